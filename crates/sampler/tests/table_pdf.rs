//! `table_pdf` is the density of what the sampler draws: never 0 at a drawn normal, and a divisor
//! that leaves no bias; and `sample_with_table_pdf` returns it beside the normal.

use glam::{DVec3, Vec3};
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{Ggx, Skew, Tables};
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
            let (m, table) = at.sample_with_table_pdf(u);
            let (m, table) = (Vec3::from(m), f64::from(table));
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

/// How far densities of views and normals that rounding cannot tell from these are from `density`,
/// as a logarithm; infinite at the silhouette.
fn spread(lobe: &impl Tabulated, v: Vec3, m: Vec3, density: f32) -> f64 {
    // Five roundings of a component near 1.
    let around = |w: Vec3| {
        let (x, y) = w.any_orthonormal_pair();
        [x, -x, y, -y, x + y, x - y, y - x, -x - y].map(|aside| (w + 3e-7 * aside).normalize())
    };
    let near = around(v).map(|v| (v, m)).into_iter().chain(around(m).map(|m| (v, m)));
    let far = |(v, m)| (f64::from(lobe.table_pdf(v, m)) / f64::from(density)).ln().abs();
    near.map(far).fold(0.0, f64::max)
}

/// A draw with its density is that normal and that density. The density of a draw is found from the
/// numbers, `table_pdf` from the normal, whose components are rounded as those of the view are: the
/// two differ as densities so close to each other do, and by the rounding of the result.
#[test]
fn a_density_drawn_with_a_normal_is_that_of_the_normal() {
    /// The rounding of a sum of three products, of a cell's coefficients and of the result.
    const ROUNDING: f64 = 2e-6;
    fn check(lobe: &impl Tabulated, views: &[Vec3], random: &mut StdRng, what: &str) -> [usize; 2] {
        const ENDS: [f32; 7] = [0.0, 1e-30, 6e-8, 0.5, 0.501, 1.0 - 6e-8, 1.0];
        let mut numbers: Vec<_> = ENDS.iter().flat_map(|&a| ENDS.map(|b| [a, b])).collect();
        numbers.extend((0..40).map(|_| -> [f32; 2] { random.random() }));
        numbers.extend(ENDS.map(|end| [end, random.random()]));
        numbers.extend(ENDS.map(|end| [random.random(), end]));
        let mut close = [0; 2];
        for &v in views {
            for &u in &numbers {
                let (m, density) = lobe.sample_with_table_pdf(v, u);
                let place = || format!("{what}, v {v}, u {u:?}, m {m:?}");
                assert_eq!(m, lobe.sample_visible_normal(v, u), "{}", place());
                let table = lobe.table_pdf(v, m);
                let off = (f64::from(density) / f64::from(table)).ln().abs();
                let spread = if density == table { 0.0 } else { spread(lobe, v, m.into(), table) };
                assert!(
                    density == table || off <= ROUNDING + 2.0 * spread,
                    "{}: {density:e} for {table:e}, off {off:e} of {spread:e}",
                    place()
                );
                close[usize::from(spread < 1e-4)] += 1;
            }
        }
        close
    }
    let (mut random, mut close) = (StdRng::seed_from_u64(3), [0; 2]);
    let tables = Tables::embedded();
    let mut views: Vec<_> = (0..12).map(|_| direction(&mut random)).collect();
    let grazing = [1e-2, 1e-4, 0.0, -0.3_f32].map(|z| {
        let r = (1.0 - z * z).sqrt();
        Vec3::new(0.8 * r, -0.6 * r, z)
    });
    views.extend([Vec3::Z, Vec3::X, Vec3::new(1e-8, 0.0, 1.0), Vec3::new(0.0, 1e-20, 1.0)]);
    views.extend(grazing);
    for gamma in [1.501, 1.55, 1.6, 1.799, 1.8, 2.0, 3.0, 9.0, 1e6, f64::INFINITY] {
        for sigma in [[0.3, 0.3], [1e-8, 1e-8], [1e-3, 1e-3], [1e6, 1e6], [2.0, 0.1], [1e-4, 3.0]] {
            let what = format!("gamma {gamma}, sigma {sigma:?}");
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let skew = Skew::new(sigma.map(|x: f64| x.clamp(1e-3, 3.0)), [0.2, 0.1, 0.4]).unwrap();
            let tilted = tables.ellipsoid(skew, gamma).unwrap();
            for [far, near] in [
                check(&lobe, &views, &mut random, &what),
                check(&tilted, &views, &mut random, &format!("{what}, tilted")),
            ] {
                close = [close[0] + far, close[1] + near];
            }
        }
    }
    // Most comparisons are sharp.
    assert!(close[1] > 2 * close[0], "{close:?}");
    // Those of other lobes are the two functions, one after the other.
    check(&Ggx::new([0.3, 0.5]).unwrap(), &views, &mut random, "GGX");
    check(&tables.family().unwrap().at([0.3, 0.5], 2.5), &views, &mut random, "family");
    let lobe = tables.student_t([0.3, 0.5], 2.5).unwrap();
    check(&lobe.with_roughness([0.2, 0.9]), &views, &mut random, "another roughness");
    let bounded = lobe.bounded();
    for v in views {
        for u in [[0.0, 0.3], [0.4, 0.6], [0.99, 0.1]] {
            let at = bounded.at(v);
            let (m, density) = at.sample_with_table_pdf(u);
            assert_eq!(m, at.sample(u));
            let off = (density / at.table_pdf(m)).ln().abs();
            assert!(density == at.table_pdf(m) || f64::from(off) < 1e-4, "{v} {u:?}: {off}");
        }
    }
}
