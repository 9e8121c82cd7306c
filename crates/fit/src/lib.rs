//! Fits and conversions: a distribution for another one, or for a measurement.
//!
//! [`fit`] finds the Student-t, Beckmann and GGX nearest to a measured distribution of normals, and
//! [`merl`] those nearest to a reflectance, in the format of the MERL database; it compares the
//! errors of the three, and writes a recipe of the fits.
//!
//! [`convert`] replaces one distribution by another: by its half angle, by the least error of D, or
//! by a published formula, each with its error. It also recomputes Sawicki's table 2.
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

/// The best Student-t, and for comparison the best of its special cases Beckmann and GGX.
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
    use microfacet_model::classic::{Isotropic, Member};

    use super::*;
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
        }
    }
}
