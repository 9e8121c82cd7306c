//! What a sweep says of each function.

use super::Cell;

/// The times of one function over its cells.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Summary {
    /// The number of cells.
    pub(crate) cells: usize,
    /// The median time of a call, in nanoseconds, of the cells with random views and numbers.
    pub(crate) common: f64,
    /// The median of all cells.
    pub(crate) median: f64,
    /// What 99 of 100 cells do not exceed.
    pub(crate) most: f64,
    /// The slowest cell, which names the function, too.
    pub(crate) worst: Cell,
}

impl Summary {
    /// The slowest cell over the common case.
    pub(crate) fn cliff(&self) -> f64 {
        self.worst.ns / self.common
    }
}

/// One for each function, in the order of their first cells.
pub(crate) fn summaries(cells: &[Cell]) -> Vec<Summary> {
    let mut names: Vec<&str> = Vec::new();
    for cell in cells {
        if !names.contains(&cell.function.as_str()) {
            names.push(&cell.function);
        }
    }
    names
        .into_iter()
        .map(|name| summary(cells.iter().filter(|cell| cell.function == name)))
        .collect()
}

fn summary<'a>(cells: impl Iterator<Item = &'a Cell>) -> Summary {
    let mut cells: Vec<&Cell> = cells.collect();
    cells.sort_by(|a, b| a.ns.total_cmp(&b.ns));
    let common: Vec<&Cell> = cells.iter().copied().filter(|cell| cell.is_common()).collect();
    Summary {
        cells: cells.len(),
        common: quantile(&common, 50),
        median: quantile(&cells, 50),
        most: quantile(&cells, 99),
        worst: cells[cells.len() - 1].clone(),
    }
}

/// The least time that so many per cent of the cells, which are in order, do not exceed; NaN of
/// none.
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
        Cell {
            function: function.into(),
            gamma: ns,
            sigma: [1.0; 2],
            turns: [0.0; 3],
            views: "random",
            numbers: "-",
            ns,
        }
    }

    #[test]
    fn quantiles_are_over_the_cells_of_one_function() {
        let mut cells: Vec<Cell> = (1..=200).rev().map(|i| cell("b", f64::from(i))).collect();
        cells.insert(7, cell("a", 3.0));
        let [b, a] = summaries(&cells).try_into().unwrap();
        assert_eq!((b.cells, b.median, b.most, b.worst.ns), (200, 100.0, 198.0, 200.0));
        assert_eq!((b.worst.gamma, b.common, b.cliff()), (200.0, 100.0, 2.0));
        // Only cells with random views and numbers are the common case.
        for cell in cells.iter_mut().filter(|cell| cell.ns > 50.0) {
            let class = if cell.ns > 100.0 { &mut cell.views } else { &mut cell.numbers };
            *class = "other";
        }
        let b = &summaries(&cells)[0];
        assert_eq!((b.common, b.median, b.cliff()), (25.0, 100.0, 8.0));
        assert_eq!((a.worst.function.as_str(), a.cells, a.median, a.most), ("a", 1, 3.0, 3.0));
    }
}
