//! The reader of images: any bytes are refused or give a table.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = microfacet_baker::store::decode_exr(bytes);
});
