//! Time to picture: a sphere of rough gold whose σ and γ are textures beside one of GGX whose σ is.
//!
//! `cargo run --profile dist -p microfacet-study -- frame_time` renders both, and the first with
//! normals bounded to reflections too, by the path tracer of [`spheres`](crate::spheres), in turn so
//! that all meet the same load. It prints the least time of each, its ratio to that of GGX, and the
//! same at equal noise. `docs/benchmark.md` shows it; `RAYON_NUM_THREADS=1` takes one core.

use std::iter;
use std::time::Instant;

use clap::Parser;
use glam::Vec3;
use microfacet_baker::progress::Meter;
use microfacet_sampler::lobe::{BoundedFamilyLobe, FamilyLobe};
use microfacet_sampler::{Conductor, ConductorFresnel, Family, Ggx, Masking, Metal, Tables};

use crate::Outcome;
use crate::spheres::scene::{Floor, GREY, HitBsdf, Material, Scene};
use crate::spheres::sky::Sky;
use crate::spheres::{Film, Limit, render};

/// Times pictures of textured gold
#[derive(Parser)]
struct Arguments {
    /// Pixels along each side of a picture
    #[arg(long, default_value = "200", value_parser = clap::value_parser!(u16).range(8..=4096))]
    edge: u16,
    /// Paths in a pixel
    #[arg(long, default_value = "16", value_parser = clap::value_parser!(u16).range(1..=1024))]
    samples: u16,
    /// How often each picture is rendered; its least time counts
    #[arg(long, default_value = "7", value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
}

/// The name of the picture that others are compared with, in what is printed.
pub const GGX: &str = "GGX, σ textured";
/// The name of the picture of the family by all visible normals.
pub const TEXTURED: &str = "σ and γ textured, visible normals";

/// Samples of a picture without noise, for each of one with it.
const REFERENCE: u32 = 32;

/// A smooth texture, projected along the sphere's z axis.
struct Texture(Vec<f32>);

impl Texture {
    const EDGE: usize = 256;

    fn new(range: [f32; 2], waves: [f32; 2]) -> Self {
        let texel = |i: usize| {
            let [x, y] = [i % Self::EDGE, i / Self::EDGE].map(|x| x as f32 / Self::EDGE as f32);
            let t = 0.5 + 0.5 * (waves[0] * x).sin() * (waves[1] * y).sin();
            range[0] + t * (range[1] - range[0])
        };
        Self((0..Self::EDGE * Self::EDGE).map(texel).collect())
    }

    fn at(&self, point: Vec3) -> f32 {
        let place = |x: f32| ((0.5 + 0.5 * x) * (Self::EDGE - 1) as f32) as usize;
        self.0[place(point.x) + place(point.y) * Self::EDGE]
    }
}

const MASKING: Masking = Masking::HeightCorrelated;

struct Textures {
    family: Family,
    gold: ConductorFresnel,
    sigma: Texture,
    gamma: Texture,
}

impl Textures {
    fn lobe(&self, point: Vec3) -> FamilyLobe<'_> {
        self.family.at(self.sigma.at(point), self.gamma.at(point))
    }
}

macro_rules! materials {
    ($($(#[$doc:meta])* $name:ident: $lobe:ty = |$textures:ident, $point:ident| $at:expr;)*) => {$(
        $(#[$doc])*
        struct $name<'t>(&'t Textures);

        impl Material for $name<'_> {
            type Made<'a> = Conductor<$lobe, 3, microfacet_sampler::albedo::AlbedoAt<'a>>
            where
                Self: 'a;

            fn at(&self, $point: Vec3) -> HitBsdf<'_, Self::Made<'_>> {
                let $textures = self.0;
                HitBsdf::Made(Conductor::at_hit($at, $textures.gold, MASKING))
            }
        }
    )*};
}

materials! {
    /// GGX of textured σ.
    OfGgx: Ggx = |textures, point| Ggx::new(textures.sigma.at(point)).expect("a roughness");
    /// Textured σ and γ, by all visible normals.
    Visible: FamilyLobe<'a> = |textures, point| textures.lobe(point);
    /// Textured σ and γ, bounded to reflections.
    Bounded: BoundedFamilyLobe<'a> = |textures, point| textures.lobe(point).bounded();
}

/// A picture, and what is known of it.
struct Picture<'a> {
    name: &'static str,
    render: Box<dyn Fn(u32) -> Vec<Vec<Vec3>> + 'a>,
    seconds: f64,
}

fn picture<'a>(
    name: &'static str,
    material: impl Material + 'a,
    cell: usize,
) -> Result<Picture<'a>, Box<dyn std::error::Error>> {
    let scene = [Scene { material, floor: Some(Floor::new(GREY)?), sky: Sky::studio() }];
    let film = move |samples| Film { cell, limit: Limit { samples, noise: 0.0 }, is_linear: false };
    let render = move |samples| render(&scene, film(samples), &Meter::default());
    Ok(Picture { name, render: Box::new(render), seconds: f64::INFINITY })
}

/// The mean square by which one picture differs from another.
fn square_error(a: &[Vec<Vec3>], b: &[Vec<Vec3>]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let (sum, count) = pairs
        .fold((0.0, 0.0), |(s, n), (a, b)| (s + f64::from((*a - *b).length_squared()), n + 1.0));
    sum / count
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let Arguments { edge, samples, rounds } =
        Arguments::parse_from(iter::once("frame_time").chain(arguments.iter().map(String::as_str)));
    let (cell, samples) = (usize::from(edge), u32::from(samples));
    let textures = Textures {
        family: Tables::embedded().family()?,
        gold: Metal::Gold.into(),
        sigma: Texture::new([0.1, 0.5], [23.0, 17.0]),
        gamma: Texture::new([1.6, 6.0], [11.0, 29.0]),
    };
    let mut pictures = [
        picture(GGX, OfGgx(&textures), cell)?,
        picture(TEXTURED, Visible(&textures), cell)?,
        picture("σ and γ textured, bounded", Bounded(&textures), cell)?,
    ];
    for _ in 0..rounds {
        for picture in &mut pictures {
            let start = Instant::now();
            std::hint::black_box((picture.render)(samples));
            picture.seconds = picture.seconds.min(start.elapsed().as_secs_f64());
        }
    }
    println!(
        "{edge} × {edge} pixels, {samples} paths each, the least of {rounds} rounds, {} threads\n",
        rayon::current_num_threads()
    );
    crate::print_head(&["gold", "seconds", "ratio", "square error", "time × square error, ratio"]);
    let mut first = None;
    for Picture { name, render, seconds } in &pictures {
        let error = square_error(&render(samples), &render(REFERENCE * samples));
        let [time, at_equal_noise] = *first.get_or_insert([*seconds, seconds * error]);
        println!(
            "| {name} | {seconds:.3} | {:.3} | {error:.2e} | {:.3} |",
            seconds / time,
            seconds * error / at_equal_noise
        );
    }
    Ok(())
}
