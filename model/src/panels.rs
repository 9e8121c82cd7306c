//! Gauss–Legendre quadrature on graded panels.

use microfacet_common::fill_gauss_legendre;

/// Nodes and weights of a Gauss–Legendre rule on [0, 1].
#[derive(Clone, Debug)]
pub(crate) struct Gauss {
    /// (node, weight), ascending; the weights sum to 1.
    pub(crate) points: Vec<(f64, f64)>,
}

impl Gauss {
    /// The rule with n ≥ 1 points, without error for polynomials up to degree 2n−1.
    pub(crate) fn new(n: usize) -> Self {
        let mut points = vec![(0.0, 0.0); n];
        fill_gauss_legendre(&mut points);
        Self { points }
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
    /// end ± scale·sinh τ, in which the integrand is regular.
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
            let t = libm::asinh(reach / end.scale);
            // Panels grow by e² from one to the next.
            let panels = libm::ceil(0.5 * t);
            self.uniform(0.0, t, panels, |tau, weight| {
                let e = libm::exp(tau);
                let (sinh, cosh) = (0.5 * (e - 1.0 / e), 0.5 * (e + 1.0 / e));
                add(end.at + sign * end.scale * sinh, end.scale * cosh * weight);
            });
            if sign > 0.0 { from += reach } else { to -= reach }
        }
        // A remainder as small as a rounding error gets no panel.
        if to - from > 1e-9 * length {
            self.uniform(from, to, libm::ceil((to - from) / width), &mut add);
        }
    }

    fn uniform(&self, low: f64, high: f64, panels: f64, mut add: impl FnMut(f64, f64)) {
        let width = (high - low) / panels;
        for panel in 0..panels as usize {
            for &(x, w) in &self.points {
                add(low + width * (panel as f64 + x), width * w);
            }
        }
    }
}
