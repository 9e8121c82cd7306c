//! The lobes of a material.

use microfacet_baker::scene::{Reflectance, Roughness, SceneError};
use microfacet_tables::Interval;

use super::Importer;
use super::parameters::{Clearcoat, Material, TextureInfo};
use crate::builder::{GGX, Lobe};
use crate::texture::Channel;

const COAT: &str = "KHR_materials_clearcoat";

impl Importer<'_> {
    /// Adds the lobes of a material; what is impossible in one of them costs that one alone.
    pub(super) fn material(
        &mut self,
        name: &str,
        material: &Material,
        used: bool,
    ) -> Result<(), SceneError> {
        let extensions = &material.extensions;
        let place = self.place.clone();
        if extensions.unlit.is_some() {
            return self.builder.ignore(name, "KHR_materials_unlit", &place, "unlit");
        }
        let kind = match extensions.specular_glossiness {
            None => "pbrMetallicRoughness",
            Some(_) => "KHR_materials_pbrSpecularGlossiness",
        };
        if material.reflects_nothing() {
            let reason = "a dielectric whose specularFactor is 0: its facets reflect nothing";
            self.builder.ignore(name, kind, &place, reason)?;
        } else {
            let read = self.base(name, material, used);
            self.builder.degrade(name, kind, &place, read)?;
        }
        if let Some(coat) = &extensions.clearcoat {
            let read = self.coat(name, coat, used);
            self.builder.degrade(&format!("{name}.clearcoat"), COAT, &place, read)?;
        }
        if extensions.sheen.is_some() {
            let name = format!("{name}.sheen");
            let reason = "a fabric's distribution (Charlie), not a Student-t one";
            self.builder.ignore(&name, "KHR_materials_sheen", &place, reason)?;
        }
        Ok(())
    }

    /// Adds the main lobe.
    fn base(&mut self, name: &str, material: &Material, used: bool) -> Result<(), SceneError> {
        let extensions = &material.extensions;
        let roughness = match &extensions.specular_glossiness {
            None => {
                let pbr = &material.pbr_metallic_roughness;
                let texture = pbr.metallic_roughness_texture.as_ref();
                self.factor("roughnessFactor", pbr.roughness_factor, texture, Channel::Green)?
            }
            Some(pbr) => {
                let texture = pbr.specular_glossiness_texture.as_ref();
                self.factor("glossinessFactor", pbr.glossiness_factor, texture, Channel::Alpha)?
                    .map_falling(|glossiness| 1.0 - glossiness)
            }
        };
        let alpha = roughness.map_rising(|r| r * r);
        let strength = match &extensions.anisotropy {
            None => Interval::point(0.0),
            Some(a) => {
                let texture = a.anisotropy_texture.as_ref();
                self.factor("anisotropyStrength", a.anisotropy_strength, texture, Channel::Blue)?
            }
        };
        let roughness = if strength.max == 0.0 {
            Roughness::isotropic(alpha)
        } else {
            let along = |alpha: f64, s: f64| alpha + (1.0 - alpha) * s * s;
            let along = Interval {
                min: along(alpha.min, strength.min),
                max: along(alpha.max, strength.max),
            };
            Roughness::anisotropic(along, alpha)
        };
        let fresnel = material.fresnel().map_err(|why| {
            // The place is the whole file.
            self.place.invalid(format!("material \"{name}\": {why}"))
        });
        let without = (None, "the lobe is read without its Fresnel term");
        let fresnel = self.builder.or_warn(fresnel, without)?;
        self.lobe(name, used, None, roughness, fresnel)
    }

    /// Adds the lobe of a clearcoat, unless its factor is 0.
    fn coat(&mut self, name: &str, coat: &Clearcoat, used: bool) -> Result<(), SceneError> {
        if self.factor("clearcoatFactor", coat.clearcoat_factor, None, Channel::Red)?.max == 0.0 {
            return Ok(());
        }
        let texture = coat.clearcoat_roughness_texture.as_ref();
        let factor = coat.clearcoat_roughness_factor;
        let roughness = self.factor("clearcoatRoughnessFactor", factor, texture, Channel::Green)?;
        let roughness = Roughness::isotropic(roughness.map_rising(|r| r * r));
        // The coat's index of refraction is fixed at 1.5 (KHR_materials_clearcoat).
        let fresnel = Some(Reflectance::Schlick([0.04; 3]));
        self.lobe(name, used, Some("clearcoat"), roughness, fresnel)
    }

    fn lobe(
        &mut self,
        material: &str,
        used: bool,
        name: Option<&'static str>,
        roughness: Roughness,
        fresnel: Option<Reflectance>,
    ) -> Result<(), SceneError> {
        let lobe = Lobe { name, roughness, gamma: GGX, fresnel, masking: None };
        self.builder.add(material, &self.place, used, lobe)
    }

    /// A factor in [0, 1], times a channel of a texture if there is one.
    fn factor(
        &mut self,
        key: &str,
        factor: f64,
        texture: Option<&TextureInfo>,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        let factor = unit(key, factor).map_err(|why| self.place.invalid(why))?;
        let range = match texture {
            Some(texture) => self.image(texture.index, channel),
            None => Interval::point(1.0),
        };
        Ok(range.map_rising(|x| x * factor))
    }
}

/// A factor, which must be in [0, 1].
pub(super) fn unit(key: &str, factor: f64) -> Result<f64, String> {
    if (0.0..=1.0).contains(&factor) {
        Ok(factor)
    } else {
        Err(format!("{key} is {factor}; it must be from 0 to 1"))
    }
}
