//! `plot`: draws figures of the literature as SVG or PNG.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser};

use microfacet_report::plot;
use microfacet_report::plot::FIGURES;

use super::{Done, Failure, Outcome, print, write_file};

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

pub(super) fn run(args: Args) -> Outcome {
    let out = args.out.filter(|path| path.as_os_str() != "-");
    // A name that cannot be written is refused before anything is computed.
    let format = out.as_deref().map(format).transpose()?;
    let drawing = plot::figure(&args.name)?.drawing();
    match out.zip(format) {
        Some((path, Format::Svg)) => write_file(&path, drawing.svg().as_bytes())?,
        Some((path, Format::Png)) => write_file(&path, &drawing.png()?)?,
        None => print(&drawing.svg())?,
    }
    Ok(Done::Ok)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

/// The format that a name ends in, in letters of either case.
fn format(path: &Path) -> Result<Format, Failure> {
    let ending = path.extension().unwrap_or_default();
    if ending.eq_ignore_ascii_case("svg") {
        Ok(Format::Svg)
    } else if ending.eq_ignore_ascii_case("png") {
        Ok(Format::Png)
    } else {
        Err(Failure(format!(
            "{}: a figure is written as SVG or PNG; give a name that ends in .svg or .png, or \
             `--out -` for SVG on standard output",
            path.display()
        )))
    }
}
