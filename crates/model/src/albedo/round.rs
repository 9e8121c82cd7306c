//! The reflection albedo of lobes that are equally rough along both axes: fewer rays, each of which
//! is evaluated once.
//!
//! The integrand is even about the azimuth of the view. A substitution that keeps it even and
//! periodic, with c = cos u,
//!
//! ```text
//! cos φ = sinh(K c)/sinh K
//! ```
//!
//! crowds rays at right angles to the view, where R(φ) turns within 1/sinh K. The trapezoid rule
//! over u converges geometrically (Trefethen and Weideman 2014,
//! <https://doi.org/10.1137/130932132>), and halving its step keeps all rays. Where the branch
//! point of Λ(l) matters, u = v + sin v crowds them towards it as well, so that its power of π − φ
//! becomes three times as high.
//!
//! The order along rays is chosen on the rays of the first step, by comparison with the order
//! before.

use core::f64::consts::{FRAC_PI_2, PI};

use super::{AlbedoIntegrator, View};
use crate::converge::{Albedo, Both, CUT, RULES, add, differences, largest};
use crate::panels::Gauss;

/// Shares of the tolerance for the order along rays and for the rays.
const INNER: f64 = 0.4;
const OUTER: f64 = 0.5;
/// The error after the first halving of the step, as a share of the change, and the least share
/// after others. All shares of estimates are such that no estimate was exceeded in 6,020 nodes of
/// the general tables at tolerances of 1e-7, 1e-6 and 1e-5
/// (`cargo run --profile dist -p microfacet-study -- albedo_convergence`).
const FIRST: f64 = 0.3;
const LEAST: f64 = 0.1;
/// What is added to estimates, as a share of the tolerance: two orders agree by chance.
const BASE: f64 = 0.02;

/// The error of an order, as a share of its difference from the order before; rays in between may
/// err more than the first ones.
fn trust(order: usize) -> f64 {
    if order == 1 { 0.5 } else { 0.2 }
}

/// How often the step may be halved.
const HALVINGS: usize = 7;

/// A ray of slopes: cosine and sine of its azimuth from the view's, and its share of the half turn
/// times the step.
struct Ray {
    cos: f64,
    sin: f64,
    share: f64,
}

/// The substitution of the azimuth.
struct Turn {
    /// K.
    crowding: f64,
    /// Whether rays are crowded towards the branch point.
    branch: bool,
}

impl Turn {
    /// Number of steps of half a turn to begin with, such that the second halving usually is the
    /// last, or the first where few steps suffice.
    fn first_steps(&self, tolerance: f64) -> usize {
        // The integrand's singularities lie at c = ±iπ/(2K).
        let strip = libm::asinh(FRAC_PI_2 / self.crowding);
        let last = -0.4 * libm::log(tolerance.min(1e-6)) / strip;
        let [half, quarter] = [0.5, 0.25].map(|share| libm::ceil(share * last) as usize);
        quarter.max(half.clamp(3, 6))
    }

    /// Every `stride`th ray of so many steps, from the first for 1 and from the second for 2; those
    /// without a share are left out.
    fn rays(&self, steps: usize, stride: usize) -> Vec<Ray> {
        let ray = |i: usize| {
            let ray = self.ray(PI * i as f64 / steps as f64);
            let end = i == 0 || i == steps;
            Ray { share: if end { 0.5 * ray.share } else { ray.share }, ..ray }
        };
        (stride - 1..=steps).step_by(stride).map(ray).filter(|ray| ray.share > 0.0).collect()
    }

    /// The ray of v ∈ [0, π].
    fn ray(&self, v: f64) -> Ray {
        let k = self.crowding;
        let (sin_v, cos_v) = libm::sincos(v);
        let (u, rate) = if self.branch { (v + sin_v, 1.0 + cos_v) } else { (v, 1.0) };
        let (sin_u, cos_u) = libm::sincos(u);
        let (sin_half, cos_half) = libm::sincos(0.5 * u);
        let sinh = libm::sinh(k);
        let cos = libm::sinh(k * cos_u) / sinh;
        // sinh²K − sinh²Kc, without cancellation.
        let [near, far] = [sin_half, cos_half].map(|x| libm::sinh(2.0 * k * x * x));
        let sin = (near * far).sqrt() / sinh;
        // At both ends sin u/sin φ has the limit 1/√(K coth K).
        let slope = k * libm::cosh(k * cos_u) / sinh;
        let share = if sin > 1e-8 { slope * sin_u.abs() / sin } else { slope.sqrt() };
        Ray { cos, sin, share: share * rate }
    }
}

impl AlbedoIntegrator {
    /// The albedo for equal roughnesses and reflectances without a kink.
    pub(super) fn round<const N: usize>(
        &self,
        tolerance: f64,
        view: &View,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Albedo<N> {
        let turn =
            Turn { crowding: libm::asinh(1.0 / view.turn.max(1e-9)).max(0.1), branch: view.branch };
        let along = |order: usize, rays: &[Ray]| -> Vec<Both<N>> {
            rays.iter().map(|ray| self.round_ray(&RULES[order], view, ray, &weight)).collect()
        };
        let mut steps = turn.first_steps(tolerance);
        // The share of one step.
        let unit = |steps: usize| 2.0 * view.scale / steps as f64;
        let rays = turn.rays(steps, 1);
        let mut order = match tolerance {
            t if t < 2e-8 => 3,
            t if t < 2e-6 => 2,
            _ => 1,
        };
        let (mut worse, mut parts) = (along(order - 1, &rays), along(order, &rays));
        let inner = loop {
            let mut off = [[0.0; N]; 2];
            add_rays(&mut off, &rays, parts.iter().zip(&worse).map(|(a, b)| differences(a, b)));
            let inner = trust(order) * unit(steps) * largest(&off);
            if inner < INNER * tolerance || order + 1 == RULES.len() {
                break inner;
            }
            order += 1;
            worse = parts;
            parts = along(order, &rays);
        };
        let mut sum = [[0.0; N]; 2];
        add_rays(&mut sum, &rays, parts);
        let whole = |sum: &Both<N>, steps: usize| sum.map(|form| form.map(|x| x * unit(steps)));
        let mut before = whole(&sum, steps);
        let (mut outer, mut last) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..HALVINGS {
            steps *= 2;
            // The rays of the longer step are kept.
            let rays = turn.rays(steps, 2);
            add_rays(&mut sum, &rays, along(order, &rays));
            let now = whole(&sum, steps);
            let change = largest(&differences(&now, &before));
            // The change falls at least geometrically.
            outer = change
                * match last {
                    f64::INFINITY => FIRST,
                    0.0 => 0.0,
                    last => (4.0 * change / last).clamp(LEAST, 2.0),
                };
            (before, last) = (now, change);
            if outer < OUTER * tolerance {
                break;
            }
        }
        Albedo::new(before, inner + outer + (BASE + 10.0 * CUT) * tolerance)
    }

    /// The integral along one ray of slopes from m = n to the rim.
    fn round_ray<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        ray: &Ray,
        weight: &impl Fn(f64) -> [f64; N],
    ) -> Both<N> {
        let sigma = view.sigma[0];
        let a = sigma * sigma;
        let b = sigma * view.sin * ray.cos;
        let across = |l_z: f64, _, _| (a * (1.0 - l_z) * (1.0 + l_z)).max(0.0);
        self.along_ray(rule, view, [a, b, ray.sin], weight, across)
    }
}

fn add_rays<const N: usize>(
    sum: &mut Both<N>,
    rays: &[Ray],
    parts: impl IntoIterator<Item = Both<N>>,
) {
    rays.iter().zip(parts).for_each(|(ray, part)| add(sum, ray.share, &part));
}
