//! The lobes that albedos are baked of, and their quadrature: **to add one, add it here** and to
//! [`LobeEntry`](microfacet_sampler::LobeEntry).

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use microfacet_common::shape::s_of_gamma;
use microfacet_model::classic::{Marginal, RadialAlbedo};
use microfacet_model::{
    Albedo, AlbedoIntegrator, Ellipsoid, EllipsoidError, ParameterError, Shape, Skew,
};
use microfacet_sampler::LobeEntry;
use microfacet_sampler::axis::Azimuth;

use super::{AlbedoError, CHANNELS, Domain, Site};
use crate::distribution::Distribution;

/// Whose normals.
#[derive(Clone, Debug, PartialEq)]
pub enum AlbedoLobe {
    /// Round members of the Student-t family.
    Family(Domain),
    /// An anisotropic one.
    StudentT {
        /// σx and σy.
        sigma: [f64; 2],
        /// γ.
        gamma: f64,
    },
    /// A tilted one.
    Ellipsoid {
        /// σx and σy, and the turn, radians; see [`Skew::new`].
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

impl AlbedoLobe {
    /// What the description of its tables says.
    pub fn entry(&self) -> LobeEntry {
        match *self {
            Self::Family(_) => LobeEntry::Family,
            Self::StudentT { sigma, gamma } => LobeEntry::StudentT { sigma, s: s_of_gamma(gamma) },
            Self::Ellipsoid { sigma, theta, gamma } => {
                LobeEntry::Ellipsoid { sigma, theta, s: s_of_gamma(gamma) }
            }
            Self::Radial { ref distribution, .. } => LobeEntry::Distribution(distribution.label()),
        }
    }

    /// What tells it from others, in names of tables and for people; nothing for the general family.
    pub fn label(&self) -> String {
        let turn = |[x, y, z]: [f64; 3]| format!("_theta_{x}_{y}_{z}");
        match self {
            Self::Family(domain) => domain.label(),
            Self::StudentT { sigma: [x, y], gamma } => format!("gamma_{gamma}_sigma_{x}_{y}"),
            Self::Ellipsoid { sigma: [x, y], theta, gamma } => {
                format!("gamma_{gamma}_sigma_{x}_{y}{}", turn(*theta))
            }
            Self::Radial { distribution, .. } => crate::bake::in_names(&distribution.label()),
        }
    }

    /// The mapping of its azimuths; `None` of the family, whose albedo does not depend on any.
    ///
    /// # Errors
    /// [`AlbedoError`] for an ellipsoid that is none.
    pub(super) fn azimuth(&self) -> Result<Option<Azimuth>, AlbedoError> {
        let plain = |sigma| Some(Azimuth { sigma, turn: 0.0, fold: true });
        Ok(match *self {
            Self::Family(_) => None,
            Self::StudentT { sigma, .. } => plain(sigma),
            Self::Radial { sigma, .. } => plain([sigma; 2]),
            Self::Ellipsoid { sigma, theta, gamma } => {
                let (sigma, turn) = spread(&ellipsoid(sigma, theta, gamma)?);
                Some(Azimuth { sigma, turn, fold: false })
            }
        })
    }

    /// Whether one azimuth is as good as another.
    pub(super) fn is_round(&self) -> bool {
        matches!(self, Self::Family(_) | Self::Radial { .. })
    }

    /// The shape whose tail masking has, of one material; κ of the view's coordinate follows it. Of distributions outside the family it is not
    /// known, and that of a short one serves.
    pub(super) fn tail(&self) -> f64 {
        match *self {
            Self::StudentT { gamma, .. } | Self::Ellipsoid { gamma, .. } => gamma,
            Self::Family(_) | Self::Radial { .. } => f64::INFINITY,
        }
    }

    /// σ of the round member of the family that usually stands in for it.
    pub fn stand_in(&self) -> Option<f64> {
        match *self {
            Self::StudentT { sigma: [x, y], .. } | Self::Ellipsoid { sigma: [x, y], .. } => {
                Some((x * y).sqrt())
            }
            Self::Family(_) | Self::Radial { .. } => None,
        }
    }
}

fn ellipsoid(sigma: [f64; 2], theta: [f64; 3], gamma: f64) -> Result<Ellipsoid, AlbedoError> {
    let refused = |why: EllipsoidError| AlbedoError::Lobe(why.to_string());
    let skew = Skew::new(sigma, theta).map_err(|why| refused(why.into()))?;
    Ellipsoid::new(skew, gamma).map_err(refused)
}

/// How slopes spread about zero: the principal axes of σ_φ² + t_φ², roughness and mean slope seen from an azimuth, and the turn of the first.
///
/// A lobe that leans away masks, and one that leans forward reflects below the horizon, about where cot θ is its mean slope.
fn spread(ellipsoid: &Ellipsoid) -> ([f64; 2], f64) {
    let Skew { p, q, r, x, y } = ellipsoid.skew();
    let (a, b, c) = (p * p + q * q + x * x, q * r + x * y, r * r + y * y);
    let half = libm::hypot(0.5 * (a - c), b);
    let first = 0.5 * (a + c) + half;
    // The determinant without the cancellation of ac − b².
    let w = y / r;
    let u = (x - q * w) / p;
    let second = p * r * (p * r) * (1.0 + u * u + w * w) / first;
    ([first.sqrt(), second.sqrt()], 0.5 * libm::atan2(2.0 * b, a - c))
}

/// The lobes of a table by quadrature: one, or of the family one for each shape.
pub struct Models<'a>(HashMap<u64, Model<'a>>);

impl Models<'_> {
    /// Prepares the lobe for some shapes, which only the family heeds, and does something with it; `tolerance` as of
    /// [`AlbedoIntegrator::new`].
    ///
    /// # Errors
    /// [`AlbedoError`] for parameters outside the domain, and what `then` reports.
    pub fn with<T>(
        lobe: &AlbedoLobe,
        gammas: impl IntoIterator<Item = f64>,
        tolerance: f64,
        then: impl FnOnce(&Models<'_>) -> Result<T, AlbedoError>,
    ) -> Result<T, AlbedoError> {
        let integrator =
            |gamma| Ok::<_, AlbedoError>(AlbedoIntegrator::new(Shape::new(gamma)?, tolerance));
        // Sites of lobes that are one material have no γ.
        let one = |model| Models([(f64::INFINITY.to_bits(), model)].into());
        match lobe {
            AlbedoLobe::Family(_) => {
                let mut all: Vec<f64> = gammas.into_iter().collect();
                all.sort_by(f64::total_cmp);
                all.dedup();
                let model =
                    |&gamma: &f64| Ok((gamma.to_bits(), Model::StudentT(None, integrator(gamma)?)));
                then(&Models(all.par_iter().map(model).collect::<Result<_, AlbedoError>>()?))
            }
            &AlbedoLobe::StudentT { sigma, gamma } => {
                then(&one(Model::StudentT(Some(sigma), integrator(gamma)?)))
            }
            &AlbedoLobe::Ellipsoid { sigma, theta, gamma } => {
                let ellipsoid = ellipsoid(sigma, theta, gamma)?;
                then(&one(Model::Ellipsoid(ellipsoid, integrator(gamma)?)))
            }
            AlbedoLobe::Radial { distribution, .. } => {
                let built =
                    distribution.build().map_err(|why| AlbedoError::Lobe(why.to_string()))?;
                let marginal = Marginal::new(&*built);
                then(&one(Model::Radial(RadialAlbedo::new(&marginal, tolerance))))
            }
        }
    }

    /// The lobe at a place.
    ///
    /// # Panics
    /// If its shape was not prepared.
    pub fn at(&self, site: &Site) -> &Model<'_> {
        &self.0[&site.gamma.to_bits()]
    }
}

/// One lobe by quadrature.
pub enum Model<'a> {
    /// A Student-t with these σx and σy, or with the σ of the place.
    StudentT(Option<[f64; 2]>, AlbedoIntegrator),
    /// A tilted one.
    Ellipsoid(Ellipsoid, AlbedoIntegrator),
    /// One outside the family.
    Radial(RadialAlbedo<'a>),
}

impl Model<'_> {
    /// The albedo of reflection under some weights.
    ///
    /// # Errors
    /// [`ParameterError`] for a roughness outside the family or cos θ outside [0, 1].
    pub fn reflection(
        &self,
        site: &Site,
        weights: impl Fn(f64) -> [f64; CHANNELS],
    ) -> Result<Albedo<CHANNELS>, AlbedoError> {
        Ok(match self {
            Self::StudentT(None, model) => model.reflection(site.sigma, site.cos, weights)?,
            Self::StudentT(Some(sigma), model) => {
                model.reflection_anisotropic(*sigma, site.cos, site.phi, weights)?
            }
            Self::Ellipsoid(ellipsoid, model) => {
                model.reflection_skewed(ellipsoid, site.cos, site.phi, weights)?
            }
            Self::Radial(model) => model.reflection(site.cos, weights)?,
        })
    }

    /// The round member of the family with the σ of the place, which refracts as well.
    ///
    /// # Errors
    /// [`AlbedoError::Lobe`] of other lobes.
    pub(super) fn round(&self, site: &Site) -> Result<(&AlbedoIntegrator, f64), AlbedoError> {
        match self {
            Self::StudentT(None, model) => Ok((model, site.sigma)),
            _ => Err(AlbedoError::Lobe(
                "only round Student-t lobes refract light, by their own model".into(),
            )),
        }
    }

    /// The share A/μ of the macrosurface's area that the microsurface shows, of a lobe that may be tilted; below one G1 is clamped.
    pub(super) fn area_ratio(&self, site: &Site) -> Option<f64> {
        let Self::Ellipsoid(ellipsoid, _) = self else { return None };
        let sin = ((1.0 - site.cos) * (1.0 + site.cos)).sqrt();
        let (s, c) = libm::sincos(site.phi);
        Some(ellipsoid.projected_area(DVec3::new(sin * c, sin * s, site.cos)) / site.cos)
    }

    /// The albedo of the round lobe of its shape and this roughness.
    ///
    /// # Errors
    /// As [`reflection`](Self::reflection).
    pub fn stand_in(
        &self,
        sigma: f64,
        cos: f64,
        weights: impl Fn(f64) -> [f64; CHANNELS],
    ) -> Result<Option<Albedo<CHANNELS>>, ParameterError> {
        match self {
            Self::StudentT(_, model) | Self::Ellipsoid(_, model) => {
                model.reflection(sigma, cos, weights).map(Some)
            }
            Self::Radial(_) => Ok(None),
        }
    }
}
