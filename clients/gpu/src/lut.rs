//! Albedos as textures, read by the device's filter with the line of WGSL in their description.

use std::fs;
use std::path::Path;

use microfacet_export::texture::{Channels, Shapes, TextureSpec, shader_lines};
use microfacet_sampler::{Masking, Tables};
use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use serde_json::Value;
use wgpu::TextureFormat;

use crate::device::{Filtered, Gpu};

/// Largest errors of the crate's own albedos: for σ ≥ 0.01 and cos θ ≥ 0.02, and elsewhere.
const CRATE: [f64; 2] = [2e-4, 1.3e-3];
/// Points of each texture.
const POINTS: usize = 100_000;

/// Compares the textures of a folder with the crate; returns whether all agree.
pub fn agree(gpu: &Gpu, folder: &Path) -> bool {
    // Not short-circuiting: all are printed.
    let compare = |name: &str| agrees(gpu, &folder.join(name), name);
    [compare("one"), compare("half"), compare("volume")].into_iter().all(|good| good)
}

fn agrees(gpu: &Gpu, folder: &Path, name: &str) -> bool {
    let text = fs::read_to_string(folder.join("lut.json")).expect("a description");
    let told: Value = serde_json::from_str(&text).expect("a description");
    let half = told["precision"] == "f16";
    if !half && !gpu.filters_singles() {
        println!("texture \"{name}\": the device does not filter 32-bit floats");
        return true;
    }
    let bytes = fs::read(folder.join("lut.ktx2")).expect("a texture");
    let file = ktx2::Reader::new(&bytes[..]).expect("KTX 2");
    let header = file.header();
    let size = [header.pixel_width, header.pixel_height, header.pixel_depth];
    let texels = file.levels().next().expect("a level").data;

    let kind = if size[2] == 0 { "2d" } else { "3d" };
    let line = told["read"]["wgsl"].as_str().expect("a line");
    let wgsl = format!(
        "@group(0) @binding(0) var lut_texture: texture_{kind}<f32>;
        @group(0) @binding(1) var<storage, read> places: array<vec4f>;
        @group(0) @binding(2) var<storage, read_write> found: array<f32>;
        @group(0) @binding(4) var linear_clamp: sampler;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) at: vec3u) {{
            if at.x >= arrayLength(&places) {{ return; }}
            let gamma = places[at.x].x;
            let sigma = places[at.x].y;
            let mu = places[at.x].z;
            {line}
            found[at.x] = e;
        }}"
    );
    let axes = told["axes_slowest_first"].as_array().expect("axes");
    let constant = |key: &str| axes.iter().find_map(|axis| axis[key].as_f64());
    let gamma = told["gamma"].as_str().map(|gamma| gamma.parse::<f32>().expect("a number"));
    let (least, sigma_max) = (constant("gamma_min"), constant("sigma_max").expect("a roughness"));
    let places: Vec<[f32; 4]> = (0..POINTS)
        .map(|i| {
            let [a, b, c] = [0.819_172_5, 0.671_043_6, 0.549_700_5]
                .map(|step: f64| (0.5 + i as f64 * step).fract());
            // Every ninth at the normal, every seventh at the horizon, every fifth at the end of σ.
            let mu = if i % 9 == 0 {
                1.0
            } else if i % 7 == 0 {
                1e-4
            } else {
                1e-4_f64.powf(a)
            };
            let sigma = if i % 5 == 0 { sigma_max } else { (sigma_max * b * b).max(1e-7) };
            let shape = least.map_or(f32::NAN, |least| (1.5 + (least - 1.5) / (1.0 - c)) as f32);
            [gamma.unwrap_or(shape), sigma as f32, mu as f32, 0.0]
        })
        .collect();
    let format = if half { TextureFormat::R16Float } else { TextureFormat::R32Float };
    let texture = Filtered { size, format, texels: texels.to_vec() };
    let program = gpu.program(&wgsl, "main", gpu.filtered(&[texture]));
    let groups = POINTS.div_ceil(64) as u32;
    let bytes = gpu.run(&program, bytemuck::cast_slice(&places), None, 4 * POINTS, groups);
    let found: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);

    let masking: Masking = told["masking"].as_str().expect("a form").parse().expect("a form");
    let tables = Tables::embedded();
    let stated = told["errors"]["e"]["largest_if_filter_has_256_steps"].as_f64();
    let allowed = stated.expect("an error");
    let mut worst = 0.0_f64;
    for (&[gamma, sigma, mu, _], &e) in places.iter().zip(&found) {
        let [gamma, sigma] = [gamma, sigma].map(f64::from);
        let albedo = tables.albedo(sigma, gamma, masking).expect("an albedo");
        let exact = f64::from(albedo.albedo([(1.0 - mu * mu).sqrt(), 0.0, mu]));
        let common = sigma >= 0.01 && mu >= 0.02;
        let share = (f64::from(e) - exact).abs() / (allowed + CRATE[usize::from(!common)]);
        worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
    }
    println!(
        "texture \"{name}\", {size:?}: {POINTS} values by the device's filter within {worst:.2} of \
         what the texture ({allowed:.1e}) and the crate may err by"
    );
    worst <= 1.0
}

/// Whether the lines of all kinds of textures, by names of all kinds, are WGSL.
pub fn lines_are_valid() -> bool {
    let mut valid = Vec::new();
    for shapes in [Shapes::One(2.0), Shapes::One(f64::INFINITY), Shapes::DownTo(1.6)] {
        for channels in [Channels::E, Channels::OneMinusE, Channels::ScaleBias] {
            let size = if matches!(shapes, Shapes::One(_)) { &[32, 24][..] } else { &[8, 32, 24] };
            // Words of the language, and of the line itself, are names like others.
            for name in ["lut", "var", "sigma", "pow", "vec2f"] {
                let masking = Masking::HeightCorrelated;
                let specs = TextureSpec::of_shapes(name, shapes, 3.0, size, masking, channels);
                valid.extend(specs.iter().map(is_valid));
            }
        }
    }
    let good = valid.iter().filter(|valid| **valid).count();
    println!("{good} of {} lines of WGSL that read textures are valid", valid.len());
    good == valid.len()
}

/// Whether the line that reads a texture is WGSL; prints why not.
fn is_valid(spec: &TextureSpec) -> bool {
    let kind = if spec.axes.len() == 3 { "3d" } else { "2d" };
    let (name, line) = (&spec.name, shader_lines(spec).wgsl);
    let source = format!(
        "@group(0) @binding(0) var {name}_texture: texture_{kind}<f32>;
        @group(0) @binding(1) var linear_clamp: sampler;
        fn read(gamma: f32, sigma: f32, mu: f32) -> f32 {{
            {line}
            return 0.0;
        }}"
    );
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let module = wgsl::parse_str(&source).map_err(|why| why.emit_to_string(&source));
    let checked = module
        .and_then(|module| validator.validate(&module).map_err(|why| why.emit_to_string(&source)));
    checked.inspect_err(|why| println!("{why}")).is_ok()
}
