//! The sampler of visible normals by rejection, without tables: flipped normals plus an excess.
//!
//! For centrally symmetric slopes, visible normals = G1 · (flipped NDF) + (1 − G1) · (excess). The
//! flipped NDF is a slope of the NDF, turned towards the viewer as often as visibility requires.
//! The excess beyond the silhouette has a density ∝ (x − z) p(x), drawn by rejection from ∝ x p(x),
//! whose CDF inverts in closed form. Tables are tested against this sampler; it takes a variable
//! number of random numbers.

use core::f64::consts::PI;

use glam::DVec3;

use crate::shape::Shape;
use crate::student_t::StudentT;
use crate::visible::above_horizon;

impl StudentT {
    /// Draws a visible normal by rejection, for any view; `uniform` gives uniform numbers in
    /// [0, 1).
    ///
    /// A draw takes 1 + (3 or more) numbers; the rejection accepts 1 in 1.1–2.8. Every draw is an
    /// excess draw at grazing and for views below the horizon, which see the microsurface from
    /// within; for those the acceptance falls as the view gets steeper.
    pub fn sample_visible_by_rejection(
        &self,
        v: DVec3,
        uniform: &mut impl FnMut() -> f64,
    ) -> DVec3 {
        let at = self.stretch(DVec3::new(v.x, v.y, v.z.abs()));
        let (shape, z) = (self.shape(), at.view.cotangent());
        let lambda = if z.is_infinite() { 0.0 } else { shape.lambda(shape.asinh_slope(z)) };
        let (x, y) = if uniform() * (1.0 + lambda) < 1.0 && v.z >= 0.0 {
            flipped_slope(shape, z, uniform)
        } else {
            excess_slope(shape, z, uniform)
        };
        // Slopes may be infinite near γ = 3/2; scaling by the largest keeps the normal finite.
        let scale = 1.0 / x.abs().max(y.abs()).max(1.0);
        let at_infinity = |slope: f64| if slope.is_infinite() { slope.signum() } else { 0.0 };
        let [x, y] =
            [x, y].map(|slope| if scale == 0.0 { at_infinity(slope) } else { slope * scale });
        above_horizon(DVec3::new(
            self.sigma_x() * (x * at.cos_phi - y * at.sin_phi),
            self.sigma_y() * (x * at.sin_phi + y * at.cos_phi),
            scale,
        ))
    }
}

/// A slope of the NDF turned towards the viewer: always if beyond the silhouette, with probability
/// (1 + |x|/z)/2 if within it.
///
/// These are [pseudo-visible](crate::pseudo) slopes. A number of its own for the side takes less
/// time than the equation that draws the same from two.
fn flipped_slope(shape: &Shape, z: f64, uniform: &mut impl FnMut() -> f64) -> (f64, f64) {
    let r = shape.slope_radius(uniform());
    let phi = 2.0 * PI * uniform();
    let (x, y) = (r * libm::cos(phi), r * libm::sin(phi));
    let towards = x.abs();
    if towards > z || uniform() < 0.5 * (1.0 + towards / z) { (towards, y) } else { (-towards, y) }
}

/// A slope beyond the silhouette, x > z with density ∝ (x − z) p(x), and the slope across given x.
fn excess_slope(shape: &Shape, z: f64, uniform: &mut impl FnMut() -> f64) -> (f64, f64) {
    let s = shape.s();
    let x = loop {
        // ∝ x p(x) beyond z: survival ((1 + s x²)/(1 + s z²))^(−k).
        let e = -libm::log1p(-uniform());
        let x = if shape.is_beckmann() {
            (z * z + e).sqrt()
        } else {
            let grow = libm::expm1(e / (shape.gamma() - 1.5));
            (z * z + (1.0 / s + z * z) * grow).sqrt()
        };
        if uniform() * x >= z {
            break x;
        }
    };
    // t has density ∝ (1 + s t²)^(−γ): Bailey's polar form for Student's t.
    let e = -libm::log1p(-uniform());
    let exponent = 1.0 / (shape.gamma() - 0.5);
    let radius =
        if shape.is_beckmann() { e.sqrt() } else { (libm::expm1(e * exponent) / s).sqrt() };
    let t = radius * libm::cos(2.0 * PI * uniform());
    (x, if t == 0.0 { 0.0 } else { (1.0 + s * x * x).sqrt() * t })
}
