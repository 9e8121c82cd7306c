//! The tables of a group: read from the cache, or baked, certified and cached.

use std::time::Instant;

use microfacet_model::classic::Marginal;
use microfacet_sampler::Tables;
use microfacet_tables::{LoadError, MaterialEntry, Precision, Provenance, Table};

use super::super::BakeError;
use super::super::job::Job;
use super::super::refine::albedo_tables;
use super::TableGroup;
use super::kept::is_of;
use crate::bake;
use crate::certify::certificate::{POINTS, measure};
use crate::certify::radial;
use crate::distribution::Distribution;
use crate::plan::{RequiredShapes, normals_work, radial_work};
use crate::progress::Meter;
use crate::table_spec::{Level, TableSpec};

impl TableGroup {
    /// The cache key of the tables, with all that their values depend on.
    pub(in crate::table_set) fn key(&self, level: Level, precision: Precision) -> String {
        match self {
            Self::Normals(need, _) => {
                let (specs, s) = (self.specs(level, precision), need.certified_s());
                format!("{specs:?}, {POINTS} points at s in {s:?}")
            }
            // Its values are part of the key, since two measured files may have the same name.
            Self::Distribution(distribution, _) => {
                format!("{distribution:?}, {}, {level:?}, {precision:?}", distribution.label())
            }
            Self::Albedo(need) => format!("{:?}", need.spec(level, precision)),
        }
    }

    /// The certified tables of a level in several precisions, from the cache or newly baked.
    pub(in crate::table_set) fn bake(
        &self,
        level: Level,
        precisions: &[Precision],
        job: &mut Job,
    ) -> Result<Vec<Vec<Table>>, BakeError> {
        let start = Instant::now();
        let keys: Vec<String> =
            precisions.iter().map(|&precision| self.key(level, precision)).collect();
        let kept: Option<Vec<Vec<Table>>> = std::iter::zip(&keys, precisions)
            .map(|(key, &precision)| job.get(key, |tables| self.asks_for(tables, level, precision)))
            .collect();
        let sets = match (kept, self) {
            (Some(sets), _) => {
                job.progress.forget(self.work(level, precisions.len()));
                sets
            }
            (None, Self::Normals(need, _)) => self.normals(need, level, precisions, &keys, job)?,
            (None, Self::Distribution(distribution, entry)) => {
                let sets = radial_tables(distribution, entry, level, precisions, &job.progress)?;
                self.finish(&keys, sets, job)
            }
            (None, Self::Albedo(need)) => {
                let spec = need.spec(level, Precision::F32)?;
                let stored: Vec<Precision> =
                    precisions.iter().map(|&asked| need.stored(asked)).collect();
                let sets = albedo_tables(&spec, &stored, &job.progress)?;
                self.finish(&keys, sets, job)
            }
        };
        job.seconds[usize::from(matches!(self, Self::Albedo(_)))] += start.elapsed().as_secs_f64();
        Ok(sets)
    }

    fn finish(&self, keys: &[String], sets: Vec<Vec<Table>>, job: &mut Job) -> Vec<Vec<Table>> {
        for (key, tables) in keys.iter().zip(&sets) {
            job.made(tables);
            job.keep(key, tables);
        }
        sets
    }

    /// Tables of visible normals, baked one by one so that an interrupted bake can be resumed.
    fn normals(
        &self,
        need: &RequiredShapes,
        level: Level,
        precisions: &[Precision],
        keys: &[String],
        job: &mut Job,
    ) -> Result<Vec<Vec<Table>>, BakeError> {
        let specs = self.specs(level, Precision::F32);
        let progress = job.progress.clone();
        let stage = |seconds| progress.stage(seconds);
        let bake = |spec: &TableSpec| bake::bake(spec, &stage(normals_work(spec)[0]));
        let mut full = Vec::new();
        for spec in &specs {
            // Cached in single precision, of which other precisions are roundings.
            let key = format!("{spec:?}");
            let is_it = |tables: &[Table]| tables.len() == 1 && is_of(&tables[0], spec);
            full.push(match job.get(&key, is_it).and_then(|mut tables| tables.pop()) {
                Some(table) => {
                    progress.forget(normals_work(spec)[0]);
                    table
                }
                None => {
                    let table = bake(spec);
                    job.made([&table]);
                    // A slice is not cached here, since it is baked as fast as it is read.
                    if !need.gamma().is_point() {
                        job.keep(&key, std::slice::from_ref(&table));
                    }
                    table
                }
            });
        }
        let others: Vec<Table> = self.other_specs().iter().map(bake).collect();
        let certified = |&precision: &Precision| {
            let rounded = full.iter().map(|table| table.clone().rounded(precision));
            let all = rounded.chain(others.iter().cloned()).collect();
            let set = Tables::from_tables(Provenance::default(), all)?;
            let measured = set.tables()[..full.len()].iter().zip(&specs).map(|(table, spec)| {
                let stage = stage(normals_work(spec)[1]);
                let certificate = measure(&set, table, need.certified_s(), &stage)?;
                Ok(table.clone().with_certificate(certificate))
            });
            measured.collect()
        };
        let sets =
            precisions.iter().map(certified).collect::<Result<Vec<Vec<Table>>, BakeError>>()?;
        for (key, tables) in keys.iter().zip(&sets) {
            job.keep(key, tables);
        }
        specs.iter().for_each(|spec| job.forget(&format!("{spec:?}")));
        Ok(sets)
    }
}

/// The certified tables of one distribution outside the family, in several precisions.
fn radial_tables(
    distribution: &Distribution,
    entry: &MaterialEntry,
    level: Level,
    precisions: &[Precision],
    progress: &Meter,
) -> Result<Vec<Vec<Table>>, BakeError> {
    let built = distribution.build().map_err(|why| LoadError::Invalid(why.to_string()))?;
    let marginal = Marginal::new(&*built);
    let [bake, certify] = radial_work(distribution, level);
    let stage = progress.stage(bake);
    let label = distribution.label();
    let full = bake::bake_radial(&marginal, &label, level, Precision::F32, &stage);
    drop(stage);
    let certified = |&precision| {
        let mut tables: Vec<Table> =
            full.iter().map(|table| table.clone().rounded(precision)).collect();
        radial::certify(&mut tables, entry, &marginal, &progress.stage(certify))?;
        Ok(tables)
    };
    precisions.iter().map(certified).collect()
}
