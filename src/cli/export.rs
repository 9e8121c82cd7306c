//! `export`: writes shapes with their lookups for programs in other languages.

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::UnknownArgumentValueParser;

use microfacet_bake::bake::albedo::SIGMA_MAX;
use microfacet_bake::export::{Language, Shape, Storage, Target, files, texture_rows};
use microfacet_bake::store;

use super::{Done, Failure, Outcome, report, summarize, tables, values};

/// Write shapes for programs in other languages: tables of one gamma for any roughness, with the
/// functions that look them up.
#[derive(clap::Args)]
#[allow(dead_code, reason = "no value of a roughness is ever accepted")]
#[command(after_help = "Example:
  microfacet-bake export c --gamma 3 --gamma 1.65 --out student-t
writes student_t.h, student_t_gamma_3.h and student_t_gamma_1p65.h: headers for C99,
C++11, CUDA and HIP. student_t.h says how to use them.
  microfacet-bake export wgsl --gamma 3 --gamma 1.65 --out student-t
writes student_t.wgsl, with the functions, a program that uses them, and the tables of
both shapes as student_t.bin, described by student_t.json.")]
pub(super) struct Args {
    /// What to write.
    #[arg(value_enum, ignore_case = true)]
    target: TargetArg,
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. Several are separated by commas, or in
    /// options of their own.
    #[arg(long, value_name = "G", required = true, value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    #[arg(long, hide = true, value_name = "X", value_parser = every_sigma())]
    sigma: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = every_sigma())]
    alpha: Option<String>,
    #[arg(long, hide = true, value_name = "X", value_parser = every_sigma())]
    roughness: Option<String>,
    /// Have a shader read its tables from a texture, not from a buffer. GLSL ES has no other way.
    #[arg(long)]
    textures: bool,
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum TargetArg {
    /// Headers for C99, C++11, CUDA and HIP.
    #[value(aliases = ["c++", "cpp", "cuda", "hip"])]
    C,
    /// A module of WGSL: WebGPU.
    Wgsl,
    /// Functions in GLSL 4.3: OpenGL, Vulkan.
    Glsl,
    /// Functions in GLSL ES 3.0: WebGL 2, OpenGL ES.
    #[value(aliases = ["gles", "essl", "webgl"])]
    GlslEs,
    /// Functions in HLSL: Direct3D.
    Hlsl,
    /// Functions in the Metal Shading Language.
    #[value(aliases = ["metal"])]
    Msl,
    /// A program for Vulkan that samples visible normals.
    #[value(aliases = ["spir-v", "spv"])]
    Spirv,
}

/// The size of textures that every device of WebGL 2 has.
const PROMISED_ROWS: usize = 2048;

fn every_sigma() -> UnknownArgumentValueParser {
    UnknownArgumentValueParser::suggest(
        "an export serves every roughness: its functions take sigma as an argument",
    )
}

impl TargetArg {
    fn target(self, textures: bool) -> Result<Target, Failure> {
        let language = match self {
            Self::C if textures => {
                return Err(Failure("C has no textures: leave out --textures".into()));
            }
            Self::C => return Ok(Target::C),
            Self::Wgsl => Language::Wgsl,
            Self::Glsl => Language::Glsl,
            Self::GlslEs => Language::GlslEs,
            Self::Hlsl => Language::Hlsl,
            Self::Msl => Language::Msl,
            Self::Spirv => Language::SpirV,
        };
        let storage = if textures { Storage::Texture } else { Storage::Buffer };
        Ok(Target::Shader(language, storage))
    }
}

pub(super) fn run(args: Args) -> Outcome {
    let target = args.target.target(args.textures)?;
    args.gamma.iter().try_for_each(|&gamma| values::tabulated(gamma, ""))?;
    let set = tables(args.tables.as_deref())?;
    let mut gammas: Vec<f64> = Vec::new();
    for &gamma in &args.gamma {
        if !gammas.contains(&gamma) {
            gammas.push(gamma);
        }
    }
    let bind = |&gamma| Shape::bind(&set, gamma);
    let shapes = gammas.iter().map(bind).collect::<Result<Vec<_>, _>>()?;
    for shape in &shapes {
        for masking in &shape.from_default {
            let gamma = shape.gamma;
            let note = format!(
                "gamma {gamma}: the set has no albedos of {masking} masking for every sigma up to \
                 {SIGMA_MAX}; those of the default set are written"
            );
            report("note", note);
        }
    }
    if let Target::Shader(language, storage) = target
        && language.storage(storage) == Storage::Texture
        && let rows = texture_rows(&shapes)
        && rows > PROMISED_ROWS
    {
        let note = format!(
            "the texture has {rows} rows; all devices of WebGL 2 take {PROMISED_ROWS}: export fewer \
             shapes in one command for others"
        );
        report("note", note);
    }
    let files = files(target, &shapes);
    let contents = files.iter().map(|file| (&file.name[..], &file.contents[..]));
    let written = store::replace_files(&args.out, contents)
        .map_err(|(path, why)| Failure(format!("{}: {why}", path.display())))?;
    for (path, file) in written.iter().zip(&files) {
        summarize(&format!("{} ({} bytes)\n", path.display(), file.contents.len()))?;
    }
    Ok(Done::Ok)
}
