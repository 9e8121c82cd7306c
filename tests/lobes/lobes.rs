//! Every lobe gives the same results as itself and as a [`Lobe`], and agrees with its counterpart
//! in the model.

use std::sync::LazyLock;

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::classic::Gtr;
use microfacet_sampler::lobe::{Batch, Tabulated};
use microfacet_sampler::{Ggx, Lobe, Masking, MicrofacetDistribution, Skew, StudentT, Tables};

use crate::sets::{draft, recipe};

/// A set with a lobe of each kind. GGX is left to its closed forms.
static SET: LazyLock<Tables> = LazyLock::new(|| {
    let family = recipe(&[
        ["glass", "[0.3, 0.5]", "3.0", ""],
        ["steel", "0.2", "2.0", ""],
        ["brushed", "[0.4, 0.2]", "3.0", "theta = [0.05, -0.1, 0.5]"],
    ]);
    let paint = "[[material]]\nname = \"paint\"\ndistribution = \"gtr\"\nc = 0.2\ngamma = 1.5\n";
    draft(&(family + paint))
});

fn directions() -> impl Iterator<Item = Vec3> {
    let angles = [0.0, 0.4, 1.0, 1.4, 1.57, 1.7].into_iter();
    angles.flat_map(|theta: f32| {
        [0.3_f32, 2.0, -2.5].map(|phi| {
            let (sin, cos) = theta.sin_cos();
            Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
        })
    })
}

const NUMBERS: [[f32; 2]; 5] = [[0.0, 0.5], [0.2, 0.9], [0.5, 0.5], [0.8, 0.1], [1.0, 1.0]];

#[test]
fn a_name_gives_the_lobe_that_the_recipe_states() {
    let set = &*SET;
    assert!(matches!(set.material("glass"), Ok(Lobe::StudentT(_))));
    assert!(matches!(set.material("steel"), Ok(Lobe::Ggx(_))));
    assert!(matches!(set.material("brushed"), Ok(Lobe::Ellipsoid(_))));
    assert!(matches!(set.material("paint"), Ok(Lobe::Radial(_))));
    assert!(set.material("wood").unwrap_err().to_string().contains("\"paint\""));
}

#[test]
fn the_laws_hold_for_every_lobe() {
    for name in ["glass", "steel", "brushed", "paint"] {
        let lobe = SET.material(name).unwrap();
        for v in directions() {
            let g1 = lobe.g1(v);
            assert!((0.0..=1.0).contains(&g1) && (g1 > 0.0) == (v.z > 0.0), "{name} {v}: {g1}");
            assert_eq!(lobe.lambda(v), 1.0 / g1 - 1.0);
            for u in NUMBERS {
                let (m, pdf) = lobe.sample_with_pdf(v, u);
                assert_eq!(m, lobe.sample_visible_normal(v, u), "{name} {v} {u:?}");
                assert_eq!(pdf, lobe.visible_normal_pdf(v, m));
                let m = Vec3::from(m);
                assert!((m.length() - 1.0).abs() < 5e-7 && m.z > 0.0, "{name} {v} {u:?}: {m}");
                let l = 2.0 * v.dot(m) * m - v;
                for masking in Masking::ALL {
                    let weight = lobe.reflection_weight(v, l, masking);
                    assert!((0.0..=1.0 + 1e-6).contains(&weight), "{name} {v} {u:?}: {weight}");
                    assert!(weight == 0.0 || l.z > 0.0 && v.z > 0.0);
                    let (g2, quotient) = (lobe.g2(v, l, masking), weight * g1);
                    // A tilted lobe's G1 is clamped, and its weight is below G2/G1 there.
                    let clamped = name == "brushed" && g1 == 1.0;
                    assert!((g2 - quotient).abs() < 1e-6 || clamped, "{name} {v}: {g2} {quotient}");
                }
            }
        }
        let v: Vec<Vec3> = directions().collect();
        let u: Vec<_> = (0..v.len()).map(|i| NUMBERS[i % NUMBERS.len()]).collect();
        let (mut m, mut g1) = (vec![Vec3::ZERO; v.len()], vec![0.0; v.len()]);
        lobe.sample_batch(&v, &u, &mut m).unwrap();
        lobe.g1_batch(&v, &mut g1).unwrap();
        for i in 0..v.len() {
            let one = Vec3::from(lobe.sample_visible_normal(v[i], u[i]));
            assert!((m[i] - one).length() < 5e-7, "{name} {}: {} {one}", v[i], m[i]);
            assert!((g1[i] - lobe.g1(v[i])).abs() < 3e-7, "{name} {}", v[i]);
        }
        let error = lobe.g1_batch(&v, &mut g1[1..]).unwrap_err().to_string();
        assert!(error.contains("same length"), "{error}");
    }
}

#[test]
fn the_enum_answers_as_the_lobe_in_it() {
    fn all(lobe: &impl Tabulated, v: Vec3, m: Vec3) -> [f32; 5] {
        let l = 2.0 * v.dot(m) * m - v;
        let weight = lobe.reflection_weight(v, l, Masking::HeightCorrelated);
        [lobe.d(m), lobe.g1(v), lobe.visible_normal_pdf(v, m), lobe.table_pdf(v, m), weight]
    }
    let one: StudentT = Tables::embedded().student_t([0.3, 0.5], 1.6).unwrap();
    let any = Lobe::from(one.clone());
    for v in directions() {
        for u in NUMBERS {
            let m = any.sample_visible_normal(v, u);
            assert_eq!(m, one.sample_visible_normal(v, u));
            assert_eq!(all(&any, v, m.into()), all(&one, v, m.into()));
        }
    }
    assert_eq!(any.bytes(), one.bytes());
}

/// Largest differences of G1, D, the density of normals and weights from the model's, relative.
fn apart(
    lobe: &impl MicrofacetDistribution,
    truth: &impl model::MicrofacetDistribution,
) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for v in directions().filter(|v| v.z > 0.01) {
        for u in NUMBERS {
            let m = Vec3::from(lobe.sample_visible_normal(v, u));
            let (v64, m64) = (v.as_dvec3(), m.as_dvec3());
            let l: DVec3 = 2.0 * v64.dot(m64) * m64 - v64;
            if v64.dot(m64) < 1e-3 || m.z < 1e-6 || l.z < 1e-3 {
                continue;
            }
            let masking = Masking::HeightCorrelated;
            let pairs = [
                (lobe.g1(v), truth.g1(v64)),
                (lobe.d(m), truth.d(m64)),
                (lobe.visible_normal_pdf(v, m), truth.visible_normal_pdf(v64, m64)),
                (
                    lobe.reflection_weight(v, l.as_vec3(), masking),
                    truth.reflection_weight(v64, l, masking),
                ),
            ];
            for (worst, (got, want)) in worst.iter_mut().zip(pairs) {
                *worst = worst.max((f64::from(got) / want - 1.0).abs());
            }
        }
    }
    worst
}

#[test]
fn both_precisions_mean_the_same() {
    let tables = Tables::embedded();
    // G1, and values computed from it, within the error of the tables; D within single precision.
    let close =
        |[g1, d, pdf, weight]: [f64; 4]| g1 < 3e-5 && d < 1e-5 && pdf < 6e-5 && weight < 3e-5;
    for gamma in [1.6, 2.0, 3.0, f64::INFINITY] {
        let sigma = [0.3_f32, 0.5];
        let (lobe, truth) =
            (tables.student_t(sigma, gamma).unwrap(), model::StudentT::new(sigma, gamma).unwrap());
        let errors = apart(&lobe, &truth);
        assert!(close(errors), "gamma {gamma}: {errors:?}");
        let skew = Skew::new(sigma, [0.3, -0.2, 0.5]).unwrap();
        let (lobe, truth) =
            (tables.ellipsoid(skew, gamma).unwrap(), model::Ellipsoid::new(skew, gamma).unwrap());
        let errors = apart(&lobe, &truth);
        assert!(close(errors), "ellipsoid, gamma {gamma}: {errors:?}");
    }
    let (ggx, truth) = (Ggx::new(0.3_f32).unwrap(), model::StudentT::new(0.3_f32, 2.0).unwrap());
    let errors = apart(&ggx, &truth);
    assert!(errors.iter().all(|error| *error < 3e-6), "{errors:?}");
    // A distribution outside the family has tables of its own.
    let gtr = Gtr::new(0.2, 1.5).unwrap();
    let truth = model::classic::Radial::new(&gtr);
    let [g1, .., weight] = apart(&SET.material("paint").unwrap(), &truth);
    assert!(g1 < 1e-5 && weight < 1e-5, "{g1} {weight}");
    // The test can fail: another roughness is another lobe.
    let other = model::StudentT::new(0.301, 2.0).unwrap();
    assert!(!close(apart(&ggx, &other)));
}

#[test]
fn narrow_lobes_say_that_they_are_mirrors() {
    let tables = Tables::embedded();
    assert!(tables.student_t(9.9e-4, 3.0).unwrap().is_effectively_smooth());
    // The mean slope of GGX is alpha; near γ = 3/2 a tenth of visible normals is far off n.
    assert!(tables.student_t(9.9e-4, 2.0).unwrap().is_effectively_smooth());
    assert!(!tables.student_t(1.01e-3, 2.0).unwrap().is_effectively_smooth());
    assert!(!tables.student_t(9.9e-4, 1.501).unwrap().is_effectively_smooth());
    assert!(!tables.student_t([9.9e-4, 0.1], 3.0).unwrap().is_effectively_smooth());
    assert!(Ggx::new(9.9e-4).unwrap().is_effectively_smooth());
    let tilted = |turn| tables.ellipsoid(Skew::new(5e-4, [turn, 0.0, 0.0]).unwrap(), 3.0).unwrap();
    assert!(tilted(0.0).is_effectively_smooth());
    // A mirror, but tilted against the surface.
    assert!(!tilted(0.1).is_effectively_smooth());
}

#[test]
fn an_ellipsoid_knows_the_density_of_its_samples() {
    let tables = Tables::embedded();
    // The analytic density has no error of tables, which the coarse tables of the draft set show.
    let draft = SET.material("brushed").unwrap();
    for gamma in [1.6, 3.0] {
        let straight = tables.ellipsoid(Skew::new([0.3, 0.5], [0.0; 3]).unwrap(), gamma).unwrap();
        let same = tables.student_t([0.3, 0.5], gamma).unwrap();
        for v in directions().filter(|v| v.z > 0.0) {
            for u in NUMBERS.into_iter().filter(|u| u[0] > 0.0 && u[0] < 1.0) {
                let m = same.sample_visible_normal(v, u);
                let ratio = straight.table_pdf(v, m) / same.table_pdf(v, m);
                assert!((ratio - 1.0).abs() < 1e-4, "gamma {gamma}, {v} {u:?}: {ratio}");
            }
        }
    }
    // The mean over samples of analytic over drawn density is the former's integral.
    const STEPS: u16 = 200;
    for v in directions().filter(|v| v.z > 0.1) {
        let at = |i: u16| (f32::from(i) + 0.5) / f32::from(STEPS);
        let (mut sum, mut apart) = (0.0, 0.0_f64);
        for u in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| [at(i), at(j)])) {
            let m = draft.sample_visible_normal(v, u);
            let ratio = f64::from(draft.visible_normal_pdf(v, m) / draft.table_pdf(v, m));
            sum += ratio;
            apart = apart.max((ratio - 1.0).abs());
        }
        let integral = sum / f64::from(STEPS).powi(2);
        assert!((integral - 1.0).abs() < 1e-4, "{v}: {integral}");
        assert!(apart > 1e-4, "{v}: the densities do not differ");
    }
}

/// Weights of views down to the smallest numbers above the horizon: G2 and G1 vanish together, and
/// their computed quotient would be arbitrary.
#[test]
fn weights_of_grazing_views_are_those_of_the_model() {
    let skew = Skew::new([0.4, 0.2], [0.05, -0.1, 0.5]).unwrap();
    let truth: [(&str, Box<dyn model::MicrofacetDistribution>); 3] = [
        ("glass", Box::new(model::StudentT::new([0.3_f32, 0.5], 3.0).unwrap())),
        ("steel", Box::new(model::StudentT::new(0.2_f32, 2.0).unwrap())),
        ("brushed", Box::new(model::Ellipsoid::new(skew, 3.0).unwrap())),
    ];
    for z in [1e-3, 1e-10, 1e-20, 1e-30, 1e-37, 1e-40, 1e-44_f32] {
        for phi in [0.0_f32, 1.0, 2.5, -1.0] {
            let v = Vec3::new(phi.cos(), phi.sin(), z);
            for l in directions().filter(|l| l.z > 0.01) {
                for masking in Masking::ALL {
                    for (name, truth) in &truth {
                        let lobe = SET.material(name).unwrap();
                        let weight = f64::from(lobe.reflection_weight(v, l, masking));
                        let want = truth.reflection_weight(v.as_dvec3(), l.as_dvec3(), masking);
                        let close = (weight - want).abs() < 2e-3;
                        assert!(close && weight <= 1.0 + 1e-6, "{name} {v} {l}: {weight} {want}");
                    }
                    let paint = SET.material("paint").unwrap().reflection_weight(v, l, masking);
                    assert!((0.0..=1.0 + 1e-6).contains(&paint), "{v} {l}: {paint}");
                }
            }
        }
    }
}
