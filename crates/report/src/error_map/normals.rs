//! Errors of tables of masking and of visible normals.

use microfacet_baker::certify::certificate::{Ruler, cotangent, view};
use microfacet_baker::progress::Stage;
use microfacet_core::shape::{gamma_of_s, s_of_gamma};
use microfacet_sampler::Tables;
use microfacet_tables::{Provenance, Table};
use rayon::prelude::*;

use super::{Place, Quantity, Span, Unmeasured};

/// A table, with the other tables that a lobe is read from together with it.
pub(super) struct Normals {
    /// Its first table is the one to measure.
    set: Tables,
    /// s of the certificate's largest error.
    worst: f64,
    spans: Vec<Span>,
}

impl Normals {
    pub(super) fn new(set: &Tables, table: &Table) -> Result<Self, Unmeasured> {
        let set = Tables::from_tables(Provenance::default(), with_others(set, table))?;
        let worst = Quantity::Gamma.worst(table).map_or(1.0, s_of_gamma);
        let shapes = ruler(&set).shapes;
        let span = |axis: &microfacet_tables::Axis| match Quantity::of(axis) {
            Quantity::Gamma => {
                let shapes = shapes.clone();
                Span::new(Quantity::Gamma, move |share| {
                    gamma_of_s(shapes.s(shapes.place(ascending(share), worst)))
                })
            }
            Quantity::Number => Span::of_numbers(axis),
            other => {
                let axis = axis.clone();
                Span::new(other, move |share| cotangent(&axis, worst, share))
            }
        };
        let spans = table.axes.iter().map(span).collect();
        Ok(Self { set, worst, spans })
    }
}

impl super::Ruler for Normals {
    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn errors(&self, places: &[Place], run: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured> {
        let ruler = ruler(&self.set);
        let at = |place: &Place, quantity: Quantity| {
            let mut along = self.spans.iter().zip(place);
            along
                .find(|(span, _)| span.quantity == quantity)
                .map_or(0.5, |(span, x)| span.value(*x))
        };
        let of_shape = |places: &[Place]| {
            let share = ascending(places[0][0]);
            let lobe = ruler.lobe(ruler.shapes.place(share, self.worst))?;
            let error = |place: &Place| {
                let u = at(place, Quantity::Number) as f32;
                ruler.error_at(&lobe, || view(at(place, Quantity::Cotangent)), u)
            };
            let errors: Vec<f64> = places.par_iter().map(error).collect();
            stage.steps(places.len());
            Ok(errors)
        };
        let errors: Result<Vec<_>, Unmeasured> = places.par_chunks(run).map(of_shape).collect();
        Ok(errors?.concat())
    }
}

fn ruler(set: &Tables) -> Ruler<'_> {
    let table = &set.tables()[0];
    Ruler::new(set, table, table.subject.lobe.s())
}

/// The share along s for a share along γ: γ ascends along an axis of a map, and s falls as γ rises.
fn ascending(share: f64) -> f64 {
    1.0 - share
}

/// The table, and tables of other kinds that a lobe is read from together with it. A second table
/// of its own kind is left out, since a lobe might be read from that one.
fn with_others(set: &Tables, table: &Table) -> Vec<Table> {
    let overlaps = |other: &Table| {
        let [a, b] = [other, table].map(|table| table.subject.lobe.gamma);
        a.min <= b.max && b.min <= a.max
    };
    let is_beside = |other: &&Table| {
        let of_normals = other.kind == microfacet_tables::Kind::Shadowing
            || other.axes.iter().any(|axis| Quantity::of(axis) == Quantity::Number);
        let of_family = other.subject.lobe.is_family();
        other.kind != table.kind && of_normals && of_family && overlaps(other)
    };
    let others = set.tables().iter().filter(is_beside);
    std::iter::once(table).chain(others).cloned().collect()
}
