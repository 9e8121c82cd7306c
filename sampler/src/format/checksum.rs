//! The checksum of a set: eight hexadecimal digits in its document, a CRC-32 taken over everything with these digits as zeros, so
//! that a damaged shape or axis is found like a damaged value.

use alloc::format;

/// What precedes the digits in a document.
const IN_DOCUMENT: &[u8] = br#""checksum":""#;
/// And in the header of a safetensors file, where the document is a JSON string inside JSON.
const IN_HEADER: &[u8] = br#"\"checksum\":\""#;

/// The digits of a document that is not sealed.
pub(super) const NONE: &str = "00000000";
const DIGITS: usize = NONE.len();

/// Where the digits stand.
fn position(bytes: &[u8], prefix: &[u8]) -> Option<usize> {
    let at = bytes.windows(prefix.len()).position(|window| window == prefix)? + prefix.len();
    (at + DIGITS <= bytes.len()).then_some(at)
}

/// CRC-32 (ISO-HDLC) of the bytes with the digits at `at` as zeros.
fn digits(bytes: &[u8], at: usize) -> [u8; DIGITS] {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&bytes[..at]);
    hasher.update(NONE.as_bytes());
    hasher.update(&bytes[at + DIGITS..]);
    let text = format!("{:08x}", hasher.finalize());
    text.as_bytes().try_into().expect("32 bits are eight digits")
}

fn fill(bytes: &mut [u8], prefix: &[u8]) -> bool {
    let Some(at) = position(bytes, prefix) else { return false };
    let digits = digits(bytes, at);
    bytes[at..at + DIGITS].copy_from_slice(&digits);
    true
}

/// Fills in the checksum of a safetensors file, whatever it was before: for tools that edit files. False if there is no place
/// for it.
pub fn seal(file: &mut [u8]) -> bool {
    fill(file, IN_HEADER)
}

/// The same for a document followed by the values it describes, as little-endian f32 in table order: what an image carries.
pub fn seal_document(document_and_values: &mut [u8]) -> bool {
    fill(document_and_values, IN_DOCUMENT)
}

/// Whether the checksum of a safetensors file is that of its bytes; `None` if it has none.
pub(super) fn is_sealed(file: &[u8]) -> Option<bool> {
    let at = position(file, IN_HEADER)?;
    Some(digits(file, at) == file[at..at + DIGITS])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flipped_bit_is_seen() {
        let mut file = br#"12345678{"a":"{\"checksum\":\"deadbeef\",\"b\":1}"} values"#.to_vec();
        assert_eq!(is_sealed(&file), Some(false));
        assert!(seal(&mut file) && is_sealed(&file) == Some(true));
        for bit in 0..8 * file.len() {
            file[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(is_sealed(&file), Some(true), "bit {bit}");
            file[bit / 8] ^= 1 << (bit % 8);
        }
    }

    #[test]
    fn there_is_a_place_or_none() {
        let mut document = br#"{"checksum":"00000000"}1234"#.to_vec();
        assert!(!seal(&mut document) && seal_document(&mut document) && document[13..21] != *b"00000000");
        assert_eq!(is_sealed(br#"\"checksum\":\"1234"#), None);
    }
}
