//! The checksum of a set: a CRC-32 over the whole file, header included, so that a damaged shape or
//! axis is found like a damaged value. Its own eight hexadecimal digits, in the document, count as
//! zeros.

use alloc::format;
use alloc::string::String;
use core::iter;

/// The bytes before the digits in a document.
const IN_DOCUMENT: &[u8] = br#""checksum":""#;
/// The bytes before the digits in the header of a safetensors file, where the document is a JSON
/// string inside JSON.
const IN_HEADER: &[u8] = br#"\"checksum\":\""#;

/// The digits of an unsealed document.
pub(super) const NONE: &str = "00000000";
const DIGITS: usize = NONE.len();

/// The offset of the digits, which follow `prefix`.
fn position(head: &[u8], prefix: &[u8]) -> Option<usize> {
    let at = head.windows(prefix.len()).position(|window| window == prefix)? + prefix.len();
    (at + DIGITS <= head.len()).then_some(at)
}

/// The offset of the digits in a safetensors file: in its header, whose length is the first eight
/// bytes.
fn position_in_file(file: &[u8]) -> Option<usize> {
    let header = u64::from_le_bytes(file.get(..8)?.try_into().ok()?);
    position(file.get(..usize::try_from(header).ok()?.checked_add(8)?)?, IN_HEADER)
}

/// CRC-32 (ISO-HDLC) of the bytes and of `more`, with the digits at `at` taken as zeros.
fn digits(bytes: &[u8], at: usize, more: impl Iterator<Item = [u8; 4]>) -> [u8; DIGITS] {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&bytes[..at]);
    hasher.update(NONE.as_bytes());
    hasher.update(&bytes[at + DIGITS..]);
    more.for_each(|bytes| hasher.update(&bytes));
    let text = format!("{:08x}", hasher.finalize());
    text.as_bytes().try_into().expect("32 bits are eight digits")
}

/// The CRC-32 (ISO-HDLC) of some bytes as eight hexadecimal digits.
pub fn crc32(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

/// Fills in the checksum of a safetensors file, for tools that edit files; false if the file has no
/// `checksum` entry.
pub fn seal(file: &mut [u8]) -> bool {
    let Some(at) = position_in_file(file) else { return false };
    let digits = digits(file, at, iter::empty());
    file[at..at + DIGITS].copy_from_slice(&digits);
    true
}

/// Whether the checksum of a safetensors file matches its bytes; `None` if it has none.
pub(super) fn is_sealed(file: &[u8]) -> Option<bool> {
    let at = position_in_file(file)?;
    Some(digits(file, at, iter::empty()) == file[at..at + DIGITS])
}

/// The document of an OpenEXR image, with its checksum over the document and the values that it
/// describes, as little-endian f32 in table order; `None` if it has no `checksum` entry.
pub fn seal_document<'a>(
    document: &str,
    values: impl IntoIterator<Item = &'a f32>,
) -> Option<String> {
    let at = position(document.as_bytes(), IN_DOCUMENT)?;
    let values = values.into_iter().map(|x| x.to_le_bytes());
    let digits = digits(document.as_bytes(), at, values);
    let digits = core::str::from_utf8(&digits).expect("hexadecimal digits are ASCII");
    // In a damaged document the digits may begin or end inside a character.
    Some(format!("{}{digits}{}", document.get(..at)?, document.get(at + DIGITS..)?))
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    /// A header and values, as in a file.
    fn file(header: &str, values: &[u8]) -> Vec<u8> {
        [&(header.len() as u64).to_le_bytes()[..], header.as_bytes(), values].concat()
    }

    #[test]
    fn every_flipped_bit_is_seen() {
        let mut file = file(r#"{"a":"{\"checksum\":\"deadbeef\",\"b\":1}"}"#, b"values");
        assert_eq!(is_sealed(&file), Some(false));
        assert!(seal(&mut file) && is_sealed(&file) == Some(true));
        // The checksum is that of the file with zeros instead of the digits.
        let at = position_in_file(&file).unwrap();
        let mut zeroed = file.clone();
        zeroed[at..at + DIGITS].fill(b'0');
        assert_eq!(file[at..at + DIGITS], *crc32(&zeroed).as_bytes());
        for bit in 0..8 * file.len() {
            file[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(is_sealed(&file), Some(true), "bit {bit}");
            file[bit / 8] ^= 1 << (bit % 8);
        }
    }

    #[test]
    fn a_document_is_sealed_with_its_values() {
        let sealed = seal_document(r#"{"checksum":"00000000"}"#, &[1.0, 2.0]).unwrap();
        assert!(!sealed.contains("00000000"));
        assert_eq!(seal_document(&sealed, &[1.0, 2.0]), Some(sealed.clone()));
        assert_ne!(seal_document(&sealed, &[1.0, 2.5]), Some(sealed));
    }

    #[test]
    fn what_looks_like_a_checksum_elsewhere_is_none() {
        let digits = br#"\"checksum\":\"00000000"#;
        assert_eq!(is_sealed(&file("{}", digits)), None);
        assert!(!seal(&mut file("{}", digits)) && !seal(&mut digits.to_vec()));
        assert_eq!(seal_document("{}", &[f32::from_le_bytes(*b"\"che")]), None);
    }
}
