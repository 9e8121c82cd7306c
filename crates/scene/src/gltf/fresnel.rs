//! The reflectance of a material at normal incidence.

use std::array::from_fn;

use microfacet_baker::scene::Reflectance;

use super::material::unit;
use super::parameters::{Material, Specular};

impl Material {
    /// Whether it is a dielectric without reflection, by a `specularFactor` of 0
    /// (`KHR_materials_specular`), and without transmission, which passes through the same facets.
    pub(super) fn reflects_nothing(&self) -> bool {
        let extensions = &self.extensions;
        let none = extensions.specular.as_ref().is_some_and(|s| s.specular_factor == 0.0);
        none && self.pbr_metallic_roughness.metallic_factor == 0.0
            && extensions.specular_glossiness.is_none()
            && extensions.transmission.is_none()
    }

    /// Schlick's reflectance with F90 = 1 where that is what the material has, with the same F0
    /// everywhere; the error says what is impossible.
    pub(super) fn fresnel(&self) -> Result<Option<Reflectance>, String> {
        let extensions = &self.extensions;
        // With a factor of 0, the default, there is no film, whatever its texture.
        if let Some(film) = &extensions.iridescence
            && unit("iridescenceFactor", film.iridescence_factor)? > 0.0
        {
            return Ok(None);
        }
        if let Some(pbr) = &extensions.specular_glossiness {
            let f0 = colour("specularFactor", pbr.specular_factor)?;
            let constant = pbr.specular_glossiness_texture.is_none();
            return Ok(constant.then_some(Reflectance::Schlick(f0)));
        }
        let pbr = &self.pbr_metallic_roughness;
        let metallic = unit("metallicFactor", pbr.metallic_factor)?;
        let base = match pbr.base_color_factor {
            // A dielectric's F0 does not depend on it.
            _ if metallic == 0.0 => [0.0; 3],
            [r, g, b, _] => colour("baseColorFactor", [r, g, b])?,
        };
        let textures = [&pbr.base_color_texture, &pbr.metallic_roughness_texture];
        if metallic > 0.0 && textures.into_iter().any(Option::is_some) {
            return Ok(None);
        }
        if metallic == 1.0 {
            return Ok(Some(Reflectance::Schlick(base)));
        }
        let ior = extensions.ior.as_ref().map_or(1.5, |extension| extension.ior);
        if !(ior >= 1.0 || ior == 0.0) {
            return Err(format!("ior is {ior}; it must be 0, or at least 1"));
        }
        // An index of 0 asks for total reflection (KHR_materials_ior); the formula gives 1 there.
        let amplitude = (ior - 1.0) / (ior + 1.0);
        let none = Specular::default();
        let specular = extensions.specular.as_ref().unwrap_or(&none);
        // F90 is the factor: at 1 alone the form is Schlick's with F90 = 1.
        let textures = [&specular.specular_texture, &specular.specular_color_texture];
        if unit("specularFactor", specular.specular_factor)? != 1.0
            || textures.into_iter().any(Option::is_some)
        {
            return Ok(None);
        }
        let tint = specular.specular_color_factor;
        if let Some(negative) = tint.iter().find(|&&tint| tint < 0.0) {
            return Err(format!("specularColorFactor has {negative}; it must be 0 or more"));
        }
        let dielectric = tint.map(|tint| (amplitude * amplitude * tint).min(1.0));
        let f0 = from_fn(|i| dielectric[i] * (1.0 - metallic) + base[i] * metallic);
        Ok(Some(Reflectance::Schlick(f0)))
    }
}

/// A colour whose channels must be in [0, 1].
fn colour(key: &str, [r, g, b]: [f64; 3]) -> Result<[f64; 3], String> {
    Ok([unit(key, r)?, unit(key, g)?, unit(key, b)?])
}
