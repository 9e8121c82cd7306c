//! What a page of the documentation says that this benchmark and the study `frame_time` printed,
//! read again, so that figures are drawn of the numbers beside them without another run.

use microfacet_study::frame_time;

use crate::Failure;
use crate::plot::Point;
use crate::rows::Quantity;
use crate::terminal::{TABLES, widths};

/// The rows of all tables of a page.
pub(crate) fn points(page: &str) -> Result<Vec<Point>, Failure> {
    let mut all = Vec::new();
    for (quantity, title) in TABLES {
        let [wide, narrow] = widths(quantity);
        let head = format!("{title:wide$}{:>narrow$}", "gamma");
        let mut lines = page.lines().skip_while(|line| !line.starts_with(&head));
        if lines.next().is_none() {
            return Err(Failure(format!(
                "no table that begins with `{title}` and `gamma`; give a page with all tables that \
                 the benchmark prints"
            )));
        }
        let rows = lines.take_while(|line| !line.is_empty() && !line.starts_with("```"));
        for line in rows {
            let point = point(quantity, line, wide);
            all.push(point.ok_or_else(|| {
                let columns = "a name, gamma, ns, bytes, stored, max";
                Failure(format!("`{line}` is no row of `{title}`: it has {columns}"))
            })?);
        }
    }
    Ok(all)
}

/// A row of a table whose names have this width.
fn point(quantity: Quantity, line: &str, wide: usize) -> Option<Point> {
    let (name, columns) = line.split_at_checked(wide)?;
    let columns: Vec<&str> = columns.split_whitespace().collect();
    let &[gamma, ns, _, _, max, ..] = &columns[..] else { return None };
    let number = |text: &str| text.parse::<f64>().ok();
    let gamma = if gamma == "varies" { f64::NAN } else { number(gamma)? };
    let error = if max == "-" { None } else { Some(number(max)?) };
    Some(Point { quantity, name: name.trim().into(), gamma, ns: number(ns)?, error })
}

/// Seconds of the pictures of `frame_time`: of GGX, and of the family.
pub(crate) fn pictures(page: &str) -> Result<[f64; 2], Failure> {
    let seconds = |name: &str| {
        let start = format!("| {name} | ");
        let rest = page.lines().find_map(|line| line.strip_prefix(&start));
        let first = rest.and_then(|rest| rest.split(' ').next());
        first.and_then(|seconds| seconds.parse().ok()).ok_or_else(|| {
            Failure(format!(
                "no row `| {name} | SECONDS`; give a page with what `frame_time` prints"
            ))
        })
    };
    Ok([seconds(frame_time::GGX)?, seconds(frame_time::TEXTURED)?])
}
