//! Table 2 of Sawicki 2021 (doi:10.5220/0010252702090220): the distributions of least RMSE to a
//! Beckmann, as printed and recomputed.
//!
//! The errors are those of D/D(0) on uniform grids of θ. Where the grids end is not printed, and
//! was found from the errors: the integral of the squared difference, divided by the square of the
//! printed RMSE, is the length of the range. It comes out as a number of two digits in radians in
//! every row (`ENDS`, near 4 m), alike from the columns of N, m_G and N_DS, and explains why the
//! errors of C_TR waver from row to row. On [0, π/2) instead, errors are smaller by √(8 m/π), and
//! C_TR differs by up to 0.5 %, since its long tail counts. The number of steps hardly matters.
//! The printed m are √(2/N) rounded up.

use rayon::prelude::*;

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::distribution::DistributionKind::{
    Beckmann, BlinnPhong, Gauss, Sawicki, TrowbridgeReitz,
};
use microfacet_baker::progress::Stage;

use super::{ConvertError, Form, Target};

/// The table as printed: m_B, N by equation 11 with its RMSE, then four parameters, each with its
/// RMSE.
const PRINTED: &str = include_str!("sawicki-2021-table-2.csv");

/// Where the grid of each row ends, in radians.
const ENDS: [f64; 17] = [
    1.4, 1.1, 0.8, 0.65, 0.56, 0.4, 0.26, 0.22, 0.17, 0.12, 0.085, 0.07, 0.06, 0.04, 0.027, 0.021,
    0.017,
];
/// Steps of each grid; 100 give the same parameters to 2e-5.
const STEPS: usize = 1000;

/// The fitted kinds: each has two columns after the first three, its parameter and its RMSE.
pub const FITTED: [DistributionKind; 4] = [BlinnPhong, Gauss, Sawicki, TrowbridgeReitz];
/// Names of the columns, in the order of the file.
pub const COLUMNS: [&str; 11] =
    ["m_B", "2/m_B^2", "RMSE", "N", "RMSE", "m_G", "RMSE", "N_DS", "RMSE", "C_TR", "RMSE"];

/// One value, as printed and recomputed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// As printed, with its digits.
    pub printed: &'static str,
    /// The recomputed value.
    pub ours: f64,
}

impl Value {
    /// The printed number.
    pub fn number(&self) -> f64 {
        number(self.printed)
    }

    /// The recomputed value, rounded to the printed digits.
    pub fn rounded(&self) -> String {
        let (mantissa, exponent) = self.printed.split_once('e').unwrap_or((self.printed, ""));
        let places = mantissa.split_once('.').map_or(0, |(_, places)| places.len());
        match exponent {
            "" => format!("{:.places$}", self.ours),
            _ => format!("{:.places$e}", self.ours),
        }
    }

    /// Whether the recomputed value equals the printed one to the printed digits.
    pub fn agrees(&self) -> bool {
        self.rounded() == self.printed
    }

    /// The recomputed value over the printed one, less 1.
    pub fn deviation(&self) -> f64 {
        self.ours / self.number() - 1.0
    }
}

fn number(printed: &str) -> f64 {
    printed.parse().expect("the table holds numbers")
}

fn printed() -> impl Iterator<Item = Vec<&'static str>> {
    PRINTED.lines().skip(1).map(|line| line.split(',').collect())
}

/// The range of a kind's parameter in the table; `None` for kinds that the table does not have.
pub(super) fn printed_range(kind: DistributionKind) -> Option<[f64; 2]> {
    let column = match kind {
        Beckmann => 0,
        _ => 3 + 2 * FITTED.iter().position(|fitted| *fitted == kind)?,
    };
    let values = printed().map(|row| number(row[column]));
    Some(values.fold([f64::INFINITY, 0.0], |[low, high], x| [low.min(x), high.max(x)]))
}

/// The rows of the table, each with the values of [`COLUMNS`]; the first two, m_B and the N of
/// equation 11, identify the row, and their recomputed values are the inputs of the computation.
/// Each row is one step of the stage.
///
/// # Errors
/// [`ConvertError::Minimiser`] with the message of the minimiser.
pub fn rows(stage: &Stage) -> Result<Vec<Vec<Value>>, ConvertError> {
    let all: Vec<_> = printed().zip(ENDS).collect();
    stage.split(all.len());
    all.into_par_iter()
        .map(|(texts, end)| {
            let n = number(texts[1]);
            let m = (2.0 / n).sqrt();
            let beckmann = Beckmann.build(&[m])?;
            let target = Target::up_to(&*beckmann, end, STEPS);
            let mut ours = vec![m, n, target.rmse(&*BlinnPhong.build(&[n])?, Form::Relative)];
            for kind in FITTED {
                let found = target.by_rmse(kind, Form::Relative, &Stage::unwatched())?;
                ours.extend([found.to.values[0], found.rmse[0]]);
            }
            stage.step();
            let pair = |(printed, ours)| Value { printed, ours };
            Ok(texts.into_iter().zip(ours).map(pair).collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_is_rounded_as_printed() {
        let value = |printed, ours| Value { printed, ours };
        assert_eq!(value("0.4970", 0.49698).rounded(), "0.4970");
        assert_eq!(value("1171", 1171.3).rounded(), "1171");
        assert_eq!(value("6.975e-5", 6.97525e-5).rounded(), "6.975e-5");
        assert!(value("1.390e-6", 1.3899e-6).agrees() && !value("0.02", 0.0251).agrees());
    }

    #[test]
    fn the_table_is_reproduced() {
        let rows = rows(&Stage::unwatched()).unwrap();
        assert!(rows.len() == 17 && rows.iter().all(|row| row.len() == COLUMNS.len()));
        // How many of the 17 agree to the printed digits, and the largest deviation of the others:
        // rounding, and slips of the printed table, which are named.
        let agreeing = |i: usize| rows.iter().filter(|row| row[i].agrees()).count();
        let deviation =
            |i: usize| rows.iter().map(|row| row[i].deviation().abs()).fold(0.0, f64::max);
        for (i, agree, largest) in
            [(3, 14, 2e-4), (5, 16, 9e-4), (7, 10, 9e-4), (9, 14, 4e-4), (10, 13, 2e-4)]
        {
            let (agreed, most) = (agreeing(i), deviation(i));
            assert!(agreed >= agree && most < largest, "{}: {agreed}, {most}", COLUMNS[i]);
        }
        // 0.01910 for 0.001910.
        let slip = &rows[4][6];
        assert!(slip.printed == "0.01910" && (slip.ours - 0.00191).abs() < 1e-6, "{slip:?}");
        // Beyond the printed range the difference is negligible: only the number of angles grows.
        let beckmann = Beckmann.build(&[0.2]).unwrap();
        let phong = BlinnPhong.build(&[47.33]).unwrap();
        let of = |end| Target::up_to(&*beckmann, end, 4000).rmse(&*phong, Form::Relative);
        assert!((of(0.8) / of(1.57) - (1.57_f64 / 0.8).sqrt()).abs() < 1e-3);
        // The number of steps hardly matters.
        let nearest = |steps| {
            let target = Target::up_to(&*beckmann, 0.8, steps);
            let found = target.by_rmse(TrowbridgeReitz, Form::Relative, &Stage::unwatched());
            found.unwrap().to.values[0]
        };
        assert!((nearest(100) / nearest(STEPS) - 1.0).abs() < 2e-5);
    }
}
