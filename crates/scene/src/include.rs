//! Included files: checks for circular inclusion, and a limit for all of them together, since a few
//! files that include each other twice amount to any number.

use std::collections::BTreeSet;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use microfacet_baker::input;
use microfacet_baker::scene::{Place, SceneError};

use crate::limits::{self, Budget};

/// Deeper nesting than this is refused as a mistake.
const MAX_DEPTH: usize = 64;

/// What is said of a file, included as `name`, that [`Includes::enter`] did not find.
pub(super) fn absent(name: &str, file: &Path) -> String {
    // The empty name is the folder of the scene.
    if file.is_dir() {
        format!("\"{name}\" is a folder and no file")
    } else {
        format!("{name} is missing")
    }
}

/// Why more text is refused.
fn spent(text: &Budget) -> String {
    format!(
        "the scene has more than {} MiB of text, with all that is included and substituted; load a \
         file that has the materials alone",
        text.limit() >> 20
    )
}

/// A reader that takes what it reads from a budget.
pub(super) struct Metered<R> {
    input: R,
    budget: Budget,
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        if self.budget.take(count as u64) {
            Ok(count)
        } else {
            Err(io::Error::new(io::ErrorKind::FileTooLarge, spent(&self.budget)))
        }
    }
}

/// The files being read, from the scene's own to the innermost included one.
pub(super) struct Includes {
    open: Vec<PathBuf>,
    /// How many were included so far.
    count: usize,
    /// Each of those that were found, once.
    found: BTreeSet<PathBuf>,
    /// Bytes of text.
    text: Budget,
}

impl Includes {
    /// For a scene of `limit` bytes in all.
    pub(super) fn new(limit: u64) -> Self {
        Self { open: Vec::new(), count: 0, found: BTreeSet::new(), text: Budget::new(limit) }
    }

    /// Opens `file`, which `place` asks for. Each success must be followed by [`Self::leave`].
    ///
    /// Returns `false` if there is no such file, for which [`absent`] has words.
    pub(super) fn enter(&mut self, file: &Path, place: &Place) -> Result<bool, SceneError> {
        if self.count > limits::INCLUDES {
            return Err(place.too_large(format!(
                "the scene includes files more than {} times; include each once, and check for \
                 files that include the same one twice",
                limits::INCLUDES
            )));
        }
        self.count += 1;
        let Ok(path) = file.canonicalize() else {
            return Ok(false);
        };
        if path.is_dir() {
            return Ok(false);
        }
        if let Some(first) = self.open.iter().position(|open| *open == path) {
            let names: Vec<String> = self.open[first..]
                .iter()
                .chain([&path])
                .map(|file| file.file_name().unwrap_or_default().to_string_lossy().into_owned())
                .collect();
            return Err(place.invalid(format!(
                "the file includes itself: {}; remove one of these includes",
                names.join(" -> ")
            )));
        }
        if self.open.len() == MAX_DEPTH {
            return Err(place.invalid(format!(
                "files include each other more than {MAX_DEPTH} deep; include them from fewer levels"
            )));
        }
        if !self.open.is_empty() {
            self.found.insert(path.clone());
        }
        self.open.push(path);
        Ok(true)
    }

    /// The files that were included, without the scene's own.
    pub(super) fn found(&mut self) -> Vec<PathBuf> {
        std::mem::take(&mut self.found).into_iter().collect()
    }

    /// Closes the innermost file.
    pub(super) fn leave(&mut self) {
        self.open.pop();
    }

    /// The text of a file that `place` asks for.
    pub(super) fn text(&self, file: &Path, place: &Place) -> Result<String, SceneError> {
        let text = input::read_text(file, self.text.limit()).map_err(|error| {
            let place = Place::file(file);
            match error.kind() {
                io::ErrorKind::FileTooLarge => place.too_large(spent(&self.text)),
                _ => place.io(error),
            }
        })?;
        self.charge(text.len(), place)?;
        Ok(text)
    }

    /// Takes bytes that `place` adds to the text from what may still be read.
    pub(super) fn charge(&self, bytes: usize, place: &Place) -> Result<(), SceneError> {
        if self.text.take(bytes as u64) { Ok(()) } else { Err(place.too_large(spent(&self.text))) }
    }

    /// A reader of text that counts what it reads.
    pub(super) fn metered<R: Read>(&self, input: R) -> Metered<R> {
        Metered { input, budget: self.text.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readers_share_what_is_left() {
        let includes = Includes::new(3 << 20);
        let read = |count: u64| {
            io::copy(&mut includes.metered(io::repeat(b' ').take(count)), &mut io::sink())
        };
        assert_eq!(read(2 << 20).unwrap(), 2 << 20);
        let error = read(u64::MAX).unwrap_err().to_string();
        assert!(error.contains("more than 3 MiB"), "{error}");
        assert!(includes.charge(1, &Place::file(Path::new("a"))).is_err());
    }
}
