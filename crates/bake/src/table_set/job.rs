//! The cache, the limits, the counts and the progress of a bake.

use std::collections::HashSet;
use std::io;

use microfacet_tables::Table;

use super::Settings;
use crate::cache::Cache;
use crate::progress::Meter;

pub(super) struct Job {
    cache: Cache,
    pub(super) progress: Meter,
    pub(super) max_memory: u64,
    pub(super) patient: bool,
    /// Names of tables that were baked, not read from the cache.
    fresh: HashSet<String>,
    pub(super) cache_error: Option<io::Error>,
    pub(super) seconds: [f64; 2],
}

impl Job {
    pub(super) fn new(settings: Settings) -> Self {
        let Settings { cache, max_memory, patient, progress } = settings;
        let (fresh, cache_error, seconds) = Default::default();
        Self { cache, progress, max_memory, patient, fresh, cache_error, seconds }
    }

    pub(super) fn get(&self, key: &str, are: impl Fn(&[Table]) -> bool) -> Option<Vec<Table>> {
        self.cache.get(key).filter(|tables| are(tables))
    }

    pub(super) fn keep(&mut self, key: &str, tables: &[Table]) {
        if let Err(why) = self.cache.put(key, tables) {
            self.cache_error.get_or_insert(why);
        }
    }

    pub(super) fn forget(&self, key: &str) {
        self.cache.remove(key);
    }

    /// Counts tables of these names as newly baked.
    pub(super) fn made<'t>(&mut self, tables: impl IntoIterator<Item = &'t Table>) {
        self.fresh.extend(tables.into_iter().map(|table| table.name.clone()));
    }

    /// Number of the tables that were newly baked.
    pub(super) fn baked_of(&self, tables: &[Table]) -> usize {
        tables.iter().filter(|table| self.fresh.contains(&table.name)).count()
    }
}
