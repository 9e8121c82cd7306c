//! Finds the albedos of a lobe in tables.

use alloc::boxed::Box;

use microfacet_core::Masking;
use microfacet_tables::{Kind, LobeSpec, Reflectance};

use crate::albedo::{Albedo, DielectricAlbedo};
use crate::bind_error::BindError;
use crate::error::MaterialError;
use crate::material::{LobeKey, Tabulated};
use crate::tables::Tables;

/// Whether the round lobe of √(σx σy) may stand in where the tables hold no albedo of an
/// anisotropic or tilted lobe itself.
///
/// Its albedo is off by 0.07 to 0.6 for anisotropic lobes and by 0.2 to 0.9 for tilted ones
/// (`docs/albedo.md`), so that compensation then returns too much light or too little. Exact
/// albedos are baked for a recipe that names the lobe, or when loading; of dielectrics for upright
/// lobes of the family only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StandIn {
    /// A missing albedo is an error.
    #[default]
    Refused,
    /// The albedo of the round lobe is used.
    Round,
}

impl Tables {
    /// The albedo of a lobe with F = 1: of the lobe itself, or of the round lobe in its stead.
    ///
    /// # Errors
    /// [`BindError::NoAlbedo`] naming the lobe, or
    /// [`BindError::Material`] for a round lobe that the tables do not cover.
    pub fn albedo_of(
        &self,
        lobe: &impl Tabulated,
        masking: Masking,
        stand_in: StandIn,
    ) -> Result<Albedo, BindError> {
        let key = lobe.key();
        let own = self.searched().iter().find(|table| {
            table.kind == Kind::Albedo
                && table.subject.masking == Some(masking)
                && table.subject.reflectance == Some(Reflectance::Mirror)
                && key.is(&table.subject.lobe)
        });
        if let Some(table) = own {
            return Ok(Albedo::from_table(table, f64::NAN, f64::NAN)?);
        }
        let round = round(&key, stand_in).ok_or_else(|| BindError::NoAlbedo {
            lobe: Box::new(key.clone()),
            eta: None,
            masking,
            nearest: None,
            stand_in: key.round().is_some(),
        })?;
        Ok(self.albedo(round.0, round.1, masking)?)
    }

    /// The albedo of a dielectric, by event and side: of the lobe itself, or of a round lobe in the
    /// stead of another.
    ///
    /// # Errors
    /// [`BindError::NoAlbedo`] naming the lobe, [`BindError::RoundOnly`] for a lobe without such
    /// tables, tilted or outside the family, if `stand_in` refuses a round one.
    pub fn dielectric_albedo_of(
        &self,
        lobe: &impl Tabulated,
        eta: f64,
        masking: Masking,
        stand_in: StandIn,
    ) -> Result<DielectricAlbedo, BindError> {
        let key = lobe.key();
        if let Some(own) = self.own_dielectric_albedo(|lobe| key.is(lobe), eta, masking) {
            return Ok(own);
        }
        let stood_for = key.round().is_some();
        let (sigma, gamma) = round(&key, stand_in).ok_or_else(|| match key {
            LobeKey::Upright(LobeSpec { distribution: None, .. }) => BindError::NoAlbedo {
                lobe: Box::new(key.clone()),
                eta: Some(eta),
                masking,
                nearest: None,
                stand_in: true,
            },
            _ => BindError::RoundOnly { stand_in: stood_for },
        })?;
        self.dielectric_albedo(sigma, gamma, eta, masking).map_err(|why| match why {
            MaterialError::DielectricNotCovered { nearest, .. } => {
                let lobe = Box::new(LobeKey::Upright(LobeSpec::student_t([sigma; 2], gamma)));
                BindError::NoAlbedo { lobe, eta: Some(eta), masking, nearest, stand_in: false }
            }
            why => why.into(),
        })
    }
}

/// σ and γ of a round lobe, or of the one that may stand in for another.
fn round(key: &LobeKey, stand_in: StandIn) -> Option<(f64, f64)> {
    let may = stand_in == StandIn::Round || key.is_round();
    key.round().filter(|_| may).map(|[sigma, gamma]| (sigma, gamma))
}
