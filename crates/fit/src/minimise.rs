//! The least value of a function of one to three coordinates, each in [0, 1]: a scan finds the
//! basin, a local search its bottom.

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::brent::BrentOpt;
use argmin::solver::neldermead::NelderMead;
use argmin_math::{ArgminAdd, ArgminMul, ArgminSub};

/// The points of a scan in so many equal steps along each coordinate, both ends included; the last
/// coordinate varies fastest.
pub(crate) fn grid(steps: &[usize]) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::new()];
    for &n in steps {
        let along =
            |point: Vec<f64>| (0..=n).map(move |i| [&point[..], &[i as f64 / n as f64]].concat());
        points = points.into_iter().flat_map(along).collect();
    }
    points
}

/// When a local search ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// In one coordinate: relative width of the bracket, with a tenth of it as absolute width.
    pub(crate) width: f64,
    /// In more: standard deviation of the cost at the corners of the simplex.
    pub(crate) spread: f64,
}

/// Searches for a minimum near `start`, within `h` in one coordinate, from a simplex of sides 0.4 h
/// in more, and returns where it is. A cost of NaN counts as `f64::MAX`.
pub(crate) fn descend(
    start: &[f64],
    h: f64,
    stop: Stop,
    cost: impl Fn(&[f64]) -> f64,
) -> Result<Vec<f64>, String> {
    let cost = |point: &[f64]| {
        let cost = cost(point);
        if cost.is_finite() { cost } else { f64::MAX }
    };
    let failed = |e: Error| e.to_string();
    if start.len() == 1 {
        let solver = BrentOpt::new((start[0] - h).max(0.0), (start[0] + h).min(1.0))
            .set_tolerance(stop.width, 0.1 * stop.width);
        let run = Executor::new(Line(cost), solver)
            .configure(|s| s.max_iters(200))
            .run()
            .map_err(failed)?;
        return Ok(vec![*run.state().get_best_param().unwrap_or(&start[0])]);
    }
    // Off the edges of the square, where the simplex would be flat.
    let first: Vec<f64> = start.iter().map(|c| c.clamp(0.5 * h, 1.0 - 0.5 * h)).collect();
    let corner = |i: usize| {
        let mut corner = first.clone();
        corner[i] += 0.4 * h;
        Point(corner)
    };
    let simplex = [Point(first.clone())].into_iter().chain((0..first.len()).map(corner)).collect();
    let solver = NelderMead::new(simplex).with_sd_tolerance(stop.spread).map_err(failed)?;
    let run = Executor::new(Square(cost), solver)
        .configure(|s| s.max_iters(2000))
        .run()
        .map_err(failed)?;
    let best = run.state().get_best_param().map_or(&first, |best| &best.0);
    Ok(inside(best))
}

fn inside(point: &[f64]) -> Vec<f64> {
    point.iter().map(|y| y.clamp(0.0, 1.0)).collect()
}

/// A corner of a simplex. The crate's own arithmetic of lists comes with random ones of them, for
/// which it needs a second generation of `rand`.
#[derive(Clone, Debug)]
struct Point(Vec<f64>);

impl ArgminAdd<Point, Point> for Point {
    fn add(&self, other: &Point) -> Point {
        Point(self.0.iter().zip(&other.0).map(|(a, b)| a + b).collect())
    }
}

impl ArgminSub<Point, Point> for Point {
    fn sub(&self, other: &Point) -> Point {
        Point(self.0.iter().zip(&other.0).map(|(a, b)| a - b).collect())
    }
}

impl ArgminMul<f64, Point> for Point {
    fn mul(&self, factor: &f64) -> Point {
        Point(self.0.iter().map(|x| x * factor).collect())
    }
}

struct Line<F>(F);

impl<F: Fn(&[f64]) -> f64> CostFunction for Line<F> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, x: &f64) -> Result<f64, Error> {
        Ok((self.0)(&[*x]))
    }
}

struct Square<F>(F);

impl<F: Fn(&[f64]) -> f64> CostFunction for Square<F> {
    type Param = Point;
    type Output = f64;

    fn cost(&self, Point(point): &Point) -> Result<f64, Error> {
        let inside = inside(point);
        let cost = (self.0)(&inside);
        // A point outside the square has the value at its edge plus a slope that leads the simplex
        // back.
        let outside: f64 = point.iter().zip(&inside).map(|(y, edge)| (y - edge).abs()).sum();
        Ok(if cost < f64::MAX { cost * (1.0 + outside) + 1e-12 * outside } else { cost })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOP: Stop = Stop { width: 1e-9, spread: 1e-14 };

    #[test]
    fn a_scan_holds_both_ends() {
        assert_eq!(grid(&[2]), [[0.0], [0.5], [1.0]]);
        let square = grid(&[1, 2]);
        assert_eq!(square[..3], [[0.0, 0.0], [0.0, 0.5], [0.0, 1.0]]);
        assert_eq!((square.len(), &square[5]), (6, &vec![1.0, 1.0]));
        let cube = grid(&[1, 2, 3]);
        assert_eq!((cube.len(), &cube[5]), (24, &vec![0.0, 0.5, 1.0 / 3.0]));
    }

    #[test]
    fn minima_are_found_inside_and_at_the_edges() {
        for at in [0.0, 0.3, 1.0] {
            let found = descend(&[0.5], 0.6, STOP, |x| (x[0] - at).abs()).unwrap();
            assert!((found[0] - at).abs() < 1e-7, "{at}: {found:?}");
            let bowl = |p: &[f64]| (p[0] - at).powi(2) + (p[1] - 0.7).powi(2);
            let found = descend(&[at, 0.4], 0.1, STOP, bowl).unwrap();
            assert!((found[0] - at).abs() < 1e-6 && (found[1] - 0.7).abs() < 1e-6, "{found:?}");
            let bowl = |p: &[f64]| bowl(p) + (p[2] - 0.2).powi(2);
            let found = descend(&[at, 0.4, 0.5], 0.1, STOP, bowl).unwrap();
            let near = [at, 0.7, 0.2].iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(near, "{at}: {found:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_avoided() {
        let found = descend(&[0.5, 0.5], 0.2, STOP, |p| {
            if p[0] > 0.6 { f64::NAN } else { (p[0] - 0.55).abs() + (p[1] - 0.5).abs() }
        });
        let found = found.unwrap();
        assert!((found[0] - 0.55).abs() < 1e-6 && (found[1] - 0.5).abs() < 1e-6, "{found:?}");
    }
}
