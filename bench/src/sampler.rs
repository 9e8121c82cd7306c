//! The samplers that are compared, each as a function over slices, with the data to judge it.

use std::cell::RefCell;
use std::hint::black_box;

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::lobe::Bounded;
use microfacet_sampler::{Ggx, MicrofacetDistribution as _, StudentT, Tables};
use microfacet_tables::Table;

use crate::inputs::Stream;
use crate::rivals::bilinear::Bilinear;
use crate::rivals::lobe::Lobe;
use crate::rivals::stream::Drawer;
use crate::rivals::{beckmann, ggx};
use crate::settings::{GAMMA, SIGMA};
use crate::tables::Slices;

/// Normals for views and random numbers, as many as there are views.
pub(crate) type Draw<'a> = Box<dyn Fn(&[Vec3], &[[f32; 2]], &mut [Vec3]) + 'a>;

/// The normal of a view at two random numbers, in double precision.
pub(crate) type Exactly = fn(f64, DVec3, [f64; 2]) -> DVec3;

/// The reference for the normals of a sampler.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// The CDFs along and across the plane of incidence are the random numbers.
    Cdf,
    /// The same, but the tilt falls with the first number.
    Falling,
    /// The normal that the same formula gives in double precision.
    Formula(Exactly),
    /// None: its random numbers do not correspond to CDFs. It is exact in distribution, or does not
    /// draw visible normals at all.
    Distribution,
}

/// The density it draws from, for the weights of an estimator.
pub(crate) enum Density {
    /// Visible normals.
    Visible,
    /// All normals, D(m)(m·n).
    Ndf,
    /// Visible normals that may reflect upwards, of this material.
    Bounded(Box<Bounded>),
}

/// A sampler.
pub(crate) struct Sampler<'a> {
    /// Its name.
    pub(crate) name: String,
    /// The shape it draws from; roughness is [`SIGMA`].
    pub(crate) gamma: f64,
    /// Bytes of table that lookups touch.
    pub(crate) bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub(crate) stored: usize,
    /// Draws.
    pub(crate) draw: Draw<'a>,
    pub(crate) check: Check,
    pub(crate) density: Density,
}

impl<'a> Sampler<'a> {
    fn new(name: &str, gamma: f64, check: Check, draw: Draw<'a>) -> Self {
        Self {
            name: name.into(),
            gamma,
            bytes: 0,
            stored: 0,
            draw,
            check,
            density: Density::Visible,
        }
    }

    pub(crate) fn draws_visible_normals(&self) -> bool {
        matches!(self.density, Density::Visible)
    }

    fn tables(self, bytes: usize, stored: usize) -> Self {
        Self { bytes, stored, ..self }
    }
}

/// One call after the other. Each result is used by itself, so that the compiler neither drops a
/// call nor vectorises the loop: the calls of a path tracer lie apart.
pub(crate) fn each<'a>(one: impl Fn(Vec3, [f32; 2]) -> Vec3 + 'a) -> Draw<'a> {
    Box::new(move |v, u, m| {
        for ((v, u), m) in v.iter().zip(u).zip(m) {
            *m = black_box(one(*v, *u));
        }
    })
}

/// The same as a loop over arrays, which the compiler may turn into vectors. It does that with
/// closed forms that have no branches, and not with lookups.
pub(crate) fn in_a_loop<'a>(one: impl Fn(Vec3, [f32; 2]) -> Vec3 + 'a) -> Draw<'a> {
    Box::new(move |v, u, m| {
        for ((v, u), m) in v.iter().zip(u).zip(m) {
            *m = one(*v, *u);
        }
    })
}

fn streamed<'a>(seed: u64, one: impl Fn(Vec3, &mut Stream) -> Vec3 + 'a) -> Draw<'a> {
    let stream = RefCell::new(Stream::new(seed));
    Box::new(move |v, _, m| {
        let stream = &mut *stream.borrow_mut();
        for (v, m) in v.iter().zip(m) {
            *m = black_box(one(*v, stream));
        }
    })
}

/// Names that figures refer to.
pub(crate) const CAPS: &str = "GGX, spherical caps";
pub(crate) const BATCH: &str = "table, default, batch";
pub(crate) const INVERSION: &str = "inversion of the CDF, any gamma";
pub(crate) const INVERSION_SUM: &str = "inversion of the CDF, integer gamma";

/// All samplers, over the given tables.
pub(crate) fn samplers<'a>(slices: &'a Slices, seed: u64) -> Vec<Sampler<'a>> {
    let sigma = SIGMA as f32;
    let truth = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let drawer = || Drawer::new(SIGMA);
    let (any, four) = (Lobe::any(SIGMA, GAMMA), Lobe::four(SIGMA));
    let (exact, mixture, ndf) = (drawer(), drawer(), drawer());
    let doubles = move |v: Vec3, u: [f32; 2]| {
        truth.sample_visible_normal(v.as_dvec3(), u.map(f64::from)).as_vec3()
    };
    let closed = Ggx::new(SIGMA).expect("a constant");
    let (caps, listed): (Exactly, Exactly) = (ggx::double::caps, ggx::double::listed);
    let mut all = vec![
        Sampler::new(
            CAPS,
            2.0,
            Check::Formula(caps),
            each(move |v, u| ggx::single::caps(sigma, v, u)),
        ),
        Sampler::new(
            "GGX, spherical caps as listed",
            2.0,
            Check::Formula(listed),
            each(move |v, u| ggx::single::listed(sigma, v, u)),
        ),
        Sampler::new(
            "GGX, spherical caps as listed, in a loop",
            2.0,
            Check::Formula(listed),
            in_a_loop(move |v, u| ggx::single::listed(sigma, v, u)),
        ),
        Sampler::new(
            "GGX, Heitz 2018",
            2.0,
            Check::Formula(ggx::double::heitz),
            each(move |v, u| ggx::single::heitz(sigma, v, u)),
        ),
        Sampler::new(
            "GGX, closed form of the sampler crate",
            2.0,
            // It takes the listing's numbers in the other order: height first.
            Check::Formula(|sigma, v, [height, azimuth]| {
                ggx::double::caps(sigma, v, [azimuth, height])
            }),
            each(move |v, u| closed.sample_visible_normal(v, u)),
        ),
        Sampler::new(
            "Beckmann, numerical inversion",
            f64::INFINITY,
            Check::Falling,
            each(move |v, u| beckmann::sample(sigma, v, u)),
        ),
        Sampler::new(INVERSION, GAMMA, Check::Cdf, each(move |v, u| any.sample(v, u))),
        Sampler::new(INVERSION_SUM, GAMMA, Check::Cdf, each(move |v, u| four.sample(v, u))),
        Sampler::new("inversion of the CDF, to rounding in f64", GAMMA, Check::Cdf, each(doubles)),
        Sampler::new(
            "exact by rejection",
            GAMMA,
            Check::Distribution,
            streamed(seed, move |v, stream| exact.exact(v, stream)),
        ),
        Sampler::new(
            "mixture of Beckmanns",
            GAMMA,
            Check::Distribution,
            streamed(seed, move |v, stream| mixture.mixture(v, stream)),
        ),
        Sampler {
            density: Density::Ndf,
            ..Sampler::new(
                "all normals (NDF)",
                GAMMA,
                Check::Distribution,
                each(move |_, u| ndf.ndf(u)),
            )
        },
    ];
    all.extend(slices.each().map(|(name, set)| table(name, set)));
    all.extend(variants(&slices.default));
    for (name, set) in
        [("bilinear, default nodes", &slices.default), ("bilinear, high nodes", &slices.high)]
    {
        let plain = Bilinear::new(SIGMA, GAMMA, set);
        let bytes = plain.bytes();
        all.push(
            Sampler::new(name, GAMMA, Check::Cdf, each(move |v, u| plain.sample(v, u)))
                .tables(bytes, bytes),
        );
    }
    all
}

/// The batch over slices, and the sampler bounded to reflections.
fn variants<'a>(set: &Tables) -> [Sampler<'a>; 2] {
    let (batch, bounded) = (lobe(set, GAMMA), lobe(set, GAMMA));
    let (bytes, stored) = (batch.bytes(), stored(set));
    let draw: Draw = Box::new(move |v, u, m| batch.sample_batch(v, u, m).expect("of one length"));
    let bounded = bounded.bounded();
    let density = Density::Bounded(bounded.clone().into());
    let one = each(move |v, u| bounded.at(v).sample(u));
    let bounded =
        Sampler::new("table, default, bounded to reflections", GAMMA, Check::Distribution, one);
    [Sampler::new(BATCH, GAMMA, Check::Cdf, draw), Sampler { density, ..bounded }]
        .map(|sampler| sampler.tables(bytes, stored))
}

fn table<'a>(name: &str, set: &Tables) -> Sampler<'a> {
    let lobe = lobe(set, GAMMA);
    let (bytes, stored) = (lobe.bytes(), stored(set));
    Sampler::new(name, GAMMA, Check::Cdf, each(move |v, u| lobe.sample_visible_normal(v, u)))
        .tables(bytes, stored)
}

/// The lobe of γ from a set that covers it.
pub(crate) fn lobe(set: &Tables, gamma: f64) -> StudentT {
    set.student_t(SIGMA, gamma).expect("the sets were made for this shape")
}

/// Bytes that the tables for G1 and normals take in a file.
pub(crate) fn stored(set: &Tables) -> usize {
    let lookups = set.tables().iter().filter(|table| !table.kind.is_albedo());
    lookups.map(Table::stored_bytes).sum()
}
