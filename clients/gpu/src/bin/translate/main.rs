//! The shader module in every language but its own, for `microfacet-export`, which holds what is
//! made here as files: `naga` compiles longer than that crate, and would make the same each time.
//!
//! Compares these files with translations that it makes; exit status 1 if one differs. With
//! `--write` it writes them.

mod languages;

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use microfacet_export::{Host, Language, Shape, Storage, Target, files, wgsl_crc32};
use microfacet_sampler::Tables;

/// Where they are, in the repository.
const FOLDER: &str = "crates/export/src/shader/translated";

/// The checksum of the WGSL that was translated.
const CHECKSUM: &str = "wgsl.crc32";

/// What to do if one differs.
const REMEDY: &str = "write all anew: cargo run --release --manifest-path clients/gpu/Cargo.toml \
    --bin translate -- --write";

/// By name.
const FILES: [(&str, Language, Storage); 9] = [
    ("buffer.glsl", Language::Glsl, Storage::Buffer),
    ("texture.glsl", Language::Glsl, Storage::Texture),
    ("texture_es.glsl", Language::GlslEs, Storage::Texture),
    ("buffer.hlsl", Language::Hlsl, Storage::Buffer),
    ("texture.hlsl", Language::Hlsl, Storage::Texture),
    ("buffer.metal", Language::Msl, Storage::Buffer),
    ("texture.metal", Language::Msl, Storage::Texture),
    ("buffer.spv", Language::SpirV, Storage::Buffer),
    ("texture.spv", Language::SpirV, Storage::Texture),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let writes = match &arguments[..] {
        [] => false,
        [argument] if argument == "--write" => true,
        _ => {
            eprintln!("usage: translate [--write]");
            return ExitCode::from(2);
        }
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(FOLDER);
    let mut good = true;
    let checksum = wgsl_crc32(&shape()) + "\n";
    let path = folder.join(CHECKSUM);
    if writes {
        fs::write(path, checksum).expect(CHECKSUM);
    } else if fs::read_to_string(path).expect(CHECKSUM) != checksum {
        eprintln!("error: {FOLDER}/{CHECKSUM} is not that of the WGSL");
        good = false;
    }
    for (name, language, storage) in FILES {
        let [module, sample] = exported(Language::Wgsl, storage);
        let translation = languages::translate(&module, &sample, language, storage);
        let path = folder.join(name);
        if writes {
            fs::write(path, translation).expect(name);
        } else if fs::read(path).expect(name) != translation {
            eprintln!("error: {FOLDER}/{name} is no translation of the WGSL beside it");
            good = false;
        } else if !exported(language, storage)[0].ends_with(&translation) {
            eprintln!("error: {language:?} by {storage:?} is exported without {FOLDER}/{name}");
            good = false;
        }
    }
    match (writes, good) {
        (true, _) => println!("{} files written", FILES.len()),
        (false, true) => println!("{} translations are those of the WGSL", FILES.len()),
        (false, false) => eprintln!("{REMEDY}"),
    }
    ExitCode::from(u8::from(!good))
}

/// Module and program of an export. They are the same for all shapes.
fn exported(language: Language, storage: Storage) -> [Vec<u8>; 2] {
    let target = Target::Shader(language, storage, Host::default());
    let mut files = files(&target, &[shape()]).into_iter();
    [0; 2].map(|_| files.next().expect("a module and a program").contents)
}

fn shape() -> Shape {
    Shape::bind(&Tables::embedded(), 2.0).expect("a shape of the default set")
}
