//! The grammar of pbrt's files: tokens, and lists of parameters.

use std::borrow::Cow;
use std::path::Path;
use std::rc::Rc;

use microfacet_baker::scene::{Lines, Place, SceneError};

use super::definition::Parameter;
use crate::Result;
use crate::builder::shortened;
use crate::limits;

/// Longer parameter lists are spectra or geometry, none of which is read.
const MAX_VALUES: usize = 16;

#[derive(Debug)]
pub(super) enum Token<'a> {
    /// A directive, a number, `true` or `false`.
    Word(Cow<'a, str>),
    /// A quoted text.
    Text(String),
    /// `[`
    Open,
    /// `]`
    Close,
}

impl Token<'_> {
    /// The token as messages show it.
    pub(super) fn shown(&self) -> Cow<'_, str> {
        match self {
            Token::Word(text) => shortened(text),
            Token::Text(text) => shortened(text),
            Token::Open => "[".into(),
            Token::Close => "]".into(),
        }
    }
}

pub(super) struct Tokens<'a> {
    text: &'a [u8],
    lines: Lines<'a>,
    /// Offset of the text that is left.
    at: usize,
    /// Offset of the last token.
    start: usize,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a [u8], file: &Path) -> Self {
        Self { text, lines: Lines::new(file, text), at: 0, start: 0 }
    }

    /// The place of the last token.
    pub(super) fn place(&self) -> Place {
        self.lines.place(self.start)
    }

    fn syntax(&self, why: impl Into<String>) -> SceneError {
        self.place().syntax(why)
    }

    /// The next token; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>> {
        while let Some(&first) = self.text.get(self.at) {
            match first {
                b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
                b'#' => self.skip_to(|byte| matches!(byte, b'\r' | b'\n')),
                _ => {
                    self.start = self.at;
                    self.at += 1;
                    return Ok(Some(match first {
                        b'[' => Token::Open,
                        b']' => Token::Close,
                        b'"' => Token::Text(self.quoted()?),
                        _ => {
                            self.skip_to(|byte| b" \t\r\n\"[]".contains(&byte));
                            Token::Word(String::from_utf8_lossy(&self.text[self.start..self.at]))
                        }
                    }));
                }
            }
        }
        Ok(None)
    }

    fn skip_to(&mut self, is_end: impl Fn(u8) -> bool) {
        let rest = &self.text[self.at..];
        self.at += rest.iter().position(|&byte| is_end(byte)).unwrap_or(rest.len());
    }

    /// The text after an opening quote, up to the closing one.
    fn quoted(&mut self) -> Result<String> {
        let mut text = Vec::new();
        loop {
            let from = self.at;
            self.skip_to(|byte| b"\"\\\r\n".contains(&byte));
            text.extend_from_slice(&self.text[from..self.at]);
            let next = |ahead: usize| self.text.get(self.at + ahead).copied();
            match (next(0), next(1)) {
                (Some(b'"'), _) => {
                    self.at += 1;
                    return Ok(String::from_utf8_lossy(&text).into_owned());
                }
                (Some(b'\\'), escaped) => text.push(match escaped {
                    Some(b'b') => 8,
                    Some(b'f') => 12,
                    Some(b'n') => b'\n',
                    Some(b'r') => b'\r',
                    Some(b't') => b'\t',
                    Some(byte @ (b'\\' | b'\'' | b'"')) => byte,
                    _ => return Err(self.syntax("this text has an unknown escape")),
                }),
                _ => return Err(self.syntax("this text has no closing quote")),
            }
            self.at += 2;
        }
    }

    /// Skips a list whose opening bracket has been read, without storing its tokens.
    ///
    /// Almost all bytes of a large scene are numbers in lists.
    fn skip_list(&mut self, open: &Place) -> Result<()> {
        loop {
            self.skip_to(|byte| b"]\"#[".contains(&byte));
            match self.next()? {
                Some(Token::Close) => return Ok(()),
                Some(Token::Open) => {
                    return Err(
                        open.syntax("this list has another list in it, or no closing bracket")
                    );
                }
                Some(_) => {}
                None => return Err(open.syntax("this list has no closing bracket")),
            }
        }
    }

    /// The quoted text that must come next.
    pub(super) fn text(&mut self, what: &str) -> Result<String> {
        match self.next()? {
            Some(Token::Text(text)) => Ok(text),
            Some(token) => {
                Err(self.syntax(format!("expected {what} in quotes, not {}", token.shown())))
            }
            None => Err(self.syntax(format!("the file ends where {what} is expected"))),
        }
    }

    /// The parameter list that comes next, perhaps empty.
    pub(super) fn parameters(&mut self) -> Result<Vec<Rc<Parameter>>> {
        let mut list = Vec::new();
        while let Some(token) = self.next()? {
            let Token::Text(declared) = token else {
                self.at = self.start;
                break;
            };
            let place = self.place();
            if list.len() == limits::PARAMETERS {
                return Err(place.too_large(format!(
                    "a directive has more than {} parameters; remove those that pbrt does not read",
                    limits::PARAMETERS
                )));
            }
            let mut words = declared.split_ascii_whitespace().map(str::to_owned);
            let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
                return Err(place.syntax(format!(
                    "\"{}\" declares no parameter; write its type and its name, as in \"float \
                     roughness\"",
                    shortened(&declared)
                )));
            };
            let values = self.values(&name)?;
            list.push(Rc::new(Parameter { kind, name, values, place }));
        }
        Ok(list)
    }

    fn values(&mut self, name: &str) -> Result<Vec<String>> {
        let mut values = Vec::new();
        match self.next()? {
            Some(Token::Word(value)) => values.push(value.into_owned()),
            Some(Token::Text(value)) => values.push(value),
            Some(Token::Open) => {
                let open = self.place();
                loop {
                    match self.next()? {
                        Some(Token::Close) => break,
                        Some(Token::Word(value)) => values.push(value.into_owned()),
                        Some(Token::Text(value)) => values.push(value),
                        _ => return Err(open.syntax("this list has no closing bracket")),
                    }
                    if values.len() == MAX_VALUES {
                        self.skip_list(&open)?;
                        break;
                    }
                }
            }
            _ => return Err(self.syntax(format!("the parameter {name} has no value"))),
        }
        Ok(values)
    }

    /// Skips everything up to the next directive.
    pub(super) fn skip_arguments(&mut self) -> Result<()> {
        while let Some(token) = self.next()? {
            match token {
                Token::Text(_) => {}
                Token::Open => self.skip_list(&self.place())?,
                Token::Close => return Err(self.syntax("this bracket closes no list")),
                // Numbers and truth values are arguments; any other word is the next directive.
                Token::Word(word) => {
                    let is_word = word.starts_with(|c: char| c.is_ascii_alphabetic());
                    if is_word && !matches!(&*word, "true" | "false") {
                        self.at = self.start;
                        break;
                    }
                }
            }
        }
        Ok(())
    }
}
