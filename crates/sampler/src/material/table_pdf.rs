//! The density of the normals that the table sampler draws.
//!
//! An estimator that divides by it is unbiased at any resolution: it is the Jacobian of the
//! sampler's map, found by inverting the interpolated CDFs, and not the analytic density that they
//! approximate. It is computed in f64 from the nodes that the sampler reads.
//!
//! The inverse of a lookup is the random number at which the table has a slope. A row of nodes
//! ascends. All nodes are compared with a value at once, which takes less time than a search whose
//! branches are mispredicted.

use alloc::vec::Vec;

use glam::Vec3;
use wide::{bytemuck, f32x4, i32x4};

use microfacet_core::math::{sqrt64, unit};
use microfacet_tables::axis::MirroredRoot;
use microfacet_tables::axis::half_tangent::{ends, ends_and_rate, rate_at, slope_at};
use microfacet_tables::axis::hermite::{Cubic, Node, split};

use super::distribution::MicrofacetDistribution as _;
use super::heavy::half_slopes;
use super::horizon::HORIZON;
use super::lanes::first_three;
use super::lanes::one::{Reads, draw_located};
use super::slices::Slices;
use super::student_t::{StudentT, StudentTRef};
use super::surface::{Scales, Shape, Stretched, Surface};
use crate::elementary::{exp2, log2};
use crate::vector::vec3;

/// A normal's in-plane slope x : z in unit space, and √(z² + s x²), up to a common factor.
struct InPlane {
    x: f64,
    z: f64,
    norm: f64,
}

impl InPlane {
    fn new(x: f64, z: f64, s: f32) -> Self {
        Self { x, z, norm: sqrt64(z * z + f64::from(s) * x * x) }
    }
}

/// Two neighbouring rows of a table and the position between them.
pub(super) struct Rows<'a> {
    low: &'a [Node],
    high: &'a [Node],
    between: f32,
}

impl<'a> Rows<'a> {
    fn one(row: &'a [Node]) -> Self {
        Self { low: row, high: row, between: 0.0 }
    }

    #[inline(always)]
    fn node(&self, i: usize) -> Node {
        let (a, b) = (self.low[i], self.high[i]);
        [a[0] + self.between * (b[0] - a[0]), a[1] + self.between * (b[1] - a[1])]
    }

    /// How many of the nodes from `first` up to `end` are not above g.
    #[inline(always)]
    fn count(&self, first: usize, end: usize, g: f32) -> usize {
        let ((low, low_rest), (high, _)) =
            (self.low[first..end].as_chunks::<2>(), self.high[first..end].as_chunks::<2>());
        let mut count = i32x4::ZERO;
        for (low, high) in low.iter().zip(high) {
            let [low, high] = [low, high].map(|[a, b]| f32x4::new([a[0], a[1], b[0], b[1]]));
            let nodes = low + f32x4::splat(self.between) * (high - low);
            count -= bytemuck::cast::<f32x4, i32x4>(nodes.simd_le(g));
        }
        // The other lanes hold slopes of nodes.
        let [even, _, odd, _] = count.to_array();
        let last = !low_rest.is_empty() && self.node(end - 1)[0] <= g;
        (even + odd) as usize + usize::from(last)
    }
}

/// Where the interpolated inverse CDF of one half of a mirrored axis takes a value.
struct Cell {
    cell: usize,
    cells: usize,
    g: f64,
    nodes: [Node; 2],
}

/// The t of u = 2⁻⁴⁹, far less than any random number but 0 that generators of 32 bits draw. Nearer
/// to an end t is set to this: the random number 0 stands for all numbers around it, though the
/// density of the map may vanish at 0.
const LEAST_T: f64 = 1.0 / 4096.0;

/// A place on an axis of `cells` cells, and the derivative of the value there, by cells.
struct Place {
    at: f64,
    slope: f64,
    cells: f64,
    /// Whether it stands for places nearer to the end.
    is_end: bool,
}

impl Place {
    #[inline(always)]
    fn new(cubic: &Cubic, at: f64, w: f64, cells: usize) -> Self {
        let cells = cells as f64;
        Self { at, slope: cubic.derivative(w), cells, is_end: !(at > LEAST_T * cells) }
    }
}

impl Cell {
    /// The cell of g among the `cells + 1` ascending nodes from `first` on.
    #[inline(always)]
    fn find(rows: &Rows<'_>, first: usize, cells: usize, g: f64) -> Self {
        let cell = rows.count(first, first + cells, g as f32).max(1) - 1;
        let nodes = [rows.node(first + cell), rows.node(first + cell + 1)];
        // A sampled g may lie outside its cell by rounding: across a node, between the halves,
        // which meet at u = ½ up to the rounding of their nodes, or beyond the silhouette at the
        // first node. It is clamped to the nearer end of the cell.
        let g = g.max(f64::from(nodes[0][0])).min(f64::from(nodes[1][0]));
        Self { cell, cells, g, nodes }
    }

    /// The place of the value, to 1e-11.
    #[inline(always)]
    fn place(&self) -> Place {
        let cubic = Cubic::new(self.nodes[0], self.nodes[1]);
        let cell = self.cell as f64;
        let at = (cell + cubic.solve(self.g)).max(LEAST_T * self.cells as f64);
        Place::new(&cubic, at, (at - cell).min(1.0), self.cells)
    }
}

impl Place {
    /// du/dg as a quotient; over 0 where many random numbers have one slope.
    #[inline(always)]
    fn density(&self) -> [f64; 2] {
        // du/dt is a multiple of t³, and t is at/cells.
        let square = self.cells * self.cells;
        [MirroredRoot::rate(self.at), square * square * self.slope.max(0.0)]
    }
}

impl Slices {
    /// [`table_pdf`](crate::lobe::Tabulated::table_pdf) of a normal that faces the view. This is
    /// not checked, since rounding may put the slope of a drawn normal behind the silhouette.
    pub(crate) fn density_of_samples(&self, sigma: [f32; 2], v: Vec3, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let [sx, sy] = sigma;
        let view = Stretched::new([sx * v.x, sy * v.y, v.z]);
        let at = self.row(&view);
        let Some(rows) = self.rows_at(at) else { return 0.0 };
        let (slope, y) = unit_slopes(&view, sigma, self.s, m);
        let heavy = self.heavy_share(at);
        let (along, is_end) = self.along(&rows, &slope, heavy);
        let ([_, g], rate) = ends_and_rate(y.abs(), slope.norm);
        let place_across = self.cell_across(g).place();
        let across = times(place_across.density(), [rate, 1.0]);
        let density = self.per_steradian(&slope, [along, across], heavy, sx * sy, m.z);
        if is_end || place_across.is_end || density == 0.0 {
            return self.at_an_end(density, sigma, v, m);
        }
        density
    }

    /// [`density_of_samples`](Self::density_of_samples) of the normal that is drawn by `reads` for a
    /// view at a coordinate, by its cosine. Their places and the slopes there are known, so nothing
    /// is inverted. `area` is σxσy, or the determinant of a tilted lobe's matrix.
    ///
    /// `None` where a table ends.
    #[inline(always)]
    pub(super) fn density_of_reads(
        &self,
        reads: &Reads,
        at: f32x4,
        area: f32,
        cos: f32,
    ) -> Option<f32> {
        let &Reads { low, high, between, across, t, w, towards, tail } = reads;
        let ([t_along, t_across, ..], [w_along, w_across, ..]) =
            (t.to_array().map(f64::from), w.map(f64::from));
        let at = at.to_array()[0];
        let heavy = self.heavy_share(at);
        let (slope, along, is_end) = if let Some(number) = tail {
            // A slope of the heavy part may be anywhere in the table.
            let [x, z, shrink] = half_slopes(f32x4::splat(number), self.heavy.tail.in_lanes());
            let [x, z, shrink] = [x, z, shrink].map(|x| f64::from(x.to_array()[0]));
            let slope = InPlane::new(2.0 * x, z * shrink, self.s);
            let (along, is_end) = self.along(&self.rows_at(at)?, &slope, heavy);
            (slope, along, is_end)
        } else {
            let [v0, s0, v1, s1] = self.between(low, high, between).to_array();
            let cubic = Cubic::new([v0, s0], [v1, s1]);
            let place = Place::new(&cubic, t_along, w_along, self.half_cells);
            let g = cubic.value(w_along);
            let [x, z] = slope_at(g);
            let x = if towards.to_array()[0].to_bits() == 0 { -x } else { x };
            (InPlane::new(x, z, self.s), times(place.density(), rate_at(g)), place.is_end)
        };

        let cubic = Cubic::of_cell(self.across_cells.get(across)?);
        let place_across = Place::new(&cubic, t_across, w_across, self.across.len() - 1);
        let across = times(place_across.density(), rate_at(cubic.value(w_across)));

        let density = self.per_steradian(&slope, [along, across], heavy, area, cos);
        let is_inside = !is_end && !place_across.is_end && cos > HORIZON;
        // The guard cell, which a number of ½ may read, is level.
        (is_inside && density > 0.0 && density < f32::MAX).then_some(density)
    }

    /// The density of a normal with this slope and cosine, from those of the table as quotients:
    /// `along` per unit of x/z, `across` per unit of t = y/√(z² + s x²).
    #[inline(always)]
    fn per_steradian(
        &self,
        slope: &InPlane,
        [mut along, across]: [[f64; 2]; 2],
        heavy: f64,
        area: f32,
        cos: f32,
    ) -> f32 {
        if self.peeled {
            along[0] = (1.0 - heavy) * along[0] + heavy * self.heavy_density(slope) * along[1];
        }
        // p(x, y) = p(x) p(t)/√(1 + s x²). Slopes in the tangent frame scale by σ, and
        // dm = cos³θ per slope area.
        let cos = f64::from(cos);
        let [number, of] = times(along, across);
        let density = (number * slope.z) / (of * slope.norm * f64::from(area) * (cos * cos * cos));
        if density > 0.0 { density.min(f64::from(f32::MAX)) as f32 } else { 0.0 }
    }

    /// The table's density at a slope, per unit of x/z as a quotient, and whether it ends there.
    #[inline(always)]
    fn along(&self, rows: &Rows<'_>, slope: &InPlane, heavy: f64) -> ([f64; 2], bool) {
        let (ends, rate) = ends_and_rate(slope.x, slope.z);
        let (half, cell) = self.cell_along(rows, ends);
        let place = cell.place();
        // The heavy part extends beyond the end of a peeled table.
        let is_end = place.is_end && (half == 0 || heavy == 0.0);
        (times(place.density(), [rate, 1.0]), is_end)
    }

    /// The share of the heavy part at a view's coordinate, 0 where all is tabulated.
    #[inline(always)]
    fn heavy_share(&self, at: f32) -> f64 {
        if self.peeled { f64::from(unit(self.heavy.share(at))) } else { 0.0 }
    }

    /// A density where the table ends: not below the analytic one.
    ///
    /// Towards the horizon that may grow without limit, and its quotient by the table's density
    /// would too; rounding of a normal that is tilted mostly across may lose its slope along the
    /// view.
    #[cold]
    #[inline(never)]
    fn at_an_end(&self, density: f32, sigma: [f32; 2], v: Vec3, m: Vec3) -> f32 {
        density.max(Surface::new(self, sigma).visible_normal_pdf(v, m))
    }

    /// Density of the heavy part at x/z: 2k s x (1 + s x²)^(−k−1) for x > 0.
    fn heavy_density(&self, at: &InPlane) -> f64 {
        let (s, two_gamma_minus_3) = (f64::from(self.s), 2.0 * self.gamma - 3.0);
        let x = (at.x / at.z).max(0.0);
        let base = 1.0 + s * x * x;
        // The root is in the range of f32 even where the base is not.
        let log = log2(f32x4::splat(sqrt64(base) as f32));
        let power = exp2(log * (-two_gamma_minus_3 as f32)).to_array()[0];
        two_gamma_minus_3 * s * x / base * f64::from(power)
    }

    /// The rows at a view's coordinate, interpolated as the sampler does; `None` where it is NaN.
    #[inline(always)]
    pub(super) fn rows_at(&self, coordinate: f32) -> Option<Rows<'_>> {
        let (row, between) = split(f32x4::splat(coordinate));
        let (row, between) = (row.to_array()[0] as u32 as usize, between.to_array()[0]);
        let stride = 2 * (self.half_cells + 1);
        let (low, high) = self.slope.get(row * stride..)?.get(..2 * stride)?.split_at(stride);
        Some(Rows { low, high, between })
    }

    /// The half of the row that holds the in-plane slope of ends 1 ± h, and the cell in it.
    #[inline(always)]
    fn cell_along(&self, rows: &Rows<'_>, ends: [f64; 2]) -> (usize, Cell) {
        let cells = self.half_cells;
        let low = ends[0];
        // The half for u ≤ ½ ends where 1 + h reaches its last node; larger slopes are looked up by
        // 1 − h in the other half. An index avoids a branch that would be mispredicted half of the
        // time.
        let half = usize::from(low > f64::from(rows.node(cells)[0]));
        let g = ends[half];
        (half, Cell::find(rows, half * (cells + 1), cells, g))
    }

    /// The cell of the slopes across that holds the distance g from their end.
    #[inline(always)]
    fn cell_across(&self, g: f64) -> Cell {
        let nodes = &self.across;
        Cell::find(&Rows::one(nodes), 0, nodes.len() - 1, g)
    }

    /// The random number at which a row of the table has the in-plane slope x : z.
    pub(super) fn number_along(&self, rows: &Rows<'_>, x: f64, z: f64) -> f64 {
        let (half, cell) = self.cell_along(rows, ends(x, z));
        let place = cell.place();
        let u = MirroredRoot::number(place.at / place.cells);
        // The other half ascends from u = 1.
        if half == 0 { u } else { 1.0 - u }
    }

    pub(super) fn one_row(&self, row: usize) -> Rows<'_> {
        let stride = 2 * (self.half_cells + 1);
        Rows::one(&self.slope[row * stride..(row + 1) * stride])
    }

    fn joints(&self, view: &Stretched) -> [Vec<f64>; 2] {
        let Some(rows) = self.rows_at(self.row(view)) else {
            return Default::default();
        };
        let half = self.half_cells + 1;
        let slope = |g: f64, sign: f64| {
            let [x, z] = slope_at(g);
            sign * x / z
        };
        let away = (0..half).map(|i| slope(f64::from(rows.node(i)[0]), -1.0));
        let towards = (0..half).rev().map(|i| slope(f64::from(rows.node(half + i)[0]), 1.0));
        let across = self.across.iter().rev().map(|node| slope(f64::from(node[0]), 1.0));
        [away.chain(towards).collect(), across.collect()]
    }
}

/// The product of two quotients: one division in the end takes less time than one for each.
#[inline(always)]
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0], a[1] * b[1]]
}

/// The in-plane slope of a normal and its y across, up to a common factor, without a division.
fn unit_slopes(view: &Stretched, sigma: [f32; 2], s: f32, m: Vec3) -> (InPlane, f64) {
    let [vx, vy, mx, my] = [view.x, view.y, m.x, m.y].map(f64::from);
    let [sx, sy] = sigma.map(f64::from);
    let (a, b) = (mx * sy, my * sx);
    let frame = sqrt64(vx * vx + vy * vy);
    (InPlane::new(a * vx + b * vy, f64::from(m.z) * sx * sy * frame, s), b * vx - a * vy)
}

impl StudentTRef<'_> {
    /// A visible normal, and its density where that is a by-product; `None` where the draw is not
    /// the common one.
    #[inline(always)]
    pub(super) fn draw_with_density<const HEAVY: bool>(
        &self,
        v: Vec3,
        u: [f32; 2],
    ) -> Option<(Vec3, Option<f32>)> {
        let Surface { shape, scales: Scales { sigma, .. } } = self.surface();
        let view = self.surface().view::<HEAVY>(v);
        let reads = Reads::new::<_, HEAVY>(shape, &view, u)?;
        let m = first_three(draw_located::<_, HEAVY>(shape, &view, &reads, sigma, |m| m)?);
        Some((m, shape.density_of_reads(&reads, view.at, sigma[0] * sigma[1], m.z)))
    }
}

impl StudentT {
    /// The slopes at which the tabulated density ([`table_pdf`](crate::lobe::Tabulated::table_pdf))
    /// of a view has joints: unit slopes x in the plane of incidence, ascending, and t ≥ 0 across
    /// it.
    ///
    /// Between joints the density of the samples is smooth, so a quadrature that divides there
    /// converges fast. x may end at ±∞.
    #[must_use]
    pub fn table_joints(&self, v: impl Into<[f32; 3]>) -> [Vec<f64>; 2] {
        self.slices.joints(&self.surface().stretch(vec3(v)))
    }
}

#[cfg(test)]
mod tests {
    use crate::Tables;
    use crate::material::surface::Shape as _;
    use glam::Vec3;

    #[test]
    fn numbers_are_those_of_the_lookup() {
        let tables = Tables::embedded();
        for gamma in [1.501, 1.7, 1.8, 2.0, 3.0, f64::INFINITY] {
            let lobe = tables.student_t(1.0, gamma).unwrap();
            let (surface, slices) = (lobe.surface(), &lobe.slices);
            for z in [0.0, 1e-3, 0.1, 0.4, 0.7, 0.95, 0.9999] {
                let view = surface.stretch(Vec3::new(libm::sqrtf(1.0 - z * z), 0.0, z));
                let rows = slices.rows_at(slices.row(&view)).unwrap();
                for i in 1..400 {
                    let u = i as f32 / 400.0;
                    let slope = surface.sample_slope(&view, u);
                    let got = slices.number_along(&rows, f64::from(slope.x), f64::from(slope.z));
                    assert!((got - f64::from(u)).abs() < 1e-5, "{gamma} {z} {u}: {got}");
                }
            }
        }
    }
}
