//! One table group in a search: the predicted error and size of each level, and those measured.

use std::collections::BTreeMap;

use microfacet_tables::{Precision, Table};

use super::BakeError;
use super::group::TableGroup;
use super::job::Job;
use crate::memory::{self, Values};
use crate::table_spec::Level;

/// 16-bit fixed point is the only small precision to choose from: half precision takes the same
/// bytes, and its error, 3e-4 to 1e-3 of a value, is that of fixed point at best.
const PRECISIONS: [Precision; 2] = [Precision::U16, Precision::F32];
/// Another bake is worth it only if its size is at most this share of the best so far.
const WORTH: f64 = 0.9;
/// Limit of a group's measuring time, in bakes of it at default quality or, if longer, in the time
/// spent so far.
const ALLOWANCE: f64 = 2.0;
/// Estimated duration of a whole search, as a multiple of that of its first grades.
pub(super) const SEARCH_OVER_FIRST: f64 = 1.7;
/// The same for the progress: between a search that ends with its first grade, and a whole one.
const EXPECTED_OVER_FIRST: f64 = 1.3;

/// A grade: a level, and the index of one of [`PRECISIONS`].
pub(super) type Grade = (Level, usize);

/// A grade with its predicted or measured error and size, and whether they were measured.
#[derive(Clone, Copy)]
pub(super) struct Pick {
    pub(super) grade: Grade,
    /// Estimated bytes of the values before refinement, and estimated seconds of one thread to
    /// bake them.
    values: f64,
    seconds: f64,
    pub(super) error: f64,
    pub(super) bytes: f64,
    pub(super) measured: bool,
}

/// The measurements of a grade.
struct Measured {
    tables: Vec<Table>,
    error: f64,
    bytes: f64,
    /// Ratio of the number of values to the estimated one, for an albedo that was refined.
    growth: f64,
}

/// A table group with the predictions and measurements of its grades.
pub(super) struct Candidate {
    pub(super) group: TableGroup,
    /// Measurements by precision.
    measured: [BTreeMap<Level, Measured>; 2],
    /// Estimated bytes of names, axes and certificates.
    header: f64,
    /// Estimated seconds of one thread for a bake at default quality, and for those done so far.
    pub(super) default_seconds: f64,
    spent: f64,
    /// Work expected for the rest of the search.
    expected: f64,
    /// All grades, the coarsest first.
    menu: Vec<Pick>,
}

impl Candidate {
    pub(super) fn new(group: TableGroup) -> Self {
        let file_bytes = group.file_bytes(Level::DEFAULT, Precision::F32);
        let header = file_bytes.saturating_sub(group.bytes(Level::DEFAULT, Precision::F32)) as f64;
        let default_seconds = group.seconds(Level::DEFAULT);
        let at = |level: i32| {
            let (level, seconds) = (Level(level), group.seconds(Level(level)));
            [0, 1].map(|precision| Pick {
                grade: (level, precision),
                values: group.bytes(level, PRECISIONS[precision]) as f64,
                seconds,
                error: f64::INFINITY,
                bytes: f64::INFINITY,
                measured: false,
            })
        };
        let menu = group.levels().flat_map(at).collect();
        let mut new = Self {
            group,
            measured: Default::default(),
            header,
            default_seconds,
            spent: 0.0,
            expected: 0.0,
            menu,
        };
        new.predict();
        new
    }

    /// Predicts errors and bytes of the menu, from the expected errors and the measured ones.
    fn predict(&mut self) {
        let mut menu = std::mem::take(&mut self.menu);
        for pick in &mut menu {
            (pick.error, pick.bytes, pick.measured) = self.prediction(pick);
        }
        self.menu = menu;
    }

    fn prediction(
        &self,
        &Pick { grade: (level, precision), values, .. }: &Pick,
    ) -> (f64, f64, bool) {
        let measured = &self.measured[precision];
        if let Some(&Measured { error, bytes, .. }) = measured.get(&level) {
            return (error, bytes, true);
        }
        let expected = |level: Level| self.group.expected(level, PRECISIONS[precision]);
        // Ratio of the measured error and size to those expected.
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

    /// The smallest grade that errs by no more than `max_error`, among those that satisfy a
    /// condition.
    pub(super) fn smallest(&self, max_error: f64, of: impl Fn(&Pick) -> bool) -> Option<Pick> {
        let meets = self.menu.iter().filter(|pick| pick.error <= max_error && of(pick));
        meets.min_by(|a, b| a.bytes.total_cmp(&b.bytes)).copied()
    }

    /// Whether a grade is measured already, or may still be measured within the allowance.
    pub(super) fn is_affordable(&self, pick: &Pick) -> bool {
        let limit = ALLOWANCE * self.default_seconds.max(self.spent);
        pick.measured || self.spent == 0.0 || self.spent + pick.seconds <= limit
    }

    /// Bakes and measures a grade, and others of its level where that costs hardly more.
    pub(super) fn measure(
        &mut self,
        (level, precision): Grade,
        job: &mut Job,
    ) -> Result<(), BakeError> {
        memory::check(Values::at_once([self.group.values(level)]), job.max_memory)?;
        let all = if self.group.shares_measuring() { vec![0, 1] } else { vec![precision] };
        let precisions: Vec<Precision> = all.iter().map(|&i| PRECISIONS[i]).collect();
        // What was expected for the whole search holds this work already, as far as it reaches.
        let work = self.group.work(level, precisions.len());
        let ahead = self.expected.min(work);
        self.expected -= ahead;
        job.progress.expect(work - ahead);
        for (i, tables) in all.into_iter().zip(self.group.bake(level, &precisions, job)?) {
            let error = tables.iter().map(|table| table.certificate.worst()).fold(0.0, f64::max);
            let values = tables.iter().map(Table::stored_bytes).sum::<usize>() as f64;
            let growth = values / self.group.bytes(level, PRECISIONS[i]) as f64;
            self.measured[i]
                .insert(level, Measured { tables, error, bytes: values + self.header, growth });
        }
        self.spent += self.group.seconds(level);
        self.predict();
        Ok(())
    }

    /// Announces the work of a search that begins at a grade.
    pub(super) fn expect(&mut self, (level, _): Grade, job: &Job) {
        let precisions = if self.group.shares_measuring() { PRECISIONS.len() } else { 1 };
        self.expected = EXPECTED_OVER_FIRST * self.group.work(level, precisions);
        job.progress.expect(self.expected);
    }

    /// Takes back what was announced and not needed.
    pub(super) fn finish(&mut self, job: &Job) {
        job.progress.forget(std::mem::take(&mut self.expected));
    }

    pub(super) fn finest(&self) -> Grade {
        (Level(*self.group.levels().end()), PRECISIONS.len() - 1)
    }

    pub(super) fn tables(&self, (level, precision): Grade) -> &[Table] {
        &self.measured[precision][&level].tables
    }

    /// A small grade whose measured error is at most `max_error`.
    pub(super) fn meeting(&mut self, max_error: f64, job: &mut Job) -> Result<Grade, BakeError> {
        loop {
            let best = self.smallest(max_error, |pick| pick.measured);
            let next = self.smallest(max_error, |pick| self.is_affordable(pick));
            let next = next.or_else(|| self.smallest(max_error, |_| true));
            let next = match (best, next) {
                (Some(best), Some(next)) if next.measured || next.bytes > WORTH * best.bytes => {
                    return Ok(best.grade);
                }
                (_, Some(next)) => next.grade,
                // The finest grade decides whether the error can be met.
                _ => self.finest(),
            };
            if self.measured[next.1].contains_key(&next.0) {
                let measured = self.measured.iter().flat_map(BTreeMap::values);
                let reached = measured.map(|measured| measured.error).fold(f64::INFINITY, f64::min);
                return Err(BakeError::OutOfReach { max_error, name: self.group.name(), reached });
            }
            self.measure(next, job)?;
        }
    }
}
