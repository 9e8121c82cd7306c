//! A sampler, its density and evaluation are one set: of every BSDF, of reflection off a lobe, and
//! in the furnace of plastics.

use super::*;

/// Every BSDF draws the same light whether the density is asked for or not, with the density that
/// is found for it later, and a weight of f cos over that density.
#[test]
fn samplers_densities_and_evaluation_are_one_set() {
    let tables = Tables::embedded();
    let lobe = tables.student_t([0.4, 0.25], 2.6).unwrap();
    let (bounded, ggx) = (lobe.clone().bounded(), Ggx::new([0.4, 0.25]).unwrap());
    let settings = single().compensated(Compensation::KullaConty, &tables);
    let round = || tables.student_t(0.4, 2.6).unwrap();
    check_set("conductor", &gold(lobe.clone(), single()));
    check_set("bounded conductor", &gold(bounded.clone(), single()));
    check_set("compensated conductor", &gold(round(), settings));
    check_set("closed form", &gold(ggx, single()));
    check_set("glass", &glass(lobe.clone(), 1.5));
    check_set("plastic", &Plastic::new(lobe.clone(), 1.5, [0.5; 3], single()).unwrap());
    check_set("smooth plastic", &Plastic::new(Smooth, 1.5, [0.5; 3], single()).unwrap());
    let turquin = single().compensated(Compensation::Turquin, &tables);
    check_set("scaled conductor", &gold(round(), turquin));
    let skew = Skew::new([0.4, 0.2], [0.2, -0.1, 0.5]).unwrap();
    let tilted = tables.ellipsoid(skew, 1.9).unwrap();
    check_set("tilted conductor", &gold(tilted.clone(), single()));
    check_set("tilted glass", &glass(tilted, 1.0 / 1.5));
    // Next to the facets that are only sampled, the two directions determine a facet to 2 %.
    check_set_to(0.02, "steep facets", &glass(tables.student_t(0.3, 1.55).unwrap(), 1.5));
    check_set("a renderer's own", &Lambert);
    check_set("bounded plastic", &Plastic::new(bounded, 1.5, [0.5; 3], single()).unwrap());
}

/// A diffuse surface, as a renderer may add it.
struct Lambert;

impl Bsdf for Lambert {
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        _choice: f32,
        [x, y]: [f32; 2],
        _transport: Transport,
    ) -> Option<(BsdfSample, f32)> {
        let (r, (sin, cos)) = (x.sqrt(), (std::f32::consts::TAU * y).sin_cos());
        let l = [r * cos, r * sin, (1.0 - x).sqrt()];
        let pdf = l[2] * std::f32::consts::FRAC_1_PI;
        (v.into()[2] > 0.0).then(|| (BsdfSample::reflected(l, [0.5; 3]), pdf))
    }
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        _transport: Transport,
    ) -> ([f32; 3], f32) {
        let up = v.into()[2] > 0.0;
        let cos = if up { l.into()[2].max(0.0) } else { 0.0 };
        let f = if cos > 0.0 { 0.5 * std::f32::consts::FRAC_1_PI } else { 0.0 };
        ([f; 3], cos * std::f32::consts::FRAC_1_PI)
    }
    fn is_delta(&self) -> bool {
        false
    }
    fn transmits(&self) -> bool {
        false
    }
}

fn check_set(name: &str, bsdf: &impl Bsdf) {
    check_set_to(2e-3, name, bsdf);
}

fn check_set_to(tolerance: f32, name: &str, bsdf: &impl Bsdf) {
    let mut random = StdRng::seed_from_u64(5);
    let mut count = 0;
    for _ in 0..20_000 {
        let v = any_direction(&mut random);
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        let drawn = bsdf.sample_with_pdf(v, choice, u, RADIANCE);
        let sample = bsdf.sample(v, choice, u, RADIANCE);
        let (Some((with, pdf)), Some(sample)) = (drawn, sample) else {
            assert_eq!(drawn.is_none(), sample.is_none(), "{name} {v}");
            continue;
        };
        let what = format!("{name} {v} {u:?}: {with:?}");
        assert_eq!((with.l, with.event, with.eta), (sample.l, sample.event, sample.eta), "{what}");
        let close = |a: f32, b: f32| (a - b).abs() <= 2e-6 * b.abs();
        assert!(with.weight.iter().zip(sample.weight).all(|(a, b)| close(*a, b)), "{what}");
        assert_eq!(with.delta, sample.delta, "{what}");
        let (f, found) = bsdf.eval_pdf(v, sample.l, RADIANCE);
        if with.delta {
            assert_eq!((pdf, found.min(0.0)), (0.0, 0.0), "{what}");
            continue;
        }
        // Where the facet is known from the two directions; rounding grows towards grazing.
        if v.z.abs() > 0.1 && sample.l[2].abs() > 0.1 && pdf < 1e3 {
            let quotient = f[1] * sample.l[2].abs() / found;
            assert!((found / pdf - 1.0).abs() < tolerance, "{what}: {found} for {pdf}");
            assert!((quotient / sample.weight[1] - 1.0).abs() < tolerance, "{what}: {quotient}");
            count += 1;
        }
    }
    assert!(count > 4000, "{name}: {count}");
}

/// The lobes' own set of reflection is that of a perfect mirror's facets.
#[test]
fn reflection_off_a_lobe_is_that_of_a_white_conductor() {
    let tables = Tables::embedded();
    let skew = Skew::new([0.3, 0.1], [0.2, -0.1, 0.5]).unwrap();
    let lobes: [Lobe; 6] = [
        tables.student_t([0.4, 0.25], 2.6).unwrap().into(),
        tables.student_t(0.5, 1.6).unwrap().into(),
        tables.student_t([0.5, 0.3], 1.6).unwrap().bounded().into(),
        tables.student_t(0.7, f64::INFINITY).unwrap().bounded().into(),
        tables.ellipsoid(skew, 2.2).unwrap().into(),
        Ggx::new(0.4).unwrap().into(),
    ];
    let mut random = StdRng::seed_from_u64(6);
    for lobe in lobes {
        let white =
            Conductor::new(lobe.clone(), ConductorFresnel::<1>::mirror(), single()).unwrap();
        for _ in 0..2000 {
            let (v, l) = (any_direction(&mut random), any_direction(&mut random));
            let u = [random.random(), random.random()];
            let drawn = lobe.sample_reflected(v, u, Masking::default());
            let sample = white.sample(v, 0.5, u, RADIANCE);
            assert_eq!(drawn, sample.map(|sample| (sample.l, sample.weight[0])), "{lobe:?} {v}");
            let ([f], pdf) = white.eval_pdf(v, l, RADIANCE);
            assert_eq!(lobe.eval_pdf(v, l, Masking::default()), (f, pdf), "{lobe:?} {v} {l}");
            // By the formulas of Cook & Torrance and of visible normals.
            let m = (v + l).normalize();
            if v.z > 0.0 && l.z > 0.0 && pdf > 1e-6 {
                let g2 = lobe.g2(v, l, Masking::default());
                let want = lobe.d(m) * g2 / (4.0 * v.z * l.z);
                assert!((f / want - 1.0).abs() < 1e-4, "{lobe:?} {v} {l}: {f} for {want}");
                let share = lobe.reflecting_share(v);
                let want = lobe.visible_normal_pdf(v, m) / (4.0 * v.dot(m) * share);
                assert!((pdf / want - 1.0).abs() < 1e-4, "{lobe:?} {v} {l}: {pdf} for {want}");
            }
        }
        assert_eq!(lobe.eval_pdf(Vec3::Z, [f32::NAN; 3], Masking::default()), (0.0, 0.0));
    }
}

/// A rough coat of single scattering over a white base never returns more than it receives, however
/// dense, narrow, brushed or tilted: T and R, which are integrated, agree with what facets reflect.
#[test]
fn rough_white_plastic_returns_no_more_than_all_light() {
    let tables = Tables::embedded();
    let upright = [[1e-3, 1e-3], [0.02, 0.02], [0.3, 0.3], [0.3, 0.1], [0.5, 0.05]];
    for gamma in [1.501, 2.0, f64::INFINITY] {
        let skew = Skew::new([0.3, 0.2], [0.2, -0.1, 0.5]).unwrap();
        let lobes = upright.map(|sigma| Lobe::from(tables.student_t(sigma, gamma).unwrap()));
        for lobe in lobes.into_iter().chain([tables.ellipsoid(skew, gamma).unwrap().into()]) {
            for eta in [0.2, 1.0 / 1.5, 1.01, 1.5, 30.0, 100.0] {
                let white = Plastic::new(lobe.clone(), eta, [1.0], single()).unwrap();
                for cos in [1e-5_f32, 1e-3, 0.05, 0.3, 0.7, 1.0] {
                    for azimuth in [0.0_f32, 0.8, 1.45] {
                        let sin = (1.0 - cos * cos).sqrt();
                        let v = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
                        // What exceeds the limit may be noise, and is computed again without.
                        let exceeds =
                            [4000, 200_000].iter().all(|&n| mean_weight(&white, v, n) > 1.003);
                        assert!(!exceeds, "{lobe:?} {eta} {cos} {azimuth}");
                    }
                }
            }
        }
    }
}

fn mean_weight(bsdf: &impl Bsdf<1>, v: [f32; 3], count: usize) -> f64 {
    let at = |i: usize, step: f64| (0.5 + step * i as f64).fract() as f32;
    let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_8];
    let weight = |i: usize| {
        let [choice, x, y] = steps.map(|step| at(i, step));
        bsdf.sample(v, choice, [x, y], RADIANCE).map_or(0.0, |sample| f64::from(sample.weight[0]))
    };
    (0..count).map(weight).sum::<f64>() / count as f64
}
