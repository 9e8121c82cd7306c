//! The axes of a map: a quantity, and its value at each share of the axis.

use std::sync::Arc;

use microfacet_baker::certify::certificate::number;
use microfacet_core::shape::gamma_of_s;
use microfacet_tables::{Axis, Coordinate, Mapping, Table};

/// The quantity along an axis of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The shape γ.
    Gamma,
    /// The roughness σ.
    Sigma,
    /// The index of refraction η.
    Eta,
    /// The azimuth of the view, in degrees.
    Azimuth,
    /// cos θ of the view.
    Cosine,
    /// The unit cotangent z = cot θ/σ of the view.
    Cotangent,
    /// The unit slope.
    Slope,
    /// A random number u.
    Number,
}

impl Quantity {
    /// The quantity along an axis.
    pub fn of(axis: &Axis) -> Self {
        match axis.mapping {
            Mapping::InverseShape | Mapping::LogShape(_) => Self::Gamma,
            Mapping::LogRoughness(_) => Self::Sigma,
            Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => Self::Eta,
            Mapping::Azimuth(_) => Self::Azimuth,
            Mapping::ViewBlend(_) | Mapping::CriticalBlend(_) => Self::Cosine,
            Mapping::MirroredRoot | Mapping::OddRoot => Self::Number,
            _ if axis.name == "view" => Self::Cotangent,
            _ => Self::Slope,
        }
    }

    /// Whether the quantity belongs to the material, not to the view or to a random number.
    pub fn is_of_material(self) -> bool {
        matches!(self, Self::Gamma | Self::Sigma | Self::Eta | Self::Azimuth)
    }

    /// The value at the largest error of a table's certificate, if it is stated.
    pub fn worst(self, table: &Table) -> Option<f64> {
        let figure = |of| table.certificate.at.get(&of).copied();
        match self {
            Self::Gamma => figure(Coordinate::S).map(gamma_of_s),
            Self::Sigma => figure(Coordinate::Sigma),
            Self::Eta => figure(Coordinate::Eta),
            Self::Azimuth => figure(Coordinate::Phi).map(f64::to_degrees),
            Self::Cosine => figure(Coordinate::Cosine),
            // Certificates state no infinite cotangent: with s but without a cotangent it is ∞.
            Self::Cotangent => figure(Coordinate::Cotangent)
                .or_else(|| figure(Coordinate::S).map(|_| f64::INFINITY)),
            Self::Number => figure(Coordinate::U),
            Self::Slope => None,
        }
    }
}

/// A quantity along an axis of a map, ascending or descending.
#[derive(Clone)]
pub struct Span {
    /// The quantity along the axis.
    pub quantity: Quantity,
    at: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
}

/// Relative difference up to which values are equal: the rounding of a coordinate and its inverse.
const SAME: f64 = 1e-6;

impl Span {
    pub(crate) fn new(quantity: Quantity, at: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self { quantity, at: Arc::new(at) }
    }

    /// Random numbers along an axis of a table that is mirrored at 1/2.
    pub(super) fn of_numbers(axis: &Axis) -> Self {
        let half = (axis.nodes.len() - 1) as f64;
        Self::new(Quantity::Number, move |share| number(2.0 * half * share, half).into())
    }

    /// The value at a share in [0, 1] of the axis.
    pub fn value(&self, share: f64) -> f64 {
        (self.at)(share)
    }

    /// The share of the axis at which it has a value; `None` for a value beyond its ends.
    pub fn fraction(&self, value: f64) -> Option<f64> {
        if self.quantity == Quantity::Azimuth {
            let first = self.value(0.0);
            // A full turn less rounding is the beginning of the axis.
            let beyond = (value - first).rem_euclid(360.0);
            return self.within(if beyond > 360.0 - 1e-6 { first } else { first + beyond });
        }
        self.within(value)
    }

    /// The share of the axis at which the certificate of a table has its largest error.
    pub(super) fn worst(&self, table: &Table) -> Option<f64> {
        self.fraction(self.quantity.worst(table)?)
    }

    fn within(&self, value: f64) -> Option<f64> {
        let [first, last] = [0.0, 1.0].map(|share| self.value(share));
        let same = |end: f64| {
            end == value || value.is_finite() && (end - value).abs() <= SAME * value.abs()
        };
        // Ends come first: an axis of one value has both ends at that value.
        if let Some(end) = [(first, 0.0), (last, 1.0)].into_iter().find(|(end, _)| same(*end)) {
            return Some(end.1);
        }
        let ascends = first < last;
        let [mut low, mut high] = [0.0, 1.0];
        let is_before = |share: f64| (self.value(share) < value) == ascends;
        if !is_before(low) || is_before(high) {
            return None;
        }
        // 52 halvings reach the precision of f64.
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if is_before(middle) { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_found_where_it_is_whichever_way_the_axis_goes() {
        let up = Span::new(Quantity::Cotangent, |t| t / (1.0 - t));
        let down = Span::new(Quantity::Gamma, |t| gamma_of_s(2.0 * (1.0 - t)));
        for share in [0.0, 1e-4, 0.3, 1.0] {
            for span in [&up, &down] {
                let back = span.fraction(span.value(share)).unwrap();
                assert!((back - share).abs() < 1e-9, "{share}: {back}");
            }
        }
        // Finite values are found on an axis that ends at ∞.
        assert!((up.fraction(1.0).unwrap() - 0.5).abs() < 1e-9);
        assert!((down.fraction(2.0).unwrap() - 0.5).abs() < 1e-9);
        assert_eq!([up.fraction(f64::INFINITY), down.fraction(f64::INFINITY)], [Some(1.0); 2]);
        assert_eq!([up.fraction(-1.0), down.fraction(1.4), up.fraction(f64::NAN)], [None; 3]);
        // A circle closes, and an axis of one value has no length.
        let circle = Span::new(Quantity::Azimuth, |t| 30.0 + 360.0 * t);
        assert!((circle.fraction(-60.0).unwrap() - 0.75).abs() < 1e-9);
        let late = Span::new(Quantity::Azimuth, |t| 340.0 + 350.0 * t);
        assert!((late.fraction(-70.0).unwrap() - 310.0 / 350.0).abs() < 1e-9);
        assert_eq!((late.fraction(-20.0), late.fraction(335.0)), (Some(0.0), None));
        let one = Span::new(Quantity::Gamma, |_| 2.0);
        assert_eq!((one.fraction(2.0), one.fraction(3.0)), (Some(0.0), None));
    }
}
