//! Fits Cook–Torrance lobes to the measured materials of the MERL database, as figure 11 of
//! Ribardière et al. 2017 (doi:10.1111/cgf.13137) does: of the family, and of two distributions
//! whose tail is free as well.
//!
//! The model of a channel is
//!
//! ```text
//! f(v, l) = ρ/π + F(v·m) D(m) G1(v) G1(l) / (4 v·n l·n),   F(μ) = F0 + (1 − F0)(1 − μ)⁵,
//! ```
//!
//! with one σ and γ for all channels, an albedo ρ ≥ 0 of the Lambert term and a reflectance
//! F0 ∈ [0, 1] for each of red, green and blue, and the paper's uncorrelated masking. The minimised
//! error is
//!
//! ```text
//! Σ |measured − f| cos θ_l / Σ measured cos θ_l
//! ```
//!
//! over the samples of all channels with view and light less than 80° from the normal; samples that
//! were not measured are left out. For given σ and γ the error is convex in ρ and F0, and minimised
//! with a proven bound; σ and γ, or what takes their place, are found by a scan of every sixth of
//! the difference angles and every twelfth of the azimuths, then by searches from the deepest
//! basins of the scan with more samples, and finally with all.
//!
//! Files are read by [`Measured`]; [`MIDDLE`] is the position of values in their cells.

use microfacet_baker::distribution::{DistributionKind, Named};

mod file;
mod geometry;
mod linear;
mod lobe;
mod recipe;
mod samples;
mod search;

pub use file::{BYTES, MIDDLE, Measured, MerlError, encode};
pub use geometry::HalfDifference;
pub use recipe::{names, recipe};
pub use search::Fitter;

/// Views and lights at this angle from the normal, in degrees, or more are left out: measured
/// values are unreliable there.
pub const LIMIT_DEGREES: f64 = 80.0;

/// A fit of one distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The distribution with its parameters.
    pub lobe: Named,
    /// F0 of red, green and blue.
    pub f0: [f64; 3],
    /// The albedo of the Lambert term; where the surface emits or the measurement errs it may be
    /// more than 1.
    pub lambert: [f64; 3],
    /// The minimised error, relative to the measured values.
    pub error: f64,
    /// Parameters found at the end of the range that was searched, beyond which a better value may
    /// lie; empty if none.
    pub ends_at: Vec<&'static str>,
}

impl Fitted {
    /// σ and γ of a member of the family; NaN of another.
    pub fn sigma_gamma(&self) -> [f64; 2] {
        match (self.lobe.kind, &self.lobe.values[..]) {
            (DistributionKind::Beckmann, &[sigma]) => [sigma, f64::INFINITY],
            (DistributionKind::TrowbridgeReitz, &[sigma]) => [sigma, 2.0],
            (DistributionKind::StudentT, &[sigma, gamma]) => [sigma, gamma],
            _ => [f64::NAN; 2],
        }
    }
}

/// The fits of five distributions to one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// γ = ∞.
    pub beckmann: Fitted,
    /// γ = 2.
    pub ggx: Fitted,
    /// σ and γ fitted together; its error is never more than those of Beckmann and GGX.
    pub student_t: Fitted,
    /// The normals of two GGX with one masking: three parameters; its error is never more than that
    /// of GGX.
    pub haze: Fitted,
    /// The distribution of Löw et al. 2012, of two parameters.
    pub abc: Fitted,
}

impl Comparison {
    /// Gains below this share count as none: the distribution of fewer parameters is then as good.
    pub const EQUAL: f64 = 1e-3;
    /// Differences of the error below this, several tolerances of the search, count as none.
    pub const EXACT: f64 = 1e-5;

    /// The error of another fit over that of the Student-t; 1 where they differ by less than
    /// [`EXACT`](Self::EXACT).
    pub fn gain(&self, other: &Fitted) -> f64 {
        let (a, b) = (other.error, self.student_t.error);
        if (a - b).abs() <= Self::EXACT { 1.0 } else { a / b.max(Self::EXACT) }
    }

    /// The better of Beckmann and GGX if it is as good as the Student-t; else the Student-t, unless
    /// `haze` or `abc` are better; of equally good ones that of fewer parameters.
    pub fn best(&self) -> &Fitted {
        let simple = if self.beckmann.error < self.ggx.error { &self.beckmann } else { &self.ggx };
        let as_good = self.gain(simple) <= 1.0 + Self::EQUAL;
        let member = if as_good { simple } else { &self.student_t };
        let mut best = member;
        for other in [&self.abc, &self.haze] {
            let gains = other.error < best.error - Self::EXACT;
            if gains && other.error * (1.0 + Self::EQUAL) < best.error {
                best = other;
            }
        }
        best
    }
}
