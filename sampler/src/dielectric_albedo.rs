//! Albedos of dielectrics: what a rough interface reflects and what it transmits, seen from either side.

use crate::albedo_axes::{self, ViewCoordinate};
use crate::container::FresnelEntry;
use crate::critical::CriticalCoordinate;
use crate::error::BindError;
use crate::fresnel_albedo::{View, ViewCurve, at_material, middle};
use crate::student_t::Masking;
use crate::table::Kind;
use crate::tables::Tables;

/// Channels of `dielectric_albedo` tables: seen from the thin side, whose light enters, and from the dense one.
pub(crate) const CHANNELS: [&[&str]; 2] =
    [&["reflection", "transmission"], &["reflection_leaving", "transmission_leaving"]];

/// Directional albedo of one bounce off a rough dielectric, under its exact reflectance: the shares of light reflected and transmitted. What is
/// missing to one is shadowed, and left to further bounces.
#[derive(Clone, Debug)]
pub struct DielectricAlbedo {
    /// Seen from outside: [reflection, transmission] by the cosine of the view outside.
    pub outside: ViewCurve<2>,
    /// Seen from inside: [reflection, transmission] by the cosine of the view inside.
    pub inside: ViewCurve<2>,
}

impl FresnelEntry {
    /// The index of a dielectric, in the middle of the F0^¼ of several; `None` of what is no dielectric.
    pub(crate) fn middle_index(&self) -> Option<f64> {
        if let Self::Dielectric(eta) = self {
            return Some(*eta);
        }
        let [a, b] = self.indices()?.map(albedo_axes::index_coordinate);
        Some(1.0 / albedo_axes::inverse_index(0.5 * (a + b)))
    }
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
        let (sigma, gamma, masking) = middle(self.student_t_entry(name)?);
        self.dielectric_albedo(sigma, gamma, eta, masking)
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
        let dense = if leaves { 1.0 / eta } else { eta };
        let tables = self.tables().iter().filter(|table| {
            table.kind == Kind::DielectricAlbedo
                && table.masking == Some(masking)
                && table.channels == CHANNELS[usize::from(leaves)]
        });
        let found = tables.into_iter().find_map(|table| {
            let (mut at, sigma) = at_material(table, sigma, gamma)?;
            at.push(albedo_axes::weights(&table.axes[2], albedo_axes::index_coordinate(dense))?);
            Some((table, at, sigma))
        });
        let (table, at, sigma) = found.ok_or(BindError::Dielectric([eta, sigma, gamma]))?;
        let view = if leaves {
            View::Critical(CriticalCoordinate::new(&table.axes[3], sigma, gamma, eta))
        } else {
            View::Blend(ViewCoordinate::new(&table.axes[3], sigma, gamma))
        };
        Ok(ViewCurve::new(table, &at, view))
    }
}
