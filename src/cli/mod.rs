//! The command line: one file a subcommand. Only this folder prints or shows progress.

mod bake;
mod certificate;
mod convert;
mod escape;
mod fit;
mod furnace;
mod inspect;
mod plan;
mod plot;
mod query;
mod request;
mod sample;
mod stress;
mod validate;
mod values;
mod words;

use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use microfacet_bake::store;
use microfacet_sampler::Tables;

/// Bake, check and query tables for Student-t microfacet materials.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
#[command(after_help = "Exit status: 0 done, 1 validation rejected, 2 bad input.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Threads to use; all processors by default.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

#[derive(Subcommand)]
enum Command {
    Bake(bake::Args),
    Plan(plan::Args),
    Validate(validate::Args),
    Furnace(furnace::Args),
    Inspect(inspect::Args),
    Query(query::Args),
    Sample(sample::Args),
    Convert(convert::Args),
    Fit(fit::Args),
    Plot(plot::Args),
}

/// How a command ends without an error.
enum Done {
    /// Exit status 0.
    Ok,
    /// Exit status 1: a validation ran and rejected.
    Rejected,
}

/// A message for the user; exit status 2.
struct Failure(String);

impl<E: Display> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

type Outcome = Result<Done, Failure>;

pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Some(threads) = cli.threads {
        // Fails only if a thread pool exists already, and none does.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
    }
    let outcome = match cli.command {
        Command::Bake(args) => bake::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Validate(args) => validate::run(args),
        Command::Furnace(args) => furnace::run(args),
        Command::Inspect(args) => inspect::run(args),
        Command::Query(args) => query::run(args),
        Command::Sample(args) => sample::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Fit(args) => fit::run(args),
        Command::Plot(args) => plot::run(args),
    };
    match outcome {
        Ok(Done::Ok) => ExitCode::SUCCESS,
        Ok(Done::Rejected) => ExitCode::from(1),
        Err(Failure(message)) => {
            // Further lines are indented, so that none of them passes for a message of ours.
            say("error", &escape::lines(&message).replace('\n', "\n    "));
            ExitCode::from(2)
        }
    }
}

/// Writes a line to standard error: a warning or a note, as `kind` says.
fn report(kind: &str, message: impl Display) {
    say(kind, &escape::line(&message.to_string()));
}

/// Writes to standard error; where that fails, nothing is left to say it to.
fn say(kind: &str, text: &str) {
    let _ = writeln!(io::stderr(), "{kind}: {text}");
}

/// Writes a text for people to standard output.
fn print(text: &str) -> Result<(), Failure> {
    write(escape::lines(text).as_bytes())
}

/// Writes to standard output; a reader that has closed the pipe (`| head`) is no error.
fn write(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout();
    // Flushed, since an error that waits for the end of the process is lost.
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON.
fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    write(escape::json(&format!("{value:#}\n")).as_bytes())
}

/// A progress bar of `steps`, on a terminal only.
fn progress(steps: usize, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}")
        .expect("a constant template");
    ProgressBar::new(steps as u64).with_style(style).with_message(what)
}

/// The tables at a path, or the embedded default.
fn tables(path: Option<&Path>) -> Result<Tables, Failure> {
    Ok(match path {
        Some(path) => store::read(path)?,
        None => Tables::embedded(),
    })
}
