//! Which maps a page has.

use microfacet_sampler::Tables;
use microfacet_tables::Table;

use crate::error_map::{Sides, sides};

/// Most maps of a page.
const MOST: usize = 12;

/// The maps of a page.
pub(super) struct Chosen<'a> {
    /// Tables and axes, in the order of the set.
    pub(super) maps: Vec<(&'a Table, Sides)>,
    /// Maps that there is no room for.
    pub(super) left_out: usize,
    /// Tables without an axis to show.
    pub(super) single: Vec<&'a Table>,
}

impl<'a> Chosen<'a> {
    /// The first map of each table before the second of any, those of large errors before others.
    pub(super) fn of(set: &'a Tables) -> Self {
        let tables = set.tables();
        let mut all: Vec<(usize, usize, Sides)> = Vec::new();
        for (i, table) in tables.iter().enumerate() {
            all.extend(sides(table).into_iter().enumerate().map(|(nth, sides)| (nth, i, sides)));
        }
        let single = tables.iter().filter(|table| sides(table).is_empty()).collect();
        let error = |i: usize| tables[i].certificate.worst();
        all.sort_by(|a, b| a.0.cmp(&b.0).then(error(b.1).total_cmp(&error(a.1))));
        let left_out = all.len().saturating_sub(MOST);
        all.truncate(MOST);
        all.sort_by_key(|&(nth, i, _)| (i, nth));
        let maps = all.into_iter().map(|(_, i, sides)| (&tables[i], sides)).collect();
        Self { maps, left_out, single }
    }
}
