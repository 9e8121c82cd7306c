//! Haze and retroreflection: two BSDFs as one.

#![cfg(feature = "embedded")]

use glam::{DVec3, Vec3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{
    AnyBsdf, BindError, Bsdf, BsdfSample, BsdfSettings, Compensation, Conductor, ConductorFresnel,
    Dielectric, Event, Ggx, Haze, Lobe, Masking, Metal, MicrofacetDistribution, Plastic,
    Retroreflective, Skew, StandIn, Tables, Transport,
};
use microfacet_tables::{Haze as HazeEntry, LobeSpec, MaterialEntry, Provenance, Reflectance};

const RADIANCE: Transport = Transport::Radiance;

fn direction(theta: f64, phi: f64) -> Vec3 {
    let (sin, cos) = theta.sin_cos();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos).as_vec3()
}

fn turned(v: Vec3) -> Vec3 {
    Vec3::new(-v.x, -v.y, v.z)
}

fn lobe(sigma: [f64; 2], gamma: f64) -> Lobe {
    Tables::embedded().student_t(sigma, gamma).unwrap().into()
}

fn gold(lobe: impl Into<Lobe>) -> Conductor<Lobe> {
    Conductor::new(lobe.into(), Metal::Gold, BsdfSettings::new()).unwrap()
}

/// A white conductor that returns all light.
fn whole(sigma: f64, gamma: f64) -> Conductor<Lobe> {
    let tables = Tables::embedded();
    let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
    Conductor::new(lobe([sigma; 2], gamma), ConductorFresnel::mirror(), settings).unwrap()
}

/// Near the normal, in between and at grazing.
fn views() -> [Vec3; 5] {
    [(0.0, 0.0), (1e-3, 1.0), (0.8, -2.0), (1.55, 0.7), (1.5705, 3.0)].map(|(t, p)| direction(t, p))
}

/// The corners of pairs by name.
fn pairs() -> Vec<(&'static str, AnyBsdf)> {
    let haze = |core: AnyBsdf, haze: AnyBsdf, w| Haze::new(core, haze, w).unwrap().into();
    let (narrow, wide) = (gold(lobe([0.1; 2], 2.0)), gold(lobe([0.45; 2], 2.0)));
    let any = |bsdf: &Conductor<Lobe>| AnyBsdf::from(bsdf.clone());
    let mut all = Vec::new();
    for w in [0.0, 0.3, 0.5, 1.0] {
        all.push(("ggx", haze(any(&narrow), any(&wide), w)));
        let back = Retroreflective::new(gold(lobe([0.3, 0.1], 2.0)), w).unwrap();
        all.push(("anisotropic, back", back.into()));
    }
    let [tails, none] = [1.6, f64::INFINITY].map(|gamma| gold(lobe([0.2; 2], gamma)));
    all.push(("tails and Beckmann", haze(any(&tails), any(&none), 0.4)));
    let streaks = gold(lobe([0.2, 0.6], 2.5).for_reflection());
    all.push(("anisotropic", haze(gold(lobe([0.05, 0.2], 1.7)).into(), streaks.into(), 0.5)));
    all.push(("compensated", haze(whole(0.3, 2.0).into(), whole(0.8, 2.0).into(), 0.5)));
    all.push(("mirror core", haze(gold(Smooth).into(), any(&wide), 0.3)));
    let glass = |sigma| Dielectric::new(lobe([sigma; 2], 2.0), 1.5, BsdfSettings::new()).unwrap();
    all.push(("glass", haze(glass(0.1).into(), glass(0.5).into(), 0.3)));
    let paint = |lobe| Plastic::new(lobe, 1.5, [0.1, 0.4, 0.2], BsdfSettings::new()).unwrap();
    all.push(("smooth paint", haze(paint(Smooth.into()).into(), any(&wide), 0.3)));
    let hazy = Haze::new(paint(lobe([0.1; 2], 2.0)), paint(lobe([0.4; 2], 3.0)), 0.2).unwrap();
    all.push(("hazy paint, back", Retroreflective::new(hazy, 0.5).unwrap().into()));
    all.push(("mirror, back", Retroreflective::new(gold(Smooth), 0.5).unwrap().into()));
    all
}

/// Every sample has the density and the weight that evaluation gives for its light.
#[test]
fn a_weight_is_f_cos_over_the_density_of_both() {
    let mut random = StdRng::seed_from_u64(1);
    for (name, bsdf) in pairs() {
        let (mut compared, mut deltas) = (0, 0);
        for v in views().into_iter().chain(views().map(|v| -v)) {
            for _ in 0..400 {
                let (choice, u) = (random.random(), [random.random(), random.random()]);
                let Some((sample, pdf)) = bsdf.sample_with_pdf(v, choice, u, RADIANCE) else {
                    assert_eq!(bsdf.sample(v, choice, u, RADIANCE), None, "{name}");
                    continue;
                };
                assert_eq!(bsdf.sample(v, choice, u, RADIANCE), Some(sample), "{name}");
                let (f, again) = bsdf.eval_pdf(v, sample.l, RADIANCE);
                let what = format!("{name}, v {v}, {sample:?}, {pdf} {again} {f:?}");
                if sample.delta {
                    assert_eq!(pdf, 0.0, "{what}");
                    deltas += 1;
                    continue;
                }
                // Rounding of the light moves the slope of a narrow lobe, most at grazing.
                let grazing = v.z.abs().min(sample.l[2].abs()) < 0.03;
                let tolerance = if grazing { 0.05 } else { 2e-3 };
                assert!((again / pdf - 1.0).abs() < tolerance, "{what}");
                for (weight, f) in sample.weight.into_iter().zip(f) {
                    let want = f * sample.l[2].abs() / again;
                    assert!((weight - want).abs() < 1e-2 * want + 1e-6, "{what}: {want}");
                }
                compared += 1;
            }
        }
        let (mirror, all) =
            (name.contains("mirror") || name.contains("smooth"), name == "mirror, back");
        assert!((deltas > 100) == mirror && (compared > 500) != all, "{name} {compared} {deltas}");
    }
}

#[test]
fn a_part_alone_is_that_part_to_the_bit() {
    let (core, haze) = (gold(lobe([0.1; 2], 2.0)), gold(lobe([0.5; 2], 1.6)));
    let mut random = StdRng::seed_from_u64(2);
    for _ in 0..500 {
        let v = direction(random.random_range(0.0..1.57), random.random_range(-3.0..3.0));
        let l = direction(random.random_range(0.0..1.57), random.random_range(-3.0..3.0));
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        for (w, part) in [(0.0, &core), (1.0, &haze)] {
            let pair = Haze::new(core.clone(), haze.clone(), w).unwrap();
            let same = part.sample_with_pdf(v, choice, u, RADIANCE);
            assert_eq!(pair.sample_with_pdf(v, choice, u, RADIANCE), same);
            assert_eq!(pair.sample(v, choice, u, RADIANCE), part.sample(v, choice, u, RADIANCE));
            assert_eq!(pair.eval_pdf(v, l, RADIANCE), part.eval_pdf(v, l, RADIANCE));
            let back = Retroreflective::new(core.clone(), w).unwrap();
            let v = if w == 0.0 { v } else { turned(v) };
            let same = core.sample_with_pdf(v, choice, u, RADIANCE);
            let v = if w == 0.0 { v } else { turned(v) };
            assert_eq!(back.sample_with_pdf(v, choice, u, RADIANCE), same);
        }
    }
    // A part of no share counts for nothing.
    let mirror = gold(Smooth);
    let glass = Dielectric::new(lobe([0.2; 2], 2.0), 1.5, BsdfSettings::new()).unwrap();
    let of = |w| Haze::new(mirror.clone(), glass.clone(), w).unwrap();
    let of = [0.0, 0.5, 1.0].map(|w| (of(w).is_delta(), of(w).transmits()));
    assert_eq!(of, [(true, false), (false, true), (false, true)]);
}

/// A mirror remains a delta of its own reflectance beside haze, and two mirrors are one delta.
#[test]
fn deltas_stay_deltas_of_their_strength() {
    let (mirror, haze) = (gold(Smooth), gold(lobe([0.5; 2], 2.0)));
    let v = direction(0.7, 0.4);
    let hazy = Haze::new(mirror.clone(), haze.clone(), 0.3).unwrap();
    assert!(!hazy.is_delta());
    let n = 10_000;
    let (mut strength, mut light) = (0.0, 0.0);
    for i in 0..n {
        let choice = (i as f32 + 0.5) / n as f32;
        let u = [0.618_034, 0.754_878].map(|step: f64| (step * f64::from(i)).fract() as f32);
        let Some(sample) = hazy.sample(v, choice, u, RADIANCE) else { continue };
        if sample.delta {
            assert_eq!(
                (Vec3::from(sample.l), sample.weight),
                (turned(v), mirror.fresnel().at(v.z))
            );
            strength += sample.weight[0] / n as f32;
        } else {
            light += sample.weight[0] / n as f32;
        }
    }
    assert!((strength - 0.7 * mirror.fresnel().at(v.z)[0]).abs() < 1e-4, "{strength}");
    // What is drawn of the haze is 0.3 of what it returns alone.
    let alone: f32 = (0..n)
        .filter_map(|i| {
            let u = [0.618_034, 0.754_878].map(|step: f64| (step * f64::from(i)).fract() as f32);
            Some(haze.sample(v, 0.5, u, RADIANCE)?.weight[0] / n as f32)
        })
        .sum();
    assert!((light - 0.3 * alone).abs() < 2e-3, "{light} for {alone}");
    // The mirror is not evaluated, not even at its own light.
    let ([f, ..], pdf) = hazy.eval_pdf(v, turned(v), RADIANCE);
    let ([g, ..], q) = haze.eval_pdf(v, turned(v), RADIANCE);
    assert!((f / g - 0.3).abs() < 1e-6 && (pdf / q - 0.3).abs() < 1e-6);

    let mirrors = Haze::new(mirror.clone(), gold(Ggx::new(1e-4).unwrap()), 0.5).unwrap();
    let back = Retroreflective::new(mirror, 0.5).unwrap();
    assert!(mirrors.is_delta() && back.is_delta());
    let lights = [0.2, 0.8].map(|choice| back.sample(v, choice, [0.5; 2], RADIANCE).unwrap());
    assert!(
        lights.iter().all(|sample: &BsdfSample| sample.delta && sample.event == Event::Reflection)
    );
    assert_eq!(lights.map(|sample| Vec3::from(sample.l)), [turned(v), v]);
    assert_eq!(back.eval_pdf(v, v, RADIANCE), ([0.0; 3], 0.0));
}

/// A BSDF whose f and density leave single precision; its weight is known.
struct Steep([f32; 3], f32);

impl Bsdf for Steep {
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        _choice: f32,
        _u: [f32; 2],
        _transport: Transport,
    ) -> Option<(BsdfSample, f32)> {
        Some((BsdfSample::reflected(v, self.0), self.1))
    }

    fn eval_pdf(
        &self,
        _v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        _transport: Transport,
    ) -> ([f32; 3], f32) {
        let cos = l.into()[2];
        (self.0.map(|weight| (weight * self.1 / cos).min(f32::MAX)), self.1)
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }
}

#[test]
fn densities_that_leave_single_precision_give_finite_weights() {
    // Along the normal, where f of the largest density is in the range as well.
    let v = [0.0, 0.0, 1.0];
    let all = [f32::MAX, 1e30, 1.0, 1e-30, 1e-45, 0.0];
    for a in all {
        for b in all {
            for w in [1e-7, 0.25, 0.5, 1.0 - 1e-7] {
                let pair = Haze::new(Steep([0.9; 3], a), Steep([0.2; 3], b), w).unwrap();
                for choice in [0.0, 1.0] {
                    let (sample, pdf) =
                        pair.sample_with_pdf(v, choice, [0.5; 2], RADIANCE).unwrap();
                    let (f, again) = pair.eval_pdf(v, v, RADIANCE);
                    let [weight, ..] = sample.weight;
                    let what = format!("{a} {b} {w} {choice}: {weight} {pdf}");
                    // Where densities are subnormal, f rounds.
                    let most = if a.max(b) > 1e-37 { 0.9001 } else { 1.0 };
                    assert!((0.0..=most).contains(&weight), "{what}");
                    assert!(pdf.is_finite() && f[0].is_finite() && again.is_finite(), "{what}");
                    if a == b && a >= 1.0 {
                        let want = 0.9 * (1.0 - w) + 0.2 * w;
                        assert!((weight - want).abs() < 1e-6, "{what} for {want}");
                    }
                }
            }
        }
    }
}

/// The albedo of a pair is the mean of the two, so that compensated parts return all light.
#[test]
fn a_pair_returns_what_its_parts_return() {
    let returned = |bsdf: &dyn Fn(f32, [f32; 2]) -> Option<BsdfSample>| -> f64 {
        let n = 1 << 15;
        let step = |i: i32, step: f64| (0.5 + step * f64::from(i)).fract() as f32;
        let weight = |i| {
            let u = [step(i, 0.819_172_513_396_164_4), step(i, 0.671_043_606_703_789_2)];
            Some(f64::from(bsdf(step(i, 0.549_700_477_901_960_3), u)?.weight[0]))
        };
        (0..n).filter_map(weight).sum::<f64>() / f64::from(n)
    };
    for gamma in [1.6, 2.0, f64::INFINITY] {
        let (core, haze) = (whole(0.2, gamma), whole(0.9, gamma));
        let parts = [gold(lobe([0.2; 2], gamma)), gold(lobe([0.9; 2], gamma))];
        for v in views() {
            for w in [0.3, 0.7] {
                let pair = Haze::new(core.clone(), haze.clone(), w).unwrap();
                let got = returned(&|choice, u| pair.sample(v, choice, u, RADIANCE));
                assert!((got - 1.0).abs() < 4e-3, "gamma {gamma}, v {v}: {got}");
                let back = Retroreflective::new(haze.clone(), w).unwrap();
                let got = returned(&|choice, u| back.sample(v, choice, u, RADIANCE));
                assert!((got - 1.0).abs() < 4e-3, "back, gamma {gamma}, v {v}: {got}");
                // Of one bounce.
                let [a, b] = parts
                    .each_ref()
                    .map(|part| returned(&|choice, u| part.sample(v, choice, u, RADIANCE)));
                let [core, haze] = parts.clone();
                let pair = Haze::new(core, haze, w).unwrap();
                let got = returned(&|choice, u| pair.sample(v, choice, u, RADIANCE));
                let want = f64::from(1.0 - w) * a + f64::from(w) * b;
                assert!((got - want).abs() < 4e-3, "gamma {gamma}, v {v}: {got} for {want}");
            }
        }
    }
}

/// Exchanging view and light leaves f as it is, with a share that goes back, too; of a tilted lobe
/// it would not.
#[test]
fn light_that_goes_back_is_reciprocal_for_symmetric_lobes_alone() {
    let mut random = StdRng::seed_from_u64(3);
    let any = |random: &mut StdRng| {
        direction(random.random_range(0.0..1.5), random.random_range(-3.0..3.0))
    };
    for (name, bsdf) in pairs() {
        if bsdf.transmits() {
            continue;
        }
        for _ in 0..500 {
            let (v, l) = (any(&mut random), any(&mut random));
            let [a, b] = [(v, l), (l, v)].map(|(v, l)| bsdf.eval(v, l, RADIANCE)[0]);
            assert!((a - b).abs() <= 1e-3 * a.max(b), "{name}: {a} {b}");
        }
    }
    let tilted = Skew::new([0.3, 0.1], [0.2, -0.1, 0.5]).unwrap();
    let only_turned = Skew::new([0.3, 0.1], [0.0, 0.0, 0.5]).unwrap();
    let [tilted, only_turned] =
        [tilted, only_turned].map(|skew| gold(Tables::embedded().ellipsoid(skew, 2.7).unwrap()));
    let mut worst = 0.0_f32;
    for _ in 0..100 {
        let (v, l) = (any(&mut random), any(&mut random));
        let f = |v, l| tilted.eval(turned(v), l, RADIANCE)[0];
        worst = worst.max((f(v, l) - f(l, v)).abs());
    }
    assert!(worst > 0.1, "{worst}");
    let why = Retroreflective::new(tilted.clone(), 0.5).unwrap_err();
    assert!(matches!(why, BindError::NoRetroreflection { transmits: false }));
    assert!(why.to_string().contains("tilted") && why.to_string().contains("theta"), "{why}");
    assert!(only_turned.is_symmetric() && !tilted.is_symmetric());
    Retroreflective::new(only_turned, 0.5).unwrap();
    let glass = Dielectric::new(Ggx::new(0.3).unwrap(), 1.5, BsdfSettings::new()).unwrap();
    let why = Retroreflective::new(glass.clone(), 0.5).unwrap_err();
    assert!(matches!(why, BindError::NoRetroreflection { transmits: true }), "{why}");
    // At a hit what is refused keeps its light as it is.
    assert_eq!(Retroreflective::at_hit(glass, 0.5).share(), 0.0);
    assert_eq!(Retroreflective::at_hit(tilted, 0.5).share(), 0.0);
    // The lobes' own account of themselves.
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    assert!(family.at([0.3, 0.1], 2.0).bounded().is_symmetric());
    assert!(lobe([0.3, 0.1], 1.6).for_reflection().is_symmetric());
    assert!(Smooth.is_symmetric() && Ggx::new(0.2).unwrap().is_symmetric());
}

#[test]
fn shares_outside_their_range_are_refused_by_name_and_clamped_at_a_hit() {
    let ggx = || Conductor::at_hit(Ggx::new(0.3).unwrap(), Metal::Gold.into(), Masking::default());
    for value in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
        let why = Haze::new(ggx(), ggx(), value).unwrap_err();
        assert!(matches!(why, BindError::Share { name: "weight", .. }));
        let text = why.to_string();
        assert!(text.contains(&format!("weight = {value}")) && text.contains("[0, 1]"), "{text}");
        let text = Retroreflective::new(ggx(), value).unwrap_err().to_string();
        assert!(text.contains(&format!("share = {value}")) && text.contains("[0, 1]"), "{text}");
        let clamped = if value > 0.0 { 1.0 } else { 0.0 };
        assert_eq!(Haze::at_hit(ggx(), ggx(), value).weight(), clamped);
        assert_eq!(Retroreflective::at_hit(ggx(), value).share(), clamped);
    }
}

/// Views from below, in the surface and of NaN; numbers outside [0, 1].
#[test]
fn what_the_parts_refuse_the_pair_refuses() {
    let flat = [Vec3::X, Vec3::new(0.6, 0.0, f32::NAN), Vec3::NAN];
    for (name, bsdf) in pairs() {
        for v in flat {
            assert!(bsdf.sample(v, 0.5, [0.5; 2], RADIANCE).is_none(), "{name}");
            assert_eq!(bsdf.eval_pdf(v, Vec3::Z, RADIANCE), ([0.0; 3], 0.0), "{name}");
            assert_eq!(bsdf.eval_pdf(Vec3::Z, v, RADIANCE), ([0.0; 3], 0.0), "{name}");
        }
        let v = direction(0.5, 1.0);
        let draw = |choice, u| bsdf.sample(v, choice, u, RADIANCE);
        assert_eq!(draw(f32::NAN, [0.3; 2]), draw(0.0, [0.3; 2]), "{name}");
        assert_eq!(draw(7.0, [0.3; 2]), draw(1.0, [0.3; 2]), "{name}");
        // It prints and is cloned as a whole.
        assert_eq!(format!("{:?}", bsdf.clone()), format!("{bsdf:?}"), "{name}");
    }
}

/// The materials of a set by name: core, haze and light that goes back, ranges at their middle.
#[test]
fn named_materials_have_their_haze_and_send_light_back() {
    let plain = MaterialEntry {
        name: "plain".into(),
        lobe: LobeSpec::student_t([0.1; 2], 2.0),
        haze: None,
        retroreflection: MaterialEntry::SPECULAR,
        masking: Some(Masking::Uncorrelated),
        fresnel: Some(Reflectance::Schlick([0.9, 0.5, 0.2])),
    };
    let around = |sigma| {
        let lobe = LobeSpec::student_t([sigma; 2], 2.0);
        Some(HazeEntry { weight: [0.2, 0.4].into(), lobe })
    };
    let named = |name: &str, haze, back: [f64; 2]| MaterialEntry {
        name: name.into(),
        haze,
        retroreflection: back.into(),
        ..plain.clone()
    };
    let glass = Some(Reflectance::Dielectric([1.5; 2].into()));
    let materials = vec![
        plain.clone(),
        named("hazy", around(0.45), [0.0; 2]),
        named("both", around(0.45), [0.4, 0.8]),
        MaterialEntry { fresnel: glass, ..named("hazy glass", around(0.45), [0.0; 2]) },
        MaterialEntry { fresnel: glass, ..named("glass sent back", None, [0.5; 2]) },
    ];
    let set = Provenance { materials, ..Provenance::default() };
    let set = Tables::from_tables(set, Vec::new()).unwrap();
    let of = |name| set.bsdf(name, Compensation::None, StandIn::Refused);
    let settings = BsdfSettings::new().with_masking(Masking::Uncorrelated);
    let fresnel = ConductorFresnel::schlick([0.9, 0.5, 0.2]).unwrap();
    let part = |alpha: f32| Conductor::new(Ggx::new(alpha).unwrap(), fresnel, settings).unwrap();
    let (core, haze) = (part(0.1), part(0.45));
    let (v, l) = (direction(0.7, 0.3), direction(0.6, 2.9));
    let f = |bsdf: &AnyBsdf, v| bsdf.eval(v, l, RADIANCE);
    let mixed = |v: Vec3| {
        let (a, b) = (core.eval(v, l, RADIANCE), haze.eval(v, l, RADIANCE));
        [0, 1, 2].map(|i| 0.7 * a[i] + 0.3 * b[i])
    };
    let close =
        |a: [f32; 3], b: [f32; 3]| a.into_iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-5);
    assert_eq!(f(&of("plain").unwrap(), v), core.eval(v, l, RADIANCE));
    let hazy = of("hazy").unwrap();
    assert!(matches!(hazy, AnyBsdf::Haze(_)) && close(f(&hazy, v), mixed(v)), "{hazy:?}");
    let both = of("both").unwrap();
    let back = [0, 1, 2].map(|i| 0.4 * mixed(v)[i] + 0.6 * mixed(turned(v))[i]);
    assert!(close(f(&both, v), back), "{both:?}");
    assert!(matches!(of("hazy glass"), Ok(AnyBsdf::Haze(_))));
    let why = of("glass sent back").unwrap_err();
    assert!(matches!(why, BindError::NoRetroreflection { transmits: true }), "{why}");
    // The lobes themselves.
    assert!(matches!(set.material("hazy").unwrap(), Lobe::Ggx(ggx) if ggx.alpha() == [0.1; 2]));
    let (lobe, weight) = set.material_haze("hazy").unwrap().unwrap();
    assert!(matches!(lobe, Lobe::Ggx(ggx) if ggx.alpha() == [0.45; 2]));
    assert!((weight - 0.3).abs() < 1e-6 && set.material_haze("plain").unwrap().is_none());
    assert!(set.material_haze("no such").is_err());
}
