//! The parameters in which a reflectance is linear, the Lambert term and F0 of each channel, by
//! least absolute deviations.

use glam::DVec2;
use rayon::prelude::*;

use super::file::{DARKEST, MerlError};
use super::samples::Samples;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Linear {
    /// In 1/sr: the albedo over π.
    pub(super) lambert: f64,
    /// In [0, 1].
    pub(super) f0: f64,
}

pub(super) struct Problem<'a> {
    samples: &'a Samples,
    values: [Vec<f64>; 3],
    /// Σ measured · cos θ_l of each channel.
    measured: [f64; 3],
    /// Upper bound of the best Lambert term.
    bound: [f64; 3],
}

impl<'a> Problem<'a> {
    pub(super) fn new(samples: &'a Samples, values: [Vec<f64>; 3]) -> Self {
        let (mut measured, mut bound) = ([0.0; 3], [0.0; 3]);
        for (channel, values) in values.iter().enumerate() {
            let mut weight = 0.0;
            for (&y, &cos_l) in values.iter().zip(&samples.cos_l).filter(|(y, _)| **y >= 0.0) {
                weight += cos_l;
                measured[channel] += cos_l * y;
            }
            // The best Lambert term is a weighted median of the values less the highlight, so at
            // most the median of the values, and the median of non-negative numbers is at most
            // twice their mean. The bound is 0 for a channel without values.
            bound[channel] = 2.0 * measured[channel] / weight.max(f64::MIN_POSITIVE);
        }
        Self { samples, values, measured, bound }
    }

    /// Refuses measurements that cannot be fitted.
    pub(super) fn check(&self) -> Result<(), MerlError> {
        let missing = |values: &Vec<f64>| values.iter().all(|y| *y < 0.0);
        if let Some(channel) = self.values.iter().position(missing) {
            return Err(MerlError::Missing(channel));
        }
        // The bounds are twice the means.
        match self.bound.iter().fold(0.0, |most: f64, bound| most.max(0.5 * bound)) {
            0.0 => Err(MerlError::Black),
            mean if mean < DARKEST => Err(MerlError::Dark(mean)),
            _ => Ok(()),
        }
    }

    /// The least Σ |measured − model| cos θ_l / Σ measured cos θ_l over all channels for a specular
    /// reflectance (as [`Samples::specular`]), to within `tolerance`, and the parameters.
    pub(super) fn solve(&self, specular: &[f64], tolerance: f64) -> (f64, [Linear; 3]) {
        let total: f64 = self.measured.iter().sum();
        let mut searches = [(); 3].map(|()| Search::new());
        for _ in 0..Search::STEPS {
            let points = [0, 1, 2].map(|c| searches[c].next.map(|at| self.linear(c, at)));
            if points == [None; 3] {
                break;
            }
            for (c, (error, slope)) in self.sums(specular, points).into_iter().enumerate() {
                let slope = DVec2::new(self.bound[c] * slope.x, slope.y);
                searches[c].step(error, slope, tolerance * total / 3.0);
            }
        }
        let error: f64 = searches.iter().map(|search| search.least).sum();
        (error / total, [0, 1, 2].map(|c| self.linear(c, searches[c].best)))
    }

    fn linear(&self, channel: usize, at: DVec2) -> Linear {
        Linear { lambert: self.bound[channel] * at.x, f0: at.y }
    }

    /// The error of each channel at its parameters, with its slope along the Lambert term and F0;
    /// zero for a channel without parameters.
    fn sums(&self, specular: &[f64], points: [Option<Linear>; 3]) -> [(f64, DVec2); 3] {
        let chunk = |start: usize| {
            let range = start..(start + Samples::CHUNK).min(specular.len());
            let Samples { grazing, cos_l, .. } = self.samples;
            [0, 1, 2].map(|c| {
                points[c].map_or_else(Default::default, |linear| {
                    let columns = [&self.values[c], specular, grazing, cos_l];
                    sums(linear, columns.map(|column| &column[range.clone()]))
                })
            })
        };
        let starts: Vec<usize> = (0..specular.len()).step_by(Samples::CHUNK).collect();
        let parts: Vec<[(f64, DVec2); 3]> = starts.into_par_iter().map(chunk).collect();
        parts.into_iter().fold(Default::default(), |sum, part| {
            [0, 1, 2].map(|c| (sum[c].0 + part[c].0, sum[c].1 + part[c].1))
        })
    }
}

/// Σ |measured − model| cos θ_l, and its slopes along the Lambert term and F0, from columns of the
/// measured values, the specular reflectance, Schlick's weight and cos θ_l.
fn sums(Linear { lambert, f0 }: Linear, columns: [&[f64]; 4]) -> (f64, DVec2) {
    // Several sums, one in each lane of a SIMD register.
    const LANES: usize = 4;
    let (mut error, mut by_lambert, mut by_f0) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let mut one = |lane: usize, [y, specular, grazing, cos_l]: [f64; 4]| {
        // Schlick's F0 + (1 − F0) w, as (1 − w) F0 + w.
        let steady = specular * grazing;
        let rate = specular - steady;
        let rest = y - lambert - f0 * rate - steady;
        let weight = if y >= 0.0 { cos_l } else { 0.0 };
        let signed = weight.copysign(rest);
        error[lane] += signed * rest;
        by_lambert[lane] -= signed;
        by_f0[lane] -= signed * rate;
    };
    let [(y, last_y), (s, last_s), (w, last_w), (c, last_c)] =
        columns.map(|all| all.as_chunks::<LANES>());
    for (((y, s), w), c) in y.iter().zip(s).zip(w).zip(c) {
        for lane in 0..LANES {
            one(lane, [y[lane], s[lane], w[lane], c[lane]]);
        }
    }
    for i in 0..last_y.len() {
        one(0, [last_y[i], last_s[i], last_w[i], last_c[i]]);
    }
    let sum = |lanes: [f64; LANES]| lanes.iter().sum();
    (sum(error), DVec2::new(sum(by_lambert), sum(by_f0)))
}

/// The search for the least value of a convex function on the unit square by its centre of gravity
/// (Levin 1965; Newman 1965, *Location of the Maximum on Unimodal Surfaces*,
/// doi:10.1145/321281.321291): the slope at the centre of the remaining polygon decides which side
/// of the centre to drop, at least 1/e of the area.
///
/// Absolute deviations have corners wherever the model equals a sample. There a search along one
/// coordinate after the other may stop too early, and Newton's method may diverge. Here the slope
/// also bounds the least value from below; the search ends when that bound proves the tolerance, or
/// when less than 1e-20 of the square is left.
#[derive(Debug)]
struct Search {
    /// The remaining polygon, counter-clockwise.
    polygon: Vec<DVec2>,
    /// The polygon's centre, at which the value and the slope are needed next; `None` once the
    /// search has ended.
    next: Option<DVec2>,
    best: DVec2,
    least: f64,
    /// No value in the square is below this.
    bound: f64,
}

impl Search {
    /// An upper limit that is never reached: after 60 steps at most 1e-11 of the square is left.
    const STEPS: usize = 60;

    fn new() -> Self {
        let centre = DVec2::splat(0.5);
        Self {
            polygon: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from).into(),
            next: Some(centre),
            best: centre,
            least: f64::INFINITY,
            bound: f64::NEG_INFINITY,
        }
    }

    /// Takes the value and a slope at the centre; ends where no point can be better by more than
    /// `tolerance`.
    fn step(&mut self, value: f64, slope: DVec2, tolerance: f64) {
        let Some(centre) = self.next else { return };
        if value < self.least {
            (self.least, self.best) = (value, centre);
        }
        // The function lies above its tangent.
        let tangent = |at: DVec2| value + slope.dot(at - centre);
        let lowest = self.polygon.iter().map(|at| tangent(*at)).fold(f64::INFINITY, f64::min);
        self.bound = self.bound.max(lowest);
        if self.least - self.bound <= tolerance {
            self.next = None;
            return;
        }
        // Where the tangent lies above the least value so far there is nothing better.
        self.polygon = clip(&self.polygon, |at| tangent(at) - self.least);
        self.next = centroid(&self.polygon);
    }
}

/// The part of a convex polygon where a linear function is at most 0.
fn clip(polygon: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (side(a), side(b));
        if at_a <= 0.0 {
            left.push(a);
        }
        if (at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0) {
            left.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    left
}

/// The centre of gravity of a polygon; `None` if its area vanishes in double precision.
fn centroid(polygon: &[DVec2]) -> Option<DVec2> {
    let &first = polygon.first()?;
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for pair in polygon[1..].windows(2) {
        // Relative to a corner, so that a small polygon far from the origin keeps its digits.
        let [a, b] = [pair[0] - first, pair[1] - first];
        let twice = a.perp_dot(b);
        area += twice;
        moment += twice * (a + b) / 3.0;
    }
    (area > 1e-20).then(|| first + moment / area)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The search for the least value of a function with a slope, and its number of steps.
    fn least(f: impl Fn(DVec2) -> (f64, DVec2), tolerance: f64) -> (Search, usize) {
        let mut search = Search::new();
        let mut steps = 0;
        while let Some(at) = search.next.filter(|_| steps < Search::STEPS) {
            let (value, slope) = f(at);
            search.step(value, slope, tolerance);
            steps += 1;
        }
        (search, steps)
    }

    #[test]
    fn the_least_is_found_inside_and_at_edges_and_corners() {
        for x in [0.0, 1e-4, 0.37, 1.0] {
            for y in [0.0, 0.72, 1.0] {
                // A valley with a kink, much steeper across.
                let f = |at: DVec2| {
                    let [u, v] = [at.x - x + (at.y - y), 1e-3 * (at.y - y)];
                    let slope = DVec2::new(u.signum(), u.signum() + 1e-3 * v.signum());
                    (u.abs() + v.abs(), slope)
                };
                let (found, steps) = least(f, 1e-9);
                assert!(found.least < 1e-9 && steps < Search::STEPS, "{x} {y}: {found:?} {steps}");
                assert!((found.best - DVec2::new(x, y)).abs().max_element() < 1e-5, "{found:?}");
            }
        }
    }

    #[test]
    fn a_flat_function_ends_at_once() {
        let (found, steps) = least(|_| (3.0, DVec2::ZERO), 0.0);
        assert_eq!((found.least, steps), (3.0, 1));
    }

    #[test]
    fn sums_are_those_of_the_definition_at_every_length() {
        let linear = Linear { lambert: 0.1, f0: 0.3 };
        let values = [0.2, 0.9, -1.0, 0.05, 3.0, 0.0, 0.4];
        let specular = [0.5, 0.7, 2.0, 0.0, 9.0, 0.2, 0.3];
        let grazing = [0.0, 0.1, 0.2, 0.3, 0.5, 1.0, 0.0];
        let cos_l = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3];
        for n in 0..=values.len() {
            let error = |linear: Linear| -> f64 {
                let model = |i: usize| {
                    let f = linear.f0 + (1.0 - linear.f0) * grazing[i];
                    linear.lambert + f * specular[i]
                };
                let measured = (0..n).filter(|&i| values[i] >= 0.0);
                measured.map(|i| (values[i] - model(i)).abs() * cos_l[i]).sum()
            };
            let columns = [&values[..n], &specular[..n], &grazing[..n], &cos_l[..n]];
            let (sum, slope) = sums(linear, columns);
            assert!((sum - error(linear)).abs() < 1e-14);
            let h = 1e-7;
            let by_lambert = error(Linear { lambert: linear.lambert + h, ..linear });
            let by_f0 = error(Linear { f0: linear.f0 + h, ..linear });
            for (slope, moved) in [(slope.x, by_lambert), (slope.y, by_f0)] {
                assert!(((moved - sum) / h - slope).abs() < 1e-6, "{n}");
            }
        }
    }
}
