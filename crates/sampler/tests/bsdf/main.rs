//! Complete BSDFs: values against Walter et al. 2007 in double precision, delta events, and refused
//! arguments.

#![cfg(feature = "embedded")]

mod sets;
mod walter;

use glam::{DVec3, Vec3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_sampler::lobe::{Reflecting, Smooth, Tabulated};
use microfacet_sampler::{
    BindError, Bsdf, BsdfSample, BsdfSettings, Compensation, Conductor, ConductorFresnel,
    Dielectric, Event, Ggx, Lobe, Masking, Metal, MicrofacetDistribution, Plastic, Skew, StandIn,
    Tables, Transport,
};

use walter::{CRITICAL, EDGE_ON, Walter, complex_fresnel, walter_fresnel};

const RADIANCE: Transport = Transport::Radiance;

/// Single scattering.
fn single() -> BsdfSettings<'static> {
    BsdfSettings::new()
}

fn gold<L: Reflecting + Tabulated>(lobe: L, settings: BsdfSettings<'_>) -> Conductor<L> {
    Conductor::new(lobe, Metal::Gold, settings).unwrap()
}

fn glass<L: Tabulated>(lobe: L, eta: f64) -> Dielectric<L> {
    Dielectric::new(lobe, eta, single()).unwrap()
}

fn direction(theta: f64, phi: f64) -> Vec3 {
    let (sin, cos) = theta.sin_cos();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos).as_vec3()
}

/// A direction of the sphere with |cos θ| > 0.01.
fn any_direction(random: &mut StdRng) -> Vec3 {
    loop {
        let z: f64 = random.random_range(-1.0..1.0);
        if z.abs() > 0.01 {
            return direction(z.acos(), random.random_range(-3.0..3.0));
        }
    }
}

fn lobes(alpha: f32) -> [Lobe; 2] {
    let tables = Tables::embedded();
    [tables.student_t(f64::from(alpha), 2.0).unwrap().into(), Ggx::new(alpha).unwrap().into()]
}

/// Largest relative difference, where f is more than a millionth.
fn compare(got: f32, want: f64, worst: &mut f64, count: &mut usize) {
    assert_eq!(got > 0.0, want > 0.0, "{got} for {want}");
    if want > 1e-6 {
        *worst = worst.max((f64::from(got) / want - 1.0).abs());
        *count += 1;
    }
}

#[test]
fn ggx_is_that_of_walter() {
    let mut random = StdRng::seed_from_u64(1);
    for alpha in [0.05_f32, 0.3, 1.0, 2.5] {
        let truth = Walter { alpha: alpha.into() };
        for lobe in lobes(alpha) {
            let (mut worst, mut counts) = (0.0_f64, [0; 3]);
            let settings = single().with_masking(Masking::Uncorrelated);
            let gold = gold(lobe.clone(), settings);
            for _ in 0..20_000 {
                let (v, l) = (any_direction(&mut random), any_direction(&mut random));
                let (o, i) = (v.as_dvec3().normalize(), l.as_dvec3().normalize());
                if v.z > 0.0 && l.z > 0.0 {
                    let f = gold.eval(v, l, RADIANCE);
                    for (c, got) in f.into_iter().enumerate() {
                        let (eta, k) = (Metal::Gold.eta()[c], Metal::Gold.k()[c]);
                        let want = truth.reflection(o, i, |cos| complex_fresnel(eta, k, cos));
                        compare(got, want, &mut worst, &mut counts[0]);
                    }
                }
                for eta in [1.5_f32, 2.4, 1.0 / 1.33] {
                    let glass = Dielectric::new(lobe.clone(), eta.into(), settings).unwrap();
                    let index = |d: Vec3| if d.z > 0.0 { 1.0 } else { f64::from(eta) };
                    let (n_o, n_i) = (index(v), index(l));
                    let [got, ..] = glass.eval(v, l, RADIANCE);
                    if v.z * l.z > 0.0 {
                        let ratio = f64::from(if v.z > 0.0 { eta } else { 1.0 / eta });
                        let want = truth.reflection(o, i, |cos| walter_fresnel(ratio, cos));
                        // At the critical angle F rises like a square root, from rounding, too.
                        let half = 0.5 * (1.0 + o.dot(i));
                        if (half - (1.0 - ratio * ratio)).abs() > CRITICAL {
                            compare(got, want, &mut worst, &mut counts[1]);
                        }
                    } else {
                        let want = truth.transmission(o, i, n_o, n_i);
                        // The cosine of a facet seen edge-on is mostly rounding.
                        if truth.smaller_cosine(o, i, n_o, n_i) > EDGE_ON {
                            compare(got, want, &mut worst, &mut counts[2]);
                        }
                    }
                }
            }
            assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
            assert!(worst < 1e-4, "alpha {alpha}: {worst:e}");
        }
    }
}

/// Importance lacks the factor of radiance; reflection is the same for both.
#[test]
fn importance_is_radiance_without_its_scale() {
    let glass = glass(Ggx::new(0.3).unwrap(), 1.5);
    let (v, down, up) = (direction(0.5, 0.0), direction(2.8, 3.1), direction(0.4, 2.9));
    for (v, scale) in [(v, 1.0 / 2.25), (-v, 2.25)] {
        let side = v.z.signum();
        let f = |l: Vec3, transport| glass.eval(v, side * l, transport)[0];
        assert_eq!(f(up, RADIANCE), f(up, Transport::Importance));
        let (radiance, importance) = (f(down, RADIANCE), f(down, Transport::Importance));
        assert!(importance > 0.0 && (radiance / importance / scale - 1.0).abs() < 1e-6);
    }
}

#[test]
fn indices_and_reflectances_outside_their_range_are_refused_by_name() {
    let lobe = Ggx::new(0.3).unwrap();
    for eta in [0.0, -1.5, 1e-4, 2e3, f64::NAN, f64::INFINITY] {
        let why = Dielectric::new(lobe, eta, single()).unwrap_err();
        assert!(matches!(why, BindError::Index { name: "eta", .. }), "{why:?}");
        let text = why.to_string();
        assert!(text.contains(&format!("eta = {eta}")) && text.contains("[0.001, 1000]"), "{text}");
        let plastic = Plastic::new(lobe, eta, [0.5], single());
        assert!(matches!(plastic.unwrap_err(), BindError::Index { .. }));
    }
    let why = ConductorFresnel::exact([0.2; 3], [3.0, -0.5, 3.0]).unwrap_err().to_string();
    assert!(why.contains("k = -0.5"), "{why}");
    for value in [-0.1, 1.1, f32::NAN] {
        assert!(ConductorFresnel::schlick([0.5, value, 0.5]).is_err());
        let why = Plastic::new(Smooth, 1.5, [0.5, value], single()).unwrap_err().to_string();
        assert!(why.contains("base = ") && why.contains("[0, 1]"), "{why}");
    }
}

#[test]
fn an_index_of_one_lets_all_light_straight_on() {
    for eta in [1.0, 1.0 + 5e-6, 1.0 - 5e-6] {
        let air = glass(Ggx::new(0.5).unwrap(), eta);
        assert!(Bsdf::<3>::is_delta(&air));
        for v in [direction(0.7, 1.0), direction(2.0, -1.0), Vec3::Z, direction(1.57, 0.0)] {
            for choice in [0.0, 0.3, 1.0] {
                let (sample, pdf) = air.sample_with_pdf(v, choice, [0.3, 0.6], RADIANCE).unwrap();
                assert!((Vec3::from(sample.l) + v).length() < 1e-6 && sample.delta);
                assert_eq!((sample.weight, pdf), ([1.0; 3], 0.0));
                assert_eq!(sample.event, Event::Transmission);
            }
            assert_eq!(air.eval_pdf(v, -v, RADIANCE), ([0.0; 3], 0.0));
        }
    }
    // Just beyond the limit of 1e-5 the interface is rough again.
    let thin = glass(Ggx::new(0.5).unwrap(), 1.000_02);
    assert!(!Bsdf::<3>::is_delta(&thin));
}

#[test]
fn smooth_lobes_are_deltas() {
    let tables = Tables::embedded();
    let narrow: Lobe = tables.student_t(1e-8, 3.0).unwrap().into();
    let v = direction(0.6, 0.4);
    let mirrored = [-v.x, -v.y, v.z];
    for lobe in [Smooth.into(), narrow] {
        let gold = gold(lobe.clone(), single().compensated(Compensation::KullaConty, &tables));
        let (sample, pdf) = gold.sample_with_pdf(v, 0.5, [0.2, 0.9], RADIANCE).unwrap();
        assert!(gold.is_delta() && sample.delta && pdf == 0.0 && sample.l == mirrored);
        assert_eq!(sample.weight, gold.fresnel().at(v.z));
        assert_eq!(gold.eval_pdf(v, mirrored, RADIANCE), ([0.0; 3], 0.0));
        assert!(gold.sample(-v, 0.5, [0.2, 0.9], RADIANCE).is_none());

        // A smooth surface loses nothing, so that no tables are needed.
        let turquin = single().compensated(Compensation::Turquin, &tables);
        let glass = Dielectric::new(lobe.clone(), 1.5, turquin).unwrap();
        let reflected = walter_fresnel(1.5, v.z.into()) as f32;
        for (choice, event) in
            [(0.99 * reflected, Event::Reflection), (1.01 * reflected, Event::Transmission)]
        {
            let (sample, pdf) = glass.sample_with_pdf(v, choice, [0.2, 0.9], RADIANCE).unwrap();
            assert!(sample.delta && pdf == 0.0 && sample.event == event);
            let weight = if event == Event::Reflection { 1.0 } else { 1.0 / 2.25 };
            assert!((sample.weight[0] - weight).abs() < 1e-6, "{sample:?}");
            if event == Event::Transmission {
                let l = Vec3::from(sample.l);
                assert!((1.5 * l + v).truncate().length() < 1e-6 && l.z < 0.0);
            } else {
                assert_eq!(sample.l, mirrored);
            }
        }
        // Total reflection, from inside.
        let inside = direction(2.0, 0.0);
        let sample = glass.sample(inside, 0.999, [0.5; 2], RADIANCE).unwrap();
        assert_eq!((sample.event, sample.weight), (Event::Reflection, [1.0; 3]));

        let paint = Plastic::new(lobe, 1.5, [0.2, 0.5], turquin).unwrap();
        assert!(!paint.is_delta());
        let (coat, pdf) = paint.sample_with_pdf(v, 0.0, [0.2, 0.9], RADIANCE).unwrap();
        assert!(coat.delta && pdf == 0.0 && coat.l == mirrored);
        let (base, pdf) = paint.sample_with_pdf(v, 1.0, [0.2, 0.9], RADIANCE).unwrap();
        assert!(!base.delta && pdf == paint.pdf(v, base.l) && pdf > 0.0);
        assert!(base.weight[0] < base.weight[1]);
    }
}

#[test]
fn smooth_white_plastic_returns_all_light() {
    for eta in [1.05, 1.5, 3.0, 1.0 / 1.5] {
        let white = Plastic::new(Smooth, eta, [1.0], single()).unwrap();
        for cos in [0.02_f32, 0.3, 1.0] {
            let v = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            // The weight of coat or base is its share of the light that returns over its
            // probability.
            let coat = walter_fresnel(f64::from(eta as f32), cos.into());
            let n = 4000;
            let base: f64 = (0..n)
                .map(|i| {
                    let mu = (f64::from(i) + 0.5) / f64::from(n);
                    let l = Vec3::new((1.0 - mu * mu).sqrt() as f32, 0.0, mu as f32);
                    let [f] = white.eval(v, l, RADIANCE);
                    2.0 * std::f64::consts::PI * f64::from(f) * mu / f64::from(n)
                })
                .sum();
            assert!((coat + base - 1.0).abs() < 2e-4, "{eta} {cos}: {coat} + {base}");
            let [reflected, entering] = white.coat_shares(v).map(f64::from);
            assert!((reflected - coat).abs() < 1e-5 && (entering + coat - 1.0).abs() < 1e-5);
            let l = Vec3::new(0.8, 0.0, 0.6);
            let [both, leaving] = [white.coat_shares(l)[1], white.leaving()].map(f64::from);
            let f = entering * both / (std::f64::consts::PI * eta * eta * leaving);
            // Both are 0 where a thin coat reflects all of the light of l.
            let off = f64::from(white.eval(v, l, RADIANCE)[0]) - f;
            assert!(off.abs() <= 1e-5 * f, "{eta} {cos}: {off} of {f}");
        }
    }
}

#[test]
fn conductors_and_plastics_are_black_from_below_and_all_is_for_directions_in_the_surface() {
    let lobe = Ggx::new(0.4).unwrap();
    let (gold, glass) = (gold(lobe, single()), glass(lobe, 1.5));
    let paint = Plastic::new(Smooth, 1.5, [0.5; 3], single()).unwrap();
    let (above, below) = (direction(0.5, 0.3), direction(2.5, 0.3));
    let u = [0.4, 0.7];
    for (v, l) in [(below, above), (above, below), (below, below)] {
        assert_eq!(gold.eval_pdf(v, l, RADIANCE), ([0.0; 3], 0.0));
        assert_eq!(paint.eval_pdf(v, l, RADIANCE), ([0.0; 3], 0.0));
    }
    assert!(gold.sample(below, 0.5, u, RADIANCE).is_none());
    assert!(paint.sample(below, 0.5, u, RADIANCE).is_none());
    // A mirror does not use every component of a view; NaN in any must still be refused.
    let mirror: Conductor<_> = Conductor::new(Smooth, Metal::Gold, single()).unwrap();
    for strange in [f32::NAN, f32::INFINITY].map(|x| Vec3::new(x, 0.0, 0.5)) {
        assert!(mirror.sample(strange, 0.5, u, RADIANCE).is_none());
        assert!(gold.sample(strange, 0.5, u, RADIANCE).is_none());
        assert_eq!(gold.eval_pdf(strange, above, RADIANCE), ([0.0; 3], 0.0));
        assert_eq!(gold.eval_pdf(above, strange, RADIANCE), ([0.0; 3], 0.0));
    }
    for flat in [Vec3::X, Vec3::new(1.0, 0.0, -0.0), Vec3::NAN, Vec3::new(0.6, 0.0, f32::NAN)] {
        assert!(gold.sample(flat, 0.5, u, RADIANCE).is_none());
        assert!(paint.sample(flat, 0.5, u, RADIANCE).is_none());
        assert!(glass.sample(flat, 0.5, u, RADIANCE).is_none());
        for (v, l) in [(flat, above), (above, flat), (below, flat)] {
            assert_eq!(gold.eval_pdf(v, l, RADIANCE), ([0.0; 3], 0.0));
            assert_eq!(paint.eval_pdf(v, l, RADIANCE), ([0.0; 3], 0.0));
            assert_eq!(glass.eval_pdf(v, l, RADIANCE), ([0.0; 3], 0.0));
        }
    }
}

/// Numbers outside [0, 1] are those of the nearer end, and NaN is 0.
#[test]
fn random_numbers_are_clamped() {
    let glass = glass(Ggx::new(0.4).unwrap(), 1.5);
    let v = direction(0.7, 0.2);
    let draw = |choice, u| Bsdf::<3>::sample(&glass, v, choice, u, RADIANCE);
    assert_eq!(draw(f32::NAN, [0.3; 2]), draw(0.0, [0.3; 2]));
    assert_eq!(draw(-1.0, [0.3; 2]), draw(0.0, [0.3; 2]));
    assert_eq!(draw(7.0, [f32::NAN, 0.2]), draw(1.0, [0.0, 0.2]));
    assert_eq!(draw(1.0, [2.0, -0.5]), draw(1.0, [1.0, 0.0]));
}

/// 1 + F0 (1 − E)/E on the lobe of a conductor; with F0 = 1 all that is lost.
#[test]
fn turquin_scales_the_lobe() {
    let tables = Tables::embedded();
    let lobe = tables.student_t(0.9, 3.0).unwrap();
    let fresnel = ConductorFresnel::schlick([0.2, 0.6, 1.0]).unwrap();
    let [bare, scaled] = [Compensation::None, Compensation::Turquin].map(|form| {
        Conductor::new(lobe.clone(), fresnel, single().compensated(form, &tables)).unwrap()
    });
    let albedo = tables.albedo(0.9, 3.0, Masking::HeightCorrelated).unwrap();
    for (v, l) in [(direction(0.3, 0.0), direction(0.6, 2.0)), (direction(1.4, 1.0), Vec3::Z)] {
        let e = albedo.albedo(v);
        assert!(e < 0.95);
        let (f, g) = (bare.eval(v, l, RADIANCE), scaled.eval(v, l, RADIANCE));
        for (i, f0) in [0.2, 0.6, 1.0].into_iter().enumerate() {
            let want = f[i] * (1.0 + f0 * (1.0 - e) / e);
            assert!((g[i] / want - 1.0).abs() < 1e-6, "{} for {want}", g[i]);
        }
        assert_eq!(bare.pdf(v, l), scaled.pdf(v, l));
    }
}

#[test]
fn what_tables_lack_is_said_and_the_lines_that_add_it_are_data() {
    let tables = Tables::embedded();
    let brushed = tables.student_t([0.4, 0.1], 3.0).unwrap();
    let settings = single().compensated(Compensation::KullaConty, &tables);
    let metal = |settings| Conductor::<_, 3>::new(brushed.clone(), Metal::Gold, settings);
    let refused = metal(settings).unwrap_err();
    let text = refused.to_string();
    assert!(matches!(refused, BindError::NoAlbedo { stand_in: true, .. }));
    assert!(text.contains("sigma = [0.4, 0.1]") && text.contains("StandIn::Round"), "{text}");
    let recipe = refused.recipe().unwrap();
    assert!(text.ends_with(&recipe), "{text}");
    assert!(recipe.contains("sigma = [0.4, 0.1]\ngamma = 3\nfresnel = \"mirror\""), "{recipe}");
    // A program that returns the error from `main` shows its debug form.
    assert_eq!(format!("{refused:?}"), text);
    // Without compensation none is needed, and the round lobe may stand in.
    metal(single().compensated(Compensation::None, &tables)).unwrap();
    let stood_in = metal(settings.with_stand_in(StandIn::Round)).unwrap();
    let v = direction(0.4, 0.0);
    assert!(stood_in.pdf(v, direction(1.5, 2.0)) > 0.0);

    let tilted = tables.ellipsoid(Skew::new([0.4, 0.1], [0.2, 0.1, 0.5]).unwrap(), 3.0).unwrap();
    let metal = |settings| Conductor::<_, 3>::new(tilted.clone(), Metal::Gold, settings);
    assert!(matches!(metal(settings), Err(BindError::NoAlbedo { stand_in: true, .. })));
    metal(settings.with_stand_in(StandIn::Round)).unwrap();

    // The default set has common dielectrics, seen from either side, and says which.
    let lobe = tables.student_t(0.3, 3.0).unwrap();
    for eta in [1.3, 1.5, 1.7, 1.0 / 1.5] {
        Dielectric::new(lobe.clone(), eta, settings).unwrap();
        Plastic::new(lobe.clone(), eta, [0.5], settings).unwrap();
    }
    let glass = Dielectric::new(lobe.clone(), 2.4, settings).unwrap_err();
    let plastic = Plastic::new(lobe, 2.4, [0.5], settings).unwrap_err();
    for why in [glass, plastic] {
        assert!(matches!(why, BindError::NoAlbedo { stand_in: false, .. }));
        let text = why.to_string();
        assert!(text.contains("\nfresnel = { dielectric = 2.4 }\n"), "{text}");
        assert!(text.contains("1.3") && text.contains("1.7"), "{text}");
    }
    let rough = tables.student_t(0.3, 1.8).unwrap();
    assert!(Dielectric::new(rough, 1.5, settings).is_err());
    let uncorrelated = settings.with_masking(Masking::Uncorrelated);
    let lobe = tables.student_t(0.3, 3.0).unwrap();
    assert!(Dielectric::new(lobe, 1.5, uncorrelated).is_err());

    // No table has a key of a user's own lobe.
    struct Own(Ggx);
    impl MicrofacetDistribution for Own {
        fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
            self.0.d(m)
        }
        fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
            self.0.g1(v)
        }
        fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
            self.0.sample_visible_normal(v, u)
        }
        fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
            self.0.visible_normal_pdf(v, m)
        }
    }
    impl Reflecting for Own {}
    impl Tabulated for Own {}
    let own = || Own(Ggx::new(0.3).unwrap());
    let (gold, known) = (gold(own(), single()), self::gold(own().0, single()));
    let l = direction(0.5, 2.0);
    let (f, g) = (gold.eval(v, l, RADIANCE), known.eval(v, l, RADIANCE));
    assert!((f[0] / g[0] - 1.0).abs() < 1e-5);
    let why = Conductor::<_, 3>::new(own(), Metal::Gold, settings.with_stand_in(StandIn::Round));
    assert!(matches!(why, Err(BindError::NoAlbedo { stand_in: false, .. })));
}

/// The density of a sampled direction equals the density evaluated for it: facets that single
/// precision cannot find from v and l are flagged as only sampled, and keep their weight.
#[test]
fn densities_of_refracted_light_are_found_again() {
    let tables = Tables::embedded();
    let mut random = StdRng::seed_from_u64(11);
    for gamma in [1.501, 1.55, 1.65, 1.8, 1.99, 2.0, 3.0] {
        for (sigma, eta) in [([0.3, 0.3], 1.5), ([0.6, 0.3], 1.0 / 1.5), ([0.1, 0.1], 3.0)] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let glass = glass(lobe, eta).with_channels::<1>();
            let mut only_sampled = 0.0;
            for _ in 0..20_000 {
                let v = any_direction(&mut random);
                let (choice, u) = (random.random(), [random.random(), random.random()]);
                let Some((sample, drawn)) =
                    glass.sample_with_pdf(v, choice, u, Transport::Importance)
                else {
                    continue;
                };
                let ([f], pdf) = glass.eval_pdf(v, sample.l, Transport::Importance);
                let what = format!("gamma {gamma}, eta {eta}, v {v}, u {u:?}: {sample:?}");
                if sample.delta {
                    assert_eq!((f, pdf, drawn), (0.0, 0.0, 0.0), "{what}");
                    assert_eq!(sample.event, Event::Transmission, "{what}");
                    assert!(sample.weight[0] > 0.0 && sample.weight[0] <= 1.0, "{what}");
                    only_sampled += 1.0 / 20_000.0;
                } else if pdf < f32::MAX {
                    let off = pdf / drawn - 1.0;
                    assert!(off.abs() < 0.02, "{what}: {off}");
                }
            }
            // Nearly all of the light at 1.501, and none from 2 on.
            let [least, most] = match gamma {
                1.501 => [0.3, 1.0],
                1.55 => [0.01, 0.2],
                1.65 => [1e-4, 0.02],
                1.8 => [0.0, 1e-3],
                _ => [0.0, 0.0],
            };
            assert!((least..=most).contains(&only_sampled), "{gamma} {eta}: {only_sampled}");
        }
    }
}

#[test]
fn names_that_the_set_does_not_have_are_refused() {
    let why = Tables::embedded().bsdf("gold", Compensation::None, StandIn::Refused).unwrap_err();
    assert!(matches!(why, BindError::NoSuchMaterial { .. }), "{why:?}");
}
