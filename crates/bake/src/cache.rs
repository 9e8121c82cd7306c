//! A cache of finished tables, by the content of their specification.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, LazyLock};

use etcetera::BaseStrategy;
use sha2::{Digest, Sha256};

use microfacet_tables::{Mapping, OLDEST_VERSION, Provenance, Table, encode};

use crate::bake::NUMERICS;
use crate::store::{self, in_folder, make_folder, remove_abandoned, replace};

/// A folder of finished tables, or no cache at all.
///
/// An entry is a table set named by the SHA-256 of its key: the complete specification with all its
/// numbers, the number of the numeric method, the version of the format and the coordinates along
/// the axes. So an entry is never out of date, entries may be removed at any time, and several
/// processes may share a folder. An entry that cannot be read counts as missing.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: Option<PathBuf>,
    /// Whether an entry was written.
    kept: Arc<AtomicBool>,
    /// Whether incomplete files of killed processes were looked for.
    tidied: Arc<AtomicBool>,
}

impl Cache {
    /// A cache in this folder, which is created with the first entry.
    pub fn new(folder: PathBuf) -> Self {
        Self::at(Some(folder))
    }

    fn at(folder: Option<PathBuf>) -> Self {
        Self { folder, kept: Arc::default(), tidied: Arc::default() }
    }

    /// A cache that keeps nothing.
    pub fn none() -> Self {
        Self::at(None)
    }

    /// The folder `microfacet-bake` in the user's cache folder (`$XDG_CACHE_HOME`, or the system's
    /// equivalent); no cache if the user has no home.
    pub fn user() -> Self {
        let folder = etcetera::choose_base_strategy()
            .ok()
            .map(|base| base.cache_dir().join("microfacet-bake"));
        Self::at(folder)
    }

    /// The folder, if there is one.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Whether this cache or a clone of it has kept any tables; may be read at any time.
    pub fn kept(&self) -> Arc<AtomicBool> {
        self.kept.clone()
    }

    /// The tables kept under a key. The caller has to check that they are those that the key
    /// describes: the file may hold any.
    pub fn get(&self, key: &str) -> Option<Vec<Table>> {
        let key = complete(key);
        let set = store::read_file(&self.path(&key)?).ok()?;
        // A file of this name may hold the entry of another key.
        let Provenance { key: of, numerics, .. } = set.provenance();
        (*of == key && *numerics == NUMERICS).then(|| set.tables().to_vec())
    }

    /// Keeps tables under a key. The first call of a cache or its clones also removes incomplete
    /// files of bakes that were killed.
    ///
    /// # Errors
    /// Any error of the operating system, such as a folder that cannot be written.
    pub fn put(&self, key: &str, tables: &[Table]) -> io::Result<()> {
        let key = complete(key);
        let Some(folder) = &self.folder else { return Ok(()) };
        let name = name_of(&key);
        let provenance = Provenance { key, numerics: NUMERICS, ..Provenance::default() };
        let bytes = encode(&provenance, tables).map_err(io::Error::other)?;
        write_in(folder, &name, &bytes)?;
        // Only once, since it lists the folder, which may hold very many entries.
        if !self.tidied.swap(true, Relaxed) {
            remove_abandoned(folder);
        }
        self.kept.store(true, Relaxed);
        Ok(())
    }

    /// Removes the entry of a key, if there is one.
    pub fn remove(&self, key: &str) {
        if let Some(path) = self.path(&complete(key)) {
            // The file may be gone already.
            let _ = std::fs::remove_file(path);
        }
    }

    fn path(&self, key: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(name_of(key)))
    }
}

/// A key with all that tables depend on: versions, and the formulas and constants of coordinates,
/// which a specification does not name.
pub(crate) fn complete(key: &str) -> String {
    // Made once, since it is longer than most keys.
    static HEAD: LazyLock<String> = LazyLock::new(|| {
        let mappings = Mapping::EVERY.map(|mapping| (mapping, mapping.formula()));
        format!("{}, {mappings:?}\n", versions())
    });
    [HEAD.as_str(), key].concat()
}

fn name_of(key: &str) -> String {
    sha256(key) + ".safetensors"
}

/// Writes a file into a folder, which is made if it is not there.
pub(crate) fn write_in(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<()> {
    let at = |path: &Path, why: io::Error| {
        io::Error::new(why.kind(), format!("{}: {why}", path.display()))
    };
    let path = folder.join(name);
    make_folder(folder).map_err(|why| at(folder, why))?;
    in_folder(folder, || replace(&path, bytes)).map_err(|why| at(&path, why))
}

/// In hexadecimal.
pub(crate) fn sha256(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

pub(crate) fn versions() -> String {
    let program = env!("CARGO_PKG_VERSION");
    format!("format {OLDEST_VERSION}, numerics {NUMERICS}, program {program}")
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::time::{Duration, SystemTime};

    use super::*;

    #[test]
    fn leftovers_are_looked_for_once_by_a_cache_and_its_clones() {
        let folder = tempfile::tempdir().unwrap();
        let leftover = folder.path().join(".microfacet-bake-x.partial");
        let leave = || {
            let week = Duration::from_secs(7 * 24 * 3600);
            File::create(&leftover).unwrap().set_modified(SystemTime::now() - week).unwrap();
        };
        let cache = Cache::new(folder.path().into());
        leave();
        cache.put("a", &[]).unwrap();
        assert!(!leftover.exists());
        leave();
        cache.clone().put("b", &[]).unwrap();
        assert!(leftover.exists());
        Cache::new(folder.path().into()).put("c", &[]).unwrap();
        assert!(!leftover.exists());
    }
}
