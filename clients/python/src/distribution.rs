//! What lobes of both precisions have in common: closed forms, masking and visible normals.

use std::borrow::Cow;
use std::sync::Arc;

use microfacet_model::{Ellipsoid, MicrofacetDistribution as _, StudentT};
use microfacet_sampler::lobe::{Batch as _, Roughness};
use microfacet_sampler::{Lobe, MicrofacetDistribution as _};
use numpy::Element;
use pyo3::prelude::*;

use crate::arrays::{Any, Input, Number};
use crate::broadcast::{Argument, Chunks, Cost, One, by_chunks, each};
use crate::surface::{Lobes, Surface, hit};
use crate::words::{self, refused};

/// A lobe or lobes by tables, in single precision, or by the model, in double precision.
#[derive(Clone)]
pub(crate) enum Kind {
    Tables(Arc<Lobe>),
    Family(Arc<Lobes>),
    Exact(StudentT),
    ExactFamily(Arc<Surface>),
    Tilted(Box<Ellipsoid>),
}

/// A lobe of the model, of roughness and shape that were checked.
pub(crate) fn student_t(sigma: [f64; 2], gamma: f64) -> StudentT {
    StudentT::new(Roughness(sigma), gamma).expect("roughness and shape were checked")
}

/// Calls a function of lobes of any kind, an argument as others, whose vectors the conversion given
/// makes of three numbers.
macro_rules! of {
    ($kind:expr, $lobes:ident, $to:ident => $call:expr) => {
        of!($kind, One(lobe) => {
            let ($lobes, $to) = (One(lobe), std::convert::identity::<[f32; 3]>);
            $call
        }, $lobes, $to => $call)
    };
    ($kind:expr, One($lobe:ident) => $one:expr, $lobes:ident, $to:ident => $call:expr) => {
        match $kind {
            Kind::Tables($lobe) => {
                let $lobe = &**$lobe;
                $one
            }
            Kind::Family(all) => {
                let $lobes = all.surface.at(|sigma, gamma| all.lobe(sigma, gamma));
                let $to = std::convert::identity::<[f32; 3]>;
                $call
            }
            Kind::Exact(lobe) => {
                let ($lobes, $to) = (One(lobe), |v: [f64; 3]| v.into());
                $call
            }
            Kind::ExactFamily(surface) => {
                let ($lobes, $to) = (surface.at(student_t), |v: [f64; 3]| v.into());
                $call
            }
            Kind::Tilted(lobe) => {
                let ($lobes, $to) = (One(&**lobe), |v: [f64; 3]| v.into());
                $call
            }
        }
    };
}

/// What lobes have in either precision.
#[pyclass(name = "_Distribution", module = "microfacet", subclass, frozen)]
pub(crate) struct PyDistribution {
    kind: Kind,
    about: String,
}

impl PyDistribution {
    pub(crate) fn new(kind: Kind, about: String) -> PyClassInitializer<Self> {
        Self { kind, about }.into()
    }
}

#[pymethods]
impl PyDistribution {
    /// The normal distribution function D(m), per steradian.
    ///
    /// D(m) (m.n) integrates to 1 over all m; 0 for an m at or below the horizon.
    fn d<'py>(&self, py: Python<'py>, m: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind, lobes, to => {
            let m = Input::directions("m", m)?;
            each(py, (lobes, &m), Cost::Lookup, |(lobe, m): (_, [_; 3])| [lobe.d(to(m))])
        })
    }

    /// Smith's masking G1(v), in [0, 1]; 0 at and below the horizon.
    fn g1<'py>(&self, py: Python<'py>, v: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind,
            One(lobe) => {
                let v = Input::directions("v", v)?;
                by_chunks(py, &v, |v, range, g1: &mut [[f32; 1]]| {
                    let v: &[[f32; 3]] = &v.slice(range);
                    lobe.g1_batch(v, g1.as_flattened_mut()).expect("as many of each");
                })
            },
            lobes, to => {
                let v = Input::directions("v", v)?;
                each(py, (lobes, &v), Cost::Lookup, |(lobe, v): (_, [_; 3])| [lobe.g1(to(v))])
            }
        )
    }

    /// Smith's Lambda(v) = 1/G1 - 1; infinite at and below the horizon.
    fn lambda_<'py>(&self, py: Python<'py>, v: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind, lobes, to => {
            let v = Input::directions("v", v)?;
            each(py, (lobes, &v), Cost::Lookup, |(lobe, v): (_, [_; 3])| [lobe.lambda(to(v))])
        })
    }

    /// Masking and shadowing G2(v, l), in [0, 1].
    ///
    /// masking is "height-correlated", 1/(1 + Lambda(v) + Lambda(l)), or "uncorrelated",
    /// G1(v) G1(l).
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn g2<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        l: &Any<'py>,
        masking: &str,
    ) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        of!(&self.kind, lobes, to => {
            let (v, l) = (Input::directions("v", v)?, Input::directions("l", l)?);
            each(py, (lobes, &v, &l), Cost::Lookup, |(lobe, v, l): (_, [_; 3], [_; 3])| {
                [lobe.g2(to(v), to(l), form)]
            })
        })
    }

    /// Draws visible normals m, shape (..., 3), from views v and uniform numbers u, shape (..., 2).
    ///
    /// u in [0, 1] is clamped to it. m is of unit length and above the horizon, and v.m >= 0 for
    /// a view from above.
    #[allow(clippy::useless_conversion, reason = "the model has a vector of its own")]
    fn sample_visible_normal<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        u: &Any<'py>,
    ) -> PyResult<Any<'py>> {
        let cost = match &self.kind {
            Kind::Tables(_) | Kind::Family(_) => Cost::Lookup,
            _ => Cost::Quadrature,
        };
        if let Kind::Family(all) = &self.kind {
            let (v, u) = (Input::directions("v", v)?, Input::new("u", u)?);
            return by_chunks(py, (all.surface.at(hit), &v, &u), |(hits, v, u), range, m| {
                let (v, u): (Cow<[[f32; 3]]>, _) = (v.slice(range.clone()), u.slice(range.clone()));
                let (sigma, gamma): (Vec<_>, Vec<_>) =
                    (0..range.len()).map(hits.chunk(range)).unzip();
                let m: &mut [[f32; 3]] = m;
                all.family.sample_batch(&sigma, &gamma, &v, &u, m).expect("as many of each");
            });
        }
        of!(&self.kind,
            One(lobe) => {
                let (v, u) = (Input::directions("v", v)?, Input::new("u", u)?);
                by_chunks(py, (&v, &u), |(v, u), range, m: &mut [[f32; 3]]| {
                    let (v, u) = (v.slice(range.clone()), u.slice(range));
                    let v: &[[f32; 3]] = &v;
                    lobe.sample_batch(v, &u, m).expect("as many of each");
                })
            },
            lobes, to => {
                let (v, u) = (Input::directions("v", v)?, Input::new("u", u)?);
                each(py, (lobes, &v, &u), cost, |(lobe, v, u): (_, [_; 3], [_; 2])| {
                    lobe.sample_visible_normal(to(v), u).into()
                })
            }
        )
    }

    /// The density of visible normals, G1(v) max(0, v.m) D(m)/(v.n), per steradian of m.
    fn visible_normal_pdf<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        m: &Any<'py>,
    ) -> PyResult<Any<'py>> {
        of!(&self.kind, lobes, to => {
            let (v, m) = (Input::directions("v", v)?, Input::directions("m", m)?);
            each(py, (lobes, &v, &m), Cost::Lookup, |(lobe, v, m): (_, [_; 3], [_; 3])| {
                [lobe.visible_normal_pdf(to(v), to(m))]
            })
        })
    }

    /// G2(v, l)/G1(v), in [0, 1]: the weight f cos/pdf of a light l reflected off a drawn visible
    /// normal, without Fresnel.
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn reflection_weight<'py>(
        &self,
        py: Python<'py>,
        v: &Any<'py>,
        l: &Any<'py>,
        masking: &str,
    ) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        of!(&self.kind, lobes, to => {
            let (v, l) = (Input::directions("v", v)?, Input::directions("l", l)?);
            each(py, (lobes, &v, &l), Cost::Lookup, |(lobe, v, l): (_, [_; 3], [_; 3])| {
                [lobe.reflection_weight(to(v), to(l), form)]
            })
        })
    }

    fn __repr__(&self) -> &str {
        &self.about
    }
}

/// Views: directions, or their cosines.
pub(crate) enum View<'py, T: Element> {
    Directions(Input<'py, T, 3>),
    Cosines(Input<'py, T, 1>),
}

impl<'py, T: Number> View<'py, T> {
    /// Takes what the methods `albedo` are given for a view.
    pub(crate) fn new(v: Option<&Any<'py>>, cos_theta: Option<&Any<'py>>) -> PyResult<Self> {
        match (v, cos_theta) {
            (Some(v), None) if v.extract::<f64>().is_ok() => {
                Ok(Self::Cosines(Input::cosines("v", v)?))
            }
            // Three cosines look like one direction, though rarely of length 1.
            (Some(v), None) => Input::directions("v", v).map(Self::Directions).map_err(|why| {
                let why = why.value(v.py());
                refused(format!("{why}; an array of cosines goes into cos_theta"))
            }),
            (None, Some(cos)) => Ok(Self::Cosines(Input::cosines("cos_theta", cos)?)),
            _ => Err(refused("give either v, directions of shape (..., 3), or cos_theta")),
        }
    }

    /// A function of each view and of lobes, or what is made of them; a cosine is given as
    /// (0, 0, cos θ).
    pub(crate) fn each<L: Argument, const M: usize>(
        &self,
        py: Python<'py>,
        lobes: L,
        cost: Cost,
        f: impl Fn(<L::Chunks as Chunks>::Item, [T; 3]) -> [T; M] + Sync,
    ) -> PyResult<Any<'py>> {
        match self {
            Self::Directions(v) => each(py, (lobes, v), cost, |(lobe, v)| f(lobe, v)),
            Self::Cosines(cos) => {
                let zero = T::default();
                each(py, (lobes, cos), cost, |(lobe, [cos])| f(lobe, [zero, zero, cos]))
            }
        }
    }
}

pub(crate) fn azimuth_matters() -> PyErr {
    refused(
        "the lobe is not round, so that its albedo depends on the azimuth of the view: give v as \
         directions of shape (..., 3)",
    )
}
