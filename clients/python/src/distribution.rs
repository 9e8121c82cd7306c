//! What lobes of both precisions have in common: closed forms, masking and visible normals.

use std::sync::Arc;

use microfacet_model::{Ellipsoid, MicrofacetDistribution as _, StudentT};
use microfacet_sampler::lobe::Batch as _;
use microfacet_sampler::{Lobe, MicrofacetDistribution as _};
use numpy::Element;
use pyo3::prelude::*;

use crate::arrays::{Any, Cost, Input, Number, each, each2, map, map2};
use crate::words::{self, refused};

/// A lobe by tables, in single precision, or by the model, in double precision.
pub(crate) enum Kind {
    Tables(Arc<Lobe>),
    Exact(Model),
}

/// A member of the family, or one seen through a matrix.
#[derive(Clone)]
pub(crate) enum Model {
    Family(StudentT),
    Skewed(Box<Ellipsoid>),
}

/// Calls a function of either lobe, whose vectors the conversion given makes of three numbers; of
/// tables by an expression of their own, where one is given.
macro_rules! of {
    ($kind:expr, $lobe:ident, $to:ident => $call:expr) => {
        of!($kind, $lobe => {
            let $to = std::convert::identity::<[f32; 3]>;
            $call
        }, $lobe => {
            let $to = |v: [f64; 3]| v.into();
            $call
        })
    };
    ($kind:expr, $tables:ident => $batch:expr, $lobe:ident => $call:expr) => {
        match $kind {
            Kind::Tables($tables) => $batch,
            Kind::Exact(Model::Family($lobe)) => $call,
            Kind::Exact(Model::Skewed($lobe)) => $call,
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
    fn d<'py>(&self, m: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind, lobe, to => {
            each(&Input::new("m", m)?, Cost::Lookup, |m: [_; 3]| [lobe.d(to(m))])
        })
    }

    /// Smith's masking G1(v), in [0, 1]; 0 at and below the horizon.
    fn g1<'py>(&self, v: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind,
            lobe => {
                let g1 = |v: &[[f32; 3]], g1: &mut [[f32; 1]]| {
                    lobe.g1_batch(v, g1.as_flattened_mut()).expect("as many of each");
                };
                map(&Input::new("v", v)?, Cost::Lookup, g1)
            },
            lobe => each(&Input::new("v", v)?, Cost::Lookup, |v: [_; 3]| [lobe.g1(v.into())])
        )
    }

    /// Smith's Lambda(v) = 1/G1 - 1; infinite at and below the horizon.
    fn lambda_<'py>(&self, v: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind, lobe, to => {
            each(&Input::new("v", v)?, Cost::Lookup, |v: [_; 3]| [lobe.lambda(to(v))])
        })
    }

    /// Masking and shadowing G2(v, l), in [0, 1].
    ///
    /// masking is "height-correlated", 1/(1 + Lambda(v) + Lambda(l)), or "uncorrelated",
    /// G1(v) G1(l).
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn g2<'py>(&self, v: &Any<'py>, l: &Any<'py>, masking: &str) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        of!(&self.kind, lobe, to => {
            let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
            let g2 = |v: [_; 3], l: [_; 3]| [lobe.g2(to(v), to(l), form)];
            each2(&v, &l, Cost::Lookup, g2)
        })
    }

    /// Draws visible normals m, shape (..., 3), from views v and uniform numbers u, shape (..., 2).
    ///
    /// u in [0, 1] is clamped to it. m is of unit length and above the horizon, and v.m >= 0 for
    /// a view from above.
    fn sample_visible_normal<'py>(&self, v: &Any<'py>, u: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind,
            lobe => {
                let (v, u) = (Input::new("v", v)?, Input::new("u", u)?);
                let sample = |v: &[[f32; 3]], u: &[[f32; 2]], m: &mut [[f32; 3]]| {
                    lobe.sample_batch(v, u, m).expect("as many of each");
                };
                map2(&v, &u, Cost::Lookup, sample)
            },
            lobe => {
                let (v, u) = (Input::new("v", v)?, Input::new("u", u)?);
                let sample =
                    |v: [_; 3], u: [_; 2]| lobe.sample_visible_normal(v.into(), u).to_array();
                each2(&v, &u, Cost::Quadrature, sample)
            }
        )
    }

    /// The density of visible normals, G1(v) max(0, v.m) D(m)/(v.n), per steradian of m.
    fn visible_normal_pdf<'py>(&self, v: &Any<'py>, m: &Any<'py>) -> PyResult<Any<'py>> {
        of!(&self.kind, lobe, to => {
            let (v, m) = (Input::new("v", v)?, Input::new("m", m)?);
            let pdf = |v: [_; 3], m: [_; 3]| [lobe.visible_normal_pdf(to(v), to(m))];
            each2(&v, &m, Cost::Lookup, pdf)
        })
    }

    /// G2(v, l)/G1(v), in [0, 1]: the weight f cos/pdf of a light l reflected off a drawn visible
    /// normal, without Fresnel.
    #[pyo3(signature = (v, l, masking="height-correlated"))]
    fn reflection_weight<'py>(
        &self,
        v: &Any<'py>,
        l: &Any<'py>,
        masking: &str,
    ) -> PyResult<Any<'py>> {
        let form = words::masking(masking)?;
        of!(&self.kind, lobe, to => {
            let (v, l) = (Input::new("v", v)?, Input::new("l", l)?);
            let weight = |v: [_; 3], l: [_; 3]| [lobe.reflection_weight(to(v), to(l), form)];
            each2(&v, &l, Cost::Lookup, weight)
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
            (Some(v), None) if v.extract::<f64>().is_ok() => Ok(Self::Cosines(Input::new("v", v)?)),
            (Some(v), None) => {
                let v = Input::<T, 3>::new("v", v)?;
                // Three cosines look like one direction, though rarely of length 1.
                let square = |[v]: [[T; 3]; 1]| v.map(|x| x.into().powi(2)).iter().sum::<f64>();
                if v.batch().is_empty() && (square(v.first()) - 1.0).abs() > 1e-3 {
                    return Err(refused(
                        "v is no unit vector; an array of cosines goes into cos_theta",
                    ));
                }
                Ok(Self::Directions(v))
            }
            (None, Some(cos)) => Ok(Self::Cosines(Input::new("cos_theta", cos)?)),
            _ => Err(refused("give either v, directions of shape (..., 3), or cos_theta")),
        }
    }

    /// A function of each view; a cosine is given as (0, 0, cos θ).
    pub(crate) fn each<const M: usize>(
        &self,
        cost: Cost,
        f: impl Fn([T; 3]) -> [T; M] + Sync,
    ) -> PyResult<Any<'py>> {
        match self {
            Self::Directions(v) => each(v, cost, f),
            Self::Cosines(cos) => each(cos, cost, |[cos]| f([T::default(), T::default(), cos])),
        }
    }
}

pub(crate) fn azimuth_matters() -> PyErr {
    refused(
        "the lobe is not round, so that its albedo depends on the azimuth of the view: give v as \
         directions of shape (..., 3)",
    )
}
