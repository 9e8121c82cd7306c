//! Reads and writes files of tables, as safetensors and OpenEXR.
//!
//! A set is one file, which is replaced in one step: readers need no lock, and see the old set or
//! the new one.

#[cfg(feature = "exr")]
mod exr;
#[cfg(not(feature = "exr"))]
#[path = "without_exr.rs"]
mod exr;
mod folder;
mod interrupt;
mod numbered;
mod replace;

use std::io;
use std::path::{Path, PathBuf};

use microfacet_sampler::Tables;
use microfacet_tables::{Index, LoadError, Table, encode};

use crate::input::{self, MAX_TABLES};

#[cfg(feature = "exr")]
pub use self::exr::{decode as decode_exr, encode as encode_exr, encode_channels};
pub use folder::OutputFolder;
pub use interrupt::quiesce;
pub use numbered::SetWriter;
pub use replace::{check_file, replace, replace_with};
pub(crate) use replace::{in_folder, make_folder, remove_abandoned};

/// A container format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Format {
    /// `tables.safetensors`.
    #[default]
    Safetensors,
    /// `tables.exr`, an image of one part for each table; needs the feature `exr`.
    Exr,
}

impl Format {
    /// The name of the file that holds a whole set.
    pub const fn file(self) -> &'static str {
        match self {
            Self::Safetensors => "tables.safetensors",
            Self::Exr => "tables.exr",
        }
    }
}

/// Files that may hold a folder's set, in the order in which they are looked for. There may be
/// several for a moment, or after a kill, while a set in one of them replaces that in another.
const NAMES: [&str; 3] = [Format::Safetensors.file(), Format::Exr.file(), Index::FILE];

/// Why a set could not be read or written.
#[derive(thiserror::Error)]
pub enum StoreError {
    /// The operating system reported an error.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
    /// The file is not a table set, damaged, or of a newer version.
    #[error("{}: {}", .0.display(), .1)]
    Load(PathBuf, LoadError),
    /// An image could not be written.
    #[error("{}: {}", .0.display(), .1)]
    Exr(PathBuf, String),
    /// A set would be larger than what is read.
    #[error("{}: {}", .0.display(), .1)]
    TooLarge(PathBuf, String),
    /// A set, or numbered sets, have no material of a name.
    #[error("{}: {}", .0.display(), .1)]
    NoMaterial(PathBuf, String),
}

microfacet_core::debug_in_words!(StoreError);

/// A file that was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// Its path.
    pub path: PathBuf,
    /// Its size.
    pub bytes: usize,
}

/// Writes a set into a folder: [`OutputFolder::open_for_set`], then [`OutputFolder::write`].
pub fn write(folder: &Path, set: &Tables, format: Format) -> Result<Vec<Written>, StoreError> {
    OutputFolder::open_for_set(folder)?.write(set, format)
}

/// The bytes of a set's file, of a size that [`read`] allows.
fn bytes_of(set: &Tables, format: Format, path: &Path) -> Result<Vec<u8>, StoreError> {
    let (origin, tables) = (set.provenance(), set.tables());
    let bytes = match format {
        Format::Safetensors => {
            encode(origin, tables).map_err(|why| StoreError::Load(path.into(), why))?
        }
        Format::Exr => {
            exr::encode(origin, tables).map_err(|why| StoreError::Exr(path.into(), why))?
        }
    };
    allow(bytes.len() as u64, MAX_TABLES).map_err(|why| StoreError::TooLarge(path.into(), why))?;
    Ok(bytes)
}

/// Name and bytes of the image of a single table.
fn image_of(set: &Tables, table: &Table) -> Result<(String, Vec<u8>), String> {
    let plain = |c: char| !c.is_control() && c != '/' && c != '\\';
    let name = &table.name;
    if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
        return Err(format!("no file can be named after the table `{name}`"));
    }
    let bytes = exr::encode(set.provenance(), std::slice::from_ref(table))?;
    Ok((format!("{name}.exr"), bytes))
}

fn invalid(why: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

fn allow(bytes: u64, limit: u64) -> Result<(), String> {
    if bytes <= limit {
        return Ok(());
    }
    Err(format!(
        "{bytes} bytes, and at most {} MiB are read: bake fewer materials, or fewer in each set, or \
         with a lower quality or precision",
        limit >> 20
    ))
}

/// The file or the index to which a path leads.
enum Found {
    File(PathBuf),
    Numbered(PathBuf, Index),
}

impl Found {
    fn at(path: &Path) -> Result<Self, StoreError> {
        let (folder, name) = if path.is_dir() {
            let is_there = |name: &&str| std::fs::symlink_metadata(path.join(name)).is_ok();
            (path, NAMES.into_iter().find(is_there))
        } else if path.file_name().is_some_and(|name| name == Index::FILE) {
            (path.parent().unwrap_or(Path::new("")), Some(Index::FILE))
        } else {
            return Ok(Self::File(path.into()));
        };
        let Some(name) = name else {
            let why = format!(
                "holds none of {}; name what `microfacet-bake bake` wrote, or one file",
                NAMES.join(", ")
            );
            let why = io::Error::new(io::ErrorKind::NotFound, why);
            return Err(StoreError::Io(path.into(), why));
        };
        let index = if name == Index::FILE { numbered::index_at(folder)? } else { None };
        Ok(match index {
            Some(index) => Self::Numbered(folder.into(), index),
            None => Self::File(folder.join(name)),
        })
    }
}

/// Reads a set from a file, or from the folder that it was written into; an image may have a single
/// table. Numbered sets, named by their folder or its index, are read as one set if they are small
/// enough together; otherwise [`read_materials`] reads some of their materials.
///
/// A folder's set is `tables.safetensors` if there is one, else `tables.exr`, else the sets that
/// `tables.index.json` lists.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong.
pub fn read(path: &Path) -> Result<Tables, StoreError> {
    undisturbed(path, || match Found::at(path)? {
        Found::File(path) => read_file(&path),
        Found::Numbered(folder, index) => numbered::read_all(&folder, &index),
    })
}

/// Reads some materials of a set, or of numbered sets of any size.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong, such as a material that is not there.
pub fn read_materials(path: &Path, names: &[&str]) -> Result<Tables, StoreError> {
    undisturbed(path, || match Found::at(path)? {
        Found::File(file) => {
            let only = read_file(&file)?.only(names);
            only.map_err(|why| StoreError::NoMaterial(path.into(), why.to_string()))
        }
        Found::Numbered(folder, index) => numbered::read_some(&folder, &index, names),
    })
}

/// Reads what a path leads to; again, if that fails and a file was replaced meanwhile.
fn undisturbed<T>(path: &Path, read: impl Fn() -> Result<T, StoreError>) -> Result<T, StoreError> {
    let there = || {
        let names = if path.is_dir() { &NAMES[..] } else { &[""] };
        let file = |name: &&str| if name.is_empty() { path.into() } else { path.join(name) };
        names.iter().map(|name| folder::stamp(std::fs::metadata(file(name)))).collect::<Vec<_>>()
    };
    let mut before = there();
    loop {
        let result = read();
        let now = if result.is_ok() { return result } else { there() };
        if now == before {
            return result;
        }
        before = now;
    }
}

/// Reads the set or the table in one file.
pub(crate) fn read_file(path: &Path) -> Result<Tables, StoreError> {
    /// The first bytes of every OpenEXR file.
    const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
    let bytes =
        input::read(path, MAX_TABLES).map_err(|why| StoreError::Io(path.to_path_buf(), why))?;
    let set =
        if bytes.starts_with(&MAGIC) { exr::decode(&bytes) } else { Tables::from_bytes(&bytes) };
    set.map_err(|why| StoreError::Load(path.to_path_buf(), why))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_could_not_be_read_back_is_not_written() {
        assert!(allow(10, 10).is_ok());
        let message = allow(11 << 20, 10 << 20).unwrap_err();
        assert!(message.contains("at most 10 MiB") && message.contains("precision"), "{message}");
    }

    /// Another writer replaces the set between finding it and reading it.
    #[test]
    fn a_set_that_moves_while_it_is_looked_for_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        std::fs::write(file(Index::FILE), "").unwrap();
        let moves = std::cell::Cell::new(0);
        let found = undisturbed(folder.path(), || {
            let (from, to) = [(2, 0), (0, 1), (1, 1)][moves.get()];
            moves.set(moves.get() + 1);
            std::fs::rename(file(NAMES[from]), file(NAMES[to])).unwrap();
            if from == to {
                Found::at(folder.path())
            } else {
                Err(StoreError::NoMaterial(folder.path().into(), String::new()))
            }
        });
        assert!(matches!(found.unwrap(), Found::File(path) if path == file(NAMES[1])));
    }

    #[test]
    #[cfg(feature = "exr")]
    fn a_table_names_no_file_in_another_folder() {
        let set = Tables::embedded();
        let named = |name: &str| {
            let mut table = set.tables()[0].clone();
            table.name = name.into();
            Tables::from_tables(set.provenance().clone(), vec![table]).unwrap()
        };
        for name in ["../up", "/root", "", ".hidden", "two\nlines"] {
            let set = named(name);
            assert!(image_of(&set, &set.tables()[0]).is_err(), "{name}");
            for format in [Format::Safetensors, Format::Exr] {
                assert!(bytes_of(&set, format, Path::new("")).is_ok(), "{name}");
            }
        }
        let set = named("plain");
        assert_eq!(image_of(&set, &set.tables()[0]).unwrap().0, "plain.exr");
    }
}
