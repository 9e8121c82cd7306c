//! Directional albedo under an exact Fresnel term: a conductor's three channels, or a dielectric seen from either side.
//!
//! What is stored is the reflected share itself, by the axes of the other albedo tables.

use rayon::prelude::*;

use microfacet_model::fresnel::{Conductor, Dielectric};
use microfacet_model::{Albedo, AlbedoIntegrator, ParameterError, Shape};
use microfacet_sampler::{Axis, FresnelEntry, Kind, Masking, Table};

use super::albedo::{AlbedoSpec, BakeError, axes};

/// Error allowed in a node: at the edge of total reflection the quadrature is slower than elsewhere.
pub const NODE_ERROR: f64 = 1e-4;

/// Names of the channels.
pub fn channels(fresnel: &FresnelEntry) -> &'static [&'static str] {
    match fresnel {
        FresnelEntry::Dielectric(_) => &["reflection", "reflection_leaving"],
        _ => &["red", "green", "blue"],
    }
}

/// The reflectances of the channels as functions of v·m; the last is unused by a dielectric.
pub struct Reflectances(Surface);

enum Surface {
    Conductor([Conductor; 3]),
    Dielectric([Dielectric; 2]),
}

impl Reflectances {
    /// Checks the indices.
    ///
    /// # Errors
    /// [`ParameterError`] for η ≤ 0 or k < 0.
    pub fn new(fresnel: &FresnelEntry) -> Result<Self, ParameterError> {
        Ok(Self(match *fresnel {
            FresnelEntry::Conductor { eta, k } => {
                let channel = |i: usize| Conductor::new(eta[i], k[i]);
                Surface::Conductor([channel(0)?, channel(1)?, channel(2)?])
            }
            FresnelEntry::Dielectric(eta) => {
                let entering = Dielectric::new(eta)?;
                Surface::Dielectric([entering, entering.reversed()])
            }
            FresnelEntry::Mirror | FresnelEntry::Schlick(_) => {
                unreachable!("their albedos are made of moments")
            }
        }))
    }

    /// v·m of the kink where total reflection sets in, seen from the denser side; none for conductors.
    fn kink(&self) -> Option<f64> {
        let Surface::Dielectric([entering, _]) = &self.0 else { return None };
        let dense = entering.eta().max(1.0 / entering.eta());
        (dense > 1.0).then(|| ((1.0 - 1.0 / dense) * (1.0 + 1.0 / dense)).sqrt())
    }

    /// Their albedos by quadrature, for both forms of masking.
    ///
    /// # Errors
    /// As [`AlbedoIntegrator::reflection`].
    pub fn albedo(
        &self,
        model: &AlbedoIntegrator,
        sigma: f64,
        cos_theta: f64,
    ) -> Result<Albedo<3>, ParameterError> {
        match self.kink() {
            Some(kink) => model.reflection_with_kink(sigma, cos_theta, kink, |cos| self.at(cos)),
            None => model.reflection(sigma, cos_theta, |cos| self.at(cos)),
        }
    }

    /// Their values.
    fn at(&self, cos: f64) -> [f64; 3] {
        match &self.0 {
            Surface::Conductor(channels) => channels.map(|metal| metal.reflectance(cos)),
            Surface::Dielectric([entering, leaving]) => {
                [entering.reflectance(cos), leaving.reflectance(cos), 0.0]
            }
        }
    }
}

/// Bakes one table for each form of masking, with `quadrature_error` in its certificate.
///
/// # Errors
/// [`BakeError`] if a node is not in [0, 1] or not right to [`NODE_ERROR`], or the specification is out of the domain.
pub fn bake(spec: &AlbedoSpec, fresnel: &FresnelEntry) -> Result<Vec<Table>, BakeError> {
    let axes = axes(spec);
    let quantities =
        |axis: &Axis| -> Vec<f64> { axis.nodes.iter().filter_map(|&t| axis.quantity(t)).collect() };
    let (gammas, sigmas) = (quantities(&axes[0]), quantities(&axes[1]));
    let reflectances = Reflectances::new(fresnel)?;
    let channels = channels(fresnel);
    let views = |sigma, gamma| {
        let view = &axes[2];
        view.nodes.iter().map(move |&t| view.view_cosine(sigma, gamma, t).expect("a view axis"))
    };
    let places: Vec<[f64; 3]> = gammas
        .iter()
        .flat_map(|&gamma| sigmas.iter().map(move |&sigma| (gamma, sigma)))
        .flat_map(|(gamma, sigma)| views(sigma, gamma).map(move |cos| [sigma, gamma, cos]))
        .collect();
    let integrators = gammas
        .par_iter()
        .map(|&gamma| Ok(AlbedoIntegrator::new(Shape::new(gamma)?, spec.tolerance)))
        .collect::<Result<Vec<_>, ParameterError>>()?;
    let per_shape = places.len() / gammas.len();
    let nodes = places
        .par_iter()
        .enumerate()
        .map(|(i, &at)| {
            let albedo = reflectances.albedo(&integrators[i / per_shape], at[0], at[2])?;
            if !(albedo.error <= NODE_ERROR) {
                return Err(BakeError::Accuracy { at, error: albedo.error });
            }
            let forms = [albedo.uncorrelated, albedo.height_correlated];
            let sound = |x: &&f64| (0.0..=1.0 + albedo.error).contains(*x);
            match forms.iter().flatten().find(|x| !sound(x)) {
                Some(&value) => Err(BakeError::Albedo { at, value }),
                None => Ok((forms, albedo.error)),
            }
        })
        .collect::<Result<Vec<_>, BakeError>>()?;
    let error = nodes.iter().map(|node| node.1).fold(0.0, f64::max);
    let table = |&masking: &Masking| {
        let name = format!("{}_{}", Kind::FresnelAlbedo.name(), masking.name().replace('-', "_"));
        Table {
            name: format!("{name}_{}{}", fresnel.label(), spec.domain.suffix()),
            kind: Kind::FresnelAlbedo,
            axes: axes.clone(),
            channels: channels.iter().map(|name| (*name).to_owned()).collect(),
            masking: Some(masking),
            // Above 1 by less than the error of the quadrature is 1.
            values: nodes
                .iter()
                .flat_map(|node| &node.0[masking as usize][..channels.len()])
                .map(|&x| x.min(1.0) as f32)
                .collect(),
            precision: spec.precision,
            certificate: [("quadrature_error".to_string(), error)].into(),
        }
        .rounded(spec.precision)
    };
    Ok(spec.maskings.iter().map(table).collect())
}
