//! Tests whether drawn normals have the model's distribution, for one lobe and view at a time.

use glam::{DVec3, Vec3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::chi_square::{ChiSquare, chi_square};
use crate::distribution::MicrofacetDistribution;
use crate::{Shape, SignedSlope, StudentT, VisibleSlope, across_cdf, across_quantile};

/// Cells of the χ² in unit space, along the plane of incidence and across it.
const CELLS: [usize; 2] = [32, 16];
/// Cells of the in-plane slope at whose edges the empirical CDF is compared.
const KS_EDGES: usize = 256;
/// Cells of the χ² in the tangent frame, along radius and azimuth.
const WORLD: [usize; 2] = [10, 16];
/// Unit slopes beyond this go to the last cell: samplers keep normals a little above the horizon.
const LARGEST_SLOPE: f64 = 1e15;

/// Outcome of the tests for one lobe and view.
#[derive(Clone, Copy, Debug)]
pub struct NormalsTest {
    /// χ² over in-plane slope and slope across, with expected counts by the model's CDFs.
    pub lobe: ChiSquare,
    /// χ² over the hemisphere of normals in the tangent frame, with expected counts by quadrature
    /// of the analytic density.
    pub world: ChiSquare,
    /// Kolmogorov–Smirnov distance of the in-plane slope, over 256 edges.
    pub ks: f64,
}

impl NormalsTest {
    /// The smaller p-value of the two χ² tests.
    pub fn p(&self) -> f64 {
        self.lobe.p.min(self.world.p)
    }
}

/// Draws `samples` normals with `draw(u)`, u uniform in [0, 1)², and tests them against the visible
/// normals of `truth` for the view `v`, a unit vector in the tangent frame.
///
/// Any sampler can be tested, with tables or without. `truth` may deliberately differ from the lobe
/// that is drawn from, to check that the tests reject.
pub fn test_visible_normals(
    truth: &StudentT,
    v: DVec3,
    samples: usize,
    seed: u64,
    mut draw: impl FnMut([f32; 2]) -> Vec3,
) -> NormalsTest {
    let grid = LobeGrid::new(truth, v);
    let inverse_area = truth.inverse_area(v);
    let world = WorldGrid::new(truth, |m| v.dot(m).max(0.0) * truth.d(m) * inverse_area);
    let mut lobe_counts = vec![0_u64; grid.along.len() * grid.across.len()];
    let mut world_counts = vec![0_u64; WORLD[0] * WORLD[1]];
    let mut ks_counts = vec![0_u64; grid.ks.len()];
    let mut random = StdRng::seed_from_u64(seed);
    for _ in 0..samples {
        let m = draw([random.random(), random.random()]).as_dvec3();
        let [x, t] = grid.slopes(m);
        lobe_counts[cell(&grid.along, x) * grid.across.len() + cell(&grid.across, t)] += 1;
        ks_counts[cell(&grid.ks, x)] += 1;
        world_counts[world.cell(m)] += 1;
    }
    let n = samples as f64;
    let row = |a: &f64| grid.across_share.iter().map(|b| a * b * n).collect::<Vec<f64>>();
    let lobe_expected: Vec<f64> = grid.along_share.iter().flat_map(row).collect();
    let mut below = 0;
    let ks = ks_counts.iter().zip(&grid.ks_cdf).fold(0.0, |worst: f64, (&count, cdf)| {
        below += count;
        worst.max((below as f64 / n - cdf).abs())
    });
    NormalsTest {
        lobe: chi_square(&lobe_counts, &lobe_expected),
        world: world.test(&world_counts, samples),
        ks,
    }
}

/// Draws `samples` normals with `draw(u)`, u uniform in [0, 1)², and tests them against the density
/// `pdf` by a χ² over the hemisphere of normals in the tangent frame.
///
/// The cells are those of a lobe, such that each holds as many normals of D.
pub fn test_normals(
    lobe: &StudentT,
    pdf: impl Fn(DVec3) -> f64,
    samples: usize,
    seed: u64,
    mut draw: impl FnMut([f32; 2]) -> Vec3,
) -> ChiSquare {
    let world = WorldGrid::new(lobe, pdf);
    let mut counts = vec![0_u64; WORLD[0] * WORLD[1]];
    let mut random = StdRng::seed_from_u64(seed);
    for _ in 0..samples {
        counts[world.cell(draw([random.random(), random.random()]).as_dvec3())] += 1;
    }
    world.test(&counts, samples)
}

/// Index of the first upper edge ≥ x; the last edge is ∞.
fn cell(upper_edges: &[f64], x: f64) -> usize {
    upper_edges.partition_point(|&edge| edge < x).min(upper_edges.len() - 1)
}

/// Cells in the plane of incidence and across it, as upper edges in unit slopes, with their
/// probabilities.
struct LobeGrid {
    sigma: [f64; 2],
    s: f64,
    azimuth: [f64; 2],
    along: Vec<f64>,
    along_share: Vec<f64>,
    across: Vec<f64>,
    across_share: Vec<f64>,
    ks: Vec<f64>,
    ks_cdf: Vec<f64>,
}

impl LobeGrid {
    fn new(truth: &StudentT, v: DVec3) -> Self {
        let (view, azimuth) = truth.unit_view(v);
        let shape = truth.shape();
        let slopes = VisibleSlope::new(shape, view);
        let along =
            |count: usize| upper_edges(count, |u| slopes.quantile(u), |x| slopes.cdf(x), shape);
        let (along_edges, along_cdf) = along(CELLS[0]);
        let (ks, ks_cdf) = along(KS_EDGES);
        let (across, across_cdf) =
            upper_edges(CELLS[1], |u| across_quantile(shape, u), |t| across_cdf(shape, t), shape);
        Self {
            sigma: [truth.sigma_x(), truth.sigma_y()],
            s: shape.s(),
            azimuth,
            along: along_edges,
            along_share: shares(&along_cdf),
            across,
            across_share: shares(&across_cdf),
            ks,
            ks_cdf,
        }
    }

    /// Unit slopes of a normal: x towards the viewer, and y/√(1 + s x²) across.
    fn slopes(&self, m: DVec3) -> [f64; 2] {
        let (a, b) = (m.x / self.sigma[0], m.y / self.sigma[1]);
        let [cos, sin] = self.azimuth;
        let (x, y) = (a * cos + b * sin, b * cos - a * sin);
        [x / m.z, y / (m.z * m.z + self.s * x * x).sqrt()]
    }
}

/// Upper edges of `count` cells of equal probability and the CDF there, both ending at (∞, 1).
fn upper_edges(
    count: usize,
    quantile: impl Fn(f64) -> SignedSlope,
    cdf: impl Fn(SignedSlope) -> f64,
    shape: &Shape,
) -> (Vec<f64>, Vec<f64>) {
    let (mut edges, mut values) = (Vec::new(), Vec::new());
    for i in 1..count {
        let at = quantile(i as f64 / count as f64);
        let slope = at.sign * shape.slope(at.w);
        // Where the tail leaves no room for more cells, the last one takes the rest.
        if slope < LARGEST_SLOPE && edges.last().is_none_or(|&last| slope > last) {
            edges.push(slope);
            values.push(cdf(at));
        }
    }
    edges.push(f64::INFINITY);
    values.push(1.0);
    (edges, values)
}

fn shares(cdf: &[f64]) -> Vec<f64> {
    let below = [0.0].iter().chain(cdf);
    cdf.iter().zip(below).map(|(high, low)| high - low).collect()
}

/// Cells of the hemisphere in the tangent frame, rings of unit slope by azimuth. They are fixed to
/// the surface and not to the view, so that a wrong frame, rotation or sign shows.
struct WorldGrid {
    sigma: [f64; 2],
    rings: Vec<f64>,
    share: Vec<f64>,
    whole_last_ring: bool,
}

impl WorldGrid {
    fn new(truth: &StudentT, pdf: impl Fn(DVec3) -> f64) -> Self {
        let sigma = [truth.sigma_x(), truth.sigma_y()];
        let rings: Vec<f64> = (1..WORLD[0])
            .map(|i| truth.shape().slope_radius(i as f64 / WORLD[0] as f64))
            .chain([f64::INFINITY])
            .collect();
        let scale = sigma[0] * sigma[1];
        let density = |r: f64, psi: f64| {
            let (x, y) = (sigma[0] * r * libm::cos(psi), sigma[1] * r * libm::sin(psi));
            let m = DVec3::new(x, y, 1.0).normalize();
            // dm = cos³θ dx̃ dỹ in world slopes, which are σ times unit slopes.
            pdf(m) * scale * (m.z * m.z * m.z) * r
        };
        let step = 2.0 * std::f64::consts::PI / WORLD[1] as f64;
        let mut share = Vec::with_capacity(WORLD[0] * WORLD[1]);
        for (i, &outer) in rings.iter().enumerate() {
            let inner = if i == 0 { 0.0 } else { rings[i - 1] };
            for j in 0..WORLD[1] {
                let from = j as f64 * step;
                // r = inner/w covers the tail; dr = inner/w² dw.
                let tail = |w: f64, psi| density(inner / w, psi) * inner / (w * w);
                share.push(match outer.is_finite() {
                    true => integrate([inner, outer], [from, from + step], density),
                    false => integrate([0.0, 1.0], [from, from + step], tail),
                });
            }
        }
        // Near γ = 3/2 the tail is too heavy for this quadrature, which misses what lies next to
        // the horizon: the outermost ring is then one cell that holds the rest.
        let inside: f64 = share[..(WORLD[0] - 1) * WORLD[1]].iter().sum();
        let total: f64 = share.iter().sum();
        let whole_last_ring = (total - 1.0).abs() > 1e-4;
        if whole_last_ring {
            let last = (WORLD[0] - 1) * WORLD[1];
            share[last..].fill(0.0);
            share[last] = 1.0 - inside;
        }
        Self { sigma, rings, share, whole_last_ring }
    }

    fn test(&self, counts: &[u64], samples: usize) -> ChiSquare {
        // The quadrature can miss a cell of which only a corner faces the view: such a cell is
        // pooled, not taken as impossible.
        let expected: Vec<f64> =
            self.share.iter().map(|share| share.max(1e-12) * samples as f64).collect();
        chi_square(counts, &expected)
    }

    fn cell(&self, m: DVec3) -> usize {
        let (x, y) = (m.x / self.sigma[0], m.y / self.sigma[1]);
        let ring = cell(&self.rings, libm::hypot(x, y) / m.z);
        if self.whole_last_ring && ring == WORLD[0] - 1 {
            return ring * WORLD[1];
        }
        let turn = libm::atan2(y, x) / (2.0 * std::f64::consts::PI);
        let sector = ((turn + 1.0).fract() * WORLD[1] as f64) as usize;
        ring * WORLD[1] + sector.min(WORLD[1] - 1)
    }
}

/// Midpoint rule with 32² points: the integrand has a kink where normals turn away from the view,
/// so that a higher order gains nothing.
fn integrate(a: [f64; 2], b: [f64; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    const POINTS: usize = 32;
    let [da, db] = [a, b].map(|[low, high]| (high - low) / POINTS as f64);
    let at = |from: f64, step: f64, i: usize| from + (i as f64 + 0.5) * step;
    let all = (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j)));
    all.map(|(i, j)| f(at(a[0], da, i), at(b[0], db, j))).sum::<f64>() * da * db
}
