//! The closed forms of a Student-t lobe of one shape, in the lobe's own space, for any γ and for
//! those that have sums.

use super::elementary::{arc, polynomial};
use super::tail::{ArcSum, Beta, Sum, Tail, whole};

/// The elevation of a view in the lobe's space.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) sin: f32,
    pub(crate) cos: f32,
    /// sin², computed without a root.
    pub(crate) square: f32,
}

/// The area for Smith's masking.
pub(crate) trait Area {
    /// The projected area, cos θ (1 + Λ).
    fn area(&self, view: View) -> f32;
}

/// The functions that CDFs of visible normals need in addition.
pub(crate) trait Tails: Area {
    type Along: Tail;
    type Across: Tail;

    /// cos^(2γ−5), given the cosine and its square.
    fn power(&self, cos: f32, square: f32) -> f32;

    /// The tails along the plane of incidence, p = γ−2, and across it, p = γ−3/2.
    fn tails(&self) -> (&Self::Along, &Self::Across);
}

/// 1/((2γ−3) ∫(1−t²)^(γ−2)): the weight of slopes relative to the cosine in the projected area.
pub(crate) fn edge(gamma: f64) -> f64 {
    1.0 / ((2.0 * gamma - 3.0) * whole(gamma - 2.0))
}

/// Any γ.
pub(crate) struct AnyGamma {
    /// (2γ−5)/2 and γ−1.
    exponents: [f32; 2],
    edge: f32,
    along: Beta,
    across: Beta,
}

impl AnyGamma {
    pub(crate) fn new(gamma: f64) -> Self {
        Self {
            exponents: [(gamma - 2.5) as f32, (gamma - 1.0) as f32],
            edge: edge(gamma) as f32,
            along: Beta::new(gamma - 2.0),
            across: Beta::new(gamma - 1.5),
        }
    }
}

impl Area for AnyGamma {
    #[inline(always)]
    fn area(&self, view: View) -> f32 {
        let power = view.square.powf(self.exponents[1]);
        view.cos * self.along.upper(-view.cos, view.sin, power) + self.edge * power
    }
}

impl Tails for AnyGamma {
    type Along = Beta;
    type Across = Beta;

    #[inline(always)]
    fn power(&self, _: f32, square: f32) -> f32 {
        square.powf(self.exponents[0])
    }

    #[inline(always)]
    fn tails(&self) -> (&Beta, &Beta) {
        (&self.along, &self.across)
    }
}

/// γ = N + 1: the projected area is ½ cos θ and a polynomial in cos² θ.
pub(crate) struct IntegerGamma<const N: usize> {
    area: [f32; N],
    along: Sum<N>,
    across: ArcSum<N>,
}

impl<const N: usize> IntegerGamma<N> {
    pub(crate) fn new() -> Self {
        // edge (1−y)^N and y times the sum of the tail; their highest powers cancel.
        let (sum, n) = (Sum::<N>::coefficients(), N as f64);
        let mut power = edge(n + 1.0);
        let area = std::array::from_fn(|j| {
            let now = power + if j > 0 { sum[j - 1] } else { 0.0 };
            power *= -(n - j as f64) / (j as f64 + 1.0);
            now as f32
        });
        Self { area, along: Sum::new(), across: ArcSum::new() }
    }
}

impl<const N: usize> Area for IntegerGamma<N> {
    #[inline(always)]
    fn area(&self, view: View) -> f32 {
        0.5 * view.cos + polynomial(view.cos * view.cos, &self.area)
    }
}

impl<const N: usize> Tails for IntegerGamma<N> {
    type Along = Sum<N>;
    type Across = ArcSum<N>;

    #[inline(always)]
    fn power(&self, cos: f32, square: f32) -> f32 {
        (2..N).fold(cos, |power, _| power * square)
    }

    #[inline(always)]
    fn tails(&self) -> (&Sum<N>, &ArcSum<N>) {
        (&self.along, &self.across)
    }
}

/// γ = N + 3/2: the projected area has an arc, and a polynomial in sin² θ.
pub(crate) struct HalfIntegerGamma<const N: usize> {
    area: [f32; N],
}

impl<const N: usize> HalfIntegerGamma<N> {
    pub(crate) fn new() -> Self {
        // edge sin^(2N) and 1 − sin² times the sum of the tail; their highest powers cancel.
        let sum = ArcSum::<N>::coefficients();
        let term = |j: usize| sum[j] - if j > 0 { sum[j - 1] } else { 0.0 };
        Self { area: std::array::from_fn(|j| term(j) as f32) }
    }
}

impl<const N: usize> Area for HalfIntegerGamma<N> {
    #[inline(always)]
    fn area(&self, view: View) -> f32 {
        view.cos * (0.5 + arc(view.cos, view.sin)) + view.sin * polynomial(view.square, &self.area)
    }
}
