//! Shader modules: functions written once in WGSL, here, and translated.

mod data;
mod translate;

use std::fmt::Write;

use super::members::{self, Member, Value};
use super::{ExportFile, Shape};

/// A shading language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// WGSL, of WebGPU.
    Wgsl,
    /// GLSL 4.3, of OpenGL and Vulkan.
    Glsl,
    /// GLSL ES 3.0, of WebGL 2 and OpenGL ES.
    GlslEs,
    /// HLSL, shader model 6.0, of Direct3D.
    Hlsl,
    /// The Metal Shading Language 2.0.
    Msl,
    /// SPIR-V 1.3, of Vulkan: a program that reflects views, since Vulkan links no functions.
    SpirV,
}

/// What a shader reads its tables from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Storage {
    /// A buffer of pairs of numbers.
    Buffer,
    /// A texture of two channels in single precision, read by texel.
    Texture,
}

/// Names of files before their extension.
const NAME: &str = "student_t";

/// The functions, after the tables and the members of shapes.
const FUNCTIONS: &str = concat!(
    include_str!("numbers.wgsl"),
    "\n",
    include_str!("masking.wgsl"),
    "\n",
    include_str!("normals.wgsl"),
    "\n",
    include_str!("albedo.wgsl"),
);

/// The module, a program that uses it, and the data.
///
/// # Panics
/// If there are no shapes.
pub(super) fn files(language: Language, storage: Storage, shapes: &[Shape]) -> Vec<ExportFile> {
    let module = module(&lists(shapes.first().expect("shapes")), storage);
    let mut files = match language {
        Language::SpirV => {
            let words = translate::spirv(&format!("{module}{}", language.sample(storage)));
            let bytes = words.into_iter().flat_map(u32::to_le_bytes).collect();
            vec![ExportFile { name: format!("{NAME}.spv"), contents: bytes }]
        }
        _ => {
            let (extension, of_sample) = language.extensions();
            let text = translate::text(&module, language, storage);
            let file = format!("{NAME}.{extension}");
            let text = format!("{}\n{text}", head(&file, language, storage));
            let sample = format!("{NAME}_sample.{of_sample}");
            vec![
                ExportFile { name: file, contents: text.into() },
                ExportFile { name: sample, contents: language.sample(storage).into() },
            ]
        }
    };
    files.extend(data::files(shapes));
    files
}

impl Language {
    /// What programs are written to read tables from.
    pub fn default_storage(self) -> Storage {
        match self {
            Self::GlslEs => Storage::Texture,
            _ => Storage::Buffer,
        }
    }

    /// Of the module and of the sample.
    fn extensions(self) -> (&'static str, &'static str) {
        match self {
            Self::Wgsl => ("wgsl", "wgsl"),
            Self::Glsl => ("glsl", "comp"),
            Self::GlslEs => ("glsl", "frag"),
            Self::Hlsl => ("hlsl", "hlsl"),
            Self::Msl => ("metal", "metal"),
            Self::SpirV => ("spv", "spv"),
        }
    }

    /// A program that uses the module.
    fn sample(self, storage: Storage) -> String {
        let text = match self {
            Self::Wgsl | Self::SpirV => include_str!("samples/sample.wgsl"),
            Self::Glsl => include_str!("samples/sample.comp"),
            Self::GlslEs => include_str!("samples/sample.frag"),
            Self::Hlsl => include_str!("samples/sample.hlsl"),
            Self::Msl => include_str!("samples/sample.metal"),
        };
        match (self, storage) {
            (Self::Msl, Storage::Texture) => text.replace(
                "device const metal::float2* tables [[buffer(0)]]",
                "metal::texture2d<float, metal::access::sample> tables [[texture(0)]]",
            ),
            _ => text.into(),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "WGSL",
            Self::Glsl => "GLSL 4.3 and later (OpenGL, Vulkan)",
            Self::GlslEs => "GLSL ES 3.0 and later (WebGL 2, OpenGL ES)",
            Self::Hlsl => "HLSL (shader model 6.0 and later)",
            Self::Msl => "the Metal Shading Language 2.0",
            Self::SpirV => "SPIR-V",
        }
    }
}

/// What the module says of itself.
fn head(file: &str, language: Language, storage: Storage) -> String {
    include_str!("head.txt")
        .replace("{file}", file)
        .replace("{language}", language.name())
        .replace("{binding}", &binding(language, storage))
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{layout}", &data::LAYOUT.to_string())
}

/// How its tables are bound.
fn binding(language: Language, storage: Storage) -> String {
    let tables = match (storage, language) {
        (Storage::Buffer, _) => {
            "// Tables. Bind the bytes of student_t.bin, unchanged, as a storage buffer."
        }
        (Storage::Texture, Language::GlslEs) => {
            "// Tables. Make a texture with texStorage2D(gl.TEXTURE_2D, 1, gl.RG32F, width, height), fill it
// with the bytes of student_t.bin, unchanged, set both of its filters to gl.NEAREST, and bind it to
// the sampler student_t_tables. Width and height are in student_t.json."
        }
        (Storage::Texture, _) => {
            "// Tables. Make a texture of two channels in single precision (rg32float) and one level from the
// bytes of student_t.bin, unchanged; its width and height are in student_t.json. It is read by
// texel, never filtered."
        }
    };
    let place = match language {
        Language::Wgsl => {
            "// Edit the line that begins with @group if your program has other things there. Append your
// program to this text, as in student_t_sample.wgsl."
        }
        Language::Glsl => {
            "// #define STUDENT_T_BINDING before this text if they are elsewhere than its default says, in Vulkan
// with set = 0 and so on. Include this text after #version, as in student_t_sample.comp."
        }
        Language::GlslEs => {
            "// Insert this text between the line of #version and your program, as student_t_sample.frag says."
        }
        Language::Hlsl => {
            "// #define STUDENT_T_REGISTER before this text if they are elsewhere than its default says. Include
// this text, as in student_t_sample.hlsl."
        }
        Language::Msl => {
            "// Functions have one argument more than below, the last: the tables, as your kernel gets them.
// Include this text, as in student_t_sample.metal."
        }
        Language::SpirV => "",
    };
    format!("{tables}\n{place}")
}

/// The members of a shape as shaders read them: of the lobe, and of albedos by form of masking.
fn lists(shape: &Shape) -> [Vec<Member>; 3] {
    let [a, b] = &shape.albedos;
    [members::lobe(shape), members::albedo(a), members::albedo(b)]
}

/// All text in WGSL.
fn module([lobe, uncorrelated, correlated]: &[Vec<Member>; 3], storage: Storage) -> String {
    let tables = match storage {
        Storage::Buffer => include_str!("buffer.wgsl"),
        Storage::Texture => include_str!("texture.wgsl"),
    };
    let first = lobe.len().div_ceil(2);
    let second = first + uncorrelated.len().div_ceil(2);
    let which = format!("select({second}u, {first}u, masking == STUDENT_T_UNCORRELATED)");
    let shape = loader("StudentTShape", lobe, "student_t_impl_shape(shape: u32)", "shape");
    let albedo = loader(
        "StudentTAlbedoTable",
        correlated,
        "student_t_impl_albedo_table(shape: u32, masking: u32)",
        &format!("shape + {which}"),
    );
    format!("{tables}\n{shape}\n{albedo}\n{FUNCTIONS}")
}

/// A struct of members, and a function that reads one. A table is the place of its first pair.
fn loader(name: &str, members: &[Member], signature: &str, at: &str) -> String {
    let mut text = format!("struct {name} {{\n");
    for member in members {
        writeln!(text, "    {}: f32,", member.name).expect("memory");
    }
    let lines =
        ["let tables = f32(shape);", &format!("let at = {at};")].map(|s| format!("    {s}\n"));
    write!(text, "}}\n\nfn {signature} -> {name} {{\n{}", lines.concat()).expect("memory");
    let mut values = String::new();
    for (i, pair) in members.chunks(2).enumerate() {
        let first = pair[0].name;
        writeln!(text, "    let {first} = student_t_impl_pair(at + {i}u);").expect("memory");
        for (member, channel) in pair.iter().zip(["x", "y"]) {
            let base = if matches!(member.value, Value::Table(_)) { "tables + " } else { "" };
            writeln!(values, "        {base}{first}.{channel},").expect("memory");
        }
    }
    text + &format!("    return {name}(\n{values}    );\n}}\n")
}

#[cfg(test)]
mod tests {
    use microfacet_common::schlick::{F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE};
    use microfacet_sampler::{StudentT, Tables};

    use super::super::numbers::single;
    use super::*;

    #[test]
    fn constants_are_those_of_the_crate() {
        let [low, high] = StudentT::SIGMAS.map(|sigma| single(sigma as f32));
        let constants = [
            format!("student_t_impl_max(sigma, {low}), {high})"),
            format!("fourth * k, {} * mu", single(F82_SCALE as f32)),
            format!(
                "1.0 / {}, {})",
                single((1.0 / SCHLICK_AVERAGE) as f32),
                single(F82_AVERAGE as f32)
            ),
        ];
        for constant in constants {
            assert!(FUNCTIONS.contains(&constant), "{constant}");
        }
        let width = data::WIDTH;
        let (mask, shift) = (width - 1, width.ilog2());
        let texel = format!("at & {mask}u), i32(at >> {shift}u)");
        assert!(width.is_power_of_two() && include_str!("texture.wgsl").contains(&texel));
    }

    #[test]
    fn members_are_read_by_pairs_in_their_order() {
        let shape = Shape::bind(&Tables::embedded(), 1.7).unwrap();
        let [_, _, albedo] = lists(&shape);
        let text = loader("T", &albedo, "t(shape: u32)", "shape");
        let declared: Vec<&str> =
            text.lines().filter_map(|line| line.trim().strip_suffix(": f32,")).collect();
        assert!(declared.iter().copied().eq(albedo.iter().map(|member| member.name)));
        // The second pair begins with the third member.
        assert!(text.contains("let sigmas = student_t_impl_pair(at + 1u);"), "{text}");
        assert!(text.contains("(\n        tables + values.x,\n        tables + values.y,\n        sigmas.x,\n        sigmas.y,"), "{text}");
    }

    #[test]
    fn all_text_is_narrow() {
        let shape = Shape::bind(&Tables::embedded(), 1.7).unwrap();
        for storage in [Storage::Buffer, Storage::Texture] {
            let text = module(&lists(&shape), storage);
            for language in [Language::Wgsl, Language::GlslEs, Language::Msl] {
                let head = head("student_t.metal", language, storage);
                for line in head.lines().chain(text.lines()) {
                    assert!(line.len() <= 100, "{line}");
                }
            }
        }
    }
}
