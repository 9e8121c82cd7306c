//! What a [`Family`] draws and returns where σ and γ differ from hit to hit, against the model.
//!
//! The normals of many σ and γ have no density that could be integrated over cells. But the model's
//! CDFs of a normal, along the plane of incidence and across it, at the σ and γ that it was drawn
//! with, are uniform on [0, 1]² just if the sampler is right, and independent of σ and γ. So cells
//! of equal size are expected to hold the same number, exactly: a χ² of the two CDFs, and one of
//! them with σ and γ, which finds an error at some σ or γ alone.

mod mixture;
mod values;

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_baker::progress::Stage;
use microfacet_model::statistics::{ChiSquare, chi_square};
use microfacet_model::{self as model, SignedSlope, VisibleSlope};
use microfacet_sampler::{Family, MaterialError, MicrofacetDistribution as _, Tables};

use super::run::{Judged, Outcome, judge, on_threads};
use super::stress::direction;

use mixture::{Hit, Mixture};
pub use mixture::{SIGMAS, THETAS};
pub use values::{QUANTITIES, Values};

/// Cells of the two CDFs, along and across.
const NORMALS: [usize; 2] = [32, 16];
/// Cells of s, of σx, and of the two CDFs.
const PARAMETERS: [usize; 4] = [16, 4, 8, 2];
/// Larger unit slopes towards the viewer are not told apart, and no normal with a larger cosine has
/// one.
const LARGEST_SLOPE: f64 = 1e15;
const HORIZON: f32 = 1e-12;
/// Cells at whose edges the CDF along the plane of incidence is compared.
const KS_CELLS: usize = 256;

/// Options of a run.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Normals drawn for each mixture.
    pub samples: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// Factor on γ of the model; other than 1 to see it rejected.
    pub gamma_factor: f64,
    /// Factor on σ of the model; other than 1 to see it rejected.
    pub sigma_factor: f64,
}

/// The result for one range of γ and one elevation of the view.
#[derive(Clone, Debug)]
pub struct Report {
    /// The smallest and the largest γ drawn.
    pub gammas: [f64; 2],
    /// Polar angle of all views, radians; their azimuths are drawn.
    pub theta: f64,
    /// χ² of the CDFs along the plane of incidence and across it.
    pub normals: ChiSquare,
    /// χ² of the same with s and σ.
    pub parameters: ChiSquare,
    /// Kolmogorov–Smirnov distance of the CDF along the plane of incidence.
    pub ks: f64,
    /// Errors of G1, D and the density of visible normals.
    pub values: Values,
}

impl Judged for Report {
    fn p(&self) -> f64 {
        self.normals.p.min(self.parameters.p)
    }

    fn sound(&self) -> bool {
        self.values.are_allowed()
    }
}

/// The mixtures that a run draws: each range of γ at each elevation of the view.
fn mixtures(family: &Family) -> Vec<([f64; 2], f64)> {
    family.gammas().flat_map(|gammas| THETAS.map(|theta| (gammas, theta))).collect()
}

/// The estimated seconds of a run on the current threads.
pub fn seconds(family: &Family, options: Options) -> f64 {
    // Microseconds of `microfacet-bake validate --per-hit --threads 1` for a normal.
    on_threads(mixtures(family).len() * options.samples, 1.5)
}

/// Draws σ, γ and the azimuth of the view for each normal, and tests the normals of each range of γ
/// and each elevation of the view by two χ², and G1, D and densities by the model's. The normals
/// are counted in a stage of the progress.
///
/// # Errors
/// [`MaterialError::Gamma`] where a factor takes γ out of the family, and [`MaterialError::Sigma`]
/// where one takes σ out.
pub fn run(
    tables: &Tables,
    family: &Family,
    options: Options,
    stage: &Stage,
) -> Result<Outcome<Report>, MaterialError> {
    run_some(tables, family, &mixtures(family), options, stage)
}

fn run_some(
    tables: &Tables,
    family: &Family,
    mixtures: &[([f64; 2], f64)],
    options: Options,
    stage: &Stage,
) -> Result<Outcome<Report>, MaterialError> {
    let allowed = values::Allowed::of(tables);
    let mixtures: Vec<_> = mixtures.iter().copied().enumerate().collect();
    judge(&mixtures, 2, options.samples, stage, |&(i, (gammas, theta)), count| {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&options.seed.to_le_bytes());
        key[8..16].copy_from_slice(&(i as u64).to_le_bytes());
        let mut test = Test {
            family,
            options,
            mixture: Mixture::new(gammas),
            theta,
            random: StdRng::from_seed(key),
        };
        let [normals, parameters, ks] = test.counts(count)?;
        let even = |counts: &[u64]| {
            let cells = counts.len() - 1;
            let mut expected = vec![options.samples as f64 / cells as f64; cells];
            expected.push(0.0);
            chi_square(counts, &expected)
        };
        let (normals, parameters) = (even(&normals), even(&parameters));
        let values = test.values(allowed)?;
        Ok(Report { gammas, theta, normals, parameters, ks: distance(&ks), values })
    })
}

/// The lobes of one range of γ, seen from one elevation.
struct Test<'a> {
    family: &'a Family,
    options: Options,
    mixture: Mixture,
    theta: f64,
    random: StdRng,
}

impl Test<'_> {
    /// Numbers of samples in the cells of the two tests, and along the plane of incidence.
    fn counts(&mut self, count: &mut dyn FnMut()) -> Result<[Vec<u64>; 3], MaterialError> {
        let size = |cells: &[usize]| vec![0_u64; cells.iter().product::<usize>() + 1];
        let mut counts = [size(&NORMALS), size(&PARAMETERS), size(&[KS_CELLS])];
        for _ in 0..self.options.samples {
            let hit = self.mixture.hit(self.mixture.places(&mut self.random), &mut self.random);
            let v = direction(self.theta, hit.phi);
            let u = [self.random.random(), self.random.random()];
            let lobe = self.family.at(hit.sigma, hit.gamma);
            let m = Vec3::from(lobe.sample_visible_normal(v, u));
            let truth = self.truth(&hit)?;
            let [along, across] = self.numbers(&truth, v, m);
            let [s, sigma] = hit.places;
            let all: [(&[usize], &[f64]); 3] = [
                (&NORMALS, &[along, across]),
                (&PARAMETERS, &[s, sigma, along, across]),
                (&[KS_CELLS], &[along]),
            ];
            for (counts, (cells, numbers)) in counts.iter_mut().zip(all) {
                counts[cell(cells, numbers)] += 1;
            }
            count();
        }
        Ok(counts)
    }

    /// The model's CDFs of a normal, along the plane of incidence and across it.
    fn numbers(&mut self, truth: &model::StudentT, v: Vec3, m: Vec3) -> [f64; 2] {
        let (v, shape) = (v.as_dvec3(), truth.shape());
        let [along, across] = truth.invert_visible_normal(v, m.as_dvec3());
        // Such slopes are common near γ = 3/2, and single precision moves the largest of them to
        // one above the horizon. All of them count as one, of any number that they have together.
        if m.z < HORIZON {
            let last = SignedSlope { w: shape.asinh_slope(LARGEST_SLOPE), sign: 1.0 };
            let below = VisibleSlope::new(shape, truth.unit_view(v).0).cdf(last);
            if along > below {
                return [below + self.random.random::<f64>() * (1.0 - below), across];
            }
        }
        [along, across]
    }

    /// The model's lobe of a hit, with the numbers that the family takes for it.
    fn truth(&self, hit: &Hit) -> Result<model::StudentT, MaterialError> {
        let lobe = self.family.at(hit.sigma, hit.gamma);
        let gamma = lobe.gamma() * self.options.gamma_factor;
        let sigma = lobe.sigma().map(|sigma| f64::from(sigma) * self.options.sigma_factor);
        model::StudentT::new(sigma, gamma).map_err(|_| match gamma > 1.5 {
            true => MaterialError::Sigma { sigma: sigma[0], range: [0.0, f64::MAX] },
            false => MaterialError::Gamma(gamma),
        })
    }
}

/// The cell of some numbers in [0, 1]; one more, which is to stay empty, is that of NaN, as of a
/// normal that is none.
fn cell(cells: &[usize], numbers: &[f64]) -> usize {
    if numbers.iter().any(|number| number.is_nan()) {
        return cells.iter().product();
    }
    cells.iter().zip(numbers).fold(0, |at, (&count, &number)| {
        at * count + ((number * count as f64) as usize).min(count - 1)
    })
}

/// The largest difference between the shares of samples below the edges of cells, and those of a
/// uniform number.
fn distance(counts: &[u64]) -> f64 {
    let counts = &counts[..KS_CELLS];
    let (cells, samples) = (counts.len() as f64, counts.iter().sum::<u64>() as f64);
    let mut below = 0;
    counts.iter().zip(1_u32..).fold(0.0, |worst: f64, (count, i)| {
        below += count;
        worst.max((below as f64 / samples - f64::from(i) / cells).abs())
    })
}

#[cfg(test)]
mod tests;
