//! Tables of one shape for lookups elsewhere, and albedos of dielectrics.

use microfacet_export::Shape;
use microfacet_sampler::Tables;
use microfacet_sampler::albedo::DielectricAlbedo;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Any, Input};
use crate::broadcast::{Cost, One, each};
use crate::words::{one_of, refused};

/// The tables of one shape gamma for any roughness, as exports for C and shaders have them
/// (docs/shaders.md), for lookups that NumPy or another library does.
///
/// >>> import microfacet
/// >>> shape = microfacet.Tables().shape(3.0)
/// >>> shape.gamma, shape.members["is_ggx"], shape.tables["masking"].dtype.name
/// (3.0, 0.0, 'float32')
#[pyclass(name = "Shape", module = "microfacet", frozen, get_all)]
pub(crate) struct PyShape {
    /// The shape.
    gamma: f64,
    /// The numbers of its description by name; flags are 0 or 1.
    members: Py<PyDict>,
    /// Its tables by name, float32 of shape (rows, columns).
    tables: Py<PyDict>,
}

impl PyShape {
    pub(crate) fn bind(py: Python<'_>, set: &Tables, gamma: f64) -> PyResult<Self> {
        let shape = py.detach(|| Shape::bind(set, gamma)).map_err(refused)?;
        let (members, tables) = (PyDict::new(py), PyDict::new(py));
        for (name, value) in shape.numbers() {
            members.set_item(name, value)?;
        }
        for part in shape.parts() {
            let rows = part.values.len() / part.columns;
            let array = PyArray1::from_slice(py, part.values).reshape([rows, part.columns])?;
            array.call_method1("setflags", (false,))?;
            tables.set_item(part.name, array)?;
        }
        Ok(Self { gamma, members: members.into(), tables: tables.into() })
    }
}

#[pymethods]
impl PyShape {
    fn __repr__(&self) -> String {
        format!("Shape(gamma={})", self.gamma)
    }
}

/// What one bounce off and through a rough dielectric returns.
///
/// >>> import microfacet
/// >>> recipe = """[[material]]
/// ... name = "glass"
/// ... sigma = 0.3
/// ... gamma = 2.5
/// ... fresnel = { dielectric = 1.5 }"""
/// >>> tables = microfacet.bake(recipe, quality="draft")
/// >>> albedo = tables.dielectric_albedo(0.3, 2.5, 1.5)
/// >>> reflected, transmitted = albedo.shares(1.0, "outside")
/// >>> bool(0.03 < reflected < 0.04 < 0.95 < transmitted < 0.97)
/// True
#[pyclass(name = "DielectricAlbedo", module = "microfacet", frozen)]
pub(crate) struct PyDielectricAlbedo(pub(crate) DielectricAlbedo);

#[pymethods]
impl PyDielectricAlbedo {
    /// The shares of light that are reflected and transmitted, shape (..., 2), each in [0, 1], for
    /// a view of this cosine on its side of the surface, "outside" or "inside".
    fn shares<'py>(&self, py: Python<'py>, cos_theta: &Any<'py>, side: &str) -> PyResult<Any<'py>> {
        let sides = [("outside", &self.0.outside), ("inside", &self.0.inside)];
        let curve = one_of("side", side, &sides)?;
        let cos = Input::cosines("cos_theta", cos_theta)?;
        each(py, (One(curve), &cos), Cost::Lookup, |(curve, [cos])| curve.eval([0.0, 0.0, cos]))
    }
}
