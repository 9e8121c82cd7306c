//! Pseudo-visible normals against their density: its integral, the Jacobian of the sampler, χ², and
//! what is left of the visible normals.

use glam::DVec3;
use microfacet_model::statistics::{sidak, test_normals};
use microfacet_model::{MicrofacetDistribution, StudentT};

const GAMMAS: [f64; 7] = [1.501, 1.6, 2.0, 2.5, 4.0, 40.0, f64::INFINITY];
const SIGMAS: [[f64; 2]; 3] = [[0.3, 0.3], [0.5, 0.1], [1e-3, 2e-3]];

/// Views from the normal to the horizon.
fn views() -> impl Iterator<Item = DVec3> {
    [1.0, 0.9, 0.5, 0.1, 1e-3, 1e-9, 0.0].into_iter().map(|z: f64| {
        let r = ((1.0 - z) * (1.0 + z)).sqrt();
        DVec3::new(0.8 * r, -0.6 * r, z)
    })
}

fn lobes() -> impl Iterator<Item = StudentT> {
    GAMMAS.into_iter().flat_map(|g| SIGMAS.map(|sigma| StudentT::new(sigma, g).unwrap()))
}

/// ∫ pdf dm, by as many normals of D: x ↦ −x leaves out what the kinks would cost.
#[test]
fn the_density_integrates_to_one() {
    for lobe in lobes() {
        for v in views() {
            let mut sum = 0.0;
            for i in 0..64 {
                for j in 0..64 {
                    let u = [i, j].map(|i| (f64::from(i) + 0.5) / 64.0);
                    let m = lobe.sample_ndf(u);
                    sum += lobe.pseudo_visible_normal_pdf(v, m) / (lobe.d(m) * m.z);
                }
            }
            // Rounded normals are on either side of a silhouette through many of them.
            assert!((sum / 4096.0 - 1.0).abs() < 1e-9, "{lobe:?} {v}: {sum}");
        }
    }
}

/// The area of normals to which the sampler takes an area of numbers is its share of the density.
#[test]
fn the_density_is_the_jacobian_of_the_sampler() {
    const H: f64 = 1e-5;
    let mut compared = 0;
    for lobe in lobes() {
        for v in views() {
            for i in 0..12 {
                for j in 0..23 {
                    let u = [(f64::from(i) + 0.5) / 12.0, (f64::from(j) + 0.37) / 23.0];
                    let at = |a: f64, b: f64| {
                        lobe.sample_pseudo_visible_normal(v, [u[0] + a * H, u[1] + b * H])
                    };
                    // Fourth order, from both sides.
                    let slope = |a: f64, b: f64| {
                        (8.0 * (at(a, b) - at(-a, -b))
                            - (at(2.0 * a, 2.0 * b) - at(-2.0 * a, -2.0 * b)))
                            / (12.0 * H)
                    };
                    let (m, area) = (at(0.0, 0.0), slope(1.0, 0.0).cross(slope(0.0, 1.0)).length());
                    let pdf = lobe.pseudo_visible_normal_pdf(v, m);
                    // Not across a kink of the map, nor where it is steep at the scale of H.
                    let near = |a: f64, b: f64| lobe.pseudo_visible_normal_pdf(v, at(a, b));
                    let smooth = [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)]
                        .into_iter()
                        .all(|(a, b)| (near(a, b) / pdf - 1.0).abs() < 1e-3);
                    if smooth {
                        compared += 1;
                        assert!(
                            (pdf * area - 1.0).abs() < 1e-6,
                            "{lobe:?} {v} {u:?}: {}",
                            pdf * area
                        );
                    }
                }
            }
        }
    }
    assert!(compared > 30_000, "{compared}");
}

#[test]
fn normals_have_their_density() {
    let cases: Vec<(StudentT, DVec3)> =
        lobes().flat_map(|lobe| views().map(move |v| (lobe, v))).collect();
    let level = sidak(0.01, cases.len());
    let judge = |lobe: &StudentT, v: DVec3, drawn_from: DVec3| {
        test_normals(
            lobe,
            |m| lobe.pseudo_visible_normal_pdf(v, m),
            50_000,
            3,
            |u| lobe.sample_pseudo_visible_normal(drawn_from, u.map(f64::from)).as_vec3(),
        )
    };
    for (lobe, v) in &cases {
        let test = judge(lobe, *v, *v);
        assert!(test.p > level, "{lobe:?} {v}: {test:?}");
    }
    // Normals for a view on the other side of the frame, and normals of D, are rejected.
    let (lobe, v) = (StudentT::new([0.5, 0.1], 2.5).unwrap(), DVec3::new(0.48, -0.64, 0.6));
    assert!(judge(&lobe, v, DVec3::new(0.48, 0.64, 0.6)).p < level);
    assert!(judge(&lobe, v, DVec3::Z).p < level);
}

/// visible = G1 · pseudo-visible + (1 − G1) · excess.
#[test]
fn visible_normals_are_g1_of_pseudo_visible_ones_and_an_excess() {
    for lobe in lobes() {
        for v in views().filter(|v| v.z > 0.0) {
            let g1 = lobe.g1(v);
            let mut excess = 0.0;
            for i in 0..32 {
                for j in 0..32 {
                    let u = [i, j].map(|i| (f64::from(i) + 0.5) / 32.0);
                    let m = lobe.sample_visible_normal(v, u);
                    let visible = lobe.visible_normal_pdf(v, m);
                    let pseudo = lobe.pseudo_visible_normal_pdf(v, m);
                    let rest = (visible - g1 * pseudo) / visible;
                    assert!(rest > -1e-9, "{lobe:?} {v} {u:?}: {rest}");
                    excess += rest;
                    if v.dot(m) < 2.0 * v.z * m.z * (1.0 - 1e-9) {
                        assert!(rest.abs() < 1e-9, "{lobe:?} {v} {u:?}: {rest}");
                    }
                }
            }
            assert!((excess / 1024.0 - (1.0 - g1)).abs() < 0.01, "{lobe:?} {v}: {excess} {g1}");
        }
    }
}

#[test]
fn corners_are_finite_and_face_the_view() {
    let ends = [0.0, 1e-300, 1e-17, 0.25, 0.5, 0.75, 1.0 - 1e-16, 1.0];
    for gamma in [1.500_001, 1.501, 2.0, 1e9, f64::INFINITY] {
        for sigma in [1e-8, 0.5, 1e6] {
            let lobe = StudentT::new([sigma, 0.7 * sigma], gamma).unwrap();
            let below = DVec3::new(0.6, 0.0, -0.8);
            for v in views().chain([below, -DVec3::Z]) {
                for u in ends.into_iter().flat_map(|a| ends.map(|b| [a, b])) {
                    let m = lobe.sample_pseudo_visible_normal(v, u);
                    assert!((m.length() - 1.0).abs() < 1e-14 && m.z > 0.0, "{lobe:?} {v} {u:?}");
                    let facing = v.with_z(v.z.max(0.0)).dot(m);
                    assert!(facing > -1e-14, "{lobe:?} {v} {u:?}: {facing}");
                    let pdf = lobe.pseudo_visible_normal_pdf(v, m);
                    assert!((0.0..=f64::MAX).contains(&pdf), "{lobe:?} {v} {u:?}: {pdf}");
                    if v.z > 0.0 {
                        let l = 2.0 * v.dot(m) * m - v;
                        assert!(l.is_finite());
                    }
                }
            }
        }
    }
}
