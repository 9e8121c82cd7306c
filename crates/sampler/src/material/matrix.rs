//! The matrix of an ellipsoid, in single precision.

use microfacet_core::Skew;

use crate::error::MaterialError;

/// The entries of a [`Skew`] in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Matrix {
    pub(super) p: f32,
    pub(super) q: f32,
    pub(super) r: f32,
    pub(super) x: f32,
    pub(super) y: f32,
}

/// Outside this range the squares of entries times those of slopes leave single precision.
pub(super) const ENTRIES: [f64; 2] = [1e-18, 1e18];

impl Matrix {
    pub(super) fn entries(self) -> [f32; 5] {
        [self.p, self.q, self.r, self.x, self.y]
    }
}

impl TryFrom<Skew> for Matrix {
    type Error = MaterialError;

    fn try_from(Skew { p, q, r, x, y }: Skew) -> Result<Self, MaterialError> {
        let [low, high] = ENTRIES;
        match [p, r].into_iter().find(|entry| !(low..=high).contains(entry)) {
            Some(sigma) => Err(MaterialError::Sigma { sigma, range: ENTRIES }),
            None => {
                let [p, q, r, x, y] = [p, q, r, x, y].map(|entry| entry as f32);
                Ok(Self { p, q, r, x, y })
            }
        }
    }
}
