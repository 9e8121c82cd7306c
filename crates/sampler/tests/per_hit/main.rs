//! Lobes of σ and γ that differ from hit to hit: against bound lobes and the model, and the laws
//! that hold for both.

mod agreement;
mod continuity;
mod edges;
mod rising;
mod same_bits;

use glam::{DVec3, Vec3};
use microfacet_core::shape::gamma_of_s;
use microfacet_model as model;
use microfacet_sampler::lobe::FamilyLobe;
use microfacet_sampler::{Family, StudentT, Tables};
use microfacet_tables::Interpolation;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const INF: f32 = f32::INFINITY;
/// Both parts and their ends. 1.8 is less in single precision than in double.
const GAMMAS: [f32; 16] =
    [1.501, 1.51, 1.55, 1.6, 1.7, 1.79, 1.8, 1.81, 1.9, 2.0, 2.37, 4.0, 9.0, 40.0, 1e4, INF];
const SIGMAS: [[f32; 2]; 8] =
    [[1e-8; 2], [0.05; 2], [0.5; 2], [3.0; 2], [1e6; 2], [0.1, 0.7], [2.0, 0.02], [1e-8, 1e6]];
/// Polar angles down to the horizon.
const COSINES: [f32; 8] = [1.0, 0.999_999, 0.9, 0.5, 0.1, 0.01, 1e-6, 0.0];

fn family() -> Family {
    Tables::embedded().family().unwrap()
}

fn random() -> StdRng {
    StdRng::seed_from_u64(11)
}

fn numbers(random: &mut StdRng) -> [f32; 2] {
    [random.random(), random.random()]
}

/// The view of a cosine and an azimuth.
fn view(z: f32, phi: f64) -> Vec3 {
    let z = f64::from(z);
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3()
}

/// [`GAMMAS`], and γ between all nodes of all tables.
fn gammas() -> Vec<f32> {
    let mut gammas = GAMMAS.to_vec();
    for table in Tables::embedded().tables() {
        let axis = &table.axes[0];
        if axis.interpolation == Interpolation::Lagrange4 {
            let middles = axis.nodes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
            gammas.extend(middles.map(|s| gamma_of_s(s) as f32));
        }
    }
    gammas
}

/// The bound lobe of the same σ and γ, and the model's.
fn bound(tables: &Tables, lobe: &FamilyLobe) -> (StudentT, model::StudentT) {
    let (sigma, gamma) = (lobe.sigma(), lobe.gamma());
    let truth = model::StudentT::new(sigma.map(f64::from), gamma).unwrap();
    (tables.student_t(sigma, gamma).unwrap(), truth)
}

/// The numbers at which the model gives a normal, along the plane of incidence and across it, and
/// whether the one along is beside the limit between two parts of the distribution.
///
/// Below γ = 1.8 lobes first choose a part: of u along, those to `split` are the part that the
/// table has, in which CDFs are compared. The CDF of all normals rises steeply where a part ends.
fn numbers_of(
    truth: &model::StudentT,
    v: Vec3,
    m: impl Into<Vec3>,
    u: f32,
    split: f32,
) -> ([f64; 2], bool) {
    let (v, m) = (v.as_dvec3(), m.into().as_dvec3());
    let [along, across] = truth.invert_visible_normal(v, m);
    if split >= 1.0 {
        return ([along, across], false);
    }
    let (shape, (unit, [cos, sin])) = (truth.shape(), truth.unit_view(v));
    let x = (m.x / truth.sigma_x() * cos + m.y / truth.sigma_y() * sin) / m.z;
    let (tabulated, k) = (f64::from(split), shape.gamma() - 1.5);
    let along = if u > split {
        1.0 - (1.0 - tabulated) * (-k * (shape.s() * x * x).ln_1p()).exp()
    } else {
        let at = model::SignedSlope { w: shape.asinh_slope(x.abs()), sign: 1_f64.copysign(x) };
        tabulated * model::VisibleSlope::peeled(shape, unit).cdf(at)
    };
    ([along, across], (u - split).abs() < 1e-5)
}

/// Densities have a few ulp of error times this, their exponent.
fn exponent(sigma: [f32; 2], density: f64) -> f64 {
    1.0 + (density * f64::from(sigma[0]) * f64::from(sigma[1])).ln().abs()
}

/// The largest value, and where it is.
#[derive(Debug, Default)]
struct Worst {
    value: f64,
    at: String,
}

impl Worst {
    fn see(&mut self, value: f64, at: impl FnOnce() -> String) {
        // A NaN counts as the worst, and stays.
        if value.is_nan() || value > self.value {
            *self = Self { value, at: at() };
        }
    }

    #[track_caller]
    fn allowed(&self, most: f64) {
        assert!(self.value <= most, "{:e} of {most:e} at {}", self.value, self.at);
    }
}
