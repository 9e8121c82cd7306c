//! Curves of what a validation found.

use maud::{Markup, html};

use microfacet_validate::record::{Record, Tested};

use super::super::drawing::{error, plot};
use crate::plot::{Axis, Curve, Dash, Key, Panel};
use crate::words::number;

const POINTS: usize = 200;
/// Ends of the axis of errors of G1: below the rounding of single precision, and the least top.
const LEAST: f64 = 1e-9;
const HIGH: f64 = 1e-6;

/// The sorted p-values of all tests, compared with those that chance gives.
pub(super) fn p_values(record: &Record) -> Markup {
    let both = |tested: &Tested| [tested.p_lobe, tested.p_world];
    let mut sorted: Vec<f64> = record.configurations.iter().flat_map(both).collect();
    sorted.sort_by(f64::total_cmp);
    let tests = sorted.len() as f64;
    let chance = |i: usize| (i as f64 + 0.5) / tests;
    let points = ranks(sorted.len()).into_iter().map(|i| (chance(i), sorted[i]));
    let level = record.level_of_one_test;
    let least = sorted.iter().copied().filter(|p| *p > 0.0).fold(level.min(chance(0)), f64::min);
    // Smaller ones leave the figure at its lower edge.
    let low = (0.3 * least).clamp(1e-12, 0.1);
    let left = 0.5 * chance(0);
    let curves = [
        Curve::new(Key::Nth(0), "tests", points),
        Curve::new(Key::Nth(8), "chance", [(left, left), (1.0, 1.0)]).dashed(Dash::Dashed),
        Curve::new(Key::Nth(1), "rejected below", [(left, level), (1.0, level)])
            .dashed(Dash::Dotted),
    ];
    let x = Axis::log("share of the tests with a smaller p", left, 1.0).coarse();
    let panel = Panel::new("p-values", x, Axis::log("p", low, 1.0).coarse(), curves);
    let smallest = sorted.first().copied().unwrap_or(f64::NAN);
    let label = format!(
        "Sorted p-values of {} tests, from {smallest:.2e}; one is rejected below {level:.2e}",
        sorted.len()
    );
    html! {
        figure {
            (plot(panel, &label))
            figcaption {
                b { "Sorted p-values" } " of " (sorted.len()) " tests. If the tables are right, they "
                "follow the dashed line but for chance; the smallest is " (error(smallest)) "."
            }
        }
    }
}

pub(super) fn masking(record: &Record) -> Markup {
    let of = |tested: &Tested| tested.g1_error;
    let mut sorted: Vec<f64> = record.configurations.iter().map(of).collect();
    sorted.sort_by(f64::total_cmp);
    let views = sorted.len() as f64;
    let points = ranks(sorted.len())
        .into_iter()
        // The error of a view that is not masked may be 0, whose logarithm is infinite.
        .map(|i| ((i as f64 + 0.5) / views, if sorted[i] < LEAST { LEAST } else { sorted[i] }));
    let largest = sorted.last().copied().unwrap_or(f64::NAN);
    let high = if largest.is_finite() { largest.max(HIGH) } else { 1.0 };
    let x = Axis::linear("share of views with a smaller error", 0.0, 1.0);
    let y = Axis::log("error of G1", LEAST, (2.0 * high).min(f64::MAX)).coarse();
    let panel = Panel::new("Error of G1", x, y, [Curve::new(Key::Nth(0), "", points)]);
    let label = format!("Sorted errors of G1 of {views} configurations, up to {largest:.2e}");
    html! {
        figure {
            (plot(panel, &label))
            figcaption {
                b { "Sorted errors of G1" } " of the views, tables against model; the largest is "
                (error(largest)) ". What is below " (number(LEAST)) " is drawn there."
            }
        }
    }
}

/// Ranks that are drawn: all of a few, of many as close as a logarithmic axis shows.
fn ranks(tests: usize) -> Vec<usize> {
    let at = |i: usize| {
        let fraction = i as f64 / (POINTS - 1) as f64;
        ((tests as f64).powf(fraction) - 1.0).round() as usize
    };
    let mut ranks: Vec<usize> = if tests <= POINTS {
        (0..tests).collect()
    } else {
        (0..POINTS).map(at).map(|rank| rank.min(tests - 1)).collect()
    };
    ranks.dedup();
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_all_of_a_few_and_some_of_many() {
        assert!(ranks(0).is_empty());
        assert_eq!(ranks(3), [0, 1, 2]);
        for tests in [POINTS, POINTS + 1, 2_000_000] {
            let ranks = ranks(tests);
            assert!(ranks.len() <= POINTS && ranks.is_sorted_by(|a, b| a < b), "{ranks:?}");
            assert_eq!([ranks[0], ranks[ranks.len() - 1]], [0, tests - 1]);
        }
    }
}
