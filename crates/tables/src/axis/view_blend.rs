//! The view axis of albedo tables. Its spacing is defined in this file alone; baking, readers,
//! certificates, examples and the description in every file follow it.
//!
//! `cargo run --release -p microfacet-study -- albedo_design` measures the reasons for this
//! spacing.

use serde::{Deserialize, Serialize};

use microfacet_core::math::sqrt64;

use super::coordinate::{Coordinate, bisect, positive};
use super::lagrange::SIX;

/// The view coordinate of albedo tables, t ∈ [0, 1] of μ = cos θ_v ∈ [μ₀, 1], as
/// [`Mapping::formula`](super::Mapping::formula) states it.
///
/// h is a function of the view alone. x is a function of z = cot θ_v/σ and κ, which follows the
/// range of masking as that grows for γ → 3/2. The term with ν resolves the change at normal
/// incidence, and the fourth roots resolve grazing views.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewBlend {
    /// Share of x.
    pub weight: f64,
    /// Share of the term with ν.
    pub normal: f64,
    /// Share of x among the fourth roots, in [0, 1].
    pub share: f64,
    /// κ for Beckmann.
    pub scale: f64,
    /// Factor of 1/(2γ−3) in κ.
    pub heavy: f64,
    /// ν/σ.
    pub spread: f64,
    /// Largest μ₀.
    pub floor: f64,
    /// μ₀/σ as σ → 0.
    pub slope: f64,
}

impl ViewBlend {
    /// The parameters of baked tables, found by searching for the least error of E and its moments
    /// between 33 exact nodes.
    pub const BAKED: Self = Self {
        weight: 0.17,
        normal: 0.08,
        share: 0.4,
        scale: 1.5,
        heavy: 0.6,
        spread: 8.5,
        floor: 2e-5,
        slope: 2e-3,
    };

    /// The parameters for tables of many nodes, whose largest error is at the cusp at normal
    /// incidence, for γ from 1.5 to 1.6: it needs closer nodes.
    pub const CLOSE: Self = Self { normal: 0.2, scale: 6.0, spread: 1.3, ..Self::BAKED };

    /// The same coordinate for one shape γ: κ is a constant, so readers need no γ
    /// ([`prepare_shaped`](Self::prepare_shaped)).
    #[must_use]
    pub fn of_shape(&self, gamma: f64) -> Self {
        Self { scale: kappa(self.scale, self.heavy, gamma), heavy: 0.0, ..*self }
    }

    /// Prepares the coordinate of a table of one shape for a roughness σ > 0.
    pub fn prepare_shaped(&self, sigma: f64) -> PreparedView {
        // `heavy` is 0, so γ does not matter.
        self.prepare(sigma, f64::INFINITY)
    }

    /// Prepares the coordinate for a roughness σ > 0 and a shape γ.
    pub fn prepare(&self, sigma: f64, gamma: f64) -> PreparedView {
        let knee = kappa(self.scale, self.heavy, gamma) * sigma;
        // A minimum would have a kink as a function of σ, along which tables are interpolated.
        let floor = harmonic(self.floor, self.slope * sigma);
        let mut view =
            PreparedView { blend: *self, knee, turn: self.spread * sigma, floor, start: 0.0 };
        view.start = view.y(floor);
        view
    }
}

/// κ = scale + heavy/(2γ−3).
pub(super) fn kappa(scale: f64, heavy: f64, gamma: f64) -> f64 {
    scale + heavy / (2.0 * gamma - 3.0)
}

/// ab/(a + b), a smooth minimum of numbers ≥ 0; 0 if either is 0.
pub(super) fn harmonic(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a * b / (a + b) } else { 0.0 }
}

/// sin θ, x and h of a view; `knee` is κσ.
pub(super) fn terms(cos: f64, knee: f64) -> (f64, f64, f64) {
    let sin = sqrt64((1.0 - cos) * (1.0 + cos));
    (sin, cos / (cos + knee * sin), cos / (1.0 + sin))
}

/// share·x^¼ + (1−share)·h^¼.
pub(super) fn fourth_roots(share: f64, x: f64, h: f64) -> f64 {
    let root = |x: f64| sqrt64(sqrt64(x));
    share * root(x) + (1.0 - share) * root(h)
}

/// [`ViewBlend`] prepared for one material.
#[derive(Clone, Copy, Debug)]
pub struct PreparedView {
    blend: ViewBlend,
    /// κσ.
    knee: f64,
    /// ν.
    turn: f64,
    /// μ₀ and y(μ₀).
    floor: f64,
    start: f64,
}

impl PreparedView {
    /// μ₀, the view of the first node.
    pub fn floor(&self) -> f64 {
        self.floor
    }

    fn y(&self, cos: f64) -> f64 {
        let ViewBlend { weight, normal, share, .. } = self.blend;
        let (sin, x, h) = terms(cos, self.knee);
        weight * x
            + normal * self.turn / (self.turn + sin)
            + (1.0 - weight - normal) * fourth_roots(share, x, h)
    }

    /// t of cos θ ∈ [μ₀, 1].
    pub fn coordinate(&self, cos: f64) -> f64 {
        (self.y(cos) - self.start) / (1.0 - self.start)
    }

    /// t of any cos θ ∈ [0, 1]; a view with cos θ < μ₀ is taken at the first node.
    pub fn clamped(&self, cos: f32) -> f32 {
        if cos > self.floor as f32 { self.coordinate(f64::from(cos)) as f32 } else { 0.0 }
    }

    /// cos θ of t ∈ [0, 1].
    pub fn quantity(&self, t: f64) -> f64 {
        if t >= 1.0 { 1.0 } else { bisect(self.floor, 1.0, t, |cos| self.coordinate(cos)) }
    }
}

impl Coordinate for ViewBlend {
    fn formula(&self) -> &'static str {
        "t = (y(μ)−y(μ₀))/(1−y(μ₀)), μ₀ = floor·slope·σ/(floor + slope·σ), y = weight·x + normal·ν/(ν + sin \
         θ) + (1−weight−normal)·(share·x^¼ + (1−share)·h^¼), x = μ/(μ + κσ sin θ), h = μ/(1 + sin θ), κ = \
         scale + heavy/(2γ−3), ν = spread·σ"
    }

    fn fault(&self) -> Option<&'static str> {
        let Self { weight, normal, share, scale, heavy, spread, floor, slope } = *self;
        let sound = positive(&[weight, normal, scale, spread, floor, slope])
            && weight + normal < 1.0
            && (0.0..=1.0).contains(&share)
            && (0.0..1e6).contains(&heavy)
            && floor < 0.5;
        (!sound).then_some("a parameter of the view coordinate is out of range")
    }

    fn count_fault(&self, n: usize) -> Option<&'static str> {
        (n < SIX).then_some("has fewer than six nodes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for gamma in [1.501, 2.0, f64::INFINITY] {
            for sigma in [1e-8, 1e-3, 0.3, 3.0] {
                let view = ViewBlend::BAKED.prepare(sigma, gamma);
                assert_eq!(view.coordinate(1.0), 1.0);
                assert_eq!(view.coordinate(view.floor()), 0.0);
                for t in [0.0, 1e-3, 0.1, 0.5, 0.9, 1.0] {
                    let cos = view.quantity(t);
                    // Near the normal t changes with sin θ, in which an ulp of cos θ is 1e-8.
                    let below = (cos * (1.0 - 1e-15)).max(view.floor());
                    let [back, below] = [cos, below].map(|x| view.coordinate(x));
                    let near = (back - t).abs() <= 1e-14 + 2.0 * (back - below);
                    assert!(near, "sigma {sigma}, gamma {gamma}, {t}: {back}");
                }
                let alone = ViewBlend::BAKED.of_shape(gamma).prepare_shaped(sigma);
                assert_eq!(alone.coordinate(0.4), view.coordinate(0.4));
            }
        }
    }

    #[test]
    fn views_below_the_first_stand_with_it() {
        let view = ViewBlend::BAKED.prepare(0.3, 2.0);
        assert_eq!([0.0, 1e-7].map(|cos| view.clamped(cos)), [0.0; 2]);
        assert!((f64::from(view.clamped(0.4)) - view.coordinate(f64::from(0.4_f32))).abs() < 1e-7);
    }
}
