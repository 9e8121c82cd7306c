//! What the tables cost next to the closed forms of GGX:
//! `cargo run --profile dist -p microfacet-sampler --example speed`.
//!
//! All contestants take turns in one thread over the same random views and numbers, which stay in
//! the cache. A row is the median of many turns; ratios within a run mean more than nanoseconds.

use std::f32::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use glam::Vec3;
use microfacet_sampler::{MicrofacetDistribution, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The number of directions, and how often every contestant takes them all.
const COUNT: usize = 4096;
const TURNS: usize = 400;

/// The rival: GGX with closed forms, written as in the papers.
struct Ggx {
    alpha: [f32; 2],
}

impl Ggx {
    /// Dupuy & Benyoub 2023, *Sampling Visible GGX Normals with Spherical Caps*, listings 1 and 3,
    /// <https://doi.org/10.1111/cgf.14867>.
    #[inline(always)]
    fn sample_visible_normal(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let [x, y] = self.alpha;
        let w = Vec3::new(x * v.x, y * v.y, v.z).normalize();
        let (sin, cos) = (TAU * u[0]).sin_cos();
        let z = (1.0 - u[1]) * (1.0 + w.z) - w.z;
        let r = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
        let m = Vec3::new(r * cos, r * sin, z) + w;
        Vec3::new(x * m.x, y * m.y, m.z).normalize()
    }

    /// Walter et al. 2007, eq. 34, with the tangent cleared from it,
    /// <https://doi.org/10.2312/EGWR/EGSR07/195-206>.
    #[inline(always)]
    fn g1(&self, v: Vec3) -> f32 {
        let (x, y) = (self.alpha[0] * v.x, self.alpha[1] * v.y);
        2.0 * v.z / (v.z + (x * x + y * y + v.z * v.z).sqrt())
    }
}

fn main() {
    let mut rng = StdRng::seed_from_u64(1);
    // Uniform over the hemisphere.
    let v: Vec<Vec3> = (0..COUNT)
        .map(|_| {
            let (z, phi) = (rng.random::<f32>(), TAU * rng.random::<f32>());
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), z)
        })
        .collect();
    let u: Vec<[f32; 2]> = (0..COUNT).map(|_| rng.random()).collect();

    let (alpha, gamma) = ([0.3, 0.5], 2.5);
    let ggx = Ggx { alpha };
    let tables = Tables::embedded();
    let table = tables.student_t(alpha, gamma).unwrap();
    let [mut m0, mut m1, mut m2] = [(); 3].map(|()| vec![Vec3::ZERO; COUNT]);
    let [mut g0, mut g1, mut g2] = [(); 3].map(|()| vec![0.0; COUNT]);
    let [caps, sample, sample_batch, g1_closed, g1_table, g1_batch] = medians([
        &mut || each(&mut m0, |i| ggx.sample_visible_normal(v[i], u[i])),
        &mut || each(&mut m1, |i| table.sample_visible_normal(v[i], u[i])),
        &mut || table.sample_batch(&v, &u, &mut m2).unwrap(),
        &mut || each(&mut g0, |i| ggx.g1(v[i])),
        &mut || each(&mut g1, |i| table.g1(v[i])),
        &mut || table.g1_batch(&v, &mut g2).unwrap(),
    ]);
    println!("{:<34} {:>9} {:>9}", "", "ns a call", "ratio");
    let row = |name: &str, ns: f64, to: f64| println!("{name:<34} {ns:>9.2} {:>9.3}", ns / to);
    row("sample: GGX, spherical caps", caps, caps);
    row("sample: table", sample, caps);
    row("sample_batch: table", sample_batch, caps);
    row("g1: GGX, closed form", g1_closed, g1_closed);
    row("g1: table", g1_table, g1_closed);
    row("g1_batch: table", g1_batch, g1_closed);

    let [make] = medians([&mut || {
        black_box(tables.student_t(black_box(alpha), black_box(gamma)).unwrap());
    }]);
    println!(
        "a lobe from tables: {:.1} us; it reads {} bytes",
        make * COUNT as f64 / 1e3,
        table.bytes()
    );
}

/// Fills `out` one call at a time: an index that the compiler does not see keeps it from joining
/// calls into vectors, so that scalar functions are compared with scalar functions.
fn each<T>(out: &mut [T], f: impl Fn(usize) -> T) {
    for i in 0..out.len() {
        out[black_box(i)] = f(i);
    }
}

/// Median nanoseconds per direction of each contestant, all taking turns.
fn medians<const N: usize>(mut contestants: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut times = [const { Vec::new() }; N];
    for _ in 0..TURNS {
        for (run, times) in contestants.iter_mut().zip(&mut times) {
            let start = Instant::now();
            run();
            times.push(start.elapsed().as_nanos() as f64 / COUNT as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[TURNS / 2]
    })
}
