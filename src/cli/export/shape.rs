//! Shapes with their lookups, for programs in other languages.

use std::path::PathBuf;

use microfacet_baker::store::OutputFolder;
use microfacet_core::Masking;
use microfacet_export::{
    ExportFile, Family, Group, Host, Language, Realtime, Shape, Storage, Target, family_file,
    family_shader_files, files, interface_file, realtime_files, texture_rows,
};
use microfacet_sampler::Tables;
use microfacet_sampler::port::interface_tables;
use microfacet_tables::SIGMA_MAX;

use crate::cli::words::distinct;
use crate::cli::{Result, anyhow, ensure, note, tables, values};

/// Where tables come from and files go to.
#[derive(clap::Args)]
struct Ends {
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

/// Headers of C.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake export c --family --out student-t
Every gamma and sigma, for renderers that have both at each hit.
  microfacet-bake export c --gamma 3 --gamma 1.65 --out student-t
Two shapes for any sigma.
  microfacet-bake export c --family --eta 1.5 --tables glass --out student-t
And the shares of light of glass and plastic, from a set that has them.")]
pub(super) struct CArgs {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. Several are separated by commas, or in
    /// options of their own.
    #[arg(long, value_name = "G", required_unless_present_any = ["family", "eta"], value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    /// All shapes, with gamma as an argument of each call, as student_t_family.h.
    #[arg(long, conflicts_with = "gamma")]
    family: bool,
    /// Index of refraction, inside over outside, of dielectrics and plastics: shares of light by
    /// gamma and sigma, from a set whose recipe has a dielectric of it with a range of sigma, or
    /// from the default set, which has 1.3 to 1.7. Several are separated by commas, or in options
    /// of their own.
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = values::finite)]
    eta: Vec<f64>,
    /// Write the tables of the family as a file of bytes, which a program reads, not as text.
    #[arg(long, requires = "family", conflicts_with = "gamma")]
    binary: bool,
    /// Leave out directional albedos, which compensation of multiple scattering needs: about half
    /// of the text.
    #[arg(long)]
    no_albedo: bool,
    #[command(flatten)]
    ends: Ends,
}

/// Shapes for shaders.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake export wgsl --family --out student-t
Every gamma and sigma, with sampling, for path tracers.
  microfacet-bake export wgsl --gamma 3 --gamma 1.65 --out student-t
Two shapes for any sigma.
  microfacet-bake export wgsl --realtime --out student-t
Every gamma and sigma at a fetch or two for each light, without sampling.")]
pub(super) struct ShaderArgs {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. Several are separated by commas, or in
    /// options of their own.
    #[arg(long, value_name = "G", required_unless_present_any = ["family", "realtime"], value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    /// All shapes, with gamma as an argument, as student_t_family.bin, which C reads as well.
    #[arg(long, conflicts_with = "gamma")]
    family: bool,
    /// The kit for real time, of gamma from 1.6 on and sigma up to 1: functions that read nothing
    /// themselves, and two textures for linear filters, of masking and of albedos.
    #[arg(long, conflicts_with_all = ["gamma", "family", "textures", "no_albedo", "group", "binding", "argument"])]
    realtime: bool,
    #[command(flatten)]
    ends: Ends,
    /// Have a shader read its tables from a texture, not from a buffer. GLSL ES has no other way.
    #[arg(long)]
    textures: bool,
    /// Leave out directional albedos, which compensation of multiple scattering needs: half of the
    /// data, and more.
    #[arg(long)]
    no_albedo: bool,
    /// Group of the tables in WGSL, set in GLSL and SPIR-V, space in HLSL; 0 by default. In WGSL
    /// also what a preprocessor replaces, such as #{MATERIAL_BIND_GROUP}.
    #[arg(long, value_name = "GROUP")]
    group: Option<Group>,
    /// Binding of the tables in the group, or register in HLSL; the programs that come with them
    /// use the two after it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = values::count::<u16>(0..=65533))]
    binding: u16,
    /// Have functions of WGSL and GLSL take their tables, a texture, as the last argument, as those
    /// of Metal do: for programs that bind textures by themselves.
    #[arg(long)]
    argument: bool,
    /// Path by which naga_oil, as in Bevy, imports the module of WGSL, such as student_t.
    #[arg(long, value_name = "NAME", value_parser = path_of_import)]
    import_path: Option<String>,
}

/// Parses names with `::` between them.
fn path_of_import(text: &str) -> Result<String, String> {
    let is_name = |name: &str| {
        name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_')
    };
    text.split("::").all(is_name).then(|| text.into()).ok_or_else(|| {
        format!("\"{text}\" must be names with :: between them, as student_t or brdf::student_t")
    })
}

/// Rows of a texture that every device of WebGL 2 supports.
const PROMISED_ROWS: usize = 2048;

pub(super) fn shader(language: Language, args: &ShaderArgs) -> Result<()> {
    let storage = if args.textures || args.argument { Storage::Texture } else { Storage::Buffer };
    let (group, import_path) = (args.group.clone(), args.import_path.clone());
    let host = Host { group, binding: args.binding, import_path, as_argument: args.argument };
    host.check(language).map_err(|why| anyhow!(why))?;
    ensure!(
        !(args.realtime && language == Language::SpirV),
        "SPIR-V has no functions without a program, and --realtime is functions: export wgsl, glsl, \
         glsl-es, hlsl, msl or slang"
    );
    let set = tables(args.ends.tables.as_deref())?;
    if args.realtime {
        let realtime = Realtime::bake(&set)?;
        return write(&args.ends, &realtime_files(language, &host, &realtime));
    }
    if args.family {
        let family = Family::bind(&set, !args.no_albedo)?;
        return write(&args.ends, &family_shader_files(language, storage, &host, &family));
    }
    let mut shapes = bind(&set, &args.gamma)?;
    if args.no_albedo {
        shapes.iter_mut().for_each(Shape::leave_out_albedos);
    }
    if language.storage(storage) == Storage::Texture
        && let rows = texture_rows(&shapes)
        && rows > PROMISED_ROWS
    {
        note(format!(
            "the texture has {rows} rows; all devices of WebGL 2 take {PROMISED_ROWS}: export fewer \
             shapes in one command for others"
        ));
    }
    write(&args.ends, &files(&Target::Shader(language, storage, host), &shapes))
}

pub(super) fn c(args: &CArgs) -> Result<()> {
    let set = tables(args.ends.tables.as_deref())?;
    let mut shapes = bind(&set, &args.gamma)?;
    if args.no_albedo {
        shapes.iter_mut().for_each(Shape::leave_out_albedos);
    }
    let mut written = files(&Target::C, &shapes);
    if args.family {
        written.push(family_file(&Family::bind(&set, !args.no_albedo)?, args.binary));
    }
    for eta in distinct(args.eta.iter().copied()) {
        written.extend(interfaces(&set, eta)?);
    }
    write(&args.ends, &written)
}

/// The headers of a dielectric, of every form of masking that the set has; if there is none, why.
fn interfaces(set: &Tables, eta: f64) -> Result<Vec<ExportFile>> {
    let found = Masking::ALL.map(|masking| set.family_dielectric(eta, masking));
    if let [Err(_), Err(why)] = found {
        return Err(why.into());
    }
    let generator = &set.provenance().generator;
    let file = |glass| interface_file(&interface_tables(&glass), generator);
    Ok(found.into_iter().flatten().map(file).collect())
}

fn write(ends: &Ends, files: &[ExportFile]) -> Result<()> {
    super::write(&OutputFolder::open(&ends.out)?, files)
}

/// The shapes of an export.
fn bind(set: &Tables, gammas: &[f64]) -> Result<Vec<Shape>> {
    values::tabulated(gammas, "")?;
    let gammas = distinct(gammas.iter().copied());
    let shapes: Vec<Shape> =
        gammas.into_iter().map(|gamma| Shape::bind(set, gamma)).collect::<Result<_, _>>()?;
    for shape in &shapes {
        for masking in &shape.from_default {
            note(format!(
                "gamma {}: the set has no albedos of {masking} masking for every sigma up to \
                 {SIGMA_MAX}; those of the default set are written",
                shape.gamma
            ));
        }
    }
    Ok(shapes)
}
