//! The command line: one file a subcommand. Only this folder prints or shows progress.

mod bake;
mod bsdf;
mod convert;
mod export;
mod fit;
mod furnace;
mod inspect;
mod interrupt;
mod parser;
mod per_hit;
mod plan;
mod plot;
mod progress;
mod query;
mod recipe;
mod remedy;
mod report;
mod request;
mod sample;
mod shell;
mod stress;
#[cfg(test)]
mod tests;
mod validate;
mod values;
mod view;
mod words;

use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use anstyle::{AnsiColor, Style};
use anyhow::{Context, Error as Failure, Result, anyhow, bail, ensure};
use clap::{FromArgMatches, Parser, Subcommand};
use rayon::ThreadPoolBuilder;

use microfacet_baker::escape;
use microfacet_baker::progress::Meter;
use microfacet_baker::store;
use microfacet_sampler::Tables;

/// Bake, check and query tables for Student-t microfacet materials.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
#[command(after_help = "First steps:
  microfacet-bake recipe -o glass.toml        write a recipe to start from
  microfacet-bake plan glass.toml             show what must be baked for it, and what not
  microfacet-bake bake glass.toml -o glass    bake the tables into the folder glass
  microfacet-bake validate glass              test them against the analytic densities

Exit status: 0 done, 1 a validation rejected, 2 bad input; 128 and the
signal (130 for Ctrl-C) if it was interrupted.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Threads to use; all processors by default.
    #[arg(long, global = true, display_order = 900, value_name = "N", value_parser = values::count::<usize>(1..=1024))]
    threads: Option<usize>,
    /// Show no progress, notes or summaries: only results, warnings and errors.
    #[arg(long, short, global = true, display_order = 901)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    Recipe(recipe::Args),
    Bake(bake::Args),
    Plan(plan::Args),
    Validate(validate::Args),
    Furnace(furnace::Args),
    Bsdf(bsdf::Args),
    Inspect(inspect::Args),
    Report(report::Args),
    Query(query::Args),
    Sample(sample::Args),
    Convert(convert::Args),
    Export(export::Args),
    Fit(fit::Args),
    Plot(plot::Args),
    Completions(shell::Completions),
    Man(shell::ManPages),
}

impl Command {
    /// Whether the command divides work among threads; other commands start none.
    fn is_parallel(&self) -> bool {
        use Command::{Completions, Inspect, Man, Plot, Recipe, Sample};
        !matches!(self, Recipe(_) | Inspect(_) | Sample(_) | Plot(_) | Completions(_) | Man(_))
    }
}

/// How a command ends without an error.
enum Done {
    /// Exit status 0.
    Ok,
    /// Exit status 1: a validation ran and rejected.
    Rejected,
}

impl Done {
    fn judged(passed: bool) -> Self {
        if passed { Self::Ok } else { Self::Rejected }
    }
}

/// An error has exit status 2.
type Outcome = Result<Done>;

pub(crate) fn main() -> ExitCode {
    let parsed = parser::command().try_get_matches();
    let cli = match parsed.and_then(|found| Cli::from_arg_matches(&found)) {
        Ok(cli) => cli,
        Err(why) => return refuse(&why),
    };
    QUIET.store(cli.quiet, Relaxed);
    interrupt::watch();
    match among_threads(cli.threads, cli.command) {
        Ok(Done::Ok) => ExitCode::SUCCESS,
        Ok(Done::Rejected) => ExitCode::from(1),
        Err(why) => {
            // Further lines are indented, so that none of them is taken for another message.
            say("error", &escape::lines(&remedy::told(&why)).replace('\n', "\n    "));
            ExitCode::from(2)
        }
    }
}

/// Runs a command with this many threads, or one for each processor. Where the system does not
/// start them, as in a container that allows no more processes, the main thread does all work.
fn among_threads(threads: Option<usize>, command: Command) -> Outcome {
    if !command.is_parallel() {
        return run(command);
    }
    // Not rayon's global pool, which panics if it cannot be built, and is built once only.
    match ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build() {
        Ok(pool) => pool.install(|| run(command)),
        Err(why) => {
            warn(format!(
                "threads cannot be started ({why}): all work is done by one; ask for fewer with \
                 --threads, or raise the limit on processes or memory"
            ));
            let _pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()?;
            run(command)
        }
    }
}

fn run(command: Command) -> Outcome {
    match command {
        Command::Plan(args) => return plan::run(args),
        Command::Validate(args) => return validate::run(&args),
        Command::Furnace(args) => return furnace::run(&args),
        Command::Bsdf(args) => return bsdf::run(&args),
        Command::Recipe(args) => recipe::run(args)?,
        Command::Bake(args) => bake::run(&args)?,
        Command::Inspect(args) => inspect::run(&args)?,
        Command::Report(args) => report::run(&args)?,
        Command::Query(args) => query::run(&args)?,
        Command::Sample(args) => sample::run(&args)?,
        Command::Convert(args) => convert::run(&args)?,
        Command::Export(args) => export::run(args)?,
        Command::Fit(args) => fit::run(&args)?,
        Command::Plot(args) => plot::run(&args)?,
        Command::Completions(args) => shell::completions(&args)?,
        Command::Man(args) => shell::man(&args)?,
    }
    Ok(Done::Ok)
}

/// Prints help, or why the arguments are refused, and returns the exit status.
fn refuse(why: &clap::Error) -> ExitCode {
    let hides = |argument: OsString| {
        let text = argument.to_string_lossy();
        escape::lines(&text) != text
    };
    if std::env::args_os().any(hides) {
        // The message may repeat characters that command a terminal.
        let _ = write!(io::stderr(), "{}", escape::lines(&why.render().to_string()));
    } else {
        // With colours on a terminal; a closed pipe is no error.
        let _ = why.print();
    }
    ExitCode::from(u8::try_from(why.exit_code()).unwrap_or(2))
}

/// Whether to leave out progress, notes and summaries.
static QUIET: AtomicBool = AtomicBool::new(false);

fn is_quiet() -> bool {
    QUIET.load(Relaxed)
}

/// Writes a line to standard error, of `kind` "warning" or "note".
fn report(kind: &str, message: impl Display) {
    if kind != "note" || !is_quiet() {
        say(kind, &escape::line(&message.to_string()));
    }
}

fn note(message: impl Display) {
    report("note", message);
}

fn warn(message: impl Display) {
    report("warning", message);
}

/// Writes to standard error; a failure is ignored, since no other stream is left.
fn say(kind: &str, text: &str) {
    progress::above(|| {
        let _ = writeln!(io::stderr(), "{}", styled(kind, text));
    });
}

/// A message for standard error, its kind in colour.
fn styled(kind: &str, text: &str) -> String {
    let colour = match kind {
        "note" => AnsiColor::Cyan,
        "warning" | "interrupted" => AnsiColor::Yellow,
        _ => AnsiColor::Red,
    };
    format!("{}: {text}", coloured(kind, colour, &io::stderr()))
}

/// A word in colour, where a stream is a terminal and `NO_COLOR` is not set.
fn coloured(word: &str, colour: AnsiColor, stream: &impl anstream::stream::RawStream) -> String {
    let style = Style::new().bold().fg_color(Some(colour.into()));
    match anstream::AutoStream::choice(stream) {
        anstream::ColorChoice::Never => word.into(),
        _ => format!("{style}{word}{style:#}"),
    }
}

/// Does work of about this many seconds, with a progress bar.
fn watched<T>(what: &'static str, seconds: f64, work: impl FnOnce(&Meter) -> T) -> T {
    let meter = Meter::default();
    meter.expect(seconds);
    let _bar = progress::show(&meter, what);
    work(&meter)
}

/// Writes a text that `--quiet` leaves out.
fn summarize(text: &str) -> Result<()> {
    if is_quiet() { Ok(()) } else { print(text) }
}

/// Writes the verdict of a validation, and returns the outcome.
fn verdict(passed: bool) -> Outcome {
    let (word, colour) =
        if passed { ("PASSED", AnsiColor::Green) } else { ("REJECTED", AnsiColor::Red) };
    write(format!("{}\n", coloured(word, colour, &io::stdout())).as_bytes())?;
    Ok(Done::judged(passed))
}

/// Writes a text to standard output.
fn print(text: &str) -> Result<()> {
    write(escape::lines(text).as_bytes())
}

/// Writes to standard output; a reader that has closed the pipe (`| head`) is no error.
fn write(bytes: &[u8]) -> Result<()> {
    write_on(bytes).map(|_| ())
}

/// Writes to standard output as a whole, and returns whether there is still a reader.
fn write_on(bytes: &[u8]) -> Result<bool> {
    let mut out = io::stdout();
    // Flushed, since an error that waits for the end of the process is lost.
    let mut all = || out.write_all(bytes).and_then(|()| out.flush());
    // A file or pipe is written without the lock of the bar, since its reader may be slow.
    match if io::stdout().is_terminal() { progress::above(all) } else { all() } {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        result => result.context("standard output").map(|()| true),
    }
}

/// Writes a file that a user names.
fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    store::replace(path, bytes).map_err(|why| unwritable(path, why))
}

/// Why a file cannot be written, with its path.
fn unwritable(path: &Path, why: io::Error) -> Failure {
    let hint = match why.kind() {
        io::ErrorKind::InvalidInput => ", or `--out -` for standard output",
        _ => "",
    };
    anyhow!("{}: {why}{hint}", path.display())
}

fn print_json(value: &serde_json::Value) -> Result<()> {
    write(escape::json(&format!("{value:#}\n")).as_bytes())
}

/// Whether an option names standard output or input.
fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The tables at a path, or the embedded default.
fn tables(path: Option<&Path>) -> Result<Tables> {
    let Some(path) = path else { return Ok(Tables::embedded()) };
    ensure!(
        path.try_exists().unwrap_or(true),
        "{}: no such file or folder; name what `microfacet-bake bake` wrote",
        path.display()
    );
    Ok(store::read(path)?)
}
