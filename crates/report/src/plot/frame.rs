//! Where the axes of a panel lie on the page.

use super::canvas::At;
use super::clip::Place;

/// Radius of a point.
pub(super) const DOT: f64 = 4.0;

/// The rectangle that the axes span, on the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Frame {
    pub(super) fn at(&self, [x, y]: Place) -> At {
        [self.left + self.width * x, self.top + self.height * (1.0 - y)]
    }
}
