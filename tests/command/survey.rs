//! Scenes as they are: what each material is, what was not understood, and a folder of scenes.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{json, ok, refused, run};

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

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// What a command that succeeds writes to standard output, and its warnings.
fn said(at: &Path, command: &[&str]) -> (String, Vec<String>) {
    let output = run(at, command);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    (out, err.lines().map(str::to_owned).collect())
}

#[test]
fn every_material_is_described() {
    let folder = folder(&[("s.pbrt", PBRT)]);
    let at = folder.path();
    let plan = json(at, &["plan", "s.pbrt"]);
    let steel = &plan["materials"][0];
    assert_eq!(steel["name"], "steel");
    assert_eq!(steel["sigma"], json!([[0.2, 0.2], [0.3, 0.3]]));
    assert_eq!(steel["gamma"], json!(["2", "2"]));
    assert_eq!((&steel["masking"], &steel["fresnel"]), (&json!("height-correlated"), &Value::Null));
    assert_eq!(steel["verdict"], "closed form");
    let pane = &plan["materials"][1];
    assert_eq!(
        (&pane["fresnel"], &pane["sigma"][0]),
        (&json!({ "dielectric": 1.5 }), &json!([0.0, 0.0]))
    );
    let baked = json(at, &["bake", "s.pbrt", "--quality", "draft", "--out", "out"]);
    assert_eq!(baked["materials"], plan["materials"]);
    for command in
        [&["plan", "s.pbrt"][..], &["bake", "s.pbrt", "--quality", "draft", "--out", "out"]]
    {
        let text = ok(at, command);
        let has =
            |line: &str| text.lines().any(|of| of.split_whitespace().eq(line.split_whitespace()));
        let steel =
            "has steel sigma 0.2 and 0.3, gamma 2, height-correlated masking, no Fresnel term";
        assert!(has(steel), "{text}");
        assert!(
            has("has pane smooth, height-correlated masking, dielectric of index 1.5"),
            "{text}"
        );
    }
    fs::write(
        at.join("r.toml"),
        "[[material]]\nname = \"film\"\ndistribution = \"gtr\"\nc = 0.2\ngamma = 1.3\n",
    )
    .unwrap();
    let text = ok(at, &["plan", "r.toml"]);
    assert!(text.contains("gtr:0.2,1.3, height-correlated masking, no Fresnel"), "{text}");
    let film = &json(at, &["plan", "r.toml"])["materials"][0];
    assert_eq!((&film["distribution"], &film["gamma"]), (&json!("gtr:0.2,1.3"), &Value::Null));
}

#[test]
fn what_was_not_understood_is_said_last() {
    let folder = folder(&[("s.pbrt", PBRT)]);
    let at = folder.path();
    for command in
        [&["plan", "s.pbrt"][..], &["bake", "s.pbrt", "--quality", "draft", "--out", "out"]]
    {
        let (text, warnings) = said(at, command);
        assert!(!text.contains("nothing to validate"), "{text}");
        let last = warnings.last().unwrap();
        assert!(
            last.contains("2 materials were not understood") && last.contains("\"old\""),
            "{last}"
        );
        assert!(last.contains("pbrt --upgrade"), "{last}");
    }
    let ignored = &json(at, &["plan", "s.pbrt"])["ignored"];
    let understood: Vec<_> =
        ignored.as_array().unwrap().iter().map(|it| (&it["name"], &it["understood"])).collect();
    assert_eq!(
        understood,
        [
            (&json!("wall"), &json!(true)),
            (&json!("old"), &json!(false)),
            (&json!("older"), &json!(false))
        ]
    );
    let message = refused(at, &["plan", "s.pbrt", "--strict"]);
    assert!(
        message.contains("not understood: \"old\" (matte)") && message.contains("--strict"),
        "{message}"
    );
    refused(at, &["bake", "s.pbrt", "--strict", "--out", "strict"]);
    assert!(!at.join("strict/tables.safetensors").exists());
}

#[test]
fn what_is_missing_is_said_where_nothing_is_baked() {
    let folder = folder(&[
        ("s.pbrt", "Include \"geometry.pbrt\"\nMaterial \"diffuse\"\n"),
        ("whole.pbrt", "Material \"diffuse\"\n"),
    ]);
    let at = folder.path();
    let cases = [
        (&["plan"][..], "no tables to bake for what was read\n", "no tables to bake\n"),
        (&["bake", "--out", "out"], "no material that was read is rough", "no material in use is"),
    ];
    for (command, in_part, in_whole) in cases {
        let (text, warnings) = said(at, &[command, &["s.pbrt"]].concat());
        assert!(
            warnings[0].contains("warning: s.pbrt:1:1: geometry.pbrt is missing"),
            "{warnings:?}"
        );
        assert!(text.contains(in_part) && !text.contains(in_whole), "{text}");
        let text = ok(at, &[command, &["whole.pbrt"]].concat());
        assert!(!text.contains(in_part) && text.contains(in_whole), "{text}");
    }
    let plan = json(at, &["plan", "s.pbrt"]);
    assert!(plan["warnings"][0].as_str().unwrap().contains("geometry.pbrt is missing"), "{plan}");
}

#[test]
fn one_lobe_does_not_refuse_a_scene() {
    let folder = folder(&[("s.pbrt", BEYOND)]);
    let at = folder.path();
    let (_, warnings) = said(at, &["bake", "s.pbrt", "--quality", "draft", "--out", "out"]);
    let last = warnings.last().unwrap();
    assert!(last.contains("1 material is not covered: \"far\" (sigma = 1e17"), "{last}");
    // The set has the others, and its recipe can be baked.
    let set = store::read(&at.join("out")).unwrap();
    let names: Vec<_> = set.provenance().materials.iter().map(|it| &it.name[..]).collect();
    assert_eq!(names, ["near"]);
    Scene::from_recipe_str(&recipe_of(&set.provenance().materials)).unwrap();
    let plan = json(at, &["plan", "s.pbrt"]);
    assert_eq!(plan["materials"][0]["verdict"], "not covered");
    // The roughness is doubtful too, which is said first.
    assert!(refused(at, &["plan", "s.pbrt", "--strict"]).contains("above the usual range"));
    // A recipe asks for it.
    let recipe = "[[material]]\nname = \"far\"\nsigma = 1e17\ngamma = 2.0\n";
    fs::write(at.join("r.toml"), recipe).unwrap();
    assert!(refused(at, &["plan", "r.toml"]).contains("material \"far\": sigma = 1e17"));
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
    let folder = folder(&[("s.xml", &scene)]);
    let at = folder.path();
    said(at, &["bake", "s.xml", "--albedo", "--quality", "draft", "--out", "out"]);
    let materials = &json(at, &["plan", "s.xml", "--albedo"])["materials"];
    assert_eq!(materials[0]["verdict"], "closed form");
    let albedos = [0, 1].map(|i| &materials[i]["albedo"][0]);
    assert_eq!(albedos, [&json!("not covered"), &json!("baked")]);
    let message = refused(at, &["plan", "s.xml", "--albedo", "--strict"]);
    assert!(message.contains("material \"wide\": sigma = 10 is above 3"), "{message}");
    // Nobody asked for it by name.
    ok(at, &["plan", "s.xml", "--strict"]);
    // The default set does not have it either.
    let materials = &json(at, &["plan", "s.xml", "--albedo", "--embedded"])["materials"];
    let albedos = [0, 1].map(|i| &materials[i]["albedo"][0]);
    assert_eq!(albedos, [&json!("not covered"), &json!("embedded")]);
}

#[test]
fn albedos_are_offered_to_those_that_would_get_them() {
    let round = "MakeNamedMaterial \"round\" \"string type\" \"conductor\" \"float roughness\" 0.3 \"spectrum eta\" [ 400 2 700 3 ]\n";
    let folder = folder(&[("s.pbrt", &(round.to_owned() + &brushed(8)))]);
    let at = folder.path();
    let plan = json(at, &["plan", "s.pbrt", "--embedded"]);
    let albedo = |i: usize| &plan["materials"][i]["albedo"][0];
    assert_eq!((albedo(0), albedo(1)), (&json!("embedded"), &json!("not asked")));
}

#[test]
fn a_folder_is_summed_up() {
    let folder = folder(&[
        ("a/s.pbrt", PBRT),
        ("a/same.pbrt", PBRT),
        ("a/far.pbrt", BEYOND),
        ("b/main.pbrt", "WorldBegin\nInclude \"part.pbrt\"\n"),
        ("b/part.pbrt", "NamedMaterial \"defined elsewhere\"\nShape \"sphere\"\n"),
        ("b/broken.gltf", "{"),
        ("b/feed.xml", "<rss version=\"2.0\"/>"),
        ("b/settings.toml", "[profile]\nlevel = 3\n"),
        ("b/r.toml", "[[material]]\nname = \"glass\"\nsigma = 0.3\ngamma = 3.0\n"),
        ("b/wrong.toml", "[[material]]\nname = \"glass\"\nsigma = -1\ngamma = 3.0\n"),
        ("b/notes.txt", "no scene"),
        (".hidden/s.pbrt", PBRT),
    ]);
    let at = folder.path();
    let survey = json(at, &["plan", "."]);
    assert_eq!(survey["counts"], json!({ "planned": 5, "parts": 1, "no scenes": 2, "refused": 2 }));
    let outcome = |name: &str| {
        let files = survey["files"].as_array().unwrap();
        let is = |file: &&Value| file["path"].as_str().unwrap().ends_with(name);
        files.iter().find(is).unwrap_or_else(|| panic!("{name}"))
    };
    assert_eq!(outcome("b/part.pbrt")["outcome"], "part");
    assert_eq!(outcome("b/feed.xml")["outcome"], "no scene");
    assert_eq!(outcome("b/settings.toml")["outcome"], "no scene");
    assert!(outcome("b/broken.gltf")["why"].as_str().unwrap().contains("broken.gltf:1:"));
    assert!(outcome("b/wrong.toml")["why"].as_str().unwrap().contains("sigma"));
    assert_eq!(outcome("a/far.pbrt")["not_covered"][0]["name"], "far");
    assert_eq!(outcome("a/s.pbrt")["lobes"], json!({ "closed form": 1, "smooth": 1 }));
    // Equal scenes need the same; the glass has its own shape.
    assert_eq!(outcome("a/s.pbrt")["needs"], outcome("a/same.pbrt")["needs"]);
    assert_eq!(outcome("b/r.toml")["needs"].as_array().unwrap().len(), 1);
    let needs = survey["needs"].as_array().unwrap();
    let named =
        |name: &str| needs.iter().filter(|it| it["name"].as_str().unwrap().contains(name)).count();
    assert_eq!(named("gamma_3"), 1, "{needs:?}");

    let (text, warnings) = said(at, &["plan", "."]);
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "10 files in .",
        "planned 5",
        "parts 1 of other scenes",
        "no scenes 2",
        "refused 2",
        "materials not understood 4",
        "4 materials (matte 2, uber 2): a material of pbrt-v3",
        "1 material (not covered): sigma = 1e17",
        "distinct needs of all:",
    ] {
        assert!(flat.contains(part), "{part}\n{text}");
    }
    assert!(
        warnings.last().unwrap().contains("4 materials were not understood, in 2 scenes"),
        "{warnings:?}"
    );
    assert!(warnings.iter().any(|it| it.contains("2 scenes were refused")), "{warnings:?}");

    let totals =
        ["without_lobe", "not_understood", "not_covered", "warnings"].map(|it| &survey[it]);
    assert_eq!(totals, [&json!(2), &json!(4), &json!(1), &json!(2)]);
    assert_eq!(outcome("a/s.pbrt")["not_understood"][0]["place"], "./a/s.pbrt:6:1");
    assert!(flat.contains("warnings: ./a/far.pbrt:2:51: the roughness of"), "{text}");

    // Doubts refuse the scenes that have them, and so fail a build.
    let output = run(at, &["plan", ".", "--strict", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let strict: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(strict["counts"], json!({ "planned": 1, "parts": 1, "no scenes": 2, "refused": 6 }));
    ok(&at.join("b"), &["plan", "..", "--quiet"]);
    fs::create_dir(at.join("sound")).unwrap();
    fs::copy(at.join("b/r.toml"), at.join("sound/r.toml")).unwrap();
    ok(at, &["plan", "sound", "--strict"]);
}

#[test]
fn albedos_of_a_folder_that_were_not_asked_for_are_counted_once() {
    let many = brushed(8);
    // One alone is quick.
    let last = many.lines().last().unwrap();
    let folder = folder(&[("a.pbrt", &many), ("b.pbrt", &many), ("c.pbrt", last)]);
    let at = folder.path();
    let survey = json(at, &["plan", "."]);
    let number = |of: &Value| of.as_array().unwrap().len();
    assert_eq!((number(&survey["needs"]), number(&survey["offered"])), (1, 7));
    assert_eq!(number(&survey["files"][0]["offered"]), 8);
    assert_eq!(number(&json(at, &["plan", ".", "--albedo"])["needs"]), 8);
    let text = ok(at, &["plan", "."]);
    assert!(text.contains("--albedo adds those of 2 scenes where albedos take long: 7,"), "{text}");
    let none = ok(at, &["plan", ".", "--no-albedo"]);
    assert!(none.contains("distinct needs of all: none\n"), "{none}");
}

#[test]
fn a_folder_without_scenes_is_refused() {
    let folder = folder(&[("notes.txt", "")]);
    let message = refused(folder.path(), &["plan", "."]);
    assert!(message.contains("no file in this folder is named as a scene"), "{message}");
}
