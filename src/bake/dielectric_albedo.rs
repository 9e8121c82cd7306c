//! Directional albedo of rough dielectrics: the shares reflected and transmitted, seen from either side, for one index of refraction or a range.
//!
//! A range has an axis of [`ReflectanceRoot`], from 0 at η = 1 to 1 at ∞. From the dense side everything turns where total reflection sets in, which
//! depends on η: the view axis is split there, so that neither views nor indices are interpolated across it.

use microfacet_model::fresnel::Dielectric;
use microfacet_model::{Albedo, AlbedoIntegrator, ParameterError};
use microfacet_sampler::axis::{CriticalBlend, ReflectanceRoot, even_nodes};
use microfacet_sampler::{Axis, Channels, FresnelEntry, Kind, Mapping, Table};

use super::albedo::{AlbedoSpec, BakeError, INTERPOLATION, axes, cut};
use super::fresnel_albedo::shares;
use super::names;

/// From which side light comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The thin one.
    Entering,
    /// The dense one.
    Leaving,
}

impl Side {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Entering, Self::Leaving];

    /// Names of the channels.
    pub const fn channels(self) -> Channels {
        match self {
            Self::Entering => Kind::ENTERING,
            Self::Leaving => Kind::LEAVING,
        }
    }

    /// Reflection and transmission by quadrature, for both forms of masking; `eta` ≥ 1 is that of the dense side, which may be infinite.
    ///
    /// # Errors
    /// As [`AlbedoIntegrator::reflection`].
    pub fn albedo(
        self,
        model: &AlbedoIntegrator,
        sigma: f64,
        eta: f64,
        cos_theta: f64,
    ) -> Result<Albedo<2>, ParameterError> {
        if eta == f64::INFINITY {
            return model.reflection(sigma, cos_theta, |_| [1.0, 0.0]);
        }
        let pane = Dielectric::new(if self == Self::Leaving { 1.0 / eta } else { eta })?;
        let reflectance = |cos: f64| [pane.reflectance(cos)];
        let kink = if pane.eta() < 1.0 { ((1.0 - pane.eta()) * (1.0 + pane.eta())).sqrt() } else { 0.0 };
        let reflected = if kink > 0.0 {
            model.reflection_with_kink(sigma, cos_theta, kink, reflectance)?
        } else {
            model.reflection(sigma, cos_theta, reflectance)?
        };
        let transmitted = model.transmission(sigma, cos_theta, pane)?;
        let both = |r: [f64; 1], t: [f64; 1]| [r[0], t[0]];
        Ok(Albedo {
            uncorrelated: both(reflected.uncorrelated, transmitted.uncorrelated),
            height_correlated: both(reflected.height_correlated, transmitted.height_correlated),
            error: reflected.error.max(transmitted.error),
        })
    }
}

/// Nodes of the axis of indices between two ends in [1, ∞]: one for a single index, else those of `count` even ones over [0, 1] that are read there.
pub(super) fn indices(count: usize, ends: [f64; 2]) -> Axis {
    let nodes = even_nodes(0.0, 1.0, count);
    let [from, to] = ends.map(|eta| ReflectanceRoot.coordinate(eta));
    Axis::new("eta", Mapping::ReflectanceRoot, INTERPOLATION, cut(&nodes, from, to))
}

/// Bakes one table for each form of masking, with `quadrature_error` in its certificate.
///
/// # Errors
/// [`BakeError`] if a node is not in [0, 1] or not accurate enough, or the specification is out of the domain.
pub fn bake(spec: &AlbedoSpec, fresnel: &FresnelEntry, side: Side) -> Result<Vec<Table>, BakeError> {
    let ends = fresnel.indices().expect("the specification is for a dielectric");
    let mut axes = axes(spec);
    axes.insert(2, indices(spec.indices, ends));
    if side == Side::Leaving {
        // An odd number, with the middle one shared by both halves.
        let mapping = Mapping::CriticalBlend(CriticalBlend::BAKED);
        axes[3] = Axis::placed("view", mapping, INTERPOLATION, 2 * spec.views - 1);
    }
    let etas: Vec<f64> = match ends {
        // Not through the coordinate and back.
        [min, max] if min == max => vec![min],
        _ => axes[2].quantities(),
    };
    let views = |sigma, gamma, eta: f64| -> Vec<f64> {
        let nodes = axes[3].nodes.iter();
        match side {
            Side::Entering => {
                let view = spec.view.bind(sigma, gamma);
                nodes.map(|&t| view.quantity(t)).collect()
            }
            Side::Leaving => {
                let view = CriticalBlend::BAKED.bind(sigma, gamma, 1.0 / eta);
                nodes.map(|&t| view.quantity(t)).collect()
            }
        }
    };
    let albedo = |model: &AlbedoIntegrator, sigma, eta, cos| side.albedo(model, sigma, eta, cos);
    let tables = shares(spec, &axes, &etas, views, albedo)?;
    let leaving = if side == Side::Leaving { "_leaving" } else { "" };
    let suffix = format!("{}{leaving}{}", fresnel.label(), spec.domain.suffix());
    Ok(tables
        .into_iter()
        .map(|table| Table {
            name: Kind::DielectricAlbedo.table_name(table.masking, &suffix),
            kind: Kind::DielectricAlbedo,
            channels: names(side.channels()),
            ..table
        })
        .collect())
}
