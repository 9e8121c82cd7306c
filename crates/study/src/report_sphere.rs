//! The sphere of a page and its lobe in the plane of incidence by the sampler's BSDFs, as a
//! reference for those of a browser.
//!
//! `cargo run --release -p microfacet-study -- report_sphere --gamma 3 --sigma 0.2 --out
//! sphere.png` writes one, and `--lobe 45` prints the lobe for a view at 45 degrees; `--help` has
//! the options.

use std::fs::File;
use std::io::BufWriter;
use std::iter;
use std::path::PathBuf;

use clap::Parser;
use microfacet_baker::store;
use microfacet_report::{Film, Look, picture};
use microfacet_sampler::{ConductorFresnel, Metal, Tables};

use crate::Outcome;

/// Lights of the lobe, as the page has them.
const LIGHTS: usize = 721;

/// Renders the sphere of a report's page
#[derive(Parser)]
struct Arguments {
    /// Shape γ, or inf
    #[arg(long, default_value = "3")]
    gamma: f64,
    /// The shape that normals are drawn from, as `report.state().drawn` of the page has it; the
    /// same as γ if absent
    #[arg(long)]
    drawn: Option<f64>,
    /// σ, or σx,σy
    #[arg(long, value_delimiter = ',', num_args = 1..=2, default_value = "0.2")]
    sigma: Vec<f64>,
    /// A metal by name, or mirror
    #[arg(long, default_value = "gold")]
    metal: String,
    /// Whether further bounces are given back
    #[arg(long)]
    compensation: bool,
    /// Pixels along its edges
    #[arg(long, default_value = "160", value_parser = clap::value_parser!(u32).range(1..=4096))]
    size: u32,
    /// Samples of a pixel
    #[arg(long, default_value = "64", value_parser = clap::value_parser!(u32).range(1..=65536))]
    samples: u32,
    /// The set; the embedded default if absent
    #[arg(long)]
    tables: Option<PathBuf>,
    /// Prints f cos of the lobe, of GGX and of Beckmann for a view at so many degrees, a light a
    /// line, as `report.lobe` of the page has them
    #[arg(long)]
    lobe: Option<f64>,
    /// The PNG to write
    #[arg(long, required_unless_present = "lobe")]
    out: Option<PathBuf>,
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let Arguments { gamma, drawn, sigma, metal, compensation, size, samples, tables, lobe, out } =
        Arguments::parse_from(
            iter::once("report_sphere").chain(arguments.iter().map(String::as_str)),
        );
    let set = match tables {
        Some(path) => store::read(&path)?,
        None => Tables::embedded(),
    };
    let fresnel = match metal.as_str() {
        "mirror" => ConductorFresnel::mirror(),
        name => name.parse::<Metal>()?.into(),
    };
    let sigma = [sigma[0], *sigma.last().unwrap_or(&sigma[0])];
    let look =
        Look { gamma, drawn: drawn.unwrap_or(gamma), sigma, fresnel, compensated: compensation };
    if let Some(degrees) = lobe {
        let [shape, ggx, beckmann] = look.in_plane(&set, degrees, LIGHTS)?;
        for ((shape, ggx), beckmann) in shape.iter().zip(ggx).zip(beckmann) {
            println!("{shape:e} {ggx:e} {beckmann:e}");
        }
    }
    let Some(out) = out else { return Ok(()) };
    let pixels = picture(&set, &look, Film { size, samples, seed: 0 })?;
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(out)?), size, size);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    Ok(writer.finish()?)
}
