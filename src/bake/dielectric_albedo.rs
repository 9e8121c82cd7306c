//! Directional albedo of rough dielectrics: the shares reflected and transmitted, seen from either side, for one index of refraction or a range.
//!
//! A range has an axis of F0^¼ = √((η−1)/(η+1)), which goes from 0 at η = 1 to 1 at ∞. From the dense side everything turns where total reflection sets in, which
//! depends on η: the view axis is split there, so that neither views nor indices are interpolated across it.

use microfacet_model::fresnel::Dielectric;
use microfacet_model::{Albedo, AlbedoIntegrator, ParameterError};
use microfacet_sampler::{Axis, FresnelEntry, Interpolation, Kind, Mapping, Masking, Table};

use super::albedo::{AlbedoSpec, BakeError, axes, cut};
use super::fresnel_albedo::shares;

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
    pub const fn channels(self) -> [&'static str; 2] {
        match self {
            Self::Entering => ["reflection", "transmission"],
            Self::Leaving => ["reflection_leaving", "transmission_leaving"],
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

/// The coordinate of views from the dense side: knee, shares and floor as from outside; the root and the kink's width by measuring. With fourth roots above
/// μ_c, too, where they are steep in η near 1, tables over all indices erred by 0.12 for 1e-3 (sigma 0.454, gamma 3, twenty indices).
const VIEW: Mapping = Mapping::CriticalBlend {
    share: 0.4,
    scale: 3.0,
    heavy: 0.5,
    floor: 2e-5,
    slope: 2e-3,
    root: 0.5,
    kink: 1.0,
};

/// Nodes of the axis of indices between two ends in [1, ∞]: one for a single index, else those of `count` even ones over [0, 1] that are read there.
pub(super) fn indices(count: usize, ends: [f64; 2]) -> Axis {
    let mut axis = Axis {
        name: "eta".into(),
        unit: "1".into(),
        mapping: Mapping::ReflectanceRoot,
        interpolation: Interpolation::Lagrange6,
        nodes: Axis::uniform_nodes(count),
    };
    let [from, to] = ends.map(|eta| axis.coordinate(eta).expect("an axis of indices"));
    axis.nodes = cut(&axis.nodes, from, to);
    axis
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
        axes[3] = Axis { mapping: VIEW, nodes: Axis::uniform_nodes(2 * spec.views - 1), ..axes[3].clone() };
    }
    let etas: Vec<f64> = match ends {
        // Not through the coordinate and back.
        [min, max] if min == max => vec![min],
        _ => axes[2].nodes.iter().filter_map(|&t| axes[2].quantity(t)).collect(),
    };
    let views = |sigma, gamma, eta| {
        let view = &axes[3];
        let cos = |&t: &f64| match side {
            Side::Entering => view.view_cosine(sigma, gamma, t),
            Side::Leaving => view.critical_view_cosine(sigma, gamma, eta, t),
        };
        view.nodes.iter().filter_map(cos).collect()
    };
    let albedo = |model: &AlbedoIntegrator, sigma, eta, cos| side.albedo(model, sigma, eta, cos);
    let tables = shares(spec, &axes, &etas, views, albedo)?;
    let leaving = if side == Side::Leaving { "_leaving" } else { "" };
    let name = |masking: Masking| {
        let (kind, form) = (Kind::DielectricAlbedo.name(), masking.name().replace('-', "_"));
        format!("{kind}_{form}_{}{leaving}{}", fresnel.label(), spec.domain.suffix())
    };
    Ok(tables
        .into_iter()
        .map(|table| Table {
            name: name(table.masking.expect("shares are for one form")),
            kind: Kind::DielectricAlbedo,
            channels: side.channels().map(String::from).into(),
            ..table
        })
        .collect())
}
