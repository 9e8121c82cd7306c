//! Tables on disk, as safetensors and OpenEXR. Only this folder of the crate reads and writes table
//! files.

#[cfg(feature = "exr")]
mod exr;
#[cfg(not(feature = "exr"))]
#[path = "without_exr.rs"]
mod exr;
mod image;
mod interrupt;
mod journal;
mod lock;
mod numbered;
mod replace;

use std::path::{Path, PathBuf};
use std::{fmt, io};

use microfacet_sampler::Tables;
use microfacet_tables::{Index, LoadError, Table, encode};

use crate::input::{self, MAX_TABLES};

#[cfg(feature = "exr")]
pub use self::exr::{decode as decode_exr, encode as encode_exr, encode_channels};
pub use interrupt::quiesce;
pub use lock::OutputFolder;
pub use numbered::{SetWriter, index, read_materials};
pub use replace::{check_file, check_folder, replace, replace_files, replace_with};
pub(crate) use replace::{make_folder, remove_abandoned};

/// Name of the file that holds a whole set.
pub const SET_FILE: &str = "tables.safetensors";

/// Most images that a folder may hold to be read as a set.
const MAX_IMAGES: usize = 10_000;

/// A container format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// One file with all tables.
    Safetensors,
    /// One image a table; needs the feature `exr`.
    Exr,
}

/// Why a set could not be read or written.
pub enum StoreError {
    /// The operating system reported an error.
    Io(PathBuf, std::io::Error),
    /// The file is not a table set, damaged, or of a newer version.
    Load(PathBuf, LoadError),
    /// An image could not be written, or its header not be read.
    Exr(PathBuf, String),
    /// One of numbered sets would be larger than what is read.
    TooLarge(PathBuf, String),
    /// A set, or numbered sets, have no material of a name.
    NoMaterial(PathBuf, String),
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
            Self::TooLarge(path, why) => Self::TooLarge(folder.join(path), why),
            Self::NoMaterial(path, why) => Self::NoMaterial(folder.join(path), why),
            Self::InUse(path) => Self::InUse(folder.join(path)),
        }
    }
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Load(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Exr(path, why) | Self::NoMaterial(path, why) => {
                write!(f, "{}: {why}", path.display())
            }
            Self::TooLarge(path, why) => {
                write!(f, "{}: {why}, or fewer in each set", path.display())
            }
            Self::InUse(path) => write!(
                f,
                "{}: another bake is writing into this folder; wait for it to end, or name another folder",
                path.display()
            ),
        }
    }
}

microfacet_core::debug_in_words!(StoreError);

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

/// Names and contents of the files that hold a set; only what [`read`] reads back. A set without
/// tables has no images, and is a safetensors file whatever the formats.
fn files(set: &Tables, formats: &[Format]) -> Result<Vec<(String, Vec<u8>)>, StoreError> {
    let mut files = Vec::new();
    if formats.contains(&Format::Exr) {
        let mut images = Images::default();
        for table in set.tables() {
            let Some(name) = image::name_of(&table.name) else {
                let why = format!("no file can be named after the table `{}`", table.name);
                return Err(StoreError::Exr(PathBuf::new(), why));
            };
            let bytes = exr::encode(set.provenance(), table)
                .and_then(|bytes| images.add(bytes.len() as u64, table).map(|()| bytes))
                .map_err(|why| StoreError::Exr(name.clone().into(), why))?;
            files.push((name, bytes));
        }
    }
    if formats.contains(&Format::Safetensors) || set.tables().is_empty() {
        let bytes = encode(set.provenance(), set.tables())
            .map_err(|why| StoreError::Load(SET_FILE.into(), why))?;
        allow(bytes.len() as u64, MAX_TABLES)
            .map_err(|why| StoreError::Io(SET_FILE.into(), invalid(why)))?;
        files.push((SET_FILE.into(), bytes));
    }
    Ok(files)
}

fn invalid(why: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

/// Refuses more bytes of a set than are read.
fn allow(bytes: u64, limit: u64) -> Result<(), String> {
    if bytes <= limit {
        return Ok(());
    }
    Err(format!(
        "{bytes} bytes, and at most {} MiB are read: bake fewer materials, or with a lower quality or precision",
        limit >> 20
    ))
}

/// What the images of a set take, on disk and in memory.
#[derive(Default)]
struct Images {
    count: usize,
    bytes: u64,
    values: u64,
}

impl Images {
    fn add(&mut self, bytes: u64, table: &Table) -> Result<(), String> {
        self.count += 1;
        self.bytes += bytes;
        self.values += 4 * table.values.len() as u64;
        if self.count > MAX_IMAGES {
            return Err(format!("more than {MAX_IMAGES} images: write safetensors instead"));
        }
        allow(self.bytes.max(self.values), MAX_TABLES)
            .map_err(|why| format!("together the images have {why}; or write safetensors instead"))
    }
}

/// Reads a set from a safetensors file, a folder that holds one or the images of one, or a single
/// table from an EXR file. Numbered sets, by their folder or its index, are read as one if they are
/// small enough together; otherwise [`read_materials`] reads some of their materials.
///
/// Of images in a folder, those named NAME.exr count that hold the table NAME. Their order is that
/// of the names.
///
/// If a bake was killed while it replaced several files, the replacement is completed first.
///
/// # Errors
/// [`StoreError`] naming the path and what is wrong.
pub fn read(path: &Path) -> Result<Tables, StoreError> {
    let is_folder = path.is_dir();
    let folder = if is_folder { path } else { replace::folder_of(path) };
    loop {
        if journal::is_interrupted(folder) {
            OutputFolder::complete(folder)?;
        }
        let before = journal::record_stamp(folder);
        let set = path.join(SET_FILE);
        let read = if let Some(index) = numbered::index_at(path)? {
            numbered::read_all(folder, &index)
        } else if !is_folder {
            read_file(path)
        } else if std::fs::symlink_metadata(&set).is_ok() {
            read_file(&set)
        } else {
            read_images(path)
        };
        // If a bake replaced the images meanwhile, only some of a set were found.
        if !journal::is_interrupted(folder) && journal::record_stamp(folder) == before {
            return read;
        }
    }
}

/// Reads the images of a set from a folder.
fn read_images(folder: &Path) -> Result<Tables, StoreError> {
    let failed = |why| StoreError::Io(folder.into(), why);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let file = entry.map_err(failed)?.file_name().into_string().unwrap_or_default();
        names.extend(image::table_of(&file).map(|name| (name.to_owned(), file.clone())));
    }
    // By the names of the tables: `a` comes before `a_b`, but `a.exr` need not before `a_b.exr`.
    names.sort();
    let (mut images, mut tables, mut first) = (Images::default(), Vec::new(), None);
    for (_, file) in &names {
        let path = folder.join(file);
        let of_table = exr::is_table(&path);
        if !of_table.map_err(|why| StoreError::Exr(path.clone(), why))? {
            continue;
        }
        let bytes = std::fs::metadata(&path).map_err(failed)?.len();
        let set = read_file(&path)?;
        let (other, provenance) = first.get_or_insert((file, set.provenance().clone()));
        if set.provenance() != provenance {
            let why = format!("{other} and {file} come from different bakes: keep those of one");
            return Err(failed(invalid(why)));
        }
        for table in set.tables() {
            images.add(bytes, table).map_err(|why| StoreError::Exr(path.clone(), why))?;
            tables.push(table.clone());
        }
    }
    let Some((_, provenance)) = first else {
        let why = format!(
            "holds neither {SET_FILE} nor an image NAME.exr of a table; name what `microfacet-bake bake` wrote"
        );
        return Err(failed(io::Error::new(io::ErrorKind::NotFound, why)));
    };
    Tables::from_tables(provenance, tables).map_err(|why| StoreError::Load(folder.into(), why))
}

/// Reads the set or the table in one file.
pub(crate) fn read_file(path: &Path) -> Result<Tables, StoreError> {
    let bytes =
        input::read(path, MAX_TABLES).map_err(|why| StoreError::Io(path.to_path_buf(), why))?;
    let set = if bytes.starts_with(&image::MAGIC) {
        exr::decode(&bytes)
    } else {
        Tables::from_bytes(&bytes)
    };
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
        let set = Tables::embedded();
        let table = &set.tables()[0];
        let mut images = Images::default();
        assert!(images.add(MAX_TABLES, table).is_ok());
        assert!(images.add(1, table).unwrap_err().contains("256 MiB"));
        let mut images = Images { values: MAX_TABLES, ..Images::default() };
        assert!(images.add(1, table).unwrap_err().contains("safetensors"));
        let mut images = Images { count: MAX_IMAGES, ..Images::default() };
        assert!(images.add(1, table).unwrap_err().contains("10000 images"));
    }

    #[test]
    fn a_table_names_no_file_in_another_folder() {
        let set = Tables::embedded();
        for name in ["../up", "/root", "", ".hidden", "two\nlines"] {
            let table = Table { name: name.into(), ..set.tables()[0].clone() };
            let set = Tables::from_tables(set.provenance().clone(), vec![table]).unwrap();
            assert!(files(&set, &[Format::Exr]).is_err(), "{name}");
            assert!(files(&set, &[Format::Safetensors]).is_ok(), "{name}");
        }
    }
}
