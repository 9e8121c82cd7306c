//! Shares of the needs of a library, one for each process.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;
use std::str::FromStr;

use crate::table_set::Need;

/// The I-th of N shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// I, from 1 on.
    pub number: usize,
    /// N.
    pub of: usize,
}

/// Why a text is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotAShard {
    /// It is not two numbers with a slash between them.
    #[error("\"{0}\" must be I/N, such as 2/16: the second of sixteen shards")]
    Form(String),
    /// There are fewer shards than its number.
    #[error(
        "\"{0}\" is shard {number} of {of}: I goes from 1 to N, such as {of}/{number}",
        number = .0.number,
        of = .0.of
    )]
    Beyond(Shard),
    /// There are no such shards.
    #[error("\"{0}\": I goes from 1 to N, and N from 1 to {most}", most = Shard::MOST)]
    Never(String),
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = NotAShard;

    fn from_str(text: &str) -> Result<Self, NotAShard> {
        let numbers = text.split_once('/').and_then(|(number, of)| {
            let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
            (digits(number) && digits(of)).then_some(())?;
            Some((number.parse().ok()?, of.parse().ok()?))
        });
        let Some((number, of)) = numbers else { return Err(NotAShard::Form(text.into())) };
        match (Self { number, of }) {
            shard if shard.exists() => Ok(shard),
            shard if number > of && of > 0 => Err(NotAShard::Beyond(shard)),
            _ => Err(NotAShard::Never(text.into())),
        }
    }
}

impl Shard {
    /// Most shards of a library.
    pub const MOST: usize = 100_000;

    /// Whether N is allowed, and I one of N.
    pub(super) fn exists(self) -> bool {
        (1..=Self::MOST).contains(&self.of) && (1..=self.of).contains(&self.number)
    }

    /// The needs of this shard, in their order. The shards are disjoint and together hold every
    /// need. The planned seconds are balanced: the longest need goes first, to the shard that has
    /// least to do. Every machine divides the same needs in the same way.
    #[must_use]
    pub fn take(self, needs: Vec<(String, Need)>) -> Vec<(String, Need)> {
        let seconds: Vec<f64> = needs.iter().map(|(_, need)| need.seconds()).collect();
        let owners = owners(&seconds, self.of);
        let mine = needs.into_iter().zip(owners).filter(|(_, owner)| *owner + 1 == self.number);
        mine.map(|(need, _)| need).collect()
    }
}

/// The shard of each need, from 0, by the seconds that needs take.
fn owners(seconds: &[f64], shards: usize) -> Vec<usize> {
    let nanoseconds: Vec<u64> = seconds.iter().map(|seconds| (1e9 * seconds) as u64).collect();
    let mut longest: Vec<usize> = (0..seconds.len()).collect();
    longest.sort_by_key(|&i| Reverse(nanoseconds[i]));
    // The least load first; of equal ones the first shard.
    let mut loads: BinaryHeap<Reverse<(u64, usize)>> =
        (0..shards.min(seconds.len())).map(|shard| Reverse((0, shard))).collect();
    let mut owners = vec![0; seconds.len()];
    for i in longest {
        if let Some(Reverse((load, shard))) = loads.pop() {
            owners[i] = shard;
            // Needs that take no time are spread as well.
            loads.push(Reverse((load.saturating_add(nanoseconds[i].max(1)), shard)));
        }
    }
    owners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_read_and_refused_by_name() {
        for text in ["1/1", "2/16", "100000/100000"] {
            assert_eq!(text.parse::<Shard>().unwrap().to_string(), text);
        }
        let refused = |text: &str, what: &str| {
            let why = text.parse::<Shard>().unwrap_err().to_string();
            assert!(why.contains(what) && why.contains(text), "{why}");
        };
        refused("5/4", "such as 4/5");
        refused("0/4", "from 1 to N");
        refused("1/0", "from 1 to N");
        refused("1/100001", "100000");
        for text in ["", "3", "1-4", "1/4/2", "a/b", "-1/4", "+1/4", " 1/4", "1.0/4"] {
            refused(text, "must be I/N");
        }
    }

    #[test]
    fn loads_are_balanced() {
        let seconds: Vec<f64> = (1..=1000).map(|i| f64::from(i * 7919 % 1009)).collect();
        for shards in [1, 2, 7, 64, 999] {
            let mut loads = vec![0.0; shards];
            for (owner, seconds) in owners(&seconds, shards).into_iter().zip(&seconds) {
                loads[owner] += seconds;
            }
            let mean = seconds.iter().sum::<f64>() / shards as f64;
            let largest = loads.iter().copied().fold(0.0, f64::max);
            // No division has a largest shard below the mean, or below the longest need.
            assert!(largest <= 1.01 * mean.max(1008.0), "{shards}: {largest} over {mean}");
            assert!(loads.iter().all(|load| *load > 0.0));
        }
        assert_eq!(owners(&[0.0; 4], 2), [0, 1, 0, 1]);
        assert_eq!(owners(&[f64::NAN, 3.0], 5), [1, 0]);
        assert!(owners(&[], 3).is_empty());
    }
}
