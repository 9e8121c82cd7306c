//! The program as a process: killed, out of disk, denied access, run in parallel, asked for too
//! much.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Instant;

use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_microfacet-bake");

/// The one hidden file that belongs to a set of several files: their names.
const RECORD: &str = ".microfacet-bake.files";

/// A folder with two recipes whose sets differ in every file.
fn workshop() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    // The same tables, and so the same file names, for materials with other names, which every file
    // records.
    for name in ["old", "new"] {
        let recipe = format!("[[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = 3.0\n");
        fs::write(folder.path().join(format!("{name}.toml")), recipe).unwrap();
    }
    folder
}

fn bake(workshop: &TempDir, recipe: &str, out: &Path) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args([
        "bake",
        "--no-cache",
        "--quality",
        "draft",
        "--format",
        "exr,safetensors",
        "--threads",
        "1",
        "--out",
    ]);
    command.arg(out).arg(workshop.path().join(format!("{recipe}.toml")));
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

type Files = BTreeMap<String, Vec<u8>>;

/// What lies in a folder: files of sets, and the program's own hidden ones.
fn content(folder: &Path) -> (Files, Vec<String>) {
    let (mut files, mut hidden) = (Files::new(), Vec::new());
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with('.') {
            assert!(
                name.starts_with(".microfacet-bake"),
                "a leftover that does not say whose it is: {name}"
            );
            hidden.push(name);
        } else {
            files.insert(name, fs::read(&path).unwrap());
        }
    }
    (files, hidden)
}

/// The folder after an undisturbed bake.
fn baked(workshop: &TempDir, recipe: &str) -> (PathBuf, Files) {
    let out = workshop.path().join(format!("out of {recipe}"));
    let output = bake(workshop, recipe, &out).output().unwrap();
    assert!(output.status.success(), "{}", message(&output));
    let (files, hidden) = content(&out);
    assert!(files.len() > 2 && hidden == [RECORD], "{:?} {hidden:?}", files.keys());
    let record = fs::read_to_string(out.join(RECORD)).unwrap();
    assert!(record.lines().all(|name| files.contains_key(name)), "{record}");
    assert_eq!(record.lines().count(), files.len());
    (out, files)
}

/// 200 with `MICROFACET_KILLS=200`; a few otherwise.
#[test]
fn killed_at_any_moment_one_whole_set_is_there() {
    let kills: u32 = std::env::var("MICROFACET_KILLS").map_or(8, |n| n.parse().unwrap());
    let workshop = workshop();
    let start = Instant::now();
    let (out, old) = baked(&workshop, "old");
    let whole = start.elapsed();
    let (_, new) = baked(&workshop, "new");
    assert!(old.keys().eq(new.keys()) && old.iter().zip(&new).all(|(a, b)| a.1 != b.1));
    let (mut outcomes, mut recipes) = ([0; 3], ["new", "old"].into_iter().cycle());
    for i in 0..kills {
        let recipe = recipes.next().unwrap();
        let mut child = bake(&workshop, recipe, &out).spawn().unwrap();
        // Golden-ratio steps over the whole run and a little beyond.
        std::thread::sleep(whole.mul_f64(1.2 * (f64::from(i) * 0.618_033_988_75).fract()));
        child.kill().unwrap();
        child.wait().unwrap();
        let (files, hidden) = content(&out);
        let outcome = if files == old {
            0
        } else if files == new {
            1
        } else {
            // In the last step some files of the new set may not have their names yet, and a
            // journal says so.
            assert!(hidden.iter().any(|name| name == ".microfacet-bake.commit"), "mixture at {i}");
            let part_of =
                |set: &Files| files.iter().all(|(name, bytes)| set.get(name) == Some(bytes));
            assert!(part_of(&old) || part_of(&new), "mixture at {i}");
            // Whoever opens the folder next, even only to look, gets a whole set: that of this
            // bake, or the one before if this bake was killed while it completed that.
            let look =
                Command::new(PROGRAM).arg("inspect").arg(&out).stdout(Stdio::null()).status();
            assert!(look.unwrap().success());
            let (files, hidden) = content(&out);
            assert!((files == old || files == new) && hidden == [RECORD], "not completed at {i}");
            2
        };
        outcomes[outcome] += 1;
    }
    println!("{kills} kills: {outcomes:?} found the old set, the new one, one to be completed");
    let output = bake(&workshop, "new", &out).output().unwrap();
    assert!(output.status.success(), "{}", message(&output));
    assert_eq!(content(&out), (new.clone(), vec![RECORD.into()]));
}

#[test]
fn a_full_disk_leaves_the_old_set_and_says_so() {
    let workshop = workshop();
    let (out, old) = baked(&workshop, "old");
    let recipe = workshop.path().join("new.toml");
    // A limit on the size of files stands for a full disk. Without the trap the kernel kills the
    // process, which is tried too.
    for (trap, expected) in [("trap '' XFSZ; ", true), ("", false)] {
        let script = format!(
            "{trap}ulimit -f 4; exec \"$0\" bake --quality draft --format exr,safetensors --out \"$1\" \"$2\""
        );
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", &script, PROGRAM]).arg(&out).arg(&recipe).output().unwrap();
        assert!(!output.status.success());
        if expected {
            let text = message(&output);
            assert!(text.contains("File too large") && text.contains("out of old"), "{text}");
            assert_eq!(content(&out), (old.clone(), vec![RECORD.into()]));
        } else {
            assert_eq!(content(&out).0, old);
        }
    }
    // The next run tidies up.
    assert!(bake(&workshop, "old", &out).output().unwrap().status.success());
    assert_eq!(content(&out), (old, vec![RECORD.into()]));
}

#[test]
fn a_second_bake_into_a_folder_is_refused() {
    let workshop = workshop();
    let out = workshop.path().join("shared");
    fs::create_dir(&out).unwrap();
    let held = microfacet_baker::store::OutputFolder::open(&out).unwrap();
    let output = bake(&workshop, "old", &out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(message(&output).contains("another bake"), "{}", message(&output));
    drop(held);
    assert!(bake(&workshop, "old", &out).output().unwrap().status.success());
}

#[test]
fn outputs_that_are_no_folders_are_refused_before_baking() {
    let workshop = workshop();
    let path = |name: &str| workshop.path().join(name);
    let refused = |out: &Path, part: &str| {
        let output = bake(&workshop, "old", out).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{out:?}");
        assert!(message(&output).contains(part), "{out:?}: {}", message(&output));
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
    let (out, old) = baked(&workshop, "old");
    let link = workshop.path().join("link");
    std::os::unix::fs::symlink(&out, &link).unwrap();
    assert!(bake(&workshop, "new", &link).output().unwrap().status.success());
    assert_ne!(content(&out).0, old);
    // A folder where a file should go stops the bake before anything is replaced.
    let file = out.join("tables.safetensors");
    fs::remove_file(&file).unwrap();
    fs::create_dir(&file).unwrap();
    let before = fs::read(out.join("shadowing_gamma_3.exr")).unwrap();
    let output = bake(&workshop, "old", &out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(message(&output).contains("tables.safetensors"), "{}", message(&output));
    assert_eq!(fs::read(out.join("shadowing_gamma_3.exr")).unwrap(), before);
    // A link where a file should go is followed, and a bake killed meanwhile reaches no further.
    fs::remove_dir(&file).unwrap();
    let elsewhere = workshop.path().join("elsewhere");
    std::os::unix::fs::symlink(&elsewhere, &file).unwrap();
    assert!(bake(&workshop, "old", &out).output().unwrap().status.success());
    assert!(fs::symlink_metadata(&file).unwrap().is_symlink());
    assert_eq!(fs::read(&elsewhere).unwrap(), old["tables.safetensors"]);
    assert_eq!(content(&out), (old, vec![RECORD.into()]));
}

/// Headers that promise more than the file holds must not cost memory: half a gigabyte of address
/// space is enough to refuse them.
#[test]
fn inspecting_a_lie_takes_little_memory() {
    let workshop = workshop();
    let (out, _) = baked(&workshop, "old");
    let image = fs::read(out.join("shadowing_gamma_3.exr")).unwrap();
    let at = image.windows(10).position(|window| window == b"dataWindow").unwrap();
    // Name, type `box2i`, size, then x and y of either corner.
    let corner = at + 11 + 6 + 4 + 8;
    let mut lie = image.clone();
    lie[corner..corner + 8].copy_from_slice(&[0xff, 0xff, 0x0f, 0, 0xff, 0xff, 0x0f, 0]);
    // As long as its header says, by padding, but more than any image of a table.
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
        let path = workshop.path().join(name);
        fs::write(&path, bytes).unwrap();
        let script = "ulimit -v 524288; exec \"$0\" inspect \"$1\" --threads 1";
        let output = Command::new("sh").args(["-c", script, PROGRAM]).arg(&path).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", message(&output));
        assert!(message(&output).contains(part), "{}", message(&output));
    }
}

/// A stack that memory does not hold stands for a system that starts no more threads: none at all,
/// or none but the one that waits for signals.
#[test]
fn where_no_threads_can_be_started_one_does_the_work() {
    let workshop = workshop();
    let (expected, _) = baked(&workshop, "old");
    let whole = content(&expected).0;
    let recipe = workshop.path().join("old.toml");
    for (threads, stack) in [(1, 4_u64 << 30), (8, 600 << 20)] {
        let script = "ulimit -v 2097152; exec \"$0\" \"$@\"";
        let start = |words: &[&str]| {
            let mut shell = Command::new("sh");
            shell
                .args(["-c", script, PROGRAM])
                .args(words)
                .env("RUST_MIN_STACK", stack.to_string());
            shell.current_dir(workshop.path()).output().unwrap()
        };
        let options = ["--no-cache", "--quality", "draft", "--format", "exr,safetensors"];
        let out = format!("out of {stack}");
        let words = ["--threads", &threads.to_string(), "bake", recipe.to_str().unwrap()];
        let output = start(&[&words[..], &options, &["--out", &out]].concat());
        let text = message(&output);
        assert!(output.status.success(), "{text}");
        assert!(text.contains("warning: threads cannot be started") && text.contains("--threads"));
        assert!(content(&workshop.path().join(out)).0 == whole, "another set");
        // What divides no work has nothing to warn of.
        for words in [
            "recipe",
            "inspect",
            "completions bash",
            "man",
            "plot student-t --out a.svg",
            "sample --sigma 0.3 --gamma 3 --theta 1 --count 9 --out n",
        ] {
            let output = start(&words.split(' ').collect::<Vec<_>>());
            assert!(output.status.success() && output.stderr.is_empty(), "{}", message(&output));
        }
    }
}

#[test]
fn more_memory_than_allowed_is_refused_with_the_estimate() {
    let workshop = workshop();
    let wide =
        "[[material]]\nname = \"any\"\nsigma = 0.3\ngamma = { min = 1.501, max = \"inf\" }\n";
    fs::write(workshop.path().join("wide.toml"), wide).unwrap();
    let out = workshop.path().join("out");
    let output = bake(&workshop, "wide", &out).args(["--max-memory", "1M"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", message(&output));
    assert!(!out.exists());
    let text = message(&output);
    assert!(
        text.contains("values would take about") && text.contains("more than the 1 MiB allowed"),
        "{text}"
    );
    let output = bake(&workshop, "old", &out).args(["--max-memory", "512X"]).output().unwrap();
    assert!(
        message(&output).contains("such as 65536, 10K (10,000), 4GB or 4GiB"),
        "{}",
        message(&output)
    );
}
