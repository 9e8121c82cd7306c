//! The figures by name.

mod beckmann_limit;
mod printed;
mod sawicki;
mod student_t;

use super::{Axis, Curve, Dash, Figure, Key, PlotError};

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Listed {
    /// Its name.
    pub name: &'static str,
    /// What it shows, and which figure of which paper it repeats.
    pub about: &'static str,
    draw: fn() -> Figure,
}

/// All figures.
pub const FIGURES: [Listed; 6] = [
    Listed {
        name: "student-t",
        about: "P22 and G1 by gamma and by sigma (Ribardiere et al. 2017, figure 3)",
        draw: student_t::figure,
    },
    Listed {
        name: "beckmann-limit",
        about: "Distance from Beckmann over sigma at large gamma (Ribardiere et al. 2017, figure 10)",
        draw: beckmann_limit::figure,
    },
    Listed {
        name: "printed-formulas",
        about: "Errors of Lambda as printed (Ribardiere et al. 2017, eq. 13-15, 21, 22-23)",
        draw: printed::figure,
    },
    Listed {
        name: "distributions",
        about: "Six distributions, and how they differ from Beckmann (Sawicki 2021, figures 1-2)",
        draw: sawicki::distributions,
    },
    Listed {
        name: "tails",
        about: "The same over Beckmann, for the tails (after Sawicki 2021, figures 1-2)",
        draw: sawicki::tails,
    },
    Listed {
        name: "highlights",
        about: "Brightness across a rough and a smooth sphere (after Sawicki 2021, figures 3-5)",
        draw: sawicki::highlights,
    },
];

/// A figure by name.
///
/// # Errors
/// [`PlotError::Unknown`], listing the names.
pub fn figure(name: &str) -> Result<Figure, PlotError> {
    match FIGURES.iter().find(|listed| listed.name == name) {
        Some(listed) => Ok((listed.draw)()),
        None => Err(PlotError::Unknown(name.into())),
    }
}

/// Points of a curve.
const POINTS: usize = 400;

/// The places along an axis where a curve is evaluated, evenly on its scale.
fn along(axis: &Axis) -> impl Iterator<Item = f64> {
    (0..=POINTS).map(|i| axis.value(i as f64 / POINTS as f64))
}

/// A function over the whole of an axis.
fn curve(key: Key, name: String, x: &Axis, f: impl Fn(f64) -> f64) -> Curve {
    let points = along(x).map(|x| (x, f(x))).collect();
    Curve { key, name, dash: Dash::Solid, points }
}
