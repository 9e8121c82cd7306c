//! Why the view axis of albedo tables looks as it does: the largest error between 28 nodes for several coordinates.
//!
//! `cargo run --release --example albedo_design` prints the table that stands in `docs/albedo.md`. Nodes are exact (to 1e-7), the polynomial goes through the six
//! nearest, or lines through two, so that all error is the coordinate's. Columns are the parts of the domain that ask for different things.

use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_sampler::axis::{ViewBlend, even_nodes, lagrange};
use rayon::prelude::*;

const NODES: usize = 28;

/// Where views stand, as t(μ) ascending to 1 at normal incidence.
enum Coordinate {
    /// Of the view alone.
    Plain(fn(f64) -> f64),
    /// Of view and material.
    Blend(ViewBlend),
}

struct Design {
    name: &'static str,
    /// Nodes the polynomial goes through.
    window: usize,
    coordinate: Coordinate,
}

#[derive(Clone, Copy)]
struct Material {
    sigma: f64,
    gamma: f64,
}

/// h = μ/(1 + sin θ).
fn h(cos: f64) -> f64 {
    cos / (1.0 + ((1.0 - cos) * (1.0 + cos)).sqrt())
}

/// Fourth roots of h and x alone.
const ROOTS: ViewBlend = ViewBlend { weight: 0.0, normal: 0.0, ..ViewBlend::BAKED };

const fn plain(name: &'static str, window: usize, coordinate: fn(f64) -> f64) -> Design {
    Design { name, window, coordinate: Coordinate::Plain(coordinate) }
}

const fn blend(name: &'static str, blend: ViewBlend) -> Design {
    Design { name, window: 6, coordinate: Coordinate::Blend(blend) }
}

const DESIGNS: [Design; 8] = [
    plain("cosine, lines", 2, |cos| cos),
    plain("cosine", 6, |cos| cos),
    plain("square root of the cosine", 6, f64::sqrt),
    plain("√h", 6, |cos| h(cos).sqrt()),
    blend("h^¼", ViewBlend { share: 0.0, ..ROOTS }),
    blend("fourth roots of h and x", ROOTS),
    blend("and x", ViewBlend { weight: ViewBlend::BAKED.weight, ..ROOTS }),
    blend("and the turn at the normal (baked)", ViewBlend::BAKED),
];

/// Names of the columns, and whether a σ, a cosine belong.
type Part = (&'static str, fn(f64, f64) -> bool);
const PARTS: [Part; 4] = [
    ("σ ≥ 0.01, μ ≥ 0.02", |sigma, cos| sigma >= 0.01 && (0.02..0.98).contains(&cos)),
    ("σ ≥ 0.01, μ > 0.98", |sigma, cos| sigma >= 0.01 && cos >= 0.98),
    ("μ < 0.02", |sigma, cos| sigma >= 0.01 && cos < 0.02),
    ("σ < 0.01", |sigma, _| sigma < 0.01),
];

fn main() {
    print!("| coordinate |");
    PARTS.iter().for_each(|part| print!(" {} |", part.0));
    println!("\n| --- |{}", " --- |".repeat(PARTS.len()));
    let materials: Vec<Material> = [1.501, 1.505, 1.52, 1.56, 1.65, 2.0, 3.0, 8.0, f64::INFINITY]
        .into_iter()
        .flat_map(|gamma| {
            [1e-6, 1e-4, 0.003, 0.011, 0.05, 0.3, 1.0, 3.0].map(|sigma| Material { sigma, gamma })
        })
        .collect();
    for design in &DESIGNS {
        let worst = materials
            .par_iter()
            .map(|&material| errors(design, material))
            .reduce(|| [0.0; 4], |a, b| [0, 1, 2, 3].map(|i| a[i].max(b[i])));
        println!("| {} | {} |", design.name, worst.map(|x| format!("{x:.0e}")).join(" | "));
    }
}

/// Largest error of E, of either masking, in each part of the domain.
fn errors(design: &Design, material: Material) -> [f64; 4] {
    let shape = Shape::new(material.gamma).expect("in the family");
    let integrator = AlbedoIntegrator::new(shape, 1e-7);
    let exact = |cos: f64| {
        let albedo = integrator.reflection(material.sigma, cos, |_| [1.0]).expect("in the domain");
        [albedo.uncorrelated[0], albedo.height_correlated[0]]
    };
    let bound = |blend: &ViewBlend| blend.bind(material.sigma, material.gamma);
    let first = bound(&ViewBlend::BAKED).floor();
    let at = |cos: f64| match &design.coordinate {
        Coordinate::Plain(t) => (t(cos) - t(first)) / (1.0 - t(first)),
        Coordinate::Blend(blend) => bound(blend).coordinate(cos),
    };
    let nodes = even_nodes(0.0, 1.0, NODES);
    let values: Vec<[f64; 2]> = nodes.iter().map(|&t| exact(cosine(at, first, t))).collect();
    let got = |t: f64| {
        let weights = lagrange::weights(&nodes, t.clamp(0.0, 1.0), design.window);
        [0, 1].map(|form| weights.iter().map(|&(i, w)| w * values[i][form]).sum::<f64>())
    };
    let mut worst = [0.0_f64; 4];
    for i in 0..60 {
        let u = (i as f64 + 0.5) / 60.0;
        // Evenly in the cosine, in its logarithm and near the normal.
        let cos = match i % 3 {
            0 => u,
            1 => libm::pow(first, 1.0 - u),
            _ => 1.0 - 0.02 * u * u,
        };
        let (want, got) = (exact(cos), got(at(cos)));
        let error = (want[0] - got[0]).abs().max((want[1] - got[1]).abs());
        for (worst, part) in worst.iter_mut().zip(PARTS) {
            if part.1(material.sigma, cos) {
                *worst = worst.max(error);
            }
        }
    }
    worst
}

fn cosine(at: impl Fn(f64) -> f64, first: f64, t: f64) -> f64 {
    let (mut low, mut high) = (first, 1.0);
    for _ in 0..80 {
        let cos = 0.5 * (low + high);
        if at(cos) < t { low = cos } else { high = cos }
    }
    0.5 * (low + high)
}
