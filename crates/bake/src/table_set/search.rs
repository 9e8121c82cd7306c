//! Chooses levels and precisions for a budget of error or of bytes: predicted by a formula, then
//! measured.
//!
//! A *grade* is a level and a precision. `Candidate` predicts the error of each grade of a table
//! group by scaling how the errors of the general set fall with the level. A group is baked at the
//! coarsest grade that is predicted to meet the budget, and the error in its certificate corrects
//! the prediction, until the chosen grade has been measured.

use microfacet_tables::{Provenance, Table, encode};

use super::candidate::{Candidate, Grade, Pick, SEARCH_OVER_FIRST};
use super::group::TableGroup;
use super::job::Job;
use super::{BakeError, PATIENCE, in_layouts};
use crate::plan::{Plan, bare_cost, on_threads};

/// Ratio of two errors that count as different: one per cent.
const RATIO: f64 = 1.01;
/// Number of errors that are tried, from [`ANY_ERROR`], more than that of any table, down to less
/// than single precision resolves.
const ERRORS: i32 = 2000;
const ANY_ERROR: f64 = 1.0;
/// No further bake is worth it if the error measured is within this factor of the best predicted.
const CLOSE: f64 = 1.12;

/// The groups of a plan, to be chosen for a budget.
pub(super) struct Search {
    candidates: Vec<Candidate>,
}

impl Search {
    pub(super) fn new(plan: &Plan) -> Result<Self, BakeError> {
        Ok(Self { candidates: TableGroup::apart(plan)?.into_iter().map(Candidate::new).collect() })
    }

    /// The smallest tables whose errors are at most `max_error`.
    pub(super) fn meeting(
        mut self,
        max_error: f64,
        job: &mut Job,
    ) -> Result<Vec<Table>, BakeError> {
        let first = |candidate: &Candidate| {
            candidate.smallest(max_error, |_| true).map_or(candidate.finest(), |pick| pick.grade)
        };
        self.begin(&self.candidates.iter().map(first).collect::<Vec<_>>(), job)?;
        let grades = self.candidates.iter_mut().map(|candidate| {
            let grade = candidate.meeting(max_error, job);
            candidate.finish(job);
            grade
        });
        let grades = grades.collect::<Result<Vec<Grade>, _>>()?;
        Ok(self.tables(&grades))
    }

    /// The tables with the smallest worst error whose file, with its provenance, has at most
    /// `max_bytes`.
    pub(super) fn within(
        mut self,
        max_bytes: usize,
        provenance: &Provenance,
        job: &mut Job,
    ) -> Result<Vec<Table>, BakeError> {
        let mut room = max_bytes as f64 - bare_cost(provenance).bytes as f64;
        let worst = |picks: &[Pick]| picks.iter().map(|pick| pick.error).fold(0.0, f64::max);
        let mut is_first = true;
        loop {
            let known = self.fitting(room, |_, pick| pick.measured);
            let next = self
                .fitting(room, |candidate, pick| candidate.is_affordable(pick))
                .or_else(|| self.fitting(room, |_, _| true));
            let picks = match (known, next) {
                (Some(known), Some(next)) if worst(&known) <= CLOSE * worst(&next) => known,
                (_, Some(next)) => next,
                _ => self.coarsest(|_, _| true).expect("every group has levels"),
            };
            let grades: Vec<Grade> = picks.iter().map(|pick| pick.grade).collect();
            if std::mem::take(&mut is_first) {
                self.begin(&grades, job)?;
            }
            if picks.iter().all(|pick| pick.measured) {
                let tables = self.tables(&grades);
                let bytes = encode(provenance, &tables)?.len();
                if bytes <= max_bytes {
                    self.candidates.iter_mut().for_each(|candidate| candidate.finish(job));
                    return Ok(tables);
                }
                if self.fitting(room, |_, _| true).is_none() {
                    return Err(BakeError::TooSmall { max_bytes, smallest: bytes });
                }
                // The estimate for names and certificates was too small.
                let taken: f64 = picks.iter().map(|pick| pick.bytes).sum();
                room = room.min(taken) - (bytes - max_bytes) as f64;
                continue;
            }
            for (candidate, pick) in
                self.candidates.iter_mut().zip(picks).filter(|(_, pick)| !pick.measured)
            {
                candidate.measure(pick.grade, job)?;
            }
        }
    }

    /// The grades with the smallest common error that fit into `room` bytes, among those that
    /// satisfy a condition. Groups without a better grade leave their bytes to the others.
    fn fitting(&self, room: f64, of: impl Fn(&Candidate, &Pick) -> bool) -> Option<Vec<Pick>> {
        let bytes = |picks: &[Pick]| picks.iter().map(|pick| pick.bytes).sum::<f64>();
        let mut picks = self.coarsest(&of).filter(|picks| bytes(picks) <= room)?;
        let mut free: Vec<usize> = (0..self.candidates.len()).collect();
        while !free.is_empty() {
            let fixed: f64 =
                (0..picks.len()).filter(|i| !free.contains(i)).map(|i| picks[i].bytes).sum();
            let fits = |max_error: f64| {
                let each = free.iter().map(|&i| {
                    let candidate = &self.candidates[i];
                    candidate.smallest(max_error, |pick| of(candidate, pick))
                });
                each.collect::<Option<Vec<Pick>>>().filter(|picks| fixed + bytes(picks) <= room)
            };
            let (mut found, mut low, mut high) = (None, 0, ERRORS);
            while low < high {
                let middle = (low + high) / 2;
                match fits(ANY_ERROR * libm::pow(RATIO, -f64::from(middle))) {
                    Some(picks) => (found, low) = (Some(picks), middle + 1),
                    None => high = middle,
                }
            }
            if let Some(found) = found {
                free.iter().zip(found).for_each(|(&i, pick)| picks[i] = pick);
            }
            // The groups with the worst error have no better grade that fits: they keep theirs, and
            // the error of the others is lowered further.
            let worst = free.iter().map(|&i| picks[i].error).fold(0.0, f64::max);
            free.retain(|&i| picks[i].error < worst / RATIO);
        }
        Some(picks)
    }

    /// The smallest grades that satisfy a condition, if each group has one.
    fn coarsest(&self, of: impl Fn(&Candidate, &Pick) -> bool) -> Option<Vec<Pick>> {
        let least =
            |candidate: &Candidate| candidate.smallest(f64::INFINITY, |pick| of(candidate, pick));
        self.candidates.iter().map(least).collect()
    }

    /// Announces a search that begins with these grades, or refuses it if it would take longer than
    /// allowed.
    fn begin(&mut self, grades: &[Grade], job: &Job) -> Result<(), BakeError> {
        let seconds = |(candidate, grade): (&Candidate, &Grade)| candidate.group.seconds(grade.0);
        let search =
            SEARCH_OVER_FIRST * self.candidates.iter().zip(grades).map(seconds).sum::<f64>();
        let default_seconds: f64 =
            self.candidates.iter().map(|candidate| candidate.default_seconds).sum();
        // A user's patience is by the clock.
        let [search, default_seconds] = [search, default_seconds].map(on_threads);
        if !job.patient && search > PATIENCE.max(3.0 * default_seconds) {
            return Err(BakeError::TooSlow { search, default_seconds });
        }
        let each = self.candidates.iter_mut().zip(grades);
        each.for_each(|(candidate, grade)| candidate.expect(*grade, job));
        Ok(())
    }

    fn tables(&self, grades: &[Grade]) -> Vec<Table> {
        let each = self.candidates.iter().zip(grades);
        in_layouts(each.flat_map(|(candidate, &grade)| candidate.tables(grade).to_vec()).collect())
    }
}
