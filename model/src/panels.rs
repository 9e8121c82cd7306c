//! Gauss–Legendre quadrature on graded panels.

use microfacet_common::fill_gauss_legendre;

/// Width of a graded panel in the variable τ: panels grow by e² from one to the next.
const STEP: f64 = 2.0;
/// Most graded panels at an end: their scale is 5e-14 of the interval.
const MOST: usize = 16;

/// Nodes and weights of a Gauss–Legendre rule on [0, 1].
#[derive(Clone, Debug)]
pub(crate) struct Gauss {
    /// (node, weight), ascending; the weights sum to 1.
    points: Vec<(f64, f64)>,
    /// The same for k = 1, 2, … panels that shrink towards 0: the rule on each panel of
    /// τ ∈ [0, 2k], with nodes at sinh τ/sinh 2k.
    graded: Vec<Vec<(f64, f64)>>,
}

impl Gauss {
    /// The rule with n ≥ 1 points, without error for polynomials up to degree 2n−1.
    pub(crate) fn new(n: usize) -> Self {
        let mut points = vec![(0.0, 0.0); n];
        fill_gauss_legendre(&mut points);
        let panels = |k: usize| -> Vec<(f64, f64)> {
            let reach = libm::sinh(STEP * k as f64);
            let point = |panel: usize, (x, weight): (f64, f64)| {
                let tau = STEP * (panel as f64 + x);
                (libm::sinh(tau) / reach, STEP * libm::cosh(tau) * weight / reach)
            };
            (0..k).flat_map(|panel| points.iter().map(move |&at| point(panel, at))).collect()
        };
        Self { graded: (1..=MOST).map(panels).collect(), points }
    }
}

/// An end of an interval of integration, and the distance from it within which the integrand varies
/// quickly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub(crate) at: f64,
    /// That distance; ∞ where nothing varies quickly.
    pub(crate) scale: f64,
}

impl Gauss {
    /// Calls `add(node, weight)` over [low.at, high.at] with panels no wider than `width`. Panels
    /// shrink geometrically towards an end whose scale is less than `width`: there the variable is
    /// end ± scale·sinh τ, in which the integrand is regular, with a scale no larger than asked for
    /// at which τ ends with a panel.
    #[inline]
    pub(crate) fn graded(&self, low: End, high: End, width: f64, mut add: impl FnMut(f64, f64)) {
        let length = high.at - low.at;
        if length <= 0.0 {
            return;
        }
        let graded = |end: &End| end.scale < width;
        let share = if graded(&low) && graded(&high) { 0.5 } else { 1.0 };
        let reach = (share * length).min(width);
        let (mut from, mut to) = (low.at, high.at);
        for (end, sign) in [(low, 1.0), (high, -1.0)] {
            if !graded(&end) {
                continue;
            }
            let panels = libm::asinh(reach / end.scale) / STEP;
            for &(x, weight) in &self.graded[(panels as usize).min(MOST - 1)] {
                add(end.at + sign * reach * x, reach * weight);
            }
            if sign > 0.0 { from += reach } else { to -= reach }
        }
        // A remainder as small as a rounding error gets no panel.
        if to - from > 1e-9 * length {
            let panels = libm::ceil((to - from) / width);
            let width = (to - from) / panels;
            for panel in 0..panels as usize {
                for &(x, weight) in &self.points {
                    add(from + width * (panel as f64 + x), width * weight);
                }
            }
        }
    }
}
