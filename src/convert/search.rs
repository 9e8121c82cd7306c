//! The replacement with the least error, by a coarse scan and a minimiser.

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::brent::BrentOpt;
use argmin::solver::neldermead::NelderMead;

use super::{ConvertError, Form, Replacement, Target};
use crate::distribution::{DistributionKind, Named};
use crate::progress::Stage;

impl Target<'_> {
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
        let problem = Problem { target: self, to, form, stage };
        let failed = |e: Error| ConvertError::Minimiser(e.to_string());
        // A coarse scan finds the basin of the global minimum among several local ones.
        let steps = scan(to);
        let scale = |i: usize| i as f64 / steps as f64;
        let start = (0..=steps)
            .flat_map(|i| {
                let seconds = if to.dimension() == 1 { 0..=0 } else { 0..=steps };
                seconds.map(move |j| [scale(i), scale(j)])
            })
            .map(|point| (problem.error(&point[..to.dimension()]), point))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("the scan is not empty")
            .1;
        let h = 1.0 / steps as f64;
        let best = if to.dimension() == 1 {
            let solver = BrentOpt::new((start[0] - h).max(0.0), (start[0] + h).min(1.0))
                .set_tolerance(1e-9, 1e-10);
            let run = Executor::new(&problem, solver)
                .configure(|s| s.max_iters(200))
                .run()
                .map_err(failed)?;
            vec![*run.state().get_best_param().unwrap_or(&start[0])]
        } else {
            // Away from an edge of the square, where the simplex would be flat.
            let [x, y] = start.map(|c| c.clamp(0.5 * h, 1.0 - 0.5 * h));
            let simplex = vec![vec![x, y], vec![x + 0.4 * h, y], vec![x, y + 0.4 * h]];
            let solver = NelderMead::new(simplex).with_sd_tolerance(1e-14).map_err(failed)?;
            let run = Executor::new(Simplex(&problem), solver)
                .configure(|s| s.max_iters(2000))
                .run()
                .map_err(failed)?;
            run.state().get_best_param().cloned().unwrap_or(vec![x, y])
        };
        let found = self.judged(Named { kind: to, values: to.at(&best, self.narrow) })?;
        Ok(Replacement { ends_at: self.ends_at(to, &best), ..found })
    }

    /// The parameters that ended where their search ends, apart from the limit γ = ∞.
    fn ends_at(&self, to: DistributionKind, best: &[f64]) -> Vec<&'static str> {
        let at_end = |y: f64| !(1e-4..=1.0 - 1e-4).contains(&y);
        let is_limit = |i: usize| to == DistributionKind::StudentT && i == 1 && best[i] < 0.5;
        let ends = (0..best.len()).filter(|&i| at_end(best[i]) && !is_limit(i));
        ends.map(|i| to.parameters()[i]).collect()
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

/// The RMSE as a function on the search square of a kind of distribution.
struct Problem<'a> {
    target: &'a Target<'a>,
    to: DistributionKind,
    form: Form,
    stage: &'a Stage,
}

impl Problem<'_> {
    fn error(&self, point: &[f64]) -> f64 {
        self.stage.step();
        let rmse = self
            .to
            .build(&self.to.at(point, self.target.narrow))
            .map(|to| self.target.rmse(&*to, self.form));
        // A point outside the square has the value at its edge plus a slope that leads the simplex
        // back.
        let outside: f64 = point.iter().map(|y| (y - y.clamp(0.0, 1.0)).abs()).sum();
        match rmse {
            Ok(rmse) if rmse.is_finite() => rmse * (1.0 + outside) + 1e-12 * outside,
            _ => f64::MAX,
        }
    }
}

impl CostFunction for &Problem<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, y: &f64) -> Result<f64, Error> {
        Ok(self.error(&[*y]))
    }
}

/// The same problem for the minimiser of several variables.
struct Simplex<'a>(&'a Problem<'a>);

impl CostFunction for Simplex<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.0.error(point))
    }
}
