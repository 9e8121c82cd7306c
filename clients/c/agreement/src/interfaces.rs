//! Compares dielectrics in C and C++ with the crate's: samples, f and densities, at random
//! directions of both sides and at corners; and checks what must hold of C alone.

use std::collections::BTreeMap;
use std::f32::consts::TAU;

use microfacet_sampler::lobe::{Reflecting, Tabulated};
use microfacet_sampler::{
    Bsdf, BsdfSettings, Compensation, Dielectric, DielectricAt, Event, Ggx, Masking, Plastic,
    Tables, Transport,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::foreign::{self, Found, Query};

const ETAS: [f32; 8] = [1.5, 1.0 / 1.5, 1.001, 1.0, 2.4, 1.000_001, 1e-3, 1e3];

/// The largest difference of a kind, and where it is.
type Worst = BTreeMap<&'static str, (f64, String)>;

/// What is added to densities and f by tables, before their differences are related to them.
const LEAST: f64 = 0.01;

/// Differences that are allowed: of one bounce, and by tables. These have shares of light to 1e-6,
/// which what is lost on average divides.
const LIMITS: &[(&str, [f64; 2])] = &[
    // Rounding decides whether a facet on the silhouette faces a view in the surface, as corners
    // have them, and whether one at the limit is steep.
    ("other events, share of samples", [1e-2; 2]),
    // Next to the normal rounding of the cosine is that of its square root across.
    ("light", [2e-5, 3e-4]),
    ("weight", [5e-5, 5e-3]),
    ("density, relative", [1e-4; 2]),
    ("f, relative", [1e-4, 5e-3]),
    ("index", [1e-6; 2]),
    ("sampled light by its facet", [1e-5; 2]),
    ("weight pdf - f cos, relative", [5e-2; 2]),
    ("reciprocity, relative", [1e-3; 2]),
    ("not finite", [0.0; 2]),
];

/// Compares `count` random points of each of the shapes, and corners; returns whether all is within
/// the limits. Compensations and plastics are those of the indices of the set at `glass`.
pub fn agree(gammas: &[f64], count: usize, glass: Option<&str>) -> bool {
    let (tables, each) = (Tables::embedded(), count.div_ceil(gammas.len()));
    let (mut worst, mut points) = (Worst::new(), 0);
    for (shape, &gamma) in gammas.iter().enumerate() {
        let queries = queries(&tables, gamma, each, shape as u64);
        points += queries.len();
        for found in foreign::dielectric(shape, None, &queries) {
            let model = |query: &Query| single(&tables, gamma, query);
            compare(&model, gamma, &queries, &found, &mut worst, false);
        }
    }
    println!("dielectrics of one bounce at {points} points of gamma {gammas:?}, C and C++");
    let mut good = print(&worst, false);
    let Some(glass) = glass else { return good };

    let set = Tables::from_bytes(&std::fs::read(glass).expect("a set")).expect("a set");
    for (table, eta) in foreign::indices().into_iter().enumerate() {
        let glass = set.family_dielectric(eta, Masking::HeightCorrelated).expect("its index");
        for (name, is_plastic) in [("dielectrics", false), ("plastics", true)] {
            let (mut worst, mut points) = (Worst::new(), 0);
            for (shape, &gamma) in gammas.iter().enumerate() {
                let random = each.min(20_000);
                let mut queries = queries(&tables, gamma, random, shape as u64);
                // Every seventh corner: albedos cost more.
                let mut index = 0;
                queries.retain(|_| {
                    index += 1;
                    index <= random || index % 7 == 0
                });
                for query in &mut queries {
                    (query.eta, query.masking) = (eta as f32, 1);
                    if is_plastic && query.v[2] < 0.0 {
                        query.v[2] = -query.v[2];
                    }
                }
                for (form, compensation) in FORMS.into_iter().enumerate() {
                    if compensation == Compensation::None && !is_plastic {
                        continue;
                    }
                    points += queries.len();
                    let model = |query: &Query| -> Box<dyn Model + '_> {
                        let stand_in = (query.sigma[0] * query.sigma[1]).sqrt();
                        let at = glass.at(stand_in, gamma as f32);
                        let sigma = query.sigma.map(f64::from);
                        if gamma == 2.0 {
                            hit(Ggx::new(sigma).unwrap(), at, compensation, is_plastic)
                        } else {
                            let lobe = tables.student_t(sigma, gamma).unwrap();
                            hit(lobe, at, compensation, is_plastic)
                        }
                    };
                    let all = if is_plastic {
                        foreign::plastic(shape, (table, form), BASE, &queries)
                    } else {
                        foreign::dielectric(shape, Some((table, form)), &queries)
                    };
                    for found in all {
                        compare(&model, gamma, &queries, &found, &mut worst, true);
                    }
                }
            }
            println!("{name} by a table of index {eta} at {points} points, C and C++");
            good &= print(&worst, true);
        }
    }
    good
}

const FORMS: [Compensation; 3] =
    [Compensation::None, Compensation::Turquin, Compensation::KullaConty];

/// The base of plastics.
const BASE: [f32; 3] = [0.2, 0.5, 1.0];

fn print(worst: &Worst, by_table: bool) -> bool {
    let mut good = true;
    for (name, limits) in LIMITS {
        let limit = &limits[usize::from(by_table)];
        let Some((difference, at)) = worst.get(name) else { continue };
        let fits = difference <= limit;
        good &= fits;
        let mark = if fits { "" } else { "  TOO MUCH" };
        println!("  {name:38} {difference:.1e} of {limit:.0e}{mark}  {at}");
    }
    good
}

/// A material of a hit by albedos from a table.
fn hit<'a, L: Tabulated + Reflecting + 'a>(
    lobe: L,
    at: DielectricAt<'a>,
    compensation: Compensation,
    is_plastic: bool,
) -> Box<dyn Model + 'a> {
    if is_plastic {
        Box::new(Whole(Plastic::at_hit(lobe, at, BASE, compensation)))
    } else {
        Box::new(Whole(Dielectric::at_hit(lobe, at, compensation)))
    }
}

fn masking(query: &Query) -> Masking {
    [Masking::Uncorrelated, Masking::HeightCorrelated][query.masking as usize]
}

fn transport(query: &Query) -> Transport {
    [Transport::Radiance, Transport::Importance][query.transport as usize]
}

fn of_lobe(lobe: impl Tabulated + 'static, query: &Query) -> Box<dyn Model> {
    let settings = BsdfSettings::new().with_masking(masking(query));
    Box::new(Whole(Dielectric::new(lobe, query.eta.into(), settings).unwrap()))
}

/// What is compared of the crate's materials.
trait Model {
    fn sample(&self, query: &Query, choice: f32) -> Option<Light>;
    fn eval(&self, v: [f32; 3], l: [f32; 3], transport: Transport) -> ([f32; 3], f32);
}

struct Light {
    event: i32,
    l: [f32; 3],
    weight: [f32; 3],
    pdf: f32,
    delta: bool,
    eta: f32,
}

struct Whole<B>(B);

impl<B: Bsdf> Model for Whole<B> {
    fn sample(&self, query: &Query, choice: f32) -> Option<Light> {
        let (s, pdf) = self.0.sample_with_pdf(query.v, choice, query.u, transport(query))?;
        let event = if s.event == Event::Reflection { 1 } else { 2 };
        Some(Light { event, l: s.l, weight: s.weight, pdf, delta: s.delta, eta: s.eta })
    }

    fn eval(&self, v: [f32; 3], l: [f32; 3], transport: Transport) -> ([f32; 3], f32) {
        self.0.eval_pdf(v, l, transport)
    }
}

/// The crate's dielectric of one bounce.
fn single(tables: &Tables, gamma: f64, query: &Query) -> Box<dyn Model> {
    let sigma = query.sigma.map(f64::from);
    if gamma == 2.0 {
        of_lobe(Ggx::new(sigma).unwrap(), query)
    } else {
        of_lobe(tables.student_t(sigma, gamma).unwrap(), query)
    }
}

fn direction(z: f32, turn: f32) -> [f32; 3] {
    let (r, (sin, cos)) = (((1.0 - z) * (1.0 + z)).sqrt(), (TAU * turn).sin_cos());
    [r * cos, r * sin, z]
}

/// Random queries, and all combinations of corners.
fn queries(tables: &Tables, gamma: f64, count: usize, seed: u64) -> Vec<Query> {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut uniform = move || rng.random::<f32>();
    let mut all = Vec::new();
    for i in 0..count {
        let mut sigma = || 10.0_f32.powf(-2.5 + 3.0 * uniform());
        let x = sigma();
        let sigma = if i % 2 == 0 { [x, x] } else { [x, sigma()] };
        let mut side = || if uniform() < 0.5 { 1.0 } else { -1.0 };
        let (a, b) = (side(), side());
        let mut query = Query {
            sigma,
            eta: ETAS[i % 5],
            v: direction(a * uniform(), uniform()),
            l: direction(b * uniform(), uniform()),
            choice: uniform(),
            u: [uniform(), uniform()],
            masking: i32::from(uniform() < 0.5),
            transport: i32::from(uniform() < 0.5),
        };
        // Mostly lights where there is some: those of another sample, a little aside.
        if i % 4 != 0 {
            let other = Query { u: [uniform(), uniform()], ..query };
            if let Some(light) = single(tables, gamma, &query).sample(&other, uniform()) {
                let aside = light.l.map(|x| x + 0.02 * (uniform() - 0.5));
                let length = aside.iter().map(|x| x * x).sum::<f32>().sqrt();
                query.l = aside.map(|x| x / length);
            }
        }
        all.push(query);
    }
    const NAN: f32 = f32::NAN;
    let views = [
        [0.6, 0.0, 0.8],
        [0.0, 0.6, -0.8],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.8, 0.6, 1e-10],
        [0.8, 0.6, -1e-6],
        [NAN, 0.0, 0.8],
        [0.6, 0.0, NAN],
        [0.0; 3],
    ];
    for sigma in [[1e-8; 2], [1e-4, 1e-5], [0.3, 0.3], [0.05, 0.6], [3.0, 3.0]] {
        for eta in ETAS {
            for v in views {
                for (i, l) in views.into_iter().enumerate() {
                    for choice in [0.0, 1.0, NAN, 0.4] {
                        let u = [[0.0, 0.0], [1.0, 1.0], [NAN, 0.5], [0.3, 0.7]][i % 4];
                        let (masking, transport) = ((i % 2) as i32, (i / 2 % 2) as i32);
                        all.push(Query { sigma, eta, v, l, choice, u, masking, transport });
                    }
                }
            }
        }
    }
    all
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    a.into_iter().zip(b).map(|(a, b)| f64::from(a) * f64::from(b)).sum()
}

fn compare<'a>(
    build: &dyn Fn(&Query) -> Box<dyn Model + 'a>,
    gamma: f64,
    all: &[Query],
    found: &[Found],
    worst: &mut Worst,
    by_table: bool,
) {
    let mut other = 0;
    for (query, found) in all.iter().zip(found) {
        let at = || format!("gamma {gamma} {query:?}");
        let mut note = |name: &'static str, difference: f64| {
            let entry = worst.entry(name).or_insert((0.0, String::new()));
            if !(difference <= entry.0) {
                *entry = (difference, at());
            }
        };
        let numbers = [&found.l[..], &found.m, &found.weight, &[found.pdf, found.eta]];
        let numbers = numbers.concat().into_iter().chain(found.f.concat()).chain(found.density);
        let mut bad = numbers.filter(|x| !x.is_finite());
        note("not finite", if bad.next().is_some() { 1.0 } else { 0.0 });

        let model = build(query);
        // Halfway between two nodes rounding decides from which the density is taken.
        let density = model.eval(query.v, found.l, transport(query)).1;
        if by_table && relative(found.density[2], density, f64::from(density) + LEAST) > 1e-2 {
            other += 1;
            continue;
        }
        // f and density at the same directions.
        let pairs = [(query.v, query.l), (query.l, query.v), (query.v, found.l)];
        for (i, (v, l)) in pairs.into_iter().enumerate() {
            let (f, pdf) = model.eval(v, l, transport(query));
            // Of shares of light the rounding is absolute.
            let least = if by_table { LEAST } else { 1e-30 };
            let scale = |x: f32| f64::from(x) + least;
            let mut off = relative(found.density[i], pdf, scale(pdf));
            if by_table && off > 1e-4 {
                // Of a σ halfway between two nodes that of either may be right.
                let other = |factor: f32| {
                    let sigma = query.sigma.map(|sigma| sigma * factor);
                    let pdf = build(&Query { sigma, ..*query }).eval(v, l, transport(query)).1;
                    relative(found.density[i], pdf, scale(pdf))
                };
                off = off.min(other(1.0 - 1e-6)).min(other(1.0 + 1e-6));
            }
            note("density, relative", off);
            for (got, want) in found.f[i].into_iter().zip(f) {
                note("f, relative", relative(got, want, scale(want)));
            }
        }
        // The sample. What is at a threshold may be another event.
        let near = |choice: f32| {
            let light = model.sample(query, choice);
            light.filter(|light| light.event == found.event)
        };
        let [low, high] = [query.choice - 1e-4, query.choice + 1e-4];
        let light = near(query.choice).or_else(|| near(low)).or_else(|| near(high));
        match light {
            None => {
                let absorbed = model.sample(query, query.choice).is_none();
                other += usize::from(!(absorbed && found.event == 0));
            }
            Some(light) => {
                // What a facet is off is multiplied by 1/η in its light.
                let apart = light.l.iter().zip(found.l).map(|(a, b)| (a - b).abs());
                note("light", (apart.fold(0.0, f32::max) * found.eta.min(1.0)).into());
                if light.delta == (found.is_delta != 0) {
                    // For views in the surface a mixture's weight takes densities that vary
                    // quickly with the facet.
                    let weights = found.weight.into_iter().zip(light.weight);
                    for (got, want) in weights.filter(|_| !by_table || query.v[2].abs() > 1e-3) {
                        note("weight", (f64::from(got) - f64::from(want)).abs());
                    }
                } else {
                    other += 1;
                }
                note("index", (light.eta / found.eta - 1.0).abs().into());
                if light.delta && found.pdf != light.pdf {
                    other += 1;
                }
            }
        }
        if !by_table {
            own(gamma, query, found, &mut note);
        }
    }
    let share = other as f64 / all.len() as f64;
    let entry = worst.entry("other events, share of samples").or_default();
    if share >= entry.0 {
        *entry = (share, format!("gamma {gamma}"));
    }
}

fn relative(got: f32, want: f32, scale: f64) -> f64 {
    // Equal infinities do not occur.
    (f64::from(got) - f64::from(want)).abs() / scale
}

/// What must hold of C alone.
fn own(gamma: f64, query: &Query, found: &Found, note: &mut impl FnMut(&'static str, f64)) {
    let eta_v = if query.v[2] > 0.0 { query.eta } else { 1.0 / query.eta };
    let (v, l, m) = (query.v, found.l, found.m);
    // The facet reflects or refracts the view to the light: v + l or v + η l is along m.
    if found.event != 0 && query.eta != 1.000_001 {
        let eta = if found.event == 1 { 1.0 } else { eta_v };
        let sum: [f64; 3] = std::array::from_fn(|i| f64::from(v[i]) + f64::from(eta * l[i]));
        let along: f64 = (0..3).map(|i| sum[i] * f64::from(m[i])).sum();
        let off: f64 = (0..3).map(|i| (sum[i] - along * f64::from(m[i])).powi(2)).sum();
        note("sampled light by its facet", off.sqrt() / f64::from(eta).max(1.0));
    }
    // Where the facet is found again from the view and the light.
    let far = (query.eta - 1.0).abs() > 0.1 && query.eta < 100.0 && query.eta > 0.01;
    if found.event != 0 && found.is_delta == 0 && far && found.m[2] > 1e-3 && dot(v, m).abs() > 1e-3
    {
        let product = found.weight[0] * found.pdf;
        let cosine = found.f[2][0] * l[2].abs();
        if product > 1e-20 && product < 1e20 {
            note("weight pdf - f cos, relative", relative(cosine, product, product.into()));
        }
    }
    let unit = |w: [f32; 3]| (dot(w, w) - 1.0).abs() < 1e-5;
    // For γ < 2 a facet may be steep as seen from one side alone.
    if far && gamma >= 2.0 && unit(query.v) && unit(query.l) && query.transport == 0 {
        let index2 = |w: [f32; 3]| if w[2] > 0.0 { 1.0 } else { query.eta * query.eta };
        let [a, b] =
            [found.f[0][0] / index2(query.v), found.f[1][0] / index2(query.l)].map(f64::from);
        if a.max(b) > 1e-15 && a.max(b) < 1e15 {
            note("reciprocity, relative", (a - b).abs() / a.max(b));
        }
    }
}
