//! CSV files of `query` and `fit`: lines, units, columns, and messages for refused files.

use std::fs;
use std::path::Path;

use crate::common::{ok, refused, run};

const HEADER: &str = "sigma_x,sigma_y,gamma,theta,phi";

fn query(at: &Path, text: &str, more: &[&str]) -> std::process::Output {
    fs::write(at.join("p.csv"), text).unwrap();
    run(at, &[&["query", "g1", "--input", "p.csv"], more].concat())
}

/// The message with which `query g1` refuses a text.
#[track_caller]
fn refusal(at: &Path, text: &str) -> String {
    let output = query(at, text, &[]);
    assert_eq!(output.status.code(), Some(2), "{text:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_row_of_query_has_its_file_and_the_line_of_an_editor() {
    let folder = tempfile::tempdir().unwrap();
    let rows = [
        // Errors in the last row, after blank lines and a field of several lines; in the first.
        ("\n{}id\n\n1,1,3,0.1,0,\"a\n\nb\"\n\n1,1,3,-1,0,c", 8, "theta = -1"),
        ("{}id\n1,1,3,x,0,\"a\nb\"\n1,1,3,0,0,b\n", 2, "theta \"x\" is not a number"),
        ("{}id\n1,1,3,0,0,a\n\n1,1,3,0\n", 4, "4 columns, and the header 6"),
        ("{}id\n1,1,3,0,0,a\n\n1,1,3,0,0,\"a\n1,1,3,0,0,a\n", 4, "a quote is opened"),
        ("{}id\n\n1,1,1.5,0,0,a\n", 3, "gamma = 1.5"),
    ];
    for (text, line, why) in rows {
        for (mark, end) in [("", "\n"), ("\u{feff}", "\n"), ("\u{feff}", "\r\n"), ("", "\r")] {
            let text = text.replace("{}", &format!("{HEADER},")).replace('\n', end);
            let message = refusal(folder.path(), &format!("{mark}{text}"));
            let place = format!("error: p.csv: line {line}: ");
            assert!(message.starts_with(&place) && message.contains(why), "{text:?}: {message}");
        }
    }
    for text in ["", "\n\n", "\u{feff}"] {
        assert!(refusal(folder.path(), text).starts_with("error: p.csv: it is empty"));
    }
}

#[test]
fn columns_of_query_are_found_once() {
    let folder = tempfile::tempdir().unwrap();
    let header = |header: &str| refusal(folder.path(), &format!("{header}\n1,1,3,0,0\n"));
    let message = header("alpha_x,alpha_y,gamma,theta,phi");
    let parts =
        ["error: p.csv: no column `sigma_x`", "did you mean `sigma_x`?", "the alpha of GGX"];
    assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    assert!(header("roughness,gamma,theta,phi").contains("square root of sigma"));
    assert!(header("sigma_x,sigma_y,shape,theta,phi").contains("did you mean `gamma`?"));
    assert!(header("sigma_x,sigma_y,gamma,thta,phi").contains("for `thta` did you mean `theta`?"));
    let message = header("sigma_x,sigma_y,gamma,theta,phi,phi");
    assert!(message.contains("p.csv: two columns have the name `phi`"), "{message}");
    assert!(header(&format!("{HEADER},id,id")).contains("`id`"));
    assert!(header(&format!("{HEADER},g1_exact")).contains("column `g1_exact` already"));
    // Columns without a name are no duplicates, and only columns of results that are written clash.
    let text = format!("{HEADER},,,g1_exact\n1,1,3,0,0,,,\n");
    assert!(query(folder.path(), &text, &["--method", "table"]).status.success());
}

#[test]
fn query_reads_degrees_and_doubts_them() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |theta: f64, phi: f64| format!("{HEADER}\n0.3,0.1,3,{theta:?},{phi:?}\n");
    let values = |text: &str, more: &[&str]| {
        let output = query(folder.path(), text, more);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        let text = String::from_utf8(output.stdout).unwrap();
        let row = text.lines().nth(1).unwrap().to_owned();
        let (point, values) = row.split_at(row.match_indices(',').nth(4).unwrap().0);
        (point.to_owned(), values.to_owned())
    };
    let (point, degrees) = values(&rows(60.0, 400.0), &["--degrees"]);
    let (_, radians) = values(&rows(60.0_f64.to_radians(), 40.0_f64.to_radians()), &[]);
    assert_eq!(point, "0.3,0.1,3,60.0,400.0");
    let numbers = |values: &str| -> Vec<f64> {
        values[1..].split(',').map(|value| value.parse().unwrap()).collect()
    };
    for (a, b) in numbers(&degrees).into_iter().zip(numbers(&radians)) {
        assert!((a / b - 1.0).abs() < 1e-5, "{degrees} {radians}");
    }

    let said = |text: &str| String::from_utf8(query(folder.path(), text, &[]).stderr).unwrap();
    assert!(said(&rows(60.0, 0.0)).contains("p.csv: line 2: theta = 60 must"));
    assert!(said(&rows(60.0, 0.0)).contains("--degrees"));
    // One warning for a run, at the first row.
    let many = format!("{HEADER}\n1,1,3,0,6\n\n{}", "1,1,3,0,90\n".repeat(600));
    let doubt = "warning: p.csv: line 4: phi = 90 radians is 14.3 turns; if it is in degrees, add --degrees\n";
    assert_eq!(said(&many), doubt);
}

#[test]
fn points_of_query_are_printed_with_the_unit_of_their_angles() {
    let folder = tempfile::tempdir().unwrap();
    let lobe = ["query", "g1", "--sigma", "0.5", "--gamma", "2", "--method", "exact"];
    let printed = |more: &[&str]| ok(folder.path(), &[&lobe, more].concat());
    let text = printed(&["--theta", "60", "--degrees"]);
    assert!(text.contains(", theta = 60 degrees, phi = 0 degrees\n\nmethod  lambda"), "{text}");
    let text = printed(&["--theta", "0.5", "--theta", "1"]);
    assert!(text.contains(", phi = 0 radians\n\ntheta [radians]  method"), "{text}");
}

#[test]
fn query_names_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    for (text, why) in [("a\n", "no column"), ("", "it is empty"), (HEADER, "")] {
        fs::write(folder.path().join("in"), text).unwrap();
        let file = fs::File::open(folder.path().join("in")).unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_microfacet-bake"))
            .args(["query", "g1", "--input", "-"])
            .stdin(file)
            .output()
            .unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.success(), why.is_empty(), "{message}");
        assert!(message.contains(&format!("standard input: {why}")) || why.is_empty(), "{message}");
    }
}

#[test]
fn fit_speaks_in_the_unit_of_its_input_and_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let fit = |text: &str, more: &[&str]| {
        fs::write(at.join("d.csv"), text).unwrap();
        [&["fit", "--input", "d.csv"], more].concat().iter().map(|arg| (*arg).to_owned()).collect()
    };
    let run = |args: Vec<String>, accept: bool| {
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        if accept { ok(at, &args) } else { refused(at, &args) }
    };
    let rows = "0.5,9\n2,5\n4,2\n6,1\n8,0.5\n";
    let text = run(fit(rows, &["--degrees"]), true);
    assert!(
        text.contains("nothing below 0.5 degrees:") && text.contains("nothing above 8 degrees:")
    );
    // A small angle is not printed as 0.000 degrees.
    let text = run(fit("0,9\n1e-6,5\n2.5e-6,2\n", &["--degrees"]), true);
    assert!(text.contains("nothing above 2.5e-6 degrees:"), "{text}");
    let text = run(fit("0,9\n0.01,5\n0.025,2\n", &[]), true);
    assert!(text.contains("nothing above 0.025 radians:"), "{text}");

    let cases = [
        (rows, "line 2: the angle 2 must be in [0, pi/2"),
        ("D,theta\n9,0\n", "line 1: the columns are `D` and `theta`"),
        ("0,1\r\r\r0.1,x\r", "line 4: `x`"),
        ("0,1\n", "a distribution needs at least 3 rows, not 1"),
        // Too narrow for any lobe.
        ("0,1\n1e-300,1\n2e-300,0", "D is too large or too small"),
    ];
    for (text, why) in cases {
        let message = run(fit(text, &[]), false);
        assert!(message.contains(&format!("error: d.csv: {why}")), "{message}");
    }
}
