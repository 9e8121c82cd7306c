//! The times that the cliffs are ratios of.

use std::cell::RefCell;
use std::hint::black_box;

use glam::Vec3;
use microfacet_sampler::{Ggx, MicrofacetDistribution, StudentT, Tables};

use crate::clock::{self, Calls};
use crate::conductors::{Hits, schlick_fresnel};
use crate::inputs::Inputs;
use crate::rivals::ggx;
use crate::rows::normals;
use crate::sampler::{in_a_loop, lobe};
use crate::settings::{SIGMA, Settings};
use crate::sweep::domain::{GAMMAS, Numbers, Views, WHOLE};

/// What is timed of a lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    Sample,
    /// The same, of views that are put together from three arrays of components.
    SampleOfComponents,
    Batch,
    /// 5 % of the pairs of random numbers have one of the two at an end.
    BatchOfEnds,
    /// All views are straight down.
    BatchDown,
    /// A normal bounded to reflections, its view prepared for it alone.
    Bounded,
    BoundedBatch,
    Density,
    TableDensity,
    /// A sampled light and the evaluation of another, of a conductor with Schlick's reflectance.
    Conductor,
}

impl What {
    const ALL: [Self; 10] = [
        Self::Sample,
        Self::SampleOfComponents,
        Self::Batch,
        Self::BatchOfEnds,
        Self::BatchDown,
        Self::Bounded,
        Self::BoundedBatch,
        Self::Density,
        Self::TableDensity,
        Self::Conductor,
    ];
}

/// Random inputs, and two classes that are not.
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
        let views = Views::Down.draw(settings.seed, settings.calls);
        Self {
            components: [0, 1, 2].map(|axis| random.views.iter().map(|v| v[axis]).collect()),
            ends: Inputs { numbers, ..random.clone() },
            down: Inputs { views, ..random.clone() },
            hits: Hits::new(settings.seed, settings.calls),
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
            What::SampleOfComponents => {
                self.of_components(move |v, u| lobe.sample_visible_normal(v, u))
            }
            What::Batch => batch(lobe, random),
            What::BatchOfEnds => batch(lobe, &self.ends),
            What::BatchDown => batch(lobe, &self.down),
            What::Bounded => {
                let bounded = lobe.bounded();
                normals(in_a_loop(move |v, u| bounded.at(v).sample(u)), random)
            }
            What::BoundedBatch => {
                let shares = RefCell::new(vec![0.0; random.views.len()]);
                let bounded = lobe.bounded();
                let batch = move |v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]| {
                    let shares = &mut shares.borrow_mut()[..v.len()];
                    bounded.sample_batch(v, u, m, shares).expect("of one length");
                };
                normals(batch, random)
            }
            What::Density => densities(lobe, random, StudentT::visible_normal_pdf),
            What::TableDensity => densities(lobe, random, StudentT::table_pdf),
            What::Conductor => self.hits.of_lobe(lobe, schlick_fresnel()),
        }
    }

    /// Calls over arrays of components. A renderer's view, too, comes from three registers; a
    /// function that is not inlined then finds it in memory in three parts.
    fn of_components<'a>(&'a self, one: impl Fn(Vec3, [f32; 2]) -> Vec3 + 'a) -> Calls<'a> {
        let [x, y, z] = &self.components;
        let numbers = &self.random.numbers;
        let mut normals = vec![Vec3::ZERO; numbers.len()];
        Box::new(move |at| {
            let [x, y, z] = [x, y, z].map(|a| &a[at.clone()]);
            let normals = &mut normals[at.clone()];
            for ((((x, y), z), u), m) in x.iter().zip(y).zip(z).zip(&numbers[at]).zip(&mut *normals)
            {
                *m = one(Vec3::new(*x, *y, *z), *u);
            }
            black_box(normals);
        })
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
pub(super) struct Times {
    /// GGX by spherical caps, as listed: of an array of views, and of arrays of components.
    pub(super) caps: [f64; 2],
    /// The closed form of the run-time crate, of the same.
    pub(super) ggx: [f64; 2],
    /// The conductor of GGX by hand, with Schlick's reflectance.
    pub(super) by_hand: f64,
    /// Everything of a lobe, by γ.
    lobes: Vec<(f64, What, f64)>,
}

impl Times {
    pub(super) fn measure(set: &Tables, settings: &Settings) -> Self {
        let classes = Classes::new(settings);
        let sigma = SIGMA as f32;
        let closed = Ggx::new(SIGMA).expect("a constant");
        // A closure for each use: one that is used twice is not inlined.
        let mut runs = vec![
            normals(in_a_loop(move |v, u| ggx::single::listed(sigma, v, u)), &classes.random),
            classes.of_components(move |v, u| ggx::single::listed(sigma, v, u)),
            normals(in_a_loop(move |v, u| closed.sample_visible_normal(v, u)), &classes.random),
            classes.of_components(move |v, u| closed.sample_visible_normal(v, u)),
            classes.hits.by_hand_schlick(),
        ];
        let of_lobes = GAMMAS.iter().flat_map(|&gamma| What::ALL.map(|what| (gamma, what)));
        let of_lobes: Vec<(f64, What)> = of_lobes.collect();
        runs.extend(of_lobes.iter().map(|&(gamma, what)| classes.calls(what, lobe(set, gamma))));
        // There are so many that fewer rounds must suffice.
        let times = clock::medians(&mut runs, settings.rounds.div_ceil(4), settings.calls);
        let lobes = of_lobes.iter().zip(&times[5..]).map(|(&(gamma, what), &ns)| (gamma, what, ns));
        Self {
            caps: [times[0], times[1]],
            ggx: [times[2], times[3]],
            by_hand: times[4],
            lobes: lobes.collect(),
        }
    }

    /// The times of one kind, of the shapes that are asked for.
    fn of(&self, what: What, shapes: Shapes) -> Vec<f64> {
        let of_kind = self.lobes.iter().filter(|&&(gamma, kind, _)| kind == what && shapes(gamma));
        of_kind.map(|&(_, _, ns)| ns).collect()
    }

    pub(super) fn median(&self, what: What, shapes: Shapes) -> f64 {
        clock::median(self.of(what, shapes))
    }

    pub(super) fn worst(&self, what: What, shapes: Shapes) -> f64 {
        self.of(what, shapes).into_iter().fold(0.0, f64::max)
    }

    /// The largest ratio of two times of the same shape.
    pub(super) fn ratio(&self, what: What, to: What) -> f64 {
        let ratios = self.of(what, all).into_iter().zip(self.of(to, all)).map(|(a, b)| a / b);
        ratios.fold(0.0, f64::max)
    }
}

/// Some of the shapes.
pub(super) type Shapes = fn(f64) -> bool;

pub(super) fn all(_: f64) -> bool {
    true
}

/// Those with a heavy part in closed form.
pub(super) fn peeled(gamma: f64) -> bool {
    gamma < WHOLE
}

/// Those that are tabulated as a whole.
pub(super) fn whole(gamma: f64) -> bool {
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
        let times = Times {
            caps: [1.0; 2],
            ggx: [1.0; 2],
            by_hand: 1.0,
            lobes: lobes.flat_map(both).collect(),
        };
        assert_eq!(times.worst(What::Sample, peeled), 60.0);
        assert_eq!(times.worst(What::Sample, whole), 30.0);
        assert_eq!(times.median(What::Sample, whole), 20.0);
        assert_eq!(times.median(What::Sample, all), 30.0);
        assert_eq!(times.ratio(What::Bounded, What::Sample), 4.0);
    }
}
