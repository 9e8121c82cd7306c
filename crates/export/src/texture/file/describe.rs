//! The description of a texture as JSON: a file, and inside the formats that can hold it.

use serde_json::{Map, Value, json};

use microfacet_tables::axis::LogShape;

use super::Made;
use crate::numbers::{as_typed, single};
use crate::texture::interface::{KNEE, POWER, WIDTH};
use crate::texture::{Along, Channel, Deviation, Edge, Place, Texture, shader_lines};

/// The description, without entries that do not apply.
pub(super) fn description(made: &Made) -> Map<String, Value> {
    let (texture, spec) = (&made.texture, &made.texture.spec);
    let average = !spec.is_directional();
    let quantity =
        if average { "average over all views of the albedo" } else { "directional albedo" };
    let axes = spec.axes.iter().map(|axis| {
        let mut one = along(axis.along, spec.gamma);
        one["texels"] = axis.len().into();
        one
    });
    let side = spec.side();
    let subject = match side {
        None => format!("{quantity} of reflection by the Student-t distribution, F = 1"),
        Some(side) => format!(
            "{quantity} of reflection and of transmission by an interface seen from {side}, with \
             facets of the Student-t distribution"
        ),
    };
    let mirror = if average { "1/21" } else { "(1 - mu)^5" };
    let meaning = match spec.channels[..] {
        [Channel::E, Channel::Excess] => {
            json!(format!("bias = bias_excess + e {mirror}, scale = e - bias"))
        }
        [Channel::ReflectedExcess, Channel::TransmittedExcess] => json!(MEANING_OF_SHARES),
        _ => Value::Null,
    };
    let before = made.before_rounding.as_ref();
    let all = [
        ("generator", json!(concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")))),
        ("quantity", json!(subject)),
        ("masking", json!(spec.masking.name())),
        ("gamma", json!((!spec.gamma.is_nan()).then(|| as_typed(spec.gamma)))),
        ("side", json!(side)),
        ("eta", json!(spec.eta)),
        ("axes_slowest_first", axes.collect()),
        ("channels", spec.channels.iter().map(|channel| channel.name()).collect()),
        ("meaning", meaning),
        ("coordinates", json!("c in [0, 1] along n texels is read at (1/2 + (n - 1) c) / n")),
        ("precision", json!(if texture.half { "f16" } else { "f32" })),
        (
            "values",
            json!(if spec.fitted { "fitted to the linear filter" } else { "exact at the texels" }),
        ),
        ("least_cos_theta", json!((!average).then_some(spec.least_cos))),
        ("errors", errors(&made.errors)),
        ("largest_errors_along_edges", edges(&made.edges)),
        ("errors_in_f32", json!(before.map(|before| errors(&before.errors)))),
        ("largest_rounding_to_f16", json!(before.map(|before| rounded(before.rounding)))),
        ("read", json!(shader_lines(spec))),
    ];
    let all = all.into_iter().filter(|(_, value)| !value.is_null());
    all.map(|(key, value)| (key.into(), value)).collect()
}

/// How both shares follow from a texture of an interface.
const MEANING_OF_SHARES: &str = "reflected = reflected_excess + f, transmitted = \
    transmitted_excess + 1 - f; f = ((mu - g)/(mu + g))^2 (1 + ((mu (mu + g) - 1)/(mu (g - mu) + \
    1))^2)/2, g^2 = max(0, past) + rim^2/(2 (|past| + rim)), past = mu^2 + eta^2 - 1, rim = sigma \
    mu sqrt(1 - mu^2); eta is the index beyond the interface over that on the side of the view";

fn edges(all: &[(Edge, Vec<Deviation>)]) -> Value {
    let entry = |(edge, errors): &(Edge, Vec<Deviation>)| {
        let one = |error: &Deviation| (error.quantity.to_owned(), json!(error.stated()));
        (edge.name().to_owned(), Value::Object(errors.iter().map(one).collect()))
    };
    let all: Map<String, Value> = all.iter().map(entry).collect();
    if all.is_empty() { Value::Null } else { Value::Object(all) }
}

fn errors(all: &[Deviation]) -> Value {
    let entry = |error: &Deviation| {
        let mut entry = json!({
            "largest": error.stated(),
            "at": at(&error.at),
            "rms": rounded(error.rms),
            "largest_if_filter_has_256_steps": error.stated_coarse(),
        });
        // Shaders divide by it.
        if error.quantity == "e" {
            entry["largest_relative"] = rounded(error.relative[0]);
        }
        (error.quantity.to_owned(), entry)
    };
    Value::Object(all.iter().map(entry).collect())
}

fn along(along: Along, gamma: f64) -> Value {
    match along {
        Along::Shape { smallest } => json!({
            "coordinate": format!(
                "ln(1 + {scale} / (2 gamma - 3)) / ln(1 + {scale} / (2 gamma_min - 3))",
                scale = LogShape::BAKED.scale
            ),
            "gamma_min": smallest,
        }),
        Along::Index { ends: [least, most], .. } => json!({
            "coordinate": "(v - v_min) / (v_max - v_min), v = sqrt(|eta - 1| / (eta + 1)), v_min \
                and v_max of eta_min and eta_max",
            "eta_min": least,
            "eta_max": most,
        }),
        Along::Critical { near } => json!({
            "coordinate": format!(
                "near x^{POWER} + (1 - near)/2 (1 + past/(|past| + {WIDTH} rim)), x = mu / (mu + kappa \
                 sigma sqrt(1 - mu^2)), past = mu^2 + eta^2 - 1, rim = sigma mu sqrt(1 - mu^2), mu \
                 = cos theta"
            ),
            "near": near,
            "kappa": KNEE[0] + KNEE[1] / (2.0 * gamma - 3.0),
        }),
        Along::Roughness { largest } => {
            json!({ "coordinate": "sqrt(sigma / sigma_max)", "sigma_max": largest })
        }
        Along::LinearRoughness => json!({ "coordinate": "sigma" }),
        Along::View(view) => json!({
            "coordinate": "(mu / (mu + kappa sigma sqrt(1 - mu^2)))^(1/4), mu = cos theta",
            "kappa": if gamma.is_nan() {
                json!(format!("{} + {} / (2 gamma - 3)", view.scale, view.heavy))
            } else {
                json!(view.of_shape(gamma).scale)
            },
        }),
        Along::Cosine { .. } => json!({ "coordinate": "mu = cos theta" }),
        Along::Angle => json!({ "coordinate": "2 theta / pi" }),
        Along::RootVersine { .. } => json!({ "coordinate": "sqrt(1 - mu), mu = cos theta" }),
        Along::LinearIndex { first, last, inside } => json!({
            "coordinate": format!("(n - {first}) / ({last} - {first}), n = {}", index(inside)),
        }),
        Along::Contrast { inside, .. } => json!({
            "coordinate": format!("sqrt((n - 1) / (n + 1)), n = {}", index(inside)),
        }),
    }
}

/// n, in words of η.
fn index(inside: bool) -> &'static str {
    if inside { "1 / eta" } else { "eta" }
}

/// An error in three digits.
fn rounded(x: f64) -> Value {
    read(&format!("{x:.2e}"))
}

fn read(number: &str) -> Value {
    number.parse::<f64>().map_or(Value::Null, Value::from)
}

fn at(place: &Place) -> Value {
    let gamma = format!("{:.4}", place.gamma).parse::<f64>().unwrap_or(place.gamma);
    let mut at = json!({ "gamma": as_typed(gamma), "sigma": short(place.sigma) });
    if let Some(eta) = place.eta {
        at["eta"] = short(eta);
    }
    if let Some(cos) = place.cos {
        at["cos_theta"] = short(cos);
    }
    at
}

/// A coordinate in four digits.
fn short(x: f64) -> Value {
    read(&format!("{x:.3e}"))
}

/// In one line, for formats that hold a text.
pub(super) fn compact(description: &Map<String, Value>) -> String {
    Value::Object(description.clone()).to_string()
}

/// As a file, with the values of a texture if they are asked for.
pub(super) fn text(description: Map<String, Value>, values: Option<&Texture>) -> String {
    let mut text = serde_json::to_string_pretty(&description).expect("names and numbers");
    if let Some(texture) = values {
        // All numbers on one line: one on each would make a very long file.
        let numbers: Vec<String> = texture.values.iter().map(|&x| single(x)).collect();
        text.truncate(text.len() - "\n}".len());
        text += &format!(",\n  \"data\": [{}]\n}}", numbers.join(", "));
    }
    text + "\n"
}
