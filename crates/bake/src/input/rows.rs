//! The rows of a CSV, each with the line on which it begins.

use std::collections::VecDeque;
use std::io::{self, Read};

use super::{Limited, MAX_ROW, Unmarked, unmarked_stream};

/// A row: its fields without the spaces around them.
#[derive(Clone, Debug)]
pub struct Row {
    /// The line on which it begins, from 1, as an editor counts.
    pub line: u64,
    /// The fields.
    pub fields: csv::StringRecord,
}

/// Why a row was refused.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {why}")]
pub struct RowError {
    /// The line on which it begins, from 1.
    pub line: u64,
    /// The reason.
    pub why: String,
}

impl RowError {
    pub(crate) fn new(line: u64, why: impl Into<String>) -> Self {
        Self { line, why: why.into() }
    }
}

microfacet_core::debug_in_words!(RowError);

/// Reads a CSV row by row, each of at most [`MAX_ROW`] bytes.
///
/// A byte order mark and blank lines are skipped. The header, if there is one, is a row like any
/// other.
#[derive(Debug)]
pub struct Rows<R> {
    reader: csv::Reader<Numbered<Limited<Unmarked<R>>>>,
}

impl<R: Read> Rows<R> {
    /// Reads a stream, in which lines that begin with the byte `comment` are skipped.
    ///
    /// # Errors
    /// [`RowError`] if the stream fails at once.
    pub fn new(input: R, comment: Option<u8>) -> Result<Self, RowError> {
        let input = unmarked_stream(input).map_err(|why| RowError::new(1, why.to_string()))?;
        let reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(comment)
            .from_reader(Numbered::new(Limited::new(input, MAX_ROW), comment));
        Ok(Self { reader })
    }

    /// Bytes of the rows that were read.
    pub fn bytes(&self) -> u64 {
        self.reader.position().byte()
    }

    /// The next row; `None` at the end.
    ///
    /// # Errors
    /// [`RowError`] for a stream that fails, text that is not UTF-8, a row that is too long, or a
    /// quote that is never closed.
    pub fn read(&mut self) -> Result<Option<Row>, RowError> {
        loop {
            self.reader.get_mut().input.restart();
            let start = self.bytes();
            let mut fields = csv::StringRecord::new();
            let found = self.reader.read_record(&mut fields);
            let line = self.reader.get_mut().line_from(start);
            let found = found.map_err(|error| match error.into_kind() {
                csv::ErrorKind::Io(why) => RowError::new(line, why.to_string()),
                _ => RowError::new(line, "is no text in UTF-8"),
            })?;
            if !found {
                return Ok(None);
            }
            // An unquoted row ends at its line break, so only an open quote takes in all `ENDS`.
            if self.bytes() == self.reader.get_ref().bytes + ENDS {
                return Err(RowError::new(line, "a quote is opened here and never closed"));
            }
            // A line of spaces is blank.
            if fields.len() > 1 || !fields[0].is_empty() {
                return Ok(Some(Row { line, fields }));
            }
        }
    }
}

/// Line breaks that are appended to the text: an unclosed quote takes in all of them.
const ENDS: u64 = 2;

/// A stream that notes where the lines of its text begin.
#[derive(Debug)]
struct Numbered<R> {
    input: R,
    comment: Option<u8>,
    /// Bytes and line breaks of the text so far.
    bytes: u64,
    breaks: u64,
    last: u8,
    /// Line breaks still to put after the text.
    ends: u64,
    /// Byte and number of the lines from which rows may still be read: neither empty nor comments.
    lines: VecDeque<(u64, u64)>,
}

impl<R> Numbered<R> {
    fn new(input: R, comment: Option<u8>) -> Self {
        Self { input, comment, bytes: 0, breaks: 0, last: b'\n', ends: ENDS, lines: [].into() }
    }

    /// The line of the first row from a byte on, or where there is none the last line so far.
    fn line_from(&mut self, byte: u64) -> u64 {
        while self.lines.front().is_some_and(|&(start, _)| start < byte) {
            self.lines.pop_front();
        }
        self.lines.front().map_or(self.breaks + 1, |&(_, line)| line)
    }

    fn note(&mut self, byte: u8) {
        let ends = |byte| matches!(byte, b'\r' | b'\n');
        if ends(byte) {
            // A carriage return and a line feed are one break.
            self.breaks += u64::from(!(byte == b'\n' && self.last == b'\r'));
        } else if ends(self.last) && self.comment != Some(byte) {
            self.lines.push_back((self.bytes, self.breaks + 1));
        }
        self.last = byte;
        self.bytes += 1;
    }
}

impl<R: Read> Read for Numbered<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(to)?;
        if count == 0 {
            let ends = to.iter_mut().take(self.ends as usize).map(|byte| *byte = b'\n').count();
            self.ends -= ends as u64;
            return Ok(ends);
        }
        for byte in &mut to[..count] {
            self.note(*byte);
            // The parser ends a comment with a line feed alone.
            if self.comment.is_some() && *byte == b'\r' {
                *byte = b'\n';
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines and fields of the rows, and the error after them if there is one.
    fn rows(text: &str) -> (Vec<(u64, String)>, Option<RowError>) {
        let mut rows = Rows::new(text.as_bytes(), Some(b'#')).unwrap();
        let mut read = Vec::new();
        loop {
            match rows.read() {
                Ok(Some(Row { line, fields })) => {
                    read.push((line, fields.iter().collect::<Vec<_>>().join("|")));
                }
                Ok(None) => return (read, None),
                Err(error) => return (read, Some(error)),
            }
        }
    }

    #[test]
    fn a_row_has_the_line_that_an_editor_shows() {
        let text = "\u{feff}# a comment\n\na, b\n#\n  \n\n\"1\n\n2\",3\n4,5";
        let expected = [(3, "a|b"), (7, "1\n\n2|3"), (10, "4|5")];
        for end in ["\n", "\r\n", "\r"] {
            let (read, error) = rows(&text.replace('\n', end));
            let lines: Vec<u64> = read.iter().map(|(line, _)| *line).collect();
            assert_eq!((lines, error), (expected.map(|(line, _)| line).into(), None), "{end:?}");
        }
        assert_eq!(rows(text).0, expected.map(|(line, fields)| (line, fields.to_owned())));
    }

    #[test]
    fn line_breaks_in_quotes_are_kept_and_bytes_are_those_of_the_text() {
        let text = "a,\"b\r\nc\"\r\n1,2\r\n";
        let mut rows = Rows::new(text.as_bytes(), None).unwrap();
        assert_eq!(&rows.read().unwrap().unwrap().fields[1], "b\r\nc");
        rows.read().unwrap();
        assert!(rows.read().unwrap().is_none());
        // Including the line feeds that are appended.
        assert_eq!(rows.bytes(), text.len() as u64 + ENDS);
    }

    #[test]
    fn a_text_without_rows_has_none() {
        for text in ["", "\u{feff}", "\n\n", "#", "  \r\n"] {
            assert_eq!(rows(text), (vec![], None), "{text:?}");
        }
    }

    #[test]
    fn an_open_quote_is_refused_where_it_begins() {
        for text in ["a\n\n\"1,2\n3,4\n", "a\n\n1,\"2", "a\n\n1,\"2\"\"", "a\n\n1,\"2\n\n\n"] {
            let (read, error) = rows(text);
            assert_eq!(read.len(), 1, "{text:?}");
            assert_eq!(error.map(|error| error.line), Some(3), "{text:?}");
        }
        // These quotes are closed.
        for text in ["\"1\n\"", "\"1\n\n\"\n", "\"1\"\r", "\"1\"\r\n", "1\"", "1,\"\""] {
            assert_eq!((rows(text).0.len(), rows(text).1), (1, None), "{text:?}");
        }
    }

    #[test]
    fn text_that_is_not_utf_8_has_its_line() {
        let mut rows = Rows::new(&b"a\n\n\xff\n"[..], None).unwrap();
        rows.read().unwrap();
        assert_eq!(rows.read().unwrap_err().to_string(), "line 3: is no text in UTF-8");
    }
}
