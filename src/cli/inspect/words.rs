//! What a table holds, is of, and lies over, in words.

use microfacet_common::shape::gamma_of_s;
use microfacet_sampler::{
    Axis, Covered, FresnelEntry, Interpolation, Kind, LobeEntry, Mapping, MaterialEntry, Precision,
    Subject, Table,
};

use crate::cli::escape;
use crate::cli::plan::reflectance;
use crate::cli::words::{count, number, range};

/// What a table holds, and of what it is if that is not the whole family.
pub(super) fn holds(table: &Table) -> String {
    let kind = match table.kind {
        Kind::Shadowing | Kind::RadialShadowing => "Smith's G1 of a view",
        Kind::VisibleSlope | Kind::RadialSlope => {
            "slopes of visible normals, in the plane of incidence"
        }
        Kind::VisibleSlopePeeled => {
            "slopes of visible normals, in the plane of incidence, without their heavy part"
        }
        Kind::VisibleSlopeConditional | Kind::RadialConditional => {
            "slopes of visible normals, across that plane"
        }
        Kind::RadialDensity => "the distribution of normals D",
        Kind::Albedo => "directional albedo",
        Kind::AlbedoAverage => "cosine-weighted average of the albedo",
        other => other.name(),
    };
    let lobe = match &table.subject.lobe {
        LobeEntry::Family | LobeEntry::StudentT { .. } => String::new(),
        LobeEntry::Ellipsoid { theta, .. } => {
            format!(", of an ellipsoid with theta {}", theta.map(number).join(", "))
        }
        LobeEntry::Distribution(label) => format!(", of {}", escape::line(label)),
    };
    let of = table.subject.reflectance.as_ref();
    let reflectance = of.map_or(String::new(), |of| format!(", {}", reflectance(of)));
    format!("{kind}{lobe}{reflectance}")
}

/// The γ and the σ of the materials that a table serves, as cells of columns.
pub(super) fn covers(Subject { lobe, covers, .. }: &Subject) -> [String; 2] {
    match (lobe, covers) {
        (LobeEntry::Distribution(_), _) => ["-".into(), "its own".into()],
        (LobeEntry::StudentT { sigma, s } | LobeEntry::Ellipsoid { sigma, s, .. }, _) => {
            [number(gamma_of_s(*s)), sigma.map(number).join(", ")]
        }
        (LobeEntry::Family, Some(Covered { s, sigma })) => {
            [gammas(*s), sigma.map_or("any".into(), range)]
        }
        (LobeEntry::Family, None) => ["-".into(), "-".into()],
    }
}

/// A range of γ, from a range of s = 1/(γ−1).
pub(super) fn gammas([low, high]: [f64; 2]) -> String {
    range([gamma_of_s(high), gamma_of_s(low)])
}

pub(super) fn precision(precision: Precision) -> &'static str {
    match precision {
        Precision::F32 => "f32",
        Precision::F16 => "f16",
        Precision::U16 => "u16",
    }
}

/// A material of the recipe.
pub(super) fn material(entry: &MaterialEntry) -> String {
    let mut parts = Vec::new();
    if entry.is_smooth() {
        parts.push("smooth".into());
    } else if entry.distribution.is_empty() {
        let [x, y] = entry.sigma.map(range);
        parts.push(if x == y { format!("sigma {x}") } else { format!("sigma {x} and {y}") });
        parts.push(format!("gamma {}", gammas(entry.s)));
    } else {
        parts.push(escape::line(&entry.distribution).into());
    }
    parts.extend(entry.theta.map(|theta| format!("theta {}", theta.map(number).join(", "))));
    parts.extend(entry.masking.map(|masking| format!("{masking} masking")));
    parts.extend(entry.fresnel.map(|fresnel| match fresnel {
        FresnelEntry::Mirror => "F = 1".into(),
        FresnelEntry::Schlick([r, g, b]) if r == g && g == b => {
            format!("Schlick with F0 {}", number(r))
        }
        FresnelEntry::Schlick(f0) => format!("Schlick with F0 {}", f0.map(number).join(", ")),
        FresnelEntry::Conductor { eta, k } => {
            let [eta, k] = [eta, k].map(|rgb| rgb.map(number).join(", "));
            format!("conductor with eta {eta} and k {k}")
        }
        FresnelEntry::Dielectric(eta) => format!("dielectric of index {}", number(eta)),
        FresnelEntry::Dielectrics { min, max } => {
            format!("dielectric of index {}", range([min, max.unwrap_or(f64::INFINITY)]))
        }
    }));
    format!("\"{}\": {}", escape::line(&entry.name), parts.join(", "))
}

/// An axis: what it is of, its range and nodes, the coordinate, and what lies between nodes.
pub(super) fn axis(axis: &Axis) -> String {
    let quantities = axis.quantities();
    let ends = || {
        let (least, most) =
            quantities.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
        range([least, most])
    };
    let (what, extent) = match axis.mapping {
        Mapping::InverseShape | Mapping::LogShape(_) => ("the shape gamma", ends()),
        Mapping::LogRoughness(_) => ("the roughness sigma", ends()),
        Mapping::ReflectanceRoot => ("the index of refraction", ends()),
        Mapping::Azimuth(azimuth) if azimuth.fold => {
            ("the azimuth of the view", "a quarter of a turn, which repeats mirrored".into())
        }
        Mapping::Azimuth(_) => ("the azimuth of the view", "a whole turn".into()),
        Mapping::MirroredRoot | Mapping::OddRoot => ("a random number", "0 to 1".into()),
        Mapping::ViewBlend(_) | Mapping::CriticalBlend(_) => {
            ("the view by cos(theta)", "from the horizon to the normal".into())
        }
        _ if axis.name == "slope" => ("the slope z of the normal", "0 to the largest".into()),
        _ => ("the view by z = cot(theta)/sigma", "from the horizon to the normal".into()),
    };
    let nodes = count(axis.len(), "node");
    format!("{what}: {extent}; {nodes}, {}; {}", coordinate(&axis.mapping), between(axis))
}

/// The coordinate in which nodes stand, with its name and parameters in files.
fn coordinate(mapping: &Mapping) -> String {
    let words = match mapping {
        Mapping::InverseShape => "in 1/(gamma - 1)",
        Mapping::LogShape(_) => "in a logarithm of the shape",
        Mapping::LogRoughness(_) => "in a logarithm of the roughness",
        Mapping::ReflectanceRoot => "in the fourth root of F0",
        Mapping::HalfTangent(_) => "in tan(atan(z)/2)",
        Mapping::Rational(_) => "in z/(z + kappa)",
        Mapping::ViewBlend(_) => "in a blend of roots of cos(theta)",
        Mapping::CriticalBlend(_) => "in a blend of roots on either side of the critical angle",
        Mapping::Azimuth(_) => "in the azimuth of the lobe's own frame",
        Mapping::MirroredRoot => "in a fourth root from either end",
        Mapping::OddRoot => "in a fourth root from the end, odd about 1/2",
        _ => "in a coordinate",
    };
    let document = serde_json::to_value(mapping).expect("numbers and names");
    let parameters = document.as_object().into_iter().flatten();
    let parameters = parameters.filter(|(name, _)| *name != "kind").map(|(name, value)| {
        value
            .as_f64()
            .map_or_else(|| format!(" {name} {value}"), |x| format!(" {name} {}", number(x)))
    });
    let parameters: Vec<String> = parameters.collect();
    format!("{words} ({}{})", mapping.name(), parameters.join(","))
}

/// How values between the nodes of an axis are found.
fn between(axis: &Axis) -> &'static str {
    if axis.len() == 1 {
        return "at the node only";
    }
    match axis.interpolation {
        Interpolation::Linear => "linear between them",
        Interpolation::Hermite => "cubic Hermite between them",
        Interpolation::Lagrange4 => "the polynomial of the nearest 4 between them",
        Interpolation::Lagrange6 => "the polynomial of the nearest 6 between them",
        Interpolation::Nodes => "at the nodes only",
        _ => "an interpolation of a later version between them",
    }
}
