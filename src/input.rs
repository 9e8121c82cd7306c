//! Opens what a user names for reading: regular files only, of a limited size.
//!
//! A FIFO would hang, a device never ends, and a file of many gigabytes may hold nothing but zeros.
//! So every file is looked at before it is opened, and read to a limit.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest table file or image, 512 MiB: as much again is needed to decode it.
pub const MAX_TABLES: u64 = 512 << 20;

/// Opens a regular file of at most `limit` bytes.
///
/// # Errors
/// Those of the operating system, or one that says what else the path names, or how large the file
/// is and may be.
pub fn open(path: &Path, limit: u64) -> io::Result<File> {
    regular(&std::fs::metadata(path)?, limit)?;
    let file = File::open(path)?;
    // Another program may have replaced it meanwhile.
    regular(&file.metadata()?, limit)?;
    Ok(file)
}

fn regular(found: &std::fs::Metadata, limit: u64) -> io::Result<()> {
    let invalid = |why: String| Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    if !found.is_file() {
        return invalid(format!("is {}; name a regular file", name(found.file_type())));
    }
    if found.len() > limit {
        return invalid(too_large(&format!("has {} bytes", found.len()), limit));
    }
    Ok(())
}

fn too_large(what: &str, limit: u64) -> String {
    format!("{what}, and at most {} MiB are read", limit >> 20)
}

/// What a path names, in words.
pub(crate) fn name(kind: std::fs::FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return "a FIFO (a pipe)";
        } else if kind.is_socket() {
            return "a socket";
        } else if kind.is_block_device() {
            return "a block device";
        } else if kind.is_char_device() {
            return "a character device";
        }
    }
    if kind.is_dir() { "a folder" } else { "no regular file" }
}

/// The content of a regular file of at most `limit` bytes.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // Files of the kernel report no size, and a file may grow while it is read.
    open(path, limit)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, too_large("is too long", limit)));
    }
    Ok(bytes)
}

/// The content of a regular text file of at most `limit` bytes.
///
/// # Errors
/// As [`open`], or that it is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    let text = String::from_utf8(read(path, limit)?);
    text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "is no text in UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_within_the_limit_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse");
        let file = File::create(&path).unwrap();
        file.set_len(11).unwrap();
        assert_eq!(read(&path, 11).unwrap().len(), 11);
        let message = read(&path, 10).unwrap_err().to_string();
        assert!(message.contains("has 11 bytes"), "{message}");
        let message = read(folder.path(), 10).unwrap_err().to_string();
        assert!(message.contains("is a folder"), "{message}");
        #[cfg(target_os = "linux")]
        {
            let message = read(Path::new("/dev/zero"), 10).unwrap_err().to_string();
            assert!(message.contains("character device"), "{message}");
            // It reports no size.
            let message = read(Path::new("/proc/self/maps"), 10).unwrap_err().to_string();
            assert!(message.contains("too long"), "{message}");
        }
    }
}
