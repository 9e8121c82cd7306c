//! Errors of the tables of a distribution outside the family.

use microfacet_baker::certify::certificate::cotangent;
use microfacet_baker::certify::radial::{Ruler, read};
use microfacet_baker::distribution::Named;
use microfacet_baker::progress::Stage;
use microfacet_model::classic::{Isotropic, Marginal};
use microfacet_sampler::{Lobe, Tables};
use microfacet_tables::{MaterialEntry, Table};
use rayon::prelude::*;

use super::{Place, Quantity, Span, Unmeasured};

/// One table of a distribution outside the family, with the lobe that all its tables make.
pub(super) struct Radial<'a> {
    table: &'a Table,
    lobe: Lobe,
    distribution: Box<dyn Isotropic>,
    spans: Vec<Span>,
}

impl<'a> Radial<'a> {
    pub(super) fn new(set: &Tables, table: &'a Table) -> Result<Self, Unmeasured> {
        let Some(label) = &table.subject.lobe.distribution else {
            return Err(Unmeasured::NoAxes);
        };
        let distribution = label.parse::<Named>()?.build()?;
        let is_of = |entry: &&MaterialEntry| entry.lobe.distribution.as_ref() == Some(label);
        let of_label = set.provenance().materials.iter().find(is_of);
        let entry =
            of_label.ok_or_else(|| Unmeasured::NoTable(format!("a material of `{label}`")))?;
        let lobe = set.material(&entry.name)?;
        let span = |axis: &microfacet_tables::Axis| match Quantity::of(axis) {
            Quantity::Number => Span::of_numbers(axis),
            other => {
                let (axis, part) = (axis.clone(), read(table.kind, axis));
                // s = 1, since the tables have no axis of γ.
                Span::new(other, move |share| cotangent(&axis, 1.0, part * share))
            }
        };
        let spans = table.axes.iter().map(span).collect();
        Ok(Self { table, lobe, distribution, spans })
    }
}

impl super::Ruler for Radial<'_> {
    fn spans(&self) -> &[Span] {
        &self.spans
    }

    fn errors(&self, places: &[Place], _: usize, stage: &Stage) -> Result<Vec<f64>, Unmeasured> {
        let marginal = Marginal::new(&*self.distribution);
        let ruler = Ruler::new(&self.lobe, &marginal, &self.table.axes);
        let error = |place: &Place| {
            stage.step();
            ruler.error(self.table.kind, [place[0], place[1]])
        };
        Ok(places.par_iter().map(error).collect())
    }
}
