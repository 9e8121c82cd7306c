//! `inspect`: shows what a table file holds.

use std::collections::BTreeMap;

use std::path::PathBuf;

use serde_json::json;

use microfacet_bake::store;
use microfacet_common::shape::gamma_of_s;
use microfacet_sampler::internals::describe;
use microfacet_sampler::{Axis, Covered, Interpolation, LobeEntry, Subject, Table};

use super::bake::largest_error;
use super::{Done, Outcome, escape, print, print_json};

/// Show axes, ranges, sizes, metadata and certificates of a table file.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake inspect out/tables.safetensors")]
pub(super) struct Args {
    /// A .safetensors set, a folder that holds one or its images, or a single table as .exr.
    file: PathBuf,
    /// Print the complete description as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let set = store::read(&args.file)?;
    if args.json {
        let document: serde_json::Value =
            serde_json::from_str(&describe(set.provenance(), set.tables())?)?;
        print_json(&json!(document))?;
        return Ok(Done::Ok);
    }
    let origin = set.provenance();
    let mut text = format!(
        "baked by {} (numerics {}), {}\n",
        escape::line(&origin.generator),
        origin.numerics,
        escape::line(&origin.license)
    );
    for material in &origin.materials {
        text += &format!("material \"{}\"\n", escape::line(&material.name));
    }
    for table in set.tables() {
        text += &describe_table(table);
    }
    text += "\nmappings:\n";
    let mappings = set.tables().iter().flat_map(|table| &table.axes).map(|axis| axis.mapping);
    let formulas: BTreeMap<_, _> =
        mappings.map(|mapping| (mapping.name(), mapping.formula())).collect();
    for (name, formula) in formulas {
        text += &format!("  {name}: {formula}\n");
    }
    text += "\nconventions:\n";
    for (key, value) in &origin.conventions {
        text += &format!("  {}: {}\n", escape::line(key), escape::line(value));
    }
    if !origin.recipe.is_empty() {
        // Indented, so that no line of it passes for one of ours.
        text += "\nrecipe:\n";
        for line in origin.recipe.lines() {
            text += &format!("  {line}\n");
        }
    }
    print(&text)?;
    Ok(Done::Ok)
}

fn describe_table(table: &Table) -> String {
    let mut text = format!(
        "\n{} ({}), {:?}, {} values of {:?}\n",
        escape::line(&table.name),
        table.kind.name(),
        table.shape(),
        table.values.len(),
        table.precision
    );
    text += &format!("  {}\n", describe_subject(&table.subject));
    for axis in &table.axes {
        text += &format!("  {}\n", describe_axis(axis));
    }
    text += &format!("  {}\n", largest_error(table));
    if let Some(error) = table.certificate.get("shortcut_max_error") {
        text += &format!(
            "  an isotropic table at sqrt(sigma_x sigma_y) in its place would be off by up to {error}\n"
        );
    }
    for (key, value) in &table.certificate {
        text += &format!("    {} {value}\n", escape::line(key));
    }
    text
}

/// The lobe, masking and reflectance of a table, and the materials it covers.
fn describe_subject(Subject { lobe, masking, reflectance, covers }: &Subject) -> String {
    let sigmas =
        |[x, y]: &[f64; 2], s: &f64| format!("sigma {x} {y}, gamma {}", short(gamma_of_s(*s)));
    let mut parts = vec![match lobe {
        LobeEntry::Family => "student-t".to_owned(),
        LobeEntry::StudentT { sigma, s } => format!("student-t, {}", sigmas(sigma, s)),
        LobeEntry::Ellipsoid { sigma, theta: [x, y, z], s } => {
            format!("ellipsoid, {}, theta {x} {y} {z}", sigmas(sigma, s))
        }
        LobeEntry::Distribution(label) => label.clone(),
    }];
    parts.extend(masking.map(|masking| masking.name().to_owned()));
    parts.extend(reflectance.map(|reflectance| reflectance.label().replace('_', " ")));
    if let Some(Covered { s: [low, high], sigma }) = covers {
        parts.push(format!("gamma {} to {}", short(gamma_of_s(*high)), short(gamma_of_s(*low))));
        parts.extend(sigma.map(|[min, max]| format!("sigma {min} to {max}")));
    }
    format!("of {}", escape::line(&parts.join("; ")))
}

fn describe_axis(axis: &Axis) -> String {
    let [first, last] = axis.ends();
    let range = match (axis.quantities().as_slice(), axis.interpolation) {
        ([], _) => format!("coordinate in [{first}, {last}]"),
        (all, Interpolation::Nodes) => {
            let all: Vec<String> = all.iter().rev().map(|x| format!("{x}")).collect();
            format!("{} = {}", axis.name, all.join(", "))
        }
        ([one], _) => format!("{} = {one}", axis.name),
        ([a, .., b], _) => format!("{} in [{}, {}]", axis.name, short(a.min(*b)), short(a.max(*b))),
    };
    format!(
        "{}: {} nodes, {range}, {}, {:?} between them",
        axis.name,
        axis.len(),
        serde_json::to_string(&axis.mapping).expect("numbers and names"),
        axis.interpolation
    )
}

/// Rounds to seven digits: an end of an axis has passed through its coordinate and back.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    if rounded != 0.0 && rounded < 1e-3 { format!("{rounded:e}") } else { format!("{rounded}") }
}
