//! GGX without tables: values, the analytic distribution, and sets that leave it to closed forms.

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::statistics::{sidak, test_visible_normals};
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::port::tables_of_shape;
use microfacet_sampler::{
    Compensation, Ggx, Lobe, Masking, MaterialError, MicrofacetDistribution, StandIn, Tables,
};
use microfacet_tables::{
    Interval, Kind, LobeSpec, MaterialEntry, Provenance, Reflectance, Roughness,
};

const SIGMAS: [[f64; 2]; 4] = [[0.3, 0.3], [1e-3, 0.01], [4.0, 0.5], [1e-8, 1e6]];
const VIEWS: [[f64; 2]; 5] = [[0.0, 0.0], [1e-3, 1.0], [0.8, -2.5], [1.4, 3.0], [1.5705, 0.6]];

fn direction([theta, phi]: [f64; 2]) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[test]
fn values_are_those_of_the_model() {
    for sigma in &SIGMAS[..3] {
        let ggx = Ggx::new(*sigma).unwrap();
        let [x, y] = ggx.alpha().map(f64::from);
        let truth = model::StudentT::new([x, y], 2.0).unwrap();
        for view in VIEWS {
            let v = direction(view).as_vec3();
            let exact = truth.g1(v.as_dvec3());
            assert!((f64::from(ggx.g1(v)) - exact).abs() < 3e-7, "{sigma:?} {view:?}");
            let m = Vec3::from(ggx.sample_visible_normal(v, [0.4, 0.8]));
            let density = truth.visible_normal_pdf(v.as_dvec3(), m.as_dvec3());
            // Relative error, and what the rounding of v·m allows.
            let error = (f64::from(ggx.visible_normal_pdf(v, m)) - density).abs() / density;
            assert!(error < 2e-6 + 2e-7 / f64::from(v.dot(m)), "{sigma:?} {view:?}: {error}");
            assert_eq!(ggx.table_pdf(v, m), ggx.visible_normal_pdf(v, m));
        }
    }
}

#[test]
fn normals_have_the_analytic_distribution() {
    const SAMPLES: usize = 200_000;
    let cases: Vec<_> = SIGMAS[..3]
        .iter()
        .flat_map(|sigma| VIEWS.iter().map(move |view| (*sigma, *view)))
        .collect();
    let level = sidak(0.01, 2 * cases.len());
    let judge = |sigma: [f64; 2], view, gamma| {
        let ggx = Ggx::new(sigma).unwrap();
        let [x, y] = ggx.alpha().map(f64::from);
        let truth = model::StudentT::new([x, y], gamma).unwrap();
        let v = direction(view).as_vec3();
        test_visible_normals(&truth, v.as_dvec3(), SAMPLES, 11, |u| {
            ggx.sample_visible_normal(v, u).into()
        })
    };
    for (sigma, view) in cases {
        let outcome = judge(sigma, view, 2.0);
        assert!(outcome.p() > level, "{sigma:?} {view:?}: {outcome:?}");
    }
    // The test detects another shape.
    assert!(judge([0.3, 0.3], [0.8, -2.5], 2.1).p() < level);
}

#[test]
fn normals_are_visible_at_every_corner() {
    let corners = [0.0, f32::from_bits(1), 0.5, 1.0 - f32::EPSILON, 1.0, 2.0, -1.0];
    for sigma in SIGMAS {
        let ggx = Ggx::new(sigma).unwrap();
        let directions = VIEWS.map(|view| direction(view).as_vec3());
        for v in
            directions.into_iter().chain([Vec3::X, Vec3::Z, -Vec3::Z, Vec3::new(0.6, 0.0, -0.8)])
        {
            for u in corners.into_iter().flat_map(|a| corners.map(|b| [a, b])) {
                let m = Vec3::from(ggx.sample_visible_normal(v, u));
                assert!((m.length() - 1.0).abs() < 1e-6 && m.z > 0.0, "{sigma:?} {v} {u:?}: {m}");
                let above = Vec3::new(v.x, v.y, v.z.max(0.0));
                assert!(above.dot(m) > -1.2e-7, "{sigma:?} {v} {u:?}: {m} faces away");
            }
        }
    }
}

/// The set of a scene of GGX alone, as a plan makes it: a name, and no table.
fn without_tables() -> Tables {
    let gold = MaterialEntry {
        name: "gold".into(),
        lobe: LobeSpec::family(
            Roughness::Anisotropic { x: Interval::point(0.2), y: [0.1, 0.3].into() },
            Interval::point(2.0),
        ),
        haze: None,
        retroreflection: MaterialEntry::SPECULAR,
        masking: None,
        fresnel: None,
    };
    let mirror = MaterialEntry {
        name: "mirror".into(),
        fresnel: Some(Reflectance::Mirror),
        lobe: LobeSpec::student_t([0.3; 2], 2.0),
        ..gold.clone()
    };
    let origin = Provenance { materials: vec![gold, mirror], ..Provenance::default() };
    Tables::from_tables(origin, Vec::new()).unwrap()
}

#[test]
fn a_set_without_tables_has_ggx_and_nothing_else() {
    let bytes = microfacet_tables::encode(without_tables().provenance(), &[]).unwrap();
    let set = Tables::from_bytes(&bytes).unwrap();
    let gold = set.material("gold").unwrap();
    assert!(matches!(gold, Lobe::Ggx(ggx) if ggx.alpha() == [0.2, 0.2]));
    assert_eq!(set.material("gold").unwrap().bytes(), 0);
    assert!(set.covers(2.0) && !set.covers(3.0));
    let error = set.student_t(0.3, 3.0).unwrap_err();
    assert!(
        matches!(error, MaterialError::NotCovered { .. })
            && error.to_string().contains("gamma = 3"),
        "{error}"
    );
    let error = set.material("silver").unwrap_err().to_string();
    assert!(
        error.contains("\"silver\"") && error.ends_with("which holds \"gold\", \"mirror\""),
        "{error}"
    );
}

#[test]
fn tables_are_preferred_where_there_are_some() {
    let embedded = Tables::embedded();
    assert!(embedded.student_t(0.3, 2.0).unwrap().bytes() > 0);
    let both = without_tables().with_fallback(&embedded);
    assert!(both.material("gold").unwrap().bytes() > 0 && both.student_t(0.3, 3.0).is_ok());
    assert!(both.tables().is_empty(), "what is written remains the set itself");
}

/// Every lookup goes on in the fallback, which neither narrowing nor joining makes part of the set.
#[test]
fn a_fallback_serves_all_lookups_and_is_never_written() {
    let embedded = Tables::embedded();
    let both = without_tables().with_fallback(&without_tables()).with_fallback(&embedded);
    let (masking, lobe) = (Masking::Uncorrelated, both.student_t(0.3, 3.0).unwrap());
    assert!(both.covers(3.0) && both.tabulates(3.0));
    assert_eq!(both.shapes(), embedded.shapes());
    let (got, want) = (both.albedo(0.3, 3.0, masking), embedded.albedo(0.3, 3.0, masking));
    assert_eq!(got.unwrap().moments([0.6, 0.0, 0.8]), want.unwrap().moments([0.6, 0.0, 0.8]));
    let average = |set: &Tables| set.average_moments(0.3, 3.0, masking).unwrap();
    assert_eq!(average(&both), average(&embedded));
    assert!(both.albedo_of(&lobe, masking, StandIn::Refused).is_ok());
    assert!(both.bsdf("mirror", Compensation::KullaConty, StandIn::Refused).is_ok());
    let [masking, ..] = tables_of_shape(&both, 3.0).unwrap();
    assert_eq!(masking.kind, Kind::Shadowing);
    // A dielectric is in neither, and a name of the fallback is none of the set.
    assert!(both.dielectric_albedo(0.3, 3.0, 1.5, Masking::Uncorrelated).is_err());
    assert!(embedded.clone().with_fallback(&both).material("gold").is_err());

    let only = both.clone().only(&["gold"]).unwrap();
    assert!(only.tables().is_empty() && only.tabulates(3.0));
    let joined = Tables::joined([both]).unwrap();
    assert!(joined.tables().is_empty() && !joined.tabulates(3.0));
}
