//! The cliffs of the run-time crate: how much slower than its common case it can become.
//!
//! All times of this module take turns in one process, over the shapes of the sweep at one
//! roughness. Calls are in a plain loop over arrays, as a user's program has them.

mod times;

use microfacet_sampler::Tables;

use self::times::{Times, What, all, peeled, whole};
use crate::figures::{CONDUCTOR_AIM, CONDUCTOR_MUST, Figure};
use crate::settings::Settings;
use crate::sweep::Summary;

/// The figures; those of ellipsoids are of the sweep.
pub(crate) fn figures(set: &Tables, sweep: &[Summary], settings: &Settings) -> Vec<Figure> {
    let times = Times::measure(set, settings);
    let cliff = |function: &str| {
        sweep.iter().find(|summary| summary.worst.function == function).map(Summary::cliff)
    };
    let drop = |what| times.worst(what, peeled) / times.median(what, whole);
    let figure = |name, must, aim, reached| Figure { name, unit: "", must, aim, reached };
    let ratio = |name, must, aim, reached| figure(name, must, aim, Some(reached));
    use What::{
        Batch, BatchDown, BatchOfEnds, Bounded, BoundedBatch, Density, Sample, TableDensity,
    };
    let by_caps = |what, layout: usize| times.worst(what, whole) / times.caps[layout];
    let [ggx, ggx_of_components] = [0, 1].map(|layout| times.ggx[layout] / times.caps[layout]);
    let sample_of_components = by_caps(What::SampleOfComponents, 1);
    let of_density = times.worst(TableDensity, all) / times.median(Density, all);
    vec![
        ratio("Ggx sample / caps as listed", 1.0, 0.9, ggx),
        ratio("Ggx sample / caps, views by component", 1.0, 0.9, ggx_of_components),
        ratio("sample, worst gamma >= 1.8 / caps as listed", 1.25, 1.0, by_caps(Sample, 0)),
        ratio("sample, gamma >= 1.8 / caps, views by component", 1.25, 1.0, sample_of_components),
        ratio("sample, worst gamma < 1.8 / gamma >= 1.8", 2.0, 1.3, drop(Sample)),
        ratio("sample_batch, worst gamma < 1.8 / gamma >= 1.8", 3.0, 1.5, drop(Batch)),
        ratio(
            "sample_batch, 5 % of u at an end / random",
            1.3,
            1.1,
            times.ratio(BatchOfEnds, Batch),
        ),
        ratio(
            "sample_batch, views straight down / random",
            1.3,
            1.1,
            times.ratio(BatchDown, Batch),
        ),
        ratio("bounded, drawn once / sample", 1.6, 1.3, times.ratio(Bounded, Sample)),
        ratio("bounded, batch / sample_batch", 1.5, 1.5, times.ratio(BoundedBatch, Batch)),
        ratio(
            "conductor, worst gamma >= 1.8 / GGX by hand",
            CONDUCTOR_MUST,
            CONDUCTOR_AIM,
            times.worst(What::Conductor, whole) / times.by_hand,
        ),
        ratio("conductor, worst gamma < 1.8 / gamma >= 1.8", 2.0, 1.3, drop(What::Conductor)),
        ratio("table_pdf, worst gamma / visible_normal_pdf", 4.0, 2.0, of_density),
        figure("Ellipsoid g1, worst / common case", 4.0, 2.0, cliff("Ellipsoid::g1")),
        figure(
            "Ellipsoid sample, worst / common case",
            4.0,
            2.0,
            cliff("Ellipsoid::sample_visible_normal"),
        ),
    ]
}
