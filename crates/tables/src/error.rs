//! The error of reading a table set, and numbers in messages.

use alloc::string::String;
use core::fmt;

/// Why bytes are not a table set that this crate can use.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum LoadError {
    /// The bytes contradict the format: truncated, damaged, or describing something impossible.
    Invalid(String),
    /// A file that may be valid but that this version cannot read: another version of the format,
    /// or nodes that are not spaced as its readers need.
    Unsupported(String),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => write!(f, "not a valid table set: {why}"),
            Self::Unsupported(why) => write!(f, "table set not supported: {why}"),
        }
    }
}

microfacet_core::debug_in_words!(LoadError);

impl core::error::Error for LoadError {}

/// An interval in a message: its ends to nine digits, which hides the rounding of 1/(1/x), and with
/// a power of ten below 1e-4 and from 1e6.
pub struct Range(pub [f64; 2]);

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.0.map(Short);
        if self.0[0] == self.0[1] { write!(f, "{low}") } else { write!(f, "[{low}, {high}]") }
    }
}

struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short: f64 = alloc::format!("{:.8e}", self.0).parse().unwrap_or(self.0);
        match short.abs() {
            1e-4..1e6 => write!(f, "{short}"),
            0.0 | f64::INFINITY => write!(f, "{short}"),
            _ => write!(f, "{short:e}"),
        }
    }
}
