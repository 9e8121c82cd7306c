//! Composes modules that `microfacet-bake export wgsl` wrote with programs that import them, by
//! what links WGSL: naga_oil, as Bevy does, and WESL. What comes of it is valid and has the tables
//! where they should be, and names that a module has not are refused.
//!
//! Takes the folder of the exports. The programs that came with two of them it writes beside these
//! as SPIR-V, for `clients/gpu/vulkan.c`.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{ImageClass, Module, ScalarKind, TypeInner};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
};
use wesl::Wesl;

/// For single shapes.
const PROGRAM: &str = "
fn facets(lobe: StudentTLobe, v: vec3f, l: vec3f) -> f32 {
    return student_t_lobe_eval_pdf(lobe, v, l, STUDENT_T_HEIGHT_CORRELATED).x;
}

@fragment
fn fragment(@location(0) v: vec3f, @location(1) l: vec3f) -> @location(0) vec4f {
    let lobe = student_t_lobe_of(0u, vec2f(0.3));
    return vec4f(facets(lobe, v, l), student_t_lobe_d(lobe, v), 0.0, 1.0);
}
";

/// The same where functions take the tables, which are the program's.
const WITH_TABLES: &str = "
@group(2) @binding(5) var tables: texture_2d<f32>;

@fragment
fn fragment(@location(0) v: vec3f, @location(1) u: vec2f) -> @location(0) vec4f {
    let lobe = student_t_lobe_of(0u, vec2f(0.3), tables);
    let m = student_t_lobe_sample_visible_normal(lobe, v, u, tables);
    return vec4f(m, student_t_lobe_albedo(lobe, v.z, STUDENT_T_HEIGHT_CORRELATED, tables));
}
";

/// Without tables.
const CLOSED: &str = "
@fragment
fn fragment(@location(0) v: vec3f) -> @location(0) vec4f {
    return vec4f(student_t_closed_d(3.0, vec2f(0.3), v));
}
";

/// Group and binding, and the kind of numbers if it is a texture.
type Bound = (u32, u32, Option<ScalarKind>);

/// A module and a program as one.
type Composed = Result<Module, String>;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("the folder of the exports"));
    let of_family = PROGRAM.replace("_lobe_of(0u,", "_lobe_at(3.0,");
    let [float, uint] = [ScalarKind::Float, ScalarKind::Uint].map(Some);

    // In Bevy materials are group 3, and were 2 before 0.17.
    for group in [3, 2] {
        let by_bevy = |module: &Path, program: &str| by_naga_oil(module, program, Some(group));
        let at = folder.join("bevy/student_t.wgsl");
        composed(by_bevy, &at, PROGRAM, &[(group, 110, float)]);
        let at = folder.join("bevy-family/student_t_family.wgsl");
        composed(by_bevy, &at, &of_family, &[(group, 110, uint)]);
        println!("naga_oil: valid, with the tables in group {group}, the material's");
    }
    let linkers = [
        ("naga_oil", (|module, program| by_naga_oil(module, program, None)) as Linker),
        ("wesl", by_wesl),
    ];
    for (name, linker) in linkers {
        let of = |options: &str, file: &str| folder.join(format!("{name}{options}/{file}.wgsl"));
        composed(linker, &of("-family", "student_t_family"), &of_family, &[(0, 0, None)]);
        composed(linker, &of("-argument", "student_t"), WITH_TABLES, &[(2, 5, float)]);
        composed(linker, &of("", "student_t_closed"), CLOSED, &[]);
        let sample = fs::read_to_string(of("", "student_t_sample")).expect("a program");
        let bound = [(0, 0, None), (0, 1, None), (0, 2, None)];
        let words = composed(linker, &of("", "student_t"), &sample, &bound);
        fs::write(folder.join(name).join("student_t.spv"), words).expect("SPIR-V");
        println!("{name}: valid, by buffer, of a family, with tables as an argument, without them");
    }
}

type Linker = fn(&Path, &str) -> Composed;

/// Composes a program, which is valid and has these bindings, and no other; returns its SPIR-V.
fn composed(
    linker: impl Fn(&Path, &str) -> Composed,
    module: &Path,
    program: &str,
    bound: &[Bound],
) -> Vec<u8> {
    let refused = linker(module, &program.replace("student_t_", "student_t_no_"));
    assert!(refused.is_err(), "{} has what is in no module", module.display());
    let composed = linker(module, program).unwrap_or_else(|why| panic!("{module:?}: {why}"));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&composed).unwrap_or_else(|why| panic!("{module:?}: {why:?}"));
    let found = composed.global_variables.iter().map(|(_, variable)| {
        let place = variable.binding.as_ref().expect("a binding");
        let kind = match composed.types[variable.ty].inner {
            TypeInner::Image { class: ImageClass::Sampled { kind, .. }, .. } => Some(kind),
            _ => None,
        };
        (place.group, place.binding, kind)
    });
    let mut found: Vec<Bound> = found.collect();
    found.sort_by_key(|&(_, binding, _)| binding);
    assert_eq!(found, bound, "{}", module.display());
    let flags = spv::WriterFlags::empty();
    let options = spv::Options { lang_version: (1, 3), flags, ..spv::Options::default() };
    let words = spv::write_vec(&composed, &info, &options, None).expect("a valid module");
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// The names that a program takes from a module.
fn imported(program: &str) -> String {
    let words = program.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let prefixes = ["student_t_", "STUDENT_T_", "StudentT"];
    let names = words.filter(|word| prefixes.iter().any(|prefix| word.starts_with(prefix)));
    names.collect::<BTreeSet<&str>>().into_iter().collect::<Vec<_>>().join(", ")
}

/// As Bevy composes shaders: those without a path for imports have that of their file, in quotes.
fn by_naga_oil(module: &Path, program: &str, material: Option<u32>) -> Composed {
    let text = fs::read_to_string(module).expect("a module");
    let file = format!("\"{}\"", module.file_name().expect("a file").display());
    let has_path = text.starts_with("#define_import_path student_t\n");
    let name = if has_path { "student_t" } else { &file };
    let mut composer = Composer::default();
    let module = ComposableModuleDescriptor {
        source: &text,
        as_name: (!has_path).then(|| file.clone()),
        ..ComposableModuleDescriptor::default()
    };
    let added = composer.add_composable_module(module).map(|_| ());
    added.map_err(|why| why.emit_to_string(&composer))?;
    let program = format!("#import {name}::{{{}}}\n{program}", imported(program));
    let groups = material.map(|group| ("MATERIAL_BIND_GROUP".into(), ShaderDefValue::UInt(group)));
    let whole = NagaModuleDescriptor {
        source: &program,
        shader_defs: HashMap::from_iter(groups),
        ..NagaModuleDescriptor::default()
    };
    composer.make_naga_module(whole).map_err(|why| why.emit_to_string(&composer))
}

/// A package of the module and of a program beside it, as WGSL that naga reads.
fn by_wesl(module: &Path, program: &str) -> Composed {
    let folder = module.parent().expect("a folder");
    let name = module.file_stem().expect("a file").display();
    let program = format!("import package::{name}::{{{}}};\n{program}", imported(program));
    fs::write(folder.join("program.wesl"), program).expect("a program");
    let root = "package::program".parse().expect("a path");
    let text = Wesl::new(folder).compile(&root).map_err(|why| why.to_string())?.to_string();
    naga::front::wgsl::parse_str(&text).map_err(|why| why.emit_to_string(&text))
}
