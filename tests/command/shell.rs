//! What shells and their readers see: completions, manual pages, `--quiet`, colours.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{ok, refused, run};

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
    for hidden in ["roughness", "alpha"] {
        let script = ok(folder.path(), &["completions", "bash"]);
        assert!(!script.contains(&format!("--{hidden} ")), "{hidden} exists to be refused");
    }
}

#[test]
#[cfg(unix)]
fn bash_completes_options_and_values_of_subcommands() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("c"), ok(folder.path(), &["completions", "bash"])).unwrap();
    for (words, found) in [
        ("validate --st", "--stress"),
        ("bake --qual", "--quality"),
        ("bake --quality d", "draft default"),
        ("query g1 --met", "--method"),
        ("furnace --masking h", "height-correlated"),
    ] {
        let count = words.split(' ').count();
        // As an interactive bash calls it.
        let script = format!(
            "source ./c; COMP_WORDS=(microfacet-bake {words}); COMP_CWORD={count}; \
             last=${{COMP_WORDS[$COMP_CWORD]}}; _microfacet-bake microfacet-bake \"$last\" \
             \"${{COMP_WORDS[$COMP_CWORD-1]}}\"; echo ${{COMPREPLY[@]}}"
        );
        let Ok(output) = Command::new("bash").args(["-c", &script]).current_dir(&folder).output()
        else {
            // A system without bash has no use for it.
            return;
        };
        let replies = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(replies.trim(), found, "{words}: {}", String::from_utf8_lossy(&output.stderr));
    }
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
    assert_eq!(ok(folder.path(), &few), "PASSED\n");
    let wrong = ["validate", "out", "-q", "--configurations", "2", "--perturb-gamma", "1.5"];
    let output = run(folder.path(), &wrong);
    assert_eq!((output.status.code(), &output.stdout[..]), (Some(1), &b"REJECTED\n"[..]));
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

/// What a command writes to a terminal of its own, by the `script` of util-linux; `None` on systems
/// without it.
#[cfg(target_os = "linux")]
fn on_a_terminal(folder: &Path, line: &str, no_color: bool) -> Option<String> {
    let program = env!("CARGO_BIN_EXE_microfacet-bake");
    let mut command = Command::new("script");
    command.args(["-qec", &format!("{program} {line}"), "/dev/null"]);
    command.env("TERM", "xterm").env("XDG_CACHE_HOME", folder.join("home")).current_dir(folder);
    command.env_remove("NO_COLOR").env_remove("CLICOLOR");
    if no_color {
        command.env("NO_COLOR", "1");
    }
    let output = command.stdin(std::process::Stdio::null()).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_has_colours_unless_it_wants_none() {
    let folder = tempfile::tempdir().unwrap();
    let line = "bake missing.toml --out o";
    let Some(coloured) = on_a_terminal(folder.path(), line, false) else { return };
    assert!(coloured.contains("\u{1b}[31merror\u{1b}[0m: missing.toml"), "{coloured:?}");
    let plain = on_a_terminal(folder.path(), line, true).unwrap();
    assert!(plain.starts_with("error: missing.toml"), "{plain:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_shows_progress_and_clears_it() {
    let folder = tempfile::tempdir().unwrap();
    let long = "bake --threads 2 --no-albedo --quality high --no-cache --out out";
    let Some(text) = on_a_terminal(folder.path(), long, true) else { return };
    let (bars, summary) = text.split_at(text.find("baked ").expect("a summary"));
    assert!(bars.contains("baking ") && bars.contains(" left"), "{bars:?}");
    // Cleared before the summary, and not drawn again.
    assert!(bars.ends_with("\u{1b}[2K") || bars.ends_with('\r'), "{bars:?}");
    assert!(!summary.contains(" left") && summary.contains("next:"), "{summary:?}");
    let quiet = on_a_terminal(folder.path(), &format!("{long} -q"), true).unwrap();
    assert_eq!(quiet, "");
}
