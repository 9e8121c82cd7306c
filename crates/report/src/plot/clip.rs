//! The runs of a curve that a panel shows, and where the curve leaves the panel.

/// A point of a panel: (0, 0) is its left lower corner, (1, 1) the right upper one.
pub(super) type Place = [f64; 2];

/// Rounding of coordinates at the edge.
const EDGE: f64 = 1e-9;
/// Exits that are nearer to each other than this have one mark.
const APART: f64 = 0.02;

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Clipped {
    /// Connected parts inside.
    pub(super) runs: Vec<Vec<Place>>,
    /// Where the curve crosses the upper edge (y = 1) or the lower (y = 0).
    pub(super) exits: Vec<Place>,
}

/// Cuts a curve to the panel. Runs are not joined across points outside or NaN; NaN has no mark.
pub(super) fn clip(points: impl Iterator<Item = Place>) -> Clipped {
    let mut clipped = Clipped::default();
    let mut run = Vec::new();
    let mut last: Option<Place> = None;
    for point in points {
        if point.iter().any(|x| x.is_nan()) || side(point[0]) != 0 {
            clipped.end(&mut run);
            last = None;
            continue;
        }
        match (last.map(|last| side(last[1])), side(point[1])) {
            (None | Some(0), 0) => run.push(point),
            (Some(_), 0) => {
                let edge = crossing(point, last.unwrap_or(point));
                clipped.leave(edge);
                run.extend([edge, point]);
            }
            (Some(0), _) => {
                let edge = crossing(last.unwrap_or(point), point);
                run.push(edge);
                clipped.end(&mut run);
                clipped.leave(edge);
            }
            (_, _) => {}
        }
        last = Some(point);
    }
    clipped.end(&mut run);
    clipped
}

impl Clipped {
    fn end(&mut self, run: &mut Vec<Place>) {
        if !run.is_empty() {
            self.runs.push(std::mem::take(run));
        }
    }

    fn leave(&mut self, at: Place) {
        let near = |other: &Place| other[1] == at[1] && (other[0] - at[0]).abs() < APART;
        if !self.exits.iter().any(near) {
            self.exits.push(at);
        }
    }
}

/// −1 below the panel, 0 inside, 1 above.
fn side(x: f64) -> i32 {
    i32::from(x > 1.0 + EDGE) - i32::from(x < -EDGE)
}

/// Where the line from a point inside to one outside, perhaps at infinity, meets the edge.
fn crossing(inside: Place, outside: Place) -> Place {
    let edge = if side(outside[1]) > 0 { 1.0 } else { 0.0 };
    let part = ((edge - inside[1]) / (outside[1] - inside[1])).clamp(0.0, 1.0);
    [inside[0] + part * (outside[0] - inside[0]), edge]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_marked_where_it_leaves_and_not_joined_across() {
        let points = [[0.0, 0.5], [0.2, 1.5], [0.4, 1.5], [0.6, 0.5], [0.8, -0.5]];
        let clipped = clip(points.into_iter());
        let close = |a: &[Place], b: &[Place]| {
            assert_eq!(a.len(), b.len(), "{a:?}");
            for (a, b) in a.iter().zip(b) {
                assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-12, "{a:?} {b:?}");
            }
        };
        assert_eq!(clipped.runs.len(), 2);
        close(&clipped.runs[0], &[[0.0, 0.5], [0.1, 1.0]]);
        close(&clipped.runs[1], &[[0.5, 1.0], [0.6, 0.5], [0.7, 0.0]]);
        close(&clipped.exits, &[[0.1, 1.0], [0.5, 1.0], [0.7, 0.0]]);
    }

    #[test]
    fn a_pole_and_a_gap_are_no_line() {
        let pole = clip([[0.1, -2.0], [0.2, 3.0]].into_iter());
        assert_eq!(pole, Clipped::default());
        let gap = clip([[0.1, 0.5], [0.2, f64::NAN], [0.3, 0.5]].into_iter());
        assert_eq!((gap.runs.len(), gap.exits.len()), (2, 0));
        let zero = clip([[0.1, 0.5], [0.2, f64::NEG_INFINITY]].into_iter());
        assert_eq!(zero.exits, [[0.1, 0.0]]);
        let beyond = clip([[0.9, 0.5], [1.1, 0.5]].into_iter());
        assert_eq!((beyond.runs, beyond.exits), (vec![vec![[0.9, 0.5]]], vec![]));
    }

    #[test]
    fn the_edge_itself_is_inside() {
        let along = [[0.0, 1.0], [1.0, 1.0]];
        assert_eq!(clip(along.into_iter()), Clipped { runs: vec![along.into()], exits: vec![] });
    }

    #[test]
    fn many_crossings_at_one_place_are_one_mark() {
        let noise =
            (0..40).map(|i| [0.5 + 1e-4 * f64::from(i), if i % 2 == 0 { 0.9 } else { 1.1 }]);
        assert_eq!(clip(noise).exits.len(), 1);
    }
}
