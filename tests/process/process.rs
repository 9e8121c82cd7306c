//! The program as a process: killed, out of disk, denied access, run in parallel, out of memory or
//! threads.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use microfacet_baker::store;

use crate::common::{Desk, PROGRAM, has, material, words};

/// A folder with two recipes whose sets differ in every file.
fn workshop() -> Desk {
    // The same tables for materials with other names.
    let recipe = |name: &str| {
        [1, 2].map(|i| material(&format!("{name} {i}"), "sigma = 0.3\ngamma = 3.0")).concat()
    };
    Desk::new(&[("old.toml", &recipe("old")), ("new.toml", &recipe("new"))])
}

fn bake(workshop: &Desk, recipe: &str, out: &Path) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(words("bake --no-cache --quality draft --threads 1 --out")).arg(out);
    command.arg(workshop.join(&format!("{recipe}.toml")));
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

type Files = BTreeMap<String, Vec<u8>>;

/// The content of a folder: the files of a set, and the program's own hidden ones.
fn content(folder: &Path) -> (Files, Vec<String>) {
    let (mut files, mut hidden) = (Files::new(), Vec::new());
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with('.') {
            assert!(
                name.starts_with(".microfacet-bake-") && name.ends_with(".partial"),
                "a leftover that does not say whose it is: {name}"
            );
            hidden.push(name);
        } else {
            files.insert(name, fs::read(&path).unwrap());
        }
    }
    (files, hidden)
}

/// The kinds of a set's files: the options that ask for them, and their number.
const FORMS: [(&[&str], usize); 3] =
    [(&[], 1), (&["--format", "exr"], 1), (&["--per-set", "1"], 3)];

/// The folder after an undisturbed bake.
fn baked(workshop: &Desk, recipe: &str, (form, count): (&[&str], usize)) -> (PathBuf, Files) {
    let out = workshop.join(&format!("out of {recipe} {}", form.join(" ")));
    let output = bake(workshop, recipe, &out).args(form).output().unwrap();
    assert!(output.status.success(), "{}", message(&output));
    let (files, hidden) = content(&out);
    assert!(files.len() == count && hidden.is_empty(), "{:?} {hidden:?}", files.keys());
    (out, files)
}

/// The names of the materials of the set in a folder.
fn read(folder: &Path) -> Vec<String> {
    let set = store::read(folder).unwrap();
    assert!(!set.tables().is_empty());
    set.provenance().materials.iter().map(|entry| entry.name.clone()).collect()
}

const OLD: [&str; 2] = ["old 1", "old 2"];
const NEW: [&str; 2] = ["new 1", "new 2"];

/// 8 kills, or `MICROFACET_KILLS`. Each bake writes other kinds of files than the one before.
#[test]
fn killed_at_any_moment_one_whole_set_is_there() {
    let kills: u32 = std::env::var("MICROFACET_KILLS").map_or(8, |n| n.parse().unwrap());
    let workshop = workshop();
    let whole: Vec<_> = FORMS.map(|form| (form, baked(&workshop, "new", form).1)).into();
    let start = Instant::now();
    let (out, _) = baked(&workshop, "old", FORMS[0]);
    let time = start.elapsed();
    let mut outcomes = [0; 2];
    for i in 0..kills {
        let (form, _) = FORMS[i as usize % FORMS.len()];
        let recipe = ["new", "old"][i as usize % 2];
        let mut child = bake(&workshop, recipe, &out).args(form).spawn().unwrap();
        // Golden-ratio steps over the whole run and a little beyond.
        std::thread::sleep(time.mul_f64(1.2 * (f64::from(i) * 0.618_033_988_75).fract()));
        child.kill().unwrap();
        child.wait().unwrap();
        let names = read(&out);
        assert!(names == OLD || names == NEW, "a mixture at {i}: {names:?}");
        outcomes[usize::from(names == NEW)] += 1;
    }
    println!("{kills} kills: {outcomes:?} found the old set, the new one");
    // A bake that is not killed leaves nothing of the others.
    for (form, expected) in whole {
        let output = bake(&workshop, "new", &out).args(form.0).output().unwrap();
        assert!(output.status.success(), "{}", message(&output));
        let mut files = content(&out).0;
        if form.1 == 1 {
            // Numbered sets of a killed bake, which no index lists, are removed after a day.
            files.retain(|name, _| !name.starts_with("tables-"));
        }
        assert!(expected.iter().all(|(name, bytes)| files.get(name) == Some(bytes)));
        assert!(form.1 > 1 || files.len() == 1, "{:?}", files.keys());
    }
}

/// Two bakes overwrite each other's set, in turn with each kind of files, while the test reads it.
#[test]
fn beside_two_writers_every_read_finds_a_whole_set() {
    let workshop = workshop();
    let (out, _) = baked(&workshop, "old", FORMS[0]);
    let end = Instant::now() + Duration::from_millis(1500);
    let cache = workshop.join("cache");
    let (reads, seen) = std::thread::scope(|scope| {
        for (recipe, first) in [("old", 0), ("new", 1)] {
            let (workshop, out, cache) = (&workshop, &out, &cache);
            scope.spawn(move || {
                for (form, _) in FORMS.iter().cycle().skip(first) {
                    let mut command = Command::new(PROGRAM);
                    command.args(["bake", "--quality", "draft", "--threads", "1", "--quiet"]);
                    command.args(["--out".as_ref(), out.as_os_str(), "--cache".as_ref()]);
                    command.arg(cache).arg(workshop.join(&format!("{recipe}.toml")));
                    let output = command.args(*form).output().unwrap();
                    assert!(output.status.success(), "{}", message(&output));
                    if Instant::now() > end {
                        return;
                    }
                }
            });
        }
        let (mut reads, mut seen) = (0, [false; 2]);
        while Instant::now() < end {
            let names = read(&out);
            assert!(names == OLD || names == NEW, "a mixture: {names:?}");
            seen[usize::from(names == NEW)] = true;
            reads += 1;
        }
        (reads, seen)
    });
    println!("{reads} reads");
    assert!(reads > 20 && seen == [true; 2], "{reads} reads, {seen:?}");
}

#[test]
fn a_full_disk_leaves_the_old_set_and_says_so() {
    let workshop = workshop();
    let recipe = workshop.join("new.toml");
    for form in FORMS {
        let (out, old) = baked(&workshop, "old", form);
        // A limit on the size of files stands for a full disk. Without the trap the kernel kills
        // the process, which is tried too.
        for (trap, expected) in [("trap '' XFSZ; ", true), ("", false)] {
            let script =
                format!("{trap}ulimit -f 4; exec \"$0\" bake --quality draft --no-cache \"$@\"");
            let mut shell = Command::new("sh");
            shell.args(["-c", &script, PROGRAM]).args(form.0).arg("--out").arg(&out).arg(&recipe);
            let output = shell.output().unwrap();
            assert!(!output.status.success());
            let (files, hidden) = content(&out);
            assert_eq!(files, old);
            if expected {
                has(&message(&output), &["File too large", "out of old"]);
                assert!(hidden.is_empty(), "{hidden:?}");
            }
        }
    }
}

#[test]
fn outputs_that_are_no_folders_are_refused_before_baking() {
    let workshop = workshop();
    let path = |name: &str| workshop.join(name);
    let refused = |out: &Path, part: &str| {
        let output = bake(&workshop, "old", out).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{out:?}");
        has(&message(&output), &[part]);
    };
    refused(&path("old.toml"), "is a file");
    refused(&path("old.toml/inside"), "Not a directory");
    std::os::unix::fs::symlink(path("nowhere"), path("dangling")).unwrap();
    refused(&path("dangling"), "dangling");
    let locked = path("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, std::os::unix::fs::PermissionsExt::from_mode(0o555)).unwrap();
    // The administrator may write anywhere but into the kernel's own folders.
    if tempfile::tempfile_in(&locked).is_err() {
        refused(&locked, "Permission denied");
    } else if Path::new("/proc/self/status").exists() {
        refused(Path::new("/proc"), "/proc");
    }
}

#[test]
fn folders_and_links_in_place_of_files() {
    let workshop = workshop();
    // A link to a folder is followed.
    let (out, old) = baked(&workshop, "old", FORMS[0]);
    let link = workshop.join("link");
    std::os::unix::fs::symlink(&out, &link).unwrap();
    assert!(bake(&workshop, "new", &link).output().unwrap().status.success());
    assert_eq!(read(&out), NEW);
    // A folder where a file should go stops the bake before it begins.
    let file = out.join("tables.safetensors");
    fs::remove_file(&file).unwrap();
    fs::create_dir(&file).unwrap();
    let output = bake(&workshop, "old", &out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    has(&message(&output), &["tables.safetensors"]);
    // A link where a file should go is followed.
    fs::remove_dir(&file).unwrap();
    let elsewhere = workshop.join("elsewhere");
    std::os::unix::fs::symlink(&elsewhere, &file).unwrap();
    assert!(bake(&workshop, "old", &out).output().unwrap().status.success());
    assert!(fs::symlink_metadata(&file).unwrap().is_symlink());
    assert_eq!(fs::read(&elsewhere).unwrap(), old["tables.safetensors"]);
    assert_eq!(content(&out), (old, Vec::new()));
}

/// Headers that declare more than the file holds must not cost memory: they are refused within half
/// a gigabyte of address space.
#[test]
fn inspecting_a_lie_takes_little_memory() {
    let workshop = workshop();
    let (out, _) = baked(&workshop, "old", FORMS[0]);
    let (images, _) = baked(&workshop, "old", FORMS[1]);
    let image = fs::read(images.join("tables.exr")).unwrap();
    let at = image.windows(10).position(|window| window == b"dataWindow").unwrap();
    // Name, type `box2i`, size, then x and y of either corner.
    let corner = at + 11 + 6 + 4 + 8;
    let mut lie = image.clone();
    lie[corner..corner + 8].copy_from_slice(&[0xff, 0xff, 0x0f, 0, 0xff, 0xff, 0x0f, 0]);
    // Padded to the length that its header declares, but more than any image of a table.
    let mut large = image;
    large[corner..corner + 8].copy_from_slice(&[0xff, 0x1f, 0, 0, 0xff, 0x1f, 0, 0]);
    large.resize(9 << 20, 0);
    let mut long_header = fs::read(out.join("tables.safetensors")).unwrap();
    long_header[..8].copy_from_slice(&99_000_000_u64.to_le_bytes());
    for (name, bytes, part) in [
        ("lie.exr", lie, "1048576"),
        ("large.exr", large, "at most 64 MiB"),
        ("long.safetensors", long_header, "not a valid table set"),
    ] {
        let path = workshop.join(name);
        fs::write(&path, bytes).unwrap();
        let script = "ulimit -v 524288; exec \"$0\" inspect \"$1\" --threads 1";
        let output = Command::new("sh").args(["-c", script, PROGRAM]).arg(&path).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", message(&output));
        has(&message(&output), &[part]);
    }
}

/// A stack larger than memory stands for a system that starts no more threads: none at all, or only
/// the one that waits for signals.
#[test]
fn where_no_threads_can_be_started_one_does_the_work() {
    let workshop = workshop();
    let (_, whole) = baked(&workshop, "old", FORMS[0]);
    for (threads, stack) in [(1, 4_u64 << 30), (8, 600 << 20)] {
        let script = "ulimit -v 2097152; exec \"$0\" \"$@\"";
        let start = |line: &str| {
            let mut shell = Command::new("sh");
            shell.args(["-c", script, PROGRAM]).args(words(line)).current_dir(workshop.path());
            shell.env("RUST_MIN_STACK", stack.to_string()).output().unwrap()
        };
        let bake = "bake old.toml --no-cache --quality draft --out";
        let output = start(&format!("--threads {threads} {bake} {stack}"));
        let text = message(&output);
        assert!(output.status.success(), "{text}");
        has(&text, &["warning: threads cannot be started", "--threads"]);
        assert!(content(&workshop.join(&stack.to_string())).0 == whole, "another set");
        // Commands that divide no work give no warning.
        for line in [
            "recipe",
            "inspect",
            "completions bash",
            "man",
            "plot student-t --out a.svg",
            "sample --sigma 0.3 --gamma 3 --theta 1 --count 9 --out n",
        ] {
            let output = start(line);
            assert!(output.status.success() && output.stderr.is_empty(), "{}", message(&output));
        }
    }
}
