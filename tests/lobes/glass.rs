//! Dielectrics and plastics that are made at a hit, of σ and γ from textures, against those that
//! are bound to one σ and γ.

use std::f32::consts::TAU;
use std::sync::OnceLock;

use glam::Vec3;
use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    BindError, Bsdf, BsdfSettings, Compensation, Dielectric, DielectricAt, Family,
    FamilyDielectric, Masking, MaterialError, MicrofacetDistribution as _, Plastic, Tables,
    Transport,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::sets::{draft, recipe};

const MASKING: Masking = Masking::HeightCorrelated;
const SIGMA: [f32; 2] = [0.25, 0.35];
const GAMMA: [f32; 2] = [2.2, 2.8];
const GLASS: f64 = 1.5;
const BOTH: [Compensation; 2] = [Compensation::Turquin, Compensation::KullaConty];

struct Set {
    tables: Tables,
    family: Family,
    glass: FamilyDielectric,
    /// The same surface seen from its other side.
    cavity: FamilyDielectric,
}

fn set() -> &'static Set {
    static SET: OnceLock<Set> = OnceLock::new();
    SET.get_or_init(|| {
        let range = |[min, max]: [f32; 2]| format!("{{ min = {min}, max = {max} }}");
        let more = format!("fresnel = {{ dielectric = {GLASS} }}\nmasking = \"{MASKING}\"");
        let tables = draft(&recipe(&[["glass", &range(SIGMA), &range(GAMMA), &more]]));
        let family = tables.family().unwrap();
        let [glass, cavity] =
            [GLASS, 1.0 / GLASS].map(|eta| tables.family_dielectric(eta, MASKING).unwrap());
        Set { tables, family, glass, cavity }
    })
}

fn view(cos: f32) -> Vec3 {
    Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos)
}

/// σ and γ of the corners, of edges and of the inside of what is covered.
fn surfaces() -> impl Iterator<Item = (f32, f32)> {
    let along = |[a, b]: [f32; 2]| [0.0, 0.07, 0.5, 0.61, 1.0].map(|t| a + t * (b - a));
    along(GAMMA).into_iter().flat_map(move |gamma| along(SIGMA).map(|sigma| (sigma, gamma)))
}

const COSINES: [f32; 12] = [0.0, 1e-6, 1e-3, 0.05, 0.3, 0.6, 0.741, 0.749, 0.8, 0.95, 0.999, 1.0];

#[test]
fn shares_are_those_of_bound_albedos() {
    let Set { tables, glass, cavity, .. } = set();
    for (family, eta) in [(glass, GLASS), (cavity, 1.0 / GLASS)] {
        assert_eq!((family.eta(), family.masking()), (eta, MASKING));
        for (sigma, gamma) in surfaces() {
            let bound = tables.dielectric_albedo(sigma.into(), gamma.into(), eta, MASKING).unwrap();
            let at = family.at(sigma, gamma);
            for cos in COSINES {
                let v = view(cos);
                let sides =
                    [(at.outside(v), bound.outside.eval(v)), (at.inside(v), bound.inside.eval(v))];
                for (got, want) in sides {
                    let off = (0..2).map(|i| (got[i] - want[i]).abs()).fold(0.0, f32::max);
                    assert!(off < 3e-6, "{sigma} {gamma} {cos}: {got:?} for {want:?}");
                }
            }
        }
    }
}

#[test]
fn what_is_outside_is_clamped() {
    let Set { glass, .. } = set();
    let same = |a: (f32, f32), b: (f32, f32)| {
        let [a, b] = [a, b].map(|(sigma, gamma)| glass.at(sigma, gamma).outside(view(0.4)));
        assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{a:?} {b:?}");
    };
    same((0.01, 2.5), (SIGMA[0], 2.5));
    same((f32::NAN, 2.5), (SIGMA[0], 2.5));
    same((f32::INFINITY, 2.5), (SIGMA[1], 2.5));
    same((0.3, 1.501), (0.3, GAMMA[0]));
    same((0.3, f32::NAN), (0.3, GAMMA[0]));
    same((0.3, f32::INFINITY), (0.3, GAMMA[1]));
    let at = glass.at(0.3, 2.5);
    let grazing = at.inside(view(0.0));
    for v in [Vec3::NAN, Vec3::new(1.0, 0.0, -0.2)] {
        assert_eq!(at.inside(v), grazing);
    }
    assert!(glass.bytes() > 50_000 && glass.bytes() < 1 << 20, "{}", glass.bytes());
    assert!(size_of::<DielectricAt<'_>>() <= 512, "{}", size_of::<DielectricAt<'_>>());
}

/// f of a dielectric and of a plastic of a hit is that of bound ones.
#[test]
fn evaluation_is_that_of_bound_materials() {
    let Set { tables, family, glass, cavity } = set();
    let base = [0.9, 0.3, 0.0];
    for compensation in BOTH {
        let settings = BsdfSettings::new().compensated(compensation, tables);
        for (eta, albedo) in [(GLASS, glass), (1.0 / GLASS, cavity)] {
            for (sigma, gamma) in surfaces() {
                let lobe = || family.at(sigma, gamma);
                let at = albedo.at(sigma, gamma);
                let bound = tables.student_t(f64::from(sigma), f64::from(gamma)).unwrap();
                let pane = Dielectric::new(bound.clone(), eta, settings).unwrap();
                let coat = Plastic::new(bound, eta, base, settings).unwrap();
                let hit = Dielectric::at_hit(lobe(), at, compensation);
                let coated = Plastic::at_hit(lobe(), at, base, compensation);
                assert_eq!((hit.eta(), hit.masking(), coated.base()), (eta, MASKING, base));
                for (cos_v, cos_l) in [(0.9, 0.3), (0.2, 0.8), (0.05, 0.5)] {
                    let (v, l) = (
                        view(cos_v),
                        Vec3::new(0.0, 1.0, 1.0) * view(cos_l) + Vec3::Y * view(cos_l).x,
                    );
                    let check = |got: [f32; 3], want: [f32; 3]| {
                        for (got, want) in got.into_iter().zip(want) {
                            let off = (got - want).abs();
                            // Averages are interpolated between nodes.
                            assert!(
                                off < 1e-3 * want + 1e-6,
                                "{compensation:?} {eta} {sigma} {gamma} {v} {l}: {got} {want}"
                            );
                        }
                    };
                    for (v, l) in [(v, l), (v, -l), (-v, l), (-v, -l)] {
                        let f = |bsdf: &dyn Fn(Vec3, Vec3) -> [f32; 3]| bsdf(v, l);
                        check(
                            f(&|v, l| hit.eval(v, l, Transport::Radiance)),
                            f(&|v, l| pane.eval(v, l, Transport::Radiance)),
                        );
                        check(
                            f(&|v, l| coated.eval(v, l, Transport::Radiance)),
                            f(&|v, l| coat.eval(v, l, Transport::Radiance)),
                        );
                    }
                }
            }
        }
    }
}

/// A texture: σ and γ differ from sample to sample.
fn texture(random: &mut StdRng) -> (f32, f32) {
    let [s, t]: [f32; 2] = [random.random(), random.random()];
    (SIGMA[0] + s * (SIGMA[1] - SIGMA[0]), GAMMA[0] + t * (GAMMA[1] - GAMMA[0]))
}

/// A mean and its standard error.
struct Mean {
    mean: f64,
    error: f64,
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> Mean {
    let n = values.len() as f64;
    let [sum, squares] = values.fold([0.0; 2], |[sum, squares], x| [sum + x, squares + x * x]);
    let mean = sum / n;
    Mean { mean, error: ((squares / n - mean * mean).max(0.0) / n).sqrt() }
}

/// The mean weight of samples; and of lights drawn evenly over the sphere, what f and its density
/// integrate to.
fn furnace<B: Bsdf>(
    v: Vec3,
    texture: &impl Fn(&mut StdRng) -> (f32, f32),
    of: impl Fn(f32, f32) -> B,
) -> [Mean; 3] {
    const SAMPLES: usize = 100_000;
    let mut random = StdRng::seed_from_u64(11);
    let all: Vec<[f64; 3]> = (0..SAMPLES)
        .map(|_| {
            let (sigma, gamma) = texture(&mut random);
            let bsdf = of(sigma, gamma);
            let (choice, u) = (random.random(), [random.random(), random.random()]);
            let sample = bsdf.sample_with_pdf(v, choice, u, Transport::Importance);
            let weight = sample.map_or(0.0, |(sample, pdf)| {
                let l = Vec3::from(sample.l);
                assert!((l.length() - 1.0).abs() < 1e-5 && pdf > 0.0 && !sample.delta);
                sample.weight[0]
            });
            let z: f32 = 2.0 * random.random::<f32>() - 1.0;
            let (r, (sin, cos)) =
                (((1.0 - z) * (1.0 + z)).sqrt(), (TAU * random.random::<f32>()).sin_cos());
            let ([f, ..], pdf) =
                bsdf.eval_pdf(v, Vec3::new(r * cos, r * sin, z), Transport::Importance);
            [weight, 2.0 * TAU * f * z.abs(), 2.0 * TAU * pdf].map(f64::from)
        })
        .collect();
    [0, 1, 2].map(|i| mean(all.iter().map(|values| values[i])))
}

/// White surfaces whose σ and γ are drawn for each sample return all light, to 3e-3, by samples and
/// by evaluation, and lights are drawn with their density, whose integral is at least `least`.
fn closes(
    family: &Family,
    [glass, cavity]: [&FamilyDielectric; 2],
    texture: impl Fn(&mut StdRng) -> (f32, f32),
    least: f64,
) {
    let check = |what: &str, [weight, f, pdf]: [Mean; 3]| {
        let (mean, error) = (weight.mean, weight.error);
        println!("{what}: {mean:.5} +- {error:.5}, by f {:.4} +- {:.4}", f.mean, f.error);
        assert!(
            (mean - 1.0).abs() < 3e-3 + 3.0 * error && error < 2e-3,
            "{what}: {mean} +- {error}"
        );
        assert!((f.mean - mean).abs() < 4.5 * (f.error + error), "{what}: {} {mean}", f.mean);
        // Facets whose light passes through the surface again are part of no density.
        assert!(pdf.mean < 1.0 + 4.5 * pdf.error && pdf.mean > least, "{what}: {}", pdf.mean);
    };
    for compensation in BOTH {
        for cos in [0.04, 0.3, 0.75, 1.0] {
            for v in [view(cos), -view(cos)] {
                let pane = |sigma, gamma| {
                    let at = glass.at(sigma, gamma);
                    Dielectric::at_hit(family.at(sigma, gamma), at, compensation)
                };
                check(&format!("{compensation:?} pane {}", v.z), furnace(v, &texture, pane));
            }
        }
        for (albedo, cos) in [(glass, 0.04), (glass, 0.75), (cavity, 0.3)] {
            let coat = |sigma, gamma| {
                let at = albedo.at(sigma, gamma);
                Plastic::at_hit(family.at(sigma, gamma), at, [1.0; 3], compensation)
            };
            let what = format!("{compensation:?} coat {:.3} {cos}", albedo.eta());
            check(&what, furnace(view(cos), &texture, coat));
        }
    }
}

#[test]
fn a_furnace_closes_with_a_surface_for_each_sample() {
    let Set { family, glass, cavity, .. } = set();
    closes(family, [glass, cavity], texture, 0.85);
}

/// Common glass and plastic need no set of their own.
#[test]
fn a_furnace_closes_with_the_default_set() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    let of = |eta| tables.family_dielectric(eta, MASKING).unwrap();
    let all = |random: &mut StdRng| {
        let [s, t]: [f32; 2] = [random.random(), random.random()];
        (0.02 + 0.98 * s, 2.0 + 4.0 * t)
    };
    // An index between nodes.
    closes(&family, [1.37, 1.0 / 1.37].each_ref().map(|eta| of(*eta)).each_ref(), all, 0.6);
    // And bound to one material.
    let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
    let lobe = tables.student_t(0.4, 2.5).unwrap();
    let pane = Dielectric::new(lobe, 1.62, settings).unwrap();
    for v in [view(0.3), -view(0.3)] {
        let [weight, ..] = furnace(v, &all, |_, _| pane.clone());
        let Mean { mean, error } = weight;
        assert!((mean - 1.0).abs() < 3e-3 + 3.0 * error && error < 2e-3, "{mean} +- {error}");
    }
}

/// The tables of a set go before those of its fallback, which may be of more shapes, but coarser.
#[test]
fn own_tables_go_first() {
    let Set { tables, glass, .. } = set();
    let behind = tables.clone().with_fallback(&Tables::embedded());
    let same = behind.family_dielectric(GLASS, MASKING).unwrap();
    let common = Tables::embedded().family_dielectric(GLASS, MASKING).unwrap();
    let shares = |of: &FamilyDielectric| of.at(0.3, 2.5).inside(view(0.7));
    assert_eq!(shares(&same), shares(glass));
    assert_ne!(shares(&same), shares(&common));
    // What the set lacks is the fallback's.
    assert!(behind.family_dielectric(1.6, MASKING).is_ok());
}

/// What a sample weighs is what evaluation finds for its light.
#[test]
fn samples_and_evaluation_are_one_set() {
    let Set { family, glass, .. } = set();
    let mut random = StdRng::seed_from_u64(3);
    for _ in 0..20_000 {
        let (sigma, gamma) = texture(&mut random);
        let (at, lobe) = (glass.at(sigma, gamma), family.at(sigma, gamma));
        let v = view(0.2 + 0.8 * random.random::<f32>()) * if random.random() { 1.0 } else { -1.0 };
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        let check = |sample: Option<(microfacet_sampler::BsdfSample, f32)>,
                     found: &dyn Fn([f32; 3]) -> ([f32; 3], f32)| {
            let Some((sample, pdf)) = sample else { return };
            if sample.l[2].abs() < 0.1 || pdf > 1e3 {
                return;
            }
            let (f, found) = found(sample.l);
            let weight = f[1] * sample.l[2].abs() / found;
            let near = |a: f32, b: f32| (a / b - 1.0).abs() < 3e-3;
            assert!(near(found, pdf) && near(weight, sample.weight[1]), "{sample:?} {pdf} {found}");
        };
        let radiance = Transport::Radiance;
        let pane = Dielectric::at_hit(lobe, at, Compensation::KullaConty);
        check(pane.sample_with_pdf(v, choice, u, radiance), &|l| pane.eval_pdf(v, l, radiance));
        let coat = Plastic::at_hit(lobe, at, [0.2, 0.5, 0.9], Compensation::KullaConty);
        check(coat.sample_with_pdf(v, choice, u, radiance), &|l| coat.eval_pdf(v, l, radiance));
    }
}

#[test]
fn single_bounces_mirrors_and_bases_outside_their_range() {
    let Set { tables, family, glass, .. } = set();
    let (v, at) = (view(0.6), glass.at(0.3, 2.5));
    let l = Vec3::new(0.1, 0.3, 0.9).normalize();
    let eval = |bsdf: &dyn Fn() -> [f32; 3]| bsdf();
    // Without compensation that of `Dielectric::new`.
    let none = Dielectric::at_hit(family.at(0.3, 2.5), at, Compensation::None);
    let single = Dielectric::new(family.at(0.3, 2.5), GLASS, BsdfSettings::new()).unwrap();
    assert_eq!(
        eval(&|| none.eval(v, l, Transport::Radiance)),
        eval(&|| single.eval(v, l, Transport::Radiance))
    );
    // A coat of one bounce takes T and R from the tables, not by integration.
    let coat = Plastic::at_hit(family.at(0.3, 2.5), at, [0.5; 3], Compensation::None);
    let lobe = tables.student_t(0.3, 2.5).unwrap();
    let bound = Plastic::new(lobe, GLASS, [0.5; 3], BsdfSettings::new()).unwrap();
    let [got, want] = [coat.eval(v, l, Transport::Radiance), bound.eval(v, l, Transport::Radiance)];
    assert!((got[0] / want[0] - 1.0).abs() < 3e-3, "{got:?} {want:?}");
    // A mirror has no rough albedos, whatever the tables hold.
    for compensation in BOTH {
        let pane = Dielectric::at_hit(Smooth, at, compensation);
        assert!(pane.is_delta() && pane.eval(v, l, Transport::Radiance) == [0.0; 3]);
        let coat = Plastic::at_hit(Smooth, at, [0.5; 3], compensation);
        let bound = Plastic::new(Smooth, GLASS, [0.5; 3], BsdfSettings::new()).unwrap();
        let [got, want] =
            [coat.eval(v, l, Transport::Radiance), bound.eval(v, l, Transport::Radiance)];
        assert!((got[0] / want[0] - 1.0).abs() < 1e-6, "{got:?} {want:?}");
    }
    assert!(family.at(0.0, 2.5).is_effectively_smooth());
    let odd = Plastic::at_hit(family.at(0.3, 2.5), at, [-1.0, 7.0, f32::NAN], Compensation::None);
    assert_eq!(odd.base(), [0.0, 1.0, 0.0]);
}

/// Whatever a texture, a view or a random number is, results are finite and none is negative.
#[test]
fn corners_give_numbers() {
    let Set { family, glass, cavity, .. } = set();
    let odd = [0.0, -1.0, 1e-30, 0.3, 2.5, f32::INFINITY, f32::NAN];
    let views = [view(0.0), view(1e-7), view(0.5), Vec3::Z, Vec3::NAN, Vec3::ZERO];
    let numbers = [0.0, 0.5, 1.0, f32::NAN];
    let sound = |x: f32| x.is_finite() && x >= 0.0;
    for (sigma, gamma) in odd.into_iter().flat_map(|sigma| odd.map(|gamma| (sigma, gamma))) {
        for (albedo, compensation) in [glass, cavity].into_iter().flat_map(|a| BOTH.map(|b| (a, b)))
        {
            let (lobe, at) = (family.at(sigma, gamma), albedo.at(sigma, gamma));
            let pane = Dielectric::at_hit(lobe, at, compensation);
            let coat = Plastic::at_hit(lobe, at, [0.0, 0.5, 1.0], compensation);
            for (v, sign) in views.into_iter().flat_map(|v| [1.0, -1.0].map(|sign| (v, sign))) {
                for number in numbers {
                    let what = format!("{sigma} {gamma} {compensation:?} {v} {sign} {number}");
                    let (v, u) = (sign * v, [number, 1.0 - number]);
                    for transport in [Transport::Radiance, Transport::Importance] {
                        let samples = [
                            pane.sample_with_pdf(v, number, u, transport),
                            coat.sample_with_pdf(v, number, u, transport),
                        ];
                        for (sample, pdf) in samples.into_iter().flatten() {
                            assert!(sample.weight.into_iter().all(sound), "{what} {sample:?}");
                            assert!(pdf >= 0.0 && !pdf.is_nan(), "{what} {pdf}");
                        }
                        for l in views.into_iter().flat_map(|l| [l, -l]) {
                            let both =
                                [pane.eval_pdf(v, l, transport), coat.eval_pdf(v, l, transport)];
                            for (f, pdf) in both {
                                assert!(f.into_iter().all(sound), "{what} {l} {f:?}");
                                assert!(pdf >= 0.0 && !pdf.is_nan(), "{what} {l} {pdf}");
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_set_without_them_says_what_to_bake() {
    let embedded = Tables::embedded();
    let why = embedded.family_dielectric(2.4, MASKING).unwrap_err();
    assert!(matches!(
        why,
        BindError::Material(MaterialError::NoDielectricRange { nearest: Some(_), .. })
    ));
    let text = why.to_string();
    assert!(text.contains("fresnel = { dielectric = 2.4 }"), "{text}");
    assert!(text.contains("1.3") && text.contains("1.7"), "{text}");
    // An index that the set does not hold; it names what it has.
    let why = set().tables.family_dielectric(1.7, MASKING).unwrap_err().to_string();
    assert!(why.contains("index 1.5"), "{why}");
    let why = set().tables.family_dielectric(GLASS, Masking::Uncorrelated).unwrap_err();
    assert!(why.to_string().contains("uncorrelated"), "{why}");
    for eta in [0.0, -1.5, f64::NAN, f64::INFINITY] {
        let why = embedded.family_dielectric(eta, MASKING).unwrap_err();
        assert!(matches!(why, BindError::Index { .. }), "{why}");
    }
}
