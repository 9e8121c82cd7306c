//! A sphere of metal under one round light, by the exported WGSL and by the crate's BSDF: the same
//! random numbers, the same steps.

use std::f32::consts::TAU;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec2, Vec3};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{
    Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Masking, StudentT, Tables,
    Transport,
};

use crate::device::Gpu;
use crate::export::Export;

/// As in `sphere.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Scene {
    light: [f32; 3],
    rim: f32,
    metal: [f32; 3],
    radiance: f32,
    sigma: f32,
    shape: u32,
    size: u32,
    samples: u32,
}

const GAMMA: f64 = 3.0;
const ALLOWED: u8 = 2;

/// Renders both pictures, writes that of the shader, and returns whether they agree.
pub fn agrees(gpu: &Gpu, export: &Export, path: &Path) -> bool {
    let scene = Scene {
        light: Vec3::new(0.5, 0.6, 0.62).normalize().into(),
        rim: 0.9,
        metal: [0.95, 0.64, 0.54],
        radiance: 8.0,
        sigma: 0.3,
        shape: export.offset(GAMMA),
        size: 192,
        samples: 32,
    };
    let wgsl = format!("{}{}", export.module, include_str!("sphere.wgsl"));
    let program = gpu.program(&wgsl, "main", gpu.buffer(&export.tables));
    let pixels = scene.size * scene.size;
    let input = bytemuck::bytes_of(&scene);
    let bytes = gpu.run(&program, input, None, 16 * pixels as usize, pixels.div_ceil(64));
    let shader: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
    let shader: Vec<u8> = shader.iter().flat_map(|[r, g, b, _]| [*r, *g, *b].map(byte)).collect();
    let crate_s: Vec<u8> = by_crate(&scene).iter().flat_map(|c| c.to_array().map(byte)).collect();
    let worst = shader.iter().zip(&crate_s).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(255);
    let differ = shader.iter().zip(&crate_s).filter(|(a, b)| a != b).count();

    save(path, scene.size, &shader).expect("the picture is written");
    let mean = shader.iter().map(|&x| f64::from(x)).sum::<f64>() / shader.len() as f64;
    println!(
        "the sphere: at most {worst}/255 from that of the crate's BSDF, of {ALLOWED}/255 allowed; \
         {differ} of {} numbers differ; mean {mean:.1}/255",
        shader.len()
    );
    // A black picture would agree with any other.
    worst <= ALLOWED && (20.0..235.0).contains(&mean)
}

/// Writes a square picture whose pixels are in sRGB.
fn save(path: &Path, size: u32, pixels: &[u8]) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), size, size);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()
}

/// A number as a byte of sRGB.
fn byte(x: f32) -> u8 {
    let encoded = if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded.clamp(0.0, 1.0)).round() as u8
}

/// A random number in [0, 1) (PCG by O'Neill 2014).
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((*state >> ((*state >> 28) + 4)) ^ *state).wrapping_mul(277_803_737);
    (((word >> 22) ^ word) >> 8) as f32 / 16_777_216.0
}

/// A tangent frame, as columns; glam and the shader both have that of Duff et al. 2017.
fn frame(n: Vec3) -> Mat3 {
    let (x, y) = n.any_orthonormal_pair();
    Mat3::from_cols(x, y, n)
}

fn by_crate(scene: &Scene) -> Vec<Vec3> {
    let tables = Tables::embedded();
    let lobe = tables.student_t(f64::from(scene.sigma), GAMMA).expect("a lobe");
    let fresnel = ConductorFresnel::schlick(scene.metal).expect("reflectances");
    let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
    let metal = Conductor::new(lobe.clone(), fresnel, settings).expect("albedos of a round lobe");
    let size = scene.size as f32;
    let pixel = |i: u32| {
        let mut state = i;
        let (x, y) = ((i % scene.size) as f32, (i / scene.size) as f32);
        let mut sum = Vec3::ZERO;
        for _ in 0..scene.samples {
            let x = (x + random(&mut state)) / size - 0.5;
            let p = 2.2 * Vec2::new(x, 0.5 - (y + random(&mut state)) / size);
            let square = p.dot(p);
            if square < 1.0 {
                sum += reflected(scene, &lobe, &metal, p.extend((1.0 - square).sqrt()), &mut state);
            }
        }
        sum / scene.samples as f32
    };
    (0..scene.size * scene.size).map(pixel).collect()
}

/// Light drawn by the light, and by the metal, each weighted by the balance heuristic.
fn reflected(
    scene: &Scene,
    lobe: &StudentT,
    metal: &Conductor<StudentT>,
    n: Vec3,
    state: &mut u32,
) -> Vec3 {
    let local = frame(n).transpose();
    let v = local * Vec3::Z;
    if v.z <= 0.0 {
        return Vec3::ZERO;
    }
    let axis = local * Vec3::from(scene.light);
    let cap = TAU * (1.0 - scene.rim);
    let z = 1.0 - random(state) * (1.0 - scene.rim);
    let (sin, cos) = (TAU * random(state)).sin_cos();
    let r = ((1.0 - z) * (1.0 + z)).sqrt();
    let by_light = frame(axis) * Vec3::new(r * cos, r * sin, z);
    let u = [random(state), random(state)];
    let by_metal = lobe.sample_reflected(v, u, Masking::HeightCorrelated);
    let mut sum = Vec3::ZERO;
    for l in [Some(by_light), by_metal.map(|(l, _)| l.into())].into_iter().flatten() {
        let brightness = ((l.dot(axis) - scene.rim) / (1.0 - scene.rim)).max(0.0);
        if l.z > 0.0 && brightness > 0.0 {
            let (_, pdf) = lobe.eval_pdf(v, l, Masking::HeightCorrelated);
            let f = Vec3::from(metal.eval(v, l, Transport::Radiance));
            sum += scene.radiance * brightness / (pdf + 1.0 / cap) * f * l.z;
        }
    }
    sum
}
