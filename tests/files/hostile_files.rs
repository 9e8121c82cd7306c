//! Devices, pipes, endless and huge files, links, protected files and full disks, as input and as
//! output: every command ends soon, in little memory, and leaves other files alone.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::{names, ok, refused};

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

/// Runs a script that must be refused with a message that has `part`.
fn refuses(folder: &Path, text: &str, part: &str) {
    let output = script(folder, text);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}: {message}");
    assert!(message.contains(part), "{text}: {message}");
}

/// Standard output of a script that must succeed.
fn runs(folder: &Path, text: &str) -> Vec<u8> {
    let output = script(folder, text);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}: {message}");
    output.stdout
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
        // The same as a file in a folder.
        for name in ["tables.safetensors", "tables.exr", "tables.index.json"] {
            let inside = at.join(format!("folder of {} {name}", path.replace('/', "_")));
            fs::create_dir(&inside).unwrap();
            symlink(at.join(path), inside.join(name)).unwrap();
            refuses(at, &format!("\"$0\" inspect '{}'", inside.display()), name);
        }
    }
    // The message names the remedy.
    refuses(at, "\"$0\" fit --input fifo", "`-` for standard input");
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
    let answers = runs(at, "\"$0\" query g1 --method table --input - < wide.csv");
    assert_eq!(answers.iter().filter(|&&byte| byte == b'\n').count(), 101);
}

#[test]
fn fit_reads_standard_input() {
    let folder = workshop();
    let rows: String =
        (0..=80).map(|t| format!("{t},{}\n", (-0.002 * f64::from(t * t)).exp())).collect();
    fs::write(folder.path().join("m.csv"), rows).unwrap();
    let fit = |input| runs(folder.path(), &format!("\"$0\" fit --degrees --input {input}"));
    let [file, piped] = ["m.csv", "- < m.csv"].map(fit);
    assert_eq!(file, piped);
}

#[test]
fn a_cache_entry_that_cannot_be_read_is_baked_again() {
    let folder = workshop();
    let at = folder.path();
    let bake = "\"$0\" bake gold.toml --out out --cache cache --quality draft";
    runs(at, bake);
    let entry = at.join("cache").join(&names(&at.join("cache"))[0]);
    for hostile in ["fifo", "sparse", "/dev/zero"] {
        fs::remove_file(&entry).unwrap();
        symlink(at.join(hostile), &entry).unwrap();
        let text = String::from_utf8(runs(at, bake)).unwrap();
        assert!(!text.contains("from the cache"), "{text}");
    }
    // Old files that killed bakes left are removed when the next entry is written.
    let partial = at.join("cache/.microfacet-bake-x.partial");
    let file = fs::File::create(&partial).unwrap();
    file.set_modified(std::time::SystemTime::now() - Duration::from_secs(100_000)).unwrap();
    fs::remove_file(&entry).unwrap();
    runs(at, bake);
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
        // The link first has no target, then a private file.
        for _ in 0..2 {
            runs(at, &format!("{command} {link}"));
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
        runs(at, &format!("{command} null.svg"));
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    }
    refuses(at, &format!("{SAMPLE} fifo"), "`--out -` for standard output");
    assert_eq!(names(&at.join("there.svg")), ["file0", "file1"]);
}

#[test]
fn modes_of_a_set_are_kept() {
    for format in ["safetensors", "exr"] {
        let folder = workshop();
        let at = folder.path();
        bake(at, "gold.toml", "out", format);
        let name = format!("tables.{format}");
        let file = at.join("out").join(&name);
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        let before = fs::read(&file).unwrap();
        bake(at, "glass.toml", "out", format);
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o640);
        assert_ne!(fs::read(&file).unwrap(), before);
        // A protected file protects its set: it is neither replaced nor removed.
        fs::set_permissions(&file, fs::Permissions::from_mode(0o440)).unwrap();
        let again = |recipe, format| {
            let to = ["--out", "out", "--quality", "draft", "--format", format];
            refused(at, &[&["bake", recipe][..], &to].concat())
        };
        for recipe in ["gold.toml", "glass.toml"] {
            for format in ["safetensors", "exr"] {
                let message = again(recipe, format);
                assert!(message.contains(&format!("{name}: is write-protected")), "{message}");
                assert_eq!(names(&at.join("out")), [&name[..]]);
            }
        }
        // The check comes before anything is read or baked.
        let message = refused(at, &["bake", "missing.toml", "--out", "out"]);
        assert!(message.contains("is write-protected"), "{message}");
        assert!(ok(at, &["inspect", "out"]).contains("glass"));
        fs::remove_file(&file).unwrap();
        fs::rename(at.join("fifo"), &file).unwrap();
        let message = again("gold.toml", format);
        assert!(message.contains("is a FIFO"), "{message}");
    }
}

#[test]
fn normals_go_to_standard_output() {
    let folder = workshop();
    let at = folder.path();
    let piped = script(at, &format!("{SAMPLE} - | cat"));
    assert!(String::from_utf8_lossy(&piped.stderr).contains("1000 normals on standard output"));
    runs(at, &format!("{SAMPLE} n"));
    assert_eq!(piped.stdout, fs::read(at.join("n")).unwrap());
    // The pipe is closed at once.
    let output = script(at, &format!("({SAMPLE} -; echo $? > status) | true"));
    assert_eq!(fs::read_to_string(at.join("status")).unwrap(), "0\n", "{output:?}");
    assert!(!at.join("-").exists());
}

/// Other files in the folder of a set are left alone.
#[test]
fn only_the_set_of_a_folder_is_replaced() {
    let folder = workshop();
    let at = folder.path();
    let out = at.join("out");
    fs::create_dir(&out).unwrap();
    let others = ["backup.exr", "notes.txt", "tables-00001-00000000.safetensors", "tables.json"];
    for name in others {
        fs::write(out.join(name), name).unwrap();
    }
    symlink(at.join("fifo"), out.join("fifo.exr")).unwrap();
    for (material, format) in [("gold", "exr"), ("glass", "safetensors"), ("gold", "exr")] {
        bake(at, &format!("{material}.toml"), "out", format);
        let set = format!("tables.{format}");
        let mut all = [&others[..], &["fifo.exr", &set]].concat();
        all.sort();
        assert_eq!(names(&out), all);
        assert!(ok(at, &["inspect", "out"]).contains(material));
    }
}

#[test]
fn an_image_is_the_set_and_an_image_of_a_table_is_that_table() {
    let folder = workshop();
    let at = folder.path();
    bake(at, "gold.toml", "set", "safetensors");
    bake(at, "gold.toml", "image", "exr");
    let whole = store::read(&at.join("set")).unwrap();
    assert_eq!(store::read(&at.join("image")).unwrap(), whole);
    assert!(ok(at, &["inspect", "image"]).contains("\"gold\": sigma "));
    ok(at, &["validate", "image", "--configurations", "2", "--samples", "1000"]);
    fs::write(at.join("q.csv"), "sigma_x,sigma_y,gamma,theta,phi\n0.3,0.3,3,1,0\n").unwrap();
    let query = |tables| ok(at, &["query", "g1", "--input", "q.csv", "--tables", tables]);
    assert_eq!(query("image"), query("set"));

    let split = ["bake", "gold.toml", "--quality", "draft", "--out", "images", "--split"];
    let said = ok(at, &[&split[..], &["--format", "exr"]].concat());
    assert_eq!(names(&at.join("images")).len(), whole.tables().len());
    for table in whole.tables() {
        let image = store::read(&at.join(format!("images/{}.exr", table.name))).unwrap();
        assert_eq!(
            (image.provenance(), image.tables()),
            (whole.provenance(), std::slice::from_ref(table))
        );
    }
    // The command that is printed to run next names one image, since the folder is no set.
    let next = said.lines().last().unwrap().trim().strip_prefix("microfacet-bake ").unwrap();
    ok(at, &next.split(' ').collect::<Vec<_>>());
    let message = refused(at, &["inspect", "images"]);
    let any = "holds none of tables.safetensors, tables.exr, tables.index.json";
    assert!(message.contains(any), "{message}");
    assert!(refused(at, &split).contains("--format exr"));

    let photo = at.join("photo.exr");
    image(&photo);
    assert!(refused(at, &["inspect", "photo.exr"]).contains("another program wrote this image"));
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
    bake(at, "gold.toml", "out", "safetensors");
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
    // A set that leads to a full device.
    fs::remove_file(at.join("out/tables.safetensors")).unwrap();
    symlink("/dev/full", at.join("out/tables.safetensors")).unwrap();
    let again = ["bake", "glass.toml", "--out", "out", "--quality", "draft"];
    let message = refused(at, &again);
    assert!(message.contains("tables.safetensors: No space left"), "{message}");
    assert_eq!(names(&at.join("out")), ["tables.safetensors"]);
}
