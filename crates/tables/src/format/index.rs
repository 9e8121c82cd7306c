//! The index of numbered sets: in which file each material of a large library is.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::checksum::crc32;
use super::document::Provenance;
use crate::error::LoadError;

/// The `format` entry of the document.
const FORMAT: &str = "microfacet-tables index";
const VERSION: u32 = 2;

/// Which of the numbered sets in a folder holds which materials; `docs/format.md` has an example.
///
/// Each file is a whole set with all tables that its materials need. To read some materials of a
/// library of any size, read the files that [`files_of`](Self::files_of) names, one after the
/// other, keep only the tables of these materials (`Tables::only` of the crate
/// `microfacet-sampler`), and join them (`Tables::joined`).
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
    /// The CRC-32 (ISO-HDLC) of the file, as eight hexadecimal digits.
    pub crc32: String,
    /// The names of its materials; no other set has them.
    pub materials: Vec<String>,
}

impl IndexedSet {
    /// The entry of the numbered set of these bytes, the first being 1, with these materials.
    pub fn new(number: usize, bytes: &[u8], materials: Vec<String>) -> Self {
        let crc32 = crc32(bytes);
        let file = Index::file_name(number, &crc32);
        Self { file, bytes: bytes.len() as u64, crc32, materials }
    }

    /// Checks that these bytes are the set that was listed.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] if their size or checksum is another.
    pub fn check(&self, bytes: &[u8]) -> Result<(), LoadError> {
        let (size, crc32) = (bytes.len() as u64, crc32(bytes));
        if (size, &crc32) == (self.bytes, &self.crc32) {
            return Ok(());
        }
        Err(LoadError::Invalid(format!(
            "{size} bytes of CRC-32 {crc32}, and {} lists {} of {}: it is of another library, or \
             damaged; copy all files of the folder again, or bake again",
            Index::FILE,
            self.bytes,
            self.crc32
        )))
    }

    /// Checks that a set has the listed materials, and no others.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] naming the first that differs.
    pub fn check_materials(&self, provenance: &Provenance) -> Result<(), LoadError> {
        let held: Vec<&String> = provenance.materials.iter().map(|entry| &entry.name).collect();
        let differs = |i: &usize| held.get(*i).copied() != self.materials.get(*i);
        let Some(i) = (0..held.len().max(self.materials.len())).find(differs) else {
            return Ok(());
        };
        let of = |name: Option<&String>| name.map_or("none".into(), |name| format!("\"{name}\""));
        Err(LoadError::Invalid(format!(
            "its material {} is {}, and {} lists {}; bake again",
            i + 1,
            of(held.get(i).copied()),
            Index::FILE,
            of(self.materials.get(i))
        )))
    }
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

    /// The name of a numbered set, the first being 1, with its checksum:
    /// `tables-00001-9d2ad2a6.safetensors`. The checksum keeps a new library from overwriting the
    /// files of an old one, which are in use until the new index replaces the old index.
    fn file_name(number: usize, crc32: &str) -> String {
        format!("tables-{number:05}-{crc32}.safetensors")
    }

    /// Whether a numbered set can have this name.
    fn is_file_name(name: &str) -> bool {
        let middle =
            name.strip_prefix("tables-").and_then(|rest| rest.strip_suffix(".safetensors"));
        let Some((number, crc32)) = middle.and_then(|middle| middle.split_once('-')) else {
            return false;
        };
        let hexadecimal = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        number.len() >= 5
            && number.bytes().all(|byte| byte.is_ascii_digit())
            && crc32.len() == 8
            && crc32.bytes().all(hexadecimal)
    }

    /// Reads an index from its JSON.
    ///
    /// # Errors
    /// [`LoadError`] if it is no index, of another version, names a file that is not that of a
    /// numbered set, or a file or a material twice.
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

    /// The index as JSON.
    pub fn to_json(&self) -> String {
        let document =
            Document { format: FORMAT.into(), version: VERSION, sets: self.sets.clone() };
        serde_json::to_string_pretty(&document).expect("texts and numbers are JSON") + "\n"
    }

    /// Bytes of all sets, at most [`u64::MAX`]: an index may state any size.
    pub fn bytes(&self) -> u64 {
        self.sets.iter().fold(0, |sum, set| sum.saturating_add(set.bytes))
    }

    /// Number of the materials in all sets.
    pub fn materials(&self) -> usize {
        self.sets.iter().map(|set| set.materials.len()).sum()
    }

    /// The sets that hold these materials, each with the names that it holds; names that no set has
    /// are left out.
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
        let set = |number, names: &[&str]| {
            let names = names.iter().map(|&name| name.into()).collect();
            IndexedSet::new(number, format!("set {number}").as_bytes(), names)
        };
        Index { sets: vec![set(1, &["gold", "glass"]), set(2, &["brass"])] }
    }

    #[test]
    fn an_index_reads_back_and_finds_materials() {
        let index = index();
        assert_eq!(Index::from_json(&index.to_json()).unwrap(), index);
        assert_eq!((index.materials(), index.bytes()), (3, 10));
        let found = index.files_of(&["brass", "none", "glass"]);
        let found: Vec<_> = found.into_iter().map(|(set, names)| (&*set.file, names)).collect();
        let [one, two] = ["tables-00001-e30a8e27.safetensors", "tables-00002-7a03df9d.safetensors"];
        assert_eq!(found, [(one, vec!["glass"]), (two, vec!["brass"])]);
        assert!(index.files_of(&[]).is_empty());
        let wraps = index.to_json().replacen("5", &u64::MAX.to_string(), 1);
        assert_eq!(Index::from_json(&wraps).unwrap().bytes(), u64::MAX);
    }

    #[test]
    fn what_is_no_index_is_refused_by_name() {
        let json = index().to_json();
        let refused = |from: &str, to: &str, what: &str| {
            assert!(json.contains(from), "{from} in {json}");
            let why = Index::from_json(&json.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(why.contains(what), "{why}");
        };
        let [one, two] = ["tables-00001-e30a8e27", "tables-00002-7a03df9d"];
        refused("brass", "gold", "\"gold\" is in two sets");
        refused(two, &format!("../{two}"), "no name of a numbered set");
        refused(two, one, "no name of a numbered set");
        refused(two, "tables-00002", "no name of a numbered set");
        refused(two, "tables-2-7a03df9d", "no name of a numbered set");
        refused(two, "tables-00002-7A03DF9D", "no name of a numbered set");
        refused("\"version\": 2", "\"version\": 1", "version 1");
        refused(" index", " list", "\"microfacet-tables index\" is expected");
        refused("{", "", "index:");
    }

    #[test]
    fn a_set_is_what_the_index_lists() {
        let set = &index().sets[0];
        set.check(b"set 1").unwrap();
        for other in [&b"set 2"[..], b"set 1 ", b""] {
            let why = set.check(other).unwrap_err().to_string();
            assert!(why.contains("lists 5 of e30a8e27"), "{why}");
        }
        let of = |names: &[&str]| {
            let text: Vec<String> = names
                .iter()
                .map(|name| format!(r#"{{"name":"{name}","sigma":0.1,"gamma":2}}"#))
                .collect();
            let materials = serde_json::from_str(&format!("[{}]", text.join(","))).unwrap();
            set.check_materials(&Provenance { materials, ..Provenance::default() })
        };
        of(&["gold", "glass"]).unwrap();
        for (names, what) in [
            (&["gold"][..], "its material 2 is none"),
            (&["glass", "gold"], "its material 1 is \"glass\""),
            (&["gold", "glass", "brass"], "lists none"),
        ] {
            let why = of(names).unwrap_err().to_string();
            assert!(why.contains(what), "{why}");
        }
    }
}
