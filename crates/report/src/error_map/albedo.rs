//! Errors of tables of albedos.

use rayon::prelude::*;

use microfacet_baker::bake::albedo::{AlbedoSpec, Site};
use microfacet_baker::certify::albedo::{average_error, errors_at};
use microfacet_baker::certify::points::{promised_views, ranges, seen};
use microfacet_baker::progress::Stage;
use microfacet_sampler::Tables;
use microfacet_tables::{Axis, Kind, Mapping, Provenance, Table};

use super::{Place, Quantity, Span, Unmeasured};

/// Tolerance of a node as a share of the table's largest error, and its limits.
const FINE: f64 = 1.0 / 300.0;
const TOLERANCES: [f64; 2] = [1e-7, 1e-5];

/// The specification of a directional table, with a tolerance that follows from the table's errors.
pub(crate) fn spec(table: &Table) -> Option<AlbedoSpec> {
    let [least, most] = TOLERANCES;
    AlbedoSpec::of_table(table, (FINE * table.certificate.worst()).clamp(least, most))
}

pub(super) struct Albedos<'a> {
    /// Directional albedos.
    table: &'a Table,
    /// A set of the averages alone, if their errors are measured.
    averages: Option<Tables>,
    spec: AlbedoSpec,
    /// Axes of the material, and of the view unless averages are measured.
    spans: Vec<Span>,
}

impl<'a> Albedos<'a> {
    pub(super) fn new(set: &'a Tables, table: &'a Table) -> Result<Self, Unmeasured> {
        let is_of = |other: &&Table| other.kind == Kind::Albedo && other.subject == table.subject;
        let (directional, averages) = if table.kind == Kind::Albedo {
            (table, None)
        } else {
            let found = set.tables().iter().find(is_of);
            let found = found.ok_or_else(|| Unmeasured::NoTable("their directional albedo".into()));
            (found?, Some(Tables::from_tables(Provenance::default(), vec![table.clone()])?))
        };
        let lobe = directional.subject.lobe.distribution.as_deref().unwrap_or(&directional.name);
        let spec = spec(directional)
            .ok_or_else(|| Unmeasured::NoTable(format!("the curve of `{lobe}`")))?;
        let (view, of_material) = spec.axes.split_last().ok_or(Unmeasured::NoAxes)?;
        let axes = of_material.iter().enumerate();
        let mut spans: Vec<Span> = axes.map(|(i, axis)| material(&spec, i, axis.clone())).collect();
        if averages.is_none() {
            // Views are spaced as the table spaces them for the material of the largest error.
            let at = coordinates(&spec, spans.iter().map(|span| span.worst(table).unwrap_or(0.5)));
            let views = promised_views(view, Site::new(&spec.axes, &at));
            spans.push(Span::new(Quantity::Cosine, views));
        }
        Ok(Self { table: directional, averages, spec, spans })
    }
}

impl super::Ruler for Albedos<'_> {
    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn errors(&self, places: &[Place], _: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured> {
        let Self { table, spec, spans, .. } = self;
        let view = spec.axes.len() - 1;
        let material = |place: &Place| coordinates(spec, place[..view].iter().copied());
        let Some(averages) = &self.averages else {
            let point =
                |place: &Place| seen(spec, &material(place), spans[view].value(place[view]));
            return Ok(errors_at(spec, table, places.iter().map(point).collect(), stage)?);
        };
        let error = |place: &Place| {
            stage.step();
            Ok(average_error(averages, table, &Site::new(&spec.axes, &material(place)))?)
        };
        places.par_iter().map(error).collect()
    }
}

/// An axis of the material over the range that the certificate promises; γ ascends.
fn material(spec: &AlbedoSpec, i: usize, axis: Axis) -> Span {
    let ends = {
        let range = &ranges(spec)[i];
        [0.0, 1.0].map(|share| range.at(share))
    };
    let quantity = Quantity::of(&axis);
    let at = move |share| between(ends, quantity, share);
    match axis.mapping {
        Mapping::Azimuth(azimuth) => {
            let azimuth = azimuth.prepare(axis.len());
            let first = azimuth.quantity(ends[0]).to_degrees();
            Span::new(quantity, move |share| {
                // A full circle begins at the first principal axis, and ends there.
                let phi = azimuth.quantity(at(share)).to_degrees();
                if phi < first || (phi == first && share == 1.0) { phi + 360.0 } else { phi }
            })
        }
        _ => Span::new(quantity, move |share| axis.quantity(at(share)).unwrap_or(f64::NAN)),
    }
}

/// The coordinate at a share of a promised range.
fn between([first, last]: [f64; 2], quantity: Quantity, share: f64) -> f64 {
    let share = if quantity == Quantity::Gamma { 1.0 - share } else { share };
    first + share * (last - first)
}

/// Coordinates along the axes of materials, at shares of their promised ranges.
fn coordinates(spec: &AlbedoSpec, shares: impl Iterator<Item = f64>) -> Vec<f64> {
    let ranges = ranges(spec);
    let at = |(i, share): (usize, f64)| {
        let ends = [0.0, 1.0].map(|share| ranges[i].at(share));
        between(ends, Quantity::of(&spec.axes[i]), share)
    };
    shares.enumerate().map(at).collect()
}
