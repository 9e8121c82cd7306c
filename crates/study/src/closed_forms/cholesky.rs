//! Small dense systems of normal equations.

/// The Cholesky factor of a symmetric matrix whose columns are scaled to a diagonal of ones.
pub(super) struct Cholesky {
    n: usize,
    lower: Vec<f64>,
    scales: Vec<f64>,
}

impl Cholesky {
    /// Of a matrix by its lower triangle, row by row, with `damping` added to the scaled diagonal.
    /// `None` if it is not positive.
    pub(super) fn damped(matrix: &[f64], damping: f64) -> Option<Self> {
        let n = matrix.len().isqrt();
        let scales: Vec<f64> = (0..n).map(|i| matrix[i * n + i].sqrt().max(1e-150)).collect();
        let mut lower = vec![0.0; n * n];
        for a in 0..n {
            for b in 0..=a {
                let mut x = matrix[a * n + b] / (scales[a] * scales[b]);
                if a == b {
                    x += damping;
                }
                x -= (0..b).map(|k| lower[a * n + k] * lower[b * n + k]).sum::<f64>();
                if a > b {
                    lower[a * n + b] = x / lower[b * n + b];
                } else if x > 0.0 {
                    lower[a * n + a] = x.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(Self { n, lower, scales })
    }

    /// The solution x of matrix · x = right.
    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let n = self.n;
        let mut x: Vec<f64> = right.iter().zip(&self.scales).map(|(x, scale)| x / scale).collect();
        for a in 0..n {
            let sum: f64 = (0..a).map(|k| self.lower[a * n + k] * x[k]).sum();
            x[a] = (x[a] - sum) / self.lower[a * n + a];
        }
        for a in (0..n).rev() {
            let sum: f64 = (a + 1..n).map(|k| self.lower[k * n + a] * x[k]).sum();
            x[a] = (x[a] - sum) / self.lower[a * n + a];
        }
        x.iter().zip(&self.scales).map(|(x, scale)| x / scale).collect()
    }

    /// The diagonal of the inverse.
    pub(super) fn inverse_diagonal(&self) -> Vec<f64> {
        let unit = |i: usize| {
            let mut unit = vec![0.0; self.n];
            unit[i] = 1.0;
            self.solve(&unit)[i]
        };
        (0..self.n).map(unit).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_inverts_what_it_is_given() {
        // [[4, 2, -1], [2, 5, 0.5], [-1, 0.5, 3]] (1, 2, 3).
        let matrix = [4.0, 0.0, 0.0, 2.0, 5.0, 0.0, -1.0, 0.5, 3.0];
        let factor = Cholesky::damped(&matrix, 0.0).unwrap();
        for (x, want) in factor.solve(&[5.0, 13.5, 9.0]).iter().zip([1.0, 2.0, 3.0]) {
            assert!((x - want).abs() < 1e-14, "{x} for {want}");
        }
        // The determinant is 40, the minors of the diagonal are 14.75, 11 and 16.
        for (x, minor) in factor.inverse_diagonal().iter().zip([14.75, 11.0, 16.0]) {
            assert!((x - minor / 40.0).abs() < 1e-15, "{x}");
        }
        assert!(Cholesky::damped(&[1.0, 0.0, 2.0, 1.0], 0.0).is_none());
    }
}
