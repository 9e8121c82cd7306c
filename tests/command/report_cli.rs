//! `report` as a command: what it refuses and leaves alone, and where its page goes.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::{names, ok, refused, run};

use microfacet_tables::{OLDEST_VERSION, VERSION};

/// A folder with a set that is quick to draw: a closed form, without tables.
fn workshop() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    bake(folder.path(), "gold", "2.0");
    folder
}

/// Bakes a set into the folder of its name.
fn bake(at: &Path, name: &str, gamma: &str) {
    let recipe = format!("[[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = {gamma}\n");
    let file = format!("{name}.toml");
    fs::write(at.join(&file), recipe).unwrap();
    ok(at, &["bake", &file, "--quality", "draft", "--out", name]);
}

/// Checks that a run is refused, with these words, and writes nothing.
#[track_caller]
fn refuses(at: &Path, args: &[&str], parts: &[&str]) {
    let before = names(at);
    let message = refused(at, &[&["report"], args].concat());
    for part in parts {
        assert!(message.contains(part), "{args:?}: no \"{part}\" in: {message}");
    }
    assert_eq!(names(at), before, "{args:?}");
}

#[test]
fn sets_of_other_versions_and_damaged_ones_are_refused() {
    let folder = workshop();
    let at = folder.path();
    bake(at, "glass", "3.0");
    let set = fs::read(at.join("glass/tables.safetensors")).unwrap();
    let file = at.join("set.safetensors");
    // The document is text within the head of the file, which keeps its length.
    let place = |what: &str| set.windows(what.len()).position(|at| at == what.as_bytes()).unwrap();
    let version = format!(r#"\"version\":{OLDEST_VERSION}"#);
    let mut newer = set.clone();
    newer[place(&version) + version.len() - 1] += (VERSION + 1 - OLDEST_VERSION) as u8;
    fs::write(&file, &newer).unwrap();
    let why = format!("version {} (this reader knows {OLDEST_VERSION} to {VERSION})", VERSION + 1);
    refuses(at, &["set.safetensors"], &["set.safetensors", &why, "bake again"]);
    fs::write(&file, &set[..set.len() - 1]).unwrap();
    refuses(at, &["set.safetensors"], &["set.safetensors", "not a valid table set"]);
    let mut flipped = set.clone();
    *flipped.last_mut().unwrap() ^= 1;
    fs::write(&file, &flipped).unwrap();
    refuses(at, &["set.safetensors"], &["set.safetensors", "checksum"]);
    // As it was, it is drawn.
    fs::write(&file, &set).unwrap();
    ok(at, &["report", "set.safetensors"]);
}

#[test]
fn a_page_takes_the_place_of_what_was_there() {
    let folder = workshop();
    let at = folder.path();
    let summary = ok(at, &["report", "gold"]);
    let page = fs::read(at.join("report.html")).unwrap();
    assert!(page.starts_with(b"<!DOCTYPE html>") && page.ends_with(b"</html>"));
    assert!(summary.starts_with("report.html ("), "{summary}");
    assert!(summary.contains(&format!("({} bytes)", page.len())), "{summary}");

    // Something longer than a page is replaced as a whole.
    fs::write(at.join("long.html"), vec![b'x'; 2 * page.len()]).unwrap();
    fs::hard_link(at.join("long.html"), at.join("other.html")).unwrap();
    assert_eq!(ok(at, &["--quiet", "report", "gold", "--out", "long.html"]), "");
    assert_eq!(fs::read(at.join("long.html")).unwrap(), page);
    assert_eq!(fs::read(at.join("other.html")).unwrap().len(), 2 * page.len());

    // A set that is refused leaves the page of another.
    fs::write(at.join("damaged"), "no set").unwrap();
    refuses(at, &["damaged", "--out", "long.html"], &["damaged"]);
    assert_eq!(fs::read(at.join("long.html")).unwrap(), page);
}

#[test]
fn an_empty_path_is_refused() {
    let folder = workshop();
    let at = folder.path();
    refuses(at, &["gold", "--out", ""], &[]);
    assert_eq!(names(&at.join("gold")), ["tables.safetensors"]);
}

#[cfg(unix)]
#[test]
fn modes_links_and_protection_are_respected() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
    let folder = workshop();
    let at = folder.path();
    let file = at.join("page.html");
    let mode = |mode| fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
    fs::write(&file, "old").unwrap();
    mode(0o640);
    symlink("page.html", at.join("link.html")).unwrap();
    ok(at, &["report", "gold", "--out", "link.html"]);
    assert!(fs::symlink_metadata(at.join("link.html")).unwrap().is_symlink());
    assert!(fs::read(&file).unwrap().starts_with(b"<!DOCTYPE html>"));
    assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o640);

    fs::write(&file, "old").unwrap();
    mode(0o440);
    refuses(at, &["gold", "--out", "page.html"], &["page.html: is write-protected"]);
    refuses(at, &["gold", "--out", "link.html"], &["is write-protected"]);
    assert_eq!(fs::read(&file).unwrap(), b"old");
    let fifo = std::process::Command::new("mkfifo").arg(at.join("fifo")).status();
    assert!(fifo.unwrap().success());
    refuses(at, &["gold", "--out", "fifo"], &["fifo: is a FIFO", "`--out -`"]);
}

#[test]
fn a_page_goes_to_standard_output() {
    let folder = workshop();
    let at = folder.path();
    ok(at, &["report", "gold"]);
    let page = fs::read_to_string(at.join("report.html")).unwrap();
    let written = |args: &[&str]| {
        let output = run(at, args);
        assert_eq!(output.status.code(), Some(0));
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(written(&["report", "gold", "--out", "-"]) == page);
    assert!(!at.join("-").exists());
    // The title is the name of the set, which may be a file.
    assert!(page.contains("<title>gold · microfacet-bake</title>"));
    let file = written(&["-q", "report", "gold/tables.safetensors", "-o", "-"]);
    assert!(file.contains("<title>tables.safetensors · microfacet-bake</title>"));
}

/// What `validate` prints of a set, with these options, into a file.
fn validate(at: &Path, set: &str, more: &[&str], file: &str) {
    let few = ["validate", set, "--samples", "20000", "--configurations", "20", "--json"];
    let output = run(at, &[&few[..], more].concat());
    assert!(output.status.code().is_some_and(|code| code <= 1));
    fs::write(at.join(file), output.stdout).unwrap();
}

#[test]
fn a_validation_is_shown_on_the_page_of_its_set() {
    let folder = workshop();
    let at = folder.path();
    let page = |args: &[&str]| ok(at, &[&["report"], args, &["--out", "-"]].concat());
    let bare = page(&["gold"]);
    assert!(bare.contains("microfacet-bake validate SET --json"));
    assert!(!bare.contains("Sorted p-values"));
    validate(at, "gold", &[], "good.json");
    let good = page(&["gold", "--validation", "good.json"]);
    for part in [">Passed<", "20 configurations", "Sorted p-values", "None was rejected"] {
        assert!(good.contains(part), "{part}");
    }
    assert!(!good.contains("microfacet-bake validate SET --json"));
    validate(at, "gold", &["--perturb-gamma", "2"], "bad.json");
    let bad = page(&["gold", "--validation", "bad.json"]);
    for part in [">Rejected<", "was multiplied by 2", "configurations were rejected"] {
        assert!(bad.contains(part), "{part}");
    }
    assert!(!bad.contains(">Passed<"));
    // An error of any size has a place on the axis.
    let text = fs::read_to_string(at.join("good.json")).unwrap();
    let mut wild: serde_json::Value = serde_json::from_str(&text).unwrap();
    wild["configurations"][0]["g1_error"] = 1e308.into();
    fs::write(at.join("wild.json"), wild.to_string()).unwrap();
    assert!(page(&["gold", "--validation", "wild.json"]).contains("the largest is 1.00e308"));
}

/// The image of a set is that set.
#[test]
fn a_validation_of_an_image_is_one_of_the_set() {
    let folder = workshop();
    let at = folder.path();
    fs::write(at.join("glass.toml"), "[[material]]\nname = \"glass\"\nsigma = 0.3\ngamma = 3.0\n")
        .unwrap();
    for format in ["safetensors", "exr"] {
        let words = ["bake", "glass.toml", "--quality", "draft", "--format", format];
        ok(at, &[&words[..], &["--out", format]].concat());
    }
    validate(at, "exr", &[], "image.json");
    ok(at, &["report", "safetensors", "--validation", "image.json"]);
    refuses(at, &["gold", "--validation", "image.json"], &["image.json: ", "another set"]);
}

#[test]
fn what_is_no_validation_is_refused() {
    let folder = workshop();
    let at = folder.path();
    let with = |file: &'static str| ["gold", "--validation", file];
    refuses(at, &with("absent.json"), &["absent.json"]);
    refuses(at, &with("gold"), &["gold: is a folder"]);
    validate(at, "gold", &[], "whole.json");
    let whole = fs::read_to_string(at.join("whole.json")).unwrap();
    let what = "not the result of a validation";
    for (broken, why) in [
        (String::new(), what),
        (whole[..whole.len() / 2].into(), what),
        ("[]".into(), what),
        (whole.replacen("\"set\"", "\"sets\"", 1), "missing field `set`"),
        (whole.replacen("\"gamma\": \"2\"", "\"gamma\": \"two\"", 1), "\"two\" is no number"),
    ] {
        assert_ne!(broken, whole);
        fs::write(at.join("broken.json"), broken).unwrap();
        refuses(at, &with("broken.json"), &["broken.json", why]);
    }
    let stressed = ["validate", "gold", "--stress", "--points", "1", "--json"];
    fs::write(at.join("stress.json"), ok(at, &stressed)).unwrap();
    refuses(at, &with("stress.json"), &["stress.json", what, "validate SET --json"]);
    let file = fs::File::create(at.join("huge.json")).unwrap();
    file.set_len(1 << 40).unwrap();
    refuses(at, &with("huge.json"), &["huge.json", "at most 64 MiB are read"]);
}
