//! `plot`: draws figures of the literature as SVG.

use std::path::PathBuf;

use microfacet_bake::plot;

use super::{Done, Outcome, print};

/// Draw a figure of the literature as SVG.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake plot student-t --output student-t.svg")]
pub(super) struct Args {
    /// Name of the figure.
    #[arg(value_parser = plot::NAMES)]
    name: String,
    /// File to write; standard output by default.
    #[arg(long, short, value_name = "SVG")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: Args) -> Outcome {
    let text = plot::svg(&plot::figure(&args.name)?)?;
    match args.output {
        Some(path) => {
            std::fs::write(&path, text)
                .map_err(|why| format!("writing {}: {why}", path.display()))?;
        }
        None => print(&text)?,
    }
    Ok(Done::Ok)
}
