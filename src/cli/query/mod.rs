//! `query`: appends table and exact values to points from a CSV file.

mod quantities;

use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};
use rayon::prelude::*;

use super::{Done, Failure, Outcome, tables};
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

/// Rows that are computed at once, on all cores.
const ROWS: usize = 256;

/// Passes the rows of a file through, with the quantity's values appended.
fn answer(io: &Io, quantity: &dyn Quantity) -> Outcome {
    let known = Known::new(tables(io.tables.as_deref())?);
    let input: Box<dyn Read> = if io.input.as_os_str() == "-" {
        Box::new(io::stdin())
    } else {
        let open = File::open(&io.input);
        Box::new(open.map_err(|why| Failure(format!("{}: {why}", io.input.display())))?)
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let header = reader.headers()?.clone();
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
            Err(error) => Err(Failure::from(error)),
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
    let mut records = reader.into_records();
    let mut noted = false;
    loop {
        let some: Vec<_> = records.by_ref().take(ROWS).collect();
        if some.is_empty() {
            break;
        }
        if !noted && io.method.len() > 1 {
            let rows = some.par_iter().filter_map(|record| record.as_ref().ok());
            let note = rows.find_map_first(|row| quantity.note(&picked(row, &columns), &known));
            note.iter().for_each(|note| eprintln!("note: {note}"));
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
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
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
