//! Arguments as arrays: conversion, shapes, and checks of directions and cosines.

use std::array;

use microfacet_sampler::BindError;
use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PySlice, PyTuple};
use rayon::prelude::*;

pub(crate) use crate::broadcast::{Any, Number};
use crate::broadcast::{Argument, Cost, Values, each, has_threads, shown};

/// By how much the length of a direction, or a cosine, may be off: what half precision rounds.
const ROUNDING: f64 = 1e-3;

/// How an array lies in memory.
#[derive(Clone)]
struct Layout {
    name: &'static str,
    /// Its shape, without the axis of components.
    batch: Vec<usize>,
    /// Items from one to the next along each axis of `batch`; 0 where one is repeated.
    strides: Vec<usize>,
}

/// An argument: an array whose last axis has N numbers, or for N = 1 has any number of axes.
pub(crate) struct Input<'py, T: Element, const N: usize> {
    layout: Layout,
    /// Its items in C's order, without the axes along which one is repeated.
    array: PyReadonlyArrayDyn<'py, T>,
}

impl<'py, T: Number, const N: usize> Input<'py, T, N> {
    /// Converts anything that NumPy takes as an array; `name` is that of the argument.
    pub(crate) fn new(name: &'static str, value: &Any<'py>) -> PyResult<Self> {
        let py = value.py();
        let numpy = py.import("numpy")?;
        let given = numpy.call_method1("asarray", (value,))?.cast_into::<PyUntypedArray>()?;
        if given.dtype().kind() == b'c' {
            return Err(PyValueError::new_err(format!("{name} must be real, and is complex")));
        }
        let shape = given.shape();
        let (batch, last) = shape.split_at(shape.len().saturating_sub((N > 1).into()));
        let axes = || batch.iter().zip(given.strides());
        let repeats = |(&n, &stride): (&usize, &isize)| n == 1 || n > 1 && stride == 0;
        let index = axes().map(|axis| match repeats(axis) {
            true => Ok(0_usize.into_pyobject(py)?.into_any()),
            false => Ok(PySlice::full(py).into_any()),
        });
        let once = given.get_item(PyTuple::new(py, index.collect::<PyResult<Vec<_>>>()?)?)?;
        // A copy only where it has another type, order or alignment.
        let array = numpy.call_method1("asarray", (once, T::get_dtype(py), "C"));
        let array = array.map_err(|why| match why.is_instance_of::<PyValueError>(py) {
            true => PyValueError::new_err(format!("{name}: {}", why.value(py))),
            false => why,
        })?;
        let mut array = array.cast_into::<PyArrayDyn<T>>()?;
        if !array.is_aligned() {
            array = array.call_method0("copy")?.cast_into()?;
        }
        if N > 1 && last != [N] {
            let last = if N == 3 { "x, y, z" } else { "u1, u2" };
            return Err(PyValueError::new_err(format!(
                "{name} has the shape {}: its last axis must have {N} numbers, as in [{last}] or an \
                 array of shape (N, {N})",
                shown(shape)
            )));
        }
        let mut next = 1;
        let mut strides = vec![0; batch.len()];
        for (stride, axis) in strides.iter_mut().zip(axes()).rev() {
            if !repeats(axis) {
                *stride = next;
                next *= axis.0;
            }
        }
        let layout = Layout { name, batch: batch.to_vec(), strides };
        Ok(Self { layout, array: array.readonly() })
    }

    /// Its shape, without the axis of components.
    pub(crate) fn batch(&self) -> &[usize] {
        &self.layout.batch
    }

    fn items(&self) -> &[[T; N]] {
        self.array.as_slice().expect("it is in C's order and aligned").as_chunks().0
    }

    /// Its first K items, which must exist.
    pub(crate) fn first<const K: usize>(&self) -> [[T; N]; K] {
        let values = Values::new(self.items(), &self.layout.strides, &self.layout.batch);
        array::from_fn(|i| values.at(i))
    }

    /// Raises ValueError for the first item that is bad, with what `why` says of it.
    fn check(
        &self,
        is_bad: impl Fn(&[T; N]) -> bool + Sync,
        why: impl Fn([T; N]) -> String,
    ) -> PyResult<()> {
        /// Items that are checked at once, without a branch for each.
        const BLOCK: usize = 1 << 12;
        let items = self.items();
        let of_block = |(block, items): (usize, &[[T; N]])| {
            let any = items.iter().fold(false, |any, item| any | is_bad(item));
            any.then(|| items.iter().position(&is_bad)).flatten().map(|at| block * BLOCK + at)
        };
        let found = self.array.py().detach(|| match has_threads() && items.len() > BLOCK {
            true => items.par_chunks(BLOCK).enumerate().find_map_first(of_block),
            false => items.chunks(BLOCK).enumerate().find_map(of_block),
        });
        let Some(at) = found else { return Ok(()) };
        let place = self.layout.place(at);
        Err(PyValueError::new_err(format!("{}{place} {}", self.layout.name, why(items[at]))))
    }

    /// A copy that outlives the argument.
    pub(crate) fn kept(&self) -> PyResult<Kept<T, N>> {
        let mut items = Vec::new();
        let all = self.items();
        items.try_reserve_exact(all.len()).map_err(|e| PyMemoryError::new_err(e.to_string()))?;
        items.extend_from_slice(all);
        Ok(Kept { layout: self.layout.clone(), items })
    }
}

impl<'py, T: Number> Input<'py, T, 3> {
    /// Directions: unit vectors. Null ones, which a sample of a path that ends has, and NaN pass.
    pub(crate) fn directions(name: &'static str, value: &Any<'py>) -> PyResult<Self> {
        let input = Self::new(name, value)?;
        let square = |&[x, y, z]: &[T; 3]| {
            let [x, y, z]: [f64; 3] = [x.into(), y.into(), z.into()];
            x * x + y * y + z * z
        };
        let is_off = |w: &[T; 3]| {
            let off = (square(w) - 1.0).abs();
            off > 2.0 * ROUNDING && off != 1.0
        };
        input.check(is_off, |w| {
            format!(
                "is no unit vector, its length is {:.4}: divide by \
                 numpy.linalg.norm({name}, axis=-1, keepdims=True)",
                square(&w).sqrt()
            )
        })?;
        Ok(input)
    }
}

impl<'py, T: Number> Input<'py, T, 1> {
    /// Cosines, in [-1, 1]; NaN passes.
    pub(crate) fn cosines(name: &'static str, value: &Any<'py>) -> PyResult<Self> {
        let input = Self::new(name, value)?;
        let is_off = |&[x]: &[T; 1]| x.into().abs() > 1.0 + ROUNDING;
        input.check(is_off, |[x]| {
            format!("= {} is no cosine of an angle: it must lie in [-1, 1]", x.into())
        })?;
        Ok(input)
    }
}

impl<'py> Input<'py, f64, 1> {
    /// Shares of light, in [0, 1], which NaN is not.
    pub(crate) fn shares(name: &'static str, value: &Any<'py>) -> PyResult<Self> {
        let input = Self::new(name, value)?;
        let is_off = |&[x]: &[f64; 1]| !(0.0..=1.0).contains(&(x as f32));
        // The name and the index stand before it.
        let why = |[x]: [f64; 1]| BindError::Share { name: "", value: x as f32 }.to_string();
        input.check(is_off, |x| why(x).trim_start().to_owned())?;
        Ok(input)
    }
}

impl Layout {
    /// An item's index as Python writes it; nothing of a single one.
    fn place(&self, at: usize) -> String {
        let mut index = Vec::with_capacity(self.batch.len());
        for (&n, &stride) in self.batch.iter().zip(&self.strides) {
            index.push(at.checked_div(stride).map_or(0, |at| at % n));
        }
        match index.is_empty() {
            true => String::new(),
            false => {
                format!("[{}]", index.iter().map(usize::to_string).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

impl<'a, T: Number, const N: usize> Argument for &'a Input<'_, T, N> {
    type Chunks = Values<'a, T, N>;

    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
        all.push((self.layout.name, self.layout.batch.clone()));
    }
    fn chunks(&self, batch: &[usize]) -> Self::Chunks {
        Values::new(self.items(), &self.layout.strides, batch)
    }
}

/// An argument that was kept.
#[derive(Clone)]
pub(crate) struct Kept<T, const N: usize> {
    layout: Layout,
    items: Vec<[T; N]>,
}

impl<T: Number> Kept<T, 1> {
    /// Its items, each once.
    pub(crate) fn items(&self) -> impl Iterator<Item = T> + '_ {
        self.items.iter().map(|&[x]| x)
    }

    /// The number, if it is one.
    pub(crate) fn one(&self) -> Option<T> {
        self.layout.batch.is_empty().then(|| self.items[0][0])
    }

    /// The name of the argument.
    pub(crate) fn name(&self) -> &'static str {
        self.layout.name
    }

    /// Its shape.
    pub(crate) fn batch(&self) -> &[usize] {
        &self.layout.batch
    }

    /// As an array of NumPy, or as a number.
    pub(crate) fn array<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        match self.one() {
            Some(one) => Ok(PyFloat::new(py, one.into()).into_any()),
            None => each(py, self, Cost::Lookup, |x| x),
        }
    }
}

impl<'a, T: Number, const N: usize> Argument for &'a Kept<T, N> {
    type Chunks = Values<'a, T, N>;

    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
        all.push((self.layout.name, self.layout.batch.clone()));
    }
    fn chunks(&self, batch: &[usize]) -> Self::Chunks {
        Values::new(&self.items, &self.layout.strides, batch)
    }
}
