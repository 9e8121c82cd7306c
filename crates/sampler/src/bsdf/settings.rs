//! How BSDFs are made: masking, and the compensation of multiple scattering.

use microfacet_core::Masking;

use super::bind::StandIn;
use super::compensation::Compensation;
use crate::tables::Tables;

/// How a [`Conductor`](crate::Conductor), [`Dielectric`](crate::Dielectric) or
/// [`Plastic`](crate::Plastic) is made: its form of masking and shadowing, and the compensation of
/// the light that one bounce loses, with the tables whose albedos it reads. One value serves all
/// materials of a scene.
///
/// By default height-correlated masking and single scattering, which needs no albedo.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{BsdfSettings, Compensation, Conductor, Metal, Tables};
///
/// let tables = Tables::embedded();
/// let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
/// let gold = Conductor::new(tables.student_t(0.3, 2.5)?, Metal::Gold, settings)?;
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct BsdfSettings<'a> {
    pub(super) masking: Masking,
    compensation: Compensation,
    tables: Option<&'a Tables>,
    pub(super) stand_in: StandIn,
}

impl<'a> BsdfSettings<'a> {
    /// Height-correlated masking and single scattering.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// With another form of masking and shadowing.
    #[must_use]
    pub fn with_masking(self, masking: Masking) -> Self {
        Self { masking, ..self }
    }

    /// With a compensation of the light that one bounce loses, by albedos from tables.
    ///
    /// The default set has those of metals, and of [common](Tables::embedded) dielectrics and
    /// plastics; others are baked for a recipe that names them, whose lines the error of a missing
    /// one gives.
    #[must_use]
    pub fn compensated(self, compensation: Compensation, tables: &'a Tables) -> Self {
        Self { compensation, tables: Some(tables), ..self }
    }

    /// With albedos of round lobes, or without, where the tables have none of a lobe itself.
    #[must_use]
    pub fn with_stand_in(self, stand_in: StandIn) -> Self {
        Self { stand_in, ..self }
    }

    /// The compensation and its tables; `None` for single scattering.
    pub(super) fn compensation(&self) -> Option<(Compensation, &'a Tables)> {
        let tables = self.tables.filter(|_| self.compensation != Compensation::None)?;
        Some((self.compensation, tables))
    }
}
