//! Numbers along the axes of maps.

use super::words::number;
use crate::error_map::{Quantity, Span};

/// Numbers this near to an end, as a share of the axis, are left out: they could be taken for it.
const AT_END: f64 = 1e-3;

/// Numbers with their shares of the axis, the most important first: both ends, then round numbers.
pub(super) fn of(span: &Span) -> Vec<(f64, String)> {
    let label = |x: f64| match span.quantity {
        // An axis of a full circle may begin at any azimuth, and pass 360°.
        Quantity::Azimuth if x > 90.0 => number(x.rem_euclid(360.0)),
        _ => number(x),
    };
    let ends = [0.0, 1.0].map(|share| (share, label(span.value(share))));
    let inside = |x: &f64| {
        let share = span.fraction(*x)?;
        (AT_END..=1.0 - AT_END).contains(&share).then(|| (share, number(*x)))
    };
    ends.into_iter().chain(round(span.quantity).iter().filter_map(inside)).collect()
}

/// Round numbers, the most useful first.
fn round(quantity: Quantity) -> &'static [f64] {
    match quantity {
        Quantity::Gamma => &[
            2.0, 3.0, 1.6, 5.0, 10.0, 1.8, 2.5, 4.0, 1.55, 1.7, 1.9, 20.0, 100.0, 7.0, 1.52, 1.51,
            50.0, 2.2, 3.5,
        ],
        Quantity::Sigma => {
            &[0.1, 1.0, 0.3, 0.03, 0.5, 2.0, 0.2, 0.05, 0.7, 1.5, 0.4, 0.15, 0.25, 0.6, 0.35, 0.02]
        }
        Quantity::Eta => &[1.5, 2.0, 1.2, 3.0, 1.33, 1.05, 5.0, 1.7, 1.4, 1.6, 10.0],
        Quantity::Azimuth => &[90.0, 180.0, 270.0, 0.0, 45.0, 30.0, 60.0],
        Quantity::Cosine => {
            &[0.5, 0.1, 0.9, 0.2, 0.05, 0.99, 0.7, 0.8, 0.3, 0.999, 0.95, 0.03, 0.6, 0.4, 0.9999]
        }
        Quantity::Cotangent | Quantity::Slope => {
            &[1.0, 0.1, 10.0, 0.3, 3.0, 0.5, 2.0, 100.0, 30.0, 5.0, 0.03, 0.2, 0.01, 1000.0]
        }
        Quantity::Number => &[0.5, 0.1, 0.9, 0.01, 0.99, 0.3, 0.7, 1e-3, 0.999, 1e-4, 0.9999],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_come_first_and_no_number_stands_outside() {
        let span = Span::new(Quantity::Cotangent, |t| t / (1.0 - t));
        let ticks = of(&span);
        assert_eq!(ticks[..2], [(0.0, "0".to_owned()), (1.0, "∞".to_owned())]);
        let one = ticks.iter().find(|tick| tick.1 == "1").unwrap();
        assert!((one.0 - 0.5).abs() < 1e-9);
        assert!(ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.0)));
        // 10 and 100 of an axis that ends at 5 are no ticks.
        let short = of(&Span::new(Quantity::Cotangent, |t| 5.0 * t));
        assert!(short.iter().all(|tick| tick.1 != "10"), "{short:?}");
        // An axis of a full circle that begins at 90° has no number twice.
        let circle = of(&Span::new(Quantity::Azimuth, |t| 90.0 + 350.0 * t));
        let words: Vec<&str> = circle.iter().map(|tick| &*tick.1).take(5).collect();
        assert_eq!(words, ["90", "80", "180", "270", "0"]);
    }
}
