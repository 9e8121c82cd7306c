//! A Student-t lobe of fixed σ and γ, prepared from tables, and one that borrows its shape.
//!
//! The in-plane slope x and the slope across t of visible normals are independent, so one lookup
//! inverts each CDF. A table holds the distance of the slope's half tangent from an end, see
//! [`half_tangent`](microfacet_tables::axis::half_tangent); there the silhouette is linear in the
//! view coordinate, so no sampled normal faces away, however coarse the table. The lookups are
//! written here in readable scalar code; [`lanes`](super::lanes) has the fast ones that a renderer
//! calls.

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Masking, Roughness};
use microfacet_tables::Table;
use microfacet_tables::axis::MirroredRoot;
use microfacet_tables::axis::half_tangent::Slope;
use microfacet_tables::axis::hermite::{between_rows, hermite, locate};

use super::batch::Batch;
use super::delegate::{by_ref, forward, surface};
use super::distribution::{Facet, MicrofacetDistribution, is_hidden};
use super::horizon::above_horizon;
use super::key::{LobeKey, has_pole};
use super::pseudo::PseudoVisible;
use super::reflecting::Reflecting;
use super::roughness::{checked, clamped};
use super::slices::Slices;
use super::surface::{Scales, Shape, Stretched, Surface};
use super::tabulated::{Tabulated, with_table_pdf};
use crate::error::{BatchError, MaterialError};
use crate::vector::vec3;

/// A Student-t lobe with fixed roughness and shape, holding only the slices of the tables it needs.
///
/// Directions are unit vectors in the tangent frame, n = +z, x and y along the principal axes of
/// roughness. A view or light at or below the horizon has `g1` = 0 and `lambda` = ∞; sampling moves
/// a view below the horizon to the horizon. G1 and sampled normals have the errors that the tables'
/// certificates state; D is in closed form, with a relative error of up to 3e-7 (2 + γ) for γ ≤ 16;
/// for larger γ, and where the cosine times σ is below 1e-19, of about 2e-6 times 1 + |ln D σxσy|.
/// For γ < 2 it grows without limit towards the horizon and overflows to `f32::MAX`, not to ∞.
///
/// Normals are drawn by the inverse CDFs of two slopes. Where the whole distribution is tabulated
/// (γ ≥ 1.8 in the default set), the tilt towards the viewer rises with `u[0]` and the tilt across
/// with `u[1]`. For smaller γ, `u[0]` first chooses between the tabulated part and the closed-form
/// heavy part, and the tilt rises within each. Normals from samplers are of unit length to 4 ulp,
/// lie above the horizon, and face the view to rounding (v·m > −1.2e-7).
///
/// Where a texture gives σ, [`with_roughness`](Self::with_roughness) is the lobe of one hit; where
/// it gives γ too, see [`Tables::family`](crate::Tables::family).
#[derive(Clone, Debug)]
pub struct StudentT {
    pub(crate) slices: Slices,
    scales: Scales,
}

/// A [`StudentT`] of another roughness, which borrows all else: the lobe of one hit.
///
/// It is small, `Copy`, and made in a few operations; no memory is allocated and no reference
/// count is touched. Made by [`StudentT::with_roughness`].
#[derive(Clone, Copy, Debug)]
pub struct StudentTRef<'a> {
    surface: Surface<&'a Slices>,
}

impl StudentT {
    /// The smallest and the largest σ of a lobe, [1e-8, 1e6]: outside, squares would leave single
    /// precision. A smoother surface is a mirror.
    pub const SIGMAS: [f64; 2] = super::roughness::SIGMAS;

    pub(crate) fn from_tables(
        tables: &[Table],
        roughness: Roughness,
        gamma: f64,
    ) -> Result<Self, MaterialError> {
        let sigma = checked(roughness)?;
        if !(gamma > 1.5) {
            return Err(MaterialError::Gamma(gamma));
        }
        Ok(Self::new(sigma, Slices::from_tables(tables, gamma, s_of_gamma(gamma))?))
    }

    /// Of a shape, or of the tables of a distribution outside the family, whose unit slopes are
    /// slopes over σ.
    pub(crate) fn new(sigma: [f32; 2], slices: Slices) -> Self {
        Self { scales: Scales::new(sigma, slices.kappa), slices }
    }

    /// The same shape with another roughness: the lobe of a hit where a texture gives σ.
    ///
    /// Both σ are clamped to [1e-8, 1e6], NaN to the lower end; what is so smooth is
    /// [a mirror](crate::MicrofacetDistribution::is_effectively_smooth). A sample of it takes at
    /// most 1.3 times as long as one of a lobe that is kept
    /// (`cargo run --profile dist -p microfacet-bench`, parameters per hit).
    ///
    /// ```
    /// # #[cfg(feature = "embedded")] {
    /// use microfacet_sampler::{MicrofacetDistribution, Tables};
    ///
    /// let shape = Tables::embedded().student_t(1.0, 2.5)?; // once
    /// for sigma in [0.1, 0.12, 0.15] {
    ///     let lobe = shape.with_roughness(sigma); // at each hit
    ///     let m = lobe.sample_visible_normal([0.6, 0.0, 0.8], [0.3, 0.7]);
    /// #   assert!(m[2] > 0.0);
    /// }
    /// # }
    /// # Ok::<(), microfacet_sampler::MaterialError>(())
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn with_roughness(&self, roughness: impl Into<Roughness>) -> StudentTRef<'_> {
        StudentTRef { surface: Surface::new(&self.slices, clamped(roughness.into())) }
    }

    /// This lobe, borrowed.
    #[inline(always)]
    #[must_use]
    pub fn by_ref(&self) -> StudentTRef<'_> {
        StudentTRef { surface: self.surface() }
    }

    #[inline(always)]
    pub(crate) fn surface(&self) -> Surface<&Slices> {
        Surface { shape: &self.slices, scales: self.scales }
    }

    /// σx and σy.
    #[must_use]
    pub fn sigma(&self) -> [f32; 2] {
        self.scales.sigma
    }

    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.slices.gamma
    }

    /// Share of `u[0]`, from 0 up, for which
    /// [`sample_visible_normal`](crate::MicrofacetDistribution::sample_visible_normal) reads the
    /// table; the rest draws from the closed-form heavy part.
    ///
    /// 1 where the whole distribution is tabulated.
    #[must_use]
    pub fn tabulated_share(&self, v: impl Into<[f32; 3]>) -> f32 {
        if !self.slices.peeled {
            return 1.0;
        }
        // The same bits as in the sampler: the next number belongs to the heavy part.
        let at = self.surface().view::<true>(vec3(v)).at.to_array()[0];
        unit(1.0 - self.slices.heavy.share(at))
    }
}

impl<'a> StudentTRef<'a> {
    /// σx and σy.
    #[must_use]
    pub fn sigma(&self) -> [f32; 2] {
        self.surface.scales.sigma
    }

    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.surface.shape.gamma
    }

    #[inline(always)]
    pub(crate) fn surface(&self) -> Surface<&'a Slices> {
        self.surface
    }
}

impl Surface<&Slices> {
    /// The in-plane slope from the table at u ∈ [0, 1].
    #[inline(always)]
    pub(crate) fn sample_slope(self, view: &Stretched, u: f32) -> Slope {
        let slices = self.shape;
        let (row, between) = locate(slices.row(view), slices.rows);
        let towards = u > 0.5;
        let t = MirroredRoot::coordinate(u);
        let (cell, w) = locate(t * slices.half_cells as f32, slices.half_cells);
        // A row holds both halves, cells + 1 nodes each.
        let stride = 2 * (slices.half_cells + 1);
        let start = row * stride + if towards { slices.half_cells + 1 } else { 0 } + cell;
        let nodes = &slices.slope[..];
        let (a, b) = between_rows(
            &nodes[start..start + 2],
            &nodes[start + stride..start + stride + 2],
            0,
            between,
        );
        Slope::from_end(hermite(a, b, w), if towards { 1.0 } else { -1.0 })
    }

    /// The slope across in units of √(1 + s x²).
    #[inline(always)]
    pub(crate) fn sample_across(self, u: f32) -> Slope {
        let slices = self.shape;
        let cells = slices.across.len() - 1;
        let t = MirroredRoot::coordinate(u);
        let (cell, w) = locate(t * cells as f32, cells);
        let pair = &slices.across[cell..cell + 2];
        Slope::from_end(hermite(pair[0], pair[1], w), if u > 0.5 { 1.0 } else { -1.0 })
    }

    /// The normal in the tangent frame of two slopes in unit space.
    #[inline(always)]
    pub(crate) fn assemble(self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let m = self.unit_normal(view, x, t);
        let [sx, sy] = self.scales.sigma;
        above_horizon(Vec3::new(sx * m.x, sy * m.y, m.z))
    }

    /// The unnormalised normal in unit space: y = √(1 + s x²)·t, turned to the view's azimuth.
    #[inline(always)]
    pub(crate) fn unit_normal(self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let y = sqrt(x.z * x.z + self.shape.s * x.x * x.x) * t.x;
        let (x, z) = (x.x * t.z, x.z * t.z);
        Vec3::new(x * view.x - y * view.y, x * view.y + y * view.x, z * view.frame)
    }
}

forward!(#[inline(always)] StudentT, surface: MicrofacetDistribution, Reflecting, PseudoVisible, Batch);
forward!(#[inline(always)] StudentT, by_ref: Tabulated);
forward!(#[inline(always)] StudentTRef<'_>, surface: MicrofacetDistribution, Reflecting, PseudoVisible, Batch);

impl Tabulated for StudentTRef<'_> {
    /// The density with which the sampler draws `m`, the Jacobian of its map.
    ///
    /// An estimator that divides by it is unbiased at any resolution of the tables. The density is
    /// above 0 at every normal that is drawn for a view above the horizon, integrates to 1 over all
    /// m, and costs two searches and a few square roots.
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        let Surface { shape, scales: Scales { sigma, .. } } = self.surface;
        if is_hidden(v, m) { 0.0 } else { shape.density_of_samples(sigma, v, m) }
    }

    fn sample_with_table_pdf(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        let v = vec3(v);
        let drawn = if self.surface.shape.peeled {
            self.draw_with_density::<true>(v, u)
        } else {
            self.draw_with_density::<false>(v, u)
        };
        with_table_pdf(self, drawn, v, u)
    }

    fn key(&self) -> LobeKey {
        LobeKey::of_family(self.sigma(), self.gamma())
    }

    #[inline]
    fn has_pole(&self) -> bool {
        has_pole(self.gamma())
    }

    fn bytes(&self) -> usize {
        self.surface.shape.bytes()
    }
}
