//! `export`: writes shapes with their lookups as source text.

use std::path::PathBuf;

use clap::ValueEnum;

use microfacet_bake::export::{Shape, Target, files};
use microfacet_bake::store;

use super::{Done, Failure, Outcome, report, summarize, tables, values, write_file};

/// Write shapes as source text: tables of one gamma for any roughness, with their lookups.
#[derive(clap::Args)]
#[command(after_help = "Example:
  microfacet-bake export c --gamma 3 --gamma 1.65 --out student-t
writes student_t.h, student_t_gamma_3.h and student_t_gamma_1p65.h: headers for C99,
C++11, CUDA and HIP. student_t.h says how to use them.")]
pub(super) struct Args {
    /// What to write.
    #[arg(value_enum)]
    target: TargetArg,
    /// Shape, or several, separated by commas or in several options.
    #[arg(long, value_name = "G", required = true, value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    #[command(flatten)]
    others: values::OtherNames,
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
    C,
}

impl From<TargetArg> for Target {
    fn from(target: TargetArg) -> Self {
        match target {
            TargetArg::C => Self::C,
        }
    }
}

pub(super) fn run(args: Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    let mut shapes: Vec<Shape> = Vec::new();
    for &gamma in &args.gamma {
        if shapes.iter().all(|shape| shape.gamma != gamma) {
            shapes.push(Shape::bind(&set, gamma)?);
        }
    }
    for shape in &shapes {
        for masking in &shape.from_default {
            report(
                "note",
                format_args!(
                    "gamma {}: the set has no albedos of {masking} masking for every sigma; those of the default set are written",
                    shape.gamma
                ),
            );
        }
    }
    // Nothing is written unless all of it can be.
    let files = files(args.target.into(), &shapes);
    let folder = &args.out;
    store::make_folder(folder).map_err(|why| Failure(format!("{}: {why}", folder.display())))?;
    for file in &files {
        let path = folder.join(&file.name);
        write_file(&path, file.text.as_bytes())?;
        summarize(&format!("{}  {} bytes\n", path.display(), file.text.len()))?;
    }
    Ok(Done::Ok)
}
