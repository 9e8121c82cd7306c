//! Moments of Fresnel weights: from a few of them, the albedo of every Schlick reflectance and of OpenPBR's metals.

use microfacet_common::gauss_legendre;
use microfacet_common::schlick::{F82_AVERAGE, SCHLICK_AVERAGE, f82_dip, f82_weight, schlick_weight};

/// Moments of one Fresnel reflectance F(v·m) over the visible normals whose reflections leave the surface, weighted by shadowing.
///
/// They make the albedo of every Schlick reflectance, and of OpenPBR's metals, from one table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Of 1 − (1−v·m)⁵.
    pub scale: f32,
    /// Of (1−v·m)⁵.
    pub bias: f32,
    /// Of the F82 tint's μ(1−μ)⁶, divided by its peak at μ = 1/7.
    pub f82: f32,
}

impl Moments {
    /// E with F = 1: scale + bias.
    pub fn total(&self) -> f32 {
        self.scale + self.bias
    }

    /// Albedo of Schlick's reflectance F0 + (F90 − F0)(1−μ)⁵.
    pub fn schlick(&self, f0: f32, f90: f32) -> f32 {
        f0 * self.scale + f90 * self.bias
    }

    /// Albedo of OpenPBR's metal: Schlick with F90 = 1 and the tint, in [0, 1], of its reflectance at μ = 1/7 (Kutz, Hašan & Edmondson
    /// 2021, eq. 2–5); tint = 1 is Schlick.
    pub fn f82_tint(&self, f0: f32, tint: f32) -> f32 {
        self.schlick(f0, 1.0) - f82_dip(f0, tint) * self.f82
    }

    /// Moments of a perfect mirror seen at cos θ.
    pub(super) fn mirror(cos_theta: f32) -> Self {
        let bias = schlick_weight(cos_theta);
        Self { scale: 1.0 - bias, bias, f82: f82_weight(cos_theta) }
    }

    /// 2 ∫ μ dμ of a mirror's moments.
    pub(super) fn mirror_average() -> Self {
        Self { scale: (1.0 - SCHLICK_AVERAGE) as f32, bias: SCHLICK_AVERAGE as f32, f82: F82_AVERAGE as f32 }
    }

    /// From what is stored, `self` being the mirror's.
    pub(super) fn plus(self, [e, bias, f82]: [f32; 3]) -> Self {
        // Interpolation and 16-bit rounding may leave [0, 1] and [0, E] by the table's error; below 0 there is no [0, E].
        let e = (1.0 + e).max(0.0);
        let bias = (bias + e * self.bias).clamp(0.0, e);
        Self { scale: e - bias, bias, f82: (f82 + e * self.f82).clamp(0.0, 1.0) }
    }
}

/// 2 ∫ μ dμ of E − 1 and of the whole moments, from what is stored as a function of cos θ, which is resolved down to `floor`.
pub(super) fn over_views(floor: f64, rest: impl Fn(f32) -> [f32; 3]) -> [f64; 3] {
    // In y = −ln h with h = tan(½ elevation), μ = 2h/(1+h²): even in the angle near normal incidence, and in its logarithm where
    // views graze and small roughness makes its difference. Views below the table's first weigh nothing.
    const RULE: [(f64, f64); 4] = gauss_legendre();
    const WIDTH: f64 = 0.35;
    let panels = libm::ceil(libm::log(2.0 / floor) / WIDTH) as usize;
    let mut sum = [0.0_f64; 3];
    for panel in 0..panels {
        for (node, weight) in RULE {
            let h = libm::exp(-WIDTH * (panel as f64 + node));
            let cos = 2.0 * h / (1.0 + h * h);
            // 2 μ dμ, with dμ/dy = μ (1−h²)/(1+h²).
            let measure = 2.0 * WIDTH * weight * cos * cos * (1.0 - h * h) / (1.0 + h * h);
            let [e, bias, f82] = rest(cos as f32).map(f64::from);
            let mirror = Moments::mirror(cos as f32);
            sum[0] += measure * e;
            sum[1] += measure * (bias + e * f64::from(mirror.bias));
            sum[2] += measure * (f82 + e * f64::from(mirror.f82));
        }
    }
    sum
}

/// Channels below the first view of a table, where E − 1 is `share` of what it is there: the mixture of the other moments stays.
pub(super) fn fade([e, bias, f82]: [f32; 3], share: f32) -> [f32; 3] {
    let less = e * share;
    let more = (1.0 + less) / (1.0 + e).max(1e-6);
    [less, bias * more, f82 * more]
}

/// Averages of whole moments in the form of the tables' channels.
pub(super) fn less_mirror([e, bias, f82]: [f64; 3]) -> [f32; 3] {
    let mirror = Moments::mirror_average();
    [e, bias - e * f64::from(mirror.bias), f82 - e * f64::from(mirror.f82)].map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_albedo_of_nothing_is_no_panic() {
        // What 16-bit rounding makes of E = 0.
        let moments = Moments::mirror(0.4).plus([-1.000_003, 1e-6, -1e-6]);
        assert_eq!([moments.scale, moments.bias, moments.f82], [0.0; 3]);
    }
}
