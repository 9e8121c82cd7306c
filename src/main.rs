//! The `microfacet-bake` command: parses the arguments, runs the subcommand, returns an exit code.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    if !cfg!(debug_assertions) {
        std::panic::set_hook(Box::new(|panic| eprintln!("{}", bug(&panic.to_string()))));
    }
    cli::main()
}

/// A panic as a message in one line, since every panic is a bug of this program.
fn bug(panic: &str) -> String {
    let what = panic.lines().collect::<Vec<_>>().join(" ");
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "error: a bug in microfacet-bake {version}: {what} Please report this line with the command and its input files."
    )
}

#[test]
fn a_bug_is_one_line() {
    let line = bug("panicked at src/main.rs:1:2:\nindex out of bounds");
    assert_eq!(line.lines().count(), 1);
    assert!(line.contains("src/main.rs:1:2: index") && line.contains("report"), "{line}");
}
