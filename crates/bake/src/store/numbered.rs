//! Libraries too large for one set: numbered sets and their index.

use std::path::Path;

use microfacet_sampler::Tables;
use microfacet_tables::{Index, IndexedSet};

use super::replace::Replacement;
use super::{Format, OutputFolder, StoreError, Written, bytes_of, invalid};
use crate::input::{self, MAX_TABLES};

/// Writes any number of sets into a folder: one set is `tables.safetensors`, several are files such
/// as `tables-00001-9d2ad2a6.safetensors` with an index, `tables.index.json`, which is replaced
/// last. Only one set is in memory at a time.
#[derive(Debug)]
pub struct SetWriter {
    folder: OutputFolder,
    /// The first set, until there is a second.
    first: Option<Tables>,
    replacement: Replacement,
    index: Index,
}

impl OutputFolder {
    /// Begins to write sets.
    pub fn sets(self) -> SetWriter {
        let index = Index { sets: Vec::new() };
        SetWriter { folder: self, first: None, replacement: Replacement::default(), index }
    }
}

impl SetWriter {
    /// Adds the next set, whose materials no other set has.
    ///
    /// # Errors
    /// [`StoreError`] if it cannot be written, or is larger than what is read back.
    pub fn add(&mut self, set: Tables) -> Result<(), StoreError> {
        if self.index.sets.is_empty() {
            match self.first.take() {
                None => {
                    self.first = Some(set);
                    return Ok(());
                }
                Some(first) => self.number(&first)?,
            }
        }
        self.number(&set)
    }

    fn number(&mut self, set: &Tables) -> Result<(), StoreError> {
        let number = self.index.sets.len() + 1;
        let path = self.folder.path().join(format!("numbered set {number}"));
        let bytes = bytes_of(set, Format::Safetensors, &path)?;
        let names = set.provenance().materials.iter().map(|entry| entry.name.clone());
        let entry = IndexedSet::new(number, &bytes, names.collect());
        self.replacement.put(self.folder.path().join(&entry.file), &bytes)?;
        self.index.sets.push(entry);
        Ok(())
    }

    /// Replaces the set or sets of the folder: the index in one step, after the files that it
    /// lists.
    ///
    /// # Errors
    /// As [`OutputFolder::write`]; also if two sets have materials of the same name.
    pub fn finish(self) -> Result<Vec<Written>, StoreError> {
        let Self { folder, first, mut replacement, index } = self;
        if let Some(set) = first {
            return folder.write(&set, Format::Safetensors);
        }
        if index.sets.is_empty() {
            let why = invalid("there is no set to write: add one before".into());
            return Err(StoreError::Io(folder.path().into(), why));
        }
        let (path, json) = (folder.path().join(Index::FILE), index.to_json());
        Index::from_json(&json).map_err(|why| StoreError::Load(path.clone(), why))?;
        let listing = replacement.put(path, json.as_bytes())?;
        folder.exchange(replacement)?;
        let written = |set: &IndexedSet| Written {
            path: folder.path().join(&set.file),
            bytes: set.bytes as usize,
        };
        let sets = index.sets.iter().map(written);
        Ok(sets.chain([listing]).collect())
    }
}

/// The index in a folder, if there is one.
pub(super) fn index_at(folder: &Path) -> Result<Option<Index>, StoreError> {
    let file = folder.join(Index::FILE);
    if std::fs::symlink_metadata(&file).is_err() {
        return Ok(None);
    }
    let text = input::read_text(&file, input::MAX_TEXT);
    let text = text.map_err(|why| StoreError::Io(file.clone(), why))?;
    Index::from_json(&text).map(Some).map_err(|why| StoreError::Load(file, why))
}

/// All sets of a folder's index as one set, if together they are not larger than [`MAX_TABLES`].
pub(super) fn read_all(folder: &Path, index: &Index) -> Result<Tables, StoreError> {
    if index.bytes() > MAX_TABLES {
        let first = folder.join(index.sets.first().map_or(Index::FILE, |set| &set.file));
        return Err(StoreError::Io(
            folder.into(),
            invalid(format!(
                "holds {} numbered sets of {} materials, {} MiB together, and at most {} MiB are \
                 read at once: name one of them, such as {}, or open the materials that you need \
                 (in Python `Tables(path, materials=[...])`, in Rust `store::read_materials`)",
                index.sets.len(),
                index.materials(),
                index.bytes() >> 20,
                MAX_TABLES >> 20,
                first.display()
            )),
        ));
    }
    let sets = index.sets.iter().map(|set| read_listed(folder, set));
    joined(folder, sets.collect::<Result<Vec<Tables>, _>>()?)
}

/// Some materials of a folder's index; one file is in memory at a time.
pub(super) fn read_some(
    folder: &Path,
    index: &Index,
    names: &[&str],
) -> Result<Tables, StoreError> {
    let found = index.files_of(names);
    let is_found = |name: &&str| found.iter().any(|(_, held)| held.contains(name));
    if let Some(name) = names.iter().find(|name| !is_found(name)) {
        let why = format!(
            "none of the {} materials is named \"{name}\"; {} lists them",
            index.materials(),
            Index::FILE
        );
        return Err(StoreError::NoMaterial(folder.into(), why));
    }
    let part = |(set, held): (&IndexedSet, Vec<&str>)| {
        let set = read_listed(folder, set)?;
        set.only(&held).map_err(|why| StoreError::NoMaterial(folder.into(), why.to_string()))
    };
    let sets: Result<Vec<Tables>, StoreError> = found.into_iter().map(part).collect();
    joined(folder, sets?)
}

/// A numbered set, if it is the one that the index lists.
fn read_listed(folder: &Path, listed: &IndexedSet) -> Result<Tables, StoreError> {
    let path = folder.join(&listed.file);
    let bytes = input::read(&path, MAX_TABLES).map_err(|why| StoreError::Io(path.clone(), why))?;
    let set = listed.check(&bytes).and_then(|()| Tables::from_bytes(&bytes));
    let set = set.and_then(|set| listed.check_materials(set.provenance()).map(|()| set));
    set.map_err(|why| StoreError::Load(path, why))
}

fn joined(folder: &Path, sets: Vec<Tables>) -> Result<Tables, StoreError> {
    Tables::joined(sets).map_err(|why| StoreError::Load(folder.into(), why))
}
