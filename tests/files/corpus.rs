//! The seeds of the fuzz targets and the inputs that fuzzing has found, on a stable compiler: each
//! is read or refused.

use std::fs;
use std::path::Path;

include!("../../fuzz/fuzz_targets/common.rs");

/// The files of a target's folder of seeds, and of its corpus, if fuzzing has left one.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let list = |kind: &str| fs::read_dir(fuzz.join(kind).join(target)).into_iter().flatten();
    let files: Vec<_> = list("seeds")
        .chain(list("corpus"))
        .map(|entry| fs::read(entry.unwrap().path()).unwrap())
        .collect();
    assert!(!files.is_empty(), "no seeds for {target}");
    files
}

/// A seed that is refused at its first byte reaches no code: bake seeds anew when the format
/// changes, as `docs/reliability.md` says.
#[test]
fn seeds_of_table_files_are_of_this_version() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    for target in ["loader", "image"] {
        for entry in fs::read_dir(folder.join(target)).unwrap() {
            let path = entry.unwrap().path();
            if !path.file_name().unwrap().to_str().unwrap().starts_with("refused_") {
                microfacet_baker::store::read(&path)
                    .unwrap_or_else(|why| panic!("{}: {why}", path.display()));
            }
        }
    }
}

/// A bake left this entry in the cache; the key of another version would refuse it.
#[test]
fn the_seed_of_an_entry_is_believed() {
    assert!(entry(include_bytes!("../../fuzz/seeds/entry/gamma_3.safetensors")));
}

/// The decoder of B44 in `exr` 1.74.2 overflows on these blocks, and must not be called.
#[test]
fn an_image_by_another_compression_is_refused_undecoded() {
    let image = include_bytes!("../../fuzz/seeds/image/refused_b44.exr");
    let message = microfacet_baker::store::decode_exr(image).unwrap_err().to_string();
    assert!(message.contains("b44 compression, and tables are"), "{message}");
}

#[test]
fn table_files() {
    seeds("loader").iter().for_each(|bytes| load(bytes));
    seeds("index").iter().for_each(|bytes| index(bytes));
    for bytes in seeds("entry") {
        entry(&bytes);
    }
    for bytes in seeds("image") {
        let _ = microfacet_baker::store::decode_exr(&bytes);
    }
}

#[test]
fn scenes() {
    let targets = [
        ("recipe", "a.toml"),
        ("pbrt", "a.pbrt"),
        ("mitsuba", "a.xml"),
        ("gltf", "a.gltf"),
        ("materialx", "a.mtlx"),
    ];
    for (target, name) in targets {
        seeds(target).iter().for_each(|bytes| scene(name, bytes));
    }
}
