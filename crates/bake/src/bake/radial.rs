//! The four tables of an isotropic distribution outside the Student-t family.
//!
//! The coordinates are those of the family's tables without γ: slopes are divided by their median
//! σ, and the slope across also by √(1 + x²). All values are integrals over the slope marginal, or
//! roots of such integrals.

use microfacet_model::classic::{Marginal, MarginalView};
use microfacet_tables::Interpolation::{Hermite, Linear};
use microfacet_tables::axis::half_tangent::{rate, slope_at};
use microfacet_tables::axis::hermite::limit_slopes;
use microfacet_tables::axis::{HalfTangent, Rational};
use microfacet_tables::{Axis, Kind, LobeSpec, Mapping, Precision, Subject, Table};
use rayon::prelude::*;

use super::shadowing::ratios;
use super::{across, along, mirrored, round};
use crate::progress::Stage;
use crate::table_spec::Level;

/// Number of in-plane slopes, the rows of the table of slopes across.
const SLOPES: usize = 193;
/// Nodes of the table of D.
const DENSITIES: usize = 257;

/// Kinds and axes of the four tables, for a distribution whose projected area at grazing is `kappa`
/// and whose largest slope is `reach`.
pub fn radial_axes(level: Level, kappa: f64, reach: f64) -> [(Kind, Vec<Axis>); 4] {
    let r = level.resolution();
    // Twice as fine as the family's: a distribution may have kinks and several scales, and its
    // tables have one shape only.
    let [along_numbers, across_numbers] = [r.numbers, r.across_numbers].map(|n| 2 * n - 1);
    let slopes = match reach {
        reach if reach.is_finite() => rational(reach),
        _ => HALF_TANGENT,
    };
    let views = |mapping, interpolation, count| Axis::placed("view", mapping, interpolation, count);
    let slope =
        |mapping, interpolation, count| Axis::placed("slope", mapping, interpolation, count);
    let given = slope(slopes, Linear, SLOPES);
    [
        (Kind::RadialShadowing, vec![views(rational(kappa), Hermite, r.shadowing_views)]),
        (Kind::RadialSlope, vec![views(HALF_TANGENT, Linear, r.views), along(along_numbers)]),
        (Kind::RadialConditional, vec![given, across(across_numbers)]),
        (Kind::RadialDensity, vec![slope(HALF_TANGENT, Hermite, DENSITIES)]),
    ]
}

/// The coordinate of views, and of slopes that have no bound.
const SLOPE: HalfTangent = HalfTangent { knots: None };
const HALF_TANGENT: Mapping = Mapping::HalfTangent(SLOPE);

/// q with the given κ, for tables without a γ axis.
fn rational(kappa: f64) -> Mapping {
    Mapping::Rational(Rational { scale: kappa, crowded: false })
}

/// The subject of the tables of the distribution with this label.
pub(crate) fn radial_subject(label: &str) -> Subject {
    Subject::of(LobeSpec::outside(label.into()))
}

/// Bytes of the values of the four tables as they are stored.
pub fn radial_bytes(level: Level, precision: Precision) -> usize {
    // The sizes do not depend on the distribution.
    let channels = Kind::VALUE_AND_SLOPE.len();
    let values =
        |(_, axes): &(Kind, Vec<Axis>)| channels * axes.iter().map(Axis::len).product::<usize>();
    radial_axes(level, 1.0, f64::INFINITY).iter().map(values).sum::<usize>() * precision.bytes()
}

/// The four tables of the distribution with this label; each row of two of them is one step of the
/// stage.
pub fn bake_radial(
    marginal: &Marginal,
    label: &str,
    level: impl Into<Level>,
    precision: Precision,
    stage: &Stage,
) -> Vec<Table> {
    let (kappa, subject) = (marginal.beyond(0.0).excess, radial_subject(label));
    let table = |(kind, axes): (Kind, Vec<Axis>)| {
        let values = match (kind, &axes[..]) {
            (Kind::RadialShadowing, [views]) => shadowing(marginal, kappa, &views.nodes),
            (Kind::RadialSlope, [views, numbers]) => {
                in_plane(marginal, &views.nodes, &numbers.nodes, stage)
            }
            (Kind::RadialConditional, [slopes, numbers]) => {
                given_slope(marginal, slopes, &numbers.nodes, stage)
            }
            (_, [slopes, ..]) => density(marginal, &slopes.nodes),
            (_, []) => unreachable!("every kind has an axis"),
        };
        let values = values.into_iter().flatten().collect();
        Table::new(subject.name(kind), kind, subject.clone(), axes, values).rounded(precision)
    };
    let all = radial_axes(level.into(), kappa, marginal.reach());
    stage.split(all.iter().filter(|(_, axes)| axes.len() > 1).map(|(_, axes)| axes[0].len()).sum());
    all.into_iter().map(table).collect()
}

/// G1/q with q = z/(z + κ), where κ is the projected area at grazing.
fn shadowing(marginal: &Marginal, kappa: f64, views: &[f64]) -> Vec<[f32; 2]> {
    let beyond = |z: f64| {
        let at = marginal.beyond(z);
        (at.excess, at.tail)
    };
    round(ratios(&Rational { scale: kappa, crowded: false }, kappa, views, beyond))
}

/// Finds the distance g ∈ (0, 2) from an end at which `share`, which rises with g and is returned
/// with its derivative, equals `u`.
///
/// Newton's method on the logarithms of share and g, since the share is nearly a power of g; where
/// a step leaves the bracket, the bracket is halved instead.
fn solve(u: f64, guess: f64, share: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high, mut g) = (0.0, 2.0, guess);
    for _ in 0..80 {
        let (value, rate) = share(g);
        if value < u {
            low = g
        } else {
            high = g
        }
        let step = g * libm::exp(value / (rate * g) * libm::log(u / value));
        let next = if step > low && step < high { step } else { 0.5 * (low + high) };
        // About a hundredth of the last stored bit.
        if (next - g).abs() < 1e-9 * g || high - low < 1e-14 {
            return next;
        }
        g = next;
    }
    g
}

/// The slope at the distance g from the end `sign` of the half tangent.
fn slope_from(g: f64, sign: f64) -> f64 {
    let [x, z] = slope_at(g);
    sign * (x / z.max(1e-300)).clamp(-1e30, 1e30)
}

/// A half of a row: the distance from an end at each random number, and its derivative per node;
/// `share` is the share of normals within a distance, and the derivative of that.
fn half_row(numbers: &[f64], share: impl Fn(f64) -> (f64, f64)) -> Vec<[f32; 2]> {
    let cells = (numbers.len() - 1) as f64;
    let mut g = 1e-3;
    round(numbers.iter().map(|&t| {
        let (u, du_dt) = mirrored(t);
        g = solve(u, g, &share);
        let slope = du_dt / share(g).1 / cells;
        // The slope is infinite at the end of a support; `limit_slopes` bounds it.
        [g, if slope.is_finite() { slope } else { f64::from(f32::MAX) }]
    }))
}

fn in_plane(marginal: &Marginal, views: &[f64], numbers: &[f64], stage: &Stage) -> Vec<[f32; 2]> {
    let row = |&tau: &f64| {
        let z = SLOPE.quantity(tau);
        let view = MarginalView::new(marginal, z);
        let mut row = Vec::with_capacity(2 * numbers.len());
        for sign in [-1.0, 1.0] {
            let mut half = half_row(numbers, |g| {
                let x = slope_from(g, sign);
                let at = view.shares(x);
                (if sign < 0.0 { at.below } else { at.above }, at.density / rate(x, 1.0))
            });
            if sign < 0.0 && tau < 1.0 && z <= marginal.reach() {
                // The silhouette in closed form.
                half[0][0] = SLOPE.parts(tau)[1] as f32;
            }
            limit_slopes(&mut half);
            row.extend(half);
        }
        stage.step();
        row
    };
    views.par_iter().flat_map_iter(row).collect()
}

fn given_slope(
    marginal: &Marginal,
    slopes: &Axis,
    numbers: &[f64],
    stage: &Stage,
) -> Vec<[f32; 2]> {
    let row = |&at: &f64| {
        // There is no quadrature for a row at infinity, or at or beyond the bound R of the slopes:
        // a row just before it is close to the limit.
        let (x, scale) = match slopes.mapping {
            Mapping::Rational(axis) => {
                let part = axis.quantity(at, 1.0).min(1.0 - 1e-6);
                (marginal.reach() * part, ((1.0 - part) * (1.0 + part)).sqrt())
            }
            _ => {
                let x = SLOPE.quantity(at.min(1.0 - 1e-5));
                (x, (1.0 + x * x).sqrt())
            }
        };
        let across = marginal.across_at(x);
        let mut half = half_row(numbers, |g| {
            let t = slope_from(g, 1.0);
            let tail = across.tail(t.abs() * scale);
            // Symmetric about t = 0, where the half table ends.
            let above = if t < 0.0 { 1.0 - tail } else { tail };
            (above, scale * across.density(t.abs() * scale) / rate(t, 1.0))
        });
        limit_slopes(&mut half);
        stage.step();
        half
    };
    slopes.nodes.par_iter().flat_map_iter(row).collect()
}

fn density(marginal: &Marginal, slopes: &[f64]) -> Vec<[f32; 2]> {
    let cells = (slopes.len() - 1) as f64;
    // D at the horizon is the limit from just above it.
    let root = |h: f64| marginal.d(SLOPE.quantity(h.min(1.0 - 1e-9))).sqrt().sqrt();
    let step = 1e-4 / cells;
    let node = |&h: &f64| {
        // D is even in h; at the horizon the difference is one-sided.
        let (a, b) = (root((h - step).abs()), root(h + step));
        let width = if h + step > 1.0 { step } else { 2.0 * step };
        [root(h), (b - a) / width / cells]
    };
    let mut nodes: Vec<[f64; 2]> = slopes.iter().map(node).collect();
    // D falls to 0, ever faster. Noisy values are kept, as are values that are small and flat.
    if let [.., [before, _], last] = &mut nodes[..]
        && last[0] < 0.1 * *before
        && last[1].abs() > 3.0 * (last[0] - *before).abs()
    {
        *last = FADING.map(|part| part * *before);
    }
    round(nodes)
}

/// Value and slope per cell of the last node, relative to the value before it, where D falls to 0
/// at the horizon.
///
/// There D^¼ is a fourth root of the distance from the horizon, whose slope is infinite at the end:
/// with that slope the cell would swing to some 1e6 D(0). These values leave an error of less than
/// 0.04 of D at the node before.
const FADING: [f64; 2] = [0.41, -1.4];

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use microfacet_model::classic::{Gtr, Isotropic, Sawicki, Tabulated};

    use super::*;

    fn nodes() -> Vec<f64> {
        (0..DENSITIES).map(|i| i as f64 / (DENSITIES - 1) as f64).collect()
    }

    /// The largest error in the last cell of the table of D, relative to D at its inner node.
    fn error_in_the_last_cell(d: &dyn Isotropic) -> f64 {
        let marginal = Marginal::new(d);
        let nodes = nodes();
        let table = density(&marginal, &nodes);
        let [a, b] = [table[DENSITIES - 2], table[DENSITIES - 1]].map(|n| n.map(f64::from));
        let start = nodes[DENSITIES - 2];
        let inner = a[0].powi(4);
        let errors = (0..100).map(|i| {
            let w = f64::from(i) / 100.0;
            let (x, v) = (w * w * (3.0 - 2.0 * w), 1.0 - w);
            let root = a[0] + x * (b[0] - a[0]) + w * v * (v * a[1] - w * b[1]);
            let exact = marginal.d(SLOPE.quantity(start + w * (1.0 - start)));
            (root.max(0.0).powi(4) - exact).abs() / inner
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn a_density_that_fades_at_the_horizon_stays_near_it() {
        for n in [0.0, 1.0, 40.0] {
            let error = error_in_the_last_cell(&Sawicki::new(n).unwrap());
            assert!(error < 0.04, "sawicki {n}: {error}");
        }
        let rows = (0..=90).map(|i| f64::from(i).to_radians()).map(|t| (t, t.cos().max(0.0)));
        let measured = Tabulated::new(&rows.collect::<Vec<_>>()).unwrap();
        let error = error_in_the_last_cell(&measured);
        assert!(error < 0.04, "measured: {error}");
        // A noisy one that does not fade keeps its value at the horizon.
        let noisy = |i: i32| {
            let theta = f64::from(i) * 1e-3 * FRAC_PI_2;
            let noise = 1.0 + 0.02 * f64::sin(1e3 * f64::from(i));
            (theta, noise * (0.01 + libm::exp(-theta * theta / 0.1)))
        };
        let flat = Tabulated::new(&(0..=1000).map(noisy).collect::<Vec<_>>()).unwrap();
        let marginal = Marginal::new(&flat);
        let table = density(&marginal, &nodes());
        let want = marginal.d(SLOPE.quantity(1.0 - 1e-9)).sqrt().sqrt();
        let last = f64::from(table[DENSITIES - 1][0]);
        assert!((last / want - 1.0).abs() < 1e-6, "{last} {want}");
        // One that does not fade is smooth there.
        let error = error_in_the_last_cell(&Gtr::new(0.3, 1.5).unwrap());
        assert!(error < 1e-6, "gtr: {error}");
    }
}
