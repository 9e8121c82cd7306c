//! The time by γ and by σ of each form of masking, alone and in a renderer, after figure 4; and of
//! visible normals, which the paper does not draw.

use std::cell::RefCell;

use glam::Vec3;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::StudentT;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::Tables;
use microfacet_study::spheres::sky::Sky;

use super::forms::{Form, Line, Stage};
use super::method::Method;
use crate::clock::{self, Calls};
use crate::inputs::{Inputs, Stream};
use crate::rows::{Quantity, normals, values};
use crate::sampler::{self, Draw};
use crate::settings::{GAMMA, SIGMA, Settings};

/// Shapes at [`SIGMA`], and roughnesses at [`GAMMA`].
pub(super) const GAMMAS: [f64; 12] =
    [1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.5, 8.0, 12.0, 20.0, 30.0, 40.0];
pub(super) const SIGMAS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0];

/// What a time is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Timed {
    /// The method.
    pub(super) method: Method,
    /// Whether this is a point over γ (else over σ).
    pub(crate) by_gamma: bool,
    /// Its shape; of a closed form that has only one, that one.
    pub(crate) gamma: f64,
    /// Its roughness.
    pub(crate) sigma: f64,
}

/// The time of one method for one material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Timing {
    /// What is computed.
    pub(crate) quantity: Quantity,
    pub(crate) at: Timed,
    /// Nanoseconds a call; of a picture, for all of it.
    pub(crate) ns: f64,
}

/// Every method at every material, in turns.
pub(crate) fn times(set: &Tables, settings: &Settings) -> Vec<Timing> {
    let stage = Stage { film: settings.timed, sky: Sky::studio(), seed: settings.picture_seed() };
    let by_gamma = GAMMAS.map(|gamma| (true, gamma, SIGMA));
    let by_sigma = SIGMAS.map(|sigma| (false, GAMMA, sigma));
    let points: Vec<_> = by_gamma.into_iter().chain(by_sigma).collect();

    let (mut of_forms, mut g1, mut lines) = (vec![], vec![], vec![]);
    let mut add = |by_gamma, gamma, sigma, form| {
        let Form { method, g1: alone, line } = form;
        of_forms.push(Timed { method, by_gamma, gamma, sigma });
        g1.push(alone);
        lines.push(line);
    };
    for &(by_gamma, gamma, sigma) in &points {
        for form in stage.of_shape(set, gamma, sigma) {
            add(by_gamma, gamma, sigma, form);
        }
    }
    // Beckmann's closed form is compared with the table of its own shape.
    let beckmann = f64::INFINITY;
    add(true, beckmann, SIGMA, stage.table(set, beckmann, SIGMA));
    // Over γ the references are the same everywhere.
    for (by_gamma, sigma) in [(true, SIGMA)].into_iter().chain(SIGMAS.map(|sigma| (false, sigma))) {
        for (gamma, form) in stage.references(set, sigma) {
            add(by_gamma, gamma, sigma, form);
        }
    }
    let draws: Vec<(Timed, Draw)> = points
        .into_iter()
        .flat_map(|(by_gamma, gamma, sigma)| {
            let methods = samplers(set, gamma, sigma, settings.seed);
            methods
                .into_iter()
                .map(move |(method, draw)| (Timed { method, by_gamma, gamma, sigma }, draw))
        })
        .collect();

    let inputs = Inputs::new(settings.seed, settings.calls);
    let mut runs: Vec<Calls> = g1.iter().map(|evaluate| values(evaluate, &inputs)).collect();
    runs.extend(draws.iter().map(|(_, draw)| normals(draw, &inputs)));
    // There are so many that fewer rounds must suffice.
    let times = clock::medians(&mut runs, settings.rounds.div_ceil(8), settings.calls);
    let pictures = pictures(&lines, settings);
    let of_draws = draws.iter().map(|(at, _)| *at);
    let calls = of_forms.iter().copied().map(|at| (Quantity::G1, at));
    let calls = calls.chain(of_draws.map(|at| (Quantity::Normal, at))).zip(times);
    let whole = of_forms.iter().map(|at| (Quantity::Picture, *at)).zip(pictures);
    calls.chain(whole).map(|((quantity, at), ns)| Timing { quantity, at, ns }).collect()
}

/// Nanoseconds of a whole picture with each form, as the sum over its lines: a line takes less than
/// a time slice of the scheduler, so that most are not interrupted.
fn pictures(forms: &[Line], settings: &Settings) -> Vec<f64> {
    let edge = settings.timed.edge;
    let runs = forms.iter().flat_map(|form| {
        (0..edge).map(move |y| -> Calls { Box::new(move |calls| calls.for_each(|_| form(y))) })
    });
    let times = clock::medians(&mut runs.collect::<Vec<_>>(), settings.picture_rounds, 1);
    times.chunks(edge).map(|lines| lines.iter().sum()).collect()
}

/// The samplers of visible normals.
fn samplers(set: &Tables, gamma: f64, sigma: f64, seed: u64) -> [(Method, Draw<'static>); 3] {
    let truth = StudentT::new(sigma, gamma).expect("constants");
    let lobe = set.student_t(sigma, gamma).expect("the general set covers all shapes");
    let inversion = move |v: Vec3, u: [f32; 2]| {
        truth.sample_visible_normal(v.as_dvec3(), u.map(f64::from)).as_vec3()
    };
    let stream = RefCell::new(Stream::new(seed));
    let exact = move |v: Vec3, _| {
        let stream = &mut *stream.borrow_mut();
        truth.sample_visible_by_rejection(v.as_dvec3(), &mut || f64::from(stream.next())).as_vec3()
    };
    [
        (Method::Inversion, sampler::each(inversion)),
        (Method::Rejection, sampler::each(exact)),
        (Method::Table, sampler::each(move |v: Vec3, u| lobe.sample_visible_normal(v, u))),
    ]
}
