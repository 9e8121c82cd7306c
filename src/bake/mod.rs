//! From a specification to a table: pure functions, one file a kind, parallel over γ and view.
//!
//! Everything is computed in f64 with the `libm` crate's functions and rounded once, to f32, at the end: the bytes
//! are the same on every system, with any number of threads and in every build.

pub mod albedo;
mod conditional;
pub mod dielectric_albedo;
pub mod fresnel_albedo;
mod radial;
mod shadowing;
pub mod view_albedo;
mod visible_slope;

use microfacet_model::{Shape, SignedUnit};
use microfacet_sampler::{Axis, Interpolation, Kind, Mapping, Table};

use crate::spec::TableSpec;

pub use radial::{bake_radial, radial_axes, radial_bytes};

/// Changes whenever the same specification would give other values: part of every file, and of every cache key.
pub const NUMERICS: u32 = 1;

/// The random numbers' axes: t = (2 min(u, 1−u))^(1/4).
const POWER: u32 = 4;

/// u at which the ends of a mirrored axis are evaluated where u = 0 itself is an infinite slope: 2⁻⁴⁰. For Beckmann it keeps every
/// stored slope finite (below 5.3); the CDF error it makes is itself.
const END: f64 = 1.0 / 1_099_511_627_776.0;

/// Bakes one table.
pub fn bake(spec: &TableSpec) -> Table {
    let values = match spec.kind {
        Kind::Shadowing => shadowing::bake(spec),
        Kind::VisibleSlope | Kind::VisibleSlopePeeled => visible_slope::bake(spec),
        Kind::VisibleSlopeConditional => conditional::bake(spec),
        _ => unreachable!("kinds are listed in `axes`, which comes first"),
    };
    let table = Table {
        name: spec.name.clone(),
        kind: spec.kind,
        axes: axes(spec),
        channels: vec!["value".into(), "slope".into()],
        masking: None,
        values,
        precision: spec.precision,
        certificate: Default::default(),
    };
    table.rounded(spec.precision)
}

/// The axes of a table, from its specification.
pub fn axes(spec: &TableSpec) -> Vec<Axis> {
    let axis = |name: &str, unit: &str, mapping, interpolation, nodes| Axis {
        name: name.into(),
        unit: unit.into(),
        mapping,
        interpolation,
        nodes,
    };
    let numbers = |name: &str, odd| {
        let mapping = Mapping::MirroredPower { power: POWER, odd };
        axis(name, "1", mapping, Interpolation::Hermite, Axis::uniform_nodes(spec.numbers))
    };
    let shapes = spec.shapes.clone();
    let gamma = axis("gamma", "1", Mapping::InverseShape, shapes.interpolation, shapes.nodes);
    let view =
        |mapping, interpolation| axis("view", "1", mapping, interpolation, Axis::uniform_nodes(spec.views));
    match spec.kind {
        Kind::Shadowing => vec![gamma, view(shadowing::view(spec), Interpolation::Hermite)],
        Kind::VisibleSlopeConditional => vec![gamma, numbers("u2", true)],
        _ => vec![gamma, view(visible_slope::view(spec.kind), Interpolation::Linear), numbers("u1", false)],
    }
}

/// The shapes along the γ axis.
fn shapes(spec: &TableSpec) -> Vec<Shape> {
    let shape = |&s: &f64| Shape::from_s(s).expect("specifications hold s in [0, 2)");
    spec.shapes.nodes.iter().map(shape).collect()
}

/// Rounds (value, slope) pairs to f32, the one place where a bake does.
fn round(nodes: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f32; 2]> {
    nodes.into_iter().map(|[value, slope]| [value as f32, slope as f32]).collect()
}

/// u ≤ ½ at the coordinate t ∈ [0, 1] of a mirrored axis, and du/dt; not below [`END`].
fn mirrored(t: f64) -> (f64, f64) {
    // (2 END)^(1/4) is not a power of two; t itself only enters the derivative, whose end value is limited anyway.
    let t = t.max((2.0 * END).sqrt().sqrt());
    (0.5 * t * t * t * t, 2.0 * t * t * t)
}

/// Distance of the half tangent of a unit slope from the end −1 or 1, without cancellation.
fn distance(shape: &Shape, x: SignedUnit, end: f64) -> f64 {
    let (sin, cos) = shape.unit_sin_cos(x.w);
    if x.sign == end {
        // (1 + cos − sin)/(1 + cos), and 1 − sin = cos²/(1 + sin).
        (cos + cos * cos / (1.0 + sin)) / (1.0 + cos)
    } else {
        1.0 + sin / (1.0 + cos)
    }
}

/// d h/d w of the half tangent: h = tan(α/2) with tan α = x, and dx/dw = √(1 + s x²).
fn half_tangent_rate(shape: &Shape, x: SignedUnit) -> f64 {
    let (sin, cos) = shape.unit_sin_cos(x.w);
    let h = sin / (1.0 + cos);
    0.5 * (1.0 + h * h) * cos * (cos * cos + shape.s() * sin * sin).sqrt()
}
