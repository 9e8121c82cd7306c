//! Estimates what a bake costs before it is done.

use microfacet_sampler::internals::describe;
use microfacet_sampler::{
    Axis, Interpolation, Kind, LobeEntry, Mapping, Masking, MaterialEntry, Precision, Provenance,
    Reflectance,
};

use super::Plan;
use crate::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec};
use crate::bake::{self};
use crate::distribution::Distribution;
use crate::table_spec::{Level, Quality, TableSpec, general_set};
use crate::validate::certificate::POINTS;
use crate::validate::{points, radial};

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

/// Estimates the bytes of a set without tables: its names, its recipe, its conventions, and the
/// formulas of the axes that its tables will have.
pub fn bare_cost(provenance: &Provenance) -> Cost {
    let has = |convention: &str| provenance.conventions.contains_key(convention);
    let some =
        |of: &dyn Fn(&MaterialEntry) -> bool| has("albedo") && provenance.materials.iter().any(of);
    let dielectric = |entry: &MaterialEntry| entry.fresnel.is_some_and(|f| f.indices().is_some());
    let formulas = Mapping::EVERY.into_iter().filter(|mapping| match mapping {
        Mapping::LogShape(_) | Mapping::LogRoughness(_) | Mapping::ViewBlend(_) => has("albedo"),
        Mapping::Azimuth(_) => some(&|entry| entry.lobe() != LobeEntry::Family),
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

/// Estimates what tables add to a set. The bytes are right to a few per cent, since only the digits
/// of certificates are unknown. The seconds, on the current threads, are scaled from times measured
/// on one machine: their ratios are more reliable than their values.
pub fn cost(specs: &[TableSpec]) -> Cost {
    let header = |spec: &TableSpec| {
        let axes = serde_json::to_string(&bake::axes(spec)).map_or(0, |json| escaped(&json));
        // Name twice, kind, channels, certificate, shape and offsets.
        axes + 2 * spec.name.len() + 440
    };
    let bytes = specs.iter().map(|spec| spec.bytes() + header(spec)).sum();
    Cost { bytes, seconds: seconds(specs) }
}

/// Estimates a whole set of this quality.
///
/// # Errors
/// [`AlbedoError`] for an albedo that no table can hold.
pub fn set_cost(plan: &Plan, quality: Quality, precision: Precision) -> Result<Cost, AlbedoError> {
    let general = general_set(quality, precision);
    let shapes = plan.shapes.iter().map(|need| Ok(cost(&need.specs(&general))));
    let albedos = plan.albedos.iter().map(|need| Ok(albedo_cost(&need.spec(quality, precision)?)));
    let own = plan.distributions.iter().map(|own| Ok(distribution_cost(own, quality, precision)));
    shapes.chain(albedos).chain(own).chain([Ok(bare_cost(&plan.provenance()))]).sum()
}

/// The seconds of [`cost`] alone, which are quick to estimate.
pub fn seconds(specs: &[TableSpec]) -> f64 {
    specs.iter().map(seconds_of).sum::<f64>() / rayon::current_num_threads() as f64
}

/// The cost of albedo tables, with the nodes that are tried first.
pub fn albedo_cost(spec: &AlbedoSpec) -> Cost {
    let json = |axes: &[Axis]| serde_json::to_string(axes).map_or(0, |json| escaped(&json));
    // Name twice, kind, subject, channels, certificate, shape and offsets; for averages, over all
    // axes but the view.
    let name = |kind| 2 * spec.name(kind, Masking::HeightCorrelated).len();
    let subject = serde_json::to_string(&spec.reflectance).map_or(0, |json| escaped(&json));
    let one = json(&spec.axes) + name(Kind::Albedo) + subject + 800;
    let average = json(&spec.axes[..2]) + name(Kind::AlbedoAverage) + subject + 680;
    let headers = spec.maskings.len() * (one + if spec.has_averages() { average } else { 0 });
    let threads = rayon::current_num_threads() as f64;
    Cost { bytes: spec.bytes() + headers, seconds: albedo_seconds(spec) / threads }
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
    let suffix = distribution.label().len();
    // Another number of the same length stands for the scale and the reach in the axes.
    let tables = bake::radial_axes(level, std::f64::consts::PI, f64::INFINITY);
    let header = |(kind, axes): &(Kind, Vec<Axis>)| {
        let axes = serde_json::to_string(axes).map_or(0, |json| escaped(&json));
        axes + 2 * (kind.name().len() + suffix) + 330
    };
    let bytes = tables.iter().map(header).sum::<usize>() + bake::radial_bytes(level, precision);
    // Microseconds for a node of either slope table (the other tables are far smaller) and for a
    // normal of the certificate: fitted to the processor time of `microfacet-bake bake --threads 1
    // --no-cache --quality Q` for a Gauss, a GTR, a Schlick and a measured distribution. Their mean
    // is met within a twentieth at each quality, a single one within a third.
    let [node, normal] = [65.0, 30.0];
    let nodes = |(_, axes): &(Kind, Vec<Axis>)| match &axes[..] {
        [first, last] => first.len() * last.len(),
        _ => 0,
    };
    let nodes: usize = tables.iter().map(nodes).sum();
    let seconds = 1e-6 * (node * nodes as f64 + normal * radial::POINTS as f64);
    Cost { bytes, seconds: seconds / rayon::current_num_threads() as f64 }
}

/// Seconds for one thread to bake and certify albedo tables.
fn albedo_seconds(spec: &AlbedoSpec) -> f64 {
    // Microseconds for a node or a point of the certificate: fitted to `microfacet-bake bake
    // --threads 1 --no-cache --out out` of the draft, the default and the high general set, which
    // are met within a tenth; single materials, dielectrics and other lobes within a half. Long
    // tails and narrow lobes take up to twice as long, and so does refinement.
    let (nodes, points) = (spec.nodes() as f64, points::count(spec) as f64);
    1e-6 * match (&spec.lobe, spec.reflectance) {
        (_, Reflectance::Dielectric { .. }) => 3300.0 * (nodes + points),
        // Each decade of accuracy takes twice as long, and certificates are a decade finer.
        (AlbedoLobe::Family(_), _) => {
            895.0 * libm::pow(1e-6 / spec.tolerance, 0.32) * (nodes + 2.1 * points)
        }
        _ => 10_000.0 * (nodes + points),
    }
}

/// Seconds for one thread to bake and certify a table.
fn seconds_of(spec: &TableSpec) -> f64 {
    // Nanoseconds for a node and for a point of the certificate: fitted to `time microfacet-bake
    // bake --threads 1 --no-cache --quality Q` at the three qualities, which are met within a
    // tenth.
    let [node, point] = match spec.kind {
        Kind::Shadowing => [400.0, 250.0],
        Kind::VisibleSlopeConditional => [2000.0, 350.0],
        _ => [5800.0, 580.0],
    };
    let shapes = spec.shapes.nodes.len();
    let measured =
        if spec.shapes.interpolation == Interpolation::Nodes { shapes } else { 4 * shapes - 3 };
    1e-9 * (node * spec.nodes() as f64 + point * (measured * POINTS) as f64)
}
