//! The cliffs of the run-time crate: how much slower than its common case it can become.
//!
//! All times of this module take turns in one process, over the shapes of the sweep at one
//! roughness. Calls are in a plain loop over arrays, as a user's program has them.

use std::hint::black_box;

use glam::Vec3;
use microfacet_sampler::{Ggx, MicrofacetDistribution, StudentT, Tables};

use crate::clock::{self, Calls};
use crate::figures::Figure;
use crate::inputs::Inputs;
use crate::rivals::ggx;
use crate::rows::normals;
use crate::sampler::{in_a_loop, lobe};
use crate::settings::{SIGMA, Settings};
use crate::sweep::Summary;
use crate::sweep::domain::{GAMMAS, Numbers, Views, WHOLE};

/// What is timed of a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Sample,
    Batch,
    /// 5 % of the pairs of random numbers have one of the two at an end.
    BatchOfEnds,
    /// All views are straight down.
    BatchDown,
    /// A normal bounded to reflections, its view prepared for it alone.
    Bounded,
    Density,
    TableDensity,
}

impl What {
    const ALL: [Self; 7] = [
        Self::Sample,
        Self::Batch,
        Self::BatchOfEnds,
        Self::BatchDown,
        Self::Bounded,
        Self::Density,
        Self::TableDensity,
    ];
}

/// Random inputs, and two classes that are not.
struct Classes {
    random: Inputs,
    ends: Inputs,
    down: Inputs,
}

impl Classes {
    fn new(settings: &Settings) -> Self {
        let random = Inputs::new(settings.seed, settings.calls);
        let numbers = Numbers::SomeAtEnds.draw(settings.seed, settings.calls);
        let views = Views::Down.draw(settings.seed, settings.calls);
        Self {
            ends: Inputs { numbers, ..random.clone() },
            down: Inputs { views, ..random.clone() },
            random,
        }
    }

    /// The calls of one kind, of a lobe.
    fn calls(&self, what: What, lobe: StudentT) -> Calls<'_> {
        let random = &self.random;
        match what {
            What::Sample => {
                normals(in_a_loop(move |v, u| lobe.sample_visible_normal(v, u)), random)
            }
            What::Batch => batch(lobe, random),
            What::BatchOfEnds => batch(lobe, &self.ends),
            What::BatchDown => batch(lobe, &self.down),
            What::Bounded => normals(in_a_loop(move |v, u| lobe.bounded(v).sample(u)), random),
            What::Density => densities(lobe, random, StudentT::visible_normal_pdf),
            What::TableDensity => densities(lobe, random, StudentT::table_pdf),
        }
    }
}

fn batch(lobe: StudentT, inputs: &Inputs) -> Calls<'_> {
    normals(move |v, u, m| lobe.sample_batch(v, u, m).expect("of one length"), inputs)
}

/// Densities of the normals that the lobe itself draws.
fn densities<'a>(
    lobe: StudentT,
    inputs: &'a Inputs,
    density: impl Fn(&StudentT, Vec3, Vec3) -> f32 + 'a,
) -> Calls<'a> {
    let mut m = vec![Vec3::ZERO; inputs.views.len()];
    lobe.sample_batch(&inputs.views, &inputs.numbers, &mut m).expect("of one length");
    let mut values = vec![0.0; m.len()];
    Box::new(move |at| {
        let arguments = inputs.views[at.clone()].iter().zip(&m[at.clone()]);
        for ((v, m), value) in arguments.zip(&mut values[at]) {
            *value = density(&lobe, *v, *m);
        }
        black_box(&mut values);
    })
}

/// Nanoseconds a call.
struct Times {
    /// GGX by spherical caps, as listed.
    caps: f64,
    /// The closed form of the run-time crate.
    ggx: f64,
    /// Everything of a lobe, by γ.
    lobes: Vec<(f64, What, f64)>,
}

impl Times {
    fn measure(set: &Tables, settings: &Settings) -> Self {
        let classes = Classes::new(settings);
        let sigma = SIGMA as f32;
        let ggx = Ggx::new(SIGMA).expect("a constant");
        let mut runs = vec![
            normals(in_a_loop(move |v, u| ggx::single::listed(sigma, v, u)), &classes.random),
            normals(in_a_loop(move |v, u| ggx.sample_visible_normal(v, u)), &classes.random),
        ];
        let of_lobes = GAMMAS.iter().flat_map(|&gamma| What::ALL.map(|what| (gamma, what)));
        let of_lobes: Vec<(f64, What)> = of_lobes.collect();
        runs.extend(of_lobes.iter().map(|&(gamma, what)| classes.calls(what, lobe(set, gamma))));
        // There are so many that fewer rounds must suffice.
        let times = clock::medians(&mut runs, settings.rounds.div_ceil(4), settings.calls);
        let lobes = of_lobes.iter().zip(&times[2..]).map(|(&(gamma, what), &ns)| (gamma, what, ns));
        Self { caps: times[0], ggx: times[1], lobes: lobes.collect() }
    }

    /// The times of one kind, of the shapes that are asked for.
    fn of(&self, what: What, shapes: Shapes) -> Vec<f64> {
        let of_kind = self.lobes.iter().filter(|&&(gamma, kind, _)| kind == what && shapes(gamma));
        of_kind.map(|&(_, _, ns)| ns).collect()
    }

    fn median(&self, what: What, shapes: Shapes) -> f64 {
        clock::median(self.of(what, shapes))
    }

    fn worst(&self, what: What, shapes: Shapes) -> f64 {
        self.of(what, shapes).into_iter().fold(0.0, f64::max)
    }

    /// The largest ratio of two times of the same shape.
    fn ratio(&self, what: What, to: What) -> f64 {
        let ratios = self.of(what, all).into_iter().zip(self.of(to, all)).map(|(a, b)| a / b);
        ratios.fold(0.0, f64::max)
    }
}

/// Some of the shapes.
type Shapes = fn(f64) -> bool;

fn all(_: f64) -> bool {
    true
}

/// Those with a heavy part in closed form.
fn peeled(gamma: f64) -> bool {
    gamma < WHOLE
}

/// Those that are tabulated as a whole.
fn whole(gamma: f64) -> bool {
    gamma >= WHOLE
}

/// The figures; those of ellipsoids are of the sweep.
pub(crate) fn figures(set: &Tables, sweep: &[Summary], settings: &Settings) -> Vec<Figure> {
    let times = Times::measure(set, settings);
    let cliff = |function: &str| {
        sweep.iter().find(|summary| summary.worst.function == function).map(Summary::cliff)
    };
    let drop = |what| times.worst(what, peeled) / times.median(what, whole);
    let figure = |name, must, aim, reached| Figure { name, unit: "", must, aim, reached };
    let ratio = |name, must, aim, reached| figure(name, must, aim, Some(reached));
    use What::{Batch, BatchDown, BatchOfEnds, Bounded, Density, Sample, TableDensity};
    let by_caps = times.worst(Sample, whole) / times.caps;
    let of_density = times.worst(TableDensity, all) / times.median(Density, all);
    vec![
        ratio("Ggx sample / caps as listed", 1.0, 0.9, times.ggx / times.caps),
        ratio("sample, worst gamma >= 1.8 / caps as listed", 1.25, 1.0, by_caps),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_compared_by_their_kind() {
        let lobes = [(1.6, 60.0, 40.0), (1.79, 50.0, 200.0), (1.8, 10.0, 30.0), (4.0, 20.0, 20.0)];
        let lobes = lobes.into_iter().chain([(f64::INFINITY, 30.0, 30.0)]);
        let both = |(gamma, a, b)| [(gamma, What::Sample, a), (gamma, What::Bounded, b)];
        let times = Times { caps: 1.0, ggx: 1.0, lobes: lobes.flat_map(both).collect() };
        assert_eq!(times.worst(What::Sample, peeled), 60.0);
        assert_eq!(times.worst(What::Sample, whole), 30.0);
        assert_eq!(times.median(What::Sample, whole), 20.0);
        assert_eq!(times.median(What::Sample, all), 30.0);
        assert_eq!(times.ratio(What::Bounded, What::Sample), 4.0);
    }
}
