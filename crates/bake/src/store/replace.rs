//! Replaces files as a whole. All files that a user names are written by this module, as a shell's
//! `>` would: links are followed, modes kept, devices written through. What cannot be replaced as a
//! whole is refused.

use std::collections::{BTreeSet, HashMap};
use std::fs::{self, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::interrupt::{self, Partial};
use super::{StoreError, Written};
use crate::input;

/// Prefix and suffix of the names of incomplete files.
const PREFIX: &str = ".microfacet-bake-";
const SUFFIX: &str = ".partial";

/// Age at which an incomplete file counts as abandoned. Incomplete files exist for seconds, since
/// all of their bytes are in memory when they are begun; those of numbered sets, until all sets are
/// baked.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// Most times that a folder is made again after another process removed it.
const TIMES: usize = 100;

/// Writes `bytes` to `path` so that at every moment either the old file or the complete new one is
/// there: into a temporary file in the same folder, synchronised to disk, then renamed over it.
///
/// Symbolic links are followed, dangling ones too, and the file they name is replaced. An existing
/// file keeps its mode and, where the system allows it, its owner; other hard links keep the old
/// content. Character devices are written through.
///
/// # Errors
/// The operating system's error, or one that says why the path cannot be written to: it is a
/// folder, a FIFO, a socket or a block device, or protected. Unless the disk itself fails at the
/// very end, the old file is then untouched.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace_with(path, |out| out.write_all(bytes))
}

/// As [`replace`], with the bytes that `write` writes, which need not fit into memory.
pub fn replace_with(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut replacement = Replacement::default();
    replacement.add(path, write)?;
    let _writing = interrupt::writing();
    replacement.commit().map(|_| ()).map_err(|(_, why)| why)
}

/// Checks that a file could be written by [`replace`], without changing it.
pub fn check_file(path: &Path) -> io::Result<()> {
    let to = Destination::of(path)?;
    if to.is_device() {
        return OpenOptions::new().write(true).open(&to.path).map(|_| ());
    }
    to.stage(|_| Ok(())).map(|_| ())
}

/// Checks that [`replace`] may write to a path, or remove what is there.
pub(super) fn check_writable(path: &Path) -> io::Result<()> {
    Destination::of(path).map(|_| ())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn refused<T>(kind: ErrorKind, why: impl Into<String>) -> io::Result<T> {
    Err(io::Error::new(kind, why.into()))
}

#[cfg(unix)]
fn is_char_device(kind: fs::FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_char_device(&kind)
}

#[cfg(not(unix))]
fn is_char_device(_: fs::FileType) -> bool {
    false
}

/// The file to which a path leads, or would lead if the file existed.
struct Destination {
    path: PathBuf,
    /// The metadata of the regular file or device there.
    old: Option<Metadata>,
}

impl Destination {
    /// Follows symbolic links, and checks that the file there can be written to.
    fn of(path: &Path) -> io::Result<Self> {
        let mut old = match fs::metadata(path) {
            Err(why) if why.kind() == ErrorKind::NotFound => None,
            Err(why) if why.kind() != ErrorKind::PermissionDenied && path.is_symlink() => {
                let why = "is a link that leads nowhere; name a regular file";
                return refused(ErrorKind::InvalidInput, why);
            }
            found => Some(found?),
        };
        if let Some(old) = old.take_if(|old| !old.is_file()) {
            // Descriptors such as /dev/stdout look like links, but lead to no path.
            if is_char_device(old.file_type()) {
                return Ok(Self { path: path.into(), old: Some(old) });
            }
            let why = format!("is {}; name a regular file", input::name(old.file_type()));
            return refused(ErrorKind::InvalidInput, why);
        }
        let mut path = path.to_path_buf();
        // This ends: a circle of links has no metadata, and was refused.
        while let Ok(to) = fs::read_link(&path) {
            let folder = folder_of(&path);
            if fs::canonicalize(folder).is_ok_and(|folder| folder.starts_with("/proc")) {
                let why = "is a file that a process has open; name the file itself";
                return refused(ErrorKind::InvalidInput, why);
            }
            path = folder.join(to);
        }
        if old.as_ref().is_some_and(|old| old.permissions().readonly()) {
            let why = "is write-protected; make it writable, or name another file";
            return refused(ErrorKind::PermissionDenied, why);
        }
        let folder = folder_of(&path);
        if !folder.is_dir() {
            let why = format!("the folder {} does not exist; make it first", folder.display());
            return refused(ErrorKind::NotFound, why);
        }
        // To rename over a file takes only the right to write to its folder: check the file's own.
        match OpenOptions::new().write(true).open(&path) {
            // There was no file, or another writer just removed it.
            Err(why) if why.kind() == ErrorKind::NotFound => old = None,
            opened => drop(opened?),
        }
        Ok(Self { path, old })
    }

    fn is_device(&self) -> bool {
        self.old.as_ref().is_some_and(|old| !old.is_file())
    }

    /// A complete temporary file in the same folder, synchronised to disk, with the rights of the
    /// old file, or those that any new file gets.
    fn stage(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<Partial> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        #[cfg(unix)]
        if self.old.is_none() {
            // Reduced by the umask. By default a temporary file is accessible to its owner only.
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        }
        let folder = folder_of(&self.path);
        // The message leaves out the temporary name.
        let mut staged = Partial::new(|| builder.tempfile_in(folder)).map_err(|why| {
            let (folder, kind) = (folder.display(), why.kind());
            io::Error::new(kind, format!("cannot write into the folder {folder}: {kind}"))
        })?;
        write(staged.file.as_file_mut())?;
        #[cfg(unix)]
        if let Some(old) = &self.old {
            use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
            let file = staged.file.as_file();
            let new = file.metadata()?;
            if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
                // Few users may change the owner of a file, or set any group.
                let _ = fchown(file, None, Some(old.gid()));
                let _ = fchown(file, Some(old.uid()), None);
            }
            file.set_permissions(fs::Permissions::from_mode(old.mode() & 0o777))?;
        }
        staged.file.as_file().sync_all()?;
        Ok(staged)
    }
}

/// New files, complete under temporary names, that are renamed one right after the other.
#[derive(Debug, Default)]
pub(super) struct Replacement {
    /// The path of each file, and the file it leads to; `None` for devices, which are written at
    /// once.
    all: Vec<(PathBuf, Option<(Partial, PathBuf)>)>,
    /// The named path of each file, by the file it leads to with links resolved.
    places: HashMap<PathBuf, PathBuf>,
}

impl Replacement {
    /// Completes a file of these bytes under a temporary name, in a folder that is made if missing.
    pub(super) fn put(&mut self, path: PathBuf, bytes: &[u8]) -> Result<Written, StoreError> {
        match in_folder(folder_of(&path), || self.add(&path, |out| out.write_all(bytes))) {
            Ok(()) => Ok(Written { path, bytes: bytes.len() }),
            Err(why) => Err(StoreError::Io(path, why)),
        }
    }

    /// Completes a file of the bytes that `write` writes under a temporary name.
    fn add(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let to = Destination::of(path)?;
        if to.is_device() {
            write(&mut OpenOptions::new().write(true).open(&to.path)?)?;
            self.all.push((path.into(), None));
            return Ok(());
        }
        let place = match (fs::canonicalize(folder_of(&to.path)), to.path.file_name()) {
            (Ok(at), Some(file)) => Some(at.join(file)),
            _ => None,
        };
        if let Some(other) = place.as_ref().and_then(|place| self.places.get(place)) {
            let why =
                format!("leads to the same file as {}; remove one of the links", other.display());
            return refused(ErrorKind::InvalidInput, why);
        }
        let staged = to.stage(write)?;
        // Only after success, since a file that could not be staged may be tried again.
        self.places.extend(place.map(|place| (place, path.into())));
        self.all.push((path.into(), Some((staged, to.path))));
        Ok(())
    }

    /// Renames all files, and returns their paths.
    pub(super) fn commit(self) -> Result<Vec<PathBuf>, (PathBuf, io::Error)> {
        let (mut written, mut folders) = (Vec::new(), BTreeSet::new());
        for (path, staged) in self.all {
            if let Some((staged, place)) = staged {
                if let Err(why) = staged.file.persist(&place) {
                    return Err((path, why.error));
                }
                folders.insert(folder_of(&place).to_path_buf());
            }
            written.push(path);
        }
        for folder in folders {
            sync(&folder).map_err(|why| (folder, why))?;
        }
        Ok(written)
    }
}

/// Makes renames in a folder durable, where the system can: some network file systems cannot, and
/// only Unix opens folders.
fn sync(folder: &Path) -> io::Result<()> {
    let done = fs::File::open(folder).map_or(Ok(()), |folder| folder.sync_all());
    done.or_else(|why| match why.kind() {
        ErrorKind::InvalidInput | ErrorKind::Unsupported => Ok(()),
        _ if cfg!(not(unix)) => Ok(()),
        _ => Err(why),
    })
}

/// Removes incomplete files that have not changed for a day.
pub(crate) fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_old = |file: Metadata| {
            file.is_file()
                && file.modified().is_ok_and(|at| at.elapsed().is_ok_and(|age| age > ABANDONED))
        };
        // `DirEntry::metadata` does not follow links.
        if name.starts_with(PREFIX) && name.ends_with(SUFFIX) && entry.metadata().is_ok_and(is_old)
        {
            // A leftover that cannot be removed is no error.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Makes a folder and its parents, unless it exists.
pub(crate) fn make_folder(path: &Path) -> io::Result<()> {
    let why = match (fs::metadata(path), fs::read_link(path)) {
        (Ok(found), _) if found.is_dir() => return Ok(()),
        (Ok(found), _) => format!("is {}; name a folder", input::name(found.file_type())),
        (Err(why), Ok(to)) if why.kind() == ErrorKind::NotFound => {
            format!("is a link to {}, which does not exist; make that folder first", to.display())
        }
        (Err(_), Ok(_)) => "is a link that leads nowhere; name a folder".into(),
        (Err(_), Err(_)) => return fs::create_dir_all(path),
    };
    refused(ErrorKind::NotADirectory, why)
}

/// Writes something into a folder, which is made if it is missing, and again if it is removed
/// meanwhile, as by a process that made it and then wrote nothing. Another process may make it
/// again, too, so the attempt is repeated whenever something is not found, whether the folder
/// exists or not.
pub(crate) fn in_folder<T>(folder: &Path, mut act: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    let mut once = || make_folder(folder).and_then(|()| act());
    for _ in 1..TIMES {
        match once() {
            Err(why) if why.kind() == ErrorKind::NotFound => {}
            done => return done,
        }
    }
    once()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_another_removes_is_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made").join("here");
        let mut times = 0;
        let done = in_folder(&path, || {
            times += 1;
            if times < 4 {
                fs::remove_dir_all(path.parent().unwrap())?;
            }
            replace(&path.join("file"), b"whole")
        });
        done.unwrap();
        assert_eq!((times, fs::read(path.join("file")).unwrap().as_slice()), (4, &b"whole"[..]));
        // Something is not found although the folder exists.
        let mut times = 0;
        let done = in_folder(&path, || {
            times += 1;
            if times == 1 { Err(io::ErrorKind::NotFound.into()) } else { Ok(times) }
        });
        assert!(path.is_dir() && done.unwrap() == 2);
        // Repeated failure is an error; a failure of another kind is one at once.
        for (kind, tries) in [(io::ErrorKind::NotFound, TIMES), (io::ErrorKind::StorageFull, 1)] {
            let mut times = 0;
            let failed = in_folder(&path, || {
                times += 1;
                Err::<(), _>(kind.into())
            });
            assert_eq!((failed.unwrap_err().kind(), times), (kind, tries));
        }
    }

    #[test]
    fn only_old_partial_files_are_abandoned() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let (old, young) = (format!("{PREFIX}1{SUFFIX}"), format!("{PREFIX}2{SUFFIX}"));
        for (name, days) in [(old.as_str(), 2), (&young, 0), ("other.partial", 2)] {
            let file = fs::File::create(path(name)).unwrap();
            file.set_modified(std::time::SystemTime::now() - days * ABANDONED).unwrap();
        }
        remove_abandoned(folder.path());
        assert!(!path(&old).exists() && path(&young).exists() && path("other.partial").exists());
    }

    #[cfg(unix)]
    mod unix {
        use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

        use super::*;

        fn mode(path: &Path) -> u32 {
            fs::metadata(path).unwrap().mode() & 0o777
        }

        fn set_mode(path: &Path, mode: u32) {
            fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
        }

        /// The bytes that are written last would be in both files.
        #[test]
        fn two_links_to_one_file_are_refused() {
            let folder = tempfile::tempdir().unwrap();
            let path = |name: &str| folder.path().join(name);
            fs::write(path("one"), "old").unwrap();
            symlink("one", path("link")).unwrap();
            let mut files = Replacement::default();
            files.add(&path("one"), |out| out.write_all(b"new")).unwrap();
            let why = files.add(&path("link"), |_| Ok(())).unwrap_err().to_string();
            assert!(why.contains("leads to the same file as"), "{why}");
            drop(files);
            assert_eq!(fs::read(path("one")).unwrap(), b"old");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        }

        #[test]
        fn links_are_followed_and_stay() {
            let folder = tempfile::tempdir().unwrap();
            let (here, there) = (folder.path().join("here"), folder.path().join("there"));
            fs::create_dir(&here).unwrap();
            fs::create_dir(&there).unwrap();
            symlink("second", here.join("first")).unwrap();
            symlink("../there/file", here.join("second")).unwrap();
            for bytes in [b"dangling", b"existing"] {
                replace(&here.join("first"), bytes).unwrap();
                assert_eq!(fs::read(there.join("file")).unwrap(), bytes);
                assert!(fs::symlink_metadata(there.join("file")).unwrap().is_file());
                assert!(fs::symlink_metadata(here.join("first")).unwrap().is_symlink());
            }
            symlink("circle", here.join("circle")).unwrap();
            assert!(replace(&here.join("circle"), b"").is_err());
            symlink("../nowhere/file", here.join("lost")).unwrap();
            assert!(replace(&here.join("lost"), b"").is_err());
        }

        #[test]
        fn modes_are_kept_and_protection_heeded() {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("file");
            replace(&path, b"new").unwrap();
            // The mode of any other new file.
            fs::write(folder.path().join("other"), "").unwrap();
            assert_eq!(mode(&path), mode(&folder.path().join("other")));
            for kept in [0o600, 0o664] {
                set_mode(&path, kept);
                replace(&path, b"again").unwrap();
                assert_eq!(mode(&path), kept);
            }
            // The owner is kept, where this process may change owners at all.
            if std::os::unix::fs::chown(&path, Some(12345), Some(54321)).is_ok() {
                replace(&path, b"again").unwrap();
                let found = fs::metadata(&path).unwrap();
                assert_eq!((found.uid(), found.gid(), mode(&path)), (12345, 54321, 0o664));
            }
            set_mode(&path, 0o444);
            let error = replace(&path, b"protected").unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::PermissionDenied);
            assert_eq!(fs::read(&path).unwrap(), b"again");
        }

        #[test]
        fn what_is_no_file_stays_what_it_is() {
            replace(Path::new("/dev/null"), b"gone").unwrap();
            assert!(is_char_device(fs::metadata("/dev/null").unwrap().file_type()));
            let folder = tempfile::tempdir().unwrap();
            let socket = folder.path().join("socket");
            let _held = std::os::unix::net::UnixListener::bind(&socket).unwrap();
            for (path, what) in [(folder.path(), "is a folder"), (&socket, "is a socket")] {
                let message = replace(path, b"").unwrap_err().to_string();
                assert!(message.contains(what), "{message}");
            }
        }
    }
}
