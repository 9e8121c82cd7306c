//! Parameters per hit: σ, or σ and γ, come from textures at every call, as in a renderer. Beside
//! them stands the lobe that is bound once, and GGX, whose constants are a few operations.

use std::hint::black_box;
use std::ops::Range;

use glam::Vec3;
use microfacet_sampler::albedo::{AlbedoAt, ShapeAlbedo};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Conductor, ConductorFresnel, Ggx, Masking, MicrofacetDistribution as _};

use crate::clock::Calls;
use crate::conductors::{
    conductor, of_conductor, of_conductor_by_hand, schlick_by_hand, schlick_fresnel,
};
use crate::error::{self, Error};
use crate::inputs::Inputs;
use crate::rival::{Rival, lobe};
use crate::rivals::conductor::GgxConductor;
use crate::rivals::lookup::Lookup;
use crate::sampler::{Check, closed};
use crate::settings::{GAMMA, SIGMA, Settings};
use crate::tables::Slices;
use crate::textures::{Hit, Surface, Texture};

/// Names that figures refer to.
pub(crate) const BOUND: &str = "sample, everything bound";
pub(crate) const OF_SIGMA: &str = "sample, sigma per hit";
pub(crate) const SMOOTH: &str = "sample, sigma and gamma of a smooth texture";
pub(crate) const RANDOM: &str = "sample, sigma and gamma random";
pub(crate) const PEELED: &str = "sample, sigma random, gamma random < 1.8";
const OF_GGX: &str = "sample of GGX, sigma per hit";
pub(crate) const ALBEDO: &str = "E, sigma and gamma random";
pub(crate) const BOUND_ALBEDO: &str = "E, one sigma, one shape";
pub(crate) const ALBEDO_OF_SHAPE: &str = "E, sigma random, one shape";
pub(crate) const LOOKUP: &str = "E of GGX, 32 x 32 bilinear lookup";

/// Of the errors of E, whose model is a quadrature, one hit in this many.
const EVERY: usize = 32;

/// Stands for a γ that varies from hit to hit.
const VARIES: f64 = f64::NAN;

/// One call for each of a range of hits, into as many results.
type Each<'a, T> = Box<dyn Fn(Range<usize>, &mut [T]) + 'a>;

/// What is computed at a hit, and how it is judged.
enum What<'a> {
    Normal(Each<'a, Vec3>, Check),
    G1(Each<'a, f32>),
    D(Each<'a, f32>),
    Albedo(Each<'a, f32>),
    Conductor(Each<'a, [f32; 4]>),
}

/// A computation at the hits of a surface.
pub(crate) struct PerHit<'a> {
    on: &'a Surface<'a>,
    what: What<'a>,
}

/// One surface for each kind of textures, and the albedo of one shape.
pub(crate) struct Surfaces<'a> {
    constant: Surface<'a>,
    of_sigma: Surface<'a>,
    ggx: Surface<'a>,
    smooth: Surface<'a>,
    whole: Surface<'a>,
    peeled: Surface<'a>,
    shape: ShapeAlbedo<'a>,
}

impl<'a> Surfaces<'a> {
    pub(crate) fn new(
        slices: &'a Slices,
        inputs: &'a Inputs,
        lights: &'a Inputs,
        settings: &Settings,
    ) -> Self {
        let &Settings { calls, seed, .. } = settings;
        let on = |texture| Surface::new(slices.family(), inputs, lights, texture);
        Self {
            constant: on(Texture::constant(calls)),
            of_sigma: on(Texture::of_sigma(seed, calls, GAMMA)),
            ggx: on(Texture::of_sigma(seed, calls, 2.0)),
            smooth: on(Texture::smooth(calls)),
            whole: on(Texture::whole(seed, calls)),
            peeled: on(Texture::peeled(seed, calls)),
            shape: (slices.whole().shape_albedo(GAMMA, Masking::HeightCorrelated))
                .expect("it has every shape"),
        }
    }
}

impl<'a> PerHit<'a> {
    /// As the clock runs it.
    pub(crate) fn calls(&'a self) -> Calls<'a> {
        let count = self.on.len();
        match &self.what {
            What::Normal(each, _) => calls(each, count),
            What::G1(each) | What::D(each) | What::Albedo(each) => calls(each, count),
            What::Conductor(each) => calls(each, count),
        }
    }

    /// The error over all hits, each compared with the model of its own σ and γ.
    pub(crate) fn error(&self) -> Option<Error> {
        let hits = || self.on.hits(0..self.on.len());
        let truth = |hit: &Hit| error::material(hit.sigma.into(), hit.gamma.into());
        match &self.what {
            What::Normal(_, Check::Distribution) | What::Conductor(_) => None,
            What::Normal(each, check) => {
                let one =
                    |(hit, m): (Hit, Vec3)| error::cdf_error(&truth(&hit), *check, hit.v, hit.u, m);
                Some(Error::of(hits().zip(self.all(each)).map(one)))
            }
            What::G1(each) => {
                let one = |(hit, g1)| error::g1_error(&truth(&hit), hit.v, g1);
                Some(Error::of(hits().zip(self.all(each)).map(one)))
            }
            What::D(each) => {
                let one = |(hit, d)| error::d_error(&truth(&hit), hit.m, d);
                Some(Error::of(hits().zip(self.all(each)).filter_map(one)))
            }
            What::Albedo(each) => {
                let some = hits().zip(self.all(each)).step_by(EVERY);
                Some(Error::of(some.map(|(hit, e)| error::e_error(&truth(&hit), hit.v, e))))
            }
        }
    }

    fn all<T: Clone + Default>(&self, each: &Each<T>) -> Vec<T> {
        let mut all = vec![T::default(); self.on.len()];
        each(0..all.len(), &mut all);
        all
    }
}

fn calls<'a, T: Clone + Default>(each: &'a Each<'a, T>, count: usize) -> Calls<'a> {
    let mut results = vec![T::default(); count];
    Box::new(move |at| {
        each(at.clone(), &mut results[at]);
        black_box(&mut results);
    })
}

/// One call after the other, each result used by itself, as for all rivals.
fn each<'a, T>(on: &'a Surface<'a>, one: impl Fn(Hit) -> T + 'a) -> Each<'a, T> {
    Box::new(move |at, results| {
        for (hit, result) in on.hits(at).zip(results) {
            *result = black_box(one(hit));
        }
    })
}

/// All computations at hits. The bound lobe and the family are of the general set.
pub(crate) fn per_hit<'a>(slices: &'a Slices, on: &'a Surfaces<'a>) -> Vec<Rival<PerHit<'a>>> {
    let mut all = samples(slices, on);
    all.extend(values(slices, on));
    all.extend(conductors(slices, on));
    all
}

fn form<'a>(
    name: &'static str,
    gamma: f64,
    on: &'a Surface<'a>,
    what: What<'a>,
) -> Rival<PerHit<'a>> {
    Rival::form(name, gamma, PerHit { on, what })
}

fn samples<'a>(slices: &'a Slices, on: &'a Surfaces<'a>) -> Vec<Rival<PerHit<'a>>> {
    let Surfaces { constant, of_sigma, ggx, smooth, whole, peeled, .. } = on;
    let (set, family) = (slices.whole(), slices.family());
    let [bound, shape] = [(); 2].map(|()| lobe(set, GAMMA));
    let bound = each(constant, move |hit| bound.sample_visible_normal(hit.v, hit.u).into());
    let shape = each(of_sigma, move |hit| {
        shape.with_roughness(hit.sigma).sample_visible_normal(hit.v, hit.u).into()
    });
    let of_ggx = each(ggx, move |hit| of_ggx(hit).sample_visible_normal(hit.v, hit.u).into());
    let general = |name, on, check| {
        let draw = each(on, move |hit: Hit| {
            family.at(hit.sigma, hit.gamma).sample_visible_normal(hit.v, hit.u).into()
        });
        form(name, VARIES, on, What::Normal(draw, check)).of_family(slices)
    };
    vec![
        form(BOUND, GAMMA, constant, What::Normal(bound, Check::Cdf)).of(set),
        form(OF_SIGMA, GAMMA, of_sigma, What::Normal(shape, Check::Cdf)).of(set),
        general(SMOOTH, smooth, Check::Cdf),
        general(RANDOM, whole, Check::Cdf),
        // The first number also chooses between the table and the heavy part.
        general(PEELED, peeled, Check::Distribution),
        form(OF_GGX, 2.0, ggx, What::Normal(of_ggx, Check::Formula(closed))),
    ]
}

/// G1, D and E.
fn values<'a>(slices: &'a Slices, on: &'a Surfaces<'a>) -> Vec<Rival<PerHit<'a>>> {
    let Surfaces { constant, of_sigma, ggx, whole, shape, .. } = on;
    let (set, family) = (slices.whole(), slices.family());
    let [a, b, c] = [(); 3].map(|()| lobe(set, GAMMA));
    let lookup = Lookup::new(set);
    let bytes = lookup.bytes();
    let g1 = What::G1(each(constant, move |hit| a.g1(hit.v)));
    let g1_of_sigma = What::G1(each(of_sigma, move |hit| b.with_roughness(hit.sigma).g1(hit.v)));
    let g1_at_hit = What::G1(each(whole, |hit| family.at(hit.sigma, hit.gamma).g1(hit.v)));
    let g1_of_ggx = What::G1(each(ggx, |hit| of_ggx(hit).g1(hit.v)));
    let d = What::D(each(constant, move |hit| c.d(hit.m)));
    let d_at_hit = What::D(each(whole, |hit| family.at(hit.sigma, hit.gamma).d(hit.m)));
    let d_of_ggx = What::D(each(ggx, |hit| of_ggx(hit).d(hit.m)));
    let volume = slices.albedo();
    // Of E alone.
    let touched = size_of_val(&shape.channels[0][..]);
    let prepared = shape.at(SIGMA as f32);
    let e = What::Albedo(each(constant, move |hit| prepared.albedo(hit.v)));
    let e_of_sigma = What::Albedo(each(of_sigma, |hit| shape.at(hit.sigma).albedo(hit.v)));
    let e_at_hit = What::Albedo(each(whole, |hit| volume.at(hit.sigma, hit.gamma).albedo(hit.v)));
    let e_of_ggx = What::Albedo(each(ggx, move |hit| lookup.at(hit.sigma, hit.v.z)));
    vec![
        form("G1, everything bound", GAMMA, constant, g1).of(set),
        form("G1, sigma per hit", GAMMA, of_sigma, g1_of_sigma).of(set),
        form("G1, sigma and gamma random", VARIES, whole, g1_at_hit).of_family(slices),
        form("G1 of GGX, sigma per hit", 2.0, ggx, g1_of_ggx),
        form("D, everything bound", GAMMA, constant, d).of(set),
        // No table of its shape.
        form("D, sigma and gamma random", VARIES, whole, d_at_hit),
        form("D of GGX, sigma per hit", 2.0, ggx, d_of_ggx),
        Rival { bytes: touched, ..form(BOUND_ALBEDO, GAMMA, constant, e) },
        Rival { bytes: touched, ..form(ALBEDO_OF_SHAPE, GAMMA, of_sigma, e_of_sigma) },
        Rival { bytes: volume.bytes(), ..form(ALBEDO, VARIES, whole, e_at_hit) },
        Rival { bytes, stored: bytes, ..form(LOOKUP, 2.0, ggx, e_of_ggx) },
    ]
}

/// A sampled light and the evaluation of another, of conductors that are made at the hit, with
/// Schlick's reflectance.
fn conductors<'a>(slices: &'a Slices, on: &'a Surfaces<'a>) -> Vec<Rival<PerHit<'a>>> {
    let Surfaces { constant, of_sigma, ggx, whole, .. } = on;
    let (set, family, fresnel) = (slices.whole(), slices.family(), schlick_fresnel());
    let [bound, shape] = [(); 2].map(|()| lobe(set, GAMMA));
    let bound = conductor(bound, fresnel);
    let bound = each(constant, move |hit| of_conductor(&bound, hit.v, hit.l, hit.u));
    let shape = each(of_sigma, move |hit| {
        let conductor = at_hit(shape.with_roughness(hit.sigma), fresnel);
        of_conductor(&conductor, hit.v, hit.l, hit.u)
    });
    let general = each(whole, move |hit| {
        let conductor = at_hit(family.at(hit.sigma, hit.gamma), fresnel);
        of_conductor(&conductor, hit.v, hit.l, hit.u)
    });
    let of_ggx =
        each(ggx, move |hit| of_conductor(&at_hit(of_ggx(hit), fresnel), hit.v, hit.l, hit.u));
    let by_hand = each(ggx, |hit| {
        of_conductor_by_hand(&GgxConductor::new(hit.sigma, schlick_by_hand), hit.v, hit.l, hit.u)
    });
    let [bound, shape, general, of_ggx, by_hand] =
        [bound, shape, general, of_ggx, by_hand].map(What::Conductor);
    vec![
        form("conductor, everything bound", GAMMA, constant, bound).of(set),
        form("conductor, sigma per hit", GAMMA, of_sigma, shape).of(set),
        form("conductor, sigma and gamma random", VARIES, whole, general).of_family(slices),
        form("conductor of Ggx, sigma per hit", 2.0, ggx, of_ggx),
        form("conductor of GGX by hand, sigma per hit", 2.0, ggx, by_hand),
    ]
}

/// A conductor of one bounce, made at a hit.
#[inline(always)]
fn at_hit<'a, L: Reflecting>(lobe: L, fresnel: ConductorFresnel) -> Conductor<L, 3, AlbedoAt<'a>> {
    Conductor::at_hit(lobe, fresnel, Masking::HeightCorrelated)
}

/// The rival, made at a hit.
#[inline(always)]
fn of_ggx(hit: Hit) -> Ggx {
    Ggx::new(hit.sigma).expect("textures have sound roughnesses")
}
