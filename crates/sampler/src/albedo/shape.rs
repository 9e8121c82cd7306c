//! The albedos of one shape for all roughnesses.

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_tables::axis::lagrange::{SIX, six, weights};
use microfacet_tables::axis::{LogRoughness, PreparedView, ViewBlend};
use microfacet_tables::{Axis, Interpolation, Kind, Mapping, Table};

use super::average::over_views;
use super::elevation::Elevation;
use super::moments::{Moments, averaged, down_to_grazing, less_mirror};
use crate::tables::Tables;
use crate::vector::vec3;

/// The directional albedo of one shape γ for every roughness: a table of moments of the family with
/// its axis of γ collapsed.
///
/// Made by [`Tables::shape_albedo`]. [`at`](Self::at) gives the values of
/// [`Tables::albedo`](crate::Tables::albedo) to rounding, without its call for each σ;
/// [`FamilyAlbedo`](crate::albedo::FamilyAlbedo) takes γ at every hit as well, in less time and
/// with an error of its own.
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
    /// E − 1, and the excess of bias and F82 over E times those of a mirror: by σ, by view.
    pub values: Vec<[f32; 3]>,
    masking: Masking,
    /// The σ of the first node and of the last.
    ends: [f64; 2],
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
        let [first, last] = sigma.ends().map(|t| roughness.quantity(t));
        let masking = table.subject.masking?;
        rest.is_empty().then(|| Self {
            table,
            roughness,
            axis: sigma,
            view: blend.of_shape(gamma),
            views: view.len(),
            values: nodes.iter().map(|node| node.map(|x| x as f32)).collect(),
            masking,
            ends: [first, last],
        })
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// The albedo at a roughness, in some tens of nanoseconds.
    ///
    /// σ is clamped to the table's, [1e-8, 3] in the default set, and NaN counts as the smallest;
    /// σ ≤ 0 is a mirror, with E = 1, where the table has one.
    #[must_use]
    pub fn at(&self, sigma: f32) -> ShapeAlbedoAt<'_> {
        let [first, last] = self.ends;
        let mirror = sigma <= 0.0 && self.table.subject.lobe.roughness.x().min <= 0.0;
        let sigma = f64::from(sigma).max(first).min(last);
        let (n, [low, high]) = (self.axis.len(), self.axis.ends());
        let t = self.roughness.coordinate(sigma);
        let (start, weights) = if n >= SIX {
            six(((t - low) / (high - low)) as f32, n)
        } else {
            let mut all = [0.0; SIX];
            for (i, weight) in weights(&self.axis.nodes, t, SIX) {
                all[i] = weight as f32;
            }
            (0, all)
        };
        let weights = if mirror { [0.0; SIX] } else { weights };
        ShapeAlbedoAt { shape: self, start, weights, view: self.view.prepare_shaped(sigma) }
    }
}

/// The directional albedo of one shape and one roughness, read from a [`ShapeAlbedo`].
///
/// Views are taken as by [`Albedo`](crate::albedo::Albedo), whose values these are to rounding.
#[derive(Clone, Copy, Debug)]
pub struct ShapeAlbedoAt<'a> {
    shape: &'a ShapeAlbedo<'a>,
    /// The first of six roughnesses and their weights.
    start: usize,
    weights: [f32; SIX],
    view: PreparedView,
}

impl ShapeAlbedoAt<'_> {
    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.shape.masking
    }

    /// Moments of the Fresnel weights at a view, each in [0, 1], with a total of at most 1.
    #[must_use]
    pub fn moments(&self, v: impl Into<[f32; 3]>) -> Moments {
        let cos = unit(vec3(v).z);
        Moments::mirror(cos).plus(self.rest(cos))
    }

    /// The directional albedo E(v) with F = 1, in [0, 1].
    #[must_use]
    pub fn albedo(&self, v: impl Into<[f32; 3]>) -> f32 {
        1.0 - self.lost(v)
    }

    /// The share of light lost, 1 − E(v), with all its digits where E is close to 1.
    #[must_use]
    pub fn lost(&self, v: impl Into<[f32; 3]>) -> f32 {
        let cos = unit(vec3(v).z);
        let [e] = if cos >= self.view.floor() as f32 {
            self.interpolate(cos)
        } else {
            [self.rest(cos)[0]]
        };
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
        let view = Elevation::Blend(&self.view);
        less_mirror(over_views(&view, self.shape.views, &|cos| averaged(cos, self.rest(cos))))
    }

    /// E − 1 in [−1, 0], and the excess of the other moments over E times a mirror's.
    pub(super) fn rest(&self, cos: f32) -> [f32; 3] {
        let at = |cos| self.interpolate(cos);
        down_to_grazing(self.shape.masking, self.view.floor() as f32, cos, at)
    }

    /// The first N channels.
    fn interpolate<const N: usize>(&self, cos: f32) -> [f32; N] {
        let ShapeAlbedo { values, views, .. } = self.shape;
        let (first, view) = six(self.view.clamped(cos), *views);
        let mut sum = [0.0; N];
        // A table of fewer than six roughnesses has fewer rows.
        let rows = values[self.start * views..].chunks_exact(*views);
        for (row, a) in rows.zip(self.weights) {
            for (node, b) in row[first..first + SIX].iter().zip(view) {
                for (sum, x) in sum.iter_mut().zip(node) {
                    *sum += a * b * x;
                }
            }
        }
        sum[0] = sum[0].clamp(-1.0, 0.0);
        sum
    }
}
