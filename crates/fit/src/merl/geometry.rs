//! Half and difference angles (Rusinkiewicz 1998, *A New Change of Variables for Efficient BRDF
//! Representation*, doi:10.1007/978-3-7091-6453-2_2) of a view and a light over an isotropic
//! surface.

use glam::DVec3;

/// The directions of a view `v` and a light `l`, up to a rotation about the macro normal `n`;
/// radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfDifference {
    /// The angle between `n` and the half vector `m`, in [0, π/2].
    pub theta_h: f64,
    /// The angle between `m` and either direction, in [0, π/2].
    pub theta_d: f64,
    /// The azimuth of `l` about `m`: 0 where `l` is tilted away from `n` in the plane of `n` and
    /// `m`. At φ_d + π view and light have changed places.
    pub phi_d: f64,
}

impl HalfDifference {
    /// `v` and `l`, unit vectors in a frame whose pole is `n`, with `m` at (sin θ_h, 0, cos θ_h).
    pub fn directions(self) -> [DVec3; 2] {
        let (sin, cos) = self.theta_d.sin_cos();
        let (sin_h, cos_h) = self.theta_h.sin_cos();
        // With m as the pole, then rotated by θ_h.
        let side = DVec3::new(sin * self.phi_d.cos(), sin * self.phi_d.sin(), 0.0);
        [-side, side].map(|side| {
            DVec3::new(cos_h * side.x + sin_h * cos, side.y, cos_h * cos - sin_h * side.x)
        })
    }

    /// v·n and l·n; negative below the horizon. Cheaper than [`directions`](Self::directions).
    ///
    /// In a frame with `m` as its pole the directions are (∓sin θ_d cos φ_d, ∓sin θ_d sin φ_d,
    /// cos θ_d), the upper sign for `v`; there `n` is (−sin θ_h, 0, cos θ_h).
    pub fn cosines(self) -> [f64; 2] {
        let pole = self.theta_h.cos() * self.theta_d.cos();
        let side = self.theta_h.sin() * self.theta_d.sin() * self.phi_d.cos();
        [pole + side, pole - side]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use glam::DMat3;

    use super::*;

    fn at(theta_h: f64, theta_d: f64, phi_d: f64) -> HalfDifference {
        HalfDifference { theta_h, theta_d, phi_d }
    }

    fn assert_near(found: [f64; 2], expected: [f64; 2]) {
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near, "{found:?}, {expected:?}");
    }

    #[test]
    fn directions_and_cosines_are_those_of_vectors_that_are_turned() {
        for theta_h in [0.0, 0.3, 1.2, FRAC_PI_2] {
            for theta_d in [0.0, 0.7, FRAC_PI_2] {
                for phi_d in [0.0, 0.4, FRAC_PI_2, 2.0, PI] {
                    let (sin, cos) = f64::sin_cos(theta_d);
                    let about_m = DVec3::new(sin * phi_d.cos(), sin * phi_d.sin(), cos);
                    let turn = DMat3::from_rotation_y(theta_h);
                    let (m, l) = (turn * DVec3::Z, turn * about_m);
                    let v = 2.0 * l.dot(m) * m - l;
                    let at = at(theta_h, theta_d, phi_d);
                    assert_near(at.cosines(), [v.z, l.z]);
                    for (found, expected) in at.directions().into_iter().zip([v, l]) {
                        assert!((found - expected).abs().max_element() < 1e-15, "{at:?}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn corners_are_what_they_are_called() {
        // The directions of a mirror, a light at the view, and directions perpendicular to the
        // plane of m and n.
        assert_near(at(0.0, 0.7, 2.0).cosines(), [0.7_f64.cos(); 2]);
        assert_near(at(0.4, 0.0, 2.0).cosines(), [0.4_f64.cos(); 2]);
        assert_near(at(0.4, 0.7, FRAC_PI_2).cosines(), [0.4_f64.cos() * 0.7_f64.cos(); 2]);
        // In the plane angles add; at φ_d + π view and light have changed places.
        assert_near(at(0.4, 0.7, 0.0).cosines(), [0.3_f64.cos(), 1.1_f64.cos()]);
        assert_near(at(0.4, 0.7, PI).cosines(), [1.1_f64.cos(), 0.3_f64.cos()]);
        // A half vector at the horizon: one direction is below it, or both are on it.
        assert_near(at(FRAC_PI_2, 0.7, 0.0).cosines(), [0.7_f64.sin(), -0.7_f64.sin()]);
        assert_near(at(FRAC_PI_2, 0.0, 0.0).cosines(), [0.0, 0.0]);
        assert_near(at(0.0, FRAC_PI_2, 0.0).cosines(), [0.0, 0.0]);
    }
}
