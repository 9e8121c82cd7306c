//! Names next to points, where they cover little.

use super::drawing::{Anchor, At, Drawing};
use super::ink::{Color, Dash};
use super::panel::{DOT, Frame};
use super::text;

/// Size of the letters and of the space that a line of them takes.
const LETTERS: f64 = 10.5;
const LINE: f64 = 12.0;
/// Gap between a point and its name.
const GAP: f64 = 3.0;
/// Horizontal distances of a name from the position next to its point.
const ASIDE: [f64; 4] = [0.0, 16.0, 40.0, 80.0];
/// Half the side of the squares that represent a line, and how far apart they are.
const PEN: f64 = 1.5;
const STRIDE: f64 = 3.0;
/// Costs, in pixels of distance: of covering a name or a point, of covering a square of a line, and
/// of a square of a leading line over a name.
const HIDES: f64 = 4000.0;
const CROSSES: f64 = 8.0;
const STRIKES: f64 = 60.0;

/// A rectangle: [left, right], [top, bottom].
#[derive(Clone, Copy, Debug)]
struct Area {
    x: [f64; 2],
    y: [f64; 2],
}

impl Area {
    fn about([x, y]: At, half: f64) -> Self {
        Self { x: [x - half, x + half], y: [y - half, y + half] }
    }

    fn meets(&self, other: &Self) -> bool {
        let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
        overlap(self.x, other.x) && overlap(self.y, other.y)
    }

    fn is_in(&self, frame: &Frame) -> bool {
        let inside = |[from, to]: [f64; 2], start, length| start <= from && to <= start + length;
        inside(self.x, frame.left, frame.width) && inside(self.y, frame.top, frame.height)
    }
}

struct Candidate {
    right: bool,
    /// The end of the name that is nearer to its point, at the middle of its height.
    start: At,
    area: Area,
    is_beside: bool,
}

/// Writes the names of points one after the other, each where its cost is least; thin lines lead to
/// names that are not next to their points. `curves` are the other lines of the drawing.
pub(super) fn write(
    drawing: &mut Drawing,
    frame: &Frame,
    curves: &[Vec<At>],
    points: &[(At, &str, Color)],
) {
    // Names must not cover `words`, and should not cover `lines` and `leads`.
    let mut words: Vec<Area> = points.iter().map(|&(at, ..)| Area::about(at, DOT)).collect();
    let segments = curves.iter().flat_map(|curve| curve.windows(2));
    let lines: Vec<Area> = segments.flat_map(|ends| squares(ends[0], ends[1])).collect();
    let mut leads: Vec<Area> = Vec::new();
    for &([x, y], name, color) in points.iter().filter(|(_, name, _)| !name.is_empty()) {
        let count =
            |areas: &[Area], at: &Area| areas.iter().filter(|other| other.meets(at)).count();
        let cost = |at: &Candidate| {
            let hidden = count(&words, &at.area) + usize::from(!at.area.is_in(frame));
            let struck: usize = lead([x, y], at).map(|part| count(&words, &part)).sum();
            (at.start[0] - x).hypot(at.start[1] - y)
                + HIDES * hidden as f64
                + CROSSES * count(&lines, &at.area) as f64
                + STRIKES * (struck + count(&leads, &at.area)) as f64
        };
        let all = candidates([x, y], text::width(name, LETTERS)).map(|at| (cost(&at), at));
        let (_, best) = all.min_by(|a, b| a.0.total_cmp(&b.0)).expect("some places");
        let (anchor, near) = if best.right { (Anchor::Start, -1.0) } else { (Anchor::End, 1.0) };
        if !best.is_beside {
            let end = [best.start[0] + near, best.start[1]];
            drawing.line(vec![[x, y], end], color, 0.6, Dash::Solid);
            leads.extend(lead([x, y], &best));
        }
        words.push(best.area);
        let baseline = [best.start[0], best.start[1] + 0.36 * LETTERS];
        drawing.text(baseline, name, LETTERS, anchor, color);
    }
}

/// Positions for a name of this width.
fn candidates([x, y]: At, width: f64) -> impl Iterator<Item = Candidate> {
    let at = move |half_lines: i32, aside: f64, right: bool| {
        let [gap, down] = [DOT + GAP + aside, f64::from(half_lines) * 0.5 * LINE];
        let start = if right { [x + gap, y + down] } else { [x - gap, y + down] };
        let reach = if right { [start[0], start[0] + width] } else { [start[0] - width, start[0]] };
        let area = Area { x: reach, y: [start[1] - 0.5 * LINE, start[1] + 0.5 * LINE] };
        Candidate { right, start, area, is_beside: half_lines.abs() <= 1 && aside == 0.0 }
    };
    let sides = move |i| ASIDE.into_iter().flat_map(move |by| [true, false].map(|r| at(i, by, r)));
    (-24..=24).flat_map(sides)
}

/// The squares of a leading line without those on its own point; none for a name next to it.
fn lead(point: At, to: &Candidate) -> impl Iterator<Item = Area> {
    let parts = (!to.is_beside).then(|| squares(point, to.start).skip(3));
    parts.into_iter().flatten()
}

fn squares(from: At, to: At) -> impl Iterator<Item = Area> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let steps = (dx.hypot(dy) / STRIDE).ceil().max(1.0);
    (0..=steps as u32).map(move |i| {
        let part = f64::from(i) / steps;
        Area::about([from[0] + part * dx, from[1] + part * dy], PEN)
    })
}
