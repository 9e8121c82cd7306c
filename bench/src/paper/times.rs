//! The time by γ and by σ of each computation of G1, alone and in a renderer, after figure 4; and
//! of visible normals, which figure 4 does not show.

use std::cell::RefCell;

use glam::Vec3;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::StudentT;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::Tables;
use microfacet_study::spheres::sky::Sky;
use serde::{Serialize, Serializer};

use super::forms::{Line, Stage};
use super::method::Method;
use crate::clock::{self, Calls};
use crate::files::shape;
use crate::inputs::{Inputs, Stream};
use crate::rival::{Draw, each, normals, values};
use crate::rows::Quantity;
use crate::settings::{GAMMA, SIGMA, Settings};

/// Shapes at [`SIGMA`], and roughnesses at [`GAMMA`].
pub(super) const GAMMAS: [f64; 12] =
    [1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.5, 8.0, 12.0, 20.0, 30.0, 40.0];
pub(super) const SIGMAS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0];

/// The time of one method for one material: a line of `figure-4.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Timing {
    pub(crate) quantity: Quantity,
    /// Whether this is a point over γ (else over σ).
    #[serde(rename = "by", serialize_with = "coordinate")]
    pub(crate) by_gamma: bool,
    pub(super) method: Method,
    /// The shape; of a closed form for one shape, that shape.
    #[serde(serialize_with = "shape")]
    pub(crate) gamma: f64,
    pub(crate) sigma: f64,
    /// Nanoseconds a call; of a picture, for all of it.
    pub(crate) ns: f64,
}

fn coordinate<S: Serializer>(by_gamma: &bool, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(if *by_gamma { "gamma" } else { "sigma" })
}

/// Every method at every material, in turns.
pub(crate) fn times(set: &Tables, settings: &Settings) -> Vec<Timing> {
    let stage = Stage { film: settings.timed, sky: Sky::studio(), seed: settings.picture_seed() };
    let by_gamma = GAMMAS.map(|gamma| (true, gamma, SIGMA));
    let by_sigma = SIGMAS.map(|sigma| (false, GAMMA, sigma));
    let (mut forms, mut draws) = (vec![], vec![]);
    for at in by_gamma.into_iter().chain(by_sigma) {
        let (_, gamma, sigma) = at;
        forms.extend(stage.of_shape(set, gamma, sigma).into_iter().map(|form| (at, form)));
        draws.extend(samplers(set, gamma, sigma, settings.seed).map(|draw| (at, draw)));
    }
    // Beckmann's closed form is compared with the table of its own shape.
    let beckmann = f64::INFINITY;
    forms.push(((true, beckmann, SIGMA), stage.table(set, beckmann, SIGMA)));
    // Over γ the references are the same everywhere.
    for (by_gamma, sigma) in [(true, SIGMA)].into_iter().chain(SIGMAS.map(|sigma| (false, sigma))) {
        let references = stage.references(set, sigma).into_iter();
        forms.extend(references.map(|(gamma, form)| ((by_gamma, gamma, sigma), form)));
    }

    let inputs = Inputs::new(settings.seed, settings.calls);
    let mut runs: Vec<Calls> = forms.iter().map(|(_, form)| values(&form.g1, &inputs)).collect();
    runs.extend(draws.iter().map(|(_, (_, draw))| normals(draw, &inputs)));
    // An eighth of the rounds, since there are many runs.
    let times = clock::medians(&mut runs, settings.rounds.div_ceil(8), settings.calls);
    let (of_forms, of_draws) = times.split_at(forms.len());
    let timing = |quantity, (by_gamma, gamma, sigma), method, &ns: &f64| Timing {
        quantity,
        by_gamma,
        method,
        gamma,
        sigma,
        ns,
    };
    let g1 = forms.iter().zip(of_forms);
    let g1 = g1.map(|((at, form), ns)| timing(Quantity::G1, *at, form.method, ns));
    let normals = draws.iter().zip(of_draws);
    let normals = normals.map(|((at, (method, _)), ns)| timing(Quantity::Normal, *at, *method, ns));
    let pictures = pictures(forms.iter().map(|(_, form)| &form.line), settings);
    let whole = forms.iter().zip(&pictures);
    let whole = whole.map(|((at, form), ns)| timing(Quantity::Picture, *at, form.method, ns));
    g1.chain(normals).chain(whole).collect()
}

/// Nanoseconds of a whole picture with each form, as the sum over its lines: a line takes less than
/// a time slice of the scheduler, so that most are not interrupted.
fn pictures<'a>(lines: impl Iterator<Item = &'a Line<'a>>, settings: &Settings) -> Vec<f64> {
    let edge = settings.timed.edge;
    let runs = lines.flat_map(|line| {
        (0..edge).map(move |y| -> Calls { Box::new(move |calls| calls.for_each(|_| line(y))) })
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
        (Method::Inversion, each(inversion)),
        (Method::Rejection, each(exact)),
        (Method::Table, each(move |v: Vec3, u| lobe.sample_visible_normal(v, u))),
    ]
}
