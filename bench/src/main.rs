//! Run time against error: the tables of `microfacet-bake` and their rivals, timed in one process,
//! on one thread, with the same inputs.
//!
//! A time is a throughput: of independent calls in a row, each of which the compiler may inline,
//! with views and random numbers drawn beforehand ([`inputs`]). Everything is in single precision
//! unless its name says otherwise.

mod cliffs;
mod clock;
mod conductors;
mod densities;
mod error;
mod figures;
mod files;
mod inputs;
mod masking;
mod paper;
mod plot;
mod rivals;
mod rows;
mod sampler;
mod settings;
mod sweep;
mod tables;
mod terminal;

use std::fmt::Display;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

use crate::inputs::COUNT;
use crate::settings::Settings;
use crate::tables::Slices;

/// Time the samplers and the forms of G1, and measure the error of each.
///
/// One thread; views evenly over the hemisphere and uniform random numbers, drawn beforehand; times
/// are medians over batches of rivals that take turns. Close other programs: ratios are steadier
/// than times, but not immune.
#[derive(Parser)]
#[command(version)]
#[command(
    after_help = "Example:\n  microfacet-bench --quick --out out/bench\n\nExit status: 0 done, 2 bad input."
)]
struct Args {
    /// Fewer batches: some seconds instead of two minutes.
    #[arg(long)]
    quick: bool,
    /// Different inputs to call with.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=COUNT as i64))]
    calls: Option<u32>,
    /// Seed of views and random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for bench.csv, bench.json, bench.svg, every time of the sweep (sweep.csv) and, after
    /// Ribardière et al. 2017, the times by gamma and sigma (figure-4.csv, .svg) and the error of
    /// the rational approximation (figure-5.csv, .svg).
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print JSON instead of tables.
    #[arg(long)]
    json: bool,
}

/// A message for the user; exit status 2.
struct Failure(String);

impl<E: Display> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

fn main() -> ExitCode {
    match run(Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn run(args: Args) -> Result<(), Failure> {
    let settings = if args.quick { Settings::QUICK } else { Settings::FULL };
    let settings = Settings { seed: args.seed, ..settings };
    let settings = args.calls.map_or(settings, |calls| settings.with_calls(calls as usize));
    if let Some(folder) = &args.out {
        // Fail before the work, not after it.
        std::fs::create_dir_all(folder)
            .map_err(|why| Failure(format!("making the folder {}: {why}", folder.display())))?;
    }
    let slices = Slices::bake();
    let rows = rows::rows(&slices, &settings);
    let cells = sweep::cells(slices.whole(), &settings);
    let sweep = sweep::summaries(&cells);
    let approximation = paper::approximation(slices.whole());
    let mut figures = figures::figures(&rows, &approximation, &slices, &settings);
    figures.extend(cliffs::figures(slices.whole(), &sweep, &settings));
    let document = files::document(&settings, &rows, &sweep, &figures);
    if let Some(folder) = &args.out {
        let times = paper::times(slices.whole(), &settings);
        files::write(folder, &document, &rows, &cells, &times, &approximation)?;
    }
    if args.json {
        print(&format!("{document:#}\n"))
    } else {
        let parts = [terminal::table(&rows), terminal::sweep(&sweep), terminal::block(&figures)];
        print(&parts.join("\n"))
    }
}

/// Writes to standard output; a closed pipe (`| head`) is not an error.
fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
