//! Shapes with their lookups, for programs in other languages.

use std::path::PathBuf;

use clap::builder::UnknownArgumentValueParser;

use microfacet_baker::store::OutputFolder;
use microfacet_export::{Language, Shape, Storage, Target, files, texture_rows};
use microfacet_tables::SIGMA_MAX;

use crate::cli::{Outcome, report, tables, values};

/// What every export of shapes asks for.
#[derive(clap::Args)]
#[allow(dead_code, reason = "no value of a roughness is ever accepted")]
pub(super) struct Args {
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
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
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

/// The size of textures that every device of WebGL 2 has.
const PROMISED_ROWS: usize = 2048;

fn every_sigma() -> UnknownArgumentValueParser {
    UnknownArgumentValueParser::suggest(
        "an export serves every roughness: its functions take sigma as an argument",
    )
}

pub(super) fn shader(language: Language, args: ShaderArgs) -> Outcome {
    let storage = if args.textures { Storage::Texture } else { Storage::Buffer };
    run(Target::Shader(language, storage), args.shapes)
}

pub(super) fn run(target: Target, args: Args) -> Outcome {
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
    super::write(&OutputFolder::open(&args.out)?, &files(target, &shapes))
}
