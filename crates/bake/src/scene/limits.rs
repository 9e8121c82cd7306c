//! Limits of a recipe, with which reading takes no more than seconds and 1 GB of memory.

use std::cell::Cell;
use std::rc::Rc;

/// An amount, such as bytes, that may still be read or held for a scene; clones share it.
#[derive(Clone, Debug)]
pub struct Budget {
    limit: u64,
    left: Rc<Cell<u64>>,
}

impl Budget {
    /// A budget of which nothing has been taken.
    pub fn new(limit: u64) -> Self {
        Self { limit, left: Rc::new(Cell::new(limit)) }
    }

    /// The whole amount.
    pub fn limit(&self) -> u64 {
        self.limit
    }

    /// The amount that is left.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Takes `part` of it; if less is left, takes the rest and returns `false`.
    pub fn take(&self, part: u64) -> bool {
        let left = self.left.get().checked_sub(part);
        self.left.set(left.unwrap_or(0));
        left.is_some()
    }
}

/// Bytes of a recipe.
pub(super) const RECIPE: u64 = 64 << 20;
/// Bytes of a part of a recipe: from one `[[material]]` to the next, and all before the second. The
/// parser takes 80 times as much memory for a list of ones.
pub(super) const RECIPE_PART: u64 = 8 << 20;
/// Materials of a recipe.
pub(super) const RECIPE_MATERIALS: usize = 1_000_000;
/// Bytes of the measured distributions of a recipe, all together; each is integrated numerically.
pub(super) const MEASURED: u64 = 16 << 20;
/// Distributions outside the family in a recipe: each takes a millisecond or more to integrate.
pub(super) const DISTRIBUTIONS: u64 = 1000;
