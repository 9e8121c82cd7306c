//! Numbers and words that Python passes, and errors as those of Python.

use std::io;

use microfacet_baker::scene::{SceneError, SceneErrorKind};
use microfacet_baker::store::StoreError;
use microfacet_sampler::lobe::Roughness;
use microfacet_sampler::{
    BindError, BsdfSettings, Compensation, Masking, Metal, StandIn, Tables, Transport,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Any, Input};
use crate::broadcast::shown;

/// An error with the text that the command prints.
pub(crate) fn refused(why: impl ToString) -> PyErr {
    PyValueError::new_err(why.to_string())
}

/// Why a BSDF or an albedo cannot be made, in the words of Python.
pub(crate) fn unbound(why: BindError) -> PyErr {
    let words = [
        ("`StandIn::Round`", "stand_in=True"),
        ("and the sigma and theta of its Skew", "and its sigma and theta"),
        (", which compensation needs", ""),
        (", or state that a lobe or BSDF of your own is one by `is_symmetric`", ""),
        ("bake a set from these lines", "give microfacet.bake a recipe with these lines"),
    ];
    refused(words.iter().fold(why.to_string(), |why, (rust, python)| why.replace(rust, python)))
}

/// Names that other renderers have for arguments of ours, with what to write.
const ELSEWHERE: [(&str, &str); 18] = [
    ("alpha", "sigma is what others call alpha: sigma = alpha"),
    ("alpha_x", "sigma_x is what others call alpha_x: sigma_x = alpha_x"),
    ("alpha_y", "sigma_y is what others call alpha_y: sigma_y = alpha_y"),
    ("roughness", "sigma is alpha, which renderers square roughness for: sigma = roughness**2"),
    ("anisotropy", "give sigma_x and sigma_y"),
    ("distribution", "gamma = 2 is GGX, and gamma = math.inf Beckmann"),
    ("nu", "gamma is the shape, half of Student's degrees of freedom plus 1: gamma = nu/2 + 1"),
    ("shape", "the shape is gamma"),
    ("tail", "the shape is gamma: 2 is GGX, below are heavier tails"),
    ("color", "the reflectance at normal incidence is f0; the base of a Plastic is base"),
    ("base_color", "the reflectance at normal incidence is f0; the base of a Plastic is base"),
    ("specular", "the reflectance at normal incidence is f0"),
    ("ior", "the index of refraction is eta; of a metal eta with k"),
    ("material", "give metal, a name such as \"gold\" or \"Au\""),
    ("edge_tint", "the tint at 82 degrees is f82"),
    ("specular_haze", "the share of the haze is weight"),
    ("specular_haze_spread", "the haze is a BSDF of its own, of a rougher lobe"),
    ("specular_retroreflectivity", "the share of the light that goes back is share"),
];

/// Raises TypeError for arguments that a class does not have, and says what to write instead.
pub(crate) fn lead_on(class: &str, others: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
    let Some(name) = others.and_then(|others| others.keys().get_item(0).ok()) else {
        return Ok(());
    };
    let name = name.to_string();
    let hint = ELSEWHERE.iter().find(|(known, _)| *known == name);
    let hint = hint.map_or(String::new(), |(_, hint)| format!(": {hint}"));
    Err(PyTypeError::new_err(format!("{class} has no argument {name}{hint}")))
}

/// An index of refraction, which must be given.
pub(crate) fn index(eta: Option<f64>) -> PyResult<f64> {
    eta.ok_or_else(|| {
        PyTypeError::new_err("eta is missing: the index of refraction inside over that outside")
    })
}

/// A metal by name or symbol.
pub(crate) fn metal(py: Python<'_>, name: &str) -> PyResult<Metal> {
    name.parse::<Metal>().or_else(|why| {
        // As people write it: Gold, AU.
        let lower = name.trim().to_lowercase();
        let names = Metal::ALL.map(Metal::name);
        let symbol = Metal::ALL.map(Metal::symbol).into_iter().find(|s| s.to_lowercase() == lower);
        let close = match symbol {
            Some(symbol) => vec![symbol.to_owned()],
            None => {
                let difflib = py.import("difflib")?;
                difflib.call_method1("get_close_matches", (lower, names, 1))?.extract()?
            }
        };
        let hint =
            close.first().map_or(String::new(), |close| format!("; did you mean \"{close}\"?"));
        Err(refused(format!("metal \"{name}\": {why}{hint}")))
    })
}

/// Why a scene cannot be read: errors of the operating system are OSError.
pub(crate) fn unscened(why: SceneError) -> PyErr {
    match &why.kind {
        SceneErrorKind::Io(cause) => io::Error::new(cause.kind(), why.to_string()).into(),
        _ => refused(why),
    }
}

/// An error of files: those of the operating system are OSError.
pub(crate) fn unread(why: StoreError) -> PyErr {
    match &why {
        StoreError::Io(_, cause) => io::Error::new(cause.kind(), why.to_string()).into(),
        _ => refused(why),
    }
}

/// N numbers, or one number for all N; `meaning` describes them in errors.
pub(crate) fn numbers<const N: usize>(
    name: &'static str,
    value: &Any,
    meaning: &str,
) -> PyResult<[f64; N]> {
    let input = Input::<f64, 1>::new(name, value)?;
    match input.batch() {
        [] => Ok([input.first::<1>()[0][0]; N]),
        [n] if *n == N => Ok(input.first().map(|[x]| x)),
        shape => Err(refused(format!(
            "{name} has the shape {}: it must be a number, or {meaning}",
            shown(shape)
        ))),
    }
}

/// Roughness: a number, or a pair for x and y.
pub(crate) fn sigma(value: &Any) -> PyResult<Roughness> {
    Ok(Roughness(numbers("sigma", value, "a pair (sigma_x, sigma_y)")?))
}

/// Three angles; a single number is an error.
pub(crate) fn angles(value: &Any) -> PyResult<[f64; 3]> {
    let input = Input::<f64, 3>::new("theta", value)?;
    match input.batch() {
        [] => Ok(input.first::<1>()[0]),
        _ => Err(refused("theta must be three angles (x, y, z) in radians")),
    }
}

/// A colour: a number for all three channels, or three.
pub(crate) fn colour(name: &'static str, value: &Any) -> PyResult<[f64; 3]> {
    numbers(name, value, "three (r, g, b)")
}

/// A colour in single precision.
pub(crate) fn reflectance(name: &'static str, value: &Any) -> PyResult<[f32; 3]> {
    Ok(colour(name, value)?.map(|x| x as f32))
}

/// One of a few words.
pub(crate) fn one_of<T: Copy>(name: &str, word: &str, words: &[(&str, T)]) -> PyResult<T> {
    let found = words.iter().find(|(known, _)| *known == word);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let known: Vec<String> = words.iter().map(|(known, _)| format!("\"{known}\"")).collect();
        refused(format!("{name} \"{word}\" must be {}", known.join(" or ")))
    })
}

pub(crate) fn masking(word: &str) -> PyResult<Masking> {
    one_of("masking", word, &Masking::ALL.map(|form| (form.name(), form)))
}

pub(crate) fn compensation(word: &str) -> PyResult<Compensation> {
    let words = [
        ("none", Compensation::None),
        ("turquin", Compensation::Turquin),
        ("kulla-conty", Compensation::KullaConty),
        ("kulla_conty", Compensation::KullaConty),
    ];
    one_of("compensation", word, &words)
}

/// Masking and compensation of a BSDF.
pub(crate) struct Form {
    pub(crate) masking: Masking,
    pub(crate) compensation: Compensation,
    pub(crate) may_stand_in: bool,
}

impl Form {
    pub(crate) fn new(
        masking_word: &str,
        compensation_word: &str,
        may_stand_in: bool,
    ) -> PyResult<Self> {
        let (masking, compensation) = (masking(masking_word)?, compensation(compensation_word)?);
        Ok(Self { masking, compensation, may_stand_in })
    }

    /// How a BSDF is made of one lobe.
    pub(crate) fn settings<'a>(&self, tables: &'a Tables) -> BsdfSettings<'a> {
        BsdfSettings::new()
            .with_masking(self.masking)
            .compensated(self.compensation, tables)
            .with_stand_in(stand_in(self.may_stand_in))
    }
}

pub(crate) fn transport(word: &str) -> PyResult<Transport> {
    let words = [("radiance", Transport::Radiance), ("importance", Transport::Importance)];
    one_of("transport", word, &words)
}

/// Whether the round lobe may stand in.
pub(crate) fn stand_in(may: bool) -> StandIn {
    if may { StandIn::Round } else { StandIn::Refused }
}
