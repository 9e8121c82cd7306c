//! An entry of the cache: any bytes are the tables that were asked for, or are baked again.

#![no_main]

include!("common.rs");

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    entry(bytes);
});
