//! The figures as files: numbers as CSV, and drawings.

use serde_json::{Value, json};

use super::Paper;
use super::integrated::{CLAIM, MEASURES, verdicts};
use crate::Failure;
use crate::files::csv;

impl Paper {
    /// Every file by its name.
    pub(crate) fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
        let measures = MEASURES.map(|measure| measure.column);
        let columns = [&["gamma", "sigma"][..], &measures].concat();
        let mut files = vec![
            ("figure-4.csv", csv(&[], &self.times)?),
            ("figure-5.csv", csv(&[], &self.approximation)?),
            ("figure-5-integrated.csv", csv(&columns, &self.integrated)?),
            ("figure-6.csv", csv(&[], self.compared.iter().flat_map(|of| &of.differences))?),
        ];
        files.extend(self.drawings()?);
        Ok(files)
    }

    /// The same numbers as JSON, without the errors of single views and materials.
    pub(crate) fn json(&self) -> Value {
        let pictures: Vec<_> = self.compared.iter().flat_map(|of| &of.differences).collect();
        json!({
            "figure_4": self.times,
            "figure_5": { "claim": CLAIM, "measures": verdicts(&self.integrated) },
            "figure_6": pictures,
        })
    }
}
