//! Differences from the crate's family.

use std::collections::BTreeMap;

use glam::Vec3;

use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::albedo::Moments;
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};

use super::{At, FamilyLimits, Hit};
use crate::compare::SMALLEST;

/// Differences by quantity, as shares of what is allowed.
pub(super) struct Seen<'a> {
    limits: &'a FamilyLimits,
    worst: BTreeMap<&'static str, (f64, f64, String)>,
}

impl<'a> Seen<'a> {
    pub(super) fn new(limits: &'a FamilyLimits) -> Self {
        Self { limits, worst: BTreeMap::new() }
    }

    fn see(&mut self, name: &'static str, difference: f64, allowed: f64, hit: &Hit) {
        let share = if difference.is_nan() { f64::INFINITY } else { difference / allowed };
        let entry = self.worst.entry(name).or_default();
        if share > entry.0 || entry.2.is_empty() {
            *entry = (share, difference, format!("{hit:?}"));
        }
    }

    fn holds(&mut self, name: &'static str, holds: bool, hit: &Hit) {
        self.see(name, if holds { 0.0 } else { f64::INFINITY }, 1.0, hit);
    }

    /// Prints them, and returns whether all are allowed.
    pub(super) fn print(&self) -> bool {
        for (name, (share, difference, hit)) in &self.worst {
            let verdict = if *share <= 1.0 { "" } else { "  TOO FAR" };
            println!("  {name:20} {difference:.1e}, {share:.2} of what is allowed{verdict}; {hit}");
        }
        self.worst.values().all(|(share, ..)| *share <= 1.0)
    }

    pub(super) fn compare(&mut self, hits: &[Hit], all: &[At]) {
        let limits = self.limits;
        let seen = self;
        let tables = Tables::embedded();
        let family = tables.family().unwrap();
        let albedos = Masking::ALL.map(|masking| tables.family_albedo(masking).unwrap());
        for (i, (hit, at)) in hits.iter().zip(all).enumerate() {
            let &Hit { sigma, v, l, m, u, .. } = hit;
            let all = [v, l, m];
            let is_odd = all.as_flattened().iter().any(|x| x.is_nan());
            let scalars = [at.d, at.pdf, at.reflection_pdf, at.g1];
            let finite = scalars.iter().chain(&at.normal).chain(&at.f).chain(&at.f_pdf);
            seen.holds("numbers", finite.clone().all(|x| x.is_finite()) && at.lambda >= 0.0, hit);
            let shares = [at.g2, at.weight, at.albedo, at.average];
            let parts = [at.parts, at.average_parts];
            let shares = shares.as_flattened().iter().chain(parts.as_flattened().as_flattened());
            seen.holds("ranges", shares.clone().all(|x| (0.0..=1.0).contains(x)), hit);
            seen.holds("normal above", at.normal[2] > 0.0, hit);
            if is_odd {
                continue;
            }
            let lobe = family.at(sigma, hit.gamma);
            let gamma = lobe.gamma().min(f32::MAX.into()) as f32;
            seen.see("gamma", f64::from(at.gamma / gamma - 1.0).abs(), 2e-7, hit);
            let far = |a: f32, b: f32| (f64::from(a) - f64::from(b)).abs();
            seen.see("g1", far(at.g1, lobe.g1(v)), limits.share, hit);
            let smooth = f32::from(u8::from(lobe.is_effectively_smooth()));
            // The limit is met to rounding.
            let other = |factor: f32| family.at(lobe.sigma().map(|x| x * factor), hit.gamma);
            let near = [0.999, 1.001].map(|factor| other(factor).is_effectively_smooth());
            seen.holds("smooth", at.is_smooth == smooth || near[0] != near[1], hit);
            if i % 16 == 0 && v[2] > 0.0 {
                let model =
                    microfacet_model::StudentT::new(lobe.sigma().map(f64::from), lobe.gamma());
                let exact = model.unwrap().g1(v.map(f64::from).into());
                seen.see("g1 of the model", (f64::from(at.g1) - exact).abs(), limits.exact, hit);
            }
            let relative = |got: f32, want: f32| {
                let tiny = f64::from(got.max(want)) < SMALLEST;
                if tiny { 0.0 } else { (f64::from(got) / f64::from(want) - 1.0).abs() }
            };
            let log = (f64::from(lobe.d(m)).max(1e-38) * f64::from(sigma[0] * sigma[1])).ln().abs();
            let allowed =
                if log.is_finite() { limits.density[0] + limits.density[1] * log } else { 1e-3 };
            seen.see("d", relative(at.d, lobe.d(m)), allowed, hit);
            // An area is that of G1, whose absolute error counts most at grazing views.
            let area = allowed + limits.share / f64::from(lobe.g1(v)).max(1e-6);
            // Densities are products with D, which has few digits, or none, where it is subnormal.
            let has_digits = |m: Vec3| f64::from(lobe.d(m)) >= SMALLEST;
            if m[2] <= 0.0 || has_digits(m.into()) {
                seen.see("pdf", relative(at.pdf, lobe.visible_normal_pdf(v, m)), area, hit);
            }
            let both = Vec3::from(v) + Vec3::from(l);
            let below = !(v[2] > 0.0 && l[2] > 0.0);
            let has_digits = has_digits(both.normalize_or_zero());
            for (k, masking) in Masking::ALL.into_iter().enumerate() {
                seen.see("g2", far(at.g2[k], lobe.g2(v, l, masking)), limits.share, hit);
                let weight = lobe.reflection_weight(v, l, masking);
                seen.see("weight", far(at.weight[k], weight), 3.0 * limits.share, hit);
                let (f, pdf) = lobe.eval_pdf(v, l, masking);
                let log = (f64::from(pdf).max(1e-38) * f64::from(sigma[0] * sigma[1])).ln().abs();
                let allowed = if log.is_finite() { area + limits.density[1] * log } else { 1e-3 };
                if has_digits || below {
                    seen.see("density of eval", relative(at.f_pdf[k], pdf), allowed, hit);
                }
                if has_digits && (1e-30..1e30).contains(&f) && weight > 1e-3 {
                    let allowed = allowed + 3.0 * limits.share / f64::from(weight);
                    seen.see("f of eval", relative(at.f[k], f), allowed, hit);
                }
                let [x, y] = sigma;
                if !(x > 0.0 && y > 0.0) {
                    seen.holds("mirror", at.albedo[k] == 1.0 && at.average[k] == 1.0, hit);
                    continue;
                }
                let [x, y] = lobe.sigma();
                let albedo = albedos[k].at((x * y).sqrt(), hit.gamma);
                let moments = |Moments { scale, bias, f82, .. }| [scale, bias, f82];
                seen.see("albedo", far(at.albedo[k], albedo.albedo(v)), limits.albedo, hit);
                seen.see(
                    "average",
                    far(at.average[k], albedo.albedo_average()),
                    limits.albedo,
                    hit,
                );
                for (got, want) in [
                    (at.parts[k], moments(albedo.moments(v))),
                    (at.average_parts[k], moments(albedo.average_moments())),
                ] {
                    for (got, want) in got.into_iter().zip(want) {
                        seen.see("moments", far(got, want), limits.moment, hit);
                    }
                }
            }
            seen.normal(hit, at, |u| lobe.sample_visible_normal(v, u), lobe.gamma(), u);
        }
    }

    /// A normal lies between those of the crate at numbers to either side of its own.
    fn normal(
        &mut self,
        hit: &Hit,
        at: &At,
        of: impl Fn([f32; 2]) -> [f32; 3],
        gamma: f64,
        u: [f32; 2],
    ) {
        let limits = self.limits;
        // Where rounding of the view or of a horizon does not decide.
        let plain = hit.sigma.iter().all(|sigma| (1e-3..=10.0).contains(sigma));
        let inside = u.iter().all(|u| (0.0..=1.0).contains(u));
        if !(plain && inside && hit.v[2] > 1e-3 && hit.v[2] < 0.999_99 && at.normal[2] > 1e-6) {
            return;
        }
        let s = 1.0 / (gamma - 1.0);
        let (got, length) = slopes(hit, s, at.normal);
        for axis in 0..2 {
            let with = |number: f32| {
                let mut u = u;
                u[axis] = number.clamp(0.0, 1.0);
                slopes(hit, s, of(u)).0[axis]
            };
            let ends = [u[axis] - limits.number, u[axis] + limits.number];
            let [low, high] = ends.map(with);
            // The parts of the distribution of a small gamma are one above the other, not in order.
            let within = with(u[axis]);
            if !(low <= within && within <= high) {
                continue;
            }
            // No number is beyond 0 and 1, and so no end to what is next to them.
            let low = if ends[0] > 0.0 { low } else { f64::NEG_INFINITY };
            let high = if ends[1] < 1.0 { high } else { f64::INFINITY };
            let outside = (low - got[axis]).max(got[axis] - high).max(0.0);
            // Coordinates of normals have single precision, and so has a slope beside a much larger
            // one, which strong anisotropy turns.
            let [x, y] = hit.sigma.map(f64::from);
            let allowed = limits.slope * (x / y).max(y / x) * (1.0 + length);
            self.see(["normal, along", "normal, across"][axis], outside, allowed, hit);
        }
    }
}

/// The slopes of a normal along the azimuth of a stretched view and across it, over what the slope
/// along makes of it: each follows one random number alone. And the length of both.
fn slopes(hit: &Hit, s: f64, [x, y, z]: [f32; 3]) -> ([f64; 2], f64) {
    let [sx, sy] = hit.sigma.map(f64::from);
    let [vx, vy] = [f64::from(hit.v[0]) * sx, f64::from(hit.v[1]) * sy];
    let length = vx.hypot(vy);
    let [x, y] = [f64::from(x) / sx, f64::from(y) / sy].map(|x| x / f64::from(z));
    let [cos, sin] = if length > 0.0 { [vx / length, vy / length] } else { [1.0, 0.0] };
    let (along, across) = (x * cos + y * sin, y * cos - x * sin);
    ([along, across / (1.0 + s * along * along).sqrt()], along.hypot(across))
}
