//! The cliffs of the run-time crate: how much slower than its common case it can become.
//!
//! All times of this module are taken in turns in one process, over the shapes of the sweep at one
//! roughness. Calls are in a plain loop over arrays, as in a user's program.

use std::cell::RefCell;
use std::hint::black_box;

use glam::Vec3;
use microfacet_sampler::lobe::{Batch, Tabulated};
use microfacet_sampler::{Ggx, MicrofacetDistribution, StudentT, Tables};

use crate::clock::{self, Calls};
use crate::conductors::{Hits, schlick_fresnel};
use crate::figures::{CONDUCTOR_AIM, CONDUCTOR_MUST, Figure};
use crate::inputs::Inputs;
use crate::rival::{in_a_loop, lobe, normals};
use crate::rivals::ggx::single::listed;
use crate::settings::{SIGMA, Settings};
use crate::sweep::Summary;
use crate::sweep::domain::{GAMMAS, Numbers, Views, WHOLE};

/// What is timed of a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Sample,
    /// `Sample`, with views assembled from three arrays of components.
    SampleOfComponents,
    Batch,
    /// 5 % of the pairs of random numbers have one of the two at an end.
    BatchOfEnds,
    /// All views are straight down.
    BatchDown,
    /// A normal bounded to reflections, with a view prepared for one draw.
    Bounded,
    BoundedBatch,
    Density,
    TableDensity,
    /// A sampled light and the evaluation of another, of a conductor with Schlick's reflectance.
    Conductor,
}

/// All figures; those of ellipsoids come from the sweep.
pub(crate) fn figures(set: &Tables, sweep: &[Summary], settings: &Settings) -> Vec<Figure> {
    use What::*;
    let times = Times::measure(set, settings);
    let cliff = |function: &str| {
        sweep.iter().find(|summary| summary.function == function).map(Summary::cliff)
    };
    let drop = |what| times.worst(what, peeled) / times.median(what, whole);
    let by_caps = |what, layout: usize| times.worst(what, whole) / times.caps[layout];
    let ggx = |layout: usize| times.ggx[layout] / times.caps[layout];
    let ratio = |name, must, aim, reached| Figure::ratio(name, must, aim, Some(reached));
    let components = by_caps(SampleOfComponents, 1);
    let [ends, down] = [BatchOfEnds, BatchDown].map(|what| times.ratio(what, Batch));
    let bounded = times.ratio(Bounded, Sample);
    let by_hand = times.worst(Conductor, whole) / times.by_hand;
    let density = times.worst(TableDensity, all) / times.median(Density, all);
    let (must, aim) = (CONDUCTOR_MUST, CONDUCTOR_AIM);
    let [g1, sample] = ["Ellipsoid::g1", "Ellipsoid::sample_visible_normal"].map(cliff);
    vec![
        ratio("Ggx sample / caps as listed", 1.0, 0.9, ggx(0)),
        ratio("Ggx sample / caps, views by component", 1.0, 0.9, ggx(1)),
        ratio("sample, worst gamma >= 1.8 / caps as listed", 1.25, 1.0, by_caps(Sample, 0)),
        ratio("sample, gamma >= 1.8 / caps, views by component", 1.25, 1.0, components),
        ratio("sample, worst gamma < 1.8 / gamma >= 1.8", 2.0, 1.3, drop(Sample)),
        ratio("sample_batch, worst gamma < 1.8 / gamma >= 1.8", 3.0, 1.5, drop(Batch)),
        ratio("sample_batch, 5 % of u at an end / random", 1.3, 1.1, ends),
        ratio("sample_batch, views straight down / random", 1.3, 1.1, down),
        ratio("bounded, drawn once / sample", 1.6, 1.3, bounded),
        ratio("bounded, batch / sample_batch", 1.5, 1.5, times.ratio(BoundedBatch, Batch)),
        ratio("conductor, worst gamma >= 1.8 / GGX by hand", must, aim, by_hand),
        ratio("conductor, worst gamma < 1.8 / gamma >= 1.8", 2.0, 1.3, drop(Conductor)),
        ratio("table_pdf, worst gamma / visible_normal_pdf", 4.0, 2.0, density),
        Figure::ratio("Ellipsoid g1, worst / common case", 4.0, 2.0, g1),
        Figure::ratio("Ellipsoid sample, worst / common case", 4.0, 2.0, sample),
    ]
}

/// Random inputs, and inputs of two other classes.
struct Classes {
    random: Inputs,
    /// The components of the random views.
    components: [Vec<f32>; 3],
    ends: Inputs,
    down: Inputs,
    hits: Hits,
}

impl Classes {
    fn new(settings: &Settings) -> Self {
        let random = Inputs::new(settings.seed, settings.calls);
        let numbers = Numbers::SomeAtEnds.draw(settings.seed, settings.calls);
        let views = Views::down().draw(settings.seed, settings.calls);
        Self {
            components: [0, 1, 2].map(|axis| random.views.iter().map(|v| v[axis]).collect()),
            ends: Inputs { numbers, ..random.clone() },
            down: Inputs { views, ..random.clone() },
            hits: Hits::new(settings.seed, settings.calls),
            random,
        }
    }

    /// Everything that is timed of a lobe, each with its own closure: one that is used twice is not
    /// inlined.
    fn of_lobe(&self, lobe: &StudentT) -> [(What, Calls<'_>); 10] {
        let random = &self.random;
        let [a, b, c] = [(); 3].map(|()| lobe.clone());
        let [one, many] = [(); 2].map(|()| lobe.clone().bounded());
        let shares = RefCell::new(vec![0.0; random.views.len()]);
        let bounded_batch = move |v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]| {
            let shares = &mut shares.borrow_mut()[..v.len()];
            many.sample_reflecting_batch(v, u, m, shares).expect("of one length");
        };
        let sample = in_a_loop(move |v, u| a.sample_visible_normal(v, u));
        let bounded = in_a_loop(move |v, u| one.at(v).sample(u));
        [
            (What::Sample, normals(sample, random)),
            (
                What::SampleOfComponents,
                self.of_components(move |v, u| b.sample_visible_normal(v, u)),
            ),
            (What::Batch, batch(lobe, random)),
            (What::BatchOfEnds, batch(lobe, &self.ends)),
            (What::BatchDown, batch(lobe, &self.down)),
            (What::Bounded, normals(bounded, random)),
            (What::BoundedBatch, normals(bounded_batch, random)),
            (What::Density, densities(lobe, random, StudentT::visible_normal_pdf)),
            (What::TableDensity, densities(lobe, random, StudentT::table_pdf)),
            (What::Conductor, self.hits.of_lobe(c, schlick_fresnel())),
        ]
    }

    /// Calls over arrays of components. A renderer's view comes from three registers as well; a
    /// function that is not inlined then finds it in memory in three parts.
    fn of_components<'a, M: Into<Vec3>>(
        &'a self,
        one: impl Fn(Vec3, [f32; 2]) -> M + 'a,
    ) -> Calls<'a> {
        let [x, y, z] = &self.components;
        let numbers = &self.random.numbers;
        let mut normals = vec![Vec3::ZERO; numbers.len()];
        Box::new(move |at| {
            let [x, y, z] = [x, y, z].map(|a| &a[at.clone()]);
            let normals = &mut normals[at.clone()];
            for ((((x, y), z), u), m) in x.iter().zip(y).zip(z).zip(&numbers[at]).zip(&mut *normals)
            {
                *m = one(Vec3::new(*x, *y, *z), *u).into();
            }
            black_box(normals);
        })
    }
}

fn batch<'a>(lobe: &StudentT, inputs: &'a Inputs) -> Calls<'a> {
    let lobe = lobe.clone();
    normals(move |v, u, m| lobe.sample_batch(v, u, m).expect("of one length"), inputs)
}

/// Densities of the normals that the lobe itself draws.
fn densities<'a>(
    lobe: &StudentT,
    inputs: &'a Inputs,
    density: impl Fn(&StudentT, Vec3, Vec3) -> f32 + 'a,
) -> Calls<'a> {
    let lobe = lobe.clone();
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
    /// GGX by spherical caps, as listed: of an array of views, and of arrays of components.
    caps: [f64; 2],
    /// The closed form of the run-time crate, for the same two inputs.
    ggx: [f64; 2],
    /// The conductor of GGX by hand, with Schlick's reflectance.
    by_hand: f64,
    /// The times of each [`What`], by γ.
    lobes: Vec<(f64, What, f64)>,
}

impl Times {
    fn measure(set: &Tables, settings: &Settings) -> Self {
        let classes = Classes::new(settings);
        let sigma = SIGMA as f32;
        let closed = Ggx::new(SIGMA).expect("a constant");
        let mut runs = vec![
            normals(in_a_loop(move |v, u| listed(sigma, v, u)), &classes.random),
            classes.of_components(move |v, u| listed(sigma, v, u)),
            normals(in_a_loop(move |v, u| closed.sample_visible_normal(v, u)), &classes.random),
            classes.of_components(move |v, u| closed.sample_visible_normal(v, u)),
            classes.hits.by_hand_schlick(),
        ];
        let mut of_lobes = Vec::new();
        for gamma in GAMMAS {
            for (what, calls) in classes.of_lobe(&lobe(set, gamma)) {
                of_lobes.push((gamma, what));
                runs.push(calls);
            }
        }
        // A quarter of the rounds, since there are many runs.
        let times = clock::medians(&mut runs, settings.rounds.div_ceil(4), settings.calls);
        let lobes = of_lobes.iter().zip(&times[5..]).map(|(&(gamma, what), &ns)| (gamma, what, ns));
        Self {
            caps: [times[0], times[1]],
            ggx: [times[2], times[3]],
            by_hand: times[4],
            lobes: lobes.collect(),
        }
    }

    /// The times of one kind over a selection of shapes.
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

/// A selection of shapes γ.
type Shapes = fn(f64) -> bool;

fn all(_: f64) -> bool {
    true
}

/// Shapes with a heavy part in closed form.
fn peeled(gamma: f64) -> bool {
    gamma < WHOLE
}

/// Shapes that are tabulated as a whole.
fn whole(gamma: f64) -> bool {
    gamma >= WHOLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_compared_by_their_kind() {
        let lobes = [(1.6, 60.0, 40.0), (1.79, 50.0, 200.0), (1.8, 10.0, 30.0), (4.0, 20.0, 20.0)];
        let lobes = lobes.into_iter().chain([(f64::INFINITY, 30.0, 30.0)]);
        let both = |(gamma, a, b)| [(gamma, What::Sample, a), (gamma, What::Bounded, b)];
        let lobes = lobes.flat_map(both).collect();
        let times = Times { caps: [1.0; 2], ggx: [1.0; 2], by_hand: 1.0, lobes };
        assert_eq!(times.worst(What::Sample, peeled), 60.0);
        assert_eq!(times.worst(What::Sample, whole), 30.0);
        assert_eq!(times.median(What::Sample, whole), 20.0);
        assert_eq!(times.median(What::Sample, all), 30.0);
        assert_eq!(times.ratio(What::Bounded, What::Sample), 4.0);
    }
}
