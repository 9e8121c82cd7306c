//! The figures that say whether tables are worth having, as ratios of times within one run.

use std::hint::black_box;
use std::time::Instant;

use microfacet_sampler::{MicrofacetDistribution, Tables};
use microfacet_tables::Kind;

use crate::paper::Approximation;
use crate::rows::{Quantity, Row};
use crate::sampler::{BATCH, CAPS, INVERSION, INVERSION_SUM, lobe};
use crate::settings::{GAMMA, SIGMA, Settings};
use crate::tables::{Slices, TABLE};
use crate::{clock, conductors, masking};

/// One figure with its limit and its goal; smaller is better.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Figure {
    /// What it compares.
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
    let ratio = |quantity, a, b| Some(ns(quantity, a)? / ns(quantity, b)?);
    let normals = |a, b| ratio(Quantity::Normal, a, b);
    let conductor = |[rival, table]: [&'static str; 2]| ratio(Quantity::Conductor, table, rival);
    let worst =
        |error: fn(&Approximation) -> f64| approximation.iter().map(error).fold(0.0, f64::max);
    let bytes = lobe(&slices.default, GAMMA).bytes() as f64;
    let figure = |name, unit, must, aim, reached| Figure { name, unit, must, aim, reached };
    vec![
        figure("sample, table / GGX spherical caps", "", 1.3, 1.0, normals(TABLE, CAPS)),
        figure("sample_batch, table / GGX spherical caps", "", 0.6, 0.35, normals(BATCH, CAPS)),
        figure(
            "g1, table / GGX closed form",
            "",
            2.0,
            1.2,
            ratio(Quantity::G1, TABLE, masking::GGX),
        ),
        figure(
            "conductor, Schlick, table / GGX by hand",
            "",
            CONDUCTOR_MUST,
            CONDUCTOR_AIM,
            conductor(conductors::SCHLICK),
        ),
        figure(
            "conductor, exact Reflectance, table / GGX by hand",
            "",
            CONDUCTOR_MUST,
            CONDUCTOR_AIM,
            conductor(conductors::EXACT),
        ),
        figure(
            "sample, table / inversion, any gamma",
            "",
            1.0 / 20.0,
            1.0 / 40.0,
            normals(TABLE, INVERSION),
        ),
        figure(
            "sample, table / inversion, integer gamma only",
            "",
            1.0 / 20.0,
            1.0 / 40.0,
            normals(TABLE, INVERSION_SUM),
        ),
        figure(
            "CDF error, default tables, gamma >= 1.8",
            "",
            1e-4,
            2e-5,
            Some(certified(&slices.whole)),
        ),
        figure(
            "G1 error, table / rational approximation",
            "",
            1e-2,
            1e-3,
            Some(worst(|at| at.table_error.abs()) / worst(|at| at.rational_error.abs())),
        ),
        figure("tables of a lobe", "KiB", 32.0, 16.0, Some(bytes / 1024.0)),
        figure(
            "a lobe from tables",
            "us",
            50.0,
            10.0,
            Some(1e-3 * lobe_ns(&slices.whole, settings)),
        ),
        // No stricter goal: this happens once per process.
        figure("the embedded set, ready", "ms", 1.0, 1.0, Some(1e-6 * embedded_ns(settings))),
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

/// The median time of decoding the compiled-in set.
fn embedded_ns(settings: &Settings) -> f64 {
    let times = (0..settings.rounds.max(40)).map(|_| {
        let start = Instant::now();
        black_box(Tables::embedded());
        start.elapsed().as_nanos() as f64
    });
    clock::median(times.collect())
}

/// The median time to make a lobe from tables, over shapes between the nodes of the general set.
fn lobe_ns(set: &Tables, settings: &Settings) -> f64 {
    let times = (0..settings.rounds.max(40)).map(|i| {
        let gamma = 2.1 + 0.37 * (i % 40) as f64;
        let start = Instant::now();
        black_box(set.student_t(black_box(SIGMA), black_box(gamma)))
            .expect("all gamma are covered");
        start.elapsed().as_nanos() as f64
    });
    clock::median(times.collect())
}
