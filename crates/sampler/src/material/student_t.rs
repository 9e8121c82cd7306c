//! A Student-t lobe of fixed σ and γ, prepared from tables.
//!
//! The in-plane slope x and the slope across t of visible normals are independent, so one lookup
//! inverts each CDF. A table holds the distance of the slope's half tangent from an end, see
//! [`half_tangent`](microfacet_tables::axis::half_tangent); there the silhouette is linear in the
//! view coordinate, so no sampled normal faces away, however coarse the table. The lookups are
//! written here in readable scalar code; [`lanes`](super::lanes) has the fast ones that a renderer
//! calls.

use core::f32::consts::PI;

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Masking, Roughness};
use microfacet_tables::Table;
use microfacet_tables::axis::MirroredRoot;
use microfacet_tables::axis::half_tangent::Slope;
use microfacet_tables::axis::hermite::{between_rows, hermite, horner, locate, split};
use wide::f32x4;

use super::batch::Batch;
use super::distribution::{
    Facet, GRAZING, MicrofacetDistribution, SMOOTH, SMOOTH_MASKED, is_hidden, visible_density,
};
use super::horizon::above_horizon;
use super::key::LobeKey;
use super::normals::Normals;
use super::reflecting::Reflecting;
use super::roughness::checked;
use super::slices::Slices;
use super::tabulated::Tabulated;
use crate::error::{BatchError, MaterialError, same_lengths};
use crate::vector::vec3;

/// A Student-t lobe with fixed roughness and shape, holding only the slices of the tables it needs.
///
/// Directions are unit vectors in the tangent frame, n = +z, x and y along the principal axes of
/// roughness. A view or light at or below the horizon has `g1` = 0 and `lambda` = ∞; sampling moves
/// a view below the horizon to the horizon. G1 and sampled normals have the errors that the tables'
/// certificates state; D is in closed form. Normals from samplers are of unit length to 4 ulp, lie
/// above the horizon, and face the view to rounding (v·m > −1.2e-7).
#[derive(Clone, Debug)]
pub struct StudentT {
    pub(crate) sigma_x: f32,
    pub(crate) sigma_y: f32,
    pub(crate) gamma: f64,
    pub(crate) s: f32,
    pub(crate) slices: Slices,
    pub(crate) normals: Normals,
    /// 1/σx and 1/σy.
    inverse_sigma: [f32; 2],
    /// 1/(πσxσy).
    scale: f32,
    /// κσx and κσy, of G1's coordinate.
    pub(crate) kappa_sigma: [f32; 2],
}

/// A direction stretched by (σx, σy, 1), with its azimuth in unit space.
#[derive(Clone, Copy)]
pub(crate) struct Stretched {
    /// Direction of the horizontal component, of length `frame`; (1, 0) at normal incidence.
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// Length of (x, y): that of the horizontal component, or 1 where that is short.
    pub(crate) frame: f32,
    /// Horizontal length, 0 at normal incidence.
    pub(crate) rho: f32,
    /// Vertical component, ≥ 0.
    pub(crate) z: f32,
}

/// Shorter horizontal components count as normal incidence: their squares, and the azimuth with
/// them, leave the range of f32.
pub(crate) const NORMAL_INCIDENCE: f32 = 1e-18;

/// For shorter horizontal components the azimuth is scaled to unit length: otherwise the square of
/// a normal carrying it would leave the range of f32.
pub(crate) const SHORT: f32 = 1e-6;

/// For longer horizontal components the azimuth is scaled, or squares would leave the range of f32.
/// A direction of unit length has one only with the matrix of a tilted lobe, whose entries are at
/// most 10¹⁸; otherwise σ ≤ 10⁶.
pub(crate) const LONG: f32 = 1e9;

/// The squares of longer components leave the range of f32.
pub(crate) const LONGEST: f32 = 1e19;

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
        let s = s_of_gamma(gamma);
        let slices = Slices::from_tables(tables, gamma, s)?;
        Ok(Self::new(sigma, gamma, slices, Normals::new(s)))
    }

    /// Holds the tables of a distribution outside the family, whose unit slopes are slopes over σ.
    pub(crate) fn for_radial(sigma: f32, slices: Slices) -> Self {
        Self::new([sigma; 2], 2.0, slices, Normals::untabulated(1.0))
    }

    fn new([sigma_x, sigma_y]: [f32; 2], gamma: f64, slices: Slices, normals: Normals) -> Self {
        Self {
            sigma_x,
            sigma_y,
            gamma,
            s: s_of_gamma(gamma) as f32,
            kappa_sigma: [slices.kappa * sigma_x, slices.kappa * sigma_y],
            slices,
            normals,
            inverse_sigma: [1.0 / sigma_x, 1.0 / sigma_y],
            scale: 1.0 / (PI * sigma_x * sigma_y),
        }
    }

    /// The same shape with another roughness; the tables are not read again.
    ///
    /// # Errors
    /// [`MaterialError::Sigma`] unless both roughnesses lie in [1e-8, 1e6].
    pub fn with_roughness(&self, roughness: impl Into<Roughness>) -> Result<Self, MaterialError> {
        let sigma = checked(roughness.into())?;
        Ok(Self::new(sigma, self.gamma, self.slices.clone(), self.normals.clone()))
    }

    /// σx and σy.
    #[must_use]
    pub fn sigma(&self) -> [f32; 2] {
        [self.sigma_x, self.sigma_y]
    }

    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.gamma
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
        let at = self.view::<true>(vec3(v)).at.to_array()[0];
        unit(1.0 - self.slices.heavy.share(at))
    }

    /// Whether a lobe of this shape with roughness σ is [smooth](Self::is_effectively_smooth).
    pub(crate) fn is_smooth(&self, sigma: f32) -> bool {
        let rho = sigma * sqrt(1.0 - GRAZING * GRAZING);
        let grazing = Stretched { x: 1.0, y: 0.0, frame: 1.0, rho, z: GRAZING };
        let masked = 1.0 - GRAZING * self.inverse_area(&grazing);
        // The mean of |x| over unit slopes x: 1 for GGX, and without limit towards γ = 3/2.
        let mean_slope = 2.0 * self.slices.first_moment();
        sigma * mean_slope < SMOOTH && masked <= SMOOTH_MASKED
    }

    #[inline(always)]
    pub(crate) fn stretch(&self, w: Vec3) -> Stretched {
        let (x, y) = (self.sigma_x * w.x, self.sigma_y * w.y);
        let rho = sqrt(x * x + y * y);
        let z = if w.z > 0.0 { w.z.min(LONGEST) } else { 0.0 };
        if (SHORT..=LONG).contains(&rho) {
            Stretched { x, y, frame: rho, rho, z }
        } else if (NORMAL_INCIDENCE..=LONGEST).contains(&rho) {
            Stretched { x: x / rho, y: y / rho, frame: 1.0, rho, z }
        } else {
            // Normal incidence, straight down, NaN or too long: without z > 0 the view is moved to
            // the horizon, as every view below it, with an arbitrary azimuth.
            let (rho, z) = if z > 0.0 { (0.0, z.max(NORMAL_INCIDENCE)) } else { (1.0, 0.0) };
            Stretched { x: 1.0, y: 0.0, frame: 1.0, rho, z }
        }
    }

    /// 1/(area of the microsurface seen along the stretched direction) = G1/z, finite at grazing.
    #[inline(always)]
    pub(crate) fn inverse_area(&self, w: &Stretched) -> f32 {
        /// Less than any area; its reciprocal times the number of cells stays finite.
        const LEAST_AREA: f32 = 1e-30;
        let slices = &self.slices;
        // cells/(z + κρ): times z, it is the view coordinate q in cells. z + κρ vanishes only for
        // the null vector and straight below the surface, where z·r is then 0 and not 0·∞.
        let r = slices.shadowing_cells / (w.z + slices.kappa * w.rho).max(LEAST_AREA);
        let at = slices.shadowing_view.of_view(w.rho, w.z, slices.kappa, r, slices.shadowing_cells);
        let (cell, w) = split(f32x4::splat(at));
        // G1/q over the number of cells. The index is out of the table only for NaN.
        let cell = slices.shadowing.get(cell.to_array()[0] as u32 as usize);
        cell.map_or(0.0, |cell| horner(cell, w.to_array()[0])) * r
    }

    /// D of a normal above the horizon: `m` is the normal with its horizontal component divided by
    /// σ, `length2` the square of its length before that, `scale` is 1/(πσxσy).
    #[inline(always)]
    pub(crate) fn d_of_unit(&self, m: Vec3, length2: f32, scale: f32) -> f32 {
        self.normals.d(m.x * m.x + m.y * m.y, m.z * m.z, length2, scale)
    }

    /// D of a normal above the horizon, by its direction and the square of its length.
    #[inline(always)]
    fn d_of(&self, m: Vec3, length2: f32) -> f32 {
        let [x, y] = self.inverse_sigma;
        self.d_of_unit(Vec3::new(m.x * x, m.y * y, m.z), length2, self.scale)
    }

    /// The in-plane slope from the table at u ∈ [0, 1].
    #[inline(always)]
    pub(crate) fn sample_slope(&self, view: &Stretched, u: f32) -> Slope {
        let slices = &self.slices;
        let (row, between) = self.locate_row(view);
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

    /// The row of the slope table at a view: a cell of the view axis, and the position inside it.
    #[inline(always)]
    pub(super) fn locate_row(&self, view: &Stretched) -> (usize, f32) {
        let slices = &self.slices;
        locate(slices.row(view.rho, view.z), slices.rows)
    }

    /// The slope across in units of √(1 + s x²).
    #[inline(always)]
    pub(crate) fn sample_across(&self, u: f32) -> Slope {
        let slices = &self.slices;
        let cells = slices.across.len() - 1;
        let t = MirroredRoot::coordinate(u);
        let (cell, w) = locate(t * cells as f32, cells);
        let pair = &slices.across[cell..cell + 2];
        Slope::from_end(hermite(pair[0], pair[1], w), if u > 0.5 { 1.0 } else { -1.0 })
    }

    /// The normal in the tangent frame of two slopes in unit space.
    #[inline(always)]
    pub(crate) fn assemble(&self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let m = self.unit_normal(view, x, t);
        above_horizon(Vec3::new(self.sigma_x * m.x, self.sigma_y * m.y, m.z))
    }

    /// The unnormalised normal in unit space: y = √(1 + s x²)·t, turned to the view's azimuth.
    #[inline(always)]
    pub(crate) fn unit_normal(&self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let y = sqrt(x.z * x.z + self.s * x.x * x.x) * t.x;
        let (x, z) = (x.x * t.z, x.z * t.z);
        Vec3::new(x * view.x - y * view.y, x * view.y + y * view.x, z * view.frame)
    }
}

impl MicrofacetDistribution for StudentT {
    /// D(m), with a relative error of up to 3e-7 (2 + γ) for γ ≤ 16. For larger γ, and where the
    /// cosine times σ is below 1e-19, it is a few ulp times its exponent (about 1e-6 times
    /// |ln D σxσy|).
    ///
    /// For γ < 2 D grows without limit towards the horizon and overflows to `f32::MAX`, not to ∞.
    #[inline]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        let m = vec3(m);
        if !(m.z > 0.0) {
            return 0.0;
        }
        self.d_of(m, 1.0)
    }

    #[inline(always)]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        self.g1_of_one(vec3(v))
    }

    /// A normal visible from `v`, by the inverse CDFs of two slopes at `u[0]` and `u[1]`.
    ///
    /// Where the whole distribution is tabulated (γ ≥ 1.8 in the default set), the tilt towards the
    /// viewer rises with `u[0]` and the tilt across with `u[1]`. For smaller γ, `u[0]` first
    /// chooses between the tabulated part and the closed-form heavy part, and the tilt rises within
    /// each.
    #[inline(always)]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        self.sample(vec3(v), u).to_array()
    }

    #[inline]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        visible_density(v.dot(m), self.d(m), self.inverse_area(&self.stretch(v)))
    }

    #[inline]
    fn reflection_weight(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> f32 {
        let (v, l) = (vec3(v), vec3(l));
        let [g1_v, g1_l] = self.g1_of_both(v, l);
        if v.z > 0.0 { masking.g2_over_g1(g1_v, g1_l) } else { 0.0 }
    }

    #[inline(always)]
    fn facet(
        &self,
        v: impl Into<[f32; 3]>,
        m: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> Facet {
        let (v, m, l) = (vec3(v), vec3(m), vec3(l));
        if !(m.z > 0.0) {
            return Facet::default();
        }
        Facet::of_g1(self.d_of(m, m.dot(m)), v, self.g1_of_both(v, l), masking)
    }

    fn is_effectively_smooth(&self) -> bool {
        self.is_smooth(self.sigma_x.max(self.sigma_y))
    }
}

impl Reflecting for StudentT {
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        (self.sample_along(vec3(v), u).to_array(), 1.0)
    }
}

impl Tabulated for StudentT {
    /// The density with which the sampler draws `m`, the Jacobian of its map.
    ///
    /// An estimator that divides by it is unbiased at any resolution of the tables. The density is
    /// above 0 at every normal that is drawn for a view above the horizon, integrates to 1 over all
    /// m, and costs two searches and a few square roots.
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        if is_hidden(v, m) { 0.0 } else { self.density_of_samples(v, m) }
    }

    fn key(&self) -> LobeKey {
        LobeKey::of_family([self.sigma_x, self.sigma_y], self.gamma)
    }

    fn bytes(&self) -> usize {
        self.slices.bytes() + self.normals.bytes()
    }
}

impl Batch for StudentT {
    fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
        self.sample_all(v, u, m);
        Ok(())
    }

    fn g1_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        g1: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("g1", g1.len())])?;
        self.g1_all(v, g1);
        Ok(())
    }
}
