//! How two kinds of haze differ: the engines' mixture of two BRDFs, and the mixture of normals on
//! one surface, whose facets mask each other: `cargo run --release -p microfacet-sampler --example
//! haze`.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_sampler::{
    Bsdf, BsdfSettings, Conductor, ConductorFresnel, Ggx, Haze, Masking, MicrofacetDistribution,
    Transport,
};

/// α of the core, and that of the haze for OpenPBR's roughness r = √α and spread.
const CORES: [f64; 2] = [0.01, 0.1];
const SPREAD: f64 = 0.5;
const WEIGHTS: [f32; 2] = [0.25, 0.5];
const THETAS: [f32; 5] = [0.0, 45.0, 70.0, 85.0, 89.0];
/// Strata along each of two numbers, and of the choice of a part.
const STRATA: usize = 512;

/// A mixture of normals of two kinds, w of them of the second, on one surface.
struct Normals {
    parts: [Ggx; 2],
    w: f32,
}

impl Normals {
    fn mean(&self, of: impl Fn(&Ggx) -> f32) -> f32 {
        (1.0 - self.w) * of(&self.parts[0]) + self.w * of(&self.parts[1])
    }

    /// f of one bounce with F = 1 and height-correlated masking, G2 = 1/(1 + Λ(v) + Λ(l)): D and Λ
    /// are means of those of the parts.
    fn f(&self, v: Vec3, l: Vec3) -> f32 {
        let m = (v + l).normalize();
        let lambda = |v: Vec3| self.mean(|part| part.lambda(v));
        self.mean(|part| part.d(m)) / (4.0 * v.z * l.z * (1.0 + lambda(v) + lambda(l)))
    }
}

fn main() {
    println!("F = 1; E of a mixture of BRDFs - E of a mixture of normals, and the ratio of f");
    println!("core a  haze a  w     theta  E BRDFs  E normals  difference  f BRDFs / f normals");
    for core in CORES {
        let r = core.sqrt() + (1.0 - core.sqrt()) * SPREAD;
        for w in WEIGHTS {
            let parts = [core, r * r].map(|alpha| Ggx::new(alpha as f32).expect("in the range"));
            for theta in THETAS {
                row(Normals { parts, w }, theta);
            }
        }
    }
}

fn row(normals: Normals, theta: f32) {
    let Normals { parts, w } = normals;
    let white = |ggx| {
        let settings = BsdfSettings::new().with_masking(Masking::HeightCorrelated);
        Conductor::<_, 1>::new(ggx, ConductorFresnel::mirror(), settings).expect("no table needed")
    };
    let haze = Haze::new(white(parts[0]), white(parts[1]), w).expect("a share");
    let theta_v = theta.to_radians();
    let v = Vec3::new(theta_v.sin(), 0.0, theta_v.cos());
    let mut random = StdRng::seed_from_u64(1);
    let (mut sums, mut ratios) = ([0.0_f64; 2], [f64::INFINITY, 0.0]);
    for i in 0..STRATA * STRATA {
        let mut number = |i: usize| (i as f32 + random.random::<f32>()) / STRATA as f32;
        let u = [number(i % STRATA), number(i / STRATA)];
        let Some(sample) = haze.sample(v, random.random(), u, Transport::Radiance) else {
            continue;
        };
        let [f] = haze.eval(v, sample.l, Transport::Radiance);
        let ratio = f64::from(f) / f64::from(normals.f(v, sample.l.into()));
        let weight = f64::from(sample.weight[0]) / (STRATA * STRATA) as f64;
        sums = [sums[0] + weight, sums[1] + weight / ratio];
        ratios = [ratios[0].min(ratio), ratios[1].max(ratio)];
    }
    let ([brdfs, normals], [low, high]) = (sums, ratios);
    let [core, haze] = parts.map(|part| part.alpha()[0]);
    println!(
        "{core:<7.4} {haze:<7.4} {w:<5} {theta:<6} {brdfs:.4}   {normals:.4}     {:+.4}     \
         {low:.3} to {high:.3}",
        brdfs - normals
    );
}
