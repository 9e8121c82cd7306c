//! Memoised values of nodes that refer to each other, such as textures.

use std::collections::HashMap;
use std::hash::Hash;

use microfacet_baker::scene::{Place, SceneError};
use microfacet_tables::Interval;

/// Longer chains of references than this are refused, which bounds the stack for the recursion.
const MAX_DEPTH: usize = 128;

/// Computes each value once, so that time stays linear however often it is referred to, and detects
/// a value that depends on itself.
pub(super) struct Memo<K> {
    /// `None` is a value that is being computed.
    values: HashMap<K, Option<Interval>>,
    /// Those that are being computed, from the outermost.
    open: Vec<K>,
}

impl<K> Default for Memo<K> {
    fn default() -> Self {
        Self { values: HashMap::new(), open: Vec::new() }
    }
}

impl<K: Clone + Eq + Hash> Memo<K> {
    /// The value if it is known; if not, it must be computed and given to [`Self::end`].
    pub(super) fn begin(&mut self, key: K, place: &Place) -> Result<Option<Interval>, SceneError> {
        match self.values.get(&key) {
            Some(&Some(value)) => return Ok(Some(value)),
            Some(None) => return Err(place.invalid("this texture or node depends on itself")),
            None => {}
        }
        if self.open.len() == MAX_DEPTH {
            return Err(place.invalid(format!(
                "textures or nodes depend on each other more than {MAX_DEPTH} deep"
            )));
        }
        self.open.push(key.clone());
        self.values.insert(key, None);
        Ok(None)
    }

    /// Keeps a value that was computed for `place`; it must be finite.
    pub(super) fn end(
        &mut self,
        key: K,
        value: Interval,
        place: &Place,
    ) -> Result<Interval, SceneError> {
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
