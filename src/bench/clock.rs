//! The time of a call, as the median over batches of rivals that take turns.
//!
//! One batch of each in every round: what disturbs the machine for a while disturbs all of them, so that their ratios are
//! steadier than their times.

use std::time::Instant;

/// A rival that makes as many calls as it is told.
pub(super) type Calls<'a> = Box<dyn FnMut(usize) + 'a>;

/// A batch takes no longer than this, or the slowest rivals would take all of the time.
const BATCH_NS: f64 = 3e6;

/// Nanoseconds a call of each, over `rounds` batches of at most `calls`.
pub(super) fn medians(rivals: &mut [Calls], rounds: usize, calls: usize) -> Vec<f64> {
    let time = |rival: &mut Calls, calls: usize| {
        let start = Instant::now();
        rival(calls);
        start.elapsed().as_nanos() as f64 / calls as f64
    };
    let few = calls.min(256);
    let batches: Vec<usize> = rivals
        .iter_mut()
        .map(|rival| {
            // The first touches its data, the second tells how long it takes.
            time(rival, few);
            let one = time(rival, few);
            ((BATCH_NS / one) as usize).clamp(few, calls)
        })
        .collect();
    let mut times = vec![Vec::with_capacity(rounds); rivals.len()];
    for _ in 0..rounds {
        for ((rival, &calls), times) in rivals.iter_mut().zip(&batches).zip(&mut times) {
            // Its code and tables back into the caches.
            rival(few.min(calls));
            times.push(time(rival, calls));
        }
    }
    times.into_iter().map(median).collect()
}

/// The middle one.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
