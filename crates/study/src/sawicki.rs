//! Checks of the equations of Sawicki 2021 (doi:10.5220/0010252702090220): constants of table 1,
//! half angles, and the published curves against table 2.
//!
//! `cargo run --release -p microfacet-study -- sawicki` prints them; `microfacet-bake convert
//! --table` prints table 2 itself.

use std::f64::consts::{LN_2, PI};

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::distribution::DistributionKind::{
    Beckmann, BlinnPhong, Gauss, Sawicki, TrowbridgeReitz,
};
use microfacet_baker::progress::Stage;
use microfacet_fit::convert::table::{COLUMNS, FITTED, rows};
use microfacet_fit::convert::{formulas, half_angle_parameter};
use microfacet_model::classic::{self, Gtr, Isotropic};

use crate::Outcome;

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    println!("table 1: the integral of D (m.n) with the printed constant");
    for gamma in [1.5, 2.0, 3.0] {
        let c = 0.1_f64;
        let printed = c * c / PI * c.powf(-2.0 * gamma);
        println!("  GTR, C = {c}, gamma = {gamma}: {:.4}", printed / Gtr::new(c, gamma)?.peak());
    }
    for m in [0.1_f64, 0.2, 0.4] {
        let log = (m * LN_2.sqrt()).cos().ln();
        let printed = (2.0 * log - LN_2) / (2.0 * PI * log);
        println!("  Gauss, m = {m}: {:.5}", printed / classic::Gauss::new(m)?.peak());
    }
    for (kind, x, printed) in [
        (BlinnPhong, 12.0, 14.0 / (2.0 * PI)),
        (TrowbridgeReitz, 0.3, 1.0 / (PI * 0.09)),
        (DistributionKind::Schlick, 0.3, 1.0 / (PI * 0.09)),
        (Sawicki, 12.0, 96.0 * 15.0 / (PI * 256.0)),
    ] {
        println!("  {}, {x}: {:.12}", kind.name(), printed / kind.build(&[x])?.peak());
    }

    println!(
        "equations 3 to 5, 9 and 10: the half angle of what they give, over the one asked for"
    );
    for (equation, kind) in
        [("3", BlinnPhong), ("4", Gauss), ("5", TrowbridgeReitz), ("9", Beckmann), ("10", Sawicki)]
    {
        let mut worst = 0.0_f64;
        for i in 1..=80 {
            let h = 0.01 * f64::from(i);
            let parameter = half_angle_parameter(kind, h).unwrap_or(f64::NAN);
            let half = kind.build(&[parameter])?.half_angle().unwrap_or(f64::NAN);
            worst = worst.max((half / h - 1.0).abs());
        }
        println!("  {equation}: largest difference from 1, h from 0.01 to 0.8: {worst:.1e}");
    }

    let rows = rows(&Stage::unwatched())?;
    println!("the published curves, against the values printed in table 2");
    let value = |row: usize, kind: DistributionKind| {
        let column = FITTED.iter().position(|fitted| *fitted == kind).map_or(0, |i| 3 + 2 * i);
        // The unrounded m: the printed ones are rounded up.
        if column == 0 { rows[row][0].ours } else { rows[row][column].number() }
    };
    let known = |kind| kind == Beckmann || FITTED.contains(&kind);
    for formula in formulas().filter(|f| known(f.from) && known(f.to)) {
        let off = |row| formula.value(value(row, formula.from)) / value(row, formula.to) - 1.0;
        let worst = (0..rows.len()).max_by(|a, b| off(*a).abs().total_cmp(&off(*b).abs()));
        let row = worst.expect("the table has rows");
        println!(
            "  {:>16} to {:<16} {:>+7.3} % at m = {:<8} {}",
            formula.from.name(),
            formula.to.name(),
            100.0 * off(row),
            rows[row][0].printed,
            formula.source
        );
    }

    println!("what each row gives for the coefficients of equations 12 to 15, from our values");
    println!(
        "  {:>8} {:>12} {:>14} {:>14} {:>12}",
        COLUMNS[0], "2/m^2 - N", "(m_G - m)/m^3", "2/m_G^2 - N", "N_DS/N"
    );
    for row in &rows {
        let [m, n, gauss, sawicki] = [0, 3, 5, 7].map(|i| row[i].ours);
        println!(
            "  {:>8} {:>12.3} {:>14.4} {:>14.3} {:>12.4}",
            row[0].printed,
            2.0 / (m * m) - n,
            (gauss - m) / m.powi(3),
            2.0 / (gauss * gauss) - n,
            sawicki / n
        );
    }
    Ok(())
}
