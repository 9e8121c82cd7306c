//! Complete materials.

use pyo3::basic::CompareOp;
use pyo3::prelude::*;
use pyo3::types::{PyEllipsis, PySlice, PyTuple};

use microfacet_sampler::{
    AnyBsdf, Bsdf, Conductor, ConductorFresnel, Dielectric, Event, Lobe, Metal, Plastic,
};

use crate::arrays::{Any, Cost, Input, each, each2, each3};
use crate::lobe::PyLobe;
use crate::words::{self, refused, unbound};

/// A bidirectional scattering distribution function in three channels.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, both
/// away from the surface; z < 0 is inside. f excludes the cosine, densities are per steradian of l.
/// Where all events are deltas (a smooth surface) f and density are 0. transport is "radiance", for
/// paths from the camera, which refraction scales by (n_v/n_l)^2, or "importance".
#[pyclass(name = "Bsdf", module = "microfacet", subclass, frozen)]
pub(crate) struct PyBsdf {
    bsdf: AnyBsdf,
    about: String,
}

impl PyBsdf {
    pub(crate) fn new(bsdf: impl Into<AnyBsdf>, about: String) -> Self {
        Self { bsdf: bsdf.into(), about }
    }
}

/// Lights drawn for views, arrays of one shape: a path that ends has l, weight and pdf of 0.
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
    fn eval<'py>(&self, v: &Any<'py>, l: &Any<'py>, transport: &str) -> PyResult<Any<'py>> {
        let mode = words::transport(transport)?;
        let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
        each2(&v, &l, Cost::Lookup, |v: [f32; 3], l: [f32; 3]| self.bsdf.eval(v, l, mode))
    }

    /// The density with which sample draws l for v, per steradian.
    fn pdf<'py>(&self, v: &Any<'py>, l: &Any<'py>) -> PyResult<Any<'py>> {
        let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
        each2(&v, &l, Cost::Lookup, |v: [f32; 3], l: [f32; 3]| [self.bsdf.pdf(v, l)])
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
        let (v, choice) = (Input::new("v", v)?, Input::new("choice", choice)?);
        let u = Input::new("u", u)?;
        let draw = |v: [f32; 3], [choice]: [f32; 1], u: [f32; 2]| {
            let Some((sample, pdf)) = self.bsdf.sample_with_pdf(v, choice, u, mode) else {
                return [0.0; 10];
            };
            let ([x, y, z], [r, g, b]) = (sample.l, sample.weight);
            let [other, delta] = [sample.event == Event::Transmission, sample.delta]
                .map(|flag| f32::from(u8::from(flag)));
            [x, y, z, r, g, b, pdf, sample.eta, other, delta]
        };
        let all = each3(&v, &choice, &u, Cost::Lookup, draw)?;
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
    fn is_delta(&self) -> bool {
        Bsdf::<3>::is_delta(&self.bsdf)
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
#[pyclass(name = "Conductor", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyConductor {}

#[pymethods]
impl PyConductor {
    #[new]
    #[pyo3(signature = (lobe, *, f0=None, f82=None, eta=None, k=None, metal=None,
                        masking="height-correlated", compensation="none", stand_in=false))]
    #[expect(clippy::too_many_arguments, reason = "by keyword")]
    fn new(
        lobe: &Bound<'_, PyLobe>,
        f0: Option<&Any>,
        f82: Option<&Any>,
        eta: Option<&Any>,
        k: Option<&Any>,
        metal: Option<&str>,
        masking: &str,
        compensation: &str,
        stand_in: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let fresnel: ConductorFresnel = match (metal, eta, k, f0, f82) {
            (None, None, None, None, None) => ConductorFresnel::mirror(),
            (Some(metal), None, None, None, None) => {
                let why = |why| refused(format!("metal \"{metal}\": {why}"));
                metal.parse::<Metal>().map_err(why)?.into()
            }
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
        let PyLobe { lobe, tables } = lobe.get();
        let settings = words::settings(masking, compensation, tables, stand_in)?;
        let conductor = Conductor::new(Lobe::clone(lobe), fresnel, settings).map_err(unbound)?;
        Ok(PyClassInitializer::from(PyBsdf::new(conductor, about)).add_subclass(Self {}))
    }
}

/// A rough dielectric of a lobe, of index eta in [1e-3, 1e3], inside over outside: every facet
/// reflects and refracts.
///
/// A compensation needs a set of tables that was baked for the material; see Conductor.
#[pyclass(name = "Dielectric", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyDielectric {}

#[pymethods]
impl PyDielectric {
    #[new]
    #[pyo3(signature = (lobe, eta, *, masking="height-correlated", compensation="none",
                        stand_in=false))]
    fn new(
        lobe: &Bound<'_, PyLobe>,
        eta: f64,
        masking: &str,
        compensation: &str,
        stand_in: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let about = format!("Dielectric({}, eta={eta})", lobe.repr()?);
        let PyLobe { lobe, tables } = lobe.get();
        let settings = words::settings(masking, compensation, tables, stand_in)?;
        let dielectric = Dielectric::new(Lobe::clone(lobe), eta, settings).map_err(unbound)?;
        Ok(PyClassInitializer::from(PyBsdf::new(dielectric, about)).add_subclass(Self {}))
    }
}

/// A rough dielectric coat of a lobe, of index eta, over a diffuse base, a colour in [0, 1].
///
/// A compensation needs a set of tables that was baked for the coat; see Conductor.
#[pyclass(name = "Plastic", module = "microfacet", extends = PyBsdf, frozen)]
pub(crate) struct PyPlastic(Plastic<Lobe>);

#[pymethods]
impl PyPlastic {
    #[new]
    #[pyo3(signature = (lobe, eta, base, *, masking="height-correlated", compensation="none",
                        stand_in=false))]
    fn new(
        lobe: &Bound<'_, PyLobe>,
        eta: f64,
        base: &Any,
        masking: &str,
        compensation: &str,
        stand_in: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let about = format!("Plastic({}, eta={eta})", lobe.repr()?);
        let PyLobe { lobe, tables } = lobe.get();
        let settings = words::settings(masking, compensation, tables, stand_in)?;
        let base = words::reflectance("base", base)?;
        let plastic = Plastic::new(Lobe::clone(lobe), eta, base, settings).map_err(unbound)?;
        let bsdf = PyBsdf::new(plastic.clone(), about);
        Ok(PyClassInitializer::from(bsdf).add_subclass(Self(plastic)))
    }

    /// The shares of the light of views v that one bounce off the coat reflects and transmits,
    /// shape (..., 2), each in [0, 1]; what is missing to 1 is lost to further bounces.
    fn coat_shares<'py>(&self, v: &Any<'py>) -> PyResult<Any<'py>> {
        let v = Input::new("v", v)?;
        each(&v, Cost::Lookup, |v: [f32; 3]| self.0.coat_shares(v))
    }

    /// The share of diffuse light from inside that the coat does not reflect, in (0, 1].
    #[getter]
    fn leaving(&self) -> f32 {
        self.0.leaving()
    }
}
