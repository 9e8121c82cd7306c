//! The table in memory: axes, channels and values, with a certificate of the errors measured on it.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use microfacet_core::Real;

use super::certificate::Certificate;
use super::kind::Kind;
use super::precision::{Codec, Precision};
use super::subject::Subject;
use crate::axis::{Axis, Mapping, Weights};
use crate::error::LoadError;
use crate::interval::Interval;

/// A table of values at the nodes of named axes.
///
/// `values` is row-major with the axes slowest first and the channels fastest: shape
/// `[axes[0].len(), …, axes[n−1].len(), channels.len()]`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Table {
    /// Name inside its set, for messages; readers find tables by `kind` and `subject`.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// What it is of.
    pub subject: Subject,
    /// Axes, slowest first.
    pub axes: Vec<Axis>,
    /// Channel names, such as `value` and `slope`.
    pub channels: Vec<String>,
    /// Values in f32; rounded once, from f64, when they were stored.
    pub values: Vec<f32>,
    /// How the values are stored in a file.
    pub precision: Precision,
    /// The errors measured at baking.
    pub certificate: Certificate,
}

impl Table {
    /// A table of the channels that its kind has, in single precision and without a certificate.
    pub fn new(
        name: impl Into<String>,
        kind: Kind,
        subject: Subject,
        axes: Vec<Axis>,
        values: Vec<f32>,
    ) -> Self {
        let channels = kind.layout(&subject).channels.iter().map(ToString::to_string).collect();
        Self {
            name: name.into(),
            kind,
            subject,
            axes,
            channels,
            values,
            precision: Precision::F32,
            certificate: Certificate::default(),
        }
    }

    /// The table with the errors that were measured on it.
    #[must_use]
    pub fn with_certificate(self, certificate: Certificate) -> Self {
        Self { certificate, ..self }
    }

    /// Lengths along the axes, then the number of channels.
    pub fn shape(&self) -> Vec<usize> {
        self.axes.iter().map(Axis::len).chain([self.channels.len()]).collect()
    }

    /// Bytes of the values as they are stored.
    pub fn stored_bytes(&self) -> usize {
        self.precision.bytes() * self.values.len()
    }

    /// The table as it will be read back after being stored at `precision`.
    ///
    /// Rounding happens here and nowhere else, so that a certificate can be measured on what a
    /// reader gets.
    #[must_use]
    pub fn rounded(mut self, precision: Precision) -> Self {
        self.precision = precision;
        self.values = Codec::round(precision, self.values, self.channels.len());
        self
    }

    /// The values with the first axes collapsed, each to some of its nodes with their weights.
    pub fn collapsed<T: Real + From<f32>>(&self, at: &[Weights]) -> Vec<T> {
        let zero = T::constant(0.0);
        // All combinations of the nodes along the axes, as an index and the product of the weights.
        let mut rows = vec![(0, 1.0)];
        for (axis, weights) in self.axes.iter().zip(at) {
            let along = |row: usize, a: f64| {
                weights.iter().map(move |&(i, b)| (row * axis.len() + i, a * b))
            };
            rows = rows.into_iter().flat_map(|(row, a)| along(row, a)).collect();
        }
        let size =
            self.axes[at.len()..].iter().map(Axis::len).product::<usize>() * self.channels.len();
        let mut sum = vec![zero; size];
        for (row, weight) in rows {
            let weight = T::constant(weight);
            for (into, &x) in sum.iter_mut().zip(&self.values[row * size..]) {
                *into = *into + weight * T::from(x);
            }
        }
        sum
    }

    /// An end of the range of γ in the table's subject that its axis does not cover.
    fn uncovered(&self) -> Option<f64> {
        let of_shape =
            |axis: &&Axis| matches!(axis.mapping, Mapping::InverseShape | Mapping::LogShape(_));
        let axis = self.axes.iter().find(of_shape)?;
        let holds = |gamma: f64| axis.weights(axis.coordinate(gamma)?);
        let Interval { min, max } = self.subject.lobe.gamma;
        [max, min].into_iter().find(|&gamma| holds(gamma).is_none())
    }

    /// Checks everything that lookups rely on.
    ///
    /// # Errors
    /// [`LoadError`] naming the table and what is wrong.
    pub fn validate(&self) -> Result<(), LoadError> {
        let invalid = |why: String| LoadError::Invalid(format!("table `{}`: {why}", self.name));
        let fail = |why: String| Err(invalid(why));
        self.subject.check(self.kind).and_then(|()| self.certificate.check()).map_err(invalid)?;
        let layout = self.kind.layout(&self.subject);
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
        let expected: Vec<&str> = layout.axes.iter().map(|axis| axis.name).collect();
        if names != expected {
            return fail(format!("axes {names:?} where {expected:?} are expected"));
        }
        if self.channels != layout.channels {
            let (got, want) = (&self.channels, layout.channels);
            return fail(format!("channels {got:?} where {want:?} are expected"));
        }
        for (axis, rule) in self.axes.iter().zip(&layout.axes) {
            let (name, mapping, read) = (&axis.name, axis.mapping.name(), axis.interpolation);
            if !rule.mappings.contains(&mapping) {
                let want = rule.mappings.join("` or `");
                return fail(format!("axis `{name}` is mapped by `{mapping}`, not by `{want}`"));
            }
            let want = rule.interpolations;
            if !want.contains(&read) {
                return fail(format!("axis `{name}` is read by {read:?}, not by one of {want:?}"));
            }
            axis.validate()?;
        }
        if let Some(gamma) = self.uncovered() {
            return fail(format!("it covers gamma = {gamma}, which its axis does not hold"));
        }
        let expected =
            self.axes.iter().map(Axis::len).try_fold(self.channels.len(), usize::checked_mul);
        if expected != Some(self.values.len()) {
            return fail(format!("{} values for shape {:?}", self.values.len(), self.shape()));
        }
        // Without an early exit both checks of values are vectorised, four values at a time: they
        // take half of the time of loading the default set.
        if !self.values.iter().fold(true, |sound, x| sound & x.is_finite()) {
            return fail("a value is not finite".into());
        }
        let [low, high] = layout.range;
        let within = |sound, x: &f32| sound & (*x >= low) & (*x <= high);
        let nodes = self.values.chunks_exact(self.channels.len());
        if !nodes.fold(true, |sound, node| node[..layout.checked].iter().fold(sound, within)) {
            return fail(format!("a value is out of range, [{low:e}, {high}]"));
        }
        Ok(())
    }
}
