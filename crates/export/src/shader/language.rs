//! Shading languages: what is particular to each.

use super::data::LAYOUT;
use super::for_webgl;

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
    /// Slang, which compiles to all of these, to CUDA and to C++, with derivatives.
    Slang,
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

impl Language {
    /// `asked`, or a texture for a language without buffers.
    pub fn storage(self, asked: Storage) -> Storage {
        if self == Self::GlslEs { Storage::Texture } else { asked }
    }

    /// File extensions of the module and of the sample. SPIR-V is both in one file, and its sample
    /// is the source, which declares what it takes and returns.
    pub(super) fn extensions(self) -> [&'static str; 2] {
        match self {
            Self::Wgsl => ["wgsl", "wgsl"],
            Self::Glsl => ["glsl", "comp"],
            Self::GlslEs => ["glsl", "frag"],
            Self::Hlsl => ["hlsl", "hlsl"],
            Self::Msl => ["metal", "metal"],
            Self::Slang => ["slang", "slang"],
            Self::SpirV => ["spv", "wgsl"],
        }
    }

    /// The module, of SPIR-V the program, as `clients/gpu` translates it; none of WGSL, which it
    /// is translated from, and of Slang, which is made of HLSL.
    pub(super) fn translation(self, storage: Storage) -> Option<&'static [u8]> {
        Some(match (self, storage) {
            (Self::Wgsl | Self::Slang, _) => return None,
            (Self::Glsl, Storage::Buffer) => include_bytes!("translated/buffer.glsl"),
            (Self::Glsl, Storage::Texture) => include_bytes!("translated/texture.glsl"),
            (Self::GlslEs, _) => for_webgl().as_bytes(),
            (Self::Hlsl, Storage::Buffer) => include_bytes!("translated/buffer.hlsl"),
            (Self::Hlsl, Storage::Texture) => include_bytes!("translated/texture.hlsl"),
            (Self::Msl, Storage::Buffer) => include_bytes!("translated/buffer.metal"),
            (Self::Msl, Storage::Texture) => include_bytes!("translated/texture.metal"),
            (Self::SpirV, Storage::Buffer) => include_bytes!("translated/buffer.spv"),
            (Self::SpirV, Storage::Texture) => include_bytes!("translated/texture.spv"),
        })
    }

    /// A program that uses the module.
    pub(super) fn sample(self, storage: Storage) -> String {
        let text = match self {
            Self::Wgsl | Self::SpirV => include_str!("samples/sample.wgsl"),
            Self::Glsl => include_str!("samples/sample.comp"),
            Self::GlslEs => include_str!("samples/sample.frag"),
            Self::Hlsl => include_str!("samples/sample.hlsl"),
            Self::Msl => include_str!("samples/sample.metal"),
            Self::Slang => include_str!("samples/sample.slang"),
        };
        match (self, storage) {
            (Self::Msl, Storage::Texture) => {
                let buffer = "device const metal::float2* tables [[buffer(0)]]";
                assert!(text.contains(buffer));
                let texture =
                    "metal::texture2d<float, metal::access::sample> tables [[texture(0)]]";
                text.replace(buffer, texture)
            }
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
            Self::Slang => "Slang (2026 and later), differentiable",
            Self::SpirV => "SPIR-V",
        }
    }
}

/// The comment at the head of the module.
pub(super) fn head(file: &str, language: Language, storage: Storage) -> String {
    include_str!("head.txt")
        .replace("{file}", file)
        .replace("{language}", language.name())
        .replace("{binding}", &binding(language, storage))
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{layout}", &LAYOUT.to_string())
}

/// The comment on binding the tables.
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
            "// To have them elsewhere, define the layout before this text, such as
//     #define STUDENT_T_BINDING layout({std}set = 1, binding = 3)
// Include this text after #version, as in student_t_sample.comp; OpenGL, which has no #include,
// takes the text itself in its place."
        }
        Language::GlslEs => {
            "// Insert this text before your functions, and after
//     precision highp float;
//     precision highp int;
// which stand at the head of your shader, as student_t_sample.frag says: with less it errs."
        }
        Language::Hlsl => {
            "// To have them elsewhere, define the register before this text, such as
//     #define STUDENT_T_REGISTER t3, space1
// Include this text, as in student_t_sample.hlsl."
        }
        Language::Msl => {
            "// Functions have one argument more than below, the last: the tables, as your kernel gets them.
// Include this text, as in student_t_sample.metal."
        }
        Language::Slang => {
            "// The compiler places them; programs find them as student_t_tables by reflection. To choose the
// place, write [[vk::binding(3, 1)]] before the line that declares them, and : register(t3, space1)
// at its end. Have this file where modules are searched for, and import student_t, as in
// student_t_sample.slang.
//
// Derivatives. All functions have them with respect to all numbers: sigma, directions, cosines, u.
// They are those of the branch that is taken: 0 where an argument or a result is at the end of its
// range, and of albedos those of polynomials, which have corners at nodes. A sampled normal has
// those for given u. shape has none, since tables are of one gamma each. Slang has one function
// more,
//     student_t_d_of_gamma(gamma: f32, sigma, m) -> f32
//         D(m) of any gamma without tables, which has them with respect to gamma too"
        }
        Language::SpirV => "",
    };
    let std = if storage == Storage::Buffer { "std430, " } else { "" };
    format!("{tables}\n{}", place.replace("{std}", std))
}
