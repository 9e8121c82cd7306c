//! Spectra that pbrt has names for.

use microfacet_sampler::Metal;

use crate::builder;

/// Indices of refraction of pbrt's glasses at the d line, 587.56 nm.
///
/// They are read from the tables of pbrt's `util/spectrum.cpp`, which are of refractiveindex.info
/// (CC0), linearly between the two nearest wavelengths as pbrt does, and rounded to five decimals.
/// Under the names F5, F10 and F11 it has the tables of SF5, SF10 and SF11.
const GLASSES: [(&str, f64); 7] = [
    ("glass-BK7", 1.516_80),
    ("glass-BAF10", 1.670_00),
    ("glass-FK51A", 1.486_56),
    ("glass-LASF9", 1.850_27),
    ("glass-F5", 1.672_72),
    ("glass-F10", 1.728_28),
    ("glass-F11", 1.784_74),
];

/// The index of refraction that stands for a glass.
pub(super) fn glass(name: &str) -> Option<f64> {
    GLASSES.iter().find(|(known, _)| *known == name).map(|&(_, eta)| eta)
}

/// The metal of a spectrum such as "metal-Au-eta", which has the `end` "-eta".
pub(super) fn metal(name: &str, end: &str) -> Option<Metal> {
    builder::metal(name.strip_prefix("metal-")?.strip_suffix(end)?)
}
