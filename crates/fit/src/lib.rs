//! Fits and conversions: a distribution for another one, or for a measurement.
//!
//! [`fit`] finds the Student-t, Beckmann, GGX, pair of GGX and ABC nearest to a measured
//! distribution of normals, and [`merl`] the first three nearest to a reflectance, in the format of
//! the MERL database; it compares their errors, and writes a recipe of the fits.
//!
//! [`convert`] replaces one distribution by another: by its half angle, by the least error of D, by
//! the least distance of slopes, or by a published formula, each with its errors. It
//! also recomputes Sawicki's table 2.
//!
//! Both search by the minimiser of `argmin`, in coordinates in which every parameter has about the
//! same effect on D, and report parameters at an end of their range.

pub mod convert;
pub mod merl;
mod minimise;

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::progress::Meter;
use microfacet_model::classic::Tabulated;

use crate::convert::{ConvertError, Form, Replacement, Target};

/// The best Student-t, and for comparison the best of its special cases Beckmann and GGX, and of
/// two other distributions whose tail is free.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// σ and γ fitted together.
    pub student_t: Replacement,
    /// γ = ∞.
    pub beckmann: Replacement,
    /// γ = 2.
    pub ggx: Replacement,
    /// The normals of two GGX: three parameters.
    pub haze: Replacement,
    /// The distribution of Löw et al. 2012, of as many parameters as a Student-t.
    pub abc: Replacement,
}

impl Fit {
    /// All fits, in the order in which they are printed.
    pub fn all(&self) -> [&Replacement; 5] {
        [&self.student_t, &self.beckmann, &self.ggx, &self.haze, &self.abc]
    }
}

/// Fits by least squares over the measured angles, and counts the work in a meter.
///
/// # Errors
/// [`ConvertError::Minimiser`].
pub fn fit(measured: &Tabulated, form: Form, meter: &Meter) -> Result<Fit, ConvertError> {
    use DistributionKind::{Abc, Beckmann, Haze, StudentT, TrowbridgeReitz};
    let target = Target::measured(measured);
    let kinds = [StudentT, Beckmann, TrowbridgeReitz, Haze, Abc];
    meter.expect(kinds.map(|to| target.seconds(to)).iter().sum());
    let nearest = |to| target.by_rmse(to, form, &meter.stage(target.seconds(to)));
    Ok(Fit {
        student_t: nearest(StudentT)?,
        beckmann: nearest(Beckmann)?,
        ggx: nearest(TrowbridgeReitz)?,
        haze: nearest(Haze)?,
        abc: nearest(Abc)?,
    })
}

#[cfg(test)]
mod tests {
    use microfacet_model::classic::{Isotropic, Member};

    use super::*;
    use microfacet_baker::distribution::Named;
    use microfacet_baker::input::angles::Angles;
    use microfacet_baker::input::normals::read_csv;

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
            // Another kind of tail is further off, and two GGX no further than one.
            assert!(fit.student_t.rmse[0] < fit.abc.rmse[0], "{fit:?}");
            assert!(fit.haze.rmse[0] <= fit.ggx.rmse[0] + 1e-6, "{fit:?}");
        }
    }

    #[test]
    fn a_measurement_of_two_ggx_is_judged_to_be_one() {
        let truth: Named = "haze:0.08,0.35,0.4".parse().unwrap();
        let truth = truth.build().unwrap();
        let rows = (0..=400).map(|i| f64::from(i) * 0.225);
        let rows: String = rows.map(|t| format!("{t},{}\n", truth.d(t.to_radians()))).collect();
        let text = format!("theta,D\n{rows}");
        let table = read_csv(text.as_bytes(), Angles::Degrees).unwrap();
        let fit = fit(&table, Form::Relative, &Meter::default()).unwrap();
        let others = [&fit.student_t, &fit.ggx, &fit.beckmann, &fit.abc];
        let best = others.iter().map(|found| found.rmse[0]).fold(f64::INFINITY, f64::min);
        assert!(fit.haze.rmse[0] < 0.1 * best, "{fit:?}");
        assert!((fit.haze.to.values[0] / 0.08 - 1.0).abs() < 1e-2, "{}", fit.haze.to);
    }
}
