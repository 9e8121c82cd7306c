//! What scenes are compared by, as keys of hash maps: planning compares each part of a material
//! with those of all others.

use std::collections::HashSet;
use std::hash::Hash;

use microfacet_tables::{Reflectance, Side};
use ordered_float::OrderedFloat;

use crate::bake::albedo::{AlbedoLobe, Domain};

/// The numbers of a part of a scene, in which −0 equals 0; each form has another number of them.
pub(super) type Numbers = Vec<OrderedFloat<f64>>;

/// Numbers as a key.
pub(super) fn of(numbers: &[f64]) -> Numbers {
    numbers.iter().copied().map(OrderedFloat).collect()
}

pub(super) fn of_domain(Domain { gamma, sigma }: &Domain) -> Numbers {
    of(&[gamma.min, gamma.max, sigma.min, sigma.max])
}

/// The numbers of a lobe, and the distribution of one outside the family.
pub(super) fn of_lobe(lobe: &AlbedoLobe) -> (Numbers, Option<String>) {
    match lobe {
        AlbedoLobe::Family(domain) => (of_domain(domain), None),
        AlbedoLobe::StudentT { sigma, gamma } => (of(&[&sigma[..], &[*gamma]].concat()), None),
        AlbedoLobe::Ellipsoid { sigma, theta, gamma } => {
            (of(&[&sigma[..], &theta[..], &[*gamma]].concat()), None)
        }
        AlbedoLobe::Radial { distribution, sigma } => (of(&[*sigma]), Some(distribution.label())),
    }
}

pub(super) fn of_reflectance(reflectance: &Reflectance) -> Numbers {
    match *reflectance {
        Reflectance::Moments => Vec::new(),
        Reflectance::Conductor { eta, k } => of(&[eta, k].concat()),
        Reflectance::Dielectric { side, min, max } => {
            of(&[f64::from(side == Side::Dense), min, max.unwrap_or(f64::INFINITY)])
        }
    }
}

/// The values of which each is the first of its key, in order.
pub(super) fn distinct<T: Copy, K: Eq + Hash>(
    values: impl Iterator<Item = T>,
    key: impl Fn(&T) -> K,
) -> Vec<T> {
    let mut seen = HashSet::new();
    values.filter(|value| seen.insert(key(value))).collect()
}
