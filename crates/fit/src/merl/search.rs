//! The search for σ and γ.

use std::f64::consts::PI;

use microfacet_baker::distribution::{DistributionKind, Named, S_MAX};
use microfacet_baker::progress::{Meter, Stage};
use microfacet_core::shape::s_of_gamma;
use microfacet_model::StudentT;
use rayon::prelude::*;

use super::file::{Measured, MerlError};
use super::linear::{Linear, Problem};
use super::lobe::Lobe;
use super::samples::Samples;
use super::{Comparison, Fitted};
use crate::minimise::{self, Stop};

/// Steps of the scan along σ, which is evenly spaced in its logarithm over five decades, and along
/// s = 1/(γ−1).
const SCAN: [usize; 2] = [40, 12];
/// The same of a haze: its core, how much wider the haze is, and its weight.
const HAZE_SCAN: [usize; 3] = [20, 8, 5];
/// Strides of the cells of θ_d and φ_d in the first, second and last search.
const STRIDES: [[usize; 2]; 3] = [[6, 12], [2, 4], [1, 1]];
/// About how many lobes are tried in each search, for progress only.
const TRIES: [usize; 3] = [3200, 240, 130];
/// Tolerances of the error in a scan, the first search and the later ones.
const TOLERANCES: [f64; 3] = [1e-3, 1e-5, 1e-6];
/// Most basins of a scan that are searched.
const BASINS: usize = 3;

/// Beckmann and GGX first, since they are starting points for the Student-t.
const KINDS: [DistributionKind; 5] = [
    DistributionKind::Beckmann,
    DistributionKind::TrowbridgeReitz,
    DistributionKind::StudentT,
    DistributionKind::Haze,
    DistributionKind::Abc,
];

/// Fits to any number of files, with the geometry of their samples prepared once.
pub struct Fitter {
    levels: [Samples; 3],
}

impl Default for Fitter {
    fn default() -> Self {
        Self { levels: STRIDES.map(Samples::new) }
    }
}

/// The width is a tenth of the distance that counts as at an end (`DistributionKind::ends_at`).
const fn stop(tolerance: f64) -> Stop {
    Stop { width: 1e-5, spread: tolerance }
}

impl Fitter {
    /// The estimated seconds of a fit on two cores.
    pub const SECONDS: f64 = 11.0;

    /// Whether [`fit`](Self::fit) can be made of a measurement.
    ///
    /// # Errors
    /// [`MerlError::Missing`], [`MerlError::Black`] and [`MerlError::Dark`].
    pub fn check(&self, measured: &Measured) -> Result<(), MerlError> {
        let [_, _, all] = &self.levels;
        Problem::new(all, all.of(measured)).check()
    }

    /// Fits a Lambert term and a Cook–Torrance lobe of each distribution, and counts the work in a
    /// meter, which expects [`SECONDS`](Self::SECONDS). The result is the same for any number of
    /// threads.
    ///
    /// # Errors
    /// As [`check`](Self::check), and [`MerlError::Minimiser`].
    pub fn fit(&self, measured: &Measured, meter: &Meter) -> Result<Comparison, MerlError> {
        let stage = meter.stage(Self::SECONDS);
        let sizes = self.levels.each_ref().map(Errors::size);
        stage.split(sizes.iter().zip(TRIES).map(|(size, tries)| size * tries).sum());
        let [few, more, all] = self.levels.each_ref().map(|samples| Errors {
            problem: Problem::new(samples, samples.of(measured)),
            samples,
            stage: &stage,
        });
        all.problem.check()?;
        let mut starts: Vec<Vec<f64>> = Vec::new();
        let mut found: Vec<(Vec<f64>, Fitted)> = Vec::new();
        for kind in KINDS {
            let start = few.search(kind, if is_member(kind) { &starts } else { &[] })?;
            if is_member(kind) {
                starts.push(on_square(kind, &start));
            }
            let place = more.descend(kind, &start, 0.01, TOLERANCES[2])?;
            let place = all.descend(kind, &place, 0.002, TOLERANCES[2])?;
            found.push((place.clone(), all.fitted(kind, &place)));
        }
        let [beckmann, ggx, student_t, haze, abc] = found.try_into().expect("five kinds");
        let [at_beckmann, at_ggx] = [&beckmann, &ggx].map(|(at, of)| on_square(of.lobe.kind, at));
        let [beckmann, ggx, mut student_t, mut haze, abc] =
            [beckmann, ggx, student_t, haze, abc].map(|(_, fitted)| fitted);
        // Beckmann and GGX are members of the family, so that the best Student-t is not worse:
        // where the search found a worse one, it ended in another basin.
        for (at, other) in [(at_ggx, &ggx), (at_beckmann, &beckmann)] {
            if other.error < student_t.error {
                let kind = DistributionKind::StudentT;
                let near = all.fitted(kind, &all.descend(kind, &at, 0.02, TOLERANCES[2])?);
                let lobe = Named { kind, values: other.sigma_gamma().into() };
                let same = Fitted { lobe, ..other.clone() };
                student_t = if near.error < other.error { near } else { same };
            }
        }
        // Likewise a haze whose two lobes are one.
        if ggx.error < haze.error {
            let sigma = ggx.lobe.values[0];
            let lobe = Named { kind: DistributionKind::Haze, values: vec![sigma, sigma, 0.0] };
            haze = Fitted { lobe, ..ggx.clone() };
        }
        Ok(Comparison { beckmann, ggx, student_t, haze, abc })
    }
}

/// Whether a kind is of the family, and has a place on the square of its members.
fn is_member(kind: DistributionKind) -> bool {
    !matches!(kind, DistributionKind::Haze | DistributionKind::Abc)
}

/// The coordinates of a lobe on the square that [`DistributionKind::at`] maps to Student-ts, from
/// the searched coordinates: σ, and s for the Student-t only.
fn on_square(kind: DistributionKind, place: &[f64]) -> Vec<f64> {
    let z = place.get(1).copied().unwrap_or_else(|| s_of_gamma(shape(kind)) / S_MAX);
    vec![place[0], z]
}

fn shape(kind: DistributionKind) -> f64 {
    if kind == DistributionKind::Beckmann { f64::INFINITY } else { 2.0 }
}

/// The distribution at searched coordinates, by name and as a lobe.
fn at(kind: DistributionKind, place: &[f64]) -> (Named, Lobe) {
    if !is_member(kind) {
        let named = Named { kind, values: kind.at(place, 1.0) };
        let lobe = Lobe::of(&named);
        return (named, lobe);
    }
    let mut values = DistributionKind::StudentT.at(&on_square(kind, place), 1.0);
    if place.len() == 1 {
        values[1] = shape(kind);
    }
    let lobe = StudentT::new(values[0], values[1]).expect("the square has no others");
    values.truncate(place.len());
    (Named { kind, values }, Lobe::StudentT(lobe))
}

struct Errors<'a> {
    samples: &'a Samples,
    problem: Problem<'a>,
    stage: &'a Stage,
}

impl Errors<'_> {
    /// The work of one lobe, in thousands of samples.
    fn size(samples: &Samples) -> usize {
        samples.len() / 1000
    }

    fn solve(&self, lobe: &Lobe, tolerance: f64) -> (f64, [Linear; 3]) {
        self.stage.steps(Self::size(self.samples));
        self.problem.solve(&self.samples.specular(lobe), tolerance)
    }

    fn error(&self, kind: DistributionKind, place: &[f64], tolerance: f64) -> f64 {
        self.solve(&at(kind, place).1, tolerance).0
    }

    /// The best coordinates of a scan, of searches in its deepest basins, and of searches from
    /// `starts`.
    fn search(&self, kind: DistributionKind, starts: &[Vec<f64>]) -> Result<Vec<f64>, MerlError> {
        let dimension = kind.dimension();
        let grid = minimise::grid(if dimension == 3 { &HAZE_SCAN } else { &SCAN[..dimension] });
        let errors: Vec<f64> =
            grid.par_iter().map(|place| self.error(kind, place, TOLERANCES[0])).collect();
        let mut basins = match dimension {
            1 => basins(&errors, 1),
            2 => basins(&errors, SCAN[1] + 1),
            _ => best_of(&errors),
        };
        basins.truncate(BASINS);
        let places = basins.into_iter().map(|i| &grid[i]);
        let places: Vec<_> =
            if dimension == 1 { places.collect() } else { places.chain(starts).collect() };
        let h = 1.0 / SCAN[0] as f64;
        let found: Result<Vec<_>, MerlError> = places
            .into_par_iter()
            .map(|place| {
                let place = self.descend(kind, place, h, TOLERANCES[1])?;
                Ok((self.error(kind, &place, TOLERANCES[1]), place))
            })
            .collect();
        let best = found?.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(best.expect("a scan has a least value").1)
    }

    fn descend(
        &self,
        kind: DistributionKind,
        place: &[f64],
        h: f64,
        tolerance: f64,
    ) -> Result<Vec<f64>, MerlError> {
        minimise::descend(place, h, stop(tolerance), |place| {
            self.error(kind, place, 0.1 * tolerance)
        })
        .map_err(MerlError::Minimiser)
    }

    fn fitted(&self, kind: DistributionKind, place: &[f64]) -> Fitted {
        let (named, lobe) = at(kind, place);
        let (error, linear) = self.solve(&lobe, 0.1 * TOLERANCES[2]);
        Fitted {
            lobe: named,
            f0: linear.map(|linear| linear.f0),
            lambert: linear.map(|linear| PI * linear.lambert),
            error,
            ends_at: kind.ends_at(place),
        }
    }
}

/// The points of a scan that are no worse than their neighbours, best first; `width` points have
/// the same first coordinate.
fn basins(errors: &[f64], width: usize) -> Vec<usize> {
    let is_least = |&i: &usize| {
        let (x, y) = (i / width, i % width);
        let near = |a: usize, most: usize| a.saturating_sub(1)..=(a + 1).min(most);
        let around = near(x, errors.len() / width - 1)
            .flat_map(|x| near(y, width - 1).map(move |y| x * width + y));
        around.into_iter().all(|other| errors[other] >= errors[i])
    };
    let mut basins: Vec<usize> = (0..errors.len()).filter(is_least).collect();
    basins.sort_by(|&a, &b| errors[a].total_cmp(&errors[b]));
    basins
}

/// All points of a scan, best first.
fn best_of(errors: &[f64]) -> Vec<usize> {
    let mut all: Vec<usize> = (0..errors.len()).collect();
    all.sort_by(|&a, &b| errors[a].total_cmp(&errors[b]));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merl::file::CELLS;

    #[test]
    fn basins_are_found_inside_and_at_the_edges() {
        // Rows of three: a basin at a corner, one at the other end.
        let errors = [1.0, 2.0, 5.0, 3.0, 4.0, 5.0, 6.0, 5.0, 0.5];
        assert_eq!(basins(&errors, 3), [8, 0]);
        assert_eq!(basins(&[3.0, 1.0, 2.0, 0.0, 4.0], 1), [3, 1]);
    }

    #[test]
    fn both_ends_of_a_search_are_said_to_be() {
        for (end, start) in [(0.0, 0.1), (1.0, 0.9)] {
            for kind in KINDS.into_iter().filter(|kind| is_member(*kind)) {
                let mut at = vec![start; kind.dimension()];
                // The sequence of searches in `search` and `fit`.
                for (h, tolerance) in [(0.2, TOLERANCES[1]), (0.01, 1e-6), (0.002, 1e-6)] {
                    let cost = |p: &[f64]| 1.0 + p.iter().map(|x| (x - end).abs()).sum::<f64>();
                    at = minimise::descend(&at, h, stop(tolerance), cost).unwrap();
                }
                assert!(!kind.ends_at(&at).is_empty(), "{kind:?}: {at:?}");
                assert_eq!(kind.ends_at(&at)[0], kind.parameters()[0], "{kind:?}: {at:?}");
            }
        }
    }

    #[test]
    fn kinds_have_their_places_on_the_square() {
        for (kind, gamma) in [(KINDS[0], f64::INFINITY), (KINDS[1], 2.0)] {
            let student_t = |(named, lobe)| match lobe {
                Lobe::StudentT(lobe) => (named, lobe),
                _ => unreachable!("a member"),
            };
            let (named, lobe) = student_t(at(kind, &[0.6]));
            assert_eq!((named.values.len(), lobe.shape().gamma()), (1, gamma));
            let (named, same) = student_t(at(KINDS[2], &on_square(kind, &[0.6])));
            assert!((same.shape().s() - lobe.shape().s()).abs() < 1e-15, "{named}");
            assert_eq!(same.sigma_x(), lobe.sigma_x());
        }
    }

    #[test]
    fn a_fit_is_the_same_for_any_number_of_threads() {
        // Enough samples for several chunks.
        let fitter = Fitter { levels: [[18, 36], [6, 12], [3, 6]].map(Samples::new) };
        let [_, _, last] = &fitter.levels;
        assert!(last.len() > 2 * Samples::CHUNK);
        let lobe = StudentT::new(0.2, 1.7).unwrap();
        let mut measured = Measured { channels: [0, 1, 2].map(|_| vec![-1.0; CELLS]) };
        for samples in &fitter.levels {
            for (i, specular) in samples.specular(&Lobe::StudentT(lobe)).into_iter().enumerate() {
                for (c, channel) in measured.channels.iter_mut().enumerate() {
                    // Off by up to a fifth, without order.
                    let off = 0.2 * (i as f64 * (1.0 + c as f64)).sin();
                    channel[samples.index[i]] = (0.1 + 0.5 * specular) * (1.0 + off);
                }
            }
        }
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| fitter.fit(&measured, &Meter::default()).unwrap())
        });
        assert_eq!(one, three);
        assert!(one.student_t.error < one.ggx.error, "{one:?}");
    }
}
