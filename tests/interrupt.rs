//! The program interrupted, as by Ctrl-C: it ends with whole files and says what is left.
#![cfg(unix)]

mod command;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use command::{json, ok};

fn start(folder: &Path, args: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_microfacet-bake"));
    command.env("XDG_CACHE_HOME", folder.join("home")).args(args).current_dir(folder);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Sends the signal once something has happened.
fn interrupt_after(mut child: Child, signal: &str, happened: impl Fn() -> bool) -> Output {
    while !happened() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be interrupted");
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    child.wait_with_output().unwrap()
}

fn message(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{text}");
    text
}

/// A bake that takes seconds: of the general set, without albedos.
const LONG: [&str; 6] = ["bake", "--no-albedo", "--quality", "high", "--out", "new/out"];

#[test]
fn an_interrupted_bake_leaves_nothing_and_goes_on_from_there() {
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("home/microfacet-bake");
    let finished = || {
        fs::read_dir(&kept).map_or(0, |entries| {
            entries.filter(|entry| entry.as_ref().unwrap().path().extension().is_some()).count()
        })
    };
    let output = interrupt_after(start(folder.path(), &LONG), "-INT", || finished() > 1);
    let text = message(&output);
    assert!(text.starts_with("interrupted: no file is half written; "), "{text}");
    assert!(text.contains("new/out is as it was") && text.contains("goes on from there"), "{text}");
    assert!(output.stdout.is_empty());
    assert!(!folder.path().join("new").exists(), "the folder made for the set is left");
    // Finished tables were kept, and lead to the same set.
    let resumed = json(folder.path(), &LONG);
    assert!(resumed["baked"].as_u64().unwrap() < 5, "{}", resumed["baked"]);
    ok(folder.path(), &[&LONG[..5], &["fresh", "--no-cache"]].concat());
    let set = |out: &str| fs::read(folder.path().join(out).join("tables.safetensors")).unwrap();
    assert!(set("new/out") == set("fresh"));
}

#[test]
fn an_older_set_stays_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.toml"), ok(folder.path(), &["recipe"])).unwrap();
    ok(folder.path(), &["bake", "one.toml", "--out", "out", "--quality", "draft"]);
    let set = folder.path().join("out/tables.safetensors");
    let old = fs::read(&set).unwrap();
    let args = ["bake", "--quality", "high", "--out", "out", "--no-cache"];
    let child = start(folder.path(), &args);
    // It has begun once nobody else may lock the folder.
    let locked = || {
        let folder = fs::File::open(folder.path().join("out")).unwrap();
        folder.try_lock().is_err()
    };
    let text = message(&interrupt_after(child, "-TERM", locked));
    assert!(text.contains("out is as it was") && !text.contains("are kept"), "{text}");
    assert!(fs::read(&set).unwrap() == old);
    let entries = fs::read_dir(folder.path().join("out")).unwrap();
    assert_eq!(entries.count(), 1, "something is left beside the set");
}

#[test]
fn one_that_waits_for_input_ends_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let child = start(folder.path(), &["query", "g1", "--input", "-"]);
    // Signals are handled once this file of the kernel names them.
    let status = format!("/proc/{}/status", child.id());
    let handled = || match fs::read_to_string(&status) {
        Ok(text) => text.lines().any(|line| {
            let mask =
                line.strip_prefix("SigCgt:").map(|mask| u64::from_str_radix(mask.trim(), 16));
            mask.is_some_and(|mask| mask.unwrap() & 0b10 != 0)
        }),
        // Elsewhere it is given a moment.
        Err(_) => {
            std::thread::sleep(Duration::from_secs(2));
            true
        }
    };
    assert!(message(&interrupt_after(child, "-INT", handled)).contains("no file is half written"));
}
