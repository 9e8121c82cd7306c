//! The Ellipsoid distribution of normals of any shape γ: a Student-t lobe seen through a 3×3 matrix.

use core::f64::consts::PI;
use core::fmt;

use glam::{DMat3, DVec3};
use microfacet_common::Masking;

use crate::below::SlopeBelow;
use crate::error::ParameterError;
use crate::shape::Shape;
use crate::visible::{self, SignedUnit, UnitView, VisibleSlope};

/// Below this ratio the matrix is taken for singular: half of the digits of a double would be lost in its inverse.
const SINGULAR: f64 = 1e-8;

/// Why an ellipsoid was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EllipsoidError {
    /// A roughness or the shape is outside its domain.
    Parameter(ParameterError),
    /// An angle or a matrix entry is infinite or NaN; the value.
    NotFinite(f64),
    /// The columns of the matrix are linearly dependent; the ratio of the smallest to the largest part found.
    Singular(f64),
    /// The macro normal lies almost in the ellipsoid's silhouette: the mean normal is tilted by more than
    /// atan(1e8) from it; the tangent of the tilt.
    Silhouette(f64),
    /// A lobe matrix was given with γ = ∞, where the lobe is infinitely narrow in its own space.
    LobeWithoutWidth,
}

impl fmt::Display for EllipsoidError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(e) => e.fmt(f),
            Self::NotFinite(x) => {
                write!(f, "{x}: angles (radians) and matrix entries must be finite")
            }
            Self::Singular(r) => write!(
                f,
                "the matrix is singular to a ratio of {r:e}; its columns must span space with a ratio above {SINGULAR:e}"
            ),
            Self::Silhouette(t) => write!(
                f,
                "the ellipsoid is tilted until the macro normal is almost in its silhouette (mean slope {t:e}, at most \
                 {:e}); turn it less",
                1.0 / SINGULAR
            ),
            Self::LobeWithoutWidth => {
                write!(
                    f,
                    "a lobe matrix needs a finite gamma; for Beckmann give the unit matrix (`from_matrix`)"
                )
            }
        }
    }
}

impl core::error::Error for EllipsoidError {}

impl From<ParameterError> for EllipsoidError {
    fn from(e: ParameterError) -> Self {
        Self::Parameter(e)
    }
}

/// Ellipsoid normals of any shape γ: the Ellipsoid NDF (Walter, Dong, Marschner, Greenberg 2015, *The Ellipsoid Normal
/// Distribution Function*, supplemental material) at γ = 2, a skewed Beckmann at γ = ∞, a skewed Student-t between.
///
/// A 3×3 matrix U maps directions by v ↦ Uv and normals by m ↦ U⁻ᵀm into *unit space*, where the lobe is the isotropic
/// Student-t of unit roughness about Un. U counts up to a rotation on its left and a positive factor, so it can be brought to the
/// form ((p, 0, 0), (q, r, 0), (x, y, 1)): the slopes of the surface are those of a Student-t with an arbitrary 2×2 linear map
/// and a mean slope −(x, y). That form has no singular limit in γ, and all members of one γ share the same tables.
///
/// ```
/// use glam::DVec3;
/// use microfacet_model::Ellipsoid;
/// let brushed = Ellipsoid::new(0.3, 0.1, [0.2, -0.1, 0.5], 2.7)?;
/// let v = DVec3::new(0.8, 0.0, 0.6);
/// let m = brushed.visible_normal(v, [0.3, 0.7]);
/// assert!(m.dot(v) > 0.0 && brushed.visible_normal_pdf(v, m) > 0.0);
/// # Ok::<(), microfacet_model::EllipsoidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Lower-triangular map into unit space with a 1 in the corner.
    unit: DMat3,
    shape: Shape,
}

/// A direction in unit space, turned so that it lies over the first axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Horizontal length and height; not normalised, the height may be negative.
    pub(crate) across: f64,
    pub(crate) up: f64,
    pub(crate) cos_phi: f64,
    pub(crate) sin_phi: f64,
}

/// The distribution of in-plane slopes that a view sees.
enum InPlane<'a> {
    Above(VisibleSlope<'a>),
    Below(SlopeBelow<'a>),
}

impl Ellipsoid {
    /// From the roughness along two axes of the ellipsoid (the third has 1) and its turn: U = diag(σx, σy, 1)·Rx·Ry·Rz, a
    /// direction being turned by θz about z first, then by θy about y, then by θx about x (right-handed, radians).
    ///
    /// θz is the direction of anisotropy; θx and θy tilt the lobe away from n. At γ = 2 σ is the α of GGX.
    ///
    /// # Errors
    /// [`EllipsoidError`], see there.
    pub fn new(
        sigma_x: f64,
        sigma_y: f64,
        theta: [f64; 3],
        gamma: f64,
    ) -> Result<Self, EllipsoidError> {
        for sigma in [sigma_x, sigma_y] {
            if !(sigma > 0.0 && sigma < f64::INFINITY) {
                return Err(ParameterError::Sigma(sigma).into());
            }
        }
        if let Some(angle) = theta.iter().find(|x| !x.is_finite()) {
            return Err(EllipsoidError::NotFinite(*angle));
        }
        let [x, y, z] = theta.map(|t| (libm::sin(t), libm::cos(t)));
        let rx = DMat3::from_cols(DVec3::X, DVec3::new(0.0, x.1, x.0), DVec3::new(0.0, -x.0, x.1));
        let ry = DMat3::from_cols(DVec3::new(y.1, 0.0, -y.0), DVec3::Y, DVec3::new(y.0, 0.0, y.1));
        let rz = DMat3::from_cols(DVec3::new(z.1, z.0, 0.0), DVec3::new(-z.0, z.1, 0.0), DVec3::Z);
        Self::from_matrix(
            DMat3::from_diagonal(DVec3::new(sigma_x, sigma_y, 1.0)) * rx * ry * rz,
            gamma,
        )
    }

    /// From the matrix U into unit space; for γ = 2 it is the A of the Ellipsoid NDF.
    ///
    /// # Errors
    /// [`EllipsoidError`] when an entry is not finite, the matrix is singular, or n is almost in the silhouette.
    pub fn from_matrix(u: DMat3, gamma: f64) -> Result<Self, EllipsoidError> {
        let shape = Shape::new(gamma)?;
        if let Some(x) = u.to_cols_array().iter().find(|x| !x.is_finite()) {
            return Err(EllipsoidError::NotFinite(*x));
        }
        let largest = u.to_cols_array().iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest == 0.0 {
            return Err(EllipsoidError::Singular(0.0));
        }
        // Gram–Schmidt from the last column: U = QL with a rotation (or reflection) Q, to which the lobe is blind.
        let [c1, c2, c3] = [u.x_axis / largest, u.y_axis / largest, u.z_axis / largest];
        let (q3, l33) = direction(c3);
        let l32 = q3.dot(c2);
        let (q2, l22) = direction(c2 - l32 * q3);
        let (l31, l21) = (q3.dot(c1), q2.dot(c1));
        let l11 = (c1 - l31 * q3 - l21 * q2).length();
        for (part, whole) in [(l33, 1.0), (l22, c2.length()), (l11, c1.length())] {
            if !(part > SINGULAR * whole) {
                return Err(EllipsoidError::Singular(if whole > 0.0 { part / whole } else { 0.0 }));
            }
        }
        let tilt = libm::hypot(l31, l32) / l33;
        if !(tilt < 1.0 / SINGULAR) {
            return Err(EllipsoidError::Silhouette(tilt));
        }
        let (p, q, r) = (l11 / l33, l21 / l33, l22 / l33);
        let unit =
            DMat3::from_cols(DVec3::new(p, q, l31 / l33), DVec3::new(0.0, r, l32 / l33), DVec3::Z);
        Ok(Self { unit, shape })
    }

    /// From the matrix A of the cosine-power lobe, D′ ∝ (m′·n′)^(2γ−4) with n′ = An/‖An‖, where a plain Student-t has
    /// A = diag(σx√(γ−1), σy√(γ−1), 1).
    ///
    /// # Errors
    /// As [`from_matrix`](Self::from_matrix), and [`EllipsoidError::LobeWithoutWidth`] for γ = ∞.
    pub fn from_lobe_matrix(a: DMat3, gamma: f64) -> Result<Self, EllipsoidError> {
        let mut ellipsoid = Self::from_matrix(a, gamma)?;
        if ellipsoid.shape.is_beckmann() {
            return Err(EllipsoidError::LobeWithoutWidth);
        }
        let s = ellipsoid.shape.s().sqrt();
        let u = &mut ellipsoid.unit;
        (u.x_axis.x, u.x_axis.y, u.y_axis.y) = (s * u.x_axis.x, s * u.x_axis.y, s * u.y_axis.y);
        Ok(ellipsoid)
    }

    /// The lower-triangular matrix ((p, 0, 0), (q, r, 0), (x, y, 1)) into unit space, p, r > 0.
    pub fn unit_matrix(&self) -> DMat3 {
        self.unit
    }

    /// The shape γ.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Normal distribution function D(m) per steradian, ∫ D(m) (m·n) dm = 1 ([Walter et al. 2015, eq. 1] at γ = 2); 0 for m·n ≤ 0.
    ///
    /// At γ = 2: 1/(π |A| ‖An‖ ‖A⁻ᵀm‖⁴).
    pub fn d(&self, m: DVec3) -> f64 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let u = self.normal_to_unit(m);
        self.shape.unit_d(u.x * u.x + u.y * u.y, m.z * m.z)
            / (self.unit.x_axis.x * self.unit.y_axis.y)
    }

    /// A normal in unit space, U⁻ᵀm; its z is that of m.
    pub(crate) fn normal_to_unit(&self, m: DVec3) -> DVec3 {
        let (c1, c2) = (self.unit.x_axis, self.unit.y_axis);
        let y = (m.y - c2.z * m.z) / c2.y;
        DVec3::new((m.x - c1.z * m.z - c1.y * y) / c1.x, y, m.z)
    }

    pub(crate) fn view(&self, v: DVec3) -> View {
        let w = self.unit * v;
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
            InPlane::Below(SlopeBelow::new(&self.shape, -view.up / view.across))
        }
    }

    fn area(&self, view: &View, slopes: &InPlane) -> f64 {
        match slopes {
            InPlane::Above(visible) => visible.area() * libm::hypot(view.across, view.up),
            InPlane::Below(below) => below.excess() * view.across,
        }
    }

    /// Projected area of the whole microsurface, ∫ (v·m)⁺ D(m) dm, for any direction v (Walter et al. 2015, eq. 24 and 26, at
    /// γ = 2, where it is ½(‖Av‖ + Av·An/‖An‖)/‖An‖). 0 where it underflows.
    pub fn projected_area(&self, v: DVec3) -> f64 {
        let view = self.view(v);
        self.area(&view, &self.in_plane(&view))
    }

    /// Smith masking G1(v) = min(1, (v·n) / projected area) (Walter et al. 2015, eq. 6); 0 at and below the horizon.
    ///
    /// Without the clamp a lobe that leans away from v would show less area than the surface it stands on.
    pub fn g1(&self, v: DVec3) -> f64 {
        if v.z > 0.0 { (v.z / self.projected_area(v)).min(1.0) } else { 0.0 }
    }

    /// Λ = 1/G1 − 1 ≥ 0 with the clamped G1; ∞ at and below the horizon.
    pub fn lambda(&self, v: DVec3) -> f64 {
        if v.z > 0.0 { (self.projected_area(v) / v.z - 1.0).max(0.0) } else { f64::INFINITY }
    }

    /// Masking and shadowing of a pair of directions; 0 when either is at or below the horizon.
    pub fn g2(&self, v: DVec3, l: DVec3, masking: Masking) -> f64 {
        masking.g2(self.g1(v), self.g1(l))
    }

    /// Density of visible normals per steradian, (v·m)⁺ D(m) / ∫ (v·m)⁺ D (Walter et al. 2015, eq. 30).
    ///
    /// 0 for v at or below the horizon, for normals facing away, and where the visible area underflows.
    pub fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let facing = v.dot(m);
        let area = self.projected_area(v);
        if !(v.z > 0.0 && facing > 0.0 && area > 0.0) {
            return 0.0;
        }
        facing * self.d(m) / area
    }

    /// The visible normal at u₁ (in the plane of v and the lobe's axis, from away from the viewer to towards it) and u₂
    /// (across), by inverting both CDFs in unit space.
    pub fn visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let view = self.view(v);
        let x = match self.in_plane(&view) {
            InPlane::Above(visible) => visible.quantile(u[0]),
            InPlane::Below(below) => SignedUnit { w: below.quantile(u[0]), sign: 1.0 },
        };
        let t = visible::across_quantile(&self.shape, u[1]);
        let m = visible::unit_normal(&self.shape, x, t);
        self.normal_from_unit(turn(m, view.cos_phi, view.sin_phi))
    }

    /// The random numbers at which [`visible_normal`](Self::visible_normal) gives m: uniform on [0, 1]² for visible normals.
    pub fn invert_visible_normal(&self, v: DVec3, m: DVec3) -> [f64; 2] {
        let view = self.view(v);
        let m = turn(self.normal_to_unit(m), view.cos_phi, -view.sin_phi);
        let (x, y) = (m.x / m.z, m.y / m.z);
        let w = self.shape.unit(x.abs());
        let x_at = SignedUnit { w, sign: 1.0_f64.copysign(x) };
        let along = match self.in_plane(&view) {
            InPlane::Above(visible) => visible.cdf(x_at),
            InPlane::Below(_) if x < 0.0 => 0.0,
            InPlane::Below(below) => 1.0 - below.complement(w),
        };
        let t = y / (1.0 + self.shape.s() * x * x).sqrt();
        let t = SignedUnit { w: self.shape.unit(t.abs()), sign: 1.0_f64.copysign(t) };
        [along, visible::across_cdf(&self.shape, t)]
    }

    /// A normal distributed as D(m)(m·n) from u ∈ [0, 1)².
    pub fn sample_ndf(&self, u: [f64; 2]) -> DVec3 {
        let r = self.shape.slope_radius(u[0]);
        let phi = 2.0 * PI * u[1];
        let (x, y) = (libm::cos(phi), libm::sin(phi));
        // The horizon: r² would overflow in the normalisation.
        let m = if r > 1e150 { DVec3::new(x, y, 1.0 / r) } else { DVec3::new(r * x, r * y, 1.0) };
        self.normal_from_unit(m)
    }

    /// Uᵀm, normalised.
    pub(crate) fn normal_from_unit(&self, m: DVec3) -> DVec3 {
        (self.unit.transpose() * m).normalize()
    }
}

/// Unit vector and length; the zero vector has no direction.
fn direction(v: DVec3) -> (DVec3, f64) {
    let length = v.length();
    (if length > 0.0 { v / length } else { DVec3::ZERO }, length)
}

/// Turns by the azimuth given as (cos, sin).
pub(crate) fn turn(m: DVec3, cos: f64, sin: f64) -> DVec3 {
    DVec3::new(m.x * cos - m.y * sin, m.x * sin + m.y * cos, m.z)
}
