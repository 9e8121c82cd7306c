//! The loader of table sets: any bytes are refused or give usable tables.

#![no_main]

include!("common.rs");

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| load(bytes));
