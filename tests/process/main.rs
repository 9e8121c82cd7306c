//! Processes: interrupts, kills, several at once, and any number of threads.

#[path = "../common/mod.rs"]
mod common;

mod interrupt;
mod library;
mod process;
mod threads;
