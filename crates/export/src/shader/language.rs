//! Shading languages: what is particular to each.

use super::data::LAYOUT;
use crate::{c, realtime};

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

/// What the tables of a module are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Single shapes γ.
    Shapes,
    /// Every γ.
    Family,
    /// None: functions for real time take what they need as arguments.
    Realtime,
}

impl Kind {
    /// Names of files before their extension.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Shapes => "student_t",
            Self::Family => "student_t_family",
            Self::Realtime => "student_t_realtime",
        }
    }
}

impl Language {
    /// `asked`, or a texture for a language without buffers.
    pub fn storage(self, asked: Storage) -> Storage {
        if self == Self::GlslEs { Storage::Texture } else { asked }
    }

    /// File extensions of the module and of the sample. SPIR-V is both in one file, and its sample
    /// is the source, which declares what it takes and returns.
    pub(super) fn extensions(self, kind: Kind) -> [&'static str; 2] {
        match self {
            Self::Glsl if kind == Kind::Realtime => ["glsl", "frag"],
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
    pub(super) fn translation(self, storage: Storage, kind: Kind) -> Option<&'static [u8]> {
        macro_rules! of {
            ($file:literal) => {
                match kind {
                    Kind::Shapes => include_bytes!(concat!("translated/", $file)),
                    Kind::Family => include_bytes!(concat!("translated/family_", $file)),
                    Kind::Realtime => return self.translation_for_real_time(),
                }
            };
        }
        Some(match (self, storage) {
            (Self::Wgsl | Self::Slang, _) => return None,
            (Self::GlslEs, _) => of!("texture_es.glsl"),
            (Self::Glsl, Storage::Buffer) => of!("buffer.glsl"),
            (Self::Glsl, Storage::Texture) => of!("texture.glsl"),
            (Self::Hlsl, Storage::Buffer) => of!("buffer.hlsl"),
            (Self::Hlsl, Storage::Texture) => of!("texture.hlsl"),
            (Self::Msl, Storage::Buffer) => of!("buffer.metal"),
            (Self::Msl, Storage::Texture) => of!("texture.metal"),
            (Self::SpirV, Storage::Buffer) => of!("buffer.spv"),
            (Self::SpirV, Storage::Texture) => of!("texture.spv"),
        })
    }

    /// The functions for real time, which read no storage.
    fn translation_for_real_time(self) -> Option<&'static [u8]> {
        Some(match self {
            Self::Wgsl | Self::Slang => return None,
            Self::Glsl | Self::GlslEs => include_bytes!("translated/realtime.glsl"),
            Self::Hlsl => include_bytes!("translated/realtime.hlsl"),
            Self::Msl => include_bytes!("translated/realtime.metal"),
            Self::SpirV => panic!("functions for real time are no program"),
        })
    }

    /// A program that uses the module.
    pub(super) fn sample(self, storage: Storage, kind: Kind) -> String {
        if kind == Kind::Realtime {
            return match self {
                Self::Wgsl => include_str!("samples/realtime.wgsl"),
                Self::Glsl => include_str!("samples/realtime.glsl"),
                Self::GlslEs => include_str!("samples/realtime.frag"),
                Self::Hlsl => include_str!("samples/realtime.hlsl"),
                Self::Msl => include_str!("samples/realtime.metal"),
                Self::Slang => include_str!("samples/realtime.slang"),
                Self::SpirV => panic!("functions for real time are no program"),
            }
            .into();
        }
        let text = match self {
            Self::Wgsl | Self::SpirV => include_str!("samples/sample.wgsl"),
            Self::Glsl => include_str!("samples/sample.comp"),
            Self::GlslEs => include_str!("samples/sample.frag"),
            Self::Hlsl => include_str!("samples/sample.hlsl"),
            Self::Msl => include_str!("samples/sample.metal"),
            Self::Slang => include_str!("samples/sample.slang"),
        };
        let mut text = text.to_owned();
        let mut replace = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        };
        if kind == Kind::Family {
            replace("student_t.", "student_t_family.");
            if self == Self::Slang {
                replace("import student_t;", "import student_t_family;");
            }
            replace("student_t_lobe_of", "student_t_lobe_at");
            let uint = match self {
                Self::Wgsl | Self::SpirV => ["shape: u32,  ", "gamma: f32,  "],
                _ => ["uint shape;", "float gamma;"],
            };
            replace(uint[0], uint[1]);
            replace("its offset in student_t_family.json", "its shape");
            let of_query =
                if self == Self::GlslEs { ["(shape,", "(gamma,"] } else { ["q.shape", "q.gamma"] };
            replace(of_query[0], of_query[1]);
        }
        if (self, storage) == (Self::Msl, Storage::Texture) {
            let number = if kind == Kind::Family { "uint" } else { "float" };
            replace(
                "device const metal::float2* tables [[buffer(0)]]",
                &format!("metal::texture2d<{number}, metal::access::sample> tables [[texture(0)]]"),
            );
        } else if (self, kind) == (Self::Msl, Kind::Family) {
            replace("device const metal::float2* tables", "device const uint* tables");
        }
        text
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
/// With the tables as an argument if so.
pub(super) fn head(
    file: &str,
    language: Language,
    storage: Storage,
    kind: Kind,
    as_argument: bool,
) -> String {
    let layout = match kind {
        Kind::Shapes => LAYOUT,
        Kind::Family => c::LAYOUT,
        Kind::Realtime => return head_for_real_time(file, language),
    };
    include_str!("head.txt")
        .replace("{load}", kind.load())
        .replace("{domain}", kind.domain())
        .replace("{cost}", kind.cost())
        .replace("{accuracy}", kind.accuracy())
        .replace("{file}", file)
        .replace("{language}", language.name())
        .replace("{binding}", &binding(language, storage, kind, as_argument))
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{layout}", &layout.to_string())
}

/// The comment at the head of the functions for real time.
fn head_for_real_time(file: &str, language: Language) -> String {
    let [gammas, sigmas, views] = realtime::ALBEDO;
    let place = match language {
        Language::Wgsl => "Append your program to this text, as in student_t_realtime_sample.wgsl.",
        Language::Glsl => {
            "Include this text after #version, as in student_t_realtime_sample.frag; OpenGL, which\n\
             // has no #include, takes the text itself in its place."
        }
        Language::GlslEs => {
            "Insert this text before your functions, and after\n//     precision highp float;\n// \
             which stands at the head of your shader: with less it errs."
        }
        Language::Hlsl => "Include this text, as in student_t_realtime_sample.hlsl.",
        Language::Msl => "Include this text, as in student_t_realtime_sample.metal.",
        Language::Slang => {
            "Have this file where modules are searched for, and import student_t_realtime. All\n\
             // functions are differentiable with respect to all numbers, and so to texels."
        }
        Language::SpirV => "",
    };
    include_str!("realtime_head.txt")
        .replace("{place}", &format!("// {place}"))
        .replace("{file}", file)
        .replace("{language}", language.name())
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{gammas}", &gammas.to_string())
        .replace("{sigmas}", &sigmas.to_string())
        .replace("{views_of_masking}", &realtime::VIEWS_OF_MASKING.to_string())
        .replace("{views}", &views.to_string())
}

/// What heads of modules with tables say; that of the kit for real time is another.
impl Kind {
    /// How a lobe is made.
    fn load(self) -> &'static str {
        match self {
            Self::Shapes => {
                "\
// A lobe is a shape and a roughness. Make it once at a hit, from the tables, and hand it on:
//
//     student_t_lobe_of(shape: u32, sigma: vec2f) -> StudentTLobe
//
// The functions below that begin with student_t_lobe_, but for student_t_lobe_eval_pdf, are also
// there without lobe_ in their names, as student_t_d(shape, sigma, m), and make a lobe in each
// call."
            }
            Self::Family | Self::Realtime => {
                "\
// A lobe is a shape gamma and a roughness. Make it once at a hit, from the tables, and hand it on:
//
//     student_t_lobe_at(gamma: f32, sigma: vec2f) -> StudentTLobe"
            }
        }
    }

    /// The first lines on the domain.
    fn domain(self) -> &'static str {
        match self {
            Self::Shapes => {
                "\
// Domain. With a shape that is in the tables nothing reads outside them, and with directions of
// length 1, or null, no result is NaN or infinite. Shaders may take NaN for anything, so that no
// more is said of arguments that are NaN.
//   shape     The place of its first pair in the tables, \"offset\" in student_t.json."
            }
            Self::Family | Self::Realtime => {
                "\
// Domain. Nothing reads outside the tables, and with directions of length 1, or null, no result is
// NaN or infinite. Shaders may take NaN and infinity for anything, so that no more is said of
// arguments that are NaN.
//   gamma     Taken at the nearer end of [1.501, 1e18], as which infinity counts: 2 is GGX, from
//             tables as well, and 1e18 Beckmann."
            }
        }
    }

    /// What an albedo takes.
    fn cost(self) -> &'static str {
        match self {
            Self::Shapes => "Albedos take 36 nodes of a table:",
            Self::Family | Self::Realtime => "Albedos take 36 codes of a table:",
        }
    }

    /// Where errors are stated.
    fn accuracy(self) -> &'static str {
        match self {
            Self::Shapes => {
                "\
// Accuracy. student_t.json has the errors of the tables, measured against the model in double
// precision. What shaders add is in docs/shaders.md of microfacet-bake, which also has code that
// binds the tables."
            }
            Self::Family | Self::Realtime => {
                "\
// Accuracy. docs/shaders.md of microfacet-bake has what was measured, and code that binds the
// tables."
            }
        }
    }
}

/// The comment on binding the tables.
fn binding(language: Language, storage: Storage, kind: Kind, as_argument: bool) -> String {
    let tables = match (storage, language) {
        (Storage::Buffer, _) => {
            "// Tables. Bind the bytes of student_t.bin, unchanged, as a storage buffer."
        }
        (Storage::Texture, Language::GlslEs) => {
            "// Tables. Make a texture with texStorage2D(gl.TEXTURE_2D, 1, gl.RG32F, width, height), fill it
// with the bytes of student_t.bin, unchanged, set both of its filters to gl.NEAREST, and
// bind it to the sampler student_t_tables. Width and height are in student_t.json."
        }
        (Storage::Texture, _) => {
            "// Tables. Make a texture of two channels in single precision (rg32float) and one level from the
// bytes of student_t.bin, unchanged; its width and height are in student_t.json.
// It is read by texel, never filtered."
        }
    };
    let place = match language {
        _ if as_argument => {
            "// Functions that read tables have one argument more than below, the last: the texture, which
// your program binds, as that which comes with this text does."
        }
        Language::Wgsl => {
            "// Edit the line that begins with @group if your program has other things there. Append your
// program to this text, as in student_t_sample.wgsl."
        }
        Language::Glsl => {
            "// To have them elsewhere, define the layout before this text, such as
//     #define STUDENT_T_BINDING layout({std}set = 1, binding = 3)
// Include this text after #version, as in student_t_sample.comp; OpenGL, which has no
// #include, takes the text itself in its place."
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
// Derivatives. All functions have them with respect to all numbers: sigma, gamma where it is one,
// directions, cosines, u. They are those of the branch that is taken: 0 where an argument or a
// result is at the end of its range, and of albedos those of polynomials, which have corners at
// nodes. A sampled normal has those for given u. Slang has one function more,
//     student_t_d_of_gamma(gamma: f32, sigma, m) -> f32
//         D(m) of any gamma without tables"
        }
        Language::SpirV => "",
    };
    let std = if storage == Storage::Buffer { "std430, " } else { "" };
    let text = format!("{tables}\n{}", place.replace("{std}", std));
    match kind {
        Kind::Shapes => text,
        Kind::Family | Kind::Realtime => text
            .replace("student_t.", "student_t_family.")
            .replace("student_t_sample", "student_t_family_sample")
            .replace("gl.RG32F", "gl.R32UI")
            .replace(
                "two channels in single precision (rg32float)",
                "one channel of 32 bits (r32uint)",
            ),
    }
}
