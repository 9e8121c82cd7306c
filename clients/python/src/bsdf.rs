//! Complete materials.

use std::sync::Arc;

use pyo3::basic::CompareOp;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyEllipsis, PySlice, PyTuple};

use microfacet_sampler::{AnyBsdf, Bsdf, BsdfSample, ConductorFresnel, Event, Lobe, Plastic};

use crate::arrays::{Any, Input};
use crate::broadcast::{Cost, One, each, flags};
use crate::lobe::PyLobe;
use crate::material::{Material, of};
use crate::words::{self, Form, refused, unbound};

/// A bidirectional scattering distribution function in three channels.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, both
/// away from the surface; z < 0 is inside. f excludes the cosine, densities are per steradian of l.
/// Where all events are deltas (a smooth surface) f and density are 0. transport is "radiance", for
/// paths from the camera, which refraction scales by (n_v/n_l)^2, or "importance".
///
/// >>> import microfacet
/// >>> gold = microfacet.Conductor(microfacet.StudentT(0.3, 2.5), metal="gold")
/// >>> v, l = [0.6, 0.0, 0.8], [[0.0, 0.0, 1.0], [-0.6, 0.0, 0.8]]
/// >>> gold.eval(v, l).shape, gold.pdf(v, l).shape
/// ((2, 3), (2,))
/// >>> gold.sample(v, 0.5, [0.3, 0.7]).l.shape
/// (3,)
#[pyclass(name = "Bsdf", module = "microfacet", subclass, frozen)]
pub(crate) struct PyBsdf {
    pub(crate) bsdf: Arc<Material>,
    /// What `repr` shows.
    pub(crate) about: String,
    /// How many BSDFs of one lobe a call evaluates.
    pub(crate) parts: usize,
}

impl PyBsdf {
    pub(crate) fn new(bsdf: impl Into<AnyBsdf>, about: String) -> Self {
        Self { bsdf: Arc::new(Material::of(bsdf)), about, parts: 1 }
    }

    pub(crate) fn made(bsdf: Material, about: String, parts: usize) -> PyClassInitializer<Self> {
        PyClassInitializer::from(Self { bsdf: Arc::new(bsdf), about, parts })
    }

    /// The plastic, if it is one, of one lobe.
    fn plastic(&self) -> PyResult<&Plastic<Lobe>> {
        if let Material::One(bsdf) = &*self.bsdf
            && let AnyBsdf::Plastic(plastic) = &**bsdf
        {
            return Ok(plastic);
        }
        Err(refused("this is for one coat, not for lobes of arrays"))
    }
}

/// Lights drawn for views, arrays of one shape: a path that ends has l, weight and pdf of 0.
///
/// >>> import microfacet
/// >>> glass = microfacet.Dielectric(microfacet.StudentT(0.3, 2.5), eta=1.5)
/// >>> sample = glass.sample([0.6, 0.0, 0.8], [0.01, 0.9], [0.3, 0.7])
/// >>> sample.l.shape, sample.weight.shape, sample.pdf.shape
/// ((2, 3), (2, 3), (2,))
/// >>> sample.transmitted.tolist()
/// [False, True]
#[pyclass(name = "BsdfSample", module = "microfacet", frozen, get_all)]
pub(crate) struct PySample {
    /// Directions of light, shape (..., 3).
    l: Py<PyAny>,
    /// f |cos|/pdf, shape (..., 3); of a delta what it scatters over the probability of its choice.
    weight: Py<PyAny>,
    /// Densities per steradian; 0 of a delta.
    pdf: Py<PyAny>,
    /// n_l/n_v, 1 of a reflection.
    eta: Py<PyAny>,
    /// Whether the light is on the other side of the surface.
    transmitted: Py<PyAny>,
    /// Whether the event is a delta.
    delta: Py<PyAny>,
}

#[pymethods]
impl PySample {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let shape = self.pdf.bind(py).getattr("shape")?;
        Ok(format!("BsdfSample of shape {}", shape.str()?))
    }
}

#[pymethods]
impl PyBsdf {
    /// f(v, l), shape (..., 3), without the cosine.
    #[pyo3(signature = (v, l, transport="radiance"))]
    fn eval<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        l: &Any<'py>,
        transport: &str,
    ) -> PyResult<Any<'py>> {
        let mode = words::transport(transport)?;
        let (v, l) = (Input::directions("v", v)?, Input::directions("l", l)?);
        of!(&*self.bsdf, all => each(py, (all, &v, &l), Cost::Lookup, |(bsdf, v, l)| {
            let (v, l): ([f32; 3], [f32; 3]) = (v, l);
            bsdf.eval(v, l, mode)
        }))
    }

    /// The density with which sample draws l for v, per steradian.
    fn pdf<'py>(&self, py: Python<'py>, v: &Any<'py>, l: &Any<'py>) -> PyResult<Any<'py>> {
        let (v, l) = (Input::directions("v", v)?, Input::directions("l", l)?);
        of!(&*self.bsdf, all => each(py, (all, &v, &l), Cost::Lookup, |(bsdf, v, l)| {
            let (v, l): ([f32; 3], [f32; 3]) = (v, l);
            [bsdf.pdf(v, l)]
        }))
    }

    /// Draws lights for views v from uniform numbers: u, shape (..., 2), for the direction and
    /// choice, shape (...), among events.
    #[pyo3(signature = (v, choice, u, transport="radiance"))]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        choice: &Any<'py>,
        u: &Any<'py>,
        transport: &str,
    ) -> PyResult<PySample> {
        let mode = words::transport(transport)?;
        let (v, choice) = (Input::directions("v", v)?, Input::new("choice", choice)?);
        let u = Input::new("u", u)?;
        let all = of!(&*self.bsdf, all => {
            each(py, (all, &v, &choice, &u), Cost::Lookup, |(bsdf, v, [choice], u)| {
                drawn(bsdf.sample_with_pdf(v, choice, u, mode))
            })
        })?;
        // Columns are copied: a view of the array would keep all ten, and its sums would round
        // more.
        let column = |index: Any<'py>| -> PyResult<Py<PyAny>> {
            let index = PyTuple::new(py, [PyEllipsis::get(py).to_owned().into_any(), index])?;
            Ok(all.get_item(index)?.call_method0("copy")?.unbind())
        };
        let vector = |at: isize| column(PySlice::new(py, at, at + 3, 1).into_any());
        let number = |at: i32| column(at.into_pyobject(py)?.into_any());
        let flag = |at: i32| number(at)?.bind(py).rich_compare(0, CompareOp::Ne).map(Bound::unbind);
        Ok(PySample {
            l: vector(0)?,
            weight: vector(3)?,
            pdf: number(6)?,
            eta: number(7)?,
            transmitted: flag(8)?,
            delta: flag(9)?,
        })
    }

    /// Whether all events are deltas, so that eval is 0 everywhere.
    #[getter]
    fn is_delta<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        of!(&*self.bsdf, all => flags(py, all, |bsdf| bsdf.is_delta()))
    }

    fn __repr__(&self) -> &str {
        &self.about
    }
}

/// A rough conductor of a lobe: every facet reflects.
///
/// The reflectance is one of: metal, a name such as "gold"; eta and k, a complex index of
/// refraction; f0, Schlick's reflectance at normal incidence, with f82, if given, OpenPBR's tint at
/// 82 degrees; none of them, F = 1. Colours are a number or three. compensation, "none", "turquin"
/// or "kulla-conty", gives back the light of further bounces; ValueError where the tables of the
/// lobe have no albedo for it.
///
/// >>> import microfacet
/// >>> lobe = microfacet.StudentT(0.3, 2.5)
/// >>> gold = microfacet.Conductor(lobe, metal="gold", compensation="kulla-conty")
/// >>> r, g, b = gold.eval([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8])
/// >>> bool(r > g > b)
/// True
#[pyclass(name = "Conductor", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyConductor {}

#[pymethods]
impl PyConductor {
    #[new]
    #[pyo3(signature = (lobe, *, f0=None, f82=None, eta=None, k=None, metal=None,
                        masking="height-correlated", compensation="none", stand_in=false,
                        **others),
           text_signature = "(lobe, *, f0=None, f82=None, eta=None, k=None, metal=None, \
                             masking='height-correlated', compensation='none', stand_in=False)")]
    #[expect(clippy::too_many_arguments, reason = "by keyword")]
    fn new(
        py: Python<'_>,
        lobe: &Bound<'_, PyLobe>,
        f0: Option<&Any>,
        f82: Option<&Any>,
        eta: Option<&Any>,
        k: Option<&Any>,
        metal: Option<&str>,
        masking: &str,
        compensation: &str,
        stand_in: bool,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        words::lead_on("Conductor", others)?;
        let fresnel: ConductorFresnel = match (metal, eta, k, f0, f82) {
            (None, None, None, None, None) => ConductorFresnel::mirror(),
            (Some(metal), None, None, None, None) => words::metal(py, metal)?.into(),
            (None, Some(eta), Some(k), None, None) => {
                ConductorFresnel::exact(words::colour("eta", eta)?, words::colour("k", k)?)
                    .map_err(unbound)?
            }
            (None, None, None, Some(f0), None) => {
                ConductorFresnel::schlick(words::reflectance("f0", f0)?).map_err(unbound)?
            }
            (None, None, None, Some(f0), Some(tint)) => {
                let [f0, tint] = [("f0", f0), ("f82", tint)]
                    .map(|(name, colour)| words::reflectance(name, colour));
                ConductorFresnel::f82_tint(f0?, tint?).map_err(unbound)?
            }
            _ => {
                return Err(refused(
                    "the reflectance must be one of metal, eta with k, f0, and f0 with f82",
                ));
            }
        };
        let about = format!("Conductor({})", lobe.repr()?);
        let form = Form::new(masking, compensation, stand_in)?;
        let bsdf = Material::conductor(lobe.get(), fresnel, &form)?;
        Ok(PyBsdf::made(bsdf, about, 1).add_subclass(Self {}))
    }
}

/// A rough dielectric of a lobe, of index eta in [1e-3, 1e3], inside over outside: every facet
/// reflects and refracts.
///
/// A compensation needs a set of tables that was baked for the material; see Conductor.
///
/// >>> import microfacet
/// >>> glass = microfacet.Dielectric(microfacet.StudentT(0.3, 2.5), eta=1.5)
/// >>> v, above, below = [0.6, 0.0, 0.8], [-0.6, 0.0, 0.8], [-0.4, 0.0, -0.9165151]
/// >>> bool((glass.eval(v, [above, below]) > 0.0).all())
/// True
#[pyclass(name = "Dielectric", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyDielectric {}

#[pymethods]
impl PyDielectric {
    #[new]
    #[pyo3(signature = (lobe, eta=None, *, masking="height-correlated", compensation="none",
                        stand_in=false, **others),
           text_signature = "(lobe, eta, *, masking='height-correlated', compensation='none', \
                             stand_in=False)")]
    fn new(
        lobe: &Bound<'_, PyLobe>,
        eta: Option<f64>,
        masking: &str,
        compensation: &str,
        stand_in: bool,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        words::lead_on("Dielectric", others)?;
        let eta = words::index(eta)?;
        let about = format!("Dielectric({}, eta={eta})", lobe.repr()?);
        let form = Form::new(masking, compensation, stand_in)?;
        let bsdf = Material::dielectric(lobe.get(), eta, &form)?;
        Ok(PyBsdf::made(bsdf, about, 1).add_subclass(Self {}))
    }
}

/// A rough dielectric coat of a lobe, of index eta, over a diffuse base, a colour in [0, 1].
///
/// A compensation needs a set of tables that was baked for the coat; see Conductor.
///
/// >>> import microfacet
/// >>> red = microfacet.Plastic(microfacet.StudentT(0.1, 2.5), eta=1.5, base=(0.8, 0.1, 0.1))
/// >>> r, g, b = red.eval([0.6, 0.0, 0.8], [0.0, 0.0, 1.0])
/// >>> bool(r > g == b)
/// True
#[pyclass(name = "Plastic", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyPlastic {}

#[pymethods]
impl PyPlastic {
    #[new]
    #[pyo3(signature = (lobe, eta=None, base=None, *, masking="height-correlated",
                        compensation="none", stand_in=false, **others),
           text_signature = "(lobe, eta, base, *, masking='height-correlated', \
                             compensation='none', stand_in=False)")]
    fn new(
        lobe: &Bound<'_, PyLobe>,
        eta: Option<f64>,
        base: Option<&Any>,
        masking: &str,
        compensation: &str,
        stand_in: bool,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        words::lead_on("Plastic", others)?;
        let eta = words::index(eta)?;
        let base = base.ok_or_else(|| PyTypeError::new_err("base is missing: a colour"))?;
        let about = format!("Plastic({}, eta={eta})", lobe.repr()?);
        let base = words::reflectance("base", base)?;
        let form = Form::new(masking, compensation, stand_in)?;
        let bsdf = Material::plastic(lobe.get(), eta, base, &form)?;
        Ok(PyBsdf::made(bsdf, about, 1).add_subclass(Self {}))
    }

    /// The shares of the light of views v that one bounce off the coat reflects and transmits,
    /// shape (..., 2), each in [0, 1]; what is missing to 1 is lost to further bounces.
    fn coat_shares<'py>(slf: &Bound<'py, Self>, v: &Any<'py>) -> PyResult<Any<'py>> {
        let input = Input::directions("v", v)?;
        let coat = One(slf.as_super().get().plastic()?);
        let shares = |(coat, v): (&Plastic<Lobe>, [f32; 3])| coat.coat_shares(v);
        each(slf.py(), (coat, &input), Cost::Lookup, shares)
    }

    /// The share of diffuse light from inside that the coat does not reflect, in (0, 1].
    #[getter]
    fn leaving(slf: &Bound<'_, Self>) -> PyResult<f32> {
        slf.as_super().get().plastic().map(Plastic::leaving)
    }
}

/// A sample, its density and its event in numbers: zeros of a path that ends.
fn drawn(sample: Option<(BsdfSample, f32)>) -> [f32; 10] {
    let Some((sample, pdf)) = sample else { return [0.0; 10] };
    let ([x, y, z], [r, g, b]) = (sample.l, sample.weight);
    let [other, delta] =
        [sample.event == Event::Transmission, sample.delta].map(|flag| f32::from(u8::from(flag)));
    [x, y, z, r, g, b, pdf, sample.eta, other, delta]
}
