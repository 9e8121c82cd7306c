//! The model against values computed elsewhere with 60 to 200 digits.

use glam::DVec3;
use microfacet_model::{
    MicrofacetDistribution, Shape, StudentT, UnitView, VisibleSlope, across_quantile,
};

fn rows(name: &str) -> Vec<Vec<f64>> {
    let number = |x: &String| x.parse().expect("number");
    crate::rows(name).iter().map(|row| row.iter().map(number).collect()).collect()
}

#[test]
fn lambda_and_g1() {
    let mut worst: (f64, String) = (0.0, String::new());
    for row in rows("lambda_g1.csv") {
        let &[sigma_x, sigma_y, gamma, theta, phi, lambda, g1] = row.as_slice() else {
            panic!("columns")
        };
        let (sin, cos) = libm::sincos(theta);
        let v = DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos);
        let material = StudentT::new([sigma_x, sigma_y], gamma).unwrap();
        let (got, got_g1) = (material.lambda(v), material.g1(v));
        // 1e-12 relative or 1e-15 absolute.
        let error =
            ((got - lambda).abs() / (1e-12 * lambda + 1e-15)).max((got_g1 - g1).abs() / 1e-12);
        if error > worst.0 {
            worst = (error, format!("{row:?}: {got} {got_g1}"));
        }
    }
    println!("Lambda: worst error {} of the tolerance at {}", worst.0, worst.1);
    assert!(worst.0 < 1.0, "{}", worst.1);
}

#[test]
fn visible_slope_quantiles() {
    let mut worst = 0.0_f64;
    for row in rows("visible_cdf.csv") {
        let (gamma, cos_l, u, alpha) = (row[0], row[1], row[2], row[3]);
        let shape = Shape::new(gamma).unwrap();
        // The cotangent of the angle in the lobe's own space, times √(γ−1), is the unit cotangent.
        let z = cos_l / (1.0 - cos_l * cos_l).sqrt() * (gamma - 1.0).sqrt();
        let slope = VisibleSlope::new(&shape, UnitView::from_cotangent(z)).quantile(u);
        let v = slope.w * shape.s().sqrt();
        let got = slope.sign * 2.0 * libm::atan(libm::tanh(0.5 * v));
        worst = worst.max((got - alpha).abs());
        assert!((got - alpha).abs() < 1e-12, "{row:?}: {got}, off by {:e}", got - alpha);
        if let Some(&cos_alpha) = row.get(4) {
            // The digits that alpha loses near π/2; the conditioning of the tail is 1/(2k).
            let got = 1.0 / libm::cosh(v);
            let tolerance = 1e-12 * (1.0 + 1.0 / (2.0 * gamma - 3.0)) * cos_alpha + 1e-300;
            assert!((got - cos_alpha).abs() < tolerance, "{row:?}: cos {got}");
        }
    }
    println!("alpha: worst error {worst:e}");
}

#[test]
fn across_quantiles() {
    let mut worst = 0.0_f64;
    for row in rows("beta_quantile.csv") {
        let &[gamma, u, sin_beta] = row.as_slice() else { panic!("columns") };
        let shape = Shape::new(gamma).unwrap();
        let t = across_quantile(&shape, u);
        let got = t.sign * libm::tanh(t.w * shape.s().sqrt());
        worst = worst.max((got - sin_beta).abs());
        assert!((got - sin_beta).abs() < 1e-12, "{row:?}: {got}");
    }
    println!("sin beta: worst error {worst:e}");
}
