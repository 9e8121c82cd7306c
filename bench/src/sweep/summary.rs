//! The summary of a sweep for each function.

use serde::Serialize;

use super::Cell;

/// The times of one function over its cells, in nanoseconds a call.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Summary {
    pub(crate) function: String,
    pub(crate) cells: usize,
    /// The median of the cells with random views and numbers.
    pub(crate) common_ns: f64,
    /// The median of all cells.
    pub(crate) median_ns: f64,
    /// What 99 of 100 cells do not exceed.
    pub(crate) percentile_99_ns: f64,
    pub(crate) worst_ns: f64,
    /// The slowest cell.
    pub(crate) worst: Cell,
}

impl Summary {
    fn new(mut cells: Vec<&Cell>) -> Self {
        cells.sort_by(|a, b| a.ns.total_cmp(&b.ns));
        let common: Vec<&Cell> = cells.iter().copied().filter(|cell| cell.is_common()).collect();
        let worst = cells[cells.len() - 1].clone();
        Self {
            function: worst.function.clone(),
            cells: cells.len(),
            common_ns: quantile(&common, 50),
            median_ns: quantile(&cells, 50),
            percentile_99_ns: quantile(&cells, 99),
            worst_ns: worst.ns,
            worst,
        }
    }

    /// The slowest cell over the common case.
    pub(crate) fn cliff(&self) -> f64 {
        self.worst_ns / self.common_ns
    }
}

/// One for each function, in the order of their first cells.
pub(crate) fn summaries(cells: &[Cell]) -> Vec<Summary> {
    let mut by_function: Vec<Vec<&Cell>> = Vec::new();
    for cell in cells {
        match by_function.iter_mut().find(|of| of[0].function == cell.function) {
            Some(of) => of.push(cell),
            None => by_function.push(vec![cell]),
        }
    }
    by_function.into_iter().map(Summary::new).collect()
}

/// The least time that `percent` per cent of the sorted cells do not exceed; NaN without cells.
fn quantile(cells: &[&Cell], percent: usize) -> f64 {
    match cells.len() {
        0 => f64::NAN,
        count => cells[(percent * count).div_ceil(100) - 1].ns,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(function: &str, ns: f64) -> Cell {
        Cell { views: "random", ns, ..Cell::of(function, ns, [1.0; 2], [0.0; 3]) }
    }

    #[test]
    fn quantiles_are_over_the_cells_of_one_function() {
        let mut cells: Vec<Cell> = (1..=200).rev().map(|i| cell("b", f64::from(i))).collect();
        cells.insert(7, cell("a", 3.0));
        let [b, a] = summaries(&cells).try_into().unwrap();
        assert_eq!(
            (b.cells, b.median_ns, b.percentile_99_ns, b.worst_ns),
            (200, 100.0, 198.0, 200.0)
        );
        assert_eq!((b.worst.gamma, b.common_ns, b.cliff()), (200.0, 100.0, 2.0));
        // Only cells with random views and numbers are the common case.
        for cell in cells.iter_mut().filter(|cell| cell.ns > 50.0) {
            let class = if cell.ns > 100.0 { &mut cell.views } else { &mut cell.numbers };
            *class = "other";
        }
        let b = &summaries(&cells)[0];
        assert_eq!((b.common_ns, b.median_ns, b.cliff()), (25.0, 100.0, 8.0));
        assert_eq!(
            (a.function.as_str(), a.cells, a.median_ns, a.percentile_99_ns),
            ("a", 1, 3.0, 3.0)
        );
    }
}
