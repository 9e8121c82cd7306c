//! The domain that is swept: materials, classes of views and classes of random numbers.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use microfacet_sampler::Skew;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

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

/// A class of views: its name, and one try to draw a unit vector from two random numbers.
pub(crate) struct Views {
    pub(crate) name: &'static str,
    one: Box<dyn Fn([f32; 2]) -> Option<Vec3>>,
}

/// The class of views that most calls of a renderer have, evenly over the hemisphere.
pub(crate) const RANDOM: &str = "random";

impl Views {
    fn new(name: &'static str, one: impl Fn([f32; 2]) -> Option<Vec3> + 'static) -> Self {
        Self { name, one: Box::new(one) }
    }

    /// The classes that every lobe has.
    pub(crate) fn all() -> [Self; 5] {
        let even =
            |name, z: fn(f32) -> f32| Self::new(name, move |[a, b]| Some(direction(z(a), b)));
        [
            even(RANDOM, |a| 1.0 - a),
            // Cosines from 1e-6 to 0.01, evenly in their logarithm.
            even("grazing", |a| 10_f32.powf(-2.0 - 4.0 * a)),
            Self::down(),
            even("horizon", |_| 0.0),
            even("below", |a| a - 1.0),
        ]
    }

    /// All straight down onto the surface, (0, 0, 1).
    pub(crate) fn down() -> Self {
        Self::new("straight down", |_| Some(Vec3::Z))
    }

    /// Views above the surface, but below the horizon of a lobe that leans away, if there are any:
    /// at all depths; and at depths of 0.8 to 1 unit slopes, which save the least time: too deep
    /// for a table, not deep enough for an expansion.
    pub(crate) fn below_lobe(skew: Skew) -> impl Iterator<Item = Self> {
        let below = move |[a, b]: [f32; 2]| {
            // The lobe's horizon is at the slope −(x, y)·(cos φ, sin φ).
            let [x, y] = [skew.x as f32, skew.y as f32];
            let off = 0.95 * FRAC_PI_2 * (2.0 * b - 1.0);
            let slope = a * off.cos() * x.hypot(y);
            let (sin, cos) = ((-y).atan2(-x) + off).sin_cos();
            (slope > 0.0).then(|| Vec3::new(cos, sin, slope).normalize())
        };
        let near = move |u| {
            let v: Vec3 = below(u)?;
            let [x, y, z] = skew.direction(v.as_dvec3().to_array());
            (0.8..1.0).contains(&(-z / x.hypot(y))).then_some(v)
        };
        let classes =
            [Self::new("below the lobe", below), Self::new("below the lobe by 0.8 to 1", near)];
        classes.into_iter().filter(|views| !views.draw(1, 1).is_empty())
    }

    /// Unit vectors of this class; none if it is empty.
    pub(crate) fn draw(&self, seed: u64, count: usize) -> Vec<Vec3> {
        let mut random = StdRng::seed_from_u64(seed);
        // Few tries are enough for a class that is not empty.
        let tries = 1000 * count;
        let one = || (self.one)(random.random());
        std::iter::repeat_with(one).take(tries).flatten().take(count).collect()
    }
}

/// A class of pairs of random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Numbers {
    /// Uniform in [0, 1)².
    Random,
    /// Uniform, but in one pair of twenty one of the two is 0 or 1.
    SomeAtEnds,
    /// Both are 0 or 1.
    AllAtEnds,
}

impl Numbers {
    pub(crate) const ALL: [(&str, Self); 3] = [
        (RANDOM, Self::Random),
        ("5 % at an end", Self::SomeAtEnds),
        ("at the ends", Self::AllAtEnds),
    ];

    /// Pairs of this class.
    pub(crate) fn draw(self, seed: u64, count: usize) -> Vec<[f32; 2]> {
        let mut random = StdRng::seed_from_u64(!seed);
        let one = |_| {
            let mut u: [f32; 2] = random.random();
            let (at_end, which, ends): (f32, usize, [bool; 2]) =
                (random.random(), random.random_range(0..2), random.random());
            let ends = ends.map(|end| f32::from(u8::from(end)));
            match self {
                Self::SomeAtEnds if at_end < 0.05 => u[which] = ends[0],
                Self::AllAtEnds => u = ends,
                Self::Random | Self::SomeAtEnds => {}
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
                assert_eq!(drawn.len(), 500, "{}", views.name);
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
        let heights = [[0.0, 1.0], [0.99e-6, 1.01e-2], [1.0; 2], [0.0; 2], [-1.0, 0.0]];
        for (views, [low, high]) in Views::all().iter().zip(heights) {
            let drawn = views.draw(1, 500);
            assert_eq!(drawn.len(), 500);
            let is_sound = |v: &Vec3| (low..=high).contains(&v.z) && v.is_normalized();
            assert!(drawn.iter().all(is_sound), "{}", views.name);
        }
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
