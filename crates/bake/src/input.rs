//! Opens files that a user names: regular files only, of a limited size. Every file is checked
//! before it is opened, since a FIFO would hang and a device may never end.

pub mod angles;
pub mod normals;
pub mod rows;

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest table file or image, 256 MiB: decoding may need two more times as much.
pub const MAX_TABLES: u64 = 256 << 20;
/// Largest text, such as measured data or an index, 64 MiB. Scenes have limits of their own.
pub const MAX_TEXT: u64 = 64 << 20;
/// Largest row of a CSV, 1 MiB. A row may have quoted fields of several lines.
pub const MAX_ROW: u64 = 1 << 20;

/// Opens a regular file of at most `limit` bytes.
///
/// # Errors
/// Those of the operating system, or one that says what else the path names, or how large the file
/// is and may be.
pub fn open(path: &Path, limit: u64) -> io::Result<File> {
    regular(&std::fs::metadata(path)?, limit)?;
    let file = File::open(path)?;
    // Another program may have replaced the file meanwhile.
    regular(&file.metadata()?, limit)?;
    Ok(file)
}

fn regular(found: &std::fs::Metadata, limit: u64) -> io::Result<()> {
    if !found.is_file() {
        let why = format!("is {}; name a regular file", name(found.file_type()));
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    if found.len() > limit {
        return Err(too_large(&format!("has {} bytes", found.len()), limit));
    }
    Ok(())
}

fn too_large(what: &str, limit: u64) -> io::Error {
    let why = format!("{what}, and at most {} MiB are read", limit >> 20);
    io::Error::new(io::ErrorKind::FileTooLarge, why)
}

/// Opens a regular file as [`open`] does, or standard input for `-`, of which `limit` bytes are
/// read.
///
/// # Errors
/// As [`open`]. Reading fails beyond `limit`.
pub fn open_or_stdin(path: &Path, limit: u64) -> io::Result<Box<dyn Read>> {
    if path.as_os_str() == "-" {
        return Ok(Box::new(Limited::new(io::stdin(), limit)));
    }
    match open(path, limit) {
        Ok(file) => Ok(Box::new(Limited::new(file, limit))),
        // A pipe may hang, so it is read only as standard input.
        Err(why) if std::fs::metadata(path).is_ok_and(|found| !found.is_file()) => {
            Err(io::Error::new(why.kind(), format!("{why}, or `-` for standard input")))
        }
        Err(why) => Err(why),
    }
}

/// A path as messages show it, where `-` is standard input.
pub fn shown(path: &Path) -> std::path::Display<'_> {
    if path.as_os_str() == "-" { Path::new("standard input").display() } else { path.display() }
}

/// A stream whose reading fails beyond a limit of bytes.
#[derive(Debug)]
pub struct Limited<R> {
    input: R,
    limit: u64,
    left: u64,
}

impl<R> Limited<R> {
    /// Allows `limit` bytes of `input`.
    pub fn new(input: R, limit: u64) -> Self {
        Self { input, limit, left: limit }
    }

    /// Allows as many bytes again, at the end of a row.
    pub fn restart(&mut self) {
        self.left = self.limit;
    }
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let bytes = self.input.read(to)?;
        match self.left.checked_sub(bytes as u64) {
            Some(left) => self.left = left,
            None => {
                let why = format!("no end within {} MiB", self.limit >> 20);
                return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
            }
        }
        Ok(bytes)
    }
}

/// The kind of a file in words.
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
    match kind {
        kind if kind.is_dir() => "a folder",
        kind if kind.is_file() => "a file",
        _ => "no regular file",
    }
}

/// The content of a regular file of at most `limit` bytes, with the errors of [`open`].
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // Files of the kernel report no size, and a file may grow while it is read.
    open(path, limit)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(too_large("is too long", limit));
    }
    Ok(bytes)
}

/// The content of a regular file of at most `limit` bytes of UTF-8, with the errors of [`open`].
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    let text = String::from_utf8(unmarked(&read(path, limit)?).to_vec());
    text.map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "is no text in UTF-8"))
}

/// The byte order mark that some editors write before UTF-8.
const MARK: &[u8] = "\u{feff}".as_bytes();

/// A text without its byte order mark.
pub fn unmarked(text: &[u8]) -> &[u8] {
    text.strip_prefix(MARK).unwrap_or(text)
}

pub(crate) type Unmarked<R> = io::Chain<io::Cursor<Vec<u8>>, R>;

/// A stream of text without its byte order mark. Its first bytes are read by this call.
pub fn unmarked_stream<R: Read>(mut input: R) -> io::Result<Unmarked<R>> {
    let mut first = Vec::new();
    input.by_ref().take(MARK.len() as u64).read_to_end(&mut first)?;
    Ok(io::Cursor::new(unmarked(&first).to_vec()).chain(input))
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
            let message = open_or_stdin(Path::new("/dev/zero"), 10).err().unwrap().to_string();
            assert!(message.contains("`-` for standard input"), "{message}");
            // A file that reports no size.
            let message = read(Path::new("/proc/self/maps"), 10).unwrap_err().to_string();
            assert!(message.contains("too long"), "{message}");
        }
    }

    #[test]
    fn a_stream_ends_at_its_limit() {
        let mut stream = Limited::new(io::repeat(1), 10);
        let mut some = [0; 6];
        assert_eq!(stream.read(&mut some).unwrap(), 6);
        stream.restart();
        assert_eq!(stream.read(&mut some).unwrap(), 6);
        assert!(stream.read(&mut some).unwrap_err().to_string().contains("no end within"));
        assert_eq!(Limited::new(&[1; 10][..], 10).read_to_end(&mut Vec::new()).unwrap(), 10);
    }
}
