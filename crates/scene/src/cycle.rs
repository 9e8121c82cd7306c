//! Things that refer to each other in a circle.

use std::collections::HashMap;
use std::hash::Hash;

/// A circle among `all` and what they refer to: each refers to the next, and the last to the first.
///
/// Takes time in proportion to the references, and no stack.
pub(super) fn find<T: Copy + Eq + Hash>(
    all: impl IntoIterator<Item = T>,
    references: impl Fn(T) -> Vec<T>,
) -> Option<Vec<T>> {
    // Whether everything that can be reached from it has been followed.
    let mut done: HashMap<T, bool> = HashMap::new();
    // From the first to the last: what is being followed, with the references that are left.
    let mut path: Vec<(T, std::vec::IntoIter<T>)> = Vec::new();
    for start in all {
        let mut next = Some(start);
        loop {
            match next {
                Some(one) => match done.insert(one, false) {
                    None => path.push((one, references(one).into_iter())),
                    Some(true) => {
                        done.insert(one, true);
                    }
                    Some(false) => {
                        let first = path.iter().position(|&(other, _)| other == one)?;
                        return Some(path[first..].iter().map(|&(one, _)| one).collect());
                    }
                },
                None => match path.pop() {
                    Some((one, _)) => {
                        done.insert(one, true);
                    }
                    None => break,
                },
            }
            next = path.last_mut().and_then(|(_, left)| left.next());
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::find;

    #[test]
    fn a_circle_is_found_and_a_diamond_is_none() {
        let of = |edges: &'static [(u32, u32)]| {
            let to = move |x| edges.iter().filter(move |e| e.0 == x).map(|e| e.1).collect();
            find(0..5, to)
        };
        assert_eq!(of(&[(0, 1), (0, 2), (1, 3), (2, 3), (3, 4)]), None);
        assert_eq!(of(&[(0, 1), (1, 2), (2, 3), (3, 1), (3, 4)]), Some(vec![1, 2, 3]));
        assert_eq!(of(&[(0, 1), (2, 4), (4, 4)]), Some(vec![4]));
    }

    #[test]
    fn a_long_chain_takes_no_stack() {
        let last = 1_000_000;
        assert_eq!(find([0], |x: u32| if x == last { vec![] } else { vec![x + 1] }), None);
        let round = find([0], |x: u32| vec![if x == last { last - 1 } else { x + 1 }]);
        assert_eq!(round, Some(vec![last - 1, last]));
    }
}
