//! Errors of tables of albedos.

use rayon::prelude::*;

use microfacet_baker::bake::albedo::{AlbedoSpec, Site};
use microfacet_baker::certify::albedo::{average_error, errors_at};
use microfacet_baker::certify::points::{promised_views, ranges, seen};
use microfacet_baker::progress::Stage;
use microfacet_sampler::Tables;
use microfacet_tables::{Axis, Kind, Mapping, Provenance, Table};

use super::{Place, Quantity, Span, Unmeasured};

/// A node as accurate as this share of the table's largest error tells errors apart; no less than
/// that of high quality, and no more than that of a draft.
const FINE: f64 = 1.0 / 300.0;
const TOLERANCES: [f64; 2] = [1e-7, 1e-5];

/// The specification of a directional table, with an accuracy that its errors ask for.
pub(crate) fn spec(table: &Table) -> Option<AlbedoSpec> {
    let [least, most] = TOLERANCES;
    AlbedoSpec::of_table(table, (FINE * table.certificate.worst()).clamp(least, most))
}

fn known(table: &Table) -> Result<AlbedoSpec, Unmeasured> {
    let lobe = table.subject.lobe.distribution.as_deref().unwrap_or(&table.name);
    spec(table).ok_or_else(|| Unmeasured::NoTable(format!("the curve of `{lobe}`")))
}

/// Directional albedos.
pub(super) struct Directional<'a> {
    table: &'a Table,
    spec: AlbedoSpec,
    spans: Vec<Span>,
}

impl<'a> Directional<'a> {
    pub(super) fn new(table: &'a Table) -> Result<Self, Unmeasured> {
        let spec = known(table)?;
        let (view, _) = spec.axes.split_last().ok_or(Unmeasured::NoAxes)?;
        let mut spans = materials(&spec);
        // Views are spaced as for the material of the largest error.
        let at = coordinates(&spec, spans.iter().map(|span| span.worst(table).unwrap_or(0.5)));
        let site = Site::new(&spec.axes, &at);
        spans.push(Span::new(Quantity::Cosine, promised_views(view, site)));
        Ok(Self { table, spec, spans })
    }
}

impl super::Ruler for Directional<'_> {
    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn errors(&self, places: &[Place], _: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured> {
        let view = self.spans.len() - 1;
        let point = |place: &Place| {
            let material = coordinates(&self.spec, place[..view].iter().copied());
            seen(&self.spec, &material, self.spans[view].value(place[view]))
        };
        let points = places.iter().map(point).collect();
        Ok(errors_at(&self.spec, self.table, points, stage)?)
    }
}

/// Averages over the views.
pub(super) struct Average<'a> {
    directional: &'a Table,
    /// The averages alone.
    set: Tables,
    spec: AlbedoSpec,
    spans: Vec<Span>,
}

impl<'a> Average<'a> {
    pub(super) fn new(set: &'a Tables, table: &Table) -> Result<Self, Unmeasured> {
        let is_of = |other: &&Table| other.kind == Kind::Albedo && other.subject == table.subject;
        let directional = set.tables().iter().find(is_of);
        let directional =
            directional.ok_or_else(|| Unmeasured::NoTable("their directional albedo".into()))?;
        let spec = known(directional)?;
        let set = Tables::from_tables(Provenance::default(), vec![table.clone()])?;
        Ok(Self { directional, set, spans: materials(&spec), spec })
    }
}

impl super::Ruler for Average<'_> {
    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn errors(&self, places: &[Place], _: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured> {
        let error = |place: &Place| {
            let at = coordinates(&self.spec, place[..self.spans.len()].iter().copied());
            stage.step();
            Ok(average_error(&self.set, self.directional, &Site::new(&self.spec.axes, &at))?)
        };
        places.par_iter().map(error).collect()
    }
}

/// The axes of materials over the ranges that are promised; γ ascends.
fn materials(spec: &AlbedoSpec) -> Vec<Span> {
    let axes = &spec.axes[..spec.axes.len() - 1];
    axes.iter().enumerate().map(|(i, axis)| material(spec, i, axis.clone())).collect()
}

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
