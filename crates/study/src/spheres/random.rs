//! The numbers of a path: an Owen-scrambled Sobol sequence of each pixel (Burley 2020, *Practical
//! Hash-based Owen Scrambling*, <https://jcgt.org/published/0009/04/01/>).

/// Dimensions of one sequence; longer paths continue in another.
const DIMENSIONS: u32 = 256;

/// The coordinates of one point, taken one after the other.
pub(crate) struct Random {
    seed: u32,
    index: u32,
    dimension: u32,
}

impl Random {
    /// The most points of a sequence.
    pub(crate) const MOST: u32 = 1 << 16;

    /// The point of an index below [`MOST`](Self::MOST), of a pixel.
    pub(crate) fn new(pixel: u32, index: u32) -> Self {
        // The golden ratio spreads the seeds of neighbouring pixels.
        Self { seed: pixel.wrapping_mul(0x9e37_79b9), index, dimension: 0 }
    }

    pub(crate) fn one(&mut self) -> f32 {
        let at = self.dimension % DIMENSIONS;
        let seed = self.seed.wrapping_add(self.dimension / DIMENSIONS);
        self.dimension += 1;
        sobol_burley::sample(self.index, at, seed)
    }

    pub(crate) fn two(&mut self) -> [f32; 2] {
        [self.one(), self.one()]
    }
}
