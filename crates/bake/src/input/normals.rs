//! Reads a measured distribution of normals from a CSV of angles and D.

use std::io::Read;

use microfacet_model::classic::{Tabulated, TabulatedError};

use super::angles::Angles;
use super::rows::{Row, RowError, Rows};
use super::{Limited, MAX_TEXT};

/// Most rows of a measurement. A fit to that many takes some seconds.
pub const MAX_ROWS: usize = 1_000_000;

/// Why a measurement could not be read.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// A row that cannot be read, or is out of range.
    #[error(transparent)]
    Row(#[from] RowError),
    /// An angle out of range that may have been meant in degrees.
    #[error("{0}; if it is in degrees, say so")]
    Degrees(RowError),
    /// There are more rows than [`MAX_ROWS`].
    #[error("more than {MAX_ROWS} rows: leave some out, or average neighbours")]
    TooMany,
    /// The rows together make no distribution.
    #[error(transparent)]
    Distribution(TabulatedError),
}

microfacet_core::debug_in_words!(MeasuredError);

struct Measured {
    line: u64,
    /// The angle as written.
    angle: f64,
    d: f64,
}

/// Reads a CSV with the columns θ and D, with or without a header; further columns are refused, as
/// is a header that names them in the other order.
///
/// At most [`MAX_ROWS`] rows are taken, and [`MAX_TEXT`] bytes.
///
/// # Errors
/// [`MeasuredError`] with the line.
pub fn read_csv(input: impl Read, angles: Angles) -> Result<Tabulated, MeasuredError> {
    let mut rows = Rows::new(Limited::new(input, MAX_TEXT), Some(b'#'))?;
    let mut measured = Vec::new();
    let mut first = true;
    while let Some(Row { line, fields }) = rows.read()? {
        let refused = |why| Err(RowError { line, why }.into());
        let form = "each row holds an angle and a D, separated by a comma";
        if fields.len() != 2 {
            let columns = if fields.len() == 1 { "column" } else { "columns" };
            return refused(format!("{} {columns}; {form}", fields.len()));
        }
        let [left, right] = [&fields[0], &fields[1]];
        match (left.parse(), right.parse()) {
            (Ok(angle), Ok(d)) => measured.push(Measured { line, angle, d }),
            // Only a first row without any number is a header.
            (Err(_), Err(_)) if first => {
                if is_angle(right) || left.eq_ignore_ascii_case("d") {
                    return refused(format!(
                        "the columns are `{left}` and `{right}`; put the angle first and D second"
                    ));
                }
            }
            (left_read, _) => {
                let text = if left_read.is_err() { left } else { right };
                return refused(format!("`{text}` is not a number; {form}"));
            }
        }
        if measured.len() > MAX_ROWS {
            return Err(MeasuredError::TooMany);
        }
        first = false;
    }
    // The model says what is wrong with an angle that is out of range.
    let radians = |angle| angles.polar(angle).unwrap_or_else(|_| angles.to_radians(angle));
    let points: Vec<_> = measured.iter().map(|row| (radians(row.angle), row.d)).collect();
    Tabulated::new(&points).map_err(|error| refusal(error, &measured, angles))
}

/// Whether a header names a column of angles.
fn is_angle(name: &str) -> bool {
    let name = name.to_lowercase();
    ["theta", "θ", "angle"].iter().any(|word| name.contains(word))
}

/// An error of the model, with the line and the unit of the file.
fn refusal(error: TabulatedError, rows: &[Measured], angles: Angles) -> MeasuredError {
    let unit = angles.name();
    let (row, why) = match error {
        TabulatedError::Angle(i, _) => {
            let angle = rows[i].angle;
            let before = i.checked_sub(1).map(|i| rows[i].angle);
            let why = match (before, angles.polar(angle)) {
                (Some(before), _) if angle <= before => {
                    format!("the angle {angle} must be more than {before}, that of the row before")
                }
                (_, Err((range, doubted))) => {
                    let why = format!("the angle {angle} must be {range}");
                    let error = RowError { line: rows[i].line, why };
                    return if doubted { MeasuredError::Degrees(error) } else { error.into() };
                }
                // Two roundings of π/2.
                _ => format!("the angle {angle} must be more than that of the row before"),
            };
            (i, why)
        }
        TabulatedError::Value(i, d) => (i, format!("D = {d} must be finite and not negative")),
        TabulatedError::Gap(_, to) => {
            let i = rows.partition_point(|row| angles.to_radians(row.angle) < to);
            let (from, to) = (rows[i - 1].angle, rows[i].angle);
            let why = format!(
                "no row between the angles {from} and {to} ({unit}): measure there, or interpolate \
                 before and say so"
            );
            (i, why)
        }
        _ => return MeasuredError::Distribution(error),
    };
    RowError { line: rows[row].line, why }.into()
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    #[test]
    fn bad_rows_are_named_by_their_line_in_the_unit_of_the_file() {
        let check = |angles, text: &str, parts: &[&str]| {
            let message = read_csv(text.as_bytes(), angles).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{text:?}: {message}");
        };
        let radians = |text: &str, parts: &[&str]| check(Angles::Radians, text, parts);
        let degrees = |text: &str, parts: &[&str]| check(Angles::Degrees, text, parts);
        radians("0,1\n0.1,x\n", &["line 2: `x` is not a number"]);
        radians("0,1\n0.1\n", &["line 2: 1 column; each row"]);
        radians("0,1\n0.1,\n0.2,1\n", &["line 2: `` is"]);
        radians("0,1\n\n# half\n0.1,1,2", &["line 4: 3 columns"]);
        // Header, blank lines and comments count, whatever ends a line.
        for end in ["\n", "\r\n", "\r"] {
            let text = "theta,D\n\n# two\n0,1\n\n0.1,-3\n0.2,1".replace('\n', end);
            radians(&text, &["line 6: D = -3"]);
        }
        radians("0,-1\n1,1\n2,1", &["line 1: D = -1"]);
        radians("0,1\n0.1,1\n0.2,inf\n", &["line 3: D = inf"]);
        radians("0,1\n30,1\n60,1", &["line 2: the angle 30", "1.5708", "in degrees, say so"]);
        radians(
            "-30,1\n0.1,1\n0.2,1",
            &["line 1: the angle -30 must be in [0, pi/2 = 1.5708] radians"],
        );
        radians("0,1\n0.1,1\n0.1,1", &["line 3: the angle 0.1 must be more than 0.1"]);
        degrees("0,1\n\n89,1\n91,1", &["line 4: the angle 91", "[0, 90] degrees"]);
        degrees("0,1\n30,1\n29,1", &["line 3: the angle 29 must be more than 30"]);
        let gap = "0,1\n1,1\n2,1\n3,1\n\n40,1\n41,1";
        degrees(gap, &["line 6: no row between the angles 3 and 40 (degrees)"]);
        radians("", &["3 rows, not 0"]);
        radians("0,0\n0.1,0\n0.2,0", &["D is zero"]);
        radians("0,1\n\n\"0.1,1\n0.2,1", &["line 3: a quote"]);
    }

    #[test]
    fn columns_in_the_other_order_are_refused() {
        let read = |header: &str| {
            let text = format!("{header}\n0,1\n0.1,0.9\n0.2,0.8\n");
            read_csv(text.as_bytes(), Angles::Radians)
        };
        for header in ["D,theta", "ndf,Theta_m", "d , angle (rad)", "D,x"] {
            let message = read(header).unwrap_err().to_string();
            assert!(message.contains("line 1: the columns are `"), "{header}: {message}");
        }
        for header in ["theta,D", "angle,NDF", "x,y"] {
            assert!(read(header).is_ok(), "{header}");
        }
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
