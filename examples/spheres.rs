//! Metal spheres under a simple sky, rendered with the BSDFs of the sampler crate.
//!
//! `cargo run --release --example spheres -- OUTPUT [WIDTH] [SAMPLES]` writes OUTPUT.exr (linear
//! radiance) and OUTPUT.png.
//!
//! Rows: the gold of Ribardière et al. 2017 (doi:10.1111/cgf.13137), σ = 0.3 and γ = 1.51, 1.65, 2,
//! 4, 10 and 50, single scattering; the same with multiple-scattering compensation; brushed
//! aluminium of σ = (0.3, 0.7), and the same tilted by half a radian about the brushing as
//! generalised ellipsoids, both for γ = 1.65, 2 and 10. The gold needs the embedded tables alone;
//! the albedos of the aluminium are baked when the program starts, which takes a while the first
//! time and is kept in the user's cache.

use std::error::Error;

use glam::{Mat3, Vec3, Vec4};
use microfacet_bake::cache::Cache;
use microfacet_bake::plan::{Options, Plan};
use microfacet_bake::scene::Scene;
use microfacet_bake::table_set::{Settings, Target, bake_with};
use microfacet_bake::table_spec::Quality;
use microfacet_sampler::{
    BindError, Bsdf, Compensation, Conductor, Lobe, Metal, Precision, StandIn, Tables, Transport,
};
use rayon::prelude::*;

const COLUMNS: usize = 6;
const ROWS: usize = 3;

/// Shapes of the brushed aluminium, and its tilts about the brushing in radians.
const BRUSHED: [f64; 3] = [1.65, 2.0, 10.0];
const TILTS: [f64; 2] = [0.0, 0.5];

type Metals = Vec<Conductor<Lobe>>;

fn name(tilt: f64, gamma: f64) -> String {
    format!("tilt {tilt} gamma {gamma}")
}

/// The embedded tables, and the albedos of lobes that are not round.
fn tables() -> Result<Tables, Box<dyn Error>> {
    let each = TILTS.iter().flat_map(|tilt| BRUSHED.iter().map(move |gamma| (tilt, gamma)));
    let recipe: String = each
        .map(|(&tilt, &gamma)| {
            let theta = if tilt == 0.0 { String::new() } else { format!("theta = [{tilt}, 0, 0]") };
            format!(
                "[[material]]\nname = \"{}\"\nsigma = [0.3, 0.7]\ngamma = {gamma:?}\n{theta}\n\
                 fresnel = \"mirror\"\n",
                name(tilt, gamma)
            )
        })
        .collect();
    let options = Options { embedded: true, ..Options::default() };
    let plan = Plan::new(&Scene::from_recipe_str(&recipe)?, options)?;
    let settings = Settings { cache: Cache::user(), ..Settings::default() };
    Ok(bake_with(&plan, Target::Quality(Quality::Draft, Precision::F32), settings)?
        .set
        .or_embedded())
}

fn materials(tables: &Tables) -> Result<Metals, BindError> {
    let mut all = Vec::new();
    for compensation in [Compensation::None, Compensation::KullaConty] {
        for gamma in [1.51, 1.65, 2.0, 4.0, 10.0, 50.0] {
            let gold = Conductor::new(tables.lobe(0.3, gamma)?, Metal::Gold);
            all.push(gold.compensated(tables, compensation, StandIn::Refused)?);
        }
    }
    for tilt in TILTS {
        for gamma in BRUSHED {
            let lobe = tables.material(&name(tilt, gamma))?;
            let aluminium = Conductor::new(lobe, Metal::Aluminium);
            let form = Compensation::KullaConty;
            all.push(aluminium.compensated(tables, form, StandIn::Refused)?);
        }
    }
    Ok(all)
}

/// The i-th point of the five-dimensional additive recurrence, shifted by a hash of `seed`.
fn sequence(i: usize, seed: u32) -> [f32; 5] {
    // Powers of 1/x for x⁶ = x + 1.
    const STEPS: [f64; 5] = [
        0.881271461633570,
        0.776639389089768,
        0.684430129585343,
        0.603168740685728,
        0.531555397715791,
    ];
    let mut hash = seed;
    STEPS.map(|step| {
        hash = (hash ^ (hash >> 16)).wrapping_add(0x9e37_79b9).wrapping_mul(0x85eb_ca6b);
        hash ^= hash >> 13;
        let shift = f64::from(hash) / 4_294_967_296.0;
        ((shift + step * (i + 1) as f64).fract() as f32).min(1.0 - f32::EPSILON)
    })
}

/// Radiance of the sky: blue towards the zenith, bright at the horizon, a sun and a lamp with soft
/// edges, a brown ground.
fn sky(d: Vec3) -> Vec3 {
    let lamp = |at: Vec3, degrees: f32, radiance: Vec3| {
        let off = (1.0 - d.dot(at.normalize())).max(0.0) / (1.0 - degrees.to_radians().cos());
        radiance / (1.0 + off * off * off)
    };
    let up = d.y.max(0.0).sqrt();
    let base = if d.y > 0.0 {
        Vec3::new(0.9, 0.93, 1.0).lerp(Vec3::new(0.12, 0.25, 0.6), up)
    } else {
        Vec3::new(0.42, 0.36, 0.3).lerp(Vec3::new(0.1, 0.085, 0.07), (-d.y).sqrt())
    };
    base + lamp(Vec3::new(-0.6, 0.75, 0.6), 14.0, Vec3::new(9.0, 8.4, 7.2))
        + lamp(Vec3::new(0.9, 0.25, 0.35), 14.0, Vec3::new(1.6, 2.2, 3.2))
}

/// Radiance towards the viewer of the sphere at (x, y) of the unit disc.
fn shade(metal: &Conductor<Lobe>, x: f32, y: f32, choice: f32, u: [f32; 2]) -> Vec3 {
    let n = Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
    // Brushed round the vertical axis.
    let tangent = Vec3::Y.cross(n).normalize_or(Vec3::X);
    let frame = Mat3::from_cols(tangent, n.cross(tangent), n);
    let v = frame.transpose() * Vec3::Z;
    let sample = metal.sample(v, choice, u, Transport::Radiance);
    sample.map_or(Vec3::ZERO, |sample| Vec3::from(sample.weight) * sky(frame * sample.l))
}

/// A pixel: premultiplied radiance and coverage.
fn pixel(materials: &[Conductor<Lobe>], x: usize, y: usize, cell: f32, samples: usize) -> Vec4 {
    let seed = (y as u32).wrapping_mul(0x9e37_79b1) ^ (x as u32).wrapping_mul(0x85eb_ca77);
    let mut sum = Vec4::ZERO;
    for i in 0..samples {
        let [a, b, choice, u1, u2] = sequence(i, seed);
        let (px, py) = ((x as f32 + a) / cell, (y as f32 + b) / cell);
        let (column, row) = (px as usize, py as usize);
        // Leaves a margin of a twelfth of the cell.
        let at = |p: f32| (2.0 * p.fract() - 1.0) * 1.2;
        let (sx, sy) = (at(px), -at(py));
        if sx * sx + sy * sy < 1.0 && column < COLUMNS && row < ROWS {
            sum += shade(&materials[row * COLUMNS + column], sx, sy, choice, [u1, u2]).extend(1.0);
        }
    }
    sum / samples as f32
}

/// Eight-bit sRGB with a shoulder, over a light grey.
fn display(pixel: Vec4) -> [u8; 3] {
    let background = 0.75;
    let encode = |x: f32| {
        let x = 1.0 - (-1.1 * x).exp();
        let x = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (255.0 * x + 0.5) as u8
    };
    let over = pixel.truncate() + (1.0 - pixel.w) * Vec3::splat(background);
    [encode(over.x), encode(over.y), encode(over.z)]
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let output = arguments.next().ok_or("usage: spheres OUTPUT [WIDTH] [SAMPLES]")?;
    let width: usize = arguments.next().map_or(Ok(1000), |x| x.parse())?;
    let samples: usize = arguments.next().map_or(Ok(256), |x| x.parse())?;
    let (cell, height) = (width as f32 / COLUMNS as f32, width * ROWS / COLUMNS);
    let materials = materials(&tables()?)?;
    let pixels: Vec<Vec4> = (0..width * height)
        .into_par_iter()
        .map(|i| pixel(&materials, i % width, i / width, cell, samples))
        .collect();
    exr::prelude::write_rgba_file(format!("{output}.exr"), width, height, |x, y| {
        let p = pixels[y * width + x];
        (p.x, p.y, p.z, p.w)
    })?;
    let bytes: Vec<u8> = pixels.iter().flat_map(|p| display(*p)).collect();
    let (w, h) = (width as u32, height as u32);
    image::save_buffer(format!("{output}.png"), &bytes, w, h, image::ExtendedColorType::Rgb8)?;
    Ok(())
}
