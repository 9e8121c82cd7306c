//! Folders that files are written into. Missing folders are made, and removed again if nothing was
//! written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::SystemTime;
use std::{fs, io};

use microfacet_sampler::Tables;
use microfacet_tables::Index;

use super::interrupt::{self, Leftovers};
use super::replace::{Replacement, check_writable, in_folder, remove_abandoned};
use super::{Format, NAMES, StoreError, Written, bytes_of, image_of, numbered};

/// A folder to write into. On drop, folders that were made for it are removed if they are empty.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// Folders that were made, the innermost first.
    _made: Leftovers,
    /// Whether something new is in the folder.
    written: Arc<AtomicBool>,
}

impl OutputFolder {
    /// Makes the folder if it does not exist, and checks that files can be written into it.
    ///
    /// # Errors
    /// [`StoreError::Io`] if the path is no folder or cannot be written to.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        let _made = Leftovers::folders(made);
        let this = Self { path: path.into(), _made, written: Arc::default() };
        let failed = |why| StoreError::Io(path.into(), why);
        // Fails before the tables are baked rather than after.
        in_folder(path, || tempfile::tempfile_in(path)).map_err(failed)?;
        Ok(this)
    }

    /// As [`open`](Self::open), for a set: also checks that the set in the folder can be replaced.
    ///
    /// # Errors
    /// [`StoreError::Io`] naming the file that cannot be replaced.
    pub fn open_for_set(path: &Path) -> Result<Self, StoreError> {
        let this = Self::open(path)?;
        remove_abandoned(path);
        let old = OldSet::of(path);
        for file in old.files.keys().map(|name| path.join(name)) {
            check_writable(&file).map_err(|why| StoreError::Io(file, why))?;
        }
        Ok(this)
    }

    /// Whether something was written; may be read at any time.
    pub fn written(&self) -> Arc<AtomicBool> {
        self.written.clone()
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a set as one file, `tables.safetensors` or `tables.exr`; a set without tables is
    /// `tables.safetensors` in either format. Several sets are written by [`sets`](Self::sets).
    ///
    /// The new file replaces the set that was in the folder in one step, as by
    /// [`replace`](super::replace()), and other files of the old set are removed; files that are of
    /// no set stay. Of two writers at once the set of the last remains.
    ///
    /// # Errors
    /// [`StoreError`] naming the path. The old set is then unchanged.
    pub fn write(&self, set: &Tables, format: Format) -> Result<Vec<Written>, StoreError> {
        let format = if set.tables().is_empty() { Format::Safetensors } else { format };
        let path = self.path.join(format.file());
        let bytes = bytes_of(set, format, &path)?;
        let mut replacement = Replacement::default();
        let written = replacement.put(path, &bytes)?;
        self.exchange(replacement)?;
        Ok(vec![written])
    }

    /// Writes each table as an image of its own, NAME.exr, for programs that cannot read images of
    /// several parts. The images are no set that can be read back; other files in the folder stay.
    ///
    /// # Errors
    /// [`StoreError`] naming the path, such as a table whose name no file can have.
    pub fn write_images(&self, set: &Tables) -> Result<Vec<Written>, StoreError> {
        let mut images = Vec::new();
        for table in set.tables() {
            let (name, bytes) = image_of(set, table)
                .map_err(|why| StoreError::Exr(self.path.join(&table.name), why))?;
            images.push((name, bytes));
        }
        self.write_files(images.iter().map(|(name, bytes)| (&name[..], &bytes[..])))
    }

    /// Writes files, each as by [`replace`](super::replace()). All are completed under temporary
    /// names, and then renamed one right after the other: only a process that is killed between two
    /// renames leaves some files old and some new.
    ///
    /// # Errors
    /// [`StoreError::Io`] with the operating system's error, or if two of the names lead to one
    /// file. All old files are then untouched, unless the disk itself failed at the very end, when
    /// some may be replaced.
    pub fn write_files<'a>(
        &self,
        files: impl IntoIterator<Item = (&'a str, &'a [u8])>,
    ) -> Result<Vec<Written>, StoreError> {
        let (mut replacement, mut all) = (Replacement::default(), Vec::new());
        for (name, bytes) in files {
            all.push(replacement.put(self.path.join(name), bytes)?);
        }
        let _writing = interrupt::writing();
        replacement.commit().map_err(|(path, why)| StoreError::Io(path, why))?;
        self.written.store(true, Relaxed);
        Ok(all)
    }

    /// Replaces the old set by a new one.
    pub(super) fn exchange(&self, new: Replacement) -> Result<(), StoreError> {
        // Two writers at once might each remove the new set of the other, so that no set would be
        // left. Where a folder cannot be locked, as on some network file systems, that stays
        // possible.
        let folder = fs::File::open(&self.path);
        let _lock = folder.and_then(|folder| folder.lock().map(|()| folder));
        let old = OldSet::of(&self.path);
        let _writing = interrupt::writing();
        let new = new.commit().map_err(|(path, why)| StoreError::Io(path, why))?;
        // Set while `_writing` is held, so that an interrupt sees both the files and the flag, or
        // neither.
        self.written.store(true, Relaxed);
        old.remove(&self.path, &new)
    }
}

/// Time, size and inode number of a file, which tell it from another of the same name. The time
/// alone does not, since clocks may tick slower than files are written.
type Stamp = Option<(SystemTime, u64, u64)>;

/// The files of the set in a folder, by name, before a new set replaces it.
struct OldSet {
    files: BTreeMap<String, Stamp>,
}

impl OldSet {
    fn of(folder: &Path) -> Self {
        let names = NAMES.map(String::from).into_iter().chain(indexed(folder));
        let files = names.map(|name| (name.clone(), link_stamp(&folder.join(&name))));
        Self { files: files.filter(|(_, stamp)| stamp.is_some()).collect() }
    }

    /// Removes the files that are not among the new ones, except those that another writer put
    /// there meanwhile and those that its index lists.
    fn remove(mut self, folder: &Path, new: &[PathBuf]) -> Result<(), StoreError> {
        let remove = |(name, old): (String, Stamp)| {
            let path = folder.join(name);
            if new.contains(&path) || link_stamp(&path) != old {
                return Ok(());
            }
            match fs::remove_file(&path) {
                Err(why) if why.kind() != io::ErrorKind::NotFound => Err(StoreError::Io(path, why)),
                _ => Ok(()),
            }
        };
        // The index is removed before the files that it lists.
        self.files.remove_entry(Index::FILE).map_or(Ok(()), remove)?;
        let listed = indexed(folder);
        self.files.into_iter().filter(|(name, _)| !listed.contains(name)).try_for_each(remove)
    }
}

/// The files of the numbered sets that the index in a folder lists, if there is one.
fn indexed(folder: &Path) -> Vec<String> {
    let index = numbered::index_at(folder).ok().flatten();
    index.into_iter().flat_map(|index| index.sets).map(|set| set.file).collect()
}

fn link_stamp(path: &Path) -> Stamp {
    stamp(fs::symlink_metadata(path))
}

/// The stamp of a file; `None` if there is no file.
pub(super) fn stamp(file: io::Result<fs::Metadata>) -> Stamp {
    let file = file.ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&file);
    #[cfg(not(unix))]
    let number = 0;
    Some((file.modified().ok()?, file.len(), number))
}
