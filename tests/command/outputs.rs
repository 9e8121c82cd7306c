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
fn figures_of_a_summary_are_those_of_certificates_and_of_files() {
    let desk = desk(GLASS);
    let text = desk.ok(DRAFT);
    let set = store::read(&desk.join("out")).unwrap();
    for (what, name, quantity) in [
        ("  G1 ", "shadowing_gamma_3", Quantity::G1),
        ("  CDF of visible normals ", "visible_slope_gamma_3", Quantity::Cdf),
    ] {
        let table = set.tables().iter().find(|table| table.name == name).unwrap();
        let figure = format!("{:.2e}  in {name}", table.certificate.error(quantity).unwrap());
        assert!(line(&text, what).ends_with(&figure), "{text}");
    }
    let bytes = fs::metadata(desk.join("out/tables.safetensors")).unwrap().len();
    let wrote = line(&text, "wrote out/tables.safetensors, ");
    assert!(wrote.ends_with(&format!(" kB ({bytes} bytes)")), "{wrote}");
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
    // The largest error of an albedo is that of its worst moment.
    let set = store::read(&desk.join("out")).unwrap();
    let table = set.tables().iter().find(|table| table.kind.is_albedo()).unwrap();
    let worst = table.certificate.worst();
    assert!(worst > table.certificate.error(Quantity::E).unwrap());
    let figure = format!("{:22}  {worst:.2e}  in {}", "albedo", table.name);
    assert_eq!(line(&text, "  albedo ").trim(), figure);

    // A plan says the same of the same materials, and so does the JSON of both.
    let plan = desk.ok("plan r.toml --quality draft");
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

#[test]
fn a_set_of_closed_forms_is_a_set_in_every_format() {
    let desk = desk(&(ggx("gold") + &ggx("steel")));
    desk.write("glass.toml", GLASS);
    desk.ok("bake glass.toml --quality draft --format exr --out out");
    assert_eq!(names(&desk.join("out")), ["tables.exr"]);
    desk.ok("bake r.toml --format exr --out out");
    // The old set is gone, and the new one in its place.
    assert_eq!(names(&desk.join("out")), ["tables.safetensors"]);
    let set = store::read(&desk.join("out")).unwrap();
    assert!(set.tables().is_empty() && set.material("gold").is_ok());
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
fn a_set_of_nothing_is_a_set() {
    let desk = desk(&smooth("mirror"));
    let json = desk.json("bake r.toml --out out");
    let verdict = &json["materials"][0]["verdict"];
    assert_eq!((&json["baked"], verdict), (&0.into(), &"not rough".into()));
    assert_eq!(json["files"].as_array().unwrap().len(), 1);
    let set = store::read(&desk.join("out")).unwrap();
    let names = set.provenance().materials.iter().map(|material| &material.name[..]);
    assert_eq!((set.tables().len(), names.collect::<Vec<_>>()), (0, vec!["mirror"]));
    // A scene of which nothing has a lobe too.
    desk.write("s.pbrt", "WorldBegin\nMaterial \"diffuse\"\nShape \"sphere\"\n");
    desk.ok("bake s.pbrt --out out");
    assert_eq!(store::read(&desk.join("out")).unwrap().provenance().materials.len(), 0);
}

#[test]
fn a_set_larger_than_the_general_one_is_called_larger() {
    let plan = desk(&gtr(60)).ok("plan r.toml");
    has(line(&plan, "total: "), &[" times larger and "]);
    lacks(&plan, &["0.2 times"]);
}

#[test]
fn the_figures_of_certificates_are_in_the_details() {
    let desk = Desk::new(&[]);
    let shown = desk.ok("inspect");
    assert!(shown.lines().count() <= 45, "{shown}");
    let details = desk.ok("inspect --details");
    assert!(details.starts_with(shown.split("\n--details").next().unwrap()), "{details}");
    let details = flat(&details);
    // No word of a programming language, nor a key of the file.
    lacks(&details, &["F32", "Hermite,", "Lagrange", "{\"", "[1", "_max_error", "worst_"]);
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
}
