//! The domain that is swept: materials, classes of views and classes of random numbers.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use microfacet_sampler::Skew;
use rand::rngs::StdRng;
use rand::{Rng, RngExt, SeedableRng};

use crate::inputs::direction;

/// Shapes: both ends, both sides of 1.8, where the closed-form heavy part takes over, GGX, nodes of
/// the general set and shapes between them.
pub(crate) const GAMMAS: [f64; 15] =
    [1.501, 1.55, 1.6, 1.7, 1.79, 1.8, 1.9, 2.0, 2.5, 3.0, 4.0, 7.3, 20.0, 100.0, f64::INFINITY];

/// From here on the whole distribution is tabulated.
pub(crate) const WHOLE: f64 = 1.8;

/// Roughness along x and y.
pub(crate) const SIGMAS: [[f64; 2]; 8] = [
    [1e-3, 1e-3],
    [0.03, 0.03],
    [0.3, 0.3],
    [1.0, 1.0],
    [5.0, 5.0],
    [0.3, 0.5],
    [1e-3, 1.0],
    [5.0, 0.03],
];

/// Roughness of ellipsoids, and their turns about x, y and z in radians: upright, tilted slightly,
/// narrow and tilted, wide and tilted far, and anisotropic and tilted along both axes.
pub(crate) const ELLIPSOIDS: [([f64; 2], [f64; 3]); 5] = [
    ([0.3, 0.1], [0.0, 0.0, 0.0]),
    ([0.3, 0.1], [0.2, -0.1, 0.5]),
    ([0.03, 0.03], [0.5, 0.0, 0.0]),
    ([0.5, 0.5], [1.0, 0.0, 0.0]),
    ([1.0, 0.2], [0.3, 0.8, -0.4]),
];

/// A class of views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Views {
    /// Evenly over the hemisphere.
    Random,
    /// Cosines from 1e-6 to 0.01, evenly in their logarithm.
    Grazing,
    /// All straight down onto the surface, (0, 0, 1).
    Down,
    /// On the horizon.
    Horizon,
    /// Below the horizon, evenly over that hemisphere.
    Below,
    /// Above the surface, but below the horizon of a lobe that leans away.
    BelowLobe(Skew),
    /// The same, at depths of 0.8 to 1 unit slopes, where the least is saved: too deep for a table,
    /// not deep enough for an expansion.
    BelowLobeNear(Skew),
}

impl Views {
    /// The classes that every lobe has.
    pub(crate) const ALL: [Self; 5] =
        [Self::Random, Self::Grazing, Self::Down, Self::Horizon, Self::Below];

    /// The classes of views below an ellipsoid's own horizon, as far as there are any.
    pub(crate) fn below_lobe(skew: Skew) -> impl Iterator<Item = Self> {
        let classes = [Self::BelowLobe(skew), Self::BelowLobeNear(skew)];
        classes.into_iter().filter(|views| !views.draw(1, 1).is_empty())
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Grazing => "grazing",
            Self::Down => "straight down",
            Self::Horizon => "horizon",
            Self::Below => "below",
            Self::BelowLobe(_) => "below the lobe",
            Self::BelowLobeNear(_) => "below the lobe by 0.8 to 1",
        }
    }

    /// Unit vectors of this class; none if it is empty.
    pub(crate) fn draw(self, seed: u64, count: usize) -> Vec<Vec3> {
        let mut random = StdRng::seed_from_u64(seed);
        // Few tries are enough for a class that is not empty.
        let tries = 1000 * count;
        std::iter::repeat_with(|| self.one(&mut random)).take(tries).flatten().take(count).collect()
    }

    /// One try.
    fn one(self, random: &mut impl Rng) -> Option<Vec3> {
        let [a, b]: [f32; 2] = random.random();
        Some(match self {
            Self::Random => direction(1.0 - a, b),
            Self::Grazing => direction(10_f32.powf(-2.0 - 4.0 * a), b),
            Self::Down => Vec3::Z,
            Self::Horizon => direction(0.0, b),
            Self::Below => direction(a - 1.0, b),
            Self::BelowLobe(Skew { x, y, .. }) => {
                // The lobe's horizon is at the slope −(x, y)·(cos φ, sin φ).
                let [x, y] = [x as f32, y as f32];
                let off = 0.95 * FRAC_PI_2 * (2.0 * b - 1.0);
                let slope = a * off.cos() * x.hypot(y);
                let (sin, cos) = ((-y).atan2(-x) + off).sin_cos();
                return (slope > 0.0).then(|| Vec3::new(cos, sin, slope).normalize());
            }
            Self::BelowLobeNear(skew) => {
                let v = Self::BelowLobe(skew).one(random)?;
                let [x, y, z] = skew.direction(v.as_dvec3().to_array());
                return (0.8..1.0).contains(&(-z / x.hypot(y))).then_some(v);
            }
        })
    }
}

/// A class of pairs of random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Numbers {
    /// Uniform in [0, 1)².
    Random,
    /// The same, but in one pair of twenty one of the two is 0 or 1.
    SomeAtEnds,
    /// Both are 0 or 1.
    AllAtEnds,
}

impl Numbers {
    pub(crate) const ALL: [Self; 3] = [Self::Random, Self::SomeAtEnds, Self::AllAtEnds];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::SomeAtEnds => "5 % at an end",
            Self::AllAtEnds => "at the ends",
        }
    }

    /// Pairs of this class.
    pub(crate) fn draw(self, seed: u64, count: usize) -> Vec<[f32; 2]> {
        let mut random = StdRng::seed_from_u64(!seed);
        let one = |_| {
            let mut u: [f32; 2] = random.random();
            let (at_end, which, [a, b]): (f32, usize, [bool; 2]) =
                (random.random(), random.random_range(0..2), random.random());
            match self {
                Self::Random => {}
                Self::SomeAtEnds if at_end < 0.05 => u[which] = f32::from(u8::from(a)),
                Self::SomeAtEnds => {}
                Self::AllAtEnds => u = [a, b].map(|end| f32::from(u8::from(end))),
            }
            u
        };
        (0..count).map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_of_their_class() {
        for (sigma, turns) in ELLIPSOIDS {
            let skew = Skew::new(sigma, turns).unwrap();
            let classes: Vec<Views> = Views::below_lobe(skew).collect();
            assert_eq!(classes.is_empty(), turns == [0.0; 3]);
            for (views, range) in classes.iter().zip([0.0..f64::INFINITY, 0.8..1.0]) {
                let drawn = views.draw(1, 500);
                assert_eq!(drawn.len(), 500, "{views:?}");
                for v in drawn {
                    let [x, y, z] = skew.direction(v.as_dvec3().to_array());
                    let depth = -z / x.hypot(y);
                    assert!(v.z > 0.0 && range.contains(&depth), "{v} of {skew:?} is at {depth}");
                }
            }
        }
        // A narrow lobe is seen from far below its horizon; a wide one that is tilted more is not.
        let classes = |i: usize| {
            let (sigma, turns) = ELLIPSOIDS[i];
            Views::below_lobe(Skew::new(sigma, turns).unwrap()).count()
        };
        assert_eq!([classes(2), classes(3)], [2, 1]);
        let within = |views: Views, low: f32, high: f32| {
            let drawn = views.draw(1, 500);
            assert_eq!(drawn.len(), 500);
            assert!(drawn.iter().all(|v| (low..=high).contains(&v.z) && v.is_normalized()));
        };
        within(Views::Random, 0.0, 1.0);
        within(Views::Grazing, 0.99e-6, 1.01e-2);
        within(Views::Down, 1.0, 1.0);
        within(Views::Horizon, 0.0, 0.0);
        within(Views::Below, -1.0, 0.0);
    }

    #[test]
    fn numbers_are_at_an_end_as_often_as_said() {
        let is_end = |u: f32| u == 0.0 || u == 1.0;
        let share = |numbers: Numbers, which: fn([bool; 2]) -> bool| {
            let drawn = numbers.draw(1, 20_000);
            assert!(drawn.iter().flatten().all(|u| (0.0..=1.0).contains(u)));
            drawn.iter().filter(|u| which(u.map(is_end))).count() as f64 / 20_000.0
        };
        assert!(share(Numbers::Random, |ends| ends != [false; 2]) < 1e-3);
        assert!((share(Numbers::SomeAtEnds, |ends| ends != [false; 2]) - 0.05).abs() < 0.01);
        assert_eq!(share(Numbers::AllAtEnds, |ends| ends == [true; 2]), 1.0);
        let ends = Numbers::AllAtEnds.draw(1, 20_000);
        for pair in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
            let share = ends.iter().filter(|u| **u == pair).count() as f64 / 20_000.0;
            assert!((share - 0.25).abs() < 0.02, "{pair:?}: {share}");
        }
    }
}
