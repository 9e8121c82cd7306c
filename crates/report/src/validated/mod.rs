//! What a validation found: p-values of the χ² tests, the worst configurations, white furnaces.

mod plots;

use maud::{Markup, html};

use microfacet_validate::record::{Record, Returned, Tested, identity};

use super::drawing::{code, error, symbols, table};
use super::texts;
use super::{ReportError, Source};
use crate::words::{command, count, number};

/// Rows of the table of configurations.
const WORST: usize = 5;
/// Tables that were not tested, by name.
const NAMED: usize = 12;
/// Letters of what was not tested, and why.
const WORDS: usize = 400;
/// Rows of the table of furnaces.
const FURNACES: usize = 24;

/// Refuses the validation of another set.
pub(super) fn check(source: &Source) -> Result<(), ReportError> {
    let Some(record) = source.validation else { return Ok(()) };
    let set = identity(source.set).map_err(ReportError::Unsound)?;
    if record.set == set {
        return Ok(());
    }
    Err(ReportError::OtherSet { of: record.set.clone(), set })
}

pub(super) fn section(source: &Source) -> Markup {
    match source.validation {
        Some(record) => results(record),
        None => html! {
            p {
                "No validation was given. It draws normals from the tables and compares them with "
                "the density of the model, and it returns the light of white furnaces:"
            }
            pre tabindex="0" {
                code {
                    "microfacet-bake validate SET --json > validation.json\n"
                    "microfacet-bake report SET --validation validation.json"
                }
            }
        },
    }
}

fn results(record: &Record) -> Markup {
    let all = &record.configurations;
    html! {
        @if record.passed {
            p.verdict.passed { "Passed" }
        } @else {
            p.verdict.rejected { "Rejected" }
        }
        @if record.gamma_factor != 1.0 {
            p {
                "The model’s γ was multiplied by " (number(record.gamma_factor))
                ", to see whether the tests notice."
            }
        }
        @if !all.is_empty() {
            p {
                (count(all.len(), "configuration")) " of " (record.samples) " normals. Two tests "
                "each, of the slopes in the plane of incidence and across it, and of the normals "
                "on the hemisphere; one rejects below p = " (error(record.level_of_one_test))
                ", so that a correct set is rejected once in " (number(1.0 / record.level))
                " runs. " (rejections(record.rejected)) " "
                @match record.worst_pdf_integral {
                    Some(integral) => {
                        "The integral of the density differs from 1 by at most "
                        (error((integral - 1.0).abs())) "; " (number(record.pdf_tolerance))
                        " is allowed."
                    }
                    None => "An integral of the density is not finite.",
                }
            }
            div.figures { (plots::p_values(record)) (plots::masking(record)) }
            (worst(record))
        }
        @if !record.furnaces.is_empty() { (furnaces(record)) }
        @if !record.not_tested.is_empty() {
            h3 { "Not tested" }
            ul {
                @for what in record.not_tested.iter().take(NAMED) { li { bdi { (code(&texts::cut(what, WORDS))) } } }
                @if record.not_tested.len() > NAMED {
                    li { (record.not_tested.len() - NAMED) " more" }
                }
            }
        }
    }
}

fn rejections(rejected: usize) -> String {
    match rejected {
        0 => "None was rejected.".into(),
        1 => "One configuration was rejected.".into(),
        n => format!("{n} configurations were rejected."),
    }
}

fn worst(record: &Record) -> Markup {
    let shown: Vec<&Tested> = record.configurations.iter().take(WORST).collect();
    let cell = |p: f64| {
        let class = if p < record.level_of_one_test { "number rejected" } else { "number" };
        html! { td class=(class) { (error(p)) } }
    };
    let caption = html! {
        "θ and φ are the angles of the view. KS is the distance of Kolmogorov and Smirnov of the \
         slopes in the plane of incidence."
    };
    let head = ["σx", "σy", "γ", "θ", "φ", "p, slopes", "p, normals", "KS", "error of G1"];
    let rows = html! {
        @for tested in &shown {
            @let one = &tested.configuration;
            tr {
                @for x in [one.sigma_x, one.sigma_y] { td.number { (short(x)) } }
                td.number { (symbols(&short(one.gamma))) }
                @for angle in [one.theta, one.phi] {
                    td.number { (short(angle.to_degrees())) "°" }
                }
                @for p in [tested.p_lobe, tested.p_world] { (cell(p)) }
                @for x in [tested.ks, tested.g1_error] { td.number { (error(x)) } }
            }
        }
    };
    html! {
        h3 { "The smallest p-values" }
        (table("The smallest p-values", &caption, [&[], &head], &rows))
        details {
            summary { "To repeat them" }
            p {
                "With another " code { "--seed" } " and more " code { "--samples" }
                " chance goes away, and the p of a defect falls."
            }
            pre tabindex="0" {
                code {
                    @for tested in &shown {
                        "microfacet-bake validate SET --samples " (record.samples) " "
                        (command::options(&tested.configuration)) "\n"
                    }
                }
            }
        }
    }
}

/// A number to four digits, which no line breaks.
fn short(x: f64) -> String {
    number(format!("{x:.3e}").parse().unwrap_or(x)).replace('-', "−")
}

fn furnaces(record: &Record) -> Markup {
    let is_off = |share: f64| (share - 1.0).abs() > record.furnace_tolerance || share.is_nan();
    let cell = |share: f64| {
        let class = if is_off(share) { "number rejected" } else { "number" };
        html! { td class=(class) { (format!("{share:.5}")) } }
    };
    let caption = html! {
        "The share of light that returns with Kulla–Conty’s lobe, over materials and views of each \
         table of albedos; 1 ± " (number(record.furnace_tolerance)) " is allowed."
    };
    let rows = html! {
        @for Returned { masking, points, lowest, highest } in record.furnaces.iter().take(FURNACES) {
            tr {
                th scope="row" { (texts::name(masking)) }
                td.number { (points) }
                @for share in [*lowest, *highest] { (cell(share)) }
            }
        }
    };
    html! {
        h3 { "White furnaces" }
        (table("White furnaces", &caption, [&["masking"], &["points", "lowest", "highest"]], &rows))
        @if record.furnaces.len() > FURNACES {
            p.note { "and " (count(record.furnaces.len() - FURNACES, "more furnace")) }
        }
    }
}
