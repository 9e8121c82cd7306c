//! A power of numbers q ≥ 1 by the bits of q.
//!
//! The first bits of the mantissa select a cubic, which interpolates the power over 1/64 of an
//! octave, and the exponent a factor. That takes half the time of a logarithm and an exponential,
//! of which each waits for the other's last step.

use alloc::boxed::Box;

use microfacet_tables::axis::hermite::{Cell, cubic};

/// Cells of an octave, evenly over [1, 2).
const CELLS: usize = 64;

/// Bits of the mantissa within a cell.
const WITHIN: u32 = f32::MANTISSA_DIGITS - 1 - CELLS.trailing_zeros();

/// Terms of the binomial series, which leave out 1e-11 from one cell to the next.
const TERMS: usize = 8;

/// The powers qᵖ of one p.
#[derive(Clone, Debug)]
pub(crate) struct PowerTable {
    /// The power of a mantissa, in each cell about its middle.
    cells: [Cell; CELLS],
    /// The power of 2ᵉ by the biased exponent of q, so that neither a sum nor a comparison goes
    /// before the load. 0 where there is none: for q < 1, infinite q and NaN, and where the power
    /// is below the least normal number, since products with it would be slow.
    octaves: [f32; 256],
}

impl PowerTable {
    /// The largest |p|, up to which a cubic errs by 1e-7 of the power.
    pub(crate) const STEEPEST: f64 = 7.0;

    /// From two library functions and products otherwise, in 0.6 µs.
    pub(crate) fn new(p: f64) -> Box<Self> {
        debug_assert!(p.abs() <= Self::STEEPEST);
        // (1 + u)ᵖ = Σ cₖ uᵏ.
        let mut binomial = [1.0; TERMS];
        for k in 1..TERMS {
            let order = k as f64;
            binomial[k] = binomial[k - 1] * (p - (order - 1.0)) / order;
        }
        let power_near_1 = |u: f64| binomial.iter().rev().fold(0.0, |sum, c| sum * u + c);

        let mut middle = power_near_1(0.5 / CELLS as f64);
        let cells = core::array::from_fn(|i| {
            // The width of a cell over its middle, as well as the rise to the next middle.
            let width = 1.0 / (CELLS as f64 + 0.5 + i as f64);
            let cell = cell(&binomial, middle, width);
            middle *= power_near_1(width);
            cell
        });

        let mut octaves = [0.0; 256];
        let (factor, mut power) = (libm::exp2(p), 1.0);
        for octave in &mut octaves[127..255] {
            *octave = if power < f64::from(f32::MIN_POSITIVE) { 0.0 } else { power as f32 };
            power *= factor;
        }
        Box::new(Self { cells, octaves })
    }

    /// scale·qᵖ; `None` for infinite q and NaN, and where the power is below 2⁻¹²⁶.
    #[inline(always)]
    pub(crate) fn scaled(&self, q: f32, scale: f32) -> Option<f32> {
        const MIDDLE: f32 = 1.0 + 0.5 / CELLS as f32;
        let bits = q.to_bits();
        // Both steps are exact.
        let within = f32::from_bits((bits & ((1 << WITHIN) - 1)) | 1.0_f32.to_bits()) - MIDDLE;
        let cell = &self.cells[(bits >> WITHIN) as usize % CELLS];
        let octave = self.octaves[(bits >> (f32::MANTISSA_DIGITS - 1)) as u8 as usize];
        (octave > 0.0).then(|| cubic(cell, within) * (octave * scale))
    }
}

/// The cubic next to the power over a cell, of the distance from its middle.
///
/// The series to the fifth power, whose last two terms are replaced with the closest of lower
/// degree: those less the Chebyshev polynomials T₄ and T₅, to scale.
fn cell(binomial: &[f64; TERMS], middle: f64, width: f64) -> Cell {
    let [c0, c1, c2, c3, c4, c5, ..] = *binomial;
    let half2 = 0.25 * width * width;
    let relative = [
        c0 - c4 * half2 * half2 / 8.0,
        c1 - c5 * half2 * half2 * (5.0 / 16.0),
        c2 + c4 * half2,
        c3 + c5 * half2 * (5.0 / 4.0),
    ];
    // A distance over the middle, of which the width is 1/CELLS of an octave.
    let step = width * CELLS as f64;
    let mut scale = middle;
    relative.map(|c| {
        let coefficient = c * scale;
        scale *= step;
        coefficient as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_library() {
        let least = f64::from(f32::MIN_POSITIVE);
        for p in [0.249_5, 0.1, 0.0, -0.25, -1.0, -2.65, -6.5, -7.0] {
            let table = PowerTable::new(p);
            for i in 0..20_000 {
                // All octaves, and every part of a cell.
                let q = f32::from_bits(1.0_f32.to_bits() + i * 53_261);
                let want = libm::pow(q.into(), p);
                match table.scaled(q, 1.0) {
                    Some(got) => {
                        let error = f64::from(got) / want - 1.0;
                        assert!(error.abs() < 2.5e-7 || want < least, "{q} {p}: {error:e}");
                    }
                    None => assert!(want < 2.0 * least, "{q} {p}"),
                }
            }
        }
        let table = PowerTable::new(-1.0);
        assert_eq!(table.scaled(1.0, 3.0), Some(3.0));
        for q in [f32::INFINITY, f32::NAN, -f32::NAN] {
            assert_eq!(table.scaled(q, 1.0), None, "{q}");
        }
    }
}
