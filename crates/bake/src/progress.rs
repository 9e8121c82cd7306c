//! Progress of long work.
//!
//! The caller announces all work by [`Meter::expect`], so that the share done is a share of the
//! whole, and gives each function a [`Stage`]. The function splits its stage into equal steps, such
//! as nodes or points, and counts them from any thread. Another thread may [read](Meter::share) the
//! meter at any time. Work has any unit that is the same for all stages, such as planned seconds.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

/// Counts of the work that was announced and of the work done; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Meter(Arc<Counts>);

/// In 1e-9 of the unit of work.
#[derive(Debug, Default)]
struct Counts {
    known: AtomicU64,
    done: AtomicU64,
}

/// Share below which no remaining time is estimated: the first steps may differ from the others.
const FIRST: f64 = 0.01;

impl Meter {
    /// Announces work.
    pub fn expect(&self, work: f64) {
        self.0.known.fetch_add(counted(work), Relaxed);
    }

    /// Takes back announced work that need not be done, such as tables found in a cache.
    pub fn forget(&self, work: f64) {
        let less = |known: u64| Some(known.saturating_sub(counted(work)));
        let _ = self.0.known.fetch_update(Relaxed, Relaxed, less);
    }

    /// Begins a stage of the announced work.
    pub fn stage(&self, work: f64) -> Stage {
        let total = counted(work);
        Stage { meter: self.clone(), total, parts: AtomicU64::new(1), counted: AtomicU64::new(0) }
    }

    /// Whether any work was announced.
    pub fn is_known(&self) -> bool {
        self.0.known.load(Relaxed) > 0
    }

    /// The share of the announced work that is done, in [0, 1]; 0 if none was announced.
    pub fn share(&self) -> f64 {
        let (done, known) = (self.0.done.load(Relaxed), self.0.known.load(Relaxed));
        if known == 0 { 0.0 } else { (done as f64 / known as f64).min(1.0) }
    }

    /// The time left after `elapsed` at the average speed so far; `None` while too little is done
    /// to tell.
    pub fn left(&self, elapsed: Duration) -> Option<Duration> {
        let share = self.share();
        (share >= FIRST).then(|| elapsed.mul_f64((1.0 - share) / share))
    }
}

fn counted(work: f64) -> u64 {
    // A cast takes NaN and negative numbers to 0.
    (1e9 * work) as u64
}

/// A stage of the work, counted in equal steps; when it is dropped, all of it counts as done.
#[derive(Debug)]
pub struct Stage {
    meter: Meter,
    total: u64,
    parts: AtomicU64,
    counted: AtomicU64,
}

impl Stage {
    /// A stage of a meter that is not read.
    pub fn unwatched() -> Self {
        Meter::default().stage(0.0)
    }

    /// Sets the number of equal steps, before any is done. If more or fewer are counted, the work
    /// of the whole stage stays the same.
    pub fn split(&self, parts: usize) {
        self.parts.store((parts as u64).max(1), Relaxed);
    }

    /// Counts one step as done.
    pub fn step(&self) {
        self.steps(1);
    }

    /// Counts some steps as done.
    pub fn steps(&self, count: usize) {
        let before = self.counted.fetch_add(count as u64, Relaxed);
        self.count(before, before + count as u64);
    }

    fn count(&self, from: u64, to: u64) {
        let parts = self.parts.load(Relaxed);
        let upto = |n: u64| u128::from(self.total) * u128::from(n.min(parts)) / u128::from(parts);
        // The total has 64 bits.
        self.meter.0.done.fetch_add((upto(to) - upto(from)) as u64, Relaxed);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        self.count(self.counted.load(Relaxed), u64::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_add_up_to_what_was_expected() {
        let meter = Meter::default();
        let is_at = |share: f64| assert!((meter.share() - share).abs() < 1e-9, "{share}");
        is_at(0.0);
        meter.expect(10.0);
        {
            let stage = meter.stage(2.5);
            stage.split(3);
            stage.step();
            is_at(0.25 / 3.0);
            // More steps than were announced.
            stage.steps(7);
            is_at(0.25);
        }
        is_at(0.25);
        // Fewer, or none.
        drop(meter.stage(2.5));
        is_at(0.5);
        meter.forget(5.0);
        assert_eq!(meter.share(), 1.0);
        // Wrong estimates leave the share in [0, 1].
        meter.forget(f64::INFINITY);
        meter.expect(f64::NAN);
        drop(meter.stage(1.0));
        assert_eq!(meter.share(), 0.0);
    }

    #[test]
    fn threads_count_together() {
        let meter = Meter::default();
        meter.expect(1.0);
        let stage = meter.stage(1.0);
        stage.split(4000);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..500).for_each(|_| stage.step()));
            }
        });
        assert!((meter.share() - 0.5).abs() < 1e-9);
    }
}
