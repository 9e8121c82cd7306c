//! The interpolation error of tables, measured off their grid through the run-time sampler itself in f32.
//!
//! A table carries the figures found here as its certificate. The points are a fixed low-discrepancy sequence, so
//! the certificate is part of the table's reproducible bytes.

use std::collections::BTreeMap;

use glam::Vec3;
use rayon::prelude::*;

use microfacet_common::shape::{S_END, gamma_of_s, s_of_gamma};
use microfacet_model::{Shape, SignedUnit, UnitView, VisibleSlope, across_cdf};
use microfacet_sampler::axis::HalfTangent;
use microfacet_sampler::{BindError, Interpolation, Kind, StudentT, Table, Tables};

use crate::spec::GAMMA_WHOLE;

/// Largest and root-mean-square error over a set of points, with the point of the largest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Error {
    /// Largest absolute error.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
    /// γ, z = cot θ/σ and u where the largest was seen; u is NaN for quantities without one.
    pub at: [f64; 3],
    /// How many points were measured.
    pub points: usize,
}

impl Error {
    fn new(points: impl IntoIterator<Item = (f64, [f64; 3])>) -> Self {
        let mut all = Self::default();
        let mut sum = 0.0;
        for (error, at) in points {
            // A NaN is the worst error there is.
            if !(error <= all.max) {
                (all.max, all.at) = (error, at);
            }
            sum += error * error;
            all.points += 1;
        }
        all.rms = (sum / all.points.max(1) as f64).sqrt();
        all
    }

    fn join(a: Self, b: Self) -> Self {
        let points = a.points + b.points;
        let sum = a.rms * a.rms * a.points as f64 + b.rms * b.rms * b.points as f64;
        let worst = if b.max <= a.max { a } else { b };
        Self { rms: (sum / points.max(1) as f64).sqrt(), points, ..worst }
    }
}

/// s of all shapes.
pub const ALL_SHAPES: [f64; 2] = [0.0, S_END];

/// Adds to each table the errors measured on it, `points` of them for each of a few γ between every two nodes.
///
/// `s` limits the shapes to those that were asked for: a sub-range has nodes beyond its ends, for the interpolation only, and what lies
/// between those is less accurate. Unless it is [`ALL_SHAPES`], certificates state it as `s_min` and `s_max`.
///
/// # Errors
/// [`BindError`] if the tables are not a complete set.
pub fn certify(tables: &mut Tables, points: usize, s: [f64; 2]) -> Result<(), BindError> {
    let measured: Vec<BTreeMap<String, f64>> =
        tables.tables().iter().map(|table| measure(tables, table, points, s)).collect::<Result<_, _>>()?;
    for (i, certificate) in measured.into_iter().enumerate() {
        tables.set_certificate(i, certificate);
    }
    Ok(())
}

/// Figures of one table, rounded up to three digits.
pub(crate) fn measure(
    tables: &Tables,
    table: &Table,
    points: usize,
    s: [f64; 2],
) -> Result<BTreeMap<String, f64>, BindError> {
    if table.kind.is_albedo() {
        // Measured over their own domain, by `super::albedo::certify`.
        return Ok(table.certificate.clone());
    }
    let gammas = gammas_between_nodes(table, s);
    let all = gammas
        .par_iter()
        .map(|&gamma| {
            let bound = tables.student_t(1.0, gamma)?;
            let shape = Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?;
            Ok(match table.kind {
                Kind::Shadowing => g1_error(&bound, &shape, points),
                Kind::VisibleSlopeConditional => across_error(&bound, &shape, points),
                _ => along_error(&bound, &shape, points),
            })
        })
        .collect::<Result<Vec<Error>, BindError>>()?
        .into_iter()
        .fold(Error::default(), Error::join);
    let quantity = match table.kind {
        Kind::Shadowing => "g1",
        _ => "cdf",
    };
    let [gamma, z, u] = all.at;
    let mut figures = BTreeMap::from([
        (format!("{quantity}_max_error"), round_up(all.max)),
        (format!("{quantity}_rms_error"), round_up(all.rms)),
        ("worst_s".into(), s_of_gamma(gamma)),
        ("points".into(), all.points as f64),
    ]);
    if z.is_finite() {
        figures.insert("worst_view_cotangent".into(), z);
    }
    if u.is_finite() {
        figures.insert("worst_u".into(), u);
    }
    if s != ALL_SHAPES {
        figures.extend([("s_min".into(), s[0]), ("s_max".into(), s[1])]);
    }
    Ok(figures)
}

/// Three significant digits, upwards: a certificate must not promise more than was measured.
pub(super) fn round_up(x: f64) -> f64 {
    if !(x > 0.0) {
        return x;
    }
    let text = format!("{:.2e}", x * 1.005);
    text.parse().expect("a number just printed")
}

/// Shapes to measure at, none outside [from, to] in s: those of a list, and three between every two nodes of a range.
fn gammas_between_nodes(table: &Table, [from, to]: [f64; 2]) -> Vec<f64> {
    let axis = &table.axes[0];
    if axis.interpolation == Interpolation::Nodes || axis.nodes.len() == 1 {
        return axis.quantities();
    }
    let [low, high] = [axis.nodes[0].max(from), axis.nodes[axis.nodes.len() - 1].min(to)];
    let mut all: Vec<f64> = Vec::new();
    for pair in axis.nodes.windows(2) {
        all.extend([0.0, 0.21, 0.5, 0.83].map(|w| pair[0] + w * (pair[1] - pair[0])));
    }
    all.retain(|s| (low..high).contains(s));
    if all.first() != Some(&low) {
        all.push(low);
    }
    // The far end not as 1 + 1/s itself, which may round to just outside.
    all.push(high * (1.0 - 1e-15));
    all.into_iter().map(gamma_of_s).collect()
}

/// The i-th point of the additive recurrence with the plastic number (Roberts 2018), in [0, 1)².
pub(super) fn low_discrepancy(i: usize) -> [f64; 2] {
    [0.7548776662466927, 0.5698402909980532].map(|a| (0.5 + a * (i + 1) as f64).fract())
}

/// Spreads x ∈ [0, 1) so that two fifths of it go to the ends, logarithmically down to 1e-7.
fn towards_ends(x: f64) -> f64 {
    let tail = |y: f64| 0.1 * libm::exp(-13.8 * y);
    match x {
        x if x < 0.2 => tail(5.0 * x),
        x if x < 0.4 => 1.0 - tail(5.0 * (x - 0.2)),
        x => (x - 0.4) / 0.6,
    }
}

/// A view in the plane y = 0 with the half tangent of its elevation near τ, and its exact cotangent.
fn view(tau: f64) -> (Vec3, f64) {
    let z = HalfTangent::default().quantity(tau);
    let UnitView { sin, cos } = UnitView::from_cotangent(z);
    let v = Vec3::new(sin as f32, 0.0, cos as f32);
    (v, f64::from(v.z) / f64::from(v.x))
}

fn g1_error(bound: &StudentT, shape: &Shape, points: usize) -> Error {
    Error::new((0..points).map(|i| {
        let (v, z) = view(towards_ends(low_discrepancy(i)[0]));
        let exact = 1.0 / (1.0 + shape.lambda(shape.unit(z)));
        ((f64::from(bound.g1(v)) - exact).abs(), [shape.gamma(), z, f64::NAN])
    }))
}

/// How far the CDF of the sampled slope is from the number it was sampled with.
///
/// Where the heavy part is peeled off, the sum of the error of the remaining part, weighted by its share, and of that share.
fn along_error(bound: &StudentT, shape: &Shape, points: usize) -> Error {
    let peeled = shape.gamma() < GAMMA_WHOLE && bound.tabulated_share(Vec3::X) < 1.0;
    Error::new((0..points).map(|i| {
        let [a, b] = low_discrepancy(i);
        let ((v, z), u) = (view(towards_ends(a)), towards_ends(b) as f32);
        let at = UnitView::from_cotangent(z);
        let whole = VisibleSlope::new(shape, at);
        let error = if peeled {
            let share = bound.tabulated_share(v);
            let rest = VisibleSlope::peeled(shape, at);
            let exact_share = 1.0 - at.sin * shape.first_moment(0.0) / whole.area();
            let m = bound.sample_visible_normal(v, [u * share, 0.5]);
            let inside = (rest.cdf(slope_of(shape, m)) - f64::from(u * share) / f64::from(share)).abs();
            // At grazing the share vanishes, and with it what its part is worth.
            f64::from(share) * if share > 0.0 { inside } else { 0.0 } + (f64::from(share) - exact_share).abs()
        } else {
            let m = bound.sample_visible_normal(v, [u, 0.5]);
            (whole.cdf(slope_of(shape, m)) - f64::from(u)).abs()
        };
        (error, [shape.gamma(), z, f64::from(u)])
    }))
}

/// The in-plane unit slope of a normal sampled with σ = 1 and a view in the plane y = 0.
fn slope_of(shape: &Shape, m: Vec3) -> SignedUnit {
    let x = f64::from(m.x) / f64::from(m.z);
    SignedUnit { w: shape.unit(x.abs()), sign: if x < 0.0 { -1.0 } else { 1.0 } }
}

fn across_error(bound: &StudentT, shape: &Shape, points: usize) -> Error {
    // The view is normal to the surface; u₁ only scales y/√(z² + s x²), which is t again.
    let u1 = 0.4_f32;
    Error::new((0..points).map(|i| {
        let u = towards_ends(low_discrepancy(i)[0]) as f32;
        let m = bound.sample_visible_normal(Vec3::Z, [u1, u]);
        let [x, y, z] = [m.x, m.y, m.z].map(f64::from);
        let t = y / (z * z + shape.s() * x * x).sqrt();
        let got =
            across_cdf(shape, SignedUnit { w: shape.unit(t.abs()), sign: if t < 0.0 { -1.0 } else { 1.0 } });
        ((got - f64::from(u)).abs(), [shape.gamma(), f64::NAN, f64::from(u)])
    }))
}
