//! Scenes in .xml files: any bytes are read or refused.

#![no_main]

include!("common.rs");

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| scene("a.xml", bytes));
