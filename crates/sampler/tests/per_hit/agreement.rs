//! Nothing bound, and the same lobe: normals, G1 and densities of a family are those of the lobe
//! that is bound to the same σ and γ.

use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{Masking, MicrofacetDistribution as _, Tables};

use super::*;

#[test]
fn a_family_has_the_normals_and_values_of_bound_lobes() {
    let (tables, family, mut random) = (Tables::embedded(), family(), random());
    let [mut whole, mut peeled, mut g1s, mut ds, mut pdfs, mut weights] =
        std::array::from_fn(|_| Worst::default());
    for gamma in gammas() {
        for sigma in SIGMAS {
            let lobe = family.at(sigma, gamma);
            let (bound, truth) = bound(&tables, &lobe);
            for z in COSINES {
                let v = view(z, random.random_range(-3.0..3.0));
                let what = || format!("{gamma:?} {sigma:?} {v:?}");
                let g1 = f64::from(lobe.g1(v));
                g1s.see((g1 - f64::from(bound.g1(v))).abs(), what);
                let l = view(random.random(), random.random_range(-3.0..3.0));
                for form in Masking::ALL {
                    let [a, b] =
                        [lobe.reflection_weight(v, l, form), bound.reflection_weight(v, l, form)];
                    weights.see(f64::from((a - b).abs()), what);
                }
                for _ in 0..4 {
                    let u = numbers(&mut random);
                    let what = || format!("{gamma:?} {sigma:?} {v:?} {u:?}");
                    let m = Vec3::from(lobe.sample_visible_normal(v, u));
                    let of = |m| numbers_of(&truth, v, m, u[0], bound.tabulated_share(v));
                    let ((got, beside), (want, _)) =
                        (of(m), of(bound.sample_visible_normal(v, u).into()));
                    let normals = if lobe.gamma() < 1.8 { &mut peeled } else { &mut whole };
                    for i in usize::from(beside)..2 {
                        normals.see((got[i] - want[i]).abs(), what);
                    }
                    let relative = |got: f32, want: f32| {
                        let [got, want] = [got, want].map(f64::from);
                        // What is almost 0 or more than can be held has no digits.
                        let held = (1e-30..1e30).contains(&want);
                        // The bound D of a small γ is a product of powers.
                        let powers = if gamma <= 16.0 { 2.0 + f64::from(gamma) } else { 0.0 };
                        let scale = exponent(lobe.sigma(), want) + powers;
                        if held { (got / want - 1.0).abs() / scale } else { 0.0 }
                    };
                    ds.see(relative(lobe.d(m), bound.d(m)), what);
                    let pdf = lobe.visible_normal_pdf(v, m);
                    pdfs.see(relative(pdf, bound.visible_normal_pdf(v, m)), what);
                    // It has no density of its own tables.
                    assert_eq!(lobe.table_pdf(v, m).to_bits(), pdf.to_bits());
                }
            }
        }
    }
    // The shares of the heavy part differ by so much.
    peeled.allowed(1e-5);
    whole.allowed(1e-6);
    g1s.allowed(2e-6);
    ds.allowed(4e-7);
    pdfs.allowed(4e-7);
    weights.allowed(5e-7);
}
