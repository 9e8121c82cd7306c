//! Shading languages from WGSL, by `naga`.
//!
//! A module without an entry point is no shader to most of its writers. So each gets one, which is
//! cut off again. Names that a writer makes up are made those of this module, and what the user
//! has to bind gets its name from here.

use microfacet_export::{Kind, Language, Storage};
use naga::back::{glsl, hlsl, msl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};

/// The entry point that is cut off.
const ENTRY: &str = "student_t_impl_entry";

/// A module in WGSL in another language; in SPIR-V, with a program that uses it.
pub fn translate(
    module: &[u8],
    program: &[u8],
    (language, storage, kind): (Language, Storage, Kind),
) -> Vec<u8> {
    let [wgsl, program] = [module, program].map(|text| str::from_utf8(text).expect(OURS));
    match language {
        Language::SpirV => {
            let words = spirv(&format!("{wgsl}{program}"));
            words.into_iter().flat_map(u32::to_le_bytes).collect()
        }
        _ => text(wgsl, language, storage, kind).into(),
    }
}

/// A module of functions as text.
fn text(wgsl: &str, language: Language, storage: Storage, kind: Kind) -> String {
    let stage =
        if language == Language::GlslEs { "fragment" } else { "compute @workgroup_size(1)" };
    // What uses the tables, if there are any.
    let used = match kind {
        Kind::Shapes => "student_t_impl_pair(0u)",
        Kind::Family => "student_t_impl_word(0u)",
        Kind::Realtime => "student_t_impl_texel(0.0, 1.0)",
    };
    let entry = format!("@{stage} fn {ENTRY}() {{ _ = {used}; }}\n");
    let (module, info) = parse(&format!("{wgsl}\n{entry}"));
    match language {
        Language::Glsl => {
            let version = glsl::Version::Desktop(430);
            let text = glsl(&module, &info, version, ShaderStage::Compute);
            if kind == Kind::Realtime {
                return guarded(&without_lines(&text, &["#", "layout(local_size"]), kind);
            }
            let mut names = vec![("_group_0_binding_0_cs", "student_t_tables")];
            if storage == Storage::Buffer {
                names.push((block(&text), "student_t_tables_block"));
            }
            let text = renamed(&text, &names);
            let text = without_lines(&text, &["#", "layout(local_size"]);
            guarded(&bindable_glsl(&text, storage, kind), kind)
        }
        Language::GlslEs => {
            let version = glsl::Version::Embedded { version: 300, is_webgl: true };
            let text = glsl(&module, &info, version, ShaderStage::Fragment);
            let text = renamed(&text, &[("_group_0_binding_0_fs", "student_t_tables")]);
            without_lines(&text, &["#version", "precision "]).trim_start().into()
        }
        Language::Hlsl => {
            let text = hlsl(&module, &info);
            let text = if kind == Kind::Realtime { text } else { bindable_hlsl(&text) };
            guarded(&text, kind)
        }
        Language::Msl => {
            // What takes no tables is as it were of a texture.
            let storage = if kind == Kind::Realtime { Storage::Texture } else { storage };
            guarded(&includable_msl(&msl(&module, &info), storage, kind), kind)
        }
        Language::Wgsl | Language::Slang | Language::SpirV => panic!("no translation into text"),
    }
}

/// A program as SPIR-V.
fn spirv(wgsl: &str) -> Vec<u32> {
    let (module, info) = parse(wgsl);
    let flags = spv::WriterFlags::empty();
    let options = spv::Options { lang_version: (1, 3), flags, ..spv::Options::default() };
    spv::write_vec(&module, &info, &options, None).expect(OURS)
}

/// Why nothing here fails.
const OURS: &str = "the module is our own";

fn parse(wgsl: &str) -> (Module, ModuleInfo) {
    let module =
        naga::front::wgsl::parse_str(wgsl).map_err(|why| why.emit_to_string(wgsl)).expect(OURS);
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).map_err(|why| why.emit_to_string(wgsl)).expect(OURS);
    (module, info)
}

fn glsl(module: &Module, info: &ModuleInfo, version: glsl::Version, stage: ShaderStage) -> String {
    let writer_flags = glsl::WriterFlags::empty();
    let options = glsl::Options { version, writer_flags, ..glsl::Options::default() };
    let (entry_point, multiview) = (ENTRY.into(), None);
    let pipeline = glsl::PipelineOptions { shader_stage: stage, entry_point, multiview };
    let mut text = String::new();
    let policies = BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies)
        .and_then(|mut writer| writer.write())
        .expect(OURS);
    without_entry(&text, "\nvoid main() {")
}

fn hlsl(module: &Module, info: &ModuleInfo) -> String {
    let (options, pipeline) = (hlsl::Options::default(), hlsl::PipelineOptions::default());
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None).expect(OURS);
    without_entry(&text, "\n[numthreads(").replace("naga_", "student_t_impl_")
}

fn msl(module: &Module, info: &ModuleInfo) -> String {
    let options = msl::Options { lang_version: (2, 0), ..msl::Options::default() };
    let pipeline = msl::PipelineOptions::default();
    let (text, _) = msl::write_string(module, info, &options, &pipeline).expect(OURS);
    without_entry(&text, "\nkernel void ").replace("naga_", "student_t_impl_")
}

/// Lets users of GLSL say where the tables are.
fn bindable_glsl(text: &str, storage: Storage, kind: Kind) -> String {
    let (declared, default) = match storage {
        Storage::Buffer => ("layout(std430) readonly buffer", "layout(std430, binding = 0)"),
        Storage::Texture if kind == Kind::Family => ("uniform usampler2D", "layout(binding = 0)"),
        Storage::Texture => ("uniform sampler2D", "layout(binding = 0)"),
    };
    let rest = declared.trim_start_matches("layout(std430) ");
    let text = renamed(text, &[(declared, &format!("STUDENT_T_BINDING {rest}"))]);
    with_default("STUDENT_T_BINDING", default, &text)
}

/// Lets users of HLSL say where the tables are.
fn bindable_hlsl(text: &str) -> String {
    let text = renamed(text, &[("register(t0)", "register(STUDENT_T_REGISTER)")]);
    with_default("STUDENT_T_REGISTER", "t0", &text)
}

fn with_default(name: &str, default: &str, text: &str) -> String {
    format!("#ifndef {name}\n#define {name} {default}\n#endif\n\n{}", text.trim_start())
}

/// Metal's functions take the tables as an argument: a pointer, in place of a reference to an array
/// of unknown length and of a structure with that length, which none reads. They are inline, since
/// Metal links what several files define.
fn includable_msl(text: &str, storage: Storage, kind: Kind) -> String {
    let array = if kind == Kind::Family { "uint" } else { "metal::float2" };
    let name = text
        .split_once(&format!("typedef {array} "))
        .map(|(_, rest)| rest.split_once('[').expect("an array").0);
    let text = without_lines(text, &["// language", &format!("typedef {array} ")]);
    let functions = text.lines().map(|line| {
        let begins = line.starts_with(char::is_alphabetic) && !line.starts_with("struct");
        let inline = if begins && line.contains(" student_t_") { "inline " } else { "" };
        format!("{inline}{line}\n")
    });
    let text: String = functions.collect();
    match storage {
        Storage::Texture => text,
        Storage::Buffer => renamed(
            &text,
            &[
                ("struct _mslBufferSizes {\n    uint size0;\n};\n", ""),
                (",\n    constant _mslBufferSizes& _buffer_sizes", ""),
                (", _buffer_sizes", ""),
                (
                    &format!("device {} const& student_t_tables", name.expect("an array")),
                    &format!("device const {array}* student_t_tables"),
                ),
            ],
        ),
    }
}

/// The name of the block of a buffer in GLSL.
fn block(text: &str) -> &str {
    let (before, _) = text.split_once("_block_0Compute").expect("a block");
    let start = before.rfind(' ').expect("a word before") + 1;
    &text[start..before.len() + "_block_0Compute".len()]
}

fn without_entry(text: &str, entry: &str) -> String {
    let (rest, _) = text.split_once(entry).expect("the entry point comes last");
    format!("{}\n", rest.trim_end())
}

fn without_lines(text: &str, starts: &[&str]) -> String {
    let kept = text.lines().filter(|line| starts.iter().all(|start| !line.starts_with(start)));
    kept.map(|line| format!("{line}\n")).collect()
}

/// Text with each of these replaced; all occur.
fn renamed(text: &str, names: &[(&str, &str)]) -> String {
    names.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "no {from} in a translation");
        text.replace(from, to)
    })
}

/// Text that may be included twice.
fn guarded(text: &str, kind: Kind) -> String {
    // Functions for real time have names of their own, and may stand beside others.
    let name = if kind == Kind::Realtime { "STUDENT_T_REALTIME" } else { "STUDENT_T" };
    format!("#ifndef {name}\n#define {name}\n\n{}\n#endif\n", text.trim_start())
}
