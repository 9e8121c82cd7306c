//! The model's values: directional albedos by quadrature, and their averages.

use std::collections::{HashMap, HashSet};

use microfacet_baker::bake::albedo::weights;
use microfacet_baker::progress::Stage;
use microfacet_core::Masking;
use microfacet_core::schlick::{
    F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE, f82_weight, schlick_weight,
};
use microfacet_model::fresnel::Dielectric;
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use rayon::prelude::*;

use super::axis::Place;
use super::interface::soft_reflectance;

/// The smallest errors that the quadrature aims at, of albedos and of averages, which err by less
/// than a hundredth of that.
pub(super) const FINEST: [f64; 2] = [1e-7, 3e-6];
/// The smallest ones of interfaces, whose shares then err by up to 2e-6.
pub(super) const FINEST_OF_INTERFACES: [f64; 2] = [1e-5, 3e-5];
/// The largest ones, for textures of few texels.
pub(super) const COARSEST: [f64; 2] = [3e-5, 1e-4];
/// The same of interfaces, whose textures are volumes of many points.
pub(super) const COARSEST_OF_INTERFACES: [f64; 2] = [3e-4, 1e-3];

/// What a channel of a texture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// E, the albedo under F = 1; of an interface, the sum of both shares.
    E,
    /// 1 − E.
    Lost,
    /// √(1 − E), of which small losses keep their order of magnitude.
    RootLost,
    /// Factor of F0 under Schlick's reflectance.
    Scale,
    /// Factor of F90, E − scale.
    Bias,
    /// bias − E (1−μ)⁵, which vanishes with σ; of averages, bias − E/21.
    Excess,
    /// The moment of F82, less E times that of a mirror.
    TintExcess,
    /// The moment of μ (1−μ)⁶, which is that of F82 without its factor.
    Tint,
    /// The share of light that an interface reflects.
    Reflected,
    /// The share of light that an interface transmits.
    Transmitted,
    /// What the reflected share exceeds that of a smooth interface by, softened by the roughness.
    ReflectedExcess,
    /// The same of the transmitted share.
    TransmittedExcess,
    /// One minus the share that is reflected.
    NotReflected,
    /// A channel of an engine that is no albedo of this family: 0.
    Empty,
}

impl Channel {
    /// What a texture of averages has in its place. Averages of both shares vary smoothly.
    pub(super) fn of_averages(self) -> Self {
        match self {
            Self::ReflectedExcess => Self::Reflected,
            Self::TransmittedExcess => Self::Transmitted,
            other => other,
        }
    }

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::E => "e",
            Self::Lost => "one_minus_e",
            Self::RootLost => "root_one_minus_e",
            Self::Scale => "scale",
            Self::Bias => "bias",
            Self::Excess => "bias_excess",
            Self::TintExcess => "f82_excess",
            Self::Tint => "tint",
            Self::Reflected => "reflected",
            Self::Transmitted => "transmitted",
            Self::ReflectedExcess => "reflected_excess",
            Self::TransmittedExcess => "transmitted_excess",
            Self::NotReflected => "one_minus_reflected",
            Self::Empty => "empty",
        }
    }

    /// The range of its values. A fit may exceed it, which would make a loss negative.
    pub(super) fn range(self) -> [f64; 2] {
        match self {
            Self::Excess | Self::TintExcess | Self::ReflectedExcess | Self::TransmittedExcess => {
                [-1.0, 1.0]
            }
            _ => [0.0, 1.0],
        }
    }

    pub(super) fn of(self, truth: Truth) -> f64 {
        match self {
            Self::E => truth.e,
            Self::Lost => 1.0 - truth.e,
            Self::RootLost => (1.0 - truth.e).max(0.0).sqrt(),
            Self::Scale => truth.e - truth.bias,
            Self::Bias => truth.bias,
            Self::Excess => truth.bias - truth.e * truth.mirror[0],
            Self::TintExcess => truth.tint - truth.e * truth.mirror[1],
            Self::Tint => truth.tint / F82_SCALE,
            Self::Reflected => truth.shares[0],
            Self::Transmitted => truth.shares[1],
            Self::ReflectedExcess => truth.shares[0] - truth.smooth,
            Self::TransmittedExcess => truth.shares[1] - (1.0 - truth.smooth),
            Self::NotReflected => 1.0 - truth.shares[0],
            Self::Empty => 0.0,
        }
    }
}

/// The albedo of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// E; of an interface, the sum of both shares.
    pub e: f64,
    /// The shares reflected and transmitted, all and nothing of E if F = 1.
    pub shares: [f64; 2],
    /// The component of E with the factor F90; NaN of an interface.
    pub bias: f64,
    /// The moment of OpenPBR's tint at 82°, over its peak; NaN of an interface.
    pub tint: f64,
    /// The bias and the moment of the tint of a mirror, (1−μ)⁵ and 7⁷/6⁶ μ(1−μ)⁶, or averages.
    pub mirror: [f64; 2],
    /// The reflectance of a smooth interface, softened by the roughness; NaN of a mirror and of
    /// averages.
    pub smooth: f64,
}

impl Truth {
    /// E, its bias and the moment of the tint, at a view, or their averages.
    pub(crate) fn new(cos: Option<f64>, [e, bias, tint]: [f64; 3]) -> Self {
        let of_view = |cos| [schlick_weight(cos), f82_weight(cos)];
        let mirror = cos.map_or([SCHLICK_AVERAGE, F82_AVERAGE], of_view);
        Self { e, shares: [e, 0.0], bias, tint, mirror, smooth: f64::NAN }
    }

    /// The shares reflected and transmitted by an interface of index η.
    fn of_interface(place: &Place, eta: f64, shares: [f64; 2]) -> Self {
        let smooth = place.cos.map(|cos| soft_reflectance(eta, place.sigma, cos));
        Self {
            shares,
            smooth: smooth.unwrap_or(f64::NAN),
            ..Self::new(place.cos, [shares.iter().sum(), f64::NAN, f64::NAN])
        }
    }
}

/// The albedos of `count` places with the shapes `gammas`, each a step of the stage; either all
/// have a view or all are averages. Places are computed when used: a large texture has 2²⁴.
pub(super) fn truths(
    gammas: impl Iterator<Item = f64>,
    count: usize,
    place: impl Fn(usize) -> Place + Sync,
    masking: Masking,
    tolerance: f64,
    stage: &Stage,
) -> Result<Vec<Truth>, ParameterError> {
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
        let truth = match place.eta {
            None => {
                let albedo = match place.cos {
                    Some(cos) => integrator.reflection(place.sigma, cos, weights)?,
                    None => integrator.average(place.sigma, weights)?,
                };
                let [scale, bias, tint] = albedo.of(masking);
                Truth::new(place.cos, [scale + bias, bias, tint])
            }
            Some(eta) => {
                let interface = Dielectric::new(eta)?;
                let shares = match place.cos {
                    Some(cos) => integrator.interface(place.sigma, cos, interface)?,
                    None => integrator.interface_average(place.sigma, interface)?,
                };
                Truth::of_interface(&place, eta, shares.of(masking))
            }
        };
        stage.step();
        Ok(truth)
    };
    (0..count).into_par_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a texture of 32 texels a side is fitted to errs far less than that texture.
    #[test]
    fn values_are_far_better_than_the_error_they_aim_at() {
        let smooth = [1.55, 2.0, f64::INFINITY].map(|gamma| (gamma, 1e-3));
        let rough = [1.55, 2.0, f64::INFINITY].map(|gamma| (gamma, 3.0));
        let between = [(1.7305, 0.0327), (f64::INFINITY, 0.0126), (2.0, 0.3)];
        let materials = [&smooth[..], &between, &rough].concat();
        let worst = |tolerance: f64, finest: f64, cos: Option<f64>| {
            let at = |(gamma, sigma)| Place { gamma, sigma, eta: None, cos };
            let place = |i: usize| at(materials[i]);
            let of = |tolerance| {
                let gammas = materials.iter().map(|&(gamma, _)| gamma);
                let (masking, stage) = (Masking::HeightCorrelated, Stage::unwatched());
                truths(gammas, materials.len(), place, masking, tolerance, &stage).unwrap()
            };
            let pairs = of(tolerance).into_iter().zip(of(finest));
            pairs.map(|(a, b)| (a.e - b.e).abs().max((a.bias - b.bias).abs())).fold(0.0, f64::max)
        };
        for cos in [1.0, 0.6, 0.02, 1e-4] {
            let worst = worst(COARSEST[0], 1e-11, Some(cos));
            assert!(worst < 1e-6, "{cos}: {worst}");
        }
        let worst = worst(COARSEST[1], 1e-9, None);
        assert!(worst < 3e-7, "{worst}");
    }

    /// Less than what engines store in 16 bits or six decimals can tell apart.
    #[test]
    fn shares_of_interfaces_are_as_exact_as_is_said() {
        let mut places = Vec::new();
        for eta in [0.5, 0.8, 1.2, 2.3] {
            for sigma in [0.001, 0.02, 0.3, 1.0] {
                let at = |cos| Place { gamma: 2.0, sigma, eta: Some(eta), cos: Some(cos) };
                places.extend([0.0, 1e-3, 0.1, 0.6, 1.0].map(at));
            }
        }
        let of = |tolerance| {
            let (place, masking) = (|i: usize| places[i], Masking::Uncorrelated);
            let (gamma, stage) = (std::iter::once(2.0), Stage::unwatched());
            truths(gamma, places.len(), place, masking, tolerance, &stage).unwrap()
        };
        for (a, b) in of(FINEST_OF_INTERFACES[0]).iter().zip(of(1e-9)) {
            for (a, b) in a.shares.iter().zip(b.shares) {
                assert!((a - b).abs() < 2e-6, "{a} for {b}");
            }
        }
    }
}
