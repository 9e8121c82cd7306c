//! Sets, tables and materials in words, for commands and pages. Texts from files are repeated
//! unchanged; [`microfacet_baker::escape`] makes them safe where they are shown.

pub mod certificate;
pub mod command;
pub mod material;
pub mod table;
pub mod verdict;

use bytesize::ByteSize;

/// A number to seven digits, without the rounding of coordinates: `0.3`, `1e-8`, `inf`.
pub fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    match rounded.abs() {
        1e-3..1e7 | 0.0 | f64::INFINITY => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

/// A range of numbers: `3`, or `1.501 to inf`.
pub fn range(ends: impl Into<[f64; 2]>) -> String {
    let [min, max] = ends.into().map(number);
    if min == max { min } else { format!("{min} to {max}") }
}

/// An error with all the digits of a certificate, which are rounded up.
pub fn error(x: f64) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:.2e}") }
}

/// A number of bytes to three digits: `29.2 kB`.
pub fn bytes(count: usize) -> String {
    // 1, 2 or 3 digits stand before the point.
    let decimals = 2 - count.max(1).ilog10() as usize % 3;
    format!("{:.decimals$}", ByteSize(count as u64).display().si())
}

/// A number of bytes to three digits, and exactly: `29.2 kB (29232 bytes)`.
pub fn exact_bytes(count: usize) -> String {
    if count < 1000 {
        format!("{count} bytes")
    } else {
        format!("{} ({count} bytes)", bytes(count))
    }
}

/// A count of things: `1 table`, `3 tables`.
pub fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// Items joined as in a sentence: `a, b and c`.
pub fn joined(items: &[String]) -> String {
    match items {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => items.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_seven_digits_and_no_zeros_behind() {
        let numbers = [
            (0.3, "0.3"),
            (0.3999999999999999, "0.4"),
            (1.25e-8, "1.25e-8"),
            (0.0, "0"),
            (-0.002, "-0.002"),
            (491.50099405466847, "491.501"),
            (1e9, "1e9"),
            (f64::INFINITY, "inf"),
        ];
        for (x, text) in numbers {
            assert_eq!(number(x), text);
        }
        assert_eq!(range([1.501, f64::INFINITY]), "1.501 to inf");
        assert_eq!(range([0.4, 0.39999999999999]), "0.4");
    }

    #[test]
    fn sizes_have_their_units() {
        assert_eq!(exact_bytes(29232), "29.2 kB (29232 bytes)");
        assert_eq!(exact_bytes(612), "612 bytes");
        assert_eq!([0, 999, 462_672, 1_563_743].map(bytes), ["0 B", "999 B", "463 kB", "1.56 MB"]);
    }
}
