//! Places between two ends, and the largest of errors.

use std::f64::consts::PI;

/// n numbers in [0, 1], denser at both ends, which they reach.
pub(super) fn crowded(n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |i| 0.5 * (1.0 - libm::cos(PI * i as f64 / (n - 1) as f64)))
}

/// The largest absolute error, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Largest {
    pub(super) error: f64,
    pub(super) at: [f64; 3],
}

impl Largest {
    /// Takes an error at a place into account; what is no number counts as infinite.
    pub(super) fn take(&mut self, error: f64, at: [f64; 3]) {
        let error = if error.is_nan() { f64::INFINITY } else { error.abs() };
        if error > self.error {
            *self = Self { error, at };
        }
    }
}
