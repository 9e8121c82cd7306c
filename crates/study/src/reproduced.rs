//! Numbers that papers print with figures drawn by `microfacet-bake plot`, computed again:
//! `cargo run --release -p microfacet-study -- reproduced`.

use std::f64::consts::FRAC_PI_2;

use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Stage;
use microfacet_fit::convert::{Form, Target};
use microfacet_report::plot;
use microfacet_report::plot::Curve;

use crate::{Outcome, print_head};

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    println!("Largest values of `plot beckmann-limit` over sigma, in %, after Ribardiere et al.");
    println!("2017, figure 10, with the bounds printed for gamma = 40 and sigma < 1.2:");
    let shapes = ["γ = 30", "γ = 40", "γ = 50", "γ = 100"];
    print_head(&[&["distance"], &shapes[..], &["printed", "kept at γ = 40"]].concat());
    for panel in plot::figure("beckmann-limit")?.panels {
        // The last curve is the printed bound.
        let highest: Vec<f64> = panel.curves.iter().map(|curve| largest(curve).1).collect();
        let cells: Vec<String> = highest.iter().map(|most| format!("{most:.3}")).collect();
        let kept = if highest[1] < highest[4] { "yes" } else { "no" };
        let title = panel.title.replace('|', "\\|");
        println!("| {title} | {} | {kept} |", cells.join(" | "));
    }

    println!("\nLargest differences of D/D(0) from Beckmann's in `plot distributions`, in %, with");
    println!("the parameters of Sawicki 2021, figures 1 and 2:");
    for panel in plot::figure("distributions")?.panels {
        if panel.title.starts_with("Difference") {
            println!("{}:", panel.title);
            for curve in &panel.curves {
                let (at, most) = largest(curve);
                println!("  {:28} {most:6.3} at {at:.2} degrees", curve.name);
            }
        }
    }

    println!("\nThe same for the Beckmann of least RMSE to each Blinn-Phong, the Schlick of its");
    println!("m, and the others of least RMSE to it, after the text of Sawicki 2021:");
    print_head(&["N", "m", "blinn-phong", "gauss", "trowbridge-reitz", "schlick", "sawicki"]);
    for n in [10.0, 40.0, 100.0, 1000.0] {
        let blinn_phong = Named { kind: DistributionKind::BlinnPhong, values: vec![n] };
        let beckmann = nearest(&blinn_phong, DistributionKind::Beckmann)?;
        let m = beckmann.values[0];
        let others = [
            blinn_phong,
            nearest(&beckmann, DistributionKind::Gauss)?,
            nearest(&beckmann, DistributionKind::TrowbridgeReitz)?,
            Named { kind: DistributionKind::Schlick, values: vec![m] },
            nearest(&beckmann, DistributionKind::Sawicki)?,
        ];
        let errors = others.iter().map(|other| difference(&beckmann, other));
        let cells: Vec<String> = errors
            .map(|error| Ok(format!("{:.3}", 100.0 * error?)))
            .collect::<Result<_, Box<dyn std::error::Error>>>()?;
        println!("| {n} | {m:.5} | {} |", cells.join(" | "));
    }
    Ok(())
}

/// Where a curve is largest by size, and how large.
fn largest(curve: &Curve) -> (f64, f64) {
    let sizes = curve.points.iter().map(|&(x, y)| (x, y.abs()));
    sizes.fold((0.0, 0.0), |most, at| if at.1 > most.1 { at } else { most })
}

/// The distribution of a kind with the least RMSE of D/D(0).
fn nearest(from: &Named, kind: DistributionKind) -> Result<Named, Box<dyn std::error::Error>> {
    let built = from.build()?;
    Ok(Target::new(&*built).by_rmse(kind, Form::Relative, &Stage::unwatched())?.to)
}

/// The largest difference of D/D(0).
fn difference(a: &Named, b: &Named) -> Result<f64, Box<dyn std::error::Error>> {
    let (a, b) = (a.build()?, b.build()?);
    let angles = (0..20_000).map(|i| FRAC_PI_2 * f64::from(i) / 20_000.0);
    Ok(angles.map(|at| (a.relative_d(at) - b.relative_d(at)).abs()).fold(0.0, f64::max))
}
