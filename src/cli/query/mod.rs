//! `query`: appends table and exact values to points from a CSV file.

mod quantities;

use std::io;
use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};
use microfacet_bake::input::{Limited, MAX_ROW, open_or_stdin, shown};
use rayon::prelude::*;

use super::{Done, Failure, Outcome, report, tables};
use quantities::{Albedo, AlbedoAverage, G1, Known, Normal, Quantity};

/// Append table and exact values to the points of a CSV file.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  printf 'sigma_x,sigma_y,gamma,theta,phi\\n0.3,0.3,3,1.2,0\\n' | microfacet-bake query g1 --input -"
)]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Smith's lambda and G1 of a view. Columns: sigma_x, sigma_y, gamma, theta, phi.
    G1(Io),
    /// The visible normal at random numbers u1, u2, and its density. Columns: those of g1, and u1,
    /// u2. Below gamma = 1.8 table and exact normals of the same u1 differ.
    Normal(Io),
    /// Directional albedo with F = 1 and its Schlick parts. Columns: sigma, gamma, cos_theta,
    /// masking.
    Albedo(Io),
    /// Cosine-weighted average of the albedo. Columns: sigma, gamma, masking.
    AlbedoAverage(Io),
}

#[derive(clap::Args)]
struct Io {
    /// CSV file with named columns, `-` for standard input; other columns are passed through.
    #[arg(long, value_name = "CSV")]
    input: PathBuf,
    /// Tables to read; the embedded default if absent.
    #[arg(long, value_name = "PATH")]
    tables: Option<PathBuf>,
    /// Source of the appended values.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "table,exact")]
    method: Vec<Method>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The sampler's, in single precision.
    Table,
    /// The model's, in double precision.
    Exact,
}

pub(super) fn run(args: Args) -> Outcome {
    match &args.what {
        What::G1(io) => answer(io, &G1),
        What::Normal(io) => answer(io, &Normal),
        What::Albedo(io) => answer(io, &Albedo),
        What::AlbedoAverage(io) => answer(io, &AlbedoAverage),
    }
}

/// Rows that are computed at once, on all cores, and the bytes of input after which fewer are.
const ROWS: usize = 256;
const BYTES: u64 = 2 * MAX_ROW;

/// Passes the rows of a file through, with the quantity's values appended.
fn answer(io: &Io, quantity: &dyn Quantity) -> Outcome {
    let known = Known::new(tables(io.tables.as_deref())?);
    let path = shown(&io.input);
    // A stream of any length, as long as its rows end.
    let input =
        open_or_stdin(&io.input, u64::MAX).map_err(|why| Failure(format!("{path}: {why}")))?;
    let input = Limited::new(input, MAX_ROW);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let unreadable = |line: u64, why: csv::Error| Failure(format!("{path}: line {line}: {why}"));
    let header = reader.headers().map_err(|why| unreadable(1, why))?.clone();
    let columns = quantity
        .inputs()
        .iter()
        .map(|name| find_column(&header, name, quantity.inputs()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut writer = csv::Writer::from_writer(io::stdout());
    let names = io.method.iter().flat_map(|method| quantity.outputs(*method));
    let write =
        |writer: &mut csv::Writer<io::Stdout>, row: Vec<String>| match writer.write_record(&row) {
            Err(error) if is_broken_pipe(&error) => Ok(false),
            Err(error) => Err(Failure(format!("standard output: {error}"))),
            Ok(()) => Ok(true),
        };
    if !write(&mut writer, header.iter().map(String::from).chain(names).collect())? {
        return Ok(Done::Ok);
    }
    let answered = |record: csv::StringRecord| -> Result<Vec<String>, Failure> {
        let line = record.position().map_or(0, csv::Position::line);
        let fields = picked(&record, &columns);
        let mut row: Vec<String> = record.iter().map(String::from).collect();
        for &method in &io.method {
            let values = quantity.values(&fields, &known, method);
            row.extend(values.map_err(|why| Failure(format!("line {line}: {why}")))?);
        }
        Ok(row)
    };
    let mut noted = false;
    let mut ended = false;
    while !ended {
        let mut some = Vec::new();
        let start = reader.position().byte();
        while some.len() < ROWS && reader.position().byte() - start < BYTES {
            reader.get_mut().restart();
            let line = reader.position().line();
            let mut record = csv::StringRecord::new();
            match reader.read_record(&mut record) {
                Ok(true) => some.push(Ok(record)),
                end => {
                    some.extend(end.err().map(|why| Err(unreadable(line, why))));
                    ended = true;
                    break;
                }
            }
        }
        if !noted && io.method.len() > 1 {
            let rows = some.par_iter().filter_map(|record| record.as_ref().ok());
            let note = rows.find_map_first(|row| quantity.note(&picked(row, &columns), &known));
            note.iter().for_each(|note| report("note", note));
            noted = note.is_some();
        }
        let rows: Vec<_> = some.into_par_iter().map(|record| answered(record?)).collect();
        // Written in order; the rows before a refused one are still written.
        for row in rows {
            if !write(&mut writer, row?)? {
                return Ok(Done::Ok);
            }
        }
    }
    match writer.flush() {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure(format!("standard output: {error}")))
        }
        _ => Ok(Done::Ok),
    }
}

/// The fields of a row in some columns.
fn picked<'a>(record: &'a csv::StringRecord, columns: &[usize]) -> Vec<&'a str> {
    columns.iter().map(|&column| &record[column]).collect()
}

fn is_broken_pipe(error: &csv::Error) -> bool {
    matches!(error.kind(), csv::ErrorKind::Io(error) if error.kind() == io::ErrorKind::BrokenPipe)
}

fn find_column(header: &csv::StringRecord, name: &str, all: &[&str]) -> Result<usize, Failure> {
    header.iter().position(|column| column == name).ok_or_else(|| {
        let have: Vec<&str> = header.iter().collect();
        Failure(format!(
            "no column `{name}`; the columns are {}, the file has {}",
            all.join(", "),
            have.join(", ")
        ))
    })
}
