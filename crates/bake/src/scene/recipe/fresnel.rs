//! The reflectance of a material, and its form of masking.

use microfacet_sampler::Metal;
use microfacet_sampler::bsdf::UnknownMetal;

use super::{CONDUCTOR_KEYS, FRESNEL_KEYS, Source, Value, quoted};
use crate::scene::error::did_you_mean;
use crate::scene::{Masking, Reflectance, SceneError};

impl Source<'_> {
    pub(super) fn fresnel(&self, value: &Value<'_>) -> Result<Reflectance, SceneError> {
        let place = self.place(value.span());
        let forms = "fresnel must be \"mirror\", { schlick = F0 }, { schlick = [r, g, b] }, \
                     { metal = \"gold\" }, \
                     { conductor = { eta = [r, g, b], k = [r, g, b] } } or { dielectric = eta }, a number or \
                     { min = .., max = .. }";
        if value.get_ref().as_str() == Some("mirror") {
            return Ok(Reflectance::Mirror);
        }
        let table = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
        self.only_keys(table, &FRESNEL_KEYS)?;
        let mut entries = table.iter();
        let (Some((form, value)), None) = (entries.next(), entries.next()) else {
            return Err(place.invalid(forms));
        };
        match form.get_ref().as_ref() {
            "schlick" => {
                let f0 = |value: &Value<'_>| {
                    let f0 = self.number(value, "schlick")?;
                    let valid = (0.0..=1.0).contains(&f0);
                    self.check(value, valid, "schlick", "a reflectance from 0 to 1")?;
                    Ok(f0)
                };
                if value.get_ref().is_array() {
                    return Ok(Reflectance::Schlick(self.rgb(
                        value,
                        "schlick",
                        "[0.95, 0.64, 0.54]",
                        f0,
                    )?));
                }
                Ok(Reflectance::Schlick([f0(value)?; 3]))
            }
            "metal" => self.metal(value),
            "dielectric" if value.get_ref().is_table() => {
                let eta = self.interval(value, "dielectric")?;
                let valid = eta.min >= 1.0 && eta.min < f64::INFINITY && eta.min < eta.max;
                let what = "a range of indices inside over outside, from 1 or more up to \"inf\"; both sides are baked";
                self.check(value, valid, "dielectric", what)?;
                Ok(Reflectance::Dielectric(eta))
            }
            "dielectric" => Ok(Reflectance::dielectric(self.index(value, "dielectric")?)),
            _ => {
                let table = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
                self.only_keys(table, &CONDUCTOR_KEYS)?;
                let (Some(eta), Some(k)) = (table.get("eta"), table.get("k")) else {
                    return Err(
                        place.invalid("a conductor needs both eta = [r, g, b] and k = [r, g, b]")
                    );
                };
                Ok(Reflectance::Conductor {
                    eta: self
                        .rgb(eta, "eta", "[0.2, 0.9, 1.1]", |value| self.index(value, "eta"))?,
                    k: self.rgb(k, "k", "[3.9, 2.4, 2.2]", |value| {
                        let k = self.number(value, "k")?;
                        let valid = (0.0..f64::INFINITY).contains(&k);
                        self.check(
                            value,
                            valid,
                            "k",
                            "an extinction coefficient, finite and 0 or more",
                        )?;
                        Ok(k)
                    })?,
                })
            }
        }
    }

    fn metal(&self, value: &Value<'_>) -> Result<Reflectance, SceneError> {
        let invalid = |what: String| self.place(value.span()).invalid(what);
        let Some(name) = value.get_ref().as_str() else {
            let text = self.text.get(value.span()).unwrap_or_default();
            let why = UnknownMetal;
            return Err(invalid(format!("metal = {text} is not a name in quotes; {why}")));
        };
        let metal: Metal = name.parse().map_err(|why: UnknownMetal| {
            let hint = did_you_mean(name, &Metal::ALL.map(Metal::name));
            invalid(format!("no metal is known as {}{hint}; {why}", quoted(name)))
        })?;
        Ok(metal.into())
    }

    fn index(&self, value: &Value<'_>, key: &str) -> Result<f64, SceneError> {
        let eta = self.number(value, key)?;
        let valid = eta > 0.0 && eta < f64::INFINITY;
        self.check(value, valid, key, "an index of refraction, finite and more than 0")?;
        Ok(eta)
    }

    fn check(
        &self,
        value: &Value<'_>,
        valid: bool,
        key: &str,
        what: &str,
    ) -> Result<(), SceneError> {
        if valid {
            return Ok(());
        }
        let text = self.text.get(value.span()).unwrap_or_default();
        Err(self
            .place(value.span())
            .invalid(format!("{key} = {text} is out of range; it must be {what}")))
    }

    fn rgb(
        &self,
        value: &Value<'_>,
        key: &str,
        example: &str,
        channel: impl Fn(&Value<'_>) -> Result<f64, SceneError>,
    ) -> Result<[f64; 3], SceneError> {
        match value.get_ref().as_array().map(|array| &array[..]) {
            Some([r, g, b]) => Ok([channel(r)?, channel(g)?, channel(b)?]),
            _ => Err(self.place(value.span()).invalid(format!(
                "{key} must be three numbers, for red, green and blue: {key} = {example}"
            ))),
        }
    }

    pub(super) fn masking(&self, value: &Value<'_>) -> Result<Masking, SceneError> {
        let name = value.get_ref().as_str().unwrap_or_default();
        name.parse().map_err(|why: microfacet_core::UnknownMasking| {
            let hint = did_you_mean(name, &Masking::ALL.map(Masking::name));
            self.place(value.span()).invalid(format!("{why}{hint}"))
        })
    }
}
