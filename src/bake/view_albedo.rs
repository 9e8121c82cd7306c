//! Directional albedo of one material over cos θ and the azimuth of the view: of lobes that are not round, and over cos θ alone of
//! distributions outside the family.
//!
//! Stored in the form of the other albedo tables. The view's coordinate is theirs with the roughness σ_φ seen from the azimuth in the place of σ, and
//! azimuths stand evenly in a circle that is stretched by the square roots of the two roughnesses: found by measuring (`docs/albedo.md`).

use glam::DVec3;
use rayon::prelude::*;

use microfacet_model::classic::{Marginal, RadialAlbedo};
use microfacet_model::{Albedo, AlbedoIntegrator, Ellipsoid, EllipsoidError, ParameterError, Shape};
use microfacet_sampler::axis::{Azimuth, BoundAzimuth, ViewBlend};
use microfacet_sampler::{Axis, Channels, Kind, LoadError, Mapping, Masking, Precision, Table};

use super::albedo::{BakeError, INTERPOLATION, residual, weights};
use super::names;
use crate::family::Distribution;
use crate::spec::Quality;

/// Error allowed in a node, in units of the one aimed at: narrow lobes with heavy tails, seen at grazing, are slower than round ones.
const SLACK: f64 = 100.0;

/// The normals of one material.
#[derive(Clone, Debug, PartialEq)]
pub enum Lobe {
    /// An anisotropic Student-t.
    StudentT {
        /// σx and σy.
        sigma: [f64; 2],
        /// γ.
        gamma: f64,
    },
    /// A tilted one.
    Ellipsoid {
        /// σx and σy, and the turn, radians; see [`Ellipsoid::new`].
        sigma: [f64; 2],
        /// θx, θy and θz.
        theta: [f64; 3],
        /// γ.
        gamma: f64,
    },
    /// An isotropic distribution outside the family.
    Radial {
        /// Which.
        distribution: Distribution,
        /// Its median slope.
        sigma: f64,
    },
}

impl Lobe {
    /// The mapping of its azimuths.
    ///
    /// # Errors
    /// [`BakeError`] for an ellipsoid that is none.
    fn azimuth(&self) -> Result<Azimuth, BakeError> {
        Ok(match *self {
            Self::StudentT { sigma, .. } => Azimuth { sigma, turn: 0.0, fold: true },
            Self::Radial { sigma, .. } => Azimuth { sigma: [sigma; 2], turn: 0.0, fold: true },
            Self::Ellipsoid { sigma, theta, gamma } => {
                let (sigma, turn) = spread(&ellipsoid(sigma, theta, gamma)?);
                Azimuth { sigma, turn, fold: false }
            }
        })
    }

    /// The shape whose tail masking has; κ of the view's coordinate follows it. Of distributions outside the family it is not known, and that
    /// of a short one serves.
    fn gamma(&self) -> f64 {
        match *self {
            Self::StudentT { gamma, .. } | Self::Ellipsoid { gamma, .. } => gamma,
            Self::Radial { .. } => f64::INFINITY,
        }
    }

    /// σ of the round lobe that usually stands in for it.
    pub fn stand_in(&self) -> Option<f64> {
        match *self {
            Self::StudentT { sigma: [x, y], .. } | Self::Ellipsoid { sigma: [x, y], .. } => {
                Some((x * y).sqrt())
            }
            Self::Radial { .. } => None,
        }
    }
}

fn invalid(why: impl ToString) -> BakeError {
    BakeError::Table(LoadError::Invalid(why.to_string()))
}

fn ellipsoid([x, y]: [f64; 2], theta: [f64; 3], gamma: f64) -> Result<Ellipsoid, BakeError> {
    Ellipsoid::new(x, y, theta, gamma).map_err(|why: EllipsoidError| invalid(why))
}

/// How slopes spread about zero: the principal axes of σ_φ² + t_φ², roughness and mean slope seen from an azimuth, and the turn of the first.
///
/// A lobe that leans away masks, and one that leans forward reflects below the horizon, about where cot θ is its mean slope.
fn spread(ellipsoid: &Ellipsoid) -> ([f64; 2], f64) {
    let unit = ellipsoid.unit_matrix();
    let (p, q, r, [x, y]) = (unit.x_axis.x, unit.x_axis.y, unit.y_axis.y, [unit.x_axis.z, unit.y_axis.z]);
    let (a, b, c) = (p * p + q * q + x * x, q * r + x * y, r * r + y * y);
    let half = libm::hypot(0.5 * (a - c), b);
    let first = 0.5 * (a + c) + half;
    // The determinant without the cancellation of ac − b².
    let w = y / r;
    let u = (x - q * w) / p;
    let second = p * r * (p * r) * (1.0 + u * u + w * w) / first;
    ([first.sqrt(), second.sqrt()], 0.5 * libm::atan2(2.0 * b, a - c))
}

/// Its albedo by quadrature.
pub struct LobeAlbedo<'a> {
    integrator: Integrator<'a>,
    stand_in: Option<f64>,
}

enum Integrator<'a> {
    StudentT([f64; 2], AlbedoIntegrator),
    Ellipsoid(Ellipsoid, AlbedoIntegrator),
    Radial(RadialAlbedo<'a>),
}

impl LobeAlbedo<'_> {
    /// Prepares the lobe and does something with it; `tolerance` as of [`AlbedoIntegrator::new`].
    ///
    /// # Errors
    /// [`BakeError`] for parameters outside the domain, and what `then` reports.
    pub fn with<T>(
        lobe: &Lobe,
        tolerance: f64,
        then: impl FnOnce(&LobeAlbedo<'_>) -> Result<T, BakeError>,
    ) -> Result<T, BakeError> {
        let family = |gamma| Ok::<_, ParameterError>(AlbedoIntegrator::new(Shape::new(gamma)?, tolerance));
        let stand_in = lobe.stand_in();
        match lobe {
            &Lobe::StudentT { sigma, gamma } => {
                then(&LobeAlbedo { integrator: Integrator::StudentT(sigma, family(gamma)?), stand_in })
            }
            &Lobe::Ellipsoid { sigma, theta, gamma } => {
                let ellipsoid = ellipsoid(sigma, theta, gamma)?;
                then(&LobeAlbedo { integrator: Integrator::Ellipsoid(ellipsoid, family(gamma)?), stand_in })
            }
            Lobe::Radial { distribution, .. } => {
                let built = distribution.build().map_err(invalid)?;
                let marginal = Marginal::new(&*built);
                let integrator = Integrator::Radial(RadialAlbedo::new(&marginal, tolerance));
                then(&LobeAlbedo { integrator, stand_in })
            }
        }
    }

    /// The moments of [`weights`] for the view of cos θ and azimuth φ (radians).
    ///
    /// # Errors
    /// [`ParameterError`] for a roughness outside the family or cos θ outside [0, 1].
    pub fn at(&self, cos_theta: f64, phi: f64) -> Result<Albedo<3>, ParameterError> {
        match &self.integrator {
            Integrator::StudentT(sigma, model) => {
                model.reflection_anisotropic(*sigma, cos_theta, phi, weights)
            }
            Integrator::Ellipsoid(ellipsoid, model) => {
                model.reflection_skewed(ellipsoid, cos_theta, phi, weights)
            }
            Integrator::Radial(model) => model.reflection(cos_theta, weights),
        }
    }

    /// The share A/μ of the macrosurface's area that the microsurface shows, of a lobe that may be tilted; below one G1 is clamped.
    fn area_ratio(&self, cos: f64, phi: f64) -> Option<f64> {
        let Integrator::Ellipsoid(ellipsoid, _) = &self.integrator else { return None };
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        let (s, c) = libm::sincos(phi);
        Some(ellipsoid.projected_area(DVec3::new(sin * c, sin * s, cos)) / cos)
    }

    /// The same of the round lobe that usually stands in for it, at any azimuth; `None` if none does.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn stand_in(&self, cos_theta: f64) -> Result<Option<Albedo<3>>, ParameterError> {
        match &self.integrator {
            Integrator::StudentT(_, model) | Integrator::Ellipsoid(_, model) => {
                let albedo = |sigma| model.reflection(sigma, cos_theta, weights);
                self.stand_in.map(albedo).transpose()
            }
            Integrator::Radial(_) => Ok(None),
        }
    }
}

/// A table to bake.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewSpec {
    /// What for.
    pub lobe: Lobe,
    /// What its name ends in, after kind and masking.
    pub label: String,
    /// The form of masking.
    pub masking: Masking,
    /// Nodes of the azimuth: 2ᵏ + 1 on a quarter, 2ᵏ on the circle, or one.
    pub azimuths: usize,
    /// Nodes of the view, six or more.
    pub views: usize,
    /// Error aimed at in every node.
    pub tolerance: f64,
    /// How values are stored.
    pub precision: Precision,
}

impl ViewSpec {
    /// The smallest table that is tried at a quality.
    pub fn new(lobe: Lobe, label: String, masking: Masking, quality: Quality, precision: Precision) -> Self {
        let (azimuths, views, tolerance) = match quality {
            Quality::Draft => (5, 17, 1e-5),
            Quality::Default => (9, 33, 1e-6),
            Quality::High => (17, 65, 1e-7),
        };
        let azimuths = match lobe {
            Lobe::StudentT { .. } => azimuths,
            Lobe::Ellipsoid { .. } => 4 * (azimuths - 1),
            Lobe::Radial { .. } => 1,
        };
        Self { lobe, label, masking, azimuths, views, tolerance, precision }
    }

    /// With the azimuths twice as dense.
    #[must_use]
    pub fn with_more_azimuths(&self) -> Self {
        let azimuths = match self.lobe {
            Lobe::Ellipsoid { .. } => 2 * self.azimuths,
            _ => 2 * self.azimuths - 1,
        };
        Self { azimuths, ..self.clone() }
    }

    /// With the views twice as dense.
    #[must_use]
    pub fn with_more_views(&self) -> Self {
        Self { views: 2 * self.views - 1, ..self.clone() }
    }

    /// Places at which the albedo is integrated.
    pub fn nodes(&self) -> usize {
        self.azimuths * self.views
    }

    /// Bytes of the values as they are stored.
    pub fn bytes(&self) -> usize {
        self.channels().len() * self.precision.bytes() * self.nodes()
    }

    /// Names of the channels.
    fn channels(&self) -> Channels {
        if matches!(self.lobe, Lobe::Ellipsoid { .. }) { Kind::CLAMPED_MOMENTS } else { Kind::MOMENTS }
    }

    /// The name of the table.
    pub fn name(&self) -> String {
        Kind::ViewAlbedo.table_name(Some(self.masking), &self.label)
    }

    /// The axes: azimuth and view.
    ///
    /// # Errors
    /// [`BakeError`] for an ellipsoid that is none.
    pub fn axes(&self) -> Result<Vec<Axis>, BakeError> {
        let azimuth = Mapping::Azimuth(self.lobe.azimuth()?);
        Ok(vec![
            Axis { unit: "rad".into(), ..Axis::placed("azimuth", azimuth, INTERPOLATION, self.azimuths) },
            Axis::placed("view", Mapping::ViewBlend(self.view()), INTERPOLATION, self.views),
        ])
    }

    /// The coordinate of the azimuth.
    ///
    /// # Errors
    /// [`BakeError`] for an ellipsoid that is none.
    pub fn azimuth(&self) -> Result<BoundAzimuth, BakeError> {
        Ok(self.lobe.azimuth()?.bind(self.azimuths))
    }

    /// The coordinate of the view: γ is known, so that readers need none.
    fn view(&self) -> ViewBlend {
        ViewBlend::BAKED.of_shape(self.lobe.gamma())
    }
}

/// Bakes the table, with `quadrature_error`, the largest error estimate of a node, in its certificate.
///
/// # Errors
/// [`BakeError`] if a node is not a sound albedo or not right to a hundred times the tolerance, or the lobe is out of the domain.
pub fn bake(spec: &ViewSpec) -> Result<Table, BakeError> {
    LobeAlbedo::with(&spec.lobe, spec.tolerance, |model| bake_with(spec, model))
}

fn bake_with(spec: &ViewSpec, model: &LobeAlbedo<'_>) -> Result<Table, BakeError> {
    let axes = spec.axes()?;
    let azimuths = spec.azimuth()?;
    let places: Vec<(f64, f64, f64)> = axes[0]
        .nodes
        .iter()
        .flat_map(|&t| {
            let [c, s] = azimuths.direction(t);
            let (phi, sigma) = (azimuths.quantity(t), azimuths.sigma(c, s));
            let view = spec.view().bind_shaped(sigma);
            axes[1].nodes.iter().map(move |&t| (phi, sigma, view.quantity(t)))
        })
        .collect();
    let nodes = places
        .par_iter()
        .map(|&(phi, sigma, cos)| {
            let node = node(spec, model, sigma, cos, phi);
            node.map_err(|why| BakeError::Azimuth { lobe: spec.label.clone(), phi, why: Box::new(why) })
        })
        .collect::<Result<Vec<_>, BakeError>>()?;
    let error = nodes.iter().map(|node| node.1).fold(0.0, f64::max);
    let table = Table {
        name: spec.name(),
        kind: Kind::ViewAlbedo,
        axes,
        channels: names(spec.channels()),
        masking: Some(spec.masking),
        values: nodes.iter().flat_map(|node| &node.0).map(|&x| x as f32).collect(),
        precision: spec.precision,
        certificate: [("quadrature_error".to_string(), error)].into(),
    };
    Ok(table.rounded(spec.precision))
}

/// What a node holds, and its error estimate.
fn node(
    spec: &ViewSpec,
    model: &LobeAlbedo<'_>,
    sigma: f64,
    cos: f64,
    phi: f64,
) -> Result<(Vec<f64>, f64), BakeError> {
    /// Less than this of the microsurface is seen, E is less still, and the quotient of the two is none.
    const UNSEEN: f64 = 1e-6;
    let at = [sigma, spec.lobe.gamma(), cos];
    let albedo = model.at(cos, phi)?;
    let ratio = model.area_ratio(cos, phi);
    // What the clamp of G1(v) leaves, taken out of E.
    let share = ratio.unwrap_or(1.0).min(1.0);
    let moments = if share < UNSEEN {
        [0.0; 3]
    } else {
        let free = |moments: [f64; 3]| moments.map(|x| x / share);
        let free = Albedo {
            uncorrelated: free(albedo.uncorrelated),
            height_correlated: free(albedo.height_correlated),
            error: albedo.error / share,
        };
        residual(&free, at, SLACK * spec.tolerance / share)?.of(spec.masking)
    };
    let clamp = ratio.map(|ratio| 1.0 / (1.0 + ratio));
    Ok((moments.into_iter().chain(clamp).collect(), albedo.error))
}
