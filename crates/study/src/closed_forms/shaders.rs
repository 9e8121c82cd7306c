//! Quotients of polynomials that shaders have for albedos of GGX: their errors as printed, and the
//! same quotients fitted to the model, for any γ.

use microfacet_core::Masking;
use microfacet_core::schlick::schlick_weight;
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use rayon::prelude::*;

use super::fit::{Start, fit};
use super::measure::{Largest, crowded};
use super::share::{Samples, Term, Terms};
use crate::{Outcome, print_head};

/// How often the weights of a fit follow its errors.
const ROUNDS: usize = 400;

/// Numbers of σ and of μ at which forms are fitted, and at which they are checked. Fewer leave a
/// quotient room for a pole between them.
const FITTED: [usize; 2] = [32, 40];
const CHECKED: [usize; 2] = [45, 61];

/// Cosines from here: below, the errors of all forms are several times as large.
const LEAST_COSINE: f64 = 0.02;

/// The part of E of a reflectance F0 + (1 − F0)(1 − v·m)⁵ that a form stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// E, of F0 = 1.
    E,
    /// The factor on F0, E − bias.
    Scale,
    /// E of F0 = 0.
    Bias,
}

/// Coefficients of a polynomial, and the powers of μ = cos θ and the roughness that they are of.
type Polynomial = &'static [([u8; 2], f64)];

/// A quotient as it is printed.
struct Printed {
    name: &'static str,
    quantity: Quantity,
    /// What the roughness is: σ to this power.
    power: f64,
    over: Polynomial,
    under: Polynomial,
}

/// Sforza & Pellacini 2022 (<https://doi.org/10.2312/stag.20221258>), the conductors of the file
/// `resources/coefficients/conductors.csv` of their `energy-preservation`; and equation 4 of chapter
/// 32 of *Ray Tracing Gems* 2019 (<https://doi.org/10.1007/978-1-4842-4427-2_32>), which engines and
/// denoisers have as `EnvironmentTerm_Rtg` and `env_brdf_approx2`.
const PRINTED: [Printed; 3] = [
    Printed {
        name: "Sforza & Pellacini",
        quantity: Quantity::E,
        power: 0.5,
        over: &[
            ([0, 0], 1.0247217),
            ([0, 1], -10.984229),
            ([1, 0], 10.918318),
            ([0, 2], 46.93353),
            ([1, 1], -54.779343),
            ([2, 0], 21.742077),
            ([0, 3], -30.368898),
            ([1, 2], 31.919222),
            ([2, 1], -8.013965),
            ([3, 0], -6.2407165),
        ],
        under: &[
            ([0, 0], 1.0),
            ([0, 1], -10.218104),
            ([1, 0], 10.955399),
            ([0, 2], 44.08196),
            ([1, 1], -55.33452),
            ([2, 0], 21.437538),
            ([0, 3], -23.744568),
            ([1, 2], 33.265057),
            ([2, 1], -7.9268975),
            ([3, 0], -5.930959),
        ],
    },
    Printed {
        name: "Ray Tracing Gems",
        quantity: Quantity::Scale,
        power: 1.0,
        over: &[([0, 0], 0.0365463), ([1, 0], 3.32707), ([0, 1], 9.0632), ([1, 1], -9.04756)],
        under: &[
            ([0, 0], 1.0),
            ([2, 0], 3.59685),
            ([3, 0], -1.36772),
            ([0, 1], 9.04401),
            ([2, 1], -16.3174),
            ([3, 1], 9.22949),
            ([0, 3], 5.56589),
            ([2, 3], 19.7886),
            ([3, 3], -20.2123),
        ],
    },
    Printed {
        name: "Ray Tracing Gems",
        quantity: Quantity::Bias,
        power: 1.0,
        over: &[([0, 0], 0.99044), ([1, 0], -1.28514), ([0, 1], 1.29678), ([1, 1], -0.755907)],
        under: &[
            ([0, 0], 1.0),
            ([1, 0], 2.92338),
            ([3, 0], 59.4188),
            ([0, 1], 20.3225),
            ([1, 1], -27.0302),
            ([3, 1], 222.592),
            ([0, 3], 121.563),
            ([1, 3], 626.13),
            ([3, 3], 316.627),
        ],
    },
];

/// The same place in a form, of which the last two variables are none.
fn term([mu, roughness]: [u8; 2]) -> Term {
    [mu, roughness, 0, 0]
}

fn value(polynomial: &[([u8; 2], f64)], mu: f64, roughness: f64) -> f64 {
    let term =
        |([i, j], x): &([u8; 2], f64)| x * mu.powi((*i).into()) * roughness.powi((*j).into());
    polynomial.iter().map(term).sum()
}

/// σ, μ and the three quantities of the model.
type Truth = ([f64; 2], [f64; 3]);

/// The model at √σ evenly up to 1, and cosines that are denser at both ends.
fn truths(gamma: f64, masking: Masking, sizes: [usize; 2]) -> Result<Vec<Truth>, ParameterError> {
    let integrator = AlbedoIntegrator::new(Shape::new(gamma)?, 1e-6);
    let sigmas: Vec<f64> = (1..=sizes[0]).map(|i| i as f64 / sizes[0] as f64).collect();
    let of = |root: &f64| -> Result<Vec<Truth>, ParameterError> {
        let sigma = root * root;
        let at = |u: f64| {
            let mu = f64::min(LEAST_COSINE + (1.0 - LEAST_COSINE) * u, 1.0);
            let [e, bias] =
                integrator.reflection(sigma, mu, |cos| [1.0, schlick_weight(cos)])?.of(masking);
            Ok(([sigma, mu], [e, e - bias, bias]))
        };
        crowded(sizes[1]).map(at).collect()
    };
    Ok(sigmas.par_iter().map(of).collect::<Result<Vec<_>, _>>()?.concat())
}

impl Printed {
    /// The largest error and the root mean square of a form of these polynomials, limited to [0, 1].
    fn errors(&self, truths: &[Truth], [over, under]: [&[([u8; 2], f64)]; 2]) -> (Largest, f64) {
        let (mut largest, mut squares) = (Largest::default(), 0.0);
        for ([sigma, mu], wanted) in truths {
            let roughness = sigma.powf(self.power);
            let form = value(over, *mu, roughness) / value(under, *mu, roughness);
            let error = form.clamp(0.0, 1.0) - wanted[self.quantity as usize];
            largest.take(error, [*sigma, *mu, 0.0]);
            squares += error * error;
        }
        (largest, (squares / truths.len() as f64).sqrt())
    }

    /// The coefficients with which the largest error is least, from those that are printed or from
    /// a guess, whichever ends lower at places between: a quotient may have a pole there.
    fn fitted(&self, fitted: &[Truth], check: &[Truth]) -> [Vec<([u8; 2], f64)>; 2] {
        let terms = |part: Polynomial| part.iter().map(|(powers, _)| term(*powers)).collect();
        let terms = Terms::quotient(terms(self.over), terms(self.under));
        let place = |([sigma, mu], _): &Truth| [*mu, sigma.powf(self.power), 0.0, 0.0];
        let samples = Samples {
            places: fitted.iter().map(place).collect(),
            wanted: fitted.iter().map(|(_, wanted)| wanted[self.quantity as usize]).collect(),
        };
        let printed = self.over.iter().chain(self.under).map(|(_, x)| *x).collect();
        let starts = [None, Some(Start::at(printed, &samples))];
        let fits = starts.map(|start| {
            let fit = fit(&terms, &samples, start, ROUNDS);
            // The constant below is 1 in the texts.
            let scale = fit.coefficients[self.over.len()];
            let mut numbers = fit.coefficients.iter().map(|x| x / scale);
            [self.over, self.under].map(|part| -> Vec<([u8; 2], f64)> {
                part.iter().map(|(powers, _)| *powers).zip(&mut numbers).collect()
            })
        });
        let [guessed, near] = fits
            .each_ref()
            .map(|fit| self.errors(check, fit.each_ref().map(Vec::as_slice)).0.error);
        let [first, second] = fits;
        if guessed < near { first } else { second }
    }

    fn row(&self, masking: Masking, check: &[Truth], fitted: &[Vec<([u8; 2], f64)>; 2]) -> String {
        let (printed, rms) = self.errors(check, [self.over, self.under]);
        let (ours, our_rms) = self.errors(check, fitted.each_ref().map(Vec::as_slice));
        let ([sigma, mu, _], numbers) = (printed.at, self.over.len() + self.under.len() - 1);
        format!(
            "| {} | {} | {numbers} | {} | {:.1e} / {rms:.1e} | {sigma:.2}, {mu:.2} | {:.1e} / \
             {our_rms:.1e} |",
            self.name,
            self.quantity(),
            masking.name(),
            printed.error,
            ours.error,
        )
    }

    fn quantity(&self) -> &'static str {
        match self.quantity {
            Quantity::E => "E",
            Quantity::Scale => "scale",
            Quantity::Bias => "bias",
        }
    }
}

/// Prints the errors of the forms as printed and fitted, and the fitted constants.
pub(super) fn run(gamma: f64) -> Outcome {
    println!("γ = {gamma}, σ ≤ 1, μ ≥ {LEAST_COSINE}; largest error / root mean square\n");
    print_head(&["form", "of", "numbers", "masking", "as printed", "at σ, μ", "fitted"]);
    let mut constants = Vec::new();
    for masking in Masking::ALL {
        let (fitted_at, check) =
            (truths(gamma, masking, FITTED)?, truths(gamma, masking, CHECKED)?);
        for form in &PRINTED {
            let fitted = form.fitted(&fitted_at, &check);
            println!("{}", form.row(masking, &check, &fitted));
            let head = format!("{}, {}, {}", form.name, form.quantity(), masking.name());
            constants.push((head, fitted));
        }
    }
    for (head, parts) in constants {
        println!("\n{head}; (powers of μ and of the roughness) coefficient");
        for (name, part) in ["over ", "under"].into_iter().zip(parts) {
            let term = |([i, j], x): &([u8; 2], f64)| format!("({i} {j}) {x:.6}");
            println!("  {name}: {}", part.iter().map(term).collect::<Vec<_>>().join(", "));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the published formula, as another project's tests have them: F0 = 0.04, α = 0.25,
    /// μ = 0.7.
    #[test]
    fn polynomials_are_read_in_the_order_of_their_sources() {
        let of = |quantity| {
            let form = PRINTED.iter().find(|form| form.quantity == quantity).unwrap();
            value(form.over, 0.7, 0.25) / value(form.under, 0.7, 0.25)
        };
        assert!((of(Quantity::Scale) - 0.876_603_1).abs() < 1e-6);
        assert!((of(Quantity::Bias) - 0.005_304_0).abs() < 1e-6);
    }

    /// The page has the errors; the forms stand for uncorrelated masking, and fit either when their
    /// numbers are for it.
    #[test]
    fn the_page_has_the_rows_and_fitted_numbers_are_better() {
        let page = include_str!("../../../../docs/engines.md");
        for masking in Masking::ALL {
            let [fitted, check] = [FITTED, CHECKED].map(|size| truths(2.0, masking, size).unwrap());
            for form in &PRINTED {
                let ours = form.fitted(&fitted, &check);
                let row = form.row(masking, &check, &ours);
                assert!(page.contains(&row), "{row}");
                let errors = |parts| form.errors(&check, parts).0.error;
                let printed = errors([form.over, form.under]);
                assert!(errors(ours.each_ref().map(Vec::as_slice)) < 0.85 * printed, "{row}");
            }
        }
    }
}
