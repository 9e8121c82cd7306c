//! An array of NumPy, shaped as the texture, with an axis of channels if it has several.

use super::bytes;
use crate::texture::Texture;

/// Bytes in front of the dictionary: a magic number, the version 1.0, and the dictionary's length.
const HEAD: usize = 10;
/// Values begin at a multiple of it (NEP 1, "A simple file format for NumPy arrays").
const ALIGNMENT: usize = 64;

pub(super) fn encode(texture: &Texture) -> Vec<u8> {
    let channels = texture.spec.channels.len();
    let edges = texture.size().into_iter().chain((channels > 1).then_some(channels));
    let edges: Vec<String> = edges.map(|edge| edge.to_string()).collect();
    // A tuple of one has a comma as well.
    let shape = if let [edge] = &edges[..] { format!("{edge},") } else { edges.join(", ") };
    let kind = if texture.half { "<f2" } else { "<f4" };
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (HEAD + header.len() + 1).next_multiple_of(ALIGNMENT) - HEAD;
    let header = format!("{header:<0$}\n", length - 1);
    let head = [&b"\x93NUMPY\x01\0"[..], &(length as u16).to_le_bytes()].concat();
    [head, header.into_bytes(), bytes(texture)].concat()
}
