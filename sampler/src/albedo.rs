//! Directional albedo from tables: the share of light that one bounce off the microsurface returns.

use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use crate::albedo_axes::{
    STENCIL, ViewCoordinate, roughness, roughness_coordinate, shape_coordinate, stencil, weights,
};
use crate::axis::Axis;
use crate::error::BindError;
use crate::student_t::Masking;
use crate::table::{Kind, Table};
use crate::tables::Tables;

/// Channels of albedo tables: E − 1, and what the other moments have over a mirror's times E, in which form they are smooth.
pub(crate) const CHANNELS: [&str; 3] = ["e", "bias", "f82"];

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
    pub(crate) fn mirror(cos_theta: f32) -> Self {
        // 7⁷/6⁶ normalises the peak of μ(1−μ)⁶.
        const PEAK: f32 = 823543.0 / 46656.0;
        let x = 1.0 - cos_theta;
        let bias = x * x * x * x * x;
        Self { scale: 1.0 - bias, bias, f82: PEAK * cos_theta * x * bias }
    }

    /// 2 ∫ μ dμ of a mirror's moments.
    pub(crate) fn mirror_average() -> Self {
        // 2 B(2, 6) = 1/21 and 2·7⁷/6⁶ B(3, 7) = 117649/839808.
        Self { scale: 20.0 / 21.0, bias: 1.0 / 21.0, f82: 117649.0 / 839808.0 }
    }

    /// From what is stored, `self` being the mirror's.
    pub(crate) fn plus(self, [e, bias, f82]: [f32; 3]) -> Self {
        // Interpolation and 16-bit rounding may leave [0, 1] and [0, E] by the table's error; below 0 there is no [0, E].
        let e = (1.0 + e).max(0.0);
        let bias = (bias + e * self.bias).clamp(0.0, e);
        Self { scale: e - bias, bias, f82: (f82 + e * self.f82).clamp(0.0, 1.0) }
    }
}

/// The directional albedo of one material, with the γ and σ axes of the table collapsed.
///
/// Made by [`Tables::albedo`]. `cos_theta` is the view's cosine to the macro normal; values outside [0, 1] and NaN are taken at the nearer
/// end (NaN at grazing). Errors are those of the table's certificate: at most 3e-4 in the default set for cos θ ≥ 0.02 and σ ≥ 0.01, at most
/// 2e-3 elsewhere.
#[derive(Clone, Debug)]
pub struct Albedo {
    masking: Masking,
    sigma: f32,
    /// What the view nodes hold; see [`CHANNELS`].
    nodes: Vec<[f32; 3]>,
    view: ViewCoordinate,
    /// The averages, in the same form.
    average: [f32; 3],
    /// Height-correlated: 1 − E vanishes with this power of cos θ; 0 for uncorrelated masking, where E has another limit.
    power: f32,
}

impl Tables {
    /// The directional albedo of the material with σ ∈ [0, 3] and γ, for one form of masking.
    ///
    /// A surface smoother than the table's first node, σ = 1e-8, is a mirror, E = 1. The averages are integrated from the interpolated albedo of
    /// just this material, so that a furnace closes to rounding. Takes some ten microseconds; keep the result.
    ///
    /// # Errors
    /// [`BindError`] for a σ or γ outside the family, or one that the set's albedo tables do not cover.
    pub fn albedo(&self, sigma: f64, gamma: f64, masking: Masking) -> Result<Albedo, BindError> {
        Self::within_family(sigma, gamma)?;
        let (table, mut nodes) = self.collapse(Kind::Albedo, sigma, gamma, masking)?;
        let first = first_sigma(table);
        if sigma < first * (1.0 - 1e-9) {
            nodes.fill([0.0; 3]);
        }
        let power = match masking {
            Masking::Uncorrelated => 0.0,
            Masking::HeightCorrelated => (2.0 * gamma - 3.0).min(1.0) as f32,
        };
        let view = ViewCoordinate::new(&table.axes[2], sigma.max(first), gamma);
        let mut albedo = Albedo { masking, sigma: sigma as f32, nodes, view, power, average: [0.0; 3] };
        albedo.average = albedo.integrate();
        Ok(albedo)
    }

    /// Cosine-weighted averages 2∫₀¹ · μ dμ of the moments from the table of averages alone; off its nodes they differ from those of
    /// [`albedo`](Self::albedo) by the errors of its certificate.
    ///
    /// # Errors
    /// As [`albedo`](Self::albedo).
    pub fn average_moments(&self, sigma: f64, gamma: f64, masking: Masking) -> Result<Moments, BindError> {
        Self::within_family(sigma, gamma)?;
        let (table, rest) = self.collapse(Kind::AlbedoAverage, sigma, gamma, masking)?;
        let smooth = sigma < first_sigma(table) * (1.0 - 1e-9);
        Ok(Moments::mirror_average().plus(if smooth { [0.0; 3] } else { rest[0] }))
    }

    fn within_family(sigma: f64, gamma: f64) -> Result<(), BindError> {
        if !(0.0..f64::INFINITY).contains(&sigma) {
            return Err(BindError::Sigma(sigma as f32));
        }
        if !(gamma > 1.5) {
            return Err(BindError::Gamma(gamma));
        }
        Ok(())
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
            let at = sigma.max(first_sigma(table));
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
                            *x += a * b * f64::from(*value);
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
                let gamma = |t: f64| axis.quantity(t).expect("validated on load");
                alloc::format!("[{:.6}, {}]", gamma(axis.nodes[axis.nodes.len() - 1]), gamma(axis.nodes[0]))
            })
            .collect();
        let covered = if covered.is_empty() { "nothing".to_string() } else { covered.join(", ") };
        Err(BindError::NotCovered { kind: kind.name(), gamma, covered })
    }
}

/// σ of the first node of an albedo table.
fn first_sigma(table: &Table) -> f64 {
    roughness(&table.axes[1], table.axes[1].nodes[0])
}

/// First σ node, at most, of tables that serve all smaller σ as mirrors; those of a recipe may begin higher.
const SMOOTHEST: f64 = 1.01e-8;

/// Whether a table goes down to σ.
pub(crate) fn reaches(axis: &Axis, sigma: f64) -> bool {
    let first = roughness(axis, axis.nodes[0]);
    first <= SMOOTHEST || sigma >= first * (1.0 - 1e-9)
}

/// What tables cover, in words.
pub(crate) fn domains<'a>(tables: impl Iterator<Item = &'a Table>) -> String {
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
            ends(gamma, &|t| gamma.quantity(t).expect("validated on load")),
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

/// cos θ in [0, 1]; NaN becomes 0.
pub(crate) fn within(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { cos_theta.min(1.0) } else { 0.0 }
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
        Moments::mirror(cos).plus(self.rest(cos))
    }

    /// E(cos θ) with F = 1, in [0, 1].
    pub fn albedo(&self, cos_theta: f32) -> f32 {
        1.0 - self.lost(cos_theta)
    }

    /// 1 − E(cos θ), with all its digits where E is close to 1.
    pub fn lost(&self, cos_theta: f32) -> f32 {
        -self.rest(within(cos_theta))[0]
    }

    /// Cosine-weighted averages 2∫₀¹ · μ dμ of the moments.
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average)
    }

    /// E_avg = 2∫₀¹ E(μ) μ dμ with F = 1.
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// 1 − E_avg, with all its digits.
    pub fn lost_average(&self) -> f32 {
        -self.average[0]
    }

    /// The averages by quadrature of the interpolated albedo, in the form of the tables' channels: what tables of averages are filled with.
    pub fn integrate(&self) -> [f32; 3] {
        less_mirror(over_views(self.view.floor, |cos| self.rest(cos)))
    }

    /// What a table of any number of nodes would hold at cos θ ∈ [0, 1]; E in [0, 1], so that what is lost and its average agree.
    fn rest(&self, cos: f32) -> [f32; 3] {
        let floor = self.view.floor as f32;
        let [e, bias, f82] = self.interpolate(self.view.clamped(cos));
        let e = e.clamp(-1.0, 0.0);
        if cos >= floor || self.power == 0.0 {
            return [e, bias, f82];
        }
        // Correlated masking lets through ever more of what is seen, up to all of it, and in the same mixture.
        let less = e * libm::powf(cos / floor, self.power);
        let more = (1.0 + less) / (1.0 + e).max(1e-6);
        [less, bias * more, f82 * more]
    }

    fn interpolate(&self, t: f32) -> [f32; 3] {
        let (start, weights) = stencil(t, self.nodes.len());
        let mut sum = [0.0; 3];
        for (node, w) in self.nodes[start..start + STENCIL].iter().zip(weights) {
            for (sum, x) in sum.iter_mut().zip(node) {
                *sum += w * x;
            }
        }
        sum
    }
}

/// 2 ∫ μ dμ of E − 1 and of the whole moments, from what is stored as a function of cos θ, which is resolved down to `floor`.
pub(crate) fn over_views(floor: f64, rest: impl Fn(f32) -> [f32; 3]) -> [f64; 3] {
    // Gauss-Legendre, four points, in y = −ln h with h = tan(½ elevation), μ = 2h/(1+h²): even in the angle near normal incidence, and
    // in its logarithm where views graze and small roughness makes its difference. Views below the table's first weigh nothing.
    const POINTS: [(f64, f64); 2] =
        [(0.339981043584856265, 0.652145154862546143), (0.861136311594052575, 0.347854845137453857)];
    const WIDTH: f64 = 0.35;
    let panels = libm::ceil(libm::log(2.0 / floor) / WIDTH) as usize;
    let mut sum = [0.0_f64; 3];
    for panel in 0..panels {
        let middle = WIDTH * (panel as f64 + 0.5);
        for (node, weight) in POINTS {
            for y in [middle - 0.5 * WIDTH * node, middle + 0.5 * WIDTH * node] {
                let h = libm::exp(-y);
                let cos = 2.0 * h / (1.0 + h * h);
                // 2 μ dμ, with dμ/dy = μ (1−h²)/(1+h²).
                let measure = WIDTH * weight * cos * cos * (1.0 - h * h) / (1.0 + h * h);
                let [e, bias, f82] = rest(cos as f32).map(f64::from);
                let mirror = Moments::mirror(cos as f32);
                sum[0] += measure * e;
                sum[1] += measure * (bias + e * f64::from(mirror.bias));
                sum[2] += measure * (f82 + e * f64::from(mirror.f82));
            }
        }
    }
    sum
}

/// Averages of whole moments in the form of the tables' channels.
pub(crate) fn less_mirror([e, bias, f82]: [f64; 3]) -> [f32; 3] {
    let mirror = Moments::mirror_average();
    [e, bias - e * f64::from(mirror.bias), f82 - e * f64::from(mirror.f82)].map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_albedo_of_nothing_is_no_panic() {
        // What 16-bit rounding makes of E = 0.
        let moments = Moments::mirror(0.4).plus([-1.000_003, 1e-6, -1e-6]);
        assert_eq!([moments.scale, moments.bias, moments.f82], [0.0; 3]);
    }
}
