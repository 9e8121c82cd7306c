//! The contents, subject and axes of a table in words.

use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::Tables;
use microfacet_tables::{
    Axis, Interpolation, Kind, LobeForm, LobeSpec, Mapping, MaterialEntry, Precision, Reflectance,
    Roughness, Subject, Table,
};

use super::material::reflectance;
use super::{count, joined, number, range};

/// What a table holds, and its lobe unless that is the whole family.
pub fn holds(table: &Table) -> String {
    let kind = match table.kind {
        Kind::Shadowing | Kind::RadialShadowing => "masking G1 of a view",
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
    let LobeSpec { theta, distribution, .. } = &table.subject.lobe;
    let tilt = theta.map(|theta| theta.map(number).join(", "));
    let tilt = tilt.map_or(String::new(), |theta| format!(", of an ellipsoid with theta {theta}"));
    let lobe = distribution.as_ref().map_or(tilt, |label| format!(", of {label}"));
    let of = table.subject.reflectance.as_ref();
    let reflectance = of.map_or(String::new(), |of| format!(", {}", reflectance(of)));
    format!("{kind}{lobe}{reflectance}")
}

/// The γ and the σ of the materials that a table serves, as cells of columns.
pub fn covers(Subject { lobe, .. }: &Subject) -> [String; 2] {
    let [x, y] = lobe.sigmas().map(range);
    let gamma = range(lobe.gamma);
    match lobe.form() {
        LobeForm::Distribution => ["-".into(), "its own".into()],
        LobeForm::StudentT | LobeForm::Ellipsoid => [gamma, format!("{x}, {y}")],
        LobeForm::Family if lobe.roughness == Roughness::ALL => [gamma, "any".into()],
        LobeForm::Family => [gamma, x],
    }
}

/// A range of γ, from a range of s = 1/(γ−1).
fn gammas([low, high]: [f64; 2]) -> String {
    range([gamma_of_s(high), gamma_of_s(low)])
}

/// The type of the values.
pub fn precision(precision: Precision) -> &'static str {
    match precision {
        Precision::F32 => "f32",
        Precision::F16 => "f16",
        Precision::U16 => "u16",
    }
}

/// The lobes of which visible normals can be drawn.
pub fn normals(set: &Tables) -> Vec<String> {
    let mut lines: Vec<String> = set.shapes().into_iter().map(gammas).collect();
    // `shapes` ascend in s, and γ falls with s.
    lines.reverse();
    if !lines.is_empty() {
        lines = vec![format!("gamma {}; every sigma", joined(&lines))];
    }
    let mut lobes = set.provenance().materials.iter().flat_map(MaterialEntry::lobes);
    if lobes.any(LobeSpec::is_ggx) && !set.tabulates(2.0) {
        lines.push("gamma 2 (GGX) in closed form".into());
    }
    for table in set.tables() {
        let own = table.subject.lobe.distribution.iter();
        lines.extend(own.filter(|_| table.kind == Kind::RadialSlope).cloned());
    }
    lines
}

/// The lobes of which there are albedos.
pub fn albedos(tables: &[Table]) -> Vec<String> {
    let mut lines: Vec<(String, Vec<String>)> = Vec::new();
    for table in tables.iter().filter(|table| table.kind == Kind::Albedo) {
        let [gamma, sigma] = covers(&table.subject);
        let what = match (&table.subject.lobe.distribution, table.subject.reflectance) {
            (Some(label), _) => label.clone(),
            (_, Some(Reflectance::Mirror) | None) => format!("gamma {gamma}, sigma {sigma}"),
            (_, Some(of)) => format!("gamma {gamma}, sigma {sigma}, {}", reflectance(&of)),
        };
        let masking = table.subject.masking.map_or(String::new(), |form| form.name().to_owned());
        match lines.iter_mut().find(|(known, _)| *known == what) {
            Some((_, forms)) => forms.push(masking),
            None => lines.push((what, vec![masking])),
        }
    }
    lines.iter().map(|(what, forms)| format!("{what}; {} masking", joined(forms))).collect()
}

/// An axis: what it is of, its range and nodes, the coordinate, and what lies between nodes.
pub fn axis(axis: &Axis) -> String {
    let quantities = axis.quantities();
    let ends = || {
        let (least, most) =
            quantities.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
        range([least, most])
    };
    let (what, extent) = match axis.mapping {
        Mapping::InverseShape | Mapping::LogShape(_) => ("the shape gamma", ends()),
        Mapping::LogRoughness(_) => ("the roughness sigma", ends()),
        Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => ("the index of refraction", ends()),
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

/// The coordinate in which nodes are placed, with its name and parameters in files.
fn coordinate(mapping: &Mapping) -> String {
    let words = match mapping {
        Mapping::InverseShape => "in 1/(gamma - 1)",
        Mapping::LogShape(_) => "in a logarithm of the shape",
        Mapping::LogRoughness(_) => "in a logarithm of the roughness",
        Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => "in the fourth root of F0",
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
