//! Replaces one distribution by another: by equal half angles, by least squares, or by published
//! formulas.
//!
//! After Sawicki 2021, *Microfacet Distribution Function: To Change or Not to Change, That Is the
//! Question*: the error of a replacement is the root mean square of the difference over a uniform
//! grid of θ in [0, π/2).

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use microfacet_model::classic::{Isotropic, Tabulated};

use crate::distribution::{DistributionError, DistributionKind, Named};
use crate::minimise::{self, Stop};
use crate::progress::Stage;

/// The quantity that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// D(θ)/D(0): the shape of the highlight.
    Relative,
    /// D(θ) itself, normalised.
    Density,
}

/// A replacement and its errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Replacement {
    /// The distribution found.
    pub to: Named,
    /// RMSE of D/D(0), and of D in 1/sr.
    pub rmse: [f64; 2],
    /// Parameters found at the end of the range that was searched, beyond which a better value may
    /// lie; empty if none.
    pub ends_at: Vec<&'static str>,
}

/// Why there is no replacement.
#[derive(Clone, Debug, PartialEq)]
pub enum ConvertError {
    /// A distribution could not be made.
    Distribution(DistributionError),
    /// D does not fall to half of D(0) at any angle.
    NoHalfAngle,
    /// No parameter of this kind of distribution gives that half angle, in radians.
    OutOfReach(DistributionKind, f64),
    /// A half angle fixes one parameter; this kind of distribution has two, and the second must be
    /// given.
    ShapeNeeded(DistributionKind),
    /// No published formula is known for this pair.
    NoFormula(DistributionKind, DistributionKind),
    /// D is so large or so small that errors are no numbers.
    Overflow,
    /// The minimiser's message.
    Minimiser(String),
}

impl fmt::Display for ConvertError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Distribution(e) => e.fmt(f),
            Self::NoHalfAngle => f.write_str(
                "the distribution is so wide that D nowhere falls to half of D(0); use rmse",
            ),
            Self::OutOfReach(to, angle) => {
                write!(f, "no {} has its half angle at {angle} radians; use rmse", to.name())
            }
            Self::ShapeNeeded(to) => write!(
                f,
                "a half angle fixes one parameter and {} has two: give the second with --shape, or use rmse",
                to.name()
            ),
            Self::NoFormula(from, to) => write!(
                f,
                "there is no formula from {} to {} here; there is one between beckmann and blinn-phong, and half-angle and rmse work \
                 between any two",
                from.name(),
                to.name()
            ),
            Self::Overflow => f.write_str(
                "D is too large or too small for double precision; use a roughness in [1e-8, 1e6], and measured angles further apart",
            ),
            Self::Minimiser(e) => write!(f, "the minimiser failed: {e}"),
        }
    }
}

impl std::error::Error for ConvertError {}

impl From<DistributionError> for ConvertError {
    fn from(e: DistributionError) -> Self {
        Self::Distribution(e)
    }
}

/// The distribution to be replaced, on the uniform grid over which errors are taken.
pub struct Target<'a> {
    from: &'a dyn Isotropic,
    theta: Vec<f64>,
    d: Vec<f64>,
    peak: f64,
    /// Number of steps in [0, π/2); beyond the grid, if it ends before, everything counts as 0.
    steps: f64,
    /// Scale of the widths that are searched: 1 for all but narrow lobes.
    narrow: f64,
}

/// A half angle, radians, below which the widths that are searched scale with it.
const NARROW: f64 = 0.01;
/// The largest grid; for half angles below 5e-3 it ends some 300 of them from the normal, where
/// even GGX has fallen to 1e-10.
const LARGEST_GRID: f64 = 20_000.0;

impl<'a> Target<'a> {
    /// Prepares the grid: 900 steps, or as many as give 64 within the half angle.
    pub fn new(from: &'a dyn Isotropic) -> Self {
        let half = from.half_angle().unwrap_or(FRAC_PI_2);
        let steps = (64.0 * FRAC_PI_2 / half).max(900.0).ceil();
        let used = steps.min(LARGEST_GRID) as usize;
        let theta: Vec<f64> = (0..used).map(|i| i as f64 * FRAC_PI_2 / steps).collect();
        let d = theta.iter().map(|&t| from.d(t)).collect();
        let narrow = (half / NARROW).min(1.0);
        Self { from, theta, d, peak: from.peak(), steps, narrow }
    }

    /// The grid of a measured distribution, over the angles that were measured.
    pub fn measured(from: &'a Tabulated) -> Self {
        let mut this = Self::new(from);
        let (low, high) = from.assumed();
        let inside = this.theta.iter().filter(|t| (low..=high).contains(*t)).count();
        let skip = this.theta.partition_point(|t| *t < low);
        this.theta = this.theta[skip..skip + inside].to_vec();
        this.d = this.d[skip..skip + inside].to_vec();
        this.steps = inside as f64;
        this
    }

    /// The estimated seconds of a search for the least RMSE.
    pub fn seconds(&self, to: DistributionKind) -> f64 {
        // Nanoseconds for an angle, of `microfacet-bake fit`.
        1e-9 * 110.0 * (tries(to) * self.theta.len()) as f64
    }

    /// Root mean square of the difference over the grid.
    pub fn rmse(&self, to: &dyn Isotropic, form: Form) -> f64 {
        let (a, b) = match form {
            Form::Relative => (1.0 / self.peak, 1.0 / to.peak()),
            Form::Density => (1.0, 1.0),
        };
        let square = |(&t, &d): (&f64, &f64)| {
            let difference = a * d - b * to.d(t);
            difference * difference
        };
        let sum: f64 = self.theta.iter().zip(&self.d).map(square).sum();
        (sum / self.steps).sqrt()
    }

    fn judged(&self, to: Named) -> Result<Replacement, ConvertError> {
        let built = to.build()?;
        let rmse = [Form::Relative, Form::Density].map(|form| self.rmse(&*built, form));
        if rmse.iter().any(|rmse| rmse.is_nan()) {
            return Err(ConvertError::Overflow);
        }
        Ok(Replacement { to, rmse, ends_at: Vec::new() })
    }

    /// The distribution of kind `to` with the same half angle. `shape` is the second parameter of a
    /// kind that has two.
    ///
    /// # Errors
    /// [`ConvertError`] if either distribution has no such angle, or `shape` is missing.
    pub fn by_half_angle(
        &self,
        to: DistributionKind,
        shape: Option<f64>,
    ) -> Result<Replacement, ConvertError> {
        let named = |y: f64| {
            let mut values = to.at(&vec![y; to.dimension()], self.narrow);
            if to.dimension() == 2 {
                values[1] = shape.ok_or(ConvertError::ShapeNeeded(to))?;
            }
            Ok::<_, ConvertError>(Named { kind: to, values })
        };
        named(0.5)?.build()?;
        let angle = self.from.half_angle().ok_or(ConvertError::NoHalfAngle)?;
        // The half angle is monotone in the width; a lobe too wide to have one is wider than any
        // with one.
        let excess = |y: f64| {
            let half = named(y)?.build()?.half_angle();
            Ok::<_, ConvertError>(half.map_or(f64::INFINITY, |half| half - angle))
        };
        let rising = excess(0.0)? < 0.0;
        if rising == (excess(1.0)? < 0.0) {
            return Err(ConvertError::OutOfReach(to, angle));
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (excess(middle)? < 0.0) == rising { low = middle } else { high = middle }
        }
        let found = named(0.5 * (low + high))?;
        match found.build()?.half_angle() {
            Some(half) if (half - angle).abs() < 1e-6 * angle => self.judged(found),
            _ => Err(ConvertError::OutOfReach(to, angle)),
        }
    }

    /// The distribution of kind `to` with the least RMSE, all parameters fitted together; each
    /// distribution tried is one step of the stage, about [`tries`] in all.
    ///
    /// # Errors
    /// [`ConvertError::Minimiser`] with the minimiser's own message.
    pub fn by_rmse(
        &self,
        to: DistributionKind,
        form: Form,
        stage: &Stage,
    ) -> Result<Replacement, ConvertError> {
        stage.split(tries(to));
        let error = |point: &[f64]| {
            stage.step();
            let to = to.build(&to.at(point, self.narrow));
            to.map_or(f64::MAX, |to| self.rmse(&*to, form)).min(f64::MAX)
        };
        // A coarse scan finds the basin of the global minimum among several local ones.
        let start = minimise::grid(to.dimension(), [scan(to); 2])
            .into_iter()
            .map(|point| (error(&point), point))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("the scan is not empty")
            .1;
        let h = 1.0 / scan(to) as f64;
        let best = minimise::descend(&start, h, STOP, error).map_err(ConvertError::Minimiser)?;
        let found = self.judged(Named { kind: to, values: to.at(&best, self.narrow) })?;
        Ok(Replacement { ends_at: to.ends_at(&best), ..found })
    }
}

/// Steps of a coarse scan along each parameter.
fn scan(to: DistributionKind) -> usize {
    if to.dimension() == 1 { 200 } else { 48 }
}

/// About how many distributions of a kind a search tries: those of the scan, and about as many of
/// the minimiser as it takes to its tolerance. Only the progress reads it.
pub fn tries(to: DistributionKind) -> usize {
    match to.dimension() {
        1 => scan(to) + 40,
        _ => (scan(to) + 1).pow(2) + 200,
    }
}

/// The error is smooth, and known to rounding.
const STOP: Stop = Stop { width: 1e-9, spread: 1e-14 };

/// The published formula from one distribution to another: N = 2/m² − 2 between Beckmann and
/// Blinn–Phong (Walter et al. 2007, *Microfacet Models for Refraction through Rough Surfaces*,
/// doi:10.2312/EGWR/EGSR07/195-206, section 5.2).
///
/// # Errors
/// [`ConvertError::NoFormula`] for other pairs; [`ConvertError::Distribution`] if the result is out
/// of range.
pub fn by_formula(from: &Named, to: DistributionKind) -> Result<Replacement, ConvertError> {
    let values = match (from.kind, to, from.values.as_slice()) {
        (DistributionKind::Beckmann, DistributionKind::BlinnPhong, &[m]) => {
            vec![2.0 / (m * m) - 2.0]
        }
        (DistributionKind::BlinnPhong, DistributionKind::Beckmann, &[n]) => {
            vec![(2.0 / (n + 2.0)).sqrt()]
        }
        _ => return Err(ConvertError::NoFormula(from.kind, to)),
    };
    Target::new(&*from.build()?).judged(Named { kind: to, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(text: &str) -> Named {
        text.parse().unwrap()
    }

    #[test]
    fn every_family_finds_itself() {
        for text in
            ["beckmann:0.2", "gauss:0.15", "trowbridge-reitz:0.3", "blinn-phong:40", "schlick:0.1"]
        {
            let from = named(text);
            let built = from.build().unwrap();
            let target = Target::new(&*built);
            for found in [
                target.by_rmse(from.kind, Form::Relative, &Stage::unwatched()).unwrap(),
                target.by_half_angle(from.kind, None).unwrap(),
            ] {
                let (a, b) = (found.to.values[0], from.values[0]);
                assert!(
                    (a / b - 1.0).abs() < 1e-6 && found.rmse[0] < 1e-7,
                    "{text} became {}",
                    found.to
                );
            }
        }
        for text in ["student-t:0.3,2.5", "gtr:0.2,1.3", "hyper-cauchy:0.4,3"] {
            let from = named(text);
            let built = from.build().unwrap();
            let found = Target::new(&*built)
                .by_rmse(from.kind, Form::Density, &Stage::unwatched())
                .unwrap();
            for (a, b) in found.to.values.iter().zip(&from.values) {
                assert!((a / b - 1.0).abs() < 1e-3, "{text} became {}", found.to);
            }
            assert!(found.rmse[1] < 1e-3 * built.peak());
        }
    }

    #[test]
    fn student_t_recognises_its_members() {
        for (text, gamma) in [("trowbridge-reitz:0.2", 2.0), ("blinn-phong:20", 12.0)] {
            let built = named(text).build().unwrap();
            let found = Target::new(&*built)
                .by_rmse(DistributionKind::StudentT, Form::Relative, &Stage::unwatched())
                .unwrap();
            assert!((found.to.values[1] / gamma - 1.0).abs() < 1e-2, "{text} became {}", found.to);
        }
        let built = named("beckmann:0.2").build().unwrap();
        let found = Target::new(&*built)
            .by_rmse(DistributionKind::StudentT, Form::Relative, &Stage::unwatched())
            .unwrap();
        assert!(
            found.to.values[1] > 1e3 && (found.to.values[0] - 0.2).abs() < 1e-3,
            "{}",
            found.to
        );
    }

    #[test]
    fn the_optimum_beats_the_half_angle_and_the_formula() {
        let from = named("blinn-phong:50");
        let built = from.build().unwrap();
        let target = Target::new(&*built);
        let best = target
            .by_rmse(DistributionKind::Beckmann, Form::Relative, &Stage::unwatched())
            .unwrap();
        let half = target.by_half_angle(DistributionKind::Beckmann, None).unwrap();
        let formula = by_formula(&from, DistributionKind::Beckmann).unwrap();
        assert!(best.rmse[0] <= half.rmse[0] && best.rmse[0] <= formula.rmse[0]);
        assert!((best.to.values[0] / formula.to.values[0] - 1.0).abs() < 0.02);
    }

    #[test]
    fn refusals() {
        let built = named("blinn-phong:50").build().unwrap();
        let target = Target::new(&*built);
        assert_eq!(
            target.by_half_angle(DistributionKind::Gtr, None).unwrap_err(),
            ConvertError::ShapeNeeded(DistributionKind::Gtr)
        );
        target.by_half_angle(DistributionKind::Gtr, Some(2.0)).unwrap();
        assert!(matches!(
            by_formula(&named("gauss:0.1"), DistributionKind::Gtr),
            Err(ConvertError::NoFormula(..))
        ));
        let flat = named("blinn-phong:0").build().unwrap();
        assert!(matches!(
            Target::new(&*flat).by_half_angle(DistributionKind::Gauss, None),
            Err(ConvertError::NoHalfAngle)
        ));
    }
}
