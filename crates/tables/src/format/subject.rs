//! The subject of a table: its lobes, masking and reflectance. Readers find tables by these data,
//! not by names.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use microfacet_core::Masking;
use serde::{Deserialize, Serialize};

use super::ensure;
use super::kind::Kind;
use super::lobe::{LobeForm, LobeSpec, Roughness};
use super::reflectance::Reflectance;
use super::stored::{Single, gamma_of};
use crate::interval::Interval;

/// The side from which a dielectric is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The side of the smaller index of refraction; refraction enters the dense side.
    Thin,
    /// The side of the larger index, with total reflection beyond the critical angle.
    Dense,
}

impl Side {
    /// Both sides.
    pub const ALL: [Self; 2] = [Self::Thin, Self::Dense];

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Thin => "thin",
            Self::Dense => "dense",
        }
    }
}

/// The parts of a name joined by `_`, without the empty ones.
pub fn joined_name(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
    parts.join("_")
}

/// What a table is of, besides its kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The lobes that it was baked and measured for; its axes may have nodes beyond, which
    /// interpolation reads. Tables of slopes divided by σ, and those of a distribution outside the
    /// family, are of every σ.
    pub lobe: LobeSpec,
    /// The form of G2 of an albedo; `None` where values depend on one direction only.
    pub masking: Option<Masking>,
    /// The reflectance of an albedo.
    pub reflectance: Option<Reflectance>,
}

impl Subject {
    /// The subject of a table of one direction.
    pub const fn of(lobe: LobeSpec) -> Self {
        Self { lobe, masking: None, reflectance: None }
    }

    /// The subject of a table of one direction over the range [min, max] of s = 1/(γ−1).
    pub fn shapes(s: [f64; 2]) -> Self {
        let [max, min] = s.map(gamma_of);
        Self::of(LobeSpec::family(Roughness::ALL, Interval { min, max }))
    }

    /// The name of a table of this kind and subject, in characters that file names can have.
    pub fn name(&self, kind: Kind) -> String {
        let masking = self.masking.map_or("", Masking::name);
        let reflectance = self.reflectance.map(|of| of.label()).unwrap_or_default();
        joined_name(&[kind.name(), masking, &reflectance, &self.lobe.label()])
    }

    /// γ and σ, where they are single numbers.
    pub(super) fn single(&self) -> Single {
        let (lobe, form) = (&self.lobe, self.lobe.form());
        let point = |range: Interval| range.is_point().then_some(range.min);
        Single {
            gamma: point(lobe.gamma).filter(|_| form != LobeForm::Distribution),
            sigma: point(lobe.roughness.x()).filter(|_| form == LobeForm::Family),
            is_lobe: form != LobeForm::Family,
            sigmas: (form == LobeForm::StudentT).then(|| lobe.sigma()),
        }
    }

    /// Checks the subject, and that it fits a kind of table; the error says what is wrong.
    pub(super) fn check(&self, kind: Kind) -> Result<(), String> {
        let Self { lobe, masking, reflectance } = self;
        ensure([masking.is_some(), reflectance.is_some()] == [kind.is_albedo(); 2], || {
            "an albedo names the masking and the reflectance it is for, and no other table does"
                .into()
        })?;
        let form = lobe.form();
        let fits = match kind {
            Kind::Albedo => true,
            _ if kind.is_radial() => form == LobeForm::Distribution,
            _ => form == LobeForm::Family,
        };
        let name = kind.name();
        ensure(fits, || format!("{name} tables are not of a lobe of the form {form:?}"))?;
        if kind.is_albedo() && form != LobeForm::Distribution {
            lobe.roughness.check()?;
        } else {
            let is_all = lobe.roughness == Roughness::ALL;
            ensure(is_all, || format!("{name} tables are of every sigma"))?;
        }
        lobe.check()?;
        let is_one = lobe.is_single() && lobe.sigmas().iter().all(|x| x.min > 0.0);
        ensure(form != LobeForm::StudentT || is_one, || {
            "the sigma and gamma of its lobe must be single numbers more than 0".into()
        })?;
        reflectance.iter().try_for_each(Reflectance::check_of_table)
    }
}
