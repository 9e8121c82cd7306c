//! The textures of the kit for real time, of every γ at once: masking in two dimensions, and
//! albedos as a volume, in 16 bits, for linear filters.

use std::collections::BTreeMap;

use half::f16;
use ktx2::Format;
use microfacet_core::Masking;
use microfacet_model::{ParameterError, Shape};
use microfacet_sampler::port::VolumeTables;
use microfacet_sampler::{MaterialError, Tables};
use microfacet_tables::axis::LogShape;
use microfacet_tables::crc32;
use serde::Serialize;

use crate::ExportFile;
use crate::texture::{Channel, Channels, Place, Shapes, TextureSpec, Truth, encode_texels};

/// The least γ. Heavier tails lose most of their light to facets near the horizon, which these
/// textures do not resolve.
pub(crate) const GAMMA_MIN: f64 = 1.6;
/// The largest σ of albedos.
const SIGMA_MAX: f64 = 1.0;
/// Texels along γ, σ and the view.
pub(crate) const ALBEDO: [usize; 3] = [32, 32, 48];
/// Texels along the view in the texture of masking, which has those of γ too.
pub(crate) const VIEWS_OF_MASKING: usize = 64;
/// In the middle of (1 + Λ) q, from ½ to 1: what is left rounds to 16 bits with more digits.
const MIDDLE: f64 = 0.75;

/// Tables for real time.
#[derive(Clone, Debug)]
pub struct Realtime {
    /// (1 + Λ) q − ¾ by γ and by q = z/(z + κ), with z = cot θ/σ and κ = ½ + ½/(2γ−3).
    masking: Vec<f16>,
    /// √(1 − E), the excesses of bias and F82, and √(1 − E_avg), by γ, σ and view.
    albedo: Vec<[f16; 4]>,
    generator: String,
    numerics: u32,
}

impl Realtime {
    /// Makes the textures, whose texels are exact: masking of the model, and albedos of a set's
    /// family under height-correlated masking. Takes seconds.
    ///
    /// # Errors
    /// [`MaterialError`] for a set without albedos of all these γ and σ.
    pub fn bake(tables: &Tables) -> Result<Self, MaterialError> {
        let family = tables.family_albedo(Masking::HeightCorrelated)?;
        let VolumeTables { shapes: [least, most], sigmas: [_, largest], .. } =
            VolumeTables::new(&family);
        // Beyond what it covers a family would return its last, without a word. 2γ−3 of a set that
        // begins at this γ is rounded, and that of infinity any large number.
        let heaviest = (2.0 * GAMMA_MIN - 3.0) as f32;
        if least > 1.0001 * heaviest || most < 1e4 || largest < SIGMA_MAX as f32 {
            let ends = [GAMMA_MIN, f64::INFINITY];
            let lacks = |gamma| tables.albedo(SIGMA_MAX, gamma, Masking::HeightCorrelated).err();
            let (sigma, gamma, nearest) = (SIGMA_MAX, GAMMA_MIN, None);
            let other = MaterialError::AlbedoNotCovered { sigma, gamma, nearest };
            return Err(ends.into_iter().find_map(lacks).unwrap_or(other));
        }
        let spec = spec();
        let truth = |place: &Place| {
            let at = family.at(place.sigma as f32, place.gamma as f32);
            let cos = place.cos.expect("a view");
            let v = [(1.0 - cos * cos).max(0.0).sqrt() as f32, 0.0, cos as f32];
            let (lost, moments) = (f64::from(at.lost(v)), at.moments(v));
            let [bias, f82] = [moments.bias, moments.f82].map(f64::from);
            Truth::new(place.cos, [1.0 - lost, bias, f82])
        };
        let texels = spec.exact(truth);
        let provenance = tables.provenance();
        Ok(Self {
            masking: masking().expect("shapes of the family"),
            albedo: with_averages(&spec, &texels),
            generator: provenance.generator.clone(),
            numerics: provenance.numerics,
        })
    }

    /// The textures and their description, which has the checksums of `files` as well.
    pub(crate) fn append_files(&self, files: &mut Vec<ExportFile>) {
        let masking: Vec<u8> = self.masking.iter().flat_map(|x| x.to_le_bytes()).collect();
        let albedo = self.albedo.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        let [shapes, roughnesses, views] = ALBEDO;
        let mut textures = BTreeMap::new();
        let mut append = |name, format, size: &[usize], channels: &[&'static str], data: &[u8]| {
            let file = format!("student_t_realtime_{name}.ktx2");
            let depth = size.get(2).copied();
            let (contents, offset) =
                encode_texels(format, 2, [size[0], size[1]], depth, data, None);
            let size = size.to_vec();
            let bytes = data.len();
            let channels = channels.to_vec();
            textures
                .insert(name, TextureEntry { file: file.clone(), size, channels, offset, bytes });
            files.push(ExportFile::new(file, contents));
        };
        append(
            "masking",
            Format::R16_SFLOAT,
            &[VIEWS_OF_MASKING, shapes],
            &["(1 + lambda) q - 3/4"],
            &masking,
        );
        append(
            "albedo",
            Format::R16G16B16A16_SFLOAT,
            &[views, roughnesses, shapes],
            &["root_one_minus_e", "bias_excess", "f82_excess", "root_one_minus_e_average"],
            &albedo.collect::<Vec<u8>>(),
        );
        let description = Description {
            generator: &self.generator,
            numerics: self.numerics,
            gamma_min: GAMMA_MIN,
            sigma_max: SIGMA_MAX,
            masking: Masking::HeightCorrelated.name(),
            precision: "f16",
            byte_order: "little",
            textures,
            crc32: files.iter().map(|file| (file.name.clone(), crc32(&file.contents))).collect(),
        };
        let json = serde_json::to_string_pretty(&description).expect("names and numbers");
        files.push(ExportFile::new("student_t_realtime.json", json + "\n"));
    }
}

/// The content of `student_t_realtime.json`.
#[derive(Serialize)]
struct Description<'a> {
    generator: &'a str,
    numerics: u32,
    gamma_min: f64,
    sigma_max: f64,
    masking: &'static str,
    precision: &'static str,
    byte_order: &'static str,
    textures: BTreeMap<&'static str, TextureEntry>,
    /// The CRC-32 (ISO-HDLC) of all files that were written with this one.
    crc32: BTreeMap<String, String>,
}

/// A texture; `size` begins with the width, and its texels are `bytes` from `offset` on.
#[derive(Serialize)]
struct TextureEntry {
    file: String,
    size: Vec<usize>,
    channels: Vec<&'static str>,
    offset: usize,
    bytes: usize,
}

/// κ of the coordinate of masking, which makes the texels about even.
pub(crate) fn kappa(gamma: f64) -> f64 {
    0.5 + 0.5 / (2.0 * gamma - 3.0)
}

/// The texture of masking, exact at its texels: so it errs by less than 16 bits round away.
fn masking() -> Result<Vec<f16>, ParameterError> {
    let last = LogShape::BAKED.coordinate(GAMMA_MIN);
    let mut texels = Vec::new();
    for row in 0..ALBEDO[0] {
        let share = row as f64 / (ALBEDO[0] - 1) as f64;
        let shape = Shape::new(LogShape::BAKED.quantity(share * last))?;
        let kappa = kappa(shape.gamma());
        texels.extend((0..VIEWS_OF_MASKING).map(|column| {
            let q = column as f64 / (VIEWS_OF_MASKING - 1) as f64;
            let z = kappa * q / (1.0 - q);
            // 1 at the normal, where z is infinite.
            let product = if q == 1.0 { 1.0 } else { area(&shape, z) / (z + kappa) };
            f16::from_f64(product - MIDDLE)
        }));
    }
    Ok(texels)
}

/// z (1 + Λ), finite at z = 0.
fn area(shape: &Shape, z: f64) -> f64 {
    z + shape.excess(shape.asinh_slope(z))
}

/// The texture of albedos without their averages.
pub(crate) fn spec() -> TextureSpec {
    let (shapes, masking) = (Shapes::DownTo(GAMMA_MIN), Masking::HeightCorrelated);
    let [views, _] = TextureSpec::of_shapes("", shapes, SIGMA_MAX, &ALBEDO, masking, Channels::E);
    let channels = vec![Channel::RootLost, Channel::Excess, Channel::TintExcess];
    TextureSpec { channels, ..views }
}

/// Texels of three channels, with a fourth: √(1 − E_avg). It is the average of what a filter reads,
/// so that a white furnace closes: further bounces return what the first lost.
fn with_averages(spec: &TextureSpec, texels: &[Vec<f32>]) -> Vec<[f16; 4]> {
    let [_, sigmas, views] = ALBEDO;
    let of_row = |(row, texels): (usize, &[Vec<f32>])| {
        let material = [spec.axes[0].texels[row / sigmas], spec.axes[1].texels[row % sigmas]];
        let lost: Vec<f64> = texels.iter().map(|x| f16::from_f32(x[0]).to_f64()).collect();
        let average = average(spec, material, &lost).sqrt() as f32;
        let texel = |x: &Vec<f32>| [x[0], x[1], x[2], average].map(f16::from_f32);
        texels.iter().map(texel).collect::<Vec<_>>()
    };
    texels.chunks_exact(views).enumerate().flat_map(of_row).collect()
}

/// The average of 1 − E over μ², which is what a filter reads along the views, by steps in each of
/// their cells.
fn average(spec: &TextureSpec, [gamma, sigma]: [f64; 2], along: &[f64]) -> f64 {
    const STEPS: usize = 32;
    let square = |t| spec.place(&[gamma, sigma, t]).cos.expect("a view").powi(2);
    let count = STEPS * (along.len() - 1);
    let (mut lost, mut before) = (0.0, 0.0);
    for step in 0..count {
        let after = square((step + 1) as f64 / count as f64);
        let [a, b] = [0, 1].map(|next| along[step / STEPS + next]);
        let root = a + ((step % STEPS) as f64 + 0.5) / STEPS as f64 * (b - a);
        lost += root * root * (after - before);
        before = after;
    }
    lost
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E, and what further bounces return of the light that the first lost, are 1 between texels
    /// as well.
    #[test]
    fn a_white_furnace_closes() {
        let realtime = Realtime::bake(&Tables::embedded()).unwrap();
        let [shapes, sigmas, views] = ALBEDO;
        let texel = |[a, b, c]: [usize; 3]| realtime.albedo[(a * sigmas + b) * views + c];
        let along = |a: f64, n: usize| {
            let before = (a.floor() as usize).min(n - 2);
            (before, a - before as f64)
        };
        // A row of views at a material between texels.
        let row = |material: [f64; 2], c: usize, channel: usize| -> f64 {
            let [(i, p), (j, q)] = [along(material[0], shapes), along(material[1], sigmas)];
            let of = |i, j| texel([i, j, c])[channel].to_f64();
            let line = |i| (1.0 - q) * of(i, j) + q * of(i, j + 1);
            (1.0 - p) * line(i) + p * line(i + 1)
        };
        let spec = spec();
        let last = |axis: usize| (ALBEDO[axis] - 1) as f64;
        let mut worst = [0.0_f64; 3];
        for shape in [0.0, 0.5, 7.3, 15.5, 24.5, 30.5, 31.0] {
            for sigma in [0.1, 0.5, 1.0, 1.5, 3.5, 6.5, 12.3, 20.5, 26.5, 30.5, 31.0] {
                let along: Vec<f64> = (0..views).map(|c| row([shape, sigma], c, 0)).collect();
                let exact = average(&spec, [shape / last(0), sigma / last(1)], &along);
                let stored = row([shape, sigma], 0, 3).powi(2);
                let most = along.iter().map(|root| root * root).fold(0.0, f64::max);
                let error = most * (exact / stored - 1.0).abs();
                // sigma > 0.04, > 0.01, and below.
                let part = usize::from(sigma < 6.2) + usize::from(sigma < 3.2);
                worst[part] = worst[part].max(error);
            }
        }
        for (worst, bound) in worst.into_iter().zip([1.1e-3, 4e-3, 9e-2]) {
            assert!(worst < bound && worst > 0.5 * bound, "{worst} of {bound}");
        }
    }

    /// What a linear filter reads between texels is masking within what the documentation says.
    #[test]
    fn masking_is_that_of_the_model_between_texels() {
        let texels = masking().unwrap();
        let last = LogShape::BAKED.coordinate(GAMMA_MIN);
        let at = |row: usize, column: usize| f64::from(texels[row * VIEWS_OF_MASKING + column]);
        let mut worst = 0.0_f64;
        for i in 0..=4 * (ALBEDO[0] - 1) {
            let y = f64::from(i as u32) / 4.0;
            let gamma = LogShape::BAKED.quantity(y / (ALBEDO[0] - 1) as f64 * last);
            let shape = Shape::new(gamma).unwrap();
            for j in 0..4 * (VIEWS_OF_MASKING - 1) {
                let x = f64::from(j as u32) / 4.0;
                let [a, b] = [y.floor().min((ALBEDO[0] - 2) as f64), x.floor()];
                let (row, column) = (a as usize, b as usize);
                let along = |row| at(row, column) * (b + 1.0 - x) + at(row, column + 1) * (x - b);
                let read = along(row) * (a + 1.0 - y) + along(row + 1) * (y - a);
                let q = x / (VIEWS_OF_MASKING - 1) as f64;
                let z = kappa(gamma) * q / (1.0 - q);
                let exact = area(&shape, z) / (z + kappa(gamma));
                worst = worst.max(((MIDDLE + read) / exact - 1.0).abs());
            }
        }
        assert!(worst < 4e-4, "{worst}");
        assert!(worst > 2e-4, "{worst}: the bound can be smaller");
    }
}
