//! Levels and precisions for a budget of error or of bytes: predicted by a formula, then measured.
//!
//! Errors fall with the level as those of the general set do; that is the formula. A unit is baked where it
//! says that the budget is met, and what its certificate measures corrects the formula, until what is
//! chosen has been measured. So nothing is baked to learn what a neighbour tells.

use std::collections::BTreeMap;

use microfacet_sampler::{Precision, Provenance, Table, encode};

use super::job::Job;
use super::unit::Unit;
use super::{BakeError, PATIENCE};
use crate::memory;
use crate::plan::{Plan, bare_cost};
use crate::spec::Level;
use crate::validate::certificate::worst_error;

/// 16-bit fixed point is the only small precision to choose: half precision takes the same bytes, and its
/// error, 3e-4 to 1e-3 of a value, is that of fixed point at best.
const PRECISIONS: [Precision; 2] = [Precision::U16, Precision::F32];
/// Fewer bytes than this share are not worth another bake.
const WORTH: f64 = 0.9;
/// What a unit may spend on being measured more than once, in units of its bake at default quality.
const ALLOWANCE: f64 = 2.0;
/// How many times as long as its first grades a search takes, all in all.
const OFTEN: f64 = 1.7;
/// Errors that are told apart: by one per cent.
const RATIO: f64 = 1.01;
/// So many of them, from more than any table errs by down to less than single precision can tell.
const ERRORS: i32 = 2000;
const ANY_ERROR: f64 = 1.0;
/// A larger error than could be, by this factor, is not worth another bake.
const CLOSE: f64 = 1.12;

/// A level in one of [`PRECISIONS`], by its index.
type Grade = (Level, usize);

/// A grade, what it is predicted or was measured to be, and whether it was.
#[derive(Clone, Copy)]
struct Pick {
    grade: Grade,
    /// Bytes of the values before refinement, and seconds to bake it, as estimated.
    values: f64,
    seconds: f64,
    error: f64,
    bytes: f64,
    measured: bool,
}

/// What was measured of a grade.
struct Measured {
    tables: Vec<Table>,
    error: f64,
    bytes: f64,
    /// How many times as many values as estimated there are, of an albedo that was refined.
    growth: f64,
}

/// A unit and what is known of it.
struct Candidate<'a> {
    unit: Unit<'a>,
    /// By precision.
    measured: [BTreeMap<Level, Measured>; 2],
    /// Bytes of what is no value, about.
    header: f64,
    /// Seconds of a bake at default quality, and those that were spent, as estimated.
    plain: f64,
    spent: f64,
    /// All grades, the coarsest first.
    menu: Vec<Pick>,
}

impl<'a> Candidate<'a> {
    fn new(unit: Unit<'a>) -> Self {
        let cost = unit.cost(Level::DEFAULT, Precision::F32);
        let header = cost.bytes.saturating_sub(unit.bytes(Level::DEFAULT, Precision::F32)) as f64;
        let at = |level: i32| {
            let (level, seconds) = (Level(level), unit.seconds(Level(level)));
            [0, 1].map(|precision| Pick {
                grade: (level, precision),
                values: unit.bytes(level, PRECISIONS[precision]) as f64,
                seconds,
                error: f64::INFINITY,
                bytes: f64::INFINITY,
                measured: false,
            })
        };
        let menu = unit.levels().flat_map(at).collect();
        let mut new =
            Self { unit, measured: Default::default(), header, plain: cost.seconds, spent: 0.0, menu };
        new.predict();
        new
    }

    /// Errors and bytes of the menu, from what is expected and what was measured.
    fn predict(&mut self) {
        let mut menu = std::mem::take(&mut self.menu);
        for pick in &mut menu {
            (pick.error, pick.bytes, pick.measured) = self.prediction(pick);
        }
        self.menu = menu;
    }

    fn prediction(&self, &Pick { grade: (level, precision), values, .. }: &Pick) -> (f64, f64, bool) {
        let measured = &self.measured[precision];
        if let Some(&Measured { error, bytes, .. }) = measured.get(&level) {
            return (error, bytes, true);
        }
        let expected = |level: Level| self.unit.expected(level, PRECISIONS[precision]);
        // How much worse, and larger, than expected.
        let off = |(at, measured): (&Level, &Measured)| [measured.error / expected(*at), measured.growth];
        let below = measured.range(..level).next_back();
        let above = measured.range(level..).next();
        let [worse, growth] = match (below, above) {
            (None, None) => [1.0; 2],
            (Some(one), None) | (None, Some(one)) => off(one),
            (Some(a), Some(b)) => {
                let t = f64::from(level.0 - a.0.0) / f64::from(b.0.0 - a.0.0);
                let ([low, _], [high, growth]) = (off(a), off(b));
                [low.powf(1.0 - t) * high.powf(t), growth]
            }
        };
        (worse * expected(level), growth * values + self.header, false)
    }

    /// The smallest grade that errs by no more than `max_error`, of those that satisfy a condition.
    fn smallest(&self, max_error: f64, of: impl Fn(&Pick) -> bool) -> Option<Pick> {
        let meets = self.menu.iter().filter(|pick| pick.error <= max_error && of(pick));
        meets.min_by(|a, b| a.bytes.total_cmp(&b.bytes)).copied()
    }

    /// Whether a grade is known, or may be measured beside what was measured already.
    fn is_affordable(&self, pick: &Pick) -> bool {
        let limit = ALLOWANCE * self.plain.max(self.spent);
        pick.measured || self.spent == 0.0 || self.spent + pick.seconds <= limit
    }

    /// Bakes and measures a grade, and others of its level where that costs hardly more.
    fn measure(&mut self, (level, precision): Grade, job: &mut Job) -> Result<(), BakeError> {
        memory::check(self.unit.values(level), job.max_memory)?;
        job.steps += self.unit.steps();
        let all = if self.unit.shares_measuring() { vec![0, 1] } else { vec![precision] };
        let precisions: Vec<Precision> = all.iter().map(|&i| PRECISIONS[i]).collect();
        for (i, tables) in all.into_iter().zip(self.unit.bake(level, &precisions, job)?) {
            let error = tables.iter().map(worst_error).fold(0.0, f64::max);
            let values = tables.iter().map(Table::stored_bytes).sum::<usize>() as f64;
            let growth = values / self.unit.bytes(level, PRECISIONS[i]) as f64;
            self.measured[i].insert(level, Measured { tables, error, bytes: values + self.header, growth });
        }
        self.spent += self.unit.seconds(level);
        self.predict();
        Ok(())
    }

    fn finest(&self) -> Grade {
        (Level(*self.unit.levels().end()), PRECISIONS.len() - 1)
    }

    fn tables(&self, (level, precision): Grade) -> &[Table] {
        &self.measured[precision][&level].tables
    }

    /// The small grade with an error that was measured to be no larger than `max_error`.
    fn meeting(&mut self, max_error: f64, job: &mut Job) -> Result<Grade, BakeError> {
        loop {
            let best = self.smallest(max_error, |pick| pick.measured);
            let next = self.smallest(max_error, |pick| self.is_affordable(pick));
            let next = next.or_else(|| self.smallest(max_error, |_| true));
            let next = match (best, next) {
                (Some(best), Some(next)) if next.measured || next.bytes > WORTH * best.bytes => {
                    return Ok(best.grade);
                }
                (_, Some(next)) => next.grade,
                // The finest has the last word.
                _ => self.finest(),
            };
            if self.measured[next.1].contains_key(&next.0) {
                let measured = self.measured.iter().flat_map(BTreeMap::values);
                let reached = measured.map(|measured| measured.error).fold(f64::INFINITY, f64::min);
                return Err(BakeError::OutOfReach { max_error, name: self.unit.name(), reached });
            }
            self.measure(next, job)?;
        }
    }
}

/// The units of a plan, to be chosen for a budget.
pub(super) struct Search<'a> {
    candidates: Vec<Candidate<'a>>,
}

impl<'a> Search<'a> {
    pub(super) fn new(plan: &'a Plan) -> Result<Self, BakeError> {
        Ok(Self { candidates: Unit::apart(plan)?.into_iter().map(Candidate::new).collect() })
    }

    /// Small tables that err by no more than `max_error`.
    pub(super) fn meeting(mut self, max_error: f64, job: &mut Job) -> Result<Vec<Table>, BakeError> {
        let first = |candidate: &Candidate| {
            candidate.smallest(max_error, |_| true).map_or(candidate.finest(), |pick| pick.grade)
        };
        self.check_time(&self.candidates.iter().map(first).collect::<Vec<_>>(), job)?;
        let grades = self.candidates.iter_mut().map(|candidate| candidate.meeting(max_error, job));
        let grades = grades.collect::<Result<Vec<Grade>, _>>()?;
        Ok(self.tables(&grades))
    }

    /// Accurate tables whose file, with its provenance, has no more than `max_bytes`.
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
                _ => self.coarsest(|_, _| true).expect("every unit has levels"),
            };
            let grades: Vec<Grade> = picks.iter().map(|pick| pick.grade).collect();
            if std::mem::take(&mut is_first) {
                self.check_time(&grades, job)?;
            }
            if picks.iter().all(|pick| pick.measured) {
                let tables = self.tables(&grades);
                let bytes = encode(provenance, &tables)?.len();
                if bytes <= max_bytes {
                    return Ok(tables);
                }
                if self.fitting(room, |_, _| true).is_none() {
                    return Err(BakeError::TooSmall { max_bytes, smallest: bytes });
                }
                // What was estimated of names and certificates was too little.
                let taken: f64 = picks.iter().map(|pick| pick.bytes).sum();
                room = room.min(taken) - (bytes - max_bytes) as f64;
                continue;
            }
            for (candidate, pick) in self.candidates.iter_mut().zip(picks).filter(|(_, pick)| !pick.measured)
            {
                candidate.measure(pick.grade, job)?;
            }
        }
    }

    /// The grades with the least common error that fit into `room` bytes, if any do, of those that satisfy a
    /// condition. What units leave that have no better grade goes to the others.
    fn fitting(&self, room: f64, of: impl Fn(&Candidate, &Pick) -> bool) -> Option<Vec<Pick>> {
        let bytes = |picks: &[Pick]| picks.iter().map(|pick| pick.bytes).sum::<f64>();
        let mut picks = self.coarsest(&of).filter(|picks| bytes(picks) <= room)?;
        let mut free: Vec<usize> = (0..self.candidates.len()).collect();
        while !free.is_empty() {
            let fixed: f64 = (0..picks.len()).filter(|i| !free.contains(i)).map(|i| picks[i].bytes).sum();
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
                match fits(ANY_ERROR * RATIO.powi(-middle)) {
                    Some(picks) => (found, low) = (Some(picks), middle + 1),
                    None => high = middle,
                }
            }
            if let Some(found) = found {
                free.iter().zip(found).for_each(|(&i, pick)| picks[i] = pick);
            }
            // Those that hold the others back stay as they are.
            let worst = free.iter().map(|&i| picks[i].error).fold(0.0, f64::max);
            free.retain(|&i| picks[i].error < worst / RATIO);
        }
        Some(picks)
    }

    /// The smallest grades that satisfy a condition, if each unit has one.
    fn coarsest(&self, of: impl Fn(&Candidate, &Pick) -> bool) -> Option<Vec<Pick>> {
        let least = |candidate: &Candidate| candidate.smallest(f64::INFINITY, |pick| of(candidate, pick));
        self.candidates.iter().map(least).collect()
    }

    /// Whether a search that begins with these grades takes no longer than it may.
    fn check_time(&self, grades: &[Grade], job: &Job) -> Result<(), BakeError> {
        let seconds = |(candidate, grade): (&Candidate, &Grade)| candidate.unit.seconds(grade.0);
        let search = OFTEN * self.candidates.iter().zip(grades).map(seconds).sum::<f64>();
        let plain: f64 = self.candidates.iter().map(|candidate| candidate.plain).sum();
        if !job.patient && search > PATIENCE.max(3.0 * plain) {
            return Err(BakeError::TooSlow { search, plain });
        }
        Ok(())
    }

    fn tables(&self, grades: &[Grade]) -> Vec<Table> {
        let each = self.candidates.iter().zip(grades);
        each.flat_map(|(candidate, &grade)| candidate.tables(grade).to_vec()).collect()
    }
}
