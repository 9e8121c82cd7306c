//! What scenes are compared by, as keys of hash maps: planning compares each part of a material
//! with those of all others.

use std::collections::HashSet;
use std::hash::{Hash, Hasher};
use std::mem::discriminant;

use microfacet_tables::Reflectance;

use crate::bake::albedo::{AlbedoLobe, Domain};
use crate::distribution::Distribution;
use crate::interval::Interval;

/// A part of a scene as a key, equal to another if the parts are. No number of a scene is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key<T>(pub(super) T);

impl<T: PartialEq> Eq for Key<T> {}

impl<T: Bits> Hash for Key<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.feed(state);
    }
}

/// Each of some values once, in the order in which they come first.
pub(super) fn distinct<T: Bits + Copy + PartialEq>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen = HashSet::new();
    values.filter(|value| seen.insert(Key(*value))).collect()
}

/// What has numbers, to be hashed by their bits.
pub(super) trait Bits {
    /// Hashes it; what is equal gives the same hash.
    fn feed(&self, state: &mut impl Hasher);
}

impl Bits for f64 {
    fn feed(&self, state: &mut impl Hasher) {
        // −0 equals 0: their sum is 0.
        state.write_u64((self + 0.0).to_bits());
    }
}

impl<T: Bits, const N: usize> Bits for [T; N] {
    fn feed(&self, state: &mut impl Hasher) {
        self.iter().for_each(|part| part.feed(state));
    }
}

impl<T: Bits> Bits for &T {
    fn feed(&self, state: &mut impl Hasher) {
        (**self).feed(state);
    }
}

impl<A: Bits, B: Bits> Bits for (A, B) {
    fn feed(&self, state: &mut impl Hasher) {
        self.0.feed(state);
        self.1.feed(state);
    }
}

impl Bits for Interval {
    fn feed(&self, state: &mut impl Hasher) {
        [self.min, self.max].feed(state);
    }
}

impl Bits for Domain {
    fn feed(&self, state: &mut impl Hasher) {
        [self.gamma, self.sigma].feed(state);
    }
}

impl Bits for Distribution {
    fn feed(&self, state: &mut impl Hasher) {
        match self {
            Self::Named(named) => {
                named.kind.hash(state);
                named.values.iter().for_each(|value| value.feed(state));
            }
            // A recipe reads a file in two units at most, and a hash of all its rows takes longer
            // than to compare them.
            Self::Measured { file, .. } => file.hash(state),
        }
    }
}

impl Bits for AlbedoLobe {
    fn feed(&self, state: &mut impl Hasher) {
        discriminant(self).hash(state);
        match self {
            Self::Family(domain) => domain.feed(state),
            Self::StudentT { sigma, gamma } => (sigma, gamma).feed(state),
            Self::Ellipsoid { sigma, theta, gamma } => (sigma, (theta, gamma)).feed(state),
            Self::Radial { distribution, sigma } => (distribution, sigma).feed(state),
        }
    }
}

impl Bits for Reflectance {
    fn feed(&self, state: &mut impl Hasher) {
        discriminant(self).hash(state);
        match self {
            Self::Moments => {}
            Self::Conductor { eta, k } => [eta, k].feed(state),
            Self::Dielectric { side, min, max } => {
                discriminant(side).hash(state);
                [*min, max.unwrap_or(f64::INFINITY)].feed(state);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::hash::{BuildHasher, RandomState};

    use super::*;

    #[test]
    fn what_is_equal_is_the_same_key() {
        let state = RandomState::new();
        let same = |a: Reflectance, b: Reflectance| {
            assert_eq!(a == b, state.hash_one(Key(a)) == state.hash_one(Key(b)), "{a:?} {b:?}");
            a == b
        };
        let eta = [0.2, 0.9, 1.1];
        let conductor = |k: f64| Reflectance::Conductor { eta, k: [k, 2.4, 2.2] };
        assert!(same(conductor(0.0), conductor(-0.0)));
        assert!(!same(conductor(0.0), conductor(f64::MIN_POSITIVE)));
        assert!(!same(conductor(0.0), Reflectance::Moments));
    }
}
