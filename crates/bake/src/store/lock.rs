//! Locks an output folder for one bake at a time.

use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use microfacet_sampler::Tables;

use super::interrupt;
use super::journal::{RECORD, finish, is_ours, recorded, replace_all};
use super::replace::{check_writable, make_folder};
use super::{Format, SET_FILE, StoreError, Written, files};

/// A folder to write a set into, locked against every other bake until it is dropped.
///
/// The lock ends with the process, however it ends, and leaves nothing behind. A folder that was
/// made for the set is removed again on drop if the bake was refused and nothing was written.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// Folders that did not exist before, the innermost first.
    made: Vec<PathBuf>,
    lock: Option<File>,
    /// Whether a new set is in the folder.
    written: Arc<AtomicBool>,
}

impl OutputFolder {
    /// Makes the folder if it does not exist, locks it, cleans up after an interrupted bake, and
    /// checks that the folder and the set in it can be written to. If the last step of replacing a
    /// set had begun, it is completed, and partial files are removed.
    ///
    /// # Errors
    /// [`StoreError::InUse`] if another bake has locked the folder, [`StoreError::Io`] if the path
    /// is no folder or cannot be written to.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let this = Self::complete(path)?;
        // Fail now rather than after an hour of baking.
        tempfile::tempfile_in(path).map_err(|why| StoreError::Io(path.into(), why))?;
        for name in this.old()?.iter().map(String::as_str).chain([SET_FILE]) {
            let file = path.join(name);
            check_writable(&file).map_err(|why| StoreError::Io(file, why))?;
        }
        Ok(this)
    }

    /// Locks the folder, and completes what an interrupted bake has begun.
    pub(super) fn complete(path: &Path) -> Result<Self, StoreError> {
        let failed = |why| StoreError::Io(path.into(), why);
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made: Vec<_> = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        interrupt::will_make(&made);
        let mut this = Self { path: path.into(), made, lock: None, written: Arc::default() };
        make_folder(path).map_err(failed)?;
        let lock = this.lock.insert(lock_file(path).map_err(failed)?);
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                // The bake that holds the lock uses these folders.
                interrupt::forget(&this.made);
                this.made.clear();
                return Err(StoreError::InUse(path.into()));
            }
            // Some network file systems have no locks; files are still replaced as a whole.
            Err(TryLockError::Error(why)) if why.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(why)) => return Err(failed(why)),
        }
        let _writing = interrupt::writing();
        finish(path).map_err(|(name, why)| StoreError::Io(path.join(name), why))?;
        Ok(this)
    }

    /// Whether [`write`](Self::write) has replaced the set, to be read at any time.
    pub fn written(&self) -> Arc<AtomicBool> {
        self.written.clone()
    }

    /// The folder.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Names of the files of the set that is in the folder, as far as they are known to be ours.
    pub(super) fn old(&self) -> Result<Vec<String>, StoreError> {
        let recorded = recorded(&self.path);
        let mut old = recorded.map_err(|(name, why)| StoreError::Io(self.path.join(name), why))?;
        old.extend([SET_FILE, RECORD].map(String::from));
        old.sort();
        old.dedup();
        old.retain(|name| is_ours(&self.path, name));
        Ok(old)
    }

    /// Writes a set: `tables.safetensors`, and `NAME.exr` for each table; several sets are
    /// [`sets`](Self::sets); a set without tables is
    /// `tables.safetensors` in any format. A folder holds one set: the files of the set that was
    /// written here before are removed, all others stay.
    ///
    /// First all new files are written beside the old ones. A single file is then replaced in one
    /// step; with several, the old ones are removed before the first new one appears, so that the
    /// two sets never mix. Each file is written as [`replace`](super::replace()) does it.
    ///
    /// # Errors
    /// [`StoreError`] naming the path. The old set is then unchanged, unless its replacement had
    /// begun; whoever opens the folder next completes it.
    pub fn write(&self, set: &Tables, formats: &[Format]) -> Result<Vec<Written>, StoreError> {
        let mut files = files(set, formats).map_err(|why| why.inside(&self.path))?;
        let written = |(name, bytes): &(String, Vec<u8>)| Written {
            path: self.path.join(name),
            bytes: bytes.len(),
        };
        let all = files.iter().map(written).collect();
        if files.iter().any(|(name, _)| name != SET_FILE) {
            let names: String = files.iter().map(|(name, _)| format!("{name}\n")).collect();
            files.push((RECORD.into(), names.into_bytes()));
        }
        let mut stale = self.old()?;
        stale.retain(|old| files.iter().all(|(new, _)| new != old));
        let _writing = interrupt::writing();
        replace_all(&self.path, &files, &stale)
            .map_err(|(name, why)| StoreError::Io(self.path.join(name), why))?;
        // While the write is marked: an interrupt sees both or neither.
        self.written.store(true, Relaxed);
        Ok(all)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        if !cfg!(unix) && !self.made.is_empty() {
            self.lock = None;
            let _ = std::fs::remove_file(self.path.join(LOCK_FILE));
        }
        interrupt::remove_empty(&self.made);
        interrupt::forget(&self.made);
    }
}

/// Name of the file that is locked where a folder itself cannot be.
const LOCK_FILE: &str = ".microfacet-bake.lock";

/// Opens what the lock is taken on: on Unix the folder itself.
#[cfg(unix)]
fn lock_file(folder: &Path) -> io::Result<File> {
    File::open(folder)
}

/// On other systems, where folders cannot be opened, a file in the folder.
#[cfg(not(unix))]
fn lock_file(folder: &Path) -> io::Result<File> {
    File::create(folder.join(LOCK_FILE))
}
