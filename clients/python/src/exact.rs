//! The model in double precision.

use std::sync::OnceLock;

use glam::DVec3;
use microfacet_core::schlick::{f82_weight, schlick_weight};
use microfacet_model::{
    Albedo, AlbedoIntegrator, Ellipsoid, MicrofacetDistribution, ParameterError, Shape, Skew,
    StudentT,
};
use pyo3::prelude::*;

use crate::arrays::{Cost, Input, each, each2};
use crate::lobe::{View, azimuth_matters, view};
use crate::words::{self, refused};

/// Error that the quadrature of albedos aims at.
const TOLERANCE: f64 = 1e-9;

/// Of a tilted lobe, whose clamped masking has a kink.
const TOLERANCE_TILTED: f64 = 1e-6;

/// A member of the family, or one seen through a matrix.
enum Model {
    Family(StudentT),
    Skewed(Box<Ellipsoid>),
}

/// Calls one function of whichever it is.
macro_rules! of {
    ($model:expr, $one:ident => $call:expr) => {
        match $model {
            Model::Family($one) => $call,
            Model::Skewed($one) => $call,
        }
    };
}

/// A lobe by the model, in double precision: closed forms, quadrature, and roots to rounding.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, away
/// from the surface. Arguments broadcast; results are float64.
#[pyclass(name = "Lobe", module = "microfacet.exact", subclass, frozen)]
pub(crate) struct ExactLobe {
    model: Model,
    about: String,
    integrator: OnceLock<AlbedoIntegrator>,
}

impl ExactLobe {
    fn new(model: Model, about: String) -> Self {
        Self { model, about, integrator: OnceLock::new() }
    }

    fn shape(&self) -> &Shape {
        of!(&self.model, lobe => lobe.shape())
    }

    /// Made once, in some milliseconds.
    fn integrator(&self) -> &AlbedoIntegrator {
        let tolerance = match self.model {
            Model::Family(_) => TOLERANCE,
            Model::Skewed(_) => TOLERANCE_TILTED,
        };
        self.integrator.get_or_init(|| AlbedoIntegrator::new(*self.shape(), tolerance))
    }

    /// Roughness of a round lobe, for which the azimuth of a view does not matter.
    fn round(&self) -> Option<f64> {
        match &self.model {
            Model::Family(lobe) if lobe.sigma_x() == lobe.sigma_y() => Some(lobe.sigma_x()),
            _ => None,
        }
    }

    /// Albedos of a view from above, given by cosine and azimuth, under Fresnel weights.
    fn directional<const N: usize>(
        &self,
        cos: f64,
        phi: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        let integrator = self.integrator();
        match (&self.model, self.round()) {
            (_, Some(sigma)) => integrator.reflection(sigma, cos, weight),
            (Model::Family(lobe), None) => {
                let sigma = [lobe.sigma_x(), lobe.sigma_y()];
                integrator.reflection_anisotropic(sigma, cos, phi, weight)
            }
            (Model::Skewed(lobe), None) => integrator.reflection_skewed(lobe, cos, phi, weight),
        }
    }

    /// Albedos of views; NaN for those from below.
    fn albedos<'py, const N: usize>(
        &self,
        py: Python<'py>,
        v: Option<&Bound<'py, PyAny>>,
        masking: &str,
        cos_theta: Option<&Bound<'py, PyAny>>,
        weight: impl Fn(f64) -> [f64; N] + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let form = words::masking(masking)?;
        let e = |cos: f64, phi: f64| {
            // Rounding may take the cosine of a unit vector beyond 1.
            let cos = if cos <= 1.0 + 1e-12 { cos.min(1.0) } else { cos };
            self.directional(cos, phi, &weight).map_or([f64::NAN; N], |albedo| albedo.of(form))
        };
        py.detach(|| self.integrator());
        match view::<f64>(v, cos_theta)? {
            View::Directions(v) => {
                each(py, &v, Cost::Quadrature, |[x, y, z]: [f64; 3]| e(z, y.atan2(x)))
            }
            View::Cosines(_) if self.round().is_none() => Err(azimuth_matters()),
            View::Cosines(cos) => each(py, &cos, Cost::Quadrature, |[cos]: [f64; 1]| e(cos, 0.0)),
        }
    }
}

#[pymethods]
impl ExactLobe {
    /// The normal distribution function D(m), per steradian.
    fn d<'py>(&self, py: Python<'py>, m: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        each(py, &Input::new("m", m)?, Cost::Lookup, |m| {
            let m = DVec3::from_array(m);
            [of!(&self.model, lobe => lobe.d(m))]
        })
    }

    /// Smith's masking G1(v), in [0, 1].
    fn g1<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        each(py, &Input::new("v", v)?, Cost::Lookup, |v| {
            let v = DVec3::from_array(v);
            [of!(&self.model, lobe => lobe.g1(v))]
        })
    }

    /// Smith's Lambda(v) = 1/G1 - 1.
    fn lambda_<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        each(py, &Input::new("v", v)?, Cost::Lookup, |v| {
            let v = DVec3::from_array(v);
            [of!(&self.model, lobe => lobe.lambda(v))]
        })
    }

    /// Masking and shadowing G2(v, l), in [0, 1]; masking is "height-correlated" or "uncorrelated".
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
        each2(py, ("v", &v), ("l", &l), Cost::Lookup, |v: [f64; 3], l: [f64; 3]| {
            [of!(&self.model, lobe => lobe.g2(v.into(), l.into(), form))]
        })
    }

    /// Draws visible normals m, shape (..., 3), from views v and uniform numbers u, shape (..., 2),
    /// by inverting distributions to rounding, in some ten microseconds each.
    fn sample_visible_normal<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        u: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (v, u) = (Input::new("v", v)?, Input::new("u", u)?);
        each2(py, ("v", &v), ("u", &u), Cost::Quadrature, |v: [f64; 3], u: [f64; 2]| {
            of!(&self.model, lobe => lobe.sample_visible_normal(v.into(), u)).to_array()
        })
    }

    /// The density of visible normals, G1(v) max(0, v.m) D(m)/(v.n), per steradian of m.
    fn visible_normal_pdf<'py>(
        &self,
        py: Python<'py>,
        v: &Bound<'py, PyAny>,
        m: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (v, m) = (Input::new("v", v)?, Input::new("m", m)?);
        each2(py, ("v", &v), ("m", &m), Cost::Lookup, |v: [f64; 3], m: [f64; 3]| {
            [of!(&self.model, lobe => lobe.visible_normal_pdf(v.into(), m.into()))]
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
        each2(py, ("v", &v), ("l", &l), Cost::Lookup, |v: [f64; 3], l: [f64; 3]| {
            [of!(&self.model, lobe => lobe.reflection_weight(v.into(), l.into(), form))]
        })
    }

    /// The directional albedo E(v) of one bounce with F = 1, in [0, 1], by quadrature: to 1e-9 of a
    /// lobe of the family, in some hundred microseconds; to 1e-6 of an ellipsoid.
    ///
    /// v are directions, shape (..., 3), or one number, which is cos theta and enough for a round
    /// lobe; cosines in an array go into cos_theta instead. A view from below is NaN.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None))]
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Bound<'py, PyAny>>,
        masking: &str,
        cos_theta: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.albedos(py, v, masking, cos_theta, |_| [1.0])
    }

    /// The parts scale, bias and F82 of E(v), shape (..., 3); arguments are those of albedo, and
    /// the parts those of microfacet.Lobe.albedo_parts.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None))]
    fn albedo_parts<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Bound<'py, PyAny>>,
        masking: &str,
        cos_theta: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.albedos(py, v, masking, cos_theta, |cos| {
            let bias = schlick_weight(cos);
            [1.0 - bias, bias, f82_weight(cos)]
        })
    }

    /// The average of E over the hemisphere of views, weighted by the cosine, in [0, 1]; of round
    /// lobes alone.
    #[pyo3(signature = (masking="height-correlated"))]
    fn albedo_average(&self, py: Python<'_>, masking: &str) -> PyResult<f64> {
        let form = words::masking(masking)?;
        let sigma = self.round().ok_or_else(|| {
            refused("averages are integrated for round lobes alone; average albedo(v) over views")
        })?;
        let average = py.detach(|| self.integrator().average(sigma, |_| [1.0]));
        Ok(average.map_err(refused)?.of(form)[0])
    }

    /// Shape.
    #[getter]
    fn gamma(&self) -> f64 {
        self.shape().gamma()
    }

    fn __repr__(&self) -> &str {
        &self.about
    }
}

/// A member of the Student-t family in double precision: roughness sigma > 0, a number or (sigma_x,
/// sigma_y), and shape gamma in (1.5, inf].
#[pyclass(name = "StudentT", module = "microfacet.exact", extends = ExactLobe, frozen)]
pub(crate) struct ExactStudentT {}

#[pymethods]
impl ExactStudentT {
    #[new]
    fn new(sigma: &Bound<'_, PyAny>, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        let lobe = StudentT::new(words::sigma(sigma)?, gamma).map_err(refused)?;
        let about =
            format!("StudentT(sigma=({}, {}), gamma={gamma})", lobe.sigma_x(), lobe.sigma_y());
        Ok(PyClassInitializer::from(ExactLobe::new(Model::Family(lobe), about))
            .add_subclass(Self {}))
    }
}

/// A Student-t lobe tilted and turned, in double precision; arguments are those of
/// microfacet.Ellipsoid.
#[pyclass(name = "Ellipsoid", module = "microfacet.exact", extends = ExactLobe, frozen)]
pub(crate) struct ExactEllipsoid {}

#[pymethods]
impl ExactEllipsoid {
    #[new]
    fn new(
        sigma: &Bound<'_, PyAny>,
        theta: &Bound<'_, PyAny>,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let skew = Skew::new(words::sigma(sigma)?, words::angles(theta)?).map_err(refused)?;
        let lobe = Ellipsoid::new(skew, gamma).map_err(refused)?;
        let about = format!("Ellipsoid(gamma={gamma})");
        Ok(PyClassInitializer::from(ExactLobe::new(Model::Skewed(Box::new(lobe)), about))
            .add_subclass(Self {}))
    }
}
