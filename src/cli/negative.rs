//! Negative numbers on the command line. Clap takes `-1` for an option, or for a value of options
//! that say so one by one, and `-inf`, `-.5` and `-1,2` for options in any case.

use std::ffi::{OsStr, OsString};

/// The words of a command line with `--option -1` as `--option=-1`: what begins like a negative
/// number is never an option, and after one it is its value.
pub(super) fn attached(words: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut attached: Vec<OsString> = Vec::new();
    let mut words = words.into_iter();
    while let Some(word) = words.next() {
        if word == "--" {
            attached.push(word);
            attached.extend(words);
            break;
        }
        match attached.last_mut().filter(|last| is_negative(&word) && is_option(last)) {
            Some(option) => {
                option.push("=");
                option.push(word);
            }
            None => attached.push(word),
        }
    }
    attached
}

/// A long option without a value.
fn is_option(word: &OsStr) -> bool {
    word.to_str().is_some_and(|word| word.starts_with("--") && !word.contains('='))
}

/// `-1`, `-.5`, `-1,2`, `-4GiB`, `-inf`, `-nan`: a minus, and how a number begins.
fn is_negative(word: &OsStr) -> bool {
    word.to_str().and_then(|word| word.strip_prefix('-')).is_some_and(|rest| {
        let digits = rest.strip_prefix('.').unwrap_or(rest);
        let name = rest.split(',').next().unwrap_or_default();
        digits.starts_with(|c: char| c.is_ascii_digit())
            || name.parse::<f64>().is_ok_and(|x| !x.is_finite())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_negative_number_is_joined_to_the_option_before_it() {
        let joined = |text: &str| {
            let words = attached(text.split(' ').map(OsString::from));
            words.into_iter().map(|word| word.into_string().unwrap()).collect::<Vec<_>>().join(" ")
        };
        for (typed, read) in [
            ("--sigma -1 --gamma -inf", "--sigma=-1 --gamma=-inf"),
            ("--phi -.5 --max-memory -4GiB", "--phi=-.5 --max-memory=-4GiB"),
            ("--sigma -0.3,1 -inf,2", "--sigma=-0.3,1 -inf,2"),
            ("--gamma -Infinity --theta -NaN", "--gamma=-Infinity --theta=-NaN"),
            // An option, a value, a name, what follows `--`.
            ("--json -o x --out - -1", "--json -o x --out - -1"),
            ("--sigma=1 -1 -input -.x", "--sigma=1 -1 -input -.x"),
            ("plan -1 -- --sigma -1", "plan -1 -- --sigma -1"),
        ] {
            assert_eq!(joined(typed), read);
        }
    }
}
