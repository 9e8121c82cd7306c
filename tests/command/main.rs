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

/// What a command line answers; `files` lists what is in the folder.
fn answer(folder: &Path, line: &str) -> String {
    if line == "files" {
        let files = walkdir::WalkDir::new(folder).sort_by_file_name().into_iter();
        let paths = files.filter_map(Result::ok).filter(|it| it.file_type().is_file());
        let names: String = paths
            .map(|it| format!("{}\n", it.path().strip_prefix(folder).unwrap().display()))
            .filter(|name| !name.starts_with("home"))
            .collect();
        return marked('>', &names);
    }
    // Estimates of time are for one thread.
    let output = command(folder, &words(line)).env("RAYON_NUM_THREADS", "1").output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    // Usage has one line.
    let fits = |line: &str| line.chars().count() <= 100 || line.starts_with("Usage: ");
    assert!(out.lines().all(fits), "more than 100 columns: {out}");
    let out: String = out.lines().map(|line| timeless(line) + "\n").collect();
    let status = match output.status.code() {
        Some(0) => String::new(),
        code => format!("? {}\n", code.unwrap()),
    };
    marked('>', &out) + &marked('!', &err) + &status
}

/// Errors of the system are worded as Unix has them.
#[cfg(unix)]
#[test]
fn commands_answer_as_their_transcripts_say() {
    replay("command", answer);
}
