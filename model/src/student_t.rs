//! The Student-t distribution of microfacet normals: roughness σx, σy and shape γ.

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_common::Masking;

use crate::error::ParameterError;
use crate::shape::Shape;
use crate::visible::{self, SignedUnit, UnitView, VisibleSlope};

/// Student-t microfacet normals (Ribardière et al. 2017).
///
/// Directions are unit vectors in the tangent frame (macro normal n = +z, x and y along the principal roughness axes);
/// angles are in radians, slopes dimensionless. γ = 2 is GGX with α = σ, γ = ∞ is Beckmann with α = σ.
///
/// ```
/// use glam::DVec3;
/// use microfacet_model::StudentT;
/// let gold = StudentT::isotropic(0.3, 4.0)?;
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

/// A direction stretched into unit space: its elevation there and the azimuth of the stretched direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretched {
    pub(crate) view: UnitView,
    pub(crate) cos_phi: f64,
    pub(crate) sin_phi: f64,
}

impl StudentT {
    /// Equal roughness σ > 0 along both axes.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < σ < ∞ and γ > 3/2.
    pub fn isotropic(sigma: f64, gamma: f64) -> Result<Self, ParameterError> {
        Self::anisotropic(sigma, sigma, gamma)
    }

    /// Roughness σx along x and σy along y.
    ///
    /// # Errors
    /// [`ParameterError`] unless both lie in (0, ∞) and γ > 3/2.
    pub fn anisotropic(sigma_x: f64, sigma_y: f64, gamma: f64) -> Result<Self, ParameterError> {
        for sigma in [sigma_x, sigma_y] {
            if !(sigma > 0.0 && sigma < f64::INFINITY) {
                return Err(ParameterError::Sigma(sigma));
            }
        }
        Ok(Self { sigma_x, sigma_y, shape: Shape::new(gamma)? })
    }

    /// GGX (Trowbridge–Reitz) with roughness α: γ = 2, σ = α.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 < α < ∞.
    pub fn ggx(alpha: f64) -> Result<Self, ParameterError> {
        Self::isotropic(alpha, 2.0)
    }

    /// Beckmann with roughness α: γ = ∞, σ = α.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 < α < ∞.
    pub fn beckmann(alpha: f64) -> Result<Self, ParameterError> {
        Self::isotropic(alpha, f64::INFINITY)
    }

    /// Blinn–Phong with exponent N, D = (N+2)/(2π) cosᴺθ: γ = (N+4)/2 and σ = √(2/(N+2)), an identity and not a fit.
    ///
    /// # Errors
    /// [`ParameterError::Exponent`] unless 0 ≤ N < ∞.
    pub fn blinn_phong(exponent: f64) -> Result<Self, ParameterError> {
        if !(0.0..f64::INFINITY).contains(&exponent) {
            return Err(ParameterError::Exponent(exponent));
        }
        Self::isotropic((2.0 / (exponent + 2.0)).sqrt(), 0.5 * (exponent + 4.0))
    }

    /// Hyper-Cauchy with D ∝ (1 + tan²θ/σ₀²)^(−γ)/cos⁴θ: σ = σ₀/√(γ−1).
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < σ₀ < ∞ and 3/2 < γ < ∞.
    pub fn hyper_cauchy(sigma_0: f64, gamma: f64) -> Result<Self, ParameterError> {
        if !(gamma > 1.5 && gamma < f64::INFINITY) {
            return Err(ParameterError::Gamma(gamma));
        }
        Self::isotropic(sigma_0 / (gamma - 1.0).sqrt(), gamma)
    }

    /// σx.
    pub fn sigma_x(&self) -> f64 {
        self.sigma_x
    }

    /// σy.
    pub fn sigma_y(&self) -> f64 {
        self.sigma_y
    }

    /// The shape γ and its slope marginal.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Normal distribution function D(m) per steradian, ∫ D(m) (m·n) dm = 1 (eq. 18 with 11); 0 for m·n ≤ 0.
    ///
    /// For γ < 2 it grows without bound towards the horizon, as cos^(2γ−4).
    pub fn d(&self, m: DVec3) -> f64 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let (x, y) = (m.x / self.sigma_x, m.y / self.sigma_y);
        let (r2, z2) = (x * x + y * y, m.z * m.z);
        self.shape.unit_d(r2, z2) / (self.sigma_x * self.sigma_y)
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

    /// Smith's Λ(w) for w above the horizon (eq. 13–15 in a well-conditioned form); 0 at normal incidence, ∞ at and below
    /// the horizon.
    pub fn lambda(&self, w: DVec3) -> f64 {
        if !(w.z > 0.0) {
            return f64::INFINITY;
        }
        let z = w.z / libm::hypot(self.sigma_x * w.x, self.sigma_y * w.y);
        if z.is_infinite() { 0.0 } else { self.shape.lambda(self.shape.unit(z)) }
    }

    /// Smith masking G1(w) = 1/(1 + Λ(w)) ∈ [0, 1]; 0 at and below the horizon.
    pub fn g1(&self, w: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Masking and shadowing of a pair of directions; 0 when either is at or below the horizon.
    pub fn g2(&self, v: DVec3, l: DVec3, masking: Masking) -> f64 {
        masking.g2(self.g1(v), self.g1(l))
    }

    /// Density of visible normals, G1(v) (v·m)⁺ D(m) / (v·n), per steradian (Heitz & d'Eon 2014, eq. 2).
    ///
    /// 0 for views at or below the horizon and for normals facing away.
    pub fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let facing = v.dot(m);
        // Decided first, for D may be infinite on the horizon.
        if !(v.z > 0.0 && facing > 0.0) {
            return 0.0;
        }
        facing * self.d(m) * self.inverse_area(v)
    }

    /// G1(v)/(v·n): one over the projected area of the microsurface towards `v`, finite at grazing where both vanish.
    ///
    /// The density of visible normals is (v·m)⁺ D(m) times this, so it need not be evaluated again for every m.
    pub fn inverse_area(&self, v: DVec3) -> f64 {
        let Stretched { view, .. } = self.stretch(v);
        let length = libm::hypot(libm::hypot(self.sigma_x * v.x, self.sigma_y * v.y), v.z);
        1.0 / (VisibleSlope::new(&self.shape, view).area() * length)
    }

    /// The frame of a view: its elevation in unit space, and the cosine and sine of the azimuth of the stretched direction.
    pub fn unit_view(&self, v: DVec3) -> (UnitView, [f64; 2]) {
        let Stretched { view, cos_phi, sin_phi } = self.stretch(v);
        (view, [cos_phi, sin_phi])
    }

    /// The visible normal at random numbers u₁ (in the plane of incidence, rising from away from the viewer to towards it)
    /// and u₂ (across it), by inverting both CDFs: the map that tables approximate. Views below the horizon are taken at it.
    pub fn visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let stretched = self.stretch(DVec3::new(v.x, v.y, v.z.max(0.0)));
        let x = VisibleSlope::new(&self.shape, stretched.view).quantile(u[0]);
        let t = visible::across_quantile(&self.shape, u[1]);
        self.assemble(&stretched, x, t)
    }

    /// Builds the world normal from the unit slopes x (towards the viewer) and t = y/√(1 + s x²).
    pub(crate) fn assemble(&self, at: &Stretched, x: SignedUnit, t: SignedUnit) -> DVec3 {
        let DVec3 { x, y, z } = visible::unit_normal(&self.shape, x, t);
        DVec3::new(
            self.sigma_x * (x * at.cos_phi - y * at.sin_phi),
            self.sigma_y * (x * at.sin_phi + y * at.cos_phi),
            z,
        )
        .normalize()
    }
}
