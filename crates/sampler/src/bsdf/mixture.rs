//! A mixture of two densities: facets, drawn by visible normals, and a broad lobe for light of
//! further bounces.

use glam::Vec3;
use microfacet_core::math::unit;
use microfacet_core::saturated;

use super::broad::cosine_pdf;
use crate::material::Part;

impl<const N: usize> Part<N> {
    /// The broad lobe at a light, from the factor of its density, its share on the side of that
    /// light, and π f over that share.
    #[inline(always)]
    pub(super) fn broad(l: Vec3, factor: f32, share: f32, lobe: [f32; N]) -> Self {
        Self { weight: lobe.map(|lobe| lobe / factor), pdf: share * factor * cosine_pdf(l) }
    }
}

/// Facets, drawn with the probability `p`, and the broad lobe with 1 − p; the density of each is
/// within its own part. Where p is 1 there is no broad lobe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture<const N: usize> {
    pub(super) p: f32,
    pub(super) facets: Part<N>,
    pub(super) broad: Part<N>,
}

impl<const N: usize> Mixture<N> {
    #[inline(always)]
    pub(super) fn pdf(&self) -> f32 {
        self.p * self.facets.pdf + (1.0 - self.p) * self.broad.pdf
    }

    /// f, without the cosine, and the density.
    #[inline(always)]
    pub(super) fn f_pdf(&self, l: Vec3) -> ([f32; N], f32) {
        let (facets, broad) = (self.facets.f(l), self.broad.f(l));
        (core::array::from_fn(|i| saturated(facets[i] + broad[i])), self.pdf())
    }

    /// The weight of a light drawn from the mixture, f |cos θ_l|/pdf.
    ///
    /// Both densities are divided by their sum first, so that nothing overflows.
    #[inline(always)]
    pub(super) fn weight(&self) -> [f32; N] {
        if self.p == 1.0 {
            return self.facets.weight;
        }
        // Of two densities that are `f32::MAX`, too.
        let sum = saturated(self.facets.pdf + self.broad.pdf);
        if !(sum > 0.0) {
            return [0.0; N];
        }
        let (a, b) = (self.facets.pdf / sum, self.broad.pdf / sum);
        let pdf = self.p * a + (1.0 - self.p) * b;
        core::array::from_fn(|i| (self.facets.weight[i] * a + self.broad.weight[i] * b) / pdf)
    }
}

/// A choice clamped to [0, 1), NaN to 0: 1 would choose an event of probability 0.
#[inline(always)]
pub(super) fn choice(choice: f32) -> f32 {
    unit(choice).min(1.0 - 0.5 * f32::EPSILON)
}

/// Whether a [`choice`] takes a part of probability `p`, and the choice that is left within it.
#[inline(always)]
pub(super) fn chosen(number: f32, p: f32) -> (bool, f32) {
    // The quotient may round to 1, so it is clamped.
    if number < p { (true, number / p) } else { (false, choice((number - p) / (1.0 - p))) }
}

#[inline(always)]
pub(super) fn are_finite(v: Vec3, l: Vec3) -> bool {
    (v.dot(v) + l.dot(l)).is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weight_is_f_cos_over_pdf_also_where_densities_overflow() {
        let l = Vec3::new(0.8, 0.0, 0.6);
        let mixture = Mixture {
            p: 0.7,
            facets: Part { weight: [0.9, 0.2], pdf: 3.0 },
            broad: Part::broad(l, 1.0, 0.5, [0.1, 0.4]),
        };
        let (f, pdf) = mixture.f_pdf(l);
        for (weight, f) in mixture.weight().into_iter().zip(f) {
            assert!((weight - f * l.z / pdf).abs() < 1e-6, "{weight} {f}");
        }
        let steep = Mixture { facets: Part { pdf: f32::MAX, ..mixture.facets }, ..mixture };
        assert_eq!(steep.weight(), [0.9 / 0.7, 0.2 / 0.7]);
        assert_eq!(steep.f_pdf(Vec3::new(1.0, 0.0, 1e-3)).0, [f32::MAX; 2]);
        let none = Mixture { p: 1.0, facets: Part::<1>::NONE, broad: Part::NONE };
        assert_eq!((none.weight(), none.pdf()), ([0.0], 0.0));
    }

    #[test]
    fn what_is_left_of_a_choice_is_a_choice_again() {
        assert_eq!((chosen(0.125, 0.25), chosen(0.625, 0.25)), ((true, 0.5), (false, 0.5)));
        assert_eq!(chosen(0.25, 0.25), (false, 0.0));
        // The ends, where one part is certain.
        for all in [0.0, 0.5, 1.0, f32::NAN, f32::INFINITY].map(choice) {
            assert_eq!((chosen(all, 1.0), chosen(all, 0.0)), ((true, all), (false, all)));
        }
    }
}
