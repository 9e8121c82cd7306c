//! How radiance becomes a page of pictures.

use std::error::Error;
use std::path::Path;

use glam::Vec3;
use microfacet_report::plot::{Content, Tile};
use microfacet_report::srgb;

use crate::spheres::figures::Spheres;

/// Exposure of pictures with a shoulder.
const EXPOSURE: f32 = 0.7;

/// Writes linear radiance, without text. `lines` has the lines of the squares, square after square,
/// row by row of the page.
pub(crate) fn write_exr(
    path: &Path,
    spheres: &Spheres,
    lines: &[Vec<Vec3>],
) -> Result<(), Box<dyn Error>> {
    let (cell, columns) = (lines[0].len(), spheres.sheet.columns.len());
    let pixel = |x: usize, y: usize| {
        let square = y / cell * columns + x / cell;
        let radiance = lines[square * cell + y % cell][x % cell];
        (radiance.x, radiance.y, radiance.z)
    };
    let size = [columns, spheres.sheet.rows.len()].map(|count| count * cell);
    Ok(exr::prelude::write_rgb_file(path, size[0], size[1], pixel)?)
}

/// Writes the page with its text, on white, from the same `lines` as [`write_exr`].
pub(crate) fn write_png(
    path: &Path,
    spheres: Spheres,
    lines: &[Vec<Vec3>],
) -> Result<(), Box<dyn Error>> {
    let Spheres { mut sheet, is_linear, .. } = spheres;
    let tiles = sheet.rows.iter_mut().flat_map(|(_, tiles)| tiles);
    for (tile, square) in tiles.zip(lines.chunks(lines[0].len())) {
        let pixels = square.iter().flatten().map(|&radiance| {
            (255.0 * encoded(radiance, is_linear)).to_array().map(|x| x.round() as u8)
        });
        *tile = Tile { content: Content::Colors(pixels.collect()), ..tile.clone() };
    }
    Ok(std::fs::write(path, sheet.drawing().png()?)?)
}

/// Steps of 1/255 by which an error, up or down, changes the picture. White stays white upwards,
/// also where a single path of many met a lamp.
pub(crate) fn steps(radiance: Vec3, error: Vec3, is_linear: bool) -> f32 {
    let below = (radiance - error).max(Vec3::ZERO);
    let [a, b, c] = [below, radiance, radiance + error].map(|at| encoded(at, is_linear));
    255.0 * (b - a).max(c - b).max_element()
}

fn encoded(radiance: Vec3, is_linear: bool) -> Vec3 {
    let shown = |x: f32| if is_linear { x } else { shoulder(EXPOSURE * x) };
    Vec3::from(radiance.to_array().map(|x| srgb(shown(x).into()) as f32))
}

/// A tone curve that keeps highlights distinct: the identity below a half, then an exponential
/// towards 1.
fn shoulder(x: f32) -> f32 {
    if x <= 0.5 { x } else { 1.0 - 0.5 * (1.0 - 2.0 * x).exp() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_that_one_path_of_many_makes_white_is_not_done() {
        let (mean, error) = (Vec3::splat(2.3), Vec3::splat(2.2));
        for is_linear in [false, true] {
            assert!(steps(mean, error, is_linear) > 100.0);
            assert!(steps(mean, 1e-3 * error, is_linear) < 1.0);
        }
    }
}
