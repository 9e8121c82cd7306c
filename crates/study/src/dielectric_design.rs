//! Why the default set holds no albedos of dielectrics: errors and sizes of coarse tables over
//! nearly all of γ, σ and η, and over smaller ranges.
//!
//! `cargo run --release -p microfacet-study -- dielectric_design` prints the table in
//! `docs/albedo.md`. Each row is baked with nodes spread evenly in the coordinates of albedo
//! tables, stored in 16 bits, and measured by the certificate, for height-correlated masking. `--
//! 7` prints the seventh row alone.

use microfacet_baker::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec};
use microfacet_sampler::Masking;
use microfacet_tables::axis::{
    CriticalBlend, LogRoughness, LogShape, ReflectanceRoot, ViewBlend, even_nodes,
};
use microfacet_tables::{
    Axis, Errors, Interpolation, Interval, Mapping, Precision, Reflectance, Roughness, Side,
};

use crate::{Outcome, baked, print_head};

/// Tolerance of a node. The quadrature's estimates of errors are conservative: throughout the
/// domain even 1e-2 gives values that are right to 2e-4.
const TOLERANCE: f64 = 1e-3;

/// What the tables of a row cover, and their nodes.
struct Design {
    /// Smallest γ; the largest is ∞.
    gamma: f64,
    /// Largest σ; the smallest is 0.
    sigma: f64,
    eta: [f64; 2],
    shapes: usize,
    roughnesses: usize,
    indices: usize,
    /// Views from the thin side, and in either half of those from the dense side.
    views: [usize; 2],
}

impl Design {
    fn name(&self) -> String {
        let Self { gamma, sigma, eta: [from, to], .. } = self;
        format!("gamma {gamma} to inf, sigma 0 to {sigma}, eta {from} to {to}")
    }

    /// Nodes of the dense side's views, on both sides of the critical angle.
    fn dense(&self) -> usize {
        2 * self.views[1] - 1
    }

    fn spec(&self, side: Side) -> AlbedoSpec {
        let (shape, rough) = (LogShape::BAKED, LogRoughness::BAKED);
        let of = |name, mapping, [from, to]: [f64; 2], count| {
            Axis::new(name, mapping, Interpolation::Lagrange6, even_nodes(from, to, count))
        };
        let (view, views) = match side {
            Side::Thin => (Mapping::ViewBlend(ViewBlend::BAKED), self.views[0]),
            Side::Dense => (Mapping::CriticalBlend(CriticalBlend::BAKED), self.dense()),
        };
        let gammas = [0.0, shape.coordinate(self.gamma)];
        let sigmas = [rough.first, self.sigma].map(|sigma| rough.coordinate(sigma));
        let etas = self.eta.map(|eta| ReflectanceRoot.coordinate(eta));
        let sigma = Interval { min: 0.0, max: self.sigma };
        let gamma = Interval { min: self.gamma, max: f64::INFINITY };
        AlbedoSpec {
            lobe: AlbedoLobe::family(Roughness::Isotropic(sigma), gamma),
            reflectance: Reflectance::Interface { side, index: self.eta.into() },
            maskings: vec![Masking::HeightCorrelated],
            axes: vec![
                of("gamma", Mapping::LogShape(shape), gammas, self.shapes),
                of("sigma", Mapping::LogRoughness(rough), sigmas, self.roughnesses),
                of("eta", Mapping::ReflectanceRoot, etas, self.indices),
                Axis::placed("view", view, Interpolation::Lagrange6, views),
            ],
            tolerance: TOLERANCE,
            precision: Precision::U16,
        }
    }
}

const SMALL: Design = Design {
    gamma: 2.0,
    sigma: 1.0,
    eta: [1.05, 2.0],
    shapes: 6,
    roughnesses: 20,
    indices: 9,
    views: [19, 25],
};

/// The domain that tables should cover.
const LARGE: Design = Design {
    gamma: 1.6,
    sigma: 3.0,
    eta: [1.05, 3.0],
    shapes: 8,
    roughnesses: 18,
    indices: 9,
    views: [19, 21],
};

const DESIGNS: [Design; 7] = [
    LARGE,
    Design { roughnesses: 22, indices: 12, views: [21, 33], ..LARGE },
    Design { sigma: 3.0, roughnesses: 22, indices: 11, ..SMALL },
    Design { gamma: 1.6, shapes: 8, roughnesses: 18, ..SMALL },
    Design { eta: [1.0, 2.0], indices: 12, ..SMALL },
    Design { eta: [1.05, 3.0], roughnesses: 22, indices: 10, ..SMALL },
    SMALL,
];

/// The largest and the root-mean-square error of either share in the promised range, and the
/// largest outside.
fn errors(spec: &AlbedoSpec) -> Result<String, AlbedoError> {
    let tables = baked(spec)?;
    let all: Vec<Errors> =
        tables.iter().flat_map(|table| table.certificate.errors.values().copied()).collect();
    let worst =
        |figure: fn(&Errors) -> Option<f64>| all.iter().filter_map(figure).fold(0.0, f64::max);
    let errors = [worst(|of| Some(of.largest)), worst(|of| of.rms), worst(|of| of.outside)];
    Ok(errors.map(|x| format!("{x:.1e}")).join(" / "))
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let row: Option<usize> = arguments.first().and_then(|row| row.parse().ok());
    print_head(&["covered", "γ × σ × η", "views", "bytes", "thin side", "dense side"]);
    let rows = DESIGNS.iter().enumerate().filter(|(i, _)| row.is_none_or(|row| row == i + 1));
    for (_, design) in rows {
        let specs = [Side::Thin, Side::Dense].map(|side| design.spec(side));
        let Design { shapes, roughnesses, indices, views: [views, _], .. } = design;
        println!(
            "| {} | {shapes} × {roughnesses} × {indices} | {views}, {} | {} | {} | {} |",
            design.name(),
            design.dense(),
            specs.iter().map(AlbedoSpec::bytes).sum::<usize>(),
            errors(&specs[0])?,
            errors(&specs[1])?
        );
    }
    Ok(())
}
