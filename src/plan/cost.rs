//! What a bake costs, before it is done.

use microfacet_sampler::{Interpolation, Kind, Provenance, describe};

use crate::bake;
use crate::generate::CERTIFICATE_POINTS;
use crate::spec::TableSpec;

/// Bytes and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Size of the set's safetensors file.
    pub bytes: usize,
    /// Time to bake and certify it on the threads at hand.
    pub seconds: f64,
}

/// Estimates the cost of a set: the bytes to a few per cent, since only the digits of the certificates are unknown; the seconds from what
/// `docs/planning.md` measured on one machine, so that ratios mean more than themselves.
pub fn cost(specs: &[TableSpec], provenance: &Provenance) -> Cost {
    // Escapes of the document, a string inside JSON.
    let escaped = |json: &str| json.len() + json.bytes().filter(|byte| matches!(byte, b'"' | b'\\')).count();
    let document = describe(provenance, &[]).map_or(0, |json| escaped(&json));
    let header = |spec: &TableSpec| {
        let axes = serde_json::to_string(&bake::axes(spec)).map_or(0, |json| escaped(&json));
        // Name twice, kind, channels, certificate, shape and offsets.
        axes + 2 * spec.name.len() + 440
    };
    let bytes = document + specs.iter().map(|spec| spec.bytes() + header(spec)).sum::<usize>();
    // Not `sum`, which gives −0 for none.
    let work = specs.iter().map(seconds).fold(0.0, |sum, one| sum + one);
    Cost { bytes, seconds: work / rayon::current_num_threads() as f64 }
}

/// Seconds that one thread bakes and certifies a table.
fn seconds(spec: &TableSpec) -> f64 {
    // Nanoseconds a node and a point of the certificate, as `bake --threads 1` took.
    let [node, point] = match spec.kind {
        Kind::Shadowing => [400.0, 250.0],
        Kind::VisibleSlopeConditional => [900.0, 400.0],
        _ => [1800.0, 800.0],
    };
    let shapes = spec.shapes.nodes.len();
    let measured = if spec.shapes.interpolation == Interpolation::Nodes { shapes } else { 4 * shapes - 3 };
    1e-9 * (node * spec.nodes() as f64 + point * (measured * CERTIFICATE_POINTS) as f64)
}
