//! The Ellipsoid distribution at run time: a bound lobe seen through a matrix.

use core::f32::consts::FRAC_1_PI;

use glam::Vec3;
use microfacet_common::Masking;
use wide::f32x4;

use super::below::{Below, Numbers};
use super::sample::{HORIZON, above_horizon};
use super::student_t::{Stretched, StudentT};
use crate::axis::half_tangent::Slope;
use crate::error::BindError;
use crate::math::sqrt64;

/// A matrix is singular below this ratio, and tilted into the silhouette above its reciprocal.
const SINGULAR: f64 = 1e-8;

/// The matrix U of an ellipsoid, directions v ↦ Uv, as its lower-triangular equivalent ((p, 0, 0), (q, r, 0), (x, y, 1)).
///
/// A rotation on the left of U and a factor change nothing, so every regular U has such a form, with p, r > 0. Slopes of the surface are
/// those of the plain lobe times a 2×2 matrix, minus (x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skew {
    p: f32,
    q: f32,
    r: f32,
    x: f32,
    y: f32,
}

impl Skew {
    /// From U, rows first; for γ = 2 it is the A of the Ellipsoid NDF (Walter et al. 2015).
    ///
    /// # Errors
    /// [`BindError::NotFinite`], [`BindError::Singular`], or [`BindError::Silhouette`] when n is almost in the silhouette.
    pub fn from_matrix(u: [[f64; 3]; 3]) -> Result<Self, BindError> {
        if let Some(x) = u.iter().flatten().find(|x| !x.is_finite()) {
            return Err(BindError::NotFinite(*x));
        }
        let largest = u.iter().flatten().fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest == 0.0 {
            return Err(BindError::Singular(0.0));
        }
        let column = |j: usize| [u[0][j] / largest, u[1][j] / largest, u[2][j] / largest];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // What is left of a column without its part along a unit vector.
        let without = |a: [f64; 3], along: [f64; 3]| {
            let part = dot(a, along);
            [a[0] - part * along[0], a[1] - part * along[1], a[2] - part * along[2]]
        };
        let unit = |a: [f64; 3], whole: f64| {
            let length = sqrt64(dot(a, a));
            if length > SINGULAR * whole {
                Ok((a.map(|x| x / length), length))
            } else {
                Err(BindError::Singular(if whole > 0.0 { length / whole } else { 0.0 }))
            }
        };
        let [c1, c2, c3] = [0, 1, 2].map(column);
        let (q3, l33) = unit(c3, 1.0)?;
        let (q2, l22) = unit(without(c2, q3), sqrt64(dot(c2, c2)))?;
        let rest = without(c1, q3);
        let (_, l11) = unit(without(rest, q2), sqrt64(dot(c1, c1)))?;
        let [x, y] = [dot(q3, c1) / l33, dot(q3, c2) / l33];
        let tilt = sqrt64(x * x + y * y);
        if !(tilt < 1.0 / SINGULAR) {
            return Err(BindError::Silhouette(tilt));
        }
        let [p, q, r, x, y] = [l11 / l33, dot(q2, rest) / l33, l22 / l33, x, y].map(|x| x as f32);
        Ok(Self { p, q, r, x, y })
    }

    /// From roughness along two axes and a turn: U = diag(σx, σy, 1)·Rx·Ry·Rz, a direction being turned by θz about z first, then by θy,
    /// then by θx (right-handed, radians).
    ///
    /// # Errors
    /// [`BindError::Sigma`] unless both σ are positive and finite, and as [`from_matrix`](Self::from_matrix).
    pub fn new(sigma: [f64; 2], theta: [f64; 3]) -> Result<Self, BindError> {
        for s in sigma {
            if !(s > 0.0 && s < f64::INFINITY) {
                return Err(BindError::Sigma(s as f32));
            }
        }
        if let Some(angle) = theta.iter().find(|x| !x.is_finite()) {
            return Err(BindError::NotFinite(*angle));
        }
        let [(sx, cx), (sy, cy), (sz, cz)] = theta.map(libm::sincos);
        // Rx·Ry·Rz.
        let rows = [
            [cy * cz, -cy * sz, sy],
            [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
            [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy],
        ];
        let scale = [sigma[0], sigma[1], 1.0];
        Self::from_matrix([0, 1, 2].map(|i| rows[i].map(|x| scale[i] * x)))
    }
}

/// An Ellipsoid material: Walter et al. 2015 at γ = 2, a skewed Student-t for other γ, a skewed Beckmann at γ = ∞.
///
/// Reads the same tables as [`StudentT`]: a direction is taken through the matrix, looked up, and the normal taken back. Directions
/// are unit vectors in the tangent frame, n = +z. From a view that is above the surface but below the lobe's own horizon (the lobe leans
/// away, and the view grazes) no table is used: such normals are drawn by rejection with numbers derived from the two given.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    /// The lobe with σ = 1.
    lobe: StudentT,
    skew: Skew,
}

impl Ellipsoid {
    pub(crate) fn bind(lobe: StudentT, skew: Skew) -> Result<Self, BindError> {
        Ok(Self { lobe: lobe.with_roughness(1.0_f32)?, skew })
    }

    /// The shape γ.
    pub fn gamma(&self) -> f64 {
        self.lobe.gamma()
    }

    /// The same lobe through another matrix; the tables are not touched again.
    pub fn with_skew(&self, skew: Skew) -> Self {
        Self { skew, ..self.clone() }
    }

    /// Uv.
    #[inline(always)]
    fn to_unit(&self, v: Vec3) -> Vec3 {
        let Skew { p, q, r, x, y } = self.skew;
        Vec3::new(p * v.x, q * v.x + r * v.y, x * v.x + y * v.y + v.z)
    }

    /// 1/(area of the microsurface seen along v), both outside and inside the reach of the table.
    #[inline(always)]
    fn inverse_area(&self, w: Vec3, at: &Stretched) -> f32 {
        if w.z >= 0.0 { self.lobe.inverse_area(at) } else { self.inverse_area_below(w, at) }
    }

    #[cold]
    fn inverse_area_below(&self, w: Vec3, at: &Stretched) -> f32 {
        let area = at.rho * Below::new(&self.lobe, at.rho, -w.z).excess();
        if area > 0.0 { 1.0 / area } else { f32::MAX }
    }

    /// Normal distribution function D(m) per steradian, ∫ D(m) (m·n) dm = 1; 0 for m at or below the horizon.
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let Skew { p, q, r, x, y } = self.skew;
        // Reciprocals do not wait for the normal, as four divisions of it, one after the other, would: 10 of 80 ns for a normal and its density.
        let (along, aside) = (1.0 / p, 1.0 / r);
        let uy = (m.y - y * m.z) * aside;
        let ux = (m.x - x * m.z - q * uy) * along;
        self.lobe.d_of_unit(Vec3::new(ux, uy, m.z), FRAC_1_PI * along * aside)
    }

    /// Smith masking G1(v) = min(1, (v·n)/area); 0 at and below the horizon.
    ///
    /// The clamp keeps a lobe that leans away from returning more than it receives.
    #[inline]
    pub fn g1(&self, v: Vec3) -> f32 {
        if !(v.z > 0.0) {
            return 0.0;
        }
        let w = self.to_unit(v);
        (v.z * self.inverse_area(w, &self.lobe.stretch(w))).min(1.0)
    }

    /// Λ(v) = 1/G1 − 1 ≥ 0; ∞ at and below the horizon.
    #[inline]
    pub fn lambda(&self, v: Vec3) -> f32 {
        1.0 / self.g1(v) - 1.0
    }

    /// Masking and shadowing of view and light; 0 when either is at or below the horizon.
    #[inline]
    pub fn g2(&self, v: Vec3, l: Vec3, masking: Masking) -> f32 {
        masking.g2(self.g1(v), self.g1(l))
    }

    /// A normal visible from `v`, from two numbers in [0, 1].
    #[inline(always)]
    pub fn sample_visible_normal(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let [x, y, z] =
            self.sample_plain(v, u).unwrap_or_else(|| self.sample_any(v.x, v.y, v.z, u));
        Vec3::new(x, y, z)
    }

    /// The lobe's [common case](StudentT::sample_common) between U and Uᵀ; `None` elsewhere, and where views are below its horizon.
    ///
    /// A normal from it takes 1.2 times as long as one of the plain anisotropic lobe, 1.1 to 1.2 times with its density; by the way that
    /// always works it took twice as long (`cargo run --release --example ellipsoid_cost`).
    #[inline(always)]
    fn sample_plain(&self, v: Vec3, u: [f32; 2]) -> Option<[f32; 3]> {
        let Skew { p, q, r, x, y } = self.skew;
        let w = self.to_unit(v);
        if !(w.z >= 0.0) {
            return None;
        }
        let back = |m: f32x4| {
            let [mx, my, mz, _] = m.to_array();
            let lanes = |a| f32x4::splat(a);
            lanes(mx) * f32x4::new([p, 0.0, 0.0, 0.0])
                + lanes(my) * f32x4::new([q, r, 0.0, 0.0])
                + lanes(mz) * f32x4::new([x, y, 1.0, 0.0])
        };
        let m =
            self.lobe.sample_common(f32x4::new([w.x, w.y, 0.0, 0.0]), w.z, u, [1.0; 2], back)?;
        // Not where a matrix almost singular has taken squares out of range, or a normal below the smallest cosine.
        (m[2] >= HORIZON).then_some(m)
    }

    /// What [`sample_visible_normal`](Self::sample_visible_normal) returns, by the way that always works.
    #[inline(never)]
    fn sample_any(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> [f32; 3] {
        let w = self.to_unit(Vec3::new(x, y, z));
        let view = self.lobe.stretch(w);
        let along = if w.z >= 0.0 {
            self.lobe.sample_along(&view, u[0])
        } else {
            self.sample_below(w, &view, u)
        };
        let m = self.lobe.unit_normal(&view, along, self.lobe.sample_across(u[1]));
        let Skew { p, q, r, x, y } = self.skew;
        above_horizon(Vec3::new(p * m.x + q * m.y + x * m.z, r * m.y + y * m.z, m.z)).to_array()
    }

    #[cold]
    fn sample_below(&self, w: Vec3, view: &Stretched, u: [f32; 2]) -> Slope {
        Below::new(&self.lobe, view.rho, -w.z).sample(u[0], &mut Numbers::new(u))
    }

    /// Density of visible normals (v·m)⁺ D(m)/area per steradian; 0 where m faces away or lies below the horizon.
    #[inline]
    pub fn visible_normal_pdf(&self, v: Vec3, m: Vec3) -> f32 {
        let facing = v.dot(m).max(0.0);
        let w = self.to_unit(v);
        (facing * self.d(m) * self.inverse_area(w, &self.lobe.stretch(w))).min(f32::MAX)
    }

    /// What a reflection sampled by [`sample_visible_normal`](Self::sample_visible_normal) is worth without Fresnel:
    /// f·cos θ_l/pdf = G2(v, l)·area/(v·n), never above one.
    #[inline]
    pub fn reflection_weight(&self, v: Vec3, l: Vec3, masking: Masking) -> f32 {
        if !(v.z > 0.0) {
            return 0.0;
        }
        let w = self.to_unit(v);
        let unclamped = v.z * self.inverse_area(w, &self.lobe.stretch(w));
        // G2 ≤ min(1, unclamped), hence at most one.
        masking.g2(unclamped.min(1.0), self.g1(l)) / unclamped
    }
}
