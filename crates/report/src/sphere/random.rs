//! The random numbers of a sample: a Kronecker sequence with a random offset for each pixel.
//!
//! Number k of sample i is (r_k + i a_k) mod 1. a_k is the fractional part of the root of a prime
//! (Richtmyer 1951); these are independent over the rationals. r_k follows from the pixel and a
//! seed by pcg3d (Jarzynski & Olano 2020, <https://jcgt.org/published/0009/03/02/>). The arithmetic
//! is in integers, so that `sphere.frag` gets the same numbers.

use std::fmt::Write;

/// Numbers of a sample, in threes; the last is not used.
pub(super) const COUNT: usize = 9;

/// Fractional parts of √2, √3, √5 … √23 as 32 bits.
const STEPS: [u32; COUNT] = [
    0x6a09_e667,
    0xbb67_ae85,
    0x3c6e_f372,
    0xa54f_f53a,
    0x510e_527f,
    0x9b05_688c,
    0x1f83_d9ab,
    0x5be0_cd19,
    0xcbbb_9d5d,
];

/// The numbers of a sample of a pixel, each in [0, 1).
pub(super) fn numbers([x, y]: [u32; 2], seed: u32, sample: u32) -> [f32; COUNT] {
    let mut numbers = [0.0; COUNT];
    for (i, three) in numbers.chunks_mut(3).enumerate() {
        let turn = pcg3d([x, y, seed.wrapping_mul(3).wrapping_add(i as u32)]);
        for (j, number) in three.iter_mut().enumerate() {
            let whole = turn[j].wrapping_add(sample.wrapping_mul(STEPS[3 * i + j]));
            *number = (whole >> 8) as f32 / (1 << 24) as f32;
        }
    }
    numbers
}

fn pcg3d(v: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = v.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mix = |x: &mut u32, y: &mut u32, z: &mut u32| {
        *x = x.wrapping_add(y.wrapping_mul(*z));
        *y = y.wrapping_add(z.wrapping_mul(*x));
        *z = z.wrapping_add(x.wrapping_mul(*y));
    };
    mix(&mut x, &mut y, &mut z);
    [x, y, z] = [x, y, z].map(|v| v ^ (v >> 16));
    mix(&mut x, &mut y, &mut z);
    [x, y, z]
}

pub(super) fn constants() -> String {
    let mut text = String::new();
    for (i, [a, b, c]) in STEPS.as_chunks::<3>().0.iter().enumerate() {
        writeln!(text, "const uvec3 STEPS_{i} = uvec3({a}u, {b}u, {c}u);").expect("memory");
    }
    text
}
