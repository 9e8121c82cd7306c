//! The command: its words, options, outputs, pages, and the docs that show it.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/transcript.rs"]
mod transcript;

mod cli;
mod docs;
mod options;
mod outputs;
mod recipe_page;
mod report_cli;
mod shell;
mod survey;

use std::path::Path;

use common::{command, words};
use transcript::{marked, replay};

/// A line without the version and the times that were measured: all but those that are estimated.
fn timeless(line: &str) -> String {
    let mut words: Vec<&str> = line.split(' ').collect();
    for i in (2..words.len()).rev() {
        let unit = words[i].trim_end_matches([',', ')']);
        let is_time = ["ms", "s"].contains(&unit) && words[i - 1].parse::<f64>().is_ok();
        if is_time && !words[i - 2].ends_with("about") {
            words[i - 1] = "TIME";
            words[i] = &words[i][unit.len()..];
        }
    }
    let version = concat!("microfacet-bake ", env!("CARGO_PKG_VERSION"));
    words.join(" ").replace("TIME ", "TIME").replace(version, "microfacet-bake VERSION")
}

/// Paths of what is in a folder, but for what is in the cache.
fn files(folder: &Path) -> String {
    let entries = walkdir::WalkDir::new(folder).min_depth(1).sort_by_file_name();
    let outside = |entry: &walkdir::DirEntry| !entry.path().parent().unwrap().ends_with("home");
    let path = |entry: walkdir::DirEntry| {
        let end = if entry.file_type().is_dir() { "/" } else { "" };
        format!("{}{end}\n", entry.path().strip_prefix(folder).unwrap().display())
    };
    entries.into_iter().filter_entry(outside).map(|entry| path(entry.unwrap())).collect()
}

/// What a command line answers; `files` lists what is in the folder.
fn answer(folder: &Path, line: &str) -> String {
    if line == "files" {
        return marked('>', &files(folder));
    }
    // Estimates of time are for one thread.
    let output = command(folder, &words(line)).env("RAYON_NUM_THREADS", "1").output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    // Usage has one line.
    let fits = |line: &str| line.chars().count() <= 100 || line.starts_with("Usage: ");
    assert!(out.lines().all(fits), "more than 100 columns: {out}");
    let out: String = marked('>', &out).lines().map(|line| timeless(line) + "\n").collect();
    let status = match output.status.code() {
        Some(0) => String::new(),
        Some(code @ (1 | 2)) => format!("? {code}\n"),
        // A panic, or a signal.
        other => panic!("{line}: {other:?}: {err}"),
    };
    out + &marked('!', &err) + &status
}

/// Errors of the system are worded as Unix has them.
#[cfg(unix)]
#[test]
fn commands_answer_as_their_transcripts_say() {
    replay("command", answer);
}
