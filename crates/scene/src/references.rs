//! References between textures, nodes or materials: circles, and values that are computed once.

use std::collections::HashMap;
use std::hash::Hash;

use microfacet_baker::scene::Place;
use microfacet_tables::Interval;

use crate::Result;
use crate::limits;

/// A circle among `all` and what they refer to: each refers to the next, and the last to the first.
///
/// Takes time in proportion to the number of references, and does not recurse.
pub(super) fn circle<T: Copy + Eq + Hash>(
    all: impl IntoIterator<Item = T>,
    references: impl Fn(T) -> Vec<T>,
) -> Option<Vec<T>> {
    // Whether everything that can be reached from the key has been followed.
    let mut done: HashMap<T, bool> = HashMap::new();
    for start in all {
        if done.contains_key(&start) {
            continue;
        }
        done.insert(start, false);
        // The path that is being followed, with the references that each element has left.
        let mut path = vec![(start, references(start).into_iter())];
        while let Some((one, left)) = path.last_mut() {
            let Some(next) = left.next() else {
                done.insert(*one, true);
                path.pop();
                continue;
            };
            match done.get(&next) {
                None => {
                    done.insert(next, false);
                    path.push((next, references(next).into_iter()));
                }
                Some(true) => {}
                Some(false) => {
                    let circle = path.iter().map(|&(one, _)| one).skip_while(|&one| one != next);
                    return Some(circle.collect());
                }
            }
        }
    }
    None
}

/// Computes each value once, so that time stays linear however often it is referred to, and detects
/// a value that depends on itself.
pub(super) struct Memo<K> {
    /// `None` is a value that is being computed.
    values: HashMap<K, Option<Interval>>,
    /// Keys of the values that are being computed, outermost first.
    open: Vec<K>,
}

impl<K> Default for Memo<K> {
    fn default() -> Self {
        Self { values: HashMap::new(), open: Vec::new() }
    }
}

impl<K: Clone + Eq + Hash> Memo<K> {
    /// The value if it is known; if not, it must be computed and given to [`Self::end`].
    pub(super) fn begin(&mut self, key: K, place: &Place) -> Result<Option<Interval>> {
        match self.values.get(&key) {
            Some(&Some(value)) => return Ok(Some(value)),
            Some(None) => return Err(place.invalid("this texture or node depends on itself")),
            None => {}
        }
        if self.open.len() == limits::DEPTH {
            return Err(place.invalid(format!(
                "textures or nodes depend on each other more than {} deep",
                limits::DEPTH
            )));
        }
        self.open.push(key.clone());
        self.values.insert(key, None);
        Ok(None)
    }

    /// Keeps a value that was computed for `place`; it must be finite.
    pub(super) fn end(&mut self, key: K, value: Interval, place: &Place) -> Result<Interval> {
        if !(value.min.is_finite() && value.max.is_finite()) {
            return Err(place.invalid(format!(
                "the values of this texture or node come to [{}, {}]; they must be finite",
                value.min, value.max
            )));
        }
        self.open.pop();
        self.values.insert(key, Some(value));
        Ok(value)
    }

    /// Forgets the values that were being computed when one of them failed, so that another
    /// material that refers to them finds the same error, and not a circle.
    pub(super) fn abandon(&mut self) {
        for key in self.open.drain(..) {
            self.values.remove(&key);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::circle;

    #[test]
    fn a_circle_is_found_and_a_diamond_is_none() {
        let of = |edges: &'static [(u32, u32)]| {
            let to = move |x| edges.iter().filter(move |e| e.0 == x).map(|e| e.1).collect();
            circle(0..5, to)
        };
        assert_eq!(of(&[(0, 1), (0, 2), (1, 3), (2, 3), (3, 4)]), None);
        assert_eq!(of(&[(0, 1), (1, 2), (2, 3), (3, 1), (3, 4)]), Some(vec![1, 2, 3]));
        assert_eq!(of(&[(0, 1), (2, 4), (4, 4)]), Some(vec![4]));
    }

    #[test]
    fn a_long_chain_takes_no_stack() {
        let last = 1_000_000;
        assert_eq!(circle([0], |x: u32| if x == last { vec![] } else { vec![x + 1] }), None);
        let round = circle([0], |x: u32| vec![if x == last { last - 1 } else { x + 1 }]);
        assert_eq!(round, Some(vec![last - 1, last]));
    }
}
