//! The albedos that a set has of a lobe that is not round, by azimuth and view.

use microfacet_core::Masking;
use microfacet_sampler::Tables;
use microfacet_sampler::albedo::Albedo;
use microfacet_tables::axis::ViewBlend;
use microfacet_tables::{Mapping, Reflectance, Table};

use super::albedo::{average_of, stored, worst};

/// Directional albedos of one upright lobe with F = 1, by azimuth and view, and their averages.
#[derive(Clone, Debug)]
pub struct TurningAlbedo {
    /// The form of masking.
    pub masking: Masking,
    /// σx and σy.
    pub sigma: [f64; 2],
    /// Nodes of azimuth over a quarter turn, which is mirrored.
    pub azimuths: usize,
    /// The coordinate of views, in which the roughness along the azimuth stands for σ.
    pub view: ViewBlend,
    /// Nodes along the view.
    pub views: usize,
    /// E − 1, and the excess of bias and of F82 over E times those of a mirror: by azimuth, by
    /// view.
    pub values: Vec<[f32; 3]>,
    /// ln(1 − E_avg), and the averages of bias and F82.
    pub averages: [f32; 3],
    /// The largest error of E, bias and F82 against the model for cos θ ≥ 0.02.
    pub error: Option<f64>,
}

impl TurningAlbedo {
    /// All that a set has of one shape.
    pub(super) fn all(tables: &Tables, gamma: f64) -> Vec<Self> {
        tables.tables().iter().filter_map(|table| Self::of(table, gamma)).collect()
    }

    /// `None` of a table of another kind or shape, or of a tilted lobe, whose quarters differ.
    fn of(table: &Table, gamma: f64) -> Option<Self> {
        let subject = &table.subject;
        let is_of_shape = subject.lobe.distribution.is_none() && subject.lobe.contains_shape(gamma);
        let [azimuth, view] = &table.axes[..] else { return None };
        let (Mapping::Azimuth(turning), Mapping::ViewBlend(blend)) =
            (azimuth.mapping, view.mapping)
        else {
            return None;
        };
        let is_mirror = subject.reflectance == Some(Reflectance::Mirror);
        if !(is_of_shape && is_mirror && turning.fold) {
            return None;
        }
        let albedo = Albedo::from_table(table, turning.sigma[0], gamma).ok()?;
        Some(Self {
            masking: subject.masking?,
            sigma: turning.sigma,
            azimuths: azimuth.len(),
            view: blend,
            views: view.len(),
            values: table.values.as_chunks().0.to_vec(),
            averages: stored(average_of(&albedo)),
            error: worst(table, |of| Some(of.largest)),
        })
    }
}
