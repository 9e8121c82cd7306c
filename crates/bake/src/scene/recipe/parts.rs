//! The parts of a recipe that are parsed one by one, so that memory holds the tree of one alone.
//!
//! A part is a `[[material]]` with all that follows it up to the next. The tree of a part does not
//! depend on the parts before it, since nothing but materials may stand at the top of a recipe. The
//! first part has all that comes before the second header, so that the parser itself sees whether
//! `material` was something else before the first.

use std::ops::Range;

use toml_parser::Source;
use toml_parser::lexer::{Token, TokenKind};

/// The parts of `text`, in order; together they are all of it.
pub(super) fn parts(text: &str) -> Vec<Range<usize>> {
    let inner: Vec<usize> = headers(text).skip(1).collect();
    let starts = [0].into_iter().chain(inner.iter().copied());
    let ends = inner.iter().copied().chain([text.len()]);
    starts.zip(ends).map(|(start, end)| start..end).collect()
}

/// What the tokens of a line, or of several if brackets are open, are part of.
#[derive(Clone, Copy)]
enum Within {
    /// Nothing yet.
    Start,
    /// What may become a `[[material]]` that begins there: the tokens that it still lacks.
    Header(usize, &'static [TokenKind]),
    /// The rest of a line.
    Line,
    /// A key and its value, with so many brackets open.
    Value(usize),
}

/// What follows the first bracket of a header, white space apart.
const HEADER: [TokenKind; 4] = [
    TokenKind::LeftSquareBracket,
    TokenKind::Atom,
    TokenKind::RightSquareBracket,
    TokenKind::RightSquareBracket,
];

/// Where each `[[material]]` begins. Of a text that is not TOML, all before the first error.
///
/// A key in quotes is not looked for: `[["material"]]` stays in the part of the material before it.
fn headers(text: &str) -> impl Iterator<Item = usize> {
    let mut within = Within::Start;
    Source::new(text).lex().filter_map(move |token| {
        let mut found = None;
        within = match (within, token.kind()) {
            (
                Within::Start | Within::Line | Within::Header(..) | Within::Value(0),
                TokenKind::Newline,
            ) => Within::Start,
            (Within::Start | Within::Header(..), TokenKind::Whitespace) => within,
            (Within::Start, TokenKind::LeftSquareBracket) => {
                Within::Header(token.span().start(), &HEADER)
            }
            (Within::Header(start, [next, rest @ ..]), kind)
                if kind == *next && is_part(text, token) =>
            {
                found = rest.is_empty().then_some(start);
                Within::Header(start, rest)
            }
            (Within::Header(..) | Within::Line, _) => Within::Line,
            (Within::Start, _) => Within::Value(0),
            (Within::Value(open), TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket) => {
                Within::Value(open + 1)
            }
            (Within::Value(open), TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket) => {
                Within::Value(open.saturating_sub(1))
            }
            (Within::Value(open), _) => Within::Value(open),
        };
        found
    })
}

/// Whether a token of the right kind is one of a header: its key is `material`.
fn is_part(text: &str, token: Token) -> bool {
    token.kind() != TokenKind::Atom
        || text.get(token.span().start()..token.span().end()) == Some("material")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::super::{read, read_parts};
    use super::*;

    /// What is read, or the message, part by part and at once.
    fn both(text: &str) -> [String; 2] {
        let file = Path::new("r");
        [read(text, file), read_parts(text, file, Some(0..text.len()), 100)].map(|outcome| {
            match outcome {
                Ok(scene) => format!("{scene:?}"),
                Err(why) => format!("refused: {why}"),
            }
        })
    }

    const A: &str = "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\n";
    const B: &str = "[[ material ]] # b\nname = \"b\"\nsigma = [0.3,\n\n 0.1]\ngamma = 3\n";

    /// Texts that may stand between materials: some belong there, and some do not.
    const ODD: [&str; 48] = [
        "",
        "\u{feff}",
        "# [[material]]\n",
        "[material.fresnel]\nschlick = 0.04\n",
        "[material.sigma]\nmin = 0.1\n",
        "[[material.fresnel]]\nschlick = 0.04\n",
        "[material]\nname = \"c\"\n",
        "[[\"material\"]]\nname = \"c\"\nsigma = 1\ngamma = 2\n",
        "[['material']]\nname = 'c'\nsigma = 1\ngamma = 2\n",
        "[[\"\\u006daterial\"]]\nname = 'c'\nsigma = 1\ngamma = 2\n",
        "  [[\tmaterial]]\nname = 'c'\nsigma = 1\ngamma = 2\n",
        "[[material]]\r\nname = 'c'\r\nsigma = 1\r\ngamma = 2\r\n",
        "[[material]]\nname = 'a'\nsigma = 1\ngamma = 2\n",
        "[[material]]\n",
        "[[material]] x = 1\n",
        "[[material]\n",
        "[[material\n",
        "[ [material]]\n",
        "[[material] ]\n",
        "[[material]]]\n",
        "[[[material]]]\n",
        "[[material.a]]\n",
        "[[a.material]]\n",
        "[[]]\n",
        "[[materials]]\nname = 'c'\n",
        "[other]\nx = 1\n",
        "material = 3\n",
        "material = []\n",
        "material = [{ name = 'c', sigma = 1, gamma = 2 }]\n",
        "material = [\n[[material]]\n]\n",
        "material.name = 3\n",
        "\"material\" = 3\n",
        "name = 'twice'\n",
        "gama = 3\n",
        "masking = \"\"\"\n[[material]]\n\"\"\"\n",
        "masking = \'\'\'\n[[material]]\nname = 'c'\'\'\'\n",
        "masking = \"\"\"\n[[material]]\n",
        "masking = \"open\n",
        "theta = [0.1,\n[[material]]\n, 0.2]\n",
        "theta = [0.1, # ]\n  -0.2,\n\n# [[material]]\n0.5]\n",
        "theta = [0.1, 0.2\n",
        "theta = [0.1, 0.2}\n",
        "theta = ]\n",
        "fresnel = { schlick = 0.04\n}\n",
        "masking =\n",
        "masking\n",
        "= 3\n",
        "masking = \"uncorrelated\"\r",
    ];

    #[test]
    fn parts_read_as_the_whole_does() {
        let mut differ = Vec::new();
        for odd in ODD {
            let cut = &odd[..odd.char_indices().next_back().map_or(0, |(last, _)| last)];
            for text in [
                odd.to_owned(),
                format!("{odd}{A}{B}"),
                format!("{A}{odd}{B}"),
                format!("{A}{B}{odd}"),
                format!("{A}{cut}"),
                format!("{A}{B}{cut}"),
            ] {
                let [parts, whole] = both(&text);
                if parts != whole {
                    differ.push(format!("{text}\n---\n{parts}\n{whole}\n"));
                }
            }
        }
        assert!(differ.is_empty(), "{}", differ.concat());
    }

    #[test]
    fn recipes_that_are_shipped_read_as_the_whole_does() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folders = ["tables/recipes", "fuzz/seeds/recipe"];
        let files =
            folders.iter().flat_map(|folder| std::fs::read_dir(root.join(folder))).flatten();
        let texts: Vec<String> =
            files.map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap()).collect();
        assert!(texts.len() > 5 && texts.iter().any(|text| parts(text).len() > 2));
        for text in texts {
            let [parts, whole] = both(&text);
            assert_eq!(parts, whole, "{text}");
        }
    }

    #[test]
    fn a_second_error_may_be_named_instead_but_none_is_missed() {
        let mut rng = StdRng::seed_from_u64(1);
        let mut read = 0;
        for _ in 0..3000 {
            let texts = (0..rng.random_range(1..6)).map(|i| match rng.random_range(0..3) {
                0 => ODD[rng.random_range(0..ODD.len())].to_owned(),
                _ => [A, B][i % 2].replace("name = \"", &format!("name = \"{i}")),
            });
            let text: String = texts.collect();
            let [parts, whole] = both(&text);
            if parts.starts_with("refused: ") {
                assert!(whole.starts_with("refused: "), "{text}\n{parts}");
            } else {
                assert_eq!(parts, whole, "{text}");
                read += 1;
            }
        }
        assert!(read > 500, "{read}");
    }

    #[test]
    fn the_number_of_materials_is_limited_over_all_parts() {
        let text = [A, B].concat();
        let most = |most| read_parts(&text, Path::new("r"), parts(&text), most);
        assert_eq!(most(2).unwrap().materials.len(), 2);
        let message = most(1).unwrap_err().to_string();
        assert_eq!(message, "r: the recipe has more than 1 materials; split it");
    }

    #[test]
    fn each_header_begins_a_part() {
        let text =
            format!("# first\n{A}[material.fresnel]\nschlick = 1\n{B}x = \"[[material]]\"\n{A}");
        let found: Vec<&str> = parts(&text).into_iter().map(|part| &text[part]).collect();
        assert_eq!(found.len(), 3);
        assert!(found[0].ends_with("schlick = 1\n") && found[1].starts_with("[[ material ]]"));
        assert_eq!((found.concat(), found[2]), (text.clone(), A));
    }
}
