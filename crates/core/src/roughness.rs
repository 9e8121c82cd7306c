//! Roughness along the two axes of the tangent frame.

/// Roughness σx, σy along the tangent frame's x and y, dimensionless (the α of GGX and Beckmann).
///
/// Made from a number for an isotropic surface, or from a pair. Both precisions are accepted; a
/// single-precision number comes back unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness(pub [f64; 2]);

impl Roughness {
    /// σx and σy.
    ///
    /// # Errors
    /// The first that does not lie in (0, ∞).
    pub fn positive(self) -> Result<[f64; 2], f64> {
        match self.0.into_iter().find(|sigma| !(*sigma > 0.0 && *sigma < f64::INFINITY)) {
            Some(sigma) => Err(sigma),
            None => Ok(self.0),
        }
    }
}

impl From<f64> for Roughness {
    fn from(sigma: f64) -> Self {
        Self([sigma; 2])
    }
}

impl From<f32> for Roughness {
    fn from(sigma: f32) -> Self {
        Self([sigma.into(); 2])
    }
}

impl From<[f64; 2]> for Roughness {
    fn from(sigma: [f64; 2]) -> Self {
        Self(sigma)
    }
}

impl From<[f32; 2]> for Roughness {
    fn from(sigma: [f32; 2]) -> Self {
        Self(sigma.map(f64::from))
    }
}
