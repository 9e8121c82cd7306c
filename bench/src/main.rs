//! Run time against error: the tables of `microfacet-bake` and their rivals, timed in one process,
//! on one thread, with the same inputs.
//!
//! A time is a throughput: of independent calls in a row, each of which the compiler may inline,
//! with views and random numbers drawn beforehand ([`inputs`]). Everything is in single precision
//! unless its name says otherwise.

mod cliffs;
mod clock;
mod conductors;
mod cost;
mod error;
mod figures;
mod files;
mod furnace;
mod inputs;
mod page;
mod paper;
mod per_hit;
mod plot;
mod processor;
mod rival;
mod rivals;
mod rows;
mod sampler;
mod settings;
mod sweep;
mod tables;
mod terminal;
mod textures;
mod values;

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use microfacet_sampler::Tables;
use serde_json::{Value, json};

use crate::inputs::COUNT;
use crate::paper::Paper;
use crate::plot::Point;
use crate::settings::{GAMMA, SIGMA, Settings};
use crate::tables::Slices;

/// Time the samplers and the forms of G1, and measure the error of each.
///
/// One thread; views evenly over the hemisphere and uniform random numbers, drawn beforehand; times
/// are medians over batches of rivals that take turns. Close other programs: ratios are steadier
/// than times, but not immune.
#[derive(Parser)]
#[command(version)]
#[command(after_help = "Examples:\n  \
    microfacet-bench --quick --out out/bench\n  \
    microfacet-bench paper --out out/paper\n  \
    microfacet-bench draw docs/benchmark.md --out docs\n\n\
    Exit status: 0 done, 2 bad input.")]
struct Args {
    #[command(subcommand)]
    part: Option<Part>,
    #[command(flatten)]
    options: Options,
}

/// A part of the benchmark.
#[derive(Subcommand)]
enum Part {
    /// Only what repeats figures 4 to 6 of Ribardière et al. 2017 (doi:10.1111/cgf.13137)
    ///
    /// The time of each form of masking, alone and in a renderer (figure 4); the error of the
    /// rational approximation of masking (figure 5); what that changes in pictures of rough gold,
    /// in false colours (figure 6, which uses all cores). Less than a minute, or some seconds
    /// with --quick.
    ///
    /// Files in --out: figure-4.csv, .svg and .png; figure-5.csv by gamma and theta,
    /// figure-5-integrated.csv by gamma and sigma, figure-5.svg and .png; figure-6.csv, .svg and
    /// .png.
    Paper,
    /// Draw the figures of a page that shows what was measured, without measuring
    ///
    /// Reads the tables that this command and the study `frame_time` print, and draws run time
    /// against error, and run time beside GGX as bars.
    ///
    /// Files in --out: benchmark.svg, idea/cost.svg.
    Draw {
        /// The page, in Markdown.
        #[arg(value_name = "PAGE")]
        page: PathBuf,
    },
}

#[derive(clap::Args)]
struct Options {
    /// Fewer batches: some seconds instead of three minutes.
    #[arg(long, global = true)]
    quick: bool,
    /// Different inputs to call with.
    #[arg(long, global = true, value_name = "N",
          value_parser = clap::value_parser!(u32).range(16..=COUNT as i64))]
    calls: Option<u32>,
    /// Seed of views and random numbers.
    #[arg(long, global = true, default_value_t = 1)]
    seed: u64,
    /// Folder for bench.csv, bench.json, bench.svg, samplers by noise (furnace.csv), every time of
    /// the sweep (sweep.csv) and the files of `paper`.
    #[arg(long, global = true, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Print JSON instead of tables.
    #[arg(long, global = true)]
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

fn run(Args { part, options }: Args) -> Result<(), Failure> {
    let settings = if options.quick { Settings::QUICK } else { Settings::FULL };
    let settings = Settings { seed: options.seed, ..settings };
    let settings = options.calls.map_or(settings, |calls| settings.with_calls(calls as usize));
    if let Some(folder) = &options.out {
        // Fail before the work, not after it.
        std::fs::create_dir_all(folder)
            .map_err(|why| Failure(format!("making the folder {}: {why}", folder.display())))?;
    }
    let (files, text, json) = match part {
        Some(Part::Draw { page }) => {
            let folder = options.out.ok_or(Failure("name a folder with --out".into()))?;
            return draw(&page, &folder);
        }
        Some(Part::Paper) => {
            let paper = Paper::measure(&Tables::embedded(), &settings, stage);
            let files = if options.out.is_some() { paper.files()? } else { Vec::new() };
            (files, paper.text(), paper.json())
        }
        None => everything(&settings, options.out.is_some())?,
    };
    if let Some(folder) = &options.out {
        files::write(folder, &files)?;
    }
    if options.json {
        print(&format!("{json:#}\n"))
    } else {
        print(&format!("processor: {}\n\n{text}", processor::name()))
    }
}

/// Draws what a page says.
fn draw(page: &Path, folder: &Path) -> Result<(), Failure> {
    let of_page = |why: &dyn Display| Failure(format!("{}: {why}", page.display()));
    let text = std::fs::read_to_string(page).map_err(|why| of_page(&why))?;
    let points = page::points(&text).map_err(|why| of_page(&why.0))?;
    let cost = cost::svg(&text, &points).map_err(|why| of_page(&why.0))?;
    std::fs::create_dir_all(folder.join("idea"))?;
    let files =
        [("benchmark.svg", plot::svg(&points).into_bytes()), ("idea/cost.svg", cost.into_bytes())];
    files::write(folder, &files)
}

/// What one run is to write, by name, and to print.
type Results = (Vec<(&'static str, Vec<u8>)>, String, Value);

/// All rivals, the sweep, and the paper; without files unless `files` is true.
fn everything(settings: &Settings, files: bool) -> Result<Results, Failure> {
    let slices = Slices::bake();
    stage("rivals: times and errors");
    let rows = rows::rows(&slices, settings);
    stage("furnace: what a user would pick instead");
    let furnace = furnace::rows(slices.whole(), settings);
    stage("sweep: times over the whole domain");
    let cells = sweep::cells(slices.whole(), settings);
    let sweep = sweep::summaries(&cells);
    let paper = Paper::measure(slices.whole(), settings, stage);
    let mut figures = figures::figures(&rows, &paper.approximation, &slices, settings);
    figures.extend(furnace::figures(&furnace));
    figures.extend(cliffs::figures(slices.whole(), &sweep, settings));
    let json = json!({
        "processor": processor::name(), "sigma": SIGMA, "gamma": GAMMA,
        "inputs": "views evenly over the hemisphere, random numbers uniform in [0, 1)",
        "calls": settings.calls, "rounds": settings.rounds, "seed": settings.seed,
        "rows": rows, "furnace": furnace, "sweep": sweep, "figures": figures, "paper": paper.json(),
    });
    let files = if files {
        let own = [
            ("bench.csv", files::csv(&[], &rows)?),
            ("furnace.csv", files::csv(&[], &furnace)?),
            ("bench.json", format!("{json:#}\n").into_bytes()),
            (
                "bench.svg",
                plot::svg(&rows.iter().map(Point::from).collect::<Vec<_>>()).into_bytes(),
            ),
            ("sweep.csv", files::csv(&sweep::Cell::COLUMNS, &cells)?),
        ];
        own.into_iter().chain(paper.files()?).collect()
    } else {
        Vec::new()
    };
    let text = [
        terminal::table(&rows),
        terminal::furnace(&furnace),
        terminal::sweep(&sweep),
        terminal::block(&figures),
        paper.text(),
    ];
    Ok((files, text.join("\n"), json))
}

/// Says on a terminal what is measured: a progress bar would need a second thread next to the one
/// that is timed.
fn stage(what: &str) {
    if io::stderr().is_terminal() {
        eprintln!("{what}");
    }
}

/// Writes to standard output; a closed pipe (`| head`) is not an error.
fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
