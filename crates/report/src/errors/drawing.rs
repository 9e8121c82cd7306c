//! Maps of errors as drawings.

use microfacet_tables::Table;

use super::super::drawing::SIZE;
use super::{ticks, words};
use crate::error_map::{ErrorMap, Span};
use crate::plot::{Axis, Curve, Drawing, Figure, HeatMap, Key, Mark, Panel, Symbol};

/// The low end of the scale: about the rounding of single precision.
const LOW: f64 = 1e-7;
/// The high end of the scale is at least this.
const HIGH: f64 = 1e-4;
const LABEL: &str = "largest error";

/// The scale that all maps of a page share: up to the next power of ten after the largest error.
pub(super) fn scale(largest: impl Iterator<Item = f64>) -> Axis {
    let high = largest.filter(|x| x.is_finite()).fold(HIGH, f64::max);
    // log10 may round up, which must not add a decade. `f64::MAX` is below the next power of ten.
    let decade = libm::exp10((libm::log10(high) - 1e-9).ceil());
    Axis::log(LABEL, LOW, decade.min(f64::MAX))
}

/// The map; of a table with one axis, a curve.
pub(super) fn drawn(table: &Table, map: &ErrorMap, scale: &Axis) -> String {
    let axis = |span: &Span| Axis::marked(words::axis(span.quantity), ticks::of(span));
    let drawing = match &map.y {
        Some(y) => HeatMap {
            x: axis(&map.x),
            y: axis(y),
            columns: map.columns,
            values: map.errors.clone(),
            scale: scale.clone(),
            ring: map.worst,
            size: SIZE,
        }
        .drawing(),
        None => curve(map, axis(&map.x), scale.clone().coarse()),
    };
    drawing.inline_svg(&words::label(table, map))
}

fn curve(map: &ErrorMap, x: Axis, y: Axis) -> Drawing {
    let key = Key::TABLE;
    let last = (map.columns - 1).max(1) as f64;
    // Errors below the low end of the scale are rounding.
    let error = |x: f64| if x < LOW { LOW } else { x };
    let points = map.errors.iter().enumerate().map(|(i, &x)| (i as f64 / last, error(x)));
    let curve = Curve::new(key, "", points);
    let ring = |[x, _]: [f64; 2]| {
        let near = curve.points[(x * last).round() as usize].1;
        let at = (x, near);
        Mark { key, name: String::new(), group: String::new(), at, symbol: Symbol::Ring }
    };
    let marks = map.worst.map(ring).into_iter().filter(|mark| !mark.at.1.is_nan()).collect();
    let panel = Panel { marks, ..Panel::new("", x, y, [curve]) };
    Figure { panels: vec![panel], columns: 1, panel: SIZE }.drawing()
}

#[test]
fn the_scale_reaches_any_error() {
    for (largest, decade) in [(2e-5, HIGH), (2e-3, 1e-2), (1e-2, 1e-2), (1.5e308, f64::MAX)] {
        assert_eq!(scale([1e-9, f64::NAN, largest].into_iter()), Axis::log(LABEL, LOW, decade));
    }
}
