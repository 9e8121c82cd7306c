//! A library baked in shards, by processes that run at once, repeat work, are killed or have other
//! options: always the same bytes.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::common::{json, names, ok, refused, run};
use microfacet_baker::store::{read, read_materials};
use microfacet_sampler::MicrofacetDistribution;
use microfacet_tables::{Index, IndexedSet};

/// Anisotropic mirrors, each with an albedo of its own, and a round one.
fn recipe(count: usize) -> String {
    let one = |i: usize| {
        let (x, y, gamma) = (0.2 + 0.02 * i as f64, 0.5, 30 + i % 2);
        let sigma = if i == 0 { "0.3".to_owned() } else { format!("[{x}, {y}]") };
        format!(
            "[[material]]\nname = \"m{i}\"\nsigma = {sigma}\ngamma = {gamma}\nfresnel = \"mirror\"\n\n"
        )
    };
    (0..count).map(one).collect()
}

fn folder(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("lib.toml"), recipe(count)).unwrap();
    folder
}

const DRAFT: [&str; 2] = ["--quality", "draft"];

fn shard(folder: &Path, share: &str) -> serde_json::Value {
    let args = ["bake", "lib.toml", "--shard", share, "--cache", "cache"];
    json(folder, &[&args, &DRAFT[..]].concat())
}

/// Standard error of a bake from the cache into `out`, and how many tables were baked.
fn assemble(folder: &Path, out: &str, more: &[&str]) -> (String, u64) {
    let args = ["bake", "lib.toml", "--cache", "cache", "--out", out, "--json"];
    let output = run(folder, &[&args, &DRAFT[..], more].concat());
    assert_eq!(output.status.code(), Some(0));
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    (String::from_utf8(output.stderr).unwrap(), said["baked"].as_u64().unwrap())
}

fn alone(folder: &Path, more: &[&str]) {
    let args = ["bake", "lib.toml", "--no-cache", "--out", "alone"];
    ok(folder, &[&args, &DRAFT[..], more].concat());
}

fn same(folder: &Path, a: &str, b: &str) {
    let (a, b) = (folder.join(a), folder.join(b));
    assert_eq!(names(&a), names(&b));
    for name in names(&a) {
        assert_eq!(fs::read(a.join(&name)).unwrap(), fs::read(b.join(&name)).unwrap(), "{name}");
    }
}

#[test]
fn shares_that_race_and_repeat_make_what_one_process_makes() {
    let folder = folder(5);
    let folder = folder.path();
    alone(folder, &[]);
    let racing = ["1/2", "2/2", "2/2"].map(|share| {
        Command::new(env!("CARGO_BIN_EXE_microfacet-bake"))
            .args(["bake", "lib.toml", "--cache", "cache", "--shard", share])
            .args(DRAFT)
            .current_dir(folder)
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    });
    for mut process in racing {
        assert!(process.wait().unwrap().success());
    }
    // Two shapes and five albedos, none of which is baked again.
    let again = [shard(folder, "1/2"), shard(folder, "2/2")];
    let sum = |key: &str| again.iter().map(|share| share[key].as_u64().unwrap()).sum::<u64>();
    assert_eq!((sum("needs"), sum("baked")), (7, 0));
    assert!(again.iter().all(|share| share["needs"].as_u64().unwrap() >= 2), "{again:?}");
    let (said, baked) = assemble(folder, "out", &[]);
    assert_eq!((&*said, baked), ("", 0));
    same(folder, "alone", "out");
}

#[test]
fn a_set_of_what_is_kept_alone_is_refused_if_anything_is_missing() {
    let folder = folder(3);
    let folder = folder.path();
    let only = ["bake", "lib.toml", "--cache", "cache", "--only-kept", "--out", "out"];
    let only = [&only, &DRAFT[..]].concat();
    let said = refused(folder, &only);
    assert!(said.contains("cache: 5 of 5 needs missing") && said.contains("--only-kept"), "{said}");
    let printed = ok(
        folder,
        &["bake", "lib.toml", "--shard", "1/2", "--cache", "cache", "--quality", "draft"],
    );
    // The command that is printed to run next has the options that the tables depend on.
    assert!(printed.contains("bake lib.toml --quality draft --cache cache --out DIR"), "{printed}");
    assert!(refused(folder, &only).contains("of 5 needs missing"));
    assert!(!folder.join("out").exists());
    shard(folder, "2/2");
    ok(folder, &only);
    alone(folder, &[]);
    same(folder, "alone", "out");
    // A damaged entry counts as missing.
    let entry = names(&folder.join("cache")).into_iter().find(|name| name.ends_with("tensors"));
    fs::write(folder.join("cache").join(entry.unwrap()), "damaged").unwrap();
    assert!(refused(folder, &only).contains("1 of 5 needs missing"));
}

#[test]
fn what_a_lost_share_leaves_out_is_said_and_baked() {
    let folder = folder(5);
    let folder = folder.path();
    alone(folder, &[]);
    shard(folder, "2/3");
    let mut lost = Command::new(env!("CARGO_BIN_EXE_microfacet-bake"))
        .args(["bake", "lib.toml", "--cache", "cache", "--shard", "1/3"])
        .args(DRAFT)
        .current_dir(folder)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(30));
    let _ = lost.kill();
    lost.wait().unwrap();
    let (said, baked) = assemble(folder, "out", &[]);
    assert!(said.contains("of 3 shards have not ended: ") && said.contains("baked now"), "{said}");
    assert!(said.contains(" of 7 needs missing, such as "), "{said}");
    assert!(baked > 0);
    same(folder, "alone", "out");
}

#[test]
fn shares_of_another_scene_or_version_are_said_and_not_mixed_in() {
    let folder = folder(4);
    let folder = folder.path();
    shard(folder, "1/2");
    let changed = recipe(4).replace(", 0.5]", ", 0.45]");
    assert_ne!(changed, recipe(4));
    fs::write(folder.join("lib.toml"), changed).unwrap();
    let args = ["bake", "lib.toml", "--shard", "2/2", "--cache", "cache"];
    let second = run(folder, &[&args, &DRAFT[..]].concat());
    let said = String::from_utf8_lossy(&second.stderr).into_owned();
    assert!(said.contains("shard 1/2 is of another state of lib.toml"), "{said}");
    alone(folder, &[]);
    let (said, _) = assemble(folder, "out", &[]);
    assert!(said.contains("1 of 2 shards has not ended: 1"), "{said}");
    assert!(said.contains("shard 1/2 is of another state of lib.toml"), "{said}");
    same(folder, "alone", "out");
    // Other options are another state as well.
    let high = ["bake", "lib.toml", "--shard", "1/2", "--cache", "cache", "--precision", "u16"];
    let said = run(folder, &[&high[..], &DRAFT[..]].concat()).stderr;
    assert!(String::from_utf8_lossy(&said).contains("or of other options"));
    // Receipts and entries of another version.
    let receipts = folder.join("cache").join("shards");
    for name in names(&receipts) {
        let path = receipts.join(name);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains("numerics "));
        fs::write(path, text.replace("numerics ", "numerics 9")).unwrap();
    }
    let entries = |name: &&String| name.ends_with(".safetensors");
    for name in names(&folder.join("cache")).iter().filter(entries) {
        // Names depend on keys, which hold the versions: other versions have other names.
        let other = name.chars().rev().collect::<String>().replace("srosnetefas.", "");
        let cache = folder.join("cache");
        fs::rename(cache.join(name), cache.join(other + ".safetensors")).unwrap();
    }
    let (said, baked) = assemble(folder, "out", &[]);
    assert!(said.contains("of another version (format") && said.contains("not used"), "{said}");
    assert!(baked > 0);
    same(folder, "alone", "out");
}

#[test]
fn more_materials_than_a_set_holds_become_numbered_sets() {
    let folder = folder(5);
    let folder = folder.path();
    let per_set = ["--per-set", "2"];
    alone(folder, &per_set);
    for share in ["1/2", "2/2"] {
        let args = ["bake", "lib.toml", "--shard", share, "--cache", "cache"];
        ok(folder, &[&args, &DRAFT[..], &per_set].concat());
    }
    let (said, baked) = assemble(folder, "out", &per_set);
    assert_eq!((&*said, baked), ("", 0));
    same(folder, "alone", "out");
    let mut expected: Vec<String> =
        index(&folder.join("out")).sets.into_iter().map(|set| set.file).collect();
    assert!(expected.len() == 3 && expected[2].starts_with("tables-00003-"), "{expected:?}");
    expected.push(Index::FILE.into());
    assert_eq!(names(&folder.join("out")), expected);

    // The folder and its index are opened alike, as a whole or for some materials.
    let whole = read(&folder.join("out")).unwrap();
    assert_eq!(whole.provenance().materials.len(), 5);
    assert_eq!(read(&folder.join("out").join(Index::FILE)).unwrap(), whole);
    let some = read_materials(&folder.join("out"), &["m4", "m1"]).unwrap();
    let listed = |set: &microfacet_sampler::Tables| -> Vec<String> {
        set.provenance().materials.iter().map(|entry| entry.name.clone()).collect()
    };
    assert_eq!(listed(&some), ["m1", "m4"]);
    assert!(some.tables().len() < whole.tables().len());
    for name in ["m1", "m4"] {
        let v = glam::Vec3::new(0.6, 0.0, 0.8);
        let [a, b] = [&some, &whole].map(|set| set.material(name).unwrap().g1(v));
        assert_eq!(a, b);
    }
    let why = read_materials(&folder.join("out"), &["m1", "gold"]).unwrap_err().to_string();
    assert!(why.contains("\"gold\"") && why.contains("5 materials"), "{why}");
    ok(folder, &["bake", "lib.toml", "--cache", "cache", "--out", "one", "--quality", "draft"]);
    let one = read_materials(&folder.join("one"), &["m3"]).unwrap();
    assert_eq!(listed(&one), ["m3"]);
    assert!(read_materials(&folder.join("one"), &["m9"]).is_err());
    ok(folder, &["inspect", "out"]);
    let again = ["bake", "lib.toml", "--cache", "cache", "--out", "out"];
    let text = ok(folder, &[&again, &DRAFT[..], &per_set].concat());
    let (_, next) = text.split_once("\nnext:\n").unwrap();
    let first = next.lines().next().unwrap().trim().strip_prefix("microfacet-bake inspect ");
    assert_eq!(
        next.lines().nth(1),
        first.map(|first| format!("  microfacet-bake report {first}")).as_deref()
    );

    // One set replaces three, and three replace one.
    ok(folder, &["bake", "lib.toml", "--cache", "cache", "--out", "out", "--quality", "draft"]);
    assert_eq!(names(&folder.join("out")), ["tables.safetensors"]);
    assert_eq!(
        fs::read(folder.join("out/tables.safetensors")).unwrap(),
        fs::read(folder.join("one/tables.safetensors")).unwrap()
    );
    assemble(folder, "one", &per_set);
    same(folder, "alone", "one");
}

fn index(folder: &Path) -> Index {
    Index::from_json(&fs::read_to_string(folder.join(Index::FILE)).unwrap()).unwrap()
}

/// Files of two libraries, of one set under two names, and others that an index does not list.
#[test]
fn numbered_sets_are_those_of_their_index() {
    let folder = folder(4);
    let folder = folder.path();
    alone(folder, &["--per-set", "2"]);
    fs::write(folder.join("lib.toml"), recipe(4).replace(", 0.5]", ", 0.45]")).unwrap();
    let other = ["bake", "lib.toml", "--no-cache", "--out", "other", "--per-set", "2"];
    ok(folder, &[&other, &DRAFT[..]].concat());
    let (own, foreign) = (index(&folder.join("alone")), index(&folder.join("other")));
    let file = |i: usize| folder.join("alone").join(&own.sets[i].file);
    let second = fs::read(file(1)).unwrap();
    let refused = |part: &str| {
        let why = read(&folder.join("alone")).unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
        let why = read_materials(&folder.join("alone"), &["m2"]).unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
    };
    let foreign = fs::read(folder.join("other").join(&foreign.sets[1].file)).unwrap();
    for wrong in [&foreign[..], &fs::read(file(0)).unwrap(), &second[..second.len() - 1], b""] {
        fs::write(file(1), wrong).unwrap();
        refused("it is of another library, or damaged");
    }
    fs::write(file(1), &second).unwrap();
    read(&folder.join("alone")).unwrap();
    // Listed with its checksum, but for other materials.
    let json = folder.join("alone").join(Index::FILE);
    let listed = fs::read_to_string(&json).unwrap();
    fs::write(&json, listed.replace("\"m2\"", "\"m2\", \"m5\"")).unwrap();
    refused("its material 2 is \"m3\", and tables.index.json lists \"m5\"");
    // One file under many names.
    let mut many = own.clone();
    many.sets = (1..=1500).map(|i| IndexedSet::new(i, &second, vec![format!("m{i}")])).collect();
    for set in &many.sets {
        let _ = fs::hard_link(file(1), folder.join("alone").join(&set.file));
    }
    fs::write(&json, many.to_json()).unwrap();
    refused("and tables.index.json lists");
    // Sizes are added up before a file is opened.
    many.sets.iter_mut().for_each(|set| set.bytes = 1 << 20);
    fs::write(&json, many.to_json()).unwrap();
    let why = read(&folder.join("alone")).unwrap_err().to_string();
    assert!(why.contains("1500 MiB together, and at most 256 MiB are read at once"), "{why}");
}

#[test]
fn what_cannot_be_shared_is_refused_by_name() {
    let folder = folder(2);
    let folder = folder.path();
    let says = |args: &[&str], what: &str| {
        let message = refused(folder, &[&["bake"], args].concat());
        assert!(message.contains(what), "{args:?}: {message}");
    };
    says(&["lib.toml", "--cache", "c", "--shard", "3/2"], "shard 3 of 2");
    says(&["lib.toml", "--cache", "c", "--shard", "0/2"], "from 1 to N");
    says(&["lib.toml", "--cache", "c", "--shard", "one"], "must be I/N");
    says(&["lib.toml", "--shard", "1/2"], "--cache");
    says(&["--cache", "c", "--shard", "1/2"], "SCENE");
    says(&["lib.toml", "--cache", "c", "--shard", "1/2", "--out", "o"], "--out");
    says(&["lib.toml", "--cache", "c", "--shard", "1/2", "--no-cache"], "--no-cache");
    says(&["lib.toml", "--cache", "c", "--shard", "1/2", "--max-bytes", "1MB"], "--max-bytes");
    says(&["lib.toml"], "--out");
    says(&["lib.toml", "--per-set", "0", "--out", "o"], "[1, 10000]");
    says(&["lib.toml", "--per-set", "1", "--out", "o", "--format", "exr"], "numbered sets");
    says(&["lib.toml", "--per-set", "1", "--out", "o", "--max-bytes", "1MB"], "--max-bytes");
    fs::write(folder.join("file"), "").unwrap();
    says(&["lib.toml", "--cache", "file", "--shard", "1/2"], "file");
    assert_eq!(names(folder), ["file", "lib.toml"]);
}

#[test]
fn a_plan_of_several_sets_lists_them() {
    let folder = folder(5);
    let folder = folder.path();
    let args = ["plan", "lib.toml", "--quality", "draft", "--per-set", "3"];
    let text = ok(folder, &args);
    for what in ["set 1  3 materials", "set 2", "2 numbered sets"] {
        assert!(text.contains(what), "{text}");
    }
    // A bake that takes seconds needs no shards.
    assert!(!text.contains("--shard"), "{text}");
    let many: String = (0..3000)
        .map(|i| format!("[[material]]\nname = \"{i}\"\nsigma = [0.1{i:04}, 0.5]\ngamma = 3\nfresnel = \"mirror\"\n"))
        .collect();
    std::fs::write(folder.join("many.toml"), many).unwrap();
    for more in [&[][..], &["--per-set", "2000"]] {
        let text = ok(folder, &[&["plan", "many.toml", "--albedo"], more].concat());
        let command = "microfacet-bake bake many.toml";
        assert!(text.contains(command) && text.contains("--albedo --shard I/"), "{text}");
    }
    let plan = json(folder, &args);
    assert_eq!(plan["sets"].as_array().unwrap().len(), 2);
    // Each set has two shapes.
    assert_eq!(plan["needs"], 7);
    assert!(plan["sets"][1]["materials"].as_array().unwrap().len() == 2);
}
