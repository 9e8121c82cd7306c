//! Fits (σ, γ) to a measured distribution of normals.

use std::fmt;
use std::io::{self, Read};

use microfacet_model::classic::{Tabulated, TabulatedError};

use crate::convert::{ConvertError, Form, Replacement, Target};
use crate::distribution::DistributionKind;
use crate::input::{Limited, MAX_ROW, MAX_TEXT};
use crate::progress::Meter;

/// Most rows of a measurement. A fit to as many takes some seconds.
pub const MAX_ROWS: usize = 1_000_000;

/// Why a measurement could not be read.
#[derive(Debug)]
pub enum MeasuredError {
    /// The file is not a CSV of two numbers a row: the line (from 1) and the reason.
    Row(u64, String),
    /// The file could not be read, or one row or all of it is too long; the line and the reason.
    Input(u64, io::Error),
    /// There are more rows than [`MAX_ROWS`].
    TooMany,
    /// The rows are not a distribution.
    Distribution(TabulatedError),
}

impl fmt::Display for MeasuredError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Row(line, why) => {
                write!(
                    f,
                    "line {line}: {why}; each line holds an angle and a D, separated by a comma"
                )
            }
            Self::Input(line, why) => write!(f, "line {line}: {why}"),
            Self::TooMany => {
                write!(f, "more than {MAX_ROWS} rows: leave some out, or average neighbours")
            }
            Self::Distribution(e) => write!(f, "{e} (rows are counted from 0, without the header)"),
        }
    }
}

impl std::error::Error for MeasuredError {}

/// Unit of the angles in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

/// Reads a CSV with the columns θ and D, with or without a header; further columns are refused.
///
/// At most [`MAX_ROWS`] rows are taken, and [`MAX_TEXT`] bytes.
///
/// # Errors
/// [`MeasuredError`] with the line, or the row of a value that is out of range.
pub fn read_csv(input: impl Read, angles: Angles) -> Result<Tabulated, MeasuredError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(Limited::new(Limited::new(input, MAX_TEXT), MAX_ROW));
    let mut rows = Vec::new();
    let mut record = csv::StringRecord::new();
    let mut first = true;
    loop {
        reader.get_mut().restart();
        let line = reader.position().line();
        if !reader.read_record(&mut record).map_err(|error| unreadable(line, error))? {
            break;
        }
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != 2 {
            return Err(MeasuredError::Row(line, format!("{} columns", record.len())));
        }
        let number = |text: &str| text.parse::<f64>();
        match (number(&record[0]), number(&record[1])) {
            (Ok(theta), Ok(d)) => {
                rows.push((if angles == Angles::Degrees { theta.to_radians() } else { theta }, d));
            }
            // Only a first line without any number is a header.
            (Err(_), Err(_)) if first => {}
            (Err(_), _) => {
                return Err(MeasuredError::Row(line, format!("`{}` is not a number", &record[0])));
            }
            (_, Err(_)) => {
                return Err(MeasuredError::Row(line, format!("`{}` is not a number", &record[1])));
            }
        }
        if rows.len() > MAX_ROWS {
            return Err(MeasuredError::TooMany);
        }
        first = false;
    }
    Tabulated::new(&rows).map_err(MeasuredError::Distribution)
}

/// The error for a row that begins at a line.
fn unreadable(line: u64, error: csv::Error) -> MeasuredError {
    match error.into_kind() {
        csv::ErrorKind::Io(why) => MeasuredError::Input(line, why),
        _ => MeasuredError::Row(line, "not readable text".into()),
    }
}

/// The best Student-t, and its two well-known special cases for comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// σ and γ fitted together.
    pub student_t: Replacement,
    /// γ = ∞.
    pub beckmann: Replacement,
    /// γ = 2.
    pub ggx: Replacement,
}

/// Fits by least squares over the measured angles, and counts the work in a meter.
///
/// # Errors
/// [`ConvertError::Minimiser`].
pub fn fit(measured: &Tabulated, form: Form, meter: &Meter) -> Result<Fit, ConvertError> {
    use DistributionKind::{Beckmann, StudentT, TrowbridgeReitz};
    let target = Target::measured(measured);
    meter.expect([StudentT, Beckmann, TrowbridgeReitz].map(|to| target.seconds(to)).iter().sum());
    let nearest = |to| target.by_rmse(to, form, &meter.stage(target.seconds(to)));
    Ok(Fit {
        student_t: nearest(StudentT)?,
        beckmann: nearest(Beckmann)?,
        ggx: nearest(TrowbridgeReitz)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use microfacet_model::classic::{Isotropic, Member};

    fn measured(sigma: f64, gamma: f64, upto: f64) -> String {
        let truth = Member::student_t(sigma, gamma).unwrap();
        let rows = (0..=400)
            .map(|i| f64::from(i) * upto / 400.0)
            .map(|t| format!("{t},{}\n", 3.0 * truth.d(t.to_radians())));
        format!("theta,D\n{}", rows.collect::<String>())
    }

    #[test]
    fn finds_what_was_measured() {
        for (sigma, gamma) in [(0.3, 2.6), (0.15, 5.0), (0.2, 1.8)] {
            let table = read_csv(measured(sigma, gamma, 89.9).as_bytes(), Angles::Degrees).unwrap();
            let fit = fit(&table, Form::Relative, &Meter::default()).unwrap();
            let [s, g] = fit.student_t.to.values[..] else { panic!() };
            assert!(
                (s / sigma - 1.0).abs() < 1e-2 && (g / gamma - 1.0).abs() < 2e-2,
                "{sigma} {gamma}: {s} {g}"
            );
            assert!(fit.student_t.rmse[0] < 0.3 * fit.ggx.rmse[0].min(fit.beckmann.rmse[0]));
        }
    }

    #[test]
    fn bad_rows_are_named() {
        let message =
            |text: &str| read_csv(text.as_bytes(), Angles::Radians).unwrap_err().to_string();
        assert!(message("0,1\n0.1,x\n").contains("line 2"));
        assert!(message("0,1\n0.1\n").contains("line 2: 1 columns"));
        assert!(message("0,1\n0.1,\n0.2,1\n").contains("line 2"));
        assert!(message("theta,D\n0,1\n0.1,-3\n0.2,1").contains("row 1: D = -3"));
        assert!(message("0,1\n30,1\n60,1").contains("radians"));
    }

    #[test]
    fn what_never_ends_is_refused() {
        let message = |input: &mut dyn Read| {
            read_csv(input, Angles::Radians).map(|_| ()).unwrap_err().to_string()
        };
        // One row, comments, rows, and a field in quotes.
        assert!(message(&mut io::repeat(0)).contains("1 MiB"));
        assert!(message(&mut io::repeat(b'#')).contains("1 MiB"));
        assert!(message(&mut io::repeat(b'\n')).contains("1 MiB"));
        assert!(message(&mut b"0,\"".chain(io::repeat(b'1'))).contains("1 MiB"));
        let rows = "0,1\n".repeat(MAX_ROWS + 1);
        assert!(message(&mut rows.as_bytes()).contains("more than 1000000 rows"));
        // Long rows reach the limit of the whole first.
        let row = format!("0,{}1\n", " ".repeat(1 << 16));
        let rows = row.repeat((MAX_TEXT >> 16) as usize);
        assert!(message(&mut rows.as_bytes()).contains("64 MiB"));
    }
}
