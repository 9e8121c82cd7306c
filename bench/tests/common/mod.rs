//! Runs the benchmark as a command and reads its tables.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

pub(crate) fn run(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_microfacet-bench"));
    command.args(args).current_dir(folder).output().expect("runs")
}

/// A line of a table, by the names of its columns.
pub(crate) type Record = BTreeMap<String, String>;

pub(crate) fn read(path: &Path) -> Vec<Record> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

pub(crate) fn number(record: &Record, column: &str) -> f64 {
    record[column].parse().unwrap_or_else(|_| panic!("{column} of {record:?}"))
}
