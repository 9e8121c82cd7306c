//! The reflectance of a material, and its form of masking.

use microfacet_sampler::Metal;
use microfacet_sampler::UnknownMetal;

use super::write::quoted;
use super::{CONDUCTOR_KEYS, Entry, FRESNEL_KEYS};
use crate::scene::error::did_you_mean;
use crate::scene::{Masking, Reflectance, SceneError};

const FORMS: &str = "\"mirror\", { schlick = F0 }, { schlick = [r, g, b] }, { metal = \"gold\" }, \
                     { conductor = { eta = [r, g, b], k = [r, g, b] } } or { dielectric = eta }, \
                     a number or { min = .., max = .. }";

impl<'a> Entry<'a> {
    pub(super) fn fresnel(self) -> Result<Reflectance, SceneError> {
        if self.text() == Some("mirror") {
            return Ok(Reflectance::Mirror);
        }
        self.only_keys(&FRESNEL_KEYS)?;
        let mut forms = FRESNEL_KEYS.iter().filter_map(|key| self.field(key));
        let (Some(form), None) = (forms.next(), forms.next()) else {
            return self.expected(FORMS);
        };
        Ok(match form.key {
            "schlick" if form.list().is_some() => {
                Reflectance::Schlick(form.rgb("[0.95, 0.64, 0.54]", Entry::reflectance)?)
            }
            "schlick" => Reflectance::Schlick([form.reflectance()?; 3]),
            "metal" => form.metal()?.into(),
            "dielectric" if form.table().is_some() => {
                let eta = form.interval()?;
                if !(eta.min >= 1.0 && eta.min < f64::INFINITY && eta.min < eta.max) {
                    return form.out_of_range(
                        "a range of indices inside over outside, from 1 or more up to \"inf\"; \
                         both sides are baked",
                    );
                }
                Reflectance::Dielectric(eta)
            }
            "dielectric" => Reflectance::dielectric(form.index()?),
            _ => {
                form.only_keys(&CONDUCTOR_KEYS)?;
                let (Some(eta), Some(k)) = (form.field("eta"), form.field("k")) else {
                    return form
                        .invalid("a conductor needs both eta = [r, g, b] and k = [r, g, b]");
                };
                Reflectance::Conductor {
                    eta: eta.rgb("[0.2, 0.9, 1.1]", Entry::index)?,
                    k: k.rgb("[3.9, 2.4, 2.2]", |k| {
                        let what = "an extinction coefficient, finite and 0 or more";
                        k.number_where(|k| (0.0..f64::INFINITY).contains(&k), what)
                    })?,
                }
            }
        })
    }

    fn reflectance(self) -> Result<f64, SceneError> {
        self.number_where(|f0| (0.0..=1.0).contains(&f0), "a reflectance from 0 to 1")
    }

    fn index(self) -> Result<f64, SceneError> {
        let what = "an index of refraction, finite and more than 0";
        self.number_where(|eta| eta > 0.0 && eta < f64::INFINITY, what)
    }

    fn metal(self) -> Result<Metal, SceneError> {
        let Some(name) = self.text() else {
            let text = self.written();
            return self.invalid(format!("metal = {text} is not a name in quotes; {UnknownMetal}"));
        };
        name.parse().or_else(|why: UnknownMetal| {
            let hint = did_you_mean(name, &Metal::ALL.map(Metal::name));
            self.invalid(format!("no metal is known as {}{hint}; {why}", quoted(name)))
        })
    }

    fn rgb(
        self,
        example: &str,
        channel: impl Fn(Self) -> Result<f64, SceneError>,
    ) -> Result<[f64; 3], SceneError> {
        let Some([r, g, b]) = self.list_of() else {
            let key = self.key;
            return self.expected(&format!(
                "three numbers, for red, green and blue, such as {key} = {example}"
            ));
        };
        Ok([channel(r)?, channel(g)?, channel(b)?])
    }

    pub(super) fn masking(self) -> Result<Masking, SceneError> {
        let name = self.text().unwrap_or_default();
        name.parse().or_else(|why: microfacet_core::UnknownMasking| {
            let hint = did_you_mean(name, &Masking::ALL.map(Masking::name));
            self.invalid(format!("{why}{hint}"))
        })
    }
}
