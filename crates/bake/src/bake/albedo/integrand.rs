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
    let pane = Dielectric::new(eta)?;
    // The cosine at which total reflection begins.
    let kink = if eta < 1.0 { ((1.0 - eta) * (1.0 + eta)).sqrt() } else { 0.0 };
    let reflectance = |cos: f64| [pane.reflectance(cos)];
    let [reflected, transmitted] = match model.refracting(site)? {
        (model, [sigma, y]) if sigma == y => {
            let reflected = if kink > 0.0 {
                model.reflection_with_kink(sigma, site.cos, kink, reflectance)?
            } else {
                model.reflection(sigma, site.cos, reflectance)?
            };
            [reflected, model.transmission(sigma, site.cos, pane)?]
        }
        (model, sigma) => {
            let Site { cos, phi, .. } = *site;
            let reflected =
                model.reflection_anisotropic_with_kink(sigma, cos, phi, kink, reflectance)?;
            [reflected, model.transmission_anisotropic(sigma, cos, phi, pane)?]
        }
    };
    let both = |r: [f64; 1], t: [f64; 1]| [r[0], t[0], 0.0];
    Ok(Albedo {
        uncorrelated: both(reflected.uncorrelated, transmitted.uncorrelated),
        height_correlated: both(reflected.height_correlated, transmitted.height_correlated),
        error: reflected.error.max(transmitted.error),
    })
}
