//! The albedos of one shape under one form of masking, for any roughness.

use microfacet_core::Masking;
use microfacet_sampler::Tables;
use microfacet_sampler::albedo::{Albedo, ShapeAlbedo};
use microfacet_tables::SIGMA_MAX;
use microfacet_tables::axis::lagrange::weights;
use microfacet_tables::axis::{LogRoughness, ViewBlend};
use microfacet_tables::{Errors, Table};

/// Nodes of the polynomials along σ and along the view.
pub(super) const WINDOW: usize = 6;

/// Error of averages between their nodes that ends the refinement, if [`FINEST`] does not.
const ENOUGH: f64 = 1e-5;
/// The most nodes of averages for each cell of the table.
const FINEST: usize = 16;

/// Directional albedos over (σ, view), and their averages over σ.
#[derive(Clone, Debug)]
pub struct AlbedoTable {
    /// The form of masking.
    pub masking: Masking,
    /// The coordinate of σ.
    pub roughness: LogRoughness,
    /// Its values at the first node and at the last; nodes are evenly spaced.
    pub ends: [f64; 2],
    /// The smallest σ and the largest.
    pub sigma: [f64; 2],
    /// Nodes along σ.
    pub sigmas: usize,
    /// The coordinate of views. It does not depend on γ.
    pub view: ViewBlend,
    /// Nodes along the view.
    pub views: usize,
    /// E − 1, and the excess of bias and of F82 over E times those of a mirror: by σ, by view.
    pub values: Vec<[f32; 3]>,
    /// ln(1 − E_avg), so that small losses keep their order of magnitude between nodes, and the
    /// averages of bias and F82, at evenly spaced nodes between the same ends.
    pub averages: Vec<[f32; 3]>,
    /// The largest error of the averages between these nodes, of E, bias or F82.
    pub average_error: f64,
    /// Errors of E, bias and F82 against the model: for σ ≥ 0.01 and cos θ ≥ 0.02, and elsewhere.
    pub errors: [Option<f64>; 2],
}

impl AlbedoTable {
    /// From the first table of a set that has the shape for every roughness; `None` if none has.
    pub(super) fn find(tables: &Tables, gamma: f64, masking: Masking) -> Option<Self> {
        let found = ShapeAlbedo::find(tables, gamma, masking, SIGMA_MAX)?;
        let (ends, sigmas) = (found.axis.ends(), found.axis.len());
        if sigmas < WINDOW {
            return None;
        }
        let sigma = ends.map(|t| found.axis.quantity(t));
        let [e, bias, f82] = &found.channels;
        let values = e.iter().zip(bias).zip(f82).map(|((&e, &bias), &f82)| [e, bias, f82]);
        let mut table = Self {
            masking,
            roughness: found.roughness,
            ends,
            sigma: [sigma[0]?, sigma[1]?],
            sigmas,
            view: found.view,
            views: found.views,
            values: values.collect(),
            averages: Vec::new(),
            average_error: f64::INFINITY,
            errors: [
                worst(found.table, |of| Some(of.largest)),
                worst(found.table, |of| of.outside),
            ],
        };
        let average =
            |sigma: f64| Some(average_of(&Albedo::from_table(found.table, sigma, gamma).ok()?));
        let mut parts = 1;
        while table.average_error > ENOUGH && parts <= FINEST {
            table.refine(parts, average)?;
            parts *= 2;
        }
        Some(table)
    }

    /// Without its values: lookups then take the surface for a mirror.
    pub(super) fn leave_out(&mut self) {
        (self.values, self.averages) = (Vec::new(), Vec::new());
    }

    /// Takes the averages at `parts` nodes a cell, and measures their error.
    fn refine(&mut self, parts: usize, average: impl Fn(f64) -> Option<[f64; 3]>) -> Option<()> {
        let cells = (self.sigmas - 1) * parts;
        let [first, last] = self.ends;
        let step = (last - first) / cells as f64;
        let sigma =
            |x: f64| self.roughness.quantity(first + x * step).clamp(self.sigma[0], self.sigma[1]);
        let at_node = |i: usize| Some(stored(average(sigma(i as f64))?));
        let averages: Vec<[f32; 3]> = (0..=cells).map(at_node).collect::<Option<_>>()?;
        let nodes: Vec<f64> = (0..=cells).map(|i| i as f64).collect();
        let mut error = 0.0_f64;
        for i in 0..2 * cells {
            // The error is largest about the middle of a cell.
            let x = 0.5 * i as f64 + 0.3;
            let mut got = [0.0; 3];
            for (node, weight) in weights(&nodes, x, WINDOW) {
                for (got, value) in got.iter_mut().zip(averages[node]) {
                    *got += weight * f64::from(value);
                }
            }
            got[0] = got[0].exp();
            for (got, want) in got.into_iter().zip(average(sigma(x))?) {
                error = error.max((got - want).abs());
            }
        }
        (self.averages, self.average_error) = (averages, error);
        Some(())
    }
}

/// 1 − E_avg, and the averages of bias and F82.
pub(super) fn average_of(albedo: &Albedo) -> [f64; 3] {
    let moments = albedo.average_moments();
    [albedo.lost_average(), moments.bias, moments.f82].map(f64::from)
}

/// Averages as they are written, with ln(1 − E_avg).
pub(super) fn stored([lost, bias, f82]: [f64; 3]) -> [f32; 3] {
    [lost.max(f64::MIN_POSITIVE).ln(), bias, f82].map(|x| x as f32)
}

/// The largest `figure` of a table's certificate over E, bias and F82.
pub(super) fn worst(table: &Table, figure: impl Fn(&Errors) -> Option<f64>) -> Option<f64> {
    table.certificate.errors.values().filter_map(figure).reduce(f64::max)
}
