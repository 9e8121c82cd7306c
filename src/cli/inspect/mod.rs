//! `inspect`: shows what a set of tables holds.

mod details;

use std::path::PathBuf;

use microfacet_report::has_page;
use microfacet_report::words::certificate;
use microfacet_report::words::material::material;
use microfacet_report::words::table::{albedos, covers, holds, normals, precision};
use microfacet_sampler::Tables;
use microfacet_tables::{MaterialEntry, Table, describe};

use super::words::{
    COLUMNS, bytes, columns, count, distinct, error, exact_bytes, first, shell, wrapped,
};
use super::{Result, escape, print, print_json, tables};

/// Show what a set of tables serves, and the size and the largest error of each table.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  microfacet-bake inspect\n  microfacet-bake inspect --details")]
pub(super) struct Args {
    /// A set, .safetensors or .exr, or a folder that holds one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// Show axes, certificates, conventions and the recipe as well.
    #[arg(long)]
    details: bool,
    /// Print the complete description as JSON.
    #[arg(long, conflicts_with = "details")]
    json: bool,
}

/// Width of the first column of the head.
const HEAD: usize = 11;

/// Materials and ranges that the head lists.
const SHOWN: usize = 6;

pub(super) fn run(args: &Args) -> Result<()> {
    let set = tables(args.tables.as_deref())?;
    if args.json {
        let mut document: serde_json::Value =
            serde_json::from_str(&describe(set.provenance(), set.tables())?)?;
        // The checksum is of the bytes of one file, and a set may have several.
        if let Some(document) = document.as_object_mut() {
            document.remove("checksum");
        }
        return print_json(&document);
    }
    let name: String = match &args.tables {
        Some(path) => escape::line(&path.display().to_string()).into(),
        None => "the default set, compiled into the sampler".into(),
    };
    let mut text = head(&name, &set, args.details);
    if !set.tables().is_empty() {
        text += "\n";
        text += &overview(set.tables());
    }
    if args.details {
        return print(&(text + &details::of(&set)));
    }
    text += "\n--details shows axes, certificates, conventions and the recipe\n";
    if has_page(&set) {
        let path = args.tables.as_deref().map_or(String::new(), |path| format!(" {}", shell(path)));
        text += &format!("microfacet-bake report{path} draws the set as a page\n");
    }
    print(&text)
}

fn entry(name: &str, text: &str) -> String {
    wrapped(&format!("{name:HEAD$}"), text, HEAD)
}

/// What the set is, and what it serves.
fn head(name: &str, set: &Tables, all: bool) -> String {
    let origin = set.provenance();
    let mut text = entry("set", name);
    let (generator, license) = (escape::line(&origin.generator), escape::line(&origin.license));
    let licence = if license.is_empty() { String::new() } else { format!(", licence {license}") };
    text += &entry("baked by", &format!("{generator}, numerics {}{licence}", origin.numerics));
    let tables = set.tables();
    let size = tables.iter().map(Table::stored_bytes).sum();
    let forms = distinct(tables.iter().map(|table| precision(table.precision)));
    let values = match tables {
        [] if origin.materials.is_empty() => "no tables".to_owned(),
        [] => "no tables: its materials have closed forms, or tables of another set".to_owned(),
        _ => format!(
            "{}, {} of values in {}",
            count(tables.len(), "table"),
            exact_bytes(size),
            forms.join(" and ")
        ),
    };
    text += &entry("holds", &values);
    let shown = if all { usize::MAX } else { SHOWN };
    let name = |entry: &MaterialEntry| format!("\"{}\": {}", entry.name, material(entry));
    let materials: Vec<String> = origin.materials.iter().map(name).collect();
    text += &listed("materials", &materials, shown);
    if materials.is_empty() {
        let none = if tables.is_empty() { "none" } else { "none by name; any in these ranges" };
        text += &entry("materials", none);
    }
    text += &listed("normals", &normals(set), shown);
    text + &listed("albedo", &albedos(tables), shown)
}

/// One entry a line; entries after the first `shown` are only counted.
fn listed(name: &str, lines: &[String], shown: usize) -> String {
    let mut name = Some(name);
    let line = |line: &String| entry(name.take().unwrap_or(""), &escape::line(line));
    first(lines, shown, line, |more| entry("", &format!("and {} more", more.len())))
}

/// One line for each table, under what it holds.
fn overview(tables: &[Table]) -> String {
    let header = ["", "gamma", "sigma", "nodes", "type", "size", "error"].map(String::from);
    let mut rows: Vec<Vec<String>> = vec![header.into()];
    rows.extend(tables.iter().map(row));
    let mut lines = columns(&rows);
    if lines.iter().any(|line| line.chars().count() > COLUMNS) {
        // Long names have a line of their own.
        let names: Vec<String> = rows.iter_mut().map(|row| std::mem::take(&mut row[0])).collect();
        rows.iter_mut().for_each(|row| row[0] = "  ".into());
        lines = columns(&rows);
        for (name, line) in names.iter().zip(&mut lines).skip(1) {
            *line = format!("{name}\n{line}");
        }
    }
    let mut text = format!("{}\n", lines[0]);
    let held: Vec<String> = tables.iter().map(holds).collect();
    for what in distinct(&held) {
        text += &wrapped("", &escape::line(what), 2);
        for (_, line) in held.iter().zip(&lines[1..]).filter(|(held, _)| *held == what) {
            text += &format!("{line}\n");
        }
    }
    text
}

fn row(table: &Table) -> Vec<String> {
    let [gamma, sigma] = covers(&table.subject);
    let nodes: Vec<String> = table.axes.iter().map(|axis| axis.len().to_string()).collect();
    let worst = table.certificate.largest();
    vec![
        format!("  {}", escape::line(&table.name)),
        gamma,
        sigma,
        nodes.join(" x "),
        precision(table.precision).into(),
        bytes(table.stored_bytes()),
        worst.map_or("not measured".into(), |(what, max)| {
            format!("{} {}", certificate::column(what), error(max))
        }),
    ]
}
