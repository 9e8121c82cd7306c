//! Directional albedo from tables: the share of light that one bounce off the microsurface returns.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use crate::axis::{Axis, Mapping};
use crate::error::BindError;
use crate::math::sqrt;
use crate::student_t::Masking;
use crate::table::{Kind, Table};
use crate::tables::Tables;

/// Channels of albedo tables.
pub(crate) const CHANNELS: [&str; 3] = ["scale", "bias", "f82"];

/// Moments of one Fresnel reflectance F(v·m) over the visible normals whose reflections leave the surface, weighted by shadowing.
///
/// They make the albedo of every Schlick reflectance, and of OpenPBR's metals, from one table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Of 1 − (1−v·m)⁵.
    pub scale: f32,
    /// Of (1−v·m)⁵.
    pub bias: f32,
    /// Of the F82 tint's μ(1−μ)⁶, divided by its peak at μ = 1/7.
    pub f82: f32,
}

impl Moments {
    /// E with F = 1: scale + bias.
    pub fn total(&self) -> f32 {
        self.scale + self.bias
    }

    /// Albedo of Schlick's reflectance F0 + (F90 − F0)(1−μ)⁵.
    pub fn schlick(&self, f0: f32, f90: f32) -> f32 {
        f0 * self.scale + f90 * self.bias
    }

    /// Albedo of OpenPBR's metal: Schlick with F90 = 1 and the tint, in [0, 1], of its reflectance at μ = 1/7 (Kutz, Hašan & Edmondson
    /// 2021, eq. 2–5); tint = 1 is Schlick.
    pub fn f82_tint(&self, f0: f32, tint: f32) -> f32 {
        // (6/7)⁵
        const WEIGHT: f32 = 7776.0 / 16807.0;
        self.schlick(f0, 1.0) - (1.0 - tint) * (f0 + (1.0 - f0) * WEIGHT) * self.f82
    }

    /// Moments of a perfect mirror seen at cos θ.
    fn mirror(cos_theta: f32) -> Self {
        // 7⁷/6⁶ normalises the peak of μ(1−μ)⁶.
        const PEAK: f32 = 823543.0 / 46656.0;
        let x = 1.0 - cos_theta;
        let bias = x * x * x * x * x;
        Self { scale: 1.0 - bias, bias, f82: PEAK * cos_theta * x * bias }
    }

    /// 2 ∫ μ dμ of a mirror's moments.
    fn mirror_average() -> Self {
        // 2 B(2, 6) = 1/21 and 2·7⁷/6⁶ B(3, 7) = 117649/839808.
        Self { scale: 20.0 / 21.0, bias: 1.0 / 21.0, f82: 117649.0 / 839808.0 }
    }

    fn plus(self, rest: [f32; 3]) -> Self {
        Self { scale: self.scale + rest[0], bias: self.bias + rest[1], f82: self.f82 + rest[2] }
    }
}

/// The directional albedo of one material, with the γ and σ axes of the table collapsed.
///
/// Made by [`Tables::albedo`]. `cos_theta` is the view's cosine to the macro normal; values outside [0, 1] and NaN are taken at the nearer
/// end (NaN at grazing). Below [`GRAZING_FLOOR`] the albedo is held constant. Errors are those of the table's
/// certificate: at most 3e-4 in the default set for cos θ ≥ 0.02 and σ ≥ 0.01.
#[derive(Clone, Debug)]
pub struct Albedo {
    masking: Masking,
    sigma: f32,
    /// Moments less a mirror's, by view node.
    nodes: Vec<[f32; 3]>,
    weight: f32,
    /// κσ of the view coordinate.
    knee: f32,
    /// Average moments less a mirror's.
    average: [f32; 3],
}

/// cos θ of the first view node, 1e-4; at 0 itself the height-correlated albedo is 1, a spike that polynomials
/// cannot follow (near γ = 3/2 it is narrower than any floating-point cosine).
pub const GRAZING_FLOOR: f64 = 1e-4;

impl Tables {
    /// The directional albedo of the material with σ ∈ [0, 3] and γ, for one form of masking.
    ///
    /// σ = 0 is a mirror, E = 1. A set without a table of averages has them integrated here. Below σ = 0.006 the difference to a mirror only fades in proportion and can be far off. Takes some microseconds; keep the result.
    ///
    /// # Errors
    /// [`BindError`] for a σ or γ outside the family, or one that the set's albedo tables do not cover.
    pub fn albedo(&self, sigma: f64, gamma: f64, masking: Masking) -> Result<Albedo, BindError> {
        if !(0.0..f64::INFINITY).contains(&sigma) {
            return Err(BindError::Sigma(sigma as f32));
        }
        if !(gamma > 1.5) {
            return Err(BindError::Gamma(gamma));
        }
        let (directional, nodes) = self.collapse(Kind::Albedo, sigma, gamma, masking)?;
        let Mapping::ViewBlend { weight, scale, heavy } = directional.axes[2].mapping else {
            unreachable!("validated on load")
        };
        let mut albedo = Albedo {
            masking,
            sigma: sigma as f32,
            nodes,
            weight: weight as f32,
            knee: ((scale + heavy / (2.0 * gamma - 3.0)) * sigma) as f32,
            average: [0.0; 3],
        };
        albedo.average = if self.tables().iter().any(|table| table.kind == Kind::AlbedoAverage) {
            self.collapse(Kind::AlbedoAverage, sigma, gamma, masking)?.1[0]
        } else {
            albedo.integrate()
        };
        Ok(albedo)
    }

    /// The first table of a kind and masking that covers (σ, γ), collapsed there.
    fn collapse(
        &self,
        kind: Kind,
        sigma: f64,
        gamma: f64,
        masking: Masking,
    ) -> Result<(&Table, Vec<[f32; 3]>), BindError> {
        let tables =
            || self.tables().iter().filter(|table| table.kind == kind && table.masking == Some(masking));
        let mut widest = f64::NEG_INFINITY;
        for table in tables() {
            let Some(shapes) = weights(&table.axes[0], shape_coordinate(&table.axes[0], gamma)) else {
                continue;
            };
            let axis = &table.axes[1];
            let first = roughness(axis, axis.nodes[0]);
            // Below the first node what a mirror lacks fades in proportion: σ = 0 has E = 1 exactly.
            let (at, fade) = if sigma < first { (first, sigma / first) } else { (sigma, 1.0) };
            widest = widest.max(roughness(axis, axis.nodes[axis.nodes.len() - 1]));
            let found = weights(axis, roughness_coordinate(axis, at)).filter(|_| reaches(axis, sigma));
            let Some(roughnesses) = found else { continue };
            let views = table.axes.get(2).map_or(1, Axis::len);
            let mut sum = vec![[0.0_f64; 3]; views];
            for &(i, a) in &shapes {
                for &(j, b) in &roughnesses {
                    let row = &table.values[(i * axis.len() + j) * views * 3..][..views * 3];
                    for (into, node) in sum.iter_mut().zip(row.chunks_exact(3)) {
                        for (x, value) in into.iter_mut().zip(node) {
                            *x += fade * a * b * f64::from(*value);
                        }
                    }
                }
            }
            return Ok((table, sum.into_iter().map(|node| node.map(|x| x as f32)).collect()));
        }
        if tables().any(|table| !reaches(&table.axes[1], 0.0)) {
            return Err(BindError::AlbedoNotCovered { sigma, gamma, covered: domains(tables()) });
        }
        if widest.is_finite() {
            return Err(BindError::SigmaNotCovered { sigma, max: widest });
        }
        let covered: Vec<_> = tables()
            .map(|table| {
                let axis = &table.axes[0];
                let gamma = |t: f64| shape(axis, t);
                alloc::format!("[{:.6}, {}]", gamma(axis.nodes[axis.nodes.len() - 1]), gamma(axis.nodes[0]))
            })
            .collect();
        let covered = if covered.is_empty() { "nothing".to_string() } else { covered.join(", ") };
        Err(BindError::NotCovered { kind: kind.name(), gamma, covered })
    }
}

fn shape_coordinate(axis: &Axis, gamma: f64) -> f64 {
    match axis.mapping {
        Mapping::LogShape { scale } => libm::log1p(scale / (2.0 * gamma - 3.0)),
        _ => unreachable!("validated on load"),
    }
}

/// γ at a coordinate.
fn shape(axis: &Axis, t: f64) -> f64 {
    match axis.mapping {
        Mapping::LogShape { scale } => 1.5 + 0.5 * scale / libm::expm1(t),
        _ => unreachable!("validated on load"),
    }
}

fn roughness_coordinate(axis: &Axis, sigma: f64) -> f64 {
    match axis.mapping {
        Mapping::LogRoughness { offset } => libm::log1p(sigma / offset),
        _ => unreachable!("validated on load"),
    }
}

fn roughness(axis: &Axis, t: f64) -> f64 {
    match axis.mapping {
        Mapping::LogRoughness { offset } => offset * libm::expm1(t),
        _ => unreachable!("validated on load"),
    }
}

/// First σ node, at most, of tables that serve all smaller σ as well; those of a recipe may begin higher.
const SMOOTHEST: f64 = 0.0061;

/// Whether a table goes down to σ.
fn reaches(axis: &Axis, sigma: f64) -> bool {
    let first = roughness(axis, axis.nodes[0]);
    first <= SMOOTHEST || sigma >= first * (1.0 - 1e-9)
}

/// What tables cover, in words.
fn domains<'a>(tables: impl Iterator<Item = &'a Table>) -> String {
    let ends = |axis: &Axis, at: &dyn Fn(f64) -> f64| match axis.nodes[..] {
        [t] => alloc::format!("= {:.6}", at(t)),
        [first, .., last] => {
            let (a, b) = (at(first), at(last));
            alloc::format!("in [{:.6}, {:.6}]", a.min(b), a.max(b))
        }
        [] => unreachable!("validated on load"),
    };
    let one = |table: &Table| {
        let [gamma, sigma] = [&table.axes[0], &table.axes[1]];
        alloc::format!(
            "gamma {} with sigma {}",
            ends(gamma, &|t| shape(gamma, t)),
            ends(sigma, &|t| roughness(sigma, t))
        )
    };
    const SHOWN: usize = 8;
    let mut all: Vec<String> = tables.map(one).collect();
    if all.len() > SHOWN {
        let more = all.len() - SHOWN;
        all.truncate(SHOWN);
        all.push(alloc::format!("{more} more"));
    }
    all.join("; ")
}

/// Weights of the nodes about a coordinate, or `None` where the axis does not cover it.
fn weights(axis: &Axis, t: f64) -> Option<Vec<(usize, f64)>> {
    let (n, first, last) = (axis.nodes.len(), axis.nodes[0], axis.nodes[axis.nodes.len() - 1]);
    let slack = 1e-9 * (1.0 + last.abs());
    if !(t >= first - slack && t <= last + slack) {
        return None;
    }
    if n == 1 {
        return Some(vec![(0, 1.0)]);
    }
    let x = ((t - first) / (last - first)).clamp(0.0, 1.0) * (n - 1) as f64;
    let count = n.min(STENCIL);
    let start = first_node(x as usize, n, count);
    let x = x - start as f64;
    let weight = |i: usize| {
        let others = (0..count).filter(|&j| j != i);
        others.map(|j| (x - j as f64) / (i as f64 - j as f64)).product()
    };
    Some((0..count).map(|i| (start + i, weight(i))).collect())
}

/// cos θ in [0, 1]; NaN becomes 0.
fn within(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { cos_theta.min(1.0) } else { 0.0 }
}

/// Nodes that a polynomial goes through.
const STENCIL: usize = 6;

/// The first of `count` nodes with the cell in their middle, or as near to it as the ends allow.
fn first_node(cell: usize, n: usize, count: usize) -> usize {
    (cell + 1).saturating_sub(count / 2).min(n - count)
}

impl Albedo {
    /// The form of masking it is for.
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// The roughness σ it was bound at.
    pub fn sigma(&self) -> f32 {
        self.sigma
    }

    /// Moments of the Fresnel weights at a view; each in [0, 1], their total at most 1.
    pub fn moments(&self, cos_theta: f32) -> Moments {
        let cos = within(cos_theta);
        let sum = Moments::mirror(cos).plus(self.rest(cos));
        // Interpolation may leave [0, 1] by the table's error.
        let bias = sum.bias.clamp(0.0, 1.0);
        Moments { scale: sum.scale.clamp(0.0, 1.0 - bias), bias, f82: sum.f82.clamp(0.0, 1.0) }
    }

    /// E(cos θ) with F = 1, in [0, 1].
    pub fn albedo(&self, cos_theta: f32) -> f32 {
        1.0 - self.lost(cos_theta)
    }

    /// 1 − E(cos θ), with all its digits where E is close to 1.
    pub fn lost(&self, cos_theta: f32) -> f32 {
        let rest = self.rest(within(cos_theta));
        (-rest[0] - rest[1]).clamp(0.0, 1.0)
    }

    /// Cosine-weighted averages 2∫₀¹ · μ dμ of the moments.
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average)
    }

    /// The average moments less a mirror's.
    pub fn average_rest(&self) -> [f32; 3] {
        self.average
    }

    /// E_avg = 2∫₀¹ E(μ) μ dμ with F = 1.
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// 1 − E_avg, with all its digits.
    pub fn lost_average(&self) -> f32 {
        (-self.average[0] - self.average[1]).clamp(0.0, 1.0)
    }

    /// The average moments less a mirror's, by quadrature of the interpolated albedo: what tables of averages are filled with.
    pub fn integrate(&self) -> [f32; 3] {
        // Gauss-Legendre, four points; μ = x³ resolves grazing views, where small roughness makes its difference.
        const POINTS: [(f64, f64); 2] =
            [(0.339981043584856265, 0.652145154862546143), (0.861136311594052575, 0.347854845137453857)];
        const PANELS: usize = 64;
        let half = 0.5 / PANELS as f64;
        let mut sum = [0.0_f64; 3];
        for panel in 0..PANELS {
            let middle = half * (2 * panel + 1) as f64;
            for (node, weight) in POINTS {
                for x in [middle - half * node, middle + half * node] {
                    let cos = x * x * x;
                    // 2 μ dμ = 6 x⁵ dx.
                    let measure = 6.0 * half * weight * cos * x * x;
                    for (sum, value) in sum.iter_mut().zip(self.rest(cos as f32)) {
                        *sum += measure * f64::from(value);
                    }
                }
            }
        }
        sum.map(|x| x as f32)
    }

    /// Moments less a mirror's at cos θ ∈ [0, 1].
    fn rest(&self, cos: f32) -> [f32; 3] {
        let cos = cos.max(GRAZING_FLOOR as f32);
        let sin = sqrt((1.0 - cos) * (1.0 + cos));
        self.interpolate(
            (1.0 - self.weight) * sqrt(cos / (1.0 + sin)) + self.weight * cos / (cos + self.knee * sin),
        )
    }

    fn interpolate(&self, t: f32) -> [f32; 3] {
        let n = self.nodes.len();
        let x = (t * (n - 1) as f32).clamp(0.0, (n - 1) as f32);
        let start = first_node(x as usize, n, STENCIL);
        let x = x - start as f32;
        // Products from the left and from the right leave one factor out at each node.
        const C: [f32; STENCIL] =
            [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 12.0, 1.0 / 12.0, -1.0 / 24.0, 1.0 / 120.0];
        let mut weights = C;
        let (mut left, mut right) = (1.0, 1.0);
        for i in 0..STENCIL {
            weights[i] *= left;
            left *= x - i as f32;
            let j = STENCIL - 1 - i;
            weights[j] *= right;
            right *= x - j as f32;
        }
        let mut sum = [0.0; 3];
        for (node, w) in self.nodes[start..start + STENCIL].iter().zip(weights) {
            for (sum, x) in sum.iter_mut().zip(node) {
                *sum += w * x;
            }
        }
        sum
    }
}

/// Where nodes of a table stand, for those who fill one.
impl Axis {
    /// σ at a coordinate of a [`Mapping::LogRoughness`] axis, γ at one of a [`Mapping::LogShape`] axis; `None` for others.
    pub fn quantity(&self, t: f64) -> Option<f64> {
        match self.mapping {
            Mapping::LogShape { .. } => Some(shape(self, t)),
            Mapping::LogRoughness { .. } => Some(roughness(self, t)),
            _ => None,
        }
    }
}
