//! Keys of hash maps by which planning compares the lobes and reflectances of all materials.

use std::collections::HashSet;
use std::hash::Hash;

use microfacet_tables::{Interval, Reflectance, Side};
use ordered_float::OrderedFloat;

use crate::bake::albedo::AlbedoLobe;
use crate::distribution::Distribution;

/// The numbers of a lobe or reflectance, in which −0 equals 0. Every kind of reflectance has
/// another count of numbers, so their keys differ.
pub(super) type Numbers = Vec<OrderedFloat<f64>>;

pub(super) fn of(numbers: &[f64]) -> Numbers {
    numbers.iter().copied().map(OrderedFloat).collect()
}

/// The numbers of a lobe, and the distribution of one outside the family.
pub(super) fn of_lobe(lobe: &AlbedoLobe) -> (Numbers, Option<String>) {
    let [x, y] = lobe.sigmas().map(<[f64; 2]>::from);
    let theta = lobe.theta.iter().flatten().copied();
    let all: Vec<f64> = [lobe.gamma.into(), x, y].concat().into_iter().chain(theta).collect();
    (of(&all), lobe.distribution.as_ref().map(Distribution::label))
}

pub(super) fn of_reflectance(reflectance: &Reflectance) -> Numbers {
    match *reflectance {
        Reflectance::Mirror => Vec::new(),
        Reflectance::Schlick(f0) => of(&f0),
        Reflectance::Conductor { eta, k } => of(&[eta, k].concat()),
        Reflectance::Dielectric(Interval { min, max }) => of(&[min, max]),
        Reflectance::Interface { side, index: Interval { min, max } } => {
            of(&[f64::from(side == Side::Dense), min, max, 0.0])
        }
    }
}

/// The first value of each key, in order.
pub(super) fn distinct<T: Copy, K: Eq + Hash>(
    values: impl Iterator<Item = T>,
    key: impl Fn(&T) -> K,
) -> Vec<T> {
    let mut seen = HashSet::new();
    values.filter(|value| seen.insert(key(value))).collect()
}
