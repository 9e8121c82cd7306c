//! What `plan`, `bake` and `inspect` say, in words.

use std::fs;

use crate::common::{json, names, ok, refused, run};

use microfacet_baker::store;
use microfacet_tables::{Errors, Quantity};

const GLASS: &str = include_str!("../../tables/recipes/frosted-glass.toml");

/// A recipe entry of a name and further lines.
fn material(name: &str, lines: &str) -> String {
    format!("[[material]]\nname = \"{name}\"\n{lines}\n")
}

fn ggx(name: &str) -> String {
    material(name, "sigma = 0.3\ngamma = 2.0")
}

fn smooth(name: &str) -> String {
    material(name, "sigma = 0.0\ngamma = 3.0")
}

/// A folder with a recipe.
fn folder(recipe: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("r.toml"), recipe).unwrap();
    folder
}

const DRAFT: [&str; 6] = ["bake", "r.toml", "--quality", "draft", "--out", "out"];

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

/// The text with every run of white space as one space: lines may break anywhere.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The lines after `next:`, which are the last.
fn next(text: &str) -> Vec<&str> {
    text.split_once("\nnext:\n").expect("what to do next").1.lines().map(str::trim).collect()
}

#[test]
fn a_bake_says_what_it_baked_how_well_and_what_to_run_next() {
    let folder = folder(GLASS);
    let text = ok(folder.path(), &DRAFT);
    fits(&text);
    assert_eq!(
        line(&text, "baked"),
        "baked    gamma 3             3 tables, for \"frosted glass\""
    );
    assert!(line(&text, "skipped").contains("albedo, no fresnel  the recipe states no `fresnel`"));
    let set = store::read(&folder.path().join("out")).unwrap();
    let figure = |name: &str, quantity: Quantity| {
        let table = set.tables().iter().find(|table| table.name == name).unwrap();
        format!("{:.2e}  in {name}", table.certificate.error(quantity).unwrap())
    };
    let g1 = line(&text, "  G1 ");
    assert!(g1.ends_with(&figure("shadowing_gamma_3", Quantity::G1)), "{text}");
    let cdf = line(&text, "  CDF of visible normals ");
    assert!(cdf.ends_with(&figure("visible_slope_gamma_3", Quantity::Cdf)), "{text}");
    assert!(!text.contains("  albedo  "), "{text}");
    let bytes = fs::metadata(folder.path().join("out/tables.safetensors")).unwrap().len();
    let wrote = line(&text, "wrote out/tables.safetensors, ");
    assert!(wrote.ends_with(&format!(" kB ({bytes} bytes)")), "{wrote}");
    assert!(line(&text, "3 tables baked, in ").ends_with('s'), "{text}");
    let commands = ["validate", "inspect", "report"];
    assert_eq!(next(&text), commands.map(|command| format!("microfacet-bake {command} out")));

    let again = ok(folder.path(), &DRAFT);
    line(&again, "all 3 tables came from the cache, in ");
}

#[test]
fn each_material_is_baked_or_skipped_for_a_reason() {
    let recipe = [
        ggx("gold"),
        smooth("mirror"),
        material("glass", "sigma = 0.4\ngamma = 3.0"),
        material("coat", "sigma = 0.2\ngamma = 3.0\nfresnel = { schlick = 0.04 }"),
    ];
    let folder = folder(&recipe.concat());
    let at = folder.path();
    let text = ok(at, &DRAFT);
    fits(&text);
    assert!(text.contains("\nskipped  closed form         GGX: "), "{text}");
    assert!(line(&text, "skipped  closed form").ends_with("no tables: \"gold\""), "{text}");
    assert_eq!(
        line(&text, "skipped  not rough"),
        "skipped  not rough           no microfacets: \"mirror\""
    );
    assert!(line(&text, "baked    gamma 3 ").ends_with("3 tables, for \"glass\", \"coat\""));
    let albedo = text.split_once("\nbaked    albedo              ").unwrap().1;
    let albedo = albedo.split("\nskipped").next().unwrap();
    assert!(albedo.starts_with("gamma 3, sigma 0.2, height-correlated masking"), "{text}");
    assert!(albedo.ends_with("1 table, for \"coat\""), "{text}");
    // The largest error of an albedo is that of its worst moment.
    let set = store::read(&at.join("out")).unwrap();
    let table = set.tables().iter().find(|table| table.kind.is_albedo()).unwrap();
    let worst = table.certificate.worst();
    assert!(worst > table.certificate.error(Quantity::E).unwrap());
    assert_eq!(line(&text, "  albedo ").trim(), {
        let figure = format!("{worst:.2e}");
        format!("{:22}  {figure}  in {}", "albedo", table.name)
    });

    // A plan says the same of the same materials, and so does the JSON of both.
    let plan = ok(at, &["plan", "r.toml", "--quality", "draft"]);
    fits(&plan);
    for skipped in text.lines().filter(|line| line.starts_with("skipped")) {
        let start = skipped.replacen("skipped", "skip", 1).replacen("  ", " ", 1);
        let [what, why] = [&skipped[9..27], &skipped[29..50]];
        assert!(plan.contains(&format!("skip  {what}  {why}")), "{start}: {plan}");
    }
    let [baked, planned] = [json(at, &DRAFT), json(at, &["plan", "r.toml"])];
    assert_eq!(baked["materials"], planned["materials"]);
    let gold = &baked["materials"][0];
    assert_eq!((&gold["name"], &gold["verdict"]), (&"gold".into(), &"closed form".into()));
    assert_eq!(planned["materials"][2]["shapes"], 0);
    assert_eq!(planned["shapes"][0]["materials"], serde_json::json!(["glass", "coat"]));
}

/// A scene says what it holds that is no lobe, once, and not on standard error.
#[test]
fn ignored_materials_are_in_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "MakeNamedMaterial \"steel\" \"string type\" \"conductor\" \"float roughness\" 0.04\n\
         MakeNamedMaterial \"wall\" \"string type\" \"diffuse\"\n";
    fs::write(folder.path().join("r.pbrt"), scene).unwrap();
    let output = run(folder.path(), &["bake", "r.pbrt", "--out", "out"]);
    let [text, messages] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    let skipped = line(&text, "skipped  no lobe");
    assert!(skipped.ends_with(": \"wall\""), "{text}");
    assert!(!messages.contains("wall"), "{messages}");
    let json = json(folder.path(), &["bake", "r.pbrt", "--out", "out"]);
    assert_eq!(json["ignored"][0]["name"], "wall");
}

#[test]
fn a_set_of_closed_forms_is_a_set_in_every_format() {
    let folder = folder(&(ggx("gold") + &ggx("steel")));
    let at = folder.path();
    fs::write(at.join("glass.toml"), GLASS).unwrap();
    ok(at, &["bake", "glass.toml", "--quality", "draft", "--format", "exr", "--out", "out"]);
    assert_eq!(names(&at.join("out")), ["tables.exr"]);
    let text = ok(at, &["bake", "r.toml", "--format", "exr", "--out", "out"]);
    fits(&text);
    assert!(text.contains("no tables and so no image; it is in tables.safetensors"), "{text}");
    assert!(!text.contains("error of"), "{text}");
    assert_eq!(next(&text)[..2], ["microfacet-bake inspect out", "microfacet-bake report out"]);
    assert!(!text.contains("validate out") && text.contains("--tabulate-ggx"), "{text}");
    // The old set is gone, and the new one in its place.
    assert_eq!(names(&at.join("out")), ["tables.safetensors"]);
    let set = store::read(&at.join("out")).unwrap();
    assert!(set.tables().is_empty() && set.material("gold").is_ok());
    let shown = ok(at, &["inspect", "out"]);
    fits(&shown);
    assert!(line(&shown, "holds").contains("no tables"), "{shown}");
    assert!(line(&shown, "normals").ends_with("gamma 2 (GGX) in closed form"), "{shown}");
    // What the default set serves is tested with that.
    let text = ok(at, &["bake", "glass.toml", "--embedded", "--out", "embedded"]);
    assert!(text.contains("`microfacet-bake validate` tests that one"), "{text}");
    // A plan has no seconds to compare.
    let plan = ok(at, &["plan", "r.toml"]);
    let total = line(&plan, "total: ");
    assert!(total.contains("no tables to bake; ") && !total.contains("faster"), "{plan}");
}

/// Tables that `validate` does not test are shown with their certificates.
#[test]
fn a_set_without_a_test_is_inspected() {
    let folder = folder(&material("coat", "distribution = \"gtr\"\nc = 0.2\ngamma = 1.3"));
    let text = ok(folder.path(), &DRAFT);
    let commands = ["inspect out --details", "report out"];
    assert_eq!(next(&text)[..2], commands.map(|command| format!("microfacet-bake {command}")));
    refused(folder.path(), &["validate", "out"]);
    assert!(line(&text, "  D/D(0) ").ends_with("in radial_density_gtr_0.2_1.3"), "{text}");
    let shown = ok(folder.path(), &["inspect", "out"]);
    assert!(line(&shown, "materials").contains("\"coat\": gtr:0.2,1.3, height-"), "{shown}");
    // Its s means nothing, and is not GGX.
    assert!(!shown.contains("closed form"), "{shown}");
}

#[test]
fn commands_to_run_next_are_quoted_for_a_shell() {
    let folder = folder(GLASS);
    let name = "my \"frosted\" glass's";
    let text = ok(folder.path(), &[&DRAFT[..5], &[name]].concat());
    let quoted = r#"'my "frosted" glass'\''s'"#;
    assert_eq!(next(&text)[1], format!("microfacet-bake inspect {quoted}"));
    assert_eq!(next(&text)[2], format!("microfacet-bake report {quoted}"));
    let shown = ok(folder.path(), &["inspect", name]);
    assert_eq!(
        shown.lines().last(),
        Some(&format!("microfacet-bake report {quoted} draws the set as a page")[..])
    );
    if cfg!(unix) {
        for command in next(&text) {
            let pasted = command.replacen("microfacet-bake", "\"$PROGRAM\"", 1);
            let quick =
                if pasted.contains("validate") { " --configurations 1 --samples 1000" } else { "" };
            let status = std::process::Command::new("sh")
                .args(["-c", &format!("{pasted}{quick}")])
                .env("PROGRAM", env!("CARGO_BIN_EXE_microfacet-bake"))
                .current_dir(folder.path())
                .stdout(std::process::Stdio::null())
                .status();
            assert!(status.unwrap().success(), "{pasted}");
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
    let folder = folder(&(0..300).map(each).collect::<String>());
    for command in [&DRAFT[..], &["plan", "r.toml"]] {
        let text = ok(folder.path(), command);
        fits(&text);
        // Twenty materials, and what is done for all.
        assert!(text.lines().count() <= 44, "{text}");
        assert!(text.contains("and 280 more"), "{text}");
        let text = flat(&text);
        assert!(text.contains("\"ggx 0\", \"ggx 3\", \"ggx 6\", \"ggx 9\", 96 more"), "{text}");
        assert!(text.contains("\"smooth 1\", \"smooth 4\", \"smooth 7\","), "{text}");
        assert!(text.contains("for \"brushed 5\", \"brushed 11\", "), "{text}");
    }
    let shown = ok(folder.path(), &["inspect", "out"]);
    assert!(shown.contains("           and 294 more\n"), "{shown}");
    let details = ok(folder.path(), &["inspect", "out", "--details"]);
    assert!(details.contains("           \"brushed 299\": sigma 0.2, gamma 4, "), "{details}");

    // Very many table groups are counted.
    let gtr = |i: usize| {
        material(&format!("{i}"), &format!("distribution = \"gtr\"\nc = 0.2\ngamma = 1.1{i:02}"))
    };
    fs::write(folder.path().join("r.toml"), (0..30).map(gtr).collect::<String>()).unwrap();
    let text = ok(folder.path(), &["plan", "r.toml"]);
    assert!(line(&text, "bake  and 10 more").ends_with("40 tables; --json lists all"), "{text}");
}

#[test]
fn a_path_that_is_no_folder_and_options_without_effect_are_refused() {
    let folder = folder(&ggx("gold"));
    let at = folder.path();
    let message = refused(at, &["bake", "r.toml", "--out", "-"]);
    assert!(message.contains("name a folder, such as --out tables"), "{message}");
    assert!(!at.join("-").exists());
    ok(at, &["bake", "r.toml", "--out", "./-"]);
    let message = refused(at, &["bake", "r.toml", "--out", "out", "--patient"]);
    assert!(message.contains("--max-error") && message.contains("--max-bytes"), "{message}");
    ok(at, &["bake", "r.toml", "--out", "out", "--patient", "--max-bytes", "1MB"]);
}

#[test]
fn a_set_is_always_written() {
    let folder = folder(&smooth("mirror"));
    let at = folder.path();
    fs::write(at.join("gold.toml"), ggx("gold")).unwrap();
    ok(at, &["bake", "gold.toml", "--out", "out"]);
    let text = ok(at, &["bake", "r.toml", "--out", "out"]);
    assert!(text.contains("not rough           no microfacets: \"mirror\""), "{text}");
    assert!(text.contains("no material in use is rough"), "{text}");
    // The set of the earlier bake is replaced.
    let set = store::read(&at.join("out")).unwrap();
    let names = set.provenance().materials.iter().map(|material| &material.name[..]);
    assert_eq!((set.tables().len(), names.collect::<Vec<_>>()), (0, vec!["mirror"]));
    let json = json(at, &["bake", "r.toml", "--out", "out"]);
    assert_eq!(
        (&json["baked"], &json["materials"][0]["verdict"]),
        (&0.into(), &"not rough".into())
    );
    assert_eq!(json["files"].as_array().unwrap().len(), 1);
    // A scene of which nothing has a lobe too.
    fs::write(at.join("s.pbrt"), "WorldBegin\nMaterial \"diffuse\"\nShape \"sphere\"\n").unwrap();
    let text = ok(at, &["bake", "s.pbrt", "--out", "out"]);
    assert_eq!(store::read(&at.join("out")).unwrap().provenance().materials.len(), 0);
    let shown = ok(at, &["inspect", "out"]);
    assert!(shown.contains("materials  none\n"));
    // There is nothing to draw.
    assert!(!text.contains("report") && !shown.contains("report"), "{text}{shown}");
}

/// The sampler refuses it as a lobe, so that no table could be read.
#[test]
fn a_distribution_that_is_smooth_is_not_baked() {
    let narrow = material("film", "distribution = \"gtr\"\nc = 1e-9\ngamma = 1.3");
    let folder = folder(&narrow);
    let at = folder.path();
    let plan = ok(at, &["plan", "r.toml"]);
    assert!(!plan.contains("bake  ") && plan.contains("no microfacets: \"film\""), "{plan}");
    fs::write(at.join("r.toml"), narrow + &ggx("gold")).unwrap();
    let text = ok(at, &DRAFT);
    assert!(!text.contains("gtr"), "{text}");
    assert!(store::read(&at.join("out")).unwrap().material("gold").is_ok());
}

#[test]
fn a_set_larger_than_the_general_one_is_called_larger() {
    let gtr = |i: usize| {
        material(&format!("{i}"), &format!("distribution = \"gtr\"\nc = 0.2\ngamma = 1.1{i:02}"))
    };
    let folder = folder(&(0..60).map(gtr).collect::<String>());
    let plan = ok(folder.path(), &["plan", "r.toml"]);
    let total = line(&plan, "total: ");
    assert!(total.contains(" times larger and "), "{plan}");
    assert!(!plan.contains("0.2 times"), "{plan}");
}

/// No command advises to bake a shape that `bake` refuses.
#[test]
fn a_shape_below_all_tables_is_refused_with_what_helps() {
    let folder = folder(&material("heavy", "sigma = 0.3\ngamma = 1.5005"));
    let at = folder.path();
    let heavy = ["--sigma", "0.3", "--gamma", "1.5005", "--theta", "1"];
    let sample = ["sample", "--count", "10", "--out", "n.safetensors"];
    let commands: [&[&str]; 5] = [
        &[&sample[..], &heavy].concat(),
        &[&["validate"], &heavy[..]].concat(),
        &["furnace", "--gamma", "2,1.5005"],
        &["plan", "r.toml"],
        &["bake", "r.toml", "--out", "out"],
    ];
    for command in commands {
        let message = refused(at, command);
        assert!(message.contains("gamma = 1.5005 is below 1.501"), "{command:?}: {message}");
        assert!(!message.contains("recipe line"), "{command:?}: {message}");
    }
    let message = refused(at, commands[0]);
    assert!(message.contains("--method exact"), "{message}");
    ok(at, &[&sample[..], &heavy, &["--method", "exact"]].concat());
    // What a recipe can state says what tables cover.
    fs::write(at.join("r.toml"), material("heavy", "sigma = 0.3\ngamma = 1.5")).unwrap();
    assert!(refused(at, &["plan", "r.toml"]).contains("from 1.501 on"));
}

#[test]
fn the_embedded_set_is_shown_in_a_screen_of_words() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let shown = ok(at, &["inspect"]);
    fits(&shown);
    assert!(shown.lines().count() <= 30, "{shown}");
    assert!(shown.ends_with("\nmicrofacet-bake report draws the set as a page\n"), "{shown}");
    assert!(line(&shown, "set").ends_with("the default set, compiled into the sampler"), "{shown}");
    assert!(line(&shown, "normals").ends_with("gamma 1.501 to inf; every sigma"), "{shown}");
    assert!(
        line(&shown, "albedo").contains(
            "gamma 1.501 to inf, sigma 0 to 3; uncorrelated and height-correlated masking"
        ),
        "{shown}"
    );
    let details = ok(at, &["inspect", "--details"]);
    fits(&details);
    assert!(details.starts_with(shown.split("\n--details").next().unwrap()), "{details}");
    let has = [
        "cubic Hermite between them",
        "linear between them",
        "the polynomial of the nearest 4 between them",
        "largest error of G1: ",
        "the largest of all is at gamma 1.8, cot(theta)/sigma ",
        " conventions albedo: share of light",
        "mirrored_root: t = ",
    ];
    let details = flat(&details);
    for has in has {
        assert!(details.contains(has), "{has}: {details}");
    }
    // No word of a programming language, nor a key of the file.
    for text in [&shown, &details] {
        for debug in ["F32", "Hermite,", "Lagrange", "{\"", "[1", "_max_error", "worst_"] {
            assert!(!text.contains(debug), "{debug}: {text}");
        }
    }
    // The certificate's figures are all there.
    let set = microfacet_sampler::Tables::embedded();
    for table in set.tables() {
        let certificate = &table.certificate;
        let of_quantity = |of: &Errors| [Some(of.largest), of.rms, of.outside];
        let errors = certificate.errors.values().flat_map(of_quantity);
        for figure in errors.chain([certificate.quadrature, certificate.stand_in]).flatten() {
            assert!(details.contains(&format!("{figure:.2e}")), "{} {figure:e}", table.name);
        }
    }
    let document = json(at, &["inspect"]);
    assert_eq!(document["tables"].as_array().unwrap().len(), set.tables().len());
    // A checksum is one of a file.
    assert!(document.get("checksum").is_none());
    refused(at, &["inspect", "--details", "--json"]);
}
