//! A picture by a small path tracer, of gold whose σ and γ are textures: once with the crate's
//! conductors, once with those of C and C++.
//!
//! Two spheres that touch, under a sky with a lamp; next-event estimation and multiple importance
//! sampling by the balance heuristic (Veach 1997, section 9.2). Pictures of other random numbers
//! differ by noise: where C has the crate's material, the squares of the differences of pixels over
//! their variances are 1 on average. Gold that is rougher by a tenth must be told apart, else the
//! comparison is worth nothing.

use std::f32::consts::TAU;

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::{
    Bsdf, BsdfSample, Compensation, Conductor, ConductorFresnel, Family, Masking, Metal, Tables,
    Transport,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const SIDE: usize = 24;
const PATHS: usize = 400;
const MOST_BOUNCES: usize = 4;
/// The cosine of the lamp's half angle, and how much brighter than the sky it is.
const LAMP: (f32, f32) = (0.98, 20.0);

/// A light as C samples it.
#[repr(C)]
#[derive(Default)]
struct Light {
    l: [f32; 3],
    weight: [f32; 3],
    pdf: f32,
    event: i32,
    is_delta: i32,
}

type Sampled = unsafe extern "C" fn(f32, f32, *const f32, f32, *const f32, *mut Light);
type Evaluated = unsafe extern "C" fn(f32, f32, *const f32, *const f32, *mut f32, *mut f32);

unsafe extern "C" {
    fn c_gold_sample(g: f32, s: f32, v: *const f32, choice: f32, u: *const f32, to: *mut Light);
    fn c_gold_eval(g: f32, s: f32, v: *const f32, l: *const f32, f: *mut f32, pdf: *mut f32);
    fn cpp_gold_sample(g: f32, s: f32, v: *const f32, choice: f32, u: *const f32, to: *mut Light);
    fn cpp_gold_eval(g: f32, s: f32, v: *const f32, l: *const f32, f: *mut f32, pdf: *mut f32);
}

/// Gold at a hit, by C or C++.
struct Compiled {
    gamma: f32,
    sigma: f32,
    by: (Sampled, Evaluated),
}

impl Bsdf for Compiled {
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        _: Transport,
    ) -> Option<(BsdfSample, f32)> {
        let (v, mut to) = (v.into(), Light::default());
        // SAFETY: of the layout of `pictures.c`.
        unsafe { self.by.0(self.gamma, self.sigma, v.as_ptr(), choice, u.as_ptr(), &mut to) };
        let mut sample = BsdfSample::reflected(to.l, to.weight);
        sample.delta = to.is_delta != 0;
        (to.event != 0).then_some((sample, to.pdf))
    }

    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        _: Transport,
    ) -> ([f32; 3], f32) {
        let (v, l, mut f, mut pdf) = (v.into(), l.into(), [0.0; 3], 0.0);
        // SAFETY: of the layout of `pictures.c`.
        unsafe {
            let (v, l) = (v.as_ptr(), l.as_ptr());
            self.by.1(self.gamma, self.sigma, v, l, f.as_mut_ptr(), &mut pdf);
        }
        (f, pdf)
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn along(start: [f32; 3], t: f32, direction: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| start[i] + t * direction[i])
}

/// Tangent, bitangent and normal (Duff et al. 2017).
fn frame([x, y, z]: [f32; 3]) -> [[f32; 3]; 3] {
    let sign = 1.0_f32.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y], [x, y, z]]
}

/// The nearest sphere of radius 1 ahead: where, and the normal there.
fn hit(start: [f32; 3], direction: [f32; 3]) -> Option<([f32; 3], [f32; 3])> {
    let mut nearest: Option<(f32, [f32; 3])> = None;
    for center in [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]] {
        let to: [f32; 3] = [0, 1, 2].map(|i| start[i] - center[i]);
        let (b, c) = (dot(to, direction), dot(to, to) - 1.0);
        let t = -b - (b * b - c).sqrt();
        if t > 1e-3 && nearest.is_none_or(|(other, _)| t < other) {
            nearest = Some((t, center));
        }
    }
    let (t, center) = nearest?;
    let at = along(start, t, direction);
    Some((at, [0, 1, 2].map(|i| at[i] - center[i])))
}

/// The sky towards a direction, and the density of the lamp there.
fn sky(direction: [f32; 3]) -> (f32, f32) {
    let lamp = 1.0 / (TAU * (1.0 - LAMP.0));
    if direction[2] >= LAMP.0 { (LAMP.1, lamp) } else { (1.0 + 0.5 * direction[0], 0.0) }
}

/// The light of a path from a camera, by the material at a γ and σ.
fn path<B: Bsdf>(
    material: &impl Fn(f32, f32) -> B,
    [mut start, mut direction]: [[f32; 3]; 2],
    rng: &mut StdRng,
) -> [f32; 3] {
    let (mut seen, mut share, mut pdf) = ([0.0; 3], [1.0; 3], f32::INFINITY);
    for bounce in 0.. {
        let Some((at, n)) = hit(start, direction) else {
            let (radiance, of_lamp) = sky(direction);
            let part = radiance / (1.0 + of_lamp / pdf);
            return [0, 1, 2].map(|i| seen[i] + share[i] * part);
        };
        if bounce == MOST_BOUNCES {
            break;
        }
        let axes = frame(n);
        let local = |w: [f32; 3]| axes.map(|axis| dot(axis, w));
        let [gamma, sigma] = [1.7 + 3.0 * (1.0 + n[0]), 0.1 + 0.35 * (1.0 + n[1])];
        let gold = material(gamma, sigma);
        let v = local(direction.map(|x| -x));

        // Towards the lamp.
        let z = 1.0 - rng.random::<f32>() * (1.0 - LAMP.0);
        let (r, turn) = (((1.0 - z) * (1.0 + z)).sqrt(), TAU * rng.random::<f32>());
        let towards = [r * turn.cos(), r * turn.sin(), z];
        let l = local(towards);
        if l[2] > 0.0 && hit(at, towards).is_none() {
            let (f, of_gold) = gold.eval_pdf(v, l, Transport::Radiance);
            let (radiance, of_lamp) = sky(towards);
            for i in 0..3 {
                seen[i] += share[i] * f[i] * l[2] * radiance / (of_lamp + of_gold);
            }
        }

        // The next ray.
        let (choice, u) = (rng.random(), [rng.random(), rng.random()]);
        let Some((next, of_next)) = gold.sample_with_pdf(v, choice, u, Transport::Radiance) else {
            break;
        };
        start = at;
        pdf = if next.delta { f32::INFINITY } else { of_next };
        direction = [0, 1, 2].map(|i| (0..3).map(|k| axes[k][i] * next.l[k]).sum());
        share = [0, 1, 2].map(|i| share[i] * next.weight[i]);
    }
    seen
}

/// Means of the pixels' green and their variances.
fn picture<B: Bsdf>(seed: u64, material: impl Fn(f32, f32) -> B) -> Vec<[f64; 2]> {
    let mut rng = StdRng::seed_from_u64(seed);
    let pixels = (0..SIDE * SIDE).map(|pixel| {
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..PATHS {
            let [x, y] = [pixel % SIDE, pixel / SIDE]
                .map(|at| 2.0 * (at as f32 + rng.random::<f32>()) / SIDE as f32 - 1.0);
            let camera = [[2.0 * x, -4.0, y], [0.0, 1.0, 0.0]];
            let green = f64::from(path(&material, camera, &mut rng)[1]);
            sum += green;
            squares += green * green;
        }
        let count = PATHS as f64;
        let mean = sum / count;
        [mean, (squares / count - mean * mean) / (count - 1.0)]
    });
    pixels.collect()
}

/// By how many standard deviations the differences of two pictures exceed noise: of their squares
/// over variances, whose mean is 1, and of their sum.
fn beyond_noise(a: &[[f64; 2]], b: &[[f64; 2]]) -> [f64; 2] {
    let (mut squares, mut count, mut sum, mut variance) = (0.0, 0.0, 0.0, 0.0);
    for ([a, of_a], [b, of_b]) in a.iter().zip(b) {
        if of_a + of_b > 0.0 {
            squares += (a - b).powi(2) / (of_a + of_b);
            count += 1.0;
            sum += a - b;
            variance += of_a + of_b;
        }
    }
    [(squares - count) / f64::sqrt(2.0 * count), sum.abs() / f64::sqrt(variance)]
}

/// Compares the pictures; prints by how much they differ, and returns whether that is noise.
pub fn agree() -> bool {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    let albedo = tables.family_albedo(Masking::HeightCorrelated).unwrap();
    let of_crate = picture(1, |gamma, sigma| gold(&family, &albedo, gamma, sigma));
    let mean = of_crate.iter().map(|pixel| pixel[0]).sum::<f64>() / of_crate.len() as f64;
    println!("a picture of gold of sigma and gamma per hit, of mean {mean:.3}; from the crate's");
    let languages: [(_, (Sampled, Evaluated)); 2] =
        [("C", (c_gold_sample, c_gold_eval)), ("C++", (cpp_gold_sample, cpp_gold_eval))];
    let mut good = true;
    for (seed, (language, by)) in (2..).zip(languages) {
        let one = picture(seed, |gamma, sigma| Compiled { gamma, sigma, by });
        let [pixels, whole] = beyond_noise(&of_crate, &one);
        // Beyond 5, less than one in a million.
        let verdict = if pixels < 5.0 && whole < 5.0 { "" } else { "  TOO FAR" };
        println!("  {language:4} pixels {pixels:.1}, the whole {whole:.1} deviations{verdict}");
        good &= verdict.is_empty();
    }
    let by = languages[0].1;
    let rougher = picture(4, |gamma, sigma| Compiled { gamma, sigma: 1.1 * sigma, by });
    let [pixels, whole] = beyond_noise(&of_crate, &rougher);
    let verdict = if pixels > 5.0 || whole > 5.0 { "" } else { "  NOT TOLD APART" };
    println!("  a tenth rougher: pixels {pixels:.1}, the whole {whole:.1}{verdict}");
    good && verdict.is_empty()
}

fn gold<'a>(
    family: &'a Family,
    albedo: &'a FamilyAlbedo,
    gamma: f32,
    sigma: f32,
) -> impl Bsdf + 'a {
    let fresnel = ConductorFresnel::from(Metal::Gold);
    let one = Conductor::at_hit(family.at(sigma, gamma), fresnel, Masking::HeightCorrelated);
    one.compensated_at(albedo.at(sigma, gamma), Compensation::KullaConty)
}
