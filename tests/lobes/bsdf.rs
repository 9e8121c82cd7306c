//! The tests of complete BSDFs pass correct ones and reject wrong ones: 40 configurations of 2e5
//! samples here; `microfacet-bake bsdf` runs 200 of 1e6.

use std::sync::OnceLock;

use glam::Vec3;
use microfacet_baker::progress::Stage;
use microfacet_baker::table_set::Settings;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{
    AnyBsdf, BindError, Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric,
    Event, Haze, Lobe, Masking, Plastic, Retroreflective, Skew, StandIn, Tables, Transport,
};
use microfacet_tables::Kind;
use microfacet_validate::bsdf::chi_square::{run, test};
use microfacet_validate::bsdf::configuration::{Configuration, configurations};
use microfacet_validate::bsdf::specimen::{HazeOf, LobeOf, Specimen, Surface, tables};
use microfacet_validate::bsdf::{furnace, reciprocity};
use microfacet_validate::{LEVEL, Options};

use crate::common::{json, ok, refused, run as run_command};
use crate::sets::{draft, recipe};

/// The configurations of the tests, and their albedos.
fn drawn() -> &'static (Vec<Configuration>, Tables) {
    static ALL: OnceLock<(Vec<Configuration>, Tables)> = OnceLock::new();
    ALL.get_or_init(|| {
        let all = configurations(40, 7);
        let specimens: Vec<_> = all.iter().map(|one| one.specimen).collect();
        let set = tables(&specimens, Quality::Draft, Settings::default()).unwrap();
        (all, set)
    })
}

#[test]
fn samples_have_their_density() {
    let (all, set) = drawn();
    let options = Options { samples: 200_000, gamma_factor: 1.0 };
    let result = run(set, all, options, &Stage::unwatched()).unwrap();
    let worst = &result.reports[0];
    assert!(result.passed(), "p = {:e}: {}", worst.test.p, worst.configuration);
    // The tests have hundreds of cells each, except for surfaces that lose most of their light.
    let cells = result.reports.iter().filter(|report| report.test.degrees > 100).count();
    assert!(cells > 30, "{cells}");
    // Every kind of surface occurs.
    let has = |kind: fn(&Surface) -> bool| all.iter().any(|one| kind(&one.specimen.surface));
    assert!(has(|surface| *surface == Surface::Mirror));
    assert!(has(|surface| matches!(surface, Surface::Dielectric(eta) if *eta < 1.0)));
    assert!(has(|surface| matches!(surface, Surface::Plastic(..))));
    assert!(all.iter().any(|one| one.view().z < 0.0));
}

fn specimen(surface: Surface) -> Specimen {
    Specimen {
        lobe: LobeOf::StudentT,
        sigma: [0.4, 0.4],
        gamma: 3.0,
        surface,
        masking: Masking::HeightCorrelated,
        compensation: Compensation::None,
        haze: None,
        back: 0.0,
    }
}

fn glass() -> (Lobe, Dielectric<Lobe>) {
    let lobe: Lobe = Tables::embedded().student_t(0.4, 3.0).unwrap().into();
    (lobe.clone(), Dielectric::new(lobe, 1.5, BsdfSettings::new()).unwrap())
}

fn mirror(lobe: Lobe, settings: BsdfSettings) -> Conductor<Lobe, 1> {
    Conductor::new(lobe, ConductorFresnel::mirror(), settings).unwrap()
}

/// p of a BSDF's samples against a density.
fn p<const N: usize>(bsdf: &impl Bsdf<N>, v: Vec3, density: impl Fn(Vec3) -> f32) -> f64 {
    let draw = |choice, u| Some(bsdf.sample(v, choice, u, Transport::Radiance)?.l.into());
    test(v, 200_000, 5, Vec::new(), &[], draw, density).p
}

/// Lights that rough glass of γ < 2 draws, except those that are only sampled, have the density
/// that `pdf` alone states. A renderer that weights by densities relies on this.
#[test]
fn rough_glass_of_long_tails_has_its_density() {
    let tables = Tables::embedded();
    // p of a view; with `deltas`, lights that are only sampled are counted, too.
    let p = |gamma: f64, (eta, sigma): (f64, [f32; 2]), theta: f64, deltas: bool| {
        let one = Specimen { gamma, sigma, ..specimen(Surface::Dielectric(eta)) };
        let glass = one.bsdf(&tables).unwrap();
        let one = Configuration { specimen: one, theta, phi: 0.4, seed: 3 };
        let v = one.view();
        let draw = |choice, u| {
            let sample = glass.sample(v, choice, u, Transport::Radiance)?;
            (deltas || !sample.delta).then_some(sample.l.into())
        };
        test(v, 200_000, 3, one.edges(), &[], draw, |l| Bsdf::<3>::pdf(&glass, v, l)).p
    };
    let surfaces = [(1.5, [0.1, 0.1]), (1.5, [0.5, 0.2]), (1.0 / 1.5, [0.3, 0.3])];
    let views = [0.3, 1.0, 2.2];
    let mut all = Vec::new();
    for gamma in [1.55, 1.7] {
        for surface in surfaces {
            all.extend(views.map(|theta| p(gamma, surface, theta, false)));
        }
    }
    let worst = all.iter().copied().fold(1.0, f64::min);
    assert!(worst > LEVEL / all.len() as f64, "{all:?}");
    // The cells resolve the lights that are only sampled.
    assert!(p(1.55, surfaces[0], 1.0, true) < 1e-10);
}

/// Each case is a mistake that a density may have.
#[test]
fn wrong_densities_are_rejected() {
    let v = Vec3::new(0.6, 0.0, 0.8);
    let (lobe, glass) = glass();
    let pdf = |v, l| Bsdf::<3>::pdf(&glass, v, l);
    for v in [v, -v] {
        assert!(p(&glass, v, |l| pdf(v, l)) > LEVEL / 100.0);
        // The Jacobian of refraction is missing: m is counted as if it were l.
        let eta = if v.z > 0.0 { 1.5 } else { 1.0 / 1.5 };
        let without = |l: Vec3| {
            if v.z * l.z > 0.0 {
                return pdf(v, l);
            }
            let h = v + eta * l;
            let m = h.normalize_or_zero();
            let jacobian = l.dot(m).abs() * eta * eta / h.length_squared();
            pdf(v, l) / jacobian
        };
        assert!(p(&glass, v, without) < 1e-10);
        // The probability of the event is missing: reflection has the density of a conductor.
        let mirror = mirror(lobe.clone(), BsdfSettings::new());
        let chosen = |l: Vec3| match v.z * l.z > 0.0 {
            true => mirror.pdf(v.z.signum() * v, v.z.signum() * l),
            false => pdf(v, l),
        };
        assert!(p(&glass, v, chosen) < 1e-10);
        // The relative index is taken for its inverse.
        let inverse = Dielectric::new(lobe.clone(), 1.0 / 1.5, BsdfSettings::new()).unwrap();
        assert!(p(&glass, v, |l| Bsdf::<3>::pdf(&inverse, v, l)) < 1e-10);
    }
    // The broad lobe of a compensation is missing, or has a wrong probability.
    let rough: Lobe = Tables::embedded().student_t(1.0, 3.0).unwrap().into();
    let (bare, tables) = (mirror(rough.clone(), BsdfSettings::new()), Tables::embedded());
    let whole = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
    let whole = mirror(rough, whole);
    assert!(p(&whole, v, |l| whole.pdf(v, l)) > LEVEL / 100.0);
    assert!(p(&whole, v, |l| bare.pdf(v, l)) < 1e-10);
    let other = |l: Vec3| 0.2 * bare.pdf(v, l) + 0.8 * l.z.max(0.0) * std::f32::consts::FRAC_1_PI;
    assert!(p(&whole, v, other) < 1e-10);
}

/// Corners of haze and of light that goes back: next to the normal and at grazing, one part alone,
/// a mirror core, heavy tails and none, anisotropic lobes.
#[test]
fn pairs_have_their_density_and_return_their_light_by_exchange() {
    let around = |weight, sigma| Some(HazeOf { weight, sigma });
    let mirror = |gamma| Specimen { gamma, sigma: [0.1; 2], ..specimen(Surface::Mirror) };
    let mut all = Vec::new();
    for weight in [0.0, 0.5, 1.0] {
        all.push(Specimen { haze: around(weight, [0.5; 2]), ..mirror(2.0) });
        all.push(Specimen { back: weight, sigma: [0.3, 0.1], ..mirror(2.0) });
    }
    for gamma in [1.6, f64::INFINITY] {
        let haze = around(0.3, [0.2, 0.6]);
        all.push(Specimen { haze, back: 0.5, sigma: [0.1, 0.3], ..mirror(gamma) });
        all.push(Specimen { lobe: LobeOf::Smooth, haze, ..mirror(gamma) });
        all.push(Specimen { lobe: LobeOf::Smooth, haze, back: 0.5, ..mirror(gamma) });
        let glass = Surface::Dielectric(1.5);
        all.push(Specimen { haze: around(0.3, [0.5; 2]), surface: glass, ..mirror(gamma) });
    }
    let whole = Specimen { compensation: Compensation::KullaConty, ..mirror(1.6) };
    all.push(Specimen { haze: around(0.5, [1.0; 2]), back: 0.5, ..whole });
    let views = [1e-3, 0.8, 1.55];
    let configurations: Vec<_> = all
        .iter()
        .flat_map(|&specimen| {
            views.map(|theta| Configuration { specimen, theta, phi: 0.4, seed: 11 })
        })
        .collect();
    let options = Options { samples: 100_000, gamma_factor: 1.0 };
    let set = Tables::embedded();
    let result = run(&set, &configurations, options, &Stage::unwatched()).unwrap();
    let worst = &result.reports[0];
    assert!(result.passed(), "p = {:e}: {}", worst.test.p, worst.configuration);
    let result = reciprocity::run(&set, &configurations, 500).unwrap();
    assert!(result.passed() && result.pairs[0] > 2000, "{result:?}");
}

/// Each case is a mistake that a mixture of two BSDFs may have.
#[test]
fn wrong_mixtures_are_rejected() {
    let v = Vec3::new(0.6, 0.0, 0.8);
    let turned = Vec3::new(-0.6, 0.0, 0.8);
    let part = |sigma: f64| {
        let lobe = Tables::embedded().student_t(sigma, 2.5).unwrap().into();
        mirror(lobe, BsdfSettings::new())
    };
    let (core, haze) = (part(0.2), part(0.6));
    let pair = Haze::new(core.clone(), haze.clone(), 0.3).unwrap();
    let mixed = |w: f32, l| (1.0 - w) * core.pdf(v, l) + w * haze.pdf(v, l);
    assert!(p(&pair, v, |l| pair.pdf(v, l)) > LEVEL / 100.0);
    assert!(p(&pair, v, |l| mixed(0.3, l)) > LEVEL / 100.0);
    // The shares are exchanged, a little off, or a part is missing.
    for w in [0.7, 0.33, 0.0, 1.0] {
        assert!(p(&pair, v, |l| mixed(w, l)) < 1e-6, "{w}");
    }
    let back = Retroreflective::new(core.clone(), 0.3).unwrap();
    let mixed = |a: Vec3, b: Vec3, l| 0.7 * core.pdf(a, l) + 0.3 * core.pdf(b, l);
    assert!(p(&back, v, |l| mixed(v, turned, l)) > LEVEL / 100.0);
    // The view is turned for the other part, or as if it were seen in a mirror of the surface.
    assert!(p(&back, v, |l| mixed(turned, v, l)) < 1e-10);
    let upside_down = Vec3::new(-v.x, -v.y, -v.z);
    assert!(p(&back, v, |l| mixed(v, upside_down, l)) < 1e-10);
    // The pair returns what its parts return, and more where f of the part that was drawn, in place
    // of both, is divided by the density of both.
    let numbers = |i: i32| {
        let step = |step: f64| (0.5 + step * f64::from(i)).fract() as f32;
        (step(0.819_172_513), [step(0.671_043_607), step(0.549_700_478)])
    };
    let mean = |weight: &dyn Fn(f32, [f32; 2]) -> Option<f32>| {
        let weight = |i| {
            let (choice, u) = numbers(i);
            weight(choice, u).map(f64::from)
        };
        (0..40_000).filter_map(weight).sum::<f64>() / 40_000.0
    };
    let draw = |choice, u| pair.sample(v, choice, u, Transport::Radiance);
    let [a, b] = [&core, &haze].map(|part| {
        mean(&|choice, u| Some(part.sample(v, choice, u, Transport::Radiance)?.weight[0]))
    });
    let (right, want) = (mean(&|choice, u| Some(draw(choice, u)?.weight[0])), 0.7 * a + 0.3 * b);
    assert!((right - want).abs() < 3e-3, "{right} for {want}");
    let wrong = mean(&|choice, u| {
        let l = draw(choice, u)?.l;
        let drawn = if choice < 0.7 { &core } else { &haze };
        Some(drawn.eval(v, l, Transport::Radiance)[0] * l[2] / pair.pdf(v, l))
    });
    assert!((wrong - want).abs() > 0.05, "{wrong} for {want}");
}

#[test]
fn another_shape_is_rejected() {
    let surfaces = [Surface::Mirror, Surface::Dielectric(1.5), Surface::Dielectric(1.0 / 1.5)];
    let all: Vec<_> = surfaces
        .into_iter()
        .map(|surface| Configuration { specimen: specimen(surface), theta: 0.8, phi: 0.3, seed: 3 })
        .collect();
    let judge = |gamma_factor| {
        let options = Options { samples: 1_000_000, gamma_factor };
        run(&Tables::embedded(), &all, options, &Stage::unwatched()).unwrap()
    };
    assert!(judge(1.0).passed());
    assert_eq!(judge(1.05).rejected(), all.len());
}

#[test]
fn view_and_light_may_be_exchanged() {
    let (all, set) = drawn();
    let result = reciprocity::run(set, all, 2000).unwrap();
    assert!(result.passed(), "{:?}", result.worst);
    assert!(result.pairs.iter().all(|&count| count > 2000), "{:?}", result.pairs);
    // Turquin's factor depends on the view alone, so f is not reciprocal.
    let mirror = Specimen { sigma: [1.0; 2], ..specimen(Surface::Mirror) };
    let turquin = Specimen { compensation: Compensation::Turquin, ..mirror };
    let compared = |specimen| reciprocity::compare(set, &specimen, 1, 2000).unwrap();
    assert!(compared(mirror).worst.unwrap().difference < 1e-5);
    assert!(compared(turquin).worst.unwrap().difference > 0.05);
}

/// The furnace of a single interface, with tables of the default quality.
#[test]
fn white_surfaces_return_all_light_and_wrong_tables_do_not() {
    let (pairs, masking) = (&[[3.0, 1.5]], Masking::HeightCorrelated);
    let set = furnace::tables(pairs, masking, Settings::default()).unwrap();
    let all = furnace::rows(pairs, masking);
    let rows = furnace::run(&set, &all, 20_000, 1, &Stage::unwatched()).unwrap();
    assert_eq!(rows.len(), 252);
    for row in &rows {
        assert!(row.passed(), "{row}");
    }
    for name in furnace::NAMES {
        let sampled = rows.iter().filter(|row| row.name() == name && row.sampled.is_some());
        assert!(sampled.count() >= 5, "{name}");
        // The furnace needs rows that lose light in one bounce.
        assert!(rows.iter().any(|row| row.name() == name && row.single < 0.7), "{name}");
    }
    // All shares of light three per cent too small.
    let mut tables = set.tables().to_vec();
    for table in tables.iter_mut().filter(|table| table.kind == Kind::Albedo) {
        table.values.iter_mut().for_each(|share| *share *= 0.97);
    }
    let wrong = Tables::from_tables(set.provenance().clone(), tables).unwrap();
    let rows = furnace::run(&wrong, &all, 0, 1, &Stage::unwatched()).unwrap();
    // Mirrors read the default set.
    for name in furnace::NAMES.iter().filter(|name| !name.starts_with("mirror")) {
        assert!(rows.iter().any(|row| row.name() == *name && !row.passed()), "{name}");
    }
}

/// The lines of a recipe in an error.
fn lines(why: &BindError) -> String {
    format!("{}\n", why.recipe().unwrap_or_else(|| panic!("no lines: {why}")))
}

/// The lines that an error says to append to a recipe make the tables that were missing.
#[test]
fn the_lines_of_an_error_make_what_is_missing() {
    let start = "[[material]]\nname = \"first\"\nsigma = 0.2\ngamma = 3.0\n";
    let bare = draft(start);
    for gamma in [8.0, f64::INFINITY] {
        let brushed = Tables::embedded().student_t([0.4, 0.1], gamma).unwrap();
        for masking in Masking::ALL {
            let bind = |set, compensation| {
                let settings = BsdfSettings::new().with_masking(masking);
                let settings = settings.compensated(compensation, set);
                Conductor::<_, 1>::new(brushed.clone(), ConductorFresnel::mirror(), settings)
            };
            let lines = lines(&bind(&bare, Compensation::KullaConty).unwrap_err());
            let set = draft(&format!("{start}{lines}"));
            let whole = bind(&set, Compensation::KullaConty).expect(&lines);
            let gold = bind(&set, Compensation::None).unwrap();
            // The lobe's own albedo, and not that of a round one.
            let exact = set.material_albedo("another name").unwrap();
            let v = Vec3::new(0.0, 0.8, 0.6);
            let [f, g] = [&whole, &gold].map(|bsdf| bsdf.eval(v, v, Transport::Radiance)[0]);
            assert!(((f - g) / exact.compensation(v, v) - 1.0).abs() < 1e-2, "{lines}");
        }
    }
}

/// A rough plastic of an uncommon index with compensation does not bind to the default set, but to
/// a set of the error's lines.
#[test]
fn the_lines_of_a_message_make_a_plastic() {
    let bind = |set: &Tables| {
        let coat = Tables::embedded().student_t(0.3, 2.5).unwrap();
        let settings = BsdfSettings::new().compensated(Compensation::KullaConty, set);
        Plastic::new(coat, 2.4, [0.1, 0.4, 0.2], settings)
    };
    let lines = lines(&bind(&Tables::embedded()).unwrap_err());
    bind(&draft(&lines)).expect(&lines);
}

/// A recipe that names an anisotropic or tilted lobe serves it exactly, by name and by parameters.
#[test]
fn named_materials_have_their_own_albedos() {
    let set = draft(&recipe(&[
        ["brushed", "[0.5, 0.15]", "3.0", "fresnel = \"mirror\""],
        ["tilted", "[0.5, 0.3]", "\"inf\"", "theta = [0.2, -0.1, 0.7]\nfresnel = \"mirror\""],
        ["gold", "0.3", "3.0", "fresnel = { metal = \"gold\" }"],
        ["glass", "0.4", "3.0", "fresnel = { dielectric = 1.5 }\nmasking = \"uncorrelated\""],
        ["unstated", "0.4", "3.0", ""],
    ]));
    let v = Vec3::new(0.3, 0.4, 0.75_f32.sqrt());
    for name in ["brushed", "tilted"] {
        let of = |form| set.bsdf(name, form, StandIn::Refused).expect(name);
        let (bare, whole) = (of(Compensation::None), of(Compensation::KullaConty));
        let albedo = set.material_albedo(name).unwrap();
        // A light on the side of the view, where both f are small.
        let l = Vec3::new(0.6, 0.64, 0.48).normalize();
        let f = |bsdf: &AnyBsdf| bsdf.eval(v, l, Transport::Radiance)[0];
        let (more, want) = (f(&whole) - f(&bare), albedo.compensation(v, l));
        assert!((more / want - 1.0).abs() < 1e-2, "{name}: {more} for {want}");
    }
    // By parameters: the lobe finds the same table.
    let tilted = Skew::new([0.5, 0.3], [0.2, -0.1, 0.7]).unwrap();
    let tilted = set.ellipsoid(tilted, f64::INFINITY).unwrap();
    mirror(tilted.into(), BsdfSettings::new().compensated(Compensation::KullaConty, &set));

    let of = |name, form| set.bsdf(name, form, StandIn::Refused).expect(name);
    let AnyBsdf::Conductor(gold) = of("gold", Compensation::Turquin) else { panic!() };
    let want: ConductorFresnel = microfacet_sampler::Metal::Gold.into();
    assert_eq!((gold.fresnel(), gold.masking()), (&want, Masking::HeightCorrelated));
    let AnyBsdf::Dielectric(glass) = of("glass", Compensation::KullaConty) else { panic!() };
    assert_eq!((glass.eta(), glass.masking()), (1.5, Masking::Uncorrelated));
    let sample = glass.sample(v, 0.9, [0.5; 2], Transport::Radiance).unwrap();
    assert_eq!(sample.event, Event::Transmission);
    let why = set.bsdf("unstated", Compensation::None, StandIn::Refused).unwrap_err();
    assert!(matches!(why, BindError::NoFresnel(_)) && why.to_string().contains("unstated"));
}

#[test]
fn the_command_judges() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let three = ["bsdf", "--configurations", "3", "--only"];
    let few = [&three[..], &["chi-square", "--samples", "2e4"]].concat();
    assert!(ok(at, &few).ends_with("PASSED\n"));
    let one = json(at, &few);
    assert!(one["passed"] == true && one["chi_square"]["rejected"] == 0, "{one}");
    assert!(one["furnace"].is_null());
    let pairs = json(at, &[&three[..], &["reciprocity"]].concat());
    assert!(pairs["reciprocity"]["reflected"].as_u64() > Some(100));
    let wrong = ["chi-square", "--samples", "1e6", "--perturb-gamma", "1.3"];
    let output = run_command(at, &[&three[..], &wrong].concat());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.code() == Some(1) && text.ends_with("REJECTED\n"), "{text}");
    let refused = |args: &[&str]| refused(at, &[&["bsdf"], args].concat());
    assert!(refused(&["--gamma", "2"]).contains("--eta"));
    assert!(refused(&["--gamma", "1.5005", "--eta", "1.5"]).contains("1.501"));
    assert!(refused(&["--gamma", "2", "--eta", "0"]).contains("[0.1, 10]"));
}
