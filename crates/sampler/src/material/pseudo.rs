//! Pseudo-visible normals, without tables: normals of D brought to the viewer's side.
//!
//! The mathematics is that of `pseudo.rs` in the model: the length of the slope has a closed
//! inverse CDF, and the CDF of its azimuth from the viewer is Kepler's equation, of eccentricity
//! r/z with r the slope and z the cotangent of the view in unit space. Two steps of an iteration
//! solve it to the rounding of single precision.

use core::f32::consts::{LN_2, PI};

use glam::Vec3;

use microfacet_core::math::{sqrt, unit};
use microfacet_core::saturated;

use super::distribution::MicrofacetDistribution;
use super::horizon::{above_horizon, face};
use super::surface::{Shape, Stretched, Surface};
use crate::elementary::{log2_growth, quarter_turn, scaled_expm1_over};
use crate::vector::vec3;

/// The smallest 1 − u₀: keeps a normal off the horizon, where its length may vanish, and a slope
/// finite.
pub(super) const LAST: f32 = 1.0 / 16_777_216.0;

/// Eccentricities beyond this one differ by less than the rounding of a random number.
const FLATTEST: f32 = 1e8;

/// Normals of D brought to the viewer's side, *pseudo-visible normals*, and their density.
///
/// A normal of D whose slope towards the viewer, x, is steeper than the view's cotangent z, both in
/// units of σ, is put on the viewer's side, and another with probability (1 + |x|/z)/2. What is
/// drawn has a density in closed form, needs neither tables nor G1, and is a visible normal with
/// probability G1(v): visible normals are G1 of pseudo-visible ones and 1 − G1 of others, which are
/// steeper towards the viewer (Ribardière et al. 2017, section 5, name the procedure,
/// <https://doi.org/10.1111/cgf.13137>; `docs/formulas.md` has the equations).
///
/// A light reflected off such a normal has the weight f·cos θ_l/pdf, without Fresnel,
///
/// ```text
/// G2(v, l) max(1, (v·m)/(2 (v·n)(m·n)))
/// ```
///
/// which must be formed like this: the quotient overflows near the horizon. It is at most G1(v)
/// where v·m ≤ 2 (v·n)(m·n), and elsewhere up to G1(v)/(v·n)², where that of a [visible
/// normal](MicrofacetDistribution::sample_visible_normal) is G2/G1 ≤ 1: prefer those where tables
/// are at hand. For γ near 3/2, though, many visible normals reflect below the horizon, and the
/// weights of these vary less except next to grazing.
///
/// ```
/// use microfacet_sampler::lobe::PseudoVisible;
/// use microfacet_sampler::{Ggx, Masking, MicrofacetDistribution};
///
/// let (ggx, v) = (Ggx::new(0.3)?, [0.6, 0.0, 0.8]);
/// let m = ggx.sample_pseudo_visible_normal(v, [0.3, 0.7]);
/// let facing = v[0] * m[0] + v[1] * m[1] + v[2] * m[2];
/// let l: [f32; 3] = core::array::from_fn(|i| 2.0 * facing * m[i] - v[i]);
/// if l[2] > 0.0 {
///     let g2 = ggx.g2(v, l, Masking::HeightCorrelated);
///     let weight = g2 * (facing / (2.0 * v[2] * m[2])).max(1.0);
///     let pdf = ggx.pseudo_visible_normal_pdf(v, m) / (4.0 * facing);
///     let f = ggx.d(m) * g2 / (4.0 * v[2] * l[2]);
///     assert!((f * l[2] / pdf - weight).abs() < 1e-5);
/// }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
pub trait PseudoVisible: MicrofacetDistribution {
    /// A pseudo-visible normal, from two numbers in [0, 1] (clamped to them, NaN to 0).
    ///
    /// The length of the slope in units of σ rises with `u[0]`; `u[1]` turns it once round from the
    /// direction away from the viewer, so that stratified numbers give stratified normals. A view
    /// below the horizon is moved to the horizon. The normal has unit length to 4 ulp, lies above
    /// the horizon, and faces the view to rounding.
    #[must_use]
    fn sample_pseudo_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3];

    /// The density of pseudo-visible normals, D(m) min((v·m)⁺/(v·n), 2 m·n).
    ///
    /// 0 where `m` faces away or lies below the horizon, and finite for every view; one below the
    /// horizon counts as on it. The density of reflected lights is this over 4 v·m.
    #[must_use]
    #[inline]
    fn pseudo_visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (above(vec3(v)), vec3(m));
        let (facing, twice) = (v.dot(m), 2.0 * m.z);
        if !(facing > 0.0 && m.z > 0.0) {
            return 0.0;
        }
        let factor = if facing < twice * v.z { facing / v.z } else { twice };
        saturated(factor * self.d(m))
    }
}

impl<S: Shape> PseudoVisible for Surface<S> {
    #[inline(always)]
    fn sample_pseudo_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        let r = slope_radius(self.shape.s(), u[0]);
        normal(self.scales.sigma, vec3(v), r, u[1]).to_array()
    }
}

/// A view, moved to the horizon where it is below.
#[inline(always)]
fn above(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, v.z.max(0.0))
}

/// The unit slope r at which P(R > r) = 1 − u: r² = ((1−u)^(−s) − 1)/s.
#[inline(always)]
fn slope_radius(s: f32, u: f32) -> f32 {
    let u = unit(u);
    // ln 1/(1−u), with the digits of small u.
    let log = LN_2 * log2_growth((1.0 - u).max(LAST), u);
    sqrt(scaled_expm1_over(s, log, 1.0))
}

/// The normal of a unit slope of length r, at the number u of its azimuth, for a lobe of `sigma`.
#[inline(always)]
pub(super) fn normal([sx, sy]: [f32; 2], v: Vec3, r: f32, u: f32) -> Vec3 {
    let v = above(v);
    let at = Stretched::new([sx * v.x, sy * v.y, v.z]);
    let e = r * at.rho / at.z.max(f32::MIN_POSITIVE);
    let [x, y] = azimuth(e.min(FLATTEST), unit(u)).map(|slope| r * slope);
    let m = Vec3::new(x * at.x - y * at.y, x * at.y + y * at.x, at.frame);
    face(above_horizon(Vec3::new(sx * m.x, sy * m.y, m.z)), v)
}

/// The cosine, towards the viewer, and the sine of the azimuth at which the CDF of
/// min((1 + e cos φ)⁺, 2)/2π, from φ = −π to π, is u.
#[inline(always)]
fn azimuth(e: f32, u: f32) -> [f32; 2] {
    /// Leaves 4e-8 of a turn.
    const STEPS: usize = 2;
    /// Half an angle, in turns.
    const HALF: f32 = 0.25 / PI;
    let side = if u < 0.5 { -1.0 } else { 1.0 };
    let short = u.min(1.0 - u);
    let [sin, cos] = quarter_turn(0.5 * short);
    if e * sin >= 1.0 {
        return [sin, side * cos];
    }
    let number = 2.0 * PI * short;
    let (a, g) = (e.min(1.0), sqrt((e - 1.0).max(0.0) * (e + 1.0)));
    let (b, h) = (1.0 - a, g + 0.25 * a);
    let first = 2.0 * number / (b + sqrt(b * b + 2.0 * h * number)).max(f32::MIN_POSITIVE);
    let mut epsilon = first.min((number + a * PI) / (1.0 + a));
    for _ in 0..STEPS {
        let [half_sin, half_cos] = quarter_turn(HALF * epsilon);
        let (sin, versine) = (2.0 * half_sin * half_cos, 2.0 * half_sin * half_sin);
        let excess = epsilon - a * sin + g * versine - number;
        let rise = b + a * versine + g * sin;
        let bend = a * sin + g * (1.0 - versine);
        let root = sqrt((4.0 * rise * rise - 6.0 * excess * bend).abs());
        let step = 3.0 * excess / (rise + root).max(f32::MIN_POSITIVE);
        epsilon = (epsilon - step).clamp(0.0, PI);
    }
    let [half_sin, half_cos] = quarter_turn(HALF * epsilon);
    let (sin, versine) = (2.0 * half_sin * half_cos, 2.0 * half_sin * half_sin);
    let cos_0 = (1.0 / e).min(1.0);
    let sin_0 = sqrt((1.0 - cos_0) * (1.0 + cos_0));
    let cos = 1.0 - versine;
    [sin_0 * sin - cos_0 * cos, side * (sin_0 * cos + cos_0 * sin)]
}
