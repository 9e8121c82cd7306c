//! Runs the built command in a folder, with its cache in the folder, too.

#![allow(dead_code, reason = "each test binary needs a part of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_microfacet-bake");

/// The program in a folder, whose help is as wide as a terminal of 100 columns.
pub(crate) fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.env("XDG_CACHE_HOME", folder.join("home")).env("COLUMNS", "100");
    command.args(args).current_dir(folder);
    command
}

pub(crate) fn run(folder: &Path, args: &[&str]) -> Output {
    command(folder, args).output().unwrap()
}

/// Standard output of a run that must succeed.
pub(crate) fn ok(folder: &Path, args: &[&str]) -> String {
    Said::of(args, run(folder, args)).ends(0).out
}

/// The same as JSON.
pub(crate) fn json(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&ok(folder, &[args, &["--json"]].concat())).unwrap()
}

/// The message of a run that must be refused as bad input.
pub(crate) fn refused(folder: &Path, args: &[&str]) -> String {
    Said::of(args, run(folder, args)).ends(2).err
}

/// Names of a folder's files, hidden ones included.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Words between white space, as of a command line without quotes.
pub(crate) fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Checks that a text has some parts.
#[track_caller]
pub(crate) fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

/// Checks that a text has none of some parts.
#[track_caller]
pub(crate) fn lacks(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(!text.contains(part), "{part:?} in:\n{text}");
    }
}

/// A text with every run of white space as one space: lines may break anywhere.
pub(crate) fn flat(text: &str) -> String {
    words(text).join(" ")
}

/// A material of a recipe, with lines after its name.
pub(crate) fn material(name: &str, lines: &str) -> String {
    format!("[[material]]\nname = \"{name}\"\n{lines}\n")
}

/// What a run said, and its exit status.
#[derive(Debug)]
pub(crate) struct Said {
    line: String,
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Said {
    fn of(args: &[&str], output: Output) -> Self {
        let [out, err] =
            [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
        Self { line: args.join(" "), code: output.status.code(), out, err }
    }

    /// Checks the exit status.
    #[track_caller]
    pub(crate) fn ends(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}: {}", self.line, self.err);
        self
    }
}

/// A folder in which command lines are run, whose words have no spaces.
pub(crate) struct Desk(TempDir);

impl Desk {
    /// A folder with files, each after its path.
    pub(crate) fn new(files: &[(&str, &str)]) -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        files.iter().for_each(|(name, text)| desk.write(name, text));
        desk
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn join(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        let path = self.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    #[track_caller]
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.join(name)).unwrap()
    }

    pub(crate) fn run(&self, line: &str) -> Said {
        let args = words(line);
        Said::of(&args, run(self.path(), &args))
    }

    /// Standard output of a run that must succeed.
    #[track_caller]
    pub(crate) fn ok(&self, line: &str) -> String {
        self.run(line).ends(0).out
    }

    /// The same as JSON.
    #[track_caller]
    pub(crate) fn json(&self, line: &str) -> Value {
        serde_json::from_str(&self.ok(&format!("{line} --json"))).unwrap()
    }

    /// The message of a run that must be refused as bad input; it has these parts.
    #[track_caller]
    pub(crate) fn refuses(&self, line: &str, parts: &[&str]) -> String {
        let message = self.run(line).ends(2).err;
        for part in parts {
            assert!(message.contains(part), "{line}: no {part:?} in: {message}");
        }
        message
    }
}
