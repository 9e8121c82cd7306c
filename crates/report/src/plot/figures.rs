//! The figures by name.

mod beckmann_limit;
mod printed;
mod sawicki;
mod student_t;

use super::{Axis, Curve, Figure, Key, PlotError};

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Listed {
    /// Its name.
    pub name: &'static str,
    /// What it shows, and which figure of which paper it repeats.
    pub about: &'static str,
    draw: fn() -> Figure,
}

const fn listed(name: &'static str, about: &'static str, draw: fn() -> Figure) -> Listed {
    Listed { name, about, draw }
}

/// All figures.
pub const FIGURES: [Listed; 6] = [
    listed(
        "student-t",
        "P22 and G1 by gamma and by sigma (Ribardiere et al. 2017, figure 3)",
        student_t::figure,
    ),
    listed(
        "beckmann-limit",
        "Distance from Beckmann over sigma at large gamma (Ribardiere et al. 2017, figure 10)",
        beckmann_limit::figure,
    ),
    listed(
        "printed-formulas",
        "Errors of Lambda as printed (Ribardiere et al. 2017, eq. 13-15, 21, 22-23)",
        printed::figure,
    ),
    listed(
        "distributions",
        "Six distributions, and how they differ from Beckmann (Sawicki 2021, figures 1-2)",
        sawicki::distributions,
    ),
    listed(
        "tails",
        "The same over Beckmann, for the tails (after Sawicki 2021, figures 1-2)",
        sawicki::tails,
    ),
    listed(
        "highlights",
        "Brightness across a rough and a smooth sphere (after Sawicki 2021, figures 3-5)",
        sawicki::highlights,
    ),
];

/// A figure by name.
///
/// # Errors
/// [`PlotError::Unknown`], listing the names.
pub fn figure(name: &str) -> Result<Figure, PlotError> {
    let listed = FIGURES.iter().find(|listed| listed.name == name);
    Ok((listed.ok_or_else(|| PlotError::Unknown(name.into()))?.draw)())
}

/// A curve of a function at points equally spaced on the scale of an axis, from end to end.
fn curve(key: Key, name: impl Into<String>, x: &Axis, f: impl Fn(f64) -> f64) -> Curve {
    const POINTS: u32 = 400;
    let places = (0..=POINTS).map(|i| x.value(f64::from(i) / f64::from(POINTS)));
    Curve::new(key, name, places.map(|x| (x, f(x))))
}
