//! Numbers as source text.

use std::fmt::Write;

/// The widest line of generated text.
const WIDTH: usize = 100;

/// γ as part of an identifier and of a file's name: `3`, `1p65`, `inf`.
pub(super) fn identifier(gamma: f64) -> String {
    as_typed(gamma).replace('.', "p")
}

/// γ as the command reads it: `3`, `1.65`, `inf`.
pub(crate) fn as_typed(gamma: f64) -> String {
    shortest(gamma.to_string(), format!("{gamma:e}"))
}

/// An error to two digits.
pub(super) fn error(error: Option<f64>) -> String {
    error.map_or_else(|| "not stated".into(), |error| format!("{error:.1e}"))
}

/// A single-precision number in the fewest digits that bring it back, as all languages with a
/// decimal point read it.
pub fn single(x: f32) -> String {
    let text = shortest(format!("{x:?}"), format!("{x:e}"));
    if text.contains(['.', 'e']) { text } else { text + ".0" }
}

fn shortest(plain: String, scientific: String) -> String {
    if scientific.len() < plain.len() { scientific } else { plain }
}

/// Items with a comma after each, in lines.
pub(super) fn lines(items: impl IntoIterator<Item = String>) -> String {
    wide_lines(items, WIDTH)
}

/// The same in lines of a width; C promises to read 4095 characters.
pub(super) fn wide_lines(items: impl IntoIterator<Item = String>, width: usize) -> String {
    let (mut text, mut column) = (String::new(), 0);
    for item in items {
        if column + item.len() + 1 > width {
            text.push('\n');
            column = 0;
        }
        write!(text, "{item},").expect("memory");
        column += item.len() + 1;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_back_and_short() {
        for x in [0.0, 1.0, -0.5, 1e-8, 3.4e38, 0.1 + 0.2, f32::MIN_POSITIVE, 1.0 / 3.0] {
            let text = single(x);
            assert_eq!(text.parse(), Ok(x), "{text}");
            assert!(text.contains(['.', 'e']) && text.len() <= 14, "{text}");
        }
    }

    #[test]
    fn shapes_have_names() {
        let names = [3.0, 1.65, f64::INFINITY, 2.0, 1e300, 10.0].map(identifier);
        assert_eq!(names, ["3", "1p65", "inf", "2", "1e300", "10"]);
        assert_eq!([as_typed(f64::INFINITY), as_typed(1e38)], ["inf", "1e38"]);
    }

    #[test]
    fn lines_are_not_too_wide() {
        let text = lines((0..100).map(|i| i.to_string()));
        assert!(text.lines().all(|line| line.len() <= WIDTH) && text.lines().count() == 3);
        assert_eq!(text.matches(',').count(), 100);
    }
}
