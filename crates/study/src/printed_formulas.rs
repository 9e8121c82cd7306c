//! The formulas for Λ as printed by Ribardière et al. 2017 (doi:10.1111/cgf.13137), compared with
//! the well-conditioned one: the table of `docs/formulas.md`.
//!
//! `cargo run --release -p microfacet-study -- printed_formulas` prints it;
//! `microfacet-bake plot printed-formulas` draws the curves.

use microfacet_model::Shape;
use microfacet_model::printed::{FORMS, Form};

use crate::{Outcome, print_head};

const GAMMAS: [f64; 12] = [1.51, 1.6, 2.0, 2.5, 3.0, 10.0, 10.5, 40.0, 40.5, 100.0, 150.0, 1000.0];

/// z = cot θ/σ from 1e-6 to 1e4.
fn cotangents() -> impl Iterator<Item = f64> {
    (0..=400).map(|i| libm::exp10(-6.0 + 0.025 * f64::from(i)))
}

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    let figures = ["largest error of G1", "at z", "largest G1 - 1", "smallest G1"];
    print_head(&[&["eq.", "gamma"], &figures[..], &["no digit of lambda from z"]].concat());
    for Form { equation, name, lambda } in FORMS {
        for gamma in GAMMAS {
            if lambda(gamma, 1.0).is_some() {
                let row = row(gamma, |z| lambda(gamma, z).unwrap_or(f64::NAN));
                println!("| {equation}, {name} | {gamma} | {row} |");
            }
        }
    }
    Ok(())
}

/// The cells of one formula at one γ.
fn row(gamma: f64, form: impl Fn(f64) -> f64) -> String {
    let shape = Shape::new(gamma).expect("above 3/2");
    let (mut error, mut at, mut high, mut low, mut lost) =
        (0.0, 0.0, f64::NEG_INFINITY, f64::INFINITY, None);
    for z in cotangents() {
        let (printed, truth) = (form(z), shape.lambda(shape.asinh_slope(z)));
        let (g1, true_g1) = (1.0 / (1.0 + printed), 1.0 / (1.0 + truth));
        if !g1.is_finite() {
            return format!("not a number from z = {z:.1e} | | | |");
        }
        if (g1 - true_g1).abs() > error {
            (error, at) = ((g1 - true_g1).abs(), z);
        }
        (high, low) = (g1.max(high), g1.min(low));
        if (printed - truth).abs() > 0.5 * truth && lost.is_none() {
            lost = Some(z);
        }
    }
    let lost = lost.map_or("-".into(), |z| format!("{z:.1e}"));
    format!("{error:.1e} | {at:.1e} | {:.1e} | {low:.1e} | {lost}", high - 1.0)
}
