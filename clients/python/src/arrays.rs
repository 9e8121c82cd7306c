//! Arrays in and out: broadcasting, chunks for every core, and the interpreter's lock.

use std::array;
use std::borrow::Cow;
use std::ops::Range;
use std::process;
use std::sync::OnceLock;

use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PySlice, PyTuple};
use rayon::prelude::*;

/// An object of Python: an argument or a result.
pub(crate) type Any<'py> = Bound<'py, PyAny>;

pub(crate) trait Number: Element + Copy + Default + Into<f64> + Send + Sync {}

impl<T: Element + Copy + Default + Into<f64> + Send + Sync> Number for T {}

/// Items for one call of a function, which may work on several at once.
const CHUNK: usize = 1024;

/// How long a function takes for an item, which decides how often interrupts are checked.
#[derive(Clone, Copy)]
pub(crate) enum Cost {
    /// Nanoseconds.
    Lookup,
    /// Some ten microseconds and more.
    Quadrature,
}

impl Cost {
    /// Items of a chunk, and chunks between two checks for an interrupt.
    const fn blocks(self) -> [usize; 2] {
        match self {
            Self::Lookup => [CHUNK, 4096],
            Self::Quadrature => [4, 64],
        }
    }
}

/// Whether this process has worker threads. A process that was forked after they were started has
/// none, and would wait for them forever. The import makes the first call.
pub(crate) fn has_threads() -> bool {
    static OWNER: OnceLock<u32> = OnceLock::new();
    *OWNER.get_or_init(process::id) == process::id()
}

/// An argument: an array whose last axis has N numbers, or for N = 1 has any number of axes.
pub(crate) struct Input<'py, T: Element, const N: usize> {
    name: &'static str,
    /// Its items in C's order, without the axes along which one is repeated.
    array: PyReadonlyArrayDyn<'py, T>,
    batch: Vec<usize>,
    /// Items from one to the next along each axis of `batch`; 0 where one is repeated.
    strides: Vec<usize>,
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
        let array = numpy.call_method1("asarray", (once, T::get_dtype(py), "C"))?;
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
        Ok(Self { name, array: array.readonly(), batch: batch.to_vec(), strides })
    }

    fn shape(&self) -> (&'static str, &[usize]) {
        (self.name, &self.batch)
    }

    /// Its shape, without the axis of components.
    pub(crate) fn batch(&self) -> &[usize] {
        &self.batch
    }

    /// Its first K items, which must exist.
    pub(crate) fn first<const K: usize>(&self) -> [[T; N]; K] {
        let values = self.values(&self.batch);
        let items = values.chunk(0..K);
        array::from_fn(|i| items[i])
    }

    /// Its items, repeated along the axes that it lacks.
    fn values(&self, batch: &[usize]) -> Values<'_, T, N> {
        let items = self.array.as_slice().expect("it is in C's order and aligned").as_chunks().0;
        let lacks = batch.len() - self.strides.len();
        let mut axes: Vec<(usize, usize)> = Vec::new();
        for (i, &n) in batch.iter().enumerate().rev() {
            let stride = i.checked_sub(lacks).map_or(0, |i| self.strides[i]);
            match axes.last_mut() {
                _ if n == 1 => {}
                // No result has as many items as a length that saturates.
                Some((inner, of)) if stride == *of * *inner => *inner = inner.saturating_mul(n),
                _ => axes.push((n, stride)),
            }
        }
        Values { items, axes }
    }
}

/// The items of an argument, one for each result.
struct Values<'a, T, const N: usize> {
    items: &'a [[T; N]],
    /// Lengths and strides of the axes of results, the innermost first; axes that can be are
    /// merged.
    axes: Vec<(usize, usize)>,
}

impl<T: Copy, const N: usize> Values<'_, T, N> {
    fn chunk(&self, range: Range<usize>) -> Cow<'_, [[T; N]]> {
        if let [(_, 1)] = self.axes[..] {
            return Cow::Borrowed(&self.items[range]);
        }
        let (inner, step) = self.axes.first().copied().unwrap_or((1, 0));
        let mut chunk = Vec::with_capacity(range.len());
        let mut i = range.start;
        while i < range.end {
            let (mut rest, mut at) = (i, 0);
            for (n, stride) in &self.axes {
                at += rest % n * stride;
                rest /= n;
            }
            let run = (inner - i % inner).min(range.end - i);
            chunk.extend((0..run).map(|k| self.items[at + k * step]));
            i += run;
        }
        Cow::Owned(chunk)
    }
}

/// The shape to which several broadcast, by NumPy's rule.
fn broadcast(shapes: &[(&str, &[usize])]) -> PyResult<Vec<usize>> {
    let rank = shapes.iter().map(|(_, shape)| shape.len()).max().unwrap_or(0);
    let mut all = vec![1; rank];
    for (_, shape) in shapes {
        let first = rank - shape.len();
        for (have, &n) in all[first..].iter_mut().zip(*shape) {
            if *have == 1 {
                *have = n;
            } else if n != 1 && n != *have {
                let each: Vec<String> =
                    shapes.iter().map(|(name, shape)| format!("{name} {}", shown(shape))).collect();
                return Err(PyValueError::new_err(format!(
                    "arguments do not broadcast: without the axis of components they have the \
                     shapes {}; give as many of each, or one",
                    each.join(", ")
                )));
            }
        }
    }
    Ok(all)
}

/// A shape as Python writes it.
pub(crate) fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// An array of M numbers (for M = 1, without an axis of them) for each item of a batch, filled on
/// all cores without the interpreter's lock. `fill` is given the range of items.
fn filled<'py, T: Number, const M: usize>(
    py: Python<'py>,
    batch: &[usize],
    cost: Cost,
    fill: impl Fn(Range<usize>, &mut [[T; M]]) + Sync,
) -> PyResult<Any<'py>> {
    let mut shape = batch.to_vec();
    if M > 1 {
        shape.push(M);
    }
    // NumPy's own function, which raises for too many axes or too little memory.
    let array = py.import("numpy")?.call_method1("zeros", (shape, T::get_dtype(py)))?;
    let array = array.cast_into::<PyArrayDyn<T>>()?;
    {
        let mut writing = array.readwrite();
        let out = writing.as_slice_mut().expect("a new array is contiguous").as_chunks_mut().0;
        let [chunk, chunks] = cost.blocks();
        let block = chunk * chunks;
        for (i, out) in out.chunks_mut(block).enumerate() {
            py.detach(|| {
                let fill = |(j, out): (usize, &mut [[T; M]])| {
                    let start = i * block + j * chunk;
                    fill(start..start + out.len(), out);
                };
                if out.len() <= chunk || !has_threads() {
                    out.chunks_mut(chunk).enumerate().for_each(fill);
                } else {
                    out.par_chunks_mut(chunk).enumerate().for_each(fill);
                }
            });
            py.check_signals()?;
        }
    }
    // NumPy's own functions return a scalar where all arguments are.
    if batch.is_empty() && M == 1 { array.get_item(()) } else { Ok(array.into_any()) }
}

/// A function of one argument, chunk by chunk.
pub(crate) fn map<'py, T: Number, const A: usize, const M: usize>(
    a: &Input<'py, T, A>,
    cost: Cost,
    f: impl Fn(&[[T; A]], &mut [[T; M]]) + Sync,
) -> PyResult<Any<'py>> {
    let values = a.values(&a.batch);
    filled(a.array.py(), &a.batch, cost, |range, out| f(&values.chunk(range), out))
}

/// A function of two arguments, which broadcast, chunk by chunk.
pub(crate) fn map2<'py, T: Number, const A: usize, const B: usize, const M: usize>(
    a: &Input<'py, T, A>,
    b: &Input<'py, T, B>,
    cost: Cost,
    f: impl Fn(&[[T; A]], &[[T; B]], &mut [[T; M]]) + Sync,
) -> PyResult<Any<'py>> {
    let batch = broadcast(&[a.shape(), b.shape()])?;
    let py = a.array.py();
    let (a, b) = (a.values(&batch), b.values(&batch));
    filled(py, &batch, cost, |range, out| f(&a.chunk(range.clone()), &b.chunk(range), out))
}

/// A function of one argument, item by item.
pub(crate) fn each<'py, T: Number, const A: usize, const M: usize>(
    a: &Input<'py, T, A>,
    cost: Cost,
    f: impl Fn([T; A]) -> [T; M] + Sync,
) -> PyResult<Any<'py>> {
    map(a, cost, |a, out| {
        for (a, out) in a.iter().zip(out) {
            *out = f(*a);
        }
    })
}

/// A function of two arguments, which broadcast, item by item.
pub(crate) fn each2<'py, T: Number, const A: usize, const B: usize, const M: usize>(
    a: &Input<'py, T, A>,
    b: &Input<'py, T, B>,
    cost: Cost,
    f: impl Fn([T; A], [T; B]) -> [T; M] + Sync,
) -> PyResult<Any<'py>> {
    map2(a, b, cost, |a, b, out| {
        for ((a, b), out) in a.iter().zip(b).zip(out) {
            *out = f(*a, *b);
        }
    })
}

/// A function of three arguments, which broadcast, item by item.
pub(crate) fn each3<
    'py,
    T: Number,
    const A: usize,
    const B: usize,
    const C: usize,
    const M: usize,
>(
    a: &Input<'py, T, A>,
    b: &Input<'py, T, B>,
    c: &Input<'py, T, C>,
    cost: Cost,
    f: impl Fn([T; A], [T; B], [T; C]) -> [T; M] + Sync,
) -> PyResult<Any<'py>> {
    let batch = broadcast(&[a.shape(), b.shape(), c.shape()])?;
    let py = a.array.py();
    let (a, b, c) = (a.values(&batch), b.values(&batch), c.values(&batch));
    filled(py, &batch, cost, |range, out| {
        let (a, b, c) = (a.chunk(range.clone()), b.chunk(range.clone()), c.chunk(range));
        for (((a, b), c), out) in a.iter().zip(&*b).zip(&*c).zip(out) {
            *out = f(*a, *b, *c);
        }
    })
}
