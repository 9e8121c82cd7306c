//! The one-sample mixture of two BSDFs: f = (1 − w) f₁ + w f₂.

use microfacet_core::saturated;

use super::mixture::{Mixture, choice, chosen};
use super::{Bsdf, BsdfSample, Transport};
use crate::material::Part;
use crate::vector::vec3;

/// Two BSDFs, the second with the share `w` ∈ [0, 1] and the first with the rest. A part of share 0
/// is never asked.
///
/// A sample is drawn from one of the two, chosen by its share, and its weight is
///
/// ```text
/// ((1 − w) f₁ + w f₂) cos θ_l / ((1 − w) p₁ + w p₂)
/// ```
///
/// of both, the *one-sample model* with the balance heuristic (Veach 1997, *Robust Monte Carlo
/// Methods for Light Transport Simulation*, section 9.2.4). A delta event of a part keeps its
/// weight: its strength and the probability with which it is drawn both scale by the share. Of the
/// part that has not drawn a light, f where it is `f32::MAX` counts as that, which takes a density
/// near the end of single precision.
pub(super) struct Pair<'a, A, B> {
    pub(super) first: &'a A,
    pub(super) second: &'a B,
    pub(super) w: f32,
}

impl<A, B> Pair<'_, A, B> {
    /// Whether something holds for the parts that are there.
    fn all(&self, first: impl Fn(&A) -> bool, second: impl Fn(&B) -> bool) -> bool {
        (self.w == 1.0 || first(self.first)) && (self.w == 0.0 || second(self.second))
    }
}

impl<const N: usize, A: Bsdf<N>, B: Bsdf<N>> Bsdf<N> for Pair<'_, A, B> {
    #[inline]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        number: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        let (&Self { first, second, w }, v) = (self, v.into());
        if w == 0.0 {
            return first.sample_with_pdf(v, number, u, transport);
        }
        if w == 1.0 {
            return second.sample_with_pdf(v, number, u, transport);
        }
        let (is_first, rest) = chosen(choice(number), 1.0 - w);
        if is_first {
            let drawn = first.sample_with_pdf(v, rest, u, transport)?;
            Some(mixed(drawn, second, v, transport, 1.0 - w))
        } else {
            let drawn = second.sample_with_pdf(v, rest, u, transport)?;
            Some(mixed(drawn, first, v, transport, w))
        }
    }

    #[inline]
    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        number: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample<N>> {
        // A single part needs no density for its weight.
        if self.w == 0.0 {
            return self.first.sample(v, number, u, transport);
        }
        if self.w == 1.0 {
            return self.second.sample(v, number, u, transport);
        }
        Some(self.sample_with_pdf(v, number, u, transport)?.0)
    }

    #[inline]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; N], f32) {
        let (&Self { first, second, w }, v, l) = (self, v.into(), l.into());
        if w == 0.0 {
            return first.eval_pdf(v, l, transport);
        }
        if w == 1.0 {
            return second.eval_pdf(v, l, transport);
        }
        let (f, p) = first.eval_pdf(v, l, transport);
        let (g, q) = second.eval_pdf(v, l, transport);
        // Both may be `f32::MAX`, and rounding take their mean beyond.
        let mean = |a: f32, b: f32| saturated((1.0 - w) * a + w * b);
        (core::array::from_fn(|i| mean(f[i], g[i])), mean(p, q))
    }

    fn is_delta(&self) -> bool {
        self.all(A::is_delta, B::is_delta)
    }

    fn transmits(&self) -> bool {
        !self.all(|first| !first.transmits(), |second| !second.transmits())
    }

    fn is_symmetric(&self) -> bool {
        self.all(A::is_symmetric, B::is_symmetric)
    }
}

/// The BSDF of a type that is a [`Pair`], which its function `pair` returns.
macro_rules! by_pair {
    ($type:ident<$($part:ident),+>) => {
        impl<const N: usize, $($part: Bsdf<N>),+> Bsdf<N> for $type<$($part),+> {
            #[inline]
            fn sample_with_pdf(
                &self,
                v: impl Into<[f32; 3]>,
                choice: f32,
                u: [f32; 2],
                transport: Transport,
            ) -> Option<(BsdfSample<N>, f32)> {
                self.pair().sample_with_pdf(v, choice, u, transport)
            }

            #[inline]
            fn sample(
                &self,
                v: impl Into<[f32; 3]>,
                choice: f32,
                u: [f32; 2],
                transport: Transport,
            ) -> Option<BsdfSample<N>> {
                self.pair().sample(v, choice, u, transport)
            }

            #[inline]
            fn eval_pdf(
                &self,
                v: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                transport: Transport,
            ) -> ([f32; N], f32) {
                self.pair().eval_pdf(v, l, transport)
            }

            fn is_delta(&self) -> bool {
                Bsdf::<N>::is_delta(&self.pair())
            }

            fn transmits(&self) -> bool {
                Bsdf::<N>::transmits(&self.pair())
            }

            fn is_symmetric(&self) -> bool {
                Bsdf::<N>::is_symmetric(&self.pair())
            }
        }
    };
}
pub(super) use by_pair;

/// What a part of a `share` has drawn, as a sample of the pair.
#[inline(always)]
fn mixed<const N: usize>(
    (sample, pdf): (BsdfSample<N>, f32),
    other: &impl Bsdf<N>,
    v: [f32; 3],
    transport: Transport,
    share: f32,
) -> (BsdfSample<N>, f32) {
    if sample.delta {
        return (sample, pdf);
    }
    let (f, density) = other.eval_pdf(v, sample.l, transport);
    let scaled = |part: Part<N>, share: f32| Part {
        weight: part.weight.map(|weight| share * weight),
        pdf: part.pdf,
    };
    let mixture = Mixture {
        p: share,
        facets: scaled(Part { weight: sample.weight, pdf }, share),
        broad: scaled(Part::of_f(f, density, vec3(sample.l)), 1.0 - share),
    };
    (BsdfSample { weight: mixture.weight(), ..sample }, saturated(mixture.pdf()))
}
