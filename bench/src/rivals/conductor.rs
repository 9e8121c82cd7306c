//! A rough conductor of GGX, γ = 2, as renderers write it: visible normals by spherical caps, D, G1
//! and height-correlated G2 in closed form.
//!
//! With Λ's root L = √(cos²θ + σ² sin²θ) of view and light, G1(v) = 2 v·n/(v·n + L_v) and
//! G2 = 2 (v·n)(l·n)/(l·n L_v + v·n L_l), so that every quotient of them is one division (Heitz
//! 2014, <https://jcgt.org/published/0003/02/03/>; Lagarde & de Rousiers 2014, *Moving Frostbite to
//! PBR*). The half vector is not normalised.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::ggx::single::caps;

/// The conductor, with the reflectance of its facets by the cosine v·m.
pub(crate) struct GgxConductor<F> {
    sigma: f32,
    inverse_sigma: f32,
    /// 1/(2πσ²).
    scale: f32,
    fresnel: F,
}

impl<F: Fn(f32) -> [f32; 3]> GgxConductor<F> {
    pub(crate) fn new(sigma: f32, fresnel: F) -> Self {
        let scale = 0.5 * FRAC_1_PI / (sigma * sigma);
        Self { sigma, inverse_sigma: 1.0 / sigma, scale, fresnel }
    }

    /// √(cos²θ + σ² sin²θ).
    #[inline(always)]
    fn root(&self, w: Vec3) -> f32 {
        let (x, y) = (self.sigma * w.x, self.sigma * w.y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// z² + (x² + y²)/σ².
    #[inline(always)]
    fn spread(&self, m: Vec3) -> f32 {
        let (x, y) = (self.inverse_sigma * m.x, self.inverse_sigma * m.y);
        x * x + y * y + m.z * m.z
    }

    /// A light, f cos/pdf and the density; `None` where the light is below the horizon.
    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Option<(Vec3, [f32; 3], f32)> {
        if !(v.z > 0.0) {
            return None;
        }
        let m = caps(self.sigma, v, u);
        let facing = v.dot(m);
        let l = 2.0 * facing * m - v;
        if !(l.z > 0.0) {
            return None;
        }
        let (of_v, of_l, spread) = (self.root(v), self.root(l), self.spread(m));
        let area = v.z + of_v;
        let pdf = self.scale / (spread * spread * area);
        let weight = l.z * area / (l.z * of_v + v.z * of_l);
        Some((l, (self.fresnel)(facing).map(|f| f * weight), pdf))
    }

    /// f, without the cosine, and the density of a light.
    #[inline(always)]
    pub(crate) fn eval_pdf(&self, v: Vec3, l: Vec3) -> ([f32; 3], f32) {
        if !(v.z > 0.0 && l.z > 0.0) {
            return ([0.0; 3], 0.0);
        }
        let m = v + l;
        let square = m.dot(m);
        let peak = square / self.spread(m);
        let d = self.scale * peak * peak;
        let (of_v, of_l) = (self.root(v), self.root(l));
        let f = d / (l.z * of_v + v.z * of_l);
        // The cosine is half the length: v·m = 1 + v·l = |m|²/2.
        ((self.fresnel)(0.5 * square.sqrt()).map(|fresnel| fresnel * f), d / (v.z + of_v))
    }
}

#[cfg(test)]
mod tests {
    use microfacet_core::schlick::schlick;
    use microfacet_sampler::{Bsdf, BsdfSettings, Conductor, ConductorFresnel, Ggx, Transport};

    use super::*;
    use crate::inputs::Inputs;

    #[test]
    fn it_is_the_conductor_of_the_sampler_crate() {
        let (sigma, f0) = (0.5, [0.9, 0.7, 0.3]);
        let rival = GgxConductor::new(sigma, |cos| f0.map(|f0| schlick(f0, 1.0, cos)));
        let fresnel = ConductorFresnel::schlick(f0).unwrap();
        let ggx = Ggx::new(f64::from(sigma)).unwrap();
        let ours = Conductor::new(ggx, fresnel, BsdfSettings::new()).unwrap();
        let (inputs, lights) = (Inputs::new(1, 500), Inputs::new(2, 500));
        let close = |a: f32, b: f32| (a - b).abs() <= 2e-5 * b.abs();
        let check = |v: Vec3, l: Vec3| {
            let (f, pdf) = rival.eval_pdf(v, l);
            let (want, density) = ours.eval_pdf(v, l, Transport::Radiance);
            assert!(close(pdf, density), "{v} {l}: {pdf} for {density}");
            assert!((0..3).all(|i| close(f[i], want[i])), "{v} {l}: {f:?} for {want:?}");
            (f, pdf)
        };
        let mut drawn = 0;
        for ((v, u), l) in inputs.views.iter().zip(&inputs.numbers).zip(&lights.views) {
            check(*v, *l);
            let Some((l, weight, pdf)) = rival.sample(*v, *u) else { continue };
            // Next to the horizon rounding of the light decides its cosine.
            if l.z > 0.01 {
                let (f, density) = check(*v, l);
                assert!((pdf / density - 1.0).abs() < 1e-4, "{v} {l}: {pdf} for {density}");
                let want = f.map(|f| f * l.z / density);
                assert!((0..3).all(|i| (weight[i] - want[i]).abs() < 1e-4), "{v} {l}: {weight:?}");
                drawn += 1;
            }
        }
        assert!(drawn > 300);
    }
}
