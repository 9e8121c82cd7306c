//! `query`: appends table and exact values to points from a CSV file.

mod columns;
mod quantities;

use std::fmt::Display;

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};
use rayon::prelude::*;

use microfacet_baker::input::rows::{Row, RowError, Rows};
use microfacet_baker::input::{MAX_ROW, open_or_stdin, shown};
use microfacet_baker::progress::Meter;

use super::values::Unit;
use super::{Done, Failure, Outcome, interrupt, progress, report, tables, write_on};
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
    G1(View),
    /// The visible normal at random numbers u1, u2, and its density. Columns: those of g1, and u1,
    /// u2. Below gamma = 1.8 table and exact normals of the same u1 differ.
    Normal(View),
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
    /// A table file, or a folder with one; the embedded default if absent.
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Source of the appended values.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "table,exact")]
    method: Vec<Method>,
}

#[derive(clap::Args)]
struct View {
    #[command(flatten)]
    io: Io,
    #[command(flatten)]
    unit: Unit,
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
        What::G1(view) => answer(&view.io, &G1(view.unit)),
        What::Normal(view) => answer(&view.io, &Normal(view.unit)),
        What::Albedo(io) => answer(io, &Albedo),
        What::AlbedoAverage(io) => answer(io, &AlbedoAverage),
    }
}

/// Rows that are computed at once, on all cores, and the bytes of input after which fewer are.
const ROWS: usize = 256;
const BYTES: u64 = 2 * MAX_ROW;

/// Seconds for a byte of input, about; only its share of the whole counts.
const SECONDS: f64 = 1e-6;

/// Passes the rows of a file through, with the quantity's values appended.
fn answer(io: &Io, quantity: &dyn Quantity) -> Outcome {
    let known = Known::new(tables(io.tables.as_deref())?);
    let path = shown(&io.input);
    let failed = |why: &dyn Display| Failure(format!("{path}: {why}"));
    // A stream of any length, as long as its rows end.
    let input = open_or_stdin(&io.input, u64::MAX).map_err(|why| failed(&why))?;
    let mut rows = Rows::new(input, None).map_err(|why| failed(&why))?;
    let empty = || failed(&"it is empty; the first row must name the columns");
    let header = rows.read().map_err(|why| failed(&why))?.ok_or_else(empty)?.fields;
    let names: Vec<String> = io.method.iter().flat_map(|m| quantity.outputs(*m)).collect();
    let columns = columns::find(&header, quantity.inputs(), &names).map_err(|why| failed(&why))?;
    let mut first = csv::Writer::from_writer(Vec::new());
    first.write_record(header.iter().map(String::from).chain(names))?;
    let is_file = io.input.as_os_str() != "-";
    let size = std::fs::metadata(&io.input).ok().filter(|_| is_file).map_or(0, |file| file.len());
    interrupt::leaves_stream();
    let meter = Meter::default();
    meter.expect(SECONDS * size as f64);
    let bar = progress::show(&meter, "answering");
    let stage = meter.stage(SECONDS * size as f64);
    stage.split(usize::try_from(size)?);
    if !write_on(&first.into_inner()?)? {
        return Ok(Done::Ok);
    }
    let answered = |row: Result<Row, RowError>| -> Result<Vec<String>, Failure> {
        let Row { line, fields } = row.map_err(|why| failed(&why))?;
        let mut values: Vec<String> = fields.iter().map(String::from).collect();
        for &method in &io.method {
            let found = quantity.values(&picked(&fields, &columns), &known, method);
            values.extend(found.map_err(|why| failed(&format_args!("line {line}: {why}")))?);
        }
        Ok(values)
    };
    let (mut noted, mut doubted) = (io.method.len() < 2, false);
    let mut ended = false;
    while !ended {
        let mut some = Vec::new();
        let start = rows.bytes();
        while some.len() < ROWS && rows.bytes() - start < BYTES && !ended {
            let row = rows.read().transpose().map(|row| complete(row?, header.len()));
            ended = !matches!(row, Some(Ok(_)));
            some.extend(row);
        }
        let read = || some.par_iter().filter_map(|row| row.as_ref().ok());
        if !noted {
            let note =
                read().find_map_first(|row| quantity.note(&picked(&row.fields, &columns), &known));
            note.iter().for_each(|note| report("note", note));
            noted = note.is_some();
        }
        if !doubted {
            let doubt = read().find_map_first(|row| {
                let doubt = quantity.doubt(&picked(&row.fields, &columns))?;
                Some(format!("{path}: line {}: {doubt}", row.line))
            });
            doubt.iter().for_each(|doubt| report("warning", doubt));
            doubted = doubt.is_some();
        }
        let taken = rows.bytes() - start;
        let answers: Vec<_> = some.into_par_iter().map(answered).collect();
        // Whole rows in order; those before a refused one are still written.
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut refused = None;
        for answer in answers {
            match answer {
                Ok(row) => writer.write_record(&row)?,
                Err(why) => {
                    refused = Some(why);
                    break;
                }
            }
        }
        if !write_on(&writer.into_inner()?)? {
            break;
        }
        if let Some(why) = refused {
            return Err(why);
        }
        stage.steps(usize::try_from(taken)?);
    }
    drop(bar);
    Ok(Done::Ok)
}

/// The fields of a row in some columns.
fn picked<'a>(record: &'a csv::StringRecord, columns: &[usize]) -> Vec<&'a str> {
    columns.iter().map(|&column| &record[column]).collect()
}

/// A row, which must have as many columns as the header.
fn complete(row: Row, columns: usize) -> Result<Row, RowError> {
    if row.fields.len() == columns {
        return Ok(row);
    }
    let why = format!("it has {} columns, and the header {columns}", row.fields.len());
    Err(RowError { line: row.line, why })
}
