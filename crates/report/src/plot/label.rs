//! Numbers next to points, where they cover little.

use super::drawing::{Anchor, At, Drawing};
use super::ink::{Color, Dash};
use super::panel::{DOT, Frame, NUMBERS as LETTERS};
use super::text;

/// The height that a line of letters takes.
const LINE: f64 = 12.0;
/// Gap between a point and its name, and between a name and others beside it.
const GAP: f64 = 3.0;
/// Horizontal distances of a name from the position next to its point, and how many half lines it
/// may be above or below.
const ASIDE: [f64; 6] = [0.0, 12.0, 28.0, 50.0, 80.0, 120.0];
const HALF_LINES: i32 = 28;
/// Costs, in pixels of distance: of a name over a name, a point or the frame; of a line through a
/// name, or of a leading line through a point; of two leading lines that cross; and of a leading
/// line that crosses a curve.
const HIDES: f64 = 10_000.0;
const STRIKES: f64 = 3000.0;
const CROSSES: f64 = 1000.0;
const MEETS: f64 = 20.0;
/// How often every name is placed anew among the others, at most.
const PASSES: usize = 12;

/// The ends of a line.
type Segment = [At; 2];

/// A rectangle: [left, right], [top, bottom].
#[derive(Clone, Copy, Debug)]
struct Area {
    x: [f64; 2],
    y: [f64; 2],
}

impl Area {
    fn about([x, y]: At, [width, height]: At) -> Self {
        Self { x: [x - width, x + width], y: [y - height, y + height] }
    }

    fn meets(&self, other: &Self) -> bool {
        overlap(self.x, other.x) && overlap(self.y, other.y)
    }

    fn is_in(&self, frame: &Frame) -> bool {
        let inside = |[from, to]: [f64; 2], start, length| start <= from && to <= start + length;
        inside(self.x, frame.left, frame.width) && inside(self.y, frame.top, frame.height)
    }

    /// Whether a line goes through it: their extents overlap, and its corners lie on both sides.
    fn is_struck(&self, line: &Segment) -> bool {
        let [a, b] = line;
        let near = overlap(self.x, [a[0].min(b[0]), a[0].max(b[0])])
            && overlap(self.y, [a[1].min(b[1]), a[1].max(b[1])]);
        let corners = self.x.iter().flat_map(|x| self.y.map(|y| side(line, [*x, y])));
        near && corners.clone().any(|side| side > 0.0) && corners.clone().any(|side| side < 0.0)
    }
}

/// Of intervals; one may be a point.
fn overlap(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] < b[1] && b[0] < a[1]
}

/// Positive on one side of a line, negative on the other.
fn side([a, b]: &Segment, at: At) -> f64 {
    (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0])
}

fn cross(a: &Segment, b: &Segment) -> bool {
    let apart = |line, ends: &Segment| side(line, ends[0]) * side(line, ends[1]) < 0.0;
    apart(a, b) && apart(b, a)
}

/// A place for a name.
#[derive(Clone, Copy, Debug)]
struct Place {
    anchor: Anchor,
    /// Where the name is anchored, at the middle of its height.
    start: At,
    area: Area,
    /// A thin line to a name that is not next to its point.
    lead: Option<Segment>,
}

impl Place {
    /// What two names cost each other.
    fn cost_with(&self, other: &Self) -> f64 {
        let strikes = |lead: Option<Segment>, area: &Area| -> f64 {
            f64::from(lead.is_some_and(|lead| area.is_struck(&lead)))
        };
        let struck = strikes(self.lead, &other.area) + strikes(other.lead, &self.area);
        let crossed = self.lead.zip(other.lead).is_some_and(|(a, b)| cross(&a, &b));
        HIDES * f64::from(self.area.meets(&other.area))
            + STRIKES * struck
            + CROSSES * f64::from(crossed)
    }
}

/// Writes the names of points; thin lines lead to names that are not next to their points. `curves`
/// are the other lines of the drawing.
pub(super) fn write(
    drawing: &mut Drawing,
    frame: &Frame,
    curves: &[Vec<At>],
    points: &[(At, String, Color)],
) {
    let lines: Vec<Segment> =
        curves.iter().flat_map(|curve| curve.windows(2)).map(|ends| [ends[0], ends[1]]).collect();
    let dots: Vec<Area> = points.iter().map(|(at, ..)| Area::about(*at, [DOT; 2])).collect();
    // What a place costs whatever the other names do.
    let cost = |at: At, place: &Place| {
        let count = |is: &dyn Fn(&&Area) -> bool| dots.iter().filter(is).count();
        let hidden = count(&|dot| dot.meets(&place.area)) + usize::from(!place.area.is_in(frame));
        let mut struck = lines.iter().filter(|line| place.area.is_struck(line)).count();
        let mut met = 0;
        if let Some(lead) = &place.lead {
            // Points that cover its own are no obstacles.
            let own = Area::about(at, [DOT; 2]);
            struck += count(&|dot| !dot.meets(&own) && dot.is_struck(lead));
            met = lines.iter().filter(|line| cross(line, lead)).count();
        }
        let away = (place.start[0] - at[0]).hypot(place.start[1] - at[1]);
        away + HIDES * hidden as f64 + STRIKES * struck as f64 + MEETS * met as f64
    };
    let mut options: Vec<Vec<(f64, Place)>> = Vec::new();
    for (at, name, _) in points {
        let all = places(*at, text::width(name, LETTERS));
        options.push(all.map(|place| (cost(*at, &place), place)).collect());
    }
    // Each name in turn is the first to be placed; the arrangement of the least cost is drawn.
    let arrangements = (0..points.len()).map(|first| arranged(&options, first));
    let Some(best) = arrangements.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    for (((_, name, color), options), best) in points.iter().zip(&options).zip(best.1) {
        let (_, Place { anchor, start, lead, .. }) = options[best];
        if let Some(lead) = lead {
            drawing.line(lead.into(), *color, 0.6, Dash::Solid);
        }
        drawing.text([start[0], start[1] + 0.36 * LETTERS], name, LETTERS, anchor, *color);
    }
}

/// A place for each name by index, with what all of them cost: names are placed one after the other
/// from the `first` on, and then again among all others while that costs less.
fn arranged(options: &[Vec<(f64, Place)>], first: usize) -> (f64, Vec<usize>) {
    let mut chosen: Vec<Option<usize>> = vec![None; options.len()];
    // The costs of a name beside those that are placed.
    let costs = |i: usize, chosen: &[Option<usize>]| {
        let others = chosen.iter().zip(options).enumerate().filter(|(other, _)| *other != i);
        let others: Vec<Place> =
            others.filter_map(|(_, (at, options))| Some(options[(*at)?].1)).collect();
        let with = move |place: &Place| others.iter().map(|it| place.cost_with(it)).sum::<f64>();
        options[i].iter().map(move |(own, place)| (*own, with(place)))
    };
    for _ in 0..PASSES {
        let before = chosen.clone();
        for i in (0..options.len()).map(|i| (first + i) % options.len()) {
            let all = costs(i, &chosen).map(|(own, shared)| own + shared).enumerate();
            let least = all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(best, _)| best);
            chosen[i] = least;
        }
        if chosen == before {
            break;
        }
    }
    let chosen_of = |i: usize| chosen[i].expect("there are places for every name");
    // What two names cost each other is counted at both.
    let cost = |i: usize| costs(i, &chosen).nth(chosen_of(i)).map(|(own, pair)| own + 0.5 * pair);
    let total = (0..options.len()).filter_map(cost).sum();
    (total, (0..options.len()).map(chosen_of).collect())
}

/// Places for a name of this width: at either side of its point, and above and below it.
fn places([x, y]: At, width: f64) -> impl Iterator<Item = Place> {
    let area =
        move |middle: f64, y: f64| Area::about([middle, y], [0.5 * width + 0.8 * GAP, 0.5 * LINE]);
    let beside = move |half_lines: i32, aside: f64, right: bool| {
        let towards = if right { 1.0 } else { -1.0 };
        let start = [x + towards * (DOT + GAP + aside), y + f64::from(half_lines) * 0.5 * LINE];
        let area = area(start[0] + towards * 0.5 * width, start[1]);
        let end = [start[0] - towards, start[1]];
        let [dx, dy] = [end[0] - x, end[1] - y];
        let part = DOT / dx.hypot(dy);
        let is_beside = half_lines.abs() <= 1 && aside == 0.0;
        let lead = (!is_beside).then_some([[x + part * dx, y + part * dy], end]);
        Place { anchor: if right { Anchor::Start } else { Anchor::End }, start, area, lead }
    };
    let sides =
        move |i| ASIDE.into_iter().flat_map(move |by| [true, false].map(|r| beside(i, by, r)));
    let over = [-1.0, 1.0].map(|towards| {
        let start = [x, y + towards * (DOT + 0.5 * LINE)];
        Place { anchor: Anchor::Middle, start, area: area(x, start[1]), lead: None }
    });
    (-HALF_LINES..=HALF_LINES).flat_map(sides).chain(over)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_strike_what_they_go_through() {
        let area = Area { x: [10.0, 20.0], y: [0.0, 4.0] };
        for (line, is_struck) in [
            ([[0.0, 2.0], [30.0, 2.0]], true),
            ([[15.0, -9.0], [15.0, 9.0]], true),
            ([[12.0, 1.0], [13.0, 2.0]], true),
            ([[0.0, 0.0], [30.0, 30.0]], false),
            ([[15.0, -9.0], [15.0, -1.0]], false),
            ([[0.0, 2.0], [9.0, 2.0]], false),
        ] {
            assert_eq!(area.is_struck(&line), is_struck, "{line:?}");
        }
        let line = [[0.0, 0.0], [9.0, 9.0]];
        assert!(cross(&line, &[[0.0, 9.0], [9.0, 0.0]]));
        assert!(!cross(&line, &[[6.0, 0.0], [6.0, 5.0]]));
    }
}
