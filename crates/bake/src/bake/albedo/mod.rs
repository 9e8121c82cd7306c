//! Bakes directional albedos of any lobe under any reflectance, for both forms of masking in one
//! pass over the nodes: [`Model`] is the lobe by quadrature, [`Integrand`] the reflectance.
//!
//! For the moments a table holds E − 1 and, of the other moments, their excess over E times a
//! mirror's, all of which vanish with σ; for exact reflectances it holds the shares of light.
//! Averages are integrated from the stored, interpolated albedo, so that a white furnace closes to
//! rounding rather than to the interpolation error.

mod albedo_spec;
mod coarse;
mod integrand;
mod lobe;

use std::collections::HashMap;
use std::fmt;

use glam::Vec3;
use rayon::prelude::*;

use microfacet_model::{Albedo, ParameterError};
use microfacet_sampler::albedo::Albedo as TabulatedAlbedo;
use microfacet_sampler::{Masking, MaterialError};
use microfacet_tables::{
    Axis, Certificate, Kind, LoadError, Mapping, Precision, Reflectance, Table,
};

use crate::progress::Stage;

pub use albedo_spec::AlbedoSpec;
pub use coarse::CoarseNodes;
pub use integrand::{Integrand, weights};
pub use lobe::{AlbedoLobe, Model, Models};
pub(crate) use lobe::{area_ratio, ellipsoid, stated};

/// Most channels of any integrand.
pub const CHANNELS: usize = 3;

/// A material and a view, as given by coordinates along the axes of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// γ, for tables with such an axis; else ∞, since their view coordinate does not depend on γ.
    pub gamma: f64,
    /// σ, or the roughness of a lobe along the azimuth.
    pub sigma: f64,
    /// Index of the dense side of a dielectric over that of the thin side.
    pub eta: f64,
    /// Azimuth of the view, radians.
    pub phi: f64,
    /// cos θ of the view.
    pub cos: f64,
}

impl Site {
    /// The site at these coordinates, one for each axis.
    pub fn new(axes: &[Axis], at: &[f64]) -> Self {
        let mut site =
            Self { gamma: f64::INFINITY, sigma: f64::NAN, eta: f64::NAN, phi: 0.0, cos: f64::NAN };
        for (axis, &t) in axes.iter().zip(at) {
            let quantity = || axis.quantity(t).expect("an axis of a quantity");
            match axis.mapping {
                Mapping::LogShape(_) => site.gamma = quantity(),
                Mapping::LogRoughness(_) => site.sigma = quantity(),
                Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => site.eta = quantity(),
                Mapping::Azimuth(azimuth) => {
                    let azimuth = azimuth.prepare(axis.len());
                    let [c, s] = azimuth.direction(t);
                    (site.phi, site.sigma) = (azimuth.quantity(t), azimuth.sigma(c, s));
                }
                _ => site.cos = site.cos_at(axis, t),
            }
        }
        site
    }

    /// cos θ at a coordinate along the axis of the view, for the material of the site.
    pub(crate) fn cos_at(&self, axis: &Axis, t: f64) -> f64 {
        match axis.mapping {
            Mapping::ViewBlend(view) => view.prepare(self.sigma, self.gamma).quantity(t),
            Mapping::CriticalBlend(view) => {
                view.prepare(self.sigma, self.gamma, 1.0 / self.eta).quantity(t)
            }
            _ => unreachable!("no axis of a view"),
        }
    }

    /// The direction of the view.
    pub fn view(&self) -> Vec3 {
        let sin = ((1.0 - self.cos) * (1.0 + self.cos)).sqrt();
        let (s, c) = libm::sincos(self.phi);
        Vec3::new((sin * c) as f32, (sin * s) as f32, self.cos as f32)
    }

    /// The bits of all quantities.
    fn key(&self) -> [u64; 5] {
        [self.gamma, self.sigma, self.eta, self.phi, self.cos].map(f64::to_bits)
    }

    /// The sites of all nodes, the last axis fastest.
    pub fn all(axes: &[Axis]) -> Vec<Self> {
        let (view, materials) = axes.split_last().expect("the view is an axis");
        let of_material = |at: Vec<f64>| {
            let material = Self::new(materials, &at);
            view.nodes.iter().map(move |&t| Self { cos: material.cos_at(view, t), ..material })
        };
        product(materials.iter().map(|axis| &axis.nodes[..]))
            .into_par_iter()
            .flat_map_iter(of_material)
            .collect()
    }
}

/// All combinations of one number of each list, those of the last fastest.
pub(crate) fn product<'a>(lists: impl IntoIterator<Item = &'a [f64]>) -> Vec<Vec<f64>> {
    lists.into_iter().fold(vec![Vec::new()], |all, list| {
        let longer =
            |at: &Vec<f64>| list.iter().map(|&x| [&at[..], &[x]].concat()).collect::<Vec<_>>();
        all.iter().flat_map(longer).collect()
    })
}

impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { gamma, sigma, eta, phi, cos } = self;
        write!(f, "sigma {sigma}, gamma {gamma}, cos_theta {cos}, azimuth {phi}")?;
        if eta.is_nan() { Ok(()) } else { write!(f, ", eta {eta}") }
    }
}

/// Why a bake of albedos failed.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum AlbedoError {
    /// A parameter outside the domain of the model.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A node whose E is NaN, or above 1 by more than its error estimate: a fault of the
    /// quadrature, which must not reach a table.
    #[error("albedo {value} at {at}: it must lie in [0, 1]; please report it")]
    Albedo {
        /// The site of the node.
        at: Site,
        /// The value.
        value: f64,
    },
    /// A node whose error estimate exceeds what is allowed.
    #[error(
        "the quadrature of an albedo reaches only {error:e} at {at}; keep such materials out of the \
         recipe's ranges of sigma and gamma, and please report it"
    )]
    Accuracy {
        /// The site of the node.
        at: Site,
        /// The estimate.
        error: f64,
    },
    /// The lobe has no such albedo.
    #[error("{0}")]
    Lobe(String),
    /// A table does not cover the material that it was baked for.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The tables could not be loaded.
    #[error(transparent)]
    Table(#[from] LoadError),
}

microfacet_core::debug_in_words!(AlbedoError);

/// Bakes the tables of a specification: a directional albedo for each form of masking and, for the
/// moments of the family, their averages.
///
/// The certificate of each directional table has `quadrature_error`, the largest error estimate of
/// a node.
///
/// # Errors
/// [`AlbedoError`] if a node is no valid albedo or not accurate enough, or the specification lies
/// outside the domain.
pub fn bake(spec: &AlbedoSpec) -> Result<Vec<Table>, AlbedoError> {
    let kept = &mut Nodes::default();
    Ok(bake_in(spec, &[spec.precision], kept, &Stage::unwatched())?.concat())
}

/// Bakes the tables in several precisions from one pass over the nodes, which takes nearly all the
/// time; each node that is not among those `kept` is one step of the stage. What is kept has to be
/// of the same lobe, reflectance and tolerance, as of a table that this one
/// [refines](AlbedoSpec::refined).
pub fn bake_in(
    spec: &AlbedoSpec,
    precisions: &[Precision],
    kept: &mut Nodes,
    stage: &Stage,
) -> Result<Vec<Vec<Table>>, AlbedoError> {
    let sites = Site::all(&spec.axes);
    let new: Vec<&Site> = sites.iter().filter(|site| !kept.0.contains_key(&site.key())).collect();
    stage.split(new.len());
    let integrand = Integrand::new(&spec.reflectance)?;
    let integrated = |sites: &[&Site], tolerance: f64| {
        let gammas = sites.iter().map(|site| site.gamma);
        Models::with(&spec.lobe, gammas, tolerance, |models| {
            let of = |site: &&Site| {
                let node = node(spec, &integrand, models.at(site), site)?;
                stage.step();
                Ok((site.key(), node))
            };
            sites.par_iter().map(of).collect::<Result<Vec<_>, AlbedoError>>()
        })
    };
    let is_smooth = |site: &&Site| spec.lobe.is_family() && site.sigma < SMOOTH;
    let (smooth, rough): (Vec<&Site>, Vec<&Site>) = new.into_iter().partition(is_smooth);
    kept.0.extend(integrated(&rough, spec.tolerance)?);
    if !smooth.is_empty() {
        kept.0.extend(integrated(&smooth, OF_SMOOTH * spec.tolerance)?);
    }
    let nodes: Vec<Node> = sites.iter().map(|site| kept.0[&site.key()]).collect();
    let rounded = |&precision: &Precision| {
        let spec = AlbedoSpec { precision, ..spec.clone() };
        let tables = spec.maskings.iter().map(|&masking| tables(&spec, &nodes, masking));
        Ok(tables.collect::<Result<Vec<_>, AlbedoError>>()?.concat())
    };
    precisions.iter().map(rounded).collect()
}

/// Nodes that were integrated: a table with more nodes along an axis has those of the table before.
#[derive(Default)]
pub struct Nodes(HashMap<[u64; 5], Node>);

/// The values of a node for both forms of masking, and their error estimate.
#[derive(Clone, Copy)]
struct Node {
    values: Albedo<CHANNELS>,
    /// μ/(μ + A), for lobes whose G1(v) is clamped.
    clamp: Option<f64>,
}

/// σ of surfaces that lose so little light that the error aimed at for others is a share of it,
/// which their compensation would lack, and the error they aim at, as a multiple of that of others.
/// Without it a compensated furnace at σ < 1e-5 returns 1.4e-2 too much or too little, with it 5e-3
/// (`white_furnaces_close` in `crates/sampler/tests/family_albedo.rs`).
const SMOOTH: f64 = 1e-4;
const OF_SMOOTH: f64 = 0.1;

/// Error allowed in a node, as a multiple of the one aimed at. Narrow lobes with long tails at
/// grazing views, and the kinks of clamped masking and of total reflection, take the quadrature to
/// its last order; the worst of `tables/recipes/brushed-metals.toml` reaches 26. The certificate
/// states what was reached.
const SLACK: f64 = 100.0;
/// Where less than this share of the microsurface is visible, E is smaller still, and the quotient
/// of both is not meaningful.
const UNSEEN: f64 = 1e-6;

fn node(
    spec: &AlbedoSpec,
    integrand: &Integrand,
    model: &Model<'_>,
    site: &Site,
) -> Result<Node, AlbedoError> {
    let mut values = integrand.at(model, site)?;
    let ratio = model.area_ratio(site);
    let clamp = ratio.map(|ratio| 1.0 / (1.0 + ratio));
    // The clamp of G1(v) leaves this factor in the shares, which is divided out.
    let share = ratio.unwrap_or(1.0).min(1.0);
    if share < UNSEEN {
        (values.uncorrelated, values.height_correlated) = Default::default();
        return Ok(Node { values, clamp });
    }
    if !(values.error <= SLACK * spec.tolerance) {
        return Err(AlbedoError::Accuracy { at: *site, error: values.error });
    }
    for form in [&mut values.uncorrelated, &mut values.height_correlated] {
        form.iter_mut().for_each(|x| *x /= share);
        let sound = |x: f64| {
            x >= -values.error / share && x <= 1.0 + (values.error + spec.tolerance) / share
        };
        // Checked before clamping, which would hide a wrong sum.
        match spec.reflectance {
            Reflectance::Mirror => {
                let e = form[0] + form[1];
                if !sound(e) {
                    return Err(AlbedoError::Albedo { at: *site, value: e });
                }
                let mirror = weights(site.cos);
                // Near normal incidence on a smooth surface 1 − E is far below the quadrature's
                // tolerance.
                *form = [e - 1.0, form[1] - e * mirror[1], form[2] - e * mirror[2]];
            }
            _ => {
                if let Some(&value) = form.iter().find(|x| !sound(**x)) {
                    return Err(AlbedoError::Albedo { at: *site, value });
                }
                // Out of range by no more than the error of the quadrature.
                form.iter_mut().for_each(|x| *x = x.clamp(0.0, 1.0));
            }
        }
    }
    Ok(Node { values, clamp })
}

fn tables(spec: &AlbedoSpec, nodes: &[Node], masking: Masking) -> Result<Vec<Table>, AlbedoError> {
    let channels = spec.reflectance.channels().len();
    let values = |node: &Node| {
        node.values.of(masking)[..channels].iter().copied().chain(node.clamp).collect::<Vec<f64>>()
    };
    let (name, subject) = (spec.name(Kind::Albedo, masking), spec.subject(masking));
    let values = nodes.iter().flat_map(values).map(|x| x as f32).collect();
    let directional = Table::new(name, Kind::Albedo, subject, spec.axes.clone(), values)
        .with_certificate(Certificate {
            quadrature: Some(nodes.iter().map(|node| node.values.error).fold(0.0, f64::max)),
            ..Certificate::default()
        })
        .rounded(spec.precision);
    let average = spec.has_averages().then(|| average(spec, &directional, masking)).transpose()?;
    Ok([directional].into_iter().chain(average).collect())
}

/// The averages of a table of moments over γ, σ and the view.
fn average(spec: &AlbedoSpec, directional: &Table, masking: Masking) -> Result<Table, AlbedoError> {
    directional.validate()?;
    let axes = spec.axes[..2].to_vec();
    let (gammas, sigmas) = (axes[0].quantities(), axes[1].quantities());
    // The averages also cover the outer nodes, which the table's own range leaves out.
    let mut whole = directional.clone();
    whole.subject.lobe = spec.everywhere();
    let at = |(gamma, sigma): (f64, f64)| {
        Ok(TabulatedAlbedo::from_table(&whole, sigma, gamma)?.average_channels())
    };
    let pairs = gammas.iter().flat_map(|&gamma| sigmas.iter().map(move |&sigma| (gamma, sigma)));
    let values = pairs.map(at).collect::<Result<Vec<_>, MaterialError>>()?.concat();
    let (name, kind) = (spec.name(Kind::AlbedoAverage, masking), Kind::AlbedoAverage);
    Ok(Table::new(name, kind, directional.subject.clone(), axes, values))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table_spec::Level;

    #[test]
    fn a_finer_table_keeps_all_nodes_of_the_one_before() {
        let upright = AlbedoLobe::student_t([0.3, 0.2], 3.0);
        let tilted = AlbedoLobe { theta: Some([0.1, -0.2, 0.5]), ..upright.clone() };
        for lobe in [upright, tilted] {
            let maskings = vec![Masking::HeightCorrelated];
            let (mirror, precision) = (Reflectance::Mirror, Precision::F32);
            let coarse = AlbedoSpec::new(lobe, mirror, maskings, Level::DRAFT, precision).unwrap();
            let bake_in = |spec: &AlbedoSpec, kept: &mut Nodes| {
                bake_in(spec, &[precision], kept, &Stage::unwatched()).unwrap()
            };
            for axis in coarse.refinable() {
                let fine = coarse.refined(axis);
                let mut kept = Nodes::default();
                bake_in(&coarse, &mut kept);
                assert_eq!(kept.0.len(), coarse.nodes());
                let with_it = bake_in(&fine, &mut kept);
                // None of the first table's nodes is at another place.
                assert_eq!(kept.0.len(), fine.nodes());
                assert!(with_it == bake_in(&fine, &mut Nodes::default()));
            }
        }
    }
}
