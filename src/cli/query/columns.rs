//! The columns of the file: which of them hold the points.

use std::collections::HashSet;

use csv::StringRecord;

use microfacet_baker::scene::did_you_mean_key;

use crate::cli::{Result, bail};

/// Where the columns `inputs` are in a header, to which the columns `outputs` are appended.
pub(super) fn find(
    header: &StringRecord,
    inputs: &[&str],
    outputs: &[String],
) -> Result<Vec<usize>> {
    let mut seen = HashSet::new();
    // Columns without a name, as spreadsheets leave them at the end, may be several.
    if let Some(twice) = header.iter().find(|name| !name.is_empty() && !seen.insert(*name)) {
        bail!("two columns have the name `{twice}`; rename or remove one of them");
    }
    if let Some(output) = outputs.iter().find(|name| seen.contains(&name[..])) {
        bail!(
            "there is a column `{output}` already, and the results would be another; rename or \
             remove it"
        );
    }
    inputs.iter().map(|name| position(header, name, inputs)).collect()
}

fn position(header: &StringRecord, name: &str, inputs: &[&str]) -> Result<usize> {
    if let Some(position) = header.iter().position(|column| column == name) {
        return Ok(position);
    }
    let have: Vec<&str> = header.iter().collect();
    let others = have.iter().filter(|column| !inputs.contains(column));
    let hint = others
        .map(|column| (column, did_you_mean_key(column, &[name])))
        .find(|(_, hint)| !hint.is_empty())
        .map_or(String::new(), |(column, hint)| format!("; for `{column}`{}", &hint[1..]));
    let (inputs, have) = (inputs.join(", "), have.join(", "));
    bail!("no column `{name}`; the columns are {inputs}, the file has {have}{hint}")
}
