//! Polynomials through tabulated functions.

/// Power coefficients of the polynomial of degree N − 1 through each of M functions at the
/// Chebyshev points of [−1, 1].
pub(crate) fn interpolate<const N: usize, const M: usize>(
    f: impl Fn(f64) -> [f64; M],
) -> [[f64; N]; M] {
    let angle = |i: usize| core::f64::consts::PI * (i as f64 + 0.5) / N as f64;
    let values: [[f64; M]; N] = core::array::from_fn(|i| f(libm::cos(angle(i))));
    // Σ aⱼ Tⱼ with aⱼ = 2/N Σ f cos(j angle), then powers by T_{j+1} = 2t T_j − T_{j−1}.
    let (mut previous, mut current) = ([0.0; N], [0.0; N]);
    previous[0] = 1.0;
    current[1] = 1.0;
    let mut powers = [[0.0; N]; M];
    for j in 0..N {
        let cosines: [f64; N] = core::array::from_fn(|i| libm::cos(j as f64 * angle(i)));
        for (m, powers) in powers.iter_mut().enumerate() {
            let sum: f64 = values.iter().zip(cosines).map(|(v, cos)| v[m] * cos).sum();
            let a = if j == 0 { sum / N as f64 } else { 2.0 * sum / N as f64 };
            for (power, p) in powers.iter_mut().zip(previous) {
                *power += a * p;
            }
        }
        let next =
            core::array::from_fn(|i| if i == 0 { 0.0 } else { 2.0 * current[i - 1] } - previous[i]);
        (previous, current) = (current, next);
    }
    powers
}

/// The polynomial with these power coefficients at t.
#[inline(always)]
pub(crate) fn horner<const N: usize>(coefficients: &[f64; N], t: f64) -> f64 {
    let mut sum = coefficients[N - 1];
    for &c in coefficients[..N - 1].iter().rev() {
        sum = sum * t + c;
    }
    sum
}
