//! Rough conductors that are compared, without compensation: a path tracer's two calls at a hit, a
//! sampled light and the evaluation of another that next-event estimation has chosen.

use std::hint::black_box;

use glam::Vec3;
use microfacet_core::schlick::schlick;
use microfacet_sampler::lobe::{Reflecting, Tabulated};
use microfacet_sampler::{
    Bsdf, BsdfSettings, Conductor, ConductorFresnel, Ggx, Metal, Tables, Transport,
};

use crate::clock::Calls;
use crate::inputs::Inputs;
use crate::rival::{Rival, lobe};
use crate::rivals::conductor::GgxConductor;
use crate::settings::{GAMMA, SIGMA};

/// F0 of Schlick's reflectance, by channel.
const F0: [f32; 3] = [0.9, 0.7, 0.3];

/// Names that figures refer to: the hand-written GGX and the table, with Schlick's reflectance and
/// with Fresnel's.
pub(crate) const SCHLICK: [&str; 2] = ["GGX by hand, Schlick", "table, default, Schlick"];
pub(crate) const EXACT: [&str; 2] = ["GGX by hand, exact Fresnel", "table, default, exact Fresnel"];

const OF_GGX: &str = "Ggx of the sampler crate, Schlick";

/// Views with numbers, and the lights of next-event estimation.
pub(crate) struct Hits {
    seen: Inputs,
    lights: Vec<Vec3>,
}

impl Hits {
    pub(crate) fn new(seed: u64, count: usize) -> Self {
        let lights = Inputs::new(seed.wrapping_add(1), count).views;
        Self { seen: Inputs::new(seed, count), lights }
    }

    /// Calls of `one` with a view, a light and a pair of numbers. Its results are used as sums,
    /// which stay in registers: to write a structure to memory would be timed too.
    fn calls<'a>(&'a self, one: impl Fn(Vec3, Vec3, [f32; 2]) -> [f32; 4] + 'a) -> Calls<'a> {
        Box::new(move |at| {
            let views = &self.seen.views[at.clone()];
            let hits = views.iter().zip(&self.lights[at.clone()]).zip(&self.seen.numbers[at]);
            for ((v, l), u) in hits {
                black_box(one(*v, *l, *u));
            }
        })
    }

    /// A conductor of the sampler crate.
    pub(crate) fn of_lobe<'a>(
        &'a self,
        lobe: impl Reflecting + Tabulated + 'a,
        fresnel: ConductorFresnel,
    ) -> Calls<'a> {
        let conductor = conductor(lobe, fresnel);
        self.calls(move |v, l, u| of_conductor(&conductor, v, l, u))
    }

    /// The evaluation alone, of a conductor of the sampler crate.
    fn evaluation_of_lobe<'a>(
        &'a self,
        lobe: impl Reflecting + Tabulated + 'a,
        fresnel: ConductorFresnel,
    ) -> Calls<'a> {
        let conductor = conductor(lobe, fresnel);
        self.calls(move |v, l, _| evaluated(conductor.eval_pdf(v, l, Transport::Radiance)))
    }

    /// GGX by hand.
    pub(crate) fn by_hand<'a>(&'a self, fresnel: impl Fn(f32) -> [f32; 3] + 'a) -> Calls<'a> {
        let rival = GgxConductor::new(SIGMA as f32, fresnel);
        self.calls(move |v, l, u| of_conductor_by_hand(&rival, v, l, u))
    }

    /// GGX by hand with Schlick's reflectance.
    pub(crate) fn by_hand_schlick(&self) -> Calls<'_> {
        self.by_hand(schlick_by_hand)
    }

    /// The evaluation alone, of GGX by hand with Schlick's reflectance.
    fn evaluation_by_hand(&self) -> Calls<'_> {
        let rival = GgxConductor::new(SIGMA as f32, schlick_by_hand);
        self.calls(move |v, l, _| evaluated(rival.eval_pdf(v, l)))
    }
}

/// A conductor of the sampler crate, without compensation.
#[inline(always)]
pub(crate) fn conductor<L: Reflecting + Tabulated>(
    lobe: L,
    fresnel: ConductorFresnel,
) -> Conductor<L> {
    Conductor::new(lobe, fresnel, BsdfSettings::new()).expect("no tables")
}

/// A sampled light and the evaluation of another.
#[inline(always)]
pub(crate) fn of_conductor(conductor: &impl Bsdf, v: Vec3, l: Vec3, u: [f32; 2]) -> [f32; 4] {
    let path = conductor.sample_with_pdf(v, 0.5, u, Transport::Radiance);
    let path = path.map(|(path, pdf)| (path.l.into(), path.weight, pdf));
    used(path, conductor.eval_pdf(v, l, Transport::Radiance))
}

/// The same of GGX by hand.
#[inline(always)]
pub(crate) fn of_conductor_by_hand(
    rival: &GgxConductor<impl Fn(f32) -> [f32; 3]>,
    v: Vec3,
    l: Vec3,
    u: [f32; 2],
) -> [f32; 4] {
    used(rival.sample(v, u), rival.eval_pdf(v, l))
}

/// Sums that depend on every number of both results.
#[inline(always)]
fn used(path: Option<(Vec3, [f32; 3], f32)>, (f, pdf): ([f32; 3], f32)) -> [f32; 4] {
    let (l, weight, drawn) = path.unwrap_or_default();
    [weight[0] + f[0], weight[1] + f[1], weight[2] + f[2], pdf + drawn + (l.x + l.y + l.z)]
}

fn evaluated(([r, g, b], pdf): ([f32; 3], f32)) -> [f32; 4] {
    [r, g, b, pdf]
}

/// Schlick's reflectance as renderers write it.
#[inline(always)]
pub(crate) fn schlick_by_hand(cos: f32) -> [f32; 3] {
    F0.map(|f0| schlick(f0, 1.0, cos))
}

/// Schlick's reflectance, the same for every rival.
pub(crate) fn schlick_fresnel() -> ConductorFresnel {
    ConductorFresnel::schlick(F0).expect("a constant")
}

/// All conductors: with Schlick's reflectance, which costs little, and with Fresnel's of gold.
pub(crate) fn conductors<'a>(set: &Tables, hits: &'a Hits) -> Vec<Rival<Calls<'a>>> {
    let ggx = || Ggx::new(SIGMA).expect("a constant");
    let table = |fresnel| hits.of_lobe(lobe(set, GAMMA), fresnel);
    let gold = ConductorFresnel::from(Metal::Gold);
    let schlick = schlick_fresnel();
    let form = Rival::form;
    vec![
        form(SCHLICK[0], 2.0, hits.by_hand_schlick()),
        form(OF_GGX, 2.0, hits.of_lobe(ggx(), schlick)),
        form(SCHLICK[1], GAMMA, table(schlick)).of(set),
        form(EXACT[0], 2.0, hits.by_hand(move |cos| gold.at(cos))),
        form("Ggx of the sampler crate, exact Fresnel", 2.0, hits.of_lobe(ggx(), gold)),
        form(EXACT[1], GAMMA, table(gold)).of(set),
    ]
}

/// f and density of a given light alone, with Schlick's reflectance; named as [`SCHLICK`].
pub(crate) fn evaluations<'a>(set: &Tables, hits: &'a Hits) -> Vec<Rival<Calls<'a>>> {
    let ggx = Ggx::new(SIGMA).expect("a constant");
    let schlick = schlick_fresnel();
    let form = Rival::form;
    vec![
        form(SCHLICK[0], 2.0, hits.evaluation_by_hand()),
        form(OF_GGX, 2.0, hits.evaluation_of_lobe(ggx, schlick)),
        form(SCHLICK[1], GAMMA, hits.evaluation_of_lobe(lobe(set, GAMMA), schlick)).of(set),
    ]
}
