//! The model in double precision.

use std::sync::OnceLock;

use microfacet_core::schlick::{f82_weight, schlick_weight};
use microfacet_model::{
    Albedo, AlbedoIntegrator, Ellipsoid, ParameterError, Shape, Skew, StudentT,
};
use pyo3::prelude::*;

use crate::arrays::{Any, Cost};
use crate::distribution::{Kind, Model, PyDistribution, View, azimuth_matters};
use crate::words::{self, refused};

/// Tolerance of the quadrature of albedos.
const TOLERANCE: f64 = 1e-9;

/// Tolerance for a tilted lobe, whose clamped masking has a kink.
const TOLERANCE_TILTED: f64 = 1e-6;

/// A lobe by the model, in double precision: closed forms, quadrature, and roots to rounding.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, away
/// from the surface. Arguments broadcast; results are float64. Visible normals are drawn by
/// inverting distributions to rounding, in some ten microseconds each.
///
/// >>> from microfacet import exact
/// >>> lobe = exact.StudentT(0.3, 2.5)
/// >>> m = lobe.sample_visible_normal([0.6, 0.0, 0.8], [[0.3, 0.7], [0.5, 0.5]])
/// >>> m.shape, m.dtype.name
/// ((2, 3), 'float64')
#[pyclass(name = "Lobe", module = "microfacet.exact", extends = PyDistribution, subclass, frozen)]
pub(crate) struct ExactLobe {
    model: Model,
    integrator: OnceLock<AlbedoIntegrator>,
}

impl ExactLobe {
    fn new(model: Model, about: String) -> PyClassInitializer<Self> {
        PyDistribution::new(Kind::Exact(model.clone()), about)
            .add_subclass(Self { model, integrator: OnceLock::new() })
    }

    fn shape(&self) -> &Shape {
        match &self.model {
            Model::Family(lobe) => lobe.shape(),
            Model::Skewed(lobe) => lobe.shape(),
        }
    }

    /// Made once, which takes some milliseconds.
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
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        weight: impl Fn(f64) -> [f64; N] + Sync,
    ) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        let views = View::<f64>::new(v, cos_theta)?;
        if matches!(views, View::Cosines(_)) && self.round().is_none() {
            return Err(azimuth_matters());
        }
        py.detach(|| self.integrator());
        views.each(Cost::Quadrature, |[x, y, z]| {
            // Rounding may take the cosine of a unit vector beyond 1.
            let cos = if z <= 1.0 + 1e-12 { z.min(1.0) } else { z };
            let albedo = self.directional(cos, y.atan2(x), &weight);
            albedo.map_or([f64::NAN; N], |albedo| albedo.of(form))
        })
    }
}

#[pymethods]
impl ExactLobe {
    /// The directional albedo E(v) of one bounce with F = 1, in [0, 1], by quadrature: to 1e-9 of a
    /// lobe of the family, in some hundred microseconds; to 1e-6 of an ellipsoid.
    ///
    /// v are directions, shape (..., 3), or one number, which is cos theta and enough for a round
    /// lobe; cosines in an array go into cos_theta instead. A view from below is NaN.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None))]
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
    ) -> PyResult<Any<'py>> {
        self.albedos(py, v, masking, cos_theta, |_| [1.0])
    }

    /// The parts scale, bias and F82 of E(v), shape (..., 3); arguments are those of albedo, and
    /// the parts those of microfacet.Lobe.albedo_parts.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None))]
    fn albedo_parts<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
    ) -> PyResult<Any<'py>> {
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
}

/// A member of the Student-t family in double precision: roughness sigma > 0, a number or (sigma_x,
/// sigma_y), and shape gamma in (1.5, inf].
///
/// >>> from microfacet import exact
/// >>> round(float(exact.StudentT(sigma=0.3, gamma=2.5).g1([0.6, 0.0, 0.8])), 12)
/// 0.997880175523
#[pyclass(name = "StudentT", module = "microfacet.exact", extends = ExactLobe, frozen)]
pub(crate) struct ExactStudentT {}

#[pymethods]
impl ExactStudentT {
    #[new]
    fn new(sigma: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        let lobe = StudentT::new(words::sigma(sigma)?, gamma).map_err(refused)?;
        let about =
            format!("StudentT(sigma=({}, {}), gamma={gamma})", lobe.sigma_x(), lobe.sigma_y());
        Ok(ExactLobe::new(Model::Family(lobe), about).add_subclass(Self {}))
    }
}

/// A Student-t lobe tilted and turned, in double precision; arguments are those of
/// microfacet.Ellipsoid.
///
/// >>> from microfacet import exact
/// >>> scale = exact.Ellipsoid(sigma=0.3, theta=(0.0, 0.2, 0.0), gamma=2.5)
/// >>> round(float(scale.d([0.0, 0.0, 1.0])), 9)
/// 1.985021129
#[pyclass(name = "Ellipsoid", module = "microfacet.exact", extends = ExactLobe, frozen)]
pub(crate) struct ExactEllipsoid {}

#[pymethods]
impl ExactEllipsoid {
    #[new]
    fn new(sigma: &Any, theta: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        let skew = Skew::new(words::sigma(sigma)?, words::angles(theta)?).map_err(refused)?;
        let lobe = Ellipsoid::new(skew, gamma).map_err(refused)?;
        let about = format!("Ellipsoid(gamma={gamma})");
        Ok(ExactLobe::new(Model::Skewed(Box::new(lobe)), about).add_subclass(Self {}))
    }
}
