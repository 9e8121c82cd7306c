//! Visible normals of the Ellipsoid NDF (γ = 2) by the three samplers of Walter et al. 2015, as
//! references and for comparison.
//!
//! At γ = 2 the lobe in unit space is a hemisphere of equal weight everywhere. The visible normals
//! are the points of it that a view sees, uniform when projected onto the plane perpendicular to
//! the view. The silhouette in that plane is half a disc and half an ellipse with half-axes 1 and
//! |cos θ|.

use core::f64::consts::PI;

use glam::DVec3;

use crate::ellipsoid::{self, Ellipsoid, View};

/// The samplers of visible normals that an [`Ellipsoid`] has for γ = 2 only, from
/// [`Ellipsoid::lune`] (Walter et al. 2015, supplemental material of
/// <https://doi.org/10.1145/2815618>).
#[derive(Clone, Copy, Debug)]
pub struct Lune<'a> {
    ellipsoid: &'a Ellipsoid,
}

impl Ellipsoid {
    /// The samplers for γ = 2; `None` for other shapes.
    pub fn lune(&self) -> Option<Lune<'_>> {
        (self.shape().gamma() == 2.0).then_some(Lune { ellipsoid: self })
    }
}

impl Lune<'_> {
    /// A visible normal by version 1, bounding sphere: visible points of the whole sphere are drawn
    /// until one is above the horizon of n.
    ///
    /// Accepts (1 + cos θ)/2 of the draws, θ being the angle between view and n in unit space: few
    /// when the lobe leans away from the view.
    pub fn sample_sphere(&self, v: DVec3, uniform: &mut impl FnMut() -> f64) -> DVec3 {
        let (view, frame) = Frame::of(self.ellipsoid, v);
        loop {
            let (r, phi) = (uniform().sqrt(), 2.0 * PI * uniform());
            let m = frame.point(r * libm::cos(phi), r * libm::sin(phi));
            if m.z > 0.0 {
                return self.finish(&view, m);
            }
        }
    }

    /// A visible normal by version 2, silhouette: points of the rectangle around the silhouette are
    /// drawn until one is inside it.
    ///
    /// Accepts π/4 of the draws for views above the lobe's horizon, π/4·(1 + cos θ) for views below
    /// it.
    pub fn sample_silhouette(&self, v: DVec3, uniform: &mut impl FnMut() -> f64) -> DVec3 {
        let (view, frame) = Frame::of(self.ellipsoid, v);
        loop {
            // Down to the ellipse's lower rim; for a view from below, a crescent remains whose tips
            // lie at 0.
            let up = 1.0 - uniform() * (1.0 + frame.cos.max(0.0));
            let side = 2.0 * uniform() - 1.0;
            let reach = (1.0 - side * side).max(0.0).sqrt();
            if up < reach && up > -frame.cos * reach {
                return self.finish(&view, frame.point(up, side));
            }
        }
    }

    /// A visible normal by version 3, lune: a point of the disc squeezed onto the silhouette column
    /// by column. u ∈ [0, 1]²; two random numbers make one normal.
    pub fn sample_lune(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let (view, frame) = Frame::of(self.ellipsoid, v);
        let (r, phi) = (u[0].sqrt(), 2.0 * PI * u[1]);
        let (side, up) = (r * libm::cos(phi), r * libm::sin(phi));
        let reach = (1.0 - side * side).max(0.0).sqrt();
        // [−reach, reach] onto [−cos θ reach, reach], which keeps areas in proportion.
        let up = reach - 0.5 * (1.0 + frame.cos) * (reach - up);
        self.finish(&view, frame.point(up, side))
    }

    /// The random numbers at which [`sample_lune`](Self::sample_lune) gives m: uniform on [0, 1]²
    /// for visible normals.
    pub fn invert_lune(&self, v: DVec3, m: DVec3) -> [f64; 2] {
        let (view, frame) = Frame::of(self.ellipsoid, v);
        let m = ellipsoid::turn(self.ellipsoid.normal_to_unit(m), view.cos_phi, -view.sin_phi)
            .normalize();
        let (up, side) = (m.z * frame.sin - m.x * frame.cos, m.y);
        let reach = (1.0 - side * side).max(0.0).sqrt();
        let up = reach - 2.0 * (reach - up) / (1.0 + frame.cos);
        let phi = libm::atan2(up, side) / (2.0 * PI);
        [(up * up + side * side).min(1.0), if phi < 0.0 { phi + 1.0 } else { phi }]
    }

    fn finish(&self, view: &View, m: DVec3) -> DVec3 {
        // The rim of the lune is the horizon itself; rounding may put a point below it.
        let m = DVec3::new(m.x, m.y, m.z.max(0.0));
        self.ellipsoid.normal_from_unit(ellipsoid::turn(m, view.cos_phi, view.sin_phi))
    }
}

/// The plane perpendicular to the view in unit space, in a frame where the view has azimuth 0.
struct Frame {
    sin: f64,
    cos: f64,
}

impl Frame {
    fn of(ellipsoid: &Ellipsoid, v: DVec3) -> (View, Self) {
        let view = ellipsoid.view(v);
        let length = libm::hypot(view.across, view.up);
        (view, Self { sin: view.across / length, cos: view.up / length })
    }

    /// The point of the sphere that projects to (up, side); up is along the projection of n.
    fn point(&self, up: f64, side: f64) -> DVec3 {
        let towards = (1.0 - up * up - side * side).max(0.0).sqrt();
        DVec3::new(towards * self.sin - up * self.cos, side, towards * self.cos + up * self.sin)
    }
}
