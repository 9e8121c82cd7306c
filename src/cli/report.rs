//! `report`: a set as one HTML page.

use std::io::Read;
use std::path::{Path, PathBuf};

use microfacet_baker::input::{MAX_TEXT, open_or_stdin, shown};
use microfacet_baker::store;
use microfacet_report::{ReportError, Source, page, seconds};
use microfacet_validate::record::Record;

use super::words::exact_bytes;
use super::{
    Context, Failure, Result, anyhow, is_stream, print, summarize, tables, unwritable, watched,
    write_file,
};

/// Write a page that shows what a set holds, where its errors are, and how its materials look.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake report glass --out glass.html
  microfacet-bake report glass --validation glass.json
  microfacet-bake report
  microfacet-bake report glass --out - | gzip > glass.html.gz
The page is one file, needs no network, and opens in any browser.")]
pub(super) struct Args {
    /// A set, .safetensors or .exr, or a folder that holds one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// File to write, or `-` for standard output; one that exists is replaced as a whole.
    #[arg(long, short, value_name = "FILE", default_value = "report.html")]
    out: PathBuf,
    /// What `validate SET --json` printed of the same set, to show its results; `-` for standard
    /// input.
    #[arg(long, value_name = "FILE")]
    validation: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let set = tables(args.tables.as_deref())?;
    let to_stdout = is_stream(&args.out);
    if !to_stdout {
        store::check_file(&args.out).map_err(|why| unwritable(&args.out, why))?;
    }
    let name = match &args.tables {
        Some(path) => path.file_name().unwrap_or(path.as_os_str()).display().to_string(),
        None => "The default set".into(),
    };
    let validation = args.validation.as_deref().map(validation).transpose()?;
    let source = Source { name: &name, set: &set, validation: validation.as_ref() };
    let html = watched("drawing", seconds(&source), |meter| page(&source, meter));
    let html = html.map_err(|why| match (&why, &args.validation) {
        (ReportError::OtherSet { .. }, Some(file)) => {
            Failure::from(why).context(shown(file).to_string())
        }
        _ => why.into(),
    })?;
    if to_stdout {
        return print(&html);
    }
    write_file(&args.out, html.as_bytes())?;
    summarize(&format!("{} ({})\n", args.out.display(), exact_bytes(html.len())))
}

/// Reads what `validate --json` printed.
fn validation(path: &Path) -> Result<Record> {
    let name = || shown(path).to_string();
    let mut text = Vec::new();
    let mut input = open_or_stdin(path, MAX_TEXT).with_context(name)?;
    input.read_to_end(&mut text).with_context(name)?;
    serde_json::from_slice(&text).map_err(|why| {
        anyhow!(
            "{}: not the result of a validation: {why}; give what `microfacet-bake validate SET \
             --json` prints",
            name()
        )
    })
}
