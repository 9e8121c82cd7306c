//! `table_pdf` is the density of what the sampler draws: never 0 at a drawn normal, and a divisor
//! that leaves no bias.

use glam::{DVec3, Vec3};
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{Skew, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const GAMMAS: [f64; 8] = [1.501, 1.6, 1.7, 1.8, 1.9, 3.0, 9.0, f64::INFINITY];
const SIGMAS: [[f64; 2]; 3] = [[0.3, 0.3], [1e-4, 1e-4], [2.0, 0.1]];

fn direction(random: &mut StdRng) -> Vec3 {
    let (z, phi) = (random.random::<f64>(), std::f64::consts::TAU * random.random::<f64>());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3()
}

/// The analytic density of a drawn normal over the table's.
fn ratio(lobe: &impl Tabulated, v: Vec3, u: [f32; 2], what: &str) -> f64 {
    let m = Vec3::from(lobe.sample_visible_normal(v, u));
    let (pdf, table) = (lobe.visible_normal_pdf(v, m), lobe.table_pdf(v, m));
    let place = || format!("{what}, v {v}, u {u:?}, m {m}: {pdf:e} against {table:e}");
    assert!(table.is_finite() && (table > 0.0 || pdf == 0.0), "{}", place());
    if pdf == 0.0 { 0.0 } else { f64::from(pdf) / f64::from(table) }
}

/// Rounding puts a slope that was drawn at a node on either side of the node. Dyadic numbers are
/// nodes, and low-discrepancy sequences consist of them.
#[test]
fn no_drawn_normal_has_the_density_zero() {
    const NUMBERS: [f32; 7] =
        [1.0 / 32.0, 0.158_203_125, 0.25, 0.5, 31.0 / 32.0, 1.0 - 1.0 / 8192.0, 2.0 / 81.0];
    let mut random = StdRng::seed_from_u64(1);
    for gamma in GAMMAS {
        for sigma in SIGMAS {
            let lobe = Tables::embedded().student_t(sigma, gamma).unwrap();
            let what = format!("gamma {gamma}, sigma {sigma:?}");
            for _ in 0..200 {
                let v = direction(&mut random);
                for number in NUMBERS {
                    let other = random.random();
                    for u in [[number, other], [other, number], [number, number]] {
                        let ratio = ratio(&lobe, v, u, &what);
                        // Within the last cell towards an end the quotient is that of the cell.
                        assert!(ratio < 1.3, "{what}, v {v}, u {u:?}: {ratio}");
                    }
                }
            }
            // At the ends either density may vanish; at the silhouette both are dominated by
            // rounding.
            for v in [direction(&mut random), Vec3::X, Vec3::new(0.6, 0.0, 0.8), Vec3::Z] {
                for u in [[0.0, 0.3], [0.3, 0.0], [1.0, 0.3], [0.3, 1.0], [0.0, 1.0], [1.0, 0.0]] {
                    let ratio = ratio(&lobe, v, u, &what);
                    assert!(ratio < 10.0, "{what}, v {v}, u {u:?}: {ratio}");
                }
            }
        }
    }
}

#[test]
fn dividing_by_it_is_unbiased() {
    const COUNT: usize = 200_000;
    /// Standard errors that the worst of 24 means may be off.
    const ERRORS: f64 = 4.5;
    let mean = |lobe: &dyn Fn(Vec3, [f32; 2]) -> f64, seed: u64| {
        let mut random = StdRng::seed_from_u64(seed);
        let mut sum = [0.0; 2];
        for _ in 0..COUNT {
            let v = direction(&mut random);
            let x = lobe(v, [random.random(), random.random()]);
            sum = [sum[0] + x, sum[1] + x * x];
        }
        let mean = sum[0] / COUNT as f64;
        (mean, ((sum[1] / COUNT as f64 - mean * mean) / COUNT as f64).sqrt())
    };
    for (i, gamma) in GAMMAS.into_iter().enumerate() {
        let tables = Tables::embedded();
        let lobe = tables.student_t([0.3, 0.5], gamma).unwrap();
        let skew = Skew::new([0.3, 0.5], [0.2, 0.1, 0.0]).unwrap();
        let tilted = tables.ellipsoid(skew, gamma).unwrap();
        let bounded = lobe.clone().bounded();
        let of_bounded = |v: Vec3, u: [f32; 2]| {
            let at = bounded.at(v);
            let m = Vec3::from(at.sample(u));
            let table = f64::from(at.table_pdf(m));
            assert!(table > 0.0, "{gamma} {v} {u:?} {m}");
            let ratio = f64::from(at.visible_normal_pdf(m)) / table;
            // The error of the tables is one of all normals, of which few are kept near γ = 3/2.
            1.0 + (ratio - 1.0) * f64::from(at.share())
        };
        let means = [
            mean(&|v, u| ratio(&lobe, v, u, "round"), i as u64),
            mean(&|v, u| ratio(&tilted, v, u, "tilted"), i as u64 + 100),
            mean(&of_bounded, i as u64 + 200),
        ];
        for (mean, error) in means {
            // The analytic density has the area of the tables, whose error it shares.
            assert!((mean - 1.0).abs() < 1e-4 + ERRORS * error, "{gamma}: {mean} +- {error}");
        }
    }
}
