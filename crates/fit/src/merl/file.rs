//! The files of the MERL database: an isotropic reflectance over half and difference angles.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Display;
use std::io;
use std::path::Path;

use rayon::prelude::*;

use microfacet_baker::input::{self, MAX_TABLES};

use super::{HalfDifference, LIMIT_DEGREES};

/// Cells along θ_h, θ_d and φ_d, the last fastest.
pub(super) const DIMENSIONS: [usize; 3] = [90, 90, 180];
pub(super) const CELLS: usize = DIMENSIONS[0] * DIMENSIONS[1] * DIMENSIONS[2];
/// Bytes of a file: three 32-bit dimensions, then the channels red, green and blue in doubles.
pub const BYTES: usize = HEADER + 3 * 8 * CELLS;
const HEADER: usize = 3 * 4;
/// Factors from the numbers of each channel to reflectances in 1/sr.
const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
pub(super) const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The position of a value in its cell, from 0 to 1 along each axis.
///
/// The reader that comes with the database rounds an angle down to its cell, so that the value of
/// cell i stands for [i, i + 1), and is taken to be that of the middle, i + ½.
pub const MIDDLE: f64 = 0.5;

/// The largest accepted reflectance, in 1/sr: a mirror at the resolution of the format has less.
pub(super) const LARGEST: f64 = 1e9;
/// The smallest accepted mean reflectance, in 1/sr: the blackest paint has more.
pub(super) const DARKEST: f64 = 1e-5;

/// Errors of reading a file of the database and of fitting it.
#[derive(thiserror::Error)]
pub enum MerlError {
    /// The operating system's error.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The dimensions at the head of the file are not those of the database.
    #[error(
        "is no full-size MERL file: its first {HEADER} bytes give the dimensions {}, and must give \
         {}", by(.0), by(&DIMENSIONS)
    )]
    Dimensions([u32; 3]),
    /// The number of bytes does not match the dimensions.
    #[error(
        "has {0} bytes, and a MERL file of {cells} cells has {BYTES}; get it again, it is damaged",
        cells = by(&DIMENSIONS)
    )]
    Length(usize),
    /// A value that is NaN or above 1e9/sr: channel, cell and value.
    #[error(
        "{channel} at theta_h {}, theta_d {}, phi_d {} (cells from 0) is {x:e}/sr, and must be at \
         most {LARGEST:e}/sr; a negative number marks what was not measured",
        .1[0], .1[1], .1[2], channel = CHANNELS[*.0], x = .2
    )]
    Value(usize, [usize; 3], f64),
    /// A channel without any value at the angles of a fit.
    #[error(
        "{} has no value that is 0 or more where view and light are within {LIMIT_DEGREES} degrees \
         of the normal; nothing can be fitted to it", CHANNELS[*.0]
    )]
    Missing(usize),
    /// Every value at the angles of a fit is 0.
    #[error(
        "every value is 0 or missing: a material that reflects nothing has no highlight to fit"
    )]
    Black,
    /// The largest mean of a channel at the angles of a fit, in 1/sr, is below 1e-5.
    #[error(
        "the mean reflectance is {0:.1e}/sr, and must be at least {DARKEST:e}/sr: the values are \
         scaled otherwise than those of the database"
    )]
    Dark(f64),
    /// The minimiser's message.
    #[error("the minimiser failed: {0}")]
    Minimiser(String),
}

microfacet_core::debug_in_words!(MerlError);

fn by<T: Display>([h, d, p]: &[T; 3]) -> String {
    format!("{h} x {d} x {p}")
}

/// The angles of a cell's value; `place` as [`MIDDLE`]. The square root of θ_h is evenly spaced.
pub(super) fn angles([i, j, k]: [usize; 3], place: f64) -> HalfDifference {
    let along = |index: usize, axis: usize| (index as f64 + place) / DIMENSIONS[axis] as f64;
    HalfDifference {
        theta_h: FRAC_PI_2 * along(i, 0).powi(2),
        theta_d: FRAC_PI_2 * along(j, 1),
        phi_d: PI * along(k, 2),
    }
}

/// The index of a cell in a channel.
pub(super) fn index([i, j, k]: [usize; 3]) -> usize {
    (i * DIMENSIONS[1] + j) * DIMENSIONS[2] + k
}

/// The cell at an index in a channel.
pub(super) fn cell(index: usize) -> [usize; 3] {
    let [_, d, p] = DIMENSIONS;
    [index / (d * p), index / p % d, index % p]
}

/// A measured reflectance, in 1/sr; red, green, blue. Negative values are missing.
#[derive(Clone, Debug)]
pub struct Measured {
    pub(super) channels: [Vec<f64>; 3],
}

impl Measured {
    /// Reads a file of the database (Matusik et al. 2003, *A Data-Driven Reflectance Model*,
    /// doi:10.1145/882262.882343).
    ///
    /// # Errors
    /// [`MerlError::Io`], and as [`decode`](Self::decode).
    pub fn read(path: &Path) -> Result<Self, MerlError> {
        Self::decode(&input::read(path, MAX_TABLES)?)
    }

    /// Decodes the bytes of a file.
    ///
    /// # Errors
    /// [`MerlError::Dimensions`], [`MerlError::Length`] and [`MerlError::Value`].
    pub fn decode(bytes: &[u8]) -> Result<Self, MerlError> {
        let Some((header, values)) = bytes.split_at_checked(HEADER) else {
            return Err(MerlError::Length(bytes.len()));
        };
        let (header, _) = header.as_chunks();
        let dimensions = [0, 1, 2].map(|axis| u32::from_le_bytes(header[axis]));
        if dimensions.map(|n| n as usize) != DIMENSIONS {
            return Err(MerlError::Dimensions(dimensions));
        }
        if bytes.len() != BYTES {
            return Err(MerlError::Length(bytes.len()));
        }
        let (values, _) = values.as_chunks();
        let mut channels = [const { Vec::new() }; 3];
        for (channel, values) in values.chunks_exact(CELLS).enumerate() {
            let scaled = |value: &[u8; 8]| SCALES[channel] * f64::from_le_bytes(*value);
            let values: Vec<f64> = values.iter().map(scaled).collect();
            let taken = |x: &f64| (f64::MIN..=LARGEST).contains(x);
            if let Some(at) = values.iter().position(|x| !taken(x)) {
                return Err(MerlError::Value(channel, cell(at), values[at]));
            }
            channels[channel] = values;
        }
        Ok(Self { channels })
    }
}

/// The bytes of a file of the database that holds a reflectance (red, green, blue, in 1/sr; a
/// negative number where there is none), evaluated in each cell at `place` along each axis, see
/// [`MIDDLE`].
///
/// The reflectance is a function of the index of the cell in the file and its angles; it is called
/// in parallel and in no order.
pub fn encode(
    place: f64,
    reflectance: impl Fn(usize, HalfDifference) -> [f64; 3] + Sync,
) -> Vec<u8> {
    let one = |at| reflectance(at, angles(cell(at), place));
    let values: Vec<[f64; 3]> = (0..CELLS).into_par_iter().map(one).collect();
    let mut bytes = Vec::with_capacity(BYTES);
    DIMENSIONS.iter().for_each(|&n| bytes.extend((n as u32).to_le_bytes()));
    for (channel, scale) in SCALES.iter().enumerate() {
        values.iter().for_each(|rgb| bytes.extend((rgb[channel] / scale).to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made() -> Vec<u8> {
        encode(MIDDLE, |_, at| [at.theta_h, at.theta_d, at.phi_d])
    }

    #[test]
    fn values_come_back_where_they_were_put() {
        let bytes = made();
        assert_eq!(bytes.len(), 34_992_012);
        assert_eq!(bytes[..12], [90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0]);
        let read = Measured::decode(&bytes).unwrap();
        // The ends of every axis, and one between.
        let cells = [[0, 0, 0], [89, 89, 179], [89, 0, 0], [0, 89, 0], [0, 0, 179], [45, 30, 60]];
        for at in cells {
            assert_eq!(cell(index(at)), at);
            let HalfDifference { theta_h, theta_d, phi_d } = angles(at, MIDDLE);
            let found = read.channels.each_ref().map(|channel| channel[index(at)]);
            for (found, put) in found.into_iter().zip([theta_h, theta_d, phi_d]) {
                assert!((found / put - 1.0).abs() < 1e-15, "{at:?}");
            }
        }
        // The first cell of θ_h is narrow, and the last ends at the horizon.
        let degrees = |i: usize, place| angles([i, 0, 0], place).theta_h.to_degrees();
        assert!((degrees(1, 0.0) - 90.0 / 8100.0).abs() < 1e-15);
        assert_eq!((degrees(0, 0.0), degrees(89, 1.0)), (0.0, 90.0));
    }

    #[test]
    fn a_file_that_is_none_of_the_database_is_refused() {
        let message = |bytes: &[u8]| Measured::decode(bytes).unwrap_err().to_string();
        let bytes = made();
        assert!(message(&[]).contains("has 0 bytes"));
        assert!(message(&bytes[..11]).contains("has 11 bytes"));
        assert!(message(&bytes[..BYTES - 1]).contains("has 34992011 bytes"));
        assert!(message(&[&bytes[..], &[0]].concat()).contains("has 34992013 bytes"));
        let csv = message(b"theta,D\n0,10\n5,8.7\n");
        assert!(csv.contains("no full-size MERL"), "{csv}");
        let mut small = bytes.clone();
        small[8] = 90;
        assert!(message(&small).contains("90 x 90 x 90, and must give 90 x 90 x 180"));
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 1500.0 * LARGEST] {
            let mut broken = bytes.clone();
            let at = HEADER + 8 * (CELLS + index([2, 3, 4]));
            broken[at..at + 8].copy_from_slice(&x.to_le_bytes());
            let message = message(&broken);
            let place = "green at theta_h 2, theta_d 3, phi_d 4 (cells from 0) is ";
            assert!(message.starts_with(place) && message.contains("at most 1e9/sr"), "{message}");
        }
    }
}
