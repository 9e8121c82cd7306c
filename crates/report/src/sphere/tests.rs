//! What the script is given.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::DeflateDecoder;
use glam::Vec3;
use half::f16;
use microfacet_export::Shape;
use microfacet_export::texture::{Place, TexelAxis, place};
use microfacet_sampler::{Masking, Metal, Tables};
use serde_json::Value;

use super::super::subjects::Subjects;
use super::data::{Data, SIGMA, axes, metal_of};

/// Numbers of a text as `gl.js` reads them: inflated, bytes of equal weight together.
fn unpacked<const N: usize>(text: &Value) -> Vec<[u8; N]> {
    let deflated = STANDARD.decode(text.as_str().unwrap()).unwrap();
    let mut planes = Vec::new();
    DeflateDecoder::new(&deflated[..]).read_to_end(&mut planes).unwrap();
    let count = planes.len() / N;
    assert_eq!(planes.len(), N * count);
    (0..count).map(|i| std::array::from_fn(|n| planes[n * count + i])).collect()
}

fn data(set: &Tables) -> (Subjects, Value) {
    let subjects = Subjects::of(set);
    let json = Data::new(set, &subjects).unwrap().json;
    (subjects, serde_json::from_str(&json).unwrap())
}

/// The tables of each stop are between its offset and the next, bit for bit: masking of all, slopes
/// of those that are sampled.
#[test]
fn the_script_is_given_the_tables_of_each_shape() {
    let set = Tables::embedded();
    let (subjects, data) = data(&set);
    let pairs: Vec<[u8; 4]> = unpacked(&data["tables"]);
    let numbers: Vec<f32> = pairs.into_iter().map(f32::from_le_bytes).collect();
    assert_eq!(numbers.len() % (2 * data["width"].as_u64().unwrap() as usize), 0);
    let stops = data["stops"].as_array().unwrap();
    assert_eq!(stops.len(), subjects.stops.len());
    let place = |at: &Value| 2 * at.as_u64().unwrap() as usize;
    let mut places: Vec<usize> = stops.iter().map(|stop| place(&stop["shape"])).collect();
    places.extend([place(&data["ggx"]), place(&data["beckmann"]), numbers.len()]);
    places.sort_unstable();
    for (stop, &gamma) in stops.iter().zip(&subjects.stops) {
        assert_eq!(stop["gamma"].as_f64().unwrap_or(f64::INFINITY), gamma);
        let start = place(&stop["shape"]);
        let end = places.iter().copied().find(|&place| place > start).unwrap();
        let shape = Shape::bind(&set, gamma).unwrap();
        for part in shape.parts() {
            let is_slice = subjects.slices.contains(&gamma);
            let is_kept = part.name == "masking" || is_slice && part.name == "slopes";
            if part.columns % 2 == 0 && (is_kept || !is_slice && part.name == "slopes") {
                let mut there = numbers[start..end].windows(part.values.len());
                assert_eq!(there.any(|at| at == part.values), is_kept, "{}, {gamma}", part.name);
            }
        }
        let drawn = subjects.stops[stop["drawn"].as_u64().unwrap() as usize];
        assert!(subjects.slices.contains(&drawn) && drawn <= gamma, "{gamma} is drawn by {drawn}");
    }
}

/// The volume of albedos has a layer for each stop, a row for each roughness and a texel for each
/// view; between texels a linear filter finds the albedo of the tables.
#[test]
fn the_albedo_texture_is_that_of_the_tables() {
    let set = Tables::embedded();
    let (subjects, data) = data(&set);
    let axes = axes();
    let [rows, columns] = axes.each_ref().map(TexelAxis::len);
    assert_eq!(data["texels"], serde_json::json!([rows, columns]));
    let lost = unpacked::<2>(&data["lost"]).into_iter().map(|x| f16::from_le_bytes(x).to_f64());
    let lost: Vec<f64> = lost.collect();
    assert_eq!(lost.len(), subjects.stops.len() * rows * columns);
    let dense = axes.each_ref().map(|axis| axis.dense(3));
    let mut worst: f64 = 0.0;
    for (layer, &gamma) in lost.chunks(rows * columns).zip(&subjects.stops) {
        for &row in &dense[0] {
            let sigma = place(&axes, Place::of_shape(gamma), &[row, 0.0]).sigma;
            if sigma < SIGMA[0] {
                continue;
            }
            let albedo = set.albedo(sigma, gamma, Masking::HeightCorrelated).unwrap();
            for &column in &dense[1] {
                let at = place(&axes, Place::of_shape(gamma), &[row, column]);
                if at.cos.unwrap() < LEAST {
                    continue;
                }
                let [(i, y), (j, x)] = [axes[0].locate(row), axes[1].locate(column)];
                let along =
                    |i: usize| layer[columns * i + j] * (1.0 - x) + layer[columns * i + j + 1] * x;
                let root = along(i) * (1.0 - y) + along(i + 1) * y;
                let found = root * root;
                let cos = at.cos.unwrap();
                let v = Vec3::new((1.0 - cos * cos).max(0.0).sqrt() as f32, 0.0, cos as f32);
                let off = (found - f64::from(albedo.lost(v))).abs();
                worst = worst.max(off);
            }
        }
    }
    println!("the volume differs by at most {worst:.2e}");
    assert!(worst < ALBEDO, "{worst:e}");
}

/// One of the 255 levels of a picture, of light that is white.
const ALBEDO: f64 = 1.0 / 255.0;
/// Below this cosine the albedo of a smooth lobe falls within a texel.
const LEAST: f64 = 0.02;

#[test]
fn a_name_mentions_a_metal_by_a_whole_word() {
    for (name, metal) in [
        ("Brushed Aluminium", Some(Metal::Aluminium)),
        ("aluminum_01", Some(Metal::Aluminium)),
        ("copper/gold", Some(Metal::Copper)),
        ("golden", None),
        ("", None),
    ] {
        assert_eq!(metal_of(name), metal, "{name}");
    }
}
