//! The JSON document that describes a set: its origin, materials, axes and tables.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::checksum;
use super::ensure;
use super::material::MaterialEntry;
use super::stack::{Stack, stacked};
use super::stored::StoredAxis;
use super::subject::Subject;
use super::table::Table;
use crate::axis::Axis;
use crate::error::LoadError;

/// The `format` entry of the document.
pub const FORMAT: &str = "microfacet-tables";
/// The newest version of the format. A set is written in the [oldest](OLDEST_VERSION) that has all
/// that its materials state, so that readers which know that one read it.
pub const VERSION: u32 = 5;
/// The oldest version of the format that this crate reads, and the one of sets whose materials have
/// one lobe each and no retroreflection.
pub const OLDEST_VERSION: u32 = 4;
/// Largest number of tables in a set, since a table of few values takes a kilobyte of memory too.
const MOST_TABLES: usize = 1 << 16;

/// The origin of a set, and how its numbers are to be read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Program and version that baked the set.
    pub generator: String,
    /// Number of the numeric method; it changes whenever the same recipe would give other bytes.
    pub numerics: u32,
    /// Licence of the data.
    pub license: String,
    /// Conventions that readers need, in words.
    pub conventions: BTreeMap<String, String>,
    /// The named materials that it was baked for, with all that a recipe states of them.
    pub materials: Vec<MaterialEntry>,
    /// The key of the tables in a cache; empty in a set.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub key: String,
}

impl Provenance {
    /// Checks every number of the materials, and that their names differ.
    pub fn check(&self) -> Result<(), LoadError> {
        let mut names = BTreeSet::new();
        for material in &self.materials {
            let name = &material.name;
            let named = ensure(names.insert(name), || "named twice".into());
            let sound = material.check().and(named);
            sound.map_err(|why| invalid(format!("material `{name}`: {why}")))?;
        }
        Ok(())
    }

    /// The version of the format in which a set with these materials is written.
    fn version(&self) -> u32 {
        let versions = self.materials.iter().map(MaterialEntry::version);
        versions.fold(OLDEST_VERSION, u32::max)
    }
}

#[derive(Serialize, Deserialize)]
pub(super) struct Document {
    format: String,
    version: u32,
    checksum: String,
    #[serde(flatten)]
    pub(super) provenance: Provenance,
    /// Formulas of the mappings that occur, by kind, for authors of readers.
    #[serde(default)]
    mappings: BTreeMap<String, String>,
    pub(super) axes: Vec<StoredAxis>,
    pub(super) tables: Vec<Stack>,
}

pub(super) fn invalid(why: impl ToString) -> LoadError {
    LoadError::Invalid(why.to_string())
}

fn of_table(name: &str, why: impl ToString) -> LoadError {
    invalid(format!("table `{name}`: {}", why.to_string()))
}

impl Document {
    pub(super) fn of(provenance: &Provenance, tables: &[Table]) -> Result<Self, LoadError> {
        provenance.check()?;
        let mut names = BTreeSet::new();
        for table in tables {
            table.validate()?;
            if !names.insert(&table.name) {
                return Err(of_table(&table.name, "named twice"));
            }
        }
        if tables.len() > MOST_TABLES {
            return Err(too_many(tables.len()));
        }
        let mappings = tables.iter().flat_map(|table| &table.axes).map(|axis| &axis.mapping);
        let mappings = mappings.map(|of| (of.name().into(), of.formula().into())).collect();
        let (axes, tables) = stacked(tables);
        Ok(Self {
            format: FORMAT.into(),
            version: provenance.version(),
            checksum: checksum::NONE.into(),
            provenance: provenance.clone(),
            mappings,
            axes,
            tables,
        })
    }

    pub(super) fn to_json(&self) -> Result<String, LoadError> {
        serde_json::to_string(self).map_err(invalid)
    }

    pub(super) fn from_json(json: &str) -> Result<Self, LoadError> {
        check_version(json)?;
        let document: Self = serde_json::from_str(json).map_err(invalid)?;
        document.provenance.check()?;
        let (stated, needed) = (document.version, document.provenance.version());
        if stated < needed {
            return Err(invalid(format!(
                "version {stated} of the format with a material of version {needed}"
            )));
        }
        let tables = document.tables.iter().map(Stack::len);
        let tables = tables.fold(0, usize::saturating_add);
        if tables > MOST_TABLES {
            return Err(too_many(tables));
        }
        let mut tensors = BTreeSet::new();
        for stack in &document.tables {
            stack.check(&document.axes).map_err(|why| of_table(&stack.name, why))?;
            if !tensors.insert(&stack.name) {
                return Err(of_table(&stack.name, "named twice"));
            }
        }
        Ok(document)
    }

    /// The tables; `values` gives those of a table by its stack and its number there.
    pub(super) fn tables(
        &self,
        mut values: impl FnMut(&Stack, usize) -> Result<Vec<f32>, String>,
    ) -> Result<Vec<Table>, LoadError> {
        let (mut tables, mut names): (Vec<Table>, _) = (Vec::new(), BTreeSet::new());
        for stack in &self.tables {
            for i in 0..stack.len() {
                let table = values(stack, i).and_then(|values| stack.table(i, &self.axes, values));
                let table = table.map_err(|why| of_table(&stack.name, why))?;
                table.validate()?;
                if !names.insert(table.name.clone()) {
                    return Err(of_table(&table.name, "named twice"));
                }
                tables.push(table);
            }
        }
        Ok(tables)
    }
}

fn too_many(tables: usize) -> LoadError {
    invalid(format!("{tables} tables, and a set has at most {MOST_TABLES}"))
}

/// Checks the format and version of a document before anything else: a newer document may not parse
/// as this version.
pub(super) fn check_version(json: &str) -> Result<(), LoadError> {
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
    }
    let head: Head = serde_json::from_str(json).map_err(invalid)?;
    if head.format != FORMAT {
        return Err(invalid(format!("format \"{}\" where \"{FORMAT}\" is expected", head.format)));
    }
    known(head.version, OLDEST_VERSION..=VERSION)
}

/// Refuses a version of the format that a reader of `versions` does not know.
fn known(version: u32, versions: RangeInclusive<u32>) -> Result<(), LoadError> {
    if versions.contains(&version) {
        return Ok(());
    }
    let (oldest, newest) = versions.into_inner();
    let known =
        if oldest == newest { format!("{oldest}") } else { format!("{oldest} to {newest}") };
    Err(LoadError::Unsupported(format!(
        "format version {version} (this reader knows {known}): update the reader or bake again"
    )))
}

/// The JSON document that describes a set, with zeros for its checksum.
///
/// It is what [`encode`](super::encode) embeds, and what other containers may carry.
///
/// # Errors
/// [`LoadError::Invalid`] if a material or a table would not load again.
pub fn describe(provenance: &Provenance, tables: &[Table]) -> Result<String, LoadError> {
    Document::of(provenance, tables)?.to_json()
}

/// The axes of a table as JSON of its document; tables that share an axis have the same text.
pub fn stated_axes(subject: &Subject, axes: &[Axis]) -> Vec<String> {
    let single = subject.single();
    let text = |axis| serde_json::to_string(&StoredAxis::of(axis, single)).unwrap_or_default();
    axes.iter().map(text).collect()
}

/// The name and the channels of each table of the document of [`describe`], in order.
///
/// # Errors
/// As [`reassemble`].
pub fn stated_tables(json: &str) -> Result<Vec<(String, Vec<String>)>, LoadError> {
    let document = Document::from_json(json)?;
    let of = |stack: &Stack, i| {
        let name = stack.table_name(i).map_err(|why| of_table(&stack.name, why))?;
        Ok((name, stack.channels.clone()))
    };
    let all = document.tables.iter().flat_map(|stack| (0..stack.len()).map(move |i| of(stack, i)));
    all.collect()
}

/// Reassembles a set from the document of [`describe`]; `values` is called once for each table, in
/// order, and returns its decoded values.
///
/// # Errors
/// [`LoadError`] if the document is not that of a set, or a table is not valid.
pub fn reassemble(
    json: &str,
    mut values: impl FnMut() -> Result<Vec<f32>, String>,
) -> Result<(Provenance, Vec<Table>), LoadError> {
    let document = Document::from_json(json)?;
    let tables = document.tables(|_, _| values())?;
    Ok((document.provenance, tables))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set_of(materials: &str) -> Provenance {
        let materials = serde_json::from_str(materials).unwrap();
        Provenance { materials, ..Provenance::default() }
    }

    #[test]
    fn only_what_an_older_reader_does_not_know_is_written_in_a_newer_version() {
        const PLAIN: &str = r#"{"name":"a","sigma":0.1,"gamma":2}"#;
        const HAZE: &str = r#""haze":{"weight":0.5,"sigma":0.5,"gamma":2}"#;
        for (keys, version) in [("", 4), (HAZE, 5), (r#""retroreflection":0.5"#, 5)] {
            let comma = if keys.is_empty() { "" } else { "," };
            let other = format!(r#"{{"name":"b","sigma":0.3,"gamma":3{comma}{keys}}}"#);
            let set = set_of(&format!("[{PLAIN},{other}]"));
            let json = describe(&set, &[]).unwrap();
            assert!(json.contains(&format!("\"version\":{version},")), "{json}");
            let (again, _) = reassemble(&json, || Ok(Vec::new())).unwrap();
            assert_eq!(again, set);
            // A reader of version 4 alone.
            match known(version, 4..=4) {
                Ok(()) => assert_eq!(version, 4),
                Err(LoadError::Unsupported(why)) => assert_eq!(
                    (version, &*why),
                    (5, "format version 5 (this reader knows 4): update the reader or bake again")
                ),
                Err(why) => panic!("{why}"),
            }
            let newest = json.replace(&format!("\"version\":{version},"), "\"version\":5,");
            assert_eq!(reassemble(&newest, || Ok(Vec::new())).unwrap().0, set);
            let oldest = json.replace(&format!("\"version\":{version},"), "\"version\":4,");
            assert_eq!(reassemble(&oldest, || Ok(Vec::new())).is_ok(), version == 4, "{oldest}");
        }
        assert_eq!(set_of("[]").version(), OLDEST_VERSION);
        for version in [0, 3, 6, u32::MAX] {
            let why = known(version, OLDEST_VERSION..=VERSION).unwrap_err().to_string();
            assert!(why.contains("(this reader knows 4 to 5)"), "{why}");
        }
    }
}
