//! Albedos of one material as functions of the view.

use alloc::vec::Vec;

use super::collapse::{Weights, collapse};
use crate::axis::lagrange::{combine, six};
use crate::axis::{BoundCritical, BoundView};
use crate::format::Table;

/// cos θ in [0, 1]; NaN becomes 0.
pub(super) fn within(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { cos_theta.min(1.0) } else { 0.0 }
}

/// N albedos as functions of the view, the other axes of their table collapsed.
#[derive(Clone, Debug)]
pub struct ViewCurve<const N: usize> {
    nodes: Vec<[f32; N]>,
    view: View,
}

/// The view axis at one material.
#[derive(Clone, Copy, Debug)]
pub(super) enum View {
    Blend(BoundView),
    Critical(BoundCritical),
}

impl<const N: usize> ViewCurve<N> {
    /// Of a table of N channels, at nodes of its axes but the last.
    pub(super) fn new(table: &Table, at: &[Weights], view: View) -> Self {
        Self { nodes: collapse(table, at), view }
    }

    /// The albedos at a view, each in [0, 1]; `cos_theta` outside [0, 1] is taken at the nearer end, NaN at grazing, and beyond
    /// the table's last view, μ₀ of [`ViewBlend`](crate::axis::ViewBlend), they are held constant.
    pub fn eval(&self, cos_theta: f32) -> [f32; N] {
        let (cos, n) = (within(cos_theta), self.nodes.len());
        let (start, weights) = match &self.view {
            View::Blend(view) => six(view.clamped(cos), n),
            View::Critical(view) => view.six(f64::from(cos), n),
        };
        // Interpolation may leave [0, 1] by the table's error.
        combine(&self.nodes, start, &weights).map(|x| x.clamp(0.0, 1.0))
    }

    /// Cosine-weighted averages 2∫₀¹ E(μ) μ dμ, by the midpoint rule in √μ; right to about 1e-5.
    pub fn average(&self) -> [f32; N] {
        const STEPS: u32 = 512;
        let mut sum = [0.0_f64; N];
        for i in 0..STEPS {
            let x = (f64::from(i) + 0.5) / f64::from(STEPS);
            // 2 μ dμ = 4 x³ dx with μ = x², which resolves grazing views.
            for (sum, value) in sum.iter_mut().zip(self.eval((x * x) as f32)) {
                *sum += 4.0 * x * x * x / f64::from(STEPS) * f64::from(value);
            }
        }
        sum.map(|x| x as f32)
    }
}
