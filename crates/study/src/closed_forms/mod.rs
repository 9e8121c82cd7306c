//! Masking and the albedo without tables: fitted quotients of polynomials, several sizes of them,
//! with their errors at places between the fitted ones.
//!
//! `cargo run --release -p microfacet-study -- closed_forms` prints the tables of "Without tables"
//! in `docs/shaders.md`, and the lines that `closed.wgsl` and `closed.h` of the crate
//! `microfacet-export` have of the forms chosen. `closed_forms search` searches for terms of forms,
//! which takes some minutes. `closed_forms engines [GAMMA]` prints the errors of quotients that
//! shaders of engines have for E, and fits them to the model (`docs/engines.md`).
//!
//! A number is a coefficient: one of each quotient is 1 or −1, and powers are whole. The rivals are
//! eq. 22–23 of Ribardière et al. 2017 (<https://doi.org/10.1111/cgf.13137>), which have 31 numbers,
//! powers of γ and a ratio of Gamma functions, and a polynomial.

mod albedo;
mod cholesky;
mod fit;
mod form;
mod forms;
mod masking;
mod measure;
mod search;
mod shaders;
mod share;

use microfacet_model::ParameterError;
use microfacet_model::printed::lambda_rational;

use crate::{Outcome, print_head};
use fit::{Fit, fit};
use form::{Form, Language};
use measure::Largest;
use search::{Effort, search};
use share::{Samples, Terms};

/// How often the weights follow the errors, of G1 and of E.
const ROUNDS: [usize; 2] = [1000, 300];

/// The best fit of these terms of G1.
fn fitted_masking(terms: &Terms, samples: &Samples) -> Fit {
    fit(terms, samples, None, ROUNDS[0])
}

/// The best fit of these terms of E.
fn fitted_albedo(terms: &Terms, samples: &Samples) -> Fit {
    fit(terms, samples, None, ROUNDS[1])
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    if arguments.first().is_some_and(|argument| argument == "engines") {
        return shaders::run(arguments.get(1).map_or(Ok(2.0), |gamma| gamma.parse())?);
    }
    let (masking_samples, albedo_samples) = (masking_samples(), albedo_samples()?);
    if arguments.first().is_some_and(|argument| argument == "search") {
        let effort = Effort { tries: 40, rounds: 80, singly: 40 };
        for degree in [3, 4] {
            println!("G1, degree {degree}");
            search(&masking::terms(degree), &masking::samples(17, 30), effort, 9);
        }
        println!("E");
        let effort = Effort { tries: 6, rounds: 50, singly: 62 };
        search(&albedo::terms(), &albedo::samples([7, 12, 18], 2)?, effort, 18);
        return Ok(());
    }
    println!("G1, gamma >= 1.501, in single precision:\n");
    print_head(&[&["form", "numbers"], &masking::PARTS[..], &["above 1 by, unlimited"]].concat());
    for terms in forms::masking() {
        println!("{}", masking_row(&fitted_masking(&terms, &masking_samples)));
    }
    let (terms, samples) = masking::plain(&masking_samples);
    let plain = fitted_masking(&terms, &samples);
    let g1 = |_, s, z| plain.value(masking::plain_place(z, s));
    println!("{}", row("polynomial", plain.numbers(), &masking::errors(f64::INFINITY, g1)));
    // Γ overflows above.
    let errors = masking::errors(170.0, |gamma, _, z| 1.0 / (1.0 + lambda_rational(gamma, z)));
    println!("{}", row("eq. 22–23, γ ≤ 170", 31, &errors));

    println!("\nE, gamma >= 1.6, sigma <= 1, mu >= 0.02, in single precision:\n");
    print_head(&[&["numbers"], &albedo::PARTS[..], &["at γ, σ, μ"]].concat());
    let check = albedo::check()?;
    for terms in forms::albedo() {
        println!("{}", albedo_row(&fitted_albedo(&terms, &albedo_samples), &check));
    }
    let fits = [
        fitted_masking(&forms::chosen_masking(), &masking_samples),
        fitted_albedo(&forms::chosen_albedo(), &albedo_samples),
    ];
    for language in [Language::Wgsl, Language::C] {
        println!("\n{}", lines(&fits, language).join("\n"));
    }
    Ok(())
}

fn masking_samples() -> Samples {
    masking::samples(21, 48)
}

fn albedo_samples() -> Result<Samples, ParameterError> {
    albedo::samples([9, 14, 24], 3)
}

/// The lines of a form of G1 and one of E in the texts.
fn lines([masking, albedo]: &[Fit; 2], language: Language) -> [String; 2] {
    [
        Form::of(masking).text(masking::NAMES, language),
        Form::of(albedo).text(albedo::NAMES, language),
    ]
}

/// The errors of parts, and a dash for those that no place is in.
fn cells(parts: &[Largest]) -> String {
    let cell = |part: &Largest| match part.error {
        0.0 => "–".into(),
        error => format!("{error:.1e}"),
    };
    parts.iter().map(cell).collect::<Vec<String>>().join(" | ")
}

fn row(name: &str, numbers: usize, errors: &masking::Errors) -> String {
    let above = errors.above.max(0.0);
    format!("| {name} | {numbers} | {} | {above:.1e} |", cells(&errors.parts))
}

fn masking_row(fit: &Fit) -> String {
    let form = Form::of(fit);
    let errors = masking::errors(f64::INFINITY, |_, s, z| masking::single(&form, s, z));
    row("quotient", fit.numbers(), &errors)
}

fn albedo_row(fit: &Fit, check: &Samples) -> String {
    let parts = albedo::errors(&Form::of(fit), check);
    let [gamma, sigma, mu] = parts[0].at;
    let at = format!("{gamma:.3}, {sigma:.3}, {mu:.3}");
    format!("| {} | {} | {at} |", fit.numbers(), cells(&parts))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCS: &str = include_str!("../../../../docs/shaders.md");

    #[test]
    fn texts_and_docs_are_of_the_forms_that_are_fitted() {
        let samples = [masking_samples(), albedo_samples().unwrap()];
        let texts = [
            (Language::Wgsl, include_str!("../../../export/src/shader/closed.wgsl")),
            (Language::C, include_str!("../../../export/src/c/closed.h")),
        ];
        let fits = [
            fitted_masking(&forms::chosen_masking(), &samples[0]),
            fitted_albedo(&forms::chosen_albedo(), &samples[1]),
        ];
        for (language, text) in texts {
            for lines in lines(&fits, language) {
                assert!(text.contains(&lines), "{language:?}:\n{lines}");
                assert!(text.lines().all(|line| line.len() <= 100));
            }
        }
        let check = albedo::check().unwrap();
        for row in [masking_row(&fits[0]), albedo_row(&fits[1], &check)] {
            assert!(DOCS.contains(&row), "{row}");
        }
        // Numbers that are one part in a hundred off are found.
        let within = |fits: &[Fit; 2]| {
            let form = Form::of(&fits[0]);
            let g1 = masking::errors(f64::INFINITY, |_, s, z| masking::single(&form, s, z));
            [g1.parts[0].error, albedo::errors(&Form::of(&fits[1]), &check)[0].error]
        };
        let right = within(&fits);
        let wrong = within(&fits.map(|fit| fit.with_one_off(1.01)));
        assert!(right.iter().zip(wrong).all(|(right, wrong)| wrong > 2.0 * right), "{wrong:?}");
    }
}
