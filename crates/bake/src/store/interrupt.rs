//! Lets an interrupted process end between two writes, not within one.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};
use std::{fs, io};

use tempfile::NamedTempFile;

/// Held while files are replaced.
static WRITING: Mutex<()> = Mutex::new(());
/// Files under temporary names, and folders made for sets.
static LEFTOVERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Marks a write that must not be cut short, while the guard lives. Does not nest.
pub(super) fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn leftovers() -> MutexGuard<'static, Vec<PathBuf>> {
    LEFTOVERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Files and folders that an interrupt removes while this lives. Only empty folders are removed, on
/// drop as well.
#[derive(Debug)]
pub(super) struct Leftovers(Vec<PathBuf>);

impl Leftovers {
    /// Folders that are about to be made, the innermost first.
    pub(super) fn folders(folders: Vec<PathBuf>) -> Self {
        leftovers().extend_from_slice(&folders);
        Self(folders)
    }
}

/// A file under a temporary name.
#[derive(Debug)]
pub(super) struct Partial {
    pub(super) file: NamedTempFile,
    _leftovers: Leftovers,
}

impl Partial {
    /// Makes a file; the lock on the list is held meanwhile, so that an interrupt misses no file.
    pub(super) fn new(make: impl FnOnce() -> io::Result<NamedTempFile>) -> io::Result<Self> {
        let mut all = leftovers();
        let file = make()?;
        all.push(file.path().into());
        Ok(Self { _leftovers: Leftovers(vec![file.path().into()]), file })
    }
}

fn remove_empty(all: &[PathBuf]) {
    for path in all {
        // A folder with any content cannot be removed, nor can a file.
        let _ = fs::remove_dir(path);
    }
}

impl Drop for Leftovers {
    fn drop(&mut self) {
        remove_empty(&self.0);
        leftovers().retain(|path| !self.0.contains(path));
    }
}

/// Prepares the end of the process from a signal handler's thread: waits until no file is being
/// replaced, lets no other write begin, and removes files under temporary names and the empty
/// folders that were made for sets.
///
/// Returns whether the files are whole; `false` if a write has not ended within `patience`.
pub fn quiesce(patience: Duration) -> bool {
    let start = Instant::now();
    let guard = loop {
        match WRITING.try_lock() {
            Err(TryLockError::WouldBlock) if start.elapsed() < patience => {
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(TryLockError::WouldBlock) => return false,
            Ok(guard) => break guard,
            Err(TryLockError::Poisoned(why)) => break why.into_inner(),
        }
    };
    let leftovers = leftovers();
    for path in leftovers.iter() {
        // Fails for folders and for files that are gone already.
        let _ = fs::remove_file(path);
    }
    remove_empty(&leftovers);
    // Never unlocked again.
    std::mem::forget((guard, leftovers));
    true
}
