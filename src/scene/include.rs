//! Included files, and checks for circular inclusion.

use std::path::{Path, PathBuf};

use super::{Place, SceneError};

/// Deeper nesting than this is refused as a mistake.
const MAX_DEPTH: usize = 64;

/// The files being read, from the scene's own to the innermost included one.
#[derive(Default)]
pub(super) struct Includes {
    open: Vec<PathBuf>,
}

impl Includes {
    /// Opens `file`, which `place` asks for. Each success must be followed by [`Self::leave`].
    ///
    /// Returns `false` if there is no such file.
    pub(super) fn enter(&mut self, file: &Path, place: &Place) -> Result<bool, SceneError> {
        let Ok(path) = file.canonicalize() else {
            return Ok(false);
        };
        // The empty name is the folder of the scene.
        if path.is_dir() {
            return Err(place.invalid(format!(
                "includes \"{}\", which is a folder: name a file",
                file.display()
            )));
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
        self.open.push(path);
        Ok(true)
    }

    /// Closes the innermost file.
    pub(super) fn leave(&mut self) {
        self.open.pop();
    }
}
