//! Compares conductors at a hit with the crate's.
//!
//! Headers of one γ hold the exact curve of E. f is that of the crate's [`Conductor`] compensated
//! by that curve. The crate's conductors at a hit draw light of further bounces from a density in
//! closed form, which is written down once more here, in double precision; those conductors
//! themselves, whose E is an approximation, are compared where it is good.

mod points;

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_PI, LN_2, TAU};

use microfacet_sampler::albedo::{Albedo, FamilyAlbedo};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{
    Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Family, Ggx, Lobe, Masking,
    MicrofacetDistribution, Tables, Transport,
};
use points::{Answer, Point, corners, random};

unsafe extern "C" {
    fn c_conductors(shape: usize, count: usize, points: *const Point, answers: *mut Answer);
    fn cpp_conductors(shape: usize, count: usize, points: *const Point, answers: *mut Answer);
}

const MASKINGS: [Masking; 2] = [Masking::Uncorrelated, Masking::HeightCorrelated];
const COMPENSATIONS: [Compensation; 3] =
    [Compensation::None, Compensation::Turquin, Compensation::KullaConty];

/// Compares `count` random points and all corners; prints what differs most, and returns whether
/// all is within what is allowed.
pub fn agree(gammas: &[f64], count: usize) -> bool {
    let tables = Tables::embedded();
    let (family, albedos) =
        (tables.family().unwrap(), MASKINGS.map(|masking| tables.family_albedo(masking).unwrap()));
    let mut worst = Worst::default();
    let mut compared = 0;
    for (shape, &gamma) in gammas.iter().enumerate() {
        let mut groups = random(count.div_ceil(gammas.len()), shape as u64);
        groups.extend(corners());
        for points in groups {
            let one = Surface::new(&tables, &family, &albedos, gamma, points[0].sigma);
            let by =
                [("C", c_conductors as unsafe extern "C" fn(_, _, _, _)), ("C++", cpp_conductors)];
            for (language, function) in by {
                let mut answers = vec![Answer::default(); points.len()];
                // SAFETY: both are of the length passed, and of the layout of `materials.c`.
                unsafe { function(shape, points.len(), points.as_ptr(), answers.as_mut_ptr()) };
                for (point, answer) in points.iter().zip(&answers) {
                    worst.at = format!("{language}, gamma {gamma}, {point:?}");
                    one.compare(point, answer, &mut worst);
                }
            }
            compared += points.len();
        }
    }
    println!("largest differences of conductors at {compared} points, C and C++");
    worst.print()
}

#[derive(Default)]
struct Worst {
    at: String,
    seen: BTreeMap<&'static str, (f64, f64, String)>,
}

impl Worst {
    fn see(&mut self, name: &'static str, difference: f64, allowed: f64) {
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        let share = if difference == 0.0 { 0.0 } else { difference / allowed };
        let entry = self.seen.entry(name).or_default();
        if share > entry.0 || entry.2.is_empty() {
            *entry = (share, difference, self.at.clone());
        }
    }

    fn holds(&mut self, name: &'static str, holds: bool) {
        self.see(name, if holds { 0.0 } else { f64::INFINITY }, 1.0);
    }

    fn print(&self) -> bool {
        for (name, (share, difference, at)) in &self.seen {
            let verdict = if *share <= 1.0 { "" } else { "  TOO FAR" };
            println!("  {name:24} {difference:.1e}, {share:.2} of what is allowed{verdict}; {at}");
        }
        self.seen.values().all(|(share, ..)| *share <= 1.0)
    }
}

/// The density of light of further bounces, as in the crate's `bsdf/grazing.rs`.
struct Grazing {
    square: f64,
    octaves: f64,
}

impl Grazing {
    fn new(sigma: f64, gamma: f64) -> Self {
        let c = (sigma + sigma / (6.0 * (2.0 * gamma - 3.0))).clamp(1e-9, 1.0);
        Self { square: c * c, octaves: (1.0 + 1.0 / (c * c)).log2() }
    }

    fn pdf(&self, cos: f64) -> f64 {
        let factor = 0.05 + 0.95 / (LN_2 * self.octaves) / (cos * cos + self.square);
        factor * cos * FRAC_1_PI
    }

    fn sample(&self, u: [f32; 2]) -> [f64; 3] {
        let [u, azimuth] = u.map(|u| f64::from(if u > 0.0 { u.min(1.0) } else { 0.0 }));
        let x = if u < 0.05 {
            u / 0.05
        } else {
            self.square * (((u - 0.05) / 0.95 * self.octaves).exp2() - 1.0)
        };
        let (r, (sin, cos)) = ((1.0 - x).max(0.0).sqrt(), (TAU * azimuth).sin_cos());
        [r * cos, r * sin, x.max(0.0).sqrt()]
    }
}

/// One lobe, with all of the crate that conductors are compared with.
struct Surface<'a> {
    gamma: f64,
    sigma: f64,
    sigmas: [f64; 2],
    lobe: Lobe,
    albedo: [Albedo; 2],
    grazing: Grazing,
    family: &'a Family,
    albedos: &'a [FamilyAlbedo; 2],
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    a.iter().zip(b).map(|(&a, b)| f64::from(a) * f64::from(b)).sum()
}

fn apart(a: [f32; 3], b: [f64; 3]) -> f64 {
    let apart = |i: usize| (f64::from(a[i]) - b[i]).abs();
    if a.iter().any(|x| x.is_nan()) { f64::INFINITY } else { apart(0).max(apart(1)).max(apart(2)) }
}

/// How far rounding moves a light whose cosine squared has the digits of single precision.
fn near_normal([x, y, _]: [f64; 3]) -> f64 {
    2e-6 / x.hypot(y).max(1e-3)
}

fn mean(x: [f32; 3]) -> f64 {
    x.map(f64::from).iter().sum::<f64>() / 3.0
}

impl<'a> Surface<'a> {
    fn new(
        tables: &Tables,
        family: &'a Family,
        albedos: &'a [FamilyAlbedo; 2],
        gamma: f64,
        sigma: [f32; 2],
    ) -> Self {
        let sigmas = sigma.map(|sigma| f64::from(sigma).clamp(1e-8, 1e6));
        let sigma = (sigmas[0] * sigmas[1]).sqrt();
        let lobe: Lobe = if gamma == 2.0 {
            Ggx::new(sigmas).unwrap().into()
        } else {
            tables.student_t(sigmas, gamma).unwrap().into()
        };
        let of = |masking| tables.albedo(sigma.clamp(1e-8, 3.0), gamma, masking).unwrap();
        let grazing = Grazing::new(sigma, gamma);
        Self { gamma, sigma, sigmas, lobe, albedo: MASKINGS.map(of), grazing, family, albedos }
    }

    fn compare(&self, point: &Point, answer: &Answer, worst: &mut Worst) {
        let Point { v, l, choice, u, .. } = *point;
        let numbers = [answer.light, answer.normal, answer.weight, answer.f, answer.sampled_f];
        let rest = [answer.pdf, answer.density, answer.sampled_density, answer.eta];
        let sound = numbers.as_flattened().iter().chain(&rest).all(|x| x.is_finite());
        let positive = [answer.weight, answer.f, answer.sampled_f];
        let positive = positive.as_flattened().iter().chain(&rest).all(|x| *x >= 0.0);
        worst.holds("numbers", sound && positive && answer.eta == 1.0);

        let masking = MASKINGS[point.masking as usize];
        let compensation = COMPENSATIONS[point.compensation as usize];
        let fresnel = match point.form {
            0 => ConductorFresnel::schlick(point.a),
            1 => ConductorFresnel::f82_tint(point.a, point.b),
            _ => ConductorFresnel::exact(point.a.map(f64::from), point.b.map(f64::from)),
        };
        let fresnel = fresnel.unwrap();
        let average = fresnel.average();
        worst.see("average reflectance", apart(answer.average, average.map(f64::from)), 3e-6);

        let v_good = v[2] > 0.0 && dot(v, v).is_finite();
        let l_good = l[2] > 0.0 && dot(l, l).is_finite();
        let is_null = |all: [f32; 3], one: f32| all == [0.0; 3] && one == 0.0;
        if !v_good {
            let none = answer.event == 0 && is_null(answer.weight, answer.pdf);
            worst.holds("black from below", none && is_null(answer.f, answer.density));
            return;
        }
        if !l_good {
            worst.holds("no light from below", is_null(answer.f, answer.density));
        }
        if self.lobe.is_effectively_smooth() {
            worst.holds("a mirror", answer.event == 1 && answer.is_delta == 1);
            worst.holds("a mirror", is_null(answer.f, answer.density) && answer.pdf == 0.0);
            worst.holds("a mirror", answer.light == [-v[0], -v[1], v[2]]);
            let want = fresnel.at(v[2]).map(f64::from);
            worst.see("weight of a mirror", apart(answer.weight, want), 3e-6);
            return;
        }
        worst.holds("no mirror", answer.is_delta == 0);

        // What does not depend on the light.
        let albedo = &self.albedo[point.masking as usize];
        let [lost_v, lost] = [albedo.lost(v), albedo.lost_average()].map(f64::from);
        let bounces = average.map(|average| albedo.multiple_bounces(average));
        let (facets, broad) = ((1.0 - lost_v) * mean(average), lost_v * mean(bounces));
        let is_broad = compensation == Compensation::KullaConty;
        let p = if is_broad && broad > 0.0 { facets / (facets + broad) } else { 1.0 };
        let turquin = if compensation == Compensation::Turquin {
            fresnel.at(1.0).map(|f0| albedo.turquin(v, f0))
        } else {
            [1.0; 3]
        };
        // How exact the factor, the broad lobe over cos/pi and the density are.
        let bounces_off = 4e-5 / (1.0 - lost).max(1e-6);
        let factor_off = 3e-6 / (1.0 - lost_v).max(1e-3).powi(2);
        let lost_at = |l: [f32; 3]| f64::from(albedo.lost(l));
        let broad_off = |l: [f32; 3]| {
            let (a, b) = (lost_v, lost_at(l));
            if is_broad {
                ((a + b) * 3e-6 + a * b * (4e-5 / lost + bounces_off)) / lost
            } else {
                0.0
            }
        };
        let density_off = if is_broad {
            1e-4 + 5e-6 / lost_v.max(1e-30) + 5e-6 / (1.0 - lost_v).max(1e-6) + bounces_off
        } else {
            0.0
        };
        let log_off = |pdf: f64| {
            let d = pdf * 4.0 * f64::from(v[2]);
            1e-5 + 4e-6 * (d.max(1e-38) * self.sigmas[0] * self.sigmas[1]).ln().abs()
        };
        let tiny_average = is_broad && lost < 1e-4;

        let single = BsdfSettings::new().with_masking(masking);
        let conductor = Conductor::new(self.lobe.clone(), fresnel, single).unwrap();
        let conductor = conductor.compensated_by(albedo.clone(), compensation);
        if l_good {
            let (f, pdf) = conductor.eval_pdf(v, l, Transport::Radiance);
            let white = f64::from(self.lobe.eval_pdf(v, l, masking).1);
            let cos = f64::from(l[2]);
            let want = if is_broad {
                p * white + (1.0 - p) * self.grazing.pdf(cos)
            } else {
                f64::from(pdf)
            };
            let off = log_off(white) + density_off;
            if (1e-36..1e37).contains(&want) {
                let difference = (f64::from(answer.density) - want).abs();
                worst.see("density", difference / want, off);
            }
            for i in 0..3 {
                let want = f64::from(f[i]);
                let (got, white) = (f64::from(answer.f[i]), white / cos * f64::from(turquin[i]));
                if (1e-36..1e37).contains(&want) && white < 1e37 && !tiny_average {
                    let allowed = want * (log_off(white * cos) + factor_off)
                        + white * 5e-6
                        + broad_off(l) * FRAC_1_PI;
                    worst.see("f", (got - want).abs(), allowed);
                }
            }
        }
        self.sample(
            point,
            answer,
            worst,
            &Expected {
                fresnel,
                p,
                turquin,
                bounces,
                lost_v,
                lost,
                is_broad,
                factor_off,
                tiny_average,
                masking,
                broad_off: &broad_off,
                density_off,
                log_off: &log_off,
                conductor: &conductor,
            },
        );
        if self.sigma >= 0.05 && self.sigma <= 3.0 && self.gamma >= 1.6 {
            let round = self.sigmas[0] == self.sigmas[1];
            let hit = self.family.at(self.sigma as f32, self.gamma as f32);
            let at = self.albedos[point.masking as usize].at(self.sigma as f32, self.gamma as f32);
            let hit = Conductor::at_hit(hit, fresnel, masking).compensated_at(at, compensation);
            if round && l_good && v[2] > 0.02 && l[2] > 0.02 && lost > 1e-2 && lost_v > 1e-2 {
                let (f, pdf) = hit.eval_pdf(v, l, Transport::Radiance);
                let difference = f64::from(answer.density - pdf).abs() / f64::from(pdf);
                let difference = if pdf > 1e-30 { difference } else { 0.0 };
                worst.see("density of the family", difference, 3e-3 + 2e-3 / lost_v);
                let off = (lost_v + lost_at(l)) * 1.5e-3 / lost * FRAC_1_PI;
                let off = if is_broad { off } else { 0.0 };
                let scale = 5e-3 + 1e-3 / (1.0 - lost_v).max(1e-3).powi(2);
                for i in 0..3 {
                    let want = f64::from(f[i]);
                    let difference = (f64::from(answer.f[i]) - want).abs();
                    worst.see("f of the family", difference, 1e-6 + scale * want + off);
                }
                // Its samples of further bounces are the same lights.
                let choice = f64::from(choice);
                if choice > p + 0.02 && choice < 1.0 {
                    let light = hit.sample(v, point.choice, u, Transport::Radiance);
                    if let Some(light) = light {
                        let want = light.l.map(f64::from);
                        worst.see(
                            "light of the family",
                            apart(answer.light, want),
                            2e-5 + near_normal(want),
                        );
                    }
                }
            }
        }
    }

    fn sample(&self, point: &Point, answer: &Answer, worst: &mut Worst, want: &Expected<'_>) {
        let Point { v, u, .. } = *point;
        let choice =
            f64::from(if point.choice > 0.0 { point.choice.min(0.999_999_94) } else { 0.0 });
        if (choice - want.p).abs() < 1e-4 && want.p < 1.0 {
            return;
        }
        let (l, m, cos) = (answer.light, answer.normal, f64::from(answer.light[2]));
        let is_facet = choice < want.p;
        if is_facet {
            let reflected = self.lobe.sample_reflected(v, u, want.masking);
            let rough = self.sigmas[0].max(self.sigmas[1]) > 10.0;
            let heavy = self.gamma < 1.8 && v[2] < 1e-6;
            let allowed = if rough || heavy { 4e-3 } else { 5e-5 };
            match reflected {
                Some((light, _)) if answer.event == 1 => {
                    worst.see("light of facets", apart(l, light.map(f64::from)), allowed);
                }
                None if answer.event == 0 => (),
                // Rounding decides on the horizon.
                Some((light, _)) => worst.see("on the horizon", f64::from(light[2]), allowed),
                None => worst.see("on the horizon", cos, allowed),
            }
            if answer.event == 1 {
                let twice = 2.0 * dot(v, m);
                let mirrored = [0, 1, 2].map(|i| twice * f64::from(m[i]) - f64::from(v[i]));
                worst.see("mirrored about m", apart(l, mirrored), 1e-6);
            }
        } else {
            let light = self.grazing.sample(u);
            if answer.event == 1 {
                worst.see("light of further bounces", apart(l, light), 5e-6 + near_normal(light));
            } else {
                worst.see("on the horizon", light[2], 1e-6);
            }
        }
        if answer.event != 1 {
            let null = answer.weight == [0.0; 3] && answer.pdf == 0.0;
            worst.holds("absorbed", null && answer.event == 0);
            return;
        }
        worst.see("unit length", (dot(l, l) - 1.0).abs(), 2e-6);
        worst.holds("above", l[2] > 0.0);

        // Both densities at the light of C, from its normal.
        let white = if is_facet {
            let area = f64::from(self.lobe.g1(v)) / f64::from(v[2]);
            0.25 * f64::from(self.lobe.d(m)) * area
        } else {
            f64::from(self.lobe.eval_pdf(v, l, want.masking).1)
        };
        let at = if is_facet { dot(v, m) } else { (0.5 * (1.0 + dot(v, l))).max(0.0).sqrt() };
        let broad = if want.is_broad { self.grazing.pdf(cos) } else { 0.0 };
        let pdf = want.p * white + (1.0 - want.p) * broad;
        if !(white < 1e37) || !(pdf > 1e-30) {
            return;
        }
        let off = (want.log_off)(white) + want.density_off;
        worst.see("density of a sample", (f64::from(answer.pdf) - pdf).abs() / pdf, off);
        if want.tiny_average {
            return;
        }
        let weight = f64::from(self.lobe.reflection_weight(v, l, want.masking));
        let lost_l = f64::from(self.albedo[point.masking as usize].lost(l));
        for i in 0..3 {
            let factor = f64::from(want.turquin[i]);
            let reflectance = f64::from(want.fresnel.at(at as f32)[i]);
            let facets = reflectance * weight * factor * white;
            let lobe = if want.is_broad {
                f64::from(want.bounces[i]) * want.lost_v * lost_l / want.lost * cos * FRAC_1_PI
            } else {
                0.0
            };
            let expected = (facets + lobe) / pdf;
            let allowed = expected * (off + want.factor_off)
                + factor * 5e-6 / want.p.max(1e-3)
                + (want.broad_off)(l) * cos * FRAC_1_PI / pdf;
            let difference = (f64::from(answer.weight[i]) - expected).abs();
            worst.see("weight", difference, allowed);
        }
        // C alone: f cos over the density, where v + l has the digits of m.
        let clear = self.sigmas[0].min(self.sigmas[1]) >= 0.03 && m[2] > 0.1 && at > 0.1;
        if clear && l[2] > 1e-3 {
            let density = f64::from(answer.sampled_density);
            worst.see("density again", (density - pdf).abs() / pdf, 1e-3 + 2.0 * off);
            for i in 0..3 {
                let product = f64::from(answer.weight[i]) * f64::from(answer.pdf);
                let f = f64::from(answer.sampled_f[i]) * cos;
                worst.see("f cos and weight pdf", (f - product).abs(), 1e-3 * product + 1e-7 * pdf);
            }
        }
        if !is_facet {
            let (f, _) = want.conductor.eval_pdf(v, l, Transport::Radiance);
            for i in 0..3 {
                let expected = f64::from(f[i]);
                let allowed = expected * off + white / cos * 5e-6 + (want.broad_off)(l) * FRAC_1_PI;
                let difference = (f64::from(answer.sampled_f[i]) - expected).abs();
                worst.see("f of further bounces", difference, allowed);
            }
        }
    }
}

struct Expected<'a> {
    fresnel: ConductorFresnel,
    p: f64,
    turquin: [f32; 3],
    bounces: [f32; 3],
    lost_v: f64,
    lost: f64,
    is_broad: bool,
    tiny_average: bool,
    masking: Masking,
    factor_off: f64,
    density_off: f64,
    broad_off: &'a dyn Fn([f32; 3]) -> f64,
    log_off: &'a dyn Fn(f64) -> f64,
    conductor: &'a Conductor<Lobe, 3>,
}
