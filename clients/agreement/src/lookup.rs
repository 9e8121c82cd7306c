//! Arguments and results of lookups, in the layout of C, which is that of a buffer of numbers.

use bytemuck::{Pod, Zeroable};

/// The arguments of lookups.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Point {
    pub sigma: [f32; 2],
    pub v: [f32; 3],
    pub l: [f32; 3],
    pub m: [f32; 3],
    pub u: [f32; 2],
}

/// The results of lookups; pairs are by form of masking.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Answer {
    pub d: f32,
    pub g1: f32,
    pub lambda: f32,
    pub pdf: f32,
    pub reflection_pdf: f32,
    pub normal: [f32; 3],
    pub light: [f32; 3],
    pub g2: [f32; 2],
    pub weight: [f32; 2],
    pub compensation: [f32; 2],
    pub albedo: [f32; 2],
    pub average: [f32; 2],
    pub parts: [[f32; 3]; 2],
    pub average_parts: [[f32; 3]; 2],
}
