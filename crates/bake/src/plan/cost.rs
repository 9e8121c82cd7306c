//! Estimates the bytes and the work of a bake.
//!
//! Work is a number of nodes and of points of certificates, times constants of each kind of table,
//! the seconds of a node and of a point on one thread of a 2-core x86-64 virtual machine. It
//! depends on the specification alone, so that every machine divides the needs of a library in the
//! same way. `cargo run --profile dist -p microfacet-study -- planned` prints it next to measured
//! times.

use std::collections::HashSet;

use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::Masking;
use microfacet_tables::{
    Axis, Interpolation, Kind, LobeForm, LobeSpec, Mapping, MaterialEntry, Precision, Provenance,
    Reflectance, Subject, Table, describe, stated_axes,
};

use crate::bake::albedo::AlbedoSpec;
use crate::bake::{axes, radial_axes};
use crate::certify::albedo::{climbed_count, is_bound};
use crate::certify::certificate::POINTS;
use crate::certify::{points, radial};
use crate::distribution::{Distribution, DistributionKind, Named};
use crate::table_spec::{Level, TableSpec};

/// Bytes and seconds.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Cost {
    /// Bytes of a safetensors file, right to 4 %, since only the digits of certificates are
    /// unknown. The size of albedos that are refined until their error is met is less certain.
    pub bytes: usize,
    /// Time to bake and certify on the current threads, to a factor of about 2.
    pub seconds: f64,
}

impl std::iter::Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        let none = Self { bytes: 0, seconds: 0.0 };
        costs.fold(none, |a, b| Self { bytes: a.bytes + b.bytes, seconds: a.seconds + b.seconds })
    }
}

/// Seconds of wall time on the current threads, from those of one thread.
pub fn on_threads(seconds: f64) -> f64 {
    seconds / rayon::current_num_threads() as f64
}

/// Bytes of a set without tables: names, materials, conventions, and the formulas of the axes that
/// its tables will have.
pub(crate) fn bare_bytes(provenance: &Provenance) -> usize {
    let has = |convention: &str| provenance.conventions.contains_key(convention);
    let some =
        |of: &dyn Fn(&MaterialEntry) -> bool| has("albedo") && provenance.materials.iter().any(of);
    let index = |entry: &MaterialEntry| entry.fresnel.and_then(|fresnel| fresnel.indices());
    let dielectric = |entry: &MaterialEntry| index(entry).is_some();
    let over_indices = |entry: &MaterialEntry| index(entry).is_some_and(|index| !index.is_point());
    let formulas = Mapping::EVERY.into_iter().filter(|mapping| match mapping {
        Mapping::LogShape(_) | Mapping::LogRoughness(_) | Mapping::ViewBlend(_) => has("albedo"),
        Mapping::Azimuth(_) => {
            some(&|entry| entry.lobes().any(|lobe| !lobe.tabulated().is_family()))
        }
        Mapping::ReflectanceRoot | Mapping::CriticalBlend(_) => some(&dielectric),
        Mapping::CrossingRoot(_) => some(&over_indices),
        _ => has("visible_slope"),
    });
    // Two quotes with their escapes, a colon and a comma.
    let formulas: usize =
        formulas.map(|mapping| mapping.name().len() + mapping.formula().len() + 10).sum();
    describe(provenance, &[]).map_or(0, |json| escaped(&json)) + formulas
}

/// Bytes of a document as a string inside JSON.
fn escaped(json: &str) -> usize {
    json.len() + json.bytes().filter(|byte| matches!(byte, b'"' | b'\\')).count()
}

/// Bytes of the scale and the offset of each channel.
fn scales(precision: Precision, channels: usize) -> usize {
    if precision == Precision::U16 { 26 * channels } else { 0 }
}

/// Counts bytes of descriptions, given those that a file has already: it describes an axis once,
/// and tables of single materials of one layout together.
///
/// The constants in bytes are counted in sets of draft quality of all kinds of tables, as averages
/// over the digits of their figures: kind, columns, certificate, shape and offsets.
#[derive(Default)]
pub(crate) struct Known(HashSet<String>);

impl Known {
    /// Bytes that describe those axes that are new.
    fn axes(&mut self, subject: &Subject, axes: &[Axis]) -> usize {
        let new = stated_axes(subject, axes).into_iter().filter(|json| self.0.insert(json.clone()));
        new.map(|json| escaped(&json) + 1).sum()
    }

    pub(crate) fn normals(&mut self, spec: &TableSpec) -> usize {
        let scales = scales(spec.precision, Kind::VALUE_AND_SLOPE.len());
        self.axes(&Subject::shapes(spec.covers), &axes(spec)) + 2 * spec.name.len() + 400 + scales
    }

    pub(crate) fn radial(&mut self, label: &str, level: Level, precision: Precision) -> usize {
        // A name is as long as its kind and label. π stands for the scale of an axis, which has as
        // many digits.
        let subject = Subject::of(LobeSpec::outside(String::new()));
        let scales = scales(precision, Kind::VALUE_AND_SLOPE.len());
        let header = |(kind, axes): &(Kind, Vec<Axis>)| {
            self.axes(&subject, axes) + 2 * (kind.name().len() + label.len()) + 305 + scales
        };
        radial_axes(level, std::f64::consts::PI, f64::INFINITY).iter().map(header).sum()
    }

    pub(crate) fn albedo(&mut self, spec: &AlbedoSpec) -> usize {
        let (channels, is_single) = (spec.channels(), spec.nodes_of_materials() == 1);
        let lengths: Vec<usize> = spec.axes.iter().map(Axis::len).collect();
        let optics = if matches!(spec.reflectance, Reflectance::Conductor { .. }) { 50 } else { 0 };
        let columns = optics + scales(spec.precision, channels.len());
        let header = |masking: Masking| {
            let axes = self.axes(&spec.subject(masking), &spec.axes);
            if is_single && !self.0.insert(format!("{channels:?}, {masking:?}, {lengths:?}")) {
                return 75 + columns + axes;
            }
            let rest = if is_single { 470 } else { 820 };
            let name = |kind| 2 * spec.name(kind, masking).len();
            let average = if spec.has_averages() { name(Kind::AlbedoAverage) + rest } else { 0 };
            axes + name(Kind::Albedo) + rest + columns + average
        };
        spec.maskings.iter().copied().map(header).sum()
    }
}

/// Microseconds for a node of a table of visible normals, and for a point of its certificate.
fn of_normals(kind: Kind) -> [f64; 2] {
    match kind {
        Kind::Shadowing => [0.2, 0.14],
        Kind::VisibleSlopeConditional => [1.0, 0.15],
        _ => [5.0, 0.5],
    }
}

/// How much longer a node of a single shape takes, whose rows share no work with those of others.
const ALONE: f64 = 2.5;

fn alone(shapes: &[f64]) -> f64 {
    if shapes.len() == 1 { ALONE } else { 1.0 }
}

/// Seconds of one thread to bake a table of visible normals, and to certify it.
pub(crate) fn normals_work(spec: &TableSpec) -> [f64; 2] {
    let shapes = &spec.shapes.nodes;
    let is_exact = spec.shapes.interpolation == Interpolation::Nodes;
    let measured = if is_exact { shapes.len() } else { 4 * shapes.len() - 3 };
    let [node, place] = of_normals(spec.kind).map(|time| 1e-6 * alone(shapes) * time);
    [node * spec.nodes() as f64, place * (measured * POINTS) as f64]
}

/// Microseconds for a node of either slope table of a distribution outside the family (the other
/// tables are far smaller), and for a normal of its certificate, for GTR.
const OF_DISTRIBUTIONS: [f64; 2] = [38.0, 17.0];

/// Factor of [`OF_DISTRIBUTIONS`] for the short tails of Gauss.
const OF_SHORT_TAILS: f64 = 0.65;

/// Whether D has long tails, or may have them.
fn has_long_tails(distribution: &Distribution) -> bool {
    use DistributionKind::{Gauss, Schlick};
    !matches!(distribution, Distribution::Named(Named { kind: Gauss | Schlick, .. }))
}

/// Seconds of one thread to bake the four tables of a distribution, and to certify them.
pub(crate) fn radial_work(distribution: &Distribution, level: Level) -> [f64; 2] {
    let scale = if has_long_tails(distribution) { 1.0 } else { OF_SHORT_TAILS };
    let nodes = |(_, axes): &(Kind, Vec<Axis>)| match &axes[..] {
        [first, last] => first.len() * last.len(),
        _ => 0,
    };
    let nodes: usize = radial_axes(level, 1.0, f64::INFINITY).iter().map(nodes).sum();
    let [node, normal] = OF_DISTRIBUTIONS.map(|time| 1e-6 * scale * time);
    [node * nodes as f64, normal * radial::POINTS as f64]
}

/// Seconds of one thread to measure the error of a table at one point, for the shapes or
/// distributions that take longest. Not for directional albedos.
pub fn point_seconds(table: &Table) -> f64 {
    let of_distributions = 1e-6 * OF_DISTRIBUTIONS[1];
    match table.kind {
        // Two lookups, one of which integrates over the views.
        Kind::AlbedoAverage => 40e-6,
        Kind::RadialShadowing | Kind::RadialDensity | Kind::RadialSlope => of_distributions,
        Kind::RadialConditional => radial::SLANTED * of_distributions,
        kind => 1e-6 * of_normals(kind)[1] * alone(&table.axes[0].nodes),
    }
}

/// Microseconds for a node of albedo tables under one reflectance, and the doublings of an axis
/// that are expected before the error is met. The rows of `planned` are off by at most a factor of
/// 2.1, except for the tilted heavy lobe (2.7 in default quality) and heavy dielectrics (2.2, and
/// 3.2 as drafts).
fn of_albedos(spec: &AlbedoSpec) -> [f64; 2] {
    let lobe = &spec.lobe;
    // Quadrature takes longer where tails are longer.
    let s = 0.5 * (s_of_gamma(lobe.gamma.min) + s_of_gamma(lobe.gamma.max));
    let tails = 1.0 + s;
    match lobe.form() {
        LobeForm::Family if spec.reflectance.indices().is_none() => [70.0, 0.0],
        LobeForm::Family => [300.0 * tails * tails, 0.35],
        LobeForm::StudentT => {
            let [x, y] = lobe.sigma();
            let (rough, elongation) = (x.max(y), x.max(y) / x.min(y));
            // Each factor of 3.3 in elongation takes another doubling of the azimuths, and the 17
            // views of a draft are too few for a lobe that is rough one way and narrow the other.
            let azimuths = (libm::log(elongation) / 1.2 - 0.75).clamp(0.0, 2.0);
            let is_uneven = rough >= 0.3 && elongation > 3.5;
            let views = if is_uneven { libm::log10(spec.tolerance / 1e-6) } else { 0.0 };
            // Two shares instead of one, without the fold of round lobes.
            let refracts = if spec.reflectance.indices().is_some() { 4.0 } else { 1.0 };
            [300.0 * tails * refracts, azimuths + views.clamp(0.0, 1.0)]
        }
        // Of the lobes of `tables/recipes/tilted-lobes.toml` a node at γ = 2 and 3 takes 2.2 to 2.5
        // times as long as one at γ = ∞; of the heaviest tails hardly any light is clamped, and
        // fewer doublings meet the error.
        LobeForm::Ellipsoid => {
            let clamped = (2.0 * s).min(1.0).min(2.0 - s).max(0.1);
            [300.0 * (1.0 + 1.5 * clamped), (2.5 - s).clamp(0.5, 1.5)]
        }
        LobeForm::Distribution => {
            let has_long_tails = lobe.distribution.as_ref().is_some_and(has_long_tails);
            [if has_long_tails { 600.0 } else { 200.0 }, 0.15]
        }
    }
}

/// Factor by which doublings are expected to raise the number of nodes of albedo tables.
pub(crate) fn growth(spec: &AlbedoSpec) -> f64 {
    libm::exp2(of_albedos(spec)[1])
}

fn node_seconds(spec: &AlbedoSpec) -> f64 {
    // A decade of accuracy takes 1.4 times as long; the three indices of a conductor 1.8 times.
    let accurate = libm::pow(1e-6 / spec.tolerance, 0.15);
    let metal = matches!(spec.reflectance, Reflectance::Conductor { .. });
    1e-6 * of_albedos(spec)[0] * accurate * if metal { 1.8 } else { 1.0 }
}

/// Seconds of one thread for a point of the certificate of albedo tables, which is a decade more
/// accurate than a node unless the lobe is tilted, for a shape that is prepared already.
pub fn place_seconds(spec: &AlbedoSpec) -> f64 {
    (if is_bound(spec) { 1.0 } else { 1.6 }) * node_seconds(spec)
}

/// How much longer points along edges and of climbs take for a range of shapes: each has a shape of
/// its own, which takes longer to prepare than to integrate at one view.
const OF_RANGE: f64 = 5.0;

/// The share of the cells' middles that are measured where tables tell which: of a sixteenth for
/// each of four quantities and two axes, most are the same.
const LIKELY: f64 = 0.2;

/// The seconds of one thread for albedo tables.
pub(crate) struct AlbedoWork {
    pub(crate) nodes: f64,
    /// The certificate's points inside, along edges and creases, and of climbs.
    pub(crate) interior: f64,
    pub(crate) edges: f64,
    pub(crate) climbs: f64,
}

impl AlbedoWork {
    pub(crate) fn new(spec: &AlbedoSpec) -> Self {
        let place = place_seconds(spec);
        let has_shapes = matches!(spec.axes[0].mapping, Mapping::LogShape(_));
        let is_range = has_shapes && spec.axes[0].len() > 1 && spec.reflectance.indices().is_none();
        let fresh = if is_range { OF_RANGE } else { 1.0 };
        let middles = points::middle_count(spec) as f64 * if is_bound(spec) { LIKELY } else { 1.0 };
        let edges = middles + (points::crease_count(spec) + points::smooth(spec).len()) as f64;
        // An axis of one node is not climbed along.
        let moving = spec.axes.iter().filter(|axis| axis.len() > 1).count();
        let climbed = climbed_count(spec) * spec.maskings.len() * moving / spec.axes.len();
        Self {
            nodes: node_seconds(spec) * spec.nodes() as f64,
            interior: place * points::interior_count(spec) as f64,
            edges: place * (fresh * points::edge_count(spec) as f64 + edges),
            climbs: place * fresh * climbed as f64,
        }
    }

    /// The seconds of work that each doubling repeats.
    pub(crate) fn doubling(&self) -> f64 {
        self.nodes + self.edges + self.climbs
    }

    /// The seconds of all doublings that are expected: the time of a table grows with its nodes,
    /// as measured at σx/σy from 3 to 30.
    pub(crate) fn ahead(&self, spec: &AlbedoSpec) -> f64 {
        (growth(spec) - 1.0) * self.doubling()
    }

    pub(crate) fn expected(&self, spec: &AlbedoSpec) -> f64 {
        self.interior + self.doubling() + self.ahead(spec)
    }
}
