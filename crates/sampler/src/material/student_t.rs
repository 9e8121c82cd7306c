//! A Student-t lobe prepared from tables: σ and γ are fixed, only directions are left.

use core::f32::consts::PI;

use glam::Vec3;
use microfacet_core::math::sqrt;
use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Masking, Roughness, saturated};
use microfacet_tables::Table;
use microfacet_tables::axis::hermite::{horner, split};
use wide::f32x4;

use super::distribution::{
    Facet, GRAZING, MicrofacetDistribution, SMOOTH, SMOOTH_MASKED, is_hidden, visible_density,
};
use super::key::LobeKey;
use super::normals::Normals;
use super::roughness::checked;
use super::slices::Slices;
use crate::error::{BatchError, MaterialError, same_lengths};
use crate::lanes::{swap_halves, swap_pairs};

/// A Student-t lobe with fixed roughness and shape, holding only the slices of the tables it needs.
///
/// Directions are unit vectors in the tangent frame, n = +z, x and y along the principal axes of
/// roughness. A view or light at or below the horizon has `g1` = 0 and `lambda` = ∞; sampling takes
/// such a view at the horizon. G1 and sampled normals have the errors that the tables' certificates
/// state; D is in closed form. Normals from samplers are of unit length to 4 ulp, lie above the
/// horizon, and face the view to rounding (v·m > −1.2e-7).
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
    /// Direction of the horizontal part, of length `frame`; (1, 0) at normal incidence.
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// Length of (x, y): that of the horizontal part, or 1 where that is short.
    pub(crate) frame: f32,
    /// Horizontal length, 0 at normal incidence.
    pub(crate) rho: f32,
    /// Vertical part, ≥ 0.
    pub(crate) z: f32,
}

/// Shorter horizontal parts are taken as normal incidence: their squares, and the azimuth with
/// them, leave the range of f32.
pub(crate) const NORMAL_INCIDENCE: f32 = 1e-18;

/// For shorter horizontal parts the azimuth is scaled to unit length: otherwise the square of a
/// normal carrying it would leave the range of f32.
pub(crate) const SHORT: f32 = 1e-6;

/// The azimuth of longer ones is scaled for the same reason. No direction of unit length has one,
/// since σ ≤ 10⁶; through the matrix of a tilted lobe, whose entries are at most 10¹⁸, it may.
pub(crate) const LONG: f32 = 1e9;

/// The squares of longer parts leave the range of f32.
pub(crate) const LONGEST: f32 = 1e19;

/// Less than the area of any direction; its reciprocal times the number of cells stays finite.
pub(crate) const LEAST_AREA: f32 = 1e-30;

/// Returns 0, the G1 of NaN; kept cold and out of line so that the common path stays short.
#[cold]
fn g1_of_nan<T: Default>() -> T {
    T::default()
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
        let slices = Slices::from_tables(tables, gamma, s_of_gamma(gamma))?;
        Ok(Self::new(sigma, gamma, slices))
    }

    /// The carrier of another distribution's tables: unit slopes are slopes over σ, and slopes
    /// across scale with √(1 + x²).
    pub(crate) fn for_radial(sigma: f32, slices: Slices) -> Self {
        Self::new([sigma; 2], 2.0, slices)
    }

    /// With everything prepared that does not depend on a direction.
    fn new([sigma_x, sigma_y]: [f32; 2], gamma: f64, slices: Slices) -> Self {
        let s = s_of_gamma(gamma);
        Self {
            sigma_x,
            sigma_y,
            gamma,
            s: s as f32,
            kappa_sigma: [slices.kappa * sigma_x, slices.kappa * sigma_y],
            slices,
            normals: Normals::new(s),
            inverse_sigma: [1.0 / sigma_x, 1.0 / sigma_y],
            scale: 1.0 / (PI * sigma_x * sigma_y),
        }
    }

    /// The same shape with another roughness; the tables are not read again.
    ///
    /// # Errors
    /// [`MaterialError::Sigma`] unless both roughnesses lie in [1e-8, 1e6].
    pub fn with_roughness(&self, roughness: impl Into<Roughness>) -> Result<Self, MaterialError> {
        Ok(Self::new(checked(roughness.into())?, self.gamma, self.slices.clone()))
    }

    /// σx and σy.
    pub fn sigma(&self) -> [f32; 2] {
        [self.sigma_x, self.sigma_y]
    }

    /// The shape γ.
    pub fn gamma(&self) -> f64 {
        self.gamma
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
            // Normal incidence, straight down, NaN or too long: without z > 0 it is taken at the
            // horizon, as every view below it, with an arbitrary azimuth.
            let (rho, z) = if z > 0.0 { (0.0, z.max(NORMAL_INCIDENCE)) } else { (1.0, 0.0) };
            Stretched { x: 1.0, y: 0.0, frame: 1.0, rho, z }
        }
    }

    /// 1/(area of the microsurface seen along the stretched direction) = G1/z, finite at grazing.
    #[inline(always)]
    pub(crate) fn inverse_area(&self, w: &Stretched) -> f32 {
        let r = self.inverse_mean_area(w.rho, w.z);
        self.shadowing(w.rho, w.z, r) * r
    }

    /// The mean of |x| over unit slopes x: 1 for GGX, and without limit towards γ = 3/2.
    fn mean_slope(&self) -> f32 {
        2.0 * self.slices.first_moment()
    }

    /// Whether a lobe of this shape with roughness σ is a mirror, see
    /// [`MicrofacetDistribution::is_effectively_smooth`].
    pub(crate) fn is_smooth(&self, sigma: f32) -> bool {
        let rho = sigma * sqrt(1.0 - GRAZING * GRAZING);
        let grazing = Stretched { x: 1.0, y: 0.0, frame: 1.0, rho, z: GRAZING };
        let masked = 1.0 - GRAZING * self.inverse_area(&grazing);
        sigma * self.mean_slope() < SMOOTH && masked <= SMOOTH_MASKED
    }

    /// cells/(z + κρ): times z, it is the view coordinate q in cells.
    #[inline(always)]
    fn inverse_mean_area(&self, rho: f32, z: f32) -> f32 {
        // The sum vanishes only for the null vector and straight below the surface, where z·r is
        // then 0 and not 0·∞.
        self.slices.shadowing_cells / (z + self.slices.kappa * rho).max(LEAST_AREA)
    }

    /// G1/q over the number of cells, from the table.
    #[inline(always)]
    fn shadowing(&self, rho: f32, z: f32, r: f32) -> f32 {
        let slices = &self.slices;
        let at = slices.shadowing_view.of_view(rho, z, slices.kappa, r, slices.shadowing_cells);
        let (cell, w) = split(f32x4::splat(at));
        // Only NaN can leave the table.
        let cell = slices.shadowing.get(cell.to_array()[0] as u32 as usize);
        cell.map_or(0.0, |cell| horner(cell, w.to_array()[0]))
    }

    /// D of a normal above the horizon, from it with its horizontal part divided by σ and from the
    /// square of its length before that; `scale` is 1/(πσxσy).
    #[inline(always)]
    pub(crate) fn d_of_unit(&self, m: Vec3, length2: f32, scale: f32) -> f32 {
        let root = self.normals.root(m.x * m.x + m.y * m.y, m.z * m.z, length2);
        saturated((scale * root) * root)
    }

    /// D of a normal above the horizon, by its direction and the square of its length.
    #[inline(always)]
    fn d_of(&self, m: Vec3, length2: f32) -> f32 {
        let [x, y] = self.inverse_sigma;
        self.d_of_unit(Vec3::new(m.x * x, m.y * y, m.z), length2, self.scale)
    }

    /// G1 of a view and a light: the root, the division and the lookup's arithmetic of
    /// [`g1`](MicrofacetDistribution::g1) in two lanes.
    #[inline(always)]
    fn g1_of_both(&self, v: Vec3, l: Vec3) -> [f32; 2] {
        let slices = &self.slices;
        // In turns [v, l, v, l], so that no lane has to be set to zero.
        let [kx, ky] = self.kappa_sigma;
        let xy = f32x4::new([v.x, l.x, v.y, l.y]) * f32x4::new([kx, kx, ky, ky]);
        let squares = xy * xy;
        let z = f32x4::new([v.z, l.z, v.z, l.z]).fast_max(f32x4::ZERO);
        let across = (squares + swap_halves(squares)).sqrt();
        let [q, at] = slices.shadowing_view.of_views(across, z, slices.shadowing_cells);
        let (cell, w) = split(at);
        let [i, j, ..] = cell.to_array().map(|cell| cell as u32 as usize);
        let (Some(a), Some(b)) = (slices.shadowing.get(i), slices.shadowing.get(j)) else {
            return g1_of_nan();
        };
        // c₀ and c₁ of both, then c₂ and c₃.
        let (a, b) = (f32x4::new(*a), f32x4::new(*b));
        let (low, high) = (a.unpack_lo(b), a.unpack_hi(b));
        let ([wa, wb, ..], square) = (w.to_array(), w * w);
        let terms = (low + square * high) * f32x4::new([1.0, 1.0, wa, wb]);
        let [g1_v, g1_l, ..] = (q * (terms + swap_halves(terms))).fast_min(f32x4::ONE).to_array();
        // As in `g1`.
        if cfg!(not(target_feature = "sse2")) && (g1_v.is_nan() || g1_l.is_nan()) {
            return g1_of_nan();
        }
        [g1_v, g1_l]
    }
}

impl MicrofacetDistribution for StudentT {
    /// D(m), with a relative error of a few ulp times its exponent (about 1e-6 times |ln D σxσy|).
    ///
    /// For γ < 2 it grows without limit towards the horizon and overflows to `f32::MAX`, not to ∞.
    #[inline]
    fn d(&self, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        self.d_of(m, 1.0)
    }

    #[inline(always)]
    fn g1(&self, v: Vec3) -> f32 {
        // As `inverse_area`, without the azimuth that `stretch` finds, with κ folded into the
        // roughness, and with nothing between the division and the lookup. The chain of a root, a
        // division and a lookup is so long that the instructions of a few calls fill the
        // processor's window, and each one less counts. Of 4.3 ns, Horner's scheme, which no
        // compiler turns into shuffles, saved about 0.5, an area without a lower limit 0.2, and a
        // root of all lanes, none of which is set to zero, with NaN handled out of line, 0.3; 3.1
        // are left.
        let slices = &self.slices;
        let [kx, ky] = self.kappa_sigma;
        let xy = f32x4::new([v.x, v.y, 0.0, 0.0]) * f32x4::new([kx, ky, 0.0, 0.0]);
        let squares = xy * xy;
        let z = f32x4::new([v.z, 0.0, 0.0, 0.0]).fast_max(f32x4::ZERO);
        let across = (squares + swap_pairs(squares)).sqrt();
        let [q, at] = slices.shadowing_view.of_views(across, z, slices.shadowing_cells);
        let (cell, w) = split(at);
        let Some(cell) = slices.shadowing.get(cell.to_array()[0] as u32 as usize) else {
            return g1_of_nan();
        };
        let g1 = q.to_array()[0] * horner(cell, w.to_array()[0]);
        // The null vector gives 0/0, which leaves the table where the cast does not saturate, and
        // is cell 0 where it does.
        if cfg!(not(target_feature = "sse2")) && g1.is_nan() {
            return 0.0;
        }
        // Interpolation may overshoot 1 by the table's error near normal incidence.
        g1.min(1.0)
    }

    /// A normal visible from `v`, by the inverse CDFs of two slopes at `u[0]` and `u[1]`.
    ///
    /// Where the whole distribution is tabulated (γ ≥ 1.8 in the default set), the tilt towards the
    /// viewer rises with `u[0]` and the tilt across with `u[1]`. For smaller γ, `u[0]` first
    /// chooses between the tabulated part and the closed-form heavy part, and the tilt rises within
    /// each.
    #[inline(always)]
    fn sample_visible_normal(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        self.sample(v, u)
    }

    #[inline]
    fn visible_normal_pdf(&self, v: Vec3, m: Vec3) -> f32 {
        visible_density(v.dot(m), self.d(m), self.inverse_area(&self.stretch(v)))
    }

    #[inline(always)]
    fn facet(&self, v: Vec3, m: Vec3, l: Vec3, masking: Masking) -> Facet {
        if !(m.z > 0.0) {
            return Facet::default();
        }
        Facet::of_g1(self.d_of(m, m.dot(m)), v, self.g1_of_both(v, l), masking)
    }

    #[inline(always)]
    fn sample_reflecting_normal(&self, v: Vec3, u: [f32; 2]) -> (Vec3, f32) {
        (self.sample_along(v, u), 1.0)
    }

    /// The density with which the sampler draws `m`, the Jacobian of its own map.
    ///
    /// An estimator that divides by it is unbiased at any resolution of the tables. It is above 0
    /// at every normal that is drawn for a view above the horizon, integrates to 1 over all m, and
    /// costs two searches and a few square roots: use it where bias matters.
    fn table_pdf(&self, v: Vec3, m: Vec3) -> f32 {
        if is_hidden(v, m) { 0.0 } else { self.density_of_samples(v, m) }
    }

    fn key(&self) -> LobeKey {
        LobeKey::of_family([self.sigma_x, self.sigma_y], self.gamma)
    }

    fn is_effectively_smooth(&self) -> bool {
        self.is_smooth(self.sigma_x.max(self.sigma_y))
    }

    fn bytes(&self) -> usize {
        self.slices.bytes()
    }

    fn sample_batch(&self, v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
        self.sample_all(v, u, m);
        Ok(())
    }

    fn g1_batch(&self, v: &[Vec3], g1: &mut [f32]) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("g1", g1.len())])?;
        self.g1_all(v, g1);
        Ok(())
    }
}
