//! The time of a call, as the median over batches of rivals that take turns.
//!
//! Every round runs one batch of each rival. A temporary disturbance of the machine affects all of
//! them, so their ratios are steadier than their times.

use std::ops::Range;
use std::time::Instant;

/// A rival that makes one call for each of a range of the inputs.
pub(crate) type Calls<'a> = Box<dyn FnMut(Range<usize>) + 'a>;

/// Approximate duration of a batch: long compared with a call of the clock, short compared with a
/// scheduler's time slice, so that most batches are not interrupted.
const BATCH_NS: f64 = 1e5;

/// Nanoseconds a call of each rival, the median over `rounds` batches of inputs from `count`.
pub(crate) fn medians(rivals: &mut [Calls], rounds: usize, count: usize) -> Vec<f64> {
    medians_warmed(rivals, &[], rounds, count)
}

/// The same, where the rivals of some indices have large tables.
///
/// A quarter of a batch brings small tables back into the caches, and not those of a megabyte, of
/// which a call reads a part by γ and view: they take all inputs. Without that a batch would wait
/// for memory that a renderer, after its first milliseconds, has in the caches.
pub(crate) fn medians_warmed(
    rivals: &mut [Calls],
    large: &[usize],
    rounds: usize,
    count: usize,
) -> Vec<f64> {
    let time = |rival: &mut Calls, range: Range<usize>| {
        let calls = range.len() as f64;
        let start = Instant::now();
        rival(range);
        start.elapsed().as_nanos() as f64 / calls
    };
    let batches: Vec<usize> = rivals
        .iter_mut()
        .map(|rival| {
            // The first calls warm the caches, the others measure. The least time is one without
            // interruption.
            let least = (0..5).map(|_| time(rival, 0..16.min(count))).fold(f64::INFINITY, f64::min);
            ((BATCH_NS / least) as usize).clamp(8.min(count), count)
        })
        .collect();
    let mut times = vec![Vec::with_capacity(rounds); rivals.len()];
    for round in 0..rounds {
        let each = rivals.iter_mut().zip(&batches).zip(&mut times).enumerate();
        for (i, ((rival, &calls), times)) in each {
            // Other inputs each time: a branch predictor would learn a short batch.
            let start = round * calls % (count - calls + 1);
            // Brings its code and tables back into the caches.
            rival(0..if large.contains(&i) { count } else { (calls / 4).max(1) });
            times.push(time(rival, start..start + calls));
        }
    }
    times.into_iter().map(median).collect()
}

pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
