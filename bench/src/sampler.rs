//! The samplers that are compared, each as a function over slices, with the data to judge it.

use std::cell::RefCell;
use std::hint::black_box;

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::lobe::{Batch as _, Bounded};
use microfacet_sampler::{Ggx, MicrofacetDistribution as _};

use crate::inputs::{COUNT, Stream};
use crate::rival::{Draw, Rival, each, in_a_loop, lobe};
use crate::rivals::beckmann;
use crate::rivals::bilinear::Bilinear;
use crate::rivals::ggx::{double, single};
use crate::rivals::lanes::{self, Width};
use crate::rivals::lobe::Lobe;
use crate::rivals::stream::Drawer;
use crate::settings::{GAMMA, SIGMA};
use crate::tables::{HIGH, Slices};
use crate::textures::Texture;

/// The normal of a view at two random numbers, in double precision.
pub(crate) type Exactly = fn(f64, DVec3, [f64; 2]) -> DVec3;

/// The reference for the normals of a sampler.
#[derive(Clone, Copy)]
pub(crate) enum Check {
    /// The CDFs along and across the plane of incidence are the random numbers.
    Cdf,
    /// The CDFs are the random numbers, but the tilt falls with the first.
    Falling,
    /// The normal that the same formula gives in double precision.
    Formula(Exactly),
    /// None: its random numbers do not correspond to CDFs. It is exact in distribution, or does not
    /// draw visible normals at all.
    Distribution,
}

/// The density that a sampler draws from, for the weights of an estimator.
pub(crate) enum Density {
    /// Visible normals.
    Visible,
    /// All normals, D(m)(m·n).
    Ndf,
    /// Visible normals that may reflect upwards, of this material.
    Bounded(Box<Bounded>),
}

/// How a sampler draws, and what it is judged by.
pub(crate) struct Sampler<'a> {
    pub(crate) draw: Draw<'a>,
    pub(crate) check: Check,
    pub(crate) density: Density,
}

/// A sampler of visible normals.
fn visible<'a>(name: &'static str, gamma: f64, check: Check, draw: Draw<'a>) -> Rival<Sampler<'a>> {
    Rival::form(name, gamma, Sampler { draw, check, density: Density::Visible })
}

/// The same sampler, of another density.
fn with_density<'a>(rival: Rival<Sampler<'a>>, density: Density) -> Rival<Sampler<'a>> {
    Rival { run: Sampler { density, ..rival.run }, ..rival }
}

/// A sampler of visible normals from a function for one view.
fn one<'a, M: Into<Vec3>>(
    name: &'static str,
    gamma: f64,
    check: Check,
    one: impl Fn(Vec3, [f32; 2]) -> M + 'a,
) -> Rival<Sampler<'a>> {
    visible(name, gamma, check, each(one))
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
/// In lanes, by width; a row each where the processor has the instructions.
pub(crate) const LANES: [(&str, Width); 2] =
    [("GGX, spherical caps, 4 lanes", Width::Four), ("GGX, spherical caps, 8 lanes", Width::Eight)];
pub(crate) const BATCH: &str = "table, default, batch";
pub(crate) const INVERSION: &str = "inversion of the CDF, any gamma";
pub(crate) const INVERSION_SUM: &str = "inversion of the CDF, integer gamma";

/// Samplers of another density than that of all visible normals, whose errors are not comparable.
pub(crate) const OTHERS: [&str; 2] =
    ["all normals (NDF)", "table, default, bounded to reflections"];

const FAMILY: &str = "table, family, sigma and gamma per call";

/// The numbers of the closed form are the listing's in the other order, height first.
pub(crate) fn closed(sigma: f64, v: DVec3, [height, azimuth]: [f64; 2]) -> DVec3 {
    double::caps(sigma, v, [azimuth, height])
}

/// The family at the σ and γ of all rivals, which it is told at every call.
fn of_family(slices: &Slices) -> Draw<'_> {
    let (family, texture) = (slices.family(), Texture::constant(COUNT));
    Box::new(move |v, u, m| {
        for ((([sigma, gamma], v), u), m) in texture.each().zip(v).zip(u).zip(m) {
            *m = black_box(family.at(sigma, gamma).sample_visible_normal(*v, *u)).into();
        }
    })
}

/// All samplers, over the given tables.
pub(crate) fn samplers(slices: &Slices, seed: u64) -> Vec<Rival<Sampler<'_>>> {
    let sigma = SIGMA as f32;
    let [of_caps, of_list, of_heitz, of_closed] =
        [double::caps as Exactly, double::listed, double::heitz, closed].map(Check::Formula);
    let listed = in_a_loop(move |v, u| single::listed(sigma, v, u));
    let ggx = Ggx::new(SIGMA).expect("a constant");
    let ggx = move |v, u| ggx.sample_visible_normal(v, u);
    let (any, four) = (Lobe::any(SIGMA, GAMMA), Lobe::four(SIGMA));
    let truth = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let doubles = move |v: Vec3, u: [f32; 2]| {
        truth.sample_visible_normal(v.as_dvec3(), u.map(f64::from)).as_vec3()
    };
    let [exact, mixture, ndf] = [(); 3].map(|()| Drawer::new(SIGMA));
    let exact = streamed(seed, move |v, stream| exact.exact(v, stream));
    let mixture = streamed(seed, move |v, stream| mixture.mixture(v, stream));
    let ndf = one(OTHERS[0], GAMMA, Check::Distribution, move |_, u| ndf.ndf(u));
    let mut all = vec![
        one(CAPS, 2.0, of_caps, move |v, u| single::caps(sigma, v, u)),
        one("GGX, spherical caps as listed", 2.0, of_list, move |v, u| single::listed(sigma, v, u)),
        visible("GGX, spherical caps as listed, in a loop", 2.0, of_list, listed),
        one("GGX, Heitz 2018", 2.0, of_heitz, move |v, u| single::heitz(sigma, v, u)),
        one("GGX, closed form of the sampler crate", 2.0, of_closed, ggx),
        one("Beckmann, numerical inversion", f64::INFINITY, Check::Falling, move |v, u| {
            beckmann::sample(sigma, v, u)
        }),
        one(INVERSION, GAMMA, Check::Cdf, move |v, u| any.sample(v, u)),
        one(INVERSION_SUM, GAMMA, Check::Cdf, move |v, u| four.sample(v, u)),
        one("inversion of the CDF, to rounding in f64", GAMMA, Check::Cdf, doubles),
        visible("exact by rejection", GAMMA, Check::Distribution, exact),
        visible("mixture of Beckmanns", GAMMA, Check::Distribution, mixture),
        with_density(ndf, Density::Ndf),
    ];
    all.extend(
        LANES.into_iter().filter_map(|(name, width)| {
            Some(visible(name, 2.0, of_caps, lanes::caps(width, sigma)?))
        }),
    );
    all.extend(slices.each().map(|(name, set)| {
        let lobe = lobe(set, GAMMA);
        one(name, GAMMA, Check::Cdf, move |v, u| lobe.sample_visible_normal(v, u)).of(set)
    }));
    let default = slices.default();
    let lobe = lobe(default, GAMMA);
    let bounded = lobe.clone().bounded();
    let density = Density::Bounded(bounded.clone().into());
    let batch: Draw = Box::new(move |v, u, m| lobe.sample_batch(v, u, m).expect("of one length"));
    all.push(visible(BATCH, GAMMA, Check::Cdf, batch).of(default));
    all.push(visible(FAMILY, GAMMA, Check::Cdf, of_family(slices)).of_family(slices));
    let bounded = one(OTHERS[1], GAMMA, Check::Distribution, move |v, u| bounded.at(v).sample(u));
    all.push(with_density(bounded, density).of(default));
    for (name, set) in
        [("bilinear, default nodes", default), ("bilinear, high nodes", slices.get(HIGH))]
    {
        let plain = Bilinear::new(SIGMA, GAMMA, set);
        let bytes = plain.bytes();
        let plain = one(name, GAMMA, Check::Cdf, move |v, u| plain.sample(v, u));
        all.push(Rival { bytes, stored: bytes, ..plain });
    }
    all
}
