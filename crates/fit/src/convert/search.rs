//! The replacement with the least error, by a coarse scan and a minimiser.

use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Stage;

use super::target::{scan, tries};
use super::{ConvertError, Form, Replacement, Target};
use crate::minimise::{self, Stop};

/// The error is smooth, and known to rounding.
const STOP: Stop = Stop { width: 1e-9, spread: 1e-14 };

impl Target<'_> {
    /// The distribution of kind `to` with the least RMSE, all parameters fitted together; each
    /// distribution tried is one step of the stage, about as many as its progress expects.
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
