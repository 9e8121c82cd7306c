//! The figures that decide whether tables are worthwhile, as ratios of times within one run.

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;

use microfacet_sampler::Tables;
use microfacet_sampler::lobe::Tabulated;
use microfacet_tables::Kind;

use crate::paper::Approximation;
use crate::rival::lobe;
use crate::rows::{Quantity, Row};
use crate::sampler::{BATCH, CAPS, INVERSION, INVERSION_SUM, LANES};
use crate::settings::{GAMMA, SIGMA, Settings};
use crate::tables::{Slices, TABLE};
use crate::{clock, conductors, per_hit, values};

/// One figure with its limit and its goal; smaller is better.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) name: &'static str,
    /// Its unit; empty for a ratio.
    pub(crate) unit: &'static str,
    /// The limit.
    pub(crate) must: f64,
    /// The goal.
    pub(crate) aim: f64,
    /// The measured value; `None` where a rival is missing.
    pub(crate) reached: Option<f64>,
}

impl Figure {
    pub(crate) fn ratio(name: &'static str, must: f64, aim: f64, reached: Option<f64>) -> Self {
        Self { name, unit: "", must, aim, reached }
    }
}

/// The limit and the goal of a conductor's two calls at a hit, for gamma >= 1.8.
pub(crate) const CONDUCTOR_MUST: f64 = 1.6;
pub(crate) const CONDUCTOR_AIM: f64 = 1.3;

/// All figures, from measured rows and the errors of the rational approximation.
pub(crate) fn figures(
    rows: &[Row],
    approximation: &[Approximation],
    slices: &Slices,
    settings: &Settings,
) -> Vec<Figure> {
    let ns = |quantity, name: &str| {
        rows.iter().find(|row| row.quantity == quantity && row.name == name).map(|row| row.ns)
    };
    let over = |quantity, a, b| Some(ns(quantity, a)? / ns(quantity, b)?);
    let normals = |a, b| over(Quantity::Normal, a, b);
    let conductor = |name, [rival, table]: [&'static str; 2]| {
        let reached = over(Quantity::Conductor, table, rival);
        Figure::ratio(name, CONDUCTOR_MUST, CONDUCTOR_AIM, reached)
    };
    let worst =
        |error: fn(&Approximation) -> f64| approximation.iter().map(error).fold(0.0, f64::max);
    let g1_errors = worst(|at| at.table_error.abs()) / worst(|at| at.rational_error.abs());
    let kibibytes = lobe(slices.default(), GAMMA).bytes() as f64 / 1024.0;
    let cdf_error = certified(slices.whole());
    // Over shapes between the nodes of the general set.
    let lobe_ns = median_ns(settings, |i| {
        let gamma = black_box(2.1 + 0.37 * (i % 40) as f64);
        slices.whole().student_t(black_box(SIGMA), gamma).expect("all gamma are covered")
    });
    let embedded_ns = median_ns(settings, |_| Tables::embedded());
    let ratio = Figure::ratio;
    // Of as many lanes as the batch itself takes on this processor.
    let of_lanes = LANES.iter().rev().find_map(|(name, _)| normals(BATCH, name));
    let (of_caps, sums) = ("sample, table / GGX spherical caps", INVERSION_SUM);
    let g1 = over(Quantity::G1, TABLE, values::GGX);
    let d = |name, must, aim, rival| ratio(name, must, aim, over(Quantity::D, values::BITS, rival));
    let [by_hand, table] = conductors::SCHLICK;
    let eval_pdf = over(Quantity::Evaluation, table, by_hand);
    let at_hits = parameters_per_hit(over);
    let own = vec![
        d("D / GGX closed form", 8.0, 4.0, values::GGX),
        d("D / its logarithm form", 0.5, 0.4, values::LOGARITHM),
        // What careful code can reach, see docs/benchmark.md.
        ratio(of_caps, 2.2, 1.0, normals(TABLE, CAPS)),
        ratio("sample_batch, table / caps in lanes", 3.0, 2.0, of_lanes),
        ratio("g1, table / GGX closed form", 2.0, 1.2, g1),
        conductor("conductor, Schlick, table / GGX by hand", conductors::SCHLICK),
        conductor("conductor, exact Fresnel, table / GGX by hand", conductors::EXACT),
        ratio("eval_pdf, Schlick, table / GGX by hand", 2.0, 1.5, eval_pdf),
        ratio("sample, table / inversion, any gamma", 0.05, 0.025, normals(TABLE, INVERSION)),
        ratio("sample, table / inversion, integer gamma only", 0.05, 0.025, normals(TABLE, sums)),
        ratio("CDF error, default tables, gamma >= 1.8", 1e-4, 2e-5, Some(cdf_error)),
        ratio("G1 error, table / rational approximation", 1e-2, 1e-3, Some(g1_errors)),
        Figure { unit: "KiB", ..ratio("tables of a lobe", 32.0, 16.0, Some(kibibytes)) },
        Figure { unit: "us", ..ratio("a lobe from tables", 50.0, 10.0, Some(1e-3 * lobe_ns)) },
        // No stricter goal: this happens once per process.
        Figure {
            unit: "ms",
            ..ratio("the embedded set, ready", 1.0, 1.0, Some(1e-6 * embedded_ns))
        },
    ];
    at_hits.into_iter().chain(own).collect()
}

/// What it costs that parameters come from textures, from the quotient of the times of two rows.
fn parameters_per_hit(
    over: impl Fn(Quantity, &'static str, &'static str) -> Option<f64>,
) -> Vec<Figure> {
    let figure =
        |name, must, aim, a, b| Figure::ratio(name, must, aim, over(Quantity::PerHit, a, b));
    let bound = per_hit::BOUND;
    vec![
        figure("sigma per hit / bound sample", 1.3, 1.1, per_hit::OF_SIGMA, bound),
        figure("gamma per hit / bound sample", 2.2, 2.0, per_hit::SMOOTH, bound),
        figure("gamma per hit, random / bound sample", 2.4, 2.0, per_hit::RANDOM, bound),
        figure("gamma < 1.8 per hit / bound sample", 3.2, 2.5, per_hit::PEELED, bound),
        figure("E per hit / bilinear lookup", 3.0, 2.0, per_hit::ALBEDO, per_hit::LOOKUP),
    ]
}

/// The largest CDF error, between nodes and over all γ from 1.8 on, that the set's certificates
/// state.
fn certified(set: &Tables) -> f64 {
    let whole = |kind| matches!(kind, Kind::VisibleSlope | Kind::VisibleSlopeConditional);
    let tables = set.tables().iter().filter(|table| whole(table.kind));
    tables
        .filter_map(|table| table.certificate.error(microfacet_tables::Quantity::Cdf))
        .fold(0.0, f64::max)
}

/// The median time of single calls, in nanoseconds; `call` is given their number.
fn median_ns<T>(settings: &Settings, call: impl Fn(usize) -> T) -> f64 {
    let times = (0..settings.rounds.max(40)).map(|i| {
        let start = Instant::now();
        black_box(call(i));
        start.elapsed().as_nanos() as f64
    });
    clock::median(times.collect())
}
