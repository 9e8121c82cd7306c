//! How large a recipe may be, so that the worst ends within seconds and 1 GB of memory.

use std::cell::Cell;
use std::rc::Rc;

/// What may still be read or held for a scene, shared by its readers.
#[derive(Clone, Debug)]
pub struct Budget {
    limit: u64,
    left: Rc<Cell<u64>>,
}

impl Budget {
    /// A whole budget.
    pub fn new(limit: u64) -> Self {
        Self { limit, left: Rc::new(Cell::new(limit)) }
    }

    /// The whole.
    pub fn limit(&self) -> u64 {
        self.limit
    }

    /// What is left.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Takes a part of it; `false` if less is left.
    pub fn take(&self, part: u64) -> bool {
        let left = self.left.get().checked_sub(part);
        self.left.set(left.unwrap_or(0));
        left.is_some()
    }
}

/// Bytes of a recipe, which is parsed in parts.
pub(super) const RECIPE: u64 = 64 << 20;
/// Bytes of a part of a recipe: from one `[[material]]` to the next, and all before the second. The
/// parser takes 80 times as much memory for a list of ones.
pub(super) const RECIPE_PART: u64 = 8 << 20;
/// Materials of a recipe, which is read for them alone.
pub(super) const RECIPE_MATERIALS: usize = 1_000_000;
/// Bytes of the measured distributions of a recipe, all together; each is integrated numerically.
pub(super) const MEASURED: u64 = 16 << 20;
/// Distributions outside the family in a recipe: each takes a millisecond or more to integrate.
pub(super) const DISTRIBUTIONS: u64 = 1000;
