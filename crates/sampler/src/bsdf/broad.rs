//! The density from which light of further bounces is drawn: the cosine, weighted by the loss at
//! each elevation.

use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use microfacet_core::math::{sqrt, unit};

use crate::elementary::turn;

/// Bands of elevation, between the cosines (i/32)⁴: a smooth surface loses its light at grazing,
/// within its roughness of the horizon.
const BANDS: usize = 32;

/// The share that is drawn by the plain cosine, so that the density is positive everywhere and no
/// weight exceeds twenty times that of the cosine.
const PLAIN: f64 = 0.05;

/// A density over the hemisphere above, per steradian: a factor, linear in cos² θ between the ends
/// of the bands and continuous, times cos θ/π.
///
/// Drawn by the plain cosine, light of a smooth surface would have weights of the order of 1/σ.
#[derive(Clone, Copy, Debug)]
pub struct Broad {
    /// The factors at the ends of the bands.
    factors: [f32; BANDS + 1],
    /// The share of all bands below each end.
    shares: [f32; BANDS + 1],
}

/// The square of the cosine at an end of a band; the cosine-weighted measure is uniform in it.
const fn square(end: usize) -> f64 {
    let t = end as f64 / BANDS as f64;
    let cos = (t * t) * (t * t);
    cos * cos
}

/// The squares in single precision, which are also the shares of the cosine.
const SQUARES: [f32; BANDS + 1] = Broad::COSINE.shares;

impl Broad {
    pub(super) const COSINE: Self = {
        let mut shares = [0.0; BANDS + 1];
        let mut end = 0;
        while end <= BANDS {
            shares[end] = square(end) as f32;
            end += 1;
        }
        Self { factors: [1.0; BANDS + 1], shares }
    };

    /// In proportion to a function of direction, averaged over azimuths, times the cosine.
    pub(super) fn new(of: impl Fn(Vec3) -> f32) -> Self {
        Self::averaged::<8>(of)
    }

    /// In proportion to a function of elevation times the cosine.
    pub(super) fn round(of: impl Fn(Vec3) -> f32) -> Self {
        Self::averaged::<1>(of)
    }

    fn averaged<const AZIMUTHS: usize>(of: impl Fn(Vec3) -> f32) -> Self {
        const PLACES: usize = 8;
        let mean = |square: f64| {
            let (cos, r) = (libm::sqrt(square) as f32, libm::sqrt(1.0 - square) as f32);
            let at = |azimuth: usize| {
                let [sin, along] = turn((azimuth as f32 + 0.5) / AZIMUTHS as f32);
                f64::from(of(Vec3::new(r * along, r * sin, cos)))
            };
            (0..AZIMUTHS).map(at).sum::<f64>() / AZIMUTHS as f64
        };
        // Averages around each end, so that a peak between two ends is not missed: a dielectric
        // loses light within the roughness of its critical angle.
        let mut sums = [[0.0; 2]; BANDS + 1];
        for band in 0..BANDS {
            for place in 0..PLACES {
                let w = (place as f64 + 0.5) / PLACES as f64;
                let value = mean(square(band) + w * (square(band + 1) - square(band)));
                for (end, share) in [(band, 1.0 - w), (band + 1, w)] {
                    sums[end][0] += share * value;
                    sums[end][1] += share;
                }
            }
        }
        let means = sums.map(|[sum, share]| sum / share);
        let width = |band: usize| square(band + 1) - square(band);
        let of_band = |ends: &[f64], band: usize| 0.5 * (ends[band] + ends[band + 1]) * width(band);
        let whole: f64 = (0..BANDS).map(|band| of_band(&means, band)).sum();
        if !(whole > 0.0) {
            return Self::COSINE;
        }
        let factors = means.map(|mean| PLAIN + (1.0 - PLAIN) * mean / whole);
        let (mut share, mut broad) =
            (0.0, Self { factors: factors.map(|x| x as f32), ..Self::COSINE });
        for band in 0..BANDS {
            share += of_band(&factors, band);
            broad.shares[band + 1] = share as f32;
        }
        broad
    }

    /// The factors at the ends of the bands, and the shares below them.
    pub(super) fn bands(&self) -> [[f32; BANDS + 1]; 2] {
        [self.factors, self.shares]
    }

    /// A direction above the horizon from two numbers in [0, 1] (clamped to them, NaN to 0).
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let [u, azimuth] = u.map(unit);
        let band = self.shares[1..BANDS].partition_point(|&share| share < u);
        let [below, above] = [self.shares[band], self.shares[band + 1]];
        let within = unit((u - below) / (above - below));
        // The inverse of the quadratic CDF of a linear density; without cancellation where it is
        // constant.
        let [a, b] = [self.factors[band], self.factors[band + 1]];
        let root = sqrt(a * a + within * (b - a) * (b + a));
        let w = (within * (a + b) / (a + root)).min(1.0);
        let (from, to) = (SQUARES[band], SQUARES[band + 1]);
        let square = from + w * (to - from);
        let (r, [sin, cos]) = (sqrt(1.0 - square), turn(azimuth));
        Vec3::new(r * cos, r * sin, sqrt(square))
    }

    /// [`sample`](Self::sample), or `None` for a direction on the horizon.
    #[inline]
    pub(super) fn sample_above(&self, u: [f32; 2]) -> Option<Vec3> {
        Some(self.sample(u)).filter(|l| l.z > 0.0)
    }

    /// The density over that of the cosine, at a direction or its opposite.
    #[inline(always)]
    pub(super) fn factor(&self, l: Vec3) -> f32 {
        let cos = l.z.abs();
        let band = ((BANDS as f32 * sqrt(sqrt(cos))) as usize).min(BANDS - 1);
        let (from, to) = (SQUARES[band], SQUARES[band + 1]);
        let w = unit((cos * cos - from) / (to - from));
        self.factors[band] + w * (self.factors[band + 1] - self.factors[band])
    }
}

#[inline(always)]
pub(super) fn cosine_pdf(l: Vec3) -> f32 {
    l.z.abs() * FRAC_1_PI
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loss of a surface whose loss falls off within 0.01 of the horizon.
    fn steep(l: Vec3) -> f32 {
        0.01 / (0.01 + l.z) * (1.0 + 0.5 * l.x)
    }

    #[test]
    fn samples_have_the_density() {
        for broad in [Broad::COSINE, Broad::new(steep)] {
            let n = 400_000;
            let mut counts = [0_u32; 20];
            for i in 0..n {
                let u = (i as f32 + 0.5) / n as f32;
                let l = broad.sample([u, (0.618_034 * i as f64).fract() as f32]);
                assert!((l.length() - 1.0).abs() < 1e-6 && l.z >= 0.0);
                counts[((20.0 * l.z) as usize).min(19)] += 1;
            }
            for (i, count) in counts.into_iter().enumerate() {
                // 2 ∫ factor μ dμ.
                let mu = |j: i32| (i as f32 + (j as f32 + 0.5) / 1000.0) / 20.0;
                let density = |mu: f32| broad.factor(Vec3::new(0.0, 0.0, mu)) * mu;
                let want: f32 = (0..1000).map(|j| 2.0 * density(mu(j)) / 20_000.0).sum();
                let got = count as f32 / n as f32;
                assert!((got - want).abs() < 2e-4, "{i}: {got} for {want}");
            }
        }
    }

    #[test]
    fn it_follows_what_is_lost_and_leaves_nothing_out() {
        let broad = Broad::new(steep);
        let up = |z: f32| Vec3::new(0.0, (1.0 - z * z).sqrt(), z);
        let ratio = |z| broad.factor(up(z)) / steep(up(z));
        let (least, most) = [1e-6, 1e-4, 0.01, 0.1, 0.5, 1.0]
            .map(ratio)
            .into_iter()
            .fold((f32::MAX, 0.0_f32), |(low, high), x| (low.min(x), high.max(x)));
        assert!(most / least < 5.0 && least > 0.0, "{least} {most}");
        // Continuous from band to band.
        for end in 1..BANDS {
            let cos = square(end).sqrt() as f32;
            let [below, above] = [0.9999, 1.0001].map(|x| broad.factor(up(x * cos)));
            assert!((above / below - 1.0).abs() < 1e-3, "{cos}: {below} {above}");
        }
        assert_eq!(Broad::new(|_| 0.0).factor(Vec3::Z), 1.0);
        // u = 0 and u = 1 are in the first and in the last band.
        assert!(broad.sample([0.0, 0.3]).z == 0.0 && broad.sample([1.0, 0.3]).z > 0.999);
        assert!(broad.sample([f32::NAN, 0.3]).z == 0.0);
    }
}
