//! Devices, pipes, endless and huge files, links, protected files and full disks, as input and as
//! output: every command ends soon, in little memory, and leaves what is not its own alone.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::{names, ok, refused, run};

use microfacet_baker::store;

const PROGRAM: &str = env!("CARGO_BIN_EXE_microfacet-bake");

/// Runs a script with the program as `$0`, with a gigabyte of address space and half a minute.
fn script(folder: &Path, text: &str) -> Output {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v 1048576; {text}"), PROGRAM])
        .env("XDG_CACHE_HOME", folder.join("home"))
        .env("RAYON_NUM_THREADS", "1")
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdout.take().unwrap();
    let stdout = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.read_to_end(&mut bytes).map(|_| bytes)
    });
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(30) {
            child.kill().unwrap();
            panic!("{text}: still running");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    Output { stdout: stdout.join().unwrap().unwrap(), ..output }
}

/// The message of a script that must be refused.
fn refuses(folder: &Path, text: &str, part: &str) {
    let output = script(folder, text);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}: {message}");
    assert!(message.contains(part), "{text}: {message}");
}

/// A folder with a FIFO, a sparse file of 5 GB, and recipes.
fn workshop() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(path("fifo")).status().unwrap().success());
    fs::File::create(path("sparse")).unwrap().set_len(5 << 30).unwrap();
    for (name, gamma) in [("gold", "3.0"), ("glass", "4.0")] {
        let recipe = format!("[[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = {gamma}\n");
        fs::write(path(&format!("{name}.toml")), recipe).unwrap();
    }
    folder
}

fn bake(folder: &Path, recipe: &str, out: &str, format: &str) -> String {
    ok(folder, &["bake", recipe, "--out", out, "--quality", "draft", "--format", format])
}

const SAMPLE: &str = "\"$0\" sample --sigma 0.3 --gamma 3 --theta 1 --count 1000 --out";

#[test]
fn what_is_no_file_is_not_read() {
    let folder = workshop();
    let at = folder.path();
    let mut paths = vec![("fifo", "FIFO"), ("sparse", "5368709120 bytes")];
    if Path::new("/dev/zero").exists() {
        paths.push(("/dev/zero", "character device"));
    }
    for (path, part) in paths {
        refuses(at, &format!("\"$0\" inspect {path}"), part);
        refuses(at, &format!("\"$0\" validate {path}"), part);
        refuses(at, &format!("\"$0\" query g1 --input - --tables {path}"), part);
        refuses(at, &format!("\"$0\" fit --input {path}"), part);
        // A CSV may be long, but not one row of it.
        let part = if path == "sparse" { "no end within 1 MiB" } else { part };
        refuses(at, &format!("\"$0\" query g1 --input {path}"), part);
        // As a file in a folder.
        let inside = at.join(format!("folder of {}", path.replace('/', "_")));
        fs::create_dir(&inside).unwrap();
        symlink(at.join(path), inside.join("tables.safetensors")).unwrap();
        refuses(at, &format!("\"$0\" inspect '{}'", inside.display()), "tables.safetensors");
    }
    // The way out is named.
    refuses(at, "\"$0\" fit --input fifo", "`-` for standard input");
}

#[test]
fn hidden_files_of_ours_that_are_not_are_refused() {
    for name in [".microfacet-bake.commit", ".microfacet-bake.files"] {
        let folder = workshop();
        let at = folder.path();
        bake(at, "gold.toml", "out", "exr");
        for hostile in ["fifo", "sparse"] {
            let _ = fs::remove_file(at.join("out").join(name));
            fs::rename(at.join(hostile), at.join("out").join(name)).unwrap();
            let part = "remove it";
            refuses(at, "\"$0\" bake gold.toml --out out --no-cache --quality draft", part);
            if name.ends_with("commit") {
                refuses(at, "\"$0\" inspect out", name);
            }
        }
        fs::remove_file(at.join("out").join(name)).unwrap();
        ok(at, &["inspect", "out"]);
    }
}

#[test]
fn endless_standard_input_is_refused() {
    let folder = workshop();
    let at = folder.path();
    let header = "sigma_x,sigma_y,gamma,theta,phi";
    fs::write(at.join("quote.csv"), format!("{header}\n0.3,0.3,3,1,0\n\"")).unwrap();
    for (input, line) in [("cat /dev/zero", 1), ("cat quote.csv /dev/zero", 3)] {
        let text = format!("{input} 2>/dev/null | \"$0\" query g1 --input -");
        refuses(at, &text, &format!("standard input: line {line}: no end within 1 MiB"));
    }
    refuses(at, "\"$0\" query g1 --input - < /dev/zero", "standard input: line 1: no end");
    refuses(at, "\"$0\" fit --input - < /dev/zero", "standard input: line 1: no end");
    refuses(at, "yes '0,1' | \"$0\" fit --input -", "more than 1000000 rows");
    // Rows of half a million fields are answered a few at a time.
    let more = ",".repeat(500_000);
    let rows = format!("{header}{more}\n{}", format!("0.3,0.3,3,1,0{more}\n").repeat(100));
    fs::write(at.join("wide.csv"), rows).unwrap();
    let output = script(at, "\"$0\" query g1 --method table --input - < wide.csv");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.stdout.iter().filter(|&&byte| byte == b'\n').count(), 101);
}

#[test]
fn fit_reads_standard_input() {
    let folder = workshop();
    let rows: String =
        (0..=80).map(|t| format!("{t},{}\n", (-0.002 * f64::from(t * t)).exp())).collect();
    fs::write(folder.path().join("m.csv"), rows).unwrap();
    let [file, piped] = ["m.csv", "- < m.csv"].map(|input| {
        let output = script(folder.path(), &format!("\"$0\" fit --degrees --input {input}"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    });
    assert_eq!(file, piped);
}

#[test]
fn a_cache_entry_that_cannot_be_read_is_baked_again() {
    let folder = workshop();
    let at = folder.path();
    let bake = "\"$0\" bake gold.toml --out out --cache cache --quality draft";
    assert_eq!(script(at, bake).status.code(), Some(0));
    let entries = names(&at.join("cache"));
    for hostile in ["fifo", "sparse", "/dev/zero"] {
        let entry = at.join("cache").join(&entries[0]);
        fs::remove_file(&entry).unwrap();
        symlink(at.join(hostile), &entry).unwrap();
        let output = script(at, bake);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(!text.contains("from the cache"), "{text}");
    }
    // What killed bakes leave there goes with the next entry, once it is old.
    let partial = at.join("cache/.microfacet-bake-x.partial");
    let file = fs::File::create(&partial).unwrap();
    file.set_modified(std::time::SystemTime::now() - Duration::from_secs(100_000)).unwrap();
    fs::remove_file(at.join("cache").join(&entries[0])).unwrap();
    assert_eq!(script(at, bake).status.code(), Some(0));
    assert!(!partial.exists());
}

#[test]
fn outputs_go_where_links_lead_and_keep_their_mode() {
    let folder = workshop();
    let at = folder.path();
    fs::create_dir(at.join("there.svg")).unwrap();
    symlink(at.join("fifo"), at.join("fifo.svg")).unwrap();
    symlink("/dev/null", at.join("null.svg")).unwrap();
    for (i, command) in [SAMPLE, "\"$0\" plot student-t --out"].into_iter().enumerate() {
        let (link, file) = (format!("link{i}.svg"), at.join(format!("there.svg/file{i}")));
        symlink(&file, at.join(&link)).unwrap();
        // Dangling, then to a private file.
        for _ in 0..2 {
            let output = script(at, &format!("{command} {link}"));
            assert_eq!(
                output.status.code(),
                Some(0),
                "{}",
                String::from_utf8_lossy(&output.stderr)
            );
            assert!(fs::symlink_metadata(at.join(&link)).unwrap().is_symlink());
            fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        }
        assert!(fs::metadata(&file).unwrap().len() > 1000);
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
        fs::set_permissions(&file, fs::Permissions::from_mode(0o400)).unwrap();
        refuses(at, &format!("{command} {link}"), "write-protected");
        refuses(at, &format!("{command} fifo.svg"), "FIFO");
        refuses(at, &format!("{command} there.svg"), "is a folder");
        assert!(fs::metadata(at.join("fifo")).unwrap().file_type().is_fifo());
        let output = script(at, &format!("{command} null.svg"));
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    }
    refuses(at, &format!("{SAMPLE} fifo"), "`--out -` for standard output");
    assert_eq!(names(&at.join("there.svg")), ["file0", "file1"]);
}

#[test]
fn modes_of_a_set_are_kept() {
    for format in ["safetensors", "exr,safetensors"] {
        let folder = workshop();
        let at = folder.path();
        bake(at, "gold.toml", "out", format);
        let file = at.join("out/tables.safetensors");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        let before = fs::read(&file).unwrap();
        bake(at, "glass.toml", "out", format);
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o640);
        assert_ne!(fs::read(&file).unwrap(), before);
        // One protected file protects the set.
        fs::set_permissions(&file, fs::Permissions::from_mode(0o440)).unwrap();
        let before: Vec<_> = names(&at.join("out"));
        let again = ["bake", "gold.toml", "--out", "out", "--quality", "draft", "--format", format];
        let message = refused(at, &again);
        assert!(message.contains("tables.safetensors: is write-protected"), "{message}");
        assert_eq!(names(&at.join("out")), before);
        // That is known before anything is read or baked.
        let message = refused(at, &["bake", "missing.toml", "--out", "out"]);
        assert!(message.contains("is write-protected"), "{message}");
        assert!(ok(at, &["inspect", "out"]).contains("glass"));
        fs::remove_file(&file).unwrap();
        fs::rename(at.join("fifo"), &file).unwrap();
        let message = refused(at, &again);
        assert!(message.contains("is a FIFO"), "{message}");
    }
}

#[test]
fn normals_go_to_standard_output() {
    let folder = workshop();
    let at = folder.path();
    let piped = script(at, &format!("{SAMPLE} - | cat"));
    assert!(String::from_utf8_lossy(&piped.stderr).contains("1000 normals on standard output"));
    ok(
        at,
        &[
            "sample", "--sigma", "0.3", "--gamma", "3", "--theta", "1", "--count", "1000", "--out",
            "n",
        ],
    );
    assert_eq!(piped.stdout, fs::read(at.join("n")).unwrap());
    // Nobody reads on.
    let output = script(at, &format!("({SAMPLE} -; echo $? > status) | true"));
    assert_eq!(fs::read_to_string(at.join("status")).unwrap(), "0\n", "{output:?}");
    assert!(!at.join("-").exists());
}

#[test]
fn only_what_a_set_recorded_is_removed() {
    let folder = workshop();
    let at = folder.path();
    let out = at.join("out");
    bake(at, "gold.toml", "out", "exr");
    let gold: Vec<_> = names(&out).into_iter().filter(|name| name.ends_with(".exr")).collect();
    let copy = out.join("backup_of_gold.exr");
    fs::copy(out.join(&gold[0]), &copy).unwrap();
    // Under a recorded name, but no table any more.
    fs::write(out.join(&gold[1]), "notes").unwrap();
    bake(at, "glass.toml", "out", "safetensors");
    assert_eq!(names(&out), ["backup_of_gold.exr", "tables.safetensors", gold[1].as_str()]);
    // A folder without a record: nothing is known to be ours but the set file.
    bake(at, "gold.toml", "other", "exr");
    fs::remove_file(at.join("other/.microfacet-bake.files")).unwrap();
    bake(at, "glass.toml", "other", "safetensors");
    let mut all = [gold.clone(), vec!["tables.safetensors".into()]].concat();
    all.sort();
    assert_eq!(names(&at.join("other")), all);
    // Back to images: the set file goes.
    bake(at, "gold.toml", "other", "exr");
    assert_eq!(names(&at.join("other")), [vec![".microfacet-bake.files".into()], gold].concat());
}

/// Neither replaced nor removed.
#[test]
fn a_protected_image_protects_its_set() {
    let folder = workshop();
    let at = folder.path();
    bake(at, "gold.toml", "out", "exr");
    let before = names(&at.join("out"));
    let image = at.join("out").join(&before[1]);
    fs::set_permissions(&image, fs::Permissions::from_mode(0o444)).unwrap();
    for recipe in ["gold.toml", "glass.toml"] {
        let message = refused(at, &["bake", recipe, "--out", "out", "--quality", "draft"]);
        assert!(message.contains(&format!("{}: is write-protected", before[1])), "{message}");
        assert_eq!(names(&at.join("out")), before);
    }
}

/// The folder of a file that is named without one is the current one.
#[test]
fn a_journal_beside_a_bare_name_is_completed() {
    let folder = workshop();
    bake(folder.path(), "gold.toml", "out", "safetensors");
    let out = folder.path().join("out");
    fs::write(out.join(".microfacet-bake.commit"), "").unwrap();
    ok(&out, &["inspect", "tables.safetensors"]);
    assert_eq!(names(&out), ["tables.safetensors"]);
}

#[test]
fn a_record_reaches_only_tables_in_its_folder() {
    let folder = workshop();
    let at = folder.path();
    bake(at, "gold.toml", "precious", "exr");
    let gold = names(&at.join("precious"));
    let image = &gold[1];
    let table = image.strip_suffix(".exr").unwrap();
    fs::create_dir(at.join("out")).unwrap();
    symlink(at.join("fifo"), at.join("out/fifo.exr")).unwrap();
    fs::write(at.join("out/photo.exr"), "photo").unwrap();
    fs::write(at.join("out/notes.txt"), "notes").unwrap();
    let record = format!(
        "../precious/{image}\n{}/precious/{image}\n..\n.\n\nfifo.exr\nphoto.exr\nnotes.txt\n{table}\n",
        at.display()
    );
    fs::write(at.join("out/.microfacet-bake.files"), record).unwrap();
    let output = script(at, "\"$0\" bake glass.toml --out out --quality draft --no-cache");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(&at.join("precious")), gold);
    assert_eq!(
        names(&at.join("out")),
        ["fifo.exr", "notes.txt", "photo.exr", "tables.safetensors"]
    );
}

#[test]
fn a_folder_of_images_is_a_set() {
    let folder = workshop();
    let at = folder.path();
    bake(at, "gold.toml", "both", "exr,safetensors");
    let whole = store::read(&at.join("both")).unwrap();
    fs::create_dir(at.join("images")).unwrap();
    let is_image = |name: &String| name.ends_with(".exr");
    let images: Vec<_> = names(&at.join("both")).into_iter().filter(is_image).collect();
    for name in &images {
        fs::copy(at.join("both").join(name), at.join("images").join(name)).unwrap();
    }
    fs::copy(at.join("both").join(&images[0]), at.join("images/a_copy.exr")).unwrap();
    let read = store::read(&at.join("images")).unwrap();
    let sorted = |set: &microfacet_sampler::Tables| {
        let mut tables = set.tables().to_vec();
        tables.sort_by(|a, b| a.name.cmp(&b.name));
        tables
    };
    assert_eq!((read.provenance(), read.tables()), (whole.provenance(), &sorted(&whole)[..]));
    assert!(ok(at, &["inspect", "images"]).contains("\"gold\": sigma "));
    ok(at, &["validate", "images", "--configurations", "2", "--samples", "1000"]);
    fs::write(at.join("q.csv"), "sigma_x,sigma_y,gamma,theta,phi\n0.3,0.3,3,1,0\n").unwrap();
    let query = |tables| ok(at, &["query", "g1", "--input", "q.csv", "--tables", tables]);
    assert_eq!(query("images"), query("both"));

    // Images of other programs are passed over, damaged ones are not.
    let frame = at.join("images/frame.exr");
    image(&frame);
    assert_eq!(store::read(&at.join("images")).unwrap().tables().len(), images.len());
    fs::write(&frame, "damaged").unwrap();
    let message = refused(at, &["inspect", "images"]);
    assert!(message.contains("frame.exr"), "{message}");
    fs::remove_file(&frame).unwrap();

    // Two bakes do not mix.
    bake(at, "glass.toml", "other", "exr");
    let other = names(&at.join("other")).into_iter().rfind(is_image).unwrap();
    fs::copy(at.join("other").join(&other), at.join("images").join(&other)).unwrap();
    let message = refused(at, &["inspect", "images"]);
    assert!(message.contains("different bakes") && message.contains(&other), "{message}");

    fs::create_dir(at.join("empty")).unwrap();
    let message = refused(at, &["inspect", "empty"]);
    assert!(message.contains("tables.safetensors") && message.contains("NAME.exr"), "{message}");
}

/// Writes an image that holds no table.
fn image(path: &Path) {
    exr::prelude::write_rgb_file(path, 2, 2, |_, _| (0.1_f32, 0.2_f32, 0.3_f32)).unwrap();
}

/// `/dev/full` and a limit on the size of files stand for a full disk.
#[test]
fn a_full_disk_is_reported_and_leaves_what_was_there() {
    let folder = workshop();
    let at = folder.path();
    let commands = [SAMPLE, "\"$0\" plot student-t --out"];
    for command in commands {
        fs::write(at.join("old.svg"), "old").unwrap();
        refuses(at, &format!("trap '' XFSZ; ulimit -f 4; {command} old.svg"), "old.svg: ");
        assert_eq!(fs::read_to_string(at.join("old.svg")).unwrap(), "old");
    }
    assert!(names(at).iter().all(|name| !name.ends_with(".partial")), "{:?}", names(at));
    if !Path::new("/dev/full").exists() {
        return;
    }
    symlink("/dev/full", at.join("full.svg")).unwrap();
    for command in commands {
        refuses(at, &format!("{command} full.svg"), "full.svg: No space left");
    }
    bake(at, "gold.toml", "out", "exr,safetensors");
    fs::write(at.join("q.csv"), "sigma_x,sigma_y,gamma,theta,phi\n0.3,0.3,3,1,0\n").unwrap();
    for command in [
        &format!("{SAMPLE} -"),
        "\"$0\" inspect out",
        "\"$0\" inspect out --json",
        "\"$0\" plot student-t",
        "\"$0\" query g1 --input q.csv",
    ] {
        refuses(at, &format!("{command} > /dev/full"), "No space left");
    }
    // A file of a set that leads to a full device.
    let before = names(&at.join("out"));
    let image = before.iter().find(|name| name.ends_with(".exr")).unwrap();
    let content = fs::read(at.join("out").join(image)).unwrap();
    fs::remove_file(at.join("out/tables.safetensors")).unwrap();
    symlink("/dev/full", at.join("out/tables.safetensors")).unwrap();
    let output = run(
        at,
        &[
            "bake",
            "glass.toml",
            "--out",
            "out",
            "--quality",
            "draft",
            "--format",
            "exr,safetensors",
        ],
    );
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("tables.safetensors: No space left"), "{message}");
    assert_eq!(names(&at.join("out")), before);
    assert_eq!(fs::read(at.join("out").join(image)).unwrap(), content);
}
