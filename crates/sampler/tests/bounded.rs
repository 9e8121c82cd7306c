//! Normals bounded for reflection: nothing that reflects upwards is lost, and estimates agree.

use glam::Vec3;
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{Masking, MicrofacetDistribution, StudentT, Tables};

fn materials() -> impl Iterator<Item = StudentT> {
    let tables = Tables::embedded();
    [1.55, 1.9, 3.0, f64::INFINITY].into_iter().flat_map(move |gamma| {
        let tables = tables.clone();
        [[0.4, 0.4], [1.5, 1.5], [0.2, 0.9]].map(|sigma| tables.student_t(sigma, gamma).unwrap())
    })
}

fn views() -> impl Iterator<Item = Vec3> {
    [0.0, 0.1, 0.6, 1.1, 1.45, 1.57].into_iter().flat_map(|theta: f32| {
        [0.3, 2.0].map(|phi: f32| {
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        })
    })
}

fn reflect(v: Vec3, m: [f32; 3]) -> Vec3 {
    let m = Vec3::from(m);
    2.0 * v.dot(m) * m - v
}

/// White-furnace weight of a reflection.
fn weight(material: &StudentT, v: Vec3, m: [f32; 3]) -> f64 {
    let l = reflect(v, m);
    if l.z > 0.0 {
        f64::from(material.g2(v, l, Masking::HeightCorrelated) / material.g1(v))
    } else {
        0.0
    }
}

fn grid(n: u32) -> impl Iterator<Item = [f32; 2]> {
    let at = move |i: u32| (i as f32 + 0.5) / n as f32;
    (0..n).flat_map(move |i| (0..n).map(move |j| [at(i), at(j)]))
}

#[test]
fn bounding_changes_no_mean_and_lowers_the_variance() {
    let (mut best, n) = (1.0_f64, 200);
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            let share = f64::from(bounded.share());
            assert!(share > 0.0 && share <= 1.0, "{v}: {share}");
            let (mut means, mut squares) = ([0.0; 2], [0.0; 2]);
            for u in grid(n) {
                let both = [
                    weight(&material, v, material.sample_visible_normal(v, u)),
                    weight(&material, v, bounded.sample(u)) * share,
                ];
                for i in 0..2 {
                    means[i] += both[i] / f64::from(n * n);
                    squares[i] += both[i] * both[i] / f64::from(n * n);
                }
            }
            let what = format!("{:?} {} {v}: {means:?}", material.sigma(), material.gamma());
            // The midpoint rule errs at a jump along a curve by a fraction of the cells that the
            // curve crosses.
            assert!((means[0] - means[1]).abs() < 2.0 / f64::from(n), "{what}");
            let variance = |i: usize| squares[i] - means[i] * means[i];
            assert!(variance(1) <= variance(0) + 0.01, "{what} {} {}", variance(0), variance(1));
            best = best.min(variance(1) / variance(0).max(1e-3));
        }
    }
    assert!(best < 0.5, "the variance never falls below {best} of the unbounded");
}

#[test]
fn nothing_that_reflects_upwards_is_lost() {
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            // The ends of the interval are its first and last normal: upward reflections lie
            // between them.
            let tilt = |[x, y, z]: [f32; 3]| {
                // In unit space, along the stretched azimuth.
                let [sx, sy] = material.sigma();
                let (ax, ay) = (sx * v.x, sy * v.y);
                let rho = ax.hypot(ay);
                let (ax, ay) = if rho > 0.0 { (ax / rho, ay / rho) } else { (1.0, 0.0) };
                (x / sx * ax + y / sy * ay) / z
            };
            let [first, last] = [0.0, 1.0].map(|u| tilt(bounded.sample([u, 0.5])));
            for u in grid(100) {
                let m = material.sample_visible_normal(v, u);
                if reflect(v, m).z > 1e-5 {
                    let x = tilt(m);
                    let slack = 1e-4 * (1.0 + x.abs());
                    assert!(
                        x >= first - slack && (x <= last + slack || bounded.share() > 0.999),
                        "{v} {u:?}: {x} {first} {last}"
                    );
                }
            }
        }
    }
}

#[test]
fn densities_are_those_of_visible_normals_over_the_share() {
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            let m = bounded.sample([0.4, 0.3]);
            let ratio =
                bounded.visible_normal_pdf(m) * bounded.share() / material.visible_normal_pdf(v, m);
            assert!((ratio - 1.0).abs() < 1e-6);
            let ratio = bounded.table_pdf(m) * bounded.share() / material.table_pdf(v, m);
            assert!((ratio - 1.0).abs() < 1e-6, "{v}");
        }
    }
}
