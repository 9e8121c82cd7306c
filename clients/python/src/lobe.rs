//! Lobes in single precision, by tables.

use std::sync::Arc;
use std::time::Instant;

use microfacet_sampler::albedo::{Albedo, AlbedoAt, DirectionalAlbedo, FamilyAlbedo, Moments};
use microfacet_sampler::lobe::{Batch, LobeKey, Roughness, Tabulated};
use microfacet_sampler::{Lobe, MicrofacetDistribution, Skew};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::arrays::Any;
use crate::broadcast::{Cost, One, each, flags};
use crate::distribution::{Kind, PyDistribution, View, azimuth_matters};
use crate::set::Set;
use crate::surface::{Lobes, Surface, round_sigma};
use crate::words::{self, refused, unbound};

/// What a lobe is made again from.
pub(crate) enum Made {
    StudentT(Arc<Surface>),
    Ellipsoid([f64; 2], [f64; 3], f64),
    Material(String),
}

/// The albedo of a lobe, or those of many.
enum Albedos<'a> {
    One(Box<Albedo>),
    Family(Arc<FamilyAlbedo>, &'a Surface),
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
    pub(crate) kind: Kind,
    pub(crate) set: Arc<Set>,
    made: Made,
}

/// The albedo at one roughness and shape; of a lobe that is not round that of its stand-in.
pub(crate) fn albedo_at(family: &FamilyAlbedo, sigma: [f64; 2], gamma: f64) -> AlbedoAt<'_> {
    family.at(round_sigma(sigma) as f32, gamma as f32)
}

impl PyLobe {
    fn kind_of(kind: Kind, set: &Arc<Set>, made: Made, about: String) -> PyClassInitializer<Self> {
        PyDistribution::new(kind.clone(), about).add_subclass(Self {
            kind,
            set: Arc::clone(set),
            made,
        })
    }

    pub(crate) fn new(
        lobe: impl Into<Lobe>,
        set: &Arc<Set>,
        made: Made,
        about: String,
    ) -> PyClassInitializer<Self> {
        Self::kind_of(Kind::Tables(Arc::new(lobe.into())), set, made, about)
    }

    fn albedos(&self, form: &str, may_stand_in: bool) -> PyResult<Albedos<'_>> {
        let masking = words::masking(form)?;
        match &self.kind {
            Kind::Family(lobes) => {
                let albedo = lobes.albedo(&self.set, masking, may_stand_in)?;
                Ok(Albedos::Family(albedo, &lobes.surface))
            }
            _ => {
                let stand_in = words::stand_in(may_stand_in);
                let albedo = self.set.albedo_of(self.one()?, masking, stand_in).map_err(unbound)?;
                Ok(Albedos::One(Box::new(albedo)))
            }
        }
    }

    /// The lobe, if it is one.
    pub(crate) fn one(&self) -> PyResult<&Lobe> {
        match &self.kind {
            Kind::Tables(lobe) => Ok(lobe),
            _ => Err(refused("this is for one lobe: give numbers of sigma and gamma")),
        }
    }

    /// A function of the albedo at each view; cosines are refused where the azimuth matters.
    fn of_views<'py, const M: usize>(
        &self,
        py: Python<'py>,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
        of: impl Fn(&dyn DirectionalAlbedo, [f32; 3]) -> [f32; M] + Sync,
    ) -> PyResult<Any<'py>> {
        let albedos = self.albedos(masking, stand_in)?;
        let views = View::new(v, cos_theta)?;
        let turned = self.one().is_ok_and(|lobe| match lobe.key() {
            LobeKey::Upright(lobe) => !lobe.roughness.is_isotropic(),
            key => matches!(key, LobeKey::Tilted { .. }),
        });
        // The round lobe that stands in does not depend on the azimuth, a table of the lobe does.
        if turned && matches!(views, View::Cosines(_)) && self.albedos(masking, false).is_ok() {
            return Err(azimuth_matters());
        }
        match &albedos {
            Albedos::One(albedo) => {
                views.each(py, One(&**albedo), Cost::Lookup, |albedo, v| of(albedo, v))
            }
            Albedos::Family(family, surface) => {
                let all = surface.at(|sigma, gamma| albedo_at(family, sigma, gamma));
                views.each(py, all, Cost::Lookup, |albedo, v| of(&albedo, v))
            }
        }
    }

    /// A function of the albedo of each lobe.
    fn of_lobes<'py, const M: usize>(
        &self,
        py: Python<'py>,
        masking: &str,
        stand_in: bool,
        of: impl Fn(Moments) -> [f32; M] + Sync,
    ) -> PyResult<Any<'py>> {
        match &self.albedos(masking, stand_in)? {
            Albedos::One(albedo) => {
                each(py, One(&**albedo), Cost::Lookup, |albedo| of(albedo.average_moments()))
            }
            Albedos::Family(family, surface) => {
                let all = surface.at(|sigma, gamma| albedo_at(family, sigma, gamma));
                each(py, all, Cost::Lookup, |albedo| of(albedo.average_moments()))
            }
        }
    }
}

#[pymethods]
impl PyLobe {
    /// The directional albedo E(v) of one bounce with F = 1, in [0, 1].
    ///
    /// v are directions, shape (..., 3), or one number, which is cos theta and enough for a round
    /// lobe; cosines in an array go into cos_theta instead. ValueError where the tables have no
    /// albedo of the lobe: stand_in=True then takes the round lobe of sqrt(sigma_x sigma_y). Lobes
    /// of arrays have that of a volume over all shapes, which differs by up to 5e-4 for gamma from
    /// 1.6 and 2.5e-3 below, and by 5e-3 at most next to the horizon.
    #[pyo3(signature = (v=None, masking="height-correlated", *, cos_theta=None, stand_in=false))]
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_views(py, v, masking, cos_theta, stand_in, |albedo, v| [1.0 - albedo.lost(v)])
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
        v: Option<&Any<'py>>,
        masking: &str,
        cos_theta: Option<&Any<'py>>,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_views(py, v, masking, cos_theta, stand_in, |albedo, v| parts(albedo.moments(v)))
    }

    /// The average of E over the hemisphere of views, weighted by the cosine, in [0, 1].
    #[pyo3(signature = (masking="height-correlated", *, stand_in=false))]
    fn albedo_average<'py>(
        &self,
        py: Python<'py>,
        masking: &str,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_lobes(py, masking, stand_in, |moments| [moments.scale + moments.bias])
    }

    /// The averages of the parts scale, bias and F82, shape (..., 3).
    #[pyo3(signature = (masking="height-correlated", *, stand_in=false))]
    fn albedo_average_parts<'py>(
        &self,
        py: Python<'py>,
        masking: &str,
        stand_in: bool,
    ) -> PyResult<Any<'py>> {
        self.of_lobes(py, masking, stand_in, parts)
    }

    /// Whether a renderer should treat the surface as a mirror: mean slopes are below 1e-3.
    #[getter]
    fn is_effectively_smooth<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        match &self.kind {
            Kind::Family(all) => {
                let lobes = all.surface.at(|sigma, gamma| all.lobe(sigma, gamma));
                flags(py, lobes, |lobe| lobe.is_effectively_smooth())
            }
            _ => flags(py, One(self.one()?), Lobe::is_effectively_smooth),
        }
    }

    /// A call of a method of the tables, which go along unless they are those built in.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (Any<'py>,))> {
        let (positional, arguments) = match &self.made {
            Made::StudentT(surface) => {
                (PyTuple::new(py, ["student_t"])?, Some(surface.arguments(py)?))
            }
            Made::Ellipsoid(sigma, theta, gamma) => {
                let all = ("ellipsoid", *sigma, *theta, *gamma).into_pyobject(py)?;
                (all, None)
            }
            Made::Material(name) => (("material", name).into_pyobject(py)?, None),
        };
        let call = py.import("operator")?.getattr("methodcaller")?;
        let class = py.import("microfacet._microfacet")?.getattr("Tables")?;
        let tables = if Arc::ptr_eq(&self.set, &Set::embedded()) {
            class.call0()?
        } else {
            let bytes = PyBytes::new(py, &self.set.bytes()?);
            class.call_method1("_of_bytes", (bytes, "of a lobe"))?
        };
        Ok((call.call(positional, arguments.as_ref())?, (tables,)))
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
        let hits = match &self.kind {
            Kind::Family(all) => Some((all, all.surface.hits())),
            _ => None,
        };
        let start = Instant::now();
        match &hits {
            Some((all, (sigma, gamma))) => all.family.sample_batch(sigma, gamma, v, u, &mut m),
            None => self.one()?.sample_batch(v, u, &mut m),
        }
        .map_err(refused)?;
        Ok(start.elapsed().as_secs_f64())
    }
}

fn parts(moments: Moments) -> [f32; 3] {
    [moments.scale, moments.bias, moments.f82]
}

/// A member of the Student-t family with roughness sigma and shape gamma, or many in arrays.
///
/// sigma is a number in [1e-8, 1e6], a tuple or list of two (sigma_x, sigma_y), or an array of
/// round lobes; sigma_x and sigma_y are given by themselves for arrays of both. gamma is a number
/// or an array in [1.501, inf]: 2 is GGX, inf is Beckmann. Arrays broadcast with one another, and
/// with the views and numbers of methods. StudentT reads the default tables; Tables.student_t reads
/// others.
///
/// >>> import microfacet
/// >>> lobe = microfacet.StudentT(sigma=0.3, gamma=2.5)
/// >>> round(float(lobe.d([0.0, 0.0, 1.0])), 4)  # 1/(pi sigma^2)
/// 3.5368
/// >>> round(float(lobe.albedo(cos_theta=0.8)), 4)
/// 0.9204
///
/// One for each hit of textures, rougher and rougher, seen from one side:
///
/// >>> import numpy as np
/// >>> many = microfacet.StudentT(sigma=np.linspace(0.1, 0.5, 5), gamma=2.5)
/// >>> many.g1([0.8, 0.0, 0.6]).astype(float).round(3).tolist()
/// [1.0, 0.997, 0.989, 0.977, 0.96]
#[pyclass(name = "StudentT", module = "microfacet", extends = PyLobe, frozen)]
pub(crate) struct PyStudentT {
    surface: Arc<Surface>,
}

impl PyStudentT {
    pub(crate) fn of(
        py: Python<'_>,
        set: &Arc<Set>,
        surface: Surface,
    ) -> PyResult<PyClassInitializer<Self>> {
        let surface = Arc::new(surface);
        let kind = match surface.one() {
            Some((sigma, gamma)) => {
                Kind::Tables(Arc::new(set.lobe(Roughness(sigma), gamma).map_err(refused)?))
            }
            None => {
                let family = py.detach(|| set.lobes()).map_err(refused)?;
                surface.check(set, &family)?;
                Kind::Family(Arc::new(Lobes { surface: Arc::clone(&surface), family }))
            }
        };
        let made = Made::StudentT(Arc::clone(&surface));
        let about = surface.about();
        Ok(PyLobe::kind_of(kind, set, made, about).add_subclass(Self { surface }))
    }
}

#[pymethods]
impl PyStudentT {
    #[new]
    #[pyo3(signature = (sigma=None, gamma=None, *, sigma_x=None, sigma_y=None, **others),
           text_signature = "(sigma=None, gamma=None, *, sigma_x=None, sigma_y=None)")]
    fn new(
        py: Python<'_>,
        sigma: Option<&Any>,
        gamma: Option<&Any>,
        sigma_x: Option<&Any>,
        sigma_y: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        Self::of(py, &Set::embedded(), Surface::new(sigma, gamma, sigma_x, sigma_y, others)?)
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
        set: &Arc<Set>,
        sigma: &Any,
        theta: &Any,
        gamma: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (sigma, theta) = (words::sigma(sigma)?, words::angles(theta)?);
        let skew = Skew::new(sigma, theta).map_err(refused)?;
        let lobe = set.ellipsoid(skew, gamma).map_err(refused)?;
        let about = format!(
            "Ellipsoid(sigma=({}, {}), theta=({}, {}, {}), gamma={gamma})",
            sigma.0[0], sigma.0[1], theta[0], theta[1], theta[2]
        );
        let made = Made::Ellipsoid(sigma.0, theta, gamma);
        Ok(PyLobe::new(lobe, set, made, about).add_subclass(Self {}))
    }
}

#[pymethods]
impl PyEllipsoid {
    #[new]
    fn new(sigma: &Any, theta: &Any, gamma: f64) -> PyResult<PyClassInitializer<Self>> {
        Self::of(&Set::embedded(), sigma, theta, gamma)
    }
}
