//! The rows of `docs/reference.csv`.

use std::collections::HashMap;

use crate::compare::SMALLEST;
use crate::lookup::{Answer, Point};
use crate::{Foreign, Limits};

/// Compares every row whose shape is exported; returns whether all agree.
///
/// GGX is exported in closed form: its rows are compared with the exact columns, and its normals,
/// which are not drawn from tables, not at all.
pub(crate) fn compare(
    foreign: &mut impl Foreign,
    limits: &Limits,
    path: &str,
    gammas: &[f64],
) -> bool {
    let mut reader = csv::Reader::from_path(path).expect("the reference");
    let rows: Vec<HashMap<String, String>> = reader.deserialize().map(|row| row.unwrap()).collect();
    let (mut worst, mut cells, mut skipped) = ((0.0, String::new()), 0, 0);
    for (line, row) in rows.iter().enumerate() {
        let number = |name: &str| row[name].parse::<f64>().ok();
        let gamma = number("gamma").unwrap();
        let Some(shape) = gammas.iter().position(|&g| g == gamma) else {
            skipped += 1;
            continue;
        };
        let single = |name: &str| number(name).unwrap() as f32;
        let vector = |name: &str| ["x", "y", "z"].map(|axis| single(&format!("{name}{axis}")));
        let point = Point {
            sigma: [single("sigma_x"), single("sigma_y")],
            v: vector("v"),
            l: vector("l"),
            m: vector("m"),
            u: [single("u1"), single("u2")],
        };
        let masking = usize::from(row["masking"] == "height-correlated");
        for (_, answers) in foreign.answers(shape, &[point]) {
            let density = || limits.density(number("d_table").unwrap(), point.sigma);
            for (name, value, allowed) in columns(&answers[0], masking, limits) {
                let is_ggx = gamma == 2.0;
                let exact = is_ggx && ["g1", "g2", "d", "density"].contains(&name);
                if is_ggx && name.starts_with('n') {
                    continue;
                }
                let column = format!("{name}_{}", if exact { "exact" } else { "table" });
                let Some(want) = number(&column) else { continue };
                let difference = (f64::from(value) - want).abs();
                let share = match allowed {
                    Some(allowed) => difference / allowed,
                    None if difference <= SMALLEST => 0.0,
                    None => difference / want / density(),
                };
                let share = if share.is_nan() { f64::INFINITY } else { share };
                cells += 1;
                if share > worst.0 {
                    worst = (share, format!("line {}, {name}", line + 2));
                }
            }
        }
    }
    let (share, at) = worst;
    let rows = rows.len();
    println!(
        "{cells} values of {rows} rows of the reference, {skipped} rows left out: at most \
         {share:.2} of what is allowed; {at}",
    );
    share <= 1.0 && cells > 0 && skipped == 0
}

/// Columns with the values of an answer and their limits; `None` for densities, whose limit is
/// relative.
fn columns(
    answer: &Answer,
    masking: usize,
    limits: &Limits,
) -> [(&'static str, f32, Option<f64>); 14] {
    let [share, normal, average] = [limits.share, limits.normal, limits.average].map(Some);
    let [nx, ny, nz] = answer.normal;
    let [scale, bias, f82] = answer.parts[masking];
    let [_, bias_avg, f82_avg] = answer.average_parts[masking];
    [
        ("g1", answer.g1, share),
        ("g2", answer.g2[masking], share),
        ("d", answer.d, None),
        ("density", answer.pdf, None),
        ("nx", nx, normal),
        ("ny", ny, normal),
        ("nz", nz, normal),
        ("e", answer.albedo[masking], share),
        ("scale", scale, share),
        ("bias", bias, share),
        ("f82", f82, share),
        ("e_avg", answer.average[masking], average),
        ("bias_avg", bias_avg, average),
        ("f82_avg", f82_avg, average),
    ]
}
