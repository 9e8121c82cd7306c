//! Table 2 of Sawicki 2021: ours above the printed, differences marked.

use std::fmt::Write;

use microfacet_fit::convert::table::{COLUMNS, Value, rows};

use crate::cli::{Result, watched};

/// Seconds of the search: of `microfacet-bake convert --table` on two cores.
const SECONDS: f64 = 0.6;

pub(super) fn text() -> Result<String> {
    let rows = watched("searching", SECONDS, |meter| rows(&meter.stage(SECONDS)))?;
    let mut text = format!("{:<8}", "");
    for (name, width) in COLUMNS.iter().zip(WIDTHS) {
        write!(text, "{name:>width$} ")?;
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    for row in &rows {
        line(&mut text, "ours", row, Value::rounded, true)?;
        line(&mut text, "printed", row, |value| value.printed.into(), false)?;
    }
    text += "\n* not the printed value when rounded to its digits\n\n";
    writeln!(text, "{:<17}{:>8}{:>19}{:>10}", "column", "agree", "largest deviation", "at m_B")?;
    let mut agreeing = 0;
    for i in GIVEN..COLUMNS.len() {
        let agree = rows.iter().filter(|row| row[i].agrees()).count();
        agreeing += agree;
        let off = |row: &Vec<Value>| row[i].deviation().abs();
        let most = rows.iter().max_by(|a, b| off(a).total_cmp(&off(b)));
        let most = most.expect("the table has rows");
        let name = match i % 2 {
            0 => format!("{} of {}", COLUMNS[i], COLUMNS[i - 1]),
            _ => COLUMNS[i].into(),
        };
        let (deviation, m) = (format!("{:+.3} %", 100.0 * most[i].deviation()), most[0].printed);
        writeln!(text, "{name:<17}{agree:>2} of {}{deviation:>19}{m:>10}", rows.len())?;
    }
    let values = rows.len() * (COLUMNS.len() - GIVEN);
    writeln!(text, "{:<16}{agreeing} of {values}", "all")?;
    text += NOTES;
    Ok(text)
}

/// Where the largest deviations come from.
const NOTES: &str = "
The grids are those that the printed errors fit: of theta from 0 to near 4 m, not to pi/2.
m_B is sqrt(2/N) for the N of Ward's formula, 2/m_B^2; the printed m_B are these, rounded up.
m_G: 0.01910 at 0.1415 is a slip for 0.001910. The printed 0.4970 is no minimum on any such grid;
its error is the one of a grid that ends at 1.2, where the rest of the row ends at 1.4.
2/m_B^2: its error depends on digits of m that are not printed, and is off where N is 75 10^k.
";

/// The first columns, which are given for each row.
const GIVEN: usize = 2;
/// Widths of the columns, without the mark.
const WIDTHS: [usize; 11] = [8, 7, 10, 9, 10, 9, 10, 9, 10, 9, 10];

fn line(
    text: &mut String,
    name: &str,
    row: &[Value],
    cell: impl Fn(&Value) -> String,
    marked: bool,
) -> std::fmt::Result {
    let mut line = format!("{name:<8}");
    for (i, (value, width)) in row.iter().zip(WIDTHS).enumerate() {
        let mark = if marked && i >= GIVEN && !value.agrees() { '*' } else { ' ' };
        write!(line, "{:>width$}{mark}", cell(value))?;
    }
    writeln!(text, "{}", line.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_stands_above_the_printed_in_columns_of_one_width() {
        let text = text().unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].starts_with("ours") && lines[2].starts_with("printed"), "{text}");
        assert!(lines.iter().all(|line| line.len() <= 120), "{text}");
        assert_eq!(lines.iter().filter(|line| line.starts_with("printed")).count(), 17, "{text}");
        // Values end below the names of their columns.
        for (at, _) in lines[0].match_indices("RMSE") {
            assert!(lines[2].as_bytes()[at + 3].is_ascii_digit(), "at {at} in\n{text}");
            assert!(lines[2].as_bytes().get(at + 4).is_none_or(|c| *c == b' '), "{text}");
        }
        // The misprint is marked and explained.
        let slip = lines.iter().position(|line| line.contains("0.01910")).unwrap();
        assert!(
            lines[slip - 1].contains("0.00191*") && text.contains("slip for 0.001910"),
            "{text}"
        );
    }
}
