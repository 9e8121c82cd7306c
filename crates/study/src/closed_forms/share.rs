//! A share kept/(kept + lost) of two polynomials: a rational function in [0, 1] wherever both are
//! positive, here also limited to 1 where `lost` is slightly negative. A share of which no term is
//! lost stands for the polynomial itself; and a quotient kept/lost has terms of its own above and
//! below, as forms of others do.

/// Powers of the variables of a monomial.
pub(super) type Term = [u8; 4];

/// What the terms that are kept are divided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whole {
    /// By 1: a polynomial.
    One,
    /// By the sum of kept and lost terms: a share.
    Both,
    /// By the lost terms alone: a quotient.
    Lost,
}

/// Which monomials a share has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Terms {
    pub(super) kept: Vec<Term>,
    pub(super) lost: Vec<Term>,
    pub(super) whole: Whole,
}

impl Terms {
    pub(super) fn share(kept: Vec<Term>, lost: Vec<Term>) -> Self {
        Self { kept, lost, whole: Whole::Both }
    }

    pub(super) fn polynomial(kept: Vec<Term>) -> Self {
        Self { kept, lost: Vec::new(), whole: Whole::One }
    }

    pub(super) fn quotient(over: Vec<Term>, under: Vec<Term>) -> Self {
        Self { kept: over, lost: under, whole: Whole::Lost }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Term> {
        self.kept.iter().chain(&self.lost)
    }

    pub(super) fn len(&self) -> usize {
        self.kept.len() + self.lost.len()
    }

    /// Without the terms at some places in [`Self::all`].
    pub(super) fn without(&self, places: &[usize]) -> Self {
        let left = |terms: &[Term], first: usize| {
            let left = terms.iter().enumerate().filter(|(i, _)| !places.contains(&(first + i)));
            left.map(|(_, term)| *term).collect()
        };
        let (kept, lost) = (left(&self.kept, 0), left(&self.lost, self.kept.len()));
        Self { kept, lost, whole: self.whole }
    }
}

/// Places with their values, to be met.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub(super) places: Vec<[f64; 4]>,
    pub(super) wanted: Vec<f64>,
}

/// The monomials of each sample, scaled so that a row's sum is 1, which no share sees.
pub(super) struct Rows {
    pub(super) width: usize,
    kept: usize,
    whole: Whole,
    values: Vec<f64>,
}

impl Rows {
    pub(super) fn new(terms: &Terms, samples: &Samples) -> Self {
        let mut values = Vec::with_capacity(terms.len() * samples.places.len());
        for place in &samples.places {
            let powers = place.map(|x| {
                let mut powers = [1.0; 8];
                (1..8).for_each(|i| powers[i] = powers[i - 1] * x);
                powers
            });
            let row = terms
                .all()
                .map(|term| (0..4).map(|i| powers[i][usize::from(term[i])]).product::<f64>());
            let first = values.len();
            values.extend(row);
            let sum: f64 = values[first..].iter().sum();
            if terms.whole != Whole::One {
                values[first..].iter_mut().for_each(|x| *x /= sum);
            }
        }
        Self { width: terms.len(), kept: terms.kept.len(), whole: terms.whole, values }
    }

    /// Whether this is a polynomial, the whole being 1.
    pub(super) fn is_plain(&self) -> bool {
        self.whole == Whole::One
    }

    /// By how much a term changes the whole, as a factor on it.
    pub(super) fn of_whole(&self, term: usize) -> f64 {
        match self.whole {
            Whole::One => 0.0,
            Whole::Both => 1.0,
            Whole::Lost => f64::from(term >= self.kept),
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.width)
    }

    /// The share and the whole at each sample.
    pub(super) fn shares(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let of = |row: &[f64]| {
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let kept = dot(&row[..self.kept], &x[..self.kept]);
            let lost = dot(&row[self.kept..], &x[self.kept..]);
            let whole = match self.whole {
                Whole::One => 1.0,
                Whole::Both => kept + lost,
                Whole::Lost => lost,
            };
            [kept / whole, whole]
        };
        self.iter().map(of).collect()
    }

    /// Σ weight · j jᵀ and Σ weight · j · error, where j is the change of the share, or for a first
    /// guess that of kept − wanted · whole, over `whole`.
    pub(super) fn normal_equations(
        &self,
        weights: &[f64],
        of: impl Fn(usize) -> Option<([f64; 2], f64)>,
    ) -> (Vec<f64>, Vec<f64>) {
        let n = self.width;
        let (mut matrix, mut right, mut j) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
        for (i, row) in self.iter().enumerate() {
            let Some(([share, whole], error)) = of(i) else { continue };
            for (k, (j, row)) in j.iter_mut().zip(row).enumerate() {
                let of_whole = self.of_whole(k) * share;
                *j = (if k < self.kept { 1.0 - of_whole } else { -of_whole }) * row / whole;
            }
            for a in 0..n {
                let scaled = weights[i] * j[a];
                right[a] += scaled * error;
                for b in 0..=a {
                    matrix[a * n + b] += scaled * j[b];
                }
            }
        }
        (matrix, right)
    }
}
