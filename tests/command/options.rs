//! One vocabulary of options, and refusals that name the value, the range and the way out.

use std::fs;
use std::path::Path;
use std::process::Command;

use microfacet_baker::store;
use microfacet_sampler::Tables;
use microfacet_tables::Kind;
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};

use crate::common::{json, ok, refused, run};

/// Words of a command line without quotes.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

#[track_caller]
fn refuses(at: &Path, line: &str, parts: &[&str]) {
    let message = refused(at, &words(line));
    for part in parts {
        assert!(message.contains(part), "{line}: no \"{part}\" in: {message}");
    }
}

const ONE: &str = "--sigma 0.3 --gamma 3 --theta 1";

#[test]
fn what_was_renamed_is_refused_by_its_old_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &words("plot student-t --out a.svg"));
    ok(at, &words("plot student-t -o b.svg"));
    assert_eq!(fs::read(at.join("a.svg")).unwrap(), fs::read(at.join("b.svg")).unwrap());
    refuses(at, "plot student-t --output c.svg", &["--output"]);
    refuses(at, "furnace --method walk", &["--method"]);
    refuses(at, &format!("sample {ONE} --count 9 --out n --method ndf"), &["'ndf'", "exact"]);
    ok(at, &words(&format!("sample {ONE} --count 9 -o n")));
}

#[test]
fn other_names_of_sigma_are_told_their_relation() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["validate", "sample", "furnace"] {
        for (option, relation) in [
            ("--alpha 0.3", "alpha of GGX"),
            ("--roughness=0.3", "square root of sigma"),
            ("--m 0.3", "m of Beckmann"),
            ("-m 0.3", "m of Beckmann"),
        ] {
            let line = format!("{command} {option} --gamma 3");
            // A letter is shown as one, with however many dashes it came.
            let name = option.split([' ', '=']).next().unwrap().replace("--m", "-m");
            refuses(folder.path(), &line, &[&name, "did you mean --sigma?", relation]);
        }
        assert!(!ok(folder.path(), &[command, "--help"]).contains("--alpha"));
    }
}

#[test]
fn parameters_of_a_material_are_told_where_they_belong() {
    let folder = tempfile::tempdir().unwrap();
    for option in ["sigma", "gamma", "alpha", "roughness", "theta", "fresnel"] {
        for command in ["bake p.pbrt --out out", "plan p.pbrt"] {
            let named = format!("unexpected argument '--{option} <X>'");
            let line = format!("{command} --{option} 2.5");
            refuses(folder.path(), &line, &[&named, "`microfacet-bake recipe`"]);
        }
    }
}

/// Each of these was once ignored in silence.
#[test]
fn options_that_mean_nothing_together_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (line, part) in [
        ("validate --phi 1", "--sigma"),
        ("validate --theta 1", "--sigma"),
        ("validate --degrees", "--theta"),
        ("validate --points 3", "--stress"),
        ("validate --configurations 3 --sigma 1 --gamma 3 --theta 1", "--configurations"),
        ("validate --stress --samples 3000", "--samples"),
        ("validate --stress --configurations 3", "--configurations"),
        ("validate --stress --phi 1", "--phi"),
        ("validate --stress --degrees", "--degrees"),
        ("furnace --seed 3", "--walks"),
        ("furnace --average --seed 3", "--seed"),
        ("furnace --average --walks 1e5", "--walks"),
        ("furnace --average --json", "--json"),
        ("furnace --average --cos-theta 1", "--cos-theta"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n", "--ndf"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n --ndf --theta 1", "--theta"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n --ndf --phi 1", "--phi"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n --ndf --degrees", "--degrees"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n --ndf --method table", "--method"),
        ("sample --sigma 1 --gamma 3 --count 9 --out n --ndf --tables t", "--tables"),
        (
            "sample --sigma 1 --gamma 3 --theta 1 --count 9 --out n --method exact --tables t",
            "drop",
        ),
        ("bake --out out --patient", "--max-error"),
        ("bake --out out --patient --quality draft", "--max-error"),
        ("bake --out out --max-error 1e-3 --max-bytes 1e6", "--max-bytes"),
        ("bake --out out --embedded", "<SCENE>"),
        ("bake --out out --albedo", "<SCENE>"),
        ("bake --out out --tabulate-ggx", "<SCENE>"),
        ("convert --from beckmann:0.3 --to gtr --by rmse --shape 2", "half-angle"),
        ("convert --from beckmann:0.3 --to gtr --by half-angle --shape 2 --on density", "rmse"),
        ("convert --from beckmann:0.3 --to gauss --shape 2", "one"),
    ] {
        refuses(folder.path(), line, &[part]);
    }
    assert!(fs::read_dir(folder.path()).unwrap().next().is_none(), "something was written");
}

#[test]
fn angles_may_be_in_degrees_and_are_doubted_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let draw = |name: &str, angles: &str| {
        let line = format!("sample --sigma 0.3 --gamma 3 --count 100 --out {name} {angles}");
        let output = run(at, &words(&line));
        assert_eq!(output.status.code(), Some(0));
        (fs::read(at.join(name)).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let radians = draw("r", "--theta 1.0471975511965976 --phi 1.5707963267948966");
    assert_eq!(draw("d", "--theta 60 --phi 90 --degrees"), radians);
    assert_eq!(radians.1, "");
    let (_, doubt) = draw("p", "--theta 1 --phi 360");
    assert!(doubt.contains("warning: phi = 360") && doubt.contains("--degrees"), "{doubt}");
    let one = "validate --sigma 0.3 --gamma 3 --samples 1e4";
    ok(at, &words(&format!("{one} --theta 60 --phi 360 --degrees")));
    let output = run(at, &words(&format!("{one} --theta 1 --phi 360")));
    assert!(String::from_utf8(output.stderr).unwrap().contains("57.3 turns"));
    refuses(at, &format!("{one} --theta 60"), &["[0, pi/2 = 1.5708]", "--degrees"]);
    refuses(at, &format!("{one} --theta 91 --degrees"), &["91", "[0, 90] degrees"]);
}

#[test]
fn normals_of_d_need_no_view() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &words("sample --sigma 0.3,0.1 --gamma 3 --ndf --count 1e4 --out n"));
    let bytes = fs::read(at.join("n")).unwrap();
    let normals =
        SafeTensors::deserialize(&bytes).unwrap().tensor("normals").unwrap().data().to_vec();
    let float = |at: &[u8]| f32::from_le_bytes(at.try_into().unwrap());
    let slopes = |axis: usize| {
        let squares = normals.chunks(12).map(|m| {
            let (along, up) = (float(&m[4 * axis..][..4]), float(&m[8..12]));
            f64::from(along / up).powi(2)
        });
        squares.sum::<f64>() / 1e4
    };
    // For gamma = 3 the mean square slope is sigma^2.
    let ratio = slopes(0) / slopes(1);
    assert!((ratio / 9.0 - 1.0).abs() < 0.2, "{ratio}");
}

/// Written in pieces, but the same file that the library writes as a whole.
#[test]
fn normals_are_written_as_the_library_would() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for count in [1, 7, 12345] {
        for method in ["--theta 1", "--theta 1 --method exact", "--ndf"] {
            ok(at, &words(&format!("sample --sigma 0.3 --gamma 3 {method} --count {count} -o n")));
            let bytes = fs::read(at.join("n")).unwrap();
            let read = SafeTensors::deserialize(&bytes).unwrap();
            let [normals, pdf] = ["normals", "pdf"].map(|name| read.tensor(name).unwrap());
            let float = |at: &[u8]| f32::from_le_bytes(at.try_into().unwrap());
            assert!(pdf.data().chunks(4).all(|pdf| float(pdf) > 0.0));
            let view = |shape: Vec<usize>, data| TensorView::new(Dtype::F32, shape, data).unwrap();
            let whole = safetensors::serialize(
                [
                    ("normals", view(vec![count, 3], normals.data())),
                    ("pdf", view(vec![count], pdf.data())),
                ],
                None,
            );
            assert_eq!(bytes, whole.unwrap());
        }
    }
    // A density belongs to its normal: the second drawing is that of the first.
    ok(at, &words("sample --sigma 0.3 --gamma 2 --ndf --count 100 -o n"));
    let bytes = fs::read(at.join("n")).unwrap();
    let read = SafeTensors::deserialize(&bytes).unwrap();
    let [normals, pdf] = ["normals", "pdf"].map(|name| read.tensor(name).unwrap());
    let float = |at: &[u8]| f64::from(f32::from_le_bytes(at.try_into().unwrap()));
    for (m, pdf) in normals.data().chunks(12).zip(pdf.data().chunks(4)) {
        // GGX: D cos = alpha^2 cos / (pi (cos^2 (alpha^2 - 1) + 1)^2).
        let (z, a) = (float(&m[8..12]), 0.09);
        let d = a * z / (std::f64::consts::PI * (z * z * (a - 1.0) + 1.0).powi(2));
        assert!((float(pdf) / d - 1.0).abs() < 1e-4, "{} {d}", float(pdf));
    }
}

#[cfg(unix)]
fn shell(at: &Path, script: &str) -> std::process::Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_microfacet-bake")]).current_dir(at);
    shell.env("XDG_CACHE_HOME", at.join("home")).output().unwrap()
}

#[cfg(unix)]
#[test]
fn many_normals_take_little_memory_and_a_reader_may_leave() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let draw = "\"$0\" --threads 1 sample --sigma 0.3 --gamma 2 --ndf";
    // More bytes than memory; and of a billion normals, 16 GB, the first come at once.
    let limit = "ulimit -v 131072;";
    let output = shell(at, &format!("{limit} {draw} --count 1e7 --out - | wc -c"));
    let message = String::from_utf8(output.stderr).unwrap();
    let bytes: u64 = String::from_utf8(output.stdout).unwrap().trim().parse().unwrap();
    assert!((160_000_000..160_001_000).contains(&bytes), "{bytes}: {message}");
    assert!(message.contains("10000000 normals on standard output"), "{message}");
    let output =
        shell(at, &format!("{limit} ({draw} --count 1e9 --out -; echo $? >rc) | head -c 99"));
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        (output.stdout.len(), fs::read_to_string(at.join("rc")).unwrap()),
        (99, "0\n".into())
    );
    assert!(message.contains("left before all 1000000000 normals"), "{message}");
    assert!(!message.contains("normals on standard output"), "{message}");
}

#[test]
fn a_figure_is_written_in_the_format_of_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &words("plot student-t --out a.svg"));
    ok(at, &words("plot student-t --out a.png"));
    ok(at, &words("plot student-t --out b.PNG"));
    let svg = fs::read_to_string(at.join("a.svg")).unwrap();
    let png = fs::read(at.join("a.png")).unwrap();
    assert_eq!(png, fs::read(at.join("b.PNG")).unwrap());
    assert!(png.starts_with(b"\x89PNG"));
    let image = image::load_from_memory(&png).unwrap();
    let size = format!("width=\"{}\" height=\"{}\"", image.width() / 2, image.height() / 2);
    assert!(svg.starts_with("<svg") && svg.contains(&size), "{size}");
    for name in ["a.pdf", "a", ".svg", "a.svg.gz"] {
        refuses(at, &format!("plot student-t --out {name}"), &[name, ".svg or .png", "`--out -`"]);
    }
    assert_eq!(fs::read_dir(at).unwrap().count(), 3);
}

#[test]
fn errors_about_files_say_which_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for line in [&format!("sample {ONE} --count 9 --out"), "plot student-t --out"] {
        refuses(
            at,
            &format!("{line} nowhere/x.svg"),
            &["nowhere/x.svg: the folder nowhere does not exist"],
        );
        assert!(!refused(at, &words(&format!("{line} nowhere/x.svg"))).contains("partial"));
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("circle.svg", at.join("circle.svg")).unwrap();
        symlink("gone", at.join("dangling")).unwrap();
        for line in ["plot student-t --out", "bake --out"] {
            refuses(at, &format!("{line} circle.svg"), &["circle.svg: is a", "link", "; name a "]);
        }
        refuses(at, "bake --out dangling", &["dangling: is a link to gone, which does not exist"]);
        let recipe = "[[material]]\nname = \"m\"\nsigma = 0.3\ngamma = 3.0\n";
        fs::write(at.join("r.toml"), recipe).unwrap();
        let bake = "bake r.toml --quality draft --out out --cache";
        for (cache, why) in [
            ("/dev/null", "/dev/null: is a character device; name a folder"),
            ("circle.svg", "circle.svg: is a link that leads nowhere"),
            ("r.toml", "r.toml: is a file; name a folder"),
        ] {
            let output = run(at, &words(&format!("{bake} {cache}")));
            let message = String::from_utf8(output.stderr).unwrap();
            assert!(output.status.success() && message.contains(why), "{message}");
        }
    }
}

#[test]
fn a_factor_on_gamma_has_a_range() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for factor in ["0", "-1", "1e308", "inf", "nan", "0.49", "2.01"] {
        refuses(at, &format!("validate --perturb-gamma {factor}"), &[factor, "[0.5, 2]"]);
    }
    let one = "validate --sigma 0.3 --gamma 1.6 --theta 0 --samples 1e4 --perturb-gamma";
    refuses(at, &format!("{one} 0.9"), &["--perturb-gamma 0.9", "gamma 1.6 of", "above 0.9375"]);
    assert_ne!(run(at, &words(&format!("{one} 0.94"))).status.code(), Some(2));
}

/// A draft of one material's set, albedos included, in a folder whose name needs quotes.
fn one_material() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let recipe = "[[material]]\nname = \"m\"\nsigma = 0.454\ngamma = 2.7\n";
    fs::write(folder.path().join("r.toml"), recipe).unwrap();
    ok(folder.path(), &["bake", "r.toml", "--quality", "draft", "--albedo", "--out", "it's mine"]);
    folder
}

#[cfg(unix)]
#[test]
fn the_queries_of_a_stress_run_read_the_same_set_when_pasted() {
    let folder = one_material();
    let at = folder.path();
    let report = ["validate", "it's mine", "--stress", "--points", "1"];
    let found = json(at, &report);
    let query = found["regions"][0]["errors"][0]["query"].as_str().unwrap();
    let text = ok(at, &report);
    let printed = text.lines().find_map(|line| line.strip_prefix("  g1 abs ")).unwrap();
    for query in [query, printed.split_once(": ").unwrap().1] {
        let pasted = query.replace("microfacet-bake", "\"$0\"");
        let output = shell(at, &pasted);
        assert_eq!(output.status.code(), Some(0), "{query}: {output:?}");
        // The default set would serve the shape as well, so that its absence shows nothing.
        fs::rename(at.join("it's mine"), at.join("elsewhere")).unwrap();
        assert_eq!(shell(at, &pasted).status.code(), Some(2), "{query}");
        fs::rename(at.join("elsewhere"), at.join("it's mine")).unwrap();
    }
    // So does the configuration that a validation names.
    let text = ok(at, &["validate", "it's mine", "--samples", "1e4", "--configurations", "2"]);
    let line = text.lines().find_map(|line| line.split_once("microfacet-bake ")).unwrap().1;
    let output = shell(at, &format!("\"$0\" {line}"));
    assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
}

#[test]
fn a_furnace_runs_what_the_set_covers() {
    let folder = one_material();
    let at = folder.path();
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
    assert!(note.contains("cover") && note.contains("--sigma and --gamma"), "{note}");
    for named in [["--sigma", "0.454"], ["--gamma", "2.7"]] {
        let (found, _) = rows(&[&named[..], &["--cos-theta", "1"]].concat());
        assert_eq!(found, std::slice::from_ref(&material), "{named:?}");
    }
    for named in [&["--gamma", "3"][..], &["--sigma", "0.3"], &["--gamma", "2.7,4"]] {
        let message = refused(at, &[&["furnace", "it's mine"], named].concat());
        assert!(message.contains("hold gamma 2.7 with sigma 0.454"), "{message}");
    }
    let average = ok(at, &["furnace", "it's mine", "--average"]);
    assert!(average.contains("sigma = 0.454 |") && average.contains("| 2.7 |"), "{average}");
    // The default set covers the whole grid, and needs no note.
    let output = run(at, &["furnace", "--average"]);
    assert!(output.stderr.is_empty());
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 2 + 8, "{text}");
    assert!(text.starts_with("| gamma | sigma = 0.01 | sigma = 0.1 | sigma = 0.3 | sigma = 0.6 |"));
    // A set without albedos.
    fs::write(at.join("r.toml"), "[[material]]\nname = \"m\"\nsigma = 0.3\ngamma = 3.0\n").unwrap();
    ok(at, &["bake", "r.toml", "--quality", "draft", "--out", "bare"]);
    assert!(refused(at, &["furnace", "bare"]).contains("no albedo tables"));
}

#[test]
fn a_furnace_names_the_rows_that_do_not_close() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let whole = Tables::embedded();
    let mut tables = whole.tables().to_vec();
    tables.retain(|table| table.kind == Kind::Albedo);
    for value in tables.iter_mut().flat_map(|table| &mut table.values) {
        *value *= 0.98;
    }
    let damaged = Tables::from_tables(whole.provenance().clone(), tables).unwrap();
    store::write(&at.join("damaged"), &damaged, store::Format::Safetensors).unwrap();
    let line = "furnace damaged --gamma 1.6 --sigma 1e-8,2 --cos-theta 0.3";
    let output = run(at, &words(line));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    let (_, failed) = text.split_once("The furnace does not close:\n").expect(&text);
    assert!(failed.contains("  gamma 1.6, sigma 2, cos_theta 0.3: Kulla-Conty is 1 "), "{failed}");
    assert!(failed.contains("1 +- 2e-3 is allowed"), "{failed}");
    let output = run(at, &[&words(line)[..], &["--json"]].concat());
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["passed"], false);
    assert_eq!(found["rows"][1]["deviations"].as_array().unwrap().len(), 1, "{found}");
    // A walk needs no table, and says by how much one bounce is off.
    let sound = ok(at, &words("furnace --gamma 3 --sigma 1 --cos-theta 1 --walks 1e4"));
    assert!(
        sound.contains("walk, 1 bounce") && sound.ends_with("The furnace closes.\n"),
        "{sound}"
    );
}
