//! Albedos of the materials of a recipe: of the reflectance it names.

use alloc::format;
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use crate::albedo::{self, Albedo, within};
use crate::albedo_axes::{self, STENCIL, ViewCoordinate, stencil};
use crate::container::MaterialEntry;
use crate::critical::CriticalCoordinate;
use crate::dielectric_albedo::DielectricAlbedo;
use crate::error::BindError;
use crate::student_t::Masking;
use crate::table::{Kind, Table};
use crate::tables::Tables;

/// Channels of `fresnel_albedo` tables.
pub(crate) const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// N albedos as functions of the view, the other axes of their table collapsed.
#[derive(Clone, Debug)]
pub struct ViewCurve<const N: usize> {
    nodes: Vec<[f32; N]>,
    view: View,
}

/// The view axis at one material.
#[derive(Clone, Copy, Debug)]
pub(crate) enum View {
    Blend(ViewCoordinate),
    Critical(CriticalCoordinate),
}

impl<const N: usize> ViewCurve<N> {
    /// The albedos at a view, each in [0, 1]; `cos_theta` outside [0, 1] is taken at the nearer end, NaN at grazing, and beyond
    /// the table's last view, cos θ = 1/(5e4 + 500/σ) in the tables of this version, they are held constant.
    pub fn eval(&self, cos_theta: f32) -> [f32; N] {
        let (cos, n) = (within(cos_theta), self.nodes.len());
        let (start, weights) = match &self.view {
            View::Blend(view) => stencil(view.clamped(cos), n),
            View::Critical(view) => view.stencil(f64::from(cos), n),
        };
        let mut sum = [0.0; N];
        for (node, w) in self.nodes[start..start + STENCIL].iter().zip(weights) {
            for (sum, x) in sum.iter_mut().zip(node) {
                *sum += w * x;
            }
        }
        // Interpolation may leave [0, 1] by the table's error.
        sum.map(|x| x.clamp(0.0, 1.0))
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

/// Directional albedo of one bounce under an exact Fresnel term, F = 1 not included.
#[derive(Clone, Debug)]
pub enum FresnelAlbedo {
    /// Off a conductor: red, green and blue.
    Conductor(ViewCurve<3>),
    /// Off and through a dielectric.
    Dielectric(DielectricAlbedo),
}

impl Tables {
    /// The moments of the albedo of a named material, from which those of F = 1, Schlick's approximation and OpenPBR's metals are made; for
    /// the form of masking that the recipe names, uncorrelated if it names none.
    ///
    /// The middle of the material's ranges is bound; of an anisotropic one the isotropic stand-in √(σx σy): its own albedo, by azimuth, is
    /// [`material_view_albedo`](Self::material_view_albedo).
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], or what [`albedo`](Self::albedo) reports.
    pub fn material_albedo(&self, name: &str) -> Result<Albedo, BindError> {
        let (sigma, gamma, masking) = middle(self.student_t_entry(name)?);
        self.albedo(sigma, gamma, masking)
    }

    /// The albedo of a named conductor or dielectric under its exact reflectance, bound as by [`material_albedo`](Self::material_albedo); of a
    /// range of indices the one in the middle of their F0^¼.
    ///
    /// Below σ = 1e-8 it is held at what it is there.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::NoTable`] for a material that states no such reflectance or was baked without albedos.
    pub fn material_fresnel_albedo(&self, name: &str) -> Result<FresnelAlbedo, BindError> {
        let entry = self.student_t_entry(name)?;
        let (sigma, gamma, masking) = middle(entry);
        let Some(fresnel) = entry.fresnel.filter(|entry| !entry.label().is_empty()) else {
            return Err(BindError::NoTable(Kind::FresnelAlbedo.name().to_string()));
        };
        if let Some(eta) = fresnel.middle_index() {
            return Ok(FresnelAlbedo::Dielectric(self.dielectric_albedo(sigma, gamma, eta, masking)?));
        }
        // The domain follows the reflectance, so that one index is not another's beginning.
        let masking_name = masking.name().replace('-', "_");
        let start = format!("{}_{masking_name}_{}_gamma_", Kind::FresnelAlbedo.name(), fresnel.label());
        let tables = self.tables().iter();
        let found = tables
            .filter(|table| table.kind == Kind::FresnelAlbedo && table.name.starts_with(&start))
            .find_map(|table| Some((table, at_material(table, sigma, gamma)?)));
        let Some((table, (at, sigma))) = found else { return Err(BindError::NoTable(start)) };
        let view = View::Blend(ViewCoordinate::new(&table.axes[2], sigma, gamma));
        Ok(FresnelAlbedo::Conductor(ViewCurve::new(table, &at, view)))
    }
}

/// Nodes of an axis with their weights.
pub(crate) type Weights = Vec<(usize, f64)>;

/// Weights along the axes γ and σ of a table, and the σ that they are at: no less than the first of a table that reaches down to none. `None`
/// if it does not cover them.
pub(crate) fn at_material(table: &Table, sigma: f64, gamma: f64) -> Option<(Vec<Weights>, f64)> {
    let [shapes, roughnesses, ..] = &table.axes[..] else { unreachable!("validated on load") };
    let at = sigma.max(albedo_axes::roughness(roughnesses, roughnesses.nodes[0]));
    if !albedo::reaches(roughnesses, sigma) {
        return None;
    }
    let rows = albedo_axes::weights(shapes, albedo_axes::shape_coordinate(shapes, gamma))?;
    let columns = albedo_axes::weights(roughnesses, albedo_axes::roughness_coordinate(roughnesses, at))?;
    Some((vec![rows, columns], at))
}

impl<const N: usize> ViewCurve<N> {
    /// The values of a table of N channels, its axes but the last collapsed.
    pub(crate) fn new(table: &Table, at: &[Weights], view: View) -> Self {
        let views = table.axes[at.len()].len();
        let mut nodes = vec![[0.0_f32; N]; views];
        // All combinations of the nodes along the axes, as one index and the product of the weights.
        let mut rows = vec![(0, 1.0)];
        for (axis, weights) in table.axes.iter().zip(at) {
            let all = rows
                .iter()
                .flat_map(|&(row, a)| weights.iter().map(move |&(i, b)| (row * axis.len() + i, a * b)));
            rows = all.collect();
        }
        for (row, weight) in rows {
            let row = table.values[row * views * N..].chunks_exact(N);
            for (into, node) in nodes.iter_mut().zip(row) {
                for (x, value) in into.iter_mut().zip(node) {
                    *x += weight as f32 * value;
                }
            }
        }
        Self { nodes, view }
    }
}

/// σ, γ and masking in the middle of a material's ranges.
pub(crate) fn middle(entry: &MaterialEntry) -> (f64, f64, Masking) {
    let middle = |[min, max]: [f64; 2]| if min == max { min } else { 0.5 * (min + max) };
    let [x, y] = entry.sigma.map(middle);
    let sigma = if x == y { x } else { libm::sqrt(x * y) };
    (sigma, 1.0 + 1.0 / middle(entry.s), entry.masking.unwrap_or(Masking::Uncorrelated))
}
