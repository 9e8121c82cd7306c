//! The matrix of the lobe of an ellipsoid.

use core::fmt;

use crate::Roughness;

/// Below this ratio a matrix is taken for singular: half of the digits of a double would be lost in
/// its inverse. The mean slope of a lobe is at most the reciprocal.
const SINGULAR: f64 = 1e-8;

/// The matrix U of an ellipsoid, lower triangular: ((p, 0, 0), (q, r, 0), (x, y, 1)).
///
/// U maps directions by v ↦ Uv and normals by m ↦ U⁻ᵀm into unit space, where the lobe is an
/// isotropic Student-t of roughness 1 about Un. A rotation on the left of U and a positive factor
/// leave the lobe unchanged, so every regular U can be made lower triangular, with p, r > 0. The
/// slopes of the surface are those of the Student-t times the 2×2 matrix of p, q and r, minus (x,
/// y).
///
/// For γ = 2, U is the matrix A of the Ellipsoid NDF (Walter, Dong, Marschner, Greenberg 2015, *The
/// Ellipsoid Normal Distribution Function*, supplemental material of
/// <https://doi.org/10.1145/2815618>).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skew {
    /// U₁₁ > 0.
    pub p: f64,
    /// U₂₁.
    pub q: f64,
    /// U₂₂ > 0.
    pub r: f64,
    /// U₃₁: minus the mean slope along x.
    pub x: f64,
    /// U₃₂: minus the mean slope along y.
    pub y: f64,
}

/// Why a matrix makes no ellipsoid.
#[derive(Clone, Copy, PartialEq)]
pub enum SkewError {
    /// σ does not lie in (0, ∞); the value.
    Sigma(f64),
    /// An angle or a matrix entry is infinite or NaN; the value.
    NotFinite(f64),
    /// The columns are linearly dependent; the length of what is independent in a column, relative
    /// to the column, or of the last column relative to the largest entry.
    Singular(f64),
    /// The macro normal lies almost in the silhouette: the mean normal is tilted by more than
    /// atan(1e8) from it; the tangent of the tilt.
    Silhouette(f64),
}

impl fmt::Display for SkewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sigma(x) => {
                write!(f, "sigma = {x}: the roughness of an ellipsoid must lie in (0, inf)")
            }
            Self::NotFinite(x) => write!(
                f,
                "{x}: the angles (radians) and matrix entries of an ellipsoid must be finite"
            ),
            Self::Singular(ratio) => write!(
                f,
                "the ellipsoid's matrix is singular to a ratio of {ratio:e}; its columns must span \
                 space with a ratio above {SINGULAR:e}"
            ),
            Self::Silhouette(tilt) => write!(
                f,
                "the ellipsoid is tilted until the macro normal is almost in its silhouette (mean \
                 slope {tilt:e}, at most {:e}); turn it less",
                1.0 / SINGULAR
            ),
        }
    }
}

crate::debug_in_words!(SkewError);

impl core::error::Error for SkewError {}

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Vector) -> f64 {
    libm::sqrt(dot(a, a))
}

/// Unit vector and length; both are zero for the zero vector.
fn direction(a: Vector) -> (Vector, f64) {
    let length = length(a);
    (if length > 0.0 { a.map(|x| x / length) } else { [0.0; 3] }, length)
}

/// a − f b.
fn less(a: Vector, f: f64, b: Vector) -> Vector {
    core::array::from_fn(|i| a[i] - f * b[i])
}

impl Skew {
    /// U = diag(σx, σy, 1)·Rx·Ry·Rz, from the roughness along two axes of the ellipsoid and its
    /// rotation: a direction is turned by θz about z first, then by θy about y, then by θx about x
    /// (right-handed, radians).
    ///
    /// θz is the direction of anisotropy; θx and θy tilt the lobe away from n.
    ///
    /// # Errors
    /// [`SkewError`].
    pub fn new(sigma: impl Into<Roughness>, theta: [f64; 3]) -> Result<Self, SkewError> {
        let sigma = sigma.into().positive().map_err(SkewError::Sigma)?;
        if let Some(angle) = theta.into_iter().find(|x| !x.is_finite()) {
            return Err(SkewError::NotFinite(angle));
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

    /// Uv: the direction `v` in unit space, not normalised. Its third component is negative where
    /// `v` is below the lobe's own horizon.
    pub fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        let Self { p, q, r, x, y } = *self;
        [p * v[0], q * v[0] + r * v[1], x * v[0] + y * v[1] + v[2]]
    }

    /// From the rows of U.
    ///
    /// # Errors
    /// [`SkewError`] if an entry is not finite, U is singular, or n is almost in the silhouette.
    pub fn from_matrix(u: [[f64; 3]; 3]) -> Result<Self, SkewError> {
        let entries = u.as_flattened();
        if let Some(x) = entries.iter().find(|x| !x.is_finite()) {
            return Err(SkewError::NotFinite(*x));
        }
        let largest = entries.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest == 0.0 {
            return Err(SkewError::Singular(0.0));
        }
        // Gram–Schmidt from the last column: U = QL with a rotation or reflection Q, which does not
        // change the lobe. The largest entry is divided out, so that no square overflows.
        let [c1, c2, c3] = [0, 1, 2].map(|j| [0, 1, 2].map(|i| u[i][j] / largest));
        let (q3, l33) = direction(c3);
        let l32 = dot(q3, c2);
        let (q2, l22) = direction(less(c2, l32, q3));
        let (l31, l21) = (dot(q3, c1), dot(q2, c1));
        let l11 = length(less(less(c1, l31, q3), l21, q2));
        for (part, whole) in [(l33, 1.0), (l22, length(c2)), (l11, length(c1))] {
            if !(part > SINGULAR * whole) {
                return Err(SkewError::Singular(if whole > 0.0 { part / whole } else { 0.0 }));
            }
        }
        let tilt = libm::hypot(l31, l32) / l33;
        if !(tilt < 1.0 / SINGULAR) {
            return Err(SkewError::Silhouette(tilt));
        }
        let [p, q, r, x, y] = [l11, l21, l22, l31, l32].map(|entry| entry / l33);
        Ok(Self { p, q, r, x, y })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_untilted_ellipsoid_is_its_roughness() {
        let Skew { p, q, r, x, y } = Skew::new([0.3, 0.7], [0.0; 3]).unwrap();
        assert!((p - 0.3).abs() < 1e-16 && (r - 0.7).abs() < 1e-16 && [q, x, y] == [0.0; 3]);
    }

    #[test]
    fn a_rotation_on_the_left_and_a_factor_change_nothing() {
        let a = Skew::new([0.3, 0.7], [0.4, -0.2, 1.1]).unwrap();
        let rows = [[a.p, 0.0, 0.0], [a.q, a.r, 0.0], [a.x, a.y, 1.0]];
        let (sin, cos) = libm::sincos(0.8);
        let turned = [
            [0, 1, 2].map(|j| 5.0 * (cos * rows[0][j] - sin * rows[2][j])),
            rows[1].map(|x| 5.0 * x),
            [0, 1, 2].map(|j| 5.0 * (sin * rows[0][j] + cos * rows[2][j])),
        ];
        let b = Skew::from_matrix(turned).unwrap();
        for (x, y) in [(a.p, b.p), (a.q, b.q), (a.r, b.r), (a.x, b.x), (a.y, b.y)] {
            assert!((x - y).abs() < 1e-14, "{a:?} {b:?}");
        }
    }

    #[test]
    fn what_is_no_ellipsoid_is_refused() {
        assert_eq!(Skew::new([0.0, 1.0], [0.0; 3]), Err(SkewError::Sigma(0.0)));
        let turned = Skew::new(0.1, [f64::INFINITY, 0.0, 0.0]);
        assert_eq!(turned, Err(SkewError::NotFinite(f64::INFINITY)));
        assert!(matches!(Skew::from_matrix([[f64::NAN; 3]; 3]), Err(SkewError::NotFinite(_))));
        assert_eq!(Skew::from_matrix([[0.0; 3]; 3]), Err(SkewError::Singular(0.0)));
        let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert!(matches!(Skew::from_matrix(flat), Err(SkewError::Singular(_))));
        let edge = Skew::new(1e-9, [0.5 * core::f64::consts::PI - 1e-9, 0.0, 0.0]);
        assert!(matches!(edge, Err(SkewError::Silhouette(_) | SkewError::Singular(_))));
    }
}
