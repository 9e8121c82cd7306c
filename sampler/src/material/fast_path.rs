//! Visible normals as [`sample`](super::sample) draws them, faster, for common lobes and views. An
//! [`Ellipsoid`](crate::Ellipsoid) takes the same path from its own view to its own normal.
//!
//! A row of the table of in-plane slopes belongs to a view, by its coordinate τ = z/(ρ + √(ρ²+z²));
//! a node of the row holds g, the distance of a slope's half tangent from the end of its half of
//! u₁, and the silhouette of the view is g = 1 − τ in the first half. Slopes across the plane have
//! one row.
//!
//! What makes it fast, and the share of the general path's time that each step saved:
//! - Masks instead of branches for the halves of u₁ and u₂ (a random number is above ½ as often as
//!   not, and a mispredicted branch costs as much as the lookup), and one conversion of coordinates
//!   to cells for both numbers: a third.
//! - Square roots side by side, none in a chain with another where the formulas allow: a tenth.
//! - The test whether the normal is visible, as a lower limit on g that is known before the normal
//!   is, instead of v·m afterwards: 4 %.
//! - One test for all table reads, after all index arithmetic, so that the chain from the view
//!   through its row to the normal starts at once: 3 %.
//! - The cubic along u₁ as a weighted sum, a chain half as long as Horner's: 3 %.

use wide::{bytemuck, f32x4, i32x4};

use super::student_t::{SHORT, StudentT};
use crate::axis::half_tangent::{half_slope_at, of_views};
use crate::axis::hermite::{Node, basis, cubic, split};
use crate::axis::roots;
use crate::lanes::{pairs, pairs_of_firsts, sum, swap_pairs};

impl StudentT {
    /// `None` where the case is not [common](Self::sample_common).
    #[inline(always)]
    pub(crate) fn sample_fast(&self, v: [f32; 3], u: [f32; 2]) -> Option<[f32; 3]> {
        let sigma = [self.sigma_x, self.sigma_y];
        // Unnamed lanes carry copies, zeros or NaN.
        let xy = f32x4::new([v[0], v[1], 0.0, 0.0]) * f32x4::new([sigma[0], sigma[1], 0.0, 0.0]);
        self.sample_common(xy, v[2], u, sigma, |m| m)
    }

    /// The normal visible along a stretched view: drawn there, stretched by `sigma`, then taken
    /// through `to_tangent` and normalised.
    ///
    /// `None` outside the common case: lobes without a [`FastPath`](super::slices::FastPath), views
    /// straight from above or below, normals that rounding may have put behind the silhouette, and
    /// arguments that are out of range or NaN.
    #[inline(always)]
    pub(crate) fn sample_common(
        &self,
        xy: f32x4,
        z: f32,
        u: [f32; 2],
        [sx, sy]: [f32; 2],
        to_tangent: impl FnOnce(f32x4) -> f32x4,
    ) -> Option<[f32; 3]> {
        let fast = self.slices.fast.as_ref()?;
        let z = f32x4::splat(if z > 0.0 { z } else { 0.0 });
        let squares = xy * xy;
        let rho2 = squares + swap_pairs(squares);
        let (rho, length) = (rho2.sqrt(), (rho2 + z * z).sqrt());

        // The row at τ = z/(ρ + length).
        let at = of_views(rho, z, length, fast.rows);
        let (row, between) = split(at);
        let (row, between) = (row.to_array()[0] as u32, f32x4::splat(between.to_array()[0]));

        // Both random numbers in two lanes: fourth roots, cells and positions.
        let u = f32x4::new([u[0], u[1], 0.0, 0.0]);
        let t = roots(u) * f32x4::new([fast.scales[0], fast.scales[1], 0.0, 0.0]);
        let (cell, w) = split(t);
        let w = w.to_array();
        let towards = u.simd_gt(0.5);
        let sign = towards & f32x4::splat(-0.0);
        let half: i32x4 = bytemuck::cast(towards);
        let cell = (cell + (half & i32x4::new([fast.half as i32, 0, 0, 0]))).to_array();

        // The guard cell makes every random number's cell valid. Straight from above there is no
        // next row. NaN fails here or, where it converts to 0, in the test of g.
        let stride = 2 * fast.half;
        let low = start(row, stride, cell[0]);
        let (high, across) = (low + stride as usize, cell[1] as u32 as usize);
        let nodes = &self.slices.slope[..];
        if !(high + 2 <= nodes.len() && across < fast.across.len() && rho.to_array()[0] >= SHORT) {
            return None;
        }

        // The slope across; then the factors of the in-plane slope and of its norm.
        let g_across = cubic(&fast.across[across], w[1]);
        let t = f32x4::splat((g_across - 1.0) / (g_across * (2.0 - g_across)));
        let view = pairs(xy, rho);
        let ahead = view * f32x4::new([2.0 * sx, 2.0 * sy, 1.0, 0.0]);
        let aside = swap_pairs(view)
            * f32x4::new([-2.0 * sx, 2.0 * sy, 0.0, 0.0])
            * f32x4::splat((t ^ sign).to_array()[1]);
        let silhouette = !towards & (1.0 - at * fast.inverse_rows);
        let min_g = silhouette + (SILHOUETTE_MARGIN - t * SILHOUETTE_MARGIN_ACROSS);

        // Interpolation between the rows, then along u₁.
        let (low, high) = (pair(nodes, low), pair(nodes, high));
        let g = sum((low + between * (high - low)) * basis(f32x4::splat(w[0])));
        if !(g.to_array()[0] >= min_g.to_array()[0]) {
            return None;
        }
        // Half of x, then z, and the norm √(z² + s x²).
        let [x, z] = half_slope_at(g);
        let norm = (z * z + f32x4::splat(4.0 * self.s) * (x * x)).sqrt();
        let m = to_tangent(pairs_of_firsts(x ^ sign, z) * ahead + norm * aside);
        let [x, y, z, _] = (m / sum(m * m).sqrt()).to_array();
        Some([x, y, z])
    }
}

/// How far, in g, a normal must be from the silhouette so that no rounding can hide it.
///
/// With g₀ the silhouette and t half the tangent of the tilt across, v·m = (g − g₀)(ρ + …) ρ/|m| ≥
/// (g − g₀) ρ length/|m| stands against ten roundings of terms that sum to at most ρ length (3 + 6
/// |t|)/|m|, whatever σ is. The margin also keeps normals off the horizon and all squares in range.
pub(crate) const SILHOUETTE_MARGIN: f32 = 2e-6;
/// The part of the margin that grows with |t|.
pub(crate) const SILHOUETTE_MARGIN_ACROSS: f32 = 4e-6;

/// The index of a cell in a row, less than 2³¹ so that sums with it fit; arbitrary where either was
/// NaN.
#[inline(always)]
pub(crate) fn start(row: u32, stride: u32, cell: i32) -> usize {
    (row.wrapping_mul(stride).wrapping_add(cell as u32) & (u32::MAX >> 1)) as usize
}

/// The two nodes from `at` on.
#[inline(always)]
pub(crate) fn pair(nodes: &[Node], at: usize) -> f32x4 {
    let [a, b] = [nodes[at], nodes[at + 1]];
    f32x4::new([a[0], a[1], b[0], b[1]])
}
