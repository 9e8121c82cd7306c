//! What `plan`, `bake` and `inspect` say, in words.

use std::fs;

use microfacet_baker::store;
use microfacet_tables::{Errors, Quantity};

use crate::common::{Desk, PROGRAM, flat, has, lacks, material, names, ok};

const GLASS: &str = include_str!("../../tables/recipes/frosted-glass.toml");

fn ggx(name: &str) -> String {
    material(name, "sigma = 0.3\ngamma = 2.0")
}

fn smooth(name: &str) -> String {
    material(name, "sigma = 0.0\ngamma = 3.0")
}

/// Distributions that each need tables of their own.
fn gtr(count: usize) -> String {
    let one = |i: usize| {
        material(&format!("{i}"), &format!("distribution = \"gtr\"\nc = 0.2\ngamma = 1.1{i:02}"))
    };
    (0..count).map(one).collect()
}

/// A folder with a recipe.
fn desk(recipe: &str) -> Desk {
    Desk::new(&[("r.toml", recipe)])
}

const DRAFT: &str = "bake r.toml --quality draft --out out";

/// The line that starts so.
#[track_caller]
fn line<'a>(text: &'a str, start: &str) -> &'a str {
    let found = text.lines().find(|line| line.starts_with(start));
    found.unwrap_or_else(|| panic!("no line starts with {start:?}:\n{text}"))
}

#[track_caller]
fn fits(text: &str) {
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{} columns: {line}", line.chars().count());
    }
}

/// The lines after `next:`, which are the last.
fn next(text: &str) -> Vec<&str> {
    text.split_once("\nnext:\n").expect("what to do next").1.lines().map(str::trim).collect()
}

#[test]
fn a_bake_says_what_it_baked_how_well_and_what_to_run_next() {
    let desk = desk(GLASS);
    let text = desk.ok(DRAFT);
    fits(&text);
    let baked = "baked    gamma 3             3 tables, for \"frosted glass\"";
    assert_eq!(line(&text, "baked"), baked);
    has(line(&text, "skipped"), &["albedo, no fresnel  the recipe states no `fresnel`"]);
    let set = store::read(&desk.join("out")).unwrap();
    for (what, name, quantity) in [
        ("  G1 ", "shadowing_gamma_3", Quantity::G1),
        ("  CDF of visible normals ", "visible_slope_gamma_3", Quantity::Cdf),
    ] {
        let table = set.tables().iter().find(|table| table.name == name).unwrap();
        let figure = format!("{:.2e}  in {name}", table.certificate.error(quantity).unwrap());
        assert!(line(&text, what).ends_with(&figure), "{text}");
    }
    lacks(&text, &["  albedo  "]);
    let bytes = fs::metadata(desk.join("out/tables.safetensors")).unwrap().len();
    let wrote = line(&text, "wrote out/tables.safetensors, ");
    assert!(wrote.ends_with(&format!(" kB ({bytes} bytes)")), "{wrote}");
    assert!(line(&text, "3 tables baked, in ").ends_with('s'), "{text}");
    let commands = ["validate", "inspect", "report"];
    assert_eq!(next(&text), commands.map(|command| format!("microfacet-bake {command} out")));
    line(&desk.ok(DRAFT), "all 3 tables came from the cache, in ");
}

#[test]
fn each_material_is_baked_or_skipped_for_a_reason() {
    let recipe = [
        ggx("gold"),
        smooth("mirror"),
        material("glass", "sigma = 0.4\ngamma = 3.0"),
        material("coat", "sigma = 0.2\ngamma = 3.0\nfresnel = { schlick = 0.04 }"),
    ];
    let desk = desk(&recipe.concat());
    let text = desk.ok(DRAFT);
    fits(&text);
    has(&text, &["\nskipped  closed form         GGX: "]);
    assert!(line(&text, "skipped  closed form").ends_with("no tables: \"gold\""), "{text}");
    let smooth = "skipped  not rough           no microfacets: \"mirror\"";
    assert_eq!(line(&text, "skipped  not rough"), smooth);
    assert!(line(&text, "baked    gamma 3 ").ends_with("3 tables, for \"glass\", \"coat\""));
    let albedo = text.split_once("\nbaked    albedo              ").unwrap().1;
    let albedo = albedo.split("\nskipped").next().unwrap();
    assert!(albedo.starts_with("gamma 3, sigma 0.2, height-correlated masking"), "{text}");
    assert!(albedo.ends_with("1 table, for \"coat\""), "{text}");
    // The largest error of an albedo is that of its worst moment.
    let set = store::read(&desk.join("out")).unwrap();
    let table = set.tables().iter().find(|table| table.kind.is_albedo()).unwrap();
    let worst = table.certificate.worst();
    assert!(worst > table.certificate.error(Quantity::E).unwrap());
    let figure = format!("{:22}  {worst:.2e}  in {}", "albedo", table.name);
    assert_eq!(line(&text, "  albedo ").trim(), figure);

    // A plan says the same of the same materials, and so does the JSON of both.
    let plan = desk.ok("plan r.toml --quality draft");
    fits(&plan);
    for skipped in text.lines().filter(|line| line.starts_with("skipped")) {
        has(&plan, &[&format!("skip  {}  {}", &skipped[9..27], &skipped[29..50])]);
    }
    let [baked, planned] = [DRAFT, "plan r.toml"].map(|line| desk.json(line));
    assert_eq!(baked["materials"], planned["materials"]);
    let gold = &baked["materials"][0];
    assert_eq!((&gold["name"], &gold["verdict"]), (&"gold".into(), &"closed form".into()));
    assert_eq!(planned["materials"][2]["shapes"], 0);
    assert_eq!(planned["shapes"][0]["materials"], serde_json::json!(["glass", "coat"]));
}

/// A scene says what it holds that is no lobe, once, and not on standard error.
#[test]
fn ignored_materials_are_in_the_summary() {
    let scene = "MakeNamedMaterial \"steel\" \"string type\" \"conductor\" \"float roughness\" 0.04\n\
         MakeNamedMaterial \"wall\" \"string type\" \"diffuse\"\n";
    let desk = Desk::new(&[("r.pbrt", scene)]);
    let said = desk.run("bake r.pbrt --out out");
    assert!(line(&said.out, "skipped  no lobe").ends_with(": \"wall\""), "{}", said.out);
    lacks(&said.err, &["wall"]);
    assert_eq!(desk.json("bake r.pbrt --out out")["ignored"][0]["name"], "wall");
}

#[test]
fn a_set_of_closed_forms_is_a_set_in_every_format() {
    let desk = desk(&(ggx("gold") + &ggx("steel")));
    desk.write("glass.toml", GLASS);
    desk.ok("bake glass.toml --quality draft --format exr --out out");
    assert_eq!(names(&desk.join("out")), ["tables.exr"]);
    let text = desk.ok("bake r.toml --format exr --out out");
    fits(&text);
    has(&text, &["no tables and so no image; it is in tables.safetensors", "--tabulate-ggx"]);
    lacks(&text, &["error of", "validate out"]);
    assert_eq!(next(&text)[..2], ["microfacet-bake inspect out", "microfacet-bake report out"]);
    // The old set is gone, and the new one in its place.
    assert_eq!(names(&desk.join("out")), ["tables.safetensors"]);
    let set = store::read(&desk.join("out")).unwrap();
    assert!(set.tables().is_empty() && set.material("gold").is_ok());
    let shown = desk.ok("inspect out");
    fits(&shown);
    has(line(&shown, "holds"), &["no tables"]);
    assert!(line(&shown, "normals").ends_with("gamma 2 (GGX) in closed form"), "{shown}");
    // What the default set serves is tested with that.
    let text = desk.ok("bake glass.toml --embedded --out embedded");
    has(&text, &["`microfacet-bake validate` tests that one"]);
    // A plan has no seconds to compare.
    let plan = desk.ok("plan r.toml");
    has(line(&plan, "total: "), &["no tables to bake; "]);
    lacks(line(&plan, "total: "), &["faster"]);
}

/// Tables that `validate` does not test are shown with their certificates.
#[test]
fn a_set_without_a_test_is_inspected() {
    let desk = desk(&material("coat", "distribution = \"gtr\"\nc = 0.2\ngamma = 1.3"));
    let text = desk.ok(DRAFT);
    let commands = ["inspect out --details", "report out"];
    assert_eq!(next(&text)[..2], commands.map(|command| format!("microfacet-bake {command}")));
    desk.refuses("validate out", &[]);
    assert!(line(&text, "  D/D(0) ").ends_with("in radial_density_gtr_0.2_1.3"), "{text}");
    let shown = desk.ok("inspect out");
    has(line(&shown, "materials"), &["\"coat\": gtr:0.2,1.3, height-"]);
    // Its s means nothing, and is not GGX.
    lacks(&shown, &["closed form"]);
}

#[test]
fn commands_to_run_next_are_quoted_for_a_shell() {
    let desk = desk(GLASS);
    let name = "my \"frosted\" glass's";
    let text = ok(desk.path(), &["bake", "r.toml", "--quality", "draft", "--out", name]);
    let quoted = r#"'my "frosted" glass'\''s'"#;
    assert_eq!(next(&text)[1], format!("microfacet-bake inspect {quoted}"));
    assert_eq!(next(&text)[2], format!("microfacet-bake report {quoted}"));
    let shown = ok(desk.path(), &["inspect", name]);
    let last = format!("microfacet-bake report {quoted} draws the set as a page");
    assert_eq!(shown.lines().last(), Some(&last[..]));
    if cfg!(unix) {
        for command in next(&text) {
            let pasted = command.replacen("microfacet-bake", "\"$0\"", 1);
            let few = ["", " --configurations 1 --samples 1000"];
            let quick = few[usize::from(pasted.contains("validate"))];
            let mut shell = std::process::Command::new("sh");
            shell.args(["-c", &format!("{pasted}{quick}"), PROGRAM]).current_dir(desk.path());
            assert!(shell.output().unwrap().status.success(), "{pasted}");
        }
    }
}

#[test]
fn hundreds_of_materials_stay_readable() {
    let each = |i: usize| match i % 3 {
        0 => ggx(&format!("ggx {i}")),
        1 => smooth(&format!("smooth {i}")),
        _ => material(&format!("brushed {i}"), &format!("sigma = 0.2\ngamma = {}", 3 + i % 2)),
    };
    let desk = desk(&(0..300).map(each).collect::<String>());
    for command in [DRAFT, "plan r.toml"] {
        let text = desk.ok(command);
        fits(&text);
        // Twenty materials, and what is done for all.
        assert!(text.lines().count() <= 44, "{text}");
        let parts = [
            "and 280 more",
            "\"ggx 0\", \"ggx 3\", \"ggx 6\", \"ggx 9\", 96 more",
            "\"smooth 1\", \"smooth 4\", \"smooth 7\",",
            "for \"brushed 5\", \"brushed 11\", ",
        ];
        has(&flat(&text), &parts);
    }
    has(&desk.ok("inspect out"), &["           and 294 more\n"]);
    let details = desk.ok("inspect out --details");
    has(&details, &["           \"brushed 299\": sigma 0.2, gamma 4, "]);

    // Very many table groups are counted.
    desk.write("r.toml", gtr(30));
    let text = desk.ok("plan r.toml");
    assert!(line(&text, "bake  and 10 more").ends_with("40 tables; --json lists all"), "{text}");
}

#[test]
fn a_path_that_is_no_folder_and_options_without_effect_are_refused() {
    let desk = desk(&ggx("gold"));
    desk.refuses("bake r.toml --out -", &["name a folder, such as --out tables"]);
    assert!(!desk.join("-").exists());
    desk.ok("bake r.toml --out ./-");
    desk.refuses("bake r.toml --out out --patient", &["--max-error", "--max-bytes"]);
    desk.ok("bake r.toml --out out --patient --max-bytes 1MB");
}

#[test]
fn a_set_is_always_written() {
    let desk = desk(&smooth("mirror"));
    desk.write("gold.toml", ggx("gold"));
    desk.ok("bake gold.toml --out out");
    let text = desk.ok("bake r.toml --out out");
    let parts = ["not rough           no microfacets: \"mirror\"", "no material in use is rough"];
    has(&text, &parts);
    // The set of the earlier bake is replaced.
    let set = store::read(&desk.join("out")).unwrap();
    let names = set.provenance().materials.iter().map(|material| &material.name[..]);
    assert_eq!((set.tables().len(), names.collect::<Vec<_>>()), (0, vec!["mirror"]));
    let json = desk.json("bake r.toml --out out");
    let verdict = &json["materials"][0]["verdict"];
    assert_eq!((&json["baked"], verdict), (&0.into(), &"not rough".into()));
    assert_eq!(json["files"].as_array().unwrap().len(), 1);
    // A scene of which nothing has a lobe too.
    desk.write("s.pbrt", "WorldBegin\nMaterial \"diffuse\"\nShape \"sphere\"\n");
    let text = desk.ok("bake s.pbrt --out out");
    assert_eq!(store::read(&desk.join("out")).unwrap().provenance().materials.len(), 0);
    let shown = desk.ok("inspect out");
    has(&shown, &["materials  none\n"]);
    // There is nothing to draw.
    lacks(&(text + &shown), &["report"]);
}

/// The sampler refuses it as a lobe, so that no table could be read.
#[test]
fn a_distribution_that_is_smooth_is_not_baked() {
    let narrow = material("film", "distribution = \"gtr\"\nc = 1e-9\ngamma = 1.3");
    let desk = desk(&narrow);
    let plan = desk.ok("plan r.toml");
    has(&plan, &["no microfacets: \"film\""]);
    lacks(&plan, &["bake  "]);
    desk.write("r.toml", narrow + &ggx("gold"));
    lacks(&desk.ok(DRAFT), &["gtr"]);
    assert!(store::read(&desk.join("out")).unwrap().material("gold").is_ok());
}

#[test]
fn a_set_larger_than_the_general_one_is_called_larger() {
    let plan = desk(&gtr(60)).ok("plan r.toml");
    has(line(&plan, "total: "), &[" times larger and "]);
    lacks(&plan, &["0.2 times"]);
}

/// No command advises to bake a shape that `bake` refuses.
#[test]
fn a_shape_below_all_tables_is_refused_with_what_helps() {
    let desk = desk(&material("heavy", "sigma = 0.3\ngamma = 1.5005"));
    let heavy = "--sigma 0.3 --gamma 1.5005 --theta 1";
    let sample = format!("sample --count 10 --out n.safetensors {heavy}");
    for line in [
        &sample[..],
        &format!("validate {heavy}"),
        "furnace --gamma 2,1.5005",
        "plan r.toml",
        "bake r.toml --out out",
    ] {
        lacks(&desk.refuses(line, &["gamma = 1.5005 is below 1.501"]), &["recipe line"]);
    }
    desk.refuses(&sample, &["--method exact"]);
    desk.ok(&format!("{sample} --method exact"));
    // What a recipe can state says what tables cover.
    desk.write("r.toml", material("heavy", "sigma = 0.3\ngamma = 1.5"));
    desk.refuses("plan r.toml", &["from 1.501 on"]);
}

#[test]
fn the_embedded_set_is_shown_in_a_screen_of_words() {
    let desk = Desk::new(&[]);
    let shown = desk.ok("inspect");
    fits(&shown);
    assert!(shown.lines().count() <= 30, "{shown}");
    assert!(shown.ends_with("\nmicrofacet-bake report draws the set as a page\n"), "{shown}");
    assert!(line(&shown, "set").ends_with("the default set, compiled into the sampler"), "{shown}");
    assert!(line(&shown, "normals").ends_with("gamma 1.501 to inf; every sigma"), "{shown}");
    let albedo = "gamma 1.501 to inf, sigma 0 to 3; uncorrelated and height-correlated masking";
    has(line(&shown, "albedo"), &[albedo]);
    let details = desk.ok("inspect --details");
    fits(&details);
    assert!(details.starts_with(shown.split("\n--details").next().unwrap()), "{details}");
    let parts = [
        "cubic Hermite between them",
        "linear between them",
        "the polynomial of the nearest 4 between them",
        "largest error of G1: ",
        "the largest of all is at gamma 1.8, cot(theta)/sigma ",
        " conventions albedo: share of light",
        "mirrored_root: t = ",
    ];
    let details = flat(&details);
    has(&details, &parts);
    // No word of a programming language, nor a key of the file.
    let debug = ["F32", "Hermite,", "Lagrange", "{\"", "[1", "_max_error", "worst_"];
    lacks(&shown, &debug);
    lacks(&details, &debug);
    // The certificate's figures are all there.
    let set = microfacet_sampler::Tables::embedded();
    for table in set.tables() {
        let certificate = &table.certificate;
        let of_quantity = |of: &Errors| [Some(of.largest), of.rms, of.outside];
        let errors = certificate.errors.values().flat_map(of_quantity);
        for figure in errors.chain([certificate.quadrature, certificate.stand_in]).flatten() {
            has(&details, &[&format!("{figure:.2e}")]);
        }
    }
    let document = desk.json("inspect");
    assert_eq!(document["tables"].as_array().unwrap().len(), set.tables().len());
    // A checksum is one of a file.
    assert!(document.get("checksum").is_none());
    desk.refuses("inspect --details --json", &[]);
}
