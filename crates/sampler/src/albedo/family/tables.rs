//! The data that lookups of albedos of every shape read, for exports to other languages.

use alloc::vec::Vec;

use microfacet_core::Masking;

use super::axes::{Axes, SHAPE, SIGMA, View};
use super::{FamilyAlbedo, SHAPES, VIEWS};

/// The coefficients and constants of a [`FamilyAlbedo`], laid out as in this crate.
#[derive(Clone, Debug)]
pub struct VolumeTables {
    /// The form of masking.
    pub masking: Masking,
    /// 2γ−3 of the smallest γ and of the largest.
    pub shapes: [f32; 2],
    /// The smallest σ and the largest.
    pub sigmas: [f32; 2],
    /// The coordinate of the first node of shapes and of roughnesses, and nodes for each unit.
    pub first: [f32; 2],
    /// See `first`.
    pub density: [f32; 2],
    /// The same of the roughnesses of averages.
    pub averages_first: f32,
    /// See `averages_first`.
    pub averages_density: f32,
    /// Coefficients of √(1 − E) and of the excess of bias and of F82: by σ, by γ, by view.
    pub values: [Vec<f32>; 3],
    /// Coefficients of log₂(1 − E_avg) and of the averages of the excesses: by σ, by γ.
    pub averages: Vec<[f32; 4]>,
}

impl VolumeTables {
    /// Coefficients along the shape, and along the view.
    pub const SIZES: [usize; 2] = [SHAPES, VIEWS];
    /// What the fourth roots of x and h of a view are multiplied by in its coordinate, in cells.
    pub const VIEW_SHARES: [f32; 2] = View::SHARES;

    /// Those of a volume.
    #[must_use]
    pub fn new(family: &FamilyAlbedo) -> Self {
        let Axes { shapes, sigmas, first, density, averages: (start, steps, _), .. } = family.axes;
        let of_lanes = |lanes: wide::f32x4| [SHAPE, SIGMA].map(|axis| lanes.to_array()[axis]);
        Self {
            masking: family.masking,
            shapes,
            sigmas,
            first: of_lanes(first),
            density: of_lanes(density),
            averages_first: start,
            averages_density: steps,
            values: family.values.clone(),
            averages: family.averages.clone(),
        }
    }
}
