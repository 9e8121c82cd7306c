//! The command end to end, from an empty folder.

use microfacet_baker::store;
use microfacet_sampler::{Lobe, Tables};
use microfacet_tables::{Kind, Quantity};
use safetensors::SafeTensors;

use crate::common::{Desk, has, lacks, material, refused};

fn glass() -> String {
    material("glass", "sigma = 0.454\ngamma = 3.0")
}

#[test]
fn from_a_recipe_to_normals() {
    let desk = Desk::new(&[("glass.toml", &glass())]);
    let summary = desk.ok("bake glass.toml --out out");
    has(&summary, &["G1 ", "in visible_slope_gamma_3\n"]);

    // The file holds its material, and the certificate holds what the quality promises.
    let set = store::read(&desk.join("out")).unwrap();
    let Lobe::StudentT(glass) = set.material("glass").unwrap() else { panic!("not from tables") };
    assert_eq!((glass.sigma(), glass.gamma()), ([0.454, 0.454], 3.0));
    let certificate = &set.table(Kind::VisibleSlope).unwrap().certificate;
    assert!(certificate.error(Quantity::Cdf).unwrap() < 1e-4);
    has(&set.student_t(0.3, 4.0).unwrap_err().to_string(), &["that this set serves is 3"]);

    has(&desk.ok("inspect out"), &["gamma 3", "CC0-1.0", "glass"]);
    assert_eq!(desk.json("inspect out")["format"], "microfacet-tables");

    desk.ok("sample --sigma 0.454 --gamma 3 --theta 1 --count 1000 --out n.safetensors");
    let bytes = desk.read("n.safetensors");
    let tensors = SafeTensors::deserialize(&bytes).unwrap();
    assert_eq!(tensors.tensor("normals").unwrap().shape(), [1000, 3]);
    assert_eq!(tensors.tensor("pdf").unwrap().shape(), [1000]);

    let verdict = desk.ok("validate out --configurations 4 --samples 20000");
    assert!(verdict.ends_with("PASSED\n"), "{verdict}");
}

#[test]
fn query_passes_columns_through_and_agrees_with_the_model() {
    let points = "id,sigma_x,sigma_y,gamma,theta,phi,u1,u2\na,0.3,0.3,3,1.2,0,0.2,0.7\nb,0.3,0.1,inf,1.5,2,0.9,0.1\n";
    let desk = Desk::new(&[("points.csv", points)]);
    let table = desk.ok("query g1 --input points.csv");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(rows.headers().unwrap().iter().next_back(), Some("g1_exact"));
    for row in rows.records() {
        let row = row.unwrap();
        assert!(["a", "b"].contains(&&row[0]));
        let [lambda, g1, exact_lambda, exact_g1] =
            [8, 9, 10, 11].map(|i| row[i].parse::<f64>().unwrap());
        assert!((g1 - exact_g1).abs() < 5e-6, "{row:?}");
        assert!((lambda - exact_lambda).abs() < 1e-5 * (1.0 + exact_lambda).powi(2), "{row:?}");
    }
    let normals = desk.ok("query normal --input points.csv --method exact");
    let header = normals.lines().next().unwrap();
    assert!(header.ends_with("u2,m_x_exact,m_y_exact,m_z_exact,pdf_exact"), "{normals}");
}

/// What a query says beside its rows.
#[test]
fn query_says_what_can_be_compared_and_what_is_covered() {
    let desk = Desk::new(&[]);
    let normal = |row: &str| {
        desk.write("p.csv", format!("sigma_x,sigma_y,gamma,theta,phi,u1,u2\n{row}\n"));
    };
    let query = "query normal --input p.csv";
    let notes = |line: &str| desk.run(line).err;
    normal("0.5,0.5,1.6,0.6,0,0.8,0.5");
    has(&notes(query), &["different normals"]);
    assert_eq!(notes(&format!("{query} --method table")), "");
    normal("0.5,0.5,1.9,0.6,0,0.8,0.5");
    assert_eq!(notes(query), "");
    // No line is filled with zeros.
    normal("0.5,0.5,1.501,0.6,0,0.999,0.5");
    has(&desk.ok(&format!("{query} --method exact")), &[",1e-300,"]);

    let albedo = |row: &str| {
        let text = format!("sigma,gamma,cos_theta,masking\n{row},height-correlated\n");
        desk.write("a.csv", text);
    };
    let query = "query albedo --input a.csv";
    albedo("1e-9,1.501,1e-7");
    desk.refuses(query, &["[1e-8, 3] and 0, a mirror"]);
    // It is 0.34.
    let exact = desk.ok(&format!("{query} --method exact"));
    assert!(["0.33", "0.34"].iter().any(|it| exact.contains(&format!("height-correlated,{it}"))));
    // −0 is the horizon.
    let [zero, negative] = ["0.3,3,0", "0.3,3,-0"].map(|row| {
        albedo(row);
        desk.ok(query).replace("3,-0,", "3,0,")
    });
    assert_eq!(zero, negative);

    // A rounded π/2, in every command.
    for (theta, code) in [("1.5708", 0), ("1.6", 2)] {
        desk.write("g.csv", format!("sigma_x,sigma_y,gamma,theta,phi\n0.3,0.3,3,{theta},0\n"));
        desk.run("query g1 --input g.csv").ends(code);
        let view = format!("--sigma 0.3 --gamma 3 --theta {theta}");
        desk.run(&format!("sample {view} --count 9 --out n.safetensors")).ends(code);
    }
}

#[test]
fn query_answers_points_of_options_as_rows_of_a_file() {
    let text = "id,sigma_x,sigma_y,gamma,theta,phi\n007,.3,0.1,inf,1.2,-2\n";
    let desk = Desk::new(&[("p.csv", text), ("bad.csv", &format!("{text}8,0.3,0.1,3,9,0\n"))]);
    let of_file = desk.json("query g1 --input p.csv");
    let of_options = desk.json("query g1 --sigma 0.3,0.1 --gamma inf --theta 1.2 --phi -2");
    for name in ["sigma_x", "gamma", "phi", "lambda_table", "g1_exact"] {
        assert_eq!(of_file[0][name], of_options[0][name], "{name}");
    }
    assert_eq!((&of_file[0]["id"], &of_file[0]["gamma"]), (&"007".into(), &"inf".into()));
    // Rows before one that is refused are an array all the same.
    let said = desk.run("query g1 --input bad.csv --json").ends(2);
    let rows: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(rows, of_file);

    // D of GGX at the normal is 1/(pi sigma^2).
    let d = desk.json("query d --sigma 0.5 --perceptual --gamma 2 --theta 0 --method exact");
    let want = std::f64::consts::FRAC_1_PI * 16.0;
    assert!((d[0]["d_exact"].as_f64().unwrap() - want).abs() < 1e-12 * want, "{d}");
    assert_eq!(d[0]["sigma_x"], 0.25);

    // A view a row and a line for each method; what all share stands above.
    let albedo = desk.ok("query albedo --sigma 0.5 --gamma 2");
    assert_eq!(albedo.lines().next(), Some("sigma = 0.5, gamma = 2, masking = height-correlated"));
    assert_eq!(albedo.lines().count(), 3 + 6 * 2, "{albedo}");
    let average = desk.ok("query albedo-average --sigma 0.5,1 --gamma 2 --method exact");
    has(&average, &["gamma = 2, masking", "0.5    exact", "1      exact"]);

    desk.refuses("query g1 --sigma 1.1 --perceptual --gamma 2", &["1.1", "[0, 1]"]);
    desk.refuses("query normal --sigma 0.5 --gamma 2 --u 0.5,2", &["u2 = 2", "[0, 1]"]);
    desk.refuses("query normal --sigma 0.5 --gamma 2 --u 0.5", &["0.2,0.7"]);
    desk.refuses("query d --sigma 0.5 --gamma 2 --input p.csv", &["--input"]);
    desk.refuses("query albedo --gamma 2", &["--sigma"]);
}

#[test]
fn query_answers_in_order_up_to_a_row_that_is_refused() {
    let row = |i: usize| {
        format!("{i},0.{},3,{},uncorrelated\n", 1 + i % 9, if i == 700 { "1.5" } else { "0.5" })
    };
    let rows: String = (0..800).map(row).collect();
    let desk = Desk::new(&[("views.csv", &format!("id,sigma,gamma,cos_theta,masking\n{rows}"))]);
    let said = desk.run("query albedo --input views.csv --method table").ends(2);
    // The header is line 1.
    has(&said.err, &["line 702", "1.5"]);
    let id = |line: &str| line.split(',').next().unwrap().parse().unwrap();
    let ids: Vec<usize> = said.out.lines().skip(1).map(id).collect();
    assert_eq!(ids, (0..700).collect::<Vec<_>>());
}

#[test]
fn validation_rejects_a_wrong_gamma() {
    let desk = Desk::new(&[]);
    let one = "validate --sigma 0.5,0.2 --gamma 1.65 --theta 1.1 --phi -2 --samples 300000";
    desk.ok(one);
    let said = desk.run(&format!("{one} --perturb-gamma 1.01")).ends(1);
    assert!(said.out.ends_with("REJECTED\n"));
}

#[test]
fn a_failed_bake_leaves_the_old_set() {
    let desk = Desk::new(&[("r.toml", &glass())]);
    desk.ok("bake r.toml --out out");
    let before = desk.read("out/tables.safetensors");
    desk.write("r.toml", glass().replace("3.0", "1.2"));
    desk.refuses("bake r.toml --out out", &[]);
    assert_eq!(desk.read("out/tables.safetensors"), before);
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
    let desk = Desk::new(&[]);
    let of = |name: &str, gamma: &str| {
        format!("[[material]]\nname = {}\nsigma = 0.5\ngamma = {gamma}\n", quoted(name))
    };
    let fake = format!("{ODD}\nbake  nothing at all\n");
    let faked = ["\nbake  nothing"];
    desk.write("a.toml", of(&fake, "3.0"));
    let shown = desk.ok("plan a.toml");
    assert_plain(&shown);
    has(&shown, &[r"\u{1b}[2J\r\u{7}\u{9b}1m\u{202e}z\u{2066}\nbake"]);
    desk.ok("bake a.toml --out out --quality draft");
    let shown = desk.ok("inspect out");
    assert_plain(&shown);
    lacks(&shown, &faked);
    for line in ["plan a.toml --json", "inspect out --json"] {
        let json = desk.ok(line);
        assert_plain(&json);
        let document: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(document["materials"][0]["name"], *fake);
    }

    // Errors.
    desk.write("b.toml", of(ODD, "3.0").repeat(2));
    assert_plain(&desk.refuses("plan b.toml", &[]));
    desk.write("c.toml", of(&fake, "1.5005"));
    let message = desk.refuses("plan c.toml", &[]);
    assert_plain(&message);
    lacks(&message, &faked);
    assert_plain(&refused(desk.path(), &["plan", &format!("{ODD}.toml")]));

    // Warnings and notes.
    let gltf = format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"images\": [{{\"uri\": {0}}}], \
         \"textures\": [{{\"source\": 0}}], \"materials\": [{{\"name\": {0}, \"pbrMetallicRoughness\": \
         {{\"metallicRoughnessTexture\": {{\"index\": 0}}}}, \"extensions\": {{\"KHR_materials_sheen\": {{}}}}}}]}}",
        quoted(&fake)
    );
    desk.write("d.gltf", gltf);
    for line in ["plan d.gltf", "bake d.gltf --out more"] {
        let said = desk.run(line).ends(0);
        has(&said.err, &["warning: "]);
        lacks(&said.err, &faked);
        assert_plain(&said.err);
        assert_plain(&said.out);
    }
}
