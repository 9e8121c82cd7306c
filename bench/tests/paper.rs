//! Figures 4 to 6 of the paper as a command: the files it writes and their values, never the times.

mod common;

use std::collections::BTreeSet;

use common::{Record, number, read, run};

fn distinct<'a>(records: impl Iterator<Item = &'a Record>, column: &str) -> BTreeSet<String> {
    records.map(|record| record[column].clone()).collect()
}

fn largest(records: &[Record], column: &str) -> f64 {
    records.iter().map(|record| number(record, column).abs()).fold(0.0, f64::max)
}

#[test]
fn each_figure_is_printed_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let output = run(at, &["paper", "--quick", "--calls", "64", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    for part in ["figure 4", "over GGX's closed form", "figure 5", "0.7 %", "figure 6", "RMSE"] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
    assert!(!text.contains("sweep"), "{text}");

    // Every form in both rows, over both coordinates.
    let times = read(&at.join("out/figure-4.csv"));
    assert!(times.iter().all(|time| number(time, "ns") > 0.0));
    for by in ["gamma", "sigma"] {
        let of = |quantity: &'static str| {
            times.iter().filter(move |at| at["quantity"] == quantity && at["by"] == by)
        };
        let forms = distinct(of("g1"), "method");
        assert_eq!(forms, distinct(of("picture"), "method"));
        assert!(of("normal").count() > 0);
        for form in ["13-15", "21, integer", "22-23", "beta", "table", "GGX", "Beckmann"] {
            assert!(forms.iter().any(|name| name.contains(form)), "no {form} in {forms:?}");
        }
        let table = |quantity| distinct(of(quantity).filter(|at| at["method"] == "table"), by);
        assert!(table("g1").len() >= 8 && table("g1") == table("picture"), "{by}");
    }

    // What is found over θ in single precision is found over cot θ/σ in double. (For γ = 1.6 the
    // largest error is at normal incidence, where no θ of the first stands.)
    let errors = read(&at.join("out/figure-5.csv"));
    assert!(largest(&errors, "table_error") < 1e-5);
    let integrated = read(&at.join("out/figure-5-integrated.csv"));
    for gamma in ["3", "20", "40"] {
        let of = |all: &[Record]| -> Vec<Record> {
            all.iter().filter(|at| at["gamma"] == gamma).cloned().collect()
        };
        let one = largest(&of(&errors), "rational_error");
        let other = largest(&of(&integrated), "max");
        assert!((one / other - 1.0).abs() < 0.01, "γ = {gamma}: {one} and {other}");
    }
    // The paper's 0.7 % holds for the mean, and not quite for the largest error.
    let [mean, most] = ["relative", "max"].map(|column| largest(&integrated, column));
    assert!((0.004..0.005).contains(&mean) && (0.007..0.0072).contains(&most), "{mean} {most}");

    let pictures = read(&at.join("out/figure-6.csv"));
    for picture in &pictures {
        let rmse = number(picture, "rmse");
        match picture["form"].as_str() {
            "table" => assert!(rmse < 1e-6, "{picture:?}"),
            _ => assert!((1e-4..1e-2).contains(&rmse), "{picture:?}"),
        }
    }

    for (figure, word) in [(4, "hypergeometric"), (5, "rational"), (6, "table")] {
        let drawn = std::fs::read_to_string(at.join(format!("out/figure-{figure}.svg"))).unwrap();
        assert!(drawn.starts_with("<svg") && drawn.to_lowercase().contains(word), "{figure}");
        let image = std::fs::read(at.join(format!("out/figure-{figure}.png"))).unwrap();
        assert!(image.starts_with(b"\x89PNG"), "{figure}");
    }
    assert!(!at.join("out/bench.csv").exists());
}

#[test]
fn options_may_stand_on_either_side_and_wrong_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for (args, word) in [
        (&["paper", "--calls", "0"][..], "16..=16384"),
        (&["--calls", "1000000", "paper"], "16..=16384"),
        (&["paper", "--out", "file"], "file"),
        (&["--out", "file", "paper"], "file"),
        (&["papers"], "papers"),
    ] {
        let output = run(folder.path(), args);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {errors}");
        assert!(output.stdout.is_empty() && errors.contains(word), "{args:?}: {errors}");
    }
}
