//! The index of numbered sets: any text is refused, or names files of one folder and reads back.

#![no_main]

include!("common.rs");

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| index(bytes));
