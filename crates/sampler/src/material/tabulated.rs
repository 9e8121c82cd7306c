//! What a lobe has to do with tables: those it reads, and those that hold its albedo.

use super::distribution::MicrofacetDistribution;
use super::key::LobeKey;

/// What a lobe has to do with tables: the density of what its tables draw, their size, and the key
/// by which tables of albedos know it.
///
/// All functions are provided, as for a closed form of which no table has the albedo.
pub trait Tabulated: MicrofacetDistribution {
    /// Density with which
    /// [`sample_visible_normal`](MicrofacetDistribution::sample_visible_normal) draws `m`, the
    /// tables' errors included: an estimator that divides by it is unbiased.
    ///
    /// Except for [`Radial`](crate::lobe::Radial): it returns
    /// [`visible_normal_pdf`](MicrofacetDistribution::visible_normal_pdf), from which its samples
    /// differ by the errors of its tables.
    #[must_use]
    #[inline]
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        self.visible_normal_pdf(v, m)
    }

    /// The key of the lobe in tables of albedos.
    #[must_use]
    fn key(&self) -> LobeKey {
        LobeKey::Unknown
    }

    /// Whether D grows without limit towards the horizon, as that of γ < 2 does: rough glass then
    /// treats facets next to it apart.
    #[must_use]
    fn has_pole(&self) -> bool {
        self.key().has_pole()
    }

    /// Bytes of table that lookups touch.
    #[must_use]
    fn bytes(&self) -> usize {
        0
    }
}
