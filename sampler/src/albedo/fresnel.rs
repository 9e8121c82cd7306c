//! Albedos of the materials of a recipe: of the reflectance it names.

use alloc::format;

use super::collapse::{at_material, view_blend};
use super::curve::{View, ViewCurve};
use super::dielectric::DielectricAlbedo;
use super::isotropic::Albedo;
use crate::error::BindError;
use crate::format::Kind;
use crate::tables::Tables;

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
        let entry = self.student_t_entry(name)?;
        self.albedo(entry.round_sigma(), entry.gamma(), entry.masking())
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
        let (sigma, gamma, masking) = (entry.round_sigma(), entry.gamma(), entry.masking());
        let Some(fresnel) = entry.fresnel.filter(|entry| !entry.label().is_empty()) else {
            return Err(BindError::NoTable(Kind::FresnelAlbedo.name().into()));
        };
        if let Some(eta) = fresnel.middle_index() {
            return Ok(FresnelAlbedo::Dielectric(self.dielectric_albedo(sigma, gamma, eta, masking)?));
        }
        // The domain follows the reflectance, so that one index is not another's beginning.
        let start = Kind::FresnelAlbedo.table_name(Some(masking), &format!("{}_gamma_", fresnel.label()));
        let mut tables = self
            .tables()
            .iter()
            .filter(|table| table.kind == Kind::FresnelAlbedo && table.name.starts_with(&start));
        let found = tables.find_map(|table| Some((table, at_material(table, sigma, gamma)?)));
        let Some((table, (at, sigma))) = found else { return Err(BindError::NoTable(start)) };
        let view = View::Blend(view_blend(&table.axes[2]).bind(sigma, gamma));
        Ok(FresnelAlbedo::Conductor(ViewCurve::new(table, &at, view)))
    }
}
