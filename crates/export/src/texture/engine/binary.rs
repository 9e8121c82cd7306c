//! Textures as numbers that engines read as they are.

use std::f32::consts::PI;

use super::Texture;
use crate::ExportFile;

/// The smallest average loss of a row, by which the engine divides: E of the smoothest surface
/// falls to 0.94 in the cell at the horizon, which by itself loses this much.
const LEAST_LOSS: f32 = 1.3e-5;

/// MDL: the numbers of texels along roughness, angle and index, then a conductor, a dielectric from
/// outside and one from inside in single precision, slices by roughness. Each row ends with the
/// integral of what is lost over all directions, by which the engine normalises what it adds.
pub(super) fn mdl(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let size = textures[2].size();
    let head = [size[1], size[2], size[0]].map(|n| (n as i32).to_le_bytes());
    let row = |(row, lost): (&[f32], &f32)| {
        let last = PI * lost.max(LEAST_LOSS);
        row.iter().chain([&last]).flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>()
    };
    let table = |pair: &[Texture]| {
        let rows = pair[0].values.chunks(size[2]);
        rows.zip(&pair[1].values).flat_map(row).collect::<Vec<u8>>()
    };
    let tables = textures.chunks(2).flat_map(table);
    let bytes: Vec<u8> = head.concat().into_iter().chain(tables).collect();
    let lobe = if textures[0].spec.gamma == f64::INFINITY { "beckmann" } else { "ggx" };
    Ok(vec![ExportFile::new(format!("{lobe}_smith.bin"), bytes)])
}
