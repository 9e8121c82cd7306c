//! The index of numbered sets: in which file each material of a large library is.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::error::LoadError;

/// The `format` entry of the document.
const FORMAT: &str = "microfacet-tables index";
/// Version of the document.
const VERSION: u32 = 1;

/// Which of the numbered sets in a folder holds which materials; `docs/format.md` has an example.
///
/// Each file is a whole set with all that its materials need. To serve some materials of a library
/// of any size, read the files that [`files_of`](Self::files_of) names, one after the other, keep
/// only what serves them (`Tables::only` of the crate `microfacet-sampler`), and put that together
/// (`Tables::joined`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Index {
    /// The sets, in order.
    pub sets: Vec<IndexedSet>,
}

/// One of the numbered sets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct IndexedSet {
    /// The name of its file, in the folder of the index.
    pub file: String,
    /// The size of the file.
    pub bytes: u64,
    /// The names of its materials; no other set has them.
    pub materials: Vec<String>,
}

#[derive(Serialize, Deserialize)]
struct Document {
    format: String,
    version: u32,
    sets: Vec<IndexedSet>,
}

impl Index {
    /// The file in a folder that holds the index of the numbered sets there.
    pub const FILE: &str = "tables.index.json";

    /// The name of a numbered set, the first being 1: `tables-00001.safetensors`.
    pub fn file_name(number: usize) -> String {
        format!("tables-{number:05}.safetensors")
    }

    /// Whether [`file_name`](Self::file_name) gives this name for some number.
    pub fn is_file_name(name: &str) -> bool {
        let number =
            name.strip_prefix("tables-").and_then(|rest| rest.strip_suffix(".safetensors"));
        let number = number.filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
        number.and_then(|n| n.parse().ok()).is_some_and(|n| n > 0 && name == Self::file_name(n))
    }

    /// Reads the document.
    ///
    /// # Errors
    /// [`LoadError`] if it is no index, of another version, names a file that is not that of a
    /// numbered set, or a material twice.
    pub fn from_json(json: &str) -> Result<Self, LoadError> {
        let invalid = |why: String| LoadError::Invalid(format!("index: {why}"));
        let Document { format, version, sets } =
            serde_json::from_str(json).map_err(|why| invalid(why.to_string()))?;
        if format != FORMAT {
            return Err(invalid(format!("format \"{format}\" where \"{FORMAT}\" is expected")));
        }
        if version != VERSION {
            return Err(LoadError::Unsupported(format!(
                "index of version {version} (this reader knows {VERSION}): update the reader or \
                 bake again"
            )));
        }
        let (mut files, mut materials) = (BTreeSet::new(), BTreeSet::new());
        for set in &sets {
            if !Self::is_file_name(&set.file) || !files.insert(&set.file) {
                return Err(invalid(format!("\"{}\" is no name of a numbered set", set.file)));
            }
            if let Some(name) = set.materials.iter().find(|name| !materials.insert(*name)) {
                return Err(invalid(format!("the material \"{name}\" is in two sets")));
            }
        }
        Ok(Self { sets })
    }

    /// The document.
    pub fn to_json(&self) -> String {
        let document =
            Document { format: FORMAT.into(), version: VERSION, sets: self.sets.clone() };
        serde_json::to_string_pretty(&document).expect("texts and numbers are JSON") + "\n"
    }

    /// Number of the materials in all sets.
    pub fn materials(&self) -> usize {
        self.sets.iter().map(|set| set.materials.len()).sum()
    }

    /// The sets that hold these materials, each with those of its own; names that no set has are
    /// left out.
    pub fn files_of<'a>(&'a self, names: &[&'a str]) -> Vec<(&'a IndexedSet, Vec<&'a str>)> {
        let wanted: BTreeSet<&str> = names.iter().copied().collect();
        let held = |set: &'a IndexedSet| {
            let held = set.materials.iter().map(String::as_str);
            (set, held.filter(|name| wanted.contains(name)).collect::<Vec<&str>>())
        };
        self.sets.iter().map(held).filter(|(_, held)| !held.is_empty()).collect()
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn index() -> Index {
        let set = |number, names: &[&str]| IndexedSet {
            file: Index::file_name(number),
            bytes: 7,
            materials: names.iter().map(|&name| name.into()).collect(),
        };
        Index { sets: vec![set(1, &["gold", "glass"]), set(2, &["brass"])] }
    }

    #[test]
    fn an_index_reads_back_and_finds_materials() {
        let index = index();
        assert_eq!(Index::from_json(&index.to_json()).unwrap(), index);
        assert_eq!(index.materials(), 3);
        let found = index.files_of(&["brass", "none", "glass"]);
        let found: Vec<_> = found.into_iter().map(|(set, names)| (&*set.file, names)).collect();
        let [one, two] = ["tables-00001.safetensors", "tables-00002.safetensors"];
        assert_eq!(found, [(one, vec!["glass"]), (two, vec!["brass"])]);
        assert!(index.files_of(&[]).is_empty());
    }

    #[test]
    fn what_is_no_index_is_refused_by_name() {
        let json = index().to_json();
        let refused = |from: &str, to: &str, what: &str| {
            let why = Index::from_json(&json.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(why.contains(what), "{why}");
        };
        refused("brass", "gold", "\"gold\" is in two sets");
        refused("tables-00002", "../tables-00002", "no name of a numbered set");
        refused("tables-00002", "tables-00001", "no name of a numbered set");
        refused("\"version\": 1", "\"version\": 2", "version 2");
        refused(" index", " list", "\"microfacet-tables index\" is expected");
        refused("{", "", "index:");
        for name in ["tables-1.safetensors", "tables-00000.safetensors", "tables.safetensors"] {
            assert!(!Index::is_file_name(name), "{name}");
        }
        assert!(Index::is_file_name("tables-100000.safetensors"));
    }
}
