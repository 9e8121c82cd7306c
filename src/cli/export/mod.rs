//! `export`: writes shapes, with their lookups or as textures, for programs in other languages.

mod lut;
mod shape;

use std::ffi::OsString;

use clap::Subcommand;

use microfacet_baker::store::OutputFolder;
use microfacet_export::{ExportFile, Language};

use super::{Result, bail, summarize};

/// Write shapes for programs in other languages: tables of one gamma for any roughness, with the
/// functions that look them up, or albedos as a texture.
#[derive(clap::Args)]
#[command(after_help = "Example:
  microfacet-bake export c --gamma 3 --gamma 1.65 --out student-t
writes student_t.h, student_t_gamma_3.h and student_t_gamma_1p65.h: headers for C99,
C++11, CUDA and HIP. student_t.h says how to use them.
  microfacet-bake export c --family --out student-t
writes student_t_family.h, with every gamma, for renderers that have it at each hit.
  microfacet-bake export c --eta 1.5 --tables glass --out student-t
writes student_t_eta_1p5.h, the shares of light of glass and plastic at any sigma and
gamma that the set covers.
  microfacet-bake export wgsl --gamma 3 --gamma 1.65 --out student-t
writes student_t.wgsl, with the functions, a program that uses them, and the tables of
both shapes as student_t.bin, described by student_t.json.
  microfacet-bake export lut --gamma 2 --sigma-max 1 --size 32x32 --format dds --out lut
writes lut.dds and lut_average.dds, the directional albedo and its average as textures,
and prints the line with which a shader reads them.")]
#[command(subcommand_value_name = "TARGET", subcommand_help_heading = "Targets")]
pub(super) struct Args {
    #[command(subcommand)]
    target: TargetArg,
}

#[derive(Subcommand)]
enum TargetArg {
    /// Headers for C99, C++11, CUDA and HIP.
    #[command(aliases = ["C", "c++", "cpp", "cuda", "hip"])]
    C(shape::CArgs),
    /// A module of WGSL: WebGPU.
    #[command(aliases = ["WGSL"])]
    Wgsl(shape::ShaderArgs),
    /// Functions in GLSL 4.3: OpenGL, Vulkan.
    #[command(aliases = ["GLSL"])]
    Glsl(shape::ShaderArgs),
    /// Functions in GLSL ES 3.0: WebGL 2, OpenGL ES.
    #[command(aliases = ["GLSL-ES", "gles", "essl", "webgl"])]
    GlslEs(shape::ShaderArgs),
    /// Functions in HLSL: Direct3D.
    #[command(aliases = ["HLSL"])]
    Hlsl(shape::ShaderArgs),
    /// Functions in the Metal Shading Language.
    #[command(aliases = ["MSL", "metal"])]
    Msl(shape::ShaderArgs),
    /// Functions in Slang, with derivatives: all of these, CUDA and C++.
    #[command(aliases = ["SLANG"])]
    Slang(shape::ShaderArgs),
    /// A program for Vulkan that samples visible normals.
    #[command(aliases = ["SPIRV", "SPIR-V", "spir-v", "spv"])]
    Spirv(shape::ShaderArgs),
    #[command(aliases = ["LUT"])]
    Lut(lut::Args),
    #[command(external_subcommand)]
    Other(Vec<OsString>),
}

pub(super) fn run(args: Args) -> Result<()> {
    let (language, args) = match args.target {
        TargetArg::C(args) => return shape::c(&args),
        TargetArg::Lut(args) => return lut::run(&args),
        TargetArg::Wgsl(args) => (Language::Wgsl, args),
        TargetArg::Glsl(args) => (Language::Glsl, args),
        TargetArg::GlslEs(args) => (Language::GlslEs, args),
        TargetArg::Hlsl(args) => (Language::Hlsl, args),
        TargetArg::Msl(args) => (Language::Msl, args),
        TargetArg::Slang(args) => (Language::Slang, args),
        TargetArg::Spirv(args) => (Language::SpirV, args),
        TargetArg::Other(words) => {
            let targets = TargetArg::augment_subcommands(clap::Command::new("export"));
            let names: Vec<&str> = targets.get_subcommands().map(clap::Command::get_name).collect();
            let (word, names) = (words[0].display(), names.join(", "));
            bail!("\"{word}\" is no target of exports; they are {names}")
        }
    };
    shape::shader(language, &args)
}

/// Writes files into a folder and names them.
fn write(folder: &OutputFolder, files: &[ExportFile]) -> Result<()> {
    for file in folder.write_files(files.iter().map(|file| (&file.name[..], &file.contents[..])))? {
        summarize(&format!("{} ({} bytes)\n", file.path.display(), file.bytes))?;
    }
    Ok(())
}
