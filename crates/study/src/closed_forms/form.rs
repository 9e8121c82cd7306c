//! A fitted share with its numbers in single precision: its value, and its text in WGSL and C.

use std::fmt::Write;

use super::fit::Fit;
use super::share::{Term, Terms};

/// A polynomial of four variables as nested products: by the powers of the first variable, each
/// a polynomial of the next ones.
#[derive(Clone, Debug, PartialEq)]
enum Nested {
    Number(f32),
    /// Polynomials by the powers of a variable, ascending.
    Powers(usize, Vec<(u8, Nested)>),
}

impl Nested {
    fn new(terms: &[(Term, f32)], variable: usize) -> Self {
        if variable == 4 {
            return Self::Number(terms.iter().map(|term| term.1).sum());
        }
        let mut powers: Vec<u8> = terms.iter().map(|term| term.0[variable]).collect();
        powers.sort_unstable();
        powers.dedup();
        let of = |power: u8| {
            let part = terms.iter().filter(|term| term.0[variable] == power).copied();
            (power, Self::new(&part.collect::<Vec<_>>(), variable + 1))
        };
        Self::Powers(variable, powers.into_iter().map(of).collect())
    }

    fn value(&self, x: [f32; 4]) -> f32 {
        match self {
            Self::Number(number) => *number,
            Self::Powers(variable, parts) => {
                let mut value = 0.0;
                for (i, (power, part)) in parts.iter().enumerate().rev() {
                    let below = i.checked_sub(1).map_or(0, |i| parts[i].0);
                    let factor: f32 = (below..*power).map(|_| x[*variable]).product();
                    value = factor * (part.value(x) + value);
                }
                value
            }
        }
    }

    /// Its text; `atom` if it is to be a factor.
    fn text(&self, names: [&str; 4], suffix: &str, atom: bool) -> String {
        match self {
            Self::Number(number) => format!("{number:?}{suffix}"),
            Self::Powers(variable, parts) => {
                let mut text = String::new();
                for (i, (power, part)) in parts.iter().enumerate().rev() {
                    let below = i.checked_sub(1).map_or(0, |i| parts[i].0);
                    let alone = text.is_empty();
                    let factors = format!("{} * ", names[*variable]).repeat((power - below).into());
                    let part = part.text(names, suffix, alone && !factors.is_empty());
                    text = if alone { part } else { format!("{part} + {text}") };
                    if !factors.is_empty() {
                        let sum = !alone;
                        text = if sum {
                            format!("{factors}({text})")
                        } else {
                            format!("{factors}{text}")
                        };
                    }
                }
                if atom && text.contains(" + ") && !is_product(&text) {
                    format!("({text})")
                } else {
                    text
                }
            }
        }
    }
}

/// Whether a text is one product: no sum outside of parentheses.
fn is_product(text: &str) -> bool {
    let mut depth = 0;
    !text.char_indices().any(|(i, letter)| {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        depth == 0 && text[i..].starts_with(" + ")
    })
}

/// A share kept/(kept + lost), at most 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Form {
    kept: Nested,
    lost: Nested,
}

/// A language that the text is for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Language {
    Wgsl,
    C,
}

impl Form {
    /// The form of a fit.
    pub(super) fn of(fit: &Fit) -> Self {
        Self::new(&fit.terms, &fit.coefficients)
    }

    /// Of coefficients in any scale: the largest becomes 1 or −1.
    pub(super) fn new(terms: &Terms, coefficients: &[f64]) -> Self {
        let largest = coefficients.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let numbers: Vec<(Term, f32)> =
            terms.all().zip(coefficients).map(|(term, x)| (*term, (x / largest) as f32)).collect();
        let (kept, lost) = numbers.split_at(terms.kept.len());
        Self { kept: Nested::new(kept, 0), lost: Nested::new(lost, 0) }
    }

    /// Kept and lost in single precision, as the text computes them.
    pub(super) fn parts(&self, place: [f32; 4]) -> [f32; 2] {
        [self.kept.value(place), self.lost.value(place)]
    }

    /// Lines that define `kept` and `lost` from variables of these names.
    pub(super) fn text(&self, names: [&str; 4], language: Language) -> String {
        let (declare, suffix) = match language {
            Language::Wgsl => ("let", ""),
            Language::C => ("const float", "f"),
        };
        let mut lines = String::new();
        for (name, part) in [("kept", &self.kept), ("lost", &self.lost)] {
            let text = part.text(names, suffix, false).replace(" + -", " - ");
            let text = format!("    {declare} {name} = {text};");
            writeln!(lines, "{}", wrapped(&text)).expect("memory");
        }
        lines
    }
}

/// A line broken at spaces before column 100, further lines indented.
fn wrapped(text: &str) -> String {
    let (mut lines, mut column) = (String::new(), 0);
    let indent = text.len() - text.trim_start().len();
    lines.push_str(&text[..indent]);
    for word in text[indent..].split(' ') {
        if column > 0 && indent + column + 1 + word.len() > 96 {
            lines.push_str("\n        ");
            column = 4;
        } else if column > 0 {
            lines.push(' ');
            column += 1;
        }
        lines.push_str(word);
        column += word.len();
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_is_the_polynomial() {
        let kept = vec![[1, 0, 0, 0], [1, 0, 0, 2], [3, 1, 0, 0]];
        let terms = Terms::share(kept, vec![[0, 0, 0, 0]]);
        let form = Form::new(&terms, &[1.0, -0.5, 2.0, 0.25]);
        let names = ["x", "y", "z", "s"];
        let lines =
            "    let kept = x * (0.5 + s * s * -0.25 + x * x * y * 1.0);\n    let lost = 0.125;\n";
        assert_eq!(form.text(names, Language::Wgsl), lines);
        let [x, y, s] = [0.5, 3.0, 2.0];
        let kept = 0.5 * x - 0.25 * x * s * s + x * x * x * y;
        assert_eq!(form.parts([x, y, 7.0, s]), [kept, 0.125]);
        assert!(form.text(names, Language::C).starts_with("    const float kept = x * (0.5f + s"));
    }
}
