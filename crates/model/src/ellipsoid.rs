//! The Ellipsoid distribution of normals of any shape γ: a Student-t lobe transformed by a 3×3
//! matrix.

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_core::{Masking, Skew, SkewError, saturated};

use crate::below_horizon::SlopeBelowHorizon;
use crate::distribution::MicrofacetDistribution;
use crate::error::ParameterError;
use crate::shape::Shape;
use crate::visible::{self, SignedSlope, UnitView, VisibleSlope, above_horizon};

/// Why an ellipsoid was refused.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
pub enum EllipsoidError {
    /// The shape is outside its domain.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The matrix describes no ellipsoid.
    #[error(transparent)]
    Skew(#[from] SkewError),
    /// A lobe matrix was given with γ = ∞, where the lobe is infinitely narrow in canonical space.
    #[error("a lobe matrix needs a finite gamma; for Beckmann give the unit matrix")]
    LobeWithoutWidth,
}

microfacet_core::debug_in_words!(EllipsoidError);

/// Ellipsoid normals of any shape γ: the Ellipsoid NDF (Walter, Dong, Marschner, Greenberg 2015,
/// *The Ellipsoid Normal Distribution Function*, supplemental material of
/// <https://doi.org/10.1145/2815618>) at γ = 2, a skewed Beckmann at γ = ∞, a skewed Student-t
/// between.
///
/// The matrix U of [`Skew`] maps directions by v ↦ Uv and normals by m ↦ U⁻ᵀm into *unit space*,
/// where the lobe is the isotropic Student-t of roughness 1 about Un. Its lower-triangular form has
/// no singular limit in γ, and all members of one γ share the same tables.
///
/// ```
/// use microfacet_model::glam::DVec3;
/// use microfacet_model::{Ellipsoid, MicrofacetDistribution, Skew};
/// let brushed = Ellipsoid::new(Skew::new([0.3, 0.1], [0.2, -0.1, 0.5])?, 2.7)?;
/// let v = DVec3::new(0.8, 0.0, 0.6);
/// let m = brushed.sample_visible_normal(v, [0.3, 0.7]);
/// assert!(m.dot(v) > 0.0 && brushed.visible_normal_pdf(v, m) > 0.0);
/// # Ok::<(), microfacet_model::EllipsoidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    skew: Skew,
    shape: Shape,
}

/// A direction in unit space, turned to azimuth 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Horizontal length and height; not normalised, the height may be negative.
    pub(crate) across: f64,
    pub(crate) up: f64,
    pub(crate) cos_phi: f64,
    pub(crate) sin_phi: f64,
}

enum InPlane<'a> {
    Above(VisibleSlope<'a>),
    Below(SlopeBelowHorizon<'a>),
}

impl Ellipsoid {
    /// A lobe of shape γ transformed by a matrix.
    ///
    /// # Errors
    /// [`EllipsoidError::Parameter`] unless γ > 3/2.
    pub fn new(skew: Skew, gamma: f64) -> Result<Self, EllipsoidError> {
        Ok(Self { skew, shape: Shape::new(gamma)? })
    }

    /// The ellipsoid of a cosine-power lobe with matrix A, rows first: D′ ∝ (m′·n′)^(2γ−4) with
    /// n′ = An/‖An‖. An untilted Student-t has A = diag(σx√(γ−1), σy√(γ−1), 1).
    ///
    /// # Errors
    /// [`EllipsoidError::Skew`] if A describes no ellipsoid, [`EllipsoidError::Parameter`] unless
    /// γ > 3/2, [`EllipsoidError::LobeWithoutWidth`] for γ = ∞.
    pub fn from_lobe_matrix(a: [[f64; 3]; 3], gamma: f64) -> Result<Self, EllipsoidError> {
        let mut ellipsoid = Self::new(Skew::from_matrix(a)?, gamma)?;
        if ellipsoid.shape.is_beckmann() {
            return Err(EllipsoidError::LobeWithoutWidth);
        }
        let s = ellipsoid.shape.s().sqrt();
        let skew = &mut ellipsoid.skew;
        (skew.p, skew.q, skew.r) = (s * skew.p, s * skew.q, s * skew.r);
        Ok(ellipsoid)
    }

    /// The matrix into unit space.
    pub fn skew(&self) -> Skew {
        self.skew
    }

    /// The shape γ.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// A normal in unit space, U⁻ᵀm; its z is that of m.
    pub(crate) fn normal_to_unit(&self, m: DVec3) -> DVec3 {
        let Skew { p, q, r, x, y } = self.skew;
        let uy = (m.y - y * m.z) / r;
        DVec3::new((m.x - x * m.z - q * uy) / p, uy, m.z)
    }

    pub(crate) fn view(&self, v: DVec3) -> View {
        let w = DVec3::from(self.skew.direction(v.to_array()));
        let across = libm::hypot(w.x, w.y);
        let (cos_phi, sin_phi) =
            if across > 0.0 { (w.x / across, w.y / across) } else { (1.0, 0.0) };
        View { across, up: w.z, cos_phi, sin_phi }
    }

    fn in_plane(&self, view: &View) -> InPlane<'_> {
        if view.up >= 0.0 {
            let at = UnitView::from_cotangent(view.up / view.across);
            InPlane::Above(VisibleSlope::new(&self.shape, at))
        } else {
            InPlane::Below(SlopeBelowHorizon::new(&self.shape, -view.up / view.across))
        }
    }

    fn area(&self, view: &View, slopes: &InPlane) -> f64 {
        match slopes {
            InPlane::Above(visible) => visible.area() * libm::hypot(view.across, view.up),
            InPlane::Below(below) => below.excess() * view.across,
        }
    }

    /// Projected area of the whole microsurface, ∫ (v·m)⁺ D(m) dm, for any direction v (Walter
    /// et al. 2015, eq. 24 and 26, at γ = 2, where it is ½(‖Av‖ + Av·An/‖An‖)/‖An‖). 0 where it
    /// underflows.
    pub fn projected_area(&self, v: DVec3) -> f64 {
        let view = self.view(v);
        self.area(&view, &self.in_plane(&view))
    }

    /// The random numbers at which [`sample_visible_normal`](Self::sample_visible_normal) gives m:
    /// uniform on [0, 1]² for visible normals.
    pub fn invert_visible_normal(&self, v: DVec3, m: DVec3) -> [f64; 2] {
        let view = self.view(v);
        let m = turn(self.normal_to_unit(m), view.cos_phi, -view.sin_phi);
        let slopes = self.in_plane(&view);
        visible::numbers(&self.shape, m, |x| match &slopes {
            InPlane::Above(visible) => visible.cdf(x),
            InPlane::Below(_) if x.sign < 0.0 => 0.0,
            InPlane::Below(below) => 1.0 - below.complement(x.w),
        })
    }

    /// A normal distributed as D(m)(m·n) from u ∈ [0, 1)².
    pub fn sample_ndf(&self, u: [f64; 2]) -> DVec3 {
        let r = self.shape.slope_radius(u[0]);
        let phi = 2.0 * PI * u[1];
        let (x, y) = (libm::cos(phi), libm::sin(phi));
        // At the horizon r² would overflow in the normalisation.
        let m = if r > 1e150 { DVec3::new(x, y, 1.0 / r) } else { DVec3::new(r * x, r * y, 1.0) };
        self.normal_from_unit(m)
    }

    /// Uᵀm, normalised.
    pub(crate) fn normal_from_unit(&self, m: DVec3) -> DVec3 {
        let Skew { p, q, r, x, y } = self.skew;
        above_horizon(DVec3::new(p * m.x + q * m.y + x * m.z, r * m.y + y * m.z, m.z))
    }
}

/// G1(v) = min(1, (v·n)/projected area), and Λ and G2 accordingly, as in Walter et al. 2015, eq. 6:
/// a lobe that leans away from v may show less area than the macrosurface.
impl MicrofacetDistribution for Ellipsoid {
    /// D(m), 0 at and below the horizon; at γ = 2 it is 1/(π |A| ‖An‖ ‖A⁻ᵀm‖⁴) (Walter et al. 2015,
    /// eq. 1).
    fn d(&self, m: DVec3) -> f64 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let u = self.normal_to_unit(m);
        self.shape.d_in_unit_space(libm::hypot(u.x, u.y), m.z, [self.skew.p, self.skew.r])
    }

    fn lambda(&self, v: DVec3) -> f64 {
        if v.z > 0.0 { (self.projected_area(v) / v.z - 1.0).max(0.0) } else { f64::INFINITY }
    }

    fn g1(&self, v: DVec3) -> f64 {
        if v.z > 0.0 { (v.z / self.projected_area(v)).min(1.0) } else { 0.0 }
    }

    /// G2(v, l)·(projected area)/(v·n): G2/G1 where G1 is not clamped, and never above 1.
    fn reflection_weight(&self, v: DVec3, l: DVec3, masking: Masking) -> f64 {
        if !(v.z > 0.0) {
            return 0.0;
        }
        let unclamped = v.z / self.projected_area(v);
        masking.g2_over_g1(unclamped.min(1.0), self.g1(l)) / unclamped.max(1.0)
    }

    fn sample_visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let view = self.view(v);
        let x = match self.in_plane(&view) {
            InPlane::Above(visible) => visible.quantile(u[0]),
            InPlane::Below(below) => SignedSlope { w: below.quantile(u[0]), sign: 1.0 },
        };
        let t = visible::across_quantile(&self.shape, u[1]);
        let m = visible::unit_normal(&self.shape, x, t);
        self.normal_from_unit(turn(m, view.cos_phi, view.sin_phi))
    }

    /// (v·m)⁺ D(m)/(projected area) (Walter et al. 2015, eq. 30); 0 also where that area
    /// underflows.
    fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let facing = v.dot(m);
        let area = self.projected_area(v);
        if !(v.z > 0.0 && facing > 0.0 && area > 0.0) {
            return 0.0;
        }
        saturated(facing * self.d(m) / area)
    }
}

pub(crate) fn turn(m: DVec3, cos: f64, sin: f64) -> DVec3 {
    DVec3::new(m.x * cos - m.y * sin, m.x * sin + m.y * cos, m.z)
}
