//! Lobes in single precision, by tables.

use std::sync::Arc;

use bytemuck::{cast_slice, cast_slice_mut};
use glam::Vec3;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Lobe, MicrofacetDistribution, Skew, Tables};
use microfacet_sampler::lobe::LobeKey;

use crate::arrays::{Cost, Input, each, each2, map, map2};
use crate::tables::{PyTables, embedded};
use crate::words::{self, refused, unbound};

/// A lobe with the tables that it is from: any distribution of microfacet normals.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, away
/// from the surface. Arguments broadcast; results are float32.
#[pyclass(name = "Lobe", module = "microfacet", subclass, frozen)]
pub(crate) struct PyLobe {
    pub(crate) lobe: Lobe,
    pub(crate) tables: Arc<Tables>,
    about: String,
}

impl PyLobe {
    pub(crate) fn new(lobe: impl Into<Lobe>, tables: &Arc<Tables>, about: String) -> Self {
        Self { lobe: lobe.into(), tables: Arc::clone(tables), about }
    }

    pub(crate) fn about(&self) -> &str {
        &self.about
    }

    fn albedo_of(&self, form: &str, may_stand_in: bool) -> PyResult<Albedo> {
        let masking = words::masking(form)?;
        let stand_in = words::stand_in(may_stand_in);
        self.tables.albedo_of(&self.lobe, masking, stand_in).map_err(unbound)
    }

    /// The views of an albedo; cosines where they suffice.
    fn views<'py>(
        &self,
        v: Option<&Bound<'py, PyAny>>,
        cos_theta: Option<&Bound<'py, PyAny>>,
        masking: &str,
    ) -> PyResult<View<'py, f32>> {
        let view = view(v, cos_theta)?;
        let turned = match self.lobe.key() {
            LobeKey::Upright(lobe) => !lobe.roughness.is_isotropic(),
            key => matches!(key, LobeKey::Tilted { .. }),
        };
        // The round lobe that stands in has no azimuth, a table of the lobe itself has.
        if turned && matches!(view, View::Cosines(_)) && self.albedo_of(masking, false).is_ok() {
            return Err(azimuth_matters());
        }
        Ok(view)
    }
}

#[pymethods]
impl PyLobe {
    /// The normal distribution function D(m), per steradian.
    ///
    /// D(m) (m.n) integrates to 1 over all m; 0 for an m at or below the horizon.
    fn d<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        each(py, &Input::new("m", m)?, Cost::Lookup, |m: [f32; 3]| [self.lobe.d(m.into())])
    }

    /// Smith's masking G1(v), in [0, 1]; 0 at and below the horizon.
    fn g1<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        map(py, &Input::new("v", v)?, Cost::Lookup, |v: &[[f32; 3]], out: &mut [[f32; 1]]| {
            let out = out.as_flattened_mut();
            self.lobe.g1_batch(cast_slice(v), out).expect("as many of each");
        })
    }

    /// Smith's Lambda(v) = 1/G1 - 1; infinite at and below the horizon.
    fn lambda_<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        each(py, &Input::new("v", v)?, Cost::Lookup, |v: [f32; 3]| [self.lobe.lambda(v.into())])
    }

    /// Masking and shadowing G2(v, l), in [0, 1].
    ///
    /// masking is "height-correlated", 1/(1 + Lambda(v) + Lambda(l)), or "uncorrelated",
    /// G1(v) G1(l).
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn g2<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        l: &Bound<'py, PyAny>,
        masking: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let form = words::masking(masking)?;
        let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
        each2(py, ("v", &v), ("l", &l), Cost::Lookup, |v: [f32; 3], l: [f32; 3]| {
            [self.lobe.g2(v.into(), l.into(), form)]
        })
    }

    /// Draws visible normals m, shape (..., 3), from views v and uniform numbers u, shape (..., 2).
    ///
    /// u in [0, 1] is clamped to it. m is of unit length and above the horizon, and v.m >= 0 for
    /// a view from above. GGX is drawn from tables, too, where the set has them for gamma = 2.
    fn sample_visible_normal<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        u: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (v, u) = (Input::new("v", v)?, Input::new("u", u)?);
        map2(
            py,
            ("v", &v),
            ("u", &u),
            Cost::Lookup,
            |v: &[[f32; 3]], u: &[[f32; 2]], m: &mut [[f32; 3]]| {
                let done = self.lobe.sample_batch(cast_slice(v), u, cast_slice_mut(m));
                done.expect("as many of each");
            },
        )
    }

    /// The density of visible normals, G1(v) max(0, v.m) D(m)/(v.n), per steradian of m.
    fn visible_normal_pdf<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        m: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (v, m) = (Input::new("v", v)?, Input::new("m", m)?);
        each2(py, ("v", &v), ("m", &m), Cost::Lookup, |v: [f32; 3], m: [f32; 3]| {
            [self.lobe.visible_normal_pdf(v.into(), m.into())]
        })
    }

    /// G2(v, l)/G1(v), in [0, 1]: the weight f cos/pdf of a light l reflected off a drawn visible
    /// normal, without Fresnel.
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn reflection_weight<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        l: &Bound<'py, PyAny>,
        masking: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let form = words::masking(masking)?;
        let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
        each2(py, ("v", &v), ("l", &l), Cost::Lookup, |v: [f32; 3], l: [f32; 3]| {
            [self.lobe.reflection_weight(v.into(), l.into(), form)]
        })
    }

    /// The directional albedo E(v) of one bounce with F = 1, in [0, 1].
    ///
    /// v are directions, shape (..., 3), or one number, which is cos theta and enough for a round
    /// lobe; cosines in an array go into cos_theta instead. ValueError where the tables have no
    /// albedo of the lobe: stand_in=True then takes the round lobe of sqrt(sigma_x sigma_y).
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None, stand_in=false))]
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Bound<'py, PyAny>>,
        masking: &str,
        cos_theta: Option<&Bound<'py, PyAny>>,
        stand_in: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let albedo = self.albedo_of(masking, stand_in)?;
        let views = self.views(v, cos_theta, masking)?;
        of_views(py, views, |v| [albedo.albedo(v)])
    }

    /// The parts scale, bias and F82 of E(v), shape (..., 3), each in [0, 1].
    ///
    /// Schlick's reflectance F0 + (F90 - F0)(1 - v.m)^5 has the albedo F0 scale + F90 bias, and
    /// scale + bias = E; F82 is the moment of the dip of OpenPBR's tint. Arguments are those of
    /// albedo.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None, stand_in=false))]
    fn albedo_parts<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Bound<'py, PyAny>>,
        masking: &str,
        cos_theta: Option<&Bound<'py, PyAny>>,
        stand_in: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let albedo = self.albedo_of(masking, stand_in)?;
        let views = self.views(v, cos_theta, masking)?;
        of_views(py, views, |v| {
            let moments = albedo.moments(v);
            [moments.scale, moments.bias, moments.f82]
        })
    }

    /// The average of E over the hemisphere of views, weighted by the cosine, in [0, 1].
    #[pyo3(signature = (masking="height-correlated", *, stand_in=false))]
    fn albedo_average(&self, masking: &str, stand_in: bool) -> PyResult<f32> {
        Ok(self.albedo_of(masking, stand_in)?.albedo_average())
    }

    /// The averages of the parts scale, bias and F82.
    #[pyo3(signature = (masking="height-correlated", *, stand_in=false))]
    fn albedo_average_parts(&self, masking: &str, stand_in: bool) -> PyResult<(f32, f32, f32)> {
        let moments = self.albedo_of(masking, stand_in)?.average_moments();
        Ok((moments.scale, moments.bias, moments.f82))
    }

    /// Whether a renderer should treat the surface as a mirror: mean slopes are below 1e-3.
    #[getter]
    fn is_effectively_smooth(&self) -> bool {
        self.lobe.is_effectively_smooth()
    }

    /// Seconds that Rust takes on one thread for `sample_visible_normal` of the same arrays, which
    /// must be float32 and of one length: what the method is compared with.
    fn _seconds_in_rust<'py>(
        &self,
        v: numpy::PyReadonlyArray2<'py, f32>,
        u: numpy::PyReadonlyArray2<'py, f32>,
    ) -> PyResult<f64> {
        let v = v.as_array();
        let (v, u) = (v.as_slice().map(|v| v.as_chunks().0), u.as_slice()?.as_chunks().0);
        let v: &[[f32; 3]] = v.ok_or_else(|| refused("v must be contiguous"))?;
        let mut m = Vec::new();
        m.try_reserve_exact(v.len()).map_err(|why| PyMemoryError::new_err(why.to_string()))?;
        m.resize(v.len(), Vec3::ZERO);
        let start = std::time::Instant::now();
        self.lobe.sample_batch(cast_slice(v), u, &mut m).map_err(refused)?;
        Ok(start.elapsed().as_secs_f64())
    }

    fn __repr__(&self) -> &str {
        &self.about
    }
}

/// Views: directions, or their cosines.
pub(crate) enum View<'py, T: numpy::Element> {
    Directions(Input<'py, T, 3>),
    Cosines(Input<'py, T, 1>),
}

/// What is known of views, in single precision.
pub(crate) fn of_views<'py, const M: usize>(
    py: Python<'py>,
    views: View<'py, f32>,
    of: impl Fn(Vec3) -> [f32; M] + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    match views {
        View::Directions(v) => each(py, &v, Cost::Lookup, |v: [f32; 3]| of(v.into())),
        View::Cosines(cos) => {
            each(py, &cos, Cost::Lookup, |[cos]: [f32; 1]| of(Vec3::new(0.0, 0.0, cos)))
        }
    }
}

/// Takes what the methods `albedo` are given for a view.
pub(crate) fn view<'py, T: numpy::Element + Copy + Send + Sync + Into<f64>>(
    v: Option<&Bound<'py, PyAny>>,
    cos_theta: Option<&Bound<'py, PyAny>>,
) -> PyResult<View<'py, T>> {
    match (v, cos_theta) {
        (Some(v), None) if v.extract::<f64>().is_ok() => Ok(View::Cosines(Input::new("v", v)?)),
        (Some(v), None) => {
            let v = Input::<T, 3>::new("v", v)?;
            // Three cosines look like one direction, though rarely of length 1.
            let square = |[v]: [[T; 3]; 1]| v.map(|x| x.into().powi(2)).iter().sum::<f64>();
            if v.batch().is_empty() && (square(v.first()) - 1.0).abs() > 1e-3 {
                return Err(refused(
                    "v is no unit vector; an array of cosines goes into cos_theta",
                ));
            }
            Ok(View::Directions(v))
        }
        (None, Some(cos)) => Ok(View::Cosines(Input::new("cos_theta", cos)?)),
        _ => Err(refused("give either v, directions of shape (..., 3), or cos_theta")),
    }
}

/// The error for cosines where they do not suffice.
pub(crate) fn azimuth_matters() -> PyErr {
    refused(
        "the lobe is not round, so that its albedo depends on the azimuth of the view: give v as \
         directions of shape (..., 3)",
    )
}

/// A member of the Student-t family with roughness sigma, a number or (sigma_x, sigma_y), each in
/// [1e-8, 1e6], and shape gamma in [1.501, inf]: 2 is GGX, inf is Beckmann.
///
/// StudentT(sigma, gamma) reads the default tables; Tables.student_t reads others.
#[pyclass(name = "StudentT", module = "microfacet", extends = PyLobe, frozen)]
pub(crate) struct PyStudentT {
    sigma: [f64; 2],
    gamma: f64,
}

impl PyStudentT {
    pub(crate) fn make(
        py: Python<'_>,
        tables: &Arc<Tables>,
        sigma: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<Py<Self>> {
        Py::new(py, Self::parts(tables, sigma, gamma)?)
    }

    fn parts(
        tables: &Arc<Tables>,
        sigma: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let sigma = words::sigma(sigma)?;
        let lobe = tables.lobe(sigma, gamma).map_err(refused)?;
        let sigma = sigma.0;
        let about = match sigma {
            [x, y] if x == y => format!("StudentT(sigma={x}, gamma={gamma})"),
            [x, y] => format!("StudentT(sigma=({x}, {y}), gamma={gamma})"),
        };
        Ok(PyClassInitializer::from(PyLobe::new(lobe, tables, about))
            .add_subclass(Self { sigma, gamma }))
    }
}

#[pymethods]
impl PyStudentT {
    #[new]
    fn new(sigma: &Bound<'_, PyAny>, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        Self::parts(&embedded(), sigma, gamma)
    }

    /// Roughness along x and y.
    #[getter]
    fn sigma(&self) -> (f64, f64) {
        self.sigma.into()
    }

    /// Shape.
    #[getter]
    fn gamma(&self) -> f64 {
        self.gamma
    }
}

/// A Student-t lobe tilted and turned: roughness sigma along two axes of an ellipsoid whose third
/// has 1, turned by theta = (x, y, z) in radians about z first, then y, then x.
#[pyclass(name = "Ellipsoid", module = "microfacet", extends = PyLobe, frozen)]
pub(crate) struct PyEllipsoid {}

impl PyEllipsoid {
    pub(crate) fn make(
        py: Python<'_>,
        tables: &Arc<Tables>,
        sigma: &Bound<'_, PyAny>,
        theta: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<Py<Self>> {
        Py::new(py, Self::parts(tables, sigma, theta, gamma)?)
    }

    fn parts(
        tables: &Arc<Tables>,
        sigma: &Bound<'_, PyAny>,
        theta: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let sigma = words::sigma(sigma)?;
        let theta = words::angles(theta)?;
        let skew = Skew::new(sigma, theta).map_err(refused)?;
        let lobe = tables.ellipsoid(skew, gamma).map_err(refused)?;
        let about = format!(
            "Ellipsoid(sigma=({}, {}), theta=({}, {}, {}), gamma={gamma})",
            sigma.0[0], sigma.0[1], theta[0], theta[1], theta[2]
        );
        Ok(PyClassInitializer::from(PyLobe::new(lobe, tables, about)).add_subclass(Self {}))
    }
}

#[pymethods]
impl PyEllipsoid {
    #[new]
    fn new(
        sigma: &Bound<'_, PyAny>,
        theta: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        Self::parts(&embedded(), sigma, theta, gamma)
    }
}

/// For use by others of this crate.
pub(crate) fn named(tables: &PyTables, name: &str) -> PyResult<PyLobe> {
    let lobe = tables.set.material(name).map_err(refused)?;
    Ok(PyLobe::new(lobe, &tables.set, format!("Lobe({name:?})")))
}
