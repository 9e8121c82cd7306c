//! Ranges of the values in images.

use std::collections::HashMap;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageDecoder, ImageReader, Limits};

use microfacet_baker::input;
use microfacet_tables::Interval;

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
    let image = decode(bytes, left)?;
    let stride = usize::from(image.color().channel_count());
    let decode = |x: f64| match encoding {
        Encoding::Srgb if channel != Channel::Alpha => srgb_to_linear(x),
        _ => x,
    };
    // Integer samples go through a table: a power for each sample would take seconds.
    if let Some(samples) = image.as_flat_samples_u8() {
        let table: Vec<f64> = (0..=255u8).map(|i| decode(f64::from(i) / 255.0)).collect();
        range_of(samples.samples, stride, channel, |x| table[usize::from(x)])
    } else if let Some(samples) = image.as_flat_samples_u16() {
        let table: Vec<f64> = (0..=u16::MAX).map(|i| decode(f64::from(i) / 65535.0)).collect();
        range_of(samples.samples, stride, channel, |x| table[usize::from(x)])
    } else {
        let samples = image.as_flat_samples_f32().ok_or("has no samples")?;
        range_of(samples.samples, stride, channel, f64::from)
    }
}

fn decode(bytes: &[u8], left: &Budget) -> Result<DynamicImage, String> {
    let undecoded = |error| format!("cannot be decoded ({error})");
    let mut image = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| format!("cannot be read ({error})"))?;
    let mut allowed = Limits::default();
    allowed.max_alloc = Some(limits::IMAGE);
    image.limits(allowed);
    let decoder = image.into_decoder().map_err(undecoded)?;
    let size = decoder.total_bytes();
    if size > limits::IMAGE {
        let (width, height) = decoder.dimensions();
        return Err(format!(
            "has {width} x {height} pixels, which take more than {} MiB to decode",
            limits::IMAGE >> 20
        ));
    }
    charge(left, size).map_err(|why| format!("is not read ({why})"))?;
    DynamicImage::from_decoder(decoder).map_err(undecoded)
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

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, Rgb, Rgb32FImage, RgbImage};

    fn bytes(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        image.write_to(&mut file, format).unwrap();
        file.into_inner()
    }

    fn png() -> Vec<u8> {
        let mut image = RgbImage::from_pixel(3, 2, Rgb([51, 102, 255]));
        image.put_pixel(2, 1, Rgb([51, 204, 0]));
        bytes(&image.into(), ImageFormat::Png)
    }

    fn read(bytes: &[u8], channel: Channel, encoding: Encoding) -> Result<Interval, String> {
        super::range(bytes, channel, encoding, &Budget::new(limits::IMAGES))
    }

    #[test]
    fn each_channel_has_its_own_range() {
        let range = |channel| read(&png(), channel, Encoding::Linear).unwrap();
        assert_eq!(range(Channel::Red), Interval::point(0.2));
        assert_eq!(range(Channel::Green), Interval { min: 0.4, max: 0.8 });
        assert_eq!(range(Channel::Blue), Interval::UNIT);
        assert_eq!(range(Channel::Alpha), Interval::point(1.0));
        let luminance = range(Channel::Luminance);
        assert!((luminance.min - (0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722)).abs() < 1e-15);
        assert!((luminance.max - (0.2126 * 0.2 + 0.7152 * 0.8)).abs() < 1e-15);
    }

    #[test]
    fn srgb_is_decoded_where_it_is_meant() {
        let range = read(&png(), Channel::Green, Encoding::Srgb).unwrap();
        // 102/255 and 204/255 by the definition of sRGB.
        assert!((range.min - 0.132_868_321_553_817_97).abs() < 1e-15);
        assert!((range.max - 0.603_827_338_855_337_7).abs() < 1e-15);
    }

    #[test]
    fn floats_are_linear_already() {
        let mut image = Rgb32FImage::from_pixel(2, 2, Rgb([0.25, 0.5, 4.0]));
        image.put_pixel(0, 1, Rgb([0.75, 0.5, 4.0]));
        let exr = bytes(&image.into(), ImageFormat::OpenExr);
        let range = |channel| read(&exr, channel, Encoding::Srgb).unwrap();
        assert_eq!(range(Channel::Red), Interval { min: 0.25, max: 0.75 });
        assert_eq!(range(Channel::Blue), Interval::point(4.0));
    }

    #[test]
    fn what_is_no_image_is_said_to_be_none() {
        let error = read(b"no image", Channel::Red, Encoding::Linear).unwrap_err();
        assert!(error.contains("cannot be decoded"), "{error}");
        let absent = Path::new("absent.png");
        let read = |left: &Budget| file(absent, left);
        let error = Textures::default().range(absent, Channel::Red, Encoding::Linear, read);
        assert!(error.as_ref().is_err_and(|why| why.contains("cannot be read")), "{error:?}");
    }

    #[test]
    fn an_image_is_read_once_and_only_while_the_scene_may_have_more() {
        // What was read counts, also if it is no image.
        for (bytes, read_once) in [(png(), true), (b"no image".repeat(11), false)] {
            let mut textures = Textures { left: Budget::new(200), ..Textures::default() };
            let mut range = |key: usize| {
                let read = |left: &Budget| charge(left, bytes.len() as u64).map(|()| bytes.clone());
                textures.range(Path::new(&"x".repeat(key)), Channel::Red, Encoding::Linear, read)
            };
            assert!(bytes.len() < 100);
            for _ in 0..9 {
                assert_eq!(range(1).is_ok(), read_once);
            }
            let errors: Vec<String> = (2..9).filter_map(|key| range(key).err()).collect();
            assert!(errors.iter().any(|error| error.contains("come to more than")), "{errors:?}");
        }
    }

    #[test]
    fn the_size_of_an_image_is_known_before_it_is_decoded() {
        // A PNG that claims 100 000 by 100 000 pixels, and has none.
        let mut bytes = png();
        bytes[16..24].copy_from_slice(&[0, 1, 0x86, 0xA0, 0, 1, 0x86, 0xA0]);
        let mut sum = flate2::Crc::new();
        sum.update(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&sum.sum().to_be_bytes());
        let error = read(&bytes, Channel::Red, Encoding::Linear).unwrap_err();
        assert!(error.contains("100000 x 100000 pixels"), "{error}");
    }
}
