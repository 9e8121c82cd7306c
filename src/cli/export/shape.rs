//! Shapes with their lookups, for programs in other languages.

use std::path::PathBuf;

use microfacet_baker::store::OutputFolder;
use microfacet_core::Masking;
use microfacet_export::{Language, Shape, Storage, Target, files, interface_files, texture_rows};
use microfacet_sampler::port::interface_tables;
use microfacet_tables::SIGMA_MAX;

use crate::cli::words::distinct;
use crate::cli::{Result, note, tables, values};

/// What every export of shapes asks for.
#[derive(clap::Args)]
pub(super) struct Args {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. Several are separated by commas, or in
    /// options of their own.
    #[arg(long, value_name = "G", required = true, value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

/// Shapes and dielectrics for C.
#[derive(clap::Args)]
pub(super) struct HeaderArgs {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. Several are separated by commas, or in
    /// options of their own.
    #[arg(long, value_name = "G", required_unless_present = "eta", value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    /// Index of refraction, inside over outside, of dielectrics and plastics: shares of light by
    /// gamma and sigma, from a set whose recipe has a dielectric of it with a range of sigma. The
    /// default set has none. Several are separated by commas, or in options of their own.
    #[arg(long, value_name = "N", value_delimiter = ',')]
    eta: Vec<f64>,
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

/// Writes headers of shapes and of dielectrics.
pub(super) fn headers(args: HeaderArgs) -> Result<()> {
    let HeaderArgs { gamma, eta, tables: path, out } = args;
    let set = tables(path.as_deref())?;
    let mut written = Vec::new();
    for eta in distinct(eta.iter().copied()) {
        // Every form of masking that the set has; if there is none, why.
        let found = Masking::ALL.map(|masking| set.family_dielectric(eta, masking));
        if let [Err(_), Err(why)] = found {
            return Err(why.into());
        }
        for glass in found.into_iter().flatten() {
            written.extend(interface_files(&interface_tables(&glass), &set.provenance().generator));
        }
    }
    if !gamma.is_empty() {
        run(Target::C, &Args { gamma, tables: path, out: out.clone() })?;
    } else {
        // The functions are the same for every index.
        written.sort_by(|a, b| a.name.cmp(&b.name));
        written.dedup();
        return super::write(&OutputFolder::open(&out)?, &written);
    }
    written.retain(|file| file.name.contains("_eta_"));
    super::write(&OutputFolder::open(&out)?, &written)
}

/// Shapes for shaders.
#[derive(clap::Args)]
pub(super) struct ShaderArgs {
    #[command(flatten)]
    shapes: Args,
    /// Have a shader read its tables from a texture, not from a buffer. GLSL ES has no other way.
    #[arg(long)]
    textures: bool,
}

/// Rows of a texture that every device of WebGL 2 supports.
const PROMISED_ROWS: usize = 2048;

pub(super) fn shader(language: Language, args: &ShaderArgs) -> Result<()> {
    let storage = if args.textures { Storage::Texture } else { Storage::Buffer };
    run(Target::Shader(language, storage), &args.shapes)
}

pub(super) fn run(target: Target, args: &Args) -> Result<()> {
    values::tabulated(&args.gamma, "")?;
    let set = tables(args.tables.as_deref())?;
    let gammas = distinct(args.gamma.iter().copied());
    let shapes: Vec<Shape> =
        gammas.into_iter().map(|gamma| Shape::bind(&set, gamma)).collect::<Result<_, _>>()?;
    for shape in &shapes {
        for masking in &shape.from_default {
            note(format!(
                "gamma {}: the set has no albedos of {masking} masking for every sigma up to \
                 {SIGMA_MAX}; those of the default set are written",
                shape.gamma
            ));
        }
    }
    if let Target::Shader(language, storage) = target
        && language.storage(storage) == Storage::Texture
        && let rows = texture_rows(&shapes)
        && rows > PROMISED_ROWS
    {
        note(format!(
            "the texture has {rows} rows; all devices of WebGL 2 take {PROMISED_ROWS}: export fewer \
             shapes in one command for others"
        ));
    }
    super::write(&OutputFolder::open(&args.out)?, &files(target, &shapes))
}
