//! Any isotropic distribution as a lobe: masking and visible normals by quadrature and bisection.

use glam::DVec3;

use super::{Isotropic, Marginal, MarginalView, bisect};
use crate::distribution::MicrofacetDistribution;
use crate::visible::above_horizon;

/// The steepest slope of a normal: its square does not overflow.
const STEEPEST: f64 = 1e150;

/// An isotropic distribution outside the Student-t family as a lobe, such as GTR or a measured one.
///
/// Every function integrates D over slopes, and sampling inverts such integrals by bisection, to
/// 1e-10 of the CDFs. `microfacet-sampler` has a `Radial` of the same functions from tables, for
/// speed.
///
/// ```
/// use microfacet_model::glam::DVec3;
/// use microfacet_model::MicrofacetDistribution;
/// use microfacet_model::classic::{Gtr, Radial};
/// let paint = Gtr::new(0.2, 1.5)?; // C; gamma
/// let lobe = Radial::new(&paint);
/// assert!(lobe.g1(DVec3::new(0.6, 0.0, 0.8)) < 1.0);
/// # Ok::<(), microfacet_model::classic::ClassicError>(())
/// ```
pub struct Radial<'a> {
    distribution: &'a dyn Isotropic,
    marginal: Marginal<'a>,
}

/// The slope whose half tangent h = x/(1 + √(1+x²)) is `h`.
fn slope(h: f64) -> f64 {
    2.0 * h / ((1.0 - h) * (1.0 + h))
}

fn half_tangent(slope: f64) -> f64 {
    if slope.is_infinite() {
        1.0_f64.copysign(slope)
    } else {
        slope / (1.0 + libm::hypot(slope, 1.0))
    }
}

/// The slope in [low, high] at which `is_below` turns from true to false, bisected in its half
/// tangent, which is finite for every slope.
fn turning(low: f64, high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    let sign = |h| if is_below(slope(h)) { -1.0 } else { 1.0 };
    slope(bisect(half_tangent(low), half_tangent(high), sign))
}

impl<'a> Radial<'a> {
    /// The lobe of a distribution.
    pub fn new(distribution: &'a dyn Isotropic) -> Self {
        Self { distribution, marginal: Marginal::new(distribution) }
    }

    /// The slope marginal, in units of the median slope.
    pub fn marginal(&self) -> &Marginal<'a> {
        &self.marginal
    }

    /// Unit cotangent of a view, and the cosine and sine of its azimuth.
    fn view(&self, v: DVec3) -> (f64, [f64; 2]) {
        let across = libm::hypot(v.x, v.y);
        let azimuth = if across > 0.0 { [v.x / across, v.y / across] } else { [1.0, 0.0] };
        (v.z.max(0.0) / (self.marginal.sigma() * across), azimuth)
    }
}

impl MicrofacetDistribution for Radial<'_> {
    fn d(&self, m: DVec3) -> f64 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        self.distribution.d(libm::atan2(libm::hypot(m.x, m.y), m.z))
    }

    fn lambda(&self, v: DVec3) -> f64 {
        if !(v.z > 0.0) {
            return f64::INFINITY;
        }
        let (z, _) = self.view(v);
        if z.is_infinite() { 0.0 } else { self.marginal.beyond(z).excess / z }
    }

    fn sample_visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3 {
        let (z, [cos, sin]) = self.view(v);
        let seen = MarginalView::new(&self.marginal, z);
        let reach = self.marginal.reach();
        // From whichever end is nearer: the share there keeps its digits.
        let x = turning(-z.min(reach), reach, |x| {
            let shares = seen.shares(x);
            if u[0] <= 0.5 { shares.below < u[0] } else { shares.above > 1.0 - u[0] }
        });
        let across = self.marginal.across_at(x.abs());
        let tail = u[1].min(1.0 - u[1]);
        let y = turning(0.0, reach, |y| across.tail(y) > tail);
        let y = if u[1] < 0.5 { -y } else { y };
        // Random numbers 0 and 1 give infinite slopes, whose ratio would be NaN.
        let [x, y] = [x, y].map(|slope| (self.marginal.sigma() * slope).clamp(-STEEPEST, STEEPEST));
        above_horizon(DVec3::new(x * cos - y * sin, x * sin + y * cos, 1.0))
    }

    fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64 {
        let facing = v.dot(m);
        if !(v.z > 0.0 && facing > 0.0) {
            return 0.0;
        }
        let (z, _) = self.view(v);
        let length = libm::hypot(self.marginal.sigma() * libm::hypot(v.x, v.y), v.z);
        facing * self.d(m) / (MarginalView::new(&self.marginal, z).area() * length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::StudentT;
    use crate::classic::{Gtr, Member, Schlick};

    fn views() -> impl Iterator<Item = DVec3> {
        [0.0_f64, 0.4, 1.2, 1.5].into_iter().map(|theta| {
            let (sin, cos) = libm::sincos(theta);
            DVec3::new(sin * 0.6, sin * 0.8, cos)
        })
    }

    #[test]
    fn ggx_is_that_of_the_family() {
        let member = Member::trowbridge_reitz(0.3).unwrap();
        let (radial, ggx) = (Radial::new(&member), StudentT::ggx(0.3).unwrap());
        for v in views() {
            assert!((radial.lambda(v) - ggx.lambda(v)).abs() < 1e-11);
            for u in [[0.1, 0.7], [0.5, 0.2], [0.9, 0.5]] {
                let ((got, pdf), (want, exact)) =
                    (radial.sample_with_pdf(v, u), ggx.sample_with_pdf(v, u));
                assert!((got - want).length() < 1e-9, "{v} {u:?}: {got} {want}");
                assert!((pdf / exact - 1.0).abs() < 1e-8, "{v} {u:?}: {pdf} {exact}");
            }
        }
    }

    #[test]
    fn the_ends_of_random_numbers_give_normals() {
        let (gtr, schlick) = (Gtr::new(0.2, 1.05).unwrap(), Schlick::new(0.3).unwrap());
        for d in [&gtr as &dyn Isotropic, &schlick] {
            let lobe = Radial::new(d);
            for v in views().chain([DVec3::X, DVec3::new(0.8, 0.0, -0.6)]) {
                for u in [0.0, 0.5, 1.0].into_iter().flat_map(|a| [[a, 0.0], [a, 0.5], [a, 1.0]]) {
                    let (m, pdf) = lobe.sample_with_pdf(v, u);
                    let sound = (m.length() - 1.0).abs() < 1e-14 && m.z > 0.0;
                    assert!(sound && (0.0..=f64::MAX).contains(&pdf), "{v} {u:?}: {m} {pdf}");
                }
            }
        }
    }

    #[test]
    fn normals_have_the_shares_that_were_asked_for() {
        let (gtr, schlick) = (Gtr::new(0.2, 1.5).unwrap(), Schlick::new(0.3).unwrap());
        for d in [&gtr as &dyn Isotropic, &schlick] {
            let lobe = Radial::new(d);
            for v in views() {
                for u in [[0.1, 0.7], [0.8, 0.1]] {
                    let m = lobe.sample_visible_normal(v, u);
                    let (z, [cos, sin]) = lobe.view(v);
                    let scale = 1.0 / (m.z * lobe.marginal.sigma());
                    let x = (m.x * cos + m.y * sin) * scale;
                    let y = (m.y * cos - m.x * sin) * scale;
                    let below = MarginalView::new(&lobe.marginal, z).shares(x).below;
                    let tail = lobe.marginal.across_at(x.abs()).tail(y.abs());
                    let across = if y < 0.0 { tail } else { 1.0 - tail };
                    assert!((below - u[0]).abs() < 1e-10, "{v} {u:?}: {below}");
                    assert!((across - u[1]).abs() < 1e-10, "{v} {u:?}: {across}");
                }
            }
        }
    }
}
