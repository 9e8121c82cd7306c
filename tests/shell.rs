//! What shells and their readers see: completions, manual pages, `--quiet`, colours.

mod command;

use std::fs;
use std::path::Path;

use command::{ok, refused, run};

#[test]
fn every_shell_has_completions_of_every_subcommand() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = ok(folder.path(), &["completions", shell]);
        for word in ["bake", "validate", "furnace", "max-error", "perturb-gamma"] {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
    }
    assert!(refused(folder.path(), &["completions", "cobol"]).contains("zsh"));
}

#[test]
fn the_manual_has_a_page_of_every_subcommand() {
    let folder = tempfile::tempdir().unwrap();
    assert!(ok(folder.path(), &["man"]).contains(".TH MICROFACET-BAKE 1"));
    fs::create_dir(folder.path().join("man1")).unwrap();
    ok(folder.path(), &["man", "--out", "man1"]);
    for (page, option) in [("bake", "max\\-error"), ("query-g1", "input"), ("furnace", "average")] {
        let page = folder.path().join(format!("man1/microfacet-bake-{page}.1"));
        assert!(fs::read_to_string(&page).unwrap().contains(option), "{}", page.display());
    }
    let error = refused(folder.path(), &["man", "--out", "nowhere"]);
    assert!(error.contains("nowhere"), "{error}");
}

fn glass(folder: &Path) {
    let recipe = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";
    fs::write(folder.join("glass.toml"), recipe).unwrap();
}

#[test]
fn quiet_leaves_results_and_errors() {
    let folder = tempfile::tempdir().unwrap();
    glass(folder.path());
    let silent = |args: &[&str], status: i32| {
        let output = run(folder.path(), args);
        assert_eq!(output.status.code(), Some(status), "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{args:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
    };
    silent(&["bake", "glass.toml", "--out", "out", "--quiet"], 0);
    let few = ["validate", "out", "-q", "--configurations", "2", "--samples", "1e4"];
    silent(&few, 0);
    let wrong = ["validate", "out", "-q", "--configurations", "2", "--perturb-gamma", "1.5"];
    silent(&wrong, 1);
    // What was asked for is no summary.
    assert!(ok(folder.path(), &["inspect", "out", "-q"]).contains("glass"));
    assert!(ok(folder.path(), &["plan", "glass.toml", "-q"]).contains("glass"));
    assert!(
        refused(folder.path(), &["bake", "missing.toml", "--out", "o", "-q"])
            .contains("missing.toml")
    );
}

#[test]
fn nothing_is_coloured_but_on_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    glass(folder.path());
    ok(folder.path(), &["bake", "glass.toml", "--out", "out"]);
    for args in [
        &["--help"][..],
        &["bake", "--help"],
        &["validate", "out", "--configurations", "2", "--samples", "1e4"],
        &["bake", "missing.toml", "--out", "o"],
        &["bake", "--quality", "best"],
    ] {
        let output = run(folder.path(), args);
        let all = [output.stdout, output.stderr].concat();
        assert!(!all.is_empty() && !all.contains(&0x1b), "{args:?}");
    }
}

#[test]
fn characters_that_command_a_terminal_are_written_out_in_usage_errors() {
    let folder = tempfile::tempdir().unwrap();
    let error = refused(folder.path(), &["bake", "--quality", "\u{202e}red", "--out", "o"]);
    assert!(error.contains("'\\u{202e}red'"), "{error}");
}
