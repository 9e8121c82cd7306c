//! The albedos of one shape for all roughnesses.

use alloc::vec::Vec;
use core::f64::consts::LN_2;

use microfacet_core::Masking;
use microfacet_core::math::{unit, within};
use microfacet_tables::axis::lagrange::{MIDDLE, SIX, SixLanes, few, six_lanes};
use microfacet_tables::axis::{FastBlend, FastView, LogRoughness, ViewBlend};
use microfacet_tables::{Axis, Interpolation, Kind, Mapping, Table};
use wide::f32x4;

use super::average::over_views;
use super::batch::of_each;
use super::elevation::Elevation;
use super::moments::{Moments, averaged, down_to_grazing, less_mirror};
use crate::elementary::log2;
use crate::error::BatchError;
use crate::tables::Tables;
use crate::vector::vec3;

/// The directional albedo of one shape γ for every roughness: a table of moments of the family with
/// its axis of γ collapsed.
///
/// Made by [`Tables::shape_albedo`]. [`at`](Self::at) gives the values of
/// [`Tables::albedo`](crate::Tables::albedo) to rounding, without its call for each σ;
/// [`FamilyAlbedo`](crate::albedo::FamilyAlbedo) takes γ at every hit as well, in less time and
/// with an error of its own. `cargo run --profile dist -p microfacet-bench` measures E alone, some
/// 30 ns, and with `at`, twice as much.
#[derive(Clone, Debug)]
pub struct ShapeAlbedo<'a> {
    /// The table.
    pub table: &'a Table,
    /// The coordinate of σ.
    pub roughness: LogRoughness,
    /// The axis of σ, whose nodes are even.
    pub axis: &'a Axis,
    /// The coordinate of views, without γ.
    pub view: ViewBlend,
    /// Nodes along the view.
    pub views: usize,
    /// E − 1, and the excess of bias and F82 over E times those of a mirror: each by σ, by view.
    /// Where there are fewer than six roughnesses, rows of zeros stand for the others.
    pub channels: [Vec<f32>; 3],
    fast: FastBlend,
    /// How far one roughness is from the next among the values.
    stride: u32,
    masking: Masking,
    /// The σ of the first node and of the last.
    ends: [f32; 2],
    /// Whether the table has a mirror, σ = 0.
    mirror: bool,
    /// Of six nodes and more.
    place: Option<Place>,
}

/// The coordinate of roughnesses among evenly spaced nodes, as [`LogRoughness`] states it, in
/// single precision.
#[derive(Clone, Copy, Debug)]
struct Place {
    offset: f32,
    /// Factors of log₂(offset + σ), of log₂ σ and of σ, and what is added.
    factors: [f32; 4],
    /// The first of the last six nodes.
    last: f32,
}

impl Place {
    fn new(roughness: LogRoughness, axis: &Axis) -> Self {
        let LogRoughness { offset, first, slow, linear } = roughness;
        let (n, [low, high]) = (axis.len(), axis.ends());
        let density = (n - 1) as f64 / (high - low);
        let start = libm::log(offset) + slow * libm::log(first) + low;
        let added = -start * density - f64::from(MIDDLE);
        let factors = [LN_2 * density, LN_2 * slow * density, linear * density, added];
        Self { offset: offset as f32, factors: factors.map(|x| x as f32), last: (n - SIX) as f32 }
    }

    /// The first of the six nodes about a roughness between the ends, and their weights.
    #[inline(always)]
    fn six(&self, sigma: f32) -> (usize, SixLanes) {
        let [a, b, c, added] = self.factors;
        let [near, far, ..] = log2(f32x4::from([self.offset + sigma, sigma, 1.0, 1.0])).to_array();
        six_lanes((a * near + b * far) + (c * sigma + added), self.last)
    }
}

impl<'a> ShapeAlbedo<'a> {
    /// Of the first table that has the shape, for every σ up to `largest`.
    #[must_use]
    pub fn find(tables: &'a Tables, gamma: f64, masking: Masking, largest: f64) -> Option<Self> {
        let serves = |table: &&Table| {
            let (lobe, sigma) = (&table.subject.lobe, table.subject.lobe.roughness.x());
            lobe.contains_shape(gamma) && sigma.min <= 0.0 && sigma.max >= largest
        };
        let mut tables = tables.moments(Kind::Albedo, masking).filter(serves);
        tables.find_map(|table| Self::of(table, gamma))
    }

    /// `None` where the table does not hold the shape.
    pub(super) fn of(table: &'a Table, gamma: f64) -> Option<Self> {
        let [shape, sigma, view] = &table.axes[..] else { return None };
        let (Mapping::LogRoughness(roughness), Mapping::ViewBlend(blend)) =
            (sigma.mapping, view.mapping)
        else {
            return None;
        };
        // Nodes of `Lagrange6` are even, which is checked when a table is loaded.
        if sigma.interpolation != Interpolation::Lagrange6 {
            return None;
        }
        let weights = shape.weights(shape.coordinate(gamma)?)?;
        let values = table.collapsed::<f64>(&[weights]);
        let (nodes, rest) = values.as_chunks::<3>();
        let channel = |i: usize| {
            let mut channel: Vec<f32> = nodes.iter().map(|node| node[i] as f32).collect();
            channel.resize(sigma.len().max(SIX) * view.len(), 0.0);
            channel
        };
        let masking = table.subject.masking?;
        let blend = blend.of_shape(gamma);
        rest.is_empty().then(|| Self {
            table,
            roughness,
            axis: sigma,
            view: blend,
            views: view.len(),
            channels: core::array::from_fn(channel),
            fast: blend.fast(view.len()),
            stride: view.len() as u32,
            masking,
            ends: sigma.ends().map(|t| roughness.quantity(t) as f32),
            mirror: table.subject.lobe.roughness.x().min <= 0.0,
            place: (sigma.len() >= SIX).then(|| Place::new(roughness, sigma)),
        })
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// The albedo at a roughness.
    ///
    /// σ is clamped to the table's, [1e-8, 3] in the default set, and NaN counts as the smallest;
    /// σ ≤ 0 is a mirror, with E = 1, where the table has one.
    #[inline]
    #[must_use]
    pub fn at(&self, sigma: f32) -> ShapeAlbedoAt<'_> {
        let is_mirror = self.mirror && sigma <= 0.0;
        let sigma = within(sigma, self.ends);
        let (start, [low, high]) = match &self.place {
            Some(place) => place.six(sigma),
            None => self.few(sigma),
        };
        let scale = if is_mirror { 0.0 } else { 1.0 };
        let ([a, b, c, d], [.., e, f]) = ((low * scale).to_array(), (high * scale).to_array());
        let splat = f32x4::splat;
        let weights = [[splat(a), splat(b)], [splat(c), splat(d)], [splat(e), splat(f)]];
        let (start, view) = (start as u32 * self.stride, self.fast.prepare(sigma));
        ShapeAlbedoAt { shape: self, start, weights, sigma, view }
    }

    /// The weights of fewer than six roughnesses.
    #[cold]
    fn few(&self, sigma: f32) -> (usize, SixLanes) {
        let t = self.roughness.coordinate(sigma.into());
        let [a, b, c, d, e, f] = few(&self.axis.nodes, t);
        (0, [[a, b, c, d], [0.0, 0.0, e, f]].map(f32x4::from))
    }
}

/// The directional albedo of one shape and one roughness, read from a [`ShapeAlbedo`].
///
/// Views are taken as by [`Albedo`](crate::albedo::Albedo), whose values these are to rounding.
#[derive(Clone, Copy, Debug)]
pub struct ShapeAlbedoAt<'a> {
    shape: &'a ShapeAlbedo<'a>,
    /// The first value of six roughnesses, and their weights, each in all lanes.
    start: u32,
    weights: [[f32x4; 2]; 3],
    /// The roughness, no less than the first node's.
    sigma: f32,
    view: FastView,
}

impl ShapeAlbedoAt<'_> {
    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.shape.masking
    }

    /// Moments of the Fresnel weights at a view, each in [0, 1], with a total of at most 1.
    #[inline]
    #[must_use]
    pub fn moments(&self, v: impl Into<[f32; 3]>) -> Moments {
        let cos = unit(vec3(v).z);
        Moments::mirror(cos).plus(self.rest(cos))
    }

    /// The directional albedo E(v) with F = 1, in [0, 1].
    #[inline]
    #[must_use]
    pub fn albedo(&self, v: impl Into<[f32; 3]>) -> f32 {
        1.0 - self.lost(v)
    }

    /// [`albedo`](Self::albedo) for each view, into `e`: the same numbers.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `e` is then untouched.
    pub fn albedo_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        e: &mut [f32],
    ) -> Result<(), BatchError> {
        of_each(v, e, |v| self.albedo(v))
    }

    /// The share of light lost, 1 − E(v), with all its digits where E is close to 1.
    #[inline]
    #[must_use]
    pub fn lost(&self, v: impl Into<[f32; 3]>) -> f32 {
        let cos = unit(vec3(v).z);
        let e = if cos >= self.view.floor() { self.e(self.view.six(cos)) } else { self.below(cos) };
        0.0 - e
    }

    /// The average share of light lost, 1 − E_avg, by quadrature: it takes some microseconds.
    #[must_use]
    pub fn lost_average(&self) -> f32 {
        0.0 - self.average()[0]
    }

    /// The average albedo E_avg = 1/π ∫∫ E μ dμ dφ with F = 1, by quadrature.
    #[must_use]
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// Cosine-weighted averages of the moments over the hemisphere of views, by quadrature.
    #[must_use]
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average())
    }

    /// The averages, as the channels of tables.
    fn average(&self) -> [f32; 3] {
        let view = self.shape.view.prepare_shaped(self.sigma.into());
        let rest = |cos| averaged(cos, self.rest(cos));
        less_mirror(over_views(&Elevation::Blend(view), self.shape.views, &rest))
    }

    /// E − 1 in [−1, 0], and the excess of the other moments over E times a mirror's.
    #[inline]
    pub(super) fn rest(&self, cos: f32) -> [f32; 3] {
        let floor = self.view.floor();
        let at = |cos: f32| {
            let view = self.view.six(if cos > floor { cos } else { floor });
            [self.e(view), self.channel(1, view), self.channel(2, view)]
        };
        down_to_grazing(self.shape.masking, floor, cos, at)
    }

    /// E − 1 at a view lower than the first node.
    #[cold]
    #[inline(never)]
    fn below(&self, cos: f32) -> f32 {
        self.rest(cos)[0]
    }

    /// E − 1, at a place among the views.
    #[inline(always)]
    fn e(&self, view: (usize, SixLanes)) -> f32 {
        within(self.channel(0, view), [-1.0, 0.0])
    }

    /// One channel at a place among the views: the roughnesses are combined first, then the views.
    #[inline(always)]
    fn channel(&self, channel: usize, (first, [low, high]): (usize, SixLanes)) -> f32 {
        let values = &self.shape.channels[channel][..];
        let mut at = self.start + first as u32;
        // Two sums at a time, which do not wait for each other.
        let mut sums = [[f32x4::ZERO; 2]; 2];
        for pair in &self.weights {
            for (sums, weight) in sums.iter_mut().zip(pair) {
                let from = at as usize;
                let row: &[f32; SIX] = values[from..from + SIX].first_chunk().expect("six");
                at += self.shape.stride;
                let (first, last) = (row.first_chunk::<4>(), row.last_chunk::<4>());
                sums[0] += f32x4::from(*first.expect("of six")) * *weight;
                sums[1] += f32x4::from(*last.expect("of six")) * *weight;
            }
        }
        let [[a, b], [c, d]] = sums;
        let [a, b, c, d] = ((a + c) * low + (b + d) * high).to_array();
        (a + b) + (c + d)
    }
}
