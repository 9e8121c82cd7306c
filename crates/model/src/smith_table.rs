//! Smith's G1 for one shape as a piecewise polynomial: accurate enough for quadrature, and fifty
//! times faster than Λ itself.

use crate::piecewise::{Chebyshev, polynomial};
use crate::shape::Shape;

/// Pieces per octave of y; the leading bits of y as a double select a piece.
const PIECES: usize = 16;
/// Degree of a piece's polynomial.
const DEGREE: usize = 6;
/// Largest number of octaves of y: beyond z = 2⁴⁵, 1 − G1 is less than 1e-10 for every γ ≥ 1.5001.
const OCTAVES: usize = 90;
/// Exponent and leading mantissa bits of 1.0.
const FIRST: u64 = 0x3ff0;

/// G1 of one shape as a function of direction, for integrands.
///
/// With z the unit cotangent, h(z) = E|X − z|/2 = z Λ + z/2 is even and analytic in z. So h/√y is
/// smooth in y = 1 + z² = 1/sin²θ on [1, ∞), and G1 = cos θ/(h/√y + cos θ/2), θ being the polar
/// angle in unit space. The polynomials interpolate h/√y at Chebyshev points, sixteen to an octave;
/// G1 is right to 1e-13 (measured in the tests against Λ over γ from 1.501 to ∞).
#[derive(Clone, Debug)]
pub(crate) struct SmithTable {
    pieces: Vec<[f64; DEGREE + 1]>,
}

impl SmithTable {
    /// G1 is 1 from where Λ falls below `unmasked`.
    pub(crate) fn new(shape: &Shape, unmasked: f64) -> Self {
        Self::from_excess(|z| shape.excess_at(z), unmasked)
    }

    /// G1 of any symmetric distribution of unit slopes, from its E[(X − z)⁺] = z Λ(z).
    pub(crate) fn from_excess(excess: impl Fn(f64) -> f64, unmasked: f64) -> Self {
        let chebyshev = Chebyshev::new();
        let mut pieces = Vec::new();
        let mut low = 1.0;
        for _ in 0..OCTAVES {
            for i in 0..PIECES {
                let width = low / PIECES as f64;
                let start = low + width * i as f64;
                let at = |t| [smooth(&excess, start + width * 0.5 * (1.0 + t))];
                let [piece] = chebyshev.through(at);
                pieces.push(piece);
            }
            low *= 2.0;
            // From here on 1 − G1 ≈ Λ is negligible.
            let z = low.sqrt();
            if excess(z) < unmasked * z {
                break;
            }
        }
        Self { pieces }
    }

    /// G1 of a direction with cosine `cos` > 0 and σ-stretched horizontal length squared `rho2`; 0
    /// at and below the horizon.
    #[inline]
    pub(crate) fn g1(&self, cos: f64, rho2: f64) -> f64 {
        if cos <= 0.0 {
            return 0.0;
        }
        let length2 = cos * cos + rho2;
        let cos_unit = cos / length2.sqrt();
        // Beyond the last piece h is z/2: nothing is masked.
        self.smooth(length2 / rho2).map_or(1.0, |h| cos_unit / (h + 0.5 * cos_unit))
    }

    /// G2/G1(v), in the order of [`Masking::ALL`](microfacet_core::Masking::ALL), of a view with
    /// G1(v) = `view` and a light as in [`g1`](Self::g1).
    #[inline]
    pub(crate) fn shares(&self, view: f64, cos: f64, rho2: f64) -> [f64; 2] {
        if cos <= 0.0 {
            return [0.0; 2];
        }
        let length2 = cos * cos + rho2;
        // With A the area that the light sees, G1(l) = cos/A.
        let Some(h) = self.smooth(length2 / rho2) else { return [1.0; 2] };
        let half = h * length2.sqrt();
        [cos / (half + 0.5 * cos), cos / (cos + view * (half - 0.5 * cos))]
    }

    /// Projected area of the microsurface, ∫ (w·m)⁺ D, for a direction w of any height `cos` in
    /// unit space and horizontal length squared `rho2`, not both 0; to 1e-13 of its length.
    #[inline]
    pub(crate) fn area(&self, cos: f64, rho2: f64) -> f64 {
        let length2 = cos * cos + rho2;
        self.area_of(cos, length2.sqrt(), length2 / rho2)
    }

    /// [`area`](Self::area) of a direction by its `cos`, its length, and the square of the length
    /// over that of its horizontal part.
    #[inline]
    pub(crate) fn area_of(&self, cos: f64, length: f64, square: f64) -> f64 {
        let half = self.smooth(square).map_or(0.5 * cos.abs(), |h| h * length);
        (half + 0.5 * cos).max(0.0)
    }

    #[inline]
    fn smooth(&self, y: f64) -> Option<f64> {
        let bits = y.to_bits();
        let piece = ((bits >> 48) - FIRST) as usize;
        let c = self.pieces.get(piece)?;
        // The position inside the piece from the remaining 48 bits.
        let t = (bits & 0xffff_ffff_ffff) as f64 * (2.0 / (1u64 << 48) as f64) - 1.0;
        Some(polynomial(c, t))
    }
}

/// h(z)/√y at y = 1 + z².
fn smooth(excess: impl Fn(f64) -> f64, y: f64) -> f64 {
    let z = (y - 1.0).sqrt();
    (excess(z) + 0.5 * z) / y.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn g1_is_the_exact_one() {
        let mut worst = 0.0_f64;
        for gamma in [1.501, 1.52, 1.6, 1.8, 2.0, 2.7, 4.0, 11.0, 100.0, 1e6, f64::INFINITY] {
            let shape = Shape::new(gamma).unwrap();
            let table = SmithTable::new(&shape, 1e-13);
            for i in 0..4000 {
                let z = libm::exp2(f64::from(i) * 0.012345 - 20.0);
                let want = 1.0 / (1.0 + shape.lambda(shape.asinh_slope(z)));
                let got = table.g1(z, 1.0);
                worst = worst.max((got - want).abs());
                assert!((got - want).abs() < 2e-13, "gamma {gamma}, z {z}: {got} against {want}");
            }
        }
        println!("G1: worst error {worst:e}");
        let table = SmithTable::new(&Shape::new(3.0).unwrap(), 1e-13);
        assert_eq!((table.g1(0.0, 1.0), table.g1(-0.1, 1.0), table.g1(1.0, 0.0)), (0.0, 0.0, 1.0));
    }
}
