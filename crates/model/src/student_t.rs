//! The Student-t distribution of microfacet normals: roughness σx, σy and shape γ.

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_core::{Roughness, saturated};

use crate::distribution::MicrofacetDistribution;
use crate::error::ParameterError;
use crate::shape::Shape;
use crate::visible::{self, SignedSlope, UnitView, VisibleSlope, above_horizon};

/// The Student-t distribution of microfacet normals, of roughness σx, σy and shape γ.
///
/// Equations are those of Ribardière, Bringier, Meneveaux, Simonot 2017, *STD: Student's
/// t-Distribution of Slopes for Microfacet Based BSDFs*, <https://doi.org/10.1111/cgf.13137>.
///
/// Directions are unit vectors in the tangent frame (macro normal n = +z, x and y along the
/// principal roughness axes); angles are in radians, slopes dimensionless. γ = 2 is GGX with α = σ,
/// γ = ∞ is Beckmann with α = σ.
///
/// ```
/// use microfacet_model::glam::DVec3;
/// use microfacet_model::{MicrofacetDistribution, StudentT};
/// let gold = StudentT::new(0.3, 4.0)?;
/// let v = DVec3::new(0.8, 0.0, 0.6);
/// assert!(gold.g1(v) < 1.0 && gold.g1(v) > 0.98);
/// # Ok::<(), microfacet_model::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StudentT {
    sigma_x: f64,
    sigma_y: f64,
    shape: Shape,
}

/// A direction in unit space: its elevation, and its azimuth as cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretched {
    pub(crate) view: UnitView,
    pub(crate) cos_phi: f64,
    pub(crate) sin_phi: f64,
}

impl StudentT {
    /// A distribution of roughness σ (a number, or a pair for x and y) and shape γ.
    ///
    /// # Errors
    /// [`ParameterError`] unless every σ lies in (0, ∞) and γ > 3/2.
    pub fn new(sigma: impl Into<Roughness>, gamma: f64) -> Result<Self, ParameterError> {
        let [sigma_x, sigma_y] = sigma.into().positive().map_err(ParameterError::Sigma)?;
        Ok(Self { sigma_x, sigma_y, shape: Shape::new(gamma)? })
    }

    /// GGX (Trowbridge–Reitz) with roughness α: γ = 2, σ = α.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 < α < ∞.
    pub fn ggx(alpha: f64) -> Result<Self, ParameterError> {
        Self::new(alpha, 2.0)
    }

    /// Beckmann with roughness α: γ = ∞, σ = α.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 < α < ∞.
    pub fn beckmann(alpha: f64) -> Result<Self, ParameterError> {
        Self::new(alpha, f64::INFINITY)
    }

    /// Blinn–Phong with exponent N, D = (N+2)/(2π) cosᴺθ: γ = (N+4)/2 and σ = √(2/(N+2)), an
    /// identity and not a fit.
    ///
    /// # Errors
    /// [`ParameterError::Exponent`] unless 0 ≤ N < ∞.
    pub fn blinn_phong(exponent: f64) -> Result<Self, ParameterError> {
        if !(0.0..f64::INFINITY).contains(&exponent) {
            return Err(ParameterError::Exponent(exponent));
        }
        Self::new((2.0 / (exponent + 2.0)).sqrt(), 0.5 * (exponent + 4.0))
    }

    /// Hyper-Cauchy with D ∝ (1 + tan²θ/σ₀²)^(−γ)/cos⁴θ: σ = σ₀/√(γ−1).
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < σ₀ < ∞ and 3/2 < γ < ∞.
    pub fn hyper_cauchy(sigma_0: f64, gamma: f64) -> Result<Self, ParameterError> {
        if !(gamma > 1.5 && gamma < f64::INFINITY) {
            return Err(ParameterError::Gamma(gamma));
        }
        Self::new(sigma_0 / (gamma - 1.0).sqrt(), gamma)
    }

    /// Roughness σx along the x axis.
    pub fn sigma_x(&self) -> f64 {
        self.sigma_x
    }

    /// Roughness σy along the y axis.
    pub fn sigma_y(&self) -> f64 {
        self.sigma_y
    }

    /// The shape γ and its slope marginal.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Density of slopes P22(x̃, ỹ), ∫∫ P22 = 1 (eq. 11). The slopes of m are (−m_x/m_z, −m_y/m_z).
    pub fn p22(&self, slope_x: f64, slope_y: f64) -> f64 {
        let (x, y) = (slope_x / self.sigma_x, slope_y / self.sigma_y);
        let r2 = x * x + y * y;
        let log = if self.shape.is_beckmann() {
            -r2
        } else {
            -self.shape.gamma() * libm::log1p(self.shape.s() * r2)
        };
        libm::exp(log) / (PI * self.sigma_x * self.sigma_y)
    }

    /// Stretches a direction with w.z ≥ 0 by (σx, σy, 1).
    pub(crate) fn stretch(&self, w: DVec3) -> Stretched {
        let (x, y) = (self.sigma_x * w.x, self.sigma_y * w.y);
        let length = libm::hypot(x, y);
        let (cos_phi, sin_phi) = if length > 0.0 { (x / length, y / length) } else { (1.0, 0.0) };
        Stretched { view: UnitView::from_cotangent(w.z / length), cos_phi, sin_phi }
    }

    /// G1(v)/(v·n), the reciprocal of the microsurface's projected area towards `v`: finite at
    /// grazing, where both G1(v) and v·n vanish.
    ///
    /// The density of visible normals is (v·m)⁺ D(m) times this factor, which is the same for every
    /// m.
    pub fn inverse_area(&self, v: DVec3) -> f64 {
        let Stretched { view, .. } = self.stretch(v);
        let length = libm::hypot(libm::hypot(self.sigma_x * v.x, self.sigma_y * v.y), v.z);
        1.0 / (VisibleSlope::new(&self.shape, view).area() * length)
    }

    /// The elevation of `v` in unit space, and the cosine and sine of its azimuth there.
    pub fn unit_view(&self, v: DVec3) -> (UnitView, [f64; 2]) {
        let Stretched { view, cos_phi, sin_phi } = self.stretch(v);
        (view, [cos_phi, sin_phi])
    }

    /// The random numbers at which
    /// [`sample_visible_normal`](MicrofacetDistribution::sample_visible_normal) gives m: uniform on
    /// [0, 1]² for visible normals, whatever σ, γ and v are drawn for each.
    pub fn invert_visible_normal(&self, v: DVec3, m: DVec3) -> [f64; 2] {
        let Stretched { view, cos_phi, sin_phi } = self.stretch(v.with_z(v.z.max(0.0)));
        let (x, y) = (m.x / self.sigma_x, m.y / self.sigma_y);
        let m = DVec3::new(x * cos_phi + y * sin_phi, y * cos_phi - x * sin_phi, m.z);
        let slopes = VisibleSlope::new(&self.shape, view);
        visible::numbers(&self.shape, m, |x| slopes.cdf(x))
    }

    /// The normal in the tangent frame with the unit slopes x (towards the viewer) and
    /// t = y/√(1 + s x²).
    pub(crate) fn assemble(&self, at: &Stretched, x: SignedSlope, t: SignedSlope) -> DVec3 {
        let DVec3 { x, y, z } = visible::unit_normal(&self.shape, x, t);
        above_horizon(DVec3::new(
            self.sigma_x * (x * at.cos_phi - y * at.sin_phi),
            self.sigma_y * (x * at.sin_phi + y * at.cos_phi),
            z,
        ))
    }
}

impl MicrofacetDistribution for StudentT {
    /// D(m) by eq. 18 with 11. For γ < 2, D grows towards the horizon without bound, as cos^(2γ−4)
    /// θ, and is clamped to `f64::MAX`.
    fn d(&self, m: DVec3) -> f64 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let r = libm::hypot(m.x / self.sigma_x, m.y / self.sigma_y);
        self.shape.d_in_unit_space(r, m.z, [self.sigma_x, self.sigma_y])
    }

    /// Smith's Λ: eq. 13–15 in a well-conditioned form.
    fn lambda(&self, v: DVec3) -> f64 {
        if !(v.z > 0.0) {
            return f64::INFINITY;
        }
        let z = v.z / libm::hypot(self.sigma_x * v.x, self.sigma_y * v.y);
        if z.is_infinite() { 0.0 } else { self.shape.lambda(self.shape.asinh_slope(z)) }
    }

    fn sample_visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let stretched = self.stretch(DVec3::new(v.x, v.y, v.z.max(0.0)));
        let x = VisibleSlope::new(&self.shape, stretched.view).quantile(u[0]);
        let t = visible::across_quantile(&self.shape, u[1]);
        self.assemble(&stretched, x, t)
    }

    fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let facing = v.dot(m);
        if !(v.z > 0.0 && facing > 0.0) {
            return 0.0;
        }
        saturated(facing * self.d(m) * self.inverse_area(v))
    }
}
