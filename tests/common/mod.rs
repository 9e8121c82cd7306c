//! The built command, run in a folder, with its cache there too.

#![allow(dead_code, reason = "each test binary needs a part of it")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

pub(crate) fn run(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_microfacet-bake"));
    command
        .env("XDG_CACHE_HOME", folder.join("home"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Standard output of a run that must succeed.
pub(crate) fn ok(folder: &Path, args: &[&str]) -> String {
    let output = run(folder, args);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{args:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("text")
}

/// The same as JSON.
pub(crate) fn json(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&ok(folder, &[args, &["--json"]].concat())).unwrap()
}

/// The message of a run that must be refused as bad input.
pub(crate) fn refused(folder: &Path, args: &[&str]) -> String {
    let output = run(folder, args);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
    message
}

/// Names of a folder's files, hidden ones included.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
