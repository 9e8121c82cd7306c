//! Tables on disk, as safetensors and OpenEXR. Only this folder of the crate reads and writes table
//! files.

mod exr;
mod lock;
mod replace;

use std::fmt;
use std::path::{Path, PathBuf};

use microfacet_sampler::{LoadError, Tables, encode};

pub use self::exr::{decode as decode_exr, encode as encode_exr};
pub use lock::OutputFolder;
pub use replace::replace;

/// Name of the file that holds a whole set.
pub const SET_FILE: &str = "tables.safetensors";

/// A container format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// One file with all tables.
    Safetensors,
    /// One image a table.
    Exr,
}

/// Why a set could not be read or written.
#[derive(Debug)]
pub enum StoreError {
    /// The operating system reported an error.
    Io(PathBuf, std::io::Error),
    /// The file is not a table set, damaged, or of a newer version.
    Load(PathBuf, LoadError),
    /// Writing an image failed.
    Exr(PathBuf, String),
    /// Another bake is writing into the folder.
    InUse(PathBuf),
}

impl StoreError {
    /// The same error with its path taken relative to a folder.
    fn inside(self, folder: &Path) -> Self {
        match self {
            Self::Io(path, why) => Self::Io(folder.join(path), why),
            Self::Load(path, why) => Self::Load(folder.join(path), why),
            Self::Exr(path, why) => Self::Exr(folder.join(path), why),
            Self::InUse(path) => Self::InUse(folder.join(path)),
        }
    }
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Load(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Exr(path, why) => write!(f, "{}: {why}", path.display()),
            Self::InUse(path) => write!(
                f,
                "{}: another bake is writing into this folder; wait for it to end, or name another folder",
                path.display()
            ),
        }
    }
}

impl std::error::Error for StoreError {}

/// A file that was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// Its path.
    pub path: PathBuf,
    /// Its size.
    pub bytes: usize,
}

/// Writes a set into a folder: [`OutputFolder::open`], then [`OutputFolder::write`].
///
/// # Errors
/// As [`OutputFolder::open`] and [`OutputFolder::write`].
pub fn write(folder: &Path, set: &Tables, formats: &[Format]) -> Result<Vec<Written>, StoreError> {
    OutputFolder::open(folder)?.write(set, formats)
}

/// Names and contents of the files that hold a set.
fn files(set: &Tables, formats: &[Format]) -> Result<Vec<(String, Vec<u8>)>, StoreError> {
    let mut files = Vec::new();
    if formats.contains(&Format::Exr) {
        for table in set.tables() {
            let name = format!("{}.exr", table.name);
            let bytes = encode_exr(set.provenance(), table)
                .map_err(|why| StoreError::Exr(name.clone().into(), why))?;
            files.push((name, bytes));
        }
    }
    if formats.contains(&Format::Safetensors) {
        let bytes = encode(set.provenance(), set.tables())
            .map_err(|why| StoreError::Load(SET_FILE.into(), why))?;
        files.push((SET_FILE.into(), bytes));
    }
    Ok(files)
}

/// Reads a set from a safetensors file or a folder that holds one, or a single table from an EXR
/// file.
///
/// If a bake was killed while it replaced several files, the replacement is completed first.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong.
pub fn read(path: &Path) -> Result<Tables, StoreError> {
    let folder = if path.is_dir() { path } else { path.parent().unwrap_or(path) };
    if replace::is_interrupted(folder) {
        // Opening the folder completes a replacement that was interrupted.
        OutputFolder::open(folder)?;
    }
    read_file(&if path.is_dir() { path.join(SET_FILE) } else { path.to_path_buf() })
}

/// Reads the set or the table in one file.
fn read_file(path: &Path) -> Result<Tables, StoreError> {
    let path = path.to_path_buf();
    let bytes = std::fs::read(&path).map_err(|why| StoreError::Io(path.clone(), why))?;
    let set = if bytes.starts_with(&exr::MAGIC) {
        decode_exr(&bytes)
    } else {
        Tables::from_bytes(&bytes)
    };
    set.map_err(|why| StoreError::Load(path, why))
}
