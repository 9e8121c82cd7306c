//! Closed intervals: a parameter that is one number, or the range of numbers of a texture.

/// A closed interval `[min, max]`; a single number is the interval with both ends equal.
///
/// The ends are never NaN and `min <= max`; only a shape parameter may have an infinite end.
/// Arithmetic on intervals is conservative: the result holds every value that the operation
/// takes on the arguments, for independent arguments.
///
/// In files it is `[min, max]`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Interval {
    /// The lower end.
    pub min: f64,
    /// The upper end.
    pub max: f64,
}

impl From<[f64; 2]> for Interval {
    fn from([min, max]: [f64; 2]) -> Self {
        Self { min, max }
    }
}

impl From<Interval> for [f64; 2] {
    fn from(Interval { min, max }: Interval) -> Self {
        [min, max]
    }
}

impl Interval {
    /// From 0 to 1: what is assumed of a texture that cannot be read.
    pub const UNIT: Self = Self { min: 0.0, max: 1.0 };

    /// The interval that holds `x` alone.
    #[must_use]
    pub const fn point(x: f64) -> Self {
        Self { min: x, max: x }
    }

    /// The smallest interval that holds all of `values`; `None` if there are none or one is NaN.
    pub fn hull(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().try_fold(None, |hull: Option<Self>, x| {
            (!x.is_nan()).then(|| Some(hull.map_or(Self::point(x), |h| h.union(Self::point(x)))))
        })?
    }

    /// Whether both ends are equal.
    #[must_use]
    pub fn is_point(self) -> bool {
        self.min == self.max
    }

    /// Whether `x` lies in the interval, ends included.
    #[must_use]
    pub fn contains(self, x: f64) -> bool {
        self.min <= x && x <= self.max
    }

    /// The smallest interval that holds both.
    ///
    /// An end that is NaN makes both ends NaN, so that a later check refuses the overflow that
    /// caused it; `f64::min` and `max` would drop the NaN.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let ends = [self.min, self.max, other.min, other.max];
        if ends.iter().any(|end| end.is_nan()) {
            return Self::point(f64::NAN);
        }
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The image under a function that rises over the whole interval.
    #[must_use]
    pub fn map_rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self { min: f(self.min), max: f(self.max) }
    }

    /// The image under a function that falls over the whole interval.
    #[must_use]
    pub fn map_falling(self, f: impl Fn(f64) -> f64) -> Self {
        Self { min: f(self.max), max: f(self.min) }
    }

    /// The image of both intervals under a function that is linear in each argument, so that its
    /// extremes are at the ends. Ends must be finite.
    #[must_use]
    pub fn map_bilinear(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let row = |y| Self::point(f(self.min, y)).union(Self::point(f(self.max, y)));
        row(other.min).union(row(other.max))
    }

    /// All `self (1 - t) + other t`, with the same `t` in both terms.
    #[must_use]
    pub fn mix(self, other: Self, t: Self) -> Self {
        let ends = |a: f64, b: f64| t.map_bilinear(Self::point(0.0), |t, _| a * (1.0 - t) + b * t);
        ends(self.min, other.min)
            .union(ends(self.min, other.max))
            .union(ends(self.max, other.min))
            .union(ends(self.max, other.max))
    }

    /// Both ends moved into `[low, high]`.
    #[must_use]
    pub fn clamp(self, low: f64, high: f64) -> Self {
        self.map_rising(|x| x.clamp(low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    const A: Interval = Interval { min: -1.0, max: 2.0 };

    #[test]
    fn a_point_is_its_own_hull() {
        assert_eq!(Interval::hull([0.3]), Some(Interval::point(0.3)));
        assert_eq!(Interval::hull([3.0, 1.0, 2.0]), Some(Interval { min: 1.0, max: 3.0 }));
        assert_eq!(Interval::hull([]), None);
        assert_eq!(Interval::hull([1.0, f64::NAN]), None);
    }

    #[test]
    fn products_take_their_extremes_at_the_corners() {
        let product = A.map_bilinear(Interval { min: -3.0, max: 1.0 }, |a, b| a * b);
        assert_eq!(product, Interval { min: -6.0, max: 3.0 });
    }

    #[test]
    fn an_overflow_is_no_number() {
        let all = Interval { min: 0.0, max: f64::INFINITY };
        let mixed = Interval::point(0.0).mix(Interval::point(1.0), all);
        assert!(mixed.min.is_nan() && mixed.max.is_nan(), "{mixed:?}");
    }

    #[test]
    fn a_mixture_stays_in_the_union_and_reaches_its_ends() {
        let b = Interval { min: 5.0, max: 6.0 };
        assert_eq!(A.mix(b, Interval::UNIT), A.union(b));
        assert_eq!(A.mix(b, Interval::point(0.5)), Interval { min: 2.0, max: 4.0 });
    }
}
