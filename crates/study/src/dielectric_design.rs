//! What the default set holds of dielectrics: errors and sizes of coarse tables over nearly all of
//! γ, σ and η, and over smaller ranges.
//!
//! `cargo run --release -p microfacet-study -- dielectric_design` prints the table in
//! `docs/albedo.md`. Each row is baked with nodes spread evenly in the coordinates of albedo
//! tables, stored in 16 bits, and measured by the certificate, for height-correlated masking. `--
//! 9` prints the ninth row alone, which is that of the default set.

use microfacet_baker::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec, CoarseNodes};
use microfacet_baker::plan::RequiredAlbedo;
use microfacet_baker::table_spec::Level;
use microfacet_sampler::Masking;
use microfacet_tables::{Errors, Interval, Precision, Roughness, Side};

use crate::{Outcome, baked, print_head};

/// What the tables of a row cover, and their nodes.
struct Design {
    /// Smallest γ; the largest is ∞.
    gamma: f64,
    /// Largest σ; the smallest is 0.
    sigma: f64,
    eta: [f64; 2],
    nodes: CoarseNodes,
}

impl Design {
    fn name(&self) -> String {
        let Self { gamma, sigma, eta: [from, to], .. } = self;
        format!("gamma {gamma} to inf, sigma 0 to {sigma}, eta {from} to {to}")
    }

    fn spec(&self, side: Side) -> AlbedoSpec {
        let sigma = Interval { min: 0.0, max: self.sigma };
        let gamma = Interval { min: self.gamma, max: f64::INFINITY };
        let lobe = AlbedoLobe::family(Roughness::Isotropic(sigma), gamma);
        let maskings = vec![Masking::HeightCorrelated];
        AlbedoSpec::coarse(lobe, (side, self.eta.into()), maskings, &self.nodes, Precision::U16)
    }
}

const SMALL: Design = Design {
    gamma: 2.0,
    sigma: 1.0,
    eta: [1.05, 2.0],
    nodes: CoarseNodes { shapes: 6, roughnesses: 20, indices: 9, views: [19, 25] },
};

/// The domain that tables should cover.
const LARGE: Design = Design {
    gamma: 1.6,
    sigma: 3.0,
    eta: [1.05, 3.0],
    nodes: CoarseNodes { shapes: 8, roughnesses: 18, indices: 9, views: [19, 21] },
};

fn designs() -> [Design; 9] {
    let [large, small] = [LARGE.nodes, SMALL.nodes];
    let finer = CoarseNodes { roughnesses: 22, indices: 12, views: [21, 33], ..large };
    let glass = RequiredAlbedo::common_glass()[0].clone();
    let index = glass.reflectance.indices().unwrap_or(Interval::UNIT);
    let common = Design {
        gamma: glass.lobe.gamma.min,
        sigma: glass.lobe.roughness.x().max,
        eta: index.into(),
        nodes: CoarseNodes::at(Level::DEFAULT),
    };
    [
        LARGE,
        Design { nodes: finer, ..LARGE },
        Design {
            sigma: 3.0,
            nodes: CoarseNodes { roughnesses: 22, indices: 11, ..small },
            ..SMALL
        },
        Design { gamma: 1.6, nodes: CoarseNodes { shapes: 8, roughnesses: 18, ..small }, ..SMALL },
        Design { eta: [1.0, 2.0], nodes: CoarseNodes { indices: 12, ..small }, ..SMALL },
        Design {
            eta: [1.05, 3.0],
            nodes: CoarseNodes { roughnesses: 22, indices: 10, ..small },
            ..SMALL
        },
        SMALL,
        Design { eta: common.eta, nodes: CoarseNodes { indices: 5, ..small }, ..SMALL },
        common,
    ]
}

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
    let designs = designs();
    let rows = designs.iter().enumerate().filter(|(i, _)| row.is_none_or(|row| row == i + 1));
    for (_, design) in rows {
        let specs = [Side::Thin, Side::Dense].map(|side| design.spec(side));
        let CoarseNodes { shapes, roughnesses, indices, views: [views, _] } = design.nodes;
        println!(
            "| {} | {shapes} × {roughnesses} × {indices} | {views}, {} | {} | {} | {} |",
            design.name(),
            design.nodes.dense(),
            specs.iter().map(AlbedoSpec::bytes).sum::<usize>(),
            errors(&specs[0])?,
            errors(&specs[1])?
        );
    }
    Ok(())
}
