//! The share of given terms whose largest error is least, and which of them matter least.
//!
//! Gauss–Newton steps of weighted least squares, damped as by Levenberg and Marquardt; the weights
//! follow the errors until the largest is small (Lawson's algorithm, as in
//! `microfacet_export::texture`).

use rayon::prelude::*;

use super::cholesky::Cholesky;
use super::share::{Rows, Samples, Terms, Whole};

/// A share that was fitted, the weights of the samples at which it is the best, and its largest
/// error at them.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub(super) terms: Terms,
    pub(super) coefficients: Vec<f64>,
    /// At the samples that were fitted.
    pub(super) error: f64,
    weights: Vec<f64>,
}

/// Never 0: such a weight could not grow again.
const LEAST_GROWTH: f64 = 2e-3;
const LEAST_WEIGHT: f64 = 1e-7;

/// The error of a share that is limited to 1, and whether the limit acts.
fn error(wanted: f64, share: f64) -> (f64, bool) {
    (wanted - share.min(1.0), share > 1.0)
}

/// The share of these terms, from a first guess of its own or from a former fit with one term
/// more, of which `from` holds the coefficients and weights.
pub(super) fn fit(terms: &Terms, samples: &Samples, from: Option<Start>, rounds: usize) -> Fit {
    let rows = Rows::new(terms, samples);
    let count = samples.wanted.len();
    let even = vec![1.0 / count as f64; count];
    let (mut x, mut weights) = match from {
        Some(start) => (start.coefficients, start.weights),
        None if rows.is_plain() => (vec![0.0; terms.len()], even),
        None => (first_guess(&rows, samples), even),
    };
    let mut best = Fit {
        terms: terms.clone(),
        coefficients: x.clone(),
        error: f64::INFINITY,
        weights: weights.clone(),
    };
    let mut damping = 1e-4;
    let mut shares = rows.shares(&x);
    for round in 0..rounds {
        let errors: Vec<(f64, bool)> = samples
            .wanted
            .iter()
            .zip(&shares)
            .map(|(wanted, [share, _])| error(*wanted, *share))
            .collect();
        if shares.iter().any(|[_, whole]| !(*whole > 0.0)) {
            break;
        }
        let largest = errors.iter().map(|error| error.0.abs()).fold(0.0, f64::max);
        if largest < best.error {
            (best.coefficients, best.error) = (x.clone(), largest);
            best.weights.clone_from(&weights);
        }
        if round > 0 {
            for (weight, (error, _)) in weights.iter_mut().zip(&errors) {
                *weight *= error.abs() / largest + LEAST_GROWTH;
            }
            let sum: f64 = weights.iter().sum();
            let least = LEAST_WEIGHT / count as f64;
            weights.iter_mut().for_each(|weight| *weight = (*weight / sum).max(least));
        }
        let cost = |shares: &[[f64; 2]]| -> f64 {
            let terms = weights.iter().zip(&samples.wanted).zip(shares);
            terms.map(|((w, wanted), [share, _])| w * error(*wanted, *share).0.powi(2)).sum()
        };
        let before = cost(&shares);
        let (matrix, right) =
            rows.normal_equations(&weights, |i| (!errors[i].1).then_some((shares[i], errors[i].0)));
        for _ in 0..7 {
            if let Some(step) = Cholesky::damped(&matrix, damping).map(|c| c.solve(&right)) {
                let next: Vec<f64> = x.iter().zip(step).map(|(x, step)| x + step).collect();
                let next_shares = rows.shares(&next);
                let sound = next_shares.iter().all(|[_, whole]| *whole > 0.0);
                if sound && cost(&next_shares) <= before * (1.0 + 1e-9) {
                    // Shares do not see the scale; numbers near 1 keep it from running away.
                    let largest = next.iter().map(|x| x.abs()).fold(0.0, f64::max);
                    let scale = if rows.is_plain() { 1.0 } else { largest };
                    x = next.into_iter().map(|x| x / scale).collect();
                    shares = next_shares.into_iter().map(|[s, w]| [s, w / scale]).collect();
                    damping = f64::max(damping / 5.0, 1e-11);
                    break;
                }
            }
            damping = f64::min(damping * 8.0, 1e3);
        }
    }
    best
}

/// Where a fit begins.
pub(super) struct Start {
    coefficients: Vec<f64>,
    weights: Vec<f64>,
}

impl Start {
    /// From known coefficients, every sample as important.
    pub(super) fn at(coefficients: Vec<f64>, samples: &Samples) -> Self {
        let count = samples.wanted.len();
        Self { coefficients, weights: vec![1.0 / count as f64; count] }
    }
}

impl Fit {
    /// The start without the terms at some places.
    fn without(&self, places: &[usize]) -> Start {
        let kept = self.coefficients.iter().enumerate().filter(|(i, _)| !places.contains(i));
        Start { coefficients: kept.map(|(_, x)| *x).collect(), weights: self.weights.clone() }
    }

    /// The same terms again, from here.
    pub(super) fn again(&self, samples: &Samples, rounds: usize) -> Self {
        let start =
            Start { coefficients: self.coefficients.clone(), weights: self.weights.clone() };
        fit(&self.terms, samples, Some(start), rounds)
    }

    /// Numbers that the form needs: one coefficient of a quotient is 1.
    pub(super) fn numbers(&self) -> usize {
        self.terms.len() - usize::from(self.terms.whole != Whole::One)
    }

    /// Its value in double precision, without the limit.
    pub(super) fn value(&self, place: [f64; 4]) -> f64 {
        let one = Samples { places: vec![place], wanted: vec![0.0] };
        Rows::new(&self.terms, &one).shares(&self.coefficients)[0][0]
    }

    /// By how much the weighted sum of squares grows, to first order, without each term.
    fn growth(&self, samples: &Samples) -> Vec<f64> {
        let rows = Rows::new(&self.terms, samples);
        let shares = rows.shares(&self.coefficients);
        let (matrix, _) = rows.normal_equations(&self.weights, |i| {
            (!error(samples.wanted[i], shares[i][0]).1).then_some((shares[i], 0.0))
        });
        let Some(factor) = Cholesky::damped(&matrix, 1e-10) else {
            return self.coefficients.iter().map(|x| x * x).collect();
        };
        let variances = factor.inverse_diagonal();
        self.coefficients.iter().zip(variances).map(|(x, variance)| x * x / variance).collect()
    }

    /// The best of this form without `drop` terms: of the terms that matter least, `tries` choices
    /// of neighbours in that order. `None` if no fit is left.
    pub(super) fn smaller(
        &self,
        samples: &Samples,
        drop: usize,
        tries: usize,
        rounds: usize,
    ) -> Option<Self> {
        let growth = self.growth(samples);
        let mut order: Vec<usize> = (0..growth.len()).collect();
        order.sort_by(|&a, &b| growth[a].total_cmp(&growth[b]));
        let choices: Vec<&[usize]> = order.windows(drop).take(tries).collect();
        let without = |places: &&[usize]| {
            let terms = self.terms.without(places);
            if terms.kept.is_empty() || terms.lost.is_empty() {
                return None;
            }
            let fits = [Some(self.without(places)), None].into_iter();
            let mut fits = fits.map(|start| fit(&terms, samples, start, rounds));
            fits.find(|fit| fit.error.is_finite())
        };
        let fits: Vec<Self> = choices.par_iter().filter_map(without).collect();
        fits.into_iter().min_by(|a, b| a.error.total_cmp(&b.error))
    }
}

/// Least squares of kept − wanted · whole over the whole of the step before (Sanathanan and Koerner
/// 1963), the mean of the quotient of both wholes held at 1.
fn first_guess(rows: &Rows, samples: &Samples) -> Vec<f64> {
    let (count, n) = (samples.wanted.len(), rows.width);
    let weights = vec![1.0 / count as f64; count];
    let mut wholes = vec![1.0; count];
    let mut x = vec![1.0; n];
    for _ in 0..12 {
        let (mut matrix, _) =
            rows.normal_equations(&weights, |i| Some(([samples.wanted[i], wholes[i]], 0.0)));
        let mut mean = vec![0.0; n];
        for ((row, whole), weight) in rows.iter().zip(&wholes).zip(&weights) {
            for (k, (mean, x)) in mean.iter_mut().zip(row).enumerate() {
                *mean += rows.of_whole(k) * weight * x / whole;
            }
        }
        for a in 0..n {
            for b in 0..=a {
                matrix[a * n + b] += 10.0 * mean[a] * mean[b];
            }
        }
        let right: Vec<f64> = mean.iter().map(|mean| 10.0 * mean).collect();
        let Some(factor) = Cholesky::damped(&matrix, 1e-9) else { break };
        x = factor.solve(&right);
        for (whole, [_, next]) in wholes.iter_mut().zip(rows.shares(&x)) {
            *whole = next.max(0.05 * *whole);
        }
    }
    x
}

#[cfg(test)]
impl Fit {
    /// With the coefficient of the largest magnitude times a factor.
    pub(super) fn with_one_off(mut self, factor: f64) -> Self {
        let largest = self.coefficients.iter_mut().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        *largest.expect("coefficients") *= factor;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(wanted: impl Fn(f64) -> f64) -> Samples {
        let x = (0..=400).map(|i| f64::from(i) / 400.0);
        let places = x.clone().map(|x| [x, 0.0, 0.0, 0.0]).collect();
        Samples { places, wanted: x.map(wanted).collect() }
    }

    fn powers(powers: std::ops::RangeInclusive<u8>) -> Vec<[u8; 4]> {
        powers.map(|power| [power, 0, 0, 0]).collect()
    }

    #[test]
    fn a_quotient_of_its_own_terms_is_found() {
        let samples = samples(|x| (0.2 * x + x * x) / (0.3 + 0.1 * x + 1.5 * x * x));
        let terms = Terms::share(powers(1..=2), powers(0..=2));
        let fit = fit(&terms, &samples, None, 100);
        assert!(fit.error < 1e-9 && fit.numbers() == 4, "{}", fit.error);
        // Without the one that is worth least, it is met no more.
        assert!(fit.smaller(&samples, 1, 5, 50).unwrap().error > 1e-6);
    }

    #[test]
    fn a_quotient_with_terms_of_its_own_above_and_below_is_found() {
        let samples = samples(|x| (0.2 + x) / (1.0 + 0.1 * x + 2.5 * x * x));
        let terms = Terms::quotient(powers(0..=1), powers(0..=2));
        let fit = fit(&terms, &samples, None, 100);
        assert!(fit.error < 1e-9 && fit.numbers() == 4, "{}", fit.error);
        let scaled: Vec<f64> = fit.coefficients.iter().map(|x| x / fit.coefficients[2]).collect();
        assert!(scaled.iter().zip([0.2, 1.0, 1.0, 0.1, 2.5]).all(|(x, y)| (x - y).abs() < 1e-6));
    }

    /// The best line for x² on [0, 1] errs by 1/8.
    #[test]
    fn a_polynomial_errs_as_little_as_it_can() {
        let terms = Terms::polynomial(powers(0..=1));
        let fit = fit(&terms, &samples(|x| x * x), None, 200);
        assert!((fit.error - 0.125).abs() < 1e-3 && fit.numbers() == 2, "{}", fit.error);
    }
}
