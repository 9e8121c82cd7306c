//! Climbs from the largest errors among listed points to the maxima between them, which no list
//! meets.

use super::points::{
    Point, are_apart, beside, cells_of_view, has_azimuths, has_crease, other_views,
};
use crate::bake::albedo::{AlbedoError, AlbedoSpec};

/// The errors of all quantities at one point.
pub(super) type At = (Point, Vec<f64>);

/// Steps of a climb, in cells.
const STEPS: [f64; 6] = [0.3, 0.3, 0.15, 0.15, 0.07, 0.03];
/// Hills climbed for each quantity with each step.
const HILLS: [usize; STEPS.len()] = [4; STEPS.len()];
/// [`HILLS`] over azimuths, where the middles of all cells are listed. With four hills in the first
/// step, an F82 error of 8.28e-5 at σ = (0.1, 1), γ = 2 was missed by 3 %; twice as many in the
/// last steps found 0.2 % more, for one lobe of `brushed-metals.toml`.
const HILLS_OF_AZIMUTHS: [usize; STEPS.len()] = [8, 5, 2, 1, 1, 1];

/// [`HILLS`] outside the promised domain.
const HILLS_OUTSIDE: [usize; STEPS.len()] = [1; STEPS.len()];

fn hills(spec: &AlbedoSpec) -> [usize; STEPS.len()] {
    if has_azimuths(spec) { HILLS_OF_AZIMUTHS } else { HILLS }
}

/// Whether climbs begin with the middles of all cells of the view, at the materials of their
/// starts: of tables over shapes, roughnesses and indices, whose listed points are far apart.
/// Without, an error of 1.74e-3 from inside, in the glass of the default set, was missed by 8 %.
fn sweeps(spec: &AlbedoSpec) -> bool {
    spec.axes.len() > 3
}

/// The largest number of points that climbs measure for one directional table of so many
/// quantities.
pub(super) fn count(spec: &AlbedoSpec, quantities: usize) -> usize {
    let directions = 2 * spec.axes.len() * if has_crease(spec) { 2 } else { 1 };
    let places = hills(spec).into_iter().chain(HILLS_OUTSIDE).sum::<usize>();
    let swept = if sweeps(spec) { hills(spec)[0] + HILLS_OUTSIDE[0] } else { 0 };
    quantities * (places * directions + swept * cells_of_view(spec))
}

/// A quantity by its index, a point, and the error of the quantity at that point.
type Top = (usize, Point, f64);

/// The highest `count` tops of each quantity; the tops of a quantity are neighbours in the list.
fn highest(tops: &[Top], count: usize) -> Vec<Top> {
    let of_quantity = |group: &[Top]| {
        let mut group = group.to_vec();
        group.sort_by(|a, b| b.2.total_cmp(&a.2));
        group.truncate(count);
        group
    };
    tops.chunk_by(|a, b| a.0 == b.0).flat_map(of_quantity).collect()
}

/// Climbs from the points at which each quantity has its largest errors, inside the `promised`
/// domain or outside, since the largest error lies between the listed points. Returns the points on
/// the way with their errors.
pub(super) fn climbed(
    spec: &AlbedoSpec,
    errors: &[At],
    promised: bool,
    measured: impl Fn(Vec<Point>) -> Result<Vec<At>, AlbedoError>,
) -> Result<Vec<At>, AlbedoError> {
    let hills = if promised { hills(spec) } else { HILLS_OUTSIDE };
    let mut tops: Vec<Top> = Vec::new();
    let quantities = errors.first().map_or(0, |(_, errors)| errors.len());
    for i in 0..quantities {
        let mut worst: Vec<&At> =
            errors.iter().filter(|(point, _)| point.promised == promised).collect();
        worst.sort_by(|a, b| b.1[i].total_cmp(&a.1[i]));
        let start = tops.len();
        for (at, errors) in worst {
            let apart = tops[start..].iter().all(|(_, point, _)| are_apart(spec, point, at));
            if tops.len() < start + hills[0] && apart {
                tops.push((i, at.clone(), errors[i]));
            }
        }
    }
    let mut seen: Vec<At> = Vec::new();
    let sweep = sweeps(spec).then_some((None, hills[0]));
    let steps = STEPS.into_iter().map(Some).zip(hills);
    for (step, count) in sweep.into_iter().chain(steps) {
        tops = highest(&tops, count);
        let near = |point: &Point| match step {
            Some(step) => beside(spec, point, step),
            None => other_views(spec, point),
        };
        let around: Vec<Vec<Point>> = tops.iter().map(|(_, point, _)| near(point)).collect();
        let errors = measured(around.concat())?;
        let mut from = 0;
        let mut last = None;
        for ((i, point, error), own) in tops.iter_mut().zip(&around) {
            let own = from..from + own.len();
            from = own.end;
            // Each hill is climbed from its own points, but the highest of a quantity from the best
            // of all: between the listed points of this quantity, a hill of another quantity is
            // often higher.
            let is_highest = last.replace(*i) != Some(*i);
            let near = if is_highest { &errors[..] } else { &errors[own] };
            if let Some(top) = near.iter().max_by(|a, b| a.1[*i].total_cmp(&b.1[*i]))
                && top.1[*i] > *error
            {
                (*point, *error) = (top.0.clone(), top.1[*i]);
            }
        }
        seen.extend(errors);
    }
    Ok(seen)
}
