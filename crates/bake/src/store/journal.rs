//! Replaces the files of a set together, with a journal, and remembers which files are a set's.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::replace::{
    Destination, Pending, Staged, check_writable, destination, folder_of, is_partial,
    partial_files, refused, replace_unguarded, stage, sync,
};
use super::{Index, SET_FILE, exr, image};
use crate::input;

/// Journal of the replacement of several files while it is under way: a line `PARTIAL NAME` for
/// each new file, `- NAME` for each removed one.
const JOURNAL: &str = ".microfacet-bake.commit";

/// Marks a removed file in the journal.
const STALE: &str = "-";

/// Names of the files of a set, a line each, where there are others than [`SET_FILE`]. A later bake
/// removes what is named here, and nothing else.
pub(super) const RECORD: &str = ".microfacet-bake.files";

/// An operation on the file of this name in a folder failed.
type Failed = (String, io::Error);

/// What the process that writes a set puts where a link in its folder leads.
#[derive(Debug)]
struct Led {
    name: String,
    /// The same bytes under the name in the journal.
    partial: PathBuf,
    pending: Pending,
}

/// Replaces several files of a folder, by name, and removes those in `stale`, so that old and new
/// files never coexist: a [`Replacement`] of all at once.
///
/// # Errors
/// As [`Replacement::commit`].
pub(super) fn replace_all(
    folder: &Path,
    files: &[(String, Vec<u8>)],
    stale: &[String],
) -> Result<(), Failed> {
    if let ([(name, bytes)], []) = (files, stale) {
        return replace_unguarded(&folder.join(name), bytes).map_err(|why| (name.clone(), why));
    }
    let mut replacement = Replacement::new(folder);
    for (name, bytes) in files {
        replacement.add(name, bytes)?;
    }
    replacement.commit(stale)
}

/// New files of a folder, complete under temporary names, that take their places together.
///
/// No file system replaces several files in one step. The new ones are completed under temporary
/// names, then a journal of the replacement is written in one step. From then on [`finish`] leads
/// to the new set, now or after an interruption.
///
/// Only this process, which was asked to write here, follows links. Whoever completes its journal
/// replaces the links themselves, since a journal in a folder may be anyone's.
#[derive(Debug)]
pub(super) struct Replacement {
    folder: PathBuf,
    journal: String,
    staged: Vec<Staged>,
    led: Vec<Led>,
    /// Where the files lead, with their names.
    places: BTreeMap<PathBuf, String>,
}

impl Replacement {
    pub(super) fn new(folder: &Path) -> Self {
        let (journal, staged, led, places) = Default::default();
        Self { folder: folder.into(), journal, staged, led, places }
    }

    /// Completes a file under a temporary name.
    pub(super) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Failed> {
        let failed = |why| (name.to_owned(), why);
        let path = self.folder.join(name);
        let to = if name == RECORD {
            Destination { path: path.clone(), old: None }
        } else {
            destination(&path).map_err(failed)?
        };
        if let (Ok(at), Some(file)) = (fs::canonicalize(folder_of(&to.path)), to.path.file_name())
            && let Some(other) = self.places.insert(at.join(file), name.to_owned())
        {
            let why = format!("leads to the same file as {other}; remove one of the links");
            return Err(failed(io::Error::new(io::ErrorKind::InvalidInput, why)));
        }
        let old = to.old.as_ref().filter(|old| old.is_file());
        let new = stage(&self.folder, |out| out.write_all(bytes), old).map_err(failed)?;
        let partial = new.file.path().file_name().unwrap_or_default().to_string_lossy();
        self.journal += &format!("{partial} {name}\n");
        if to.path != path || to.is_device() {
            let pending = Pending::new(to, |out| out.write_all(bytes)).map_err(failed)?;
            let partial = new.file.path().into();
            self.led.push(Led { name: name.to_owned(), partial, pending });
        }
        self.staged.push(new);
        Ok(())
    }

    /// Puts all in their places, and removes the files in `stale`.
    ///
    /// # Errors
    /// The name and the operating system's error. Before the journal is written the old files are
    /// untouched; afterwards the next [`finish`] leads to the new ones.
    pub(super) fn commit(self, stale: &[String]) -> Result<(), Failed> {
        let Self { folder, mut journal, staged, led, .. } = self;
        for name in stale {
            check_writable(&folder.join(name)).map_err(|why| (name.clone(), why))?;
            journal += &format!("{STALE} {name}\n");
        }
        let failed = |why| (JOURNAL.to_string(), why);
        let list = stage(&folder, |out| out.write_all(journal.as_bytes()), None).map_err(failed)?;
        // Before the journal is there: an error after it must not take the new files with it.
        // Without a journal they are leftovers.
        for new in staged {
            new.file.keep().map_err(|error| failed(error.error))?;
        }
        list.file.persist(folder.join(JOURNAL)).map_err(|error| failed(error.error))?;
        sync(&folder).map_err(failed)?;
        exchange(&folder, &journal, led)
    }
}

/// Whether a replacement in the folder was begun and not completed.
pub(super) fn is_interrupted(folder: &Path) -> bool {
    fs::symlink_metadata(folder.join(JOURNAL)).is_ok()
}

/// Completes the replacement that a journal lists, if there is one, and removes leftovers. It can
/// itself be interrupted and repeated.
pub(super) fn finish(folder: &Path) -> Result<(), Failed> {
    if let Some(journal) = own_text(folder, JOURNAL)? {
        exchange(folder, &journal, Vec::new())?;
    }
    let failed = |why| (String::new(), why);
    for path in partial_files(folder).map_err(failed)? {
        fs::remove_file(path).map_err(failed)?;
    }
    Ok(())
}

/// The text of a hidden file of ours, if there is one.
fn own_text(folder: &Path, name: &str) -> Result<Option<String>, Failed> {
    let path = folder.join(name);
    let text = match fs::symlink_metadata(&path) {
        Err(why) if why.kind() == io::ErrorKind::NotFound => return Ok(None),
        Ok(file) if file.is_symlink() => refused(io::ErrorKind::InvalidInput, "is a link"),
        _ => input::read_text(&path, input::MAX_TEXT),
    };
    let text = text.map_err(|why| {
        let why = io::Error::new(why.kind(), format!("{why}; no bake wrote this: remove it"));
        (name.to_string(), why)
    })?;
    Ok(Some(text))
}

/// What changes with the record of the folder's set; `None` without one.
pub(super) fn record_stamp(folder: &Path) -> Option<(SystemTime, u64)> {
    let record = fs::symlink_metadata(folder.join(RECORD)).ok()?;
    Some((record.modified().ok()?, record.len()))
}

/// Names in the record of the folder's set that a set can have.
pub(super) fn recorded(folder: &Path) -> Result<Vec<String>, Failed> {
    let text = own_text(folder, RECORD)?.unwrap_or_default();
    Ok(text.lines().filter(|name| is_name_of_ours(name)).map(String::from).collect())
}

/// Whether a file of a set can have this name. Records and journals may be anyone's.
fn is_name_of_ours(name: &str) -> bool {
    [SET_FILE, RECORD, Index::FILE].contains(&name)
        || Index::is_file_name(name)
        || image::table_of(name).is_some()
}

/// Whether a file is still what a bake wrote under this name, as far as its header tells.
pub(super) fn is_ours(folder: &Path, name: &str) -> bool {
    let path = folder.join(name);
    match image::table_of(name) {
        Some(_) => matches!(exr::is_table(&path), Ok(true)),
        None => {
            is_name_of_ours(name)
                && fs::symlink_metadata(path).is_ok_and(|file| file.is_file() || file.is_symlink())
        }
    }
}

/// Does what a journal lists, but puts the files in `led` where links lead.
fn exchange(folder: &Path, journal: &str, led: Vec<Led>) -> Result<(), Failed> {
    let lines = journal.lines().filter_map(|line| line.split_once(' '));
    let (mut new, mut old) = (Vec::new(), Vec::new());
    for (partial, name) in lines.filter(|(_, name)| is_name_of_ours(name)) {
        let is_led = led.iter().any(|led| led.name == name);
        // A file no longer under its temporary name has been moved already.
        let is_new = is_partial(partial)
            && fs::symlink_metadata(folder.join(partial)).is_ok_and(|file| file.is_file());
        if is_new && !is_led {
            new.push((folder.join(partial), name));
        }
        if is_new && !is_led || partial == STALE && is_ours(folder, name) {
            old.push(name);
        }
    }
    for name in old {
        match fs::remove_file(folder.join(name)) {
            Err(why) if why.kind() != io::ErrorKind::NotFound => return Err((name.into(), why)),
            _ => {}
        }
    }
    for Led { name, partial, pending } in led {
        let put = pending.commit().and_then(|()| fs::remove_file(partial));
        put.map_err(|why| (name, why))?;
    }
    for (partial, name) in new {
        fs::rename(partial, folder.join(name)).map_err(|why| (name.into(), why))?;
    }
    let done = sync(folder).and_then(|()| fs::remove_file(folder.join(JOURNAL)));
    done.map_err(|why| (JOURNAL.into(), why))
}

#[cfg(test)]
mod tests {
    use super::super::replace::{PREFIX, SUFFIX};
    use super::*;

    fn set(mark: &str) -> Vec<(String, Vec<u8>)> {
        ["a.exr", "b.exr", SET_FILE]
            .map(|name| (name.to_string(), format!("{mark} {name}").into_bytes()))
            .into()
    }

    fn content(folder: &Path) -> Vec<(String, Vec<u8>)> {
        let mut all: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| {
                (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
            })
            .collect();
        all.sort();
        all
    }

    /// Every state that a replacement of three files passes through, and what the next run makes of
    /// it.
    #[test]
    fn an_exchange_interrupted_anywhere_is_completed() {
        for removed in 0..=3 {
            for renamed in 0..=(if removed == 3 { 3 } else { 0 }) {
                let folder = tempfile::tempdir().unwrap();
                let path = |name: &str| folder.path().join(name);
                replace_all(folder.path(), &set("old"), &[]).unwrap();
                let mut journal = String::new();
                for (i, (name, bytes)) in set("new").into_iter().enumerate() {
                    let partial = format!("{PREFIX}{i}{SUFFIX}");
                    journal += &format!("{partial} {name}\n");
                    fs::write(path(&partial), bytes).unwrap();
                    if i < removed {
                        fs::remove_file(path(&name)).unwrap();
                    }
                    if i < renamed {
                        fs::rename(path(&partial), path(&name)).unwrap();
                    }
                }
                fs::write(path(JOURNAL), journal).unwrap();
                finish(folder.path()).unwrap();
                assert_eq!(
                    content(folder.path()),
                    set("new"),
                    "{removed} removed, {renamed} renamed"
                );
            }
        }
    }

    #[test]
    fn without_a_journal_the_old_set_stays_and_leftovers_go() {
        let folder = tempfile::tempdir().unwrap();
        replace_all(folder.path(), &set("old"), &[]).unwrap();
        fs::write(folder.path().join(format!("{PREFIX}x{SUFFIX}")), "half").unwrap();
        fs::write(folder.path().join(".hidden"), "not ours").unwrap();
        finish(folder.path()).unwrap();
        let mut expected = set("old");
        expected.insert(0, (".hidden".into(), b"not ours".into()));
        assert_eq!(content(folder.path()), expected);
    }

    #[test]
    fn what_is_ours_goes_with_the_old_set() {
        let folder = tempfile::tempdir().unwrap();
        replace_all(folder.path(), &set("old"), &[]).unwrap();
        let new = vec![("b.exr".to_string(), b"new b".to_vec())];
        replace_all(folder.path(), &new, &["a.exr".into(), SET_FILE.into()]).unwrap();
        // What holds no table is not ours, whatever a list says.
        assert_eq!(content(folder.path()), [set("old")[0].clone(), new[0].clone()]);
    }

    #[test]
    fn a_journal_reaches_no_other_folder() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        fs::create_dir(&inner).unwrap();
        fs::write(folder.path().join("precious"), "precious").unwrap();
        fs::write(inner.join(format!("{PREFIX}x{SUFFIX}")), "").unwrap();
        fs::write(inner.join(JOURNAL), format!("{PREFIX}x{SUFFIX} ../precious\n- ../precious\n"))
            .unwrap();
        finish(&inner).unwrap();
        assert_eq!(fs::read(folder.path().join("precious")).unwrap(), b"precious");
        assert_eq!(content(&inner), []);
    }

    /// A journal that names what no set has: files of other programs, a link, a folder.
    #[test]
    fn a_journal_touches_only_what_a_set_can_have() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["notes.txt", "photo.exr", "partial"] {
            fs::write(path(name), name).unwrap();
        }
        let (inside, outside) = (format!("{PREFIX}1{SUFFIX}"), format!("{PREFIX}2{SUFFIX}"));
        fs::create_dir(path(&inside)).unwrap();
        let journal = format!(
            "{STALE} notes.txt\n{STALE} photo.exr\n{STALE} \n{STALE} .\n{inside} a.exr\n\
             {outside} b.exr\npartial notes.txt\npartial photo.exr\n"
        );
        fs::write(path(JOURNAL), journal).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(path("notes.txt"), path(&outside)).unwrap();
        finish(folder.path()).unwrap();
        for name in ["notes.txt", "photo.exr", "partial"] {
            assert_eq!(fs::read_to_string(path(name)).unwrap(), name);
        }
        assert!(
            !path("a.exr").exists() && !path("b.exr").exists() && !is_interrupted(folder.path())
        );
    }

    #[cfg(unix)]
    mod unix {
        use std::os::unix::fs::symlink;

        use super::*;
        use crate::store::replace::modes::{mode, set_mode};

        /// A set of which one file is a link to another folder.
        #[test]
        fn only_the_writer_of_a_set_follows_its_links() {
            let folder = tempfile::tempdir().unwrap();
            let (here, there) = (folder.path().join("here"), folder.path().join("there"));
            fs::create_dir(&here).unwrap();
            let linked = here.join("b.exr");
            symlink(&there, &linked).unwrap();
            for mark in ["old", "new"] {
                replace_all(&here, &set(mark), &[]).unwrap();
                assert_eq!(content(&here), set(mark));
                assert!(fs::symlink_metadata(&linked).unwrap().is_symlink());
                assert_eq!(fs::read(&there).unwrap(), set(mark)[1].1);
            }
            set_mode(&here.join("a.exr"), 0o640);
            // A journal, whoever wrote it, replaces the link.
            let partial = format!("{PREFIX}1{SUFFIX}");
            fs::write(here.join(&partial), "by a journal").unwrap();
            fs::write(here.join(JOURNAL), format!("{partial} b.exr\n")).unwrap();
            finish(&here).unwrap();
            assert_eq!(fs::read(&linked).unwrap(), b"by a journal");
            assert_eq!(fs::read(&there).unwrap(), set("new")[1].1);
            replace_all(&here, &set("last"), &[]).unwrap();
            assert_eq!((content(&here), mode(&here.join("a.exr"))), (set("last"), 0o640));
            // Two names for one file could not hold two files.
            fs::remove_file(&linked).unwrap();
            symlink("a.exr", &linked).unwrap();
            let (name, why) = replace_all(&here, &set("two"), &[]).unwrap_err();
            assert!(name == "b.exr" && why.to_string().contains("a.exr"), "{name}: {why}");
            assert_eq!(fs::read(here.join("a.exr")).unwrap(), set("last")[0].1);
        }

        #[test]
        fn hidden_files_of_ours_are_never_links() {
            let folder = tempfile::tempdir().unwrap();
            let precious = folder.path().join("precious");
            fs::write(&precious, "").unwrap();
            for name in [JOURNAL, RECORD] {
                symlink(&precious, folder.path().join(name)).unwrap();
            }
            let (name, why) = finish(folder.path()).unwrap_err();
            assert!(name == JOURNAL && why.to_string().contains("remove it"), "{name}: {why}");
            assert_eq!(recorded(folder.path()).unwrap_err().0, RECORD);
            let files = [("a.exr".to_string(), Vec::new()), (RECORD.to_string(), b"a.exr".into())];
            replace_all(folder.path(), &files, &[]).unwrap();
            assert_eq!(fs::read(&precious).unwrap(), b"");
        }
    }
}
