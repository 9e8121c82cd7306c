//! Distributions outside the family: baked tables against the model's quadrature, by value and by chi-square.
//!
//! `cargo test --release --test classic -- --nocapture` prints the figures.

use std::f64::consts::PI;
use std::time::Instant;

use glam::{DVec3, Vec3};
use microfacet_bake::bake::bake_radial;
use microfacet_bake::family::Named;
use microfacet_bake::spec::Quality;
use microfacet_model::classic::{Isotropic, Marginal, MarginalView, Tabulated};
use microfacet_model::statistics::chi_square;
use microfacet_sampler::{MaterialEntry, Precision, Provenance, Radial, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Distributions of every kind, by name.
fn all() -> Vec<(String, Box<dyn Isotropic>)> {
    let names =
        ["gauss:0.1", "gauss:0.4", "gtr:0.1,1.2", "gtr:0.3,3", "gtr:0.5,0.7", "schlick:0.05", "schlick:0.3"];
    let mut all: Vec<(String, Box<dyn Isotropic>)> = names
        .iter()
        .map(|text| (text.to_string(), text.parse::<Named>().unwrap().build().unwrap()))
        .collect();
    let smooth = "gauss:0.25".parse::<Named>().unwrap().build().unwrap();
    let rows: Vec<_> =
        (0..=450).map(|i| f64::from(i) * 0.5 * PI / 450.0).map(|t| (t, smooth.d(t) + 0.02)).collect();
    all.push(("measured:wide".into(), Box::new(Tabulated::new(&rows).unwrap())));
    all
}

fn bound(name: &str, marginal: &Marginal) -> Radial {
    let entry = MaterialEntry {
        name: "it".into(),
        sigma: [[marginal.sigma(); 2]; 2],
        s: [0.0; 2],
        distribution: name.into(),
    };
    let tables = bake_radial(marginal, &entry.table_suffix(), Quality::Default, Precision::F32);
    let provenance = Provenance { materials: vec![entry], ..Provenance::default() };
    Tables::from_tables(provenance, tables).unwrap().radial("it").unwrap()
}

fn view(theta: f64) -> Vec3 {
    DVec3::new(theta.sin(), 0.0, theta.cos()).as_vec3()
}

#[test]
fn tables_follow_the_quadrature() {
    for (name, d) in all() {
        let start = Instant::now();
        let marginal = Marginal::new(&*d);
        let radial = bound(&name, &marginal);
        let seconds = start.elapsed().as_secs_f64();
        let (mut g1, mut cdf, mut across, mut density) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..90 {
            let theta = (f64::from(i) + 0.37) * 0.5 * PI / 90.0;
            let v = view(theta);
            g1 = g1.max((f64::from(radial.g1(v)) - marginal.g1(theta)).abs());
            density = density.max((f64::from(radial.d(v)) / d.d(0.0) - d.unit(theta)).abs());
            let z = theta.cos() / (marginal.sigma() * theta.sin());
            let exact = MarginalView::new(&marginal, z);
            for j in 0..40 {
                let u = [(f64::from(j) + 0.21) / 40.0, (f64::from(j * 7 % 40) + 0.6) / 40.0];
                let m = radial.sample_visible_normal(v, u.map(|u| u as f32)).as_dvec3();
                let slope = DVec3::new(m.x, m.y, 0.0) / (m.z * marginal.sigma());
                cdf = cdf.max((exact.shares(slope.x).below - u[0]).abs());
                let tail = marginal.across_at(slope.x.abs()).tail(slope.y.abs());
                let share = if slope.y < 0.0 { tail } else { 1.0 - tail };
                across = across.max((share - u[1]).abs());
            }
        }
        println!(
            "{name:16} G1 {g1:.1e}  CDF {cdf:.1e}  across {across:.1e}  D/D(0) {density:.1e}  {seconds:.2} s"
        );
        assert!(g1 < 1e-4 && cdf < 5e-4 && density < 1e-3, "{name}: G1 {g1:e}, CDF {cdf:e}, D {density:e}");
        assert!(across < 5e-4, "{name}: slope across {across:e}");
    }
}

#[test]
fn draws_pass_chi_square() {
    let mut rng = StdRng::seed_from_u64(17);
    let mut smallest = (1.0_f64, String::new());
    let mut tests = 0;
    for (name, d) in all() {
        let marginal = Marginal::new(&*d);
        let radial = bound(&name, &marginal);
        for theta in [0.0, 0.7, 1.3, 1.55] {
            let v = view(theta);
            let cot = f64::from(v.z) / (marginal.sigma() * f64::from(v.x));
            let exact = MarginalView::new(&marginal, cot);
            const BINS: usize = 10;
            let draws = 10_000;
            let mut counts = [0; BINS * BINS];
            for _ in 0..draws {
                let m = radial.sample_visible_normal(v, [rng.random(), rng.random()]).as_dvec3();
                let (x, y) = (m.x / (m.z * marginal.sigma()), m.y / (m.z * marginal.sigma()));
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
    println!("{tests} tests, smallest p {:.4} ({})", smallest.0, smallest.1);
    assert!(
        smallest.0 > 1.0 - 0.99_f64.powf(1.0 / f64::from(tests)),
        "p = {} for {}",
        smallest.0,
        smallest.1
    );
}
