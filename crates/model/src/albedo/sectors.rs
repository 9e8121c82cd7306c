//! The azimuths at which rays of slopes change, and the intervals between them.
//!
//! What decides whether light is reflected, refracted or neither are the view and the slope of the
//! surface alone, not σ: cones and circles in the plane of slopes that are symmetrical about the
//! azimuth of the view. So the azimuths at which rays begin to meet them are those of a round lobe,
//! counted from the view. In unit slopes, over which is integrated, they turn towards the major
//! axis of the roughness ellipse.

use core::f64::consts::{FRAC_PI_2, PI};

use super::{AlbedoIntegrator, View};
use crate::converge::{Both, add};
use crate::panels::{End, Gauss};

/// Widest panel of φ.
const SECTOR: f64 = 1.6;

impl View {
    /// The right angle to the view, where the slope towards it vanishes and R(φ) turns.
    pub(crate) fn right(&self) -> End {
        End { at: FRAC_PI_2, scale: self.turn.max(1e-9) }
    }

    /// The intervals of the azimuth of unit slopes that are integrated, from the azimuths of slopes
    /// in `half` of a turn, ascending from the side that leans away from the view (0) to the side
    /// that leans towards it (π). Nothing is integrated before the first of them.
    pub(crate) fn sectors(&self, half: &[End]) -> Vec<(End, End)> {
        if self.aspect == 1.0 {
            // Round lobes are even about the view: half a turn counts twice.
            let phi = libm::atan2(self.sin_phi, self.cos_phi);
            let at = |end: &End| End { at: phi + end.at, ..*end };
            return half.windows(2).map(|pair| (at(&pair[0]), at(&pair[1]))).collect();
        }
        // At the minor axis of the roughness ellipse its radius changes within an angle of the
        // aspect.
        let minor = if self.sigma[0] < self.sigma[1] { 0.0 } else { FRAC_PI_2 };
        let mut ends: Vec<End> =
            [minor, minor + PI].map(|at| End { at, scale: self.aspect }).into();
        for end in half {
            if 0.0 < end.at && end.at < PI {
                ends.extend([1.0, -1.0].map(|side| self.in_unit_slopes(end, side)));
            } else if end.scale < f64::INFINITY {
                ends.push(self.in_unit_slopes(end, 1.0));
            }
        }
        for end in &mut ends {
            end.at -= 2.0 * PI * libm::floor(end.at / (2.0 * PI));
        }
        ends.sort_by(|a, b| a.at.total_cmp(&b.at));
        let ends = shared(&ends);
        let again = End { at: ends[0].at + 2.0 * PI, ..ends[0] };
        let next = ends[1..].iter().chain([&again]);
        let is_lit = |(low, high): &(End, End)| {
            let (sin, cos) = libm::sincos(0.5 * (low.at + high.at));
            let (x, y) = (self.sigma[0] * cos, self.sigma[1] * sin);
            let (along, across) =
                (x * self.cos_phi + y * self.sin_phi, y * self.cos_phi - x * self.sin_phi);
            libm::atan2(libm::fabs(across), along) >= half[0].at
        };
        ends.iter().copied().zip(next.copied()).filter(is_lit).collect()
    }

    /// The azimuth of the unit slopes at an azimuth of slope, to the left or right of the view; a
    /// scale is never widened.
    fn in_unit_slopes(&self, end: &End, side: f64) -> End {
        let (sin, cos) = libm::sincos(end.at);
        let (c, s) = (
            self.cos_phi * cos - side * self.sin_phi * sin,
            self.sin_phi * cos + side * self.cos_phi * sin,
        );
        let [x, y] = [self.sigma[1] * c, self.sigma[0] * s];
        let rate = self.sigma[0] * self.sigma[1] / (x * x + y * y);
        End { at: libm::atan2(y, x), scale: end.scale * rate.min(1.0) }
    }

    /// 1/π G1(v)/cos θ times the integral over sectors of φ of the integrals along rays, which are
    /// those of half a turn for round lobes.
    pub(crate) fn over_sectors<const N: usize>(
        &self,
        rule: &Gauss,
        sectors: &[(End, End)],
        ray: impl Fn(f64) -> Both<N>,
    ) -> Both<N> {
        let fold = if self.aspect == 1.0 { 2.0 } else { 1.0 };
        let mut sum = [[0.0; N]; 2];
        for &(low, high) in sectors {
            rule.graded(low, high, SECTOR, |phi, jacobian| add(&mut sum, jacobian, &ray(phi)));
        }
        sum.map(|form| form.map(|x| x * fold * self.scale / PI))
    }
}

/// The same ends on a circle, each with the scale of its neighbours that reaches it: at a distance
/// d from an end of scale h the integrand varies within h + d.
fn shared(ends: &[End]) -> Vec<End> {
    let reach = |here: &End, there: &End| {
        let apart = libm::fabs(here.at - there.at);
        there.scale + apart.min(2.0 * PI - apart)
    };
    let scale = |end: &End| ends.iter().map(|other| reach(end, other)).fold(end.scale, f64::min);
    ends.iter().map(|end| End { at: end.at, scale: scale(end) }).collect()
}

impl AlbedoIntegrator {
    /// The azimuths of slope, on the side towards the view, from which on rays from m = n meet the
    /// cone v·m = `kink`: the right angle to the view, or else the cone's tangent, and the cone's
    /// asymptote if it has one.
    pub(crate) fn conic_ends(&self, cos: f64, sin: f64, kink: f64, right: End) -> Vec<End> {
        // Seen from m = n, the near side of the cone turns within this angle of the right angle.
        let across = (kink - cos) * (kink + cos);
        let angle = (libm::fabs(across).sqrt() / sin).min(1.0);
        let first = if across <= 0.0 {
            End { at: right.at, scale: right.scale.min(angle.max(1e-6)) }
        } else {
            // Rays meet the cone twice on one side of its tangent, and not at all on the other.
            End { at: right.at + libm::asin(angle), scale: (0.3 * angle).max(1e-6) }
        };
        if sin <= kink {
            return vec![first];
        }
        // Near this asymptote rays meet the cone ever further out, where heavy tails still have
        // mass: as the power 2γ−3 of the angle.
        let scale = libm::exp(-14.0 / (2.0 * self.shape.gamma() - 2.0));
        vec![first, End { at: right.at + libm::asin(kink / sin), scale }]
    }

    /// Where a ray meets the cone v·m = `kink`, in w, ascending: the roots of
    /// (cos θ − r b)² = kink² (1 + a r²).
    pub(crate) fn conic(
        &self,
        cos: f64,
        kink: f64,
        a: f64,
        b: f64,
        last: f64,
        scale: f64,
    ) -> Vec<End> {
        if kink == 0.0 {
            return Vec::new();
        }
        let square = kink * kink;
        let (p, q) = (b * b - square * a, b * cos);
        let rest = (cos - kink) * (cos + kink);
        let root = square * (b * b + a * rest);
        if root < 0.0 {
            return Vec::new();
        }
        // The two roots without cancellation.
        let sum = q + root.sqrt().copysign(q);
        let facing = |r: &f64| *r > 0.0 && r.is_finite() && cos - r * b > 0.0;
        let roots = [sum / p, rest / sum].into_iter().filter(facing);
        let mut ends: Vec<End> = roots
            .map(|r| End { at: self.shape.asinh_slope(r), scale })
            .filter(|end| end.at > 0.0 && end.at < last)
            .collect();
        ends.sort_by(|x, y| x.at.total_cmp(&y.at));
        ends
    }
}
