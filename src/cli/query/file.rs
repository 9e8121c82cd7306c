//! The points of a CSV file: its rows pass through, with values appended.

use std::path::Path;

use csv::StringRecord;
use rayon::prelude::*;

use microfacet_baker::input::rows::{Row, RowError, Rows};
use microfacet_baker::input::{MAX_ROW, open_or_stdin, shown};

use super::output::Output;
use super::quantities::{Known, Quantity};
use super::{Io, appended, columns};
use crate::cli::{Context, Result, interrupt, is_stream, note, warn, watched, write_on};

/// Rows that are computed at once, on all cores, and the bytes of input after which fewer are.
const ROWS: usize = 256;
const BYTES: u64 = 2 * MAX_ROW;

/// Approximate seconds for a byte of input; only the share of the whole counts.
const SECONDS: f64 = 1e-6;

/// Passes the rows of a file through, with the quantity's values appended.
pub(super) fn answer(input: &Path, io: &Io, quantity: Quantity, known: &Known) -> Result<()> {
    let path = || shown(input).to_string();
    // The length of a stream is not limited, but that of a row is.
    let reader = open_or_stdin(input, u64::MAX).with_context(path)?;
    let mut rows = Rows::new(reader, None).with_context(path)?;
    let empty = || format!("{}: it is empty; the first row must name the columns", path());
    let header = rows.read().with_context(path)?.with_context(empty)?.fields;
    let [inputs, _] = quantity.columns();
    let names = appended(quantity, &io.method);
    let columns = columns::find(&header, inputs, &names).with_context(path)?;
    let mut output = Output::new(header.iter().map(String::from).chain(names).collect(), io.json);
    let size = std::fs::metadata(input).ok().filter(|_| !is_stream(input));
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
        if !write_on(&output.head()?)? {
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
            let (mut text, refused) = output.rows(answers)?;
            if ended || refused.is_err() {
                text.extend(output.tail());
            }
            if !write_on(&text)? {
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
