//! The shader module in every language but its own, for `microfacet-export`, which holds what is
//! made here as files: `naga` compiles longer than that crate, and would make the same each time.
//!
//! Compares these files with translations that it makes; exit status 1 if one differs. With
//! `--write` it writes them.

mod languages;

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::LazyLock;

use microfacet_export::{
    Family, Host, Kind, Language, Shape, Storage, Target, family_shader_files, files,
    realtime_text, wgsl_crc32,
};
use microfacet_sampler::Tables;

/// Where they are, in the repository.
const FOLDER: &str = "crates/export/src/shader/translated";

/// The checksum of the WGSL that was translated.
const CHECKSUM: &str = "wgsl.crc32";

/// What to do if one differs.
const REMEDY: &str = "write all anew: cargo run --release --manifest-path clients/gpu/Cargo.toml \
    --bin translate -- --write";

/// Of functions for real time, which read no storage; GLSL ES has those of GLSL.
const FOR_REAL_TIME: [(&str, Language, Storage); 3] = [
    ("realtime.glsl", Language::Glsl, Storage::Texture),
    ("realtime.hlsl", Language::Hlsl, Storage::Texture),
    ("realtime.metal", Language::Msl, Storage::Texture),
];

/// By name; those of a family begin with `family_`.
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
    let kinds = [
        (Kind::Shapes, "", &FILES[..]),
        (Kind::Family, "family_", &FILES),
        (Kind::Realtime, "", &FOR_REAL_TIME),
    ];
    let all = kinds
        .iter()
        .flat_map(|&(kind, prefix, files)| files.iter().map(move |&file| (kind, prefix, file)));
    for (kind, prefix, (name, language, storage)) in all {
        let [module, sample] = exported(Language::Wgsl, storage, kind);
        let translation = languages::translate(&module, &sample, (language, storage, kind));
        let name = format!("{prefix}{name}");
        let path = folder.join(&name);
        if writes {
            fs::write(path, translation).expect(&name);
        } else if fs::read(path).expect(&name) != translation {
            eprintln!("error: {FOLDER}/{name} is no translation of the WGSL beside it");
            good = false;
        } else if !exported(language, storage, kind)[0].ends_with(&translation) {
            eprintln!("error: {language:?} by {storage:?} is exported without {FOLDER}/{name}");
            good = false;
        }
    }
    let count = kinds.iter().map(|(_, _, files)| files.len()).sum::<usize>();
    match (writes, good) {
        (true, _) => println!("{count} files written"),
        (false, true) => println!("{count} translations are those of the WGSL"),
        (false, false) => eprintln!("{REMEDY}"),
    }
    ExitCode::from(u8::from(!good))
}

/// Module and program of an export. They are the same for all shapes.
fn exported(language: Language, storage: Storage, kind: Kind) -> [Vec<u8>; 2] {
    let host = Host::default();
    let files = match kind {
        Kind::Shapes => files(&Target::Shader(language, storage, host), &[shape()]),
        Kind::Family => family_shader_files(language, storage, &host, family()),
        Kind::Realtime => realtime_text(language, &host),
    };
    let mut files = files.into_iter();
    [0; 2].map(|_| files.next().expect("a module and a program").contents)
}

/// A family, bound once.
fn family() -> &'static Family {
    static BOUND: LazyLock<Family> = LazyLock::new(|| {
        Family::bind(&Tables::embedded(), true).expect("the family of the default set")
    });
    &BOUND
}

fn shape() -> Shape {
    Shape::bind(&Tables::embedded(), 2.0).expect("a shape of the default set")
}
