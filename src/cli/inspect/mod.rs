//! `inspect`: shows what a set of tables holds.

mod details;

use std::path::PathBuf;

use microfacet_report::has_page;
use microfacet_report::words::certificate;
use microfacet_report::words::material::material;
use microfacet_report::words::table::{albedos, covers, holds, normals, precision};
use microfacet_sampler::Tables;
use microfacet_tables::{Table, describe};

use super::words::{COLUMNS, bytes, columns, count, error, exact_bytes, shell, wrapped};
use super::{Done, Outcome, escape, print, print_json, tables};

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

pub(super) fn run(args: Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    if args.json {
        let mut document: serde_json::Value =
            serde_json::from_str(&describe(set.provenance(), set.tables())?)?;
        // It is a checksum of a file's bytes, and there may be many files.
        if let Some(document) = document.as_object_mut() {
            document.remove("checksum");
        }
        print_json(&document)?;
        return Ok(Done::Ok);
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
        text += &details::of(&set);
    } else {
        text += "\n--details shows axes, certificates, conventions and the recipe\n";
        if has_page(&set) {
            let path =
                args.tables.as_deref().map_or(String::new(), |path| format!(" {}", shell(path)));
            text += &format!("microfacet-bake report{path} draws the set as a page\n");
        }
    }
    print(&text)?;
    Ok(Done::Ok)
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
    let mut forms: Vec<&str> = Vec::new();
    for table in tables {
        let form = precision(table.precision);
        if !forms.contains(&form) {
            forms.push(form);
        }
    }
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
    for (i, entry) in origin.materials.iter().take(shown).enumerate() {
        let first = if i == 0 { "materials" } else { "" };
        let name = escape::line(&entry.name);
        text += &self::entry(first, &format!("\"{name}\": {}", escape::line(&material(entry))));
    }
    match origin.materials.len() {
        0 if tables.is_empty() => text += &entry("materials", "none"),
        0 => text += &entry("materials", "none by name; any in these ranges"),
        n if n > shown => text += &entry("", &format!("and {} more", n - shown)),
        _ => {}
    }
    text += &listed("normals", &normals(set), shown);
    text + &listed("albedo", &albedos(tables), shown)
}

/// A list below each other, its end cut off.
fn listed(name: &str, lines: &[String], shown: usize) -> String {
    let mut text = String::new();
    for (i, line) in lines.iter().take(shown).enumerate() {
        text += &entry(if i == 0 { name } else { "" }, &escape::line(line));
    }
    if lines.len() > shown {
        text += &entry("", &format!("and {} more", lines.len() - shown));
    }
    text
}

/// One line for each table, under what it holds.
fn overview(tables: &[Table]) -> String {
    let header = ["", "gamma", "sigma", "nodes", "type", "size", "error"].map(String::from);
    let mut rows: Vec<Vec<String>> = vec![header.into()];
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for table in tables {
        let what = holds(table);
        match groups.iter_mut().find(|(known, _)| *known == what) {
            Some((_, group)) => group.push(rows.len()),
            None => groups.push((what, vec![rows.len()])),
        }
        rows.push(row(table));
    }
    let mut lines = columns(&rows);
    if lines.iter().any(|line| line.chars().count() > COLUMNS) {
        // Long names have a line of their own.
        let names: Vec<String> = rows.iter_mut().map(|row| std::mem::take(&mut row[0])).collect();
        rows.iter_mut().for_each(|row| row[0] = "  ".into());
        lines = columns(&rows);
        let below = |(name, line): (&String, &String)| format!("{name}\n{line}");
        let named: Vec<String> = names.iter().zip(&lines).skip(1).map(below).collect();
        lines.truncate(1);
        lines.extend(named);
    }
    let mut text = format!("{}\n", lines[0]);
    for (what, rows) in groups {
        text += &wrapped("", &escape::line(&what), 2);
        for i in rows {
            text += &format!("{}\n", lines[i]);
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
