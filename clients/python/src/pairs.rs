//! BSDFs of two parts: haze, and light that goes back.

use std::sync::Arc;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Any, Input, Kept};
use crate::broadcast::shown;
use crate::bsdf::PyBsdf;
use crate::material::Material;
use crate::words;

/// The most parts of a BSDF: some thirty pairs of a pair with itself would be more than memory
/// holds, and some thousands of one in another deeper than a stack.
const PARTS_MOST: usize = 64;

/// A core with haze around it, any two BSDFs: f = (1 - weight) f of core + weight f of haze.
///
/// weight lies in [0, 1], a number or an array, which broadcasts as those of sigma and gamma do;
/// both parts may be of arrays, too. They share light as two materials side by side, too small to
/// be seen apart: the albedo is (1 - weight) E of core + weight E of haze, and where both parts are
/// compensated, so is the whole. A sample is drawn from one part and weighted by both. This is
/// specular_haze of OpenPBR. Of two dielectrics, eta should be the same. A BSDF may have 64 parts
/// at most, of which those that send light back count twice.
///
/// >>> import microfacet
/// >>> def gold(sigma):
/// ...     return microfacet.Conductor(microfacet.StudentT(sigma, 2.0), metal="gold")
/// >>> hazy = microfacet.Haze(gold(0.1), gold(0.45), weight=0.3)
/// >>> hazy.haze, hazy.weight
/// (Conductor(StudentT(sigma=0.45, gamma=2)), 0.3)
/// >>> v, l = [0.6, 0.0, 0.8], [0.0, 0.0, 1.0]
/// >>> core, haze, both = (bsdf.eval(v, l)[0] for bsdf in (hazy.core, hazy.haze, hazy))
/// >>> bool(abs(both / (0.7 * core + 0.3 * haze) - 1) < 1e-6)
/// True
#[pyclass(name = "Haze", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyHaze {
    /// The core.
    #[pyo3(get)]
    core: Py<PyBsdf>,
    /// The haze around it.
    #[pyo3(get)]
    haze: Py<PyBsdf>,
    weight: Arc<Kept<f64, 1>>,
}

#[pymethods]
impl PyHaze {
    #[new]
    #[pyo3(signature = (core, haze, weight=None, **others),
           text_signature = "(core, haze, weight)")]
    fn new(
        core: &Bound<'_, PyBsdf>,
        haze: &Bound<'_, PyBsdf>,
        weight: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        words::lead_on("Haze", others)?;
        let weight = share("weight", "the share of the haze", weight)?;
        let [first, second] = [core, haze].map(Bound::get);
        let parts = limited(first.parts + second.parts)?;
        let about = format!("Haze({}, {}, {})", first.about, second.about, written(&weight));
        let bsdf = Material::haze(&first.bsdf, &second.bsdf, &weight)?;
        let (core, haze) = (core.clone().unbind(), haze.clone().unbind());
        Ok(PyBsdf::made(bsdf, about, parts).add_subclass(Self { core, haze, weight }))
    }

    /// The share of the haze: a number, or an array.
    #[getter]
    fn weight<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        self.weight.array(py)
    }
}

/// A BSDF of which a share of the light goes back to where it came from: f = (1 - share) f(v, l) +
/// share f(v', l), where v' is v turned by half a turn about n.
///
/// share lies in [0, 1], a number or an array, which broadcasts as those of sigma and gamma do. The
/// albedo, and a compensation, are those of the BSDF. It may be of any kind, a Haze too, unless it
/// refracts or a lobe of it is tilted: ValueError, since light would be sent to the wrong side of
/// the normal, or not the same in both directions. This is specular_retroreflectivity of OpenPBR.
///
/// >>> import microfacet
/// >>> silver = microfacet.Conductor(microfacet.StudentT(0.1, 2.0), metal="silver")
/// >>> sheet = microfacet.Retroreflective(silver, share=0.8)
/// >>> sheet
/// Retroreflective(Conductor(StudentT(sigma=0.1, gamma=2)), share=0.8)
/// >>> v, mirrored = [0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]
/// >>> back, forth = sheet.eval(v, [v, mirrored])[:, 0]
/// >>> bool(3.9 < back / forth < 4.1)
/// True
#[pyclass(name = "Retroreflective", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyRetroreflective {
    /// The BSDF.
    #[pyo3(get)]
    bsdf: Py<PyBsdf>,
    share: Arc<Kept<f64, 1>>,
}

#[pymethods]
impl PyRetroreflective {
    #[new]
    #[pyo3(signature = (bsdf, share=None, **others), text_signature = "(bsdf, share)")]
    fn new(
        bsdf: &Bound<'_, PyBsdf>,
        share: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        words::lead_on("Retroreflective", others)?;
        let share = self::share("share", "the share of the light that goes back", share)?;
        let of = bsdf.get();
        let parts = limited(2 * of.parts)?;
        let about = format!("Retroreflective({}, {})", of.about, written(&share));
        let made = Material::retroreflective(&of.bsdf, &share)?;
        let bsdf = bsdf.clone().unbind();
        Ok(PyBsdf::made(made, about, parts).add_subclass(Self { bsdf, share }))
    }

    /// The share of the light that goes back: a number, or an array.
    #[getter]
    fn share<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        self.share.array(py)
    }
}

/// A share of light, which must be given.
fn share(name: &'static str, meaning: &str, value: Option<&Any>) -> PyResult<Arc<Kept<f64, 1>>> {
    let missing = || PyTypeError::new_err(format!("{name} is missing: {meaning}, in [0, 1]"));
    Input::shares(name, value.ok_or_else(missing)?)?.kept().map(Arc::new)
}

/// A number of parts that are not too many.
fn limited(parts: usize) -> PyResult<usize> {
    match parts {
        0..=PARTS_MOST => Ok(parts),
        _ => Err(words::refused(format!(
            "a BSDF of {parts} parts: it may have {PARTS_MOST} at most, where those that send light \
             back count twice; make it of fewer"
        ))),
    }
}

/// A share as `repr` shows it.
fn written(share: &Kept<f64, 1>) -> String {
    match share.one() {
        Some(one) => format!("{}={one}", share.name()),
        None => format!("{} of shape {}", share.name(), shown(share.batch())),
    }
}
