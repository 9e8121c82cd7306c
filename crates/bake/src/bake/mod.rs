//! Bakes tables from specifications, in parallel over γ and view.
//!
//! Values are computed in f64 with the functions of the `libm` crate and rounded to f32 once, at
//! the end: the bytes are the same on every system, with any number of threads and in every build.

pub mod albedo;
mod conditional;
mod radial;
mod shadowing;
mod visible_slope;

use microfacet_model::{Shape, SignedSlope};
use microfacet_tables::axis::{MirroredRoot, half_tangent};
use microfacet_tables::{Axis, Channels, Interpolation, Kind, Mapping, Subject, Table};

use crate::progress::Stage;
use crate::table_spec::{ShapeAxis, TableSpec};

pub(crate) use radial::radial_subject;
pub use radial::{bake_radial, radial_axes, radial_bytes};

/// Number of the numeric method: raised when the same specification gives other values or
/// certificates. It is part of every file and of every cache key.
pub const NUMERICS: u32 = 12;

/// u at which the ends of a mirrored axis are evaluated where u = 0 itself is an infinite slope:
/// 2⁻⁴⁰. For Beckmann it keeps every stored slope below 5.3; the CDF error it causes is 2⁻⁴⁰ too.
const END: f64 = 1.0 / 1_099_511_627_776.0;

/// Bakes one table; each row is one step of the stage.
pub fn bake(spec: &TableSpec, stage: &Stage) -> Table {
    let axes = axes(spec);
    let values = match spec.kind {
        Kind::Shadowing => shadowing::bake(spec, &axes, stage),
        Kind::VisibleSlope | Kind::VisibleSlopePeeled => visible_slope::bake(spec, &axes, stage),
        Kind::VisibleSlopeConditional => conditional::bake(spec, &axes, stage),
        _ => unreachable!("kinds are listed in `axes`, which comes first"),
    };
    Table::new(&spec.name, spec.kind, Subject::shapes(spec.covers), axes, values)
        .rounded(spec.precision)
}

/// The axes of a table, from its specification.
pub fn axes(spec: &TableSpec) -> Vec<Axis> {
    let ShapeAxis { nodes, interpolation } = spec.shapes.clone();
    let gamma = Axis::new("gamma", Mapping::InverseShape, interpolation, nodes);
    let view = |mapping, interpolation| Axis::placed("view", mapping, interpolation, spec.views);
    match spec.kind {
        Kind::Shadowing => {
            vec![gamma, view(Mapping::Rational(shadowing::view(spec)), Interpolation::Hermite)]
        }
        Kind::VisibleSlopeConditional => vec![gamma, across(spec.numbers)],
        _ => {
            let mapping = Mapping::HalfTangent(visible_slope::view(spec.kind));
            vec![gamma, view(mapping, Interpolation::Linear), along(spec.numbers)]
        }
    }
}

/// The axis of u₁, for the in-plane slope.
fn along(count: usize) -> Axis {
    Axis::placed("u1", Mapping::MirroredRoot, Interpolation::Hermite, count)
}

/// The axis of u₂, for the slope across, in which all quantiles are odd.
fn across(count: usize) -> Axis {
    Axis::placed("u2", Mapping::OddRoot, Interpolation::Hermite, count)
}

fn names(channels: Channels) -> Vec<String> {
    channels.iter().map(|&name| name.into()).collect()
}

fn shapes(spec: &TableSpec) -> Vec<Shape> {
    let shape = |&s: &f64| Shape::from_s(s).expect("specifications hold s in [0, 2)");
    spec.shapes.nodes.iter().map(shape).collect()
}

/// Rounds (value, slope) pairs to f32; no other function of a bake rounds them.
fn round(nodes: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f32; 2]> {
    nodes.into_iter().map(|[value, slope]| [value as f32, slope as f32]).collect()
}

/// u ≤ ½ at the coordinate t ∈ [0, 1] of a mirrored axis, at least [`END`], and du/dt.
fn mirrored(t: f64) -> (f64, f64) {
    // (2 END)^(1/4) is not a power of two; t itself enters only the derivative, whose end value is
    // limited anyway.
    let t = t.max(MirroredRoot::of_number(END));
    (MirroredRoot::number(t), MirroredRoot::rate(t))
}

/// Distance of the half tangent of a unit slope from the end −1 or 1, without cancellation.
fn distance(shape: &Shape, x: SignedSlope, end: f64) -> f64 {
    let (sin, cos) = shape.unit_sin_cos(x.w);
    let [low, high] = half_tangent::ends(x.sign * sin, cos);
    if end < 0.0 { low } else { high }
}

/// d h/d w of the half tangent h of a unit slope x(w), dx/dw = √(1 + s x²).
fn half_tangent_rate(shape: &Shape, x: SignedSlope) -> f64 {
    // dα/dx = cos² α, one cosine of which makes dx/dw finite.
    let (sin, cos) = shape.unit_sin_cos(x.w);
    half_tangent::angle_rate(sin, cos) * cos * (cos * cos + shape.s() * sin * sin).sqrt()
}
