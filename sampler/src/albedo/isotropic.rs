//! The directional albedo of isotropic members of the family, over γ, σ and cos θ.

use alloc::format;
use alloc::vec::Vec;

use microfacet_common::Masking;

use super::collapse::{
    at_material, at_shape, collapse, domains, first_sigma, is_mirror, last_sigma, reaches_mirrors, view_blend,
};
use super::curve::within;
use super::moments::{Moments, fade, less_mirror, over_views};
use crate::axis::BoundView;
use crate::axis::lagrange::{combine, six};
use crate::error::BindError;
use crate::format::{Kind, Table};
use crate::tables::Tables;

/// The directional albedo of one material, with the γ and σ axes of the table collapsed.
///
/// Made by [`Tables::albedo`]. `cos_theta` is the view's cosine to the macro normal; values outside [0, 1] and NaN are taken at the nearer
/// end (NaN at grazing). Errors are those of the table's certificate: at most 3e-4 in the default set for cos θ ≥ 0.02 and σ ≥ 0.01, at most
/// 2e-3 elsewhere.
#[derive(Clone, Debug)]
pub struct Albedo {
    masking: Masking,
    sigma: f32,
    /// What the view nodes hold; see [`Kind::MOMENTS`].
    nodes: Vec<[f32; 3]>,
    view: BoundView,
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
        if is_mirror(sigma, first_sigma(table)) {
            nodes.fill([0.0; 3]);
        }
        let power = match masking {
            Masking::Uncorrelated => 0.0,
            Masking::HeightCorrelated => (2.0 * gamma - 3.0).min(1.0) as f32,
        };
        let view = view_blend(&table.axes[2]).bind(sigma.max(first_sigma(table)), gamma);
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
        Ok(Moments::mirror_average().plus(if is_mirror(sigma, first_sigma(table)) {
            [0.0; 3]
        } else {
            rest[0]
        }))
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
        let found = tables().find_map(|table| Some((table, at_material(table, sigma, gamma)?.0)));
        if let Some((table, at)) = found {
            return Ok((table, collapse(table, &at)));
        }
        if tables().any(|table| !reaches_mirrors(table)) {
            return Err(BindError::AlbedoNotCovered { sigma, gamma, covered: domains(tables()) });
        }
        let max = tables().filter(|table| at_shape(table, gamma).is_some()).map(last_sigma).reduce(f64::max);
        if let Some(max) = max {
            return Err(BindError::SigmaNotCovered { sigma, max });
        }
        let gammas = |table: &Table| {
            let [to, from] =
                table.axes[0].ends().map(|t| table.axes[0].quantity(t).expect("validated on load"));
            format!("[{from:.6}, {to}]")
        };
        let covered: Vec<_> = tables().map(gammas).collect();
        let covered = if covered.is_empty() { "nothing".into() } else { covered.join(", ") };
        Err(BindError::NotCovered { kind: kind.name(), gamma, covered })
    }
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
        less_mirror(over_views(self.view.floor(), |cos| self.rest(cos)))
    }

    /// What a table of any number of nodes would hold at cos θ ∈ [0, 1]; E in [0, 1], so that what is lost and its average agree.
    fn rest(&self, cos: f32) -> [f32; 3] {
        let floor = self.view.floor() as f32;
        let [e, bias, f82] = self.interpolate(self.view.clamped(cos));
        let e = e.clamp(-1.0, 0.0);
        if cos >= floor || self.power == 0.0 {
            return [e, bias, f82];
        }
        // Correlated masking lets through ever more of what is seen, up to all of it.
        fade([e, bias, f82], libm::powf(cos / floor, self.power))
    }

    fn interpolate(&self, t: f32) -> [f32; 3] {
        let (start, weights) = six(t, self.nodes.len());
        combine(&self.nodes, start, &weights)
    }
}
