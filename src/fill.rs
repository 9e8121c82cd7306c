//! The most accurate set in a file of so many bytes.
//!
//! First the least common error is found that all tables can keep together, each being the smallest that keeps it. Tables that come in
//! grades leave a rest, since the next better grade is much larger: what they leave goes to the visible normals, whose number of nodes is free.

use microfacet_sampler::{Precision, Provenance, Table, Tables, encode};

use crate::budget::{Memo, smallest};
use crate::cache::Cache;
use crate::generate::{BakeError, Baked, Job, add_albedo_conventions};
use crate::graded::{Choice, Graded};
use crate::plan::{Need, Plan};
use crate::spec::Quality;

/// Last of the steps of a twentieth of a decade, from 0.1, in which errors are tried: beyond what f32 lookups can reach.
const LAST: usize = 140;

/// The error of a step. On the first, tables in grades may err by more, so that it is the smallest set there is.
fn error_of(step: usize) -> f64 {
    0.1 * 10_f64.powf(-0.05 * step as f64)
}

/// Bakes the tables of a plan with the least error, to 12%, whose safetensors file has no more than `max_bytes`.
///
/// # Errors
/// [`BakeError::TooSmall`] with the bytes of the smallest set there is.
pub fn fill(
    plan: &Plan,
    max_bytes: usize,
    mut provenance: Provenance,
    cache: &Cache,
) -> Result<Baked, BakeError> {
    if !plan.albedos.is_empty() {
        add_albedo_conventions(&mut provenance);
    }
    let graded: Vec<Graded> = plan
        .distributions
        .iter()
        .map(|distribution| Graded::distribution(distribution, &provenance))
        .chain(plan.albedos.iter().map(|need| Ok(Graded::Albedo(need))))
        .collect::<Result<_, _>>()?;
    let bare = size(&provenance, &[]);
    // Each grade follows from any other.
    let what: Vec<String> = graded.iter().map(|one| one.key(Quality::Draft, Precision::F32)).collect();
    let key = format!("{:?}, {what:?}, {max_bytes} bytes at most, {bare} of them without tables", plan.needs);
    let mut job = Job { cache, baked: 0, cache_error: None };
    let tables = match cache.get(&key) {
        Some(tables) => tables,
        None => {
            let choices = graded.iter().map(Choice::new).collect();
            let mut filling = Filling {
                needs: &plan.needs,
                choices,
                memo: Memo::default(),
                provenance: &provenance,
                max_bytes,
            };
            let tables = filling.run(&mut job)?;
            job.keep(&key, &tables);
            // Of those that were tried, the ones in the set count.
            job.baked = tables.len();
            tables
        }
    };
    let Job { baked, cache_error, .. } = job;
    Ok(Baked { set: Tables::from_tables(provenance, tables)?, baked, cache_error })
}

/// Bytes of the file of a set.
fn size(provenance: &Provenance, tables: &[Table]) -> usize {
    encode(provenance, tables).map_or(usize::MAX, |bytes| bytes.len())
}

struct Filling<'a> {
    needs: &'a [Need],
    choices: Vec<Choice<'a>>,
    memo: Memo,
    provenance: &'a Provenance,
    max_bytes: usize,
}

impl Filling<'_> {
    fn run(&mut self, job: &mut Job) -> Result<Vec<Table>, BakeError> {
        let normals = self.normals(0).expect("the coarsest error is within reach");
        let graded = self.graded(0, usize::MAX, job)?.expect("some grade is the smallest");
        let coarsest = [normals.clone(), graded.clone()].concat();
        let bytes = size(self.provenance, &coarsest);
        if bytes > self.max_bytes {
            return Err(BakeError::TooSmall { max_bytes: self.max_bytes, smallest: bytes });
        }
        let (common, (normals, graded)) = finest((0, (normals, graded)), |step| {
            let Some(normals) = self.normals(step) else { return Ok(None) };
            let Some(room) = self.max_bytes.checked_sub(size(self.provenance, &normals)) else {
                return Ok(None);
            };
            let Some(graded) = self.graded(step, room, job)? else { return Ok(None) };
            Ok(self.fits(&normals, &graded).then_some((normals, graded)))
        })?;
        if graded.is_empty() {
            return Ok(normals);
        }
        let (_, normals) = finest((common, normals), |step| {
            Ok(self.normals(step).filter(|normals| self.fits(normals, &graded)))
        })?;
        Ok([normals, graded].concat())
    }

    /// The tables of visible normals with the error of a step, if that is within reach.
    fn normals(&mut self, step: usize) -> Option<Vec<Table>> {
        let tables = self.needs.iter().map(|need| smallest(need, error_of(step), &mut self.memo));
        Some(tables.collect::<Result<Vec<_>, _>>().ok()?.concat())
    }

    /// The smallest grades with the error of a step, if there are any and their values fit into `room` bytes.
    fn graded(
        &mut self,
        step: usize,
        mut room: usize,
        job: &mut Job,
    ) -> Result<Option<Vec<Table>>, BakeError> {
        let max_error = if step == 0 { f64::INFINITY } else { error_of(step) };
        let mut tables = Vec::new();
        for i in 0..self.choices.len() {
            // What comes after takes this much at least.
            let later = self.choices[i + 1..].iter().map(Choice::least_bytes).sum();
            let Some(left) = room.checked_sub(later) else { return Ok(None) };
            let Some(found) = self.choices[i].smallest(max_error, left, job)? else { return Ok(None) };
            room = room.saturating_sub(found.iter().map(Table::stored_bytes).sum());
            tables.extend(found);
        }
        Ok(Some(tables))
    }

    fn fits(&self, normals: &[Table], graded: &[Table]) -> bool {
        size(self.provenance, &[normals, graded].concat()) <= self.max_bytes
    }
}

/// The last step from `first` on at which `attempt` gives something, and what it gave, by bisection.
fn finest<T>(
    first: (usize, T),
    mut attempt: impl FnMut(usize) -> Result<Option<T>, BakeError>,
) -> Result<(usize, T), BakeError> {
    let (mut best, mut fails) = (first, LAST);
    while fails - best.0 > 1 {
        let middle = (best.0 + fails) / 2;
        match attempt(middle)? {
            Some(found) => best = (middle, found),
            None => fails = middle,
        }
    }
    Ok(best)
}
