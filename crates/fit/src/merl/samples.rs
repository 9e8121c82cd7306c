//! The samples that a fit compares: cells with view and light well above the horizon.

use microfacet_core::Masking;
use microfacet_core::schlick::schlick_weight;
use rayon::prelude::*;

use super::LIMIT_DEGREES;
use super::file::{DIMENSIONS, MIDDLE, Measured, angles, index};
use super::lobe::Lobe;

/// Steps of the table of masking over the square root of the angle, between which Λ is linear:
/// where γ is close to 3/2, Λ bends at the normal. The error of G1 is below 2e-6 for
/// σ ≤ 1 and 1e-5 for σ = 10.
const STEPS: usize = 4096;

/// The coordinate of an angle, in radians, in the table of masking.
fn place(theta: f64) -> f64 {
    STEPS as f64 * (theta / LIMIT_DEGREES.to_radians()).sqrt()
}

fn angle(place: f64) -> f64 {
    LIMIT_DEGREES.to_radians() * (place / STEPS as f64).powi(2)
}

/// The samples, the same for all files: indices and geometry.
#[derive(Default)]
pub(super) struct Samples {
    /// Index of each sample in a channel.
    pub(super) index: Vec<usize>,
    row: Vec<usize>,
    /// Coordinates of view and light in the table of masking.
    places: Vec<[f64; 2]>,
    /// 1/(4 v·n l·n).
    jacobian: Vec<f64>,
    /// l·n, the weight of an error.
    pub(super) cos_l: Vec<f64>,
    /// Schlick's weight at v·m.
    pub(super) grazing: Vec<f64>,
}

impl Samples {
    /// Samples that a thread sums at once; the sums of chunks are added in order, so that the
    /// result is the same for any number of threads.
    pub(super) const CHUNK: usize = 1 << 14;

    /// Every cell of θ_h, and every `strides`th of θ_d and φ_d, without those whose view or light
    /// is [`LIMIT_DEGREES`] or more from the normal.
    pub(super) fn new(strides: [usize; 2]) -> Self {
        let mut this = Self::default();
        let along = |axis: usize| {
            let stride = strides[axis - 1];
            (stride / 2..DIMENSIONS[axis]).step_by(stride)
        };
        for i in 0..DIMENSIONS[0] {
            for (j, k) in along(1).flat_map(|j| along(2).map(move |k| (j, k))) {
                let at = angles([i, j, k], MIDDLE);
                let [cos_v, cos_l] = at.cosines();
                // Next to the normal a cosine may exceed 1 by rounding.
                let places = [cos_v, cos_l].map(|cos| place(cos.min(1.0).acos()));
                if !places.iter().all(|x| *x < STEPS as f64) {
                    continue;
                }
                this.index.push(index([i, j, k]));
                this.row.push(i);
                this.places.push(places);
                this.jacobian.push(0.25 / (cos_v * cos_l));
                this.cos_l.push(cos_l);
                this.grazing.push(schlick_weight(at.theta_d.cos()));
            }
        }
        this
    }

    pub(super) fn len(&self) -> usize {
        self.index.len()
    }

    pub(super) fn of(&self, measured: &Measured) -> [Vec<f64>; 3] {
        let of = |channel: &Vec<f64>| self.index.iter().map(|&at| channel[at]).collect();
        measured.channels.each_ref().map(of)
    }

    /// D G1(v) G1(l)/(4 v·n l·n) of each sample: the specular reflectance for F = 1, in 1/sr.
    pub(super) fn specular(&self, lobe: &Lobe) -> Vec<f64> {
        let d = |i: usize| lobe.d(angles([i, 0, 0], MIDDLE).theta_h);
        let d: Vec<f64> = (0..DIMENSIONS[0]).map(d).collect();
        let masking = MaskingTable::new(lobe);
        let one = |i: usize| {
            let [v, l] = self.places[i].map(|x| masking.g1(x));
            d[self.row[i]] * Masking::Uncorrelated.g2(v, l) * self.jacobian[i]
        };
        (0..self.len()).into_par_iter().with_min_len(Self::CHUNK).map(one).collect()
    }
}

/// Λ over the angle of a direction. Each sample reads two values; computing Λ by the model would
/// take most of the time.
struct MaskingTable(Vec<f64>);

impl MaskingTable {
    fn new(lobe: &Lobe) -> Self {
        Self(lobe.lambdas(|i| angle(i as f64), STEPS))
    }

    /// G1 = 1/(1 + Λ) at a coordinate, see [`place`].
    fn g1(&self, x: f64) -> f64 {
        let i = (x as usize).min(STEPS - 1);
        let [a, b] = [self.0[i], self.0[i + 1]];
        1.0 / (1.0 + a + (x - i as f64) * (b - a))
    }
}

#[cfg(test)]
mod tests {
    use microfacet_model::classic::{Abc, Haze, Isotropic, Radial};
    use microfacet_model::{MicrofacetDistribution, StudentT};

    use super::super::file::cell;
    use super::super::lobe::direction;
    use super::*;

    #[test]
    fn all_samples_are_above_the_limit_and_few_are_spread_as_many() {
        let (all, few) = (Samples::new([1, 1]), Samples::new([6, 12]));
        for samples in [&all, &few] {
            let largest = samples.places.iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
            let largest = angle(largest).to_degrees();
            assert!((LIMIT_DEGREES - 1.0..LIMIT_DEGREES).contains(&largest), "{largest}");
        }
        let share = few.len() as f64 / all.len() as f64 * 72.0;
        assert!((share - 1.0).abs() < 0.02, "{share}");
        // Both ends of φ_d, the last θ_d within the limit, and nothing beyond.
        for at in [[0, 0, 0], [0, 79, 0], [0, 79, 179], [84, 0, 90]] {
            assert!(all.index.contains(&index(at)), "{at:?}");
        }
        for at in [[0, 80, 0], [0, 89, 179], [84, 40, 0], [84, 40, 179], [85, 0, 90]] {
            assert!(!all.index.contains(&index(at)), "{at:?}");
        }
    }

    #[test]
    fn the_table_of_masking_is_that_of_the_model() {
        let worst = |sigma: f64, gamma: f64| {
            let lobe = StudentT::new(sigma, gamma).unwrap();
            let table = MaskingTable::new(&Lobe::StudentT(lobe));
            let places = (0..=5 * STEPS).map(|i| i as f64 / 5.0).chain([1e-9, 1e-3, 0.5]);
            places.map(|x| (table.g1(x) - lobe.g1(direction(angle(x)))).abs()).fold(0.0, f64::max)
        };
        for sigma in [1e-4, 0.05, 0.3, 1.0, 10.0] {
            for gamma in [1.5025, 1.7, 2.0, 4.0, f64::INFINITY] {
                let error = worst(sigma, gamma);
                let limit = if sigma > 1.0 { 1e-5 } else { 2e-6 };
                assert!(error < limit, "sigma {sigma}, gamma {gamma}: {error}");
            }
        }
    }

    #[test]
    fn specular_is_that_of_vectors() {
        let samples = Samples::new([6, 12]);
        let lobe = StudentT::new(0.4, 2.6).unwrap();
        let found = samples.specular(&Lobe::StudentT(lobe));
        for i in (0..samples.len()).step_by(501) {
            let [v, l] = angles(cell(samples.index[i]), MIDDLE).directions();
            let m = (v + l).normalize();
            let expected = lobe.d(m) * lobe.g1(v) * lobe.g1(l) / (4.0 * v.z * l.z);
            assert!((found[i] / expected - 1.0).abs() < 1e-5, "{i}");
        }
    }

    /// Λ of the others by the quadrature that serves any distribution.
    #[test]
    fn the_tables_of_other_lobes_are_those_of_their_distributions() {
        let off = |lobe: &Lobe, of: &dyn Isotropic| {
            let (table, model) = (MaskingTable::new(lobe), Radial::new(of));
            let places = (0..=STEPS / 3).map(|i| 3.0 * i as f64 + 0.4);
            let off = |x| table.g1(x) - model.g1(direction(angle(x)));
            places.map(off).fold(0.0, |a: f64, b: f64| a.max(b.abs()))
        };
        for [core, wide, weight] in [[0.02, 0.8, 0.5], [0.1, 0.4, 0.3], [0.3, 0.3, 1.0]] {
            let worst =
                off(&Lobe::haze(core, wide, weight), &Haze::new(core, wide, weight).unwrap());
            assert!(worst < 2e-6, "{core} {wide} {weight}: {worst}");
        }
        for [b, c] in [[1e4, 1.4], [300.0, 0.6], [20.0, 3.3], [0.5, 20.0]] {
            let worst = off(&Lobe::abc(b, c), &Abc::new(b, c).unwrap());
            assert!(worst < 1e-4, "{b} {c}: {worst}");
        }
    }
}
