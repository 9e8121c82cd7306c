//! Ctrl-C, and a request to terminate: ends at once, with whole files, and says what is left.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use microfacet_bake::store;

use super::{progress, say};

/// Exit status of a command that was interrupted, as shells count it: 128 and the signal, 2.
const INTERRUPTED: i32 = 130;
/// Time that a write may take to end.
const PATIENCE: Duration = Duration::from_secs(10);

/// What an interrupted command leaves, beside whole files.
static LEFT: Mutex<String> = Mutex::new(String::new());

/// Says what the command leaves if it is interrupted from here on.
pub(super) fn leaves(what: impl Into<String>) {
    *LEFT.lock().unwrap_or_else(PoisonError::into_inner) = what.into();
}

/// From here on an interrupt ends the process between two writes.
pub(super) fn watch() {
    let handler = || {
        progress::hide();
        let files = if store::quiesce(PATIENCE) {
            "no file is half written"
        } else {
            "a write did not end; the next bake or read of that folder completes it"
        };
        let left = LEFT.lock().unwrap_or_else(PoisonError::into_inner);
        say("interrupted", &[files, &left].join(if left.is_empty() { "" } else { "; " }));
        std::process::exit(INTERRUPTED);
    };
    // Fails only where signals cannot be handled at all; then the system's default stays.
    let _ = ctrlc::set_handler(handler);
}
