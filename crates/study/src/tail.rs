//! The tail of a lobe, by a second GGX and by one γ: how far each follows the other.
//!
//! ```sh
//! cargo run --release -p microfacet-study -- tail docs
//! ```
//!
//! prints the tables of `docs/tail.md` and draws its pictures, `tail.svg` and `tail_gamma.svg`,
//! into the folder; without one it only prints. Distances are total variations of the densities of
//! slopes, as `convert --by variation` makes them least.

use std::path::Path;

use glam::DVec3;
use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Stage;
use microfacet_baker::store;
use microfacet_core::Masking;
use microfacet_core::shape::gamma_of_s;
use microfacet_fit::convert::{Replacement, Target};
use microfacet_model::{MicrofacetDistribution, StudentT};
use microfacet_report::plot::{Axis, Curve, Dash, Figure, Key, Panel};
use rayon::prelude::*;

use crate::{Outcome, print_head};

/// σ of the Student-ts; where lobes are narrow, distances hang on γ only.
const SIGMA: f64 = 0.2;
const GAMMAS: [f64; 9] = [1.55, 1.6, 1.7, 1.8, 2.0, 2.5, 3.0, 6.0, f64::INFINITY];
/// Roughnesses of a core, spreads and weights of its haze, by OpenPBR 1.2.
const ROUGHNESSES: [f64; 2] = [0.1, 0.3];
const SPREADS: [f64; 3] = [0.1, 0.25, 0.5];
const WEIGHTS: [f64; 3] = [0.1, 0.3, 0.5];

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let folder = match arguments {
        [] => None,
        [folder] if !folder.starts_with('-') => Some(Path::new(folder)),
        _ => return Err("name at most one folder, for the pictures".into()),
    };
    println!("one Student-t of sigma = {SIGMA} by two GGX, and by one\n");
    print_head(&["gamma", "core + haze", "TV", "reflection", "one GGX", "TV"]);
    let rows: Result<Vec<_>, String> = GAMMAS.into_par_iter().map(of_gamma).collect();
    for (gamma, pair, one) in rows? {
        println!(
            "| {gamma} | `{}` | {:.4} | {:.3} | {:.4} | {:.4} |",
            short(&pair.to),
            pair.variation,
            pair.reflection,
            one.to.values[0],
            one.variation
        );
    }
    println!("\na haze of OpenPBR by one Student-t, and by one GGX\n");
    print_head(&["r", "spread", "weight", "haze", "Student-t", "TV", "reflection", "one GGX: TV"]);
    let all = ROUGHNESSES.iter().flat_map(|&r| {
        SPREADS.iter().flat_map(move |&spread| WEIGHTS.iter().map(move |&w| [r, spread, w]))
    });
    let all: Vec<[f64; 3]> = all.collect();
    let rows: Result<Vec<_>, String> = all
        .into_par_iter()
        .map(|of| {
            let haze = openpbr(of);
            let found = nearest(&haze, DistributionKind::StudentT)?;
            let one = nearest(&haze, DistributionKind::TrowbridgeReitz)?;
            Ok((of, haze, found, one))
        })
        .collect();
    for ([r, spread, weight], haze, found, one) in rows? {
        println!(
            "| {r} | {spread} | {weight} | `{}` | `{}` | {:.4} | {:.3} | {:.4} |",
            short(&haze),
            short(&found.to),
            found.variation,
            found.reflection,
            one.variation
        );
    }
    println!("\none surface of both normals by a sum of two reflections\n");
    print_head(&["haze", "light at 45 degrees", "at 70 degrees", "at 80 degrees"]);
    for of in [[0.3, 0.25, 0.3], [0.1, 0.25, 0.3], [0.1, 0.5, 0.5], [0.3, 0.8, 0.5]] {
        let haze = openpbr(of);
        let apart = [45.0, 70.0, 80.0].map(|light| format!("{:.4}", two_maskings(&haze, light)));
        println!("| `{}` | {} |", short(&haze), apart.join(" | "));
    }
    let Some(folder) = folder else { return Ok(()) };
    std::fs::create_dir_all(folder)?;
    for (name, figure) in [("tail.svg", lobes()?), ("tail_gamma.svg", over_gamma()?)] {
        store::replace(&folder.join(name), figure.drawing().svg().as_bytes())?;
        println!("{}", folder.join(name).display());
    }
    Ok(())
}

/// The core and haze of a roughness r, a spread and a weight: α = r² of the core, and
/// (r + (1−r) spread)² of the haze.
fn openpbr([r, spread, weight]: [f64; 3]) -> Named {
    let wide = r + (1.0 - r) * spread;
    Named { kind: DistributionKind::Haze, values: vec![r * r, wide * wide, weight] }
}

/// The largest difference of a core + haze from the sum of the two reflections, each with the
/// masking of its own GGX, over the largest value of that sum; views are in the plane of incidence,
/// at most 80° from the normal.
fn two_maskings(haze: &Named, light: f64) -> f64 {
    let &[core, wide, weight] = &haze.values[..] else { return f64::NAN };
    let lobes = [core, wide].map(|sigma| StudentT::ggx(sigma).expect("a roughness"));
    let shares = [1.0 - weight, weight];
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        DVec3::new(sin, 0.0, cos)
    };
    let l = at(-light);
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for v in (-16_000..=16_000).map(|i| at(f64::from(i) / 200.0)) {
        let m = (v + l).normalize();
        let g2 = |of: &dyn Fn(DVec3) -> f64| {
            Masking::HeightCorrelated.g2(1.0 / (1.0 + of(v)), 1.0 / (1.0 + of(l)))
        };
        let sum = |of: &dyn Fn(&StudentT) -> f64| {
            lobes.iter().zip(shares).map(|(lobe, share)| share * of(lobe)).sum::<f64>()
        };
        let jacobian = 1.0 / (4.0 * v.z * l.z);
        let one = sum(&|lobe| lobe.d(m)) * g2(&|w| sum(&|lobe| lobe.lambda(w))) * jacobian;
        let two = sum(&|lobe| lobe.d(m) * g2(&|w| lobe.lambda(w))) * jacobian;
        (apart, largest) = (apart.max((one - two).abs()), largest.max(two));
    }
    apart / largest
}

fn student_t(gamma: f64) -> Named {
    Named { kind: DistributionKind::StudentT, values: vec![SIGMA, gamma] }
}

fn nearest(from: &Named, to: DistributionKind) -> Result<Replacement, String> {
    let built = from.build().map_err(|why| why.to_string())?;
    let found = Target::new(&*built).by_variation(to, &Stage::unwatched());
    found.map_err(|why| format!("{from}: {why}"))
}

/// A Student-t's γ, and what follows it: two GGX and one.
fn of_gamma(gamma: f64) -> Result<(f64, Replacement, Replacement), String> {
    let [pair, one] = [DistributionKind::Haze, DistributionKind::TrowbridgeReitz]
        .map(|to| nearest(&student_t(gamma), to));
    Ok((gamma, pair?, one?))
}

/// A distribution with four digits of its parameters.
fn short(named: &Named) -> String {
    let values: Vec<String> =
        named.values.iter().map(|x| format!("{}", (x * 1e4).round() / 1e4)).collect();
    format!("{}:{}", named.kind.name(), values.join(","))
}

/// Densities of slopes, over their logarithm, of distributions that are replaced and of what
/// replaces them.
fn lobes() -> Result<Figure, String> {
    let student_ts = [("γ = 1.6", 1.6), ("γ = 3", 3.0), ("γ = ∞", f64::INFINITY)];
    let hazes = [[0.3, 0.1, 0.3], [0.1, 0.25, 0.3], [0.1, 0.5, 0.5]];
    let pairs = student_ts.into_iter().zip(hazes).flat_map(|((name, gamma), haze)| {
        let [r, spread, weight] = haze;
        [
            (name.into(), student_t(gamma), DistributionKind::Haze),
            (format!("haze {r}, {spread}, {weight}"), openpbr(haze), DistributionKind::StudentT),
        ]
    });
    let pairs: Vec<(String, Named, DistributionKind)> = pairs.collect();
    let panels: Result<Vec<Panel>, String> = pairs
        .into_par_iter()
        .map(|(title, from, to)| {
            let found = nearest(&from, to)?;
            let one = nearest(&from, DistributionKind::TrowbridgeReitz)?;
            let title = format!("{title}: {:.3} apart", found.variation);
            let curves = [
                curve("GGX, the nearest", &one.to)?,
                curve(format!("{}, the nearest", name(to)), &found.to)?.dashed(Dash::DashDotted),
                curve(name(from.kind), &from)?,
            ];
            let x = Axis::log("slope tan θ", LOW, HIGH);
            let y = Axis::linear("density over ln(slope)", 0.0, 0.8);
            Ok(Panel::new(title, x, y, curves))
        })
        .collect();
    Ok(Figure::new(panels?))
}

/// What is replaced, or replaces it.
fn name(kind: DistributionKind) -> &'static str {
    if kind == DistributionKind::Haze { "core + haze" } else { "Student-t" }
}

const LOW: f64 = 1e-3;
const HIGH: f64 = 10.0;

fn curve(name: impl Into<String>, of: &Named) -> Result<Curve, String> {
    Ok(Curve::new(Key::Kind(of.kind), name, slopes(of)?))
}

/// The share of the projected area at the slopes of a distribution, over their logarithm.
pub(crate) fn slopes(of: &Named) -> Result<Vec<(f64, f64)>, String> {
    let built = of.build().map_err(|why| why.to_string())?;
    let slopes = (0..=400).map(|i| LOW * (HIGH / LOW).powf(f64::from(i) / 400.0));
    let density = |slope: f64| {
        let sin_cos = slope / (1.0 + slope * slope);
        (slope, std::f64::consts::TAU * built.d(slope.atan()) * sin_cos * sin_cos)
    };
    Ok(slopes.map(density).collect())
}

/// How far the nearest core + haze, and the nearest GGX, is from a Student-t, over 1/(γ−1).
fn over_gamma() -> Result<Figure, String> {
    let places: Vec<f64> = (0..=48).map(|i| 1.98 * f64::from(i) / 48.0).collect();
    let found: Result<Vec<_>, String> =
        places.par_iter().map(|&s| of_gamma(gamma_of_s(s))).collect();
    let found = found?;
    let points = |of: fn(&(f64, Replacement, Replacement)) -> f64| {
        places.iter().copied().zip(found.iter().map(of)).collect::<Vec<_>>()
    };
    let curves = [
        Curve::new(
            Key::Kind(DistributionKind::Haze),
            "the nearest core + haze",
            points(|(_, pair, _)| pair.variation),
        ),
        Curve::new(
            Key::Kind(DistributionKind::TrowbridgeReitz),
            "the nearest GGX",
            points(|(.., one)| one.variation),
        ),
    ];
    let numbers = [
        (0.0, "∞"),
        (1.0, "2"),
        (1.0 / 0.6, "1.6"),
        (0.5, "3"),
        (0.2, "6"),
        (1.0 / 0.8, "1.8"),
        (1.0 / 0.55, "1.55"),
    ];
    let x =
        Axis::marked("shape γ, evenly in 1/(γ−1)", numbers.map(|(s, name)| (s / 2.0, name.into())));
    let y = Axis::linear("total variation of slopes", 0.0, 0.25);
    let curves = curves.map(|curve| Curve {
        points: curve.points.iter().map(|&(s, y)| (s / 2.0, y)).collect(),
        ..curve
    });
    let panel = Panel::new("Distance of a Student-t from GGX", x, y, curves);
    Ok(Figure::stacked([panel]))
}
