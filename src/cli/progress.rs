//! Shows the progress of long work on a terminal.

use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use microfacet_baker::progress::Meter;

/// The bar on the terminal, if there is one: what is printed meanwhile goes above it.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Time between two drawings, however slow the work is.
const TICK: Duration = Duration::from_millis(100);
/// Work that ends sooner shows no bar.
const DELAY: Duration = Duration::from_millis(300);
/// Steps of the bar.
const LENGTH: u64 = 1000;

/// A bar that follows a meter until it is dropped.
pub(super) struct Bar {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Shows a meter, on a terminal only; `what` names the work.
pub(super) fn show(meter: &Meter, what: &'static str) -> Bar {
    let ended = Arc::new(AtomicBool::new(false));
    if super::is_quiet() || !io::stderr().is_terminal() {
        return Bar { ended, thread: None };
    }
    let (meter, end) = (meter.clone(), ended.clone());
    let draw = move || {
        let start = Instant::now();
        while !end.load(Relaxed) && start.elapsed() < DELAY {
            std::thread::park_timeout(DELAY);
        }
        if end.load(Relaxed) {
            return;
        }
        let bar = bar(&meter, start).with_message(what);
        // Nobody knows the length of a stream.
        if !meter.is_known() {
            bar.set_style(
                ProgressStyle::with_template("{spinner} {msg}, {elapsed}")
                    .expect("a constant template"),
            );
        }
        if let Ok(mut shown) = SHOWN.lock() {
            *shown = Some(bar.clone());
        }
        while !end.load(Relaxed) {
            // More work may turn up, as where tables are refined: the bar waits for it.
            let position = (LENGTH as f64 * meter.share()) as u64;
            bar.set_position(position.max(bar.position()));
            std::thread::park_timeout(TICK);
        }
        hide();
    };
    // The work goes on without a bar where no thread can be started.
    Bar { ended, thread: std::thread::Builder::new().spawn(draw).ok() }
}

fn bar(meter: &Meter, start: Instant) -> ProgressBar {
    let meter = meter.clone();
    let left = move |_: &ProgressState, out: &mut dyn Write| {
        // Writing to a terminal's line cannot usefully fail.
        let _ = match meter.left(start.elapsed()) {
            Some(left) => write!(out, "{} left", HumanDuration(left)),
            None => Ok(()),
        };
    };
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} % {left}")
        .expect("a constant template");
    ProgressBar::new(LENGTH).with_style(style.with_key("left", left))
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.ended.store(true, Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // A panic there has nothing to do with the work.
            let _ = thread.join();
        }
    }
}

/// Removes the bar. Not from under a line that is being printed, whose reader may have stopped.
pub(super) fn hide() {
    let deadline = Instant::now() + Duration::from_secs(1);
    loop {
        match SHOWN.try_lock() {
            Ok(mut shown) => {
                shown.take().iter().for_each(ProgressBar::finish_and_clear);
                break;
            }
            Err(_) if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(5)),
            Err(_) => break,
        }
    }
}

/// Runs what prints to the terminal with the bar out of the way.
pub(super) fn above<T>(print: impl FnOnce() -> T) -> T {
    match SHOWN.lock().as_deref() {
        Ok(Some(bar)) => bar.suspend(print),
        _ => print(),
    }
}
