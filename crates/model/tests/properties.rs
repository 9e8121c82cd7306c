//! Laws that the model obeys for every roughness, shape and direction; edge values are generated as
//! often as ordinary ones.

#![allow(
    clippy::disallowed_methods,
    reason = "only what is baked must be the same on every system"
)]

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use microfacet_model::{
    Masking, MicrofacetDistribution, Shape, SignedSlope, StudentT, UnitView, VisibleSlope,
    across_cdf, across_quantile,
};
use proptest::prelude::*;

/// Shapes from just above 3/2 to Beckmann.
fn gamma() -> impl Strategy<Value = f64> {
    let near = [1.5_f64.next_up(), 1.5 + 1e-6, 1.501, 1.8, 2.0, 2.5];
    let edges = [&near[..], &[1e4, 1e15, 1e16, 1e300, f64::INFINITY]].concat();
    prop_oneof![
        prop::sample::select(edges),
        1.5001..12.0,
        (2.0..16.0_f64).prop_map(|x| 10_f64.powf(x))
    ]
}

fn sigma() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::sample::select(vec![1e-12, 1e-4, 1.0, 1e4]),
        (-4.0..1.0_f64).prop_map(|x| 10_f64.powf(x))
    ]
}

fn theta() -> impl Strategy<Value = f64> {
    let edges = vec![0.0, 1e-300, 1e-9, 1e-4, FRAC_PI_2 - 1e-4, FRAC_PI_2 - 1e-9, FRAC_PI_2];
    prop_oneof![prop::sample::select(edges), 0.0..FRAC_PI_2]
}

fn direction() -> impl Strategy<Value = DVec3> {
    (theta(), -PI..PI).prop_map(|(theta, phi)| at(theta, phi))
}

fn at(theta: f64, phi: f64) -> DVec3 {
    let (sin, cos) = theta.sin_cos();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(vec![0.0, 1e-300, 1e-12, 0.5, 1.0 - 1e-12, 1.0]), 0.0..1.0]
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    a == b || (a - b).abs() <= relative * a.abs().max(b.abs()) + 1e-290
}

/// How far behind the silhouette rounding may put a normal: a slope z is held as a rapidity
/// asinh(√s z), whose rounding is a relative error of this size in z.
fn hidden(t: &StudentT, v: DVec3) -> f64 {
    let (view, _) = t.unit_view(v);
    1e-15 + f64::EPSILON * (t.shape().s().sqrt() * view.cos / view.sin).asinh()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn masking_is_reciprocal_and_ordered(
        x in sigma(), y in sigma(), gamma in gamma(), v in direction(), l in direction(),
    ) {
        let t = StudentT::new([x, y], gamma).unwrap();
        let [separate, joint] = [Masking::Uncorrelated, Masking::HeightCorrelated].map(|masking| t.g2(v, l, masking));
        prop_assert_eq!(separate, t.g2(l, v, Masking::Uncorrelated));
        prop_assert!(close(joint, t.g2(l, v, Masking::HeightCorrelated), 1e-15));
        // A facet hidden from one direction tends to be hidden from the other: correlation raises
        // G2, at most to the smaller G1.
        prop_assert!(0.0 <= separate && separate <= joint * (1.0 + 1e-14));
        prop_assert!(joint <= t.g1(v).min(t.g1(l)) * (1.0 + 1e-14) && joint <= 1.0);
    }

    #[test]
    fn stretching_sigma_stretches_slopes(
        x in sigma(), y in sigma(), gamma in gamma(), scale in 0.1..10.0_f64, slope in [-30.0..30.0_f64, -30.0..30.0],
        theta in 0.001..1.57_f64, phi in -PI..PI,
    ) {
        let (t, wide) =
            (StudentT::new([x, y], gamma).unwrap(), StudentT::new([x * scale, y * scale], gamma).unwrap());
        let [a, b] = slope.map(|unit| unit * x.min(y));
        // The exponent magnifies rounding: γ ln(1 + s r²) may be large.
        let density = t.p22(a, b);
        let tolerance = 1e-13 * (10.0 + density.max(1e-300).ln().abs());
        prop_assert!(close(wide.p22(a * scale, b * scale) * scale * scale, density, tolerance) || density < 1e-250);
        // A view whose tangent is smaller by the same factor sees the same share.
        let steep = libm::atan(theta.tan() / scale);
        prop_assert!(close(wide.g1(at(steep, phi)), t.g1(at(theta, phi)), 1e-9));
    }

    #[test]
    fn turning_view_and_material_together_changes_nothing(
        x in sigma(), y in sigma(), gamma in gamma(), theta in theta(), phi in -PI..PI, m in direction(),
    ) {
        let round = StudentT::new(x, gamma).unwrap();
        prop_assert!(close(round.g1(at(theta, phi)), round.g1(at(theta, 0.0)), 1e-11));
        let (t, turned) = (StudentT::new([x, y], gamma).unwrap(), StudentT::new([y, x], gamma).unwrap());
        let quarter = |w: DVec3| DVec3::new(-w.y, w.x, w.z);
        let v = at(theta, phi);
        prop_assert_eq!(t.g1(v), turned.g1(quarter(v)));
        prop_assert_eq!(t.d(m), turned.d(quarter(m)));
        // Mirror images: the distribution is even in either slope.
        for mirror in [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0)] {
            prop_assert_eq!(t.g1(v), t.g1(v * mirror));
            prop_assert_eq!(t.d(m), t.d(m * mirror));
        }
    }

    #[test]
    fn mirrored_numbers_give_mirrored_normals(
        x in sigma(), y in sigma(), gamma in gamma(), theta in 1e-6..FRAC_PI_2, phi in -PI..PI, u in number(),
        across in prop::sample::select(vec![0.0, 0.125, 0.25, 0.5, 0.75, 1.0]),
    ) {
        let t = StudentT::new([x, y], gamma).unwrap();
        let flip = DVec3::new(1.0, -1.0, 1.0);
        let v = at(theta, phi);
        let (a, b) = (t.sample_visible_normal(v, [u, across]), t.sample_visible_normal(v * flip, [u, 1.0 - across]));
        prop_assert!((a - b * flip).length() < 1e-13, "{a} {b}");
        prop_assert!((a.length() - 1.0).abs() < 1e-15 && a.z >= 0.0);
        prop_assert!(a.dot(v) > -hidden(&t, v), "{a}");
    }

    #[test]
    fn the_silhouette_of_smooth_surfaces_is_met(gamma in gamma(), theta in 1e-6..FRAC_PI_2, phi in -PI..PI) {
        // u = 0 is the silhouette itself, here at a unit slope of some 1e12.
        let (t, v) = (StudentT::new(1e-12, gamma).unwrap(), at(theta, phi));
        for across in [0.125, 0.5] {
            prop_assert!(t.sample_visible_normal(v, [0.0, across]).dot(v).abs() <= hidden(&t, v));
        }
    }

    #[test]
    fn ggx_and_beckmann_are_limits(alpha in 1e-3..10.0_f64, v in direction(), nearness in 1e-13..1e-9_f64) {
        let tan = v.truncate().length() / v.z;
        let ggx = StudentT::new(alpha, 2.0).unwrap();
        let closed = 2.0 / (1.0 + (1.0 + alpha * alpha * tan * tan).sqrt());
        prop_assert!(close(ggx.g1(v), closed, 1e-13) || v.z < 1e-15);
        for near in [2.0 - nearness, 2.0 + nearness] {
            prop_assert!(close(StudentT::new(alpha, near).unwrap().g1(v), ggx.g1(v), 1e-8));
        }
        let (far, limit) = (StudentT::new(alpha, 1e12).unwrap(), StudentT::beckmann(alpha).unwrap());
        prop_assert!(close(far.g1(v), limit.g1(v), 1e-11));
    }

    #[test]
    fn a_smooth_surface_hides_nothing(gamma in 1.6..1e17_f64, theta in 0.0..1.5_f64) {
        // G1 = 1 − O(σ^(2γ−3)) for heavy tails, faster than any power for Beckmann.
        let g1 = StudentT::new(1e-60, gamma).unwrap().g1(at(theta, 0.3));
        prop_assert!(1.0 - g1 < 1e-10, "{g1}");
    }

    #[test]
    fn the_projected_area_obeys_jensen(gamma in gamma(), z in (-12.0..12.0_f64).prop_map(|x| 10_f64.powf(x))) {
        // E[(cos + x sin)⁺] lies between the positive part of the mean and the sum of the positive
        // parts.
        let shape = Shape::new(gamma).unwrap();
        let view = UnitView::from_cotangent(z);
        let area = VisibleSlope::new(&shape, view).area();
        prop_assert!(area >= view.cos && area >= view.sin * shape.first_moment(0.0) * (1.0 - 1e-14));
        prop_assert!(area <= (view.cos + view.sin * shape.first_moment(0.0)) * (1.0 + 1e-14));
    }

    #[test]
    fn normals_are_inverted(x in sigma(), y in sigma(), gamma in gamma(), v in direction(), u in number(), across in number()) {
        let t = StudentT::new([x, y], gamma).unwrap();
        let m = t.sample_visible_normal(v, [u, across]);
        let back = t.invert_visible_normal(v, m);
        // Normals are kept away from the horizon, and a slope that is far larger than the other
        // leaves no digits of it.
        let seen = |number: f64| m.z > 1e-290 && (1e-6..1.0 - 1e-6).contains(&number);
        prop_assert!(!seen(across) || (back[0] - u).abs() < 1e-6, "{u} {across}: {back:?}");
        prop_assert!(!seen(u) || (back[1] - across).abs() < 1e-6, "{u} {across}: {back:?}");
    }

    #[test]
    fn quantiles_invert_the_cdfs_and_density_is_their_derivative(
        gamma in prop_oneof![1.6..12.0, Just(1e6), Just(f64::INFINITY)], z in (-3.0..2.0_f64).prop_map(|x| 10_f64.powf(x)),
        u in 0.001..0.999_f64,
    ) {
        let shape = Shape::new(gamma).unwrap();
        let slopes = VisibleSlope::new(&shape, UnitView::from_cotangent(z));
        let x = slopes.quantile(u);
        prop_assert!((slopes.cdf(x) - u).abs() < 1e-13);
        prop_assert!((slopes.complement(x) - (1.0 - u)).abs() < 1e-13);
        prop_assert!((across_cdf(&shape, across_quantile(&shape, u)) - u).abs() < 1e-13);
        // Five-point difference in w, away from x = 0, where the sign changes.
        let h = 1e-3 * x.w;
        let to = |step: f64| slopes.cdf(SignedSlope { w: x.w + step * h, ..x });
        let derivative = (8.0 * (to(1.0) - to(-1.0)) - (to(2.0) - to(-2.0))) / (12.0 * h) * x.sign;
        if x.w > 1e-2 && to(-2.0 * x.sign) > 1e-6 {
            prop_assert!((derivative - slopes.density(x)).abs() < 1e-6 * slopes.density(x) + 1e-8, "{derivative}");
        }
    }
}
