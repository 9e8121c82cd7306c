//! Chooses levels and precisions for a budget of error or of bytes.
//!
//! A *grade* is a level and a precision. The error of a table group falls with the level about as
//! that of the general set; the ratio of both is measured at levels that were baked, and
//! interpolated between them. So each bake narrows the levels down, until the coarsest that meets
//! the budget is itself baked and certified.

use std::collections::BTreeMap;

use microfacet_tables::{Precision, Provenance, Table, encode};

use super::group::TableGroup;
use super::job::Job;
use super::{BakeError, PATIENCE, in_layouts};
use crate::memory::{self, Values};
use crate::plan::{Known, Plan, bare_bytes, on_threads};
use crate::table_spec::Level;

/// 16-bit fixed point is the only small precision to choose from: half precision takes the same
/// bytes, and its error, 3e-4 to 1e-3 of a value, is that of fixed point at best.
const PRECISIONS: [Precision; 2] = [Precision::U16, Precision::F32];
/// Another bake is worth it only if its size is at most this share of the best so far.
const WORTH: f64 = 0.9;
/// Limit of a group's measuring time, as a multiple of its bake at default quality or, if longer,
/// of the time spent so far.
const ALLOWANCE: f64 = 2.0;
/// Ratio of two errors that count as different: one per cent.
const RATIO: f64 = 1.01;
/// Number of errors that are tried, from 1, above that of any table, to below what single precision
/// resolves.
const ERRORS: i32 = 2000;
/// No further bake is worth it if the error measured is within this factor of the best predicted.
const CLOSE: f64 = 1.12;
/// The share of the planned bytes that any set has; the rest are digits of certificates.
const SURE: f64 = 0.96;
/// Estimated duration of a whole search, as a multiple of that of its first grades.
const SEARCH_OVER_FIRST: f64 = 1.7;
/// The multiple for the progress: between a search that ends with its first grades, and a whole
/// one.
const EXPECTED_OVER_FIRST: f64 = 1.3;

/// A grade with its error and bytes, predicted or measured.
#[derive(Clone, Copy)]
struct Pick {
    level: Level,
    /// Index of one of [`PRECISIONS`].
    precision: usize,
    /// Bytes of the values before refinement, and the work to bake and certify them once.
    values: f64,
    work: f64,
    error: f64,
    bytes: f64,
    measured: bool,
}

/// Grades to choose from: those measured, also those that may be measured within the allowance, or
/// all.
#[derive(Clone, Copy, PartialEq)]
enum Among {
    Measured,
    Affordable,
    All,
}

struct Measured {
    tables: Vec<Table>,
    error: f64,
    bytes: f64,
    /// Ratio of the number of values to the estimated one, for an albedo that was refined.
    growth: f64,
}

/// A table group with its grades.
struct Candidate {
    group: TableGroup,
    /// Measurements by precision.
    measured: [BTreeMap<Level, Measured>; 2],
    /// Estimated bytes of names, axes and certificates.
    header: f64,
    /// Estimated work of a bake at default quality, and of what was measured.
    default_work: f64,
    spent: f64,
    /// All grades, the coarsest first.
    menu: Vec<Pick>,
}

impl Candidate {
    /// `known` has the axes and layouts that groups before this one describe.
    fn new(group: TableGroup, known: &mut Known) -> Self {
        let at = |level: i32| {
            let work = group.work(Level(level), 1);
            [0, 1].map(|precision| Pick {
                level: Level(level),
                precision,
                values: group.bytes(Level(level), PRECISIONS[precision]) as f64,
                work,
                error: f64::INFINITY,
                bytes: f64::INFINITY,
                measured: false,
            })
        };
        let menu = group.levels().flat_map(at).collect();
        // In fixed point, which has scales in the header, and the smallest grade.
        let header = group.header(Level::DEFAULT, PRECISIONS[0], known) as f64;
        let default_work = group.work(Level::DEFAULT, 1);
        let measured = Default::default();
        let mut new = Self { group, measured, header, default_work, spent: 0.0, menu };
        new.predict();
        new
    }

    /// Predicts errors and bytes of the menu from expectations and measurements.
    fn predict(&mut self) {
        let mut menu = std::mem::take(&mut self.menu);
        for pick in &mut menu {
            (pick.error, pick.bytes, pick.measured) = self.prediction(pick);
        }
        self.menu = menu;
    }

    fn prediction(&self, &Pick { level, precision, values, .. }: &Pick) -> (f64, f64, bool) {
        let measured = &self.measured[precision];
        if let Some(&Measured { error, bytes, .. }) = measured.get(&level) {
            return (error, bytes, true);
        }
        let expected = |level: Level| self.group.expected(level, PRECISIONS[precision]);
        // Ratio of the measured error and number of values to those expected.
        let off =
            |(at, measured): (&Level, &Measured)| [measured.error / expected(*at), measured.growth];
        let below = measured.range(..level).next_back();
        let above = measured.range(level..).next();
        let [worse, growth] = match (below, above) {
            (None, None) => [1.0; 2],
            (Some(one), None) | (None, Some(one)) => off(one),
            (Some(a), Some(b)) => {
                let t = f64::from(level.0 - a.0.0) / f64::from(b.0.0 - a.0.0);
                let ([low, _], [high, growth]) = (off(a), off(b));
                [low * libm::pow(high / low, t), growth]
            }
        };
        (worse * expected(level), growth * values + self.header, false)
    }

    /// The smallest grade whose error is at most `max_error`.
    fn smallest(&self, max_error: f64, among: Among) -> Option<Pick> {
        let limit = ALLOWANCE * self.default_work.max(self.spent);
        let is_affordable = |pick: &Pick| self.spent == 0.0 || self.spent + pick.work <= limit;
        let is_among = |pick: &Pick| match among {
            _ if pick.measured => true,
            Among::Measured => false,
            Among::Affordable => is_affordable(pick),
            Among::All => true,
        };
        let meets = |pick: &&Pick| pick.error <= max_error && is_among(pick);
        self.menu.iter().filter(meets).min_by(|a, b| a.bytes.total_cmp(&b.bytes)).copied()
    }

    /// The grade to take for a largest error, or to measure next; the finest, if none is predicted
    /// to meet the error.
    fn meeting(&self, max_error: f64) -> Result<Pick, BakeError> {
        let next = self.smallest(max_error, Among::Affordable);
        let next = next.or_else(|| self.smallest(max_error, Among::All));
        match (self.smallest(max_error, Among::Measured), next) {
            (Some(best), Some(next)) if next.bytes > WORTH * best.bytes => Ok(best),
            (_, Some(next)) => Ok(next),
            _ => match self.menu.last() {
                Some(finest) if !finest.measured => Ok(*finest),
                _ => {
                    let measured = self.measured.iter().flat_map(BTreeMap::values);
                    let reached = measured.map(|it| it.error).fold(f64::INFINITY, f64::min);
                    Err(BakeError::OutOfReach { max_error, name: self.group.name(), reached })
                }
            },
        }
    }

    /// The precisions that are measured together.
    fn precisions(&self, asked: usize) -> Vec<usize> {
        if self.group.shares_measuring() { vec![0, 1] } else { vec![asked] }
    }

    fn work(&self, pick: &Pick) -> f64 {
        self.group.work(pick.level, self.precisions(pick.precision).len())
    }

    fn measure(&mut self, pick: &Pick, job: &mut Job) -> Result<(), BakeError> {
        let level = pick.level;
        memory::check(Values::at_once([self.group.values(level)]), job.max_memory)?;
        let all = self.precisions(pick.precision);
        let precisions: Vec<Precision> = all.iter().map(|&i| PRECISIONS[i]).collect();
        for (i, tables) in all.into_iter().zip(self.group.bake(level, &precisions, job)?) {
            let error = tables.iter().map(|table| table.certificate.worst()).fold(0.0, f64::max);
            let values = tables.iter().map(Table::stored_bytes).sum::<usize>() as f64;
            let growth = values / self.group.bytes(level, PRECISIONS[i]) as f64;
            let measured = Measured { tables, error, bytes: values + self.header, growth };
            self.measured[i].insert(level, measured);
        }
        self.spent += pick.work;
        self.predict();
        Ok(())
    }
}

fn candidates(groups: Vec<TableGroup>) -> Vec<Candidate> {
    let mut known = Known::default();
    groups.into_iter().map(|group| Candidate::new(group, &mut known)).collect()
}

/// Table groups to be chosen for a budget.
pub(super) struct Search {
    candidates: Vec<Candidate>,
    /// Work that was announced and is not done yet.
    ahead: f64,
}

impl Search {
    pub(super) fn new(groups: Vec<TableGroup>) -> Self {
        Self { candidates: candidates(groups), ahead: 0.0 }
    }

    /// The smallest tables whose errors are at most `max_error`.
    pub(super) fn meeting(
        mut self,
        max_error: f64,
        job: &mut Job,
    ) -> Result<Vec<Table>, BakeError> {
        let picks = self.measured(job, |candidates| {
            candidates.iter().map(|candidate| candidate.meeting(max_error)).collect()
        })?;
        Ok(self.finish(&picks, job))
    }

    /// The tables with the smallest worst error whose file, with its provenance, has at most
    /// `max_bytes`.
    pub(super) fn within(
        mut self,
        max_bytes: usize,
        provenance: &Provenance,
        job: &mut Job,
    ) -> Result<Vec<Table>, BakeError> {
        let bare = bare_bytes(provenance) as f64;
        let least = bare + bytes(&coarsest(&self.candidates, Among::All).unwrap_or_default());
        if SURE * least > max_bytes as f64 {
            let (smallest, planned) = (least.ceil() as usize, true);
            return Err(BakeError::TooSmall { max_bytes, smallest, planned });
        }
        let mut room = max_bytes as f64 - bare;
        loop {
            let picks =
                self.measured(job, |candidates| Ok(fitting_or_coarsest(candidates, room)))?;
            let size = encode(provenance, &self.tables(&picks))?.len();
            if size <= max_bytes {
                return Ok(self.finish(&picks, job));
            }
            if fitting(&self.candidates, room, Among::All).is_none() {
                return Err(BakeError::TooSmall { max_bytes, smallest: size, planned: false });
            }
            // The estimate for names and certificates was too small.
            room = room.min(bytes(&picks)) - (size - max_bytes) as f64;
        }
    }

    /// Measures the grades that `choose` picks, one for each group, until it picks measured ones.
    fn measured(
        &mut self,
        job: &mut Job,
        choose: impl Fn(&[Candidate]) -> Result<Vec<Pick>, BakeError>,
    ) -> Result<Vec<Pick>, BakeError> {
        loop {
            let picks = choose(&self.candidates)?;
            if self.candidates.iter().flat_map(|it| &it.measured).all(BTreeMap::is_empty) {
                self.begin(&picks, job)?;
            }
            if picks.iter().all(|pick| pick.measured) {
                return Ok(picks);
            }
            for (candidate, pick) in self.candidates.iter_mut().zip(&picks) {
                if !pick.measured {
                    let work = candidate.work(pick);
                    let known = self.ahead.min(work);
                    self.ahead -= known;
                    job.progress.expect(work - known);
                    candidate.measure(pick, job)?;
                }
            }
        }
    }

    /// Announces a search that begins with these grades, or refuses it if it would take too long.
    fn begin(&mut self, picks: &[Pick], job: &Job) -> Result<(), BakeError> {
        let each = self.candidates.iter().zip(picks);
        let seconds = picks.iter().map(|pick| pick.work);
        let default = self.candidates.iter().map(|candidate| candidate.default_work);
        let search = on_threads(SEARCH_OVER_FIRST * seconds.sum::<f64>());
        let default_seconds = on_threads(default.sum());
        if !job.patient && search > PATIENCE.max(3.0 * default_seconds) {
            return Err(BakeError::TooSlow { search, default_seconds });
        }
        let work = each.map(|(candidate, pick)| candidate.work(pick)).sum::<f64>();
        self.ahead = EXPECTED_OVER_FIRST * work;
        job.progress.expect(self.ahead);
        Ok(())
    }

    fn finish(&self, picks: &[Pick], job: &Job) -> Vec<Table> {
        job.progress.forget(self.ahead);
        self.tables(picks)
    }

    fn tables(&self, picks: &[Pick]) -> Vec<Table> {
        let each = self.candidates.iter().zip(picks);
        let of = |(candidate, pick): (&Candidate, &Pick)| {
            candidate.measured[pick.precision][&pick.level].tables.clone()
        };
        in_layouts(each.flat_map(of).collect())
    }
}

/// The expected bytes of the smallest set of a plan, with the coarsest tables.
///
/// # Errors
/// [`BakeError`] for a distribution of the plan that no material has.
pub fn smallest_bytes(plan: &Plan) -> Result<usize, BakeError> {
    let candidates = candidates(TableGroup::apart(plan)?);
    let least = bytes(&coarsest(&candidates, Among::All).unwrap_or_default());
    Ok(bare_bytes(&plan.provenance()) + least.ceil() as usize)
}

fn bytes(picks: &[Pick]) -> f64 {
    picks.iter().map(|pick| pick.bytes).sum()
}

fn worst(picks: &[Pick]) -> f64 {
    picks.iter().map(|pick| pick.error).fold(0.0, f64::max)
}

/// The smallest grades, if each group has one.
fn coarsest(candidates: &[Candidate], among: Among) -> Option<Vec<Pick>> {
    candidates.iter().map(|candidate| candidate.smallest(f64::INFINITY, among)).collect()
}

/// The grades to take for `room` bytes, or to measure next.
fn fitting_or_coarsest(candidates: &[Candidate], room: f64) -> Vec<Pick> {
    let next = fitting(candidates, room, Among::Affordable);
    let next = next.or_else(|| fitting(candidates, room, Among::All));
    match (fitting(candidates, room, Among::Measured), next) {
        (Some(known), Some(next)) if worst(&known) <= CLOSE * worst(&next) => known,
        (_, Some(next)) => next,
        _ => coarsest(candidates, Among::All).unwrap_or_default(),
    }
}

/// The grades with the smallest common error that fit into `room` bytes. The bytes that groups
/// without a better grade leave go to the others.
fn fitting(candidates: &[Candidate], room: f64, among: Among) -> Option<Vec<Pick>> {
    let mut picks = coarsest(candidates, among).filter(|picks| bytes(picks) <= room)?;
    let mut free: Vec<usize> = (0..candidates.len()).collect();
    while !free.is_empty() {
        let fixed: f64 =
            (0..picks.len()).filter(|i| !free.contains(i)).map(|i| picks[i].bytes).sum();
        let fits = |max_error: f64| {
            let each = free.iter().map(|&i| candidates[i].smallest(max_error, among));
            each.collect::<Option<Vec<Pick>>>().filter(|picks| fixed + bytes(picks) <= room)
        };
        let (mut found, mut low, mut high) = (None, 0, ERRORS);
        while low < high {
            let middle = (low + high) / 2;
            match fits(libm::pow(RATIO, -f64::from(middle))) {
                Some(picks) => (found, low) = (Some(picks), middle + 1),
                None => high = middle,
            }
        }
        if let Some(found) = found {
            free.iter().zip(found).for_each(|(&i, pick)| picks[i] = pick);
        }
        // The groups with the worst error have no better grade that fits. They keep their grades,
        // and the error of the others is lowered further.
        let worst = free.iter().map(|&i| picks[i].error).fold(0.0, f64::max);
        free.retain(|&i| picks[i].error < worst / RATIO);
    }
    Some(picks)
}
