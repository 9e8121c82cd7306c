//! Albedos of the materials of a recipe: of the reflectance it names.

use alloc::format;
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use crate::albedo::{self, Albedo, within};
use crate::albedo_axes::{self, STENCIL, ViewCoordinate, stencil};
use crate::container::{FresnelEntry, MaterialEntry};
use crate::error::BindError;
use crate::student_t::Masking;
use crate::table::Kind;
use crate::tables::Tables;

/// Channels of `fresnel_albedo` tables: of a conductor and of a dielectric.
pub(crate) const CHANNELS: [&[&str]; 2] = [&["red", "green", "blue"], &["reflection", "reflection_leaving"]];

/// N albedos as functions of the view, the γ and σ axes of their table collapsed.
#[derive(Clone, Debug)]
pub struct ViewCurve<const N: usize> {
    nodes: Vec<[f32; N]>,
    view: ViewCoordinate,
}

impl<const N: usize> ViewCurve<N> {
    /// The albedos at a view, each in [0, 1]; `cos_theta` outside [0, 1] is taken at the nearer end, NaN at grazing, and beyond
    /// the table's last view, cos θ = 1/(5e4 + 500/σ) in the tables of this version, they are held constant.
    pub fn eval(&self, cos_theta: f32) -> [f32; N] {
        let (start, weights) = stencil(self.view.clamped(within(cos_theta)), self.nodes.len());
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
    /// Reflected off a dielectric: seen from outside, and from inside (where `cos_theta` is that of the view inside).
    Dielectric(ViewCurve<2>),
}

impl Tables {
    /// The moments of the albedo of a named material, from which those of F = 1, Schlick's approximation and OpenPBR's metals are made; for
    /// the form of masking that the recipe names, uncorrelated if it names none.
    ///
    /// The middle of the material's ranges is bound; of an anisotropic one the isotropic stand-in √(σx σy).
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], or what [`albedo`](Self::albedo) reports.
    pub fn material_albedo(&self, name: &str) -> Result<Albedo, BindError> {
        let (sigma, gamma, masking) = middle(self.student_t_entry(name)?);
        self.albedo(sigma, gamma, masking)
    }

    /// The albedo of a named conductor or dielectric under its exact reflectance, bound as by [`material_albedo`](Self::material_albedo).
    ///
    /// Below σ = 1e-8 it is held at what it is there.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::NoTable`] for a material that states no such reflectance or was baked without albedos.
    pub fn material_fresnel_albedo(&self, name: &str) -> Result<FresnelAlbedo, BindError> {
        let entry = self.student_t_entry(name)?;
        let (sigma, gamma, masking) = middle(entry);
        let label = entry.fresnel.as_ref().map_or_else(Default::default, FresnelEntry::label);
        let start = format!("{}_{}_{label}", Kind::FresnelAlbedo.name(), masking.name().replace('-', "_"));
        if label.is_empty() {
            return Err(BindError::NoTable(start));
        }
        Ok(match entry.fresnel {
            Some(FresnelEntry::Dielectric(_)) => {
                FresnelAlbedo::Dielectric(self.view_curve(&start, sigma, gamma)?)
            }
            _ => FresnelAlbedo::Conductor(self.view_curve(&start, sigma, gamma)?),
        })
    }

    /// The table whose name begins with `start` and that covers (σ, γ), collapsed there.
    fn view_curve<const N: usize>(
        &self,
        start: &str,
        sigma: f64,
        gamma: f64,
    ) -> Result<ViewCurve<N>, BindError> {
        // The domain follows the reflectance, so that one index is not another's beginning.
        let named = format!("{start}_gamma_");
        for table in self
            .tables()
            .iter()
            .filter(|table| table.kind == Kind::FresnelAlbedo && table.name.starts_with(&named))
        {
            let [shapes, roughnesses, views] = &table.axes[..] else { unreachable!("validated on load") };
            let at = sigma.max(albedo_axes::roughness(roughnesses, roughnesses.nodes[0]));
            let reached = |_: &Vec<(usize, f64)>| albedo::reaches(roughnesses, sigma);
            let (Some(rows), Some(columns), true) = (
                albedo_axes::weights(shapes, albedo_axes::shape_coordinate(shapes, gamma)),
                albedo_axes::weights(roughnesses, albedo_axes::roughness_coordinate(roughnesses, at))
                    .filter(reached),
                table.channels.len() == N,
            ) else {
                continue;
            };
            let mut nodes = vec![[0.0_f32; N]; views.len()];
            for &(i, a) in &rows {
                for &(j, b) in &columns {
                    let row = &table.values[(i * roughnesses.len() + j) * views.len() * N..];
                    for (into, node) in nodes.iter_mut().zip(row.chunks_exact(N)) {
                        for (x, value) in into.iter_mut().zip(node) {
                            *x += (a * b) as f32 * value;
                        }
                    }
                }
            }
            return Ok(ViewCurve { nodes, view: ViewCoordinate::new(views, at, gamma) });
        }
        Err(BindError::NoTable(start.to_string()))
    }
}

/// σ, γ and masking in the middle of a material's ranges.
fn middle(entry: &MaterialEntry) -> (f64, f64, Masking) {
    let middle = |[min, max]: [f64; 2]| if min == max { min } else { 0.5 * (min + max) };
    let [x, y] = entry.sigma.map(middle);
    let sigma = if x == y { x } else { libm::sqrt(x * y) };
    (sigma, 1.0 + 1.0 / middle(entry.s), entry.masking.unwrap_or(Masking::Uncorrelated))
}
