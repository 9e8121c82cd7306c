//! Ranges of the values in images.

mod decode;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use microfacet_baker::input;
use microfacet_tables::Interval;

use self::decode::{Pixels, Samples, decode};
use crate::limits::{self, Budget};

/// The number of a pixel to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Channel {
    /// Red, or grey.
    Red,
    /// Green, or grey.
    Green,
    /// Blue, or grey.
    Blue,
    /// Opacity; 1 in an image without it.
    Alpha,
    /// The luminance of linear sRGB, or grey.
    Luminance,
    /// Opacity if a pixel has another than 1; else the mean of red, green and blue, or grey. It is
    /// pbrt's reading of a float image, which takes opacity for encoded like the colours.
    AlphaOrMean,
}

/// Encoding of the numbers of an integer image. Images of floats are always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Encoding {
    /// Proportional to the value.
    Linear,
    /// The sRGB transfer function (IEC 61966-2-1); not applied to [`Channel::Alpha`].
    Srgb,
}

/// Ranges of images, each read once for a channel, until they come to [`limits::IMAGES`].
pub(super) struct Textures {
    ranges: HashMap<(PathBuf, Channel, Encoding), Result<Interval, String>>,
    left: Budget,
}

impl Default for Textures {
    fn default() -> Self {
        Self { ranges: HashMap::new(), left: Budget::new(limits::IMAGES) }
    }
}

impl Textures {
    /// The smallest interval that holds the values of all pixels; filtering stays inside it.
    ///
    /// `read` gives the bytes of the image that `key` stands for, and takes from the budget what it
    /// reads for them. The error completes the sentence "texture x ...".
    pub(super) fn range(
        &mut self,
        key: &Path,
        channel: Channel,
        encoding: Encoding,
        read: impl FnOnce(&Budget) -> io::Result<Vec<u8>>,
    ) -> Result<Interval, String> {
        let compute = || {
            let bytes = read(&self.left).map_err(|error| format!("cannot be read ({error})"))?;
            range(&bytes, channel, encoding, &self.left)
        };
        self.ranges.entry((key.to_owned(), channel, encoding)).or_insert_with(compute).clone()
    }
}

/// Reads an image file.
pub(super) fn file(path: &Path, left: &Budget) -> io::Result<Vec<u8>> {
    let bytes = input::read(path, limits::IMAGE)?;
    charge(left, bytes.len() as u64)?;
    Ok(bytes)
}

/// Takes bytes that were read for an image, or decoded from it, from what all images may come to.
pub(super) fn charge(left: &Budget, bytes: u64) -> io::Result<()> {
    if left.take(bytes) {
        return Ok(());
    }
    let why = format!("the images of the scene come to more than {} GiB", limits::IMAGES >> 30);
    Err(io::Error::new(io::ErrorKind::FileTooLarge, why))
}

/// As [`Textures::range`], for the bytes of an image.
fn range(
    bytes: &[u8],
    channel: Channel,
    encoding: Encoding,
    left: &Budget,
) -> Result<Interval, String> {
    let Pixels { stride, samples } = decode(bytes, left)?;
    let decode = |x: f64| match encoding {
        Encoding::Srgb if channel != Channel::Alpha => srgb_to_linear(x),
        _ => x,
    };
    // Integer samples go through a table: a power for each sample would take seconds.
    match samples {
        Samples::Eight(samples) => {
            let table: Vec<f64> = (0..=255u8).map(|i| decode(f64::from(i) / 255.0)).collect();
            range_of(&samples, stride, channel, |x| table[usize::from(x)])
        }
        Samples::Sixteen(samples) => {
            let table: Vec<f64> = (0..=u16::MAX).map(|i| decode(f64::from(i) / 65535.0)).collect();
            let value = |x| table[usize::from(u16::from_be_bytes(x))];
            range_of(samples.as_chunks().0, stride, channel, value)
        }
        Samples::Floats(samples) => range_of(&samples, stride, channel, f64::from),
    }
}

/// The range of a channel of samples that `value` decodes, in pixels of `stride` samples.
fn range_of<T: Copy>(
    samples: &[T],
    stride: usize,
    channel: Channel,
    value: impl Fn(T) -> f64,
) -> Result<Interval, String> {
    let grey = stride < 3;
    let has_alpha = stride.is_multiple_of(2);
    let pixels = samples.chunks_exact(stride);
    let of_channel = |index: usize| Interval::hull(pixels.clone().map(|p| value(p[index])));
    match channel {
        Channel::Alpha if has_alpha => of_channel(stride - 1),
        Channel::Alpha => Some(Interval::point(1.0)),
        Channel::Green if !grey => of_channel(1),
        Channel::Blue if !grey => of_channel(2),
        Channel::Luminance if !grey => Interval::hull(
            pixels.map(|p| 0.2126 * value(p[0]) + 0.7152 * value(p[1]) + 0.0722 * value(p[2])),
        ),
        Channel::AlphaOrMean
            if !grey && has_alpha && pixels.clone().any(|p| value(p[3]) != 1.0) =>
        {
            of_channel(3)
        }
        Channel::AlphaOrMean if !grey => {
            Interval::hull(pixels.map(|p| (value(p[0]) + value(p[1]) + value(p[2])) / 3.0))
        }
        _ => of_channel(0),
    }
    .ok_or_else(|| "is empty or holds NaN".to_owned())
}

/// IEC 61966-2-1. The `libm` power keeps the roughness, and so the tables, equal on every system.
fn srgb_to_linear(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { libm::pow((x + 0.055) / 1.055, 2.4) }
}
