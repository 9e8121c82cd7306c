//! The program interrupted, as by Ctrl-C: it leaves only whole files, and reports what is left.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use crate::common::{Desk, PROGRAM, has, words};

fn start(desk: &Desk, line: &str) -> Child {
    let mut command = Command::new(PROGRAM);
    command.env("XDG_CACHE_HOME", desk.join("home")).args(words(line)).current_dir(desk.path());
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
    // Standard input stays open, since its end could end the program before the signal does.
    let _input = child.stdin.take();
    child.wait_with_output().unwrap()
}

/// Standard error, if the signal itself ended the program, so that a shell sees why.
fn message(output: &Output, signal: i32) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.signal(), Some(signal), "{text}");
    text
}

/// The finished tables in the cache.
fn finished(desk: &Desk) -> usize {
    let entries = fs::read_dir(desk.join("home/microfacet-bake"));
    entries.map_or(0, |entries| {
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(".safetensors")).count()
    })
}

/// A bake that takes a second on any machine: of the general set, without albedos.
const LONG: &str = "bake --no-albedo --threads 1 --out";

#[test]
fn an_interrupted_bake_leaves_nothing_and_goes_on_from_there() {
    let desk = Desk::new(&[]);
    let child = start(&desk, &format!("{LONG} new/out"));
    let output = interrupt_after(child, "-INT", || finished(&desk) > 1);
    let text = message(&output, 2);
    assert!(text.starts_with("interrupted: new/out is as it was; "), "{text}");
    has(&text, &["goes on from there"]);
    assert!(output.stdout.is_empty());
    assert!(!desk.join("new").exists(), "the folder made for the set is left");
    // Finished tables were kept, and lead to the same set.
    let resumed = desk.json(&format!("{LONG} new/out"));
    assert!(resumed["baked"].as_u64().unwrap() < 5, "{}", resumed["baked"]);
    assert_eq!(finished(&desk), 1, "one entry replaces those of single tables");
    desk.ok(&format!("{LONG} fresh --no-cache"));
    assert!(desk.read("new/out/tables.safetensors") == desk.read("fresh/tables.safetensors"));
}

#[test]
fn an_interrupted_export_leaves_nothing() {
    let desk = Desk::new(&[]);
    let lut = "export lut --gamma-min 1.6 --size 64x64x64 --format dds --out new/lut";
    let output = interrupt_after(start(&desk, lut), "-INT", || desk.join("new/lut").exists());
    let text = message(&output, 2);
    assert!(text.starts_with("interrupted: "), "{text}");
    assert!(!desk.join("new").exists(), "the folder made for the export is left");
}

#[test]
fn an_older_set_stays_as_it_was() {
    let desk = Desk::new(&[]);
    desk.ok("recipe --out one.toml");
    desk.ok("bake one.toml --out out --quality draft");
    let (old, before) = (desk.read("out/tables.safetensors"), finished(&desk));
    let child = start(&desk, &format!("{LONG} out"));
    let text = message(&interrupt_after(child, "-TERM", || finished(&desk) > before), 15);
    has(&text, &["interrupted: out is as it was; "]);
    assert!(desk.read("out/tables.safetensors") == old);
    let entries = fs::read_dir(desk.join("out")).unwrap();
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
    let desk = Desk::new(&[]);
    let child = start(&desk, "query g1 --input -");
    let id = child.id();
    // The program writes nothing before it has read a line.
    let text = message(&interrupt_after(child, "-INT", || handles(id, 2)), 2);
    assert!(text.starts_with("interrupted: "), "{text}");
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_ignored_stays_ignored() {
    let script = format!("trap '' HUP; exec '{PROGRAM}' query g1 --input -");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = shell.spawn().unwrap();
    // `nohup` ignores the signal in the same way.
    while !handles(child.id(), 2) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(!handles(child.id(), 1));
    let sent = Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    // The program continues to the end of its input.
    drop(child.stdin.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}
