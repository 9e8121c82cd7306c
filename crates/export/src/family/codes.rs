//! Numbers as whole multiples of a step.

/// Codes of numbers: `start + step * code`, each to half a step.
pub(super) struct Codes {
    pub(super) start: f32,
    pub(super) step: f32,
}

/// Codes of numbers of which small ones keep their digits: `start + square * code²`.
pub(super) struct Squares {
    pub(super) start: f32,
    pub(super) square: f32,
}

impl Squares {
    /// Of numbers from the least on, which need not be 0.
    pub(super) fn of(numbers: impl Iterator<Item = f32>) -> Self {
        let Codes { start, step } = Codes::of(numbers, 0.0);
        Self { start, square: step / f32::from(u16::MAX) }
    }

    pub(super) fn code(&self, x: f32) -> u16 {
        let squares = (f64::from(x) - f64::from(self.start)) / f64::from(self.square);
        // As for [`Codes::code`], and for what rounding has put below the least.
        squares.max(0.0).sqrt().round() as u16
    }
}

impl Codes {
    /// Of numbers that are met to a tolerance, or as nearly as 16 bits allow. Fewer levels have
    /// fewer digits in a text.
    pub(super) fn of(numbers: impl Iterator<Item = f32>, tolerance: f64) -> Self {
        let ends = numbers
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        let range = f64::from(ends[1]) - f64::from(ends[0]);
        let levels = (0.5 * range / tolerance).ceil().clamp(1.0, f64::from(u16::MAX));
        Self { start: ends[0], step: (range / levels) as f32 }
    }

    pub(super) fn code(&self, x: f32) -> u16 {
        let steps = (f64::from(x) - f64::from(self.start)) / f64::from(self.step);
        // A step of 0, of numbers that are all the same, gives NaN, which becomes 0.
        steps.round() as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_met_to_half_a_step() {
        let numbers = [0.3, -0.2, 0.7, 0.123_456];
        let codes = Codes::of(numbers.into_iter(), 1e-3);
        assert_eq!([codes.code(-0.2), codes.code(0.7)], [0, 450]);
        for x in numbers {
            let back = codes.start + codes.step * f32::from(codes.code(x));
            assert!((back - x).abs() <= 1.0001e-3, "{x} {back}");
        }
        assert_eq!(Codes::of(numbers.into_iter(), 0.0).code(0.7), u16::MAX);
        let squares = Squares::of([0.0, 0.5, 1e-6].into_iter());
        assert_eq!([squares.code(0.0), squares.code(0.5)], [0, u16::MAX]);
        let code = f32::from(squares.code(1e-6));
        assert!((squares.square * code * code - 1e-6).abs() < 1e-8);
        assert_eq!(Codes::of([0.5; 3].into_iter(), 1e-3).code(0.5), 0);
    }
}
