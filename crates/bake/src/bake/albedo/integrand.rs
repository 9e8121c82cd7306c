//! The reflectances under which albedos are baked. A new one needs a variant here and in
//! [`Reflectance`], which names its channels.

use microfacet_model::Albedo;
use microfacet_model::fresnel::{Conductor, Dielectric, f82_weight, schlick_weight};
use microfacet_tables::{Reflectance, Side};

use super::{AlbedoError, CHANNELS, Model, Site};

/// A reflectance with its constants computed.
pub enum Integrand {
    /// F = 1, split by [`weights`].
    Moments,
    /// A conductor, one for each colour channel.
    Metal([Conductor; 3]),
    /// A dielectric seen from one side; the index is that of the site.
    Pane(Side),
}

/// The Fresnel weights of the moments: Schlick scale, Schlick bias and F82.
pub fn weights(cos: f64) -> [f64; 3] {
    let bias = schlick_weight(cos);
    [1.0 - bias, bias, f82_weight(cos)]
}

impl Integrand {
    /// Computes the constants of a reflectance.
    ///
    /// # Errors
    /// [`AlbedoError`] for η ≤ 0 or k < 0, or a dielectric of no side.
    pub fn new(reflectance: &Reflectance) -> Result<Self, AlbedoError> {
        Ok(match *reflectance {
            Reflectance::Mirror | Reflectance::Schlick(_) => Self::Moments,
            Reflectance::Conductor { eta, k } => {
                let channel = |i: usize| Conductor::new(eta[i], k[i]);
                Self::Metal([channel(0)?, channel(1)?, channel(2)?])
            }
            Reflectance::Interface { side, .. } => Self::Pane(side),
            Reflectance::Dielectric(_) => {
                return Err(AlbedoError::Lobe("a table is of one side of a dielectric".into()));
            }
        })
    }

    /// The albedos at a site by quadrature, for both forms of masking; channels that the
    /// reflectance lacks are 0.
    ///
    /// # Errors
    /// [`AlbedoError`] for a site outside the domain of the lobe, or a lobe without refraction.
    pub fn at(&self, model: &Model<'_>, site: &Site) -> Result<Albedo<CHANNELS>, AlbedoError> {
        match self {
            Self::Moments => model.reflection(site, weights),
            Self::Metal(metals) => {
                model.reflection(site, |cos| metals.map(|metal| metal.reflectance(cos)))
            }
            Self::Pane(side) => pane(*side, model, site),
        }
    }
}

/// Reflection and transmission of a dielectric; the index may be infinite.
fn pane(side: Side, model: &Model<'_>, site: &Site) -> Result<Albedo<CHANNELS>, AlbedoError> {
    if site.eta == f64::INFINITY {
        return model.reflection(site, |_| [1.0, 0.0, 0.0]);
    }
    let eta = if side == Side::Dense { 1.0 / site.eta } else { site.eta };
    let (model, sigma) = model.refracting(site)?;
    let shares = model.interface_anisotropic(sigma, site.cos, site.phi, Dielectric::new(eta)?)?;
    let three = |[reflected, transmitted]: [f64; 2]| [reflected, transmitted, 0.0];
    Ok(Albedo {
        uncorrelated: three(shares.uncorrelated),
        height_correlated: three(shares.height_correlated),
        error: shares.error,
    })
}
