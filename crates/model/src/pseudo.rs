//! Pseudo-visible normals: normals of D, brought to the viewer's side as often as visibility asks.
//!
//! In unit space let x be the slope towards the viewer and z the cotangent of the view. A slope of
//! the NDF with |x| > z is put on the viewer's side; one with |x| ≤ z with probability
//! (1 + |x|/z)/2. As x ↦ −x is a symmetry of the NDF, what is drawn has the density
//! p(x, y) min((1 + x/z)⁺, 2), the visible normals' without G1 as far as x ≤ z:
//!
//! visible = G1 · pseudo-visible + (1 − G1) · excess, the excess on x > z with density ∝ (x − z) p.
//!
//! The side needs no number of its own. At the radius r the azimuth φ from the viewer has the
//! density min((1 + e cos φ)⁺, 2)/2π with e = r/z, whose CDF is Kepler's equation of eccentricity
//! e; one number inverts it, continuously, so that stratified numbers give stratified normals.
//!
//! Ribardière et al. 2017 (<https://doi.org/10.1111/cgf.13137>), section 5, name such a procedure;
//! the decomposition is that of [`rejection`](crate::StudentT::sample_visible_by_rejection).

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_core::saturated;

use crate::distribution::MicrofacetDistribution;
use crate::student_t::StudentT;

/// Eccentricities beyond this one are as good as infinite.
const FLATTEST: f64 = 1e18;

impl StudentT {
    /// A pseudo-visible normal at u ∈ [0, 1]², of the density
    /// [`pseudo_visible_normal_pdf`](Self::pseudo_visible_normal_pdf).
    ///
    /// `u[0]` inverts the CDF of the slope's length (eq. 16) and `u[1]` that of its azimuth in unit
    /// space, from the direction away from the viewer once round. A view below the horizon is moved
    /// to the horizon. At normal incidence the normals are those of D.
    pub fn sample_pseudo_visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let at = self.stretch(v.with_z(v.z.max(0.0)));
        let (r, z) = (self.shape().slope_radius(u[0]), at.view.cotangent());
        let e = if z.is_infinite() { 0.0 } else { r / z.max(f64::MIN_POSITIVE) };
        let [x, y] = azimuth(e.min(FLATTEST), u[1]);
        let turned = [x * at.cos_phi - y * at.sin_phi, x * at.sin_phi + y * at.cos_phi];
        self.normal_of_slope(r, turned)
    }

    /// The density of pseudo-visible normals, D(m) min((v·m)⁺/(v·n), 2 m·n).
    ///
    /// It integrates to 1 over all m, for every view; one below the horizon counts as on it. Where
    /// v·m ≤ 2 (v·n)(m·n) it is the density of visible normals over G1(v), elsewhere less.
    pub fn pseudo_visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let v = v.with_z(v.z.max(0.0));
        let (facing, twice) = (v.dot(m), 2.0 * m.z);
        if !(facing > 0.0 && m.z > 0.0) {
            return 0.0;
        }
        let factor = if facing < twice * v.z { facing / v.z } else { twice };
        saturated(factor * self.d(m))
    }
}

/// The cosine, towards the viewer, and the sine of the azimuth φ at which the CDF of
/// min((1 + e cos φ)⁺, 2)/2π is u, from φ = −π at u = 0 to π at u = 1.
///
/// The numbers of φ and π − φ add up to ½, so that next to the viewer the azimuth is linear in u
/// (where e cos φ > 1). Elsewhere, from the azimuth E₀ = arccos min(1, 1/e) off the direction away
/// from the viewer, where the density rises from 0, or from E₀ = 0, the equation for ε = E − E₀ is
/// ε − a sin ε + g (1 − cos ε) = 2πu with a = min(1, e) and g = √(e² − 1) or 0. It is solved by
/// Laguerre's iteration as for a cubic, after one, two and three steps of which 2πu is met within
/// 4e-3, 4e-8 and 1e-14.
fn azimuth(e: f64, u: f64) -> [f64; 2] {
    const STEPS: usize = 3;
    let side = if u < 0.5 { -1.0 } else { 1.0 };
    let number = 2.0 * PI * u.min(1.0 - u);
    let (sin, cos) = libm::sincos(0.5 * number);
    if e * sin >= 1.0 {
        return [sin, side * cos];
    }
    let (a, g) = (e.min(1.0), ((e - 1.0).max(0.0) * (e + 1.0)).sqrt());
    // The solution of (1−a) ε + h ε²/2, and not more than the tangent at ε = π allows.
    let (b, h) = (1.0 - a, g + 0.25 * a);
    let first = 2.0 * number / (b + (b * b + 2.0 * h * number).sqrt()).max(f64::MIN_POSITIVE);
    let mut epsilon = first.min((number + a * PI) / (1.0 + a));
    for _ in 0..STEPS {
        let (half_sin, half_cos) = libm::sincos(0.5 * epsilon);
        let (sin, versine) = (2.0 * half_sin * half_cos, 2.0 * half_sin * half_sin);
        let excess = epsilon - a * sin + g * versine - number;
        let rise = b + a * versine + g * sin;
        let bend = a * sin + g * (1.0 - versine);
        let root = (4.0 * rise * rise - 6.0 * excess * bend).abs().sqrt();
        epsilon = (epsilon - 3.0 * excess / (rise + root).max(f64::MIN_POSITIVE)).clamp(0.0, PI);
    }
    let (sin, cos) = libm::sincos(epsilon);
    let cos_0 = (1.0 / e).min(1.0);
    let sin_0 = ((1.0 - cos_0) * (1.0 + cos_0)).sqrt();
    [sin_0 * sin - cos_0 * cos, side * (sin_0 * cos + cos_0 * sin)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eccentricities from a circle through the parabola at 1 to a straight line.
    fn eccentricities() -> impl Iterator<Item = f64> {
        let near_1 = (0..=40).map(|i| 0.98 + 0.001 * f64::from(i));
        let wide = (0..=240).map(|i| libm::exp10(0.05 * f64::from(i) - 4.0));
        near_1.chain(wide).chain([0.0, FLATTEST])
    }

    #[test]
    fn azimuths_solve_keplers_equation() {
        let mut worst = 0.0_f64;
        for e in eccentricities() {
            let mut last = -PI;
            for i in 0..=2000 {
                // From 0 to 1, denser at both ends.
                let t = f64::from(i) / 2000.0;
                let u = t * t * t * (10.0 - t * (15.0 - 6.0 * t));
                let [cos, sin] = azimuth(e, u);
                assert!((cos * cos + sin * sin - 1.0).abs() < 1e-14, "{e} {u}");
                // From its ends in −x: where e is large the CDF rises within 1/e of the side.
                let phi = libm::atan2(sin, cos);
                assert!(phi >= last - 1e-14 || i == 0, "{e} {u}: {phi} after {last}");
                last = phi;
                let number = 2.0 * PI * u.min(1.0 - u);
                worst = worst.max((area(e, PI - phi.abs()) - number).abs());
            }
        }
        assert!(worst < 1e-13, "{worst:e}");
    }

    /// ∫ min((1 − e cos t)⁺, 2) dt from 0 to E ∈ [0, π].
    fn area(e: f64, angle: f64) -> f64 {
        let start = libm::acos((1.0 / e).min(1.0));
        let sines = |to: f64| {
            // sin to − sin start, without cancellation.
            2.0 * libm::cos(0.5 * (to + start)) * libm::sin(0.5 * (to - start))
        };
        let part = |to: f64| (to - start) - e * sines(to);
        let end = angle.clamp(start, PI - start);
        part(end) + 2.0 * (angle - (PI - start)).max(0.0)
    }
}
