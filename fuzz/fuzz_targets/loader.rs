//! The loader of table sets: any bytes are refused or give tables that can be used.

#![no_main]

include!("common.rs");

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| load(bytes));
