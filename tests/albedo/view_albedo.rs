//! Albedo tables over all views, end to end: for lobes that are not isotropic, and for those
//! outside the family.

use std::sync::LazyLock;

use glam::Vec3;
use microfacet_baker::bake::albedo::{AlbedoLobe, AlbedoSpec, Models, Site, bake, weights};
use microfacet_baker::certify::albedo::{certified, interior_references, missed_by_half};
use microfacet_baker::plan::Options;
use microfacet_baker::progress::Stage;
use microfacet_baker::store;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::albedo::{Albedo, FresnelAlbedo, ViewCurve};
use microfacet_sampler::{BindError, Lobe, Masking, MicrofacetDistribution, Tables};
use microfacet_tables::{LobeSpec, Precision, Quantity, Reflectance, Table, encode};
use serde_json::json;

use crate::common::{json, ok};
use crate::sets::{direction, draft, mean_reflected, plan, recipe};

/// σx and σy, and γ; cos θ and φ, whether correlated, and E.
type Reference = (([f64; 2], f64), ([f64; 2], bool, f64));

/// Independently integrated.
const REFERENCE: [Reference; 6] = [
    (
        ([8.3663595940515578e-01, 1.8308432948070335e+00], 1.55),
        ([6.0718204099530682e-01, 3.9627675943465577], false, 2.0872905077163967e-02),
    ),
    (
        ([7.4568217468574471e-01, 1.4241501596865552e-01], 2.5),
        ([7.6052364365567737e-01, 5.4189788932829108e-01], true, 7.7274547738909416e-01),
    ),
    (
        ([1.3083347922293459e-01, 1.1215055613044751], 1.8581594715900893),
        ([5.3205056829163744e-01, 3.3376563960005234], false, 4.2776669010613888e-01),
    ),
    (
        ([8.2318179246625356e-01, 1.2108621091826757e-01], 8.0),
        ([3.0189095046339626e-01, 1.0622907540033377], true, 8.9592194255795199e-01),
    ),
    (
        ([4.7838580515658757e-01, 2.0], 3.0),
        ([3.9786316530442611e-01, 4.3238001313265064], false, 5.1051271478131088e-01),
    ),
    (
        ([6.3962601128219509e-01, 2.0], 1.7),
        ([1.4856543593771659e-01, 1.7119071938636254], true, 3.9822057356187424e-01),
    ),
];

const CORRELATED: &str = "fresnel = { schlick = 0.04 }\nmasking = \"height-correlated\"";
const PLAIN: &str = "fresnel = \"mirror\"\nmasking = \"uncorrelated\"";

const MATERIALS: [[&str; 4]; 6] = [
    ["brushed", "[0.6, 0.15]", "2.7", CORRELATED],
    ["the same", "[0.6, 0.15]", "2.7", CORRELATED],
    ["other form", "[0.6, 0.15]", "2.7", PLAIN],
    ["round", "0.3", "2.7", PLAIN],
    ["worn", "[{ min = 0.2, max = 0.3 }, 0.1]", "2.7", PLAIN],
    ["silent", "[0.4, 0.1]", "2.7", ""],
];

static SET: LazyLock<Tables> = LazyLock::new(|| draft(&recipe(&MATERIALS)));

fn views(set: &Tables) -> Vec<&Table> {
    let own = |table: &&Table| table.kind.is_albedo() && !table.subject.lobe.is_family();
    set.tables().iter().filter(own).collect()
}

fn spec(sigma: [f64; 2], gamma: f64, quality: Quality) -> AlbedoSpec {
    let lobe = AlbedoLobe::student_t(sigma, gamma);
    let form = vec![Masking::HeightCorrelated];
    AlbedoSpec::new(lobe, Reflectance::Mirror, form, quality, Precision::F32).unwrap()
}

#[test]
fn the_model_agrees_with_independent_values() {
    for ((sigma, gamma), ([cos, phi], correlated, e)) in REFERENCE {
        let lobe = AlbedoLobe::student_t(sigma, gamma);
        let site = Site { gamma: f64::INFINITY, sigma: f64::NAN, eta: f64::NAN, phi, cos };
        let albedo =
            Models::with(&lobe, [], 1e-8, |models| models.at(&site).reflection(&site, weights))
                .unwrap();
        let [scale, bias, _] =
            if correlated { albedo.height_correlated } else { albedo.uncorrelated };
        assert!((scale + bias - e).abs() < 1e-7, "{sigma:?} {gamma}: {} for {e}", scale + bias);
    }
}

#[test]
fn a_table_of_default_quality_agrees_with_independent_values() {
    let ((sigma, gamma), ([cos, phi], _, e)) = REFERENCE[1];
    let table = bake(&spec(sigma, gamma, Quality::Default)).unwrap().remove(0);
    let albedo = Albedo::from_table(&table, f64::NAN, f64::NAN).unwrap();
    let got = f64::from(albedo.albedo(direction(cos, phi)));
    assert!((got - e).abs() < 1e-4, "{got} for {e}");
}

#[test]
fn each_lobe_and_form_has_one_table_within_its_error() {
    let tables = views(&SET);
    let names: Vec<&str> = tables.iter().map(|table| table.name.as_str()).collect();
    let name = |form: Masking| format!("albedo_{}_gamma_2.7_sigma_0.6_0.15", form.name());
    assert_eq!(names, [Masking::Uncorrelated, Masking::HeightCorrelated].map(name));
    for table in tables {
        assert!(table.certificate.worst() <= 3e-3, "{:?}", table.certificate);
        assert!(table.certificate.quadrature.unwrap() <= 1e-4);
        // For single materials the isotropic stand-in is off by this much.
        let stand_in = table.certificate.stand_in.unwrap();
        assert!((0.05..0.3).contains(&stand_in), "{stand_in}");
    }
}

#[test]
fn opposite_and_mirrored_views_are_the_same_and_no_view_gains() {
    for name in ["brushed", "other form"] {
        let albedo = SET.material_albedo(name).unwrap();
        for i in 0..400 {
            let (cos, phi) = ((f64::from(i) * 0.618).fract().powi(3), 0.01 * f64::from(i));
            let v = direction(cos, phi);
            let e = albedo.albedo(v);
            assert!((0.0..=1.0).contains(&e), "{e} at {v}");
            for same in [Vec3::new(v.x, -v.y, v.z), Vec3::new(-v.x, -v.y, v.z)] {
                assert!((e - albedo.albedo(same)).abs() < 1e-6, "{e} at {v}");
            }
            let moments = albedo.moments(v);
            assert!(moments.scale >= 0.0 && moments.bias >= 0.0 && moments.total() <= 1.0 + 1e-6);
        }
        // The normal has one albedo for every azimuth; views below the horizon and NaN are grazing.
        let normal = albedo.albedo(Vec3::Z);
        assert!((albedo.albedo(Vec3::new(1e-30, -1e-30, 1.0)) - normal).abs() < 1e-6);
        let grazing = albedo.albedo(Vec3::X);
        assert_eq!(albedo.albedo(Vec3::new(0.8, 0.0, -0.6)), grazing);
        assert_eq!(albedo.albedo(Vec3::new(f32::NAN, f32::NAN, f32::NAN)), grazing);
        if albedo.masking() == Masking::HeightCorrelated {
            assert!(albedo.lost(Vec3::new(1.0, 0.0, 1e-30)) < 1e-6);
        }
    }
}

/// 1/π ∫ f cos θ over the hemisphere, by the midpoint rule.
fn hemisphere(f: impl Fn(Vec3) -> f32) -> f64 {
    const N: usize = 200;
    let mut sum = 0.0;
    for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
        // Even steps of x = √cos θ place more views near grazing; 4x³ dx = 2 cos θ d(cos θ).
        let x = (i as f64 + 0.5) / N as f64;
        let cos = x * x;
        let phi = std::f64::consts::TAU * (j as f64 + 0.5) / N as f64;
        sum += 4.0 * x * x * x * f64::from(f(direction(cos, phi)));
    }
    sum / (N * N) as f64
}

#[test]
fn the_average_is_that_of_all_views_and_the_furnace_closes() {
    for name in ["brushed", "other form"] {
        let albedo = SET.material_albedo(name).unwrap();
        let average = hemisphere(|v| albedo.albedo(v));
        assert!((average - f64::from(albedo.albedo_average())).abs() < 2e-5, "{average}");
        let bias = hemisphere(|v| albedo.moments(v).bias);
        assert!((bias - f64::from(albedo.average_moments().bias)).abs() < 2e-5, "{bias}");
        let v = direction(0.3, 0.7);
        let back = std::f64::consts::PI * hemisphere(|l| albedo.compensation(v, l));
        assert!((back - f64::from(albedo.lost(v))).abs() < 1e-4, "{back}");
        let l = direction(0.8, 2.0);
        assert_eq!(albedo.compensation(v, l), albedo.compensation(l, v));
        assert!((albedo.turquin(v, 1.0) * albedo.albedo(v) - 1.0).abs() < 1e-5);
        assert_eq!(albedo.multiple_bounces(1.0), 1.0);
    }
}

#[test]
fn the_round_stand_in_is_off_by_what_the_certificate_says() {
    let own = SET.material_albedo("brushed").unwrap();
    let stand_in = Tables::embedded().albedo(0.3, 2.7, own.masking()).unwrap();
    let said = views(&SET)[1].certificate.stand_in.unwrap();
    let views =
        (0..4000).map(|i| direction(0.02 + 0.98 * f64::from(i % 40) / 39.0, 0.01 * f64::from(i)));
    let seen = views.map(|v| (own.albedo(v) - stand_in.albedo(v)).abs()).fold(0.0, f32::max);
    assert!((f64::from(seen) - said).abs() < 0.1 * said + 3e-3, "{seen}, certified {said}");
}

#[test]
fn a_wrong_table_is_noticed() {
    let right = spec([0.6, 0.15], 2.7, Quality::Draft);
    let references = interior_references(&right, &Stage::unwatched()).unwrap();
    let table = bake(&right).unwrap().remove(0);
    let error = |table: Table| {
        let tables = certified(&right, vec![table], &references, &Stage::unwatched()).unwrap();
        tables[0].certificate.worst()
    };
    // A table with its axes exchanged.
    let swapped = spec([0.15, 0.6], 2.7, Quality::Draft);
    assert!(error(bake(&swapped).unwrap().remove(0)) > 0.1);
    // A table with one wrong node.
    let mut wrong = table.clone();
    let middle = wrong.values.len() / 6 * 3;
    wrong.values[middle] = (wrong.values[middle] - 0.1).max(-1.0);
    assert!(error(wrong) > 10.0 * error(table).max(3e-3));
    // `missed_by_half` is larger for the coarser axis than for the one with four times the nodes.
    for axis in [0, 1] {
        let dense = right.refined(axis).refined(axis);
        let table = bake(&dense).unwrap().remove(0);
        let [missed, other] = [axis, 1 - axis].map(|i| missed_by_half(&dense, &table, i).unwrap());
        assert!(other > 10.0 * missed, "{axis}: {other} {missed}");
    }
}

#[test]
fn materials_without_such_a_table_are_named() {
    for (name, word) in [("silent", "no such albedo"), ("gold", "which holds")] {
        let why = SET.material_albedo(name).unwrap_err();
        assert!(why.to_string().contains(name) && why.to_string().contains(word), "{why}");
    }
    assert!(matches!(SET.material_albedo("silent"), Err(BindError::NoAlbedoOf(_))));
    // For a range, the middle of the isotropic stand-in.
    let worn = SET.material_albedo("worn").unwrap();
    let round = SET.albedo((0.25_f64 * 0.1).sqrt(), 2.7, Masking::Uncorrelated).unwrap();
    assert_eq!(worn.albedo(direction(0.3, 1.0)), round.albedo(direction(0.3, 2.0)));
    // A table of moments is not taken for one of shares, nor the other way round.
    assert!(ViewCurve::<3>::from_table(views(&SET)[0], 0.3, 2.7, 1.0).is_err());
}

#[test]
fn damaged_tables_are_refused() {
    let table = views(&SET)[0].clone();
    let refused = |change: fn(&mut Table)| {
        let mut table = table.clone();
        change(&mut table);
        table.validate().unwrap_err().to_string()
    };
    assert!(refused(|t| t.axes.swap(0, 1)).contains("axes"));
    assert!(refused(|t| t.subject.masking = None).contains("masking"));
    assert!(refused(|t| t.subject.reflectance = None).contains("reflectance"));
    assert!(refused(|t| t.subject.lobe = LobeSpec::GENERAL).contains("axes"));
    assert!(refused(|t| t.values[0] = 1.5).contains("out of range"));
    assert!(refused(|t| t.axes[0].nodes[1] *= 1.01).contains("azimuth"));
    assert!(refused(|t| t.channels[0] = "value".into()).contains("channels"));
    let sigma = |t: &mut Table| {
        let microfacet_tables::Mapping::Azimuth(azimuth) = &mut t.axes[0].mapping else { panic!() };
        azimuth.sigma[1] = 0.0;
    };
    assert!(refused(sigma).contains("sigma"));
}

#[test]
fn the_commands_list_bake_keep_and_show_them() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("r.toml"), recipe(&MATERIALS[..1])).unwrap();
    let shown = json(at, &["plan", "r.toml"]);
    let listed = &shown["albedo"][0];
    assert_eq!(listed["materials"], json!(["brushed"]));
    assert!(listed["cost"]["seconds"].as_f64().unwrap() > 0.0);
    let text = ok(at, &["plan", "r.toml"]);
    // The size depends on how often the table is refined.
    for part in ["albedo              gamma 2.7, sigma 0.6 and 0.15, ", "1 table, about "] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(json(at, &["plan", "r.toml", "--no-albedo"])["albedo"], json!([]));

    let bake = ["bake", "r.toml", "--quality", "draft", "--out", "out"];
    let baked = json(at, &bake);
    assert!(baked["baked"].as_u64().unwrap() > 0);
    assert_eq!(json(at, &bake)["baked"], 0);
    let text = ok(at, &["inspect", "out", "--details"]);
    for part in [
        "albedo_height-correlated_gamma_2.7_sigma_0.6_0.15",
        "an isotropic table at sqrt(sigma_x sigma_y) in its place would be off by up to",
    ] {
        assert!(text.contains(part), "{text}");
    }
    let set = store::read(&at.join("out")).unwrap();
    assert!(set.material_albedo("brushed").is_ok());
    assert!(set.provenance().conventions.contains_key("albedo_azimuth"));
    let table = views(&set)[0];
    ok(at, &[&bake[..4], &["--out", "image", "--format", "exr"]].concat());
    assert_eq!(store::read(&at.join("image")).unwrap(), set);
    // The estimate holds the expected doublings, of which this lobe may need one more or less.
    let one = encode(&Default::default(), std::slice::from_ref(table)).unwrap().len();
    let none = encode(&Default::default(), &[]).unwrap().len();
    // A set's formulas are counted once.
    let formulas: usize = table.axes.iter().map(|axis| axis.mapping.formula().len()).sum();
    let real = one - none - formulas;
    let draft = json(at, &["plan", "r.toml", "--quality", "draft"]);
    let estimate = draft["albedo"][0]["cost"]["bytes"].as_f64().unwrap();
    assert!((0.6..1.6).contains(&(estimate / real as f64)), "{estimate} for {real}");

    let less = ["bake", "r.toml", "--quality", "draft", "--out", "less", "--no-albedo"];
    assert!(json(at, &less)["tables"].as_array().unwrap().iter().all(|t| t["kind"] != "albedo"));
    let few = json(at, &["bake", "r.toml", "--max-bytes", "14000", "--out", "few"]);
    assert!(few["tables"].as_array().unwrap().iter().any(|t| t["kind"] == "albedo"));
    assert!(std::fs::metadata(at.join("few/tables.safetensors")).unwrap().len() <= 14000);

    let scene = "MakeNamedMaterial \"steel\" \"string type\" \"conductor\" \"float uroughness\" 0.04 \
                 \"float vroughness\" 0.25 \"spectrum eta\" [ 400 2 700 3 ]\nWorldBegin\n";
    std::fs::write(at.join("s.pbrt"), scene).unwrap();
    // The albedo takes less than two seconds, and is baked without `--albedo`.
    for asked in [&["plan", "s.pbrt"][..], &["plan", "s.pbrt", "--albedo"]] {
        let albedo = &json(at, asked)["albedo"][0];
        assert_eq!(albedo["materials"], json!(["steel"]));
        assert_eq!(albedo["masking"], json!(["height-correlated"]));
    }
    assert_eq!(json(at, &["plan", "s.pbrt", "--no-albedo"])["albedo"], json!([]));
}

const GTR: &str = "[[material]]\nname = \"paint\"\ndistribution = \"gtr\"\nc = 0.2\ngamma = 1.5\n\
                   fresnel = \"mirror\"\nmasking = \"height-correlated\"\n";

#[test]
fn other_distributions_have_an_albedo_over_the_cosine() {
    let set = draft(GTR);
    let table = views(&set)[0];
    let known = (table.name.as_str(), table.shape()[0]);
    assert_eq!(known, ("albedo_height-correlated_gtr_0.2_1.5", 1));
    assert!(table.certificate.worst() <= 3e-3, "{:?}", table.certificate);
    assert!(table.certificate.stand_in.is_none());
    let (paint, albedo) = (set.material("paint").unwrap(), set.material_albedo("paint").unwrap());
    for cos in [0.1, 0.4, 0.9] {
        let v = direction(cos, 0.0);
        assert_eq!(albedo.albedo(v), albedo.albedo(Vec3::new(0.0, v.x, v.z)));
        let want = mean_reflected(&paint, v, 300, |_, l| {
            f64::from(paint.g2(v, l, Masking::HeightCorrelated) / paint.g1(v))
        });
        assert!((f64::from(albedo.albedo(v)) - want).abs() < 3e-3, "{cos}: {want}");
    }
    let why = set.material_dielectric_albedo("paint", 1.5).unwrap_err().to_string();
    assert!(why.contains("only upright Student-t lobes refract"), "{why}");
}

#[test]
fn ellipsoids_are_bound_by_name_with_their_albedo() {
    let theta = "theta = [0.05, -0.1, 0.5]\nfresnel = \"mirror\"\nmasking = \"height-correlated\"";
    let text = recipe(&[["tilted", "[0.4, 0.2]", "2.0", theta]]);
    let plan = plan(&text, Options::default());
    // The plan has the visible normals of its γ, even for GGX, and no albedo of an isotropic lobe.
    assert_eq!((plan.shapes.len(), plan.albedos.len()), (1, 1));
    let set = draft(&text);
    let table = views(&set)[0];
    assert!(table.name.ends_with("gamma_2_sigma_0.4_0.2_theta_0.05_-0.1_0.5"), "{}", table.name);
    assert!(table.certificate.error(Quantity::E).unwrap() <= 3e-3, "{:?}", table.certificate);
    let (tilted, albedo) =
        (set.material("tilted").unwrap(), set.material_albedo("tilted").unwrap());
    for i in 0..8 {
        let v = direction(0.3 + 0.08 * f64::from(i), 0.8 * f64::from(i));
        // Normals are drawn with density (v·m)⁺ D/(projected area); G1 is v·n over it, clamped.
        let want = mean_reflected(&tilted, v, 200, |_, l| {
            tilted.reflection_weight(v, l, Masking::HeightCorrelated).into()
        });
        let got = f64::from(albedo.albedo(v));
        assert!((got - want).abs() < 4e-3, "{v}: {got} {want}");
    }
    // The lobe is tilted, so that the opposite view sees another albedo.
    let [a, b] =
        [direction(0.4, 1.0), direction(0.4, 1.0 + std::f64::consts::PI)].map(|v| albedo.albedo(v));
    assert!((a - b).abs() > 0.01, "{a} {b}");
    let average = hemisphere(|v| albedo.albedo(v));
    assert!((average - f64::from(albedo.albedo_average())).abs() < 1e-4, "{average}");
    assert!(matches!(tilted, Lobe::Ellipsoid(_)));
    assert!(matches!(SET.material("brushed"), Ok(Lobe::StudentT(_))));
}

#[test]
fn an_anisotropic_conductor_has_the_albedo_of_its_own_lobe() {
    const GOLD: &str =
        "fresnel = { conductor = { eta = [0.143, 0.375, 1.442], k = [3.983, 2.386, 1.603] } }";
    let set = draft(&recipe(&[["gold", "[0.5, 0.1]", "2.2", GOLD]]));
    let exact =
        |table: &&&Table| matches!(table.subject.reflectance, Some(Reflectance::Conductor { .. }));
    let tables = views(&set);
    let table = tables.iter().find(exact).unwrap();
    assert_eq!((tables.len(), table.channels.join(" ").as_str()), (2, "red green blue"));
    assert!(table.certificate.worst() <= 3e-3, "{:?}", table.certificate);
    let FresnelAlbedo::Conductor(gold) = set.material_fresnel_albedo("gold").unwrap() else {
        panic!()
    };
    let (material, all) = (set.material("gold").unwrap(), set.material_albedo("gold").unwrap());
    let red = microfacet_model::fresnel::Conductor::new(0.143, 3.983).unwrap();
    for i in 0..6 {
        let v = direction(0.2 + 0.15 * f64::from(i), 0.9 * f64::from(i));
        // G2/G1(v) F; masking that the recipe leaves out is height-correlated.
        let want = mean_reflected(&material, v, 200, |m, l| {
            let g = material.g2(v, l, Masking::HeightCorrelated) / material.g1(v);
            f64::from(g) * red.reflectance(f64::from(v.dot(m)))
        });
        let (got, most) = (gold.eval(v), all.albedo(v) + 1e-3);
        assert!((f64::from(got[0]) - want).abs() < 4e-3, "{v}: {got:?} {want}");
        assert!(got.iter().all(|&x| x <= most), "{v}: {got:?} above {most}");
    }
    // The average is right for each channel and over all azimuths.
    let average = hemisphere(|v| gold.eval(v)[2]);
    assert!((average - f64::from(gold.average()[2])).abs() < 5e-5, "{average}");
}
