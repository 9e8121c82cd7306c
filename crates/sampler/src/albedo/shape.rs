//! The albedos of one shape for all roughnesses, for exports to other languages.

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_tables::axis::{LogRoughness, ViewBlend};
use microfacet_tables::{Axis, Interpolation, Kind, Mapping, Table};

use crate::tables::Tables;

/// A table of moments of the family with its axis of γ collapsed.
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

    fn of(table: &'a Table, gamma: f64) -> Option<Self> {
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
        rest.is_empty().then(|| Self {
            table,
            roughness,
            axis: sigma,
            view: blend.of_shape(gamma),
            views: view.len(),
            values: nodes.iter().map(|node| node.map(|x| x as f32)).collect(),
        })
    }
}
