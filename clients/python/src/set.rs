//! A set of tables, with what is made of it once for lobes of every roughness and shape.

use std::ops::Deref;
use std::sync::{Arc, LazyLock, OnceLock};

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::{Family, Masking, MaterialError, Tables};
use microfacet_tables::encode;
use pyo3::PyResult;

use crate::words::refused;

/// The tables of a set, and its families.
pub(crate) struct Set {
    tables: Tables,
    family: OnceLock<Arc<Family>>,
    albedos: [OnceLock<Arc<FamilyAlbedo>>; 2],
}

impl Set {
    pub(crate) fn new(tables: Tables) -> Arc<Self> {
        Arc::new(Self { tables, family: OnceLock::new(), albedos: Default::default() })
    }

    /// The embedded set, in one copy.
    pub(crate) fn embedded() -> Arc<Self> {
        static EMBEDDED: LazyLock<Arc<Set>> = LazyLock::new(|| Set::new(Tables::embedded()));
        Arc::clone(&EMBEDDED)
    }

    /// The bytes of its file.
    pub(crate) fn bytes(&self) -> PyResult<Vec<u8>> {
        encode(self.provenance(), self.tables.tables()).map_err(refused)
    }

    /// Lobes at any roughness and shape.
    pub(crate) fn lobes(&self) -> Result<Arc<Family>, MaterialError> {
        kept(&self.family, || self.tables.family())
    }

    /// Their albedos.
    pub(crate) fn albedos(&self, masking: Masking) -> Result<Arc<FamilyAlbedo>, MaterialError> {
        let kept_one = &self.albedos[usize::from(masking == Masking::Uncorrelated)];
        kept(kept_one, || self.tables.family_albedo(masking))
    }
}

impl Deref for Set {
    type Target = Tables;

    fn deref(&self) -> &Tables {
        &self.tables
    }
}

/// What was made, or is now.
fn kept<T>(
    cell: &OnceLock<Arc<T>>,
    make: impl FnOnce() -> Result<T, MaterialError>,
) -> Result<Arc<T>, MaterialError> {
    match cell.get() {
        Some(made) => Ok(Arc::clone(made)),
        None => make().map(|made| Arc::clone(cell.get_or_init(|| Arc::new(made)))),
    }
}
