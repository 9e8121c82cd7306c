//! Vectors that are not of unit length, infinite ones among them, give finite numbers.

use glam::Vec3;
use microfacet_sampler::lobe::{Batch, Tabulated};
use microfacet_sampler::{Ggx, Masking, Skew, Tables};

const INF: f32 = f32::INFINITY;
const PARTS: [f32; 16] = [
    0.0,
    1e-45,
    -1e-25,
    1e-25,
    1e-19,
    1e-10,
    0.6,
    -0.8,
    1.0,
    1e10,
    1e19,
    -1e20,
    1e20,
    f32::MAX,
    INF,
    -INF,
];

fn vectors() -> impl Iterator<Item = Vec3> {
    let of_x = |x: f32| PARTS.into_iter().flat_map(move |y| PARTS.map(|z| Vec3::new(x, y, z)));
    PARTS.into_iter().flat_map(of_x)
}

fn check(lobe: &(impl Tabulated + Batch), what: &str) {
    let usual = [Vec3::new(0.6, 0.0, 0.8), Vec3::X, Vec3::Z];
    let (mut views, mut batch) = (Vec::new(), Vec::new());
    for w in vectors() {
        let sound = |name: &str, x: f32| {
            assert!(x.is_finite() && x >= 0.0, "{what}: {name} of {w:?} is {x}");
        };
        sound("d", lobe.d(w));
        sound("g1", lobe.g1(w));
        for u in [[0.3, 0.7], [0.0, 1.0]] {
            let m = Vec3::from(lobe.sample_visible_normal(w, u));
            assert!((m.length() - 1.0).abs() < 1e-6 && m.z > 0.0, "{what}: {w:?} draws {m:?}");
        }
        for other in usual.into_iter().chain([w]) {
            for (v, m) in [(w, other), (other, w)] {
                sound("pdf", lobe.visible_normal_pdf(v, m));
                sound("table_pdf", lobe.table_pdf(v, m));
                sound("g2", lobe.g2(v, m, Masking::HeightCorrelated));
                sound("weight", lobe.reflection_weight(v, m, Masking::HeightCorrelated));
            }
        }
        views.push(w);
        batch.push([0.3, 0.7]);
    }
    let mut m = vec![Vec3::ZERO; views.len()];
    lobe.sample_batch(&views, &batch, &mut m).unwrap();
    for (v, m) in views.iter().zip(&m) {
        let sound = (m.length() - 1.0).abs() < 1e-6 && m.z > 0.0;
        assert!(sound, "{what}: {v:?} draws {m:?} in a batch");
    }
    let mut g1 = vec![f32::NAN; views.len()];
    lobe.g1_batch(&views, &mut g1).unwrap();
    assert!(g1.iter().all(|g1| (0.0..=1.0).contains(g1)), "{what}");
}

#[test]
fn numbers_are_finite() {
    for gamma in [1.501, 1.7, 1.8, 3.0, f64::INFINITY] {
        let tables = Tables::embedded();
        for sigma in [[0.5, 0.5], [1e-8, 1e6]] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let what = format!("gamma {gamma}, sigma {sigma:?}");
            check(&lobe, &what);
            if sigma[0] == 0.5 {
                check(&lobe.bounded(), &format!("bounded, {what}"));
            }
        }
        let skew = Skew::new([0.3, 0.5], [0.2, 0.1, 0.0]).unwrap();
        check(&tables.ellipsoid(skew, gamma).unwrap(), &format!("tilted, gamma {gamma}"));
    }
    check(&Ggx::new([0.5, 0.2]).unwrap(), "closed GGX");
}
