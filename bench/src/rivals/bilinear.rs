//! The simplest table: the inverse CDFs, interpolated linearly along every axis, at any number of
//! nodes.
//!
//! The values, axes and mappings are those of the real tables, but without slopes: this shows what
//! cubic interpolation along the random numbers is worth.

use glam::Vec3;
use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::Tables;
use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::{Kind, Mapping};
use wide::f32x4;

/// Bound to one shape.
pub(crate) struct Bilinear {
    sigma: f32,
    s: f32,
    /// Distances from the nearer end: rows by view, both halves of u₁.
    along: Vec<f32>,
    rows: usize,
    /// The coordinate of a view, in rows.
    lines: Lines,
    numbers: usize,
    across: Vec<f32>,
}

impl Bilinear {
    /// From a set that holds slices at γ alone.
    pub(crate) fn new(sigma: f64, gamma: f64, set: &Tables) -> Self {
        let of = |kind| set.table(kind).expect("a slice has tables of both kinds");
        let values = |kind| of(kind).values.iter().step_by(2).copied().collect::<Vec<f32>>();
        let axes = &of(Kind::VisibleSlope).axes;
        let Mapping::HalfTangent(view) = axes[1].mapping else { unreachable!("validated on load") };
        let rows = axes[1].nodes.len() - 1;
        Self {
            sigma: sigma as f32,
            s: s_of_gamma(gamma) as f32,
            along: values(Kind::VisibleSlope),
            rows,
            lines: view.lines(rows as f32),
            numbers: axes[2].nodes.len(),
            across: values(Kind::VisibleSlopeConditional),
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.along[..]) + size_of_val(&self.across[..])
    }

    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let (x, y) = (self.sigma * v.x, self.sigma * v.y);
        let rho2 = x * x + y * y;
        // The roots of the view, and the first of the two roots of (2 min(u, 1−u))^(1/4), in lanes
        // as in the real tables.
        let ends = u.map(|u| (2.0 * u.min(1.0 - u)).max(0.0));
        let roots = f32x4::new([rho2, rho2 + v.z * v.z, ends[0], ends[1]]).sqrt();
        let [rho, length, ..] = roots.to_array();
        let [.., t0, t1] = roots.sqrt().to_array();
        let ratios = f32x4::new([x, y, v.z, 0.0]) / f32x4::new([rho, rho, rho + length, 1.0]);
        let [cos, sin, tau, _] = ratios.to_array();
        let (cos, sin) = if rho > 0.0 { (cos, sin) } else { (1.0, 0.0) };
        let Lines { cells, slopes: [first, middle, last], second } = self.lines;
        let rest = 1.0 - tau;
        let place = (first * tau).max(second - middle * rest).max(cells - last * rest);
        let (row, between) = locate(place, self.rows);
        let (cell, w) = locate(t0 * (self.numbers - 1) as f32, self.numbers - 1);
        let at = row * 2 * self.numbers + half(u[0]) * self.numbers + cell;
        let (low, high) = (&self.along[at..at + 2], &self.along[at + 2 * self.numbers..][..2]);
        let (low, high) = (mix(low, w), mix(high, w));
        let (x, z) = slope(mix(&[low, high], between), u[0]);
        let (cell, w) = locate(t1 * (self.across.len() - 1) as f32, self.across.len() - 1);
        let (tx, tz) = slope(mix(&self.across[cell..cell + 2], w), u[1]);
        let y = (z * z + self.s * x * x).sqrt() * tx;
        let (x, z) = (x * tz, z * tz);
        let m = Vec3::new(self.sigma * (x * cos - y * sin), self.sigma * (x * sin + y * cos), z);
        m * (1.0 / m.dot(m).sqrt())
    }
}

#[inline(always)]
fn mix(pair: &[f32], w: f32) -> f32 {
    pair[0] + w * (pair[1] - pair[0])
}

#[inline(always)]
fn locate(x: f32, cells: usize) -> (usize, f32) {
    let cell = (x as i32).clamp(0, cells as i32 - 1) as usize;
    (cell, x - cell as f32)
}

/// Which half of the numbers, without a branch: it would be mispredicted in half of all calls.
#[inline(always)]
fn half(u: f32) -> usize {
    usize::from(u > 0.5)
}

/// A slope x : z from the distance of its half tangent from the end that is nearer for u.
#[inline(always)]
fn slope(g: f32, u: f32) -> (f32, f32) {
    ((2.0 - 2.0 * g) * (2.0 * half(u) as f32 - 1.0), g * (2.0 - g))
}
