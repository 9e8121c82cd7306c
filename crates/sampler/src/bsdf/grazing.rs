//! The density from which light of further bounces is drawn where nothing is tabulated for it: the
//! cosine, and a share towards grazing, where a smooth surface loses its light.

use core::f32::consts::LN_2;

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use wide::f32x4;

use crate::elementary::{exp2, log2, turn};

/// The share that is drawn by the plain cosine, so that no weight exceeds twenty times that of the
/// cosine.
const PLAIN: f32 = 0.05;

/// A density over the hemisphere above, per steradian: a factor times cos θ/π, for most of the
/// lights in proportion to 1/(x + c²) with x = cos² θ, in which the cosine-weighted measure is
/// uniform. A surface loses its light within c of the horizon, and beyond about as (c/cos θ)².
#[derive(Clone, Copy, Debug)]
pub(super) struct Grazing {
    /// c².
    square: f32,
    /// The octaves between c² and 1 + c².
    octaves: f32,
    /// What makes the density one in total.
    scale: f32,
}

impl Grazing {
    pub(super) fn new(c: f32) -> Self {
        // With more than 1 the density is about that of the cosine.
        let c = c.clamp(1e-9, 1.0);
        let square = c * c;
        let octaves = log2(f32x4::splat(1.0 + 1.0 / square)).to_array()[0];
        Self { square, octaves, scale: (1.0 - PLAIN) / (LN_2 * octaves) }
    }

    /// A direction above the horizon from two numbers in [0, 1] (clamped to them, NaN to 0).
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let [u, azimuth] = u.map(unit);
        let x = if u < PLAIN {
            u / PLAIN
        } else {
            let within = (u - PLAIN) / (1.0 - PLAIN);
            let ratio = exp2(f32x4::splat(within * self.octaves)).to_array()[0];
            unit(self.square * (ratio - 1.0))
        };
        let (r, [sin, cos]) = (sqrt(1.0 - x), turn(azimuth));
        Vec3::new(r * cos, r * sin, sqrt(x))
    }

    /// The density over that of the cosine.
    #[inline(always)]
    pub(super) fn factor(&self, l: Vec3) -> f32 {
        PLAIN + self.scale / (l.z * l.z + self.square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_have_the_density() {
        for c in [1e-8, 0.003, 0.2, 1.0, 7.0] {
            let grazing = Grazing::new(c);
            let n = 200_000;
            let mut counts = [0_u32; 20];
            // Even steps of the fourth root of the cosine.
            let bin = |cos: f32| ((20.0 * sqrt(sqrt(cos))) as usize).min(19);
            for i in 0..n {
                let u = (i as f32 + 0.5) / n as f32;
                let l = grazing.sample([u, (0.618_034 * i as f64).fract() as f32]);
                assert!((l.length() - 1.0).abs() < 1e-6 && l.z >= 0.0);
                counts[bin(l.z)] += 1;
            }
            for (i, count) in counts.into_iter().enumerate() {
                // 2 ∫ factor μ dμ, with μ = r⁴.
                let of = |j: i32| {
                    let r = (i as f64 + (f64::from(j) + 0.5) / 4000.0) / 20.0;
                    let factor = grazing.factor(Vec3::new(0.0, 0.0, (r * r * r * r) as f32));
                    8.0 * r.powi(7) * f64::from(factor) / 80_000.0
                };
                let (want, got) = ((0..4000).map(of).sum::<f64>(), f64::from(count) / f64::from(n));
                // Of the first bin, a part in ten of which is the layer of c = 1e-8.
                let tolerance = if c < 1e-6 && i == 0 { 0.05 } else { 1e-4 };
                assert!((got - want).abs() < tolerance, "{c} {i}: {got} for {want}");
            }
        }
    }

    #[test]
    fn ends_are_directions() {
        let grazing = Grazing::new(0.01);
        for u in [[0.0, 0.0], [1.0, 1.0], [PLAIN, 0.5], [f32::NAN, 0.3], [-1.0, 2.0]] {
            let l = grazing.sample(u);
            assert!((l.length() - 1.0).abs() < 1e-6 && l.z >= 0.0, "{u:?}: {l}");
        }
        assert!(grazing.sample([1.0, 0.0]).z > 0.999);
        assert!(Grazing::new(f32::NAN).factor(Vec3::Z).is_nan());
    }
}
