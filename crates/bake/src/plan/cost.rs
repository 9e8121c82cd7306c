//! Estimates what a bake costs before it is done.
//!
//! Inside the crate all seconds are those of one thread, and depend on the specification alone: so
//! shares of the work are the same wherever they are computed. A [`Cost`] and [`seconds`] are for
//! display, and are divided by the current threads.

use std::collections::HashSet;

use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::Masking;
use microfacet_tables::{
    Axis, Interpolation, Kind, LobeSpec, Mapping, MaterialEntry, Precision, Provenance,
    Reflectance, Subject, Table, describe, stated_axes,
};

use super::Plan;
use super::albedo_work::{albedo_seconds, expected_bytes};
use crate::bake::albedo::{AlbedoError, AlbedoSpec};
use crate::bake::{self};
use crate::certify::certificate::POINTS;
use crate::certify::radial;
use crate::distribution::{Distribution, DistributionKind, Named};
use crate::table_spec::{GAMMA_WHOLE, Level, Quality, TableSpec, general_set};

/// Bytes and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Size of the set's safetensors file.
    pub bytes: usize,
    /// Time to bake and certify it on the current threads.
    pub seconds: f64,
}

impl std::iter::Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        let none = Self { bytes: 0, seconds: 0.0 };
        costs.fold(none, |a, b| Self { bytes: a.bytes + b.bytes, seconds: a.seconds + b.seconds })
    }
}

impl Cost {
    fn new(bytes: usize, seconds_of_one_thread: f64) -> Self {
        Self { bytes, seconds: on_threads(seconds_of_one_thread) }
    }
}

/// Seconds on the current threads, from those of one: what a clock would show.
pub fn on_threads(seconds: f64) -> f64 {
    seconds / rayon::current_num_threads() as f64
}

/// Estimates the bytes of a set without tables: its names, its recipe, its conventions, and the
/// formulas of the axes that its tables will have.
pub fn bare_cost(provenance: &Provenance) -> Cost {
    let has = |convention: &str| provenance.conventions.contains_key(convention);
    let some =
        |of: &dyn Fn(&MaterialEntry) -> bool| has("albedo") && provenance.materials.iter().any(of);
    let dielectric = |entry: &MaterialEntry| entry.fresnel.is_some_and(|f| f.indices().is_some());
    let formulas = Mapping::EVERY.into_iter().filter(|mapping| match mapping {
        Mapping::LogShape(_) | Mapping::LogRoughness(_) | Mapping::ViewBlend(_) => has("albedo"),
        Mapping::Azimuth(_) => some(&|entry| !entry.lobe.tabulated().is_family()),
        Mapping::ReflectanceRoot | Mapping::CriticalBlend(_) => some(&dielectric),
        _ => has("visible_slope"),
    });
    // Two quotes with their escapes, a colon and a comma.
    let formulas: usize =
        formulas.map(|mapping| mapping.name().len() + mapping.formula().len() + 10).sum();
    let bare = describe(provenance, &[]).map_or(0, |json| escaped(&json));
    Cost { bytes: bare + formulas, seconds: 0.0 }
}

/// Bytes of a document as a string inside JSON.
fn escaped(json: &str) -> usize {
    json.len() + json.bytes().filter(|byte| matches!(byte, b'"' | b'\\')).count()
}

/// What the tables before one have described for it: a file describes an axis once, and tables of
/// single materials that have one layout together.
///
/// The constants below are counted in sets of draft quality of all kinds of tables, as averages
/// over the digits of their figures; `estimated_bytes_are_those_of_the_file` in `tests/plan` and
/// `tests/albedo` holds their sums to the files, to 4 %.
#[derive(Default)]
struct Known(HashSet<String>);

impl Known {
    /// Bytes of those axes that are new.
    fn axes(&mut self, subject: &Subject, axes: &[Axis]) -> usize {
        let new = stated_axes(subject, axes).into_iter().filter(|json| self.0.insert(json.clone()));
        new.map(|json| escaped(&json) + 1).sum()
    }
}

/// Estimates what tables add to a set. The bytes are right to a few per cent, since only the digits
/// of certificates are unknown. The seconds, on the current threads, are scaled from times measured
/// on one machine: `cargo run --profile dist -p microfacet-study -- planner_seconds` shows how far
/// they are off here.
pub fn cost(specs: &[TableSpec]) -> Cost {
    let mut known = Known::default();
    let mut header = |spec: &TableSpec| {
        let axes = known.axes(&Subject::shapes(spec.covers), &bake::axes(spec));
        // Kind, columns, certificate, shape and offsets.
        axes + 2 * spec.name.len() + 400 + scales(spec.precision, Kind::VALUE_AND_SLOPE.len())
    };
    let bytes = specs.iter().map(|spec| spec.bytes() + header(spec)).sum();
    Cost::new(bytes, specs_seconds(specs).iter().sum())
}

/// Estimates a whole set of this quality.
///
/// # Errors
/// [`AlbedoError`] for an albedo that no table can hold.
pub fn set_cost(plan: &Plan, quality: Quality, precision: Precision) -> Result<Cost, AlbedoError> {
    let general = general_set(quality, precision);
    let shapes = plan.shapes.iter().map(|need| Ok(cost(&need.specs(&general))));
    let specs = plan.albedos.iter().map(|need| need.spec(quality, precision));
    let specs = specs.collect::<Result<Vec<_>, _>>()?;
    let albedos = albedo_costs(&specs).into_iter().map(Ok);
    let own = plan.distributions.iter().map(|own| Ok(distribution_cost(own, quality, precision)));
    shapes.chain(albedos).chain(own).chain([Ok(bare_cost(&plan.provenance()))]).sum()
}

/// The seconds of [`cost`] alone, which are quick to estimate.
pub fn seconds(specs: &[TableSpec]) -> f64 {
    on_threads(specs_seconds(specs).iter().sum())
}

/// The seconds of one thread to bake tables, and those to certify them.
pub(crate) fn specs_seconds(specs: &[TableSpec]) -> [f64; 2] {
    specs.iter().map(spec_seconds).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d])
}

/// The cost of albedo tables, with the nodes that refinement is expected to add.
pub fn albedo_cost(spec: &AlbedoSpec) -> Cost {
    albedo_costs([spec])[0]
}

/// The costs of albedo tables that one set holds, in order.
pub fn albedo_costs<'a>(specs: impl IntoIterator<Item = &'a AlbedoSpec>) -> Vec<Cost> {
    let mut known = Known::default();
    let mut cost = |spec: &AlbedoSpec| {
        let bytes = expected_bytes(spec) as usize + albedo_header(spec, &mut known);
        Cost::new(bytes, albedo_seconds(spec))
    };
    specs.into_iter().map(&mut cost).collect()
}

/// Bytes of the descriptions of albedo tables, the first of their set.
pub(crate) fn albedo_headers(spec: &AlbedoSpec) -> usize {
    albedo_header(spec, &mut Known::default())
}

fn albedo_header(spec: &AlbedoSpec, known: &mut Known) -> usize {
    let (channels, is_single) = (spec.channels(), spec.nodes_of_materials() == 1);
    let lengths: Vec<usize> = spec.axes.iter().map(Axis::len).collect();
    let optics = if matches!(spec.reflectance, Reflectance::Conductor { .. }) { 50 } else { 0 };
    let columns = optics + scales(spec.precision, channels.len());
    let mut header = |masking: Masking| {
        let axes = known.axes(&spec.subject(masking), &spec.axes);
        if is_single && !known.0.insert(format!("{channels:?}, {masking:?}, {lengths:?}")) {
            return 75 + columns + axes;
        }
        // Kind, columns, certificate, shape and offsets.
        let rest = if is_single { 470 } else { 820 };
        let name = |kind| 2 * spec.name(kind, masking).len();
        let average = if spec.has_averages() { name(Kind::AlbedoAverage) + rest } else { 0 };
        axes + name(Kind::Albedo) + rest + columns + average
    };
    spec.maskings.iter().map(|&masking| header(masking)).sum()
}

/// Bytes of the scale and the offset of each channel.
fn scales(precision: Precision, channels: usize) -> usize {
    if precision == Precision::U16 { 26 * channels } else { 0 }
}

/// The cost of the four tables of a distribution outside the family.
pub fn distribution_cost(
    distribution: &Distribution,
    level: impl Into<Level>,
    precision: Precision,
) -> Cost {
    let level = level.into();
    // The name ends in the label, or as many other characters; kind, channels, certificate, shape
    // and offsets.
    let (label, subject) = (distribution.label(), Subject::of(LobeSpec::outside(String::new())));
    let (mut known, scales) = (Known::default(), scales(precision, Kind::VALUE_AND_SLOPE.len()));
    let header = |(kind, axes): &(Kind, Vec<Axis>)| {
        known.axes(&subject, axes) + 2 * (kind.name().len() + label.len()) + 305 + scales
    };
    let headers = distribution_tables(level).iter().map(header).sum::<usize>();
    let bytes = headers + bake::radial_bytes(level, precision);
    Cost::new(bytes, distribution_seconds(distribution, level).iter().sum())
}

/// The four tables of a distribution outside the family: another number of the same length stands
/// for the scale and the reach in the axes.
fn distribution_tables(level: Level) -> [(Kind, Vec<Axis>); 4] {
    bake::radial_axes(level, std::f64::consts::PI, f64::INFINITY)
}

/// The seconds of one thread to bake the four tables of a distribution outside the family, and
/// those to certify them.
pub(crate) fn distribution_seconds(distribution: &Distribution, level: Level) -> [f64; 2] {
    let scale = match distribution {
        Distribution::Named(Named {
            kind: DistributionKind::Gauss | DistributionKind::Schlick,
            ..
        }) => 1.25,
        _ => OF_LONG_TAILS,
    };
    let [node, normal] = OF_DISTRIBUTIONS;
    let nodes = |(_, axes): &(Kind, Vec<Axis>)| match &axes[..] {
        [first, last] => first.len() * last.len(),
        _ => 0,
    };
    let nodes: usize = distribution_tables(level).iter().map(nodes).sum();
    let seconds = [node * nodes as f64, normal * radial::POINTS as f64];
    seconds.map(|microseconds| 1e-6 * scale * microseconds)
}

/// Microseconds for a node of either slope table of a distribution (the other tables are far
/// smaller) and for a normal of the certificate, fitted as in `albedo_work`; and how much longer
/// the longest tails take, those of GTR.
const OF_DISTRIBUTIONS: [f64; 2] = [65.0, 30.0];
const OF_LONG_TAILS: f64 = 1.9;

/// Nanoseconds for a node and for a point of the certificate: fitted as in `albedo_work` to ranges
/// of shapes.
const fn nanoseconds(kind: Kind) -> [f64; 2] {
    match kind {
        Kind::Shadowing => [320.0, 230.0],
        Kind::VisibleSlopeConditional => [1600.0, 240.0],
        _ => [8500.0, 800.0],
    }
}

/// Nanoseconds to prepare the shapes of a table, and how much longer each of its nodes and points
/// takes than of a range.
fn prepared(shapes: &[f64]) -> [f64; 2] {
    // A single shape is prepared for its table alone, in some milliseconds, and its rows are not
    // shared with others. Below the seam the peeled part takes longer.
    match shapes[..] {
        [s] if s > s_of_gamma(GAMMA_WHOLE) => [7e6, 4.2],
        [_] => [3e6, 1.9],
        _ => [0.0, 1.0],
    }
}

/// Seconds of one thread to measure the error of a table other than of directional albedos at one
/// place: longer for the shapes or distributions that take longest.
pub fn point_seconds(table: &Table) -> f64 {
    match table.kind {
        // Two lookups, of which one integrates over the views.
        Kind::AlbedoAverage => 40e-6,
        Kind::RadialShadowing | Kind::RadialDensity | Kind::RadialSlope => {
            1e-6 * OF_LONG_TAILS * OF_DISTRIBUTIONS[1]
        }
        Kind::RadialConditional => 1e-6 * radial::SLANTED * OF_LONG_TAILS * OF_DISTRIBUTIONS[1],
        kind => 1e-9 * nanoseconds(kind)[1] * prepared(&table.axes[0].nodes)[1],
    }
}

/// Seconds of one thread to bake a table, and to certify it.
fn spec_seconds(spec: &TableSpec) -> [f64; 2] {
    let [node, point] = nanoseconds(spec.kind);
    let shapes = &spec.shapes.nodes;
    let [prepare, longer] = prepared(shapes);
    let is_exact = spec.shapes.interpolation == Interpolation::Nodes;
    let measured = if is_exact { shapes.len() } else { 4 * shapes.len() - 3 };
    let places = (measured * POINTS) as f64;
    [prepare + longer * node * spec.nodes() as f64, longer * point * places]
        .map(|nanoseconds| 1e-9 * nanoseconds)
}
