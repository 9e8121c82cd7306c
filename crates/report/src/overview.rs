//! What was baked, what was skipped and why.

use maud::{Markup, html};

use microfacet_baker::scene::recipe_of;
use microfacet_sampler::Tables;
use microfacet_tables::{Provenance, Table};

use super::Source;
use super::by_lobe::by_lobe;
use super::drawing::{code, error, symbols, table};
use super::served::{Served, served};
use super::texts;
use crate::words::table::{albedos, axis, covers, holds, normals, precision};
use crate::words::{bytes, certificate, count};

/// Most rows of a table of the page; a library has thousands of materials.
const ROWS: usize = 200;
/// Tables whose axes and certificates are listed, and conventions of the file.
const DETAILS: usize = 40;
/// Bytes of a recipe that are shown.
const RECIPE: usize = 16 << 10;

pub(super) fn section(source: &Source) -> Markup {
    let set = source.set;
    html! {
        @if set.provenance().materials.is_empty() {
            (ranges(set))
        } @else {
            (materials(set))
        }
        (tables(set))
        (origin(set.provenance()))
    }
}

fn ranges(set: &Tables) -> Markup {
    html! {
        p { "No materials by name; the set serves any in these ranges." }
        dl.facts {
            @for (name, lines) in [("visible normals", normals(set)), ("albedo", albedos(set.tables()))] {
                div {
                    dt { (name) }
                    @for line in &lines { dd { (texts::words(&symbols(line))) } }
                    @if lines.is_empty() { dd { "none" } }
                }
            }
        }
    }
}

fn materials(set: &Tables) -> Markup {
    let lobes = by_lobe(set);
    let all = served(&lobes);
    let shown = &all[..all.len().min(ROWS)];
    let caption = html! {
        "Materials. Bytes are those of the tables that a material reads, some of which others may \
         share."
    };
    let head: [&[&str]; 2] = [
        &["name", "σ", "γ or distribution", "masking", "Fresnel", "normals", "albedo"],
        &["bytes"],
    ];
    let rows = html! {
        @for Served { name, words, lobe, albedo, bytes: size } in shown {
            tr {
                th scope="row" { (texts::name(name)) }
                @for cell in words { td { (texts::name(&symbols(cell))) } }
                @for part in [lobe, albedo] { td { (part.what) } }
                td.number { (bytes(*size)) }
            }
        }
    };
    html! {
        (table("Materials", &caption, head, &rows))
        @if all.len() > shown.len() {
            p.note { "and " (count(all.len() - shown.len(), "more material")) }
        }
        (skipped(set, &all))
    }
}

/// What was left out, each reason once.
fn skipped(set: &Tables, all: &[Served]) -> Markup {
    let mut reasons: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for one in all {
        for (of, part) in [("visible normals", &one.lobe), ("albedo", &one.albedo)] {
            let Some(why) = &part.skipped else { continue };
            match reasons.iter_mut().find(|(known, reason, _)| *known == of && reason == why) {
                Some((.., names)) => names.push(one.name),
                None => reasons.push((of, why, vec![one.name])),
            }
        }
    }
    // In the order of the columns.
    reasons.sort_by_key(|(of, ..)| *of == "albedo");
    html! {
        h3 { "Skipped, and why" }
        @if reasons.is_empty() {
            p { "Nothing: every material of the set has tables of normals and of albedo." }
        } @else {
            ul.skipped {
                @for (of, why, names) in reasons.iter().take(REASONS) {
                    li {
                        b { (of) } ": " (code(&texts::cut(why, REASON))) " ("
                        @for (i, name) in names.iter().take(NAMES).enumerate() {
                            @if i > 0 { ", " }
                            (texts::name(name))
                        }
                        @if names.len() > NAMES { " and " (names.len() - NAMES) " more" }
                        ")"
                    }
                }
                @if reasons.len() > REASONS {
                    li { (count(reasons.len() - REASONS, "more reason")) }
                }
            }
        }
        p.note {
            @if set.provenance().materials.is_empty() {
                "The set lists no materials, so why something was left out is told by what it holds. "
            }
            "A set does not list materials of a scene that no geometry uses or that nothing \
             covers; " code { "microfacet-bake plan" } " of the scene names them."
        }
    }
}

/// Names of materials after a reason.
const NAMES: usize = 12;
/// Reasons, and letters of one.
const REASONS: usize = 40;
const REASON: usize = 400;

fn tables(set: &Tables) -> Markup {
    let all = set.tables();
    let total: usize = all.iter().map(Table::stored_bytes).sum();
    if all.is_empty() {
        return html! {
            p { "The set has no tables: its materials have closed forms, or tables of another set." }
        };
    }
    let caption = html! {
        (count(all.len(), "table")) ", " (bytes(total))
        ". The error is the largest that was measured off the nodes when the table was baked."
    };
    let head: [&[&str]; 2] = [&["table", "largest error", "γ", "σ", "nodes", "type"], &["bytes"]];
    let rows = html! { @for table in all.iter().take(ROWS) { (row(table)) } };
    html! {
        h3 { "Tables" }
        (table("Tables", &caption, head, &rows))
        @if all.len() > ROWS { p.note { "and " (count(all.len() - ROWS, "more table")) } }
        details {
            summary { "Axes and certificates" }
            @for table in all.iter().take(DETAILS) { (details(table)) }
            @if all.len() > DETAILS {
                p.note {
                    "and those of " (count(all.len() - DETAILS, "more table")) ", which "
                    code { "microfacet-bake inspect --details" } " prints"
                }
            }
        }
    }
}

fn row(table: &Table) -> Markup {
    let [gamma, sigma] = covers(&table.subject);
    let nodes: Vec<String> = table.axes.iter().map(|axis| axis.len().to_string()).collect();
    html! {
        tr {
            th scope="row" {
                (texts::words(&symbols(&holds(table)))) br;
                code.muted { (texts::name(&table.name)) }
            }
            td {
                @match table.certificate.largest() {
                    Some((what, max)) => { (certificate::column(what)) " " (error(max)) }
                    None => "not measured",
                }
            }
            td { (symbols(&gamma)) }
            td { (symbols(&sigma)) }
            td { (nodes.join("\u{a0}×\u{a0}")) }
            td { (precision(table.precision)) }
            td.number { (bytes(table.stored_bytes())) }
        }
    }
}

fn details(table: &Table) -> Markup {
    html! {
        h4 { code { (texts::name(&table.name)) } }
        ul {
            @for one in &table.axes {
                li { b { (texts::name(&one.name)) } ": " (symbols(&axis(one))) }
            }
            li { "channels: " (texts::words(&table.channels.join(", "))) }
            @for line in certificate::lines(&table.certificate) { li { (symbols(&line)) } }
        }
    }
}

fn origin(origin: &Provenance) -> Markup {
    html! {
        details {
            summary { "Where it comes from" }
            dl {
                dt { "baked by" }
                dd { (texts::words(&origin.generator)) ", numerics " (origin.numerics) }
                @if !origin.license.is_empty() {
                    dt { "licence" }
                    dd { (texts::words(&origin.license)) }
                }
                @for (name, value) in origin.conventions.iter().take(DETAILS) {
                    dt { (texts::name(name)) }
                    dd { (texts::words(value)) }
                }
            }
        }
        @let recipe = recipe_of(&origin.materials);
        @if !recipe.is_empty() {
            details {
                summary { "Recipe" }
                @let shown = beginning(&recipe);
                pre tabindex="0" { code { (shown) } }
                @if shown.len() < recipe.len() {
                    p.note {
                        "and " (bytes(recipe.len() - shown.len())) " more, which "
                        code { "microfacet-bake inspect --details" } " prints"
                    }
                }
            }
        }
    }
}

/// The whole lines of a recipe that are shown, or of a line that is longer the beginning.
fn beginning(recipe: &str) -> &str {
    let end = (0..=RECIPE.min(recipe.len())).rev().find(|&end| recipe.is_char_boundary(end));
    let shown = &recipe[..end.unwrap_or(0)];
    match shown.rfind('\n') {
        Some(end) if shown.len() < recipe.len() => &shown[..=end],
        _ => shown,
    }
}
