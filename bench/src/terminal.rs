//! Rows and figures for the terminal, in columns.

use crate::figures::Figure;
use crate::furnace;
use crate::rows::{Quantity, Row};
use crate::settings::SIGMA;
use crate::sweep::Summary;

/// The tables of rows, with the names of what they hold.
pub(crate) const TABLES: [(Quantity, &str); 6] = [
    (Quantity::Normal, "visible normals"),
    (Quantity::G1, "G1"),
    (Quantity::D, "D"),
    (Quantity::Conductor, "conductor, sample_with_pdf and eval_pdf"),
    (Quantity::Evaluation, "conductor, eval_pdf"),
    (Quantity::PerHit, "parameters per hit"),
];

/// The width of names and of γ. A line has at most 100 columns; names of normals are shorter.
pub(crate) fn widths(quantity: Quantity) -> [usize; 2] {
    if quantity == Quantity::Normal { [40, 6] } else { [43, 7] }
}

pub(crate) fn table(rows: &[Row]) -> String {
    let mut text =
        format!("sigma {}; errors are of the CDFs, or of G1, absolute, or of D, relative\n", SIGMA);
    for (quantity, title) in TABLES {
        let is_normal = quantity == Quantity::Normal;
        let [wide, narrow] = widths(quantity);
        text += &format!(
            "\n{title:wide$}{:>narrow$}{:>8}{:>8}{:>7}{:>7}{:>7}",
            "gamma", "ns", "bytes", "stored", "max", "rms"
        );
        text += &if is_normal { format!("{:>8}{:>9}\n", "var.", "var x ns") } else { "\n".into() };
        for row in rows.iter().filter(|row| row.quantity == quantity) {
            let error = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.1e}"));
            let (max, rms) = (error(row.error_max), error(row.error_rms));
            let Row { name, ns, bytes, stored_bytes: stored, .. } = row;
            let gamma = if row.gamma.is_nan() { "varies".into() } else { row.gamma.to_string() };
            text += &format!(
                "{name:wide$}{gamma:>narrow$}{ns:>8.2}{bytes:>8}{stored:>7}{max:>7}{rms:>7}"
            );
            if let (Some(variance), Some(cost)) = (row.furnace_variance, row.variance_ns) {
                text += &format!("{variance:>8.5}{cost:>9.3}");
            }
            text.push('\n');
        }
    }
    text
}

/// Samplers of every material, by noise and time.
pub(crate) fn furnace(rows: &[furnace::Row]) -> String {
    let mut text = format!(
        "{:30}{:>6}{:>6}{:>6}{:>7}{:>7}{:>7}{:>7}{:>8}{:>7}{:>9}\n",
        "what a user would pick instead",
        "sigma",
        "gamma",
        "drawn",
        "cos .9",
        "cos .5",
        "cos .1",
        "mean",
        "largest",
        "ns",
        "var x ns"
    );
    for row in rows {
        let &furnace::Row { name, sigma, gamma, drawn_sigma: drawn, .. } = row;
        let &furnace::Row { variance, largest, ns, variance_ns: cost, .. } = row;
        let [a, b, c] = [row.variance_09, row.variance_05, row.variance_01];
        text += &format!(
            "{name:30}{sigma:>6}{gamma:>6}{drawn:>6.3}{a:>7.4}{b:>7.4}{c:>7.4}{variance:>7.4}\
             {largest:>8.2}{ns:>7.1}{cost:>9.3}\n"
        );
    }
    text
}

/// The sweep: each function with its times and its slowest cell.
pub(crate) fn sweep(summaries: &[Summary]) -> String {
    let mut text = format!(
        "{:33} {:>8} {:>8} {:>8} {:>8}  worst at gamma, sigma (turns), views, numbers\n",
        "sweep, ns a call", "common", "median", "99 %", "worst"
    );
    for summary in summaries {
        let Summary { common_ns: common, median_ns: median, worst, .. } = summary;
        let most = summary.percentile_99_ns;
        let [x, y] = worst.sigma;
        let sigma = if x == y { x.to_string() } else { format!("{x}:{y}") };
        let [a, b, c] = worst.turns;
        let turns = if worst.turns == [0.0; 3] { "".into() } else { format!(" ({a} {b} {c})") };
        text += &format!(
            "{:33} {common:>8.2} {median:>8.2} {most:>8.2} {:>8.2}  {}, {sigma}{turns}, {}, {}\n",
            worst.function, worst.ns, worst.gamma, worst.views, worst.numbers
        );
    }
    text
}

/// The figures with their limits and goals.
pub(crate) fn block(figures: &[Figure]) -> String {
    let mut text = format!(
        "{:48} {:>9} {:>9} {:>9}\n",
        "figures (smaller is better)", "must", "aim", "reached"
    );
    for figure in figures {
        let number = |x: f64| if x < 0.01 { format!("{x:.1e}") } else { format!("{x:.3}") };
        let name = match figure.unit {
            "" => figure.name.into(),
            unit => format!("{}, {unit}", figure.name),
        };
        let reached = figure.reached.map_or("-".into(), number);
        let verdict = match figure.reached {
            Some(x) if x <= figure.aim => "aim",
            Some(x) if x <= figure.must => "must",
            Some(_) => "MISSED",
            None => "",
        };
        text += &format!(
            "{name:48} {:>9} {:>9} {reached:>9}  {verdict}\n",
            number(figure.must),
            number(figure.aim)
        );
    }
    text
}
