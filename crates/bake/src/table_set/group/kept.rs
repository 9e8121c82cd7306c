//! Checks that tables from a cache are those that a group asks for, since a file with the right key
//! may hold any tables. Values and certificates are not checked, as in any set that is read.

use microfacet_tables::{Axis, Kind, Precision, Subject, Table};

use super::TableGroup;
use crate::bake::albedo::AlbedoSpec;
use crate::bake::{self, radial_axes, radial_subject};
use crate::table_spec::{Level, TableSpec};

impl TableGroup {
    /// Whether these are the tables of this group at a level and precision, with certificates.
    pub(in crate::table_set) fn asks_for(
        &self,
        tables: &[Table],
        level: Level,
        precision: Precision,
    ) -> bool {
        let asked = match self {
            Self::Normals(..) => all(tables, &self.specs(level, precision), is_of),
            Self::Distribution(distribution, _) => {
                is_radial(tables, &distribution.label(), level, precision)
            }
            Self::Albedo(need) => {
                need.spec(level, precision).is_ok_and(|spec| is_albedo(tables, &spec))
            }
        };
        asked && tables.iter().all(|table| table.certificate.largest().is_some())
    }
}

fn all<T>(tables: &[Table], asked: &[T], is: impl Fn(&Table, &T) -> bool) -> bool {
    tables.len() == asked.len() && tables.iter().zip(asked).all(|(table, asked)| is(table, asked))
}

/// Whether a table of visible normals is that of a specification.
pub(super) fn is_of(table: &Table, spec: &TableSpec) -> bool {
    let Table { name, kind, subject, axes, channels, precision, .. } = table;
    let asked = (&spec.name, spec.kind, Subject::shapes(spec.covers), spec.precision);
    (name, *kind, subject.clone(), *precision) == asked
        && *axes == bake::axes(spec)
        && channels == Kind::VALUE_AND_SLOPE
}

/// The mappings of axes are not compared: their constants depend on the distribution, which takes
/// long to build.
fn is_radial(tables: &[Table], label: &str, level: Level, precision: Precision) -> bool {
    let subject = radial_subject(label);
    let is_axis = |axis: &Axis, asked: &Axis| {
        (&axis.name, axis.interpolation, axis.len())
            == (&asked.name, asked.interpolation, asked.len())
    };
    let is = |table: &Table, (kind, axes): &(Kind, Vec<Axis>)| {
        let asked = (subject.name(*kind), *kind, &subject, precision);
        (table.name.clone(), table.kind, &table.subject, table.precision) == asked
            && table.channels == Kind::VALUE_AND_SLOPE
            && table.axes.len() == axes.len()
            && table.axes.iter().zip(axes).all(|(axis, asked)| is_axis(axis, asked))
    };
    all(tables, &radial_axes(level, 1.0, f64::INFINITY), is)
}

/// Axes may have more nodes than asked for, since tables are refined.
fn is_albedo(tables: &[Table], spec: &AlbedoSpec) -> bool {
    let averages = spec.has_averages().then_some(Kind::AlbedoAverage);
    let kinds = [Some(Kind::Albedo), averages];
    let asked = spec
        .maskings
        .iter()
        .flat_map(|&masking| kinds.into_iter().flatten().map(move |kind| (kind, masking)));
    let is_axis = |axis: &Axis, asked: &Axis| {
        (&axis.name, axis.mapping, axis.interpolation, axis.ends())
            == (&asked.name, asked.mapping, asked.interpolation, asked.ends())
            && axis.len() >= asked.len()
    };
    let is = |table: &Table, &(kind, masking): &_| {
        let (axes, precision) = match kind {
            Kind::Albedo => (&spec.axes[..], spec.precision),
            _ => (&spec.axes[..2], Precision::F32),
        };
        let asked = (spec.name(kind, masking), kind, spec.subject(masking), precision);
        (table.name.clone(), table.kind, table.subject.clone(), table.precision) == asked
            && table.channels == spec.channels()
            && table.axes.len() == axes.len()
            && table.axes.iter().zip(axes).all(|(axis, asked)| is_axis(axis, asked))
    };
    all(tables, &asked.collect::<Vec<_>>(), is)
}
