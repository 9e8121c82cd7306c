//! Lobes in single precision, by tables.

use std::sync::{Arc, LazyLock};

use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::lobe::{Batch, LobeKey, Tabulated};
use microfacet_sampler::{Lobe, MicrofacetDistribution, Skew, Tables};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use crate::arrays::{Any, Cost};
use crate::distribution::{Kind, PyDistribution, View, azimuth_matters};
use crate::words::{self, refused, unbound};

/// The embedded set, in one copy.
pub(crate) fn embedded() -> Arc<Tables> {
    static EMBEDDED: LazyLock<Arc<Tables>> = LazyLock::new(|| Arc::new(Tables::embedded()));
    Arc::clone(&EMBEDDED)
}

/// A lobe with the tables that it is from: any distribution of microfacet normals.
///
/// Arrays of directions have the shape (..., 3): unit vectors in the tangent frame, n = +z, away
/// from the surface. Arguments broadcast; results are float32. GGX is drawn from tables, too, where
/// the set has them for gamma = 2.
///
/// >>> import microfacet
/// >>> lobe = microfacet.StudentT(0.3, 2.5)  # or Ellipsoid, or Tables.material
/// >>> m = lobe.sample_visible_normal([0.6, 0.0, 0.8], [[0.3, 0.7], [0.5, 0.5]])
/// >>> m.shape, lobe.visible_normal_pdf([0.6, 0.0, 0.8], m).shape
/// ((2, 3), (2,))
#[pyclass(name = "Lobe", module = "microfacet", extends = PyDistribution, subclass, frozen)]
pub(crate) struct PyLobe {
    pub(crate) lobe: Arc<Lobe>,
    pub(crate) tables: Arc<Tables>,
}

impl PyLobe {
    pub(crate) fn new(
        lobe: impl Into<Lobe>,
        tables: &Arc<Tables>,
        about: String,
    ) -> PyClassInitializer<Self> {
        let lobe = Arc::new(lobe.into());
        PyDistribution::new(Kind::Tables(Arc::clone(&lobe)), about)
            .add_subclass(Self { lobe, tables: Arc::clone(tables) })
    }

    fn albedo_of(&self, form: &str, may_stand_in: bool) -> PyResult<Albedo> {
        let masking = words::masking(form)?;
        let stand_in = words::stand_in(may_stand_in);
        self.tables.albedo_of(&*self.lobe, masking, stand_in).map_err(unbound)
    }

    /// A function of the albedo at each view; cosines are refused where the azimuth matters.
    fn of_views<'py, const M: usize>(
        &self,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
        of: impl Fn(&Albedo, [f32; 3]) -> [f32; M] + Sync,
    ) -> PyResult<Any<'py>> {
        let albedo = self.albedo_of(masking, stand_in)?;
        let views = View::new(v, cos_theta)?;
        let turned = match self.lobe.key() {
            LobeKey::Upright(lobe) => !lobe.roughness.is_isotropic(),
            key => matches!(key, LobeKey::Tilted { .. }),
        };
        // The round lobe that stands in does not depend on the azimuth, a table of the lobe does.
        if turned && matches!(views, View::Cosines(_)) && self.albedo_of(masking, false).is_ok() {
            return Err(azimuth_matters());
        }
        views.each(Cost::Lookup, |v| of(&albedo, v))
    }
}

#[pymethods]
impl PyLobe {
    /// The directional albedo E(v) of one bounce with F = 1, in [0, 1].
    ///
    /// v are directions, shape (..., 3), or one number, which is cos theta and enough for a round
    /// lobe; cosines in an array go into cos_theta instead. ValueError where the tables have no
    /// albedo of the lobe: stand_in=True then takes the round lobe of sqrt(sigma_x sigma_y).
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None, stand_in=false))]
    fn albedo<'py>(
        &self,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_views(v, masking, cos_theta, stand_in, |albedo, v| [albedo.albedo(v)])
    }

    /// The parts scale, bias and F82 of E(v), shape (..., 3), each in [0, 1].
    ///
    /// Schlick's reflectance F0 + (F90 - F0)(1 - v.m)^5 has the albedo F0 scale + F90 bias, and
    /// scale + bias = E; F82 is the moment of the dip of OpenPBR's tint. Arguments are those of
    /// albedo.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None, stand_in=false))]
    fn albedo_parts<'py>(
        &self,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_views(v, masking, cos_theta, stand_in, |albedo, v| {
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
    fn _seconds_in_rust(
        &self,
        v: PyReadonlyArray2<'_, f32>,
        u: PyReadonlyArray2<'_, f32>,
    ) -> PyResult<f64> {
        let [v, u] = [v.as_slice()?, u.as_slice()?];
        let (v, u): (&[[f32; 3]], _) = (v.as_chunks().0, u.as_chunks().0);
        let mut m = Vec::new();
        m.try_reserve_exact(v.len()).map_err(|why| PyMemoryError::new_err(why.to_string()))?;
        m.resize(v.len(), [0.0; 3]);
        let start = std::time::Instant::now();
        self.lobe.sample_batch(v, u, &mut m).map_err(refused)?;
        Ok(start.elapsed().as_secs_f64())
    }
}

/// A member of the Student-t family with roughness sigma, a number or (sigma_x, sigma_y), each in
/// [1e-8, 1e6], and shape gamma in [1.501, inf]: 2 is GGX, inf is Beckmann.
///
/// StudentT(sigma, gamma) reads the default tables; Tables.student_t reads others.
///
/// >>> import microfacet
/// >>> lobe = microfacet.StudentT(sigma=0.3, gamma=2.5)
/// >>> round(float(lobe.d([0.0, 0.0, 1.0])), 4)  # 1/(pi sigma^2)
/// 3.5368
/// >>> round(float(lobe.albedo(cos_theta=0.8)), 4)
/// 0.9204
#[pyclass(name = "StudentT", module = "microfacet", extends = PyLobe, frozen)]
pub(crate) struct PyStudentT {
    sigma: [f64; 2],
    gamma: f64,
}

impl PyStudentT {
    pub(crate) fn of(
        tables: &Arc<Tables>,
        sigma: &Any,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let sigma = words::sigma(sigma)?;
        let lobe = tables.lobe(sigma, gamma).map_err(refused)?;
        let sigma = sigma.0;
        let about = match sigma {
            [x, y] if x == y => format!("StudentT(sigma={x}, gamma={gamma})"),
            [x, y] => format!("StudentT(sigma=({x}, {y}), gamma={gamma})"),
        };
        Ok(PyLobe::new(lobe, tables, about).add_subclass(Self { sigma, gamma }))
    }
}

#[pymethods]
impl PyStudentT {
    #[new]
    fn new(sigma: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        Self::of(&embedded(), sigma, gamma)
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
///
/// >>> import microfacet
/// >>> scale = microfacet.Ellipsoid(sigma=0.3, theta=(0.0, 0.2, 0.0), gamma=2.5)
/// >>> upright = microfacet.StudentT(sigma=0.3, gamma=2.5)
/// >>> bool(scale.d([0.0, 0.0, 1.0]) < upright.d([0.0, 0.0, 1.0]))
/// True
#[pyclass(name = "Ellipsoid", module = "microfacet", extends = PyLobe, frozen)]
pub(crate) struct PyEllipsoid {}

impl PyEllipsoid {
    pub(crate) fn of(
        tables: &Arc<Tables>,
        sigma: &Any,
        theta: &Any,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (sigma, theta) = (words::sigma(sigma)?, words::angles(theta)?);
        let skew = Skew::new(sigma, theta).map_err(refused)?;
        let lobe = tables.ellipsoid(skew, gamma).map_err(refused)?;
        let about = format!(
            "Ellipsoid(sigma=({}, {}), theta=({}, {}, {}), gamma={gamma})",
            sigma.0[0], sigma.0[1], theta[0], theta[1], theta[2]
        );
        Ok(PyLobe::new(lobe, tables, about).add_subclass(Self {}))
    }
}

#[pymethods]
impl PyEllipsoid {
    #[new]
    fn new(sigma: &Any, theta: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        Self::of(&embedded(), sigma, theta, gamma)
    }
}
