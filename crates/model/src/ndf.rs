//! Sampling the normal distribution function in closed form.

use core::f64::consts::PI;

use glam::DVec3;

use crate::shape::Shape;
use crate::student_t::StudentT;
use crate::visible::above_horizon;

impl Shape {
    /// The length r ∈ [0, ∞] of a unit slope at which P(R > r) = 1 − u, for u ∈ [0, 1].
    ///
    /// r² = ((1−u)^(−1/(γ−1)) − 1)/s (Ribardière et al. 2017, <https://doi.org/10.1111/cgf.13137>,
    /// eq. 16); −ln(1−u) for Beckmann. ∞ at u = 1.
    pub fn slope_radius(&self, u: f64) -> f64 {
        // expm1 keeps the digits of small radii and has the Beckmann limit.
        let e = -libm::log1p(-u);
        if self.is_beckmann() { e.sqrt() } else { (libm::expm1(self.s() * e) / self.s()).sqrt() }
    }
}

impl StudentT {
    /// A normal distributed as D(m)(m·n) from u ∈ [0, 1)² (eq. 16–17; if anisotropic eq. 19–20, in
    /// the quadrant of 2πu₂).
    pub fn sample_ndf(&self, u: [f64; 2]) -> DVec3 {
        let phi = 2.0 * PI * u[1];
        self.normal_of_slope(self.shape().slope_radius(u[0]), [libm::cos(phi), libm::sin(phi)])
    }

    /// The normal of a unit slope of length r ∈ [0, ∞] in a direction of the tangent plane.
    pub(crate) fn normal_of_slope(&self, r: f64, [cos, sin]: [f64; 2]) -> DVec3 {
        let (x, y) = (self.sigma_x() * cos, self.sigma_y() * sin);
        // At the horizon r² would overflow in the normalisation.
        let m = if r > 1e150 { DVec3::new(x, y, 1.0 / r) } else { DVec3::new(r * x, r * y, 1.0) };
        above_horizon(m)
    }
}
