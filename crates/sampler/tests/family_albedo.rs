//! The albedo at any roughness and shape against the stored one, and what is made of it.

use glam::Vec3;
use microfacet_sampler::albedo::{Albedo, AlbedoAt, FamilyAlbedo};
use microfacet_sampler::{
    Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Masking, StudentT, Tables,
    Transport,
};
use microfacet_tables::{Interval, Kind, Reflectance, Roughness, Table};

fn view(cos: f32) -> Vec3 {
    Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos)
}

/// n numbers from a to b, at even ratios.
fn ratios(a: f64, b: f64, n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |i| a * (b / a).powf(i as f64 / (n - 1) as f64))
}

/// σ and cos θ over which errors are measured: of roughnesses that matter and of all.
fn sigmas() -> Vec<f32> {
    let all = ratios(1e-8, 3.0, 60).chain(ratios(0.0101, 2.97, 70));
    all.map(|x| (x as f32).clamp(1e-8, 3.0)).collect()
}

fn cosines() -> Vec<f32> {
    let grazing = ratios(1e-4, 0.02, 12);
    let all = grazing.chain((0..=49).map(|i| 0.02 + 0.02 * f64::from(i)));
    // The cusp at the normal of small γ.
    all.chain([0.997, 0.999, 0.9999]).map(|x| (x as f32).min(1.0)).collect()
}

/// The largest differences of E, bias and F82 for σ ≥ 0.01 and cos θ ≥ 0.02, and elsewhere.
#[derive(Default)]
struct Worst([[f32; 3]; 2]);

impl Worst {
    fn add(&mut self, sigma: f32, stored: &Albedo, at: &AlbedoAt<'_>) {
        for cos in cosines() {
            let (a, b) = (stored.moments(view(cos)), at.moments(view(cos)));
            let lost = (stored.lost(view(cos)) - at.lost(view(cos))).abs();
            let part = usize::from(!(sigma >= 0.01 && cos >= 0.02));
            let all = [lost, (a.bias - b.bias).abs(), (a.f82 - b.f82).abs()];
            for (worst, x) in self.0[part].iter_mut().zip(all) {
                *worst = worst.max(x);
            }
            assert!((b.total() - at.albedo(view(cos))).abs() < 1e-6);
            assert!(b.scale >= 0.0 && b.bias >= 0.0 && b.f82 >= 0.0 && b.total() <= 1.0);
        }
    }
}

/// γ at and above a shape, which meet all places between two nodes.
fn near(gamma: f64) -> Vec<f64> {
    if gamma == f64::INFINITY {
        return [gamma, 900.0, 120.0, 55.0].to_vec();
    }
    (0..6).map(|i| 1.5 + (gamma - 1.5) * (1.0 + 0.05 * f64::from(i))).collect()
}

/// `-- --nocapture` prints the table of errors.
#[test]
fn it_is_the_stored_albedo_within_its_error() {
    // E, bias and F82 for σ ≥ 0.01 and cos θ ≥ 0.02; E and the larger of the others elsewhere.
    let promised = [
        (1.501, [2.5e-3, 2e-4, 4e-4], [5e-3, 2e-3]),
        (1.55, [7e-4, 3e-4, 4e-4], [1.5e-3, 1e-3]),
        (1.6, [3e-4, 3e-4, 4e-4], [1e-3, 1e-3]),
        (1.8, [5e-4, 3e-4, 7e-4], [5e-4, 1e-3]),
        (2.0, [3e-4, 3e-4, 6e-4], [3e-4, 1e-3]),
        (3.0, [4e-4, 3e-4, 6e-4], [4e-4, 1e-3]),
        (10.0, [5e-4, 3e-4, 7e-4], [1e-3, 1e-3]),
        (f64::INFINITY, [5e-4, 3e-4, 7e-4], [1.3e-3, 1.3e-3]),
    ];
    let tables = Tables::embedded();
    for masking in Masking::ALL {
        let family = tables.family_albedo(masking).unwrap();
        for (gamma, inside, outside) in promised {
            let mut worst = Worst::default();
            for gamma in near(gamma) {
                for sigma in sigmas() {
                    let stored = tables.albedo(sigma.into(), gamma, masking).unwrap();
                    worst.add(sigma, &stored, &family.at(sigma, gamma as f32));
                }
            }
            let [main, rest] = worst.0;
            let [a, b] = [main, rest].map(|all| all.map(|x| format!("{x:.1e}")).join(" "));
            println!("{masking:?} gamma {gamma}: {a}; elsewhere {b}");
            let within = |x: &[f32], most: &[f32]| x.iter().zip(most).all(|(x, most)| x <= most);
            let [e, bias, f82] = rest;
            assert!(within(&main, &inside), "{masking:?}, gamma {gamma}: {main:?}");
            assert!(within(&[e, bias.max(f82)], &outside), "{masking:?}, gamma {gamma}: {rest:?}");
        }
    }
}

#[test]
fn it_is_small() {
    let family = Tables::embedded().family_albedo(Masking::HeightCorrelated).unwrap();
    assert!((400_000..=512 * 1024).contains(&family.bytes()), "{}", family.bytes());
    assert!(size_of::<AlbedoAt<'_>>() <= 128);
    fn shared<T: Send + Sync + Clone>(_: &T) {}
    shared(&family);
}

#[test]
fn corners_and_what_is_outside() {
    for masking in Masking::ALL {
        let family = Tables::embedded().family_albedo(masking).unwrap();
        assert_eq!(family.masking(), masking);
        let lost = |sigma, gamma, cos| family.at(sigma, gamma).lost(view(cos));
        // A mirror loses nothing, at grazing too, and compensates nothing.
        for sigma in [0.0, -0.0, -1.0] {
            for gamma in [1.501, 2.0, f32::INFINITY, f32::NAN] {
                let mirror = family.at(sigma, gamma);
                for cos in [0.0, 1e-8, 0.3, 1.0] {
                    assert_eq!((mirror.albedo(view(cos)), mirror.lost(view(cos))), (1.0, 0.0));
                    assert_eq!(mirror.moments(view(cos)).total(), 1.0);
                }
                assert_eq!((mirror.lost_average(), mirror.albedo_average()), (0.0, 1.0));
                assert_eq!(mirror.compensation(view(0.3), view(0.4)), 0.0);
                assert_eq!(mirror.turquin(view(0.1), 1.0), 1.0);
            }
        }
        let inside = [(1e-8, 1.501), (1e-8, f32::INFINITY), (3.0, 1.501), (3.0, f32::INFINITY)];
        for (sigma, gamma) in inside {
            for cos in [0.0, 1e-30, 1e-8, 1e-3, 0.5, 1.0, 1.000_000_1] {
                let e = family.at(sigma, gamma).albedo([1.0 - cos, 0.0, cos]);
                assert!((0.0..=1.0).contains(&e), "{sigma} {gamma} {cos}: {e}");
            }
            let average = family.at(sigma, gamma).average_moments();
            assert!(average.total() <= 1.0 && average.f82 >= 0.0 && average.bias >= 0.0);
        }
        let same = |a: (f32, f32), b: (f32, f32)| {
            for cos in [0.0, 0.1, 0.8] {
                let off = lost(a.0, a.1, cos) - lost(b.0, b.1, cos);
                // 1.501 is not a number of single precision.
                assert!(off.abs() < 3e-6, "{a:?} {b:?}: {off}");
            }
            let [a, b] = [a, b].map(|(sigma, gamma)| family.at(sigma, gamma).lost_average());
            assert!((a - b).abs() < 3e-6, "{a} {b}");
        };
        same((1e-12, 2.0), (1e-8, 2.0));
        same((f32::NAN, 2.0), (1e-8, 2.0));
        same((9.0, 2.0), (3.0, 2.0));
        same((f32::INFINITY, 2.0), (3.0, 2.0));
        for gamma in [1.5, 1.0, -7.0, f32::NEG_INFINITY, f32::NAN] {
            same((0.3, gamma), (0.3, 1.501));
        }
        same((0.3, 1e30), (0.3, f32::INFINITY));
        // A view below the horizon, or NaN, is the grazing one.
        let at = family.at(0.3, 2.0);
        let grazing = at.lost([1.0, 0.0, 0.0]);
        assert_eq!([[0.6, 0.0, -0.8], [0.0, 1.0, f32::NAN]].map(|v| at.lost(v)), [grazing; 2]);
        // Continuous across nodes and octaves: the steps of a fine sweep are small.
        let (mut last, mut steepest) = (lost(0.2, 1.9, 0.1), 0.0_f32);
        for i in 0..20_000 {
            let next = lost(0.2 + 1e-4 * i as f32, 1.9 + 1e-3 * i as f32, 0.1 + 4e-5 * i as f32);
            steepest = steepest.max((next - last).abs());
            last = next;
        }
        assert!(steepest < 5e-4, "{steepest}");
    }
}

/// ∫ (1 − E) over the lights, cosine-weighted, in steps of the fourth root of tan(½ elevation).
fn lost_over_lights(at: &AlbedoAt<'_>) -> f64 {
    const STEPS: usize = 4000;
    let part = |i: usize| {
        let root = (i as f64 + 0.5) / STEPS as f64;
        let h = root.powi(4);
        let (cos, sin) = (2.0 * h / (1.0 + h * h), (1.0 - h * h) / (1.0 + h * h));
        let weight = 8.0 * cos * root.powi(3) * sin * (1.0 + sin) / STEPS as f64;
        weight * f64::from(at.lost([sin as f32, 0.0, cos as f32]))
    };
    (0..STEPS).map(part).sum()
}

#[test]
fn white_furnaces_close() {
    let tables = Tables::embedded();
    for masking in Masking::ALL {
        let family = tables.family_albedo(masking).unwrap();
        let (mut worst, mut smooth, mut far) = (0.0_f64, 0.0_f64, 0.0_f64);
        for gamma in [1.501, 1.503, 1.53, 1.6, 1.71, 1.83, 2.0, 2.2, 3.0, 4.7, 17.0, f32::INFINITY]
        {
            for sigma in ratios(1e-8, 3.0, 160) {
                let at = family.at(sigma as f32, gamma);
                let off = lost_over_lights(&at) / f64::from(at.lost_average()) - 1.0;
                for cos in [0.0, 1e-4, 0.02, 0.3, 1.0] {
                    // What returns besides E: (1 − E(v)) times the integral over lights.
                    let returned = f64::from(at.lost(view(cos))) * off.abs();
                    let into = if sigma >= 1e-5 { &mut worst } else { &mut smooth };
                    *into = into.max(returned);
                }
                if sigma >= 1e-3 {
                    let bound = tables.average_moments(sigma as f32 as f64, gamma.into(), masking);
                    let off = f64::from((bound.unwrap().total() - at.albedo_average()).abs());
                    far = far.max(off);
                }
            }
        }
        println!("{masking:?}: furnace {worst:.1e}, below 1e-5 {smooth:.1e}; average {far:.1e}");
        assert!(worst < 3e-3 && smooth < 1e-2 && far < 1.5e-3, "{worst} {smooth} {far}");
    }
}

/// The default set without some of its tables, or with others.
fn set_of(keep: impl Fn(&Table) -> bool) -> Tables {
    let set = Tables::embedded();
    let kept = set.tables().iter().filter(|table| keep(table)).cloned().collect();
    Tables::from_tables(set.provenance().clone(), kept).unwrap()
}

#[test]
fn sets_without_moments_are_refused() {
    let none = set_of(|table| table.kind != Kind::Albedo);
    for masking in Masking::ALL {
        let why = none.family_albedo(masking).unwrap_err().to_string();
        assert_eq!(why, none.shape_albedo(2.0, masking).unwrap_err().to_string());
        assert_eq!(why, none.albedo(0.3, 2.0, masking).unwrap_err().to_string());
    }
    let one = set_of(|table| table.subject.masking == Some(Masking::Uncorrelated));
    assert!(one.family_albedo(Masking::Uncorrelated).is_ok());
    let why = one.family_albedo(Masking::HeightCorrelated).unwrap_err().to_string();
    assert!(why.contains("masking"), "{why}");
    assert!(one.shape_albedo(1.4, Masking::Uncorrelated).is_err());
}

/// The default set, whose table of moments covers less.
fn narrow(gamma: [f64; 2], sigma: [f64; 2]) -> Tables {
    let set = Tables::embedded();
    let is_of_moments = |table: &&Table| {
        table.kind == Kind::Albedo && table.subject.reflectance == Some(Reflectance::Mirror)
    };
    let moments = set.tables().iter().filter(is_of_moments);
    let table = |table: &Table| {
        let mut table = table.clone();
        table.subject.lobe.gamma = Interval { min: gamma[0], max: gamma[1] };
        table.subject.lobe.roughness =
            Roughness::Isotropic(Interval { min: sigma[0], max: sigma[1] });
        table
    };
    Tables::from_tables(set.provenance().clone(), moments.map(table).collect()).unwrap()
}

#[test]
fn narrow_sets_are_covered_from_end_to_end_and_clamped_beyond() {
    let tables = Tables::embedded();
    let masking = Masking::HeightCorrelated;
    let ranges = [
        ([1.8, 4.0], [0.05, 1.0]),
        ([2.0, 2.0], [0.05, 1.0]),
        ([1.6, f64::INFINITY], [0.3, 0.3]),
        ([2.5, 2.5], [0.3, 0.3]),
    ];
    for (gamma, sigma) in ranges {
        let family = narrow(gamma, sigma).family_albedo(masking).unwrap();
        assert!(family.bytes() < 300_000, "{gamma:?} {sigma:?}: {}", family.bytes());
        let s = gamma.map(|gamma| 1.0 / (gamma - 1.0));
        for x in [0.0, 0.21, 0.5, 0.83, 1.0] {
            for y in [0.0, 0.4, 0.7, 1.0] {
                let gamma = 1.0 + 1.0 / (s[0] + x * (s[1] - s[0]));
                let sigma = sigma[0] * (sigma[1] / sigma[0]).powf(y);
                let stored = tables.albedo(sigma, gamma, masking).unwrap();
                let at = family.at(sigma as f32, gamma as f32);
                for cos in [0.02, 0.2, 0.6, 1.0] {
                    let off = stored.lost(view(cos)) - at.lost(view(cos));
                    assert!(off.abs() < 5e-4, "{gamma} {sigma} {cos}: {off}");
                }
                let off = stored.lost_average() - at.lost_average();
                assert!(off.abs() < 5e-4, "{gamma} {sigma}: {off}");
            }
        }
        // Beyond the ends, and no mirror.
        let [a, b] = [family.at(0.0, 1.0), family.at(sigma[0] as f32, gamma[0] as f32)];
        assert!((a.lost(view(0.3)) - b.lost(view(0.3))).abs() < 1e-6 && a.lost(view(0.3)) > 0.0);
    }
}

#[test]
fn the_albedo_of_a_shape_is_that_of_a_bound_material() {
    let tables = Tables::embedded();
    for masking in Masking::ALL {
        for gamma in [1.501, 1.7, 2.0, f64::INFINITY] {
            let shape = tables.shape_albedo(gamma, masking).unwrap();
            for sigma in [1e-8_f32, 1e-4, 0.03, 0.3, 1.1, 3.0] {
                let (bound, at) =
                    (tables.albedo(sigma.into(), gamma, masking).unwrap(), shape.at(sigma));
                for cos in [0.0, 1e-6, 1e-3, 0.1, 0.5, 0.97, 1.0] {
                    let (a, b) = (bound.moments(view(cos)), at.moments(view(cos)));
                    let off = [a.scale - b.scale, a.bias - b.bias, a.f82 - b.f82];
                    let name = format!("{masking:?} {gamma} {sigma} {cos}: {a:?} {b:?}");
                    // The continuation below the first view enlarges rounding.
                    let most = if cos < 1e-4 { 2e-4 } else { 5e-6 };
                    assert!(off.iter().all(|x| x.abs() < most), "{name}");
                    assert!((bound.lost(view(cos)) - at.lost(view(cos))).abs() < most, "{name}");
                }
                for i in 0..=400 {
                    // From the normal to grazing.
                    let cos = 1.0 - (i as f32 / 401.0).powi(2);
                    let off = (bound.lost(view(cos)) - at.lost(view(cos))).abs();
                    assert!(off < 1e-6, "{masking:?} {gamma} {sigma} {cos}: {off}");
                }
                let (a, b) = (bound.lost_average(), at.lost_average());
                assert!((a - b).abs() < 1e-6 + 1e-3 * a, "{gamma} {sigma}: {a} {b}");
            }
            let mirror = shape.at(0.0);
            assert_eq!((mirror.albedo(view(0.0)), mirror.lost_average()), (1.0, 0.0));
            let ends = [shape.at(f32::NAN).lost(view(0.01)), shape.at(1e-20).lost(view(0.01))];
            assert_eq!(ends, [shape.at(1e-8).lost(view(0.01)); 2]);
        }
    }
}

/// The mean weight of lights of a white conductor, by a grid of random numbers.
fn mean_weight<B: Bsdf<1>>(bsdf: &B, v: Vec3) -> f64 {
    const N: usize = 160;
    let at = |i: usize| (i as f32 + 0.5) / N as f32;
    let mut sum = 0.0;
    for i in 0..N * N {
        // The choice goes through its range several times for each pair of the other numbers.
        let choice = (i as f64 * 0.754_877_666_246_693).fract() as f32;
        let sample = bsdf.sample(v, choice, [at(i / N), at(i % N)], Transport::Radiance);
        sum += sample.map_or(0.0, |sample| f64::from(sample.weight[0]));
    }
    sum / (N * N) as f64
}

fn white(family: &FamilyAlbedo, sigma: f32, gamma: f64) -> Conductor<StudentT, 1, AlbedoAt<'_>> {
    let lobe = Tables::embedded().student_t(sigma, gamma).unwrap();
    Conductor::new(lobe, ConductorFresnel::mirror(), BsdfSettings::new())
        .unwrap()
        .compensated_at(family.at(sigma, gamma as f32), Compensation::KullaConty)
}

#[test]
fn white_conductors_at_a_hit_return_all_light() {
    let family = Tables::embedded().family_albedo(Masking::HeightCorrelated).unwrap();
    for (sigma, gamma) in [(0.05, 1.6), (0.3, 2.0), (0.8, 3.0), (1.5, f64::INFINITY), (0.01, 2.0)] {
        let bsdf = white(&family, sigma, gamma);
        for cos in [0.05, 0.3, 0.9] {
            let mean = mean_weight(&bsdf, view(cos));
            assert!((mean - 1.0).abs() < 6e-3, "{sigma} {gamma} {cos}: {mean}");
        }
    }
}

#[test]
fn conductors_at_a_hit_are_those_that_are_bound() {
    let mut drawn = 0;
    let tables = Tables::embedded();
    for compensation in [Compensation::Turquin, Compensation::KullaConty] {
        for masking in Masking::ALL {
            let family = tables.family_albedo(masking).unwrap();
            for (sigma, gamma) in [(0.2, 1.7), (0.6, 2.0), (1.2, 8.0)] {
                let f0 = ConductorFresnel::schlick([0.9, 0.7, 0.3]).unwrap();
                let settings =
                    BsdfSettings::new().with_masking(masking).compensated(compensation, &tables);
                let lobe = || tables.student_t(sigma, gamma).unwrap();
                let bound = Conductor::new(lobe(), f0, settings).unwrap();
                let at = Conductor::new(lobe(), f0, BsdfSettings::new()).unwrap();
                let at = at.compensated_at(family.at(sigma, gamma as f32), compensation);
                assert_eq!(at.masking(), masking);
                for cos in [0.1, 0.5, 0.95] {
                    for other in [0.05, 0.4, 0.99] {
                        let (v, l) = (view(cos), Vec3::new(-1.0, 1.0, 1.0) * view(other));
                        let [a, b] = [
                            bound.eval_pdf(v, l, Transport::Radiance).0,
                            at.eval_pdf(v, l, Transport::Radiance).0,
                        ];
                        for (a, b) in a.into_iter().zip(b) {
                            assert!((a - b).abs() < 2e-3 * a + 1e-5, "{cos} {other}: {a} {b}");
                        }
                        // A sample has the density and the value that are evaluated.
                        let u = [other, cos];
                        let sample = at.sample_with_pdf(v, 0.999 * other, u, Transport::Radiance);
                        // Below the horizon.
                        let Some((sample, pdf)) = sample else { continue };
                        drawn += 1;
                        let (f, again) = at.eval_pdf(v, sample.l, Transport::Radiance);
                        assert!((pdf / again - 1.0).abs() < 1e-3, "{pdf} {again}");
                        let weight = f[0] * sample.l[2] / again;
                        assert!((sample.weight[0] / weight - 1.0).abs() < 2e-3);
                    }
                }
            }
        }
    }
    assert!(drawn > 80, "{drawn}");
}

/// Drawn by the plain cosine, lights of a smooth surface would have weights of the order of 1/σ².
#[test]
fn weights_stay_bounded_for_smooth_surfaces() {
    for masking in Masking::ALL {
        let family = Tables::embedded().family_albedo(masking).unwrap();
        let mut worst = 0.0_f32;
        for gamma in [1.6, 1.8, 2.0, 4.0, f64::INFINITY] {
            for sigma in [1e-3, 0.01, 0.1, 1.0] {
                let bsdf = white(&family, sigma, gamma);
                for i in 0..2000 {
                    let u = (i as f32 + 0.5) / 2000.0;
                    let v = view(0.5 * sigma);
                    // The last choice takes the broad lobe.
                    let sample = bsdf.sample(v, 0.999_999, [u, 0.3], Transport::Radiance);
                    worst = worst.max(sample.map_or(0.0, |sample| sample.weight[0]));
                }
            }
        }
        println!("{masking:?}: largest weight {worst}");
        assert!(worst < 30.0, "{worst}");
    }
}

/// Of every form of albedo, in lanes or not.
#[test]
fn batches_of_albedos_are_single_calls() {
    let (tables, masking) = (Tables::embedded(), Masking::HeightCorrelated);
    let family = tables.family_albedo(masking).unwrap();
    for count in [0, 1, 3, 5, 8, 13, 29, 200] {
        let z = |i: usize| match i % 11 {
            0 => [1.0, 0.0, -0.0, f32::NAN, -0.5, 1e-5, 1.5][i / 11 % 7],
            part => part as f32 / 11.0 + i as f32 * 4e-4,
        };
        let v: Vec<[f32; 3]> = (0..count).map(|i| [0.1, 0.2, z(i)]).collect();
        let mut e = vec![2.0; count];
        let bits = |x: f32| x.to_bits();
        for (sigma, gamma) in [(0.3, 2.5), (1e-8, 1.501), (3.0, f32::INFINITY), (0.0, 4.0)] {
            let at = family.at(sigma, gamma);
            at.albedo_batch(&v, &mut e).unwrap();
            for (v, e) in v.iter().zip(&e) {
                assert_eq!(bits(*e), bits(at.albedo(*v)), "{sigma} {gamma} {v:?}");
            }
        }
        let albedo = tables.albedo(0.3, 2.5, masking).unwrap();
        albedo.albedo_batch(&v, &mut e).unwrap();
        assert!(v.iter().zip(&e).all(|(v, e)| bits(*e) == bits(albedo.albedo(*v))));
        let shape = tables.shape_albedo(2.5, masking).unwrap();
        let at = shape.at(0.3);
        at.albedo_batch(&v, &mut e).unwrap();
        assert!(v.iter().zip(&e).all(|(v, e)| bits(*e) == bits(at.albedo(*v))));
        let sigma: Vec<f32> = (0..count).map(|i| 0.01 * i as f32).collect();
        let gamma: Vec<f32> = (0..count).map(|i| 1.45 + 0.1 * i as f32).collect();
        family.albedo_batch(&sigma, &gamma, &v, &mut e).unwrap();
        for i in 0..count {
            assert_eq!(bits(e[i]), bits(family.at(sigma[i], gamma[i]).albedo(v[i])), "{i}");
        }
    }
    let at = family.at(0.3, 2.5);
    assert!(at.albedo_batch(&[[0.0, 0.0, 1.0]; 3], &mut [0.0; 2]).is_err());
}
