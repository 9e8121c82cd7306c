//! The grammar of pbrt's statements: a directive, quoted texts, and a list of parameters.

use std::io::Read;
use std::rc::Rc;

use microfacet_baker::scene::{Place, SceneError};

use super::token::{Token, Tokens};
use crate::limits;

/// Longer parameter lists are spectra or geometry, none of which is read.
const MAX_VALUES: usize = 16;

/// A parameter: `"type name" value` or `"type name" [ values ]`.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) kind: String,
    pub(super) name: String,
    /// The values as written; at most [`MAX_VALUES`].
    pub(super) values: Vec<String>,
    pub(super) place: Place,
}

impl Parameter {
    /// Bytes of its texts, with one for the end of each.
    pub(super) fn bytes(&self) -> usize {
        let values: usize = self.values.iter().map(|value| value.len() + 1).sum();
        self.kind.len() + self.name.len() + 2 + values
    }
}

/// The quoted text that must come next.
pub(super) fn quoted<R: Read>(tokens: &mut Tokens<R>, what: &str) -> Result<String, SceneError> {
    match tokens.next()? {
        Some(Token::Text) => Ok(tokens.text().to_owned()),
        Some(_) => {
            Err(tokens.place().syntax(format!("expected {what} in quotes, not {}", tokens.text())))
        }
        None => Err(tokens.place().syntax(format!("the file ends where {what} is expected"))),
    }
}

/// The parameter list that comes next, perhaps empty.
pub(super) fn parameters<R: Read>(
    tokens: &mut Tokens<R>,
) -> Result<Vec<Rc<Parameter>>, SceneError> {
    let mut list = Vec::new();
    while let Some(token) = tokens.next()? {
        if token != Token::Text {
            tokens.push_back(token);
            break;
        }
        let place = tokens.place();
        if list.len() == limits::PBRT_PARAMETERS {
            return Err(place.too_large(format!(
                "a directive has more than {} parameters; remove those that pbrt does not read",
                limits::PBRT_PARAMETERS
            )));
        }
        let mut words = tokens.text().split_ascii_whitespace();
        let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
            return Err(place.syntax(format!(
                "\"{}\" declares no parameter; write its type and its name, as in \"float roughness\"",
                tokens.text()
            )));
        };
        let (kind, name) = (kind.to_owned(), name.to_owned());
        let values = values(tokens, &name)?;
        list.push(Rc::new(Parameter { kind, name, values, place }));
    }
    Ok(list)
}

fn values<R: Read>(tokens: &mut Tokens<R>, name: &str) -> Result<Vec<String>, SceneError> {
    let mut values = Vec::new();
    match tokens.next()? {
        Some(Token::Word | Token::Text) => values.push(tokens.text().to_owned()),
        Some(Token::Open) => {
            let open = tokens.place();
            loop {
                match tokens.next()? {
                    Some(Token::Close) => break,
                    Some(Token::Word | Token::Text) if values.len() < MAX_VALUES => {
                        values.push(tokens.text().to_owned());
                    }
                    Some(Token::Word | Token::Text) => {
                        tokens.skip_list()?;
                        break;
                    }
                    _ => return Err(open.syntax("this list has no closing bracket")),
                }
            }
        }
        _ => {
            return Err(tokens.place().syntax(format!("the parameter {name} has no value")));
        }
    }
    Ok(values)
}

/// Skips everything up to the next directive.
pub(super) fn skip_arguments<R: Read>(tokens: &mut Tokens<R>) -> Result<(), SceneError> {
    while let Some(token) = tokens.next()? {
        match token {
            Token::Text => {}
            Token::Open => tokens.skip_list()?,
            Token::Close => {
                return Err(tokens.place().syntax("this bracket closes no list"));
            }
            // Numbers and truth values are arguments; any other word is the next directive.
            Token::Word => {
                let word = tokens.text();
                let is_directive = word.starts_with(|c: char| c.is_ascii_alphabetic())
                    && !matches!(word, "true" | "false");
                if is_directive {
                    tokens.push_back(token);
                    break;
                }
            }
        }
    }
    Ok(())
}
