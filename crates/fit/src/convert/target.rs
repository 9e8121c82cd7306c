//! The distribution to be replaced on grids of angles and slopes, and its replacements by equal
//! half angle and by the least distance.

use std::f64::consts::FRAC_PI_2;

use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Stage;
use microfacet_model::classic::{Isotropic, Tabulated};

use super::distance::Slopes;
use super::{ConvertError, Form, Replacement};
use crate::minimise::{self, Stop};

/// The distribution to be replaced, on the uniform grid over which errors are taken.
pub struct Target<'a> {
    from: &'a dyn Isotropic,
    theta: Vec<f64>,
    d: Vec<f64>,
    peak: f64,
    slopes: Slopes,
    /// Number of steps in [0, π/2); if the grid ends before, differences beyond it count as 0.
    steps: f64,
    /// Scale of the widths that are searched: 1 for all but narrow lobes.
    narrow: f64,
}

/// A half angle, radians, below which the widths that are searched scale with it.
const NARROW: f64 = 0.01;
/// The largest grid; for half angles below 5e-3 it ends some 300 half angles from the normal, where
/// even GGX has fallen to 1e-10.
const LARGEST_GRID: f64 = 20_000.0;
/// The error is smooth, and known to rounding.
const STOP: Stop = Stop { width: 1e-9, spread: 1e-14 };

impl<'a> Target<'a> {
    /// Prepares the grid: 900 steps, or as many as give 64 within the half angle.
    pub fn new(from: &'a dyn Isotropic) -> Self {
        let half = from.half_angle().unwrap_or(FRAC_PI_2);
        let steps = (64.0 * FRAC_PI_2 / half).max(900.0).ceil();
        Self::on(from, steps.min(LARGEST_GRID) as usize, FRAC_PI_2, steps)
    }

    /// A grid of `steps` steps in [0, `end`) radians, beyond which nothing counts.
    pub fn up_to(from: &'a dyn Isotropic, end: f64, steps: usize) -> Self {
        Self::on(from, steps, end, steps as f64)
    }

    fn on(from: &'a dyn Isotropic, used: usize, end: f64, steps: f64) -> Self {
        let theta: Vec<f64> = (0..used).map(|i| i as f64 * end / steps).collect();
        let d = theta.iter().map(|&t| from.d(t)).collect();
        let half = from.half_angle().unwrap_or(FRAC_PI_2);
        let narrow = (half / NARROW).min(1.0);
        Self { from, theta, d, peak: from.peak(), slopes: Slopes::new(from), steps, narrow }
    }

    /// The grid of a measured distribution, over the angles that were measured.
    pub fn measured(from: &'a Tabulated) -> Self {
        let mut this = Self::new(from);
        let (low, high) = from.assumed();
        let first = this.theta.partition_point(|t| *t < low);
        let end = this.theta.partition_point(|t| *t <= high);
        this.theta = this.theta[first..end].to_vec();
        this.d = this.d[first..end].to_vec();
        this.steps = this.theta.len() as f64;
        this
    }

    /// The estimated seconds of a search for the least RMSE.
    pub fn seconds(&self, to: DistributionKind) -> f64 {
        // 110 nanoseconds for an angle, measured with `microfacet-bake fit`.
        1e-9 * 110.0 * (tries(to) * self.theta.len()) as f64
    }

    /// The estimated seconds of a search for the least total variation.
    pub fn seconds_of_variation(&self, to: DistributionKind) -> f64 {
        1e-9 * 110.0 * (tries(to) * Slopes::NODES) as f64
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

    pub(super) fn judged(&self, to: Named) -> Result<Replacement, ConvertError> {
        let built = to.build()?;
        let rmse = [Form::Relative, Form::Density].map(|form| self.rmse(&*built, form));
        let [variation, reflection] =
            [self.slopes.variation(&*built), self.slopes.reflection(&*built)];
        if ![rmse[0], rmse[1], variation, reflection].iter().all(|x| x.is_finite()) {
            return Err(ConvertError::Overflow);
        }
        Ok(Replacement { to, rmse, variation, reflection, ends_at: Vec::new() })
    }

    /// The distribution of kind `to` with the same half angle. `shape` is the second parameter of a
    /// kind that has two.
    ///
    /// # Errors
    /// [`ConvertError`] if either distribution has no such angle, `shape` is missing, or the kind
    /// has three parameters.
    pub fn by_half_angle(
        &self,
        to: DistributionKind,
        shape: Option<f64>,
    ) -> Result<Replacement, ConvertError> {
        let named = |y: f64| {
            let mut values = to.at(&vec![y; to.dimension()], self.narrow);
            match to.dimension() {
                1 => {}
                2 => values[1] = shape.ok_or(ConvertError::ShapeNeeded(to))?,
                _ => return Err(ConvertError::OfThree(to)),
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
    /// distribution tried is one step of the stage.
    ///
    /// # Errors
    /// [`ConvertError::Minimiser`] with the message of the minimiser.
    pub fn by_rmse(
        &self,
        to: DistributionKind,
        form: Form,
        stage: &Stage,
    ) -> Result<Replacement, ConvertError> {
        self.nearest(to, |to| self.rmse(to, form), stage)
    }

    /// The distribution of kind `to` with the least total variation of the densities of slopes,
    /// likewise.
    ///
    /// # Errors
    /// [`ConvertError::Minimiser`] with the message of the minimiser.
    pub fn by_variation(
        &self,
        to: DistributionKind,
        stage: &Stage,
    ) -> Result<Replacement, ConvertError> {
        self.nearest(to, |to| self.slopes.variation(to), stage)
    }

    fn nearest(
        &self,
        to: DistributionKind,
        distance: impl Fn(&dyn Isotropic) -> f64,
        stage: &Stage,
    ) -> Result<Replacement, ConvertError> {
        stage.split(tries(to));
        let error = |point: &[f64]| {
            stage.step();
            let to = to.build(&to.at(point, self.narrow));
            to.map_or(f64::MAX, |to| distance(&*to)).min(f64::MAX)
        };
        // A coarse scan finds the basin of the global minimum among several local ones.
        let start = minimise::grid(&vec![scan(to); to.dimension()])
            .into_iter()
            .map(|point| (error(&point), point))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("the scan is not empty")
            .1;
        let h = 1.0 / scan(to) as f64;
        let mut best = start;
        // In three coordinates a simplex may collapse on the way: it starts once more where it
        // ended.
        for _ in 0..if to.dimension() > 2 { 2 } else { 1 } {
            best = minimise::descend(&best, h, STOP, error).map_err(ConvertError::Minimiser)?;
        }
        let found = self.judged(Named { kind: to, values: to.at(&best, self.narrow) })?;
        Ok(Replacement { ends_at: to.ends_at(&best), ..found })
    }
}

fn scan(to: DistributionKind) -> usize {
    match to.dimension() {
        1 => 200,
        2 => 48,
        _ => 16,
    }
}

/// About how many distributions of a kind a search tries: those of the scan, and about as many as
/// the minimiser takes to its tolerance. Used for progress only.
fn tries(to: DistributionKind) -> usize {
    match to.dimension() {
        1 => scan(to) + 40,
        2 => (scan(to) + 1).pow(2) + 200,
        _ => (scan(to) + 1).pow(3) + 1000,
    }
}
