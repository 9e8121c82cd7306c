//! Gauss–Legendre quadrature on graded panels.

use std::sync::LazyLock;

use microfacet_core::fill_gauss_legendre;

/// Width of a graded panel in the variable τ: panels grow by e² from one to the next.
const STEP: f64 = 2.0;
/// Most graded panels at an end: their scale is 5e-14 of the interval.
const MOST: usize = 16;

/// sinh τ at the ends of graded panels: how far k of them reach, in units of the scale.
static REACHES: LazyLock<[f64; MOST]> =
    LazyLock::new(|| core::array::from_fn(|k| libm::sinh(STEP * (k + 1) as f64)));

/// Nodes and weights of a Gauss–Legendre rule on [0, 1].
#[derive(Clone, Debug)]
pub(crate) struct Gauss {
    /// (node, weight), ascending; the weights sum to 1.
    points: Vec<(f64, f64)>,
    /// (node, weight) on k = 1, 2, … panels that shrink towards 0: the rule on each panel of
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

/// An end of an interval of integration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub(crate) at: f64,
    /// Distance from the end within which the integrand varies quickly; ∞ if it does not.
    pub(crate) scale: f64,
}

impl End {
    pub(crate) const fn plain(at: f64) -> Self {
        Self { at, scale: f64::INFINITY }
    }
}

impl Gauss {
    /// Calls `add(node, weight)` over [low.at, high.at] with panels no wider than `width`. Panels
    /// shrink geometrically towards an end whose scale is less than `width`: there the variable is
    /// end ± scale·sinh τ, in which the integrand is regular. The scale is reduced to one at which
    /// the range of τ is a whole number of panels.
    #[inline]
    pub(crate) fn graded(&self, low: End, high: End, width: f64, mut add: impl FnMut(f64, f64)) {
        let length = high.at - low.at;
        if length <= 0.0 {
            return;
        }
        let graded = |end: &End| end.scale < width;
        let share = if graded(&low) && graded(&high) { 0.5 } else { 1.0 };
        let reach = (share * length).min(width);
        let from = if graded(&low) { low.at + reach } else { low.at };
        let to = if graded(&high) { high.at - reach } else { high.at };
        // A remainder as small as a rounding error gets no panel.
        let even = if to - from > 1e-9 * length { libm::ceil((to - from) / width) } else { 0.0 };
        let step = (to - from) / even;
        for part in 0..2 + even as usize {
            let (start, step, points) = match part {
                0 if graded(&low) => (low.at, reach, self.towards(reach / low.scale)),
                1 if graded(&high) => (high.at, -reach, self.towards(reach / high.scale)),
                0 | 1 => continue,
                _ => (from + step * (part - 2) as f64, step, &self.points),
            };
            for &(x, weight) in points {
                add(start + step * x, step.abs() * weight);
            }
        }
    }

    /// [`graded`](Self::graded) over the intervals between ascending stops.
    #[inline]
    pub(crate) fn between(&self, stops: &[End], width: f64, mut add: impl FnMut(f64, f64)) {
        for pair in stops.windows(2) {
            self.graded(pair[0], pair[1], width, &mut add);
        }
    }

    /// The rule on panels that shrink towards an end whose scale is 1/`ratio` of their total
    /// length.
    fn towards(&self, ratio: f64) -> &Vec<(f64, f64)> {
        let full = REACHES.partition_point(|&reach| reach <= ratio);
        &self.graded[full.min(MOST - 1)]
    }
}
