//! Libraries too large for one set: numbered sets and their index.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::Relaxed;

use microfacet_sampler::Tables;
use microfacet_tables::{Index, IndexedSet, encode};

use super::journal::{self, RECORD, Replacement};
use super::{
    Format, OutputFolder, StoreError, Written, allow, interrupt, invalid, read, read_file, replace,
};
use crate::input::{self, MAX_TABLES};

/// Writes any number of sets into a folder: one is `tables.safetensors`, several are
/// `tables-00001.safetensors` and so on with an index, `tables.index.json`. All take their places
/// together at the end; only one is in memory at a time.
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
        let replacement = Replacement::new(self.path());
        SetWriter { folder: self, first: None, replacement, index: Index { sets: Vec::new() } }
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
        let file = Index::file_name(self.index.sets.len() + 1);
        let path = || self.folder.path().join(&file);
        let bytes =
            encode(set.provenance(), set.tables()).map_err(|why| StoreError::Load(path(), why))?;
        let allowed = allow(bytes.len() as u64, MAX_TABLES);
        allowed.map_err(|why| StoreError::TooLarge(path(), why))?;
        self.replacement
            .add(&file, &bytes)
            .map_err(|(name, why)| StoreError::Io(self.folder.path().join(name), why))?;
        let names = set.provenance().materials.iter().map(|entry| entry.name.clone());
        let (bytes, materials) = (bytes.len() as u64, names.collect());
        self.index.sets.push(IndexedSet { file, bytes, materials });
        Ok(())
    }

    /// Puts all sets in the place of what the folder held.
    ///
    /// # Errors
    /// As [`OutputFolder::write`]; also if two sets have materials of the same name.
    pub fn finish(self) -> Result<Vec<Written>, StoreError> {
        let Self { folder, first, mut replacement, index } = self;
        if let Some(set) = first {
            return folder.write(&set, &[Format::Safetensors]);
        }
        if index.sets.is_empty() {
            let why = invalid("there is no set to write: add one before".into());
            return Err(StoreError::Io(folder.path().into(), why));
        }
        let failed = |(name, why): (String, _)| StoreError::Io(folder.path().join(name), why);
        let json = index.to_json();
        Index::from_json(&json)
            .map_err(|why| StoreError::Load(folder.path().join(Index::FILE), why))?;
        replacement.add(Index::FILE, json.as_bytes()).map_err(failed)?;
        let mut names: Vec<String> = index.sets.iter().map(|set| set.file.clone()).collect();
        names.push(Index::FILE.into());
        let record: String = names.iter().map(|name| format!("{name}\n")).collect();
        replacement.add(RECORD, record.as_bytes()).map_err(failed)?;
        names.push(RECORD.into());
        let mut stale = folder.old()?;
        stale.retain(|old| !names.contains(old));
        let _writing = interrupt::writing();
        replacement.commit(&stale).map_err(failed)?;
        folder.written().store(true, Relaxed);
        let written = |file: &str, bytes| Written { path: folder.path().join(file), bytes };
        let sets = index.sets.iter().map(|set| written(&set.file, set.bytes as usize));
        Ok(sets.chain([written(Index::FILE, json.len())]).collect())
    }
}

/// The index of numbered sets at a path, if it is one or a folder that holds one.
pub(super) fn index_at(path: &Path) -> Result<Option<Index>, StoreError> {
    let file = if path.is_dir() {
        path.join(Index::FILE)
    } else if path.file_name().is_some_and(|name| name == Index::FILE) {
        path.to_path_buf()
    } else {
        return Ok(None);
    };
    if std::fs::symlink_metadata(&file).is_err() {
        return Ok(None);
    }
    let text = input::read_text(&file, input::MAX_TEXT);
    let text = text.map_err(|why| StoreError::Io(file.clone(), why))?;
    Index::from_json(&text).map(Some).map_err(|why| StoreError::Load(file, why))
}

/// The index of the numbered sets at a path, a folder or the index itself; `None` for one set.
///
/// # Errors
/// [`StoreError`] if the index cannot be read.
pub fn index(path: &Path) -> Result<Option<Index>, StoreError> {
    index_at(path)
}

/// All numbered sets as one, if that is no larger than what is read of one.
pub(super) fn read_all(folder: &Path, index: &Index) -> Result<Tables, StoreError> {
    let bytes: u64 = index.sets.iter().map(|set| set.bytes).sum();
    if bytes > MAX_TABLES {
        let first = folder.join(index.sets.first().map_or(Index::FILE, |set| &set.file));
        return Err(StoreError::Io(
            folder.into(),
            invalid(format!(
                "holds {} numbered sets of {} materials, {} MiB together, and at most {} MiB are \
                 read at once: name one of them, such as {}, or open the materials that you need \
                 (in Python `Tables(path, materials=[...])`, in Rust `store::read_materials`)",
                index.sets.len(),
                index.materials(),
                bytes >> 20,
                MAX_TABLES >> 20,
                first.display()
            )),
        ));
    }
    let sets = index.sets.iter().map(|set| read_file(&folder.join(&set.file)));
    joined(folder, sets.collect::<Result<Vec<Tables>, _>>()?)
}

fn joined(folder: &Path, sets: Vec<Tables>) -> Result<Tables, StoreError> {
    Tables::joined(sets).map_err(|why| StoreError::Load(folder.into(), why))
}

/// Reads some materials of a set, or of numbered sets of any size; one file is in memory at a time.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong, such as a material that is not there.
pub fn read_materials(path: &Path, names: &[&str]) -> Result<Tables, StoreError> {
    let folder = if path.is_dir() { path } else { replace::folder_of(path) };
    let missing = |why: String| StoreError::NoMaterial(path.into(), why);
    let only =
        |set: Tables, names: &[&str]| set.only(names).map_err(|why| missing(why.to_string()));
    loop {
        if journal::is_interrupted(folder) {
            OutputFolder::complete(folder)?;
        }
        let before = journal::record_stamp(folder);
        let Some(index) = index_at(path)? else {
            return only(read(path)?, names);
        };
        let found = index.files_of(names);
        let is_found = |name: &&str| found.iter().any(|(_, held)| held.contains(name));
        if let Some(name) = names.iter().find(|name| !is_found(name)) {
            return Err(missing(format!(
                "none of the {} materials is named \"{name}\"; {} lists them",
                index.materials(),
                Index::FILE
            )));
        }
        let part = |(set, held): (&IndexedSet, Vec<&str>)| {
            let path: PathBuf = folder.join(&set.file);
            only(read_file(&path)?, &held)
        };
        let sets: Result<Vec<Tables>, StoreError> = found.into_iter().map(part).collect();
        // If a bake replaced the sets meanwhile, the index was not theirs.
        if !journal::is_interrupted(folder) && journal::record_stamp(folder) == before {
            return joined(folder, sets?);
        }
    }
}
