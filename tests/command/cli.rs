//! The command end to end, from an empty folder.

use microfacet_baker::store;
use microfacet_sampler::{Lobe, Tables};
use microfacet_tables::{Kind, Quantity};

use crate::common::{ok, refused, run};

const GLASS: &str = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";

#[test]
fn from_a_recipe_to_normals() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("glass.toml"), GLASS).unwrap();
    let summary = ok(at, &["bake", "glass.toml", "--out", "out"]);
    assert!(summary.contains("G1 ") && summary.contains("in visible_slope_gamma_3\n"), "{summary}");

    // The file holds its material, and the certificate holds what the quality promises.
    let set = store::read(&at.join("out")).unwrap();
    let Lobe::StudentT(glass) = set.material("glass").unwrap() else { panic!("not from tables") };
    assert_eq!((glass.sigma(), glass.gamma()), ([0.454, 0.454], 3.0));
    assert!(
        set.table(Kind::VisibleSlope).unwrap().certificate.error(Quantity::Cdf).unwrap() < 1e-4
    );
    let error = set.student_t(0.3, 4.0).unwrap_err().to_string();
    assert!(error.contains("gamma = 3"), "{error}");

    let shown = ok(at, &["inspect", "out"]);
    assert!(
        shown.contains("gamma 3") && shown.contains("CC0-1.0") && shown.contains("glass"),
        "{shown}"
    );
    let json: serde_json::Value =
        serde_json::from_str(&ok(at, &["inspect", "out", "--json"])).unwrap();
    assert_eq!(json["format"], "microfacet-tables");

    ok(
        at,
        &[
            "sample",
            "--sigma",
            "0.454",
            "--gamma",
            "3",
            "--theta",
            "1",
            "--count",
            "1000",
            "--out",
            "n.safetensors",
        ],
    );
    let bytes = std::fs::read(at.join("n.safetensors")).unwrap();
    let tensors = safetensors::SafeTensors::deserialize(&bytes).unwrap();
    assert_eq!(tensors.tensor("normals").unwrap().shape(), [1000, 3]);
    assert_eq!(tensors.tensor("pdf").unwrap().shape(), [1000]);

    let verdict = ok(at, &["validate", "out", "--configurations", "4", "--samples", "20000"]);
    assert!(verdict.ends_with("PASSED\n"), "{verdict}");
}

#[test]
fn query_passes_columns_through_and_agrees_with_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let points = "id,sigma_x,sigma_y,gamma,theta,phi,u1,u2\na,0.3,0.3,3,1.2,0,0.2,0.7\nb,0.3,0.1,inf,1.5,2,0.9,0.1\n";
    std::fs::write(folder.path().join("points.csv"), points).unwrap();
    let table = ok(folder.path(), &["query", "g1", "--input", "points.csv"]);
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(rows.headers().unwrap().iter().next_back(), Some("g1_exact"));
    for row in rows.records() {
        let row = row.unwrap();
        assert!(["a", "b"].contains(&&row[0]));
        let [lambda, g1, exact_lambda, exact_g1] =
            [8, 9, 10, 11].map(|i| row[i].parse::<f64>().unwrap());
        assert!(
            (g1 - exact_g1).abs() < 5e-6
                && (lambda - exact_lambda).abs() < 1e-5 * (1.0 + exact_lambda).powi(2)
        );
    }
    let normals =
        ok(folder.path(), &["query", "normal", "--input", "points.csv", "--method", "exact"]);
    assert!(
        normals.lines().next().unwrap().ends_with("u2,m_x_exact,m_y_exact,m_z_exact,pdf_exact"),
        "{normals}"
    );
}

/// What a query says beside its rows.
#[test]
fn query_says_what_can_be_compared_and_what_is_covered() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let rows = |gamma: f64| {
        let header = "sigma_x,sigma_y,gamma,theta,phi,u1,u2\n";
        std::fs::write(at.join("p.csv"), format!("{header}0.5,0.5,{gamma},0.6,0,0.8,0.5\n"))
    };
    let query = ["query", "normal", "--input", "p.csv"];
    let notes = |args: &[&str]| String::from_utf8(run(at, args).stderr).unwrap();
    rows(1.6).unwrap();
    assert!(notes(&query).contains("different normals"), "{}", notes(&query));
    assert_eq!(notes(&[&query[..], &["--method", "table"]].concat()), "");
    rows(1.9).unwrap();
    assert_eq!(notes(&query), "");

    // The exact value is 0.34.
    let text = "sigma,gamma,cos_theta,masking\n1e-9,1.501,1e-7,height-correlated\n";
    std::fs::write(at.join("a.csv"), text).unwrap();
    let message = refused(at, &["query", "albedo", "--input", "a.csv"]);
    assert!(message.contains("[1e-8, 3] and 0, a mirror"), "{message}");
    let exact = ok(at, &["query", "albedo", "--input", "a.csv", "--method", "exact"]);
    assert!(exact.contains("height-correlated,0.33") || exact.contains("height-correlated,0.34"));

    // −0 is the horizon, and no line is filled with zeros.
    let text = "sigma,gamma,cos_theta,masking\n0.3,3,-0,height-correlated\n";
    std::fs::write(at.join("a.csv"), text).unwrap();
    let [zero, negative] = ["0", "-0"].map(|cos| {
        std::fs::write(at.join("a.csv"), text.replace("-0", cos)).unwrap();
        ok(at, &["query", "albedo", "--input", "a.csv"]).replace("3,-0,", "3,0,")
    });
    assert_eq!(zero, negative);
    let text = "sigma_x,sigma_y,gamma,theta,phi,u1,u2\n0.5,0.5,1.501,0.6,0,0.999,0.5\n";
    std::fs::write(at.join("p.csv"), text).unwrap();
    let row = ok(at, &["query", "normal", "--input", "p.csv", "--method", "exact"]);
    assert!(row.contains(",1e-300,"), "{row}");

    // π/2 as people type it, in every command.
    for theta in ["1.5708", "1.6"] {
        let text = format!("sigma_x,sigma_y,gamma,theta,phi\n0.3,0.3,3,{theta},0\n");
        std::fs::write(at.join("g.csv"), text).unwrap();
        let output = run(at, &["query", "g1", "--input", "g.csv"]);
        assert_eq!(output.status.success(), theta == "1.5708");
        let sample = ["sample", "--sigma", "0.3", "--gamma", "3", "--theta", theta, "--count", "9"];
        let output = run(at, &[&sample[..], &["--out", "n.safetensors"]].concat());
        assert_eq!(output.status.success(), theta == "1.5708");
    }
    // One range of sigma.
    for sigma in ["9e-9", "1e7", "-1"] {
        let one = ["--sigma", sigma, "--gamma", "3", "--theta", "0"];
        for command in [&["validate"][..], &["sample", "--count", "9", "--out", "n"]] {
            let message = refused(at, &[command, &one[..]].concat());
            assert!(message.contains("[1e-8, 1e6]"), "{message}");
        }
    }
}

#[test]
fn query_answers_in_order_up_to_a_row_that_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let row = |i: usize| format!("{i},0.{},3,{}", 1 + i % 9, if i == 700 { "1.5" } else { "0.5" });
    let rows: Vec<String> = (0..800).map(row).collect();
    let table = format!(
        "id,sigma,gamma,cos_theta,masking\n{},uncorrelated\n",
        rows.join(",uncorrelated\n")
    );
    std::fs::write(folder.path().join("views.csv"), table).unwrap();
    let query = ["query", "albedo", "--input", "views.csv", "--method", "table"];
    let output = run(folder.path(), &query);
    let (text, message) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(2));
    // The header is line 1.
    assert!(message.contains("line 702") && message.contains("1.5"), "{message}");
    let ids: Vec<usize> =
        text.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(ids, (0..700).collect::<Vec<_>>());
}

#[test]
fn validation_rejects_a_wrong_gamma() {
    let folder = tempfile::tempdir().unwrap();
    let one = [
        "validate",
        "--sigma",
        "0.5,0.2",
        "--gamma",
        "1.65",
        "--theta",
        "1.1",
        "--phi",
        "-2",
        "--samples",
        "300000",
    ];
    ok(folder.path(), &one);
    let output = run(folder.path(), &[&one[..], &["--perturb-gamma", "1.01"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).ends_with("REJECTED\n"));
}

#[test]
fn bad_input_is_named_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let recipe = |text: &str| std::fs::write(at.join("r.toml"), text).unwrap();
    let cases = [
        (GLASS.replace("3.0", "1.5"), "1.5"),
        (GLASS.replace("3.0", "nan"), "nan"),
        (GLASS.replace("3.0", "1.5005"), "1.501"),
        (GLASS.replace("0.454", "-0.1"), "-0.1"),
        (GLASS.replace("sigma", "sgima"), "sigma"),
        (String::new(), "material"),
        ("[[material\n".into(), "r.toml:1"),
    ];
    for (text, hint) in cases {
        recipe(&text);
        let message = refused(at, &["bake", "r.toml", "--out", "out"]);
        assert!(message.to_lowercase().contains(hint), "{text}: {message}");
        assert!(!at.join("out/tables.safetensors").exists());
    }
    recipe(GLASS);
    std::fs::write(at.join("file"), "x").unwrap();
    assert!(refused(at, &["bake", "r.toml", "--out", "file"]).contains("is a file"));
    assert!(refused(at, &["bake", "absent.toml", "--out", "out"]).contains("absent.toml"));
    assert!(refused(at, &["inspect", "file"]).contains("not a valid table set"));
    // A value may begin like an option.
    for (args, value) in [
        (["furnace", "--sigma", "-1"], "\"-1\""),
        (["furnace", "--cos-theta", "-0.5"], "\"-0.5\""),
        (["validate", "--samples", "-5"], "'-5'"),
    ] {
        let message = refused(at, &args);
        assert!(message.contains(value) && !message.contains("unexpected"), "{message}");
    }
    assert!(refused(at, &["inspect", "absent"]).contains("absent"));
    std::fs::write(at.join("p.csv"), "sigma_x,sigma_y,gamma,theta\n1,1,1,1\n").unwrap();
    assert!(refused(at, &["query", "g1", "--input", "p.csv"]).contains("phi"));
    assert!(
        refused(
            at,
            &[
                "sample", "--sigma", "0", "--gamma", "2", "--theta", "1", "--count", "1", "--out",
                "n"
            ]
        )
        .contains("sigma")
    );
}

#[test]
fn a_failed_bake_leaves_the_old_set() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("r.toml"), GLASS).unwrap();
    ok(folder.path(), &["bake", "r.toml", "--out", "out"]);
    let before = std::fs::read(folder.path().join("out/tables.safetensors")).unwrap();
    std::fs::write(folder.path().join("r.toml"), GLASS.replace("3.0", "1.2")).unwrap();
    refused(folder.path(), &["bake", "r.toml", "--out", "out"]);
    assert_eq!(std::fs::read(folder.path().join("out/tables.safetensors")).unwrap(), before);
    Tables::from_bytes(&before).unwrap();
}

/// Characters that command a terminal, or turn the direction of writing, as a file may hold them.
const ODD: &str = "a\u{1b}[2J\r\u{7}\u{9b}1m\u{202e}z\u{2066}";

/// Checks that a text has none of them.
#[track_caller]
fn assert_plain(text: &str) {
    let odd = |c: char| c != '\n' && (c.is_control() || ODD[1..].contains(c) && !c.is_ascii());
    assert!(!text.contains(odd), "{text:?}");
}

/// A string of TOML or JSON.
fn quoted(text: &str) -> String {
    let escape = |c: char| {
        if c.is_ascii_graphic() { c.to_string() } else { format!("\\u{:04x}", u32::from(c)) }
    };
    format!("\"{}\"", text.chars().map(escape).collect::<String>())
}

#[test]
fn names_that_command_a_terminal_are_shown_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let material =
        |name: &str, rest: &str| format!("[[material]]\nname = {}\n{rest}\n", quoted(name));
    let fake = format!("{ODD}\nbake  nothing at all\n");
    std::fs::write(at.join("a.toml"), material(&fake, "sigma = 0.5\ngamma = 3.0")).unwrap();
    let shown = ok(at, &["plan", "a.toml"]);
    assert_plain(&shown);
    assert!(shown.contains(r"\u{1b}[2J\r\u{7}\u{9b}1m\u{202e}z\u{2066}\nbake"), "{shown}");
    let json = ok(at, &["plan", "a.toml", "--json"]);
    assert_plain(&json);
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(document["materials"][0]["name"], *fake);

    ok(at, &["bake", "a.toml", "--out", "out", "--quality", "draft"]);
    let shown = ok(at, &["inspect", "out"]);
    assert_plain(&shown);
    assert!(!shown.contains("\nbake  nothing"), "{shown}");
    let json = ok(at, &["inspect", "out", "--json"]);
    assert_plain(&json);
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(document["materials"][0]["name"], *fake);

    // Errors.
    let twice = material(ODD, "sigma = 0.5\ngamma = 3.0").repeat(2);
    std::fs::write(at.join("b.toml"), twice).unwrap();
    assert_plain(&refused(at, &["plan", "b.toml"]));
    std::fs::write(at.join("c.toml"), material(&fake, "sigma = 0.5\ngamma = 1.5005")).unwrap();
    let message = refused(at, &["plan", "c.toml"]);
    assert_plain(&message);
    assert!(!message.contains("\nbake  nothing"), "{message}");
    assert_plain(&refused(at, &["plan", &format!("{ODD}.toml")]));

    // Warnings and notes.
    let gltf = format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"images\": [{{\"uri\": {0}}}], \
         \"textures\": [{{\"source\": 0}}], \"materials\": [{{\"name\": {0}, \"pbrMetallicRoughness\": \
         {{\"metallicRoughnessTexture\": {{\"index\": 0}}}}, \"extensions\": {{\"KHR_materials_sheen\": {{}}}}}}]}}",
        quoted(&fake)
    );
    std::fs::write(at.join("d.gltf"), gltf).unwrap();
    for args in [&["plan", "d.gltf"][..], &["bake", "d.gltf", "--out", "more"]] {
        let output = run(at, args);
        assert_eq!(output.status.code(), Some(0));
        let messages = String::from_utf8(output.stderr).unwrap();
        assert!(
            messages.contains("warning: ") && !messages.contains("\nbake  nothing"),
            "{messages}"
        );
        assert_plain(&messages);
        assert_plain(&String::from_utf8(output.stdout).unwrap());
    }
}
