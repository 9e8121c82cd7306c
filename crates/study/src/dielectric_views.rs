//! Where views from inside a dielectric have nodes: errors of one index and lobe with the two parts
//! of [`CriticalBlend::BAKED`] and with the three of [`CriticalBlend::UPRIGHT`].
//!
//! `cargo run --profile dist -p microfacet-study -- dielectric_views` prints the table in
//! `docs/albedo.md`, the largest error in the promised range over some roughnesses and indices; the
//! same at γ = 1.55 for other parameters of three parts; and the errors of tables over a range of
//! indices, before any refinement. `-- ranges` prints the last alone.

use microfacet_baker::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Masking;
use microfacet_tables::axis::CriticalBlend;
use microfacet_tables::{Axis, Interpolation, Mapping, Precision, Quantity, Reflectance, Side};

use crate::{Outcome, baked, print_head};

const GAMMAS: [f64; 5] = [1.501, 1.55, 1.7, 1.9, 3.0];
const SIGMAS: [f64; 3] = [0.1, 0.3, 1.0];
const ETAS: [f64; 4] = [1.05, 1.3, 1.5, 3.0];
/// Nodes in two and in three parts.
const VIEWS: [(CriticalBlend, usize); 2] =
    [(CriticalBlend::BAKED, 65), (CriticalBlend::UPRIGHT, 67)];

/// γ, the smallest and the largest index, and roughnesses.
const RANGES: [(f64, [f64; 2], &[f64]); 4] = [
    (3.0, [1.0, f64::INFINITY], &[0.454]),
    (3.0, [1.3, 3.0], &SIGMAS),
    (1.6, [1.3, 3.0], &SIGMAS),
    (1.55, [1.3, 3.0], &SIGMAS),
];

/// The specification from the dense side of some indices.
fn spec(lobe: AlbedoLobe, index: [f64; 2]) -> Result<AlbedoSpec, AlbedoError> {
    let dense = Reflectance::Interface { side: Side::Dense, index: index.into() };
    let maskings = vec![Masking::HeightCorrelated];
    AlbedoSpec::new(lobe, dense, maskings, Quality::Default, Precision::F32)
}

/// The largest error of the reflected and of the transmitted share.
fn largest(spec: &AlbedoSpec) -> Result<[f64; 2], AlbedoError> {
    let tables = baked(spec)?;
    let largest = |of| tables[0].certificate.errors.get(&of).map_or(f64::NAN, |of| of.largest);
    Ok([Quantity::Reflection, Quantity::Transmission].map(largest))
}

/// [`largest`] of one index and other views.
fn errors(
    lobe: AlbedoLobe,
    eta: f64,
    (blend, views): (CriticalBlend, usize),
) -> Result<[f64; 2], AlbedoError> {
    let mut spec = spec(lobe, [eta; 2])?;
    let mapping = Mapping::CriticalBlend(blend);
    let view = Axis::placed("view", mapping, Interpolation::Lagrange6, views);
    *spec.axes.last_mut().expect("the view is an axis") = view;
    largest(&spec)
}

/// The errors of tables over ranges of indices.
fn ranges() -> Result<(), AlbedoError> {
    print_head(&["γ, η", "σ", "indices × views", "reflected", "transmitted"]);
    for (gamma, index, sigmas) in RANGES {
        for &sigma in sigmas {
            let spec = spec(AlbedoLobe::student_t([sigma; 2], gamma), index)?;
            let [.., indices, views] = &spec.axes[..] else { unreachable!("both are axes") };
            let (indices, views, [a, b]) = (indices.len(), views.len(), index);
            let [reflected, transmitted] = largest(&spec)?;
            println!(
                "| {gamma}, {a} to {b} | {sigma} | {indices} × {views} | {reflected:.1e} | \
                 {transmitted:.1e} |"
            );
        }
    }
    Ok(())
}

/// The largest errors over roughnesses and indices, in words.
fn worst(gamma: f64, views: (CriticalBlend, usize)) -> Result<String, AlbedoError> {
    let mut worst = [0.0_f64; 2];
    for (sigma, eta) in SIGMAS.into_iter().flat_map(|sigma| ETAS.map(|eta| (sigma, eta))) {
        let here = errors(AlbedoLobe::student_t([sigma; 2], gamma), eta, views)?;
        worst = [worst[0].max(here[0]), worst[1].max(here[1])];
    }
    Ok(worst.map(|x| format!("{x:.1e}")).join(", "))
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    if arguments.first().is_some_and(|part| part == "ranges") {
        return Ok(ranges()?);
    }
    print_head(&["γ", "two parts, 65 views: reflected, transmitted", "three parts, 67 views"]);
    for gamma in GAMMAS {
        println!("| {gamma} | {} | {} |", worst(gamma, VIEWS[0])?, worst(gamma, VIEWS[1])?);
    }
    println!();
    print_head(&["root, sharp, between", "γ = 1.55: reflected, transmitted"]);
    let own = CriticalBlend::UPRIGHT;
    let beside = [
        own,
        CriticalBlend { root: 0.4, ..own },
        CriticalBlend { root: 0.55, between: 0.8, ..own },
        CriticalBlend { sharp: 0.05, ..own },
        CriticalBlend { sharp: 0.2, ..own },
        CriticalBlend { between: 0.7, ..own },
    ];
    for blend in beside {
        let CriticalBlend { root, sharp, between, .. } = blend;
        println!("| {root}, {sharp}, {between} | {} |", worst(1.55, (blend, VIEWS[1].1))?);
    }
    println!();
    Ok(ranges()?)
}
