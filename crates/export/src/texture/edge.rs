//! The edges of the domain of a texture, by name.

use microfacet_model::fresnel::Dielectric;

use super::TextureSpec;
use super::axis::{Along, MIRROR, Place, TexelAxis};

/// An edge, or a line within the domain on which the model changes fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The smallest cosine that counts.
    LeastCos,
    /// The normal view.
    Normal,
    /// σ = 0.
    Smooth,
    /// σ_max.
    Roughest,
    /// The smallest η.
    LeastEta,
    /// The largest η.
    MostEta,
    /// From inside, the view from which a smooth interface begins to transmit.
    CriticalAngle,
    /// From inside, the view from which upright facets begin to reflect all light, cos θ = 1/η.
    UprightFacets,
}

impl Edge {
    const ALL: [Self; 8] = [
        Self::LeastCos,
        Self::Normal,
        Self::Smooth,
        Self::Roughest,
        Self::LeastEta,
        Self::MostEta,
        Self::CriticalAngle,
        Self::UprightFacets,
    ];

    /// Those within a domain that are named by the view of a material alone.
    pub(super) const WITHIN: [Self; 2] = [Self::CriticalAngle, Self::UprightFacets];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LeastCos => "least_cos_theta",
            Self::Normal => "normal",
            Self::Smooth => "sigma_0",
            Self::Roughest => "sigma_max",
            Self::LeastEta => "eta_min",
            Self::MostEta => "eta_max",
            Self::CriticalAngle => "critical_angle",
            Self::UprightFacets => "upright_facets",
        }
    }

    /// The edges of textures of an interface.
    pub(super) fn of(spec: &TextureSpec) -> Vec<Self> {
        let all = if spec.side().is_some() { &Self::ALL[..] } else { &[] };
        all.to_vec()
    }

    /// The view on a line within the domain, of a relative index η; none from outside.
    pub(super) fn cos(self, eta: f64) -> Option<f64> {
        let interface = Dielectric::new(eta).ok().filter(|_| eta < 1.0)?;
        match self {
            Self::CriticalAngle => Some(interface.kink()),
            Self::UprightFacets => Some(eta),
            _ => None,
        }
    }

    /// Whether a place is on it.
    pub(super) fn holds(self, spec: &TextureSpec, place: &Place) -> bool {
        let end = |wanted: usize| {
            let is_end = |axis: &TexelAxis| match axis.along {
                Along::Index { ends, inside } => {
                    let eta = if inside { 1.0 / ends[wanted] } else { ends[wanted] };
                    place.eta == Some(eta)
                }
                _ => false,
            };
            spec.axes.iter().any(is_end)
        };
        match self {
            Self::LeastCos => place.cos == Some(spec.least_cos),
            Self::Normal => place.cos == Some(1.0),
            Self::Smooth => place.sigma == MIRROR,
            Self::Roughest => spec.axes.iter().any(
                |axis| matches!(axis.along, Along::Roughness { largest } if place.sigma == largest),
            ),
            Self::LeastEta => end(0),
            Self::MostEta => end(1),
            Self::CriticalAngle | Self::UprightFacets => {
                place.cos.is_some() && place.eta.and_then(|eta| self.cos(eta)) == place.cos
            }
        }
    }
}
