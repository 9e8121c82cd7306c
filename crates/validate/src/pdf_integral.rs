//! Tests that `table_pdf` integrates to one, by quadrature over the pieces on which it is smooth.

use std::f64::consts::FRAC_PI_2;

use glam::Vec3;

use microfacet_core::gauss_legendre;
use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::Lobe;
use microfacet_sampler::lobe::Tabulated;
use microfacet_tables::axis::half_tangent::{ends, rate, slope_at};

/// Parts of each interval between joints, since 1/(a cubic's derivative) is not a polynomial.
const PARTS: usize = 8;
/// Slopes beyond this are left to the closed form of the tail.
const FAR: f64 = 1e12;

/// Number of pieces for the density of closed forms, which has no joints.
const PIECES: usize = 32;

/// ∫ table_pdf(v, m) dm for a lobe of the family with σ = 1 and a view in the plane y = 0.
///
/// The tabulated part is integrated between its joints, in the half tangent, by Gauss–Legendre.
/// Where the heavy part is peeled, its share beyond all representable slopes is added in closed
/// form, since no quadrature of an f32 density reaches it.
pub fn integral(lobe: &Lobe, gamma: f64, v: Vec3) -> f64 {
    let s = s_of_gamma(gamma);
    let ([mut along, mut across], tabulated) = match lobe {
        Lobe::StudentT(lobe) => (lobe.table_joints(v), lobe.tabulated_share(v)),
        _ => (ggx_joints(v), 1.0),
    };
    let peeled = tabulated < 1.0;
    along.push(0.0);
    // The outermost cells hold decades of slope, in which the density falls like a power of the
    // distance from the end.
    let (first, last) = (along[0].max(-FAR), along[along.len() - 2].min(FAR));
    let decades = (2..24).map(|i| 10f64.powf(f64::from(i) * 0.5));
    along.extend(decades.flat_map(|x| [-x, x]).filter(|&x| x > first && x < last));
    if peeled {
        // The heavy part is smooth in x, but over many decades.
        along.extend((-8..80).map(|i| 10f64.powf(f64::from(i) * 0.15)));
        along.push(FAR);
    }
    for joints in [&mut along, &mut across] {
        joints.iter_mut().for_each(|x| *x = x.clamp(-FAR, FAR));
        joints.sort_by(f64::total_cmp);
    }
    let density = |x: f64, t: f64| {
        let root = (1.0 + s * x * x).sqrt();
        let y = root * t;
        let r = (1.0 + x * x + y * y).sqrt();
        let m = Vec3::new((x / r) as f32, (y / r) as f32, (1.0 / r) as f32);
        // dm = cos³θ dx dy, dy = √(1 + s x²) dt; both signs of t.
        2.0 * f64::from(lobe.table_pdf(v, m)) * root / (r * r * r)
    };
    // The density is a function of x times a function of t, so the sum over the grid is that of a
    // row times that of a column, divided by the value where they cross. (The χ² tests check that x
    // and t are drawn independently.)
    let (t0, x_nodes) = (0.3, nodes(&along));
    let row: Vec<f64> = x_nodes.iter().map(|&(x, _)| density(x, t0)).collect();
    let along_sum: f64 = row.iter().zip(&x_nodes).map(|(f, (_, dx))| f * dx).sum();
    // The row's median is used: at the largest density there may be a spike as narrow as the
    // rounding of m.
    let mut below = 0.0;
    let median = row.iter().zip(&x_nodes).position(|(f, (_, dx))| {
        below += f * dx;
        // The halves of a row meet in an interval as narrow as rounding, where one node cannot
        // represent the density.
        below >= 0.5 * along_sum && *dx > 1e-4
    });
    let Some(top) = median else { return f64::NAN };
    let across_sum: f64 =
        nodes(&across).iter().map(|&(t, dt)| density(x_nodes[top].0, t) * dt).sum();
    let mut sum = along_sum * across_sum / row[top];
    if peeled {
        let heavy = 1.0 - f64::from(tabulated);
        sum += heavy * (-(gamma - 1.5) * (s * FAR * FAR).ln_1p()).exp();
    }
    sum
}

/// Quantiles of the in-plane slope of GGX with α = 1 and, for t ≥ 0, slopes across.
fn ggx_joints(v: Vec3) -> [Vec<f64>; 2] {
    let (sin_theta, cos_theta) = (f64::from(v.x), f64::from(v.z));
    let theta = libm::atan2(sin_theta, cos_theta);
    let share = |i: usize| i as f64 / PIECES as f64;
    // sin(α − θ) of the tilt α is uniform between the silhouette, α = θ − π/2, and the horizon,
    // α = π/2.
    let tilt = |i| theta + libm::asin((share(i) * (1.0 + cos_theta) - 1.0).clamp(-1.0, 1.0));
    let along = (0..PIECES).map(|i| libm::tan(tilt(i))).chain([f64::INFINITY]);
    let across = (0..PIECES).map(|i| libm::tan(share(i) * FRAC_PI_2)).chain([f64::INFINITY]);
    [along.collect(), across.collect()]
}

/// Slopes and weights of a composite Gauss–Legendre rule between ascending joints (0 among them
/// where they change sign), in each interval over the distance of the half tangent from its end.
fn nodes(joints: &[f64]) -> Vec<(f64, f64)> {
    const RULE: [(f64, f64); 8] = gauss_legendre();
    let mut all = Vec::new();
    for pair in joints.windows(2) {
        let sign = if pair[0] < 0.0 { -1.0 } else { 1.0 };
        let [a, b] = [pair[0], pair[1]].map(|x| ends(x.abs(), 1.0)[1]);
        let width = (b - a).abs() / PARTS as f64;
        for part in 0..PARTS {
            for (node, weight) in RULE {
                let [x, z] = slope_at(a.min(b) + width * (part as f64 + node));
                all.push((sign * x / z, weight * width / rate(x, z)));
            }
        }
    }
    all
}
