//! The view axis of albedos seen from inside a dielectric: two halves that meet where total
//! reflection sets in, so that no polynomial crosses that kink, wherever the index of refraction
//! puts it.

use serde::{Deserialize, Serialize};

use microfacet_core::math::sqrt64;

use super::coordinate::{Coordinate, bisect, positive};
use super::lagrange::{SIX, six};
use super::view_blend::{fourth_roots, harmonic, kappa, terms};

/// The view coordinate of the dense side of an interface of index η, t ∈ [0, 1].
///
/// t = ½ at μ_c = √(1 − 1/η²), where total reflection sets in; a polynomial reads nodes of one half
/// only. With x, h and κ as for [`ViewBlend`](super::ViewBlend), p = share·x + (1−share)·h,
/// y = share·x^¼ + (1−share)·h^¼, S(q) = asinh(√q/δ)/asinh(1/δ), δ² = kink·σ, and the harmonic sum
/// μ₀ = 1/(1/floor + 1/(slope·σ) + 1/μ_c):
/// t = ½ (1−root)(y(μ)−y(μ₀))/(y(μ_c)−y(μ₀)) + ½ root (1 − S((μ_c−μ)/(μ_c−μ₀))) for μ₀ ≤ μ < μ_c,
/// t = ½ + ½ (1−root)(p(μ)−p(μ_c))/(1−p(μ_c)) + ½ root S((μ−μ_c)/(1−μ_c)) for μ ≥ μ_c.
///
/// For μ ≥ μ_c there are no fourth roots, which are steep in η near 1: with them tables over all
/// indices erred by 0.12 instead of 1e-3 (σ 0.454, γ 3, twenty indices).
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
    /// δ²/σ.
    pub kink: f64,
}

impl CriticalBlend {
    /// The parameters of baked tables, found by measuring.
    pub const BAKED: Self =
        Self { share: 0.4, scale: 3.0, heavy: 0.5, floor: 2e-5, slope: 2e-3, root: 0.5, kink: 1.0 };

    /// Prepares the coordinate for σ > 0, γ and an index η ≥ 1 of the dense side, given as 1/η.
    pub fn prepare(&self, sigma: f64, gamma: f64, inverse_eta: f64) -> PreparedCritical {
        let critical = sqrt64((1.0 - inverse_eta) * (1.0 + inverse_eta));
        let floor = harmonic(harmonic(self.floor, self.slope * sigma), critical);
        let kink = sqrt64(self.kink * sigma);
        let mut view = PreparedCritical {
            blend: *self,
            knee: kappa(self.scale, self.heavy, gamma) * sigma,
            kink,
            range: libm::asinh(1.0 / kink),
            floor,
            critical,
            start: 0.0,
            middle: 0.0,
            second: 0.0,
        };
        [view.start, view.middle] = [floor, critical].map(|cos| view.y(cos));
        view.second = view.p(critical);
        view
    }
}

/// [`CriticalBlend`] prepared for one material and index of refraction.
#[derive(Clone, Copy, Debug)]
pub struct PreparedCritical {
    blend: CriticalBlend,
    /// κσ.
    knee: f64,
    /// δ and asinh(1/δ).
    kink: f64,
    range: f64,
    /// μ₀ and y(μ₀).
    floor: f64,
    start: f64,
    /// μ_c, y(μ_c) and p(μ_c).
    critical: f64,
    middle: f64,
    second: f64,
}

impl PreparedCritical {
    /// μ₀, the view of the first node.
    pub fn floor(&self) -> f64 {
        self.floor
    }

    /// μ_c, the view of t = ½.
    pub fn critical(&self) -> f64 {
        self.critical
    }

    fn y(&self, cos: f64) -> f64 {
        let (_, x, h) = terms(cos, self.knee);
        fourth_roots(self.blend.share, x, h)
    }

    fn p(&self, cos: f64) -> f64 {
        let (_, x, h) = terms(cos, self.knee);
        self.blend.share * x + (1.0 - self.blend.share) * h
    }

    /// S of a number in [0, 1].
    fn near(&self, share: f64) -> f64 {
        libm::asinh(sqrt64(share.max(0.0)) / self.kink) / self.range
    }

    /// The coordinate of cos θ within its half, in [0, 1].
    fn half(&self, cos: f64) -> f64 {
        // A half without width is a single point.
        let part = |a: f64, b: f64, whole: f64| if whole > 0.0 { (a - b) / whole } else { 0.0 };
        let (smooth, near) = if cos < self.critical {
            let rest = part(self.critical, cos, self.critical - self.floor);
            (part(self.y(cos), self.start, self.middle - self.start), 1.0 - self.near(rest))
        } else {
            let rest = part(cos, self.critical, 1.0 - self.critical);
            (part(self.p(cos), self.second, 1.0 - self.second), self.near(rest))
        };
        (1.0 - self.blend.root) * smooth + self.blend.root * near
    }

    /// t of cos θ ∈ [μ₀, 1].
    pub fn coordinate(&self, cos: f64) -> f64 {
        0.5 * self.half(cos) + if cos < self.critical { 0.0 } else { 0.5 }
    }

    /// The first of the six nodes about cos θ ∈ [0, 1], all in one half, and their weights; `n`
    /// nodes, an odd number, are spread evenly.
    pub fn six(&self, cos: f64, n: usize) -> (usize, [f32; SIX]) {
        let half = n / 2 + 1;
        let cos = cos.max(self.floor);
        let (start, weights) = six(self.half(cos) as f32, half);
        (if cos < self.critical { start } else { start + half - 1 }, weights)
    }

    /// cos θ of t ∈ [0, 1].
    pub fn quantity(&self, t: f64) -> f64 {
        let (low, high, t) = if t < 0.5 {
            (self.floor, self.critical, 2.0 * t)
        } else {
            (self.critical, 1.0, 2.0 * t - 1.0)
        };
        // μ_c itself belongs to the upper half, and the lower half ends just before it.
        bisect(low, high, t, |cos| if cos < high { self.half(cos) } else { f64::INFINITY })
    }
}

impl Coordinate for CriticalBlend {
    fn formula(&self) -> &'static str {
        "below μ_c = √(1−1/η²) t = ½ (1−root) (y(μ)−y(μ₀))/(y(μ_c)−y(μ₀)) + ½ root (1 − S((μ_c−μ)/(μ_c−μ₀))), \
         above t = ½ + ½ (1−root) (p(μ)−p(μ_c))/(1−p(μ_c)) + ½ root S((μ−μ_c)/(1−μ_c)); y = share·x^¼ + \
         (1−share)·h^¼, p = share·x + (1−share)·h, S(q) = asinh(√q/δ)/asinh(1/δ), δ = √(kink·σ), μ₀ = \
         1/(1/floor + 1/(slope·σ) + 1/μ_c), x, h and κ of view_blend"
    }

    fn check(&self) -> Result<(), &'static str> {
        let Self { share, scale, heavy, floor, slope, root, kink } = *self;
        let sound = positive(&[scale, floor, slope, kink])
            && (0.0..=1.0).contains(&share)
            && (0.0..1e6).contains(&heavy)
            && root > 0.0
            && root < 1.0
            && floor < 0.5;
        if sound { Ok(()) } else { Err("a parameter of the view coordinate is out of range") }
    }

    fn check_count(&self, n: usize) -> Result<(), &'static str> {
        if n < 2 * SIX - 1 || n.is_multiple_of(2) {
            Err("needs an odd number of nodes, eleven or more: six in either half")
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for eta in [1.0001, 1.5, 4.0] {
            for (sigma, gamma) in [(1e-6, 2.0), (0.3, 1.501), (2.0, f64::INFINITY)] {
                let view = CriticalBlend::BAKED.prepare(sigma, gamma, 1.0 / eta);
                assert_eq!(view.coordinate(1.0), 1.0);
                for t in [0.0, 0.1, 0.4, 0.5, 0.6, 0.9, 1.0] {
                    let cos = view.quantity(t);
                    let ulp = (view.coordinate(cos.min(1.0))
                        - view.coordinate(cos * (1.0 - 1e-15)))
                    .abs();
                    let back = view.coordinate(cos);
                    assert!(
                        (back - t).abs() < 1e-12 + 2.0 * ulp,
                        "eta {eta}, sigma {sigma}, {t}: {back}"
                    );
                }
            }
        }
    }

    #[test]
    fn halves_do_not_share_windows() {
        let view = CriticalBlend::BAKED.prepare(0.3, 2.0, 1.0 / 1.5);
        let critical = sqrt64(1.0 - 1.0 / 2.25);
        assert_eq!(view.six(critical - 1e-9, 21).0, 5);
        assert_eq!(view.six(critical + 1e-9, 21).0, 10);
        // For η = 1 the lower half is a point.
        let none = CriticalBlend::BAKED.prepare(0.3, 2.0, 1.0);
        assert_eq!((none.six(0.0, 21).0, none.quantity(0.0)), (10, 0.0));
    }
}
