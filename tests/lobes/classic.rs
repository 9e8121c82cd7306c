//! Distributions outside the family: baked tables against the model's quadrature, by value and by
//! chi-square.
//!
//! `cargo test --release --test lobes classic:: -- --nocapture` prints the figures.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec3, Vec3};
use microfacet_baker::bake::bake_radial;
use microfacet_baker::certify::radial::measure;
use microfacet_baker::distribution::Named;
use microfacet_baker::plan::{Cost, Options, Plan};
use microfacet_baker::progress::Stage;
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake, costs};
use microfacet_baker::table_spec::Quality;
use microfacet_model::classic::{Isotropic, Marginal, MarginalView, Tabulated};
use microfacet_model::statistics::{chi_square, sidak};
use microfacet_sampler::{Lobe, MicrofacetDistribution, Tables};
use microfacet_scene::load;
use microfacet_tables::{Kind, Precision, Quantity, encode};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::sets::{outside, set_of};

/// Distributions whose slopes are far apart: a haze forty times as rough as its core, and a long
/// tail of a narrow peak.
const APART: [&str; 2] = ["haze:0.02,0.8,0.6", "abc:1e4,1.4"];

/// Distributions of every kind, by name.
fn all() -> Vec<(String, Box<dyn Isotropic>)> {
    let built = |text: &str| text.parse::<Named>().unwrap().build().unwrap();
    let names = "gauss:0.1 gauss:0.4 gtr:0.1,1.2 gtr:0.3,3 gtr:0.5,0.7 schlick:0.05 schlick:0.3 \
                 sawicki:0 sawicki:12 sawicki:1000 haze:0.1,0.4,0.3 haze:0.05,0.5,0.6 \
                 haze:0.5,0.1,0.2 abc:30,1 abc:300,2";
    let mut all: Vec<(String, Box<dyn Isotropic>)> =
        names.split(' ').chain(APART).map(|text| (text.into(), built(text))).collect();
    let smooth = built("gauss:0.25");
    let angles = (0..=450).map(|i| f64::from(i) * 0.5 * PI / 450.0);
    let rows: Vec<_> = angles.map(|t| (t, smooth.d(t) + 0.02)).collect();
    all.push(("measured:wide".into(), Box::new(Tabulated::new(&rows).unwrap())));
    all
}

fn tabulated(name: &str, marginal: &Marginal) -> Lobe {
    let tables = bake_radial(marginal, name, Quality::Default, Precision::F32, &Stage::unwatched());
    set_of(tables, Some(outside(name, marginal))).material("it").unwrap()
}

/// The lobes of [`all`] from their tables.
static LOBES: LazyLock<Vec<Lobe>> =
    LazyLock::new(|| all().iter().map(|(name, d)| tabulated(name, &Marginal::new(&**d))).collect());

#[test]
fn tables_follow_the_quadrature() {
    for ((name, d), radial) in all().into_iter().zip(LOBES.iter()) {
        let e = measure(radial, &Marginal::new(&*d));
        // The nodes of one table serve such slopes worse, as its certificate says.
        let most = if APART.contains(&&*name) { 2e-3 } else { 5e-4 };
        let close = e.g1 < 1e-4 && e.along < most && e.across < most && e.density < 1e-3;
        assert!(close, "{name}: {e:?}");
    }
}

#[test]
fn draws_pass_chi_square() {
    let mut rng = StdRng::seed_from_u64(17);
    let mut smallest = (1.0_f64, String::new());
    let mut tests = 0;
    for ((name, d), radial) in all().into_iter().zip(LOBES.iter()) {
        let marginal = Marginal::new(&*d);
        for theta in [0.0, 0.7, 1.3, 1.55] {
            let v = DVec3::new(f64::sin(theta), 0.0, f64::cos(theta)).as_vec3();
            let cot = f64::from(v.z) / (marginal.sigma() * f64::from(v.x));
            let exact = MarginalView::new(&marginal, cot);
            const BINS: usize = 10;
            let draws = 10_000;
            let mut counts = [0; BINS * BINS];
            for _ in 0..draws {
                let m = radial.sample_visible_normal(v, [rng.random(), rng.random()]);
                let [x, y, z] = m.map(f64::from);
                let (x, y) = (x / (z * marginal.sigma()), y / (z * marginal.sigma()));
                let tail = marginal.across_at(x.abs()).tail(y.abs());
                let shares = [exact.shares(x).below, if y < 0.0 { tail } else { 1.0 - tail }];
                let [a, b] = shares.map(|u| ((u * BINS as f64) as usize).min(BINS - 1));
                counts[a * BINS + b] += 1;
            }
            let p = chi_square(&counts, &[f64::from(draws) / (BINS * BINS) as f64; BINS * BINS]).p;
            tests += 1;
            if p < smallest.0 {
                smallest = (p, format!("{name} at {theta}"));
            }
        }
    }
    let (p, at) = smallest;
    println!("{tests} tests, smallest p {p:.4} ({at})");
    assert!(p > sidak(0.01, tests), "p = {p} for {at}");
}

#[test]
fn recipes_name_distributions() {
    let material = |text: &str| {
        let recipe = format!("[[material]]\nname = \"it\"\n{text}\n");
        Scene::from_recipe_str(&recipe).map(|scene| (scene.materials[0].clone(), scene.to_recipe()))
    };
    // A member of the family is read as the family.
    let (beckmann, _) = material("distribution = \"beckmann\"\nm = 0.3").unwrap();
    assert!(beckmann.lobe.distribution.is_none() && beckmann.lobe.gamma.min == f64::INFINITY);
    let (ggx, _) = material("distribution = \"gtr\"\nc = 0.2\ngamma = 2").unwrap();
    assert!(ggx.lobe.distribution.is_none() && (ggx.lobe.roughness.x().min - 0.2).abs() < 1e-15);
    // Another distribution keeps its name when the recipe is written and read again.
    let (gtr, text) = material("distribution = \"gtr\"\nc = 0.2\ngamma = 1.3").unwrap();
    assert_eq!(gtr.lobe.distribution.as_ref().unwrap().label(), "gtr:0.2,1.3");
    let again = Scene::from_recipe_str(&text).unwrap();
    assert!(again.materials[0].asks_the_same(&gtr), "{text}");
    let refused = |text: &str| material(text).unwrap_err().to_string();
    for (distribution, why) in [
        ("\"gtr\"\nc = 0.2", "has no `gamma`"),
        ("\"gtr\"\nc = 2.0\ngamma = 3", "(0, 1]"),
        ("\"phong\"\nn = 3", "there are beckmann"),
        ("\"gauss\"\nm = 0.2\nsigma = 0.1", "unknown key `sigma`"),
        ("{ measured = \"nowhere.csv\" }", "nowhere.csv"),
        ("3", "name in quotes"),
    ] {
        let message = refused(&format!("distribution = {distribution}"));
        assert!(message.contains(why), "{message}");
    }
}

#[test]
fn a_recipe_bakes_all_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..=200)
        .map(|i| f64::from(i) * 0.5 * PI / 200.0)
        .map(|t| format!("{t},{}\n", (-9.0 * t * t).exp()))
        .collect();
    std::fs::write(folder.path().join("steel.csv"), format!("theta,D\n{rows}")).unwrap();
    let recipe = folder.path().join("metals.toml");
    let text = "[[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 3.0\n\n\
                [[material]]\nname = \"paint\"\ndistribution = \"gtr\"\nc = 0.2\ngamma = 1.3\n\n\
                [[material]]\nname = \"steel\"\ndistribution = { measured = \"steel.csv\" }\n";
    std::fs::write(&recipe, text).unwrap();
    let scene = load(&recipe).unwrap();
    let plan = Plan::new(&scene, Options::default()).unwrap();
    assert_eq!((plan.shapes.len(), plan.distributions.len()), (1, 2));
    let bake = |target| bake(&plan, target);
    // Fixed point is enough for this error, in half the bytes.
    let rough = bake(Target::MaxError(1e-3)).unwrap().set;
    for table in rough.tables() {
        assert!(table.precision == Precision::U16 && table.certificate.worst() <= 1e-3);
    }
    let [full, fixed] = [Precision::F32, Precision::U16]
        .map(|precision| bake(Target::Quality(Quality::Draft, precision)).unwrap().set);
    for (precision, set) in [(Precision::F32, &full), (Precision::U16, &fixed)] {
        let estimate: Cost = costs(&plan, Quality::Draft, precision).unwrap().into_iter().sum();
        let real = encode(set.provenance(), set.tables()).unwrap().len() as f64;
        assert!((estimate.bytes as f64 / real - 1.0).abs() < 0.02, "{estimate:?} for {real}");
        assert!(estimate.seconds > 0.0);
    }
    let set = Tables::from_bytes(&encode(full.provenance(), full.tables()).unwrap()).unwrap();
    let v = Vec3::new(0.6, 0.0, 0.8);
    assert!(set.material("gold").unwrap().g1(v) > 0.9);
    for name in ["paint", "steel"] {
        let m = Vec3::from(set.material(name).unwrap().sample_visible_normal(v, [0.4, 0.6]));
        assert!(m.dot(v) > 0.0 && m.z > 0.0, "{name}: {m}");
        assert!(matches!(set.material(name), Ok(Lobe::Radial(_))));
    }
    assert!(matches!(set.material("gold"), Ok(Lobe::StudentT(_))));
    let figures = set.tables().iter().find(|table| table.kind == Kind::RadialShadowing).unwrap();
    assert!(figures.certificate.error(Quantity::G1).unwrap() < 1e-3);
}
