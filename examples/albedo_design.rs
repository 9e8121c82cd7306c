//! Why the view axis of albedo tables looks as it does: the largest error between 28 nodes for several coordinates.
//!
//! `cargo run --release --example albedo_design` prints the table that stands in `docs/albedo.md`. Nodes are exact (to 1e-7), the polynomial goes through the six
//! nearest, or lines through two, so that all error is the coordinate's. Columns are the parts of the domain that ask for different things.

use microfacet_model::{AlbedoIntegrator, Shape};
use rayon::prelude::*;

const NODES: usize = 28;

/// Where views stand, as t(μ) ascending to 1 at normal incidence; σ and γ are the material's.
struct Design {
    name: &'static str,
    /// Nodes the polynomial goes through.
    stencil: usize,
    coordinate: fn(Material, f64) -> f64,
}

#[derive(Clone, Copy)]
struct Material {
    sigma: f64,
    gamma: f64,
}

impl Material {
    fn x(self, cos: f64) -> f64 {
        let knee = (3.0 + 0.5 / (2.0 * self.gamma - 3.0)) * self.sigma;
        cos / (cos + knee * sin(cos))
    }

    fn first(self) -> f64 {
        (2e-3 * self.sigma).min(2e-5)
    }
}

fn sin(cos: f64) -> f64 {
    ((1.0 - cos) * (1.0 + cos)).sqrt()
}

fn h(cos: f64) -> f64 {
    cos / (1.0 + sin(cos))
}

fn roots(material: Material, cos: f64) -> f64 {
    0.4 * material.x(cos).powf(0.25) + 0.6 * h(cos).powf(0.25)
}

const DESIGNS: [Design; 8] = [
    Design { name: "cosine, lines", stencil: 2, coordinate: |_, cos| cos },
    Design { name: "cosine", stencil: 6, coordinate: |_, cos| cos },
    Design { name: "square root of the cosine", stencil: 6, coordinate: |_, cos| cos.sqrt() },
    Design { name: "√h", stencil: 6, coordinate: |_, cos| h(cos).sqrt() },
    Design { name: "h^¼", stencil: 6, coordinate: |_, cos| h(cos).powf(0.25) },
    Design { name: "fourth roots of h and x", stencil: 6, coordinate: roots },
    Design { name: "and x", stencil: 6, coordinate: |m, cos| 0.3 * m.x(cos) + 0.7 * roots(m, cos) },
    Design {
        name: "and the turn at the normal (baked)",
        stencil: 6,
        coordinate: |m, cos| {
            let turn = 10.0 * m.sigma;
            0.3 * m.x(cos) + 0.1 * turn / (turn + sin(cos)) + 0.6 * roots(m, cos)
        },
    },
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
    let start = (design.coordinate)(material, material.first());
    let at = |cos: f64| ((design.coordinate)(material, cos) - start) / (1.0 - start);
    let node = |i: usize| exact(cosine(at, material.first(), i as f64 / (NODES - 1) as f64));
    let nodes: Vec<[f64; 2]> = (0..NODES).map(node).collect();
    let mut worst = [0.0_f64; 4];
    for i in 0..60 {
        let u = (i as f64 + 0.5) / 60.0;
        // Evenly in the cosine, in its logarithm and near the normal.
        let cos = match i % 3 {
            0 => u,
            1 => libm::pow(material.first(), 1.0 - u),
            _ => 1.0 - 0.02 * u * u,
        };
        let (want, got) = (exact(cos), interpolate(&nodes, design.stencil, at(cos)));
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

fn interpolate(nodes: &[[f64; 2]], stencil: usize, t: f64) -> [f64; 2] {
    let x = t.clamp(0.0, 1.0) * (nodes.len() - 1) as f64;
    let start = (x as usize + 1).saturating_sub(stencil / 2).min(nodes.len() - stencil);
    let mut sum = [0.0; 2];
    for (i, node) in nodes.iter().enumerate().skip(start).take(stencil) {
        let others = (start..start + stencil).filter(|&j| j != i);
        let weight: f64 = others.map(|j| (x - j as f64) / (i as f64 - j as f64)).product();
        sum = [0, 1].map(|form| sum[form] + weight * node[form]);
    }
    sum
}
