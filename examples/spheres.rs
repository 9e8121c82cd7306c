//! Metal spheres under a simple sky, rendered with the sampler crate and its embedded tables alone.
//!
//! `cargo run --release --example spheres -- OUTPUT [WIDTH] [SAMPLES]` writes OUTPUT.exr (linear
//! radiance) and OUTPUT.png.
//!
//! Rows: the gold of Ribardière et al. 2017 (doi:10.1111/cgf.13137), σ = 0.3 and γ = 1.51, 1.65, 2,
//! 4, 10 and 50, single scattering; the same with multiple-scattering compensation; brushed
//! aluminium of σ = (0.3, 0.7), and the same tilted by half a radian about the brushing as
//! generalised ellipsoids, both for γ = 1.65, 2 and 10.

use std::error::Error;

use glam::{Mat3, Vec3, Vec4};
use microfacet_common::schlick::schlick_weight;
use microfacet_sampler::{Lobe, Masking, MaterialError, MicrofacetDistribution, Skew, Tables};
use rayon::prelude::*;

/// Reflectance at normal incidence in linear sRGB.
const GOLD: Vec3 = Vec3::new(1.0, 0.766, 0.336);
const ALUMINIUM: Vec3 = Vec3::new(0.913, 0.921, 0.925);

const COLUMNS: usize = 6;
const ROWS: usize = 3;

/// Directional albedo over (cos θ, φ) for total reflection: that of a skewed lobe depends on both.
struct Albedo(Vec<f32>);

impl Albedo {
    const ELEVATIONS: usize = 24;
    const AZIMUTHS: usize = 16;

    fn new(lobe: &Lobe) -> Self {
        let node = |i: usize| {
            let z = (i / Self::AZIMUTHS) as f32 / (Self::ELEVATIONS - 1) as f32;
            let phi = (i % Self::AZIMUTHS) as f32 / Self::AZIMUTHS as f32 * std::f32::consts::TAU;
            // G1 is zero at grazing itself.
            let z = z.max(1e-3);
            let r = (1.0 - z * z).sqrt();
            let v = Vec3::new(r * phi.cos(), r * phi.sin(), z);
            let samples = 4096;
            let sum: f32 = (0..samples)
                .map(|i| {
                    let [a, b, ..] = sequence(i, 0);
                    let l = reflect(v, lobe.sample_visible_normal(v, [a, b]));
                    lobe.reflection_weight(v, l, Masking::HeightCorrelated)
                })
                .sum();
            sum / samples as f32
        };
        Self((0..Self::ELEVATIONS * Self::AZIMUTHS).into_par_iter().map(node).collect())
    }

    fn at(&self, v: Vec3) -> f32 {
        let y = v.z.clamp(0.0, 1.0) * (Self::ELEVATIONS - 1) as f32;
        let x = (v.y.atan2(v.x) / std::f32::consts::TAU).rem_euclid(1.0) * Self::AZIMUTHS as f32;
        let (i, j) = ((y as usize).min(Self::ELEVATIONS - 2), x as usize);
        let (a, b) = (y - i as f32, x - j as f32);
        let node = |i: usize, j: usize| self.0[i * Self::AZIMUTHS + j % Self::AZIMUTHS];
        let row = |i: usize| node(i, j) + b * (node(i, j + 1) - node(i, j));
        row(i) + a * (row(i + 1) - row(i))
    }
}

struct Material {
    lobe: Lobe,
    f0: Vec3,
    /// Compensation for the energy lost to masking: f·(1 + F0 (1/E − 1)) (Turquin 2019,
    /// <https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf>).
    compensation: Option<Albedo>,
}

fn materials(tables: &Tables) -> Result<Vec<Material>, MaterialError> {
    let mut all = Vec::new();
    for compensate in [false, true] {
        for gamma in [1.51, 1.65, 2.0, 4.0, 10.0, 50.0] {
            let lobe = tables.lobe(0.3, gamma)?;
            let compensation = compensate.then(|| Albedo::new(&lobe));
            all.push(Material { lobe, f0: GOLD, compensation });
        }
    }
    let brushed = [0.3, 0.7];
    for tilted in [false, true] {
        for gamma in [1.65, 2.0, 10.0] {
            let lobe = if tilted {
                tables.ellipsoid(Skew::new(brushed, [0.5, 0.0, 0.0])?, gamma)?.into()
            } else {
                tables.lobe(brushed, gamma)?
            };
            let compensation = Some(Albedo::new(&lobe));
            all.push(Material { lobe, f0: ALUMINIUM, compensation });
        }
    }
    Ok(all)
}

fn reflect(v: Vec3, m: Vec3) -> Vec3 {
    2.0 * v.dot(m) * m - v
}

/// The i-th point of the four-dimensional additive recurrence, shifted by a hash of `seed`.
fn sequence(i: usize, seed: u32) -> [f32; 4] {
    // Powers of 1/x for x⁵ = x + 1.
    const STEPS: [f64; 4] =
        [0.856674883854503, 0.733891856627126, 0.628706721215577, 0.538597257213057];
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
fn shade(material: &Material, x: f32, y: f32, u: [f32; 2]) -> Vec3 {
    let n = Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
    // Brushed round the vertical axis.
    let tangent = Vec3::Y.cross(n).normalize_or(Vec3::X);
    let frame = Mat3::from_cols(tangent, n.cross(tangent), n);
    let v = frame.transpose() * Vec3::Z;
    let m = material.lobe.sample_visible_normal(v, u);
    let l = reflect(v, m);
    if l.z <= 0.0 || v.z <= 0.0 {
        return Vec3::ZERO;
    }
    let fresnel = material.f0 + (1.0 - material.f0) * schlick_weight(v.dot(m).clamp(0.0, 1.0));
    let gain = material.compensation.as_ref().map_or(Vec3::ONE, |albedo| {
        Vec3::ONE + material.f0 * (1.0 / albedo.at(v).clamp(0.05, 1.0) - 1.0)
    });
    let weight = material.lobe.reflection_weight(v, l, Masking::HeightCorrelated);
    fresnel * gain * weight * sky(frame * l)
}

/// A pixel: premultiplied radiance and coverage.
fn pixel(materials: &[Material], x: usize, y: usize, cell: f32, samples: usize) -> Vec4 {
    let seed = (y as u32).wrapping_mul(0x9e37_79b1) ^ (x as u32).wrapping_mul(0x85eb_ca77);
    let mut sum = Vec4::ZERO;
    for i in 0..samples {
        let [a, b, u1, u2] = sequence(i, seed);
        let (px, py) = ((x as f32 + a) / cell, (y as f32 + b) / cell);
        let (column, row) = (px as usize, py as usize);
        // Leaves a margin of a twelfth of the cell.
        let at = |p: f32| (2.0 * p.fract() - 1.0) * 1.2;
        let (sx, sy) = (at(px), -at(py));
        if sx * sx + sy * sy < 1.0 && column < COLUMNS && row < ROWS {
            sum += shade(&materials[row * COLUMNS + column], sx, sy, [u1, u2]).extend(1.0);
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
    let materials = materials(&Tables::embedded())?;
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
