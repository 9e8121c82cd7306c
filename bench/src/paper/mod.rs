//! Figures 4 to 6 of Ribardière et al. 2017 (doi:10.1111/cgf.13137), repeated with tables: the time
//! of each form of masking, alone and as part of a renderer (figure 4), the error of the rational
//! approximation of masking (figure 5), and what that error changes in pictures of rough gold
//! (figure 6).

mod approximation;
mod draw;
mod files;
mod forms;
mod integrated;
mod method;
mod pictures;
mod studio;
mod terminal;
mod times;

use microfacet_sampler::Tables;

use crate::settings::Settings;

pub(crate) use approximation::Approximation;

/// All that is measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paper {
    times: Vec<times::Timing>,
    pub(crate) approximation: Vec<Approximation>,
    integrated: Vec<integrated::Integrated>,
    compared: Vec<pictures::Compared>,
}

impl Paper {
    /// Measures everything; `stage` is told what comes next.
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
}
