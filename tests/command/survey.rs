//! Scenes as they are: what each material is, what was not understood, and a folder of scenes.

use serde_json::{Value, json};

use crate::common::{Desk, has, material, ok};

use microfacet_baker::scene::{Scene, recipe_of};
use microfacet_baker::store;

/// A rough metal without a Fresnel term, a diffuse material, a smooth one, and some of pbrt-v3.
const PBRT: &str = r#"WorldBegin
MakeNamedMaterial "steel" "string type" "conductor" "float uroughness" 0.04 "float vroughness" 0.09
    "spectrum eta" [ 400 2 700 3 ]
MakeNamedMaterial "wall" "string type" "diffuse"
MakeNamedMaterial "pane" "string type" "dielectric"
MakeNamedMaterial "old" "string type" "matte"
MakeNamedMaterial "older" "string type" "uber"
"#;

/// One lobe that no table covers, and one in closed form.
const BEYOND: &str = r#"WorldBegin
MakeNamedMaterial "far" "string type" "conductor" "float roughness" 1e34
    "spectrum eta" [ 400 2 700 3 ]
MakeNamedMaterial "near" "string type" "conductor" "float roughness" 0.04
    "spectrum eta" [ 400 2 700 3 ]
"#;

/// Brushed metals, of which eight are too many for two seconds: each has a table over the azimuth.
fn brushed(count: usize) -> String {
    let one = |i: usize| {
        format!(
            "MakeNamedMaterial \"{i}\" \"string type\" \"conductor\" \"float uroughness\" 0.0{i} \"float vroughness\" 0.3 \"spectrum eta\" [ 400 2 700 3 ]\n"
        )
    };
    (1..=count).map(one).collect()
}

#[test]
fn every_material_is_described() {
    let film = material("film", "distribution = \"gtr\"\nc = 0.2\ngamma = 1.3");
    let desk = Desk::new(&[("s.pbrt", PBRT), ("r.toml", &film)]);
    let plan = desk.json("plan s.pbrt");
    let [steel, pane] = [0, 1].map(|i| &plan["materials"][i]);
    for (of, key, value) in [
        (steel, "name", json!("steel")),
        (steel, "sigma", json!([[0.2, 0.2], [0.3, 0.3]])),
        (steel, "gamma", json!(["2", "2"])),
        (steel, "masking", json!("height-correlated")),
        (steel, "fresnel", Value::Null),
        (steel, "verdict", json!("closed form")),
        (pane, "fresnel", json!({ "dielectric": 1.5 })),
    ] {
        assert_eq!(of[key], value, "{key}");
    }
    assert_eq!(pane["sigma"][0], json!([0.0, 0.0]));
    let baked = desk.json("bake s.pbrt --quality draft --out out");
    assert_eq!(baked["materials"], plan["materials"]);
    assert_eq!(baked["ignored"], plan["ignored"]);
    let film = &desk.json("plan r.toml")["materials"][0];
    assert_eq!((&film["distribution"], &film["gamma"]), (&json!("gtr:0.2,1.3"), &Value::Null));
}

#[test]
fn what_was_not_understood_and_what_is_missing_are_in_the_json() {
    let desk = Desk::new(&[
        ("s.pbrt", PBRT),
        ("part.pbrt", "Include \"geometry.pbrt\"\nMaterial \"diffuse\"\n"),
    ]);
    let plan = desk.json("plan s.pbrt");
    let ignored = plan["ignored"].as_array().unwrap().iter();
    let understood: Value = ignored.map(|it| json!([it["name"], it["understood"]])).collect();
    assert_eq!(understood, json!([["wall", true], ["old", false], ["older", false]]));
    let plan = desk.json("plan part.pbrt");
    has(plan["warnings"][0].as_str().unwrap(), &["geometry.pbrt is missing"]);
}

#[test]
fn one_lobe_does_not_refuse_a_scene() {
    let desk = Desk::new(&[("s.pbrt", BEYOND)]);
    desk.ok("bake s.pbrt --quality draft --out out");
    // The set has the others, and its recipe can be baked.
    let set = store::read(&desk.join("out")).unwrap();
    let names: Vec<_> = set.provenance().materials.iter().map(|it| &it.name[..]).collect();
    assert_eq!(names, ["near"]);
    Scene::from_recipe_str(&recipe_of(&set.provenance().materials)).unwrap();
    assert_eq!(desk.json("plan s.pbrt")["materials"][0]["verdict"], "not covered");
}

#[test]
fn an_albedo_beyond_all_tables_is_left_out() {
    // σ = 10 has a lobe, in closed form, and no albedo.
    let bsdf = |id: &str, alpha: &str| {
        format!(
            "<bsdf type=\"roughconductor\" id=\"{id}\"><string name=\"distribution\" value=\"ggx\"/><float name=\"alpha\" value=\"{alpha}\"/></bsdf>"
        )
    };
    let scene =
        format!("<scene version=\"3.0.0\">{}{}</scene>", bsdf("wide", "10"), bsdf("near", "0.2"));
    let desk = Desk::new(&[("s.xml", &scene)]);
    desk.ok("bake s.xml --albedo --quality draft --out out");
    let planned = |line: &str| {
        let plan = desk.json(line);
        [0, 1].map(|i| plan["materials"][i]["albedo"][0].as_str().unwrap().to_owned())
    };
    assert_eq!(desk.json("plan s.xml --albedo")["materials"][0]["verdict"], "closed form");
    assert_eq!(planned("plan s.xml --albedo"), ["not covered", "baked"]);
    let why = "material \"wide\": sigma = 10 is above 3";
    desk.refuses("plan s.xml --albedo --strict", &[why]);
    // It was not asked for by name.
    desk.ok("plan s.xml --strict");
    // The default set does not have it either.
    assert_eq!(planned("plan s.xml --albedo --embedded"), ["not covered", "embedded"]);
}

#[test]
fn albedos_are_offered_to_those_that_would_get_them() {
    let round = "MakeNamedMaterial \"round\" \"string type\" \"conductor\" \"float roughness\" 0.3 \"spectrum eta\" [ 400 2 700 3 ]\n";
    let desk = Desk::new(&[("s.pbrt", &(round.to_owned() + &brushed(8)))]);
    let plan = desk.json("plan s.pbrt --embedded");
    let albedo = |i: usize| &plan["materials"][i]["albedo"][0];
    assert_eq!((albedo(0), albedo(1)), (&json!("embedded"), &json!("not asked")));
}

#[test]
fn a_folder_is_summed_up() {
    let glass = material("glass", "sigma = 0.3\ngamma = 3.0");
    let desk = Desk::new(&[
        ("a/s.pbrt", PBRT),
        ("a/same.pbrt", PBRT),
        ("a/far.pbrt", BEYOND),
        ("b/main.pbrt", "WorldBegin\nInclude \"part.pbrt\"\n"),
        ("b/part.pbrt", "NamedMaterial \"defined elsewhere\"\nShape \"sphere\"\n"),
        ("b/broken.gltf", "{"),
        ("b/feed.xml", "<rss version=\"2.0\"/>"),
        ("b/settings.toml", "[profile]\nlevel = 3\n"),
        ("b/r.toml", &glass),
        ("b/wrong.toml", &material("glass", "sigma = -1\ngamma = 3.0")),
        ("b/notes.txt", "no scene"),
        (".hidden/s.pbrt", PBRT),
    ]);
    let survey = desk.json("plan .");
    assert_eq!(survey["counts"], json!({ "planned": 5, "parts": 1, "no scenes": 2, "refused": 2 }));
    let outcome = |name: &str| {
        let files = survey["files"].as_array().unwrap();
        let is = |file: &&Value| file["path"].as_str().unwrap().ends_with(name);
        files.iter().find(is).unwrap_or_else(|| panic!("{name}"))
    };
    assert_eq!(outcome("b/part.pbrt")["outcome"], "part");
    assert_eq!(outcome("b/feed.xml")["outcome"], "no scene");
    assert_eq!(outcome("b/settings.toml")["outcome"], "no scene");
    has(outcome("b/broken.gltf")["why"].as_str().unwrap(), &["broken.gltf:1:"]);
    has(outcome("b/wrong.toml")["why"].as_str().unwrap(), &["sigma"]);
    assert_eq!(outcome("a/far.pbrt")["not_covered"][0]["name"], "far");
    assert_eq!(outcome("a/s.pbrt")["lobes"], json!({ "closed form": 1, "smooth": 1 }));
    // Equal scenes need the same; the glass has its own shape.
    assert_eq!(outcome("a/s.pbrt")["needs"], outcome("a/same.pbrt")["needs"]);
    assert_eq!(outcome("b/r.toml")["needs"].as_array().unwrap().len(), 1);
    let needs = survey["needs"].as_array().unwrap();
    let named =
        |name: &str| needs.iter().filter(|it| it["name"].as_str().unwrap().contains(name)).count();
    assert_eq!(named("gamma_3"), 1, "{needs:?}");

    let totals =
        ["without_lobe", "not_understood", "not_covered", "warnings"].map(|it| &survey[it]);
    assert_eq!(totals, [&json!(2), &json!(4), &json!(1), &json!(2)]);
    assert_eq!(outcome("a/s.pbrt")["not_understood"][0]["place"], "./a/s.pbrt:6:1");

    // Doubts refuse the scenes that have them, and so fail a build.
    let strict: Value =
        serde_json::from_str(&desk.run("plan . --strict --json").ends(1).out).unwrap();
    assert_eq!(strict["counts"], json!({ "planned": 1, "parts": 1, "no scenes": 2, "refused": 6 }));
    ok(&desk.join("b"), &["plan", "..", "--quiet"]);
    desk.write("sound/r.toml", glass);
    desk.ok("plan sound --strict");
}

#[test]
fn albedos_of_a_folder_that_were_not_asked_for_are_counted_once() {
    let many = brushed(8);
    // One alone is quick.
    let last = many.lines().last().unwrap();
    let desk = Desk::new(&[("a.pbrt", &many), ("b.pbrt", &many), ("c.pbrt", last)]);
    let survey = desk.json("plan .");
    let number = |of: &Value| of.as_array().unwrap().len();
    assert_eq!((number(&survey["needs"]), number(&survey["offered"])), (1, 7));
    assert_eq!(number(&survey["files"][0]["offered"]), 8);
    assert_eq!(number(&desk.json("plan . --albedo")["needs"]), 8);
    has(&desk.ok("plan ."), &["--albedo adds those of 2 scenes where albedos take long: 7,"]);
    has(&desk.ok("plan . --no-albedo"), &["distinct needs of all: none\n"]);
}
