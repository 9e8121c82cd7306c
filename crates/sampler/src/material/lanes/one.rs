//! A visible normal of one view, fast for common lobes and views. An
//! [`Ellipsoid`](crate::Ellipsoid) uses the same code between its own view and normal.
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
//! - Square roots in parallel, none in a chain with another where the formulas allow: a tenth.
//! - The test whether the normal is visible, as a lower limit on g that is known before the normal
//!   is, instead of v·m afterwards: 4 %.
//! - One test for all table reads, after all index arithmetic, so that the chain from the view
//!   through its row to the normal starts at once: 3 %.
//! - The cubic along u₁ as a weighted sum, a chain half as long as Horner's: 3 %.

use glam::Vec3;
use microfacet_lanes::Lanes;
use wide::{bytemuck, f32x4, i32x4};

use microfacet_tables::axis::half_tangent::half_slope_at;
use microfacet_tables::axis::hermite::{Node, basis, split};
use microfacet_tables::axis::roots;

use super::many::sample_general;
use super::views::View;
use super::{first_three, pairs, pairs_of_firsts, sum, swap_pairs};
use crate::material::heavy::{Part, half_slopes};
use crate::material::horizon::HORIZON;
use crate::material::surface::{Shape, Surface};

impl<S: Shape> Surface<S> {
    /// A visible normal, by the fast path where it serves and by the general path elsewhere.
    #[inline(always)]
    pub(crate) fn sample(self, v: Vec3, u: [f32; 2]) -> Vec3 {
        if self.shape.peeled() {
            return self.sample_heavy(v, &self.view::<true>(v), u);
        }
        let m = draw::<S, false>(self.shape, &self.view::<false>(v), u, self.scales.sigma, |m| m);
        m.map_or_else(|| self.general(v, u), first_three)
    }

    /// A visible normal of any length, where that is faster; its squares are in range.
    #[inline(always)]
    pub(crate) fn sample_along(self, v: Vec3, u: [f32; 2]) -> Vec3 {
        if self.shape.peeled() {
            return self.sample_heavy(v, &self.view::<true>(v), u);
        }
        let view = self.view::<false>(v);
        let m = Reads::new::<S, false>(self.shape, &view, u)
            .and_then(|reads| draw_along::<S, false>(self.shape, &view, &reads, self.scales.sigma));
        m.map_or_else(|| self.general(v, u), |(m, _)| first_three(m))
    }

    /// [`sample`](Self::sample) of a shape with a heavy part, along a view that is located.
    #[inline(always)]
    pub(crate) fn sample_heavy(self, v: Vec3, view: &View, u: [f32; 2]) -> Vec3 {
        let m = draw::<S, true>(self.shape, view, u, self.scales.sigma, |m| m);
        m.map_or_else(|| self.general(v, u), first_three)
    }

    /// The general path, by scalar arguments, which keep the common case in registers.
    #[inline(always)]
    fn general(self, v: Vec3, u: [f32; 2]) -> Vec3 {
        sample_general::<S>(self.shape.seed(), self.scales.sigma, v.x, v.y, v.z, u)
    }
}

/// The normal visible along a view: drawn in unit space, stretched by `sigma`, then transformed
/// by `to_tangent` and normalised.
///
/// `None` outside the common case: normals that rounding may have put behind the silhouette,
/// and arguments that are out of range or NaN.
#[inline(always)]
pub(crate) fn draw<S: Shape, const HEAVY: bool>(
    shape: S,
    view: &View,
    u: [f32; 2],
    sigma: [f32; 2],
    to_tangent: impl FnOnce(f32x4) -> f32x4,
) -> Option<f32x4> {
    let reads = Reads::new::<S, HEAVY>(shape, view, u)?;
    draw_located::<S, HEAVY>(shape, view, &reads, sigma, to_tangent)
}

/// [`draw`] by reads that are known already.
#[inline(always)]
pub(crate) fn draw_located<S: Shape, const HEAVY: bool>(
    shape: S,
    view: &View,
    reads: &Reads,
    sigma: [f32; 2],
    to_tangent: impl FnOnce(f32x4) -> f32x4,
) -> Option<f32x4> {
    let (m, shrink) = draw_along::<S, HEAVY>(shape, view, reads, sigma)?;
    let m = to_tangent(m);
    let m = m / sum(m * m).sqrt();
    let lowest = f32x4::new([-1.0, -1.0, HORIZON, 0.0]);
    Some(if HEAVY { (m * shrink).fast_max(lowest) } else { m })
}

/// Where a view and two random numbers read the tables. All places are in range.
pub(crate) struct Reads {
    /// Nodes along the plane of incidence, in the rows below and above the view, and where it is
    /// between them.
    pub(crate) low: usize,
    pub(crate) high: usize,
    pub(crate) between: f32,
    /// The cell across the plane.
    pub(crate) across: usize,
    /// The coordinates along the plane and across it in cells, and in their cells.
    pub(crate) t: f32x4,
    pub(crate) w: [f32; 4],
    /// All ones where a number is above ½.
    pub(crate) towards: f32x4,
    /// The number within the heavy part, where that is drawn from.
    pub(crate) tail: Option<f32>,
}

impl Reads {
    /// `None` for NaN.
    #[inline(always)]
    pub(crate) fn new<S: Shape, const HEAVY: bool>(
        shape: S,
        view: &View,
        u: [f32; 2],
    ) -> Option<Self> {
        let (row, between) = split(view.at);
        let (row, between) = (row.to_array()[0] as u32, between.to_array()[0]);

        // Both random numbers in two lanes: fourth roots, cells and positions.
        let (mut along, mut tail) = (u[0], None);
        if HEAVY && shape.peeled() {
            match shape.part(along, view.at.to_array()[0]) {
                Part::Tabulated(number) => along = number,
                Part::Heavy(number) => tail = Some(number),
            }
        }
        let u = f32x4::new([along, u[1], 0.0, 0.0]);
        let [along_scale, across_scale] = shape.scales();
        let t = roots(u) * f32x4::new([along_scale, across_scale, 0.0, 0.0]);
        let (cell, w) = split(t);
        let towards = u.simd_gt(0.5);
        let half: i32x4 = bytemuck::cast(towards);
        let cell = (cell + (half & i32x4::new([shape.half() as i32, 0, 0, 0]))).to_array();

        // The guard cell makes the cell of every random number valid, and the guard row that of
        // every view. NaN fails here or, where it converts to 0, in the test of g.
        let stride = 2 * shape.half();
        let low = start(row, stride, cell[0]);
        let (high, across) = (low + stride as usize, cell[1] as u32 as usize);
        let read = Self { low, high, between, across, t, w: w.to_array(), towards, tail };
        shape.reads(high, across).then_some(read)
    }
}

/// The normal of [`draw`] before `to_tangent`, with squares in range, and a factor
/// on the normal after normalisation.
#[inline(always)]
fn draw_along<S: Shape, const HEAVY: bool>(
    shape: S,
    &View { xy, frame, silhouette, .. }: &View,
    reads: &Reads,
    [sx, sy]: [f32; 2],
) -> Option<(f32x4, f32x4)> {
    let &Reads { low, high, between, across, w, towards, tail, .. } = reads;
    let sign = towards & f32x4::splat(-0.0);

    // The slope across, as the ratio 2 t : t_z; then the factors of the in-plane slope and of
    // its norm.
    let g_across = f32x4::splat(shape.across(across, w[1]));
    let [t, t_z] = half_slope_at(g_across);
    let view = pairs(xy, frame);
    let ahead = view * f32x4::new([2.0 * sx, 2.0 * sy, 1.0, 0.0]) * t_z;
    let aside = swap_pairs(view)
        * f32x4::new([-2.0 * sx, 2.0 * sy, 0.0, 0.0])
        * f32x4::splat((t ^ sign).to_array()[1]);

    // Half of x, and z, of the in-plane slope, and whether the normal is visible.
    let mut shrink = f32x4::ONE;
    let (x, z, clear) = if HEAVY && let Some(number) = tail {
        let [x, z, factor] = half_slopes(f32x4::splat(number), shape.tails());
        shrink = pairs_of_firsts(f32x4::ONE, factor);
        // A heavy slope is on the viewer's side: the test only excludes that x and z are both
        // small.
        (x, z, ((x + z) * t_z).to_array()[0] >= least_clear(f32x4::ZERO, t, t_z).to_array()[0])
    } else {
        let least = least_clear(!towards & silhouette, t, t_z);
        // Interpolation between the rows, then along u₁.
        let nodes = shape.between(low, high, between);
        let g = sum(nodes * basis(f32x4::splat(w[0])));
        let [x, z] = half_slope_at(g);
        (x ^ sign, z, (g * t_z).to_array()[0] >= least.to_array()[0])
    };
    if !clear {
        return None;
    }
    let norm = (z * z + f32x4::splat(4.0 * shape.s()) * (x * x)).sqrt();
    Some((pairs_of_firsts(x, z) * ahead + norm * aside, shrink))
}

/// How far, in g, a normal must be from the silhouette so that no rounding can hide it.
///
/// With g₀ the silhouette and t half the tangent of the tilt across,
/// v·m = (g − g₀)(ρ + …) ρ/|m| ≥ (g − g₀) ρ length/|m| must exceed ten roundings of terms that sum
/// to at most ρ length (3 + 6 |t|)/|m|, whatever σ is. The margin also keeps normals off the
/// horizon and all squares in range.
const SILHOUETTE_MARGIN: f32 = 2e-6;
/// The part of the margin that grows with |t|.
const SILHOUETTE_MARGIN_ACROSS: f32 = 4e-6;

/// The least g t_z of a normal clear of the silhouette, for the slope across 2t : t_z.
#[inline(always)]
pub(crate) fn least_clear<L: Lanes>(silhouette: L, t: L, t_z: L) -> L {
    (silhouette + SILHOUETTE_MARGIN) * t_z - t * SILHOUETTE_MARGIN_ACROSS
}

/// The index of a cell in a row, below 2³¹ so that sums with it fit; arbitrary for NaN.
#[inline(always)]
pub(crate) fn start(row: u32, stride: u32, cell: i32) -> usize {
    (row.wrapping_mul(stride).wrapping_add(cell as u32) & (u32::MAX >> 1)) as usize
}

#[inline(always)]
pub(crate) fn pair(nodes: &[Node], at: usize) -> f32x4 {
    let [a, b] = [nodes[at], nodes[at + 1]];
    f32x4::new([a[0], a[1], b[0], b[1]])
}
