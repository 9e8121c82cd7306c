//! The model's values: directional albedos by quadrature, and their averages.

use std::collections::{HashMap, HashSet};

use microfacet_baker::bake::albedo::weights;
use microfacet_baker::progress::Stage;
use microfacet_core::Masking;
use microfacet_core::schlick::SCHLICK_AVERAGE;
use microfacet_model::fresnel::schlick_weight;
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use rayon::prelude::*;

use super::axis::Place;

/// The smallest error of albedos that the quadrature aims at, and that of averages, which err by
/// 1e-7 then.
pub(super) const FINEST: f64 = 1e-7;
const AVERAGE_TOLERANCE: f64 = 3e-5;

/// What a channel of a texture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// E, the albedo under F = 1.
    E,
    /// 1 − E.
    Lost,
    /// Factor of F0 under Schlick's reflectance.
    Scale,
    /// Factor of F90, E − scale.
    Bias,
    /// bias − E (1−μ)⁵, which vanishes with σ; of averages, bias − E/21.
    Excess,
    /// A channel of an engine that is no albedo of this family: 0.
    Empty,
}

impl Channel {
    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::E => "e",
            Self::Lost => "one_minus_e",
            Self::Scale => "scale",
            Self::Bias => "bias",
            Self::Excess => "bias_excess",
            Self::Empty => "empty",
        }
    }

    /// The range of its values. A fit may exceed it, which would make a loss negative.
    pub(super) fn range(self) -> [f64; 2] {
        match self {
            Self::Excess => [-1.0, 1.0],
            _ => [0.0, 1.0],
        }
    }

    pub(super) fn of(self, truth: Truth) -> f64 {
        match self {
            Self::E => truth.e,
            Self::Lost => 1.0 - truth.e,
            Self::Scale => truth.e - truth.bias,
            Self::Bias => truth.bias,
            Self::Excess => truth.bias - truth.e * truth.mirror,
            Self::Empty => 0.0,
        }
    }
}

/// The albedo of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// E.
    pub e: f64,
    /// The component of E with the factor F90.
    pub bias: f64,
    /// The bias of a mirror, (1−μ)⁵; of an average, 1/21.
    pub mirror: f64,
}

/// The albedos of `count` places with the shapes `gammas`, each a step of the stage; either all
/// have a view, and are found to `tolerance`, or all are averages. Places are computed when used: a
/// large texture has 2²⁴.
pub(super) fn truths(
    gammas: impl Iterator<Item = f64>,
    count: usize,
    place: impl Fn(usize) -> Place + Sync,
    masking: Masking,
    tolerance: f64,
    stage: &Stage,
) -> Result<Vec<Truth>, ParameterError> {
    let average = count > 0 && place(0).cos.is_none();
    let tolerance = if average { AVERAGE_TOLERANCE } else { tolerance };
    let gammas: HashSet<u64> = gammas.map(f64::to_bits).collect();
    let prepare = |gamma| {
        let shape = Shape::new(f64::from_bits(gamma))?;
        Ok((gamma, AlbedoIntegrator::new(shape, tolerance)))
    };
    let integrators: HashMap<u64, AlbedoIntegrator> =
        gammas.into_iter().map(prepare).collect::<Result<_, ParameterError>>()?;
    stage.split(count);
    let of = |i: usize| {
        let place = place(i);
        let integrator = &integrators[&place.gamma.to_bits()];
        let (albedo, mirror) = match place.cos {
            Some(cos) => (integrator.reflection(place.sigma, cos, weights)?, schlick_weight(cos)),
            None => (integrator.average(place.sigma, weights)?, SCHLICK_AVERAGE),
        };
        stage.step();
        let [scale, bias, _] = albedo.of(masking);
        Ok(Truth { e: scale + bias, bias, mirror })
    };
    (0..count).into_par_iter().map(of).collect()
}
