//! `plot`: draws figures of the literature as SVG.

use std::path::PathBuf;

use microfacet_bake::plot;

use super::{Done, Outcome, print, write_file};

/// Draw a figure of the literature as SVG.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake plot student-t --out student-t.svg")]
pub(super) struct Args {
    /// Name of the figure.
    #[arg(value_name = "FIGURE", value_parser = plot::NAMES)]
    name: String,
    /// File to write; standard output by default, or if it is `-`.
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn run(args: Args) -> Outcome {
    let text = plot::svg(&plot::figure(&args.name)?)?;
    match args.out.filter(|path| path.as_os_str() != "-") {
        Some(path) => write_file(&path, text.as_bytes())?,
        None => print(&text)?,
    }
    Ok(Done::Ok)
}
