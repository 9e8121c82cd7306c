//! Figures 7, 8 and 9 of Ribardière et al. 2017 (doi:10.1111/cgf.13137), by a small path tracer
//! that takes its materials from the sampler crate.
//!
//! `cargo run --release -p microfacet-study -- spheres OUTPUT` writes figure 8 as OUTPUT.exr
//! (linear radiance) and OUTPUT.png; `--help` has the options. `figures.rs` makes the materials,
//! `path.rs` shows how a renderer calls them, `scene.rs` is what surrounds them, `sky.rs` lights
//! them, and `page.rs` arranges the pictures.

mod figures;
mod page;
mod path;
mod random;
pub(crate) mod scene;
pub mod sky;
#[cfg(test)]
mod tests;

use std::iter;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use clap::{Args, Parser};
use glam::Vec3;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use figures::{Figure, Spheres};
use path::Tracer;
use random::Random;
use scene::{Material, Ray, Scene};

use microfacet_baker::progress::Meter;

use crate::Outcome;

/// The camera looks down by this many radians, from far away.
const ELEVATION: f32 = 0.45;
/// Half the edge of its picture; the sphere has radius 1.
const REACH: f32 = 1.2;

/// Renders a figure of Ribardière et al. 2017
#[derive(Parser)]
struct Arguments {
    /// The files to write, without .exr and .png
    output: PathBuf,
    /// The figure
    #[arg(long, value_enum, default_value = "8")]
    figure: Figure,
    /// Pixels across the page, or a few less; below the range its words would overlap
    #[arg(long, default_value = "1800", value_parser = clap::value_parser!(u32).range(1400..=16384))]
    width: u32,
    #[command(flatten)]
    limit: Limit,
}

/// When a pixel is done.
#[derive(Args, Clone, Copy)]
pub(crate) struct Limit {
    /// Most paths in a pixel: a limit of the time
    #[arg(long, default_value = "4096",
          value_parser = clap::value_parser!(u32).range(1..=i64::from(Random::MOST)))]
    pub(crate) samples: u32,
    /// Standard error at which a pixel is done, in steps of 1/255; 0 takes all samples
    #[arg(long, default_value = "3", value_parser = steps)]
    pub(crate) noise: f32,
}

fn steps(text: &str) -> Result<f32, String> {
    let range = "must be a number from 0 to 255";
    text.parse().ok().filter(|x| (0.0..=255.0).contains(x)).ok_or_else(|| range.into())
}

/// Paths between two estimates of the error.
const BATCH: u32 = 64;

/// Size and sampling of a sphere's square.
#[derive(Clone, Copy)]
pub(crate) struct Film {
    pub(crate) cell: usize,
    pub(crate) limit: Limit,
    /// As of [`Spheres`].
    pub(crate) is_linear: bool,
}

fn pixel<M: Material>(scene: &Scene<M>, [x, y]: [usize; 2], film: Film) -> Vec3 {
    let Film { cell, limit, is_linear } = film;
    let (sin, cos) = ELEVATION.sin_cos();
    let (up, direction) = (Vec3::new(0.0, cos, -sin), Vec3::new(0.0, -sin, -cos));
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    for index in 0..limit.samples {
        let mut random = Random::new((y * cell + x) as u32, index);
        let at = |pixel: usize, u: f32| REACH * (2.0 * (pixel as f32 + u) / cell as f32 - 1.0);
        let [a, b] = random.two();
        let origin = at(x, a) * Vec3::X - at(y, b) * up - 4.0 * direction;
        let mut tracer = Tracer { scene, random: &mut random };
        let radiance = tracer.radiance(&Ray { origin, direction });
        sum += radiance;
        squares += radiance * radiance;
        let count = (index + 1) as f32;
        if (index + 1) % BATCH == 0 {
            let mean = sum / count;
            let error = ((squares / count - mean * mean).max(Vec3::ZERO) / count).sqrt();
            if page::steps(mean, error, is_linear) < limit.noise {
                return mean;
            }
        }
    }
    sum / limit.samples as f32
}

/// All pixels, line by line of each square, on all cores.
pub(crate) fn render<M: Material>(
    scenes: &[Scene<M>],
    film: Film,
    meter: &Meter,
) -> Vec<Vec<Vec3>> {
    let cell = film.cell;
    meter.expect(1.0);
    let stage = meter.stage(1.0);
    stage.split(scenes.len() * cell);
    let line = |i: usize| {
        let line = (0..cell).map(|x| pixel(&scenes[i / cell], [x, i % cell], film));
        let line = line.collect();
        stage.step();
        line
    };
    (0..scenes.len() * cell).into_par_iter().map(line).collect()
}

/// Does some work, with a progress bar on a terminal.
fn watched<T>(what: &'static str, work: impl FnOnce(&Meter) -> T) -> T {
    const STEPS: u64 = 1000;
    let meter = Meter::default();
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {elapsed}")
        .expect("a constant template");
    let bar = ProgressBar::new(STEPS).with_style(style).with_message(what);
    thread::scope(|scope| {
        let (ended, end) = channel::<()>();
        scope.spawn(|| {
            let end = end;
            while end.recv_timeout(Duration::from_millis(100)) == Err(RecvTimeoutError::Timeout) {
                bar.set_position((STEPS as f64 * meter.share()) as u64);
            }
            bar.finish_and_clear();
        });
        let done = work(&meter);
        drop(ended);
        done
    })
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let Arguments { output, figure, width, limit } =
        Arguments::parse_from(iter::once("spheres").chain(arguments.iter().map(String::as_str)));
    let file = |extension: &str| {
        let mut name = output.clone().into_os_string();
        name.push(extension);
        PathBuf::from(name)
    };
    // A folder that cannot be written to is found before minutes of work.
    let folder = match output.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    tempfile::tempfile_in(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let mut spheres: Spheres = watched("Baking albedos", |meter| figure.spheres(meter))?;
    // A PNG has two pixels along each pixel of the page.
    let cell = (2.0 * spheres.sheet.edge_within(0.5 * f64::from(width))) as usize;
    spheres.sheet.edge = 0.5 * cell as f64;
    let film = Film { cell, limit, is_linear: spheres.is_linear };
    let lines = watched("Rendering", |meter| render(&spheres.scenes, film, meter));
    page::write_exr(&file(".exr"), &spheres, &lines)?;
    page::write_png(&file(".png"), spheres, &lines)
}
