//! What shells and their readers see: completions, manual pages, `--quiet`, colours.

use std::fs;
use std::process::{Command, Stdio};

use crate::common::{Desk, PROGRAM, has, lacks, material, names};

#[test]
fn every_shell_has_completions_of_every_subcommand() {
    let desk = Desk::new(&[]);
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = desk.ok(&format!("completions {shell}"));
        has(&script, &["bake", "validate", "furnace", "max-error", "perturb-gamma"]);
    }
    // They exist to be refused.
    lacks(&desk.ok("completions bash"), &["--roughness ", "--alpha ", "--gamma-max "]);
}

#[test]
#[cfg(unix)]
fn bash_completes_options_and_values_of_subcommands() {
    let desk = Desk::new(&[]);
    desk.write("c", desk.ok("completions bash"));
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
        let bash = Command::new("bash").args(["-c", &script]).current_dir(desk.path()).output();
        // A system without bash has no use for it.
        let Ok(output) = bash else { return };
        let replies = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(replies.trim(), found, "{words}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn the_manual_has_a_page_of_every_subcommand() {
    let desk = Desk::new(&[]);
    has(&desk.ok("man"), &[".TH MICROFACET-BAKE 1"]);
    fs::create_dir(desk.join("man1")).unwrap();
    desk.ok("man --out man1");
    for (page, option) in [("bake", "max\\-error"), ("query-g1", "input"), ("furnace", "average")] {
        let page = desk.read(&format!("man1/microfacet-bake-{page}.1"));
        has(&String::from_utf8(page).unwrap(), &[option]);
    }
    // Of each there is a help page too.
    let helps = include_str!("help.txt").lines().filter(|line| line.ends_with(" --help"));
    assert_eq!(names(&desk.join("man1")).len(), helps.filter(|line| line.starts_with('$')).count());
}

fn glass() -> Desk {
    Desk::new(&[("glass.toml", &material("glass", "sigma = 0.454\ngamma = 3.0"))])
}

#[test]
fn nothing_is_coloured_but_on_a_terminal() {
    let desk = glass();
    desk.ok("bake glass.toml --out out");
    for line in [
        "--help",
        "bake --help",
        "validate out --configurations 2 --samples 1e4",
        "bake missing.toml --out o",
        "bake --quality best",
    ] {
        let said = desk.run(line);
        let all = said.out + &said.err;
        assert!(!all.is_empty() && !all.contains('\u{1b}'), "{line}");
    }
}

#[test]
fn characters_that_command_a_terminal_are_written_out_in_usage_errors() {
    Desk::new(&[]).refuses("bake --quality \u{202e}red --out o", &["'\\u{202e}red'"]);
}

/// What a command writes to a terminal of its own, by the `script` of util-linux; `None` on systems
/// without it.
#[cfg(target_os = "linux")]
fn on_a_terminal(line: &str, no_color: bool) -> Option<String> {
    let desk = Desk::new(&[]);
    let mut command = Command::new("script");
    command.args(["-qec", &format!("{PROGRAM} {line}"), "/dev/null"]).current_dir(desk.path());
    command.env("TERM", "xterm").env("XDG_CACHE_HOME", desk.join("home"));
    command.env_remove("NO_COLOR").env_remove("CLICOLOR");
    if no_color {
        command.env("NO_COLOR", "1");
    }
    let output = command.stdin(Stdio::null()).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_has_colours_unless_it_wants_none() {
    let line = "bake missing.toml --out o";
    let Some(coloured) = on_a_terminal(line, false) else { return };
    has(&coloured, &["\u{1b}[31merror\u{1b}[0m: missing.toml"]);
    let plain = on_a_terminal(line, true).unwrap();
    assert!(plain.starts_with("error: missing.toml"), "{plain:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_shows_progress_and_clears_it() {
    let long = "bake --threads 1 --no-albedo --no-cache --out out";
    let Some(text) = on_a_terminal(long, true) else { return };
    let (bars, summary) = text.split_at(text.find("baked ").expect("a summary"));
    has(bars, &["baking ", " left"]);
    // Cleared before the summary, and not drawn again.
    assert!(bars.ends_with("\u{1b}[2K") || bars.ends_with('\r'), "{bars:?}");
    has(summary, &["next:"]);
    lacks(summary, &[" left"]);
    assert_eq!(on_a_terminal(&format!("{long} -q"), true).unwrap(), "");
}
