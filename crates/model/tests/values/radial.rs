//! Directional albedos of isotropic distributions against the family's, brute force and bounds.

use core::f64::consts::{FRAC_PI_2, PI};

use microfacet_model::classic::{
    Gauss, Gtr, Isotropic, Marginal, Member, RadialAlbedo, Sawicki, Schlick, Tabulated,
};
use microfacet_model::{AlbedoIntegrator, Masking, ParameterError};

use crate::{apart, assert_near, assert_share, schlick};

const COSINES: [f64; 7] = [0.0, 1e-3, 0.02, 0.1, 0.4, 0.8, 1.0];

/// A distribution as a measurement would give it, with an added bump.
fn measured(rows: u32) -> Tabulated {
    let source = Gtr::new(0.25, 1.5).unwrap();
    let rows: Vec<_> = (0..=rows)
        .map(|i| f64::from(i) * FRAC_PI_2 / f64::from(rows))
        .map(|t| (t, source.d(t) * (1.0 + 0.3 * libm::sin(9.0 * t))))
        .collect();
    Tabulated::new(&rows).unwrap()
}

#[test]
fn members_have_the_family_s_albedo() {
    for member in [
        Member::beckmann(0.05).unwrap(),
        Member::beckmann(0.7).unwrap(),
        Member::trowbridge_reitz(0.01).unwrap(),
        Member::trowbridge_reitz(0.3).unwrap(),
        Member::trowbridge_reitz(1.5).unwrap(),
        Member::blinn_phong(12.0).unwrap(),
    ] {
        let (marginal, t) = (Marginal::new(&member), member.student_t().unwrap());
        let (radial, family) =
            (RadialAlbedo::new(&marginal, 1e-6), AlbedoIntegrator::new(*t.shape(), 1e-9));
        for cos in COSINES {
            let got = radial.reflection(cos, schlick).unwrap();
            let want = family.reflection(t.sigma_x(), cos, schlick).unwrap();
            // Measured 1.3e-7.
            assert!(apart(&got, &want) < 1e-6, "{member:?}, cos {cos}: {got:?} for {want:?}");
        }
    }
}

/// E by brute force: f cos θ_l with F = 1 over the hemisphere of l, in solid angle, by the midpoint
/// rule.
fn brute_force(d: &dyn Isotropic, marginal: &Marginal, cos_v: f64) -> [f64; 2] {
    let (rings, sectors) = (1000, 500);
    let sin_v = (1.0 - cos_v * cos_v).sqrt();
    let g1_v = marginal.g1(libm::acos(cos_v));
    let mut sum = [0.0; 2];
    for i in 0..rings {
        let theta = FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(rings);
        let (sin, cos) = libm::sincos(theta);
        let g1 = marginal.g1(theta);
        let correlated = g1_v * g1 / (g1 + g1_v * (1.0 - g1));
        for j in 0..sectors {
            let cos_phi = libm::cos(PI * (f64::from(j) + 0.5) / f64::from(sectors));
            let (x, z) = (sin_v + sin * cos_phi, cos_v + cos);
            let y2 = sin * sin * (1.0 - cos_phi * cos_phi);
            let part = sin * d.d(libm::atan((x * x + y2).sqrt() / z)) / (4.0 * cos_v);
            sum[0] += part * g1_v * g1;
            sum[1] += part * correlated;
        }
    }
    sum.map(|x| x * FRAC_PI_2 / f64::from(rings) * 2.0 * PI / f64::from(sectors))
}

#[test]
fn it_is_the_integral_over_light_directions() {
    let all: [(&str, &dyn Isotropic); 6] = [
        ("gauss", &Gauss::new(0.25).unwrap()),
        ("wide gauss", &Gauss::new(1.2).unwrap()),
        ("schlick", &Schlick::new(0.3).unwrap()),
        ("sawicki", &Sawicki::new(12.0).unwrap()),
        ("gtr", &Gtr::new(0.3, 1.0).unwrap()),
        ("table", &measured(45)),
    ];
    for (name, d) in all {
        let marginal = Marginal::new(d);
        let radial = RadialAlbedo::new(&marginal, 1e-6);
        for cos in [0.2, 0.6, 0.95] {
            let albedo = radial.reflection(cos, |_| [1.0]).unwrap();
            for (form, want) in Masking::ALL.into_iter().zip(brute_force(d, &marginal, cos)) {
                // The midpoint rule is of second order in steps of 2e-3 and 6e-3; measured 7.6e-7.
                assert_near(albedo.of(form)[0], want, 2e-6, format!("{name}, cos {cos}"));
            }
        }
    }
}

#[test]
fn energy_is_not_gained_and_estimates_hold() {
    let mut all: Vec<(String, Box<dyn Isotropic>)> = vec![("table".into(), Box::new(measured(90)))];
    for m in [0.01, 0.1, 0.5, 1.0] {
        all.push((format!("gauss {m}"), Box::new(Gauss::new(m).unwrap())));
        all.push((format!("schlick {m}"), Box::new(Schlick::new(m).unwrap())));
        let n = 2.0 / (m * m) - 2.0;
        all.push((format!("sawicki {n}"), Box::new(Sawicki::new(n).unwrap())));
        all.push((format!("gtr {m}, 0.6"), Box::new(Gtr::new(m, 0.6).unwrap())));
        all.push((format!("gtr {m}, 3"), Box::new(Gtr::new(m, 3.0).unwrap())));
    }
    for (name, d) in all {
        let marginal = Marginal::new(&*d);
        let both = [1e-5, 1e-7].map(|tolerance| RadialAlbedo::new(&marginal, tolerance));
        for cos in COSINES {
            let [a, b] = both.each_ref().map(|x| x.reflection(cos, schlick).unwrap());
            assert!(a.error < 1e-5, "{name}, cos {cos}: estimate {:e}", a.error);
            assert!(apart(&a, &b) < a.error + b.error, "{name}, cos {cos}: {a:?} for {b:?}");
            assert_share(&a, 1e-5, format!("{name}, cos {cos}"));
        }
    }
}

#[test]
fn refuses_directions_below() {
    let gauss = Gauss::new(0.2).unwrap();
    let marginal = Marginal::new(&gauss);
    let radial = RadialAlbedo::new(&marginal, 1e-5);
    for cos in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(radial.reflection(cos, |_| [1.0]), Err(ParameterError::CosTheta(_))));
    }
}
