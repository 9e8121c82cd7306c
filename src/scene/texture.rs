//! Ranges of the values in images.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageReader};

use super::Interval;

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
}

/// Encoding of the numbers of an integer image. Images of floats are always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Encoding {
    /// Proportional to the value.
    Linear,
    /// The sRGB transfer function (IEC 61966-2-1); never applied to opacity.
    Srgb,
}

/// Ranges of image files, each read once.
#[derive(Default)]
pub(super) struct Textures(HashMap<(PathBuf, Channel, Encoding), Result<Interval, String>>);

impl Textures {
    /// The smallest interval that holds the values of all pixels; filtering stays inside it.
    ///
    /// The error completes the sentence "texture x ...".
    pub(super) fn range(
        &mut self,
        file: &Path,
        channel: Channel,
        encoding: Encoding,
    ) -> Result<Interval, String> {
        self.0
            .entry((file.to_owned(), channel, encoding))
            .or_insert_with(|| {
                let image = ImageReader::open(file)
                    .and_then(ImageReader::with_guessed_format)
                    .map_err(|error| format!("cannot be read ({error})"))?;
                range(image, channel, encoding)
            })
            .clone()
    }
}

/// As [`Textures::range`], for an image file in memory.
pub(super) fn range_of_bytes(
    bytes: &[u8],
    channel: Channel,
    encoding: Encoding,
) -> Result<Interval, String> {
    let image = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| format!("cannot be read ({error})"))?;
    range(image, channel, encoding)
}

fn range<R: std::io::BufRead + std::io::Seek>(
    image: ImageReader<R>,
    channel: Channel,
    encoding: Encoding,
) -> Result<Interval, String> {
    let image = image.decode().map_err(|error| format!("cannot be decoded ({error})"))?;
    let stride = usize::from(image.color().channel_count());
    let pixels = Pixels { channel, stride };
    let decode = |x: f64| match encoding {
        Encoding::Srgb if channel != Channel::Alpha => srgb_to_linear(x),
        _ => x,
    };
    // Integer samples go through a table: a power for each sample would take seconds.
    if let Some(samples) = image.as_flat_samples_u8() {
        let table: Vec<f64> = (0..=255u8).map(|i| decode(f64::from(i) / 255.0)).collect();
        pixels.range(samples.samples, |x| table[usize::from(x)])
    } else if let Some(samples) = image.as_flat_samples_u16() {
        let table: Vec<f64> = (0..=u16::MAX).map(|i| decode(f64::from(i) / 65535.0)).collect();
        pixels.range(samples.samples, |x| table[usize::from(x)])
    } else {
        let image = DynamicImage::from(image.to_rgba32f());
        let samples = image.as_flat_samples_f32().ok_or("has no samples")?;
        Pixels { channel, stride: 4 }.range(samples.samples, f64::from)
    }
}

struct Pixels {
    channel: Channel,
    stride: usize,
}

impl Pixels {
    fn range<T: Copy>(&self, samples: &[T], value: impl Fn(T) -> f64) -> Result<Interval, String> {
        let grey = self.stride < 3;
        let has_alpha = self.stride.is_multiple_of(2);
        let pixels = samples.chunks_exact(self.stride);
        let of_channel = |index: usize| Interval::hull(pixels.clone().map(|p| value(p[index])));
        match self.channel {
            Channel::Alpha if has_alpha => of_channel(self.stride - 1),
            Channel::Alpha => Some(Interval::point(1.0)),
            Channel::Green if !grey => of_channel(1),
            Channel::Blue if !grey => of_channel(2),
            Channel::Luminance if !grey => Interval::hull(
                pixels.map(|p| 0.2126 * value(p[0]) + 0.7152 * value(p[1]) + 0.0722 * value(p[2])),
            ),
            _ => of_channel(0),
        }
        .ok_or_else(|| "is empty or holds NaN".to_owned())
    }
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

    #[test]
    fn each_channel_has_its_own_range() {
        let range = |channel| range_of_bytes(&png(), channel, Encoding::Linear).unwrap();
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
        let range = range_of_bytes(&png(), Channel::Green, Encoding::Srgb).unwrap();
        // 102/255 and 204/255 by the definition of sRGB.
        assert!((range.min - 0.132_868_321_553_817_97).abs() < 1e-15);
        assert!((range.max - 0.603_827_338_855_337_7).abs() < 1e-15);
    }

    #[test]
    fn floats_are_linear_already() {
        let mut image = Rgb32FImage::from_pixel(2, 2, Rgb([0.25, 0.5, 4.0]));
        image.put_pixel(0, 1, Rgb([0.75, 0.5, 4.0]));
        let exr = bytes(&image.into(), ImageFormat::OpenExr);
        let range = |channel| range_of_bytes(&exr, channel, Encoding::Srgb).unwrap();
        assert_eq!(range(Channel::Red), Interval { min: 0.25, max: 0.75 });
        assert_eq!(range(Channel::Blue), Interval::point(4.0));
    }

    #[test]
    fn what_is_no_image_is_said_to_be_none() {
        let error = range_of_bytes(b"no image", Channel::Red, Encoding::Linear).unwrap_err();
        assert!(error.contains("cannot be decoded"), "{error}");
        let mut textures = Textures::default();
        let error =
            textures.range(Path::new("absent.png"), Channel::Red, Encoding::Linear).unwrap_err();
        assert!(error.contains("cannot be read"), "{error}");
    }
}
