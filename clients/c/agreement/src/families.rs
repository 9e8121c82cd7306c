//! Compares the family that C reads with the crate's, at a γ and σ of its own for each point.

use std::collections::BTreeMap;
use std::ffi::c_void;

use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::albedo::Moments;
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A point of a surface, a view and a light.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hit {
    gamma: f32,
    sigma: [f32; 2],
    v: [f32; 3],
    l: [f32; 3],
    m: [f32; 3],
    u: [f32; 2],
}

/// What C has there; pairs are by form of masking.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct At {
    gamma: f32,
    d: f32,
    g1: f32,
    lambda: f32,
    pdf: f32,
    reflection_pdf: f32,
    normal: [f32; 3],
    g2: [f32; 2],
    weight: [f32; 2],
    f: [f32; 2],
    f_pdf: [f32; 2],
    albedo: [f32; 2],
    average: [f32; 2],
    parts: [[f32; 3]; 2],
    average_parts: [[f32; 3]; 2],
    compensation: [f32; 2],
    is_smooth: i32,
}

unsafe extern "C" {
    fn c_family(bytes: *const c_void, size: u32, count: usize, hits: *const Hit, all: *mut At);
    fn cpp_family(bytes: *const c_void, size: u32, count: usize, hits: *const Hit, all: *mut At);
}

/// The file of the family, which lookups read in place of the header's tables; whole words, since
/// its address is a multiple of 4.
struct File(Vec<u32>);

impl File {
    fn read(path: &str) -> Self {
        let bytes = std::fs::read(path).expect("the file of a family");
        Self(bytes.chunks_exact(4).map(|w| u32::from_ne_bytes(w.try_into().unwrap())).collect())
    }

    fn answers(&self, hits: &[Hit]) -> Vec<At> {
        let mut all = vec![At::default(); hits.len()];
        let size = 4 * self.0.len() as u32;
        // SAFETY: all are of the lengths passed, and of the layout of `families.c`.
        unsafe {
            c_family(self.0.as_ptr().cast(), size, hits.len(), hits.as_ptr(), all.as_mut_ptr());
        }
        all
    }
}

fn answers(hits: &[Hit]) -> [Vec<At>; 2] {
    [c_family, cpp_family].map(|function: unsafe extern "C" fn(_, _, _, _, _)| {
        let mut all = vec![At::default(); hits.len()];
        // SAFETY: both are of the length passed, and of the layout of `families.c`.
        unsafe { function(std::ptr::null(), 0, hits.len(), hits.as_ptr(), all.as_mut_ptr()) };
        all
    })
}

/// What C may differ by: G1 and what follows from it, from the crate's family and from the model;
/// densities; E, other moments, and the averages of both.
const SHARE: f64 = 5e-6;
const EXACT: f64 = 1e-5;
const DENSITY: f64 = 3e-5;
const ALBEDO: f64 = 2.5e-4;
const MOMENT: f64 = 1e-3;
/// By how much random numbers may be off whose normals are those of C.
const NUMBER: f32 = 1e-5;

/// Differences by quantity, as shares of what is allowed.
#[derive(Default)]
struct Seen(BTreeMap<&'static str, (f64, f64, String)>);

impl Seen {
    fn see(&mut self, name: &'static str, difference: f64, allowed: f64, hit: &Hit) {
        let share = if difference.is_nan() { f64::INFINITY } else { difference / allowed };
        let entry = self.0.entry(name).or_default();
        if share > entry.0 || entry.2.is_empty() {
            *entry = (share, difference, format!("{hit:?}"));
        }
    }

    fn holds(&mut self, name: &'static str, holds: bool, hit: &Hit) {
        self.see(name, if holds { 0.0 } else { f64::INFINITY }, 1.0, hit);
    }

    fn print(&self) -> bool {
        for (name, (share, difference, hit)) in &self.0 {
            let verdict = if *share <= 1.0 { "" } else { "  TOO FAR" };
            println!("  {name:20} {difference:.1e}, {share:.2} of what is allowed{verdict}; {hit}");
        }
        self.0.values().all(|(share, ..)| *share <= 1.0)
    }
}

/// Compares at `count` random points and at corners, by C, by C++, and by the file at `path`;
/// prints the largest differences, and returns whether all are allowed.
pub fn agree(count: usize, path: &str) -> bool {
    let file = File::read(path);
    let mut good = true;
    for (title, hits) in [("random points", random(count)), ("corners", corners())] {
        let [c, cpp] = answers(&hits);
        let mut seen = Seen::default();
        compare(&mut seen, &hits, &c);
        compare(&mut seen, &hits, &cpp);
        let bits = |all: &[At]| all.iter().map(|at| format!("{at:?}")).collect::<Vec<_>>();
        seen.holds("file as header", bits(&file.answers(&hits)) == bits(&c), &hits[0]);
        println!("largest differences of a family at {} {title}, C and C++", hits.len());
        good &= seen.print();
    }
    good
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

fn compare(seen: &mut Seen, hits: &[Hit], all: &[At]) {
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
        seen.see("g1", far(at.g1, lobe.g1(v)), SHARE, hit);
        let smooth = i32::from(lobe.is_effectively_smooth());
        // The limit is met to rounding.
        let other = |factor: f32| family.at(lobe.sigma().map(|x| x * factor), hit.gamma);
        let near = [0.999, 1.001].map(|factor| i32::from(other(factor).is_effectively_smooth()));
        seen.holds("smooth", at.is_smooth == smooth || near[0] != near[1], hit);
        if i % 16 == 0 && v[2] > 0.0 {
            let model = microfacet_model::StudentT::new(lobe.sigma().map(f64::from), lobe.gamma());
            let exact = model.unwrap().g1(v.map(f64::from).into());
            seen.see("g1 of the model", (f64::from(at.g1) - exact).abs(), EXACT, hit);
        }
        let relative = |got: f32, want: f32| {
            let tiny = got.max(want) < 1.2e-38;
            if tiny { 0.0 } else { (f64::from(got) / f64::from(want) - 1.0).abs() }
        };
        let log = (f64::from(lobe.d(m)).max(1e-38) * f64::from(sigma[0] * sigma[1])).ln().abs();
        let allowed = if log.is_finite() { DENSITY + 4e-6 * log } else { 1e-3 };
        seen.see("d", relative(at.d, lobe.d(m)), allowed, hit);
        // An area is that of G1, whose absolute error counts most at grazing views.
        let area = allowed + SHARE / f64::from(lobe.g1(v)).max(1e-6);
        seen.see("pdf", relative(at.pdf, lobe.visible_normal_pdf(v, m)), area, hit);
        for (k, masking) in Masking::ALL.into_iter().enumerate() {
            seen.see("g2", far(at.g2[k], lobe.g2(v, l, masking)), SHARE, hit);
            let weight = lobe.reflection_weight(v, l, masking);
            seen.see("weight", far(at.weight[k], weight), 3.0 * SHARE, hit);
            let (f, pdf) = lobe.eval_pdf(v, l, masking);
            let log = (f64::from(pdf).max(1e-38) * f64::from(sigma[0] * sigma[1])).ln().abs();
            let allowed = if log.is_finite() { area + 4e-6 * log } else { 1e-3 };
            seen.see("density of eval", relative(at.f_pdf[k], pdf), allowed, hit);
            if (1e-30..1e30).contains(&f) && weight > 1e-3 {
                let allowed = allowed + 3.0 * SHARE / f64::from(weight);
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
            seen.see("albedo", far(at.albedo[k], albedo.albedo(v)), ALBEDO, hit);
            seen.see("average", far(at.average[k], albedo.albedo_average()), ALBEDO, hit);
            for (got, want) in [
                (at.parts[k], moments(albedo.moments(v))),
                (at.average_parts[k], moments(albedo.average_moments())),
            ] {
                for (got, want) in got.into_iter().zip(want) {
                    seen.see("moments", far(got, want), MOMENT, hit);
                }
            }
        }
        normal(seen, hit, at, |u| lobe.sample_visible_normal(v, u), lobe.gamma(), u);
    }
}

/// The normal of C lies between those of the crate at numbers to either side of its own.
fn normal(
    seen: &mut Seen,
    hit: &Hit,
    at: &At,
    of: impl Fn([f32; 2]) -> [f32; 3],
    gamma: f64,
    u: [f32; 2],
) {
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
        let ends = [u[axis] - NUMBER, u[axis] + NUMBER];
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
        let allowed = 2e-6 * (x / y).max(y / x) * (1.0 + length);
        seen.see(["normal, along", "normal, across"][axis], outside, allowed, hit);
    }
}

fn random(count: usize) -> Vec<Hit> {
    let mut rng = StdRng::seed_from_u64(7);
    let mut between = move |low: f32, high: f32| low + (high - low) * rng.random::<f32>();
    let one = |i: usize| {
        let ends = if i.is_multiple_of(4) { [-8.0, 6.0] } else { [-3.0, 0.5] };
        let x = 10.0_f32.powf(between(ends[0], ends[1]));
        let y = if i.is_multiple_of(2) { x } else { 10.0_f32.powf(between(ends[0], ends[1])) };
        let gamma = match i % 8 {
            0 => f32::INFINITY,
            1 => between(1.501, 1.8),
            _ => 1.5 + 0.001 * 10.0_f32.powf(between(0.0, 5.0)),
        };
        let mut direction = |k: usize| {
            let near = 10.0_f32.powf(between(-7.0, -1.0));
            let z = [between(0.0, 1.0), near, between(0.0, 1.0), 1.0 - near][k % 4];
            let (sin, cos) = between(0.0, std::f32::consts::TAU).sin_cos();
            let r = ((1.0 - z) * (1.0 + z)).sqrt();
            [r * cos, r * sin, z]
        };
        let (v, l) = (direction(i / 8), direction(i / 32));
        let m = if i.is_multiple_of(3) {
            direction(i)
        } else {
            let sum = [0, 1, 2].map(|k| v[k] + l[k]);
            let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
            sum.map(|x| x / length)
        };
        let mut number = |k: usize| match k % 10 {
            0 => 10.0_f32.powf(between(-9.0, -1.0)),
            5 => 1.0 - 10.0_f32.powf(between(-7.0, -1.0)),
            _ => between(0.0, 1.0),
        };
        Hit { gamma, sigma: [x, y], v, l, m, u: [number(i), number(i / 10)] }
    };
    (0..count).map(one).collect()
}

fn corners() -> Vec<Hit> {
    const NAN: f32 = f32::NAN;
    let (inf, huge) = (f32::INFINITY, f32::MAX);
    let gammas = [
        1.501,
        1.500_999,
        1.55,
        1.799_999_9,
        1.8,
        1.800_000_1,
        2.0,
        3.0,
        15.0,
        1e9,
        1e19,
        huge,
        inf,
        1.5,
        1.0,
        0.0,
        -1.0,
        -inf,
        NAN,
    ];
    let sigmas = [
        [1e-8, 1e-8],
        [1e6, 1e6],
        [1e-8, 1e6],
        [0.3, 0.3],
        [0.1, 2.0],
        [1e-3, 1e-3],
        [0.0, 0.3],
        [-1.0, 0.2],
        [1e-30, 1e-30],
        [1e9, inf],
        [NAN, 0.3],
    ];
    let r = |z: f32| (1.0 - z * z).sqrt();
    let directions = [
        [0.0, 0.0, 1.0],
        [1e-7, 1e-9, 1.0],
        [0.6 * r(0.5), -0.8 * r(0.5), 0.5],
        [0.6, -0.8, 1e-8],
        [0.6, -0.8, 1e-30],
        [1.0, 0.0, 0.0],
        [0.6, 0.0, -0.8],
        [0.0, 0.0, -1.0],
        [0.0; 3],
        [NAN, 0.0, 1.0],
        [0.6, 0.0, NAN],
        [NAN; 3],
    ];
    let numbers = [0.0, 1e-30, 0.25, 0.5, 1.0 - f32::EPSILON / 2.0, 1.0, -1.0, 2.0, NAN];
    let mut hits = Vec::new();
    for gamma in gammas {
        for sigma in sigmas {
            for (i, v) in directions.into_iter().enumerate() {
                for (j, a) in numbers.into_iter().enumerate() {
                    let l = directions[(i + j) % directions.len()];
                    let mut m = directions[(i + 2 * j + 1) % directions.len()];
                    if m[2] > 0.0 {
                        m[2] = m[2].max(1e-18);
                    }
                    let u = [a, numbers[(i + j) % numbers.len()]];
                    hits.push(Hit { gamma, sigma, v, l, m, u });
                }
            }
        }
    }
    hits
}
