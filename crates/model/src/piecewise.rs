//! Polynomials through tabulated functions.

/// Interpolation at the N Chebyshev points of [−1, 1].
pub(crate) struct Chebyshev<const N: usize> {
    points: [f64; N],
    /// The power coefficients, lowest first, as a matrix times the values at the points.
    powers: [[f64; N]; N],
}

impl<const N: usize> Chebyshev<N> {
    pub(crate) fn new() -> Self {
        let angle = |i: usize| core::f64::consts::PI * (i as f64 + 0.5) / N as f64;
        // Σ aⱼ Tⱼ with aⱼ = 2/N Σ f cos(j angle), then powers by T_{j+1} = 2t T_j − T_{j−1}.
        let (mut previous, mut current) = ([0.0; N], [0.0; N]);
        previous[0] = 1.0;
        current[1] = 1.0;
        let mut powers = [[0.0; N]; N];
        for j in 0..N {
            for i in 0..N {
                let a = if j == 0 { 1.0 } else { 2.0 * libm::cos(j as f64 * angle(i)) } / N as f64;
                for (row, power) in powers.iter_mut().zip(previous) {
                    row[i] += a * power;
                }
            }
            let twice = |i: usize| if i == 0 { 0.0 } else { 2.0 * current[i - 1] };
            let next = core::array::from_fn(|i| twice(i) - previous[i]);
            (previous, current) = (current, next);
        }
        Self { points: core::array::from_fn(|i| libm::cos(angle(i))), powers }
    }

    /// Power coefficients of the polynomials through M functions.
    pub(crate) fn through<const M: usize>(&self, f: impl Fn(f64) -> [f64; M]) -> [[f64; N]; M] {
        let values = self.points.map(f);
        core::array::from_fn(|m| {
            self.powers.map(|row| row.iter().zip(&values).map(|(a, value)| a * value[m]).sum())
        })
    }
}

/// The polynomial with these power coefficients at t: even and odd powers are summed separately,
/// which is faster than one chain.
#[inline(always)]
pub(crate) fn polynomial<const N: usize>(coefficients: &[f64; N], t: f64) -> f64 {
    let square = t * t;
    let [mut even, mut odd] = [0.0; 2];
    for pair in (0..N.div_ceil(2)).rev() {
        let i = 2 * pair;
        even = even * square + coefficients[i];
        odd = odd * square + if i + 1 < N { coefficients[i + 1] } else { 0.0 };
    }
    even + t * odd
}
