//! Directional albedo of conductors under their exact reflectance, by the axes of the other albedo tables. What is stored is the reflected share
//! itself.

use rayon::prelude::*;

use microfacet_model::fresnel::Conductor;
use microfacet_model::{Albedo, AlbedoIntegrator, ParameterError, Shape};
use microfacet_sampler::{Axis, FresnelEntry, Kind, Masking, Table};

use super::albedo::{AlbedoSpec, BakeError, axes};
use super::names;

/// The reflectances of the channels.
pub struct Metal([Conductor; 3]);

impl Metal {
    /// Of a complex index by channel; `None` of what is no conductor.
    ///
    /// # Errors
    /// [`ParameterError`] for η ≤ 0 or k < 0.
    pub fn new(fresnel: &FresnelEntry) -> Result<Option<Self>, ParameterError> {
        let FresnelEntry::Conductor { eta, k } = fresnel else { return Ok(None) };
        let channel = |i: usize| Conductor::new(eta[i], k[i]);
        Ok(Some(Self([channel(0)?, channel(1)?, channel(2)?])))
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
        model.reflection(sigma, cos_theta, |cos| self.0.map(|metal| metal.reflectance(cos)))
    }
}

/// Bakes one table for each form of masking, with `quadrature_error` in its certificate.
///
/// # Errors
/// [`BakeError`] if a node is not in [0, 1] or not accurate enough, or the specification is out of the domain.
pub fn bake(spec: &AlbedoSpec, fresnel: &FresnelEntry, metal: &Metal) -> Result<Vec<Table>, BakeError> {
    let axes = axes(spec);
    let views = |sigma, gamma, _| {
        let view = spec.view.bind(sigma, gamma);
        axes[2].nodes.iter().map(|&t| view.quantity(t)).collect()
    };
    let albedo = |model: &AlbedoIntegrator, sigma, _, cos| metal.albedo(model, sigma, cos);
    let tables = shares(spec, &axes, &[f64::NAN], views, albedo)?;
    let suffix = format!("{}{}", fresnel.label(), spec.domain.suffix());
    Ok(tables
        .into_iter()
        .map(|table| Table {
            name: Kind::FresnelAlbedo.table_name(table.masking, &suffix),
            kind: Kind::FresnelAlbedo,
            channels: names(Kind::RGB),
            ..table
        })
        .collect())
}

/// Tables of shares of light, one for each form of masking, over γ, σ, some indices η of refraction and the views of a material and index; not named
/// yet.
pub(super) fn shares<const N: usize>(
    spec: &AlbedoSpec,
    axes: &[Axis],
    etas: &[f64],
    views: impl Fn(f64, f64, f64) -> Vec<f64> + Sync,
    albedo: impl Fn(&AlbedoIntegrator, f64, f64, f64) -> Result<Albedo<N>, ParameterError> + Sync,
) -> Result<Vec<Table>, BakeError> {
    let (gammas, sigmas) = (axes[0].quantities(), axes[1].quantities());
    let integrators = gammas
        .par_iter()
        .map(|&gamma| Ok(AlbedoIntegrator::new(Shape::new(gamma)?, spec.tolerance)))
        .collect::<Result<Vec<_>, ParameterError>>()?;
    let mut rows = Vec::new();
    for model in &integrators {
        for &sigma in &sigmas {
            rows.extend(etas.iter().map(|&eta| (model, sigma, eta)));
        }
    }
    let node = |&(model, sigma, eta): &(&AlbedoIntegrator, f64, f64), cos| {
        let albedo = albedo(model, sigma, eta, cos)?;
        let at = [sigma, model.shape().gamma(), cos];
        if !(albedo.error <= NODE_ERROR.max(spec.tolerance)) {
            return Err(BakeError::Accuracy { at, error: albedo.error });
        }
        let forms = [albedo.uncorrelated, albedo.height_correlated];
        let sound = |x: &&f64| **x >= -albedo.error && **x <= 1.0 + albedo.error;
        match forms.iter().flatten().find(|x| !sound(x)) {
            Some(&value) => Err(BakeError::Albedo { at, value }),
            None => Ok(albedo),
        }
    };
    let nodes = rows
        .par_iter()
        .map(|row| views(row.1, row.0.shape().gamma(), row.2).into_iter().map(|cos| node(row, cos)).collect())
        .collect::<Result<Vec<Vec<_>>, BakeError>>()?;
    let error = nodes.iter().flatten().map(|node| node.error).fold(0.0, f64::max);
    let table = |&masking: &Masking| {
        let values = nodes.iter().flatten().flat_map(|node| node.of(masking));
        Table {
            name: String::new(),
            kind: Kind::FresnelAlbedo,
            axes: axes.to_vec(),
            channels: Vec::new(),
            masking: Some(masking),
            // Outside by less than the error of the quadrature is at the end.
            values: values.map(|x| x.clamp(0.0, 1.0) as f32).collect(),
            precision: spec.precision,
            certificate: [("quadrature_error".to_string(), error)].into(),
        }
    };
    Ok(spec.maskings.iter().map(table).collect())
}

/// Error allowed in a node: where total reflection sets in on a surface rough for its shape, the quadrature stops at its last order.
const NODE_ERROR: f64 = 1e-5;
