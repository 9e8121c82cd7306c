//! Broadcasting: items of several arguments for each result, in chunks for every core.

use std::borrow::Cow;
use std::ops::Range;
use std::process;
use std::sync::OnceLock;

use numpy::{Element, PyArrayDyn, PyArrayMethods};
use pyo3::basic::CompareOp;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
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

/// What has an item for each result: an argument, a lobe or lobes, or several of them.
pub(crate) trait Argument {
    type Chunks: Chunks;

    /// Adds names and shapes, without axes of components.
    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>);
    /// Its items for results of a shape to which its own broadcasts.
    fn chunks(&self, batch: &[usize]) -> Self::Chunks;
}

/// Items of one argument or several, by chunks of the results.
pub(crate) trait Chunks: Sync {
    type Item;

    /// The items of a range of results, by their place in it.
    fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> Self::Item;
}

/// One thing for all results.
pub(crate) struct One<'a, L>(pub(crate) &'a L);

impl<'a, L: Sync> Argument for One<'a, L> {
    type Chunks = One<'a, L>;

    fn shapes(&self, _: &mut Vec<(&'static str, Vec<usize>)>) {}
    fn chunks(&self, _: &[usize]) -> Self::Chunks {
        One(self.0)
    }
}

impl<'a, L: Sync> Chunks for One<'a, L> {
    type Item = &'a L;

    fn chunk(&self, _: Range<usize>) -> impl Fn(usize) -> &'a L {
        let one = self.0;
        move |_| one
    }
}

/// Something made of the items of an argument, or of several.
pub(crate) struct Made<A, F>(pub(crate) A, pub(crate) F);

impl<A: Argument, I, F> Argument for Made<A, F>
where
    F: Fn(<A::Chunks as Chunks>::Item) -> I + Copy + Sync,
{
    type Chunks = Made<A::Chunks, F>;

    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
        self.0.shapes(all);
    }
    fn chunks(&self, batch: &[usize]) -> Self::Chunks {
        Made(self.0.chunks(batch), self.1)
    }
}

impl<C: Chunks, I, F: Fn(C::Item) -> I + Copy + Sync> Chunks for Made<C, F> {
    type Item = I;

    fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> I {
        let (item, make) = (self.0.chunk(range), self.1);
        move |i| make(item(i))
    }
}

macro_rules! tuple {
    ($($one:ident $at:tt),+) => {
        impl<$($one: Argument),+> Argument for ($($one,)+) {
            type Chunks = ($($one::Chunks,)+);

            fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
                $(self.$at.shapes(all);)+
            }
            fn chunks(&self, batch: &[usize]) -> Self::Chunks {
                ($(self.$at.chunks(batch),)+)
            }
        }

        impl<$($one: Chunks),+> Chunks for ($($one,)+) {
            type Item = ($($one::Item,)+);

            fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> Self::Item {
                let all = ($(self.$at.chunk(range.clone()),)+);
                move |i| ($((all.$at)(i),)+)
            }
        }
    };
}

tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3);

/// Arrays of N numbers in C's order, one for each result, which may be repeated.
pub(crate) struct Values<'a, T, const N: usize> {
    items: &'a [[T; N]],
    /// Lengths and strides of the axes of results, the innermost first; axes that can be are
    /// merged.
    axes: Vec<(usize, usize)>,
}

impl<'a, T: Copy, const N: usize> Values<'a, T, N> {
    /// `strides` are those of the last axes of `batch`; the others repeat all.
    pub(crate) fn new(items: &'a [[T; N]], strides: &[usize], batch: &[usize]) -> Self {
        let lacks = batch.len() - strides.len();
        let mut axes: Vec<(usize, usize)> = Vec::new();
        for (i, &n) in batch.iter().enumerate().rev() {
            let stride = i.checked_sub(lacks).map_or(0, |i| strides[i]);
            match axes.last_mut() {
                _ if n == 1 => {}
                // No result has as many items as a length that saturates.
                Some((inner, of)) if stride == *of * *inner => *inner = inner.saturating_mul(n),
                _ => axes.push((n, stride)),
            }
        }
        Self { items, axes }
    }

    /// The item of a result.
    pub(crate) fn at(&self, i: usize) -> [T; N] {
        self.slice(i..i + 1)[0]
    }

    /// The items of a range of results.
    pub(crate) fn slice(&self, range: Range<usize>) -> Cow<'_, [[T; N]]> {
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

impl<T: Copy + Sync, const N: usize> Chunks for Values<'_, T, N> {
    type Item = [T; N];

    fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> [T; N] {
        let chunk = self.slice(range);
        move |i| chunk[i]
    }
}

/// The shape to which several broadcast, by NumPy's rule.
pub(crate) fn broadcast(argument: &impl Argument) -> PyResult<Vec<usize>> {
    let mut shapes = Vec::new();
    argument.shapes(&mut shapes);
    let rank = shapes.iter().map(|(_, shape)| shape.len()).max().unwrap_or(0);
    let mut all = vec![1; rank];
    for (_, shape) in &shapes {
        let first = rank - shape.len();
        for (have, &n) in all[first..].iter_mut().zip(shape) {
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

/// A function of arguments, which broadcast, item by item.
pub(crate) fn each<'py, T: Number, A: Argument, const M: usize>(
    py: Python<'py>,
    arguments: A,
    cost: Cost,
    f: impl Fn(<A::Chunks as Chunks>::Item) -> [T; M] + Sync,
) -> PyResult<Any<'py>> {
    let batch = broadcast(&arguments)?;
    let chunks = arguments.chunks(&batch);
    filled(py, &batch, cost, |range, out| {
        let item = chunks.chunk(range);
        for (i, out) in out.iter_mut().enumerate() {
            *out = f(item(i));
        }
    })
}

/// A flag for each item: a bool of Python where there is one.
pub(crate) fn flags<'py, A: Argument>(
    py: Python<'py>,
    arguments: A,
    f: impl Fn(<A::Chunks as Chunks>::Item) -> bool + Sync,
) -> PyResult<Any<'py>> {
    let numbers = each(py, arguments, Cost::Lookup, |item| [f32::from(u8::from(f(item)))])?;
    let flags = numbers.rich_compare(0, CompareOp::Ne)?;
    if flags.getattr("ndim")?.eq(0)? { flags.call_method0("item") } else { Ok(flags) }
}

/// A function of arguments, which broadcast, chunk by chunk: it is given a range of results.
pub(crate) fn by_chunks<'py, T: Number, A: Argument, const M: usize>(
    py: Python<'py>,
    arguments: A,
    f: impl Fn(&A::Chunks, Range<usize>, &mut [[T; M]]) + Sync,
) -> PyResult<Any<'py>> {
    let batch = broadcast(&arguments)?;
    let chunks = arguments.chunks(&batch);
    filled(py, &batch, Cost::Lookup, |range, out| f(&chunks, range, out))
}
