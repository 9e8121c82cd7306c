//! Samplers of Student-t normals without tables, which take as many random numbers as they need.

use glam::Vec3;

use super::beckmann;
use super::elementary::turn;
use super::form::IntegerGamma;
use super::lobe::Lobe;
use crate::inputs::Stream;

/// A Student-t with γ = 4, whose masking is a short sum.
pub(crate) struct Drawer {
    sigma: f32,
    /// 1/σ.
    steepness: f32,
    masking: Lobe<IntegerGamma<3>>,
    /// √(γ−1) Γ(γ−3/2)/Γ(γ−1), the mean of τ^(−½) over precisions τ; over 2√π, so that with ρ it is
    /// ρ E[x⁺].
    grazing: f32,
}

const GAMMA: f32 = 4.0;

/// E[x⁺] of a unit Beckmann, ½/√π.
const HALF: f32 = 0.282_094_8;

impl Drawer {
    pub(crate) fn new(sigma: f64) -> Self {
        let gamma = f64::from(GAMMA);
        let mean = (gamma - 1.0).sqrt() * libm::tgamma(gamma - 1.5) / libm::tgamma(gamma - 1.0);
        Self {
            sigma: sigma as f32,
            steepness: (1.0 / sigma) as f32,
            masking: Lobe::four(sigma),
            grazing: HALF * mean as f32,
        }
    }

    /// A normal distributed as D(m)(m·n), whatever the view (Ribardière et al. 2017,
    /// doi:10.1111/cgf.13137, eq. 16–17).
    #[inline(always)]
    pub(crate) fn ndf(&self, u: [f32; 2]) -> Vec3 {
        let [sin, cos] = turn(u[1]);
        let square = self.sigma * self.sigma * square(u[0]);
        let z = 1.0 / (1.0 + square).sqrt();
        let r = square.sqrt() * z;
        Vec3::new(r * cos, r * sin, z)
    }

    /// A visible normal: with probability G1 a normal of the NDF turned to the viewer, else one of
    /// the excess beyond the silhouette.
    #[inline(always)]
    pub(crate) fn exact(&self, v: Vec3, stream: &mut Stream) -> Vec3 {
        let horizontal = (v.x * v.x + v.y * v.y).sqrt();
        let inverse = 1.0 / horizontal;
        let (cos, sin) = if horizontal > 0.0 { (v.x * inverse, v.y * inverse) } else { (1.0, 0.0) };
        let z = v.z * inverse * self.steepness;
        let slopes = if stream.next() < self.masking.g1(v) {
            let [sin, cos] = turn(stream.next());
            let r = square(stream.next()).sqrt();
            let x = (r * cos).abs();
            // Kept with probability ½(1 + x/z), which is above 1 beyond the silhouette.
            let keeps = (2.0 * stream.next() - 1.0) * z < x;
            [if keeps { x } else { -x }, r * sin]
        } else {
            excess(z, stream)
        };
        beckmann::normal(self.sigma, [cos, sin], slopes)
    }

    /// A visible normal of one of the Beckmanns whose mixture is Student-t: precision τ ∼
    /// Gamma(γ−1), roughness σ/√τ.
    ///
    /// Exact for every view if the precision is drawn in proportion to the projected area,
    /// z(1 + Λ). That is at most z + ρ E[x⁺], whose two terms have Gamma-distributed precisions,
    /// and at least half of it, so that fewer than two tries are needed on average.
    #[inline(always)]
    pub(crate) fn mixture(&self, v: Vec3, stream: &mut Stream) -> Vec3 {
        let horizontal = (v.x * v.x + v.y * v.y).sqrt();
        let inverse = 1.0 / horizontal.max(1e-9);
        let (cos, sin) = if horizontal > 0.0 { (v.x * inverse, v.y * inverse) } else { (1.0, 0.0) };
        let rho = self.sigma * horizontal;
        let (cot, half) = (v.z * inverse * self.steepness, HALF * rho);
        let all = v.z + self.grazing * rho;
        let (root, [erf, gauss]) = loop {
            // √τ; its inverse scales the slopes.
            let root =
                (precision(stream.next() * all >= v.z, stream) * (1.0 / (GAMMA - 1.0))).sqrt();
            let [erf, gauss] = beckmann::erf(cot * root);
            // Both sides are multiplied by √τ.
            let z = v.z * root;
            if stream.next() * (z + half) <= 0.5 * z * (1.0 + erf) + half * gauss {
                break (root, [erf, gauss]);
            }
        };
        let [away, across] =
            beckmann::slopes_of(cot * root, [erf, gauss], [stream.next(), stream.next()]);
        beckmann::normal(self.sigma / root, [cos, sin], [-away, across])
    }
}

/// The square of the radius of a unit slope: r² = (γ−1)((1−u)^(−1/(γ−1)) − 1).
#[inline(always)]
fn square(u: f32) -> f32 {
    (GAMMA - 1.0) * ((1.0 - u).powf(-1.0 / (GAMMA - 1.0)) - 1.0).max(0.0)
}

/// Unit slopes with x > z of density ∝ (x − z) p(x).
#[inline(always)]
fn excess(z: f32, stream: &mut Stream) -> [f32; 2] {
    let root = (GAMMA - 1.0).sqrt();
    let a = z * (1.0 / root);
    let x = loop {
        let grow = (1.0 - stream.next()).powf(-1.0 / (GAMMA - 1.5));
        let x = ((1.0 + a * a) * grow - 1.0).max(0.0).sqrt();
        if stream.next() * x >= a {
            break x;
        }
    };
    let square = ((1.0 - stream.next()).powf(1.0 / (0.5 - GAMMA)) - 1.0).max(0.0);
    let y = ((1.0 + x * x) * square).sqrt() * turn(stream.next())[1];
    [root * x, root * y]
}

/// A Gamma-distributed number of shape γ−1 = 3, or `less` by ½, and scale 1: exponentials, and half
/// the square of a normal.
#[inline(always)]
fn precision(less: bool, stream: &mut Stream) -> f32 {
    let mut next = || 1.0 - stream.next();
    let two = next() * next();
    if less {
        let cos = turn(next())[1];
        return -two.ln() - next().ln() * cos * cos;
    }
    -(two * next()).ln()
}
