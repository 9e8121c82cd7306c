//! How far the albedo of a round lobe is off where it stands in for an anisotropic one.
//!
//! `cargo run --profile dist -p microfacet-study -- stand_in` prints the table in `docs/albedo.md`,
//! whose numbers are those of [`microfacet_baker::plan::StandIn`]: the largest difference of E over
//! all shapes, both forms of masking, views and azimuths, rounded up.

use microfacet_baker::plan::StandIn;
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use microfacet_sampler::Masking;
use rayon::prelude::*;

use crate::{Outcome, print_head};

const GAMMAS: [f64; 11] = [1.501, 1.52, 1.55, 1.65, 1.8, 2.0, 2.5, 4.0, 10.0, 40.0, f64::INFINITY];
const COSINES: [f64; 14] =
    [0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Azimuths in degrees: E turns the faster the narrower the lobe is.
const AZIMUTHS: [f64; 8] = [0.0, 1.0, 3.0, 10.0, 30.0, 60.0, 80.0, 90.0];
/// Between the places that are measured the differences are larger, by this factor at most.
const BETWEEN: f64 = 1.1;
/// The ratio that stands for any larger one, and the roughness that does.
const LARGE: f64 = 1e3;

/// The largest difference of E, of a lobe of roughness `sigma` and `sigma`/`ratio`.
fn off(model: &AlbedoIntegrator, sigma: f64, ratio: f64) -> Result<f64, ParameterError> {
    let mut largest = 0.0_f64;
    let weight = |_| [1.0];
    for cos in COSINES {
        let round = model.reflection(sigma / ratio.sqrt(), cos, weight)?;
        for phi in AZIMUTHS {
            let lobe = [sigma, sigma / ratio];
            let exact = model.reflection_anisotropic(lobe, cos, phi.to_radians(), weight)?;
            for form in Masking::ALL {
                largest = largest.max((exact.of(form)[0] - round.of(form)[0]).abs());
            }
        }
    }
    Ok(largest)
}

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    let models: Vec<AlbedoIntegrator> = GAMMAS
        .par_iter()
        .map(|&gamma| Ok(AlbedoIntegrator::new(Shape::new(gamma)?, 1e-4)))
        .collect::<Result<_, ParameterError>>()?;
    let larger = StandIn::SIGMAS.map(|sigma| format!("{sigma}"));
    let columns: Vec<&str> = larger.iter().map(String::as_str).collect();
    print_head(&[&["ratio up to"], &columns[..]].concat());
    let mut above = [0.0_f64; StandIn::SIGMAS.len()];
    for ratio in StandIn::RATIOS {
        let mut largest = 0.0_f64;
        let mut row = String::new();
        let mut from = 0.003;
        for (sigma, above) in StandIn::SIGMAS.into_iter().zip(&mut above) {
            // Places between the columns too, since E need not be monotonic.
            let to = if sigma.is_finite() { sigma } else { LARGE };
            let places: Vec<f64> =
                (1..=4).map(|i| from * (to / from).powf(f64::from(i) / 4.0)).collect();
            let ratio = if ratio.is_finite() { ratio } else { LARGE };
            let all: Vec<(&AlbedoIntegrator, f64)> =
                models.iter().flat_map(|model| places.iter().map(move |&at| (model, at))).collect();
            // Albedos have a stand-in up to the largest σ of their tables.
            let served = |&(_, at): &(_, f64)| at / ratio.sqrt() <= microfacet_tables::SIGMA_MAX;
            let found = all.into_par_iter().filter(served).map(|(model, at)| off(model, at, ratio));
            let found: Vec<f64> = found.collect::<Result<_, _>>()?;
            largest = found.into_iter().fold(largest, f64::max);
            *above = above.max(largest);
            row += &format!(" {:.2} |", ((100.0 * BETWEEN * *above).ceil() / 100.0).min(1.0));
            from = to;
        }
        println!("| {ratio} |{row}");
    }
    Ok(())
}
