//! The materials of a recipe, as a set lists them.

use alloc::format;
use alloc::string::String;

use microfacet_core::Masking;
use serde::{Deserialize, Serialize};

use super::ensure;
use super::haze::{self, Haze, check_share};
use super::lobe::LobeSpec;
use super::reflectance::Reflectance;
use super::stored::{Range, Sigma};
use crate::interval::Interval;

/// A named material of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "InFile", into = "InFile")]
pub struct MaterialEntry {
    /// Its name.
    pub name: String,
    /// Its lobe; the core, if it has a haze.
    pub lobe: LobeSpec,
    /// Its second lobe, if it has one.
    pub haze: Option<Haze>,
    /// The share in [0, 1] of the reflected light that goes back to where it comes from instead of
    /// the mirror direction; [`SPECULAR`](Self::SPECULAR) if none does.
    pub retroreflection: Interval,
    /// The form of masking and shadowing that it states, if any.
    pub masking: Option<Masking>,
    /// The reflectance of its facets, if it states one.
    pub fresnel: Option<Reflectance>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "MaterialEntry", deny_unknown_fields)]
struct InFile {
    name: String,
    sigma: Sigma,
    gamma: Range,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distribution: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    theta: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    masking: Option<Masking>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fresnel: Option<Reflectance>,
    // From version 5 on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    haze: Option<haze::InFile>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    retroreflection: Option<Range>,
}

impl From<MaterialEntry> for InFile {
    fn from(entry: MaterialEntry) -> Self {
        let is_retroreflecting = entry.is_retroreflecting();
        let MaterialEntry { name, lobe, haze, retroreflection, masking, fresnel } = entry;
        let LobeSpec { roughness, gamma, theta, distribution } = lobe;
        let (sigma, gamma, haze) = (roughness.into(), gamma.into(), haze.map(Into::into));
        let retroreflection = is_retroreflecting.then(|| retroreflection.into());
        Self { name, sigma, gamma, distribution, theta, masking, fresnel, haze, retroreflection }
    }
}

impl From<InFile> for MaterialEntry {
    fn from(stored: InFile) -> Self {
        let InFile { name, sigma, gamma, distribution, theta, masking, fresnel, .. } = stored;
        let (roughness, gamma) = (sigma.into(), gamma.into());
        let lobe = LobeSpec { roughness, gamma, theta, distribution };
        let (haze, share) = (stored.haze.map(Into::into), stored.retroreflection);
        let retroreflection = share.map_or(Self::SPECULAR, Interval::from);
        Self { name, lobe, haze, retroreflection, masking, fresnel }
    }
}

impl MaterialEntry {
    /// The share of retroreflection of a material without any.
    pub const SPECULAR: Interval = Interval::point(0.0);

    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        self.lobe.roughness.check()?;
        self.lobe.check()?;
        let haze = self.haze.as_ref();
        haze.map_or(Ok(()), Haze::check).map_err(|why| format!("haze: {why}"))?;
        check_share("retroreflection", self.retroreflection)?;
        let is_upright = self.lobes().all(|lobe| lobe.theta.is_none());
        ensure(is_upright || !self.is_retroreflecting(), || {
            "retroreflection off a tilted lobe, with theta, would not be reciprocal".into()
        })?;
        self.fresnel.iter().try_for_each(Reflectance::check_of_material)
    }

    /// Its lobes: the core, then the haze if it has one.
    pub fn lobes(&self) -> impl Iterator<Item = &LobeSpec> {
        core::iter::once(&self.lobe).chain(self.haze.iter().map(|haze| &haze.lobe))
    }

    /// It as entries of one lobe each under its name: the core, then the haze if it has one. They
    /// state no retroreflection, for which no table differs.
    pub fn parts(&self) -> impl Iterator<Item = Self> {
        let of = |lobe: &LobeSpec| Self {
            name: self.name.clone(),
            lobe: lobe.clone(),
            haze: None,
            retroreflection: Self::SPECULAR,
            ..*self
        };
        self.lobes().map(of)
    }

    /// Whether it sends any light back to where it comes from, at any point.
    pub fn is_retroreflecting(&self) -> bool {
        self.retroreflection != Self::SPECULAR
    }

    /// The form of masking that it states; height-correlated if it states none.
    pub fn masking(&self) -> Masking {
        self.masking.unwrap_or_default()
    }

    /// The version of the format that has all that it states.
    pub(super) fn version(&self) -> u32 {
        if self.haze.is_some() || self.is_retroreflecting() { 5 } else { 4 }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::Roughness;

    fn plain() -> MaterialEntry {
        MaterialEntry {
            name: "m".into(),
            lobe: LobeSpec::student_t([0.25; 2], 3.0),
            haze: None,
            retroreflection: MaterialEntry::SPECULAR,
            masking: None,
            fresnel: None,
        }
    }

    fn hazy() -> MaterialEntry {
        let sigma = Roughness::Isotropic([0.5, 0.75].into());
        let lobe = LobeSpec::family(sigma, [2.0, f64::INFINITY].into());
        let haze = Some(Haze { weight: [0.25, 0.5].into(), lobe });
        MaterialEntry { haze, retroreflection: Interval::point(0.5), ..plain() }
    }

    #[test]
    fn an_entry_states_a_haze_and_retroreflection_only_where_it_has_them() {
        let text = |entry: &MaterialEntry| serde_json::to_string(entry).unwrap();
        let begin = r#"{"name":"m","sigma":0.25,"gamma":3.0"#;
        assert_eq!(text(&plain()), format!("{begin}}}"));
        let haze = r#""haze":{"weight":{"min":0.25,"max":0.5},"sigma":{"min":0.5,"max":0.75},"#;
        let stated = format!(r#"{begin},{haze}"gamma":{{"min":2.0}}}},"retroreflection":0.5}}"#);
        assert_eq!(text(&hazy()), stated);
        let outside = LobeSpec::outside("gtr:0.2,1.5".into());
        let gtr = LobeSpec { roughness: Roughness::Isotropic([0.5; 2].into()), ..outside };
        let tilted =
            LobeSpec { theta: Some([0.1, 0.2, 0.3]), ..LobeSpec::student_t([0.1; 2], 2.0) };
        for lobe in [gtr, tilted] {
            let haze = Some(Haze { weight: Interval::point(1.0), lobe });
            let entry = MaterialEntry { haze, ..plain() };
            assert_eq!(serde_json::from_str::<MaterialEntry>(&text(&entry)).unwrap(), entry);
            assert_eq!(entry.check(), Ok(()));
        }
        for entry in [plain(), hazy()] {
            assert_eq!(serde_json::from_str::<MaterialEntry>(&text(&entry)).unwrap(), entry);
            assert_eq!(entry.check(), Ok(()));
        }
        // −0 is 0, and states nothing.
        let zero = MaterialEntry { retroreflection: Interval::point(-0.0), ..plain() };
        assert_eq!((text(&zero), zero.version()), (text(&plain()), 4));
        for other in [r#""haze":{"sigma":0.5,"gamma":2}"#, r#""haze":0.5"#, r#""retro":0.5"#] {
            let wrong = format!("{begin},{other}}}");
            assert!(serde_json::from_str::<MaterialEntry>(&wrong).is_err(), "{other}");
        }
        let more = stated.replace(r#","gamma":{"#, r#","colour":1,"gamma":{"#);
        assert!(serde_json::from_str::<MaterialEntry>(&more).is_err());
    }

    #[test]
    fn a_haze_and_a_share_are_checked() {
        let refused = |what: &str, change: &dyn Fn(&mut MaterialEntry)| {
            let mut entry = hazy();
            change(&mut entry);
            let why = entry.check().unwrap_err();
            assert!(why.contains(what), "{why}");
        };
        let of = |entry: &mut MaterialEntry, change: &dyn Fn(&mut Haze)| {
            change(entry.haze.as_mut().unwrap());
        };
        for share in [[f64::NAN; 2], [0.0, f64::NAN], [-1.0, 0.5], [0.5, 2.0], [0.75, 0.25]] {
            refused("haze: weight = [", &|entry| of(entry, &|haze| haze.weight = share.into()));
            refused("retroreflection = [", &|entry| entry.retroreflection = share.into());
        }
        refused("haze: sigma = [0, inf]", &|entry| {
            of(entry, &|haze| haze.lobe.roughness = Roughness::ALL);
        });
        refused("haze: gamma = [1.5, inf]", &|entry| of(entry, &|haze| haze.lobe.gamma.min = 1.5));
        // Half a turn about the normal changes a lobe of three angles.
        let tilted = LobeSpec { theta: Some([0.1; 3]), ..LobeSpec::student_t([0.1; 2], 2.0) };
        refused("would not be reciprocal", &|entry| entry.lobe = tilted.clone());
        refused("would not be reciprocal", &|entry| of(entry, &|of| of.lobe = tilted.clone()));
        let haze = Haze { weight: Interval::point(0.5), lobe: tilted };
        let specular = MaterialEntry { haze: Some(haze), ..plain() };
        assert_eq!(specular.check(), Ok(()));
    }

    #[test]
    fn lobes_are_the_core_and_the_haze() {
        let entry = hazy();
        let lobes: Vec<&LobeSpec> = entry.lobes().collect();
        assert_eq!(lobes, [&entry.lobe, &entry.haze.as_ref().unwrap().lobe]);
        let [core, haze] = [&entry.lobe, &entry.haze.as_ref().unwrap().lobe]
            .map(|lobe| MaterialEntry { lobe: lobe.clone(), ..plain() });
        assert_eq!(entry.parts().collect::<Vec<_>>(), [core, haze]);
        assert_eq!(plain().parts().collect::<Vec<_>>(), [plain()]);
    }
}
