//! The certificate of a table in words: the errors that its bake measured, and where.

use microfacet_core::shape::gamma_of_s;
use microfacet_tables::Table;

use super::number;

/// Ends of the keys of a quantity's errors.
const MAX: &str = "_max_error";
const RMS: &str = "_rms_error";
const OUTSIDE: &str = "_max_error_outside";

/// The error that an isotropic stand-in would have; it is none of the table.
const SHORTCUT: &str = "shortcut_max_error";

/// Quantities by their key, the most important first: name in a column, and in a sentence.
const QUANTITIES: [(&str, &str, &str); 12] = [
    ("g1", "G1", "G1"),
    ("cdf", "CDF", "the CDF of visible normals"),
    ("d", "D/D(0)", "D/D(0)"),
    ("e", "E", "E, the albedo with F = 1"),
    ("scale", "scale", "scale, the factor of Schlick's F0"),
    ("bias", "bias", "bias, the factor of Schlick's F90"),
    ("f82", "F82", "F82, the factor of the tint at 82 degrees"),
    ("red", "red", "the red reflectance"),
    ("green", "green", "the green reflectance"),
    ("blue", "blue", "the blue reflectance"),
    ("reflection", "reflected", "the reflected share"),
    ("transmission", "transmitted", "the transmitted share"),
];

/// Key of the shape with the largest error, as s = 1/(γ−1).
const WORST_S: &str = "worst_s";

/// Where the largest error is, by key; s is shown as γ.
const PLACES: [(&str, &str); 7] = [
    (WORST_S, "gamma"),
    ("worst_sigma", "sigma"),
    ("worst_eta", "eta"),
    ("worst_phi", "phi"),
    ("worst_view_cotangent", "cot(theta)/sigma"),
    ("worst_cos_theta", "cos(theta)"),
    ("worst_u", "u"),
];

/// The largest errors of a table, by quantity: those of [`QUANTITIES`] in their order, then others.
fn errors(table: &Table) -> Vec<(&str, f64)> {
    let key = |key: &'static str| (key, format!("{key}{MAX}"));
    let known = QUANTITIES.map(|(name, ..)| key(name));
    let figure = |(name, key): &(&'static str, String)| {
        table.certificate.get(key).map(|error| (*name, *error))
    };
    let mut all: Vec<(&str, f64)> = known.iter().filter_map(figure).collect();
    let others = table.certificate.iter().filter(|(key, _)| *key != SHORTCUT);
    for (key, error) in others {
        if let Some(name) = key.strip_suffix(MAX)
            && all.iter().all(|(known, _)| *known != name)
        {
            all.push((name, *error));
        }
    }
    all
}

/// The quantity with the largest error, as in a column, and that error; `None` if none was
/// measured.
pub fn largest(table: &Table) -> Option<(String, f64)> {
    // Of equal errors the first, and a NaN before any number.
    let worse = |a: (_, f64), b: (_, f64)| if b.1.total_cmp(&a.1).is_gt() { b } else { a };
    let (key, error) = errors(table).into_iter().reduce(worse)?;
    let known = QUANTITIES.iter().find(|(known, ..)| *known == key);
    Some((known.map_or_else(|| key.to_owned(), |known| known.1.to_owned()), error))
}

/// The whole certificate, a line for each figure.
pub fn lines(table: &Table) -> Vec<String> {
    let figures = &table.certificate;
    let mut shown = vec![SHORTCUT.to_owned(), "points".into(), "quadrature_error".into()];
    let mut lines = Vec::new();
    for (key, max) in errors(table) {
        let name = QUANTITIES.iter().find(|(known, ..)| *known == key);
        let name = name.map_or(key, |known| known.2);
        let mut line = format!("largest error of {name}: {}", super::error(max));
        let others = [(RMS, "root mean square"), (OUTSIDE, "beyond the promised range")];
        for (end, what) in others {
            let key = format!("{key}{end}");
            if let Some(figure) = figures.get(&key) {
                line += &format!(", {what} {}", super::error(*figure));
            }
            shown.push(key);
        }
        shown.push(format!("{key}{MAX}"));
        lines.push(line);
    }
    let place = |(key, name): &(&str, &str)| {
        let x = *figures.get(*key)?;
        let x = if *key == WORST_S { gamma_of_s(x) } else { x };
        Some(format!("{name} {}", number(x)))
    };
    let places: Vec<String> = PLACES.iter().filter_map(place).collect();
    if !places.is_empty() {
        lines.push(format!("the largest of all is at {}", places.join(", ")));
    }
    if let Some(points) = figures.get("points") {
        let exact = figures.get("quadrature_error").map_or(String::new(), |error| {
            format!("; the values at the nodes are exact to {}", super::error(*error))
        });
        lines.push(format!("measured at {points} points{exact}"));
    }
    if let Some(error) = figures.get(SHORTCUT) {
        lines.push(format!(
            "an isotropic table at sqrt(sigma_x sigma_y) in its place would be off by up to {}",
            super::error(*error)
        ));
    }
    // Of files by other programs, or later versions.
    let known = |key: &String| shown.contains(key) || PLACES.iter().any(|place| place.0 == key);
    let others = figures.iter().filter(|(key, _)| !known(key));
    lines.extend(others.map(|(key, figure)| format!("{key} {}", number(*figure))));
    lines
}
