//! Fits to synthetic measurements of normals, for `docs/fitting.md`: which of five distributions is
//! nearest, and with which parameters.
//!
//! ```sh
//! cargo run --release -p microfacet-study -- fit_normals
//! ```
//!
//! Each measurement is a D at every quarter of a degree up to 85°, with noise of 2 % of itself.

use microfacet_baker::distribution::Named;
use microfacet_baker::progress::Meter;
use microfacet_fit::convert::Form;
use microfacet_fit::fit;
use microfacet_model::classic::Tabulated;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::{Outcome, print_head};

const MADE: [&str; 8] = [
    "beckmann:0.2",
    "ggx:0.2",
    "student-t:0.2,1.7",
    "student-t:0.2,3",
    "haze:0.08,0.35,0.4",
    "haze:0.15,0.3,0.3",
    "abc:300,1.4",
    "gtr:0.1,1.5",
];

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    print_head(&["made of", "Student-t", "Beckmann", "GGX", "haze", "abc", "nearest"]);
    for text in MADE {
        let truth = text.parse::<Named>()?.build()?;
        let mut rng = StdRng::seed_from_u64(11);
        let row = |i: u32| {
            let theta = (0.25 * f64::from(i)).to_radians();
            (theta, truth.d(theta) * (1.0 + 0.02 * (2.0 * rng.random::<f64>() - 1.0)))
        };
        let rows: Vec<(f64, f64)> = (0..=340).map(row).collect();
        let found = fit(&Tabulated::new(&rows)?, Form::Relative, &Meter::default())?;
        let errors = found.all().map(|fitted| format!("{:.2e}", fitted.rmse[0]));
        let nearest = found.all().into_iter().min_by(|a, b| a.rmse[0].total_cmp(&b.rmse[0]));
        let nearest = &nearest.expect("there are five").to;
        println!("| `{text}` | {} | `{nearest}` |", errors.join(" | "));
    }
    Ok(())
}
