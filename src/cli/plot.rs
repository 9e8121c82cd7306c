//! `plot`: draws figures of the literature as SVG or PNG.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser};

use microfacet_report::plot;
use microfacet_report::plot::FIGURES;

use super::{Result, bail, is_stream, print, write_file};

/// Draw a figure of the literature as SVG or PNG.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake plot student-t --out student-t.png")]
pub(super) struct Args {
    /// Name of the figure.
    #[arg(value_name = "FIGURE", value_parser = figures())]
    name: String,
    /// File to write, as SVG or PNG by its ending, .svg or .png; standard output by default, or if
    /// it is `-`, which is SVG.
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn figures() -> PossibleValuesParser {
    FIGURES.map(|listed| PossibleValue::new(listed.name).help(listed.about)).into()
}

pub(super) fn run(args: &Args) -> Result<()> {
    let Some(path) = args.out.as_deref().filter(|path| !is_stream(path)) else {
        return print(&plot::figure(&args.name)?.drawing().svg());
    };
    // The ending is in letters of either case; another one is refused before anything is computed.
    let ends_in = |ending| path.extension().is_some_and(|end| end.eq_ignore_ascii_case(ending));
    let is_svg = ends_in("svg");
    if !is_svg && !ends_in("png") {
        bail!(
            "{}: a figure is written as SVG or PNG; give a name that ends in .svg or .png, or \
             `--out -` for SVG on standard output",
            path.display()
        );
    }
    let figure = plot::figure(&args.name)?.drawing();
    write_file(path, &if is_svg { figure.svg().into_bytes() } else { figure.png()? })
}
