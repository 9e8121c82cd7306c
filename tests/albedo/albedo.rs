//! Albedo tables end to end: baked for recipes that ask, restricted to what they ask for, read
//! back, and refused elsewhere.

use glam::Vec3;
use microfacet_baker::bake::albedo;
use microfacet_baker::bake::albedo::{AlbedoLobe, AlbedoSpec, Integrand, Models, Site};
use microfacet_baker::plan::{AlbedoVerdict, AlbedoWish, Cost, Options, Plan, RequiredAlbedo};
use microfacet_baker::scene::Scene;
use microfacet_baker::store;
use microfacet_baker::table_set::{Settings, Target, bake, bake_with, costs};
use microfacet_baker::table_spec::Quality;
use microfacet_model::fresnel::{Conductor, Dielectric};
use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_sampler::albedo::{FresnelAlbedo, ViewCurve};
use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};
use microfacet_tables::{Kind, Precision, Reflectance, Roughness, Side, Table, encode};
use microfacet_validate::furnace::direction;
use serde_json::{Value, json};

use crate::common::{json, ok, run};
use crate::sets::{self, DRAFT, baked, draft, mean, mean_reflected, recipe, set_of};

fn domain(gamma: [f64; 2], sigma: [f64; 2]) -> AlbedoLobe {
    AlbedoLobe::family(Roughness::Isotropic(sigma.into()), gamma.into())
}

fn plan(materials: &[[&str; 4]], albedo: AlbedoWish) -> Plan {
    sets::plan(&recipe(materials), Options { albedo, ..Options::default() })
}

/// The albedos of a plan, for the materials that ask for them.
fn albedos_of(materials: &[[&str; 4]]) -> Plan {
    let mut plan = plan(materials, AlbedoWish::Auto);
    (plan.shapes, plan.distributions) = Default::default();
    plan
}

/// The largest error that certificates of a set state.
fn worst(set: &Tables) -> f64 {
    set.tables().iter().map(|table| table.certificate.worst()).fold(0.0, f64::max)
}

const MIRROR: &str = "fresnel = \"mirror\"";
const UNCORRELATED: &str = "fresnel = \"mirror\"\nmasking = \"uncorrelated\"";
const CORRELATED: &str = "fresnel = { schlick = 0.04 }\nmasking = \"height-correlated\"";
const MIXED: [[&str; 4]; 6] = [
    ["plain", "0.2", "5.0", ""],
    ["mirror", "0.454", "3.0", UNCORRELATED],
    ["the other form", "0.454", "3.0", "fresnel = { schlick = 0.5 }"],
    ["gold", "0.3", "2.0", CORRELATED],
    ["brushed", "[0.6, 0.15]", "2.0", CORRELATED],
    ["smooth", "0.0", "2.0", MIRROR],
];

#[test]
fn those_who_ask_get_the_form_they_name() {
    let plan_of = |albedo| plan(&MIXED, albedo);
    let asked = plan_of(AlbedoWish::Auto);
    let need = |lobe, maskings: &[Masking]| RequiredAlbedo {
        lobe,
        reflectance: Reflectance::Mirror,
        maskings: maskings.into(),
        coarse: false,
    };
    // The anisotropic material needs the albedo of its own lobe, not that of an isotropic stand-in.
    let brushed = AlbedoLobe::student_t([0.6, 0.15], 2.0);
    let wanted = [
        need(domain([3.0; 2], [0.454; 2]), &Masking::ALL),
        need(domain([2.0; 2], [0.3; 2]), &[Masking::HeightCorrelated]),
        need(brushed, &[Masking::HeightCorrelated]),
    ];
    assert_eq!(asked.albedos, wanted);
    use AlbedoVerdict::{Bake, NotAsked, NotNeeded};
    let bake = |need| Bake(vec![need]);
    assert_eq!(asked.albedo_verdicts, [NotAsked, bake(0), bake(0), bake(1), bake(2), NotNeeded]);
    assert!(plan_of(AlbedoWish::None).albedos.is_empty());
    assert!(matches!(plan_of(AlbedoWish::All).albedo_verdicts[0], Bake(_)));
    // GGX needs a table of its albedo, and no other.
    let gold = plan(&MIXED[3..4], AlbedoWish::Auto);
    assert!(gold.shapes.is_empty() && !gold.is_empty());
}

#[test]
fn many_roughnesses_are_a_range_and_what_lies_inside_is_there() {
    let sigmas: Vec<String> = (0..100).map(|i| format!("{}", 0.1 + 0.002 * f64::from(i))).collect();
    let names: Vec<String> = (0..100).map(|i| format!("m{i}")).collect();
    let mut materials: Vec<[&str; 4]> =
        (0..100).map(|i| [names[i].as_str(), sigmas[i].as_str(), "3.0", MIRROR]).collect();
    let one = plan(&materials, AlbedoWish::Auto);
    assert_eq!(one.albedos.len(), 1);
    assert_eq!(one.albedos[0].lobe, domain([3.0; 2], [0.1, 0.1 + 0.002 * 99.0]));
    materials.push(["texture", "{ min = 0.0, max = 0.5 }", "{ min = 2.5, max = 4.0 }", MIRROR]);
    let plan = plan(&materials, AlbedoWish::Auto);
    assert_eq!(plan.albedos.len(), 1, "{:?}", plan.albedos);
    assert!(plan.albedo_verdicts.iter().all(|verdict| *verdict == AlbedoVerdict::Bake(vec![0])));
}

#[test]
fn a_part_reads_as_the_whole_does() {
    let of = |lobe| {
        let need = RequiredAlbedo {
            lobe,
            maskings: vec![Masking::HeightCorrelated],
            ..RequiredAlbedo::general()
        };
        set_of(albedo::bake(&need.spec(Quality::Draft, Precision::F32).unwrap()).unwrap(), None)
    };
    // The whole extends beyond the part on every side, so that windows are the same.
    let (part, whole) = (of(domain([2.6, 2.9], [0.0, 0.08])), of(domain([2.2, 3.6], [0.0, 0.2])));
    assert!(part.tables()[0].values.len() < whole.tables()[0].values.len());
    for gamma in [2.6, 2.77, 2.9] {
        for sigma in [0.003, 0.02, 0.08] {
            let [a, b] = [&part, &whole]
                .map(|set| set.albedo(sigma, gamma, Masking::HeightCorrelated).unwrap());
            for cos in [0.01, 0.3, 0.77, 1.0] {
                let [a, b] = [&a, &b].map(|albedo| albedo.moments(direction(cos)));
                let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
                // Node distances round differently.
                assert!(near(a.scale, b.scale) && near(a.bias, b.bias), "{a:?} {b:?}");
            }
            assert!((a.albedo_average() - b.albedo_average()).abs() < 1e-6);
        }
    }
}

#[test]
fn a_single_material_has_its_albedo_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("r.toml"), recipe(&MIXED[1..2])).unwrap();
    let text = ok(at, &["bake", "r.toml", "--out", "out"]);
    assert!(text.contains("in albedo_") && text.contains("s, albedo "), "{text}");
    let set = store::read(&at.join("out/tables.safetensors")).unwrap();
    let albedo = set.albedo(0.454, 3.0, Masking::Uncorrelated).unwrap();
    let model = AlbedoIntegrator::new(Shape::new(3.0).unwrap(), 1e-9);
    for cos in [0.02_f32, 0.1, 0.33, 0.5, 0.9, 1.0] {
        let exact = model.reflection(0.454, f64::from(cos), |_| [1.0]).unwrap().uncorrelated[0];
        assert!((f64::from(albedo.albedo(direction(cos))) - exact).abs() < 2e-6, "{cos}");
    }
    let table = set.table(Kind::Albedo).unwrap();
    assert_eq!(table.shape(), [1, 1, 33, 3]);
    assert!(table.certificate.quadrature.unwrap() < 1e-5);
    assert_eq!(table.subject.lobe.sigma(), [0.454; 2]);
    // Another roughness, shape or form of masking is not there, and the message says what is.
    for (sigma, gamma) in [(0.3, 3.0), (0.5, 3.0), (0.454, 2.9)] {
        let why = set.albedo(sigma, gamma, Masking::Uncorrelated).unwrap_err().to_string();
        assert!(why.contains("it holds is gamma 3 with sigma 0.454"), "{why}");
    }
    assert!(set.albedo(0.454, 3.0, Masking::HeightCorrelated).is_err());
    // The same as an image.
    ok(at, &["bake", "r.toml", "--out", "image", "--format", "exr"]);
    assert_eq!(store::read(&at.join("image")).unwrap(), set);
    // The second bake takes all from the cache.
    assert_eq!(json(at, &["bake", "r.toml", "--out", "out"])["baked"], 0);
    let less = json(at, &["bake", "r.toml", "--out", "less", "--no-albedo"]);
    assert_eq!(less["tables"].as_array().unwrap().len(), 3);
}

#[test]
fn imported_scenes_are_given_albedos_that_are_quick_and_have_to_ask_for_others() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // Spectra of samples leave the Fresnel term open.
    let open = "\"spectrum eta\" [ 400 2 700 3 ]";
    let scene = format!(
        "MakeNamedMaterial \"steel\" \"string type\" \"conductor\" \"float roughness\" 0.04 {open}"
    );
    std::fs::write(at.join("s.pbrt"), scene).unwrap();
    let given = json(at, &["plan", "s.pbrt"]);
    assert_eq!(given["albedo"][0]["masking"], json!(["height-correlated"]));
    assert_eq!(given["albedo"][0]["materials"], json!(["steel"]));
    assert_eq!(given["materials"][0]["albedo"][0], "baked");
    assert_eq!(given["offered"], Value::Null);
    let none = json(at, &["plan", "s.pbrt", "--no-albedo"]);
    assert_eq!(none["materials"][0]["albedo"][0], "declined");

    // Brushed metals have tables over the azimuth, which take longer.
    let brushed = |i: u32| {
        format!(
            "MakeNamedMaterial \"{i}\" \"string type\" \"conductor\" {open}
             \"float uroughness\" 0.0{i} \"float vroughness\" 0.3\n"
        )
    };
    std::fs::write(at.join("b.pbrt"), (1..9).map(brushed).collect::<String>()).unwrap();
    let shown = json(at, &["plan", "b.pbrt"]);
    assert_eq!(shown["albedo"], json!([]));
    assert_eq!(shown["materials"][0]["albedo"][0], "not asked");
    let asked = json(at, &["plan", "b.pbrt", "--albedo"]);
    let asked_for = asked["albedo"].as_array().unwrap().iter();
    assert_eq!(asked_for.map(|of| of["names"].as_array().unwrap().len()).sum::<usize>(), 8);
    // The offered cost is the difference of the totals, in bytes and in time.
    for of in ["bytes", "seconds"] {
        let [with, without] = [&asked, &shown].map(|plan| plan["total"][of].as_f64().unwrap());
        let offered = shown["offered"]["cost"][of].as_f64().unwrap();
        assert!((offered / (with - without) - 1.0).abs() < 1e-9, "{of}: {offered}");
    }
    let text = ok(at, &["plan", "b.pbrt"]);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["albedo, not asked", "--albedo bakes 8 tables"] {
        assert!(text.contains(part), "{text}");
    }

    json(at, &["bake", "s.pbrt", "--quality", "draft", "--out", "out"]);
    let set = store::read(&at.join("out")).unwrap();
    assert!(set.albedo(0.2, 2.0, Masking::HeightCorrelated).is_ok());
    assert!(set.provenance().conventions.contains_key("albedo"));
}

#[test]
fn targets_are_met_or_refused() {
    let plan = albedos_of(&MIXED[1..2]);
    let bake = |target| {
        bake_with(&plan, target, Settings { patient: true, ..Settings::default() })
            .map(|baked| baked.set)
    };
    let draft = bake(DRAFT).unwrap();
    let enough = 1.1 * worst(&draft);
    let least = bake(Target::MaxError(enough)).unwrap();
    assert!(worst(&least) <= enough);
    // In fixed point it takes fewer bytes than the draft, even with some more nodes.
    let stored = |set: &Tables| set.tables().iter().map(Table::stored_bytes).sum::<usize>();
    assert_eq!(least.tables()[0].precision, Precision::U16);
    assert!(stored(&least) < stored(&draft));
    let finer = 0.1 * worst(&draft);
    assert!(worst(&bake(Target::MaxError(finer)).unwrap()) <= finer);
    let refused = bake(Target::MaxError(1e-12)).unwrap_err().to_string();
    assert!(refused.contains("albedo") && refused.contains("at best"), "{refused}");

    let folder = tempfile::tempdir().unwrap();
    let wild = recipe(&[["wild", "3.5", "2.0", MIRROR]]);
    std::fs::write(folder.path().join("r.toml"), wild).unwrap();
    for (args, words) in [
        (&["--max-bytes", "9000"][..], &["3.5", "fresnel"][..]),
        (&[], &["\"wild\"", "3.5", "above 3", "--no-albedo"]),
    ] {
        let output = run(folder.path(), &[&["bake", "r.toml", "--out", "out"], args].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2));
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
}

#[test]
fn a_surface_smoother_than_the_promised_ones_has_a_certificate() {
    let smooth = [
        ["water", "0.002", "2.0", MIRROR],
        ["pond", "0.002", "2.0", "fresnel = { dielectric = 1.33 }"],
        ["nearly a mirror", "{ min = 0.0, max = 1e-4 }", "5.0", MIRROR],
    ];
    let set = bake(&albedos_of(&smooth), DRAFT).unwrap().set;
    for table in set.tables() {
        assert!(table.certificate.worst() < 1e-2, "{}: {:?}", table.name, table.certificate);
        table.validate().unwrap();
    }
}

#[test]
fn estimated_bytes_are_those_of_the_file() {
    // Without the albedo whose views are refined.
    let plan = albedos_of(&MIXED[..4]);
    let set = bake(&plan, DRAFT).unwrap().set;
    let estimate = costs(&plan, Quality::Draft, Precision::F32).unwrap();
    let estimate = estimate.into_iter().sum::<Cost>().bytes as f64;
    let real = encode(set.provenance(), set.tables()).unwrap().len() as f64;
    assert!((estimate / real - 1.0).abs() < 0.04, "{estimate} for {real}");
}

const GOLD: &str = "masking = \"height-correlated\"
fresnel = { conductor = { eta = [0.143, 0.375, 1.442], k = [3.983, 2.386, 1.603] } }";

const EXACT: [[&str; 4]; 4] = [
    ["gold", "0.3", "2.0", GOLD],
    ["glass", "0.454", "3.0", "fresnel = { dielectric = 1.6 }\nmasking = \"uncorrelated\""],
    ["air", "0.454", "3.0", "fresnel = { dielectric = 0.625 }\nmasking = \"uncorrelated\""],
    ["nothing", "0.454", "3.0", "fresnel = { dielectric = 1.0 }\nmasking = \"uncorrelated\""],
];

/// The albedo of reflection of a material: F G2/G1.
fn reflected(
    set: &Tables,
    name: &str,
    masking: Masking,
    cos: f32,
    fresnel: impl Fn(f64) -> f64,
) -> f64 {
    let (lobe, v) = (set.material(name).unwrap(), direction(cos));
    mean_reflected(&lobe, v, 300, |m, l| {
        fresnel(v.dot(m).into()) * f64::from(lobe.g2(v, l, masking) / lobe.g1(v))
    })
}

/// The albedo of transmission, with the refraction at each normal computed.
fn transmitted(set: &Tables, name: &str, masking: Masking, cos: f32, face: Dielectric) -> f64 {
    let (lobe, v) = (set.material(name).unwrap(), direction(cos));
    mean(&lobe, v, 300, |m| {
        let mu = f64::from(v.dot(m));
        let Some(inside) = face.refracted_cos(mu) else { return 0.0 };
        let l = (mu / face.eta() - inside) as f32 * m - v / face.eta() as f32;
        let below = Vec3::new(l.x, l.y, -l.z);
        let g = if l.z < 0.0 { lobe.g2(v, below, masking) / lobe.g1(v) } else { 0.0 };
        (1.0 - face.reflectance(mu)) * f64::from(g)
    })
}

/// Whether a table is of an exact reflectance.
fn is_exact(table: &&Table) -> bool {
    table.subject.reflectance.is_some_and(|reflectance| reflectance != Reflectance::Mirror)
}

#[test]
fn a_range_of_indices_has_an_axis() {
    let range = "fresnel = { dielectric = { min = 1.2, max = 1.7 } }\nmasking = \"uncorrelated\"";
    let text = recipe(&[["any", "0.5", "3.0", range]]);
    let scene = Scene::from_recipe_str(&text).unwrap();
    let again = Scene::from_recipe_str(&scene.to_recipe()).unwrap();
    assert_eq!(again.materials[0].fresnel, scene.materials[0].fresnel);
    let set = draft(&text);
    let tables: Vec<_> = set.tables().iter().filter(is_exact).collect();
    assert_eq!(tables.len(), 2);
    for Table { name, axes, certificate, .. } in tables {
        assert!(axes[2].len() > 5 && certificate.worst() < 3e-3, "{name}: {certificate:?}");
    }
    let integrator = AlbedoIntegrator::new(Shape::new(3.0).unwrap(), 1e-6);
    for eta in [1.2, 1.37, 1.7] {
        let albedo = set.material_dielectric_albedo("any", eta).unwrap();
        for cos in [0.1, 0.4, 0.9] {
            for (got, eta) in [
                (albedo.outside.eval(direction(cos)), eta),
                (albedo.inside.eval(direction(cos)), 1.0 / eta),
            ] {
                let pane = Dielectric::new(eta).unwrap();
                let [want] = integrator.transmission(0.5, cos.into(), pane).unwrap().uncorrelated;
                let off = (f64::from(got[1]) - want).abs();
                assert!(off < 2e-3, "eta {eta}, {cos}: {got:?}, {want}");
            }
        }
    }
    // Every value is in [0, 1], and there is no step at the critical angle.
    let albedo = set.material_dielectric_albedo("any", 1.5).unwrap();
    let critical = (1.0_f32 - 1.0 / 2.25).sqrt();
    let ends = [f32::NAN, -1.0, 0.0, 1e-40, 1e-7, 1.0 - f32::EPSILON, 1.0, f32::INFINITY];
    for curve in [&albedo.outside, &albedo.inside] {
        for cos in ends.into_iter().chain([critical]) {
            let shares = curve.eval(direction(cos));
            assert!(shares.iter().all(|x| (0.0..=1.0).contains(x)), "{cos}: {shares:?}");
        }
        let sides = [critical - 1e-6, critical + 1e-6].map(|cos| curve.eval(direction(cos)));
        assert!(sides[0].iter().zip(sides[1]).all(|(a, b)| (a - b).abs() < 1e-4), "{sides:?}");
    }
    let why = set.material_dielectric_albedo("any", 4.0).unwrap_err().to_string();
    assert!(why.contains("index 4 ") && why.contains("it holds"), "{why}");
    for (range, told) in [
        ("{ min = 0.5, max = 2.0 }", "0.5"),
        ("{ min = 2.0, max = 1.5 }", "inverted"),
        ("{ min = \"inf\", max = \"inf\" }", "inf"),
        ("{ min = 1.5, max = 1.5 }", "1.5"),
    ] {
        let range = format!("fresnel = {{ dielectric = {range} }}");
        let text = recipe(&[["any", "0.5", "3.0", &range]]);
        let why = Scene::from_recipe_str(&text).unwrap_err().to_string();
        assert!(why.contains(told), "{range}: {why}");
    }
}

/// The largest error of the reflected and the transmitted share of light seen from inside a
/// dielectric, at some indices and views, for a draft for a lobe of σ = 0.3 and a range of indices.
fn inside(gamma: f64, indices: [f64; 2], etas: &[f64], views: &[f64]) -> f64 {
    let lobe = AlbedoLobe::student_t([0.3; 2], gamma);
    let side = Side::Dense;
    let dense = Reflectance::Interface { side, index: indices.into() };
    let maskings = vec![Masking::HeightCorrelated];
    let spec = AlbedoSpec::new(lobe, dense, maskings, Quality::Draft, Precision::F32).unwrap();
    let table = albedo::bake(&spec).unwrap().remove(0);
    let (integrand, mut worst) = (Integrand::new(&dense).unwrap(), 0.0_f64);
    for &eta in etas {
        let curve = ViewCurve::<2>::from_table(&table, 0.3, gamma, eta).unwrap();
        for &cos in views {
            let site = Site { gamma, sigma: 0.3, eta, phi: 0.0, cos };
            let exact = Models::with(&spec.lobe, [gamma], 1e-6, |models| {
                integrand.at(models.at(&site), &site)
            });
            let exact = exact.unwrap().height_correlated;
            let got = curve.eval(direction(cos as f32));
            for (got, exact) in got.into_iter().zip(exact) {
                worst = worst.max((f64::from(got) - exact).abs());
            }
        }
    }
    worst
}

/// The rounding of an end at infinity is infinite, so every index could be taken for that end.
#[test]
fn indices_up_to_infinity_are_told_apart() {
    let views = [0.1, 0.5, 0.9, 1.0];
    assert!(inside(3.0, [1.2, f64::INFINITY], &[1.2, 1.5, 2.5, f64::INFINITY], &views) < 5e-3);
}

/// Upright facets, of which heavy tails have many, begin to transmit where cos θ is 1/η: one
/// polynomial across that view misses the transmitted share by 1e-2.
#[test]
fn views_at_which_upright_facets_begin_to_transmit_are_resolved() {
    for eta in [1.2, 1.5, 3.0] {
        let beside = [-0.1, -0.03, -0.01, -1e-3, -1e-5, 0.0, 1e-5, 1e-3, 0.01, 0.03, 0.1];
        let views = beside.map(|step: f64| (1.0 / eta + step).min(1.0));
        let error = inside(1.55, [eta; 2], &[eta], &views);
        assert!(error < 1.5e-3, "{eta}: {error}");
    }
}

#[test]
fn conductors_and_dielectrics_have_the_albedo_of_their_exact_reflectance() {
    let set = baked(&recipe(&EXACT), Target::default());
    // Gold; glass from both sides, which serves air; and one table for the index-matched interface,
    // which is the same from both sides.
    assert_eq!(set.tables().iter().filter(is_exact).count(), 4);
    for table in set.tables().iter().filter(is_exact) {
        assert!(table.certificate.worst() < 3e-4, "{}: {:?}", table.name, table.certificate);
        assert!(table.certificate.quadrature.unwrap() < 1e-5);
    }

    let FresnelAlbedo::Conductor(gold) = set.material_fresnel_albedo("gold").unwrap() else {
        panic!()
    };
    let metal = [(0.143, 3.983), (0.375, 2.386), (1.442, 1.603)]
        .map(|(eta, k)| Conductor::new(eta, k).unwrap());
    for cos in [0.05, 0.3, 0.8, 1.0] {
        for (got, metal) in gold.eval(direction(cos)).into_iter().zip(metal) {
            let fresnel = |x| metal.reflectance(x);
            let want = reflected(&set, "gold", Masking::HeightCorrelated, cos, fresnel);
            assert!((f64::from(got) - want).abs() < 2e-3, "gold at {cos}: {got}, {want}");
        }
        // Bounded by what F = 1 returns.
        let all = set.material_albedo("gold").unwrap().albedo(direction(cos));
        assert!(gold.eval(direction(cos)).iter().all(|&x| x <= all + 1e-5));
    }
    let average = gold.average();
    assert!(average[0] > average[1] && average[1] > average[2] && average[0] < 1.0, "{average:?}");

    let sides = |name| match set.material_fresnel_albedo(name).unwrap() {
        FresnelAlbedo::Dielectric(sides) => sides,
        other => panic!("{other:?}"),
    };
    let (glass, air, nothing) = (sides("glass"), sides("air"), sides("nothing"));
    let interface = Dielectric::new(1.6).unwrap();
    let all = set.material_albedo("glass").unwrap();
    for cos in [0.05, 0.3, 0.6, 0.8, 1.0] {
        let v = direction(cos);
        let (entering, leaving) = (glass.outside.eval(v), glass.inside.eval(v));
        for (got, face) in [(entering, interface), (leaving, interface.reversed())] {
            let fresnel = |x| face.reflectance(x);
            let want = reflected(&set, "glass", Masking::Uncorrelated, cos, fresnel);
            assert!((f64::from(got[0]) - want).abs() < 2e-3, "glass at {cos}: {got:?}, {want}");
            let want = transmitted(&set, "glass", Masking::Uncorrelated, cos, face);
            assert!(
                (f64::from(got[1]) - want).abs() < 3e-3,
                "through it at {cos}: {got:?}, {want}"
            );
            assert!(got[0] <= all.albedo(v) + 1e-4 && got[0] + got[1] <= 1.0 + 1e-4, "{got:?}");
        }
        assert!(entering[0] < leaving[0] && entering[1] > leaving[1]);
        // The other side of the same interface, from the same tables.
        assert_eq!((air.outside.eval(v), air.inside.eval(v)), (leaving, entering));
        assert_eq!(nothing.outside.eval(v)[0], 0.0);
        assert_eq!(nothing.outside.eval(v), nothing.inside.eval(v));
    }
    // Average transmission is the same both ways up to the ratio of solid angles, η².
    let (enters, leaves) = (glass.outside.average()[1], glass.inside.average()[1]);
    assert!((enters - 2.56 * leaves).abs() < 1e-4, "{enters} and {leaves}");
    assert!(set.material_fresnel_albedo("copper").is_err());
}
