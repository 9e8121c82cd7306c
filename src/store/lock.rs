//! Locks an output folder for one bake at a time.

use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use microfacet_sampler::Tables;

use super::replace::{finish, replace_all};
use super::{Format, SET_FILE, StoreError, Written, files, read_file};

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
}

impl OutputFolder {
    /// Makes the folder if it does not exist, locks it, checks that it can be written to, and
    /// cleans up after an interrupted bake: if the last step of replacing a set had begun, it is
    /// completed, and partial files are removed.
    ///
    /// # Errors
    /// [`StoreError::InUse`] if another bake has locked the folder, [`StoreError::Io`] if the path
    /// is no folder or cannot be written to.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let failed = |why| StoreError::Io(path.into(), why);
        if path.exists() && !path.is_dir() {
            return Err(failed(io::Error::new(
                io::ErrorKind::NotADirectory,
                "is a file; name a folder",
            )));
        }
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        let mut this = Self { path: path.into(), made, lock: None };
        std::fs::create_dir_all(path).map_err(failed)?;
        let lock = this.lock.insert(lock_file(path).map_err(failed)?);
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                // The bake that holds the lock uses these folders.
                this.made.clear();
                return Err(StoreError::InUse(path.into()));
            }
            // Some network file systems have no locks; files are still replaced as a whole.
            Err(TryLockError::Error(why)) if why.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(why)) => return Err(failed(why)),
        }
        finish(path).map_err(failed)?;
        // Fail now rather than after an hour of baking.
        tempfile::tempfile_in(path).map_err(failed)?;
        Ok(this)
    }

    /// Writes a set: `tables.safetensors`, and `NAME.exr` for each table. A folder holds one set:
    /// tables of an earlier set are removed, other files stay.
    ///
    /// First all new files are written beside the old ones. A single file is then replaced in one
    /// step; with several, the old ones are removed before the first new one appears, so that the
    /// two sets never mix.
    ///
    /// # Errors
    /// [`StoreError`] naming the path; the old set is then unchanged.
    pub fn write(&self, set: &Tables, formats: &[Format]) -> Result<Vec<Written>, StoreError> {
        let files = files(set, formats).map_err(|why| why.inside(&self.path))?;
        let stale = self.stale(&files).map_err(|why| StoreError::Io(self.path.clone(), why))?;
        replace_all(&self.path, &files, &stale)
            .map_err(|(name, why)| StoreError::Io(self.path.join(name), why))?;
        let written = |(name, bytes): &(String, Vec<u8>)| Written {
            path: self.path.join(name),
            bytes: bytes.len(),
        };
        Ok(files.iter().map(written).collect())
    }

    /// Names of the tables in the folder that the new `files` do not replace.
    fn stale(&self, files: &[(String, Vec<u8>)]) -> io::Result<Vec<String>> {
        let mut stale = Vec::new();
        for entry in std::fs::read_dir(&self.path)? {
            let Ok(name) = entry?.file_name().into_string() else { continue };
            let ours = name == SET_FILE || name.ends_with(".exr");
            // A file that does not load as a table is not ours.
            if ours
                && files.iter().all(|(new, _)| *new != name)
                && read_file(&self.path.join(&name)).is_ok()
            {
                stale.push(name);
            }
        }
        Ok(stale)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // A folder with any content cannot be removed, and stays.
        if !cfg!(unix) && !self.made.is_empty() {
            self.lock = None;
            let _ = std::fs::remove_file(self.path.join(LOCK_FILE));
        }
        self.made.iter().all(|folder| std::fs::remove_dir(folder).is_ok());
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
