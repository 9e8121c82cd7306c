//! Names beside points, where they hide nothing.

use super::canvas::{Anchor, At, Canvas};
use super::frame::{DOT, Frame};
use super::ink::{Color, Dash};
use super::text;

/// Size of the letters and of the space that a line of them takes.
const LETTERS: f64 = 10.5;
const LINE: f64 = 12.0;
/// Gap between a point and its name.
const GAP: f64 = 3.0;

/// A rectangle of the page in which nothing else should be drawn: [left, right], [top, bottom].
#[derive(Clone, Copy, Debug)]
struct Taken {
    x: [f64; 2],
    y: [f64; 2],
}

impl Taken {
    fn meets(&self, other: &Self) -> bool {
        let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
        overlap(self.x, other.x) && overlap(self.y, other.y)
    }
}

/// How far a name may stand to the side of its place beside the point.
const ASIDE: [f64; 4] = [0.0, 16.0, 40.0, 80.0];
/// Half the side of the squares that stand for a line, and how far apart they are.
const PEN: f64 = 1.5;
const STRIDE: f64 = 3.0;

/// What it costs, in pixels of distance from the point, to hide a name or a point, a part of a
/// line, or to lead a part of a line over a name.
const HIDES: f64 = 4000.0;
const CROSSES: f64 = 8.0;
const STRIKES: f64 = 60.0;
/// How often each name is placed anew, among all others.
const SWEEPS: usize = 4;

/// What a panel holds, so that names are written where there is room.
struct Ground<'a> {
    frame: &'a Frame,
    dots: Vec<Taken>,
    curves: Vec<Taken>,
}

/// A place for a name.
struct Candidate {
    right: bool,
    /// Where the name starts, or ends if it is to the left; at the middle of its height.
    start: At,
    place: Taken,
    /// The line from the point, if the name is not beside it.
    lead: Vec<Taken>,
}

/// Writes the names of points beside them, as near as they hide little; thin lines lead to those
/// that are farther away. `curves` are what else is drawn.
pub(super) fn write(
    canvas: &mut Canvas,
    frame: &Frame,
    curves: &[Vec<At>],
    points: &[(At, &str, Color)],
) {
    let segments = curves.iter().flat_map(|curve| curve.windows(2));
    let ground = Ground {
        frame,
        dots: points.iter().map(|&(at, ..)| square(at, DOT)).collect(),
        curves: segments.flat_map(|ends| line(ends[0], ends[1])).collect(),
    };
    let mut placed: Vec<Option<Candidate>> = points.iter().map(|_| None).collect();
    for _ in 0..SWEEPS {
        for (i, &(at, name, _)) in points.iter().enumerate() {
            placed[i] = None;
            let others: Vec<&Candidate> = placed.iter().flatten().collect();
            let cost = |candidate: &Candidate| ground.cost(at, candidate, &others);
            let mut best = (f64::INFINITY, None);
            for candidate in candidates(at, text::width(name, LETTERS)) {
                let cost = cost(&candidate);
                if cost < best.0 {
                    best = (cost, Some(candidate));
                }
            }
            placed[i] = best.1;
        }
    }
    for (&(from, name, color), place) in points.iter().zip(placed) {
        let Some(Candidate { right, start: [x, y], lead, .. }) = place else { continue };
        if !lead.is_empty() {
            let near = if right { x - 1.0 } else { x + 1.0 };
            canvas.line(vec![from, [near, y]], color, 0.6, Dash::Solid);
        }
        let anchor = if right { Anchor::Start } else { Anchor::End };
        canvas.text([x, y + 0.36 * LETTERS], name, LETTERS, anchor, color);
    }
}

impl Ground<'_> {
    fn cost(&self, [x, y]: At, candidate: &Candidate, others: &[&Candidate]) -> f64 {
        let Candidate { start, place, lead, .. } = candidate;
        let names = || others.iter().map(|other| &other.place);
        let leads = others.iter().flat_map(|other| &other.lead);
        let hidden = names().chain(&self.dots).filter(|other| other.meets(place)).count();
        let crossed = self.curves.iter().chain(leads).filter(|o| o.meets(place)).count();
        let struck = lead.iter().flat_map(|part| names().filter(|other| other.meets(part))).count();
        let outside = if self.holds(place) { 0.0 } else { HIDES };
        (start[0] - x).hypot(start[1] - y)
            + outside
            + HIDES * hidden as f64
            + CROSSES * crossed as f64
            + STRIKES * struck as f64
    }

    fn holds(&self, place: &Taken) -> bool {
        let Frame { left, top, width, height } = *self.frame;
        place.x[0] >= left
            && place.x[1] <= left + width
            && place.y[0] >= top
            && place.y[1] <= top + height
    }
}

/// Places for a name of this width.
fn candidates([x, y]: At, width: f64) -> impl Iterator<Item = Candidate> {
    let at = move |right: bool, aside: f64, half_lines: i32| {
        let [gap, down] = [DOT + GAP + aside, f64::from(half_lines) * 0.5 * LINE];
        let start = if right { [x + gap, y + down] } else { [x - gap, y + down] };
        let reach = if right { [start[0], start[0] + width] } else { [start[0] - width, start[0]] };
        let place = Taken { x: reach, y: [start[1] - 0.5 * LINE, start[1] + 0.5 * LINE] };
        let beside = half_lines.abs() <= 1 && aside == 0.0;
        let lead = if beside { Vec::new() } else { line([x, y], start).collect() };
        Candidate { right, start, place, lead }
    };
    let sides = move |i: i32| {
        ASIDE.into_iter().flat_map(move |aside| [true, false].map(|r| at(r, aside, i)))
    };
    (-24..=24).flat_map(sides)
}

fn square([x, y]: At, half: f64) -> Taken {
    Taken { x: [x - half, x + half], y: [y - half, y + half] }
}

/// Squares along a line.
fn line(from: At, to: At) -> impl Iterator<Item = Taken> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let steps = (dx.hypot(dy) / STRIDE).ceil().max(1.0);
    (0..=steps as u32).map(move |i| {
        let part = f64::from(i) / steps;
        square([from[0] + part * dx, from[1] + part * dy], PEN)
    })
}
