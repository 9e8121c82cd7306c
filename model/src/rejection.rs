//! An exact sampler of visible normals without tables: pseudo-visible normals plus an excess.
//!
//! For slopes that are centrally symmetric, visible normals = G1 · (flipped NDF) + (1 − G1) · (excess). The flipped NDF draws
//! a slope from the NDF and turns it towards the viewer where it must be; the excess beyond the silhouette has a density ∝ (x − z) p(x),
//! drawn by rejection from the closed-form ∝ x p(x). It is what tables are tested against; its price is a variable
//! number of random numbers.

use core::f64::consts::PI;

use glam::DVec3;

use crate::shape::Shape;
use crate::student_t::StudentT;

impl StudentT {
    /// Draws a visible normal, taking uniform numbers in [0, 1) from `uniform`.
    ///
    /// 1 + (3 or more) numbers a draw; the rejection accepts 1 in 1.1–2.8. At grazing every draw is an excess draw, and so it is for a
    /// view below the horizon, which sees the microsurface from within; there the rejection accepts ever less the steeper the view.
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
        // Slopes may be infinite near γ = 3/2; scaled by the largest they are not.
        let scale = 1.0 / x.abs().max(y.abs()).max(1.0);
        let (x, y) = if scale == 0.0 {
            (
                if x.is_infinite() { x.signum() } else { 0.0 },
                if y.is_infinite() { y.signum() } else { 0.0 },
            )
        } else {
            (x * scale, y * scale)
        };
        DVec3::new(
            self.sigma_x() * (x * at.cos_phi - y * at.sin_phi),
            self.sigma_y() * (x * at.sin_phi + y * at.cos_phi),
            scale,
        )
        .normalize()
    }
}

/// A slope of the NDF, turned towards the viewer: always beyond the silhouette, with probability (1 + |x|/z)/2 within.
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
