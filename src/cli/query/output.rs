//! Rows as they are written: CSV, or an array of JSON.

use csv::{StringRecord, Writer};
use serde_json::{Number, Value};

use crate::cli::Result;

/// Rows with the same columns.
pub(super) struct Output {
    names: Vec<String>,
    is_json: bool,
    /// Whether a row was written.
    begun: bool,
}

impl Output {
    pub(super) fn new(names: Vec<String>, is_json: bool) -> Self {
        Self { names, is_json, begun: false }
    }

    /// What stands before the rows.
    pub(super) fn head(&self) -> Result<Vec<u8>> {
        if self.is_json {
            return Ok(b"[".into());
        }
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(&self.names)?;
        Ok(writer.into_inner()?)
    }

    /// The rows up to one that is refused, with the reason.
    pub(super) fn rows(
        &mut self,
        rows: impl IntoIterator<Item = Result<StringRecord>>,
    ) -> Result<(Vec<u8>, Result<()>)> {
        let mut writer = Writer::from_writer(Vec::new());
        let mut text = Vec::new();
        for row in rows {
            let row = match row {
                Ok(row) => row,
                Err(why) => return Ok((self.part(writer, text)?, Err(why))),
            };
            if self.is_json {
                text.extend(if self.begun { &b",\n "[..] } else { b"\n " });
                text.extend(self.object(&row).bytes());
            } else {
                writer.write_record(&row)?;
            }
            self.begun = true;
        }
        Ok((self.part(writer, text)?, Ok(())))
    }

    fn part(&self, writer: Writer<Vec<u8>>, text: Vec<u8>) -> Result<Vec<u8>> {
        Ok(if self.is_json { text } else { writer.into_inner()? })
    }

    /// A row under the names of its columns, in their order.
    fn object(&self, row: &StringRecord) -> String {
        let entry = |(name, field): (&String, &str)| {
            let value = number(field).map_or_else(|| field.into(), Value::Number);
            format!("{}: {value}", Value::from(&name[..]))
        };
        let entries: Vec<String> = self.names.iter().zip(row).map(entry).collect();
        format!("{{{}}}", entries.join(", "))
    }

    /// What stands after the rows.
    pub(super) fn tail(&self) -> &'static [u8] {
        if self.is_json { b"\n]\n" } else { b"" }
    }
}

/// A number as JSON has them, or without the zero before the point; `007` is none, but a name.
fn number(field: &str) -> Option<Number> {
    let is_bare = field.trim_start_matches('-').starts_with('.');
    let bare = || is_bare.then(|| field.parse().ok().and_then(Number::from_f64)).flatten();
    serde_json::from_str(field).ok().or_else(bare)
}
