//! Fresnel terms: checks of their numbers, and metals by name.

use crate::Result;
use microfacet_baker::scene::{Place, Reflectance};
use microfacet_sampler::Metal;

/// The Fresnel term of a dielectric of relative index `eta`.
pub(super) fn dielectric(eta: f64, place: &Place) -> Result<Reflectance> {
    if eta > 0.0 && eta < f64::INFINITY {
        Ok(Reflectance::dielectric(eta))
    } else {
        Err(place.invalid(format!(
            "the index of refraction is {eta}; it must be finite and more than 0"
        )))
    }
}

pub(super) fn conductor(eta: [f64; 3], k: [f64; 3], place: &Place) -> Result<Reflectance> {
    let finite = eta.iter().chain(&k).all(|x| x.is_finite());
    if finite && eta.iter().all(|&eta| eta > 0.0) && k.iter().all(|&k| k >= 0.0) {
        Ok(Reflectance::Conductor { eta, k })
    } else {
        Err(place.invalid(format!(
            "the conductor has eta = {eta:?} and k = {k:?}; eta must be more than 0 and k at least 0"
        )))
    }
}

/// A metal by its chemical symbol in pbrt's spectra and Mitsuba's presets, if it is known.
///
/// The indices of [`Metal`] and of the renderer's own spectrum are different measurements.
pub(super) fn metal(symbol: &str) -> Option<Metal> {
    Metal::ALL.into_iter().find(|metal| metal.symbol() == symbol)
}
