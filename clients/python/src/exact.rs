//! The model in double precision.

use std::sync::{Arc, OnceLock};

use microfacet_core::Roughness;
use microfacet_core::schlick::{f82_weight, schlick_weight};
use microfacet_model::{
    Albedo, AlbedoIntegrator, Ellipsoid, ParameterError, Shape, Skew, StudentT,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::Any;
use crate::broadcast::{Cost, One, each};
use crate::distribution::{Kind, PyDistribution, View, azimuth_matters, student_t};
use crate::surface::Surface;
use crate::words::{self, refused};

/// Tolerance of the quadrature of albedos.
const TOLERANCE: f64 = 1e-9;

/// The most shapes whose integrators are kept, a few hundred kilobytes each.
const MOST: usize = 256;

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
    kind: Kind,
    /// Of each shape, in rising order; made once, which takes some milliseconds. Of more than
    /// [`MOST`] shapes none is kept.
    integrators: Vec<(Shape, OnceLock<AlbedoIntegrator>)>,
}

impl ExactLobe {
    fn new(kind: Kind, about: String) -> PyClassInitializer<Self> {
        let shapes = match &kind {
            Kind::Exact(lobe) => vec![*lobe.shape()],
            Kind::Tilted(lobe) => vec![*lobe.shape()],
            Kind::ExactFamily(all) => {
                let mut gammas: Vec<f64> = all.gammas().collect();
                gammas.sort_unstable_by(f64::total_cmp);
                gammas.dedup();
                gammas.truncate(if gammas.len() > MOST { 0 } else { MOST });
                gammas.into_iter().map(|gamma| *student_t([1.0; 2], gamma).shape()).collect()
            }
            Kind::Tables(_) | Kind::Family(_) => Vec::new(),
        };
        let integrators = shapes.into_iter().map(|shape| (shape, OnceLock::new())).collect();
        PyDistribution::new(kind.clone(), about).add_subclass(Self { kind, integrators })
    }

    /// What a function makes of the integrator of one shape.
    fn with_integrator<R>(&self, shape: &Shape, f: impl FnOnce(&AlbedoIntegrator) -> R) -> R {
        let tolerance = match self.kind {
            Kind::Tilted(_) => TOLERANCE_TILTED,
            _ => TOLERANCE,
        };
        let make = || AlbedoIntegrator::new(*shape, tolerance);
        let gamma = shape.gamma();
        match self.integrators.binary_search_by(|(of, _)| of.gamma().total_cmp(&gamma)) {
            Ok(found) => f(self.integrators[found].1.get_or_init(make)),
            Err(_) => f(&make()),
        }
    }

    /// Albedos of an upright lobe for a view from above, given by cosine and azimuth, under Fresnel
    /// weights.
    fn directional<const N: usize>(
        &self,
        lobe: &StudentT,
        cos: f64,
        phi: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        self.with_integrator(lobe.shape(), |integrator| match [lobe.sigma_x(), lobe.sigma_y()] {
            [x, y] if x == y => integrator.reflection(x, cos, weight),
            sigma => integrator.reflection_anisotropic(sigma, cos, phi, weight),
        })
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
        let is_round = match &self.kind {
            Kind::Exact(lobe) => lobe.sigma_x() == lobe.sigma_y(),
            Kind::ExactFamily(all) => all.is_round(),
            _ => false,
        };
        if matches!(views, View::Cosines(_)) && !is_round {
            return Err(azimuth_matters());
        }
        let numbers = |[x, y, z]: [f64; 3]| {
            // Rounding may take the cosine of a unit vector beyond 1.
            let cos = if z <= 1.0 + 1e-12 { z.min(1.0) } else { z };
            (cos, y.atan2(x))
        };
        let of =
            |albedo: Result<Albedo<N>, _>| albedo.map_or([f64::NAN; N], |albedo| albedo.of(form));
        let upright = |lobe: &StudentT, v| {
            let (cos, phi) = numbers(v);
            of(self.directional(lobe, cos, phi, &weight))
        };
        match &self.kind {
            Kind::Exact(lobe) => views.each(py, One(lobe), Cost::Quadrature, upright),
            Kind::ExactFamily(all) => {
                views.each(py, all.at(student_t), Cost::Quadrature, |lobe, v| upright(&lobe, v))
            }
            Kind::Tilted(lobe) => views.each(py, One(&**lobe), Cost::Quadrature, |lobe, v| {
                let (cos, phi) = numbers(v);
                of(self.with_integrator(lobe.shape(), |integrator| {
                    integrator.reflection_skewed(lobe, cos, phi, &weight)
                }))
            }),
            Kind::Tables(_) | Kind::Family(_) => unreachable!("they are of tables"),
        }
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
    fn albedo_average<'py>(&self, py: Python<'py>, masking: &str) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        let average = |lobe: &StudentT| {
            let average = self.with_integrator(lobe.shape(), |integrator| {
                integrator.average(lobe.sigma_x(), |_| [1.0])
            });
            average.map_or([f64::NAN], |average| average.of(form))
        };
        match &self.kind {
            Kind::Exact(lobe) if lobe.sigma_x() == lobe.sigma_y() => {
                each(py, One(lobe), Cost::Quadrature, average)
            }
            Kind::ExactFamily(all) if all.is_round() => {
                each(py, all.at(student_t), Cost::Quadrature, |lobe| average(&lobe))
            }
            _ => Err(refused(
                "averages are integrated for round lobes alone; average albedo(v) over views",
            )),
        }
    }
}

/// A member of the Student-t family in double precision: roughness sigma > 0 and shape gamma in
/// (1.5, inf]; arguments are those of microfacet.StudentT, arrays among them.
///
/// >>> from microfacet import exact
/// >>> round(float(exact.StudentT(sigma=0.3, gamma=2.5).g1([0.6, 0.0, 0.8])), 12)
/// 0.997880175523
#[pyclass(name = "StudentT", module = "microfacet.exact", extends = ExactLobe, frozen)]
pub(crate) struct ExactStudentT {
    surface: Arc<Surface>,
}

#[pymethods]
impl ExactStudentT {
    #[new]
    #[pyo3(signature = (sigma=None, gamma=None, *, sigma_x=None, sigma_y=None, **others),
           text_signature = "(sigma=None, gamma=None, *, sigma_x=None, sigma_y=None)")]
    fn new(
        sigma: Option<&Any>,
        gamma: Option<&Any>,
        sigma_x: Option<&Any>,
        sigma_y: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let surface = Arc::new(Surface::new(sigma, gamma, sigma_x, sigma_y, others)?);
        let kind = match surface.one() {
            Some((sigma, gamma)) => {
                Kind::Exact(StudentT::new(Roughness(sigma), gamma).map_err(refused)?)
            }
            None => {
                surface.check_all(|sigma, gamma| StudentT::new(Roughness([sigma; 2]), gamma))?;
                Kind::ExactFamily(Arc::clone(&surface))
            }
        };
        Ok(ExactLobe::new(kind, surface.about()).add_subclass(Self { surface }))
    }

    /// Roughness along x and y: numbers, or arrays.
    #[getter]
    fn sigma<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.surface.sigma(py)?)
    }

    /// Shape: a number, or an array.
    #[getter]
    fn gamma<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        self.surface.gamma(py)
    }

    /// The shape to which arrays of sigma and gamma broadcast; () for one lobe.
    #[getter]
    fn batch_shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.surface.batch())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, Bound<'py, PyTuple>)> {
        let again = py.import("functools")?.getattr("partial")?;
        let arguments = self.surface.arguments(py)?;
        let again = again.call((py.get_type::<Self>(),), Some(&arguments))?;
        Ok((again, PyTuple::empty(py)))
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
pub(crate) struct ExactEllipsoid {
    made: ([f64; 2], [f64; 3], f64),
}

#[pymethods]
impl ExactEllipsoid {
    #[new]
    fn new(sigma: &Any, theta: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        let (sigma, theta) = (words::sigma(sigma)?, words::angles(theta)?);
        let skew = Skew::new(sigma, theta).map_err(refused)?;
        let lobe = Ellipsoid::new(skew, gamma).map_err(refused)?;
        let about = format!("Ellipsoid(gamma={gamma})");
        let made = (sigma.0, theta, gamma);
        Ok(ExactLobe::new(Kind::Tilted(Box::new(lobe)), about).add_subclass(Self { made }))
    }

    /// Shape.
    #[getter]
    fn gamma(&self) -> f64 {
        self.made.2
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, Bound<'py, PyTuple>)> {
        Ok((py.get_type::<Self>().into_any(), self.made.into_pyobject(py)?))
    }
}
