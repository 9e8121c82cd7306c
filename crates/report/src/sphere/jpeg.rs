//! Pictures as JPEG: baseline, with full resolution of all three components (ITU-T T.81). The
//! crates that write it bring a whole library of images, or a licence that asks for a notice.

use std::array;
use std::f64::consts::PI;

/// Quantization of luminance and of chrominance at quality 50 (annex K.1), by rows; chrominance has
/// 99 from its fifth row on.
const QUANTA: [&[u8]; 2] = [
    &[
        16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69,
        56, 14, 17, 22, 29, 51, 87, 80, 62, 18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81,
        104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99,
    ],
    &[
        17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99, 99,
        99, 47, 66, 99, 99, 99, 99, 99, 99,
    ],
];

/// Percent of them at quality 90, as libjpeg counts it.
const SCALE: u32 = 20;

/// How many Huffman codes have 1 to 16 bits, and their first symbols; the rest follow in order
/// (annex K.3): of means of luminance and chrominance, and of what varies in both.
const CODES: [([u8; 16], &[u8]); 4] = [
    ([0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0], b""),
    ([0, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0], b""),
    (
        [0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 125],
        b"\x01\x02\x03\x00\x04\x11\x05\x12\x21\x31\x41\x06\x13\x51\x61\x07\x22\x71\x14\x32\x81\x91\
          \xA1\x08\x23\x42\xB1\xC1\x15\x52\xD1\xF0\x24\x33\x62\x72\x82",
    ),
    (
        [0, 2, 1, 2, 4, 4, 3, 4, 7, 5, 4, 4, 0, 1, 2, 119],
        b"\x00\x01\x02\x03\x11\x04\x05\x21\x31\x06\x12\x41\x51\x07\x61\x71\x13\x22\x32\x81\x08\x14\
          \x42\x91\xA1\xB1\xC1\x09\x23\x33\x52\xF0\x15\x62\x72\xD1\x0A\x16\x24\x34\xE1\x25\xF1",
    ),
];

/// No more coefficients of a block differ from 0.
const END: u8 = 0x00;
/// Sixteen that are 0.
const ZEROS: u8 = 0xF0;

/// A picture of quality 90, whole lines of `width` pixels.
pub(super) fn encode(pixels: &[[u8; 3]], width: usize) -> Vec<u8> {
    let height = pixels.len() / width;
    let order = zigzag();
    let quanta = QUANTA.map(|table| {
        let at = |i| table.get(i).map_or(99, |&q| u32::from(q));
        array::from_fn::<u8, 64, _>(|i| ((at(i) * SCALE + 50) / 100).max(1) as u8)
    });
    let mut file = vec![0xFF, 0xD8];
    segment(&mut file, 0xE0, b"JFIF\0\x01\x01\0\0\x01\0\x01\0\0");
    for (id, table) in quanta.iter().enumerate() {
        segment(&mut file, 0xDB, &[&[id as u8][..], &order.map(|i| table[i])].concat());
    }
    let size = [height, width].map(|n| (n as u16).to_be_bytes());
    let components = [3, 1, 0x11, 0, 2, 0x11, 1, 3, 0x11, 1];
    segment(&mut file, 0xC0, &[&[8][..], size.as_flattened(), &components].concat());
    for (i, (counts, _)) in CODES.iter().enumerate() {
        let id = [0x00, 0x01, 0x10, 0x11][i];
        segment(&mut file, 0xC4, &[&[id][..], counts, &symbols(i)].concat());
    }
    segment(&mut file, 0xDA, &[3, 1, 0x00, 2, 0x11, 3, 0x11, 0, 63, 0]);

    let codes: [_; 4] = array::from_fn(codes);
    let waves = waves();
    let mut bits = Bits { file, pending: 0, count: 0 };
    let mut means = [0; 3];
    for (y, x) in (0..height).step_by(8).flat_map(|y| (0..width).step_by(8).map(move |x| (y, x))) {
        let block: [[f32; 3]; 64] = array::from_fn(|i| {
            let [y, x] = [(y + i / 8).min(height - 1), (x + i % 8).min(width - 1)];
            to_ycc(pixels[y * width + x])
        });
        for (component, mean) in means.iter_mut().enumerate() {
            let kind = component.min(1);
            let frequencies = transform(&waves, &block.map(|p| p[component]));
            let rounded: [i32; 64] =
                array::from_fn(|i| (frequencies[i] / f32::from(quanta[kind][i])).round() as i32);
            bits.block(&order.map(|i| rounded[i]), mean, [&codes[kind], &codes[2 + kind]]);
        }
    }
    bits.put(0x7F, 7);
    bits.file.extend([0xFF, 0xD9]);
    bits.file
}

fn segment(file: &mut Vec<u8>, marker: u8, contents: &[u8]) {
    file.extend([0xFF, marker]);
    file.extend((contents.len() as u16 + 2).to_be_bytes());
    file.extend(contents);
}

/// Places of a block from the lowest frequency to the highest.
fn zigzag() -> [usize; 64] {
    let mut order = array::from_fn(|i| i);
    order.sort_by_key(|i| {
        let [y, x] = [i / 8, i % 8];
        (x + y, if (x + y) % 2 == 0 { x } else { y })
    });
    order
}

/// JFIF's luminance and chrominances, from -128.
fn to_ycc(rgb: [u8; 3]) -> [f32; 3] {
    let [r, g, b] = rgb.map(f32::from);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    [y - 128.0, (b - y) / 1.772, (r - y) / 1.402]
}

/// The orthonormal cosines of eight places, by frequency.
fn waves() -> [[f32; 8]; 8] {
    array::from_fn(|u| {
        let norm = if u == 0 { 0.125_f64.sqrt() } else { 0.5 };
        array::from_fn(|x| (norm * libm::cos((2 * x + 1) as f64 * u as f64 * PI / 16.0)) as f32)
    })
}

/// The discrete cosine transform of a block (annex A.3.3).
fn transform(waves: &[[f32; 8]; 8], block: &[f32; 64]) -> [f32; 64] {
    let along = |block: &[f32; 64]| {
        array::from_fn(|i| (0..8).map(|x| waves[i % 8][x] * block[i / 8 * 8 + x]).sum())
    };
    let turned = |block: [f32; 64]| array::from_fn(|i| block[i % 8 * 8 + i / 8]);
    turned(along(&turned(along(block))))
}

/// The symbols of a Huffman table, from the shortest code to the longest: bits of a mean, or zeros
/// in front of a coefficient times 16 and its bits.
fn symbols(table: usize) -> Vec<u8> {
    let all: Vec<u8> = match table {
        0 | 1 => (0..12).collect(),
        _ => (0..=255).filter(|s| matches!(s & 15, 1..=10) || [END, ZEROS].contains(s)).collect(),
    };
    let first = CODES[table].1;
    [first, &all.into_iter().filter(|s| !first.contains(s)).collect::<Vec<_>>()].concat()
}

/// Code and length of each symbol (annex C).
fn codes(table: usize) -> [(u32, u32); 256] {
    let mut codes = [(0, 0); 256];
    let mut symbols = symbols(table).into_iter();
    let mut code = 0;
    for (length, &count) in (1..).zip(&CODES[table].0) {
        for symbol in symbols.by_ref().take(usize::from(count)) {
            codes[usize::from(symbol)] = (code, length);
            code += 1;
        }
        code <<= 1;
    }
    codes
}

/// A file that is written bit by bit.
struct Bits {
    file: Vec<u8>,
    pending: u32,
    count: u32,
}

impl Bits {
    /// Adds the low bits of a number, at most 16, and the byte 0 behind each of 255.
    fn put(&mut self, bits: u32, count: u32) {
        self.pending = self.pending << count | bits;
        self.count += count;
        while self.count >= 8 {
            self.count -= 8;
            let byte = (self.pending >> self.count) as u8;
            self.file.push(byte);
            if byte == 0xFF {
                self.file.push(0);
            }
        }
    }

    /// Adds a symbol, `run` and the number of bits of `x`, and these.
    fn number(&mut self, codes: &[(u32, u32); 256], run: u32, x: i32) {
        let count = 32 - x.unsigned_abs().leading_zeros();
        let (code, length) = codes[(run << 4 | count) as usize];
        self.put(code, length);
        let below = if x < 0 { x - 1 } else { x };
        self.put(below as u32 & ((1 << count) - 1), count);
    }

    /// Adds the coefficients of a block in zigzag order (annex F.1.2).
    fn block(&mut self, block: &[i32; 64], mean: &mut i32, codes: [&[(u32, u32); 256]; 2]) {
        self.number(codes[0], 0, block[0] - *mean);
        *mean = block[0];
        let mut zeros = 0;
        for &x in &block[1..] {
            if x == 0 {
                zeros += 1;
                continue;
            }
            for _ in 0..zeros / 16 {
                let (code, length) = codes[1][usize::from(ZEROS)];
                self.put(code, length);
            }
            self.number(codes[1], zeros % 16, x);
            zeros = 0;
        }
        if zeros > 0 {
            let (code, length) = codes[1][usize::from(END)];
            self.put(code, length);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture with edges, slopes and noise, decoded, is what it was but for rounding.
    #[test]
    fn a_decoder_sees_the_picture() {
        for [width, height] in [[64, 48], [61, 43], [1, 1], [8, 9]] {
            let mut noise = 1_u32;
            let pixels: Vec<[u8; 3]> = (0..width * height)
                .map(|i| {
                    noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let [x, y] = [i % width, i / width];
                    let edge = if x > 20 && y > 9 { 255 } else { 3 * x as u8 };
                    [edge, 4 * y as u8, 100 + (noise >> 29) as u8]
                })
                .collect();
            let file = encode(&pixels, width);
            let mut decoder = zune_jpeg::JpegDecoder::new(
                zune_jpeg::zune_core::bytestream::ZCursor::new(&file[..]),
            );
            let read = decoder.decode().unwrap();
            assert_eq!(decoder.dimensions(), Some((width, height)));
            let squares = read.iter().zip(pixels.as_flattened()).map(|(&a, &b)| {
                let difference = f64::from(a) - f64::from(b);
                difference * difference
            });
            let rms = (squares.sum::<f64>() / read.len() as f64).sqrt();
            assert!(rms < 3.0, "{width} x {height}: {rms}");
        }
    }

    #[test]
    fn tables_have_as_many_symbols_as_codes() {
        for (i, (counts, _)) in CODES.iter().enumerate() {
            let count = counts.iter().map(|&n| usize::from(n)).sum::<usize>();
            assert_eq!(symbols(i).len(), count);
        }
    }
}
