//! The pictures of `docs/idea.md`: what a tail is, what it does to masking and to visible normals,
//! a material that is no GGX, and what a certificate promises.
//!
//! ```sh
//! cargo run --release -p microfacet-study -- idea docs/idea
//! ```
//!
//! draws them as SVG into the folder, and prints the numbers that the page states. The spheres of
//! the page are `spheres docs/idea/tails --figure tails`.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_baker::progress::Stage;
use microfacet_baker::store;
use microfacet_fit::convert::Target;
use microfacet_model::{
    AlbedoIntegrator, MicrofacetDistribution as _, Shape, SignedSlope, StudentT, UnitView,
    VisibleSlope,
};
use microfacet_report::plot::{Axis, Curve, Dash, Figure, Key, Panel, shape_name};
use microfacet_sampler::{Masking, MicrofacetDistribution as _, Tables};
use microfacet_tables::{Kind, Quantity};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use crate::{Outcome, tail};

const GAMMAS: [f64; 4] = [1.6, 2.0, 4.0, f64::INFINITY];

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let [folder] = arguments else { return Err("name the folder for the pictures".into()) };
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    let figures = [
        ("distribution.svg", distribution()?),
        ("masking.svg", masking()?),
        ("glass.svg", glass()?),
        ("certified.svg", certified()?),
    ];
    for (name, figure) in figures {
        store::replace(&folder.join(name), figure.drawing().svg().as_bytes())?;
        println!("{}", folder.join(name).display());
    }
    Ok(())
}

/// A curve of each shape over an axis.
fn of_shapes(
    sigma: f64,
    [low, high]: [f64; 2],
    f: impl Fn(&StudentT, f64) -> f64,
) -> Result<Vec<Curve>, Box<dyn std::error::Error>> {
    let each = |gamma: f64| {
        let lobe = StudentT::new([sigma; 2], gamma)?;
        let places = (0..=400).map(|i| low + (high - low) * f64::from(i) / 400.0);
        let points = places.map(|x| (x, f(&lobe, x)));
        Ok(Curve::new(Key::Gamma(gamma), shape_name(gamma), points))
    };
    GAMMAS.into_iter().map(each).collect()
}

fn at(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

/// D over the angle of the microfacet normal, relative to its peak: one core, several tails.
fn distribution() -> Result<Figure, Box<dyn std::error::Error>> {
    const SIGMA: f64 = 0.1;
    let relative = |lobe: &StudentT, degrees: f64| lobe.d(at(degrees)) / lobe.d(at(0.0));
    for gamma in GAMMAS {
        let lobe = StudentT::new([SIGMA; 2], gamma)?;
        println!(
            "sigma {SIGMA}, {}: D at 20 degrees {:.1e} of the peak",
            shape_name(gamma),
            relative(&lobe, 20.0)
        );
    }
    let x = |high| Axis::degrees("angle θ of the facet", 0.0, high);
    Ok(Figure::new([
        Panel::new(
            format!("The core, σ = {SIGMA}"),
            x(20.0),
            Axis::linear("D(θ)/D(0)", 0.0, 1.0),
            of_shapes(SIGMA, [0.0, 20.0], relative)?,
        ),
        Panel::new(
            format!("The tail, σ = {SIGMA}"),
            x(60.0),
            Axis::log("D(θ)/D(0)", 1e-6, 1.0),
            of_shapes(SIGMA, [0.0, 60.0], relative)?,
        ),
    ]))
}

/// The smallest tilt that is shown, in degrees.
const LOW: f64 = -30.0;

/// G1 over the angle of the view, and which facets a view sees; the dots were drawn by the tables.
fn masking() -> Result<Figure, Box<dyn std::error::Error>> {
    const SIGMA: f64 = 0.5;
    const VIEW: f64 = 75.0;
    let g1 = of_shapes(SIGMA, [0.0, 90.0], |lobe, degrees| lobe.g1(at(degrees)))?;
    let mut seen = of_shapes(SIGMA, [LOW, 90.0], |lobe, degrees| facing(lobe, VIEW, degrees))?;
    let tables = Tables::embedded();
    for gamma in GAMMAS {
        let lobe = tables.student_t(SIGMA, gamma)?;
        let points = drawn(|u| lobe.sample_visible_normal(at(VIEW).as_vec3(), u));
        let name = if gamma == GAMMAS[0] { "drawn by the tables" } else { "" };
        seen.push(Curve::new(Key::Gamma(gamma), name, points).dashed(Dash::Points));
    }
    Ok(Figure::new([
        Panel::new(
            format!("Masking, σ = {SIGMA}"),
            Axis::degrees("angle θ of the view", 0.0, 90.0),
            Axis::linear("masking G₁(θ)", 0.0, 1.0),
            g1,
        ),
        Panel::new(
            format!("Facets seen from {VIEW}°, σ = {SIGMA}"),
            Axis::degrees("tilt towards the view", LOW, 90.0),
            Axis::linear("density (1/°)", 0.0, 0.03),
            seen,
        ),
    ]))
}

/// The density of the tilts towards the view of visible normals, for each degree.
fn facing(lobe: &StudentT, view: f64, degrees: f64) -> f64 {
    let (shape, sigma) = (lobe.shape(), lobe.sigma_x());
    let (v, tilt) = (at(view), degrees.to_radians());
    let seen = VisibleSlope::new(shape, UnitView::from_cotangent(v.z / v.x / sigma));
    let x = tilt.tan() / sigma;
    let slope = SignedSlope { w: shape.asinh_slope(x.abs()), sign: x.signum() };
    // From w to the unit slope x, and from there to degrees.
    let unit = seen.density(slope) / (1.0 + shape.s() * x * x).sqrt();
    unit / (sigma * tilt.cos().powi(2)) * PI / 180.0
}

/// A histogram of the tilts of normals towards the view, at the middles of its bins.
fn drawn(sample: impl Fn([f32; 2]) -> [f32; 3]) -> Vec<(f64, f64)> {
    const COUNT: usize = 1_000_000;
    /// Degrees.
    const BIN: f64 = 3.0;
    const BINS: usize = 40;
    let mut random = StdRng::seed_from_u64(1);
    let mut counts = [0.0; BINS];
    for _ in 0..COUNT {
        let m = sample([random.random(), random.random()]);
        let degrees = f64::from(m[0].atan2(m[2])).to_degrees();
        let bin = ((degrees - LOW) / BIN).floor();
        if (0.0..BINS as f64).contains(&bin) {
            counts[bin as usize] += 1.0 / (COUNT as f64 * BIN);
        }
    }
    counts.iter().enumerate().map(|(i, &y)| ((i as f64 + 0.5) * BIN + LOW, y)).collect()
}

/// σ and γ of the frosted glass of d'Eon 2023.
const GLASS: [f64; 2] = [0.454, 3.0];

/// The frosted glass of d'Eon 2023 beside the nearest GGX and the nearest Beckmann.
fn glass() -> Result<Figure, Box<dyn std::error::Error>> {
    let glass = Named { kind: DistributionKind::StudentT, values: GLASS.into() };
    let built = glass.build()?;
    let target = Target::new(&*built);
    let [sigma, gamma] = GLASS;
    let name = format!("frosted glass: Student-t, σ = {sigma}, γ = {gamma}");
    // By shape, as in the other pictures of the page.
    let curve = |name: String, gamma, of: &Named| {
        Ok::<_, String>(Curve::new(Key::Gamma(gamma), name, tail::slopes(of)?))
    };
    let mut curves = vec![curve(name, gamma, &glass)?.dashed(Dash::Solid)];
    for (kind, name, gamma) in [
        (DistributionKind::TrowbridgeReitz, "GGX", 2.0),
        (DistributionKind::Beckmann, "Beckmann", f64::INFINITY),
    ] {
        let found = target.by_variation(kind, &Stage::unwatched())?;
        println!(
            "frosted glass, nearest {}: sigma {:.3}, total variation {:.3}",
            kind.name(),
            found.to.values[0],
            found.variation
        );
        curves.push(curve(format!("{name}, the nearest"), gamma, &found.to)?);
    }
    let x = Axis::log("slope tan θ", 1e-2, 10.0);
    let y = Axis::linear("density over ln(slope)", 0.0, 0.8);
    let panel = Panel::new("Slopes of a frosted glass", x, y, curves);
    Ok(Figure::stacked([panel]))
}

/// Errors of the default set's albedos between its nodes, and its certificate.
fn certified() -> Result<Figure, Box<dyn std::error::Error>> {
    const SIGMAS: [f64; 2] = [0.01, 3.0];
    let tables = Tables::embedded();
    let masking = Masking::HeightCorrelated;
    let of_metals = tables.tables().iter().filter(|table| table.kind == Kind::Albedo);
    let promised =
        of_metals.filter_map(|table| table.certificate.error(Quantity::E)).fold(0.0, f64::max);
    let sigmas: Vec<f64> =
        (0..=160).map(|i| SIGMAS[0] * (SIGMAS[1] / SIGMAS[0]).powf(f64::from(i) / 160.0)).collect();
    let cosines: Vec<f64> = (0..=24).map(|i| 0.02 + 0.98 * f64::from(i) / 24.0).collect();
    let mut curves = Vec::new();
    for gamma in GAMMAS {
        let model = AlbedoIntegrator::new(Shape::new(gamma)?, 1e-9);
        let points: Result<Vec<_>, Box<dyn std::error::Error + Send + Sync>> = sigmas
            .par_iter()
            .map(|&sigma| {
                let table = tables.albedo(sigma, gamma, masking)?;
                let mut worst = 0.0_f64;
                for &cos in &cosines {
                    let [e] = model.reflection(sigma, cos, |_| [1.0])?.of(masking);
                    let v = DVec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos).as_vec3();
                    worst = worst.max((f64::from(table.albedo(v)) - e).abs());
                }
                Ok((sigma, worst))
            })
            .collect();
        let points = points.map_err(|why| why.to_string())?;
        curves.push(Curve::new(Key::Gamma(gamma), shape_name(gamma), points));
    }
    let bound = SIGMAS.map(|sigma| (sigma, promised));
    curves.push(Curve::new(Key::OTHER, "certificate", bound).dashed(Dash::LongDashed));
    println!("certificate of E in the default set: {promised:.2e}");
    let panel = Panel::new(
        "Error of E between nodes, 25 views",
        Axis::log("roughness σ", SIGMAS[0], SIGMAS[1]),
        Axis::log("largest error of E", 1e-7, 1e-3),
        curves,
    );
    Ok(Figure::stacked([panel]))
}

/// The Python package draws shapes in the same colours.
#[test]
fn matplotlib_has_the_colours_of_these_pictures() {
    let style = include_str!("../../../clients/python/examples/plot_style.py");
    let drawn = distribution().unwrap().drawing().svg();
    let colours: Vec<&str> = style.split('"').filter(|word| word.starts_with('#')).collect();
    assert!(colours.len() > GAMMAS.len());
    for colour in colours {
        assert!(drawn.contains(&format!("stroke=\"{colour}\"")), "{colour} of plot_style.py");
    }
}
