//! A measured distribution: D at given angles, linear between them.

use core::f64::consts::{FRAC_PI_2, PI};

use super::{Isotropic, bisect};

/// Neighbouring angles leave a gap if they are further apart than this (radians) and than four
/// times the median step.
const GAP: f64 = 0.1;

/// Why a measured distribution was refused. Rows count from 0.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
pub enum TabulatedError {
    /// Fewer than three rows; how many.
    #[error("a distribution needs at least 3 rows, not {0}")]
    TooFew(usize),
    /// An angle outside [0, π/2], or not above that of the row before; the row and the angle in
    /// radians.
    #[error("row {0}: angle {1} must be in radians, within [0, pi/2], and above the row before")]
    Angle(usize, f64),
    /// A negative, infinite or NaN D; the row and the value.
    #[error("row {0}: D = {1} must be finite and not negative")]
    Value(usize, f64),
    /// Two neighbouring angles in radians with a gap between them.
    #[error(
        "nothing between the angles {0} and {1} (radians): measure there, or interpolate before \
         and say so"
    )]
    Gap(f64, f64),
    /// D(0), or all of D, is zero: there is nothing to normalise.
    #[error("D is zero at its smallest angle: nothing to normalise by")]
    Zero,
}

microfacet_core::debug_in_words!(TabulatedError);

/// A distribution given by its values D(θᵢ) up to a factor, linear between them, with its
/// normalisation in closed form.
///
/// D is taken as constant up to the first angle and as zero beyond the last.
/// [`assumed`](Self::assumed) gives these two angles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tabulated {
    theta: Vec<f64>,
    /// Normalised.
    d: Vec<f64>,
    /// Share of the projected area whose normals are within each angle.
    below: Vec<f64>,
    given: (f64, f64),
}

impl Tabulated {
    /// The distribution through rows of θ (radians, ascending) and D in any unit.
    ///
    /// # Errors
    /// [`TabulatedError`] with the row and value.
    pub fn new(rows: &[(f64, f64)]) -> Result<Self, TabulatedError> {
        if rows.len() < 3 {
            return Err(TabulatedError::TooFew(rows.len()));
        }
        let mut last = -1.0;
        for (i, &(theta, d)) in rows.iter().enumerate() {
            if !(theta > last && (0.0..=FRAC_PI_2 * (1.0 + 1e-12)).contains(&theta)) {
                return Err(TabulatedError::Angle(i, theta));
            }
            if !(0.0..f64::INFINITY).contains(&d) {
                return Err(TabulatedError::Value(i, d));
            }
            last = theta;
        }
        let mut steps: Vec<f64> = rows.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        steps.sort_by(f64::total_cmp);
        let typical = steps[steps.len() / 2];
        if let Some(pair) = rows.windows(2).find(|p| p[1].0 - p[0].0 > GAP.max(4.0 * typical)) {
            return Err(TabulatedError::Gap(pair[0].0, pair[1].0));
        }
        let given = (rows[0].0, last);
        let mut rows = rows.to_vec();
        if given.0 > 0.0 {
            rows.insert(0, (0.0, rows[0].1));
        }
        if !(rows[0].1 > 0.0) {
            return Err(TabulatedError::Zero);
        }
        let (theta, mut d): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
        // The scale is free; sums of the largest numbers would overflow, and the smallest have no
        // digits.
        let largest = d.iter().copied().fold(0.0, f64::max);
        if !(1e-200..1e200).contains(&largest) {
            d.iter_mut().for_each(|d| *d /= largest);
        }
        let mut this = Self { below: vec![0.0], theta, d, given };
        for i in 1..this.theta.len() {
            let share = this.below[i - 1] + this.segment(i - 1, this.theta[i]);
            this.below.push(share);
        }
        let whole = this.below[this.below.len() - 1];
        this.d.iter_mut().chain(&mut this.below).for_each(|x| *x /= whole);
        Ok(this)
    }

    /// First and last angle that were given, in radians: D is assumed constant up to the first and
    /// zero beyond the last.
    pub fn assumed(&self) -> (f64, f64) {
        self.given
    }

    /// The rows in use: angle in radians and normalised D.
    pub fn rows(&self) -> impl Iterator<Item = (f64, f64)> {
        self.theta.iter().copied().zip(self.d.iter().copied())
    }

    /// ∫ π D sin 2t dt from θᵢ to `to` on one segment, in closed form.
    fn segment(&self, i: usize, to: f64) -> f64 {
        let (a, d) = (self.theta[i], self.d[i]);
        let rate = (self.d[i + 1] - d) / (self.theta[i + 1] - a);
        // ∫ (d + rate (t − a)) sin 2t = −(d + rate (t − a)) cos 2t/2 + rate sin 2t/4; with
        // differences of cosines as products.
        let (h, m) = (to - a, to + a);
        let constant = d * libm::sin(h) * libm::sin(m);
        let ramp = 0.5 * rate * (libm::sin(h) * libm::cos(m) - h * libm::cos(2.0 * to));
        PI * (constant + ramp)
    }

    fn at(&self, theta: f64) -> usize {
        self.theta.partition_point(|&t| t <= theta).clamp(1, self.theta.len() - 1) - 1
    }
}

impl Isotropic for Tabulated {
    fn peak(&self) -> f64 {
        self.d[0]
    }

    fn relative_d(&self, theta: f64) -> f64 {
        if theta > self.support() {
            return 0.0;
        }
        let i = self.at(theta);
        let w = (theta - self.theta[i]) / (self.theta[i + 1] - self.theta[i]);
        (self.d[i] + w * (self.d[i + 1] - self.d[i])) / self.d[0]
    }

    fn support(&self) -> f64 {
        self.theta[self.theta.len() - 1]
    }

    fn corners(&self) -> Vec<f64> {
        self.theta.clone()
    }

    fn cdf(&self, theta: f64) -> f64 {
        let theta = theta.clamp(0.0, self.support());
        let i = self.at(theta);
        (self.below[i] + self.segment(i, theta)).clamp(0.0, 1.0)
    }

    fn sample_theta(&self, u: f64) -> f64 {
        let i = self.below.partition_point(|&share| share <= u).clamp(1, self.below.len() - 1) - 1;
        bisect(self.theta[i], self.theta[i + 1], |theta| self.below[i] + self.segment(i, theta) - u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classic::{Member, projected};

    #[test]
    fn the_scale_of_what_was_measured_is_free() {
        let of = |scale: f64| {
            let rows = [(0.0, 1.0), (0.2, 1.0), (0.5, 0.1), (1.0, 0.01)];
            Tabulated::new(&rows.map(|(theta, d)| (theta, scale * d))).unwrap()
        };
        for scale in [1e308, 1e-300, 1e-305] {
            for theta in [0.0, 0.3, 0.9] {
                assert!((of(scale).d(theta) / of(1.0).d(theta) - 1.0).abs() < 1e-12, "{scale}");
            }
        }
    }

    #[test]
    fn follows_what_it_was_sampled_from() {
        let beckmann = Member::beckmann(0.3).unwrap();
        let rows: Vec<_> = (0..=900)
            .map(|i| f64::from(i) * FRAC_PI_2 / 900.0)
            .map(|t| (t, 7.0 * beckmann.d(t)))
            .collect();
        let table = Tabulated::new(&rows).unwrap();
        for u in [0.01, 0.3, 0.7, 0.99] {
            let theta = table.sample_theta(u);
            assert!((beckmann.cdf(theta) - u).abs() < 2e-5);
            assert!((table.cdf(theta) - u).abs() < 1e-14);
        }
        assert!((table.peak() / beckmann.peak() - 1.0).abs() < 1e-4);
        // The closed form of segments against quadrature that ignores them.
        assert!((projected(|t| table.d(t), 0.01, 0.4) - table.cdf(0.4)).abs() < 1e-5);
    }

    #[test]
    fn refuses_what_is_no_distribution() {
        let with = |i: usize, row: (f64, f64)| {
            let mut rows: Vec<_> = (0..40).map(|i| (f64::from(i) * 0.03, 1.0)).collect();
            rows[i] = row;
            Tabulated::new(&rows)
        };
        assert!(with(3, (0.09, 2.0)).is_ok());
        assert_eq!(with(3, (0.09, -1.0)), Err(TabulatedError::Value(3, -1.0)));
        assert!(matches!(with(3, (0.09, f64::NAN)), Err(TabulatedError::Value(3, _))));
        assert_eq!(with(3, (0.01, 1.0)), Err(TabulatedError::Angle(3, 0.01)));
        assert_eq!(with(39, (90.0, 1.0)), Err(TabulatedError::Angle(39, 90.0)));
        assert!(matches!(with(39, (1.5, 1.0)), Err(TabulatedError::Gap(..))));
        assert_eq!(with(0, (0.0, 0.0)), Err(TabulatedError::Zero));
        assert_eq!(Tabulated::new(&[(0.0, 1.0)]), Err(TabulatedError::TooFew(1)));
        assert_eq!(with(0, (0.02, 1.0)).unwrap().assumed().0, 0.02);
    }
}
