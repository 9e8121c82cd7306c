//! Directional albedo and its average, for both forms of masking in one pass.
//!
//! Stored are E − 1 and the other moments less E times a mirror's, which vanish with σ; nodes stand evenly in coordinates found by measuring. The
//! averages are integrated from the stored, interpolated albedo, so that a white furnace closes to
//! rounding rather than to the interpolation error.

use std::fmt;

use rayon::prelude::*;

use microfacet_model::fresnel::{f82_weight, schlick_weight};
use microfacet_model::{Albedo, AlbedoIntegrator, ParameterError, Shape};
use microfacet_sampler::axis::lagrange::nodes_read;
use microfacet_sampler::axis::{LogRoughness, LogShape, ViewBlend, even_nodes};
use microfacet_sampler::{
    Axis, FresnelEntry, Interpolation, Kind, LoadError, Mapping, Masking, Precision, Table, Tables,
};

use super::{dielectric_albedo, names};
use crate::scene::Interval;
use crate::spec::{GAMMA_MIN, Quality};

/// Smallest σ node; what is smoother is a mirror.
const SIGMA_MIN: f64 = LogRoughness::BAKED.first;
/// Largest σ of the general tables.
pub const SIGMA_MAX: f64 = 3.0;
/// The materials that tables are baked for: they are measured there, and need hold nowhere else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Shapes.
    pub gamma: Interval,
    /// Roughnesses, σx = σy.
    pub sigma: Interval,
}

impl Domain {
    /// γ ∈ [1.501, ∞] and σ ∈ [0, 3].
    pub const GENERAL: Self = Self {
        gamma: Interval { min: GAMMA_MIN, max: f64::INFINITY },
        sigma: Interval { min: 0.0, max: SIGMA_MAX },
    };

    /// Whether every material of `other` is one of this.
    pub fn contains(&self, other: &Self) -> bool {
        let within = |a: Interval, b: Interval| a.contains(b.min) && a.contains(b.max);
        within(self.gamma, other.gamma) && within(self.sigma, other.sigma)
    }

    /// The smallest that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { gamma: self.gamma.union(other.gamma), sigma: self.sigma.union(other.sigma) }
    }

    /// What the names of tables end in; nothing for the general ones.
    pub(super) fn suffix(&self) -> String {
        let part = |name: &str, Interval { min, max }: Interval| {
            if min == max { format!("_{name}_{min}") } else { format!("_{name}_{min}_to_{max}") }
        };
        if *self == Self::GENERAL {
            String::new()
        } else {
            part("gamma", self.gamma) + &part("sigma", self.sigma)
        }
    }
}

/// A pair of albedo tables to bake for each of some forms of masking.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoSpec {
    /// What the tables are for.
    pub domain: Domain,
    /// An exact reflectance, baked by [`fresnel_albedo`](super::fresnel_albedo) or [`dielectric_albedo`]; `None` are the moments.
    pub fresnel: Option<FresnelEntry>,
    /// The forms; both cost hardly more than one.
    pub maskings: Vec<Masking>,
    /// Nodes of the γ axis, ascending in its coordinate.
    pub shapes: Vec<f64>,
    /// Nodes of the σ axis.
    pub roughnesses: Vec<f64>,
    /// How many nodes the view axis has, six or more.
    pub views: usize,
    /// The coordinate of the view.
    pub view: ViewBlend,
    /// How many nodes an axis of all indices of refraction has.
    pub indices: usize,
    /// Error aimed at in every node.
    pub tolerance: f64,
    /// How values are stored.
    pub precision: Precision,
}

impl AlbedoSpec {
    /// For [`Domain::GENERAL`] and both forms of masking.
    ///
    /// Draft tables err by up to 1e-2.
    pub fn general(quality: Quality, precision: Precision) -> Self {
        let ([shapes, roughnesses, views, indices], view, tolerance) = match quality {
            Quality::Draft => ([16, 22, 20, 20], ViewBlend::BAKED, 1e-5),
            Quality::Default => ([22, 35, 26, 32], ViewBlend::BAKED, 1e-6),
            Quality::High => ([44, 68, 58, 48], ViewBlend::CLOSE, 1e-7),
        };
        Self {
            domain: Domain::GENERAL,
            fresnel: None,
            maskings: Masking::ALL.into(),
            shapes: even_nodes(shape(f64::INFINITY), shape(GAMMA_MIN), shapes),
            roughnesses: even_nodes(roughness(SIGMA_MIN), roughness(SIGMA_MAX), roughnesses),
            views,
            view,
            indices,
            tolerance,
            precision,
        }
    }

    /// The part of general tables that a domain needs: one node for a single γ or σ, else the nodes that are read there, so that the
    /// values in between are those of the general tables.
    #[must_use]
    pub fn part(&self, domain: Domain, maskings: &[Masking]) -> Self {
        let Domain { gamma, sigma } = domain;
        let shapes = cut(&self.shapes, shape(gamma.max), shape(gamma.min));
        // What is smoother than the first node is a mirror.
        let sigma = if sigma.min < SIGMA_MIN {
            Interval { min: SIGMA_MIN, max: sigma.max.max(2.0 * SIGMA_MIN) }
        } else {
            sigma
        };
        let roughnesses = cut(&self.roughnesses, roughness(sigma.min), roughness(sigma.max));
        Self { domain, maskings: maskings.into(), shapes, roughnesses, ..self.clone() }
    }

    /// Places (γ, σ, view) at which the albedo is integrated; of a dielectric (γ, σ, η, view), of both sides together.
    pub fn nodes(&self) -> usize {
        let materials = self.shapes.len() * self.roughnesses.len();
        match self.fresnel.as_ref().and_then(FresnelEntry::indices) {
            Some(ends) => {
                materials * dielectric_albedo::indices(self.indices, ends).len() * (3 * self.views - 1)
            }
            None => materials * self.views,
        }
    }

    /// How many tables it makes.
    pub fn tables(&self) -> usize {
        let of_form = match self.fresnel.map(|fresnel| fresnel.indices()) {
            // The moments and their averages; a dielectric from either side, unless both are one.
            None => 2,
            Some(Some(ends)) if ends != [1.0; 2] => 2,
            Some(_) => 1,
        };
        of_form * self.maskings.len()
    }

    /// Bytes of the values as they are stored.
    pub fn bytes(&self) -> usize {
        let one = self.precision.bytes();
        match &self.fresnel {
            None => {}
            Some(fresnel) if fresnel.indices().is_none() => {
                return Kind::RGB.len() * one * self.maskings.len() * self.nodes();
            }
            // As many channels from one side as, with twice the views, from the other.
            Some(_) => return Kind::ENTERING.len() * one * self.maskings.len() * self.nodes(),
        }
        let averages = Precision::F32.bytes() * self.shapes.len() * self.roughnesses.len();
        Kind::MOMENTS.len() * self.maskings.len() * (one * self.nodes() + averages)
    }
}

/// The nodes that the polynomial reads anywhere in [from, to]; a single value is a node itself.
pub(super) fn cut(nodes: &[f64], from: f64, to: f64) -> Vec<f64> {
    if from == to { vec![from] } else { nodes_read(nodes, from, to, INTERPOLATION.window()).to_vec() }
}

/// Along every axis.
pub(super) const INTERPOLATION: Interpolation = Interpolation::Lagrange6;

/// The coordinate of a roughness.
fn roughness(sigma: f64) -> f64 {
    LogRoughness::BAKED.coordinate(sigma)
}

/// The coordinate of a shape.
fn shape(gamma: f64) -> f64 {
    LogShape::BAKED.coordinate(gamma)
}

/// Why a bake gave up.
#[derive(Clone, Debug, PartialEq)]
pub enum BakeError {
    /// A parameter outside the domain of the model.
    Parameter(ParameterError),
    /// A node whose E is not a number, or above 1 by more than its error: a fault of the quadrature, which must not reach a table.
    Albedo {
        /// Where, as σ, γ and cos θ.
        at: [f64; 3],
        /// The value.
        value: f64,
    },
    /// A node whose error estimate stayed above the tolerance.
    Accuracy {
        /// Where, as σ, γ and cos θ.
        at: [f64; 3],
        /// The estimate.
        error: f64,
    },
    /// Any of these at one azimuth of a lobe that is not round, with the roughness seen from there for σ.
    Azimuth {
        /// Which lobe, as in the name of its table.
        lobe: String,
        /// The azimuth, radians.
        phi: f64,
        /// What.
        why: Box<BakeError>,
    },
    /// The tables would not load.
    Table(LoadError),
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |[sigma, gamma, cos]: &[f64; 3]| format!("sigma {sigma}, gamma {gamma}, cos_theta {cos}");
        match self {
            Self::Parameter(why) => why.fmt(f),
            Self::Albedo { at, value } => {
                write!(f, "albedo {value} at {}: it must lie in [0, 1]; please report it", place(at))
            }
            Self::Accuracy { at, error } => {
                write!(f, "quadrature error {error:e} at {}: raise the tolerance", place(at))
            }
            Self::Azimuth { lobe, phi, why } => write!(f, "{lobe}, azimuth {phi}: {why}"),
            Self::Table(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for BakeError {}

impl From<ParameterError> for BakeError {
    fn from(why: ParameterError) -> Self {
        Self::Parameter(why)
    }
}

impl From<LoadError> for BakeError {
    fn from(why: LoadError) -> Self {
        Self::Table(why)
    }
}

/// The Fresnel weights of the channels: Schlick scale, Schlick bias and F82.
pub fn weights(cos: f64) -> [f64; 3] {
    let bias = schlick_weight(cos);
    [1.0 - bias, bias, f82_weight(cos)]
}

/// Bakes `albedo` and `albedo_average` for both forms of masking, four tables in all.
///
/// Each `albedo` table has `quadrature_error`, the largest error estimate of a node, in its certificate.
///
/// # Errors
/// [`BakeError`] if a node is not a sound albedo or not accurate enough, or the specification is out of the domain.
pub fn bake(spec: &AlbedoSpec) -> Result<Vec<Table>, BakeError> {
    Ok(bake_in(spec, &[spec.precision])?.concat())
}

/// The same in each of some precisions, from one pass over the nodes, which takes nearly all the time.
///
/// # Errors
/// As [`bake`].
pub fn bake_in(spec: &AlbedoSpec, precisions: &[Precision]) -> Result<Vec<Vec<Table>>, BakeError> {
    let axes = axes(spec);
    let (gammas, sigmas) = (axes[0].quantities(), axes[1].quantities());
    let integrators = gammas
        .par_iter()
        .map(|&gamma| Ok(AlbedoIntegrator::new(Shape::new(gamma)?, spec.tolerance)))
        .collect::<Result<Vec<_>, ParameterError>>()?;
    let pairs: Vec<_> =
        integrators.iter().flat_map(|shape| sigmas.iter().map(move |&sigma| (shape, sigma))).collect();
    let rows = pairs
        .par_iter()
        .map(|&(shape, sigma)| {
            let view = spec.view.bind(sigma, shape.shape().gamma());
            let at = |&t: &f64| node(shape, sigma, view.quantity(t), spec.tolerance);
            axes[2].nodes.iter().map(at).collect()
        })
        .collect::<Result<Vec<Vec<Albedo<3>>>, BakeError>>()?;
    let error = rows.iter().flatten().map(|node| node.error).fold(0.0, f64::max);
    let rounded = |&precision: &Precision| {
        let mut tables = Vec::new();
        for &masking in &spec.maskings {
            let values = rows.iter().flatten().flat_map(|node| node.of(masking).map(|x| x as f32)).collect();
            let stored = AlbedoSpec { precision, ..spec.clone() };
            let directional = Table {
                certificate: [("quadrature_error".to_string(), error)].into(),
                ..table(&stored, Kind::Albedo, masking, axes.clone(), values)
            };
            let set = Tables::from_tables(Default::default(), vec![directional.clone()])?;
            let average = |&(shape, sigma): &(&AlbedoIntegrator, f64)| {
                let bound = set.albedo(sigma, shape.shape().gamma(), masking).expect("nodes are covered");
                bound.integrate()
            };
            let values = pairs.iter().flat_map(average).collect();
            tables.push(directional);
            let single = AlbedoSpec { precision: Precision::F32, ..spec.clone() };
            tables.push(table(&single, Kind::AlbedoAverage, masking, axes[..2].to_vec(), values));
        }
        Ok(tables)
    };
    precisions.iter().map(rounded).collect()
}

fn table(spec: &AlbedoSpec, kind: Kind, masking: Masking, axes: Vec<Axis>, values: Vec<f32>) -> Table {
    Table {
        name: kind.table_name(Some(masking), &spec.domain.suffix()),
        kind,
        axes,
        channels: names(Kind::MOMENTS),
        masking: Some(masking),
        values,
        precision: spec.precision,
        certificate: Default::default(),
    }
    .rounded(spec.precision)
}

/// What a node holds at σ and cos θ.
fn node(shape: &AlbedoIntegrator, sigma: f64, cos: f64, tolerance: f64) -> Result<Albedo<3>, BakeError> {
    residual(&shape.reflection(sigma, cos, weights)?, [sigma, shape.shape().gamma(), cos], tolerance)
}

/// What a node holds of an albedo, at σ, γ and cos θ: E − 1, and what the other moments have over a mirror's times E.
pub(super) fn residual(albedo: &Albedo<3>, at: [f64; 3], tolerance: f64) -> Result<Albedo<3>, BakeError> {
    if !(albedo.error <= tolerance) {
        return Err(BakeError::Accuracy { at, error: albedo.error });
    }
    let mirror = weights(at[2]);
    let less_mirror = |mut form: [f64; 3]| {
        let value = form[0] + form[1];
        // Not clamped: a wrong sum must be seen. Near normal incidence on a smooth surface 1 − E is far below what quadrature is asked for.
        if !(value >= 0.0 && value <= 1.0 + tolerance) {
            return Err(BakeError::Albedo { at, value });
        }
        for (x, mirror) in form.iter_mut().zip(mirror) {
            *x -= value * mirror;
        }
        form[0] = value - 1.0;
        Ok(form)
    };
    Ok(Albedo {
        uncorrelated: less_mirror(albedo.uncorrelated)?,
        height_correlated: less_mirror(albedo.height_correlated)?,
        error: albedo.error,
    })
}

/// The axes: γ, σ and the view.
pub fn axes(spec: &AlbedoSpec) -> Vec<Axis> {
    let axis = |name: &str, mapping, nodes: &[f64]| Axis::new(name, mapping, INTERPOLATION, nodes.to_vec());
    vec![
        axis("gamma", Mapping::LogShape(LogShape::BAKED), &spec.shapes),
        axis("sigma", Mapping::LogRoughness(LogRoughness::BAKED), &spec.roughnesses),
        Axis::placed("view", Mapping::ViewBlend(spec.view), INTERPOLATION, spec.views),
    ]
}
