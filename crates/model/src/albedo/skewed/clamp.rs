//! Where the clamp of G1(l) sets in: searched for on some chords, and followed from these to all
//! others.

use super::{Chord, End, PANEL, View};
use crate::albedo::AlbedoIntegrator;

/// Stands for area − l_z where a chord has no length: positive, because l_z is 0 there.
const RIM: f64 = 1.0;
/// Points on a chord between which the clamp of G1(l) is searched for.
const CLAMPS: usize = 16;
/// Chords between which the clamp's curve is followed, and those that touch it are searched for.
const CHORDS: usize = 24;

/// Where G1(l) is clamped on one chord, in w.
pub(super) struct Clamped {
    /// The chord.
    along: f64,
    /// Whether the chord begins clamped.
    first: bool,
    /// Where that changes, ascending.
    changes: Vec<f64>,
    /// The least of area − l_z: positive if nothing is clamped.
    least: f64,
}

impl AlbedoIntegrator {
    /// Where G1(l) is clamped, on chords from the first stop to the last. Adds to `stops` the
    /// chords that touch the curve at which the clamp sets in, and those that it nearly follows.
    pub(super) fn clamps(&self, view: &View, stops: &mut Vec<End>) -> Vec<Clamped> {
        let chords = steps(stops[0].at, stops[stops.len() - 1].at, CHORDS);
        let mut clamped: Vec<Clamped> = chords.iter().map(|&w| self.clamped(view, w)).collect();
        let mut add = |at: f64, scale: f64| {
            if self.matters(view, at) {
                stops.push(End { at, scale });
            }
        };
        let least = |w: f64| {
            let Some(chord) = self.chord(view, w) else { return RIM };
            let excess = |w: f64| self.reflected(view, &chord, w).excess();
            minimum(&self.searched(view, &chord, excess), excess).1
        };
        let found: Vec<(f64, f64)> = clamped.iter().map(|at| (at.along, at.least)).collect();
        let mut touching = Vec::new();
        changes(&found, self.close(), least, |at| touching.push(at));
        for at in touching {
            add(at, 0.1);
            let beside = [at - self.close(), at + self.close()];
            clamped.extend(beside.map(|w| self.clamped(view, w)));
        }
        clamped.sort_by(|a, b| a.along.total_cmp(&b.along));
        // Where the curve crosses the bulk of the lobe (|t| ≤ 1) within a short interval of w, the
        // integrals along chords vary on the scale of that interval.
        let crossings = [-1.0, 0.0, 1.0].map(|t| {
            let excess = |w: f64| {
                let Some(chord) = self.chord(view, w) else { return RIM };
                let [low, high] = self.chord_ends(view, &chord);
                let t = self.signed_slope(f64::clamp(t, low, high));
                view.reflect(self, &chord, chord.eta + chord.rate * t).excess()
            };
            let mut found = Vec::new();
            changes(&valued(&chords, excess), self.close(), excess, |at| found.push(at));
            found
        });
        for &at in &crossings[1] {
            let nearest = |others: &Vec<f64>| {
                others.iter().map(|x| (x - at).abs()).fold(f64::INFINITY, f64::min)
            };
            let scale = nearest(&crossings[0]).max(nearest(&crossings[2]));
            if scale < 0.5 * PANEL {
                add(at, scale.max(1e-4));
            }
        }
        stops.sort_by(|a, b| a.at.total_cmp(&b.at));
        clamped
    }

    /// Where G1(l) is clamped on the chord at w.
    fn clamped(&self, view: &View, along: f64) -> Clamped {
        let Some(chord) = self.chord(view, along) else {
            return Clamped { along, first: false, changes: Vec::new(), least: RIM };
        };
        let excess = |w: f64| self.reflected(view, &chord, w).excess();
        let mut values = self.searched(view, &chord, excess);
        let least = minimum(&values, excess);
        values.insert(values.partition_point(|at| at.0 < least.0), least);
        let mut found = Vec::new();
        changes(&values, self.close(), excess, |at| found.push(at));
        Clamped { along, first: values[0].1 <= 0.0, changes: found, least: least.1 }
    }

    /// Where G1(l) enters or leaves the clamp on a chord with these ends: followed from the chords
    /// beside it, or searched for where these differ in more than the places.
    pub(super) fn clamps_of(
        &self,
        clamped: &[Clamped],
        view: &View,
        chord: &Chord,
        ends: [f64; 2],
    ) -> Vec<f64> {
        let excess = |w: f64| self.reflected(view, chord, w).excess();
        self.followed(clamped, chord.along, ends, excess).unwrap_or_else(|| {
            let mut found = Vec::new();
            let values = self.searched(view, chord, excess);
            changes(&values, self.close(), excess, |at| found.push(at));
            found
        })
    }

    fn followed(
        &self,
        clamped: &[Clamped],
        along: f64,
        [low, high]: [f64; 2],
        excess: impl Fn(f64) -> f64,
    ) -> Option<Vec<f64>> {
        let after = clamped.partition_point(|at| at.along <= along);
        let [a, b] = [clamped.get(after.checked_sub(1)?)?, clamped.get(after)?];
        if a.first != b.first || a.changes.len() != b.changes.len() {
            return None;
        }
        let share = (along - a.along) / (b.along - a.along);
        let mut is_clamped = a.first;
        let root = |(&a, &b): (&f64, &f64)| {
            let guess = a + share * (b - a);
            let at = |w: f64| (w, excess(w));
            if !(low < guess && guess < high) {
                return None;
            }
            let middle = at(guess);
            let is_before = (middle.1 <= 0.0) == is_clamped;
            is_clamped = !is_clamped;
            // The curve turns most beside a chord that touches it.
            [0.1, 0.5].into_iter().find_map(|share| {
                let reach = share * (b - a).abs() + 0.01;
                let to = if is_before { guess + reach } else { guess - reach };
                let beyond = at(to.clamp(low, high));
                let differs = (middle.1 <= 0.0) != (beyond.1 <= 0.0);
                differs.then(|| root(middle, beyond, self.close(), &excess))
            })
        };
        a.changes.iter().zip(&b.changes).map(root).collect()
    }

    /// Distance in w to which places of the clamp are found: at a kink the error that remains is of
    /// second order.
    fn close(&self) -> f64 {
        0.01 * self.tolerance.sqrt()
    }

    /// Points of a chord, between which G1(l) enters or leaves the clamp at most once apart from
    /// intervals too small to matter, with the values of area − l_z there.
    fn searched(&self, view: &View, chord: &Chord, excess: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let [low, high] = self.chord_ends(view, chord);
        let mut points = steps(low, high, CLAMPS);
        let centre = self.chord_centre(view, chord);
        let near =
            [-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0].map(|x| centre.at + x * centre.scale);
        if centre.scale < 1.0 {
            points.extend(near.into_iter().filter(|w| low < *w && *w < high));
            points.sort_by(f64::total_cmp);
        }
        valued(&points, excess)
    }
}

/// The ends of an interval of w and the points that divide it, close together in the bulk of the
/// lobe and further apart in its tails.
fn steps(low: f64, high: f64, parts: usize) -> Vec<f64> {
    let [a, b] = [low, high].map(|w| libm::asinh(2.0 * w));
    let (mut power, ratio) = (libm::exp(a), libm::exp((b - a) / parts as f64));
    // sinh(x)/2 at equal steps of x.
    let inside = (1..parts).map(|_| {
        power *= ratio;
        0.25 * (power - 1.0 / power)
    });
    [low].into_iter().chain(inside).chain([high]).collect()
}

/// The points with the values of f.
fn valued(points: &[f64], f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    points.iter().map(|&at| (at, f(at))).collect()
}

/// Calls `found` with a root of f between any neighbours of the ascending points at which f has
/// different signs.
fn changes(values: &[(f64, f64)], close: f64, f: impl Fn(f64) -> f64, mut found: impl FnMut(f64)) {
    for pair in values.windows(2) {
        if (pair[0].1 > 0.0) != (pair[1].1 > 0.0) {
            found(root(pair[0], pair[1], close, &f));
        }
    }
}

/// The least value of f, by parabolas through the least value at the ascending points and its
/// neighbours.
fn minimum(values: &[(f64, f64)], f: impl Fn(f64) -> f64) -> (f64, f64) {
    let least = (0..values.len()).min_by(|&i, &j| values[i].1.total_cmp(&values[j].1));
    let i = least.unwrap_or(0);
    let [mut a, mut b, mut c] = match values.get(i.max(1) - 1..i.max(1) + 2) {
        Some(&[a, b, c]) if i > 0 => [a, b, c],
        _ => return values[i],
    };
    for _ in 0..4 {
        // The slopes on both sides, and the vertex of the parabola.
        let [p, q] = [(b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0)];
        let at = 0.5 * (a.0 + b.0 - p * (c.0 - a.0) / (q - p));
        if !(a.0 < at && at < c.0) || at == b.0 {
            break;
        }
        let new = (at, f(at));
        [a, b, c] = match (at < b.0, new.1 < b.1) {
            (true, true) => [a, new, b],
            (true, false) => [new, b, c],
            (false, true) => [b, new, c],
            (false, false) => [a, b, new],
        };
    }
    b
}

/// A root of f between two points of different sign, by the Illinois variant of false position,
/// when a step is less than `close`.
fn root(mut a: (f64, f64), mut b: (f64, f64), close: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut middle = 0.5 * (a.0 + b.0);
    for _ in 0..40 {
        let next = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let moved = (next - middle).abs();
        middle = next;
        if moved < close {
            break;
        }
        let value = f(middle);
        if value == 0.0 {
            break;
        }
        if (value > 0.0) == (b.1 > 0.0) {
            b = (middle, value);
            a.1 *= 0.5;
        } else {
            a = b;
            b = (middle, value);
        }
    }
    middle
}
