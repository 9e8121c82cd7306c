//! Pseudo-visible normals: the model's for the same numbers, its density, χ², and corners.

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::statistics::{ChiSquare, sidak, test_normals};
use microfacet_sampler::lobe::PseudoVisible;
use microfacet_sampler::{Ggx, MicrofacetDistribution as _, Tables};

const GAMMAS: [f64; 7] = [1.501, 1.6, 1.9, 2.5, 4.0, 40.0, f64::INFINITY];
const SIGMAS: [[f32; 2]; 4] = [[0.3, 0.3], [0.5, 0.1], [1e-3, 2e-3], [6.0, 3.0]];

fn views() -> impl Iterator<Item = Vec3> {
    [1.0, 0.999, 0.9, 0.5, 0.1, 1e-3, 0.0].into_iter().map(|z: f32| {
        let r = ((1.0 - z) * (1.0 + z)).sqrt();
        Vec3::new(0.8 * r, -0.6 * r, z)
    })
}

type Sampler<'a> = &'a dyn Fn(Vec3, [f32; 2]) -> Vec3;
type Density<'a> = &'a dyn Fn(Vec3, Vec3) -> f32;

/// Calls `each` for a lobe of every kind, with the model's.
fn lobes(each: &mut dyn FnMut(&str, Sampler, Density, &model::StudentT)) {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    for sigma in SIGMAS {
        let exact = |gamma| model::StudentT::new(sigma.map(f64::from), gamma).unwrap();
        for gamma in GAMMAS {
            let bound = tables.student_t(sigma, gamma).unwrap();
            let per_hit = family.at(sigma, gamma as f32);
            each(
                &format!("{sigma:?} {gamma}"),
                &|v, u| bound.sample_pseudo_visible_normal(v, u).into(),
                &|v, m| bound.pseudo_visible_normal_pdf(v, m),
                &exact(gamma),
            );
            each(
                &format!("per hit {sigma:?} {gamma}"),
                &|v, u| per_hit.sample_pseudo_visible_normal(v, u).into(),
                &|v, m| per_hit.pseudo_visible_normal_pdf(v, m),
                &exact(per_hit.gamma()),
            );
        }
        let ggx = Ggx::new(sigma).unwrap();
        each(
            &format!("ggx {sigma:?}"),
            &|v, u| ggx.sample_pseudo_visible_normal(v, u).into(),
            &|v, m| ggx.pseudo_visible_normal_pdf(v, m),
            &exact(2.0),
        );
    }
}

/// The distance of two normals in unit space.
fn apart(truth: &model::StudentT, a: Vec3, b: DVec3) -> f64 {
    let slopes = |m: DVec3| {
        let (x, y) = (m.x / truth.sigma_x(), m.y / truth.sigma_y());
        let length = (x * x + y * y + m.z * m.z).sqrt();
        DVec3::new(x, y, m.z) / length
    };
    (slopes(a.as_dvec3()) - slopes(b)).length()
}

#[test]
fn normals_and_densities_are_those_of_the_model() {
    lobes(&mut |name, sample, pdf, truth| {
        for v in views() {
            for i in 0..400 {
                // Also far into both ends.
                let t = f64::from(i) / 400.0;
                let u = [t, (t * 157.3).fract()].map(|u| u as f32);
                let m = sample(v, u);
                let want = truth.sample_pseudo_visible_normal(v.as_dvec3(), u.map(f64::from));
                // Next to the silhouette the azimuth is a root of the number, whose rounding it
                // magnifies, and there are few normals.
                let few = (truth.pseudo_visible_normal_pdf(v.as_dvec3(), want)
                    / (truth.d(want) * want.z))
                    .max(1e-3);
                let off = apart(truth, m, want);
                assert!(off * few < 4e-6, "{name} {v} {u:?}: {m} for {want}, {off:e}");
                let (got, exact) = (
                    f64::from(pdf(v, m)),
                    truth.pseudo_visible_normal_pdf(v.as_dvec3(), m.as_dvec3()),
                );
                if exact > 1e-30 && exact < 1e30 {
                    let facing = f64::from(v.dot(m)).max(1e-12);
                    let error = (got / exact - 1.0).abs();
                    assert!(error < 3e-5 + 3e-7 / facing, "{name} {v} {u:?}: {got} for {exact}");
                }
            }
        }
    });
}

#[test]
fn normals_have_their_density() {
    const SAMPLES: usize = 40_000;
    let judge =
        |truth: &model::StudentT, v: Vec3, sample: &dyn Fn([f32; 2]) -> Vec3| -> ChiSquare {
            let v = v.as_dvec3();
            test_normals(truth, |m| truth.pseudo_visible_normal_pdf(v, m), SAMPLES, 5, sample)
        };
    let level = sidak(0.01, SIGMAS.len() * (GAMMAS.len() + 1) * views().count());
    lobes(&mut |name, sample, _, truth| {
        // Lobes at a hit draw the same to rounding.
        if name.starts_with("per hit") {
            return;
        }
        for v in views() {
            let test = judge(truth, v, &|u| sample(v, u));
            assert!(test.p > level, "{name} {v}: {test:?}");
        }
    });
    // Visible normals differ, as does another view.
    let lobe = Tables::embedded().student_t(0.5, 2.5).unwrap();
    let truth = model::StudentT::new(0.5, 2.5).unwrap();
    let (v, other) = (Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.6, 0.0, 0.8));
    let visible = judge(&truth, v, &|u| lobe.sample_visible_normal(v, u).into());
    let turned = judge(&truth, v, &|u| lobe.sample_pseudo_visible_normal(other, u).into());
    assert!(visible.p < level && turned.p < level, "{visible:?} {turned:?}");
}

#[test]
fn normals_are_of_unit_length_and_face_the_view_at_every_corner() {
    let ends =
        [0.0, f32::from_bits(1), 1e-9, 0.25, 0.5, 1.0 - f32::EPSILON, 1.0, 2.0, -1.0, f32::NAN];
    let odd = [-Vec3::Z, Vec3::X, Vec3::new(0.6, 0.0, -0.8), Vec3::new(1.0, 1e-30, 1e-30)];
    let tables = Tables::embedded();
    for sigma in [[1e-8, 1e-8], [0.3, 0.1], [1e6, 1e-8], [1e6, 1e6]] {
        for gamma in [1.501, 1.6, 2.0, 2.5, 1e4, f64::INFINITY] {
            let bound = tables.student_t(sigma, gamma).unwrap();
            let ggx = Ggx::new(sigma).unwrap();
            for v in views().chain(odd) {
                for u in ends.into_iter().flat_map(|a| ends.map(|b| [a, b])) {
                    let drawn = [
                        (bound.sample_pseudo_visible_normal(v, u), 0),
                        (ggx.sample_pseudo_visible_normal(v, u), 1),
                    ];
                    for (m, of) in drawn {
                        let at = format!("{sigma:?} {gamma} {v} {u:?}: {m:?}");
                        let pdf = match of {
                            0 => bound.pseudo_visible_normal_pdf(v, m),
                            _ => ggx.pseudo_visible_normal_pdf(v, m),
                        };
                        let m = Vec3::from(m);
                        assert!((m.length() - 1.0).abs() < 1e-6 && m.z > 0.0, "{at}");
                        assert!(v.with_z(v.z.max(0.0)).dot(m) > -5e-7, "{at}");
                        assert!((0.0..=f32::MAX).contains(&pdf), "{at}: {pdf}");
                    }
                }
            }
        }
    }
    let ggx = Ggx::new(0.3).unwrap();
    for (v, m) in
        [(Vec3::Z, -Vec3::Z), (Vec3::NAN, Vec3::Z), (Vec3::X, Vec3::Z), (Vec3::X, -Vec3::X)]
    {
        assert_eq!(ggx.pseudo_visible_normal_pdf(v, m), 0.0, "{v} {m}");
    }
}
