//! Moments of Fresnel weights: a few of them give the albedo of every Schlick reflectance and of
//! OpenPBR's metals.

use microfacet_core::Masking;
use microfacet_core::schlick::{F82_AVERAGE, SCHLICK_AVERAGE, f82_dip, f82_weight, schlick_weight};

/// Moments of a Fresnel reflectance F(v·m) over the visible normals whose reflections leave the
/// surface, weighted by shadowing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Moments {
    /// The moment of 1 − (1−v·m)⁵.
    pub scale: f32,
    /// The moment of (1−v·m)⁵.
    pub bias: f32,
    /// The moment of the F82 tint's μ(1−μ)⁶ at μ = v·m, divided by its peak at μ = 1/7.
    pub f82: f32,
}

impl Moments {
    /// The directional albedo E with F = 1: scale + bias.
    #[must_use]
    pub fn total(&self) -> f32 {
        self.scale + self.bias
    }

    /// Albedo of Schlick's reflectance F0 + (F90 − F0)(1−μ)⁵.
    #[must_use]
    pub fn schlick(&self, f0: f32, f90: f32) -> f32 {
        f0 * self.scale + f90 * self.bias
    }

    /// Albedo of OpenPBR's metal: Schlick's reflectance with F90 = 1 and a tint, in [0, 1], of the
    /// reflectance at μ = 1/7 (Kutz, Hašan & Edmondson 2021,
    /// *Novel aspects of the Adobe Standard Material*, eq. 2–5); tint = 1 is Schlick's.
    #[must_use]
    pub fn f82_tint(&self, f0: f32, tint: f32) -> f32 {
        self.schlick(f0, 1.0) - f82_dip(f0, tint) * self.f82
    }

    /// Moments of a perfect mirror seen at cos θ.
    pub(super) fn mirror(cos_theta: f32) -> Self {
        let bias = schlick_weight(cos_theta);
        Self { scale: 1.0 - bias, bias, f82: f82_weight(cos_theta) }
    }

    pub(super) fn mirror_average() -> Self {
        Self {
            scale: (1.0 - SCHLICK_AVERAGE) as f32,
            bias: SCHLICK_AVERAGE as f32,
            f82: F82_AVERAGE as f32,
        }
    }

    /// The moments from the stored channels and those of a mirror, `self`.
    pub(super) fn plus(self, [e, bias, f82]: [f32; 3]) -> Self {
        // Interpolation and 16-bit rounding may leave [0, 1] and [0, E] by the table's error; a
        // negative E is taken as 0.
        let e = (1.0 + e).max(0.0);
        let bias = (bias + e * self.bias).clamp(0.0, e);
        Self { scale: e - bias, bias, f82: (f82 + e * self.f82).clamp(0.0, 1.0) }
    }
}

/// Turns the channels at cos θ into whole moments: E − 1, bias and F82.
fn whole(cos: f32, [e, bias, f82]: [f32; 3]) -> [f32; 3] {
    let mirror = Moments::mirror(cos);
    [e, bias + (1.0 + e) * mirror.bias, f82 + (1.0 + e) * mirror.f82]
}

/// The channels at cos θ < `floor`, the first view of a table, from those at `floor` and four times
/// it.
///
/// Towards grazing every moment M approaches its limit with one power p of the cosine,
/// M(μ) = M(μ₀) + (M(μ₀) − M(4μ₀)) (1 − (μ/μ₀)^p)/(4^p − 1). For uncorrelated masking p is 1. With
/// height-correlated masking 1 − E falls, for an untilted lobe to 0: p is the power of 1 − E, or 0,
/// which holds everything constant, if 1 − E does not fall.
fn below(masking: Masking, floor: f32, cos: f32, first: [f32; 3], above: [f32; 3]) -> [f32; 3] {
    let power = match masking {
        Masking::Uncorrelated => 1.0,
        // NaN fails the comparison, too, and everything is held constant.
        Masking::HeightCorrelated if above[0] / first[0] > 1.0 => {
            (0.5 * libm::log2f(above[0] / first[0])).min(1.0)
        }
        Masking::HeightCorrelated => 0.0,
    };
    let (first, above) = (whole(floor, first), whole(4.0 * floor, above));
    let more = if power > 0.0 {
        -libm::expm1f(power * libm::logf(cos / floor))
            / libm::expm1f(power * 2.0 * core::f32::consts::LN_2)
    } else {
        0.0
    };
    let moved: [f32; 3] = core::array::from_fn(|i| first[i] + more * (first[i] - above[i]));
    let e = moved[0].clamp(-1.0, 0.0);
    let mirror = Moments::mirror(cos);
    [e, moved[1] - (1.0 + e) * mirror.bias, moved[2] - (1.0 + e) * mirror.f82]
}

/// The channels at any cos θ: those of `at` from `floor` on, the first view of a table, and
/// [`below`] it.
pub(super) fn down_to_grazing(
    masking: Masking,
    floor: f32,
    cos: f32,
    at: impl Fn(f32) -> [f32; 3],
) -> [f32; 3] {
    let here = at(cos);
    // A mirror has E = 1 down to grazing.
    if cos >= floor || here[0] == 0.0 {
        return here;
    }
    below(masking, floor, cos, here, at(4.0 * floor))
}

/// What is averaged over views, from the channels at a view: the excess of whole moments over those
/// of a mirror, and whether E is clamped.
pub(super) fn averaged(cos: f32, rest: [f32; 3]) -> ([f64; 3], u32) {
    let (mirror, e) = (Moments::mirror(cos), rest[0]);
    let moments = mirror.plus(rest);
    let less = [e, moments.bias - mirror.bias, moments.f82 - mirror.f82];
    (less.map(f64::from), u32::from(e == 0.0) + 2 * u32::from(e == -1.0))
}

/// Turns averages of whole moments into the tables' channels.
pub(super) fn less_mirror([e, bias, f82]: [f64; 3]) -> [f32; 3] {
    let mirror = Moments::mirror_average();
    [e, bias - e * f64::from(mirror.bias), f82 - e * f64::from(mirror.f82)].map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_albedo_of_nothing_is_no_panic() {
        // 16-bit rounding may turn E = 0 into these channels.
        let moments = Moments::mirror(0.4).plus([-1.000_003, 1e-6, -1e-6]);
        assert_eq!([moments.scale, moments.bias, moments.f82], [0.0; 3]);
    }
}
