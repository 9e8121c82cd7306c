//! Shows the progress of long work on a terminal.

use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
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
pub(super) struct Bar(Option<(Sender<()>, JoinHandle<()>)>);

/// Shows a meter, on a terminal only; `what` names the work.
pub(super) fn show(meter: &Meter, what: &'static str) -> Bar {
    if super::is_quiet() || !io::stderr().is_terminal() {
        return Bar(None);
    }
    let (end, ended) = channel::<()>();
    let waits = move |time| ended.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
    let meter = meter.clone();
    let draw = move || {
        let start = Instant::now();
        if !waits(DELAY) {
            return;
        }
        let style = style(meter.clone(), start);
        let bar = ProgressBar::new(LENGTH).with_style(style).with_message(what);
        if let Ok(mut shown) = SHOWN.lock() {
            *shown = Some(bar.clone());
        }
        while waits(TICK) {
            // The share falls if more work is found, as where tables are refined; the bar then
            // stays.
            let position = (LENGTH as f64 * meter.share()) as u64;
            bar.set_position(position.max(bar.position()));
            bar.tick();
        }
        hide();
    };
    // The work goes on without a bar where no thread can be started.
    Bar(std::thread::Builder::new().spawn(draw).ok().map(|thread| (end, thread)))
}

/// The style of a bar, or a spinner for a stream, whose length is not known. The time left is the
/// meter's: the bar's own estimate takes the speed of the last seconds, and stages differ.
fn style(meter: Meter, start: Instant) -> ProgressStyle {
    let is_known = meter.is_known();
    let left = move |_: &ProgressState, out: &mut dyn Write| {
        // A failure only leaves out the time.
        let _ = match meter.left(start.elapsed()) {
            Some(left) => write!(out, "{} left", HumanDuration(left)),
            None => Ok(()),
        };
    };
    let template = match is_known {
        true => "{msg} {wide_bar} {percent:>3} % {left}",
        false => "{spinner} {msg}, {elapsed}",
    };
    ProgressStyle::with_template(template).expect("a constant template").with_key("left", left)
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.0.take() {
            drop(end);
            // A panic of the drawing thread does not affect the work.
            let _ = thread.join();
        }
    }
}

/// Removes the bar, unless a print holds it for a second, whose reader may have stopped.
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
