//! Ends a process between two writes and never within one.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use tempfile::NamedTempFile;

/// Held while files are replaced.
static WRITING: Mutex<()> = Mutex::new(());
/// Folders that were made for sets, the innermost first; a bake that is refused removes them again.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// Files that are being written under a temporary name.
static PARTIAL: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Marks a write that must not be cut short, as long as the guard lives. Does not nest.
pub(super) fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn locked(list: &Mutex<Vec<PathBuf>>) -> MutexGuard<'_, Vec<PathBuf>> {
    list.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file under a temporary name that is removed if the process is interrupted.
#[derive(Debug)]
pub(super) struct Leftover(PathBuf);

impl Leftover {
    /// Makes a file, which is listed before an interrupt can see it.
    pub(super) fn of<E>(
        make: impl FnOnce() -> Result<NamedTempFile, E>,
    ) -> Result<(NamedTempFile, Self), E> {
        let mut list = locked(&PARTIAL);
        let file = make()?;
        list.push(file.path().into());
        let leftover = Self(file.path().into());
        Ok((file, leftover))
    }
}

impl Drop for Leftover {
    fn drop(&mut self) {
        locked(&PARTIAL).retain(|path| *path != self.0);
    }
}

/// Remembers folders that are about to be made.
pub(super) fn will_make(folders: &[PathBuf]) {
    locked(&MADE).extend_from_slice(folders);
}

/// Forgets folders that are removed, or hold a set now.
pub(super) fn forget(folders: &[PathBuf]) {
    locked(&MADE).retain(|folder| !folders.contains(folder));
}

/// Removes folders, the innermost first, as far as they are empty.
pub(super) fn remove_empty(folders: &[impl AsRef<Path>]) {
    // A folder with any content cannot be removed, and stays.
    folders.iter().all(|folder| std::fs::remove_dir(folder).is_ok());
}

/// Prepares the end of the process from a signal handler's thread: waits until no file is being
/// replaced, lets no other write begin, and removes files under temporary names and the empty
/// folders that were made for sets.
///
/// Returns whether the files are whole. `false` says that a write has not ended within `patience`,
/// as on a disk that hangs; whoever opens the folder next completes it.
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
    let partial = locked(&PARTIAL);
    for path in partial.iter() {
        // One that is gone already is no error.
        let _ = std::fs::remove_file(path);
    }
    remove_empty(&locked(&MADE));
    // Never unlocked again.
    std::mem::forget((guard, partial));
    true
}
