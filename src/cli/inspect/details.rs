//! The details of a set: axes, certificates, formulas, conventions and the recipe.

use std::collections::BTreeMap;

use microfacet_baker::scene::recipe_of;
use microfacet_report::words::certificate;
use microfacet_report::words::table::{axis, holds};
use microfacet_sampler::Tables;
use microfacet_tables::Table;

use crate::cli::escape;
use crate::cli::words::wrapped;

/// Everything that the overview leaves out.
pub(super) fn of(set: &Tables) -> String {
    let origin = set.provenance();
    let mut text: String = set.tables().iter().map(of_table).collect();
    let mappings = set.tables().iter().flat_map(|table| &table.axes).map(|axis| axis.mapping);
    let formulas: BTreeMap<_, _> =
        mappings.map(|mapping| (mapping.name(), mapping.formula())).collect();
    if !formulas.is_empty() {
        text += "\ncoordinates t of the axes\n";
    }
    for (name, formula) in formulas {
        text += &wrapped(&format!("  {name}: "), formula, 4);
    }
    if !origin.conventions.is_empty() {
        text += "\nconventions\n";
    }
    for (key, value) in &origin.conventions {
        text += &wrapped(&format!("  {}: ", escape::line(key)), &escape::line(value), 4);
    }
    if !origin.materials.is_empty() {
        // Indented, so that no line of the recipe is taken for a line of this command.
        text += "\nrecipe\n";
        for line in recipe_of(&origin.materials).lines() {
            text += &format!("  {line}\n");
        }
    }
    text
}

fn of_table(table: &Table) -> String {
    let mut text = format!("\n{}\n", escape::line(&table.name));
    let masking = table.subject.masking.map_or(String::new(), |form| format!(", {form} masking"));
    text += &wrapped("  ", &format!("{}{masking}", escape::line(&holds(table))), 4);
    let width = table.axes.iter().map(|axis| axis.name.len()).max().unwrap_or(0);
    for one in &table.axes {
        let head = format!("  {:width$}  ", escape::line(&one.name));
        text += &wrapped(&head, &axis(one), width + 4);
    }
    let channels: Vec<_> = table.channels.iter().map(|channel| escape::line(channel)).collect();
    text += &format!("  channels: {}\n", channels.join(", "));
    for line in certificate::lines(&table.certificate) {
        text += &wrapped("  ", &escape::line(&line), 4);
    }
    text
}
