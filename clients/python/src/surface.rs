//! Roughness and shape of lobes: one for all, or one for each item of arrays.

use std::fmt::Display;
use std::ops::Range;
use std::sync::Arc;

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::lobe::{FamilyLobe, Roughness};
use microfacet_sampler::{Family, FamilyDielectric, Ggx, Masking, Tables};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{Any, Input, Kept};
use crate::broadcast::{Argument, Chunks, Values, broadcast};
use crate::set::Set;
use crate::words::{self, Form, refused, unbound};

/// Roughness along x and y, and shape, which broadcast.
pub(crate) struct Surface {
    sigma: [Kept<f64, 1>; 2],
    gamma: Kept<f64, 1>,
    /// Whether one array is the roughness along both.
    is_round: bool,
    batch: Vec<usize>,
}

impl Surface {
    /// From what constructors of lobes are given: `sigma` is an array of round lobes, or a tuple or
    /// list of two, along x and along y; or those are given by themselves.
    pub(crate) fn new(
        sigma: Option<&Any>,
        gamma: Option<&Any>,
        sigma_x: Option<&Any>,
        sigma_y: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        words::lead_on("StudentT", others)?;
        let kept = |name, value: &Any| Input::<f64, 1>::new(name, value)?.kept();
        let (x, y, is_round) = match (sigma, sigma_x, sigma_y) {
            (Some(sigma), None, None) => match pair(sigma)? {
                Some([x, y]) => (kept("sigma", &x)?, kept("sigma", &y)?, false),
                None => {
                    let sigma = kept("sigma", sigma)?;
                    (sigma.clone(), sigma, true)
                }
            },
            (None, Some(x), Some(y)) => (kept("sigma_x", x)?, kept("sigma_y", y)?, false),
            (None, None, None) => return Err(PyTypeError::new_err("sigma is missing")),
            (None, ..) => return Err(refused("give sigma_x and sigma_y, or sigma for both")),
            (Some(_), ..) => {
                return Err(refused("sigma is sigma_x and sigma_y: give either it or them"));
            }
        };
        let gamma = gamma.ok_or_else(|| {
            PyTypeError::new_err("gamma is missing: 2 is GGX, and math.inf is Beckmann")
        })?;
        let gamma = kept("gamma", gamma)?;
        let batch = broadcast(&(&x, &y, &gamma))?;
        Ok(Self { sigma: [x, y], gamma, is_round, batch })
    }

    /// The shape of its arrays, broadcast.
    pub(crate) fn batch(&self) -> &[usize] {
        &self.batch
    }

    /// Roughness and shape of a single lobe, if it is one.
    pub(crate) fn one(&self) -> Option<([f64; 2], f64)> {
        let number = |of: &Kept<f64, 1>| of.items().next();
        let [x, y] = &self.sigma;
        let numbers = ([number(x)?, number(y)?], number(&self.gamma)?);
        self.batch.is_empty().then_some(numbers)
    }

    /// Whether all lobes are round.
    pub(crate) fn is_round(&self) -> bool {
        let [x, y] = &self.sigma;
        self.is_round || x.batch() == y.batch() && x.items().eq(y.items())
    }

    /// All shapes that there are, some more than once.
    pub(crate) fn gammas(&self) -> impl Iterator<Item = f64> + '_ {
        self.gamma.items()
    }

    /// Raises ValueError for the first lobe that the tables do not serve.
    pub(crate) fn check(&self, tables: &Tables, family: &Family) -> PyResult<()> {
        self.check_all(|sigma, _| Ggx::new(sigma))?;
        let serves = |gamma: f64| family.gammas().any(|[low, high]| low <= gamma && gamma <= high);
        let Some(bad) = self.gammas().find(|gamma| !serves(*gamma)) else { return Ok(()) };
        tables.lobe(1.0, bad).map_err(refused)?;
        Err(refused(format!(
            "gamma = {bad} is in no table over a range of shapes: give it alone, as a number"
        )))
    }

    /// Raises ValueError for the first roughness, then the first shape, of which no round lobe can
    /// be made.
    pub(crate) fn check_all<T, E: Display>(
        &self,
        make: impl Fn(f64, f64) -> Result<T, E>,
    ) -> PyResult<()> {
        let [x, y] = &self.sigma;
        let sigmas = x.items().chain(y.items()).map(|sigma| (sigma, 2.0));
        let all = sigmas.chain(self.gammas().map(|gamma| (1.0, gamma)));
        let mut made = all.map(|(sigma, gamma)| make(sigma, gamma));
        match made.find_map(Result::err) {
            Some(why) => Err(refused(why)),
            None => Ok(()),
        }
    }

    /// Raises ValueError where a table, which is over ranges, lacks the albedo of a lobe: lookups
    /// would take the nearest that it has. `of` looks for that of a round lobe.
    fn check_albedos<T, E: Display>(&self, of: impl Fn(f64, f64) -> Result<T, E>) -> PyResult<()> {
        let [x, y] = &self.sigma;
        let sigmas = match x.batch() == y.batch() {
            true => ends(x.items().zip(y.items()).map(|(x, y)| round_sigma([x, y]))),
            // Each of one may meet each of the other.
            false => ends(x.items())
                .zip(ends(y.items()))
                .map(|(x, y)| [0, 1].map(|end| round_sigma([x[end], y[end]]))),
        };
        let (Some(sigmas), Some(gammas)) = (sigmas, ends(self.gammas())) else { return Ok(()) };
        for (sigma, gamma) in
            sigmas.into_iter().flat_map(|sigma| gammas.map(|gamma| (sigma, gamma)))
        {
            of(sigma, gamma).map_err(refused)?;
        }
        Ok(())
    }

    /// Roughness and shape of each lobe.
    pub(crate) fn hits(&self) -> (Vec<[f32; 2]>, Vec<f32>) {
        let n = self.batch.iter().product();
        let chunks = self.at(hit).chunks(&self.batch);
        (0..n).map(chunks.chunk(0..n)).unzip()
    }

    /// Something made of roughness and shape for each result.
    pub(crate) fn at<I, F: Fn([f64; 2], f64) -> I + Copy + Sync>(&self, make: F) -> At<'_, F> {
        At { surface: self, make }
    }

    /// Roughness as Python is given it back: two numbers, or arrays.
    pub(crate) fn sigma<'py>(&self, py: Python<'py>) -> PyResult<[Any<'py>; 2]> {
        let [x, y] = &self.sigma;
        Ok([x.array(py)?, y.array(py)?])
    }

    pub(crate) fn gamma<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        self.gamma.array(py)
    }

    /// The arguments of Python that make it again.
    pub(crate) fn arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let arguments = PyDict::new(py);
        let [x, y] = self.sigma(py)?;
        match self.is_round {
            true => arguments.set_item("sigma", x)?,
            false => {
                arguments.set_item("sigma_x", x)?;
                arguments.set_item("sigma_y", y)?;
            }
        }
        arguments.set_item("gamma", self.gamma(py)?)?;
        Ok(arguments)
    }

    pub(crate) fn about(&self) -> String {
        match self.one() {
            Some(([x, y], gamma)) if x == y => format!("StudentT(sigma={x}, gamma={gamma})"),
            Some(([x, y], gamma)) => format!("StudentT(sigma=({x}, {y}), gamma={gamma})"),
            None => format!("StudentT of shape {}", crate::broadcast::shown(&self.batch)),
        }
    }
}

/// The smallest and the largest of some numbers.
fn ends(numbers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    numbers.fold(None, |ends, x| {
        let [low, high] = ends.unwrap_or([x, x]);
        Some([low.min(x), high.max(x)])
    })
}

/// The roughness of the round lobe that stands in for one of roughness σx, σy.
pub(crate) fn round_sigma([x, y]: [f64; 2]) -> f64 {
    if x == y { x } else { (x * y).sqrt() }
}

/// Roughness and shape in single precision.
pub(crate) fn hit(sigma: [f64; 2], gamma: f64) -> ([f32; 2], f32) {
    (sigma.map(|sigma| sigma as f32), gamma as f32)
}

/// A tuple or list of two, which are roughness along x and y; of as many numbers as else it is an
/// error.
fn pair<'py>(sigma: &Any<'py>) -> PyResult<Option<[Any<'py>; 2]>> {
    if !(sigma.is_instance_of::<PyTuple>() || sigma.is_instance_of::<PyList>()) {
        return Ok(None);
    }
    match sigma.len()? {
        2 => Ok(Some([sigma.get_item(0)?, sigma.get_item(1)?])),
        n => Err(refused(format!(
            "sigma is a {} of {n}: it must be a number, a pair (sigma_x, sigma_y), or an array of \
             round lobes, numpy.array([...])",
            sigma.get_type().name()?
        ))),
    }
}

/// An argument that is made of a surface.
pub(crate) struct At<'a, F> {
    surface: &'a Surface,
    make: F,
}

pub(crate) struct AtChunks<'a, F> {
    sigma: [Values<'a, f64, 1>; 2],
    gamma: Values<'a, f64, 1>,
    make: F,
}

impl<'a, I, F: Fn([f64; 2], f64) -> I + Copy + Sync> Argument for At<'a, F> {
    type Chunks = AtChunks<'a, F>;

    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
        (&self.surface.sigma[0], &self.surface.sigma[1], &self.surface.gamma).shapes(all);
    }

    fn chunks(&self, batch: &[usize]) -> AtChunks<'a, F> {
        let Surface { sigma: [x, y], gamma, .. } = self.surface;
        let [x, y, gamma] = [x, y, gamma].map(|of| of.chunks(batch));
        AtChunks { sigma: [x, y], gamma, make: self.make }
    }
}

impl<I, F: Fn([f64; 2], f64) -> I + Copy + Sync> Chunks for AtChunks<'_, F> {
    type Item = I;

    fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> I {
        let [x, y] = self.sigma.each_ref().map(|of| of.chunk(range.clone()));
        let gamma = self.gamma.chunk(range);
        move |i| {
            let ([x], [y], [gamma]) = (x(i), y(i), gamma(i));
            (self.make)([x, y], gamma)
        }
    }
}

/// Lobes that are read from tables of every shape.
pub(crate) struct Lobes {
    pub(crate) surface: Arc<Surface>,
    pub(crate) family: Arc<Family>,
}

impl Lobes {
    /// Their albedos, which stand in for those of lobes that are not round if they may.
    pub(crate) fn albedo(
        &self,
        set: &Set,
        masking: Masking,
        may_stand_in: bool,
    ) -> PyResult<Arc<FamilyAlbedo>> {
        self.check_round(may_stand_in)?;
        self.surface.check_albedos(|sigma, gamma| set.albedo(sigma, gamma, masking))?;
        set.albedos(masking).map_err(refused)
    }

    /// The albedos of their interfaces of an index of refraction.
    pub(crate) fn interface(&self, set: &Set, eta: f64, form: &Form) -> PyResult<FamilyDielectric> {
        self.check_round(form.may_stand_in)?;
        let family = set.family_dielectric(eta, form.masking).map_err(unbound)?;
        let of = |sigma, gamma| set.dielectric_albedo(sigma, gamma, eta, form.masking);
        self.surface.check_albedos(of)?;
        Ok(family)
    }

    fn check_round(&self, may_stand_in: bool) -> PyResult<()> {
        if may_stand_in || self.surface.is_round() {
            return Ok(());
        }
        Err(refused(
            "lobes of arrays have albedos of round lobes alone: stand_in=True takes that of \
             sqrt(sigma_x sigma_y)",
        ))
    }

    /// The lobe of one item.
    pub(crate) fn lobe(&self, sigma: [f64; 2], gamma: f64) -> FamilyLobe<'_> {
        self.family.at(Roughness(sigma), gamma as f32)
    }
}
