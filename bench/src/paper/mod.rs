//! Figures 4 to 6 of Ribardière et al. 2017 (doi:10.1111/cgf.13137), repeated with tables: the time
//! of each form of masking, alone and as part of a renderer (figure 4), the error of the rational
//! approximation of masking (figure 5), and what that error changes in pictures of rough gold
//! (figure 6).

mod approximation;
mod draw;
mod forms;
mod integrated;
mod method;
mod pictures;
mod studio;
mod terminal;
mod times;

use microfacet_sampler::Tables;
use serde_json::{Value, json};

use self::integrated::{CLAIM, MEASURES, verdicts};
use crate::Failure;
use crate::files::csv;
use crate::settings::Settings;

pub(crate) use approximation::Approximation;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paper {
    times: Vec<times::Timing>,
    pub(crate) approximation: Vec<Approximation>,
    integrated: Vec<integrated::Integrated>,
    compared: Vec<pictures::Compared>,
}

impl Paper {
    /// Measures everything; `stage` is called with the name of each stage.
    pub(crate) fn measure(set: &Tables, settings: &Settings, stage: impl Fn(&str)) -> Self {
        stage("figure 4: times of the forms of masking, alone and in a renderer");
        let times = times::times(set, settings);
        stage("figure 5: the error of the rational approximation");
        let (approximation, integrated) =
            (approximation::approximation(set), integrated::integrated());
        stage("figure 6: pictures of rough gold");
        let compared = pictures::compared(set, settings);
        Self { times, approximation, integrated, compared }
    }

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
