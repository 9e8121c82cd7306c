//! Planning: only what a scene needs is baked.

use glam::Vec3;
use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Cost, Options, Plan, Verdict};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{BakeError, Baked, Settings, Target, bake_with, costs};
use microfacet_baker::table_spec::{Quality, general_set};
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{DEFAULT_SET as GENERAL, Lobe, MicrofacetDistribution, Tables};
use microfacet_tables::{Interval, Precision, encode};

use crate::common::{json, ok, refused, run};

pub(crate) const DRAFT: Target = Target::Quality(Quality::Draft, Precision::F32);

/// A recipe of materials: name, σ and γ as TOML.
pub(crate) fn recipe(materials: &[[&str; 3]]) -> String {
    let entry = |[name, sigma, gamma]: &[&str; 3]| {
        format!("[[material]]\nname = \"{name}\"\nsigma = {sigma}\ngamma = {gamma}\n")
    };
    materials.iter().map(entry).collect()
}

pub(crate) fn scene(materials: &[[&str; 3]]) -> Scene {
    Scene::from_recipe_str(&recipe(materials)).unwrap()
}

pub(crate) fn plan(scene: &Scene) -> Plan {
    Plan::new(scene, Options::default()).unwrap()
}

pub(crate) fn bake(plan: &Plan, target: Target, cache: &Cache) -> Result<Baked, BakeError> {
    bake_with(&normals_of(plan), target, Settings { cache: cache.clone(), ..Settings::default() })
}

/// The plan without its albedos, which take long.
pub(crate) fn normals_of(plan: &Plan) -> Plan {
    let mut plan = plan.clone();
    plan.albedos.clear();
    plan
}

pub(crate) fn bytes(set: &Tables) -> Vec<u8> {
    encode(set.provenance(), set.tables()).unwrap()
}

/// The largest error of any table.
pub(crate) fn worst(set: &Tables) -> f64 {
    set.tables().iter().map(|table| table.certificate.worst()).fold(0.0, f64::max)
}

const MIXED: [[&str; 3]; 9] = [
    ["a", "0.3", "3.0"],
    ["b", "0.7", "3.0"],
    ["gold", "0.2", "2.0"],
    ["mirror", "0.0", "5.0"],
    ["series", "0.4", "{ min = 5.0, max = 20.0 }"],
    ["inside", "0.1", "8.0"],
    ["more", "0.1", "{ min = 15.0, max = \"inf\" }"],
    ["heavy", "0.1", "1.6"],
    ["beckmann", "[0.1, 0.4]", "\"inf\""],
];

#[test]
fn every_material_gets_its_verdict() {
    let mut scene = scene(&MIXED);
    scene.materials[7].used = false;
    let plan = plan(&scene);
    let gammas: Vec<Interval> = plan.shapes.iter().map(|need| need.gamma()).collect();
    // Overlapping ranges become one, which here includes Beckmann; equal shapes become one,
    // whatever their roughness.
    assert_eq!(gammas, [Interval { min: 5.0, max: f64::INFINITY }, Interval::point(3.0)]);
    let expected = [
        Verdict::Bake(1),
        Verdict::Same { need: 1, as_material: 0 },
        Verdict::ClosedForm,
        Verdict::NotRough,
        Verdict::Bake(0),
        Verdict::Within { need: 0, of_material: 4 },
        Verdict::Within { need: 0, of_material: 4 },
        Verdict::NotUsed,
        Verdict::Within { need: 0, of_material: 4 },
    ];
    assert_eq!(plan.verdicts, expected);

    let options = Options { tabulate_ggx: true, ..Options::default() };
    let all = Plan::new(&scene, options).unwrap();
    assert!(all.shapes.iter().any(|need| need.gamma() == Interval::point(2.0)));
    let none = Plan::new(&scene, Options { embedded: true, ..Options::default() }).unwrap();
    assert!(none.shapes.is_empty() && none.verdicts[0] == Verdict::Embedded && none.is_empty());
}

#[test]
fn a_range_over_ggx_serves_ggx() {
    let plan = plan(&scene(&[["gold", "0.3", "2.0"], ["worn", "0.3", "{ min = 1.9, max = 2.5 }"]]));
    assert_eq!(plan.verdicts, [Verdict::Within { need: 0, of_material: 1 }, Verdict::Bake(0)]);
}

#[test]
fn a_slice_has_no_axis_of_shapes_and_a_smooth_scene_nothing() {
    let general = general_set(Quality::Default, Precision::F32);
    let specs = plan(&scene(&[["glass", "0.454", "3.0"]])).shapes[0].specs(&general);
    let shapes: Vec<usize> = specs.iter().map(|spec| spec.shapes.nodes.len()).collect();
    assert_eq!(shapes, [1, 1, 1]);
    // γ = 1.8 itself belongs to the whole distribution's tables, not to the peeled ones.
    let seam = plan(&scene(&[["seam", "0.3", "1.8"]])).shapes[0].specs(&general);
    assert!(seam.iter().all(|spec| !spec.name.contains("peeled")));
    assert!(plan(&scene(&[["mirror", "0.0", "3.0"]])).is_empty());
}

/// What the sampler refuses as a lobe is smooth or refused when it is planned, not at run time.
#[test]
fn roughnesses_that_no_lobe_can_have_are_not_baked() {
    assert!(plan(&scene(&[["mirror", "9e-9", "3.0"]])).is_empty());
    assert!(plan(&scene(&[["mirror", "[1e-9, 5e-9]", "3.0"]])).is_empty());
    for sigma in ["[0.3, 1e-9]", "1.1e6", "{ min = 0.1, max = 2e6 }"] {
        let error = Plan::new(&scene(&[["m", sigma, "3.0"]]), Options::default()).unwrap_err();
        assert!(error.to_string().contains("[1e-8, 1e6]"), "{error}");
    }
    for sigma in ["1e-8", "1e6", "{ min = 0.0, max = 0.3 }", "{ min = 1e-9, max = 0.3 }"] {
        assert!(!plan(&scene(&[["m", sigma, "3.0"]])).is_empty(), "{sigma}");
    }
}

#[test]
fn sub_ranges_draw_the_very_normals_of_the_general_set() {
    let general = bake(&Plan::general(), DRAFT, &Cache::none()).unwrap().set;
    let size =
        general_set(Quality::Draft, Precision::F32).iter().map(|spec| spec.bytes()).sum::<usize>();
    for (range, gammas) in [
        ("{ min = 1.51, max = 2.2 }", [1.51, 1.5432, 1.7999, 1.8, 2.2]),
        ("{ min = 2.9, max = 3.2 }", [2.9, 2.95, 3.0, 3.1, 3.2]),
        ("{ min = 40.0, max = \"inf\" }", [40.0, 41.0, 1e3, 1e9, f64::INFINITY]),
    ] {
        let part = bake(&plan(&scene(&[["m", "0.3", range]])), DRAFT, &Cache::none()).unwrap().set;
        assert!(part.tables().iter().map(|table| 4 * table.values.len()).sum::<usize>() < size);
        for gamma in gammas {
            let [a, b] = [&general, &part].map(|set| set.student_t([0.3, 0.5], gamma).unwrap());
            for u in [[0.01, 0.9], [0.4, 0.2], [0.77, 0.5], [0.999, 0.03]] {
                let v = Vec3::new(0.48, 0.6, 0.64);
                assert_eq!(a.sample_visible_normal(v, u), b.sample_visible_normal(v, u), "{gamma}");
                assert_eq!(a.g1(v), b.g1(v));
            }
        }
        // And it is no less accurate: its certificate is about the range asked for, without the
        // margins.
        assert!(
            worst(&part) <= worst(&general) * 1.01,
            "{range}: {} {}",
            worst(&part),
            worst(&general)
        );
    }
}

#[test]
fn a_thousand_materials_come_down_to_their_distinct_shapes() {
    let names: Vec<String> = (0..1000).map(|i| format!("material {i}")).collect();
    let sigmas: Vec<String> = (0..1000).map(|i| format!("{}", 0.001 * f64::from(i + 1))).collect();
    let gammas: Vec<String> =
        (0..1000).map(|i| format!("{}", 1.6 + 0.1 * f64::from(i % 23))).collect();
    let materials: Vec<[&str; 3]> =
        (0..1000).map(|i| [names[i].as_str(), sigmas[i].as_str(), gammas[i].as_str()]).collect();
    let plan = plan(&scene(&materials));
    // One of the 23 is GGX.
    assert_eq!(plan.shapes.len(), 22);
    let baked = plan.verdicts.iter().filter(|verdict| matches!(verdict, Verdict::Bake(_))).count();
    let shared =
        plan.verdicts.iter().filter(|verdict| matches!(verdict, Verdict::Same { .. })).count();
    let closed = plan.verdicts.iter().filter(|verdict| **verdict == Verdict::ClosedForm).count();
    assert_eq!((baked, closed, baked + shared + closed), (22, 44, 1000));
}

#[test]
fn more_shapes_than_a_range_has_nodes_are_a_range() {
    let gammas: Vec<String> = (0..200).map(|i| format!("{}", 2.5 + 0.01 * f64::from(i))).collect();
    let names: Vec<String> = (0..200).map(|i| format!("m{i}")).collect();
    let materials: Vec<[&str; 3]> =
        (0..200).map(|i| [names[i].as_str(), "0.3", gammas[i].as_str()]).collect();
    let plan = plan(&scene(&materials));
    assert_eq!(plan.shapes.len(), 1);
    assert_eq!(plan.shapes[0].gamma(), Interval { min: 2.5, max: 4.49 });
    assert_eq!(plan.verdicts[0], Verdict::Bake(0));
    assert_eq!(plan.verdicts[7], Verdict::Within { need: 0, of_material: 0 });
}

#[test]
fn estimated_bytes_are_those_of_the_file() {
    for materials in [&MIXED[..2], &MIXED[..]] {
        let plan = normals_of(&plan(&scene(materials)));
        for precision in [Precision::F32, Precision::U16] {
            let target = Target::Quality(Quality::Draft, precision);
            let set = bake(&plan, target, &Cache::none()).unwrap().set;
            let all = costs(&plan, Quality::Draft, precision).unwrap();
            let estimate = all.into_iter().sum::<Cost>().bytes as f64;
            let real = bytes(&set).len() as f64;
            assert!((estimate / real - 1.0).abs() < 0.04, "{estimate} for {real}");
        }
    }
}

/// An entry that has its key right is compared with what was asked for: all but the numbers.
/// Coated and metallic GGX at five roughnesses, as an architectural scene has them, and materials
/// that need no table.
const PAVILION: &str = r#"
MakeNamedMaterial "polished" "string type" "coateddiffuse" "float roughness" 0.0104
MakeNamedMaterial "plaster" "string type" "coateddiffuse" "float roughness" 0.0104 "rgb reflectance" [ 0.6 0.6 0.6 ]
MakeNamedMaterial "lawn" "string type" "coateddiffuse" "float roughness" 0.1
MakeNamedMaterial "marble" "string type" "coateddiffuse" "float uroughness" 0.001 "float vroughness" 0.001
MakeNamedMaterial "steel" "string type" "conductor" "float roughness" 0.04
    "spectrum eta" [ 400 2 700 3 ]
MakeNamedMaterial "travertine" "string type" "coateddiffuse" "float roughness" 0.25
MakeNamedMaterial "pool" "string type" "dielectric"
MakeNamedMaterial "wall" "string type" "diffuse"
"#;

#[test]
fn a_pavilion_needs_names_and_no_tables() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("pavilion.pbrt"), PAVILION).unwrap();
    let shown = json(at, &["plan", "pavilion.pbrt"]);
    assert_eq!(shown["shapes"].as_array().unwrap().len(), 0);
    let verdicts: Vec<&str> = shown["materials"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| m["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts.iter().filter(|verdict| **verdict == "closed form").count(), 6);
    assert_eq!(verdicts.iter().filter(|verdict| **verdict == "not rough").count(), 1);
    assert_eq!(shown["ignored"].as_array().unwrap().len(), 1);

    json(at, &["bake", "pavilion.pbrt", "--out", "out"]);
    let file = std::fs::read(at.join("out/tables.safetensors")).unwrap();
    assert!(50 * file.len() < GENERAL.len(), "{} bytes", file.len());
    let steel = Tables::from_bytes(&file).unwrap().material("steel").unwrap();
    assert!(matches!(steel, Lobe::Ggx(ggx) if ggx.alpha() == [0.2, 0.2]));
    let verdict = run(at, &["validate", "out", "--configurations", "4", "--samples", "20000"]);
    assert!(String::from_utf8_lossy(&verdict.stdout).ends_with("PASSED\n"), "{verdict:?}");

    // For a run time that wants tables: with no larger an error than the general set's.
    let general = Tables::from_bytes(GENERAL).unwrap();
    let normals = general.tables().iter().filter(|table| !table.kind.is_albedo());
    let worst = normals.map(|table| table.certificate.worst()).fold(0.0, f64::max);
    let budget = format!("{worst:e}");
    let tabulated =
        ["bake", "pavilion.pbrt", "--tabulate-ggx", "--max-error", &budget, "--out", "tables"];
    assert_eq!(json(at, &tabulated)["tables"].as_array().unwrap().len(), 3);
    let file = std::fs::read(at.join("tables/tables.safetensors")).unwrap();
    assert!(50 * file.len() < GENERAL.len(), "{} bytes", file.len());
    assert!(Tables::from_bytes(&file).unwrap().material("steel").unwrap().bytes() > 0);
}

#[test]
fn distributions_have_their_part_in_the_totals() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let paint = "[[material]]\nname = \"paint\"\ndistribution = \"gtr\"\nc = 0.2\ngamma = 1.3\n";
    std::fs::write(at.join("r.toml"), recipe(&MIXED[..1]) + paint).unwrap();
    let shown = json(at, &["plan", "r.toml", "--quality", "high", "--precision", "u16"]);
    let own = &shown["distributions"][0];
    assert_eq!(own["distribution"], "gtr:0.2,1.3");
    assert_eq!(own["materials"], serde_json::json!(["paint"]));
    let figure = |of: &serde_json::Value, name: &str| of["cost"][name].as_f64().unwrap();
    for name in ["bytes", "seconds"] {
        let tables = figure(own, name) + figure(&shown["shapes"][0], name);
        let total = shown["total"][name].as_f64().unwrap();
        // The rest is the file's own description.
        let rest = if name == "bytes" { 3000.0 } else { 1e-9 };
        assert!(
            figure(own, name) > 0.0 && (0.0..rest).contains(&(total - tables)),
            "{name}: {shown}"
        );
    }
    assert!(ok(at, &["plan", "r.toml"]).contains("gtr:0.2,1.3         4 tables, "));
}

#[test]
fn the_command_says_what_it_did_not_do() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let write =
        |materials: &[[&str; 3]]| std::fs::write(at.join("r.toml"), recipe(materials)).unwrap();
    let draft = ["bake", "r.toml", "--out", "out", "--quality", "draft"];
    write(&MIXED[..2]);
    assert_eq!(json(at, &draft)["baked"], 3);
    let second = run(at, &draft);
    assert!(
        String::from_utf8_lossy(&second.stdout).contains("all 3 tables came from the cache"),
        "{second:?}"
    );
    write(&[MIXED[0], MIXED[7]]);
    assert_eq!(json(at, &draft)["baked"], 3);
    assert_eq!(json(at, &[&draft[..], &["--no-cache"]].concat())["baked"], 6);
    assert_eq!(json(at, &[&draft[..], &["--cache", "elsewhere"]].concat())["baked"], 6);
    assert_eq!(json(at, &[&draft[..], &["--cache", "elsewhere"]].concat())["baked"], 0);

    // A cache that cannot be written is a warning.
    std::fs::write(at.join("file"), "").unwrap();
    let output = run(at, &[&draft[..], &["--cache", "file"]].concat());
    assert!(
        output.status.success() && String::from_utf8_lossy(&output.stderr).contains("not kept"),
        "{output:?}"
    );

    // A scene without a rough material has a set without tables.
    write(&[["mirror", "0.0", "3.0"]]);
    for (command, what) in [
        (&["plan", "r.toml"][..], "no tables to bake"),
        (&["bake", "r.toml", "--out", "empty"], "no tables"),
    ] {
        assert!(ok(at, command).contains(what));
    }
    assert!(at.join("empty/tables.safetensors").exists());
}

#[test]
fn a_refused_bake_leaves_no_folder_behind() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("bad.toml"), "[[material]]\n").unwrap();
    std::fs::write(at.join("heavy.toml"), recipe(&[["heavy", "0.3", "1.5005"]])).unwrap();
    std::fs::write(at.join("good.toml"), recipe(&MIXED[..1])).unwrap();
    let refusals: [&[&str]; 4] = [
        &["bad.toml"],
        &["heavy.toml"],
        &["good.toml", "--max-bytes", "100"],
        &["good.toml", "--quality", "draft", "--max-memory", "1K"],
    ];
    std::fs::create_dir(at.join("mine")).unwrap();
    for refusal in refusals {
        let to = |out| refused(at, &[&["bake"], refusal, &["--out", out]].concat());
        for out in ["new", "new/and/deep", "mine/new"] {
            to(out);
            assert!(!at.join("new").exists() && !at.join("mine/new").exists(), "{refusal:?} {out}");
        }
        // The folder that was there before stays.
        to("mine");
        assert!(at.join("mine").is_dir(), "{refusal:?}");
    }
    json(at, &["bake", "good.toml", "--out", "new/and/deep", "--quality", "draft"]);
    assert!(at.join("new/and/deep/tables.safetensors").exists());
}

#[test]
fn albedos_of_very_many_lobes_are_refused_in_one_plan() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |entry: fn(usize) -> String| {
        let recipe: String =
            (0..100_001).map(|i| format!("[[material]]\nname = \"{i}\"\n{}\n", entry(i))).collect();
        let why = Plan::new(&Scene::from_recipe_str(&recipe).unwrap(), Options::default());
        let message = why.unwrap_err().to_string();
        assert!(
            message.contains("more than 100000 ") && message.contains("--no-albedo"),
            "{message}"
        );
        recipe
    };
    refuse(|i| format!("sigma = 0.5\ngamma = 3\nfresnel = {{ dielectric = 1.1{i:06} }}"));
    let recipe = refuse(|i| format!("sigma = [0.5, 0.1{i:06}]\ngamma = 3\nfresnel = \"mirror\""));
    // The command divides them into sets, each with a plan of its own.
    std::fs::write(folder.path().join("a.toml"), recipe).unwrap();
    let text = ok(folder.path(), &["plan", "a.toml"]);
    assert!(text.contains("100001 materials in 11 numbered sets"), "{text}");
}
