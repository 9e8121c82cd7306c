//! `query`: appends table and exact values to points from a CSV file.

mod columns;
mod quantities;

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};
use csv::{StringRecord, Writer};
use rayon::prelude::*;

use microfacet_baker::input::rows::{Row, RowError, Rows};
use microfacet_baker::input::{MAX_ROW, open_or_stdin, shown};

use super::values::Unit;
use super::{Context, Result, interrupt, is_stream, note, tables, warn, watched, write_on};
use quantities::{Known, Quantity};

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

pub(super) fn run(args: &Args) -> Result<()> {
    let (io, unit, quantity) = match &args.what {
        What::G1(view) => (&view.io, view.unit, Quantity::G1),
        What::Normal(view) => (&view.io, view.unit, Quantity::Normal),
        What::Albedo(io) => (io, Unit::default(), Quantity::Albedo),
        What::AlbedoAverage(io) => (io, Unit::default(), Quantity::AlbedoAverage),
    };
    let known = Known::new(quantity, unit, tables(io.tables.as_deref())?);
    answer(io, quantity, &known)
}

/// Rows that are computed at once, on all cores, and the bytes of input after which fewer are.
const ROWS: usize = 256;
const BYTES: u64 = 2 * MAX_ROW;

/// Approximate seconds for a byte of input; only the share of the whole counts.
const SECONDS: f64 = 1e-6;

/// Passes the rows of a file through, with the quantity's values appended.
fn answer(io: &Io, quantity: Quantity, known: &Known) -> Result<()> {
    let path = || shown(&io.input).to_string();
    // The length of a stream is not limited, but that of a row is.
    let input = open_or_stdin(&io.input, u64::MAX).with_context(path)?;
    let mut rows = Rows::new(input, None).with_context(path)?;
    let empty = || format!("{}: it is empty; the first row must name the columns", path());
    let header = rows.read().with_context(path)?.with_context(empty)?.fields;
    let [inputs, outputs] = quantity.columns();
    let named = |method: &Method| {
        let method = if *method == Method::Table { "table" } else { "exact" };
        outputs.iter().map(move |stem| format!("{stem}_{method}"))
    };
    let names: Vec<String> = io.method.iter().flat_map(named).collect();
    let columns = columns::find(&header, inputs, &names).with_context(path)?;
    let mut first = Writer::from_writer(Vec::new());
    first.write_record(header.iter().map(String::from).chain(names))?;
    let size = std::fs::metadata(&io.input).ok().filter(|_| !is_stream(&io.input));
    let size = size.map_or(0, |file| file.len());
    interrupt::leaves_stream();
    let answered = |row: Result<Row, RowError>| -> Result<StringRecord> {
        let mut row = row?;
        let point = picked(&row.fields, &columns);
        let mut values = Vec::new();
        for &method in &io.method {
            let found = known.values(&point, method);
            values.extend(found.with_context(|| format!("line {}", row.line))?);
        }
        row.fields.extend(values);
        Ok(row.fields)
    };
    watched("answering", SECONDS * size as f64, |meter| {
        let stage = meter.stage(SECONDS * size as f64);
        stage.split(usize::try_from(size)?);
        if !write_on(&first.into_inner()?)? {
            return Ok(());
        }
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
                let found = read().find_map_first(|row| known.note(&picked(&row.fields, &columns)));
                found.iter().for_each(note);
                noted = found.is_some();
            }
            if !doubted {
                let found = read().find_map_first(|row| {
                    let doubt = known.doubt(&picked(&row.fields, &columns))?;
                    Some(format!("{}: line {}: {doubt}", path(), row.line))
                });
                found.iter().for_each(warn);
                doubted = found.is_some();
            }
            let answers: Vec<_> = some.into_par_iter().map(answered).collect();
            // Whole rows in order; those before a refused one are still written.
            let mut writer = Writer::from_writer(Vec::new());
            let write = |answer: Result<StringRecord>| Ok(writer.write_record(&answer?)?);
            let refused: Result<()> = answers.into_iter().try_for_each(write);
            if !write_on(&writer.into_inner()?)? {
                return Ok(());
            }
            refused.with_context(path)?;
            stage.steps(usize::try_from(rows.bytes() - start)?);
        }
        Ok(())
    })
}

/// The fields of a row in some columns.
fn picked<'a>(record: &'a StringRecord, columns: &[usize]) -> Vec<&'a str> {
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
