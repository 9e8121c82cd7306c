//! Published formulas for replacing one distribution by another.
//!
//! Sawicki's equations 12, 14 and 15 are lines through slightly curved columns of table 2: single
//! rows would give 2.35 to 2.75 for the 2.5 of equation 12, 0.55 to 0.583 for the 0.5591 of 13,
//! 0.46 to 0.417 for the 0.5 of 14 and 1.204 to 1.174 for the 1.174 of 15, each from rough to
//! smooth (`cargo run --release -p microfacet-study -- sawicki`, which also has the largest error
//! of each formula against the table: 2 % in N by equation 12, else 1.4 %).

use std::f64::consts::{FRAC_PI_2, LN_2, SQRT_2};

use microfacet_baker::distribution::DistributionKind::{
    Beckmann, BlinnPhong, Gauss, Sawicki, Schlick, TrowbridgeReitz,
};
use microfacet_baker::distribution::{DistributionKind, Named};

use super::{ConvertError, Replacement, Target, table};

/// A published formula between two kinds of distributions of one parameter.
#[derive(Clone, Copy, Debug)]
pub struct Formula {
    /// The kind of distribution whose parameter the formula takes.
    pub from: DistributionKind,
    /// The kind of distribution whose parameter the formula gives.
    pub to: DistributionKind,
    /// Where it is printed.
    pub source: &'static str,
    value: fn(f64) -> f64,
}

const WALTER: &str = "Walter et al. 2007, section 5.2";
const WARD: &str = "Ward 1996 (Sawicki 2021, eq. 11)";
const EQ_12: &str = "Sawicki 2021, eq. 12";
const EQ_13: &str = "Sawicki 2021, eq. 13";
const EQ_14: &str = "Sawicki 2021, eq. 14";
const EQ_15: &str = "Sawicki 2021, eq. 15";
const EQ_14_15: &str = "Sawicki 2021, eq. 14 and 15";
const EQ_12_15: &str = "Sawicki 2021, eq. 12 and 15";
const TABLES: &str = "Sawicki 2021, tables 3 and 4";

/// N of a Beckmann or a Gauss of width m, N = 2/m² − `less`.
fn n_of(m: f64, less: f64) -> f64 {
    2.0 / (m * m) - less
}

fn m_of(n: f64, less: f64) -> f64 {
    (2.0 / (n + less)).sqrt()
}

fn sawicki_of_n(n: f64) -> f64 {
    1.174 * n + 0.3
}

fn n_of_sawicki(n: f64) -> f64 {
    (n - 0.3) / 1.174
}

fn c_of_n(n: f64) -> f64 {
    1.697 / (n + 4.5).sqrt()
}

fn n_of_c(c: f64) -> f64 {
    1.696 * 1.696 / (c * c) - 4.5
}

type Row = (DistributionKind, DistributionKind, &'static str, fn(f64) -> f64);

/// All published formulas, by source.
///
/// Walter et al. 2007, *Microfacet Models for Refraction through Rough Surfaces*,
/// doi:10.2312/EGWR/EGSR07/195-206; Sawicki 2021, doi:10.5220/0010252702090220.
const ALL: [Row; 26] = [
    (Beckmann, BlinnPhong, WALTER, |m| n_of(m, 2.0)),
    (BlinnPhong, Beckmann, WALTER, |n| m_of(n, 2.0)),
    (Beckmann, BlinnPhong, WARD, |m| n_of(m, 0.0)),
    (BlinnPhong, Beckmann, WARD, |n| m_of(n, 0.0)),
    (Beckmann, BlinnPhong, EQ_12, |m| n_of(m, 2.5)),
    (BlinnPhong, Beckmann, EQ_12, |n| m_of(n, 2.5)),
    (Beckmann, Gauss, EQ_13, |m| 0.5591 * m.powi(3) + m),
    (Gauss, Beckmann, EQ_13, |m| m - 0.4134 * m.powi(3)),
    (Gauss, BlinnPhong, EQ_14, |m| n_of(m, 0.5)),
    (BlinnPhong, Gauss, EQ_14, |n| m_of(n, 0.5)),
    (BlinnPhong, Sawicki, EQ_15, sawicki_of_n),
    (Sawicki, BlinnPhong, EQ_15, n_of_sawicki),
    // The following four go through Blinn–Phong.
    (Gauss, Sawicki, EQ_14_15, |m| sawicki_of_n(n_of(m, 0.5))),
    (Sawicki, Gauss, EQ_14_15, |n| m_of(n_of_sawicki(n), 0.5)),
    (Beckmann, Sawicki, EQ_12_15, |m| sawicki_of_n(n_of(m, 2.5))),
    (Sawicki, Beckmann, EQ_12_15, |n| m_of(n_of_sawicki(n), 2.5)),
    (TrowbridgeReitz, Gauss, TABLES, |c| 0.8222 * c + 0.82 * c.powi(3)),
    (TrowbridgeReitz, Beckmann, TABLES, |c| 0.8388 * c + 0.7 * c.powi(4)),
    (TrowbridgeReitz, BlinnPhong, TABLES, n_of_c),
    (TrowbridgeReitz, Sawicki, TABLES, |c| sawicki_of_n(n_of_c(c))),
    (Gauss, TrowbridgeReitz, TABLES, |m| 1.186 * m - 0.835 * m.powi(3)),
    (Beckmann, TrowbridgeReitz, TABLES, |m| 1.2 * m - 0.56 * m.powi(3)),
    (BlinnPhong, TrowbridgeReitz, TABLES, c_of_n),
    (Sawicki, TrowbridgeReitz, TABLES, |n| c_of_n(n_of_sawicki(n))),
    // Schlick approximates Beckmann at the same m: "no conversion is needed".
    (Beckmann, Schlick, "Sawicki 2021: the same m", |m| m),
    (Schlick, Beckmann, "Sawicki 2021: the same m", |m| m),
];

impl Formula {
    /// The parameter of `to` for that of `from`; it may be out of range, or NaN.
    pub fn value(&self, x: f64) -> f64 {
        (self.value)(x)
    }

    /// The range of the parameter of `from` that the formula was fitted over, if that is known and
    /// x is outside of it.
    pub fn beyond(&self, x: f64) -> Option<[f64; 2]> {
        let fitted = ![WALTER, WARD].contains(&self.source);
        table::printed_range(self.from)
            .filter(|[low, high]| fitted && self.to != Schlick && !(*low..=*high).contains(&x))
    }
}

/// The parameter of the distribution of kind `kind` and half angle `h`, radians: the angle at which
/// D is half of D(0).
///
/// Sawicki's equations of 2021 (<https://doi.org/10.5220/0010252702090220>), for five kinds:
///
/// | eq. | kind | parameter |
/// | --- | --- | --- |
/// | 3 | Blinn–Phong | N = −ln 2/ln cos h |
/// | 4 | Gauss | m = h/√(ln 2) |
/// | 5 | Trowbridge–Reitz | c = √((cos² h − 1)/(cos² h − √2)) |
/// | 9 | Beckmann | m = tan h/√(ln 2 − 4 ln cos h) |
/// | 10 | Sawicki | N = (cos h + 3 − 4 ∜(2 cos h))/(cos h − 1) |
///
/// They are computed from 1 − cos h = 2 sin² h/2, which keeps its digits as h → 0: the half angle
/// of the result is `h` to 1e-12. `None` for other kinds, unless 0 < h < π/2, and where the
/// parameter is out of the kind's range, as Sawicki's is above h = 1.3628.
pub fn half_angle_parameter(kind: DistributionKind, h: f64) -> Option<f64> {
    let (sin, cos) = h.sin_cos();
    let rest = 2.0 * (0.5 * h).sin().powi(2);
    let ln_cos = (-rest).ln_1p();
    let x = match kind {
        BlinnPhong => -LN_2 / ln_cos,
        Gauss => h / LN_2.sqrt(),
        TrowbridgeReitz => sin / (SQRT_2 - cos * cos).sqrt(),
        Beckmann => h.tan() / (LN_2 - 4.0 * ln_cos).sqrt(),
        Sawicki => (4.0 * ((2.0 * cos).powf(0.25) - 1.0) + rest) / rest,
        _ => return None,
    };
    (h > 0.0 && h < FRAC_PI_2 && kind.build(&[x]).is_ok()).then_some(x)
}

/// All published formulas.
pub fn formulas() -> impl Iterator<Item = Formula> {
    ALL.into_iter().map(|(from, to, source, value)| Formula { from, to, source, value })
}

/// The results of all published formulas from one distribution to another, in the order of
/// [`formulas`]; an error for each result out of range.
///
/// # Errors
/// [`ConvertError::NoFormula`] if there is none; [`ConvertError::Distribution`] if `from` is none.
#[expect(clippy::type_complexity, reason = "a result for each formula")]
pub fn by_formula(
    from: &Named,
    to: DistributionKind,
) -> Result<Vec<(Formula, Result<Replacement, ConvertError>)>, ConvertError> {
    let built = from.build()?;
    let of_pair: Vec<_> = formulas().filter(|f| f.from == from.kind && f.to == to).collect();
    if of_pair.is_empty() {
        return Err(ConvertError::NoFormula(from.kind, to));
    }
    let target = Target::new(&*built);
    let replace = |formula: Formula| {
        let found = target
            .judged(Named { kind: to, values: vec![formula.value(from.values[0])] })
            .map_err(|e| match e {
                ConvertError::Distribution(e) => ConvertError::OfFormula(formula.source, e),
                other => other,
            });
        (formula, found)
    };
    Ok(of_pair.into_iter().map(replace).collect())
}

#[cfg(test)]
mod tests {
    use microfacet_model::classic::Isotropic;

    use super::*;

    fn value(from: DistributionKind, to: DistributionKind, source: &str, x: f64) -> f64 {
        let found = formulas().find(|f| f.from == from && f.to == to && f.source == source);
        found.unwrap().value(x)
    }

    #[test]
    fn every_pair_of_five_kinds_has_one_and_each_has_its_way_back() {
        let kinds = [Beckmann, BlinnPhong, Gauss, TrowbridgeReitz, Sawicki];
        for (a, b) in kinds.into_iter().flat_map(|a| kinds.map(|b| (a, b))) {
            assert_eq!(formulas().any(|f| f.from == a && f.to == b), a != b, "{a:?} to {b:?}");
        }
        for there in formulas() {
            let (low, x, high) = match there.from {
                BlinnPhong | Sawicki => (8.0, 60.0, 1e5),
                _ => (0.005, 0.15, 0.45),
            };
            for x in [low, x, high] {
                let back = value(there.to, there.from, there.source, there.value(x));
                // Exact inverses but for the curves that were fitted both ways.
                let curved = [EQ_13, TABLES].contains(&there.source);
                let off = (back / x - 1.0).abs();
                assert!(off < if curved { 0.05 } else { 1e-12 }, "{there:?}: {x} is {back}");
            }
        }
    }

    #[test]
    fn they_give_what_is_printed_in_the_captions_of_the_figures() {
        for (m, n, gauss, c, sawicki) in
            [(0.4, 10.0, 0.4364, 0.4456, 12.04), (0.04464, 1000.0, 0.04471, 0.05354, 1174.3)]
        {
            let near =
                |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
            near(value(BlinnPhong, Beckmann, EQ_12, n), m);
            near(value(BlinnPhong, Gauss, EQ_14, n), gauss);
            near(value(BlinnPhong, TrowbridgeReitz, TABLES, n), c);
            near(value(BlinnPhong, Sawicki, EQ_15, n), sawicki);
        }
    }

    /// Equations 3 to 10, against the half angles of the distributions.
    #[test]
    fn half_angles_are_those_of_equations_3_to_10() {
        for h in [1e-7, 1e-3, 0.02, 0.3, 0.7, 1.3] {
            let cos = f64::cos(h);
            let named = [BlinnPhong, Gauss, TrowbridgeReitz, Beckmann, Sawicki]
                .map(|kind| (kind, half_angle_parameter(kind, h).unwrap()));
            let d: Vec<Box<dyn Isotropic>> =
                named.iter().map(|(kind, x)| kind.build(&[*x]).unwrap()).collect();
            for (d, (kind, x)) in d.iter().zip(named) {
                let half = d.half_angle().unwrap();
                assert!((half / h - 1.0).abs() < 1e-12, "{kind:?} {x}: {half} for {h}");
                for (to, want) in named {
                    let found = Target::new(&**d).by_half_angle(to, None).unwrap();
                    let got = found.to.values[0];
                    assert!((got / want - 1.0).abs() < 1e-8, "{kind:?} to {to:?}: {got} {want}");
                }
            }
            // 6 to 8, solved for the cosine.
            let [n, m, c] = [named[0].1, named[1].1, named[2].1];
            for back in [
                (-LN_2 / n).exp(),
                (m * LN_2.sqrt()).cos(),
                ((SQRT_2 * c * c - 1.0) / (c * c - 1.0)).sqrt(),
            ] {
                assert!((back - cos).abs() < 1e-12, "{h}: {back}");
            }
        }
    }

    #[test]
    fn half_angles_that_no_parameter_gives_have_none() {
        for kind in [BlinnPhong, Gauss, TrowbridgeReitz, Beckmann, Sawicki] {
            for h in [-0.3, 0.0, FRAC_PI_2, 2.0, f64::INFINITY, f64::NAN] {
                assert_eq!(half_angle_parameter(kind, h), None, "{kind:?} at {h}");
            }
        }
        assert!(half_angle_parameter(Sawicki, 1.3628).is_some());
        assert_eq!(half_angle_parameter(Sawicki, 1.3629), None);
        assert_eq!(half_angle_parameter(Schlick, 0.3), None);
        // Narrow lobes keep their digits: N is (2 ln 2)/h² there.
        let n = half_angle_parameter(BlinnPhong, 1e-9).unwrap();
        assert!((n * 1e-18 / (2.0 * LN_2) - 1.0).abs() < 1e-12, "{n}");
    }

    #[test]
    fn results_out_of_range_are_named() {
        let from = |text: &str| text.parse::<Named>().unwrap();
        let found = by_formula(&from("beckmann:1.2"), BlinnPhong).unwrap();
        let text = |r: &Result<Replacement, _>| match r {
            Ok(found) => found.to.to_string(),
            Err(e) => ConvertError::to_string(e),
        };
        let texts: Vec<String> = found.iter().map(|(_, r)| text(r)).collect();
        assert!(texts[0].contains("Walter") && texts[0].contains("-0.61"), "{texts:?}");
        assert_eq!(texts[1], "blinn-phong:1.388889");
        assert!(texts[2].contains("eq. 12") && texts[2].contains("rmse"), "{texts:?}");
        // A curve that turns, a root of a negative number, and m > 1 for Schlick.
        for (text, to) in
            [("gauss:2", Beckmann), ("sawicki:0", BlinnPhong), ("beckmann:1.1", Schlick)]
        {
            let found = by_formula(&from(text), to).unwrap();
            assert!(matches!(found[0].1, Err(ConvertError::OfFormula(..))), "{text}");
        }
        assert!(matches!(
            by_formula(&from("gauss:0.1"), Schlick),
            Err(ConvertError::NoFormula(..))
        ));
        assert!(matches!(
            by_formula(&from("beckmann:-1"), BlinnPhong),
            Err(ConvertError::Distribution(_))
        ));
    }

    #[test]
    fn beyond_the_fit_is_told() {
        let of = |source: &str| formulas().find(|f| f.source == source).unwrap();
        assert_eq!(of(EQ_12).beyond(0.2), None);
        assert_eq!(of(EQ_12).beyond(0.6), Some([0.004473, 0.4473]));
        assert_eq!(of(WALTER).beyond(0.6), None);
    }
}
