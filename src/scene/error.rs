//! Places in a scene description, and its errors.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A place in a scene description.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The path of the file, as it was given.
    pub file: Arc<Path>,
    /// The line, from 1; `None` where the syntax keeps none (glTF) or the place is the whole file.
    pub line: Option<u32>,
    /// The column in bytes, from 1.
    pub column: Option<u32>,
}

impl Place {
    /// The whole of a file.
    pub(super) fn file(file: &Path) -> Self {
        Self { file: file.into(), line: None, column: None }
    }

    pub(super) fn invalid(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Invalid(message.into()) }
    }

    pub(super) fn syntax(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Syntax(message.into()) }
    }

    pub(super) fn io(&self, error: io::Error) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Io(error) }
    }
}

/// Where the lines of a text begin, to turn byte offsets into places.
pub(super) struct Lines {
    file: Arc<Path>,
    starts: Vec<usize>,
}

impl Lines {
    pub(super) fn new(file: &Path, text: &str) -> Self {
        let after_breaks = text.bytes().enumerate().filter(|&(_, b)| b == b'\n');
        Self {
            file: file.into(),
            starts: [0].into_iter().chain(after_breaks.map(|(i, _)| i + 1)).collect(),
        }
    }

    pub(super) fn place(&self, offset: usize) -> Place {
        let line = self.starts.partition_point(|&start| start <= offset);
        Place {
            file: self.file.clone(),
            line: u32::try_from(line).ok(),
            column: u32::try_from(offset - self.starts[line - 1] + 1).ok(),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        for number in [self.line, self.column].into_iter().flatten() {
            write!(f, ":{number}")?;
        }
        Ok(())
    }
}

/// Why a scene description was refused.
#[derive(Debug)]
pub struct SceneError {
    /// The place of the error.
    pub place: Place,
    /// The cause.
    pub kind: SceneErrorKind,
}

/// The kinds of [`SceneError`].
#[derive(Debug)]
pub enum SceneErrorKind {
    /// The file cannot be read.
    Io(io::Error),
    /// The file name's extension belongs to none of the formats; holds the extension.
    UnknownExtension(PathBuf),
    /// The text does not follow the format's grammar.
    Syntax(String),
    /// The text is well formed and says something impossible: a value out of range, a name that
    /// is not defined, files that include each other.
    Invalid(String),
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.place)?;
        match &self.kind {
            SceneErrorKind::Io(error) => write!(f, "cannot be read: {error}"),
            SceneErrorKind::UnknownExtension(extension) => write!(
                f,
                "no scene format has the extension \"{}\"; the formats are .toml (recipe), .pbrt and \
                 .pbrt.gz (pbrt-v4), .xml (Mitsuba 3), .gltf and .glb (glTF 2.0), .mtlx (MaterialX)",
                extension.display()
            ),
            SceneErrorKind::Syntax(message) | SceneErrorKind::Invalid(message) => {
                f.write_str(message)
            }
        }
    }
}

impl std::error::Error for SceneError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            SceneErrorKind::Io(error) => Some(error),
            _ => None,
        }
    }
}

/// The text "; did you mean `x`?" for the candidate closest to `word`, if one is close enough; else
/// empty.
///
/// Close enough is one edit in three letters; a transposition counts as one edit. The time grows
/// with the product of the lengths: words longer than names, and candidates after many, are left
/// out.
pub(super) fn did_you_mean(word: &str, candidates: &[&str]) -> String {
    let distance = |candidate: &str| {
        strsim::damerau_levenshtein(&word.to_lowercase(), &candidate.to_lowercase())
    };
    const LONGEST: usize = 64;
    const MOST: usize = 10_000;
    if word.len() > LONGEST {
        return String::new();
    }
    candidates
        .iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .take(MOST)
        .map(|&candidate| (distance(candidate), candidate))
        .filter(|&(d, candidate)| 3 * d <= candidate.len().max(word.len()).max(3))
        .min_by_key(|&(d, _)| d)
        .map_or_else(String::new, |(_, candidate)| format!("; did you mean `{candidate}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_counts_lines_and_columns_from_one() {
        let lines = Lines::new(Path::new("f"), "ab\ncd\n");
        let place = |offset| lines.place(offset).to_string();
        assert_eq!(place(0), "f:1:1");
        assert_eq!(place(4), "f:2:2");
        assert_eq!(place(6), "f:3:1");
        assert_eq!(Place::file(Path::new("f")).to_string(), "f");
    }

    #[test]
    fn only_near_words_are_suggested() {
        let keys = ["name", "sigma", "gamma", "fresnel", "masking"];
        assert_eq!(did_you_mean("gama", &keys), "; did you mean `gamma`?");
        assert_eq!(did_you_mean("Sigma", &keys), "; did you mean `sigma`?");
        assert_eq!(did_you_mean("frensel", &keys), "; did you mean `fresnel`?");
        assert_eq!(did_you_mean("colour", &keys), "");
        // The distance of these would take a terabyte.
        let long = "a".repeat(400_000);
        assert_eq!(did_you_mean(&long, &[&long]), "");
        assert_eq!(did_you_mean("sigmo", &[&long, "sigma"]), "; did you mean `sigma`?");
    }
}
