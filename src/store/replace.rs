//! Replaces files as a whole, one or several.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

/// Prefix and suffix of the names of incomplete files; while no bake locks the folder, such a file
/// is a leftover.
const PREFIX: &str = ".microfacet-bake-";
const SUFFIX: &str = ".partial";

/// Journal of the replacement of several files while it is under way: a line `PARTIAL NAME` for
/// each new file, `- NAME` for each removed one.
const JOURNAL: &str = ".microfacet-bake.commit";

/// Marks a removed file in the journal.
const STALE: &str = "-";

/// Writes `bytes` to `path` so that at every moment either the old file or the complete new one is
/// there: into a temporary file in the same folder, synchronised to disk, then renamed over it.
///
/// # Errors
/// The operating system's error; the old file is then untouched.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder =
        path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    stage(folder, bytes)?.persist(path).map_err(|error| error.error)?;
    sync(folder)
}

/// A complete temporary file in `folder`, synchronised to disk.
fn stage(folder: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut file = tempfile::Builder::new().prefix(PREFIX).suffix(SUFFIX).tempfile_in(folder)?;
    file.write_all(bytes)?;
    #[cfg(unix)]
    {
        // Temporary files are private; the result is an ordinary file.
        use std::os::unix::fs::PermissionsExt;
        file.as_file().set_permissions(fs::Permissions::from_mode(0o644))?;
    }
    file.as_file().sync_all()?;
    Ok(file)
}

/// Makes renames in a folder durable.
fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { fs::File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Replaces several files of a folder, by name, and removes those in `stale`, so that old and new
/// files never coexist.
///
/// No file system replaces several files in one step. The new ones are completed under temporary
/// names, then a journal of the replacement is written in one step. From then on [`finish`] leads
/// to the new set, now or after an interruption.
///
/// # Errors
/// The name and the operating system's error; before the journal is written the old files are
/// untouched.
pub(super) fn replace_all(
    folder: &Path,
    files: &[(String, Vec<u8>)],
    stale: &[String],
) -> Result<(), (String, io::Error)> {
    if let ([(name, bytes)], []) = (files, stale) {
        return replace(&folder.join(name), bytes).map_err(|why| (name.clone(), why));
    }
    let mut staged = Vec::new();
    for (name, bytes) in files {
        let blocked = folder.join(name).is_dir();
        let file =
            if blocked { Err(io::ErrorKind::IsADirectory.into()) } else { stage(folder, bytes) };
        staged.push(file.map_err(|why| (name.clone(), why))?);
    }
    let failed = |why| (JOURNAL.to_string(), why);
    let mut journal: String = stale.iter().map(|name| format!("{STALE} {name}\n")).collect();
    for (file, (name, _)) in staged.iter().zip(files) {
        let partial = file.path().file_name().unwrap_or_default().to_string_lossy();
        journal += &format!("{partial} {name}\n");
    }
    replace(&folder.join(JOURNAL), journal.as_bytes()).map_err(failed)?;
    for file in staged {
        // From here on the journal decides about these files.
        file.keep().map_err(|error| failed(error.error))?;
    }
    finish(folder).map_err(failed)
}

/// Whether a replacement in the folder was begun and not completed.
pub(super) fn is_interrupted(folder: &Path) -> bool {
    folder.join(JOURNAL).exists()
}

/// Completes the replacement that a journal lists, if there is one, and removes leftovers. It can
/// itself be interrupted and repeated.
pub(super) fn finish(folder: &Path) -> io::Result<()> {
    let journal = folder.join(JOURNAL);
    let text = match fs::read_to_string(&journal) {
        Err(why) if why.kind() == io::ErrorKind::NotFound => return remove_leftovers(folder),
        text => text?,
    };
    let is_file_name = |name: &str| !name.contains(['/', '\\']) && name != "..";
    let lines = || text.lines().filter_map(|line| line.split_once(' '));
    let exchanges: Vec<_> = lines()
        // A journal written by someone else may name any path.
        .filter(|(partial, name)| {
            is_file_name(partial) && partial.starts_with(PREFIX) && is_file_name(name)
        })
        .map(|(partial, name)| (folder.join(partial), folder.join(name)))
        // A file no longer under its temporary name has been moved already.
        .filter(|(partial, _)| partial.exists())
        .collect();
    let stale = lines()
        .filter(|(partial, name)| *partial == STALE && is_file_name(name))
        .map(|(_, name)| folder.join(name));
    for path in stale.chain(exchanges.iter().map(|(_, path)| path.clone())) {
        match fs::remove_file(&path) {
            Err(why) if why.kind() != io::ErrorKind::NotFound => return Err(why),
            _ => {}
        }
    }
    for (partial, path) in &exchanges {
        fs::rename(partial, path)?;
    }
    sync(folder)?;
    fs::remove_file(&journal)?;
    remove_leftovers(folder)
}

fn remove_leftovers(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(PREFIX) && name.ends_with(SUFFIX) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(mark: &str) -> Vec<(String, Vec<u8>)> {
        ["a", "b", "c"].map(|name| (name.to_string(), format!("{mark} {name}").into_bytes())).into()
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
    fn what_is_stale_goes_with_the_old_set() {
        let folder = tempfile::tempdir().unwrap();
        replace_all(folder.path(), &set("old"), &[]).unwrap();
        let new = vec![("b".to_string(), b"new b".to_vec())];
        replace_all(folder.path(), &new, &["a".into(), "c".into()]).unwrap();
        assert_eq!(content(folder.path()), new);
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
}
