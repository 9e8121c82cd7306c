//! The materials that albedo tables cover, in words, for errors.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use microfacet_tables::{Mapping, Range, Table};

/// The roughness of the first node: the smallest that a table holds, apart from 0.
pub(super) fn smallest_sigma(table: &Table) -> Option<f64> {
    let mut axes = table.axes.iter();
    let axis = axes.find(|axis| matches!(axis.mapping, Mapping::LogRoughness(_)))?;
    axis.quantity(axis.nodes[0])
}

/// The materials of tables of moments.
pub(super) fn domains<'a>(tables: impl Iterator<Item = &'a Table>) -> String {
    listed(tables.map(material))
}

/// The dielectrics of all tables, for each form of masking.
pub(super) fn dielectrics<'a>(tables: impl Iterator<Item = &'a Table>) -> String {
    let one = |table: &Table| {
        let indices = Range(table.subject.reflectance?.indices()?.into());
        let masking = table.subject.masking?;
        Some(format!("index {indices} with {} and {masking} masking", material(table)))
    };
    listed(tables.filter_map(one))
}

fn material(table: &Table) -> String {
    let lobe = &table.subject.lobe;
    let gamma = Range(lobe.gamma.into());
    let sigma = lobe.roughness.x();
    let sigma = match smallest_sigma(table) {
        Some(first) if sigma.min == 0.0 => format!("0 or {}", Range([first, sigma.max])),
        _ => Range(sigma.into()).to_string(),
    };
    format!("gamma {gamma} with sigma {sigma}")
}

/// Without those said before, and not too many.
fn listed(all: impl Iterator<Item = String>) -> String {
    const SHOWN: usize = 8;
    let mut kept: Vec<String> = Vec::new();
    for one in all {
        if !kept.contains(&one) {
            kept.push(one);
        }
    }
    if kept.is_empty() {
        return "none".into();
    }
    if kept.len() > SHOWN {
        let more = kept.len() - SHOWN;
        kept.truncate(SHOWN);
        kept.push(format!("{more} more"));
    }
    kept.join("; ")
}
