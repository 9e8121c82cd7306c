//! The certificate of a table in words: the errors that its bake measured, and where.

use microfacet_core::shape::gamma_of_s;
use microfacet_tables::{Certificate, Coordinate, Errors, Quantity};

use super::{error, number};

/// The name of a quantity as the heading of a column.
pub fn column(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::G1 => "G1",
        Quantity::Cdf => "CDF",
        Quantity::Density => "D/D(0)",
        Quantity::E => "E",
        Quantity::F82 => "F82",
        Quantity::Reflection => "reflected",
        Quantity::Transmission => "transmitted",
        _ => quantity.name(),
    }
}

/// The name of a quantity in a sentence.
fn spelled(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Cdf => "the CDF of visible normals",
        Quantity::E => "E, the albedo with F = 1",
        Quantity::Scale => "scale, the factor of Schlick's F0",
        Quantity::Bias => "bias, the factor of Schlick's F90",
        Quantity::F82 => "F82, the factor of the tint at 82 degrees",
        Quantity::Red => "the red reflectance",
        Quantity::Green => "the green reflectance",
        Quantity::Blue => "the blue reflectance",
        Quantity::Reflection => "the reflected share",
        Quantity::Transmission => "the transmitted share",
        _ => column(quantity),
    }
}

/// A coordinate with its name; s is shown as γ.
fn place((coordinate, x): (&Coordinate, &f64)) -> String {
    let (name, x) = match coordinate {
        Coordinate::S => ("gamma", gamma_of_s(*x)),
        Coordinate::Sigma => ("sigma", *x),
        Coordinate::Eta => ("eta", *x),
        Coordinate::Phi => ("phi", *x),
        Coordinate::Cotangent => ("cot(theta)/sigma", *x),
        Coordinate::Cosine => ("cos(theta)", *x),
        Coordinate::U => ("u", *x),
    };
    format!("{name} {}", number(x))
}

/// The whole certificate, a line for each quantity and fact.
pub fn lines(certificate: &Certificate) -> Vec<String> {
    let Certificate { errors, at, points, quadrature, stand_in } = certificate;
    let mut lines = Vec::new();
    for (quantity, Errors { largest, rms, outside }) in errors {
        let mut line = format!("largest error of {}: {}", spelled(*quantity), error(*largest));
        for (figure, what) in [(rms, "root mean square"), (outside, "beyond the promised range")] {
            if let Some(figure) = figure {
                line += &format!(", {what} {}", error(*figure));
            }
        }
        lines.push(line);
    }
    if !at.is_empty() {
        let places: Vec<String> = at.iter().map(place).collect();
        lines.push(format!("the largest of all is at {}", places.join(", ")));
    }
    if let Some(points) = points {
        let exact = quadrature.map_or(String::new(), |figure| {
            format!("; the values at the nodes are exact to {}", error(figure))
        });
        lines.push(format!("measured at {points} points{exact}"));
    }
    if let Some(figure) = stand_in {
        lines.push(format!(
            "an isotropic table at sqrt(sigma_x sigma_y) in its place would be off by up to {}",
            error(*figure)
        ));
    }
    lines
}
