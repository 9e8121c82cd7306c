//! The text of a scene and of the files that it includes: checks for circular inclusion, and one
//! limit of size for all, since a few files that include each other twice come to any size.

use std::collections::BTreeSet;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use microfacet_baker::input;
use microfacet_baker::scene::{Lines, Place};

use crate::Result;
use crate::builder::Builder;
use crate::limits::{self, Budget};

/// The files being read, from the scene's own to the innermost included one.
pub(super) struct Includes {
    open: Vec<PathBuf>,
    /// How many files were included so far.
    count: usize,
    /// The included files that were found, each once.
    found: BTreeSet<PathBuf>,
    /// Bytes of text.
    text: Budget,
}

impl Includes {
    /// The scene may have `limit` bytes of text in all.
    pub(super) fn new(limit: u64) -> Self {
        Self { open: Vec::new(), count: 0, found: BTreeSet::new(), text: Budget::new(limit) }
    }

    /// The text of the scene's own file.
    pub(super) fn open(&mut self, file: &Path) -> Result<Vec<u8>> {
        let place = Place::file(file);
        // A folder is an error here; an included folder only gives a warning.
        input::open(file, u64::MAX).map_err(|error| place.io(error))?;
        self.enter(file, &place)?;
        self.text(file, &place)
    }

    /// The text of a file that `place` includes under a name, to be followed by [`Self::leave`];
    /// `None`, with a warning that ends with `said`, if there is no such file.
    pub(super) fn include(
        &mut self,
        (name, file): (&str, &Path),
        place: &Place,
        builder: &mut Builder,
        said: &str,
    ) -> Result<Option<Vec<u8>>> {
        if self.enter(file, place)? {
            return self.text(file, place).map(Some);
        }
        builder.warn(
            place,
            // The empty name is the folder of the scene.
            match file.is_dir() {
                true => format!("\"{name}\" is a folder and no file; {said}"),
                false => format!("{name} is missing; {said}"),
            },
        );
        Ok(None)
    }

    /// Closes the innermost file.
    pub(super) fn leave(&mut self) {
        self.open.pop();
    }

    /// The files that were included, without the scene's own.
    pub(super) fn found(self) -> Vec<PathBuf> {
        self.found.into_iter().collect()
    }

    /// Opens `file`, which `place` includes; `false` if there is no such file.
    fn enter(&mut self, file: &Path, place: &Place) -> Result<bool> {
        if self.count > limits::INCLUDES {
            return Err(place.too_large(format!(
                "the scene includes files more than {} times; include each once, and check for \
                 files that include the same one twice",
                limits::INCLUDES
            )));
        }
        self.count += 1;
        let Some(path) = file.canonicalize().ok().filter(|path| !path.is_dir()) else {
            return Ok(false);
        };
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
        if self.open.len() == limits::DEPTH {
            return Err(place.invalid(format!(
                "files include each other more than {} deep; include them from fewer levels",
                limits::DEPTH
            )));
        }
        if !self.open.is_empty() {
            self.found.insert(path.clone());
        }
        self.open.push(path);
        Ok(true)
    }

    /// The text of a file, unpacked, without its byte order mark.
    fn text(&self, file: &Path, place: &Place) -> Result<Vec<u8>> {
        let mut text = Vec::new();
        // One byte above the limit shows that the text is too long.
        let most = self.text.left() + 1;
        let read = match file.extension().is_some_and(|extension| extension == "gz") {
            true => input::open(file, u64::MAX)
                .and_then(|file| MultiGzDecoder::new(file).take(most).read_to_end(&mut text)),
            false => {
                input::open(file, most).and_then(|file| file.take(most).read_to_end(&mut text))
            }
        };
        match read {
            Err(error) if error.kind() == io::ErrorKind::FileTooLarge => {
                return Err(place.too_large(format!(
                    "{}; {} is the last file",
                    self.spent(),
                    file.display()
                )));
            }
            Err(error) if text.is_empty() => return Err(Place::file(file).io(error)),
            // A packed file is damaged where its unpacked text ends.
            read => read.map_err(|error| Lines::new(file, &text).place(text.len()).io(error))?,
        };
        self.charge(text.len(), place)?;
        let mark = text.len() - input::unmarked(&text).len();
        text.drain(..mark);
        Ok(text)
    }

    /// Counts bytes of text, which `place` adds, towards the limit.
    pub(super) fn charge(&self, bytes: usize, place: &Place) -> Result<()> {
        if self.text.take(bytes as u64) { Ok(()) } else { Err(place.too_large(self.spent())) }
    }

    fn spent(&self) -> String {
        format!(
            "the scene has more than {} MiB of text, with all that is included and substituted; \
             load a file that has the materials alone",
            self.text.limit() >> 20
        )
    }
}
