//! Tables on disk: safetensors and OpenEXR. The only place of the generator that touches table files.

mod exr;
mod replace;

use std::fmt;
use std::path::{Path, PathBuf};

use microfacet_sampler::{LoadError, Tables, encode};

pub use self::exr::{decode as decode_exr, encode as encode_exr};
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
    /// The operating system refused.
    Io(PathBuf, std::io::Error),
    /// The file is not a table set, damaged, or of a newer version.
    Load(PathBuf, LoadError),
    /// Writing an image failed.
    Exr(PathBuf, String),
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Load(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Exr(path, why) => write!(f, "{}: {why}", path.display()),
        }
    }
}

impl std::error::Error for StoreError {}

/// A file that was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// Where.
    pub path: PathBuf,
    /// How large.
    pub bytes: usize,
}

/// Writes a set into a folder, which is made if it is not there: `tables.safetensors`, and `NAME.exr` for each table.
///
/// Everything is prepared in memory first and each file is replaced as a whole; the set file comes last.
///
/// # Errors
/// [`StoreError`] naming the path; files already there are then untouched or complete.
pub fn write(folder: &Path, set: &Tables, formats: &[Format]) -> Result<Vec<Written>, StoreError> {
    let mut files = Vec::new();
    if formats.contains(&Format::Exr) {
        for table in set.tables() {
            let path = folder.join(format!("{}.exr", table.name));
            let bytes =
                encode_exr(set.provenance(), table).map_err(|why| StoreError::Exr(path.clone(), why))?;
            files.push((path, bytes));
        }
    }
    if formats.contains(&Format::Safetensors) {
        let path = folder.join(SET_FILE);
        let bytes =
            encode(set.provenance(), set.tables()).map_err(|why| StoreError::Load(path.clone(), why))?;
        files.push((path, bytes));
    }
    std::fs::create_dir_all(folder).map_err(|why| StoreError::Io(folder.into(), why))?;
    files
        .into_iter()
        .map(|(path, bytes)| {
            replace(&path, &bytes).map_err(|why| StoreError::Io(path.clone(), why))?;
            Ok(Written { bytes: bytes.len(), path })
        })
        .collect()
}

/// Reads a set from a safetensors file, a folder that holds one, or a single table from an EXR file.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong.
pub fn read(path: &Path) -> Result<Tables, StoreError> {
    let path = if path.is_dir() { path.join(SET_FILE) } else { path.to_path_buf() };
    let bytes = std::fs::read(&path).map_err(|why| StoreError::Io(path.clone(), why))?;
    let set = if bytes.starts_with(&exr::MAGIC) { decode_exr(&bytes) } else { Tables::from_bytes(&bytes) };
    set.map_err(|why| StoreError::Load(path, why))
}
