//! Compares the functions of exported shapes with the Rust crate: at random points, at corners, and
//! with the rows of `docs/reference.csv`. Clients run the functions.

mod compare;
mod family;
mod lookup;
mod points;
mod reference;

use microfacet_sampler::Tables;

pub use compare::{Limits, Rough};
pub use family::{At, FamilyLimits, ForeignFamily, Hit, agree as agree_with_family};
pub use lookup::{Answer, Point};

use compare::Worst;

/// Exported functions in one or several languages, for the shapes that are compared, by their
/// index.
pub trait Foreign {
    /// The answers of each language at points of a shape.
    fn answers(&mut self, shape: usize, points: &[Point]) -> Vec<(&'static str, Vec<Answer>)>;
}

/// Compares shapes by their γ at `count` random points, at all corners, and with the rows of the
/// file `reference`; prints what differs most, and returns whether all is within the limits.
pub fn agree(
    foreign: &mut impl Foreign,
    limits: &Limits,
    gammas: &[f64],
    count: usize,
    reference: &str,
) -> bool {
    let tables = Tables::embedded();
    let each = count.div_ceil(gammas.len());
    let mut good = true;
    for (title, corners) in [("random points", false), ("corners", true)] {
        let mut worst = Worst::new(limits);
        let (mut all, mut compared, mut languages) = (0, 0, Vec::new());
        for (shape, &gamma) in gammas.iter().enumerate() {
            let groups =
                if corners { points::corners() } else { points::random(each, shape as u64) };
            let points: Vec<Point> =
                groups.iter().flat_map(|group| &group.points).copied().collect();
            all += points.len();
            languages.clear();
            for (language, answers) in foreign.answers(shape, &points) {
                languages.push(language);
                let mut rest = &answers[..];
                for group in &groups {
                    let (answers, others) = rest.split_at(group.points.len());
                    rest = others;
                    compared += worst.group(&tables, gamma, group, language, answers);
                }
            }
        }
        let each = compared / languages.len();
        println!(
            "largest differences at {each} {title}, of {all}, of gamma {gammas:?}, {}",
            languages.join(" and ")
        );
        good &= worst.print();
    }
    good & reference::compare(foreign, limits, reference, gammas)
}
