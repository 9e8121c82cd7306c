//! Values to compare with: GGX of Walter et al. 2007, and Fresnel's equations.

use glam::DVec3;

/// GGX by Walter et al. 2007 in double precision; n_o and n_i are the indices on the sides of view
/// and light.
pub(super) struct Walter {
    pub(super) alpha: f64,
}

impl Walter {
    /// Eq. 33.
    pub(super) fn d(&self, m: DVec3) -> f64 {
        let tan2 = (1.0 - m.z * m.z) / (m.z * m.z);
        let a2 = self.alpha * self.alpha;
        a2 / (std::f64::consts::PI * m.z.powi(4) * (a2 + tan2).powi(2))
    }

    /// Eq. 34.
    pub(super) fn g1(&self, v: DVec3, m: DVec3) -> f64 {
        if v.dot(m) / v.z <= 0.0 {
            return 0.0;
        }
        let tan2 = (1.0 - v.z * v.z) / (v.z * v.z);
        2.0 / (1.0 + (1.0 + self.alpha * self.alpha * tan2).sqrt())
    }

    /// Eq. 20, of a reflectance by |i·h|.
    pub(super) fn reflection(&self, o: DVec3, i: DVec3, fresnel: impl Fn(f64) -> f64) -> f64 {
        let h = (i + o).normalize() * (i + o).z.signum();
        let g = self.g1(i, h) * self.g1(o, h);
        fresnel(i.dot(h).abs()) * g * self.d(h) / (4.0 * i.z.abs() * o.z.abs())
    }

    /// The smaller of the cosines of view and light at the facet that refracts the one into the
    /// other.
    pub(super) fn smaller_cosine(&self, o: DVec3, i: DVec3, n_o: f64, n_i: f64) -> f64 {
        let h = (n_i * i + n_o * o).normalize();
        i.dot(h).abs().min(o.dot(h).abs())
    }

    /// Eq. 21.
    pub(super) fn transmission(&self, o: DVec3, i: DVec3, n_o: f64, n_i: f64) -> f64 {
        let h = -(n_i * i + n_o * o);
        let h = h.normalize() * h.z.signum();
        let (ih, oh) = (i.dot(h), o.dot(h));
        // Refraction takes light to the other side of the facet, too.
        if ih * oh >= 0.0 {
            return 0.0;
        }
        let g = self.g1(i, h) * self.g1(o, h);
        let fresnel = walter_fresnel(n_o / n_i, ih.abs());
        let cosines = (ih * oh / (i.z * o.z)).abs();
        cosines * n_o * n_o * (1.0 - fresnel) * g * self.d(h) / (n_i * ih + n_o * oh).powi(2)
    }
}

/// Smaller cosines of facets have a relative error above 1e-5 in single precision.
pub(super) const EDGE_ON: f64 = 0.01;
/// The same holds where squares of cosines are closer to that of the critical angle.
pub(super) const CRITICAL: f64 = 1e-3;

/// Eq. 22, with the index on the other side over that on the side of c.
pub(super) fn walter_fresnel(ratio: f64, c: f64) -> f64 {
    let g2 = ratio * ratio - 1.0 + c * c;
    if g2 < 0.0 {
        return 1.0;
    }
    let g = g2.sqrt();
    let second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + second * second)
}

/// Fresnel's equations of a complex index by complex arithmetic.
pub(super) fn complex_fresnel(eta: f64, k: f64, cos: f64) -> f64 {
    type C = [f64; 2];
    let norm = |a: C| a[0] * a[0] + a[1] * a[1];
    let square: C = [eta * eta - k * k, 2.0 * eta * k];
    let inside: C = [square[0] - (1.0 - cos * cos), square[1]];
    let root = {
        let re = (0.5 * (norm(inside).sqrt() + inside[0])).sqrt();
        [re, 0.5 * inside[1] / re]
    };
    let times: C = square.map(|x| x * cos);
    let quotient = |a: C, b: C| norm([a[0] - b[0], a[1] - b[1]]) / norm([a[0] + b[0], a[1] + b[1]]);
    0.5 * (quotient([cos, 0.0], root) + quotient(times, root))
}
