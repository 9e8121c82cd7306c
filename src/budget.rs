//! Resolution and precision by measuring: the smallest tables that meet an error.
//!
//! Candidates are measured as a certificate is, through the run-time sampler against the f64 model. Finer nodes are taken to be never
//! worse; that steers the search, while what it returns has been measured to meet the budget.

use std::collections::HashMap;
use std::fmt;

use microfacet_sampler::{Kind, Precision, Provenance, Table, Tables};

use crate::bake;
use crate::generate::{CERTIFICATE_POINTS, worst_error};
use crate::plan::Need;
use crate::spec::{Quality, Resolution, TableSpec, general_set, general_set_at};
use crate::validate::certificate::{certify, measure};

/// Numbers of nodes to choose from; the ends are what is worth storing at all.
const SHAPES: [usize; 9] = [5, 7, 9, 13, 17, 21, 25, 33, 49];
const SHADOWING_VIEWS: [usize; 12] = [9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385];
const VIEWS: [usize; 12] = [9, 13, 17, 25, 33, 49, 81, 113, 161, 225, 321, 449];
const NUMBERS: [usize; 11] = [5, 7, 9, 11, 13, 17, 21, 25, 29, 37, 49];
const ACROSS_NUMBERS: [usize; 12] = [5, 7, 9, 11, 13, 17, 21, 25, 33, 49, 65, 97];
/// So many steps up the lists an error is a hundredth or less.
const FINER: usize = 4;
/// A candidate that fails on so few points need not be measured on all.
const QUICK_POINTS: usize = 300;

/// Errors that were measured already, for searches that repeat with another budget.
#[derive(Default)]
pub struct Memo(HashMap<(String, Candidate), Measured>);

#[derive(Clone, Copy)]
enum Measured {
    /// On [`QUICK_POINTS`]: the error is this or more.
    AtLeast(f64),
    Exactly(f64),
}

/// Indices into the lists of numbers, and a precision.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Candidate {
    nodes: [usize; 3],
    precision: Precision,
}

/// No candidate meets the budget.
#[derive(Clone, Debug, PartialEq)]
pub struct OutOfReach {
    /// What was asked for.
    pub max_error: f64,
    /// Name of the table that does not get there.
    pub table: String,
    /// Its error where it is finest.
    pub reached: f64,
}

impl fmt::Display for OutOfReach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { max_error, table, reached } = self;
        write!(
            f,
            "no resolution meets an error of {max_error:e}: table `{table}` reaches {reached:.1e} where it is finest; allow that much"
        )
    }
}

impl std::error::Error for OutOfReach {}

/// The tables of a need, each the smallest that has no larger error (G1 absolute, or CDF) than `max_error`, with certificates.
///
/// # Errors
/// [`OutOfReach`] naming the table that cannot.
pub fn smallest(need: &Need, max_error: f64, memo: &mut Memo) -> Result<Vec<Table>, OutOfReach> {
    // A table is measured beside tables that are not the final ones yet. Where that mattered, a little less is allowed.
    let mut target = max_error;
    loop {
        let tables = chosen(need, target, memo)?;
        let mut set = Tables::from_tables(Provenance::default(), tables).expect("baked tables are sound");
        certify(&mut set, CERTIFICATE_POINTS, need.certified_s()).expect("a need's tables cover it");
        if set.tables().iter().all(|table| worst_error(table) <= max_error) {
            return Ok(set.tables().to_vec());
        }
        target *= 0.9;
    }
}

/// One table of the general set after the other: masking first, since the peeled slopes depend on it.
fn chosen(need: &Need, max_error: f64, memo: &mut Memo) -> Result<Vec<Table>, OutOfReach> {
    let parts: Vec<usize> = (0..general_set(Quality::Draft, Precision::F32).len()).collect();
    // What is not chosen yet is there in draft quality, so that materials can be bound.
    let mut tables: Vec<Option<Table>> = general_set(Quality::Draft, Precision::F32)
        .iter()
        .map(|spec| need.cut(spec).map(|spec| bake::bake(&spec)))
        .collect();
    for part in parts {
        if tables[part].is_some() {
            let others: Vec<Table> = tables
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != part)
                .filter_map(|(_, table)| table.clone())
                .collect();
            tables[part] = Some(Search { need, part, others, max_error, memo }.smallest()?);
        }
    }
    Ok(tables.into_iter().flatten().collect())
}

/// The search for one table.
struct Search<'a> {
    need: &'a Need,
    /// Index into the general set.
    part: usize,
    /// The other tables of the need.
    others: Vec<Table>,
    max_error: f64,
    memo: &'a mut Memo,
}

impl Search<'_> {
    fn smallest(&mut self) -> Result<Table, OutOfReach> {
        let lists = self.lists();
        let finest = lists.map(|list| list.len() - 1);
        let at = |nodes, precision| Candidate { nodes, precision };
        // Some candidate that meets the budget, all axes being refined alike.
        let step = |i: usize| finest.map(|last| i.min(last));
        let steps = finest.into_iter().max().unwrap_or(0);
        let Some(met) = (0..=steps).find(|&i| self.meets(at(step(i), Precision::F32))) else {
            let finest = at(finest, Precision::F32);
            let reached = self.error(finest, CERTIFICATE_POINTS);
            return Err(OutOfReach { max_error: self.max_error, table: self.spec(finest).name, reached });
        };
        // What each axis needs at least, the others being so fine that they contribute nothing.
        let fine = step(met + FINER);
        let mut least = [0; 3];
        for axis in 0..3 {
            let (mut low, mut high) = (0, fine[axis]);
            while low < high {
                let middle = (low + high) / 2;
                let mut nodes = fine;
                nodes[axis] = middle;
                if self.meets(at(nodes, Precision::F32)) { high = middle } else { low = middle + 1 }
            }
            least[axis] = low;
        }
        let mut candidates = Vec::new();
        for precision in [Precision::U16, Precision::F16, Precision::F32] {
            // A precision that is too coarse even with such fine nodes is out.
            if precision != Precision::F32 && !self.meets(at(fine, precision)) {
                continue;
            }
            for i in least[0]..=fine[0] {
                for j in least[1]..=fine[1] {
                    candidates.extend((least[2]..=fine[2]).map(|k| at([i, j, k], precision)));
                }
            }
        }
        candidates.sort_by_cached_key(|&candidate| self.spec(candidate).bytes());
        let found = candidates.into_iter().find(|&candidate| self.meets(candidate));
        Ok(bake::bake(&self.spec(found.unwrap_or(at(step(met), Precision::F32)))))
    }

    fn kind(&self) -> Kind {
        general_set(Quality::Draft, Precision::F32)[self.part].kind
    }

    /// Numbers of shapes, views and random numbers to choose from; a single one where the table has no such axis.
    fn lists(&self) -> [&'static [usize]; 3] {
        const NONE: &[usize] = &[5];
        let shapes = if self.need.gamma().is_point() { NONE } else { &SHAPES };
        match self.kind() {
            Kind::Shadowing => [shapes, &SHADOWING_VIEWS, NONE],
            Kind::VisibleSlopeConditional => [shapes, NONE, &ACROSS_NUMBERS],
            _ => [shapes, &VIEWS, &NUMBERS],
        }
    }

    fn spec(&self, candidate: Candidate) -> TableSpec {
        let lists = self.lists();
        let [shapes, views, numbers] = [0, 1, 2].map(|axis| lists[axis][candidate.nodes[axis]]);
        let resolution = Resolution {
            shapes,
            peeled_shapes: shapes,
            shadowing_shapes: shapes,
            across_shapes: shapes,
            shadowing_views: views,
            views,
            numbers,
            across_numbers: numbers,
        };
        let general = general_set_at(resolution, candidate.precision);
        self.need.cut(&general[self.part]).expect("the need has this part")
    }

    /// Whether the candidate's error is within the budget.
    fn meets(&mut self, candidate: Candidate) -> bool {
        let key = (self.spec(candidate).name, candidate);
        match self.memo.0.get(&key) {
            Some(Measured::Exactly(error)) => return *error <= self.max_error,
            Some(Measured::AtLeast(error)) if *error > self.max_error => return false,
            _ => {}
        }
        let quick = self.error(candidate, QUICK_POINTS);
        let measured = if quick > self.max_error {
            Measured::AtLeast(quick)
        } else {
            Measured::Exactly(self.error(candidate, CERTIFICATE_POINTS))
        };
        self.memo.0.insert(key, measured);
        matches!(measured, Measured::Exactly(error) if error <= self.max_error)
    }

    fn error(&self, candidate: Candidate, points: usize) -> f64 {
        let table = bake::bake(&self.spec(candidate));
        let tables = std::iter::once(table).chain(self.others.iter().cloned()).collect();
        let set = Tables::from_tables(Provenance::default(), tables).expect("baked tables are sound");
        let figures = measure(&set, &set.tables()[0], points, self.need.certified_s());
        let mut table = set.tables()[0].clone();
        table.certificate = figures.expect("a need's tables cover it");
        worst_error(&table)
    }
}
