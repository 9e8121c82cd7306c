//! The lobes that albedos are baked for, and their quadrature. A new one needs a variant here and
//! in [`LobeForm`].

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use microfacet_model::classic::{Marginal, RadialAlbedo};
use microfacet_model::{Albedo, AlbedoIntegrator, Ellipsoid, EllipsoidError, Shape, Skew};
use microfacet_tables::axis::Azimuth;
use microfacet_tables::{LobeForm, LobeSpec};

use super::{AlbedoError, CHANNELS, Site};
use crate::distribution::Distribution;

/// The lobe, or the range of round lobes, that a table of albedos is baked for.
pub type AlbedoLobe = LobeSpec<Distribution>;

/// The lobe in the description of a table, where a distribution outside the family is of every
/// scale.
pub(crate) fn stated(lobe: &AlbedoLobe) -> LobeSpec {
    match &lobe.distribution {
        Some(distribution) => LobeSpec::outside(distribution.label()),
        None => lobe.map(Distribution::label),
    }
}

/// The mapping of the azimuth axis of a lobe; `None` for the family, whose albedo is the same at
/// every azimuth.
pub(super) fn azimuth(lobe: &AlbedoLobe) -> Result<Option<Azimuth>, AlbedoError> {
    Ok(match lobe.form() {
        LobeForm::Family => None,
        LobeForm::StudentT | LobeForm::Distribution => {
            Some(Azimuth { sigma: lobe.sigma(), turn: 0.0, fold: true })
        }
        LobeForm::Ellipsoid => {
            let (sigma, turn) = spread(&ellipsoid(lobe)?);
            Some(Azimuth { sigma, turn, fold: false })
        }
    })
}

/// The shape γ that sets κ of the view coordinate of a single lobe, by the tail of its masking.
/// Outside the family the tail is not known; γ of a short tail is used.
pub(super) fn tail(lobe: &AlbedoLobe) -> f64 {
    match lobe.form() {
        LobeForm::StudentT | LobeForm::Ellipsoid => lobe.gamma.min,
        LobeForm::Family | LobeForm::Distribution => f64::INFINITY,
    }
}

/// The ellipsoid of a lobe with a tilt.
pub(crate) fn ellipsoid(lobe: &AlbedoLobe) -> Result<Ellipsoid, AlbedoError> {
    let refused = |why: EllipsoidError| AlbedoError::Lobe(why.to_string());
    let theta = lobe.theta.ok_or_else(|| AlbedoError::Lobe("the lobe is not tilted".into()))?;
    let skew = Skew::new(lobe.sigma(), theta).map_err(|why| refused(why.into()))?;
    Ellipsoid::new(skew, lobe.gamma.min).map_err(refused)
}

/// The ratio A/μ of the microsurface's visible area to the macrosurface's; where it is below 1, G1
/// is clamped.
pub(crate) fn area_ratio(ellipsoid: &Ellipsoid, site: &Site) -> f64 {
    let sin = ((1.0 - site.cos) * (1.0 + site.cos)).sqrt();
    let (s, c) = libm::sincos(site.phi);
    ellipsoid.projected_area(DVec3::new(sin * c, sin * s, site.cos)) / site.cos
}

/// The spread of slopes about zero: the roots of the principal values of σ_φ² + t_φ² (roughness and
/// mean slope along the azimuth φ), and the azimuth of the first.
///
/// The mean slope counts because E changes where cot θ is about the mean slope: there a lobe that
/// leans away from the view masks, and one that leans towards it reflects below the horizon.
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

/// The lobes of a table by quadrature: a single one, or one for each shape of the family.
pub struct Models<'a>(HashMap<u64, Model<'a>>);

impl Models<'_> {
    /// Prepares the lobe, for the family at each of `gammas`, and calls `then` with it; `tolerance`
    /// as in [`AlbedoIntegrator::new`].
    ///
    /// # Errors
    /// [`AlbedoError`] for parameters outside the domain, and any error of `then`.
    pub fn with<T>(
        lobe: &AlbedoLobe,
        gammas: impl IntoIterator<Item = f64>,
        tolerance: f64,
        then: impl FnOnce(&Models<'_>) -> Result<T, AlbedoError>,
    ) -> Result<T, AlbedoError> {
        let integrator =
            |gamma| Ok::<_, AlbedoError>(AlbedoIntegrator::new(Shape::new(gamma)?, tolerance));
        // Sites of a single lobe have γ = ∞.
        let one = |model| Models([(f64::INFINITY.to_bits(), model)].into());
        let gamma = lobe.gamma.min;
        if let Some(distribution) = &lobe.distribution {
            let built = distribution.build().map_err(|why| AlbedoError::Lobe(why.to_string()))?;
            let marginal = Marginal::new(&*built);
            return then(&one(Model::Radial(RadialAlbedo::new(&marginal, tolerance))));
        }
        match (lobe.is_family(), lobe.theta) {
            (true, _) => {
                let mut all: Vec<f64> = gammas.into_iter().collect();
                all.sort_by(f64::total_cmp);
                all.dedup();
                let model =
                    |&gamma: &f64| Ok((gamma.to_bits(), Model::StudentT(None, integrator(gamma)?)));
                then(&Models(all.par_iter().map(model).collect::<Result<_, AlbedoError>>()?))
            }
            (_, None) => then(&one(Model::StudentT(Some(lobe.sigma()), integrator(gamma)?))),
            (_, Some(_)) => then(&one(Model::Ellipsoid(ellipsoid(lobe)?, integrator(gamma)?))),
        }
    }

    /// The lobe at a site.
    ///
    /// # Panics
    /// If its shape was not prepared.
    pub fn at(&self, site: &Site) -> &Model<'_> {
        &self.0[&site.gamma.to_bits()]
    }
}

/// One lobe by quadrature.
pub enum Model<'a> {
    /// A Student-t lobe with these σx and σy, or with the σ of the site.
    StudentT(Option<[f64; 2]>, AlbedoIntegrator),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid, AlbedoIntegrator),
    /// An isotropic lobe outside the family.
    Radial(RadialAlbedo<'a>),
}

impl Model<'_> {
    /// The albedo of reflection, weighted with some Fresnel weights.
    ///
    /// # Errors
    /// [`AlbedoError`] for a roughness outside the family or cos θ outside [0, 1].
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

    /// The upright lobe of the family and its σx and σy; the model has refraction for no other.
    pub(super) fn refracting(
        &self,
        site: &Site,
    ) -> Result<(&AlbedoIntegrator, [f64; 2]), AlbedoError> {
        match self {
            Self::StudentT(sigma, model) => Ok((model, sigma.unwrap_or([site.sigma; 2]))),
            _ => Err(AlbedoError::Lobe(
                "only upright Student-t lobes refract light, by their own model".into(),
            )),
        }
    }

    /// [`area_ratio`], `None` unless it is an ellipsoid.
    pub(super) fn area_ratio(&self, site: &Site) -> Option<f64> {
        let Self::Ellipsoid(ellipsoid, _) = self else { return None };
        Some(area_ratio(ellipsoid, site))
    }
}
