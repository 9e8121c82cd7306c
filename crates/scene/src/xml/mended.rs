//! XML that is not well formed, and that renderers read all the same.
//!
//! Their parsers do not check namespaces, take a raw "<" or "&" in an attribute as a character, and
//! a declaration wherever it stands. All are found in MaterialX documents: prefixes that nothing
//! declares, tokens such as `<UDIM>` in file names, "this & that" in a description, and a space
//! before `<?xml`. Such a text is mended where the parser stops, and parsed again; places stay
//! those of the text as it was written.

use std::borrow::Cow;

use roxmltree::{Error, TextPos};

use crate::limits;

/// A text, with what it takes for the parser to accept it.
pub(super) struct Mended<'a> {
    source: &'a str,
    text: Cow<'a, str>,
    /// Declarations of namespaces for the root element, and how many.
    declared: (String, usize),
    /// Whether the tokens are escaped.
    escaped: bool,
    /// Whether ampersands that begin no reference are escaped.
    ampersands: bool,
    /// Whether the declaration is made an instruction of another name, which may stand anywhere.
    renamed: bool,
    /// For each place where text was added: its end in `text`, and all bytes added up to there.
    added: Vec<(usize, usize)>,
}

impl<'a> Mended<'a> {
    pub(super) fn new(source: &'a str) -> Self {
        Self {
            source,
            text: Cow::Borrowed(source),
            declared: (String::new(), 0),
            escaped: false,
            ampersands: false,
            renamed: false,
            added: Vec::new(),
        }
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Mends what the parser's error complains about; `false` if that is not possible.
    pub(super) fn mend(&mut self, error: &Error) -> bool {
        match error {
            Error::UnknownNamespace(prefix, _) if root_name_end(self.source).is_some() => {
                let (text, count) = &mut self.declared;
                // Each prefix has a namespace of its own, or attributes would be the same twice.
                *text += &format!(" xmlns:{prefix}=\"undeclared:{count}\"");
                *count += 1;
            }
            Error::UnexpectedDeclaration(_) if !self.renamed => self.renamed = true,
            Error::MalformedEntityReference(_) | Error::UnknownEntityReference(..)
                if !self.ampersands && are_some(ampersands(self.source)) =>
            {
                self.ampersands = true;
            }
            _ if !self.escaped && are_some(tokens(self.source)) => self.escaped = true,
            _ => return false,
        }
        self.rebuild();
        true
    }

    fn rebuild(&mut self) {
        // Where something is put, what, and how many bytes it replaces.
        let mut edits: Vec<(usize, &str, usize)> = Vec::new();
        if let Some(at) = root_name_end(self.source) {
            edits.push((at, &self.declared.0, 0));
        }
        if self.escaped {
            edits.extend(tokens(self.source).map(|at| (at, "&lt;", "<".len())));
        }
        if self.ampersands {
            edits.extend(ampersands(self.source).map(|at| (at, "amp;", 0)));
        }
        if self.renamed
            && let Some(at) = self.source.find(DECLARATION)
        {
            edits.push((at + DECLARATION.len(), "-", 0));
        }
        // An ampersand may stand before a token, of which the first character is replaced.
        edits.sort_unstable_by_key(|&(at, _, replaced)| (at, replaced));
        let (mut text, mut from, mut sum) = (String::new(), 0, 0);
        self.added.clear();
        for (at, put, replaced) in edits {
            text += &self.source[from..at];
            text += put;
            from = at + replaced;
            sum += put.len() - replaced;
            self.added.push((text.len(), sum));
        }
        text += &self.source[from..];
        self.text = Cow::Owned(text);
    }

    /// The offset in the source of an offset in the text.
    pub(super) fn original(&self, offset: usize) -> usize {
        let before = self.added.partition_point(|&(end, _)| end <= offset);
        offset - before.checked_sub(1).map_or(0, |last| self.added[last].1)
    }

    /// The offset in the source of a place in the text, whose rows end with line feeds and whose
    /// columns are characters, both from 1.
    pub(super) fn offset(&self, at: TextPos) -> usize {
        let mut rows = self.text.split_inclusive('\n');
        let before = rows.by_ref().take(at.row as usize - 1).map(str::len).sum::<usize>();
        let row = rows.next().unwrap_or_default();
        let within = row.chars().take(at.col as usize - 1).map(char::len_utf8).sum::<usize>();
        self.original(before + within)
    }
}

const DECLARATION: &str = "<?xml";

/// Where tokens begin that stand for a part of a file's name, such as `<UDIM>` and `<geometry
/// token>` (MaterialX specification, "Filename Substitutions"): a word in angle brackets within an
/// attribute.
fn tokens(text: &str) -> impl Iterator<Item = usize> {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | ':' | '.' | '-' | ' ');
    // The last character that is no space, and whether the last quote of the line follows an equals
    // sign and thus begins a value.
    let (mut last, mut opened) = (' ', false);
    text.char_indices().filter_map(move |(at, c)| {
        match c {
            '"' | '\'' => opened = last == '=',
            '\n' => opened = false,
            _ => {}
        }
        if !c.is_whitespace() {
            last = c;
        }
        let is_token = || text[at + 1..].trim_start_matches(is_word).starts_with('>');
        (c == '<' && opened && is_token()).then_some(at)
    })
}

/// The places behind ampersands that begin no reference, neither to an entity that XML declares nor
/// to a character by its number.
fn ampersands(text: &str) -> impl Iterator<Item = usize> {
    text.match_indices('&').map(|(at, _)| at + 1).filter(|&at| !is_reference(&text[at..]))
}

/// Whether the text behind an ampersand makes it a reference.
fn is_reference(text: &str) -> bool {
    let Some(number) = text.strip_prefix('#') else {
        return ["amp;", "lt;", "gt;", "quot;", "apos;"].iter().any(|name| text.starts_with(name));
    };
    let (digits, radix) = number.strip_prefix('x').map_or((number, 10), |digits| (digits, 16));
    let end = digits.find(|c: char| !c.is_digit(radix)).unwrap_or(digits.len());
    let character = u32::from_str_radix(&digits[..end], radix).ok().and_then(char::from_u32);
    // The characters of XML 1.0 (2.2).
    let is_of_xml = |c| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    character.is_some_and(is_of_xml) && digits[end..].starts_with(';')
}

/// Whether there are any, and no more than are mended.
fn are_some(places: impl Iterator<Item = usize>) -> bool {
    (1..=limits::XML_MENDED).contains(&places.take(limits::XML_MENDED + 1).count())
}

/// Where the name of the root element ends.
fn root_name_end(text: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let start = from + text[from..].find('<')? + 1;
        let rest = &text[start..];
        let end = match rest.as_bytes() {
            [b'!', b'-', b'-', ..] => "-->",
            [b'?', ..] => "?>",
            [b'!', ..] => ">",
            _ => {
                let is_end = |c: char| c.is_whitespace() || matches!(c, '>' | '/');
                return Some(start + rest.find(is_end)?);
            }
        };
        from = start + rest.find(end)? + end.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_follows_the_prolog() {
        let text = "<?xml version='1.0'?>\n<!-- <a> --><root x='1'/>";
        assert_eq!(root_name_end(text), text.find(" x="));
        assert_eq!(root_name_end("<!-- <a>"), None);
    }

    #[test]
    fn a_token_stands_in_an_attribute() {
        let text = "<a file=\"<u>_<my token>.png\" b=''><c>'<d>'</c></a>\n<e f='it''s <UDIM>'/>";
        let found: Vec<&str> =
            tokens(text).map(|at| &text[at..at + text[at..].find('>').unwrap()]).collect();
        assert_eq!(found, ["<u", "<my token"]);
    }

    #[test]
    fn an_ampersand_may_begin_a_reference() {
        let references = "&amp;&lt;&gt;&quot;&apos;&#38;&#x26;&#xaF;";
        assert_eq!(ampersands(references).next(), None);
        let raw = "& &&nbsp;&amp &#;&#x;&#38&#3a;&#xg;&ampere;&";
        assert_eq!(ampersands(raw).count(), raw.matches('&').count());
        assert_eq!(ampersands("é&amp;& ").collect::<Vec<_>>(), ["é&amp;&".len()]);
    }

    #[test]
    fn offsets_are_those_of_the_source() {
        let source = " <?xml version='1.0'?><a><b é='&<UDIM> & &amp; &'/>\n<c:d e='&f;'/></a>";
        let mut mended = Mended::new(source);
        while let Err(error) = roxmltree::Document::parse(mended.text()).map(|_| ()) {
            assert!(mended.mend(&error), "{error}");
        }
        let document = roxmltree::Document::parse(mended.text()).unwrap();
        for (name, at) in [("a", "<a"), ("b", "<b"), ("d", "<c:d")] {
            let node = document
                .descendants()
                .find(|node| node.has_tag_name(name) || node.tag_name().name() == name);
            let start = node.unwrap().range().start;
            assert_eq!(mended.original(start), source.find(at).unwrap(), "{name}");
        }
    }
}
