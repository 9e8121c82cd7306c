//! The search for terms: from all terms of a degree on, those that matter least are left out, one
//! after another.

use super::fit::{Fit, fit};
use super::share::{Samples, Term, Terms};

/// Terms as they stand in the lists of forms: the powers of a term are digits.
pub(super) fn written(terms: &[Term]) -> String {
    let digits =
        |term: &Term| term.iter().map(|power| char::from(b'0' + power)).collect::<String>();
    terms.iter().map(digits).collect::<Vec<_>>().join(" ")
}

/// The terms of such a list.
pub(super) fn read(text: &str) -> Vec<Term> {
    let term = |word: &str| -> Term {
        let mut digits = word.bytes().map(|digit| digit - b'0');
        std::array::from_fn(|_| digits.next().expect("four digits"))
    };
    text.split_whitespace().map(term).collect()
}

/// How thorough a search is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Terms that are tried at each step: those that matter least.
    pub(super) tries: usize,
    /// How often weights follow the errors at each step.
    pub(super) rounds: usize,
    /// Above this size several terms are left out at a time.
    pub(super) singly: usize,
}

/// Prints the forms that are left of all `terms`, down to the size `least`.
pub(super) fn search(terms: &Terms, samples: &Samples, effort: Effort, least: usize) {
    let mut form: Fit = fit(terms, samples, None, 200);
    println!("{} numbers, {:.1e}", form.numbers(), form.error);
    while form.numbers() > least {
        let many = form.numbers() > effort.singly;
        let (drop, tries) = if many { (form.numbers() / 9, 3) } else { (1, effort.tries) };
        let Some(smaller) = form.smaller(samples, drop, tries, effort.rounds) else { return };
        form = smaller.again(samples, effort.rounds);
        println!("{} numbers, {:.1e}", form.numbers(), form.error);
        if !many {
            println!("    \"{}\"", written(&form.terms.kept));
            println!("    \"{}\"", written(&form.terms.lost));
        }
    }
}
