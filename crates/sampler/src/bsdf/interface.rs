//! The interface of two transparent media, seen from one side.

use glam::Vec3;
use microfacet_core::fresnel::{dielectric, dielectric_of_cosines, refracted_cos};
use microfacet_core::math::sqrt64;

use super::Transport;
use super::reflectance::indices;
use crate::bind_error::BindError;

/// The range of indices of refraction, inside over outside, far wider than that of matter.
const ETA: [f64; 2] = [1e-3, 1e3];

/// For |η − 1| below this, single precision does not distinguish refracted light from light that
/// goes straight on.
const NOTHING: f64 = 1e-5;

/// The index of refraction, inside over outside, in single precision; 1 if next to 1.
pub(super) fn checked(eta: f64) -> Result<f32, BindError> {
    indices("eta", &[eta], ETA)?;
    Ok(if (eta - 1.0).abs() < NOTHING { 1.0 } else { eta as f32 })
}

/// The error of a facet's cosine m·n, found from a view and a light as (v + η l)·n/|v + η l|, is to
/// be at most a hundredth of it. The sum is rounded to 2⁻²⁵ (1 + η), and its length is at least
/// |1 − η|.
const STEEP: f32 = 100.0 / (1 << 25) as f32;

/// The largest cosine that counts as steep, however near η is to 1.
const STEEPEST: f32 = 0.01;

/// The cosine m·n below which a refracting facet is only sampled if D has a pole at the horizon
/// (see [`Dielectric`](crate::Dielectric)): the view and the light do not determine the facet well
/// enough. The same for η and 1/η.
#[inline(always)]
#[must_use]
pub fn steep_cosine(eta: f32) -> f32 {
    (STEEP * (1.0 + eta) / (1.0 - eta).abs()).min(STEEPEST)
}

/// An interface seen from one side of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interface {
    /// The index of refraction beyond it, over that on the side of the view.
    eta: f32,
}

/// A facet that refracts: its normal, above the horizon, and quantities of the light's density.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refraction {
    pub(super) m: Vec3,
    /// The facet's transmittance, 1 − F.
    pub(super) transmittance: f32,
    /// Density of the light over that of m and v·m, and v·m: |l·m| η²/(v·m + η l·m)² · v·m (Walter
    /// et al. 2007, eq. 17).
    pub(super) jacobian: f32,
}

impl Interface {
    /// The interface of index η, inside over outside, seen from outside (`above`) or inside.
    #[inline(always)]
    pub(super) fn new(eta: f32, above: bool) -> Self {
        Self { eta: if above { eta } else { 1.0 / eta } }
    }

    /// The index of refraction beyond it, over that on the side of the view.
    #[inline(always)]
    pub(super) fn eta(self) -> f32 {
        self.eta
    }

    #[inline(always)]
    pub(super) fn steep(self) -> f32 {
        steep_cosine(self.eta)
    }

    /// The factor on transmitted light, (n_v/n_l)² of radiance and 1 of importance.
    #[inline(always)]
    pub(super) fn scale(self, transport: Transport) -> f32 {
        match transport {
            Transport::Radiance => 1.0 / (self.eta * self.eta),
            Transport::Importance => 1.0,
        }
    }

    #[inline(always)]
    pub(super) fn reflectance(self, facing: f32) -> f32 {
        dielectric(self.eta, facing.min(1.0))
    }

    /// The light that a facet of v·m = `facing` refracts; `None` where all light is reflected.
    #[inline(always)]
    pub(super) fn refract(self, v: Vec3, m: Vec3, facing: f32) -> Option<(Vec3, Refraction)> {
        let eta = self.eta;
        let facing = facing.min(1.0);
        let refracted = refracted_cos(eta, facing)?;
        let l = ((facing / eta - refracted) * m - v / eta).normalize_or_zero();
        let reflectance = dielectric_of_cosines(eta, facing, refracted);
        // v·m + η l·m = v·m − η |l·m|, without the cancellation where η is near 1.
        let length = (1.0 - eta) * (1.0 + eta) / (facing + eta * refracted);
        let refraction = Refraction {
            m,
            transmittance: 1.0 - reflectance,
            jacobian: jacobian(eta, facing, refracted, length),
        };
        Some((l, refraction))
    }

    /// The facet that refracts `v` into `l`, on the other side; `None` if there is none.
    #[inline(always)]
    pub(super) fn facet(self, v: Vec3, l: Vec3) -> Option<Refraction> {
        let eta = self.eta;
        // In double precision, because v + η l cancels where η is near 1.
        let [v64, l64] = [v, l].map(|w| w.to_array().map(f64::from));
        let h: [f64; 3] = core::array::from_fn(|i| v64[i] + f64::from(eta) * l64[i]);
        let length = sqrt64(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        // The sum vanishes for light that goes straight on with η = 1, where the facet is not
        // determined.
        if !(length > 0.0) {
            return None;
        }
        let scale = if h[2] < 0.0 { -1.0 / length } else { 1.0 / length };
        let m = Vec3::from(h.map(|x| (x * scale) as f32));
        let length = length as f32;
        let (facing, refracted) = (v.dot(m), -l.dot(m));
        if !(facing > 0.0 && refracted > 0.0) {
            return None;
        }
        let reflectance = dielectric_of_cosines(eta, facing, refracted);
        let transmittance = 1.0 - reflectance;
        Some(Refraction { m, transmittance, jacobian: jacobian(eta, facing, refracted, length) })
    }
}

#[inline(always)]
fn jacobian(eta: f32, facing: f32, refracted: f32, length: f32) -> f32 {
    let ratio = eta / length;
    facing * refracted * ratio * ratio
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_facet_is_found_again_from_view_and_light() {
        let v = Vec3::new(0.6, -0.3, 0.741_619_85);
        for eta in [0.3, 0.9, 1.05, 1.5, 3.0] {
            for above in [true, false] {
                let face = Interface::new(eta, above);
                for tilt in [Vec3::ZERO, Vec3::new(0.1, 0.2, 0.0), Vec3::new(-0.3, 0.1, 0.0)] {
                    let m = (Vec3::Z + tilt).normalize();
                    let Some((l, drawn)) = face.refract(v, m, v.dot(m)) else { continue };
                    assert!((l.length() - 1.0).abs() < 1e-6);
                    let found = face.facet(v, l).unwrap();
                    assert!((found.m - m).length() < 1e-5, "{eta} {above} {tilt}");
                    assert!((found.transmittance - drawn.transmittance).abs() < 1e-5);
                    assert!((found.jacobian / drawn.jacobian - 1.0).abs() < 2e-5);
                }
            }
        }
    }

    #[test]
    fn total_reflection_and_what_is_no_pair() {
        let grazing = Vec3::new(0.9, 0.0, 0.435_889_9);
        let inside = Interface::new(1.5, false);
        assert!(inside.refract(grazing, Vec3::Z, grazing.z).is_none());
        assert_eq!(inside.reflectance(grazing.z), 1.0);
        // View and light on one side of every facet.
        assert!(
            Interface::new(1.5, true).facet(grazing, Vec3::new(0.9, 0.0, -0.435_889_9)).is_none()
        );
        assert!(Interface::new(1.0, true).facet(grazing, -grazing).is_none());
    }

    #[test]
    fn an_index_next_to_one_is_one() {
        assert_eq!(checked(1.0 + 1e-6), Ok(1.0));
        for eta in [0.0, -1.5, f64::NAN, f64::INFINITY, 1e4] {
            assert!(checked(eta).is_err(), "{eta}");
        }
    }
}
