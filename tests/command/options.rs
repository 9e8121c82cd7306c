//! One vocabulary of options, and refusals that name the value, the range and the way out.

use std::fs;
use std::io::Cursor;
use std::process::{Command, Output};

use microfacet_baker::store;
use microfacet_sampler::Tables;
use microfacet_tables::Kind;
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};

use crate::common::{Desk, PROGRAM, has, json, lacks, material, ok, refused, run, words};

const ONE: &str = "--sigma 0.3 --gamma 3 --theta 1";

#[test]
fn a_letter_stands_for_its_option() {
    let desk = Desk::new(&[]);
    desk.ok("plot student-t --out a.svg");
    desk.ok("plot student-t -o b.svg");
    assert_eq!(desk.read("a.svg"), desk.read("b.svg"));
    desk.ok(&format!("sample {ONE} --count 9 -o n"));
}

#[test]
fn angles_may_be_in_degrees_and_are_doubted_else() {
    let desk = Desk::new(&[]);
    let draw = |name: &str, angles: &str| {
        let line = format!("sample --sigma 0.3 --gamma 3 --count 100 --out {name} {angles}");
        let said = desk.run(&line).ends(0);
        (desk.read(name), said.err)
    };
    let radians = draw("r", "--theta 1.0471975511965976 --phi 1.5707963267948966");
    assert_eq!(draw("d", "--theta 60 --phi 90 --degrees"), radians);
    assert_eq!(radians.1, "");
    let (_, doubt) = draw("p", "--theta 1 --phi 360");
    has(&doubt, &["warning: phi = 360", "--degrees"]);
    let one = "validate --sigma 0.3 --gamma 3 --samples 1e4";
    desk.ok(&format!("{one} --theta 60 --phi 360 --degrees"));
    has(&desk.run(&format!("{one} --theta 1 --phi 360")).err, &["57.3 turns"]);
}

/// The normals of a file, and their densities.
fn normals(bytes: &[u8]) -> Vec<([f64; 3], f64)> {
    let read = SafeTensors::deserialize(bytes).unwrap();
    let [normals, pdf] = ["normals", "pdf"].map(|name| {
        let bytes = read.tensor(name).unwrap().data().to_vec();
        let float = |at: &[u8]| f64::from(f32::from_le_bytes(at.try_into().unwrap()));
        bytes.chunks(4).map(float).collect::<Vec<_>>()
    });
    normals.chunks(3).map(|m| [m[0], m[1], m[2]]).zip(pdf).collect()
}

#[test]
fn normals_of_d_need_no_view() {
    let desk = Desk::new(&[]);
    desk.ok("sample --sigma 0.3,0.1 --gamma 3 --ndf --count 1e4 --out n");
    let all = normals(&desk.read("n"));
    let slopes = |axis: usize| all.iter().map(|(m, _)| (m[axis] / m[2]).powi(2)).sum::<f64>() / 1e4;
    // For gamma = 3 the mean square slope is sigma^2.
    let ratio = slopes(0) / slopes(1);
    assert!((ratio / 9.0 - 1.0).abs() < 0.2, "{ratio}");
}

/// Written in pieces, but the same file that the library writes as a whole.
#[test]
fn normals_are_written_as_the_library_would() {
    let desk = Desk::new(&[]);
    for count in [1, 7, 12345] {
        for method in
            ["--theta 1", "--theta 1 --method exact", "--theta 1 --method pseudo", "--ndf"]
        {
            desk.ok(&format!("sample --sigma 0.3 --gamma 3 {method} --count {count} -o n"));
            let bytes = desk.read("n");
            let read = SafeTensors::deserialize(&bytes).unwrap();
            let view = |name, shape: Vec<usize>| {
                (
                    name,
                    TensorView::new(Dtype::F32, shape, read.tensor(name).unwrap().data()).unwrap(),
                )
            };
            let whole = [view("normals", vec![count, 3]), view("pdf", vec![count])];
            assert_eq!(bytes, safetensors::serialize(whole, None).unwrap());
            assert!(normals(&bytes).iter().all(|(_, pdf)| *pdf > 0.0));
        }
    }
    // A density belongs to its normal: the second drawing is that of the first.
    desk.ok("sample --sigma 0.3 --gamma 2 --ndf --count 100 -o n");
    for ([_, _, z], pdf) in normals(&desk.read("n")) {
        // GGX: D cos = alpha^2 cos / (pi (cos^2 (alpha^2 - 1) + 1)^2).
        let a = 0.09;
        let d = a * z / (std::f64::consts::PI * (z * z * (a - 1.0) + 1.0).powi(2));
        assert!((pdf / d - 1.0).abs() < 1e-4, "{pdf} {d}");
    }
}

#[cfg(unix)]
fn shell(desk: &Desk, script: &str) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", script, PROGRAM]).current_dir(desk.path());
    shell.env("XDG_CACHE_HOME", desk.join("home")).output().unwrap()
}

#[cfg(unix)]
#[test]
fn many_normals_take_little_memory_and_a_reader_may_leave() {
    let desk = Desk::new(&[]);
    let draw = "\"$0\" --threads 1 sample --sigma 0.3 --gamma 2 --ndf";
    // More bytes than memory; and of a billion normals, 16 GB, the first come at once.
    let limit = "ulimit -v 131072;";
    let output = shell(&desk, &format!("{limit} {draw} --count 1e7 --out - | wc -c"));
    let message = String::from_utf8(output.stderr).unwrap();
    let bytes: u64 = String::from_utf8(output.stdout).unwrap().trim().parse().unwrap();
    assert!((160_000_000..160_001_000).contains(&bytes), "{bytes}: {message}");
    has(&message, &["10000000 normals on standard output"]);
    let output =
        shell(&desk, &format!("{limit} ({draw} --count 1e9 --out -; echo $? >rc) | head -c 99"));
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.stdout.len(), &desk.read("rc")[..]), (99, &b"0\n"[..]));
    has(&message, &["left before all 1000000000 normals"]);
    lacks(&message, &["normals on standard output"]);
}

#[test]
fn a_figure_is_written_in_the_format_of_its_name() {
    let desk = Desk::new(&[]);
    for name in ["a.svg", "a.png", "b.PNG"] {
        desk.ok(&format!("plot student-t --out {name}"));
    }
    let (svg, png) = (String::from_utf8(desk.read("a.svg")).unwrap(), desk.read("a.png"));
    assert_eq!(png, desk.read("b.PNG"));
    assert!(png.starts_with(b"\x89PNG") && svg.starts_with("<svg"));
    let image = png::Decoder::new(Cursor::new(&png)).read_info().unwrap();
    let (width, height) = image.info().size();
    has(&svg, &[&format!("viewBox=\"0 0 {} {}\"", width / 2, height / 2)]);
    assert_eq!(fs::read_dir(desk.path()).unwrap().count(), 3);
}

#[test]
fn errors_about_files_say_which_and_why() {
    let desk = Desk::new(&[("r.toml", &material("m", "sigma = 0.3\ngamma = 3.0"))]);
    for line in [&format!("sample {ONE} --count 9 --out"), "plot student-t --out"] {
        let why = "nowhere/x.svg: the folder nowhere does not exist";
        lacks(&desk.refuses(&format!("{line} nowhere/x.svg"), &[why]), &["partial"]);
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("circle.svg", desk.join("circle.svg")).unwrap();
        symlink("gone", desk.join("dangling")).unwrap();
        for line in ["plot student-t --out", "bake --out"] {
            let parts = ["circle.svg: is a", "link", "; name a "];
            desk.refuses(&format!("{line} circle.svg"), &parts);
        }
        desk.refuses("bake --out dangling", &["dangling: is a link to gone, which does not exist"]);
        for (cache, why) in [
            ("/dev/null", "/dev/null: is a character device; name a folder"),
            ("circle.svg", "circle.svg: is a link that leads nowhere"),
            ("r.toml", "r.toml: is a file; name a folder"),
        ] {
            let line = format!("bake r.toml --quality draft --out out --cache {cache}");
            has(&desk.run(&line).ends(0).err, &[why]);
        }
    }
}

/// A draft of one material's set, albedos included, in a folder whose name needs quotes.
fn one_material() -> Desk {
    let desk = Desk::new(&[("r.toml", &material("m", "sigma = 0.454\ngamma = 2.7"))]);
    let bake = ["bake", "r.toml", "--quality", "draft", "--albedo", "--out", "it's mine"];
    ok(desk.path(), &bake);
    desk
}

#[cfg(unix)]
#[test]
fn the_queries_of_a_stress_run_read_the_same_set_when_pasted() {
    let desk = one_material();
    let at = desk.path();
    let report = ["validate", "it's mine", "--stress", "--points", "1"];
    let found = json(at, &report);
    let query = found["regions"][0]["errors"][0]["query"].as_str().unwrap();
    let text = ok(at, &report);
    let printed = text.lines().find_map(|line| line.strip_prefix("  g1 abs ")).unwrap();
    for query in [query, printed.split_once(": ").unwrap().1] {
        let pasted = query.replace("microfacet-bake", "\"$0\"");
        let output = shell(&desk, &pasted);
        assert_eq!(output.status.code(), Some(0), "{query}: {output:?}");
        // The default set would serve the shape as well, so that its absence shows nothing.
        fs::rename(at.join("it's mine"), at.join("elsewhere")).unwrap();
        assert_eq!(shell(&desk, &pasted).status.code(), Some(2), "{query}");
        fs::rename(at.join("elsewhere"), at.join("it's mine")).unwrap();
    }
    // So does the configuration that a validation names.
    let text = ok(at, &["validate", "it's mine", "--samples", "1e4", "--configurations", "2"]);
    let line = text.lines().find_map(|line| line.split_once("microfacet-bake ")).unwrap().1;
    let output = shell(&desk, &format!("\"$0\" {line}"));
    assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
}

#[test]
fn a_furnace_runs_what_the_set_covers() {
    let desk = one_material();
    let at = desk.path();
    // Draft tables may be off by more than the furnace allows.
    let rows = |args: &[&str]| {
        let output = run(at, &[&["furnace", "it's mine", "--json"], args].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect(&message);
        let pair = |row: &serde_json::Value| {
            (row["sigma"].as_f64().unwrap(), row["gamma"].as_str().unwrap().to_owned())
        };
        (found["rows"].as_array().unwrap().iter().map(pair).collect::<Vec<_>>(), message)
    };
    let material = (0.454, "2.7".to_owned());
    let (found, note) = rows(&[]);
    assert_eq!(found, [&material; 3].map(Clone::clone), "three cosines");
    has(&note, &["cover", "--sigma and --gamma"]);
    for named in ["--sigma 0.454", "--gamma 2.7"] {
        let (found, _) = rows(&words(&format!("{named} --cos-theta 1")));
        assert_eq!(found, std::slice::from_ref(&material), "{named}");
    }
    for named in ["--gamma 3", "--sigma 0.3", "--gamma 2.7,4"] {
        let message = refused(at, &[&["furnace", "it's mine"], &words(named)[..]].concat());
        has(&message, &["it holds is gamma 2.7 with sigma 0.454"]);
    }
    let average = ok(at, &["furnace", "it's mine", "--average"]);
    has(&average, &["sigma = 0.454 |", "| 2.7 |"]);
    // The default set covers the whole grid, and needs no note.
    let said = desk.run("furnace --average");
    assert_eq!((&said.err[..], said.out.lines().count()), ("", 2 + 8), "{}", said.out);
    let head = "| gamma | sigma = 0.01 | sigma = 0.1 | sigma = 0.3 | sigma = 0.6 |";
    assert!(said.out.starts_with(head), "{}", said.out);
    // A set without albedos.
    desk.write("r.toml", self::material("m", "sigma = 0.3\ngamma = 3.0"));
    desk.ok("bake r.toml --quality draft --out bare");
    desk.refuses("furnace bare", &["no albedo tables"]);
}

#[test]
fn a_furnace_names_the_rows_that_do_not_close() {
    let desk = Desk::new(&[]);
    let whole = Tables::embedded();
    let mut tables = whole.tables().to_vec();
    tables.retain(|table| table.kind == Kind::Albedo);
    for value in tables.iter_mut().flat_map(|table| &mut table.values) {
        *value *= 0.98;
    }
    let damaged = Tables::from_tables(whole.provenance().clone(), tables).unwrap();
    store::write(&desk.join("damaged"), &damaged, store::Format::Safetensors).unwrap();
    let line = "furnace damaged --gamma 1.6 --sigma 1e-8,2 --cos-theta 0.3";
    let text = desk.run(line).ends(1).out;
    let (_, failed) = text.split_once("The furnace does not close:\n").expect(&text);
    let why = "  gamma 1.6, sigma 2, cos_theta 0.3: Kulla-Conty is 1 ";
    has(failed, &[why, "1 +- 2e-3 is allowed"]);
    let found: serde_json::Value =
        serde_json::from_str(&desk.run(&format!("{line} --json")).out).unwrap();
    assert_eq!(found["passed"], false);
    assert_eq!(found["rows"][1]["deviations"].as_array().unwrap().len(), 1, "{found}");
    // A walk needs no table, and says by how much one bounce is off.
    let sound = desk.ok("furnace --gamma 3 --sigma 1 --cos-theta 1 --walks 1e4");
    assert!(sound.ends_with("The furnace closes.\n"), "{sound}");
    has(&sound, &["walk, 1 bounce"]);
}
