//! Runs exported WGSL on a device of Vulkan: compares every function with the Rust crate, runs the
//! sample that comes with the export, reads textures by the device's filter, and renders a sphere
//! that must be that of the Rust BSDF.
//!
//! `clients/gpu/run` exports the shapes and starts this program. Exit status 1 if something differs
//! by more than is allowed.

mod device;
mod export;
mod family;
mod lut;
mod realtime;
mod sample;
mod sphere;

use std::path::Path;
use std::process::ExitCode;

use device::{Gpu, Program};
use export::Export;
use student_t_agreement::{Answer, Foreign, Limits, Point, Rough, agree};

/// The limits that the documentation of exports states.
const LIMITS: Limits = Limits {
    share: 1e-5,
    normal: 1e-4,
    rough: Rough::Stretched,
    heavy: 2e-4,
    average: 3e-5,
    density: [1e-4, 1e-4],
    extrapolated: [2e-5, 2e-4],
    of_nan: false,
    lambda: 8.6e37,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [points, folder, reference, picture] = &arguments[..] else {
        eprintln!("usage: student-t-on-gpu POINTS FOLDER REFERENCE.csv PICTURE.png");
        return ExitCode::from(2);
    };
    let points = points.parse().expect("a number of points");
    let gpu = match Gpu::new(std::env::var_os("STUDENT_T_HARDWARE").is_some()) {
        Ok(gpu) => gpu,
        Err(why) => {
            eprintln!("error: {why}");
            return ExitCode::FAILURE;
        }
    };
    println!("on {}", gpu.name);
    let folder = Path::new(folder);
    let read = |language: &str, name| Export::read(&folder.join(language), name);
    let [buffers, textures] = ["wgsl", "wgsl-textures"].map(|language| read(language, "student_t"));
    let families = ["wgsl-family", "wgsl-family-textures"].map(|of| read(of, "student_t_family"));
    let gammas = buffers.gammas();
    let mut lookups = Lookups::new(&gpu, &buffers, &textures);
    let mut good = agree(&mut lookups, &LIMITS, &gammas, points, reference);
    good &= family::agrees(&gpu, &families, points / 4);
    let argument = read("wgsl-argument", "student_t");
    good &= sample::runs(&gpu, &buffers, gpu.buffer(&buffers.tables));
    good &= sample::runs(&gpu, &argument, gpu.texture(&argument.tables));
    good &= lut::lines_are_valid();
    good &= lut::agree(&gpu, &folder.join("lut"));
    good &= realtime::agrees(&gpu, &folder.join("wgsl-realtime"), points / 4);
    good &= sphere::agrees(&gpu, &buffers, Path::new(picture));
    println!("{}", if good { "Shaders agree with the crate." } else { "They differ." });
    ExitCode::from(u8::from(!good))
}

/// The functions of an export, by buffer and by texture.
struct Lookups<'a> {
    gpu: &'a Gpu,
    programs: [(&'static str, Program, Vec<u32>); 2],
}

impl<'a> Lookups<'a> {
    fn new(gpu: &'a Gpu, buffers: &Export, textures: &Export) -> Self {
        let program = |name, export: &Export, tables| {
            let wgsl = format!("{}{}", export.module, include_str!("lookups.wgsl"));
            let shapes = export.gammas().into_iter().map(|gamma| export.offset(gamma)).collect();
            (name, gpu.program(&wgsl, "main", tables), shapes)
        };
        let buffer = program("by buffer", buffers, gpu.buffer(&buffers.tables));
        let texture = program("by texture", textures, gpu.texture(&textures.tables));
        Self { gpu, programs: [buffer, texture] }
    }
}

impl Foreign for Lookups<'_> {
    fn answers(&mut self, shape: usize, points: &[Point]) -> Vec<(&'static str, Vec<Answer>)> {
        let size = size_of::<Answer>() * points.len();
        let groups = points.len().div_ceil(64) as u32;
        let answer = |(name, program, shapes): &(&'static str, Program, Vec<u32>)| {
            let uniform = [shapes[shape], 0, 0, 0];
            let input = bytemuck::cast_slice(points);
            let uniform = Some(bytemuck::cast_slice(&uniform));
            let bytes = self.gpu.run(program, input, uniform, size, groups);
            (*name, bytemuck::pod_collect_to_vec(&bytes))
        };
        self.programs.iter().map(answer).collect()
    }
}
