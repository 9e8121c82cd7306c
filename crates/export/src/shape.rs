//! One shape with its tables, as every target writes it.

use microfacet_core::Masking;
use microfacet_sampler::port::{ShapeTables, tables_of_shape};
use microfacet_sampler::{MaterialError, Tables};
use microfacet_tables::{Quantity, SIGMA_MAX};

use super::albedo::AlbedoTable;
use super::turning::TurningAlbedo;

/// One shape γ: what lookups of any roughness read.
#[derive(Clone, Debug)]
pub struct Shape {
    /// γ.
    pub gamma: f64,
    /// Masking and slopes; none for GGX, γ = 2, which has closed forms.
    pub tables: Option<ShapeTables>,
    /// Albedos, in the order of [`Masking::ALL`].
    pub albedos: [AlbedoTable; 2],
    /// The forms of masking whose albedos are those of the default set, since the set that was
    /// asked for has none for every roughness.
    pub from_default: Vec<Masking>,
    /// Albedos of lobes that are not round, for their own roughness.
    pub turning: Vec<TurningAlbedo>,
    /// Errors of the tables against the model.
    pub errors: Errors,
    /// The program that baked the set.
    pub generator: String,
    /// The version of the set's values, raised whenever they change.
    pub numerics: u32,
}

/// The largest errors that the certificates of tables state, over all shapes that they serve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Of G1, absolute.
    pub g1: Option<f64>,
    /// Of the cumulative distribution of visible normals in the plane of incidence and across it.
    pub cdf: [Option<f64>; 2],
}

impl Shape {
    /// Collapses the tables of a set at γ. Albedos that the set does not have for every roughness
    /// are those of the default set.
    ///
    /// # Errors
    /// [`MaterialError`] for a γ that the set does not cover.
    pub fn bind(tables: &Tables, gamma: f64) -> Result<Self, MaterialError> {
        let (lobe, errors) = if gamma == 2.0 {
            (None, Errors::default())
        } else {
            let lobe = tables.student_t(1.0, gamma)?;
            let [masking, slopes, across] = tables_of_shape(tables, gamma)?;
            let cdf = [slopes, across].map(|table| table.certificate.error(Quantity::Cdf));
            let errors = Errors { g1: masking.certificate.error(Quantity::G1), cdf };
            (Some(ShapeTables::new(&lobe)), errors)
        };
        let mut from_default = Vec::new();
        let mut albedo = |masking| {
            AlbedoTable::find(tables, gamma, masking).or_else(|| {
                from_default.push(masking);
                AlbedoTable::find(&Tables::embedded(), gamma, masking)
            })
        };
        let [a, b] = Masking::ALL.map(&mut albedo);
        // Missing of a shape outside the default set alone, in a set without albedos.
        let missing = MaterialError::AlbedoNotCovered { sigma: SIGMA_MAX, gamma, nearest: None };
        let [a, b] = [a, b].map(|found| found.ok_or(missing));
        let provenance = tables.provenance();
        Ok(Self {
            gamma,
            tables: lobe,
            albedos: [a?, b?],
            from_default,
            turning: TurningAlbedo::all(tables, gamma),
            errors,
            generator: provenance.generator.clone(),
            numerics: provenance.numerics,
        })
    }

    /// Leaves out the albedos: functions then take the surface for a mirror.
    pub fn leave_out_albedos(&mut self) {
        self.albedos.iter_mut().for_each(AlbedoTable::leave_out);
        self.turning.clear();
    }

    /// The larger of `of` under both forms of masking.
    pub(super) fn worst_albedo(&self, of: impl Fn(&AlbedoTable) -> Option<f64>) -> Option<f64> {
        self.albedos.iter().filter_map(of).reduce(f64::max)
    }
}
