//! The rows of a CSV, each with the line on which it begins.

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
    reader: csv::Reader<LineFeeds<Limited<Unmarked<R>>>>,
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
            .comment(comment)
            .from_reader(LineFeeds {
                input: Limited::new(input, MAX_ROW),
                last: b'\n',
                bytes: 0,
                ends: 2,
            });
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
            let (start, mut fields) = (self.reader.position().line(), csv::ByteRecord::new());
            let found = self.reader.read_byte_record(&mut fields);
            if !found.map_err(|why| RowError::new(start, why.to_string()))? {
                return Ok(None);
            }
            // A row ends with the first line break at the latest, if it is not in quotes.
            let text = self.reader.get_ref();
            let is_open = text.ends == 0 && self.bytes() == text.bytes;
            let inside = fields.as_slice().iter().filter(|&&byte| byte == b'\n').count();
            let line = self.reader.position().line() - inside as u64 - u64::from(!is_open);
            if is_open {
                return Err(RowError::new(line, "a quote is opened here and never closed"));
            }
            let mut fields = csv::StringRecord::from_byte_record(fields)
                .map_err(|_| RowError::new(line, "is no text in UTF-8"))?;
            fields.trim();
            // A line of spaces is blank.
            if fields.len() > 1 || !fields[0].is_empty() {
                return Ok(Some(Row { line, fields }));
            }
        }
    }
}

/// A stream in which every line break is one line feed, as the parser counts them, with two more at
/// its end, which an open quote takes in.
#[derive(Debug)]
struct LineFeeds<R> {
    input: R,
    /// The last byte of the input.
    last: u8,
    /// Bytes so far, and line feeds still to come after the input.
    bytes: u64,
    ends: usize,
}

impl<R: Read> Read for LineFeeds<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let mut kept = 0;
        while kept == 0 {
            let count = self.input.read(to)?;
            if count == 0 {
                kept = self.ends.min(to.len());
                to[..kept].fill(b'\n');
                self.ends -= kept;
                break;
            }
            for i in 0..count {
                let byte = to[i];
                // A carriage return and a line feed are one break.
                if !(byte == b'\n' && self.last == b'\r') {
                    to[kept] = if byte == b'\r' { b'\n' } else { byte };
                    kept += 1;
                }
                self.last = byte;
            }
        }
        self.bytes += kept as u64;
        Ok(kept)
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
        // These are closed, whatever follows.
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
