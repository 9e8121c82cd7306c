//! Albedos of dielectrics: what a rough interface reflects and what it transmits, seen from either side.

use microfacet_common::Masking;

use super::collapse::at_material;
use super::curve::{View, ViewCurve};
use crate::axis::Mapping;
use crate::error::BindError;
use crate::format::Kind;
use crate::tables::Tables;

/// Directional albedo of one bounce off a rough dielectric, under its exact reflectance: the shares of light reflected and transmitted. What is
/// missing to one is shadowed, and left to further bounces.
#[derive(Clone, Debug)]
pub struct DielectricAlbedo {
    /// Seen from outside: [reflection, transmission] by the cosine of the view outside.
    pub outside: ViewCurve<2>,
    /// Seen from inside: [reflection, transmission] by the cosine of the view inside.
    pub inside: ViewCurve<2>,
}

impl Tables {
    /// The albedo of a rough interface of index η ∈ (0, ∞], inside over outside, with σ and γ, for one form of masking. Takes some
    /// microseconds; keep the result.
    ///
    /// # Errors
    /// [`BindError::Dielectric`] if the set's `dielectric_albedo` tables do not cover it.
    pub fn dielectric_albedo(
        &self,
        sigma: f64,
        gamma: f64,
        eta: f64,
        masking: Masking,
    ) -> Result<DielectricAlbedo, BindError> {
        let side = |eta| self.interface_albedo(sigma, gamma, eta, masking);
        Ok(DielectricAlbedo { outside: side(eta)?, inside: side(1.0 / eta)? })
    }

    /// The albedo of a named material at an index η of the range that its recipe states.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], or as [`dielectric_albedo`](Self::dielectric_albedo).
    pub fn material_dielectric_albedo(&self, name: &str, eta: f64) -> Result<DielectricAlbedo, BindError> {
        let entry = self.student_t_entry(name)?;
        self.dielectric_albedo(entry.round_sigma(), entry.gamma(), eta, entry.masking())
    }

    /// The same from one side: [reflection, transmission] where η is the index beyond the interface over that on the viewer's side, in [0, ∞].
    ///
    /// # Errors
    /// [`BindError::Dielectric`] if no `dielectric_albedo` table of that side covers it.
    pub fn interface_albedo(
        &self,
        sigma: f64,
        gamma: f64,
        eta: f64,
        masking: Masking,
    ) -> Result<ViewCurve<2>, BindError> {
        let leaves = eta < 1.0;
        let (dense, channels) = if leaves { (1.0 / eta, Kind::LEAVING) } else { (eta, Kind::ENTERING) };
        let mut tables = self.tables().iter().filter(|table| {
            table.kind == Kind::DielectricAlbedo
                && table.masking == Some(masking)
                && table.channels == channels
        });
        let found = tables.find_map(|table| {
            let (mut at, sigma) = at_material(table, sigma, gamma)?;
            let indices = &table.axes[2];
            at.push(indices.weights(indices.coordinate(dense)?)?);
            Some((table, at, sigma))
        });
        let (table, at, sigma) = found.ok_or(BindError::Dielectric([eta, sigma, gamma]))?;
        let view = match table.axes[3].mapping {
            Mapping::ViewBlend(blend) => View::Blend(blend.bind(sigma, gamma)),
            Mapping::CriticalBlend(blend) => View::Critical(blend.bind(sigma, gamma, eta)),
            _ => unreachable!("validated on load"),
        };
        Ok(ViewCurve::new(table, &at, view))
    }
}
