//! Tokens of a pbrt file, read as a stream: memory is bounded by the longest word.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use microfacet_baker::scene::{Place, SceneError, characters};

/// A longer word is not from a pbrt file; the limit bounds memory where a file has no spaces.
const MAX_WORD: usize = 1 << 12;

/// The kind of a token; its text is in [`Tokens::text`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// A directive, a number, `true` or `false`.
    Word,
    /// A quoted text.
    Text,
    /// `[`
    Open,
    /// `]`
    Close,
}

/// A stream of tokens.
pub(super) struct Tokens<R> {
    input: BufReader<R>,
    file: Arc<Path>,
    line: u64,
    /// Characters of the current line that were consumed.
    column: u64,
    /// Whether the last byte was a carriage return, with which a line feed is one line break.
    returned: bool,
    text: String,
    /// Line and column at which the last token began.
    start: (u64, u64),
    /// The last token, if it is to be returned again.
    again: Option<Token>,
}

impl<R: Read> Tokens<R> {
    pub(super) fn new(input: R, file: &Path) -> Self {
        Self {
            // Large enough that the cost of a refill vanishes beside that of the scan.
            input: BufReader::with_capacity(1 << 18, input),
            file: file.into(),
            line: 1,
            column: 0,
            returned: false,
            text: String::new(),
            start: (1, 1),
            again: None,
        }
    }

    /// The text of the last token.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The place of the last token.
    pub(super) fn place(&self) -> Place {
        Place {
            file: self.file.clone(),
            line: u32::try_from(self.start.0).ok(),
            column: u32::try_from(self.start.1).ok(),
        }
    }

    /// Makes [`Self::next`] return the last token again.
    pub(super) fn push_back(&mut self, token: Token) {
        self.again = Some(token);
    }

    /// The next token; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Token>, SceneError> {
        if let Some(token) = self.again.take() {
            return Ok(Some(token));
        }
        loop {
            match self.peek()? {
                None => return Ok(None),
                Some(b' ' | b'\t' | b'\r' | b'\n') => self.take(),
                Some(b'#') => self.skip_comment()?,
                Some(first) => {
                    self.start = (self.line, self.column + 1);
                    return Ok(Some(match first {
                        b'[' => self.bracket(Token::Open),
                        b']' => self.bracket(Token::Close),
                        b'"' => self.quoted()?,
                        _ => self.word()?,
                    }));
                }
            }
        }
    }

    /// Skips a list whose opening bracket was the last token, without storing it.
    ///
    /// Almost all bytes of a large scene are numbers in such lists.
    pub(super) fn skip_list(&mut self) -> Result<(), SceneError> {
        let open = self.place();
        loop {
            let chunk = fill(&mut self.input, &self.file, self.line)?;
            let stop =
                chunk.iter().position(|b| matches!(b, b'\n' | b'\r' | b']' | b'"' | b'#' | b'['));
            let taken = stop.unwrap_or(chunk.len());
            let stop = stop.map(|i| chunk[i]);
            let at_end = chunk.is_empty();
            self.column += characters(&chunk[..taken]) as u64;
            self.returned &= taken == 0;
            self.input.consume(taken);
            match stop {
                None if at_end => return Err(open.syntax("this list has no closing bracket")),
                None => {}
                Some(b'\n' | b'\r') => self.take(),
                Some(b'#') => self.skip_comment()?,
                Some(b'"') => {
                    self.start = (self.line, self.column + 1);
                    self.quoted()?;
                }
                Some(byte) => {
                    self.take();
                    if byte == b']' {
                        return Ok(());
                    }
                    return Err(
                        open.syntax("this list has another list in it, or no closing bracket")
                    );
                }
            }
        }
    }

    fn bracket(&mut self, token: Token) -> Token {
        self.text.clear();
        self.text.push(if token == Token::Open { '[' } else { ']' });
        self.take();
        token
    }

    fn quoted(&mut self) -> Result<Token, SceneError> {
        self.take();
        let mut bytes = self.cleared();
        loop {
            let byte = self.peek()?;
            match byte {
                None | Some(b'\n' | b'\r') => {
                    return Err(self.place().syntax("this text has no closing quote"));
                }
                Some(_) if bytes.len() > MAX_WORD => {
                    return Err(self.place().syntax("this text is too long"));
                }
                Some(_) => self.take(),
            }
            match byte {
                Some(b'"') => break,
                Some(b'\\') => {
                    let escaped = self.peek()?;
                    self.take();
                    bytes.push(match escaped {
                        Some(b'b') => 8,
                        Some(b'f') => 12,
                        Some(b'n') => b'\n',
                        Some(b'r') => b'\r',
                        Some(b't') => b'\t',
                        Some(byte @ (b'\\' | b'\'' | b'"')) => byte,
                        _ => return Err(self.place().syntax("this text has an unknown escape")),
                    });
                }
                Some(byte) => bytes.push(byte),
                None => {}
            }
        }
        self.text = text(bytes);
        Ok(Token::Text)
    }

    fn word(&mut self) -> Result<Token, SceneError> {
        let mut bytes = self.cleared();
        while let Some(byte) = self.peek()? {
            if matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b'"' | b'[' | b']') {
                break;
            }
            if bytes.len() > MAX_WORD {
                return Err(self.place().syntax("this word is too long for a pbrt file"));
            }
            bytes.push(byte);
            self.take();
        }
        self.text = text(bytes);
        Ok(Token::Word)
    }

    /// The last token's buffer, emptied for reuse.
    fn cleared(&mut self) -> Vec<u8> {
        let mut bytes = std::mem::take(&mut self.text).into_bytes();
        bytes.clear();
        bytes
    }

    fn skip_comment(&mut self) -> Result<(), SceneError> {
        while !matches!(self.peek()?, None | Some(b'\n' | b'\r')) {
            self.take();
        }
        Ok(())
    }

    fn peek(&mut self) -> Result<Option<u8>, SceneError> {
        Ok(fill(&mut self.input, &self.file, self.line)?.first().copied())
    }

    /// Consumes the byte that [`Self::peek`] saw.
    fn take(&mut self) {
        let byte = self.input.buffer().first().copied();
        match byte {
            Some(b'\n') if self.returned => {}
            Some(b'\n' | b'\r') => {
                self.line += 1;
                self.column = 0;
            }
            _ => self.column += characters(byte.as_slice()) as u64,
        }
        self.returned = byte == Some(b'\r');
        self.input.consume(1);
    }
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}

/// The buffered bytes, read anew if there are none; empty at the end.
fn fill<'a>(
    input: &'a mut BufReader<impl Read>,
    file: &Arc<Path>,
    line: u64,
) -> Result<&'a [u8], SceneError> {
    input.fill_buf().map_err(|error| {
        let line = u32::try_from(line).ok();
        Place { file: file.clone(), line, column: None }.io(error)
    })
}
