//! Ctrl-C, and a request to terminate: ends at once, with whole files, and says what is left.

use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use microfacet_baker::store;

use super::{progress, styled};

/// Time that a write may take to end.
const PATIENCE: Duration = Duration::from_secs(10);

type Left = Box<dyn Fn() -> String + Send>;

/// What an interrupted command leaves.
static LEFT: Mutex<Option<Left>> = Mutex::new(None);

/// Sets what is said if the command is interrupted from here on; `what` is called then.
pub(super) fn leaves(what: impl Fn() -> String + Send + 'static) {
    *LEFT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(what));
}

/// [`leaves`] for a command that writes to standard output.
pub(super) fn leaves_stream() {
    leaves(|| "standard output ends early".into());
}

/// Waits for a write that is under way, and says what is left.
fn prepare() {
    progress::hide();
    let whole = store::quiesce(PATIENCE);
    let left = LEFT.lock().unwrap_or_else(PoisonError::into_inner);
    let message = match left.as_ref() {
        _ if !whole => "a write did not end; it may leave a hidden file *.partial".into(),
        Some(left) => left(),
        None => "nothing was written".into(),
    };
    // Without the lock of the bar: a print that holds it may be waiting for a reader that has
    // stopped.
    let _ = writeln!(io::stderr(), "{}", styled("interrupted", &message));
}

/// From here on an interrupt ends the process between two writes, and a second one at once.
#[cfg(unix)]
pub(super) fn watch() {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::{flag, low_level};

    // A signal that is ignored already, as by `nohup` or in a background job, stays ignored.
    let ignored = ignored();
    let signals: Vec<i32> = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|signal| ignored & (1 << (signal - 1)) == 0)
        .collect();
    // Handlers come first, so that no signal is lost. Where none can be installed, the system's
    // default stays.
    let Ok(mut handled) = Signals::new(&signals) else { return };
    let again = Arc::new(AtomicBool::new(false));
    for &signal in &signals {
        let _ = flag::register_conditional_default(signal, again.clone());
        let _ = flag::register(signal, again.clone());
    }
    let watcher = std::thread::Builder::new().spawn(move || {
        if let Some(signal) = handled.forever().next() {
            prepare();
            // So that a shell sees what ended it: status 128 and the signal.
            let _ = low_level::emulate_default_handler(signal);
            std::process::exit(128 + signal);
        }
    });
    // Where no thread can be started, the first signal does what a second one would.
    if watcher.is_err() {
        again.store(true, Relaxed);
    }
}

/// The signals that are ignored, a bit each, where the kernel lists them; 0 elsewhere.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// From here on an interrupt ends the process between two writes.
#[cfg(not(unix))]
pub(super) fn watch() {
    let handler = || {
        prepare();
        std::process::exit(130);
    };
    // Fails only where signals cannot be handled at all; then the system's default stays.
    let _ = ctrlc::set_handler(handler);
}
