//! Axes of tables: what runs along them, where their nodes are, and how a table is read between the nodes.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::error::LoadError;

/// How a physical quantity becomes the coordinate along an axis. The mapping is data in the file; readers need no other
/// knowledge of it than these formulas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Mapping {
    /// The quantity itself.
    Identity,
    /// s = 1/(γ−1) ∈ [0, 2): 0 is Beckmann, 1 is GGX.
    InverseShape,
    /// τ = z/(1 + √(1+z²)) ∈ [0, 1], z = cot θ_v / σ_v: the tangent of half the elevation in unit space. 0 is grazing, 1 normal
    /// incidence (or σ → 0).
    HalfTangent,
    /// r = 1 − √(1−τ) ∈ [0, 1]: τ with its nodes crowded towards normal incidence.
    HalfTangentRoot,
    /// q = z/(z + κ) ∈ [0, 1] with κ = scale/(pole − s), z as above.
    Rational {
        /// Numerator of κ.
        scale: f64,
        /// Where κ diverges, in s.
        pole: f64,
    },
    /// r = 1 − √(1−q) ∈ [0, 1]: q of [`Rational`](Self::Rational) with its nodes crowded towards normal incidence.
    RationalRoot {
        /// Numerator of κ.
        scale: f64,
        /// Where κ diverges, in s.
        pole: f64,
    },
    /// t = ln(1 + scale/(2γ−3)) ≥ 0: 0 is Beckmann, and γ → 3/2, where the projected area diverges, is reached slowly.
    LogShape {
        /// Factor of 1/(2γ−3).
        scale: f64,
    },
    /// t = ln(1 + σ/offset) + slow·ln(σ/first) + linear·σ ≥ 0 for σ ≥ first: even ratios about the offset, wide ones far below it,
    /// where only a heavy tail still makes a difference, and finer steps where σ is large.
    Roughness {
        /// The σ about which the first term turns from even steps into even ratios.
        offset: f64,
        /// Where t vanishes (but for first/offset); a surface smoother than this is a mirror.
        first: f64,
        /// Weight of ln(σ/first).
        slow: f64,
        /// Weight of σ.
        linear: f64,
    },
    /// t = (y(μ) − y(μ₀))/(1 − y(μ₀)) ∈ [0, 1] for μ = cos θ_v ≥ μ₀ = floor·slope·σ/(floor + slope·σ), where
    /// y = weight·x + normal·ν/(ν + √(1−μ²)) + (1 − weight − normal)(share·x^¼ + (1−share)·h^¼),
    /// x = μ/(μ + κσ√(1−μ²)), κ = scale + heavy/(2γ−3), h = μ/(1 + √(1−μ²)), ν = spread·σ.
    ///
    /// h follows the view; x follows z = cot θ_v/σ and, as γ → 3/2, the ever wider reach of masking; ν resolves the turn at normal
    /// incidence, and the fourth roots grazing views.
    ViewBlend {
        /// Share of x itself.
        weight: f64,
        /// Share of the term with ν.
        normal: f64,
        /// Share of x among the fourth roots, in [0, 1].
        share: f64,
        /// κ for Beckmann.
        scale: f64,
        /// How κ grows with 1/(2γ−3).
        heavy: f64,
        /// ν/σ.
        spread: f64,
        /// Largest μ₀.
        floor: f64,
        /// μ₀/σ of smooth surfaces.
        slope: f64,
    },
    /// t ∈ [0, 1] for the view from the dense side of an interface of index η, with ½ at μ_c = √(1 − 1/η²), where total reflection
    /// sets in; a polynomial reads nodes of one half alone. With p = share·x + (1−share)·h, y = share·x^¼ + (1−share)·h^¼ (x, h, κ as for
    /// [`ViewBlend`](Self::ViewBlend)), S(q) = asinh(√q/δ)/asinh(1/δ), δ² = kink·σ, and μ₀ the harmonic sum
    /// 1/(1/floor + 1/(slope·σ) + 1/μ_c):
    /// t = ½ (1−root)(y(μ)−y(μ₀))/(y(μ_c)−y(μ₀)) + ½ root (1 − S((μ_c−μ)/(μ_c−μ₀))) for μ₀ ≤ μ < μ_c, and
    /// t = ½ + ½ (1−root)(p(μ)−p(μ_c))/(1−p(μ_c)) + ½ root S((μ−μ_c)/(1−μ_c)) for μ ≥ μ_c.
    CriticalBlend {
        /// Share of x among the fourth roots, in [0, 1].
        share: f64,
        /// κ for Beckmann.
        scale: f64,
        /// How κ grows with 1/(2γ−3).
        heavy: f64,
        /// Largest μ₀.
        floor: f64,
        /// μ₀/σ of smooth surfaces.
        slope: f64,
        /// Share of S, in (0, 1).
        root: f64,
        /// δ²/σ.
        kink: f64,
    },
    /// t = acos(1 − 2x)/π ∈ [0, 1], x = F0^¼ = √((η−1)/(η+1)), of an index η ∈ [1, ∞] of the dense side: finer towards both ends, where
    /// the reflectance of grazing views turns within √(η²−1) and 1/η of the horizon.
    ReflectanceRoot,
    /// The azimuth φ of a view (radians, from the x axis), by p = atan2(√σ₂ sin(φ − turn), √σ₁ cos(φ − turn)): t = p/2π modulo one, with
    /// nodes 0, 1/n, …, (n−1)/n; or where `fold`, with |sin| and |cos|, t = 2p/π ∈ [0, 1], with nodes 0, 1/(n−1), …, 1. One node stands
    /// for every azimuth.
    ///
    /// σ_φ² = σ₁² cos²(φ − turn) + σ₂² sin²(φ − turn) is the square of the roughness seen from there, which takes the place of σ in
    /// [`ViewBlend`](Self::ViewBlend).
    Azimuth {
        /// σ₁ and σ₂ along the principal axes.
        sigma: [f64; 2],
        /// Azimuth of the first, radians.
        turn: f64,
        /// Whether what is tabulated is the same on both sides of either principal axis.
        fold: bool,
    },
    /// t = (2 min(u, 1−u))^(1/power) ∈ [0, 1]. Along the axis stand first the nodes for u ≤ ½ (t ascending from u = 0), then as many
    /// for u > ½ (t ascending from u = 1), unless the axis is `odd`, when only the second half is stored.
    MirroredPower {
        /// 1, 2 or 4.
        power: u32,
        /// Whether the value at u is minus the value at 1−u, so that one half is enough.
        odd: bool,
    },
}

/// How values between nodes are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubic Hermite from the channels `value` and `slope`, the slope being the derivative with respect to the node index.
    Hermite,
    /// The Lagrange polynomial through the four nearest nodes (fewer if the axis has fewer).
    Lagrange4,
    /// The polynomial through the six nearest nodes, evenly spaced in the coordinate (fewer if the axis has fewer).
    Lagrange6,
    /// None: only the nodes themselves are covered.
    Nodes,
}

/// One axis of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Short name, such as `gamma`, `view` or `u1`.
    pub name: String,
    /// Unit of the physical quantity; `1` for pure numbers.
    pub unit: String,
    /// From quantity to coordinate.
    pub mapping: Mapping,
    /// How values between nodes are made.
    pub interpolation: Interpolation,
    /// Node coordinates, ascending. Values sit at the nodes (not at cell centres).
    pub nodes: Vec<f64>,
}

impl Axis {
    /// How many values stand along this axis.
    pub fn len(&self) -> usize {
        match self.mapping {
            Mapping::MirroredPower { odd: false, .. } => 2 * self.nodes.len(),
            _ => self.nodes.len(),
        }
    }

    /// Whether it has no nodes; never true for an axis that was validated.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Nodes 0, 1/(n−1), …, 1.
    pub fn uniform_nodes(n: usize) -> Vec<f64> {
        (0..n).map(|i| i as f64 / (n - 1) as f64).collect()
    }

    /// Whether the nodes are spread evenly between the first and the last.
    fn is_even(&self) -> bool {
        let (first, last) = (self.nodes[0], self.nodes[self.nodes.len() - 1]);
        let step = (last - first) / (self.nodes.len().max(2) - 1) as f64;
        let off = |(i, x): (usize, &f64)| (x - first - i as f64 * step).abs() > 1e-9 * step;
        !self.nodes.iter().enumerate().any(off)
    }

    /// Checks what every reader relies on: finite, strictly ascending nodes inside the mapping's range, and uniform ones where the
    /// lookup computes its cell instead of searching it.
    pub(crate) fn validate(&self) -> Result<(), LoadError> {
        let fail = |why: &str| Err(LoadError::Invalid(format!("axis `{}`: {why}", self.name)));
        if self.nodes.is_empty() {
            return fail("no nodes");
        }
        if self.nodes.iter().any(|x| !x.is_finite()) {
            return fail("a node is not finite");
        }
        if self.nodes.windows(2).any(|pair| pair[0] >= pair[1]) {
            return fail("nodes do not ascend");
        }
        let (low, high) = match self.mapping {
            Mapping::Identity => (f64::MIN, f64::MAX),
            Mapping::InverseShape => (0.0, 2.0 - f64::EPSILON),
            Mapping::LogShape { .. } | Mapping::Roughness { .. } => (0.0, f64::MAX),
            _ => (0.0, 1.0),
        };
        if self.nodes[0] < low || self.nodes[self.nodes.len() - 1] > high {
            return fail("a node lies outside the range of its mapping");
        }
        match self.mapping {
            Mapping::MirroredPower { power, .. } if ![1, 2, 4].contains(&power) => {
                return Err(LoadError::Unsupported(format!(
                    "axis `{}`: power {power} is not 1, 2 or 4",
                    self.name
                )));
            }
            Mapping::Rational { scale, pole } | Mapping::RationalRoot { scale, pole }
                if !(scale > 0.0 && scale < 1e6 && (2.0..=1e6).contains(&pole)) =>
            {
                return fail("scale or pole out of range");
            }
            Mapping::LogShape { scale } if !(scale > 0.0 && scale < 1e6) => {
                return fail("scale out of range");
            }
            Mapping::Roughness { offset, first, slow, linear }
                if !([offset, first, slow].iter().all(|&x| x > 0.0 && x < 1e6)
                    && (0.0..1e6).contains(&linear)) =>
            {
                return fail("offset, first, slow or linear out of range");
            }
            Mapping::ViewBlend { weight, normal, share, scale, heavy, spread, floor, slope }
                if !([weight, normal, scale, spread, floor, slope].iter().all(|&x| x > 0.0 && x < 1e6)
                    && weight + normal < 1.0
                    && (0.0..=1.0).contains(&share)
                    && (0.0..1e6).contains(&heavy)
                    && floor < 0.5) =>
            {
                return fail("a parameter of the view coordinate is out of range");
            }
            Mapping::CriticalBlend { share, scale, heavy, floor, slope, root, kink }
                if !([scale, floor, slope, kink].iter().all(|&x| x > 0.0 && x < 1e6)
                    && (0.0..=1.0).contains(&share)
                    && (0.0..1e6).contains(&heavy)
                    && root > 0.0
                    && root < 1.0
                    && floor < 0.5) =>
            {
                return fail("a parameter of the view coordinate is out of range");
            }
            Mapping::Azimuth { sigma, turn, .. }
                if !(sigma.iter().all(|x| (1e-12..=1e6).contains(x)) && turn.abs() <= 7.0) =>
            {
                return fail("sigma or turn out of range");
            }
            _ => {}
        }
        // These are looked up by computing the cell; the others by searching it.
        if self.interpolation == Interpolation::Lagrange6 && !self.is_even() {
            return Err(LoadError::Unsupported(format!(
                "axis `{}`: this interpolation needs evenly spaced nodes",
                self.name
            )));
        }
        let searched = matches!(self.mapping, Mapping::Identity | Mapping::InverseShape);
        let free = matches!(
            self.mapping,
            Mapping::LogShape { .. } | Mapping::Roughness { .. } | Mapping::ReflectanceRoot
        );
        if let Mapping::Azimuth { fold, .. } = self.mapping {
            return self.validate_azimuths(fold);
        }
        if !searched && !free {
            let n = self.nodes.len();
            if n < 2 {
                return fail("needs at least two nodes");
            }
            let off = |(i, x): (usize, &f64)| (x - i as f64 / (n - 1) as f64).abs() > 1e-12;
            if self.nodes.iter().enumerate().any(off) {
                return Err(LoadError::Unsupported(format!(
                    "axis `{}`: this mapping needs nodes spread evenly over [0, 1]",
                    self.name
                )));
            }
        }
        Ok(())
    }

    fn validate_azimuths(&self, fold: bool) -> Result<(), LoadError> {
        let n = self.nodes.len();
        let steps = if fold && n > 1 { n - 1 } else { n };
        let off = |(i, x): (usize, &f64)| (x - i as f64 / steps as f64).abs() > 1e-12;
        if self.nodes.iter().enumerate().any(off) {
            let why = format!(
                "axis `{}`: azimuths must be spread evenly over the circle or its quarter",
                self.name
            );
            return Err(LoadError::Unsupported(why));
        }
        Ok(())
    }
}
