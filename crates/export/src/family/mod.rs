//! All shapes of a set at once, for lookups at any γ: one block of memory that functions in another
//! language read as it lies.

mod block;
mod codes;

use microfacet_core::Masking;
use microfacet_sampler::port::{PartTables, VolumeTables};
use microfacet_sampler::{MaterialError, Tables};

pub(crate) use block::{Block, Item};

/// The tables of all shapes of a set.
#[derive(Clone, Debug)]
pub struct Family {
    /// By falling γ: those of whole distributions, and those of peeled ones.
    pub parts: Vec<PartTables>,
    /// Albedos, in the order of [`Masking::ALL`]; none if they were not asked for.
    pub albedos: Option<[VolumeTables; 2]>,
    /// The program that baked the set.
    pub generator: String,
    /// The version of the set's values.
    pub numerics: u32,
}

impl Family {
    /// The tables of a set, with its albedos or without.
    ///
    /// # Errors
    /// [`MaterialError`] for a set without a range of shapes, of lobes or of albedos.
    pub fn bind(tables: &Tables, with_albedos: bool) -> Result<Self, MaterialError> {
        let volume = |masking| -> Result<_, MaterialError> {
            Ok(VolumeTables::new(&tables.family_albedo(masking)?))
        };
        let albedos = if with_albedos {
            let [a, b] = Masking::ALL.map(volume);
            Some([a?, b?])
        } else {
            None
        };
        let provenance = tables.provenance();
        Ok(Self {
            parts: PartTables::of(&tables.family()?),
            albedos,
            generator: provenance.generator.clone(),
            numerics: provenance.numerics,
        })
    }
}
