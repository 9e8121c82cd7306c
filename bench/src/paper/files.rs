//! The figures as files: numbers as CSV, and drawings.

use serde_json::{Value, json};

use super::Paper;
use super::integrated::{CLAIM, MEASURES, Verdict, verdicts};
use crate::Failure;
use crate::csv::{csv, number};

impl Paper {
    /// Every file by its name.
    pub(crate) fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
        let mut files = vec![
            ("figure-4.csv", self.times_csv()?),
            ("figure-5.csv", self.approximation_csv()?),
            ("figure-5-integrated.csv", self.integrated_csv()?),
            ("figure-6.csv", self.compared_csv()?),
        ];
        files.extend(self.drawings()?);
        Ok(files)
    }

    fn times_csv(&self) -> Result<Vec<u8>, Failure> {
        let header = ["quantity", "by", "method", "gamma", "sigma", "ns"];
        csv(
            &header,
            self.times.iter().map(|time| {
                [
                    time.quantity.name().into(),
                    if time.at.by_gamma { "gamma" } else { "sigma" }.into(),
                    time.at.method.name().into(),
                    time.at.gamma.to_string(),
                    time.at.sigma.to_string(),
                    format!("{:.3}", time.ns),
                ]
            }),
        )
    }

    fn approximation_csv(&self) -> Result<Vec<u8>, Failure> {
        let header = ["gamma", "theta_degrees", "g1", "rational_error", "table_error"];
        csv(
            &header,
            self.approximation.iter().map(|at| {
                [
                    at.gamma.to_string(),
                    at.degrees.to_string(),
                    at.g1.to_string(),
                    number(at.rational_error),
                    number(at.table_error),
                ]
            }),
        )
    }

    fn integrated_csv(&self) -> Result<Vec<u8>, Failure> {
        let mut header = [""; 2 + MEASURES.len()];
        header[..2].copy_from_slice(&["gamma", "sigma"]);
        header[2..].copy_from_slice(&MEASURES.map(|measure| measure.column));
        csv(
            &header,
            self.integrated.iter().map(|at| {
                let of = |i: usize| match i {
                    0 => at.gamma.to_string(),
                    1 => at.sigma.to_string(),
                    _ => number(at.errors[i - 2]),
                };
                std::array::from_fn::<_, { 2 + MEASURES.len() }, _>(of)
            }),
        )
    }

    fn compared_csv(&self) -> Result<Vec<u8>, Failure> {
        let header = ["gamma", "form", "rmse", "relative_rmse", "rmse_steps", "max_steps"];
        let each =
            self.compared.iter().flat_map(|of| of.differences.iter().map(move |at| (of, at)));
        csv(
            &header,
            each.map(|(of, at)| {
                [
                    of.gamma.to_string(),
                    at.form.into(),
                    number(at.rmse),
                    number(at.relative),
                    number(at.steps),
                    number(at.most_steps),
                ]
            }),
        )
    }

    /// The same numbers as JSON, without the errors of single views and materials.
    pub(crate) fn json(&self) -> Value {
        // JSON has no infinity.
        let shape = |gamma: f64| if gamma.is_finite() { json!(gamma) } else { json!("inf") };
        let times = self.times.iter().map(|time| {
            json!({
                "quantity": time.quantity.name(), "method": time.at.method.name(),
                "by": if time.at.by_gamma { "gamma" } else { "sigma" },
                "gamma": shape(time.at.gamma), "sigma": time.at.sigma, "ns": time.ns,
            })
        });
        let measures = verdicts(&self.integrated).into_iter().map(|verdict| {
            let Verdict { measure, worst, gamma, sigma, below } = verdict;
            json!({
                "measure": MEASURES[measure].column, "formula": MEASURES[measure].formula,
                "largest": worst, "gamma": gamma, "sigma": sigma, "gammas_below_claim": below,
            })
        });
        let pictures = self.compared.iter().flat_map(|of| {
            of.differences.iter().map(move |at| {
                json!({
                    "gamma": of.gamma, "form": at.form, "rmse": at.rmse,
                    "relative_rmse": at.relative, "rmse_steps": at.steps,
                    "max_steps": at.most_steps,
                })
            })
        });
        json!({
            "figure_4": times.collect::<Vec<_>>(),
            "figure_5": { "claim": CLAIM, "measures": measures.collect::<Vec<_>>() },
            "figure_6": pictures.collect::<Vec<_>>(),
        })
    }
}
