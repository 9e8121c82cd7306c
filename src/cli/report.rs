//! `report`: a set as one HTML page.

use std::path::PathBuf;

use microfacet_bake::progress::Meter;
use microfacet_bake::report::{Source, page, seconds};
use microfacet_bake::store;

use super::words::exact_bytes;
use super::{Done, Outcome, print, progress, summarize, tables, unwritable, write_file};

/// Write a page that shows what a set holds, where its errors are, and how its materials look.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake report glass --out glass.html
  microfacet-bake report
  microfacet-bake report glass --out - | gzip > glass.html.gz
The page is one file, needs no network, and opens in any browser.")]
pub(super) struct Args {
    /// A .safetensors set, a folder that holds one or its images, or a single table as .exr; the
    /// embedded default if absent.
    tables: Option<PathBuf>,
    /// File to write, or `-` for standard output; one that exists is replaced as a whole.
    #[arg(long, short, value_name = "FILE", default_value = "report.html")]
    out: PathBuf,
}

pub(super) fn run(args: Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    let to_stdout = args.out.as_os_str() == "-";
    if !to_stdout {
        store::check_file(&args.out).map_err(|why| unwritable(&args.out, &why))?;
    }
    let name = match &args.tables {
        Some(path) => path.file_name().unwrap_or(path.as_os_str()).display().to_string(),
        None => "The default set".into(),
    };
    let source = Source { name: &name, set: &set };
    let meter = Meter::default();
    meter.expect(seconds(&source));
    let bar = progress::show(&meter, "drawing");
    let html = page(&source, &meter)?;
    drop(bar);
    if to_stdout {
        print(&html)?;
        return Ok(Done::Ok);
    }
    write_file(&args.out, html.as_bytes())?;
    summarize(&format!("{} ({})\n", args.out.display(), exact_bytes(html.len())))?;
    Ok(Done::Ok)
}
