//! Positions in a scene description, and its errors.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fmt, io};

/// A position in a scene description.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The path of the file, as it was given.
    pub file: Arc<Path>,
    /// The line, from 1; `None` where the parser keeps none (glTF) and for a whole file.
    pub line: Option<u32>,
    /// The column in characters, from 1.
    pub column: Option<u32>,
}

impl Place {
    /// The whole of a file.
    pub fn file(file: &Path) -> Self {
        Self { file: file.into(), line: None, column: None }
    }

    /// The error of something impossible at this position.
    pub fn invalid(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Invalid(message.into()) }
    }

    /// The error of another kind of document, which begins at this position.
    pub fn foreign(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Foreign(message.into()) }
    }

    /// The error of more than is read.
    pub fn too_large(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::TooLarge(message.into()) }
    }

    /// The error of a text that does not follow the grammar of the format.
    pub fn syntax(&self, message: impl Into<String>) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Syntax(message.into()) }
    }

    /// The error of a file that cannot be read.
    pub fn io(&self, error: io::Error) -> SceneError {
        SceneError { place: self.clone(), kind: SceneErrorKind::Io(error) }
    }
}

/// Turns byte offsets in a text into positions. A line ends with a line feed, a carriage return, or
/// both.
pub struct Lines<'a> {
    file: Arc<Path>,
    text: &'a [u8],
    /// The counts before each block of [`BLOCK`] bytes, since a text may be one very long line, or
    /// nothing but ends of lines.
    blocks: Vec<Before>,
}

const BLOCK: usize = 1 << 10;

/// Counts of the text before an offset.
#[derive(Clone, Copy, Default)]
struct Before {
    /// Characters that begin before it.
    characters: usize,
    /// Lines that end before it, and the offset at which the next begins.
    lines: usize,
    start: usize,
}

impl<'a> Lines<'a> {
    /// For the text of a file.
    pub fn new(file: &Path, text: &'a [u8]) -> Self {
        let mut lines = Self { file: file.into(), text, blocks: vec![Before::default()] };
        for end in (BLOCK..=text.len()).step_by(BLOCK) {
            lines.blocks.push(lines.before(end));
        }
        lines
    }

    /// The position of a byte.
    pub fn place(&self, offset: usize) -> Place {
        let offset = offset.min(self.text.len());
        let Before { characters, lines, start } = self.before(offset);
        let column = characters - self.before(start).characters + 1;
        Place {
            file: self.file.clone(),
            line: u32::try_from(lines + 1).ok(),
            column: u32::try_from(column).ok(),
        }
    }

    /// The position that a parser states as a line, counted from 1 by line feeds alone, and a byte
    /// in that line, from 0.
    pub fn after_feeds(&self, line: usize, bytes: usize) -> Place {
        let lines = self.text.split_inclusive(|&byte| byte == b'\n');
        let start: usize = lines.take(line.saturating_sub(1)).map(<[u8]>::len).sum();
        self.place(start + bytes)
    }

    /// The counts before an offset, continued from those of the last known block.
    fn before(&self, offset: usize) -> Before {
        let block = (offset / BLOCK).min(self.blocks.len() - 1);
        let Before { mut characters, mut lines, mut start } = self.blocks[block];
        let from = block * BLOCK;
        characters += self::characters(&self.text[from..offset]);
        for i in from..offset {
            let is_end = match self.text[i] {
                b'\r' => self.text.get(i + 1) != Some(&b'\n'),
                byte => byte == b'\n',
            };
            if is_end {
                (lines, start) = (lines + 1, i + 1);
            }
        }
        Before { characters, lines, start }
    }
}

/// The number of characters that begin in some bytes of UTF-8.
pub fn characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte & 0xc0 != 0x80).count()
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
pub struct SceneError {
    /// The position of the error.
    pub place: Place,
    /// The cause.
    pub kind: SceneErrorKind,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.kind)
    }
}

impl std::error::Error for SceneError {
    /// The cause if a file could not be read; other kinds have their cause in the message.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.kind {
            SceneErrorKind::Io(why) => Some(why),
            _ => None,
        }
    }
}

/// The kinds of [`SceneError`].
#[derive(Debug, thiserror::Error)]
pub enum SceneErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Io(io::Error),
    /// The file name's extension belongs to none of the formats; holds the extension.
    #[error("{}", unknown_extension(.0))]
    UnknownExtension(PathBuf),
    /// The text does not follow the format's grammar.
    #[error("{0}")]
    Syntax(String),
    /// The text is well formed but impossible: a value out of range, a name that is not defined,
    /// files that include each other.
    #[error("{0}")]
    Invalid(String),
    /// The text is another kind of document than a scene: of XML with another root, for instance.
    #[error("{0}")]
    Foreign(String),
    /// The scene passes a limit of what is read.
    #[error("{0}")]
    TooLarge(String),
}

microfacet_core::debug_in_words!(SceneError);

fn unknown_extension(extension: &Path) -> String {
    let extension = extension.display().to_string();
    let what = match &extension[..] {
        "" => "the name has no extension, which says the format".into(),
        _ => format!("no scene format has the extension \"{extension}\""),
    };
    let usd = match &extension[..] {
        "usd" | "usda" | "usdc" | "usdz" => {
            "; export a USD scene as glTF, or its materials as MaterialX"
        }
        _ => "",
    };
    format!(
        "{what}; the formats are .toml (recipe), .pbrt and .pbrt.gz (pbrt-v4), .xml (Mitsuba 3), \
         .gltf and .glb (glTF 2.0), .mtlx (MaterialX){usd}"
    )
}

/// Names that other programs and papers give to a parameter, the key of a recipe, and their
/// relation.
const SYNONYMS: [(&[&str], &str, &str); 5] = [
    (
        &["alpha", "m", "rough", "roughness"],
        "sigma",
        "sigma is the alpha of GGX and the m of Beckmann; a perceptual roughness, as in glTF, is \
         the square root of sigma",
    ),
    (&["shape"], "gamma", "gamma is the shape: 2 is GGX, inf is Beckmann"),
    (&["alpha", "sigma", "m", "roughness"], "c", "c is the alpha of GGX"),
    (&["alpha", "sigma", "roughness"], "m", "m is the alpha of Beckmann"),
    (&["exponent", "shininess"], "n", "n is the exponent of the cosine"),
];

/// The text "; did you mean `x`?" for the key of which `word` is another name, with their relation,
/// else for the closest key, if one is close enough; else empty.
#[must_use]
pub fn did_you_mean_key(word: &str, keys: &[&str]) -> String {
    synonym(word, keys).unwrap_or_else(|| did_you_mean(word, keys))
}

/// The hint for a word that is another name of a key; the axis of `alpha_x` or `roughness_v` is
/// kept where the keys have it.
fn synonym(word: &str, keys: &[&str]) -> Option<String> {
    let word = word.to_lowercase();
    let axes = [("_x", "_x"), ("_y", "_y"), ("_u", "_x"), ("_v", "_y")];
    let axis = axes.iter().find_map(|(end, axis)| Some((word.strip_suffix(end)?, *axis)));
    let stem = axis.map_or(&word[..], |(stem, _)| stem);
    let of = |(words, name, relation): &(&[&str], &str, &str)| {
        let of_axis = format!("{name}{}", axis.map_or("_x", |(_, axis)| axis));
        let is_key = |wanted: &str| keys.iter().find(|key| key.trim_start_matches('-') == wanted);
        let key = is_key(name).or_else(|| is_key(&of_axis)).filter(|_| words.contains(&stem))?;
        Some(format!("; did you mean `{key}`? {relation}"))
    };
    SYNONYMS.iter().find_map(of)
}

/// Number of candidates that are compared with one word; more are left out.
pub const MOST_CANDIDATES: usize = 10_000;

/// The text "; did you mean `x`?" for the candidate closest to `word`, if one is close enough; else
/// empty.
///
/// Close enough is one edit in three letters; a transposition counts as one edit. Since the time
/// grows with the product of the lengths, words and candidates of more than 64 bytes are left out.
pub fn did_you_mean(word: &str, candidates: &[&str]) -> String {
    let distance = |candidate: &str| {
        strsim::damerau_levenshtein(&word.to_lowercase(), &candidate.to_lowercase())
    };
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return String::new();
    }
    candidates
        .iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .take(MOST_CANDIDATES)
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
        let lines = Lines::new(Path::new("f"), b"ab\ncd\n");
        let place = |offset| lines.place(offset).to_string();
        assert_eq!(place(0), "f:1:1");
        assert_eq!(place(4), "f:2:2");
        assert_eq!(place(6), "f:3:1");
        assert_eq!(Place::file(Path::new("f")).to_string(), "f");
    }

    #[test]
    fn lines_end_with_either_character_or_both() {
        let text = "a\rb\r\nc\n\rd";
        let lines = Lines::new(Path::new("f"), text.as_bytes());
        for (word, place) in [("a", "f:1:1"), ("b", "f:2:1"), ("c", "f:3:1"), ("d", "f:5:1")] {
            assert_eq!(lines.place(text.find(word).unwrap()).to_string(), place, "{word}");
        }
        // The parser's second line begins with c, and its third with the carriage return.
        assert_eq!(lines.after_feeds(2, 0).to_string(), "f:3:1");
        assert_eq!(lines.after_feeds(3, 1).to_string(), "f:5:1");
    }

    #[test]
    fn columns_are_characters() {
        // Blocks end within characters of two and three bytes.
        let text = format!("é\n{}x", "é∞".repeat(3 * BLOCK));
        let lines = Lines::new(Path::new("f"), text.as_bytes());
        let columns = text.char_indices().skip(2).enumerate();
        for (i, (offset, _)) in columns {
            assert_eq!(lines.place(offset).column, u32::try_from(i + 1).ok(), "byte {offset}");
        }
        // The end of whole blocks.
        let text = [b'a'; BLOCK];
        assert_eq!(Lines::new(Path::new("f"), &text).place(BLOCK).column, Some(1025));
        // A carriage return ends one block, and its line feed begins the next.
        let text = [&[b'a'; BLOCK - 1][..], b"\r\nb"].concat();
        let lines = Lines::new(Path::new("f"), &text);
        assert_eq!(lines.place(BLOCK).to_string(), "f:1:1025");
        assert_eq!(lines.place(BLOCK + 1).to_string(), "f:2:1");
    }

    #[test]
    fn other_names_are_known_with_their_relation() {
        let recipe = ["name", "sigma", "gamma"];
        for word in ["alpha", "Alpha", "alpha_x", "roughness", "rough", "m", "roughness_v"] {
            let hint = did_you_mean_key(word, &recipe);
            assert!(
                hint.starts_with("; did you mean `sigma`? sigma is the alpha"),
                "{word}: {hint}"
            );
        }
        assert!(did_you_mean_key("shape", &recipe).contains("`gamma`?"));
        let columns = ["sigma_x", "sigma_y", "gamma"];
        for (word, column) in [("alpha", "_x"), ("alpha_x", "_x"), ("alpha_v", "_y")] {
            assert!(
                did_you_mean_key(word, &columns).contains(&format!("`sigma{column}`?")),
                "{word}"
            );
        }
        // Other distributions have parameters of their own.
        assert!(did_you_mean_key("roughness", &["name", "c"]).contains("`c`? c is the alpha"));
        assert!(did_you_mean_key("exponent", &["name", "n"]).contains("`n`?"));
        // `sigma`, the key that `roughness` stands for, is not among the keys.
        assert_eq!(did_you_mean_key("roughness", &["name", "sigma0"]), "");
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
