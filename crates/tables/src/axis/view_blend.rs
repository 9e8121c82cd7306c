//! The view axis of albedo tables. Its spacing is defined in this file alone; baking, readers,
//! certificates, examples and the description in every file follow it.
//!
//! `cargo run --release -p microfacet-study -- albedo_design` measures the reasons for this
//! spacing.

use serde::{Deserialize, Serialize};
use wide::f32x4;

use microfacet_core::math::{sqrt, sqrt64};

use super::coordinate::{Coordinate, bisect, positive};
use super::lagrange::{MIDDLE, SIX, SixLanes, six_lanes};

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

    /// The coordinate as lookups in a table of `nodes` views take it, for a blend of one shape
    /// ([`of_shape`](Self::of_shape)).
    pub fn fast(&self, nodes: usize) -> FastBlend {
        let Self { weight, normal, share, scale, spread, floor, slope, .. } = *self;
        let single = |lanes: [f64; 4]| f32x4::from(lanes.map(|x| x as f32));
        let rest = 1.0 - weight - normal;
        FastBlend {
            quotients: single([weight, 0.0, normal, 0.0]),
            roots: single([rest * share, rest * (1.0 - share), 0.0, 0.0]),
            knee: scale as f32,
            turn: spread as f32,
            floor: [floor, slope].map(|x| x as f32),
            cells: (nodes - 1) as f32,
            last: (nodes - SIX) as f32,
        }
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
#[inline]
pub(super) fn terms(cos: f64, knee: f64) -> (f64, f64, f64) {
    let sin = sqrt64((1.0 - cos) * (1.0 + cos));
    (sin, cos / (cos + knee * sin), cos / (1.0 + sin))
}

/// share·x^¼ + (1−share)·h^¼.
#[inline]
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

    #[inline]
    fn y(&self, cos: f64) -> f64 {
        let ViewBlend { weight, normal, share, .. } = self.blend;
        let (sin, x, h) = terms(cos, self.knee);
        weight * x
            + normal * self.turn / (self.turn + sin)
            + (1.0 - weight - normal) * fourth_roots(share, x, h)
    }

    /// t of cos θ ∈ [μ₀, 1].
    #[inline]
    pub fn coordinate(&self, cos: f64) -> f64 {
        (self.y(cos) - self.start) / (1.0 - self.start)
    }

    /// t of any cos θ ∈ [0, 1]; a view with cos θ < μ₀ is taken at the first node.
    #[inline]
    pub fn clamped(&self, cos: f32) -> f32 {
        if cos > self.floor as f32 { self.coordinate(f64::from(cos)) as f32 } else { 0.0 }
    }

    /// cos θ of t ∈ [0, 1].
    pub fn quantity(&self, t: f64) -> f64 {
        if t >= 1.0 { 1.0 } else { bisect(self.floor, 1.0, t, |cos| self.coordinate(cos)) }
    }
}

/// [`ViewBlend`] of one shape and of a table with some number of views, as lookups take it: in
/// single precision and in lanes, of x, h, ν/(ν + sin θ) and 1.
#[derive(Clone, Copy, Debug)]
pub struct FastBlend {
    /// Shares of the lanes, and of their fourth roots.
    quotients: f32x4,
    roots: f32x4,
    /// κ and ν/σ.
    knee: f32,
    turn: f32,
    /// The largest μ₀, and μ₀/σ as σ → 0.
    floor: [f32; 2],
    /// The number of nodes less one, and less six.
    cells: f32,
    last: f32,
}

impl FastBlend {
    /// Prepares the coordinate for a roughness σ > 0.
    #[inline]
    #[must_use]
    pub fn prepare(&self, sigma: f32) -> FastView {
        let [most, slope] = [self.floor[0], self.floor[1] * sigma];
        // Not 0 where σ is tiny, for which a lane would be 0/0 at the horizon or the normal.
        let [knee, turn] = [self.knee, self.turn].map(|x| x * sigma + f32::MIN_POSITIVE);
        let mut view = FastView {
            quotients: self.quotients,
            roots: self.roots,
            constants: f32x4::from([0.0, 1.0, turn, 1.0]),
            sines: f32x4::from([knee, 1.0, 1.0, 0.0]),
            floor: most * (slope / (most + slope + f32::MIN_POSITIVE)),
            scale: 0.0,
            shift: 0.0,
            last: self.last,
        };
        let start = view.y(view.floor);
        view.scale = self.cells / (1.0 - start);
        view.shift = -start * view.scale - MIDDLE;
        view
    }
}

/// [`FastBlend`] prepared for one roughness: [`PreparedView`] in single precision.
///
/// t errs by less than 1e-7 + 2e-7 t: most next to the normal, where albedos are level.
#[derive(Clone, Copy, Debug)]
pub struct FastView {
    /// Shares of the lanes, and of their fourth roots.
    quotients: f32x4,
    roots: f32x4,
    /// What the denominators hold beside cos θ: constants, and factors of sin θ.
    constants: f32x4,
    sines: f32x4,
    floor: f32,
    /// From y to the place among the nodes. Were the shares multiplied, a lookup would wait for all
    /// that prepares it.
    scale: f32,
    shift: f32,
    /// The first node of the last six.
    last: f32,
}

impl FastView {
    /// μ₀, the view of the first node.
    #[inline]
    #[must_use]
    pub fn floor(&self) -> f32 {
        self.floor
    }

    /// The first of the six nodes about cos θ ∈ [μ₀, 1], and their weights.
    #[inline(always)]
    #[must_use]
    pub fn six(&self, cos: f32) -> (usize, SixLanes) {
        six_lanes(self.position(cos), self.last)
    }

    /// The place among the nodes, less [`MIDDLE`].
    #[inline(always)]
    fn position(&self, cos: f32) -> f32 {
        self.y(cos) * self.scale + self.shift
    }

    #[inline(always)]
    fn y(&self, cos: f32) -> f32 {
        let sin = sqrt((1.0 - cos) * (1.0 + cos));
        let [x, both, others] =
            [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]].map(f32x4::from);
        let over = both * cos + others * self.constants;
        let lanes = over / ((x * cos + self.constants) + self.sines * sin);
        let sum = lanes * self.quotients + lanes.sqrt().sqrt() * self.roots;
        let [x, h, normal, _] = sum.to_array();
        (x + h) + normal
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

    #[test]
    fn lookups_read_the_same_coordinate() {
        const NODES: usize = 33;
        for gamma in [1.501, 1.6, 2.0, f64::INFINITY] {
            let blend = ViewBlend::BAKED.of_shape(gamma);
            for sigma in [1e-30_f32, 1e-8, 1e-5, 1e-3, 0.03, 0.3, 1.0, 3.0] {
                let exact = blend.prepare_shaped(sigma.into());
                let fast = blend.fast(NODES).prepare(sigma);
                let floor = fast.floor();
                assert!((f64::from(floor) / exact.floor() - 1.0).abs() < 3e-7);
                let even = (0..=2000).map(|i| i as f32 / 2000.0);
                let powers = (0..=2000).map(|i| 0.99_f32.powi(i));
                let normal = (0..=2000).map(|i| 1.0 - i as f32 * f32::EPSILON / 2.0);
                for cos in even.chain(powers).chain(normal).chain([floor]) {
                    let cos = cos.max(floor);
                    let place = f64::from(fast.position(cos)) + f64::from(MIDDLE);
                    let t = exact.coordinate(cos.into());
                    let off = place / (NODES - 1) as f64 - t;
                    // Most next to the normal, where albedos are level.
                    assert!(off.abs() < 1e-7 + 2e-7 * t, "{gamma} {sigma} {cos}: {off}");
                    let (start, [low, high]) = fast.six(cos);
                    let weights = [low, high].map(|lanes| lanes.to_array().map(f64::from));
                    // Of the place of each node.
                    let of = |lanes: [f64; 4], first: usize| -> f64 {
                        (start + first..).zip(lanes).map(|(i, weight)| weight * i as f64).sum()
                    };
                    let read = of(weights[0], 0) + of(weights[1], 2);
                    assert!((read - place).abs() < 2e-5, "sigma {sigma}, {cos}: {read}, {place}");
                }
                assert_eq!(fast.six(floor).0, 0);
                assert_eq!(fast.six(1.0).0, NODES - SIX);
            }
        }
    }
}
