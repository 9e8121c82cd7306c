//! What a lobe has to do with tables: those it reads, and those that hold its albedo.

use glam::Vec3;

use super::distribution::MicrofacetDistribution;
use super::key::LobeKey;
use crate::vector::vec3;

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

    /// A visible normal and the density with which it is drawn: that of
    /// [`sample_visible_normal`](MicrofacetDistribution::sample_visible_normal) to the bit, and its
    /// [`table_pdf`](Self::table_pdf) to rounding.
    ///
    /// The density is a by-product of the draw, found from the numbers, which saves the inversion
    /// by which `table_pdf` finds them: both take less than half the time of one after the other
    /// for γ ≥ 1.8 (`cargo run --profile dist -p microfacet-bench`). `table_pdf` sees a normal
    /// whose components are rounded, so the two differ as densities do of normals that rounding
    /// cannot tell apart: by a few roundings, and by more next to the silhouette, towards the ends
    /// of the numbers, and for narrow lobes. By default they are computed one after the other.
    #[must_use]
    #[inline]
    fn sample_with_table_pdf(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        with_table_pdf(self, None, vec3(v), u)
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

/// A normal and its density, from what the fast path has `drawn`, or one after the other.
#[inline(always)]
pub(super) fn with_table_pdf<L: Tabulated + ?Sized>(
    lobe: &L,
    drawn: Option<(Vec3, Option<f32>)>,
    v: Vec3,
    u: [f32; 2],
) -> ([f32; 3], f32) {
    let apart = || (lobe.sample_visible_normal(v, u).into(), None);
    let (m, density) = drawn.unwrap_or_else(apart);
    // A view below the horizon was moved to it, and does not see every normal that is drawn.
    let density = density.filter(|_| v.z >= 0.0).unwrap_or_else(|| lobe.table_pdf(v, m));
    (m.to_array(), density)
}
