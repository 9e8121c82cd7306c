//! Why albedo tables use their coordinate of the view: the largest errors between exact nodes for
//! several coordinates.
//!
//! `cargo run --release -p microfacet-study -- albedo_design` prints the table in `docs/albedo.md`:
//! errors of E, and of the worst of E and its Schlick and F82 moments. Nodes are exact (to 1e-7)
//! and the polynomial goes through the six nearest, or lines through two, so all error comes from
//! the coordinate. The columns are parts of the domain with different requirements.

use microfacet_baker::bake::albedo::weights;
use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_tables::axis::{ViewBlend, even_nodes, lagrange};
use rayon::prelude::*;

use crate::{Outcome, print_head};

/// The coordinate of the view, t(μ), ascending to 1 at normal incidence.
enum Coordinate {
    /// A function of the view alone.
    Plain(fn(f64) -> f64),
    /// A function of view and material.
    Blend(ViewBlend),
}

struct Design {
    name: &'static str,
    nodes: usize,
    /// Number of nodes that the polynomial goes through.
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
/// One term, x^¼, with κ as found for E alone, and with the best κ for all moments.
const ONE: ViewBlend = ViewBlend { share: 1.0, scale: 6.0, heavy: 1.0, ..ROOTS };
const BEST_ONE: ViewBlend = ViewBlend { scale: 8.8, heavy: 2.77, ..ONE };

const fn of_cosine(name: &'static str, window: usize, coordinate: fn(f64) -> f64) -> Design {
    Design { name, nodes: 33, window, coordinate: Coordinate::Plain(coordinate) }
}

const fn blend(name: &'static str, nodes: usize, blend: ViewBlend) -> Design {
    Design { name, nodes, window: 6, coordinate: Coordinate::Blend(blend) }
}

const DESIGNS: [Design; 14] = [
    of_cosine("cosine, lines", 2, |cos| cos),
    of_cosine("cosine", 6, |cos| cos),
    of_cosine("square root of the cosine", 6, f64::sqrt),
    of_cosine("√h", 6, |cos| h(cos).sqrt()),
    blend("h^¼", 33, ViewBlend { share: 0.0, ..ROOTS }),
    blend("fourth roots of h and x", 33, ROOTS),
    blend("and x", 33, ViewBlend { weight: ViewBlend::BAKED.weight, ..ROOTS }),
    blend("and the turn at the normal (default)", 33, ViewBlend::BAKED),
    blend("the same", 28, ViewBlend::BAKED),
    blend("x^¼ alone, κ = 6 + 1/(2γ−3)", 33, ONE),
    blend("the same", 40, ONE),
    blend("x^¼ alone, κ = 8.8 + 2.77/(2γ−3)", 48, BEST_ONE),
    blend("the same", 58, BEST_ONE),
    blend("four terms of high quality", 58, ViewBlend::CLOSE),
];

/// Names of the columns, and which σ and cosine belong to each.
type Part = (&'static str, fn(f64, f64) -> bool);
const PARTS: [Part; 4] = [
    ("σ ≥ 0.01, 0.02 ≤ μ < 0.98", |sigma, cos| sigma >= 0.01 && (0.02..0.98).contains(&cos)),
    ("σ ≥ 0.01, μ ≥ 0.98", |sigma, cos| sigma >= 0.01 && cos >= 0.98),
    ("σ ≥ 0.01, μ < 0.02", |sigma, cos| sigma >= 0.01 && cos < 0.02),
    ("σ < 0.01", |sigma, _| sigma < 0.01),
];

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    print_head(&[&["coordinate", "nodes"], &PARTS.map(|part| part.0)[..]].concat());
    let materials: Vec<Material> =
        [1.501, 1.505, 1.52, 1.56, 1.65, 2.0, 3.0, 8.0, 50.0, f64::INFINITY]
            .into_iter()
            .flat_map(|gamma| {
                [1e-6, 1e-4, 0.003, 0.01, 0.02, 0.05, 0.3, 1.0, 3.0]
                    .map(|sigma| Material { sigma, gamma })
            })
            .collect();
    for design in &DESIGNS {
        let worst = materials
            .par_iter()
            .map(|&material| errors(design, material))
            .reduce(|| [[0.0; 2]; 4], |a, b| array(|i| array(|j| a[i][j].max(b[i][j]))));
        let cells = worst.map(|[e, all]| format!("{e:.1e} / {all:.1e}"));
        println!("| {} | {} | {} |", design.name, design.nodes, cells.join(" | "));
    }
    Ok(())
}

fn array<T, const N: usize>(of: impl FnMut(usize) -> T) -> [T; N] {
    std::array::from_fn(of)
}

/// Largest errors of E, and of any of E, scale, bias and F82, of either form of masking, in each
/// part of the domain.
fn errors(design: &Design, material: Material) -> [[f64; 2]; 4] {
    let shape = Shape::new(material.gamma).expect("in the family");
    let integrator = AlbedoIntegrator::new(shape, 1e-7);
    let exact = |cos: f64| {
        let albedo = integrator.reflection(material.sigma, cos, weights).expect("in the domain");
        [albedo.uncorrelated, albedo.height_correlated]
    };
    let prepared = |blend: &ViewBlend| blend.prepare(material.sigma, material.gamma);
    let first = prepared(&ViewBlend::BAKED).floor();
    let at = |cos: f64| match &design.coordinate {
        Coordinate::Plain(t) => (t(cos) - t(first)) / (1.0 - t(first)),
        Coordinate::Blend(blend) => prepared(blend).coordinate(cos),
    };
    let nodes = even_nodes(0.0, 1.0, design.nodes);
    // Tables store the moments less E times a mirror's.
    let stored = |cos: f64, forms: [[f64; 3]; 2]| {
        let mirror = weights(cos);
        forms.map(|[scale, bias, f82]| {
            let e = scale + bias;
            [e, bias - e * mirror[1], f82 - e * mirror[2]]
        })
    };
    let node = |&t: &f64| {
        let cos = cosine(at, first, t);
        stored(cos, exact(cos))
    };
    let values: Vec<[[f64; 3]; 2]> = nodes.iter().map(node).collect();
    let got = |cos: f64| -> [[f64; 3]; 2] {
        let weights_at = lagrange::weights(&nodes, at(cos).clamp(0.0, 1.0), design.window);
        let mirror = weights(cos);
        array(|form| {
            let [e, bias, f82] =
                array(|k| weights_at.iter().map(|&(i, w)| w * values[i][form][k]).sum::<f64>());
            let bias = bias + e * mirror[1];
            [e - bias, bias, f82 + e * mirror[2]]
        })
    };
    let mut worst = [[0.0_f64; 2]; 4];
    // Three points in each cell, one of them near its middle.
    for i in 0..3 * (design.nodes - 1) {
        let t = (i as f64 / 3.0 + 0.2) / (design.nodes - 1) as f64;
        let cos = cosine(at, first, t);
        let mut error = [0.0_f64; 2];
        for (want, got) in exact(cos).into_iter().zip(got(cos)) {
            let total = (want[0] + want[1] - got[0] - got[1]).abs();
            let moments = want.iter().zip(got).map(|(a, b)| (a - b).abs()).fold(total, f64::max);
            error = [error[0].max(total), error[1].max(moments)];
        }
        for (worst, part) in worst.iter_mut().zip(PARTS) {
            if part.1(material.sigma, cos) {
                *worst = [worst[0].max(error[0]), worst[1].max(error[1])];
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
