//! The view axis of albedos seen from inside a dielectric. Its parts meet where total reflection
//! begins and, for heavy tails, where upright facets begin to transmit, so that no polynomial
//! crosses the kinks there, for any index of refraction.

use serde::{Deserialize, Serialize};

use microfacet_core::math::sqrt64;

use super::coordinate::{Coordinate, bisect, positive};
use super::lagrange::{SIX, six};
use super::view_blend::{fourth_roots, harmonic, kappa, terms};

/// The view coordinate of the dense side of an interface of index η, t ∈ [0, 1], in two or three
/// parts of equal width; a polynomial reads nodes of one part only.
/// [`Mapping::formula`](super::Mapping::formula) states it.
///
/// Level facets reflect totally below μ_c = √(1 − 1/η²), and upright ones, of which there are many
/// where tails are heavy, above μ_u = 1/η. Two parts meet at μ_c. Three meet at the smaller and at
/// the larger of μ_c and μ_u, whose order changes at η = √2, where t has a kink as a function of η:
/// [`CrossingRoot`](super::CrossingRoot) has a node there.
///
/// Above the first part there are no fourth roots, which are steep in η near 1: with them tables
/// over all indices erred by 0.12 instead of 1e-3 (σ 0.454, γ 3, twenty indices).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CriticalBlend {
    /// Share of x among the fourth roots, in [0, 1].
    pub share: f64,
    /// κ for Beckmann.
    pub scale: f64,
    /// Factor of 1/(2γ−3) in κ.
    pub heavy: f64,
    /// Largest μ₀.
    pub floor: f64,
    /// μ₀/σ as σ → 0.
    pub slope: f64,
    /// Share of S, in (0, 1).
    pub root: f64,
    /// δ²/σ for a large σ.
    pub kink: f64,
    /// Smallest δ.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub sharp: f64,
    /// What the share of either S is multiplied by in the second of three parts; 0 if there are
    /// two.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub between: f64,
    /// Moves μ_c towards √½ where η < √2, the more the larger soft·σ is: rough surfaces have no
    /// sharp kink there, and as η → 1 the first part would shrink to nothing, whereas transmission
    /// still turns at grazing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub soft: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref)]
fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl CriticalBlend {
    /// The parameters of baked tables, found by measuring, but for heavy tails.
    pub const BAKED: Self = Self {
        share: 0.4,
        scale: 3.0,
        heavy: 0.5,
        floor: 2e-5,
        slope: 2e-3,
        root: 0.5,
        kink: 1.0,
        sharp: 0.0,
        between: 0.0,
        soft: 0.0,
    };

    /// The parameters of baked tables of heavy tails. Of those that
    /// `cargo run --profile dist -p microfacet-study -- dielectric_views` compares, none has
    /// smaller errors.
    pub const UPRIGHT: Self = Self { kink: 0.0, sharp: 0.1, between: 0.9, ..Self::BAKED };

    /// [`soft`](Self::soft) of tables over indices. With 1 the error at η = 1.003 is twice as
    /// large (σ 0.454, γ 3, all indices), with 0 it is 5.9e-3 next to η = 1.
    pub const SOFT: f64 = 0.3;

    /// The parameters for tables of one shape, which need no γ: κ of the shape is their `scale`.
    #[must_use]
    pub fn of_shape(&self, gamma: f64) -> Self {
        Self { scale: kappa(self.scale, self.heavy, gamma), heavy: 0.0, ..*self }
    }

    /// The number of parts: two or three.
    pub fn parts(&self) -> usize {
        parts(self.between)
    }

    /// Prepares the coordinate for σ > 0, γ and an index η ≥ 1 of the dense side, given as 1/η.
    pub fn prepare(&self, sigma: f64, gamma: f64, inverse_eta: f64) -> PreparedCritical {
        let critical = sqrt64((1.0 - inverse_eta) * (1.0 + inverse_eta));
        let critical = softened(critical, self.soft * sigma);
        let floor = harmonic(harmonic(self.floor, self.slope * sigma), critical);
        // For η = ∞, 1/η is less than the cosine of the first view.
        let upright = inverse_eta.max(floor);
        let width = sqrt64(self.kink * sigma + self.sharp * self.sharp);
        let Self { share, root, between, .. } = *self;
        let mut view = PreparedCritical {
            share,
            root,
            between,
            knee: kappa(self.scale, self.heavy, gamma) * sigma,
            width,
            range: libm::asinh(1.0 / width),
            ends: match self.parts() {
                2 => [floor, critical, 1.0, 1.0],
                _ => [floor, critical.min(upright), critical.max(upright), 1.0],
            },
            first: [0.0; 2],
            rest: [0.0; 3],
        };
        let [a, b, c, d] = view.ends;
        view.first = [a, b].map(|cos| view.smooth(0, cos));
        view.rest = [b, c, d].map(|cos| view.smooth(1, cos));
        view
    }
}

/// A cosine with its square moved towards ½ where it is less, by a share that rises with the width.
fn softened(cos: f64, width: f64) -> f64 {
    let [room, square] = [0.5 - cos * cos, width * width];
    // A cosine that is not moved keeps every bit.
    if room > 0.0 && square > 0.0 {
        sqrt64(cos * cos + room * square / (1.0 + square))
    } else {
        cos
    }
}

fn parts(between: f64) -> usize {
    if between > 0.0 { 3 } else { 2 }
}

/// [`CriticalBlend`] prepared for one material and index of refraction.
#[derive(Clone, Copy, Debug)]
pub struct PreparedCritical {
    share: f64,
    root: f64,
    between: f64,
    /// κσ.
    knee: f64,
    /// δ and asinh(1/δ).
    width: f64,
    range: f64,
    /// The ends of the parts, and 1.
    ends: [f64; 4],
    /// y at the ends of the first part, and p at those of the others.
    first: [f64; 2],
    rest: [f64; 3],
}

impl PreparedCritical {
    /// μ₀, the view of the first node.
    pub fn floor(&self) -> f64 {
        self.ends[0]
    }

    /// The ends of the parts, from μ₀ to 1.
    pub fn ends(&self) -> &[f64] {
        &self.ends[..=self.parts()]
    }

    fn parts(&self) -> usize {
        parts(self.between)
    }

    /// The part of a view, from 0; a kink itself belongs to the one above it.
    fn part(&self, cos: f64) -> usize {
        let [_, kinks @ .., _] = self.ends() else { return 0 };
        kinks.iter().filter(|kink| cos >= **kink).count()
    }

    fn smooth(&self, i: usize, cos: f64) -> f64 {
        let (_, x, h) = terms(cos, self.knee);
        let share = self.share;
        if i == 0 { fourth_roots(share, x, h) } else { share * x + (1.0 - share) * h }
    }

    /// S of a number in [0, 1].
    fn near(&self, q: f64) -> f64 {
        libm::asinh(sqrt64(q.max(0.0)) / self.width) / self.range
    }

    /// The coordinate of cos θ within a part, in [0, 1].
    fn within(&self, i: usize, cos: f64) -> f64 {
        // A part without width is a single point.
        let share = |x: f64, whole: f64| if whole > 0.0 { x / whole } else { 0.0 };
        let [a, b] = [self.ends[i], self.ends[i + 1]];
        let [first, last] = if i == 0 { self.first } else { [self.rest[i - 1], self.rest[i]] };
        let smooth = share(self.smooth(i, cos) - first, last - first);
        let from = || self.near(share(cos - a, b - a));
        let to = || 1.0 - self.near(share(b - cos, b - a));
        let Self { root, between, .. } = *self;
        if i == 0 {
            (1.0 - root) * smooth + root * to()
        } else if i + 1 < self.parts() {
            (1.0 - 2.0 * between * root) * smooth + between * root * (from() + to())
        } else {
            (1.0 - root) * smooth + root * from()
        }
    }

    /// t of cos θ ∈ [μ₀, 1].
    pub fn coordinate(&self, cos: f64) -> f64 {
        let i = self.part(cos);
        (i as f64 + self.within(i, cos)) / self.parts() as f64
    }

    /// The first of the six nodes about cos θ ∈ [0, 1], all in one part, and their weights; `n`
    /// nodes, one more than a multiple of the number of parts, are spread evenly.
    pub fn six(&self, cos: f64, n: usize) -> (usize, [f32; SIX]) {
        let cells = n / self.parts();
        let cos = cos.max(self.floor());
        let i = self.part(cos);
        let (start, weights) = six(self.within(i, cos) as f32, cells + 1);
        (start + i * cells, weights)
    }

    /// cos θ of t ∈ [0, 1].
    pub fn quantity(&self, t: f64) -> f64 {
        let parts = self.parts();
        let t = parts as f64 * t;
        let i = (t as usize).min(parts - 1);
        let [low, high] = [self.ends[i], self.ends[i + 1]];
        // A part ends just before the kink.
        let is_here = |cos: f64| i + 1 == parts || cos < high;
        bisect(low, high, t - i as f64, |cos| {
            if is_here(cos) { self.within(i, cos) } else { f64::INFINITY }
        })
    }
}

impl Coordinate for CriticalBlend {
    fn formula(&self) -> &'static str {
        "parts of equal width in t, from a to b: two, [μ₀, μ_c] and [μ_c, 1], or if between > 0 three, which meet at the \
         smaller and the larger of μ_c and 1/η; μ_c² = x + max(½−x, 0)·s²/(1+s²), x = 1−1/η², s = soft·σ; within a part t goes by \
         (1−root) (y(μ)−y(a))/(y(b)−y(a)) + root (1−S(1−q)) in the first, \
         (1−2w) (p(μ)−p(a))/(p(b)−p(a)) + w (1+S(q)−S(1−q)), w = between·root, in the second of three, \
         (1−root) (p(μ)−p(a))/(p(b)−p(a)) + root S(q) in the last; q = (μ−a)/(b−a), \
         y = share·x^¼ + (1−share)·h^¼, p = share·x + (1−share)·h, S(q) = asinh(√q/δ)/asinh(1/δ), \
         δ = √(kink·σ + sharp²), μ₀ = 1/(1/floor + 1/(slope·σ) + 1/μ_c), 1/η no less than μ₀, x, h and κ of view_blend"
    }

    fn fault(&self) -> Option<&'static str> {
        let Self { share, scale, heavy, floor, slope, root, kink, sharp, between, soft } = *self;
        // δ is 0 without `kink` and `sharp`, and S undefined.
        let width = if sharp > 0.0 { sharp } else { kink };
        let sound = positive(&[scale, floor, slope, width])
            && (0.0..=1.0).contains(&share)
            && (0.0..1e6).contains(&heavy)
            && (0.0..1e6).contains(&kink)
            && (0.0..1e6).contains(&sharp)
            && (0.0..1e6).contains(&soft)
            && root > 0.0
            && root < 1.0
            && between >= 0.0
            && 2.0 * between * root < 1.0
            && floor < 0.5;
        (!sound).then_some("a parameter of the view coordinate is out of range")
    }

    fn count_fault(&self, n: usize) -> Option<&'static str> {
        let parts = self.parts();
        let sound = n > parts * (SIX - 1) && n % parts == 1;
        (!sound).then_some(match parts {
            2 => "needs an odd number of nodes, eleven or more: six in either half",
            _ => "needs one node more than a multiple of three, 16 or more: six in each third",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let soft = CriticalBlend { soft: CriticalBlend::SOFT, ..CriticalBlend::BAKED };
        let blends = [CriticalBlend::BAKED, CriticalBlend::UPRIGHT, soft];
        let surfaces = [(1e-6, 2.0), (0.3, 1.501), (2.0, f64::INFINITY)];
        let all = blends.into_iter().flat_map(|blend| surfaces.map(|surface| (blend, surface)));
        for (blend, (sigma, gamma)) in all {
            for eta in [1.0001, 1.2, 1.5, 4.0] {
                let view = blend.prepare(sigma, gamma, 1.0 / eta);
                assert_eq!(view.coordinate(1.0), 1.0);
                for t in [0.0, 0.1, 0.4, 0.5, 0.6, 0.9, 1.0] {
                    let cos = view.quantity(t);
                    let [back, below] = [cos, cos * (1.0 - 1e-15)].map(|x| view.coordinate(x));
                    let tolerance = 1e-12 + 2.0 * (back - below).abs();
                    assert!((back - t).abs() < tolerance, "eta {eta}, sigma {sigma}, {t}: {back}");
                }
            }
        }
    }

    #[test]
    fn the_first_part_of_a_rough_surface_does_not_vanish() {
        let own = CriticalBlend { soft: 0.3, ..CriticalBlend::BAKED };
        let end = |sigma: f64, eta: f64| own.prepare(sigma, 3.0, 1.0 / eta).ends()[1];
        let critical = |eta: f64| sqrt64(1.0 - 1.0 / (eta * eta));
        assert!((0.09..0.11).contains(&end(0.5, 1.0)) && end(1e-8, 1.0) < 1e-8);
        // From √2 on it ends at the kink itself, as it does for every index of smooth surfaces.
        for eta in [core::f64::consts::SQRT_2, 1.5, 4.0] {
            assert!((end(3.0, eta) - critical(eta)).abs() < 1e-15);
            assert!((end(1e-8, 1.2) - critical(1.2)).abs() < 1e-15);
        }
    }

    #[test]
    fn parts_do_not_share_windows() {
        let [two, three] = [CriticalBlend::BAKED, CriticalBlend::UPRIGHT];
        for (blend, eta) in [(two, 1.5), (three, 1.2), (three, 1.5)] {
            let view = blend.prepare(0.3, 2.0, 1.0 / eta);
            let (n, critical) = (10 * blend.parts() + 1, sqrt64(1.0 - 1.0 / (eta * eta)));
            let has = |cos: f64| view.ends().iter().any(|end| (end - cos).abs() < 1e-15);
            assert!(has(critical) && has(1.0 / eta) == (blend.parts() == 3));
            for (i, cos) in view.ends()[1..blend.parts()].iter().enumerate() {
                assert_eq!(view.six(cos - 1e-9, n).0, 10 * i + 5);
                assert_eq!(view.six(cos + 1e-9, n).0, 10 * i + 10);
            }
        }
        // For η = 1 the first part is a point, and for η = ∞ the last.
        for blend in [two, three] {
            let none = blend.prepare(0.3, 2.0, 1.0);
            assert_eq!((none.six(0.0, 31).0, none.quantity(0.0)), (31 / blend.parts(), 0.0));
            let mirror = blend.prepare(0.3, 2.0, 0.0);
            assert!(mirror.coordinate(0.5) < 1.0 && mirror.quantity(1.0) == 1.0);
        }
    }
}
