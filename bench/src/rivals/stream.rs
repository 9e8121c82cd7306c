//! Samplers of Student-t normals without tables, which take as many random numbers as they need.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::beckmann;
use super::lobe::Lobe;
use super::tail::{ArcSum, Sum};
use crate::inputs::Stream;

/// A Student-t with γ = 4, whose masking is a short sum.
pub(crate) struct Drawer {
    sigma: f32,
    gamma: f32,
    masking: Lobe<Sum<3>, ArcSum<3>>,
    /// √(γ−1) Γ(γ−3/2)/Γ(γ−1), the mean of τ^(−½) over precisions τ.
    mean_deviation: f32,
}

impl Drawer {
    pub(crate) fn new(sigma: f64) -> Self {
        let gamma: f64 = 4.0;
        let mean = (gamma - 1.0).sqrt() * libm::tgamma(gamma - 1.5) / libm::tgamma(gamma - 1.0);
        Self {
            sigma: sigma as f32,
            gamma: gamma as f32,
            masking: Lobe::four(sigma),
            mean_deviation: mean as f32,
        }
    }

    /// A normal distributed as D(m)(m·n), whatever the view (Ribardière et al. 2017, eq. 16–17).
    #[inline(always)]
    pub(crate) fn ndf(&self, u: [f32; 2]) -> Vec3 {
        let (sin, cos) = (TAU * u[1]).sin_cos();
        let r = self.radius(u[0]);
        beckmann::normal(self.sigma, [1.0, 0.0], [r * cos, r * sin])
    }

    /// The radius of a unit slope: r² = (γ−1)((1−u)^(−1/(γ−1)) − 1).
    #[inline(always)]
    fn radius(&self, u: f32) -> f32 {
        let s = 1.0 / (self.gamma - 1.0);
        (((1.0 - u).powf(-s) - 1.0).max(0.0) / s).sqrt()
    }

    /// A visible normal: an NDF's turned to the viewer with probability G1, else one of the excess beyond the silhouette.
    #[inline(always)]
    pub(crate) fn exact(&self, v: Vec3, stream: &mut Stream) -> Vec3 {
        let horizontal = (v.x * v.x + v.y * v.y).sqrt();
        let (cos, sin) = if horizontal > 0.0 { (v.x / horizontal, v.y / horizontal) } else { (1.0, 0.0) };
        let z = v.z / (self.sigma * horizontal);
        let slopes = if stream.next() < self.masking.g1(v) {
            let (sin, cos) = (TAU * stream.next()).sin_cos();
            let r = self.radius(stream.next());
            let x = (r * cos).abs();
            let keeps = x > z || stream.next() < 0.5 * (1.0 + x / z);
            [if keeps { x } else { -x }, r * sin]
        } else {
            self.excess(z, stream)
        };
        beckmann::normal(self.sigma, [cos, sin], slopes)
    }

    /// Unit slopes with x > z of density ∝ (x − z) p(x).
    #[inline(always)]
    fn excess(&self, z: f32, stream: &mut Stream) -> [f32; 2] {
        let root = (self.gamma - 1.0).sqrt();
        let a = z / root;
        let x = loop {
            let grow = (1.0 - stream.next()).powf(-1.0 / (self.gamma - 1.5));
            let x = ((1.0 + a * a) * grow - 1.0).max(0.0).sqrt();
            if stream.next() * x >= a {
                break x;
            }
        };
        let radius = ((1.0 - stream.next()).powf(1.0 / (0.5 - self.gamma)) - 1.0).max(0.0).sqrt();
        let y = (1.0 + x * x).sqrt() * radius * (TAU * stream.next()).cos();
        [root * x, root * y]
    }

    /// A visible normal of one of the Beckmanns that Student-t is a mixture of: precision τ ∼ Gamma(γ−1), σ/√τ.
    ///
    /// Exact for every view if the precision is drawn in proportion to the area seen, z(1 + Λ). That is at most z + ρ E[x⁺], whose two terms
    /// have Gamma-distributed precisions, and at least half of it, so that fewer than two tries are needed.
    #[inline(always)]
    pub(crate) fn mixture(&self, v: Vec3, stream: &mut Stream) -> Vec3 {
        let horizontal = (v.x * v.x + v.y * v.y).sqrt();
        let (cos, sin) = if horizontal > 0.0 { (v.x / horizontal, v.y / horizontal) } else { (1.0, 0.0) };
        let rho = self.sigma * horizontal;
        // E[x⁺] of a unit Beckmann is ½/√π.
        let half = 0.5 / PI.sqrt();
        let grazing = half * rho * self.mean_deviation;
        let deviation = loop {
            let shape = if stream.next() * (v.z + grazing) < v.z { 0.0 } else { 0.5 };
            let precision = gamma(self.gamma - 1.0 - shape, stream) / (self.gamma - 1.0);
            let deviation = 1.0 / precision.sqrt();
            let z = v.z / (rho * deviation);
            let seen = 0.5 * v.z * (1.0 + beckmann::erf(z)) + half * rho * deviation * (-z * z).exp();
            if stream.next() * (v.z + half * rho * deviation) <= seen {
                break deviation;
            }
        };
        let z = v.z / (rho * deviation).max(1e-9);
        let [away, across] = beckmann::slopes(z, [stream.next(), stream.next()]);
        beckmann::normal(self.sigma * deviation, [cos, sin], [-away, across])
    }
}

/// A Gamma-distributed number of shape ≥ 1 and scale 1 (Marsaglia and Tsang 2000, "A Simple Method for Generating Gamma Variables").
#[inline(always)]
fn gamma(shape: f32, stream: &mut Stream) -> f32 {
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    loop {
        let normal = (-2.0 * (1.0 - stream.next()).ln()).sqrt() * (TAU * stream.next()).cos();
        let t = 1.0 + c * normal;
        if t <= 0.0 {
            continue;
        }
        let cubed = t * t * t;
        if (1.0 - stream.next()).ln() < 0.5 * normal * normal + d - d * cubed + d * cubed.ln() {
            return d * cubed;
        }
    }
}
