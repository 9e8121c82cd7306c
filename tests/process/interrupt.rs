//! The program interrupted, as by Ctrl-C: it ends with whole files and says what is left.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use crate::common::{json, ok};

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
    // Held open: the end of its input could end the program before the signal does.
    let _input = child.stdin.take();
    child.wait_with_output().unwrap()
}

/// What it said, if it ended by the signal itself, so that a shell sees why.
fn message(output: &Output, signal: i32) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.signal(), Some(signal), "{text}");
    text
}

/// The finished tables in the cache.
fn finished(folder: &Path) -> usize {
    let entries = fs::read_dir(folder.join("home/microfacet-bake"));
    entries.map_or(0, |entries| {
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(".safetensors")).count()
    })
}

/// A bake that takes seconds: of the general set, without albedos.
const LONG: [&str; 6] = ["bake", "--no-albedo", "--quality", "high", "--out", "new/out"];

#[test]
fn an_interrupted_bake_leaves_nothing_and_goes_on_from_there() {
    let folder = tempfile::tempdir().unwrap();
    let child = start(folder.path(), &LONG);
    let output = interrupt_after(child, "-INT", || finished(folder.path()) > 1);
    let text = message(&output, 2);
    assert!(text.starts_with("interrupted: new/out is as it was; "), "{text}");
    assert!(text.contains("goes on from there"), "{text}");
    assert!(output.stdout.is_empty());
    assert!(!folder.path().join("new").exists(), "the folder made for the set is left");
    // Finished tables were kept, and lead to the same set.
    let resumed = json(folder.path(), &LONG);
    assert!(resumed["baked"].as_u64().unwrap() < 5, "{}", resumed["baked"]);
    assert_eq!(finished(folder.path()), 1, "one entry replaces those of single tables");
    ok(folder.path(), &[&LONG[..5], &["fresh", "--no-cache"]].concat());
    let set = |out: &str| fs::read(folder.path().join(out).join("tables.safetensors")).unwrap();
    assert!(set("new/out") == set("fresh"));
}

#[test]
fn an_interrupted_export_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let lut = ["export", "lut", "--gamma-min", "1.6", "--size", "64x64x64", "--format", "dds"];
    let child = start(folder.path(), &[&lut[..], &["--out", "new/lut"]].concat());
    let output = interrupt_after(child, "-INT", || folder.path().join("new/lut").exists());
    let text = message(&output, 2);
    assert!(text.starts_with("interrupted: "), "{text}");
    assert!(!folder.path().join("new").exists(), "the folder made for the export is left");
}

#[test]
fn an_older_set_stays_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.toml"), ok(folder.path(), &["recipe"])).unwrap();
    ok(folder.path(), &["bake", "one.toml", "--out", "out", "--quality", "draft"]);
    let set = folder.path().join("out/tables.safetensors");
    let old = fs::read(&set).unwrap();
    let before = finished(folder.path());
    let child = start(folder.path(), &[&LONG[..5], &["out"]].concat());
    let more = || finished(folder.path()) > before;
    let text = message(&interrupt_after(child, "-TERM", more), 15);
    assert!(text.contains("interrupted: out is as it was; "), "{text}");
    assert!(fs::read(&set).unwrap() == old);
    let entries = fs::read_dir(folder.path().join("out")).unwrap();
    assert_eq!(entries.count(), 1, "something is left beside the set");
}

/// Whether a process handles a signal, as the kernel says.
#[cfg(target_os = "linux")]
fn handles(child: u32, signal: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{child}/status")).unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & (1 << (signal - 1)) != 0
}

#[test]
#[cfg(target_os = "linux")]
fn one_that_waits_for_input_ends_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let child = start(folder.path(), &["query", "g1", "--input", "-"]);
    let id = child.id();
    // It writes nothing before it has read a line.
    let text = message(&interrupt_after(child, "-INT", || handles(id, 2)), 2);
    assert!(text.starts_with("interrupted: "), "{text}");
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_ignored_stays_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_microfacet-bake");
    let script = format!("trap '' HUP; exec '{program}' query g1 --input -");
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // As under `nohup`.
    while !handles(child.id(), 2) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(!handles(child.id(), 1));
    let sent = Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    // It goes on, to the end of its input.
    drop(child.stdin.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}
