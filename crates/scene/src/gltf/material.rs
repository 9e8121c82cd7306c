//! The lobes of a material.

use std::array::from_fn;

use microfacet_baker::scene::{Reflectance, Roughness, SceneError};
use microfacet_tables::{Interval, MaterialEntry};

use super::Importer;
use super::object::Object;
use crate::Result;
use crate::builder::Lobe;
use crate::texture::Channel;

const ANISOTROPY: &str = "KHR_materials_anisotropy";
const CLEARCOAT: &str = "KHR_materials_clearcoat";
const GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
const METALLIC: &str = "pbrMetallicRoughness";
const RETROREFLECTION: &str = "KHR_materials_retroreflection";
const SPECULAR: &str = "KHR_materials_specular";

impl<'a> Importer<'a> {
    /// Adds the lobes of a material; an impossible value in one lobe leaves out that lobe alone.
    pub(super) fn lobes(&mut self, name: &str, material: &Object<'a>, used: bool) -> Result<()> {
        let place = self.place;
        let extensions = material.object_or_empty("extensions")?;
        let has = |extension: &str| extensions.members.contains_key(extension);
        if has("KHR_materials_unlit") {
            return self.builder.ignore(name, "KHR_materials_unlit", place, "unlit");
        }
        let kind = if has(GLOSSINESS) { GLOSSINESS } else { METALLIC };
        match reflects_nothing(material, &extensions) {
            Ok(true) => {
                let reason = "a dielectric whose specularFactor is 0: its facets reflect nothing";
                self.builder.ignore(name, kind, place, reason)?;
            }
            // `base` reports what cannot be read.
            Ok(false) | Err(_) => {
                let read = self.base(name, material, &extensions, used);
                self.builder.degrade(name, kind, place, read)?;
            }
        }
        if has(CLEARCOAT) {
            let read = self.coat(name, &extensions, used);
            self.builder.degrade(&format!("{name}.clearcoat"), CLEARCOAT, place, read)?;
        }
        if has("KHR_materials_sheen") {
            let name = format!("{name}.sheen");
            let reason = "a fabric's distribution (Charlie), not a Student-t one";
            self.builder.ignore(&name, "KHR_materials_sheen", place, reason)?;
        }
        Ok(())
    }

    fn base(
        &mut self,
        name: &str,
        material: &Object<'a>,
        extensions: &Object<'a>,
        used: bool,
    ) -> Result<()> {
        let roughness = match extensions.object(GLOSSINESS)? {
            None => {
                let pbr = material.object_or_empty(METALLIC)?;
                let texture = ("metallicRoughnessTexture", Channel::Green);
                self.factor(&pbr, ("roughnessFactor", 1.0), texture)?
            }
            Some(pbr) => {
                let texture = ("specularGlossinessTexture", Channel::Alpha);
                let glossiness = self.factor(&pbr, ("glossinessFactor", 1.0), texture)?;
                glossiness.map_falling(|glossiness| 1.0 - glossiness)
            }
        };
        let alpha = roughness.map_rising(|r| r * r);
        let anisotropy = extensions.object_or_empty(ANISOTROPY)?;
        let texture = ("anisotropyTexture", Channel::Blue);
        let strength = self.factor(&anisotropy, ("anisotropyStrength", 0.0), texture)?;
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
        let fresnel = fresnel(material, extensions).map_err(|why| self.of_material(name, why));
        let fresnel = self.builder.without_fresnel(fresnel, None)?;
        let retroreflection = self.retroreflection(name, extensions)?;
        let lobe = Lobe { retroreflection, ..Lobe::ggx(None, roughness, fresnel) };
        self.builder.add(name, self.place, used, lobe)
    }

    /// The share of what the base reflects that goes back; none with a warning if it is impossible.
    fn retroreflection(&mut self, name: &str, extensions: &Object<'a>) -> Result<Interval> {
        const NONE: Interval = MaterialEntry::SPECULAR;
        let excluded = extensions.members.contains_key(GLOSSINESS);
        let read = extensions.object(RETROREFLECTION).and_then(|extension| match extension {
            None => Ok(NONE),
            Some(_) if excluded => {
                let why = format!("{RETROREFLECTION} must not be used with {GLOSSINESS}");
                Err(extensions.invalid(why))
            }
            Some(extension) => {
                let texture = ("retroreflectionTexture", Channel::Red);
                self.factor(&extension, ("retroreflectionFactor", 0.0), texture)
            }
        });
        let read = read.map_err(|why| self.of_material(name, why));
        self.builder.or_warn(read, (NONE, "the lobe is read without it"))
    }

    /// An error with the name of the material, since its place is the whole file.
    fn of_material(&self, name: &str, why: SceneError) -> SceneError {
        self.place.invalid(format!("material \"{name}\": {}", why.kind))
    }

    /// Adds the lobe of a clearcoat, unless its factor is 0.
    fn coat(&mut self, name: &str, extensions: &Object<'a>, used: bool) -> Result<()> {
        let coat = extensions.object_or_empty(CLEARCOAT)?;
        if coat.unit("clearcoatFactor", 0.0)? == 0.0 {
            return Ok(());
        }
        let texture = ("clearcoatRoughnessTexture", Channel::Green);
        let roughness = self.factor(&coat, ("clearcoatRoughnessFactor", 0.0), texture)?;
        let roughness = Roughness::isotropic(roughness.map_rising(|r| r * r));
        // The coat's index of refraction is fixed at 1.5 (KHR_materials_clearcoat).
        let fresnel = Some(Reflectance::Schlick([0.04; 3]));
        self.builder.add(name, self.place, used, Lobe::ggx(Some("clearcoat"), roughness, fresnel))
    }

    /// A factor in [0, 1], times a channel of a texture if there is one.
    fn factor(
        &mut self,
        object: &Object<'a>,
        (name, default): (&str, f64),
        (texture, channel): (&str, Channel),
    ) -> Result<Interval> {
        let factor = object.unit(name, default)?;
        let range = match object.object(texture)? {
            Some(texture) => self.image(texture.required_index("index")?, channel),
            None => Interval::point(1.0),
        };
        Ok(range.map_rising(|x| x * factor))
    }
}

/// Whether the material is a dielectric without reflection, by a `specularFactor` of 0
/// (`KHR_materials_specular`), and without transmission, which passes through the same facets.
fn reflects_nothing(material: &Object<'_>, extensions: &Object<'_>) -> Result<bool> {
    let others = [GLOSSINESS, "KHR_materials_transmission"];
    Ok(extensions.object_or_empty(SPECULAR)?.number("specularFactor", 1.0)? == 0.0
        && material.object_or_empty(METALLIC)?.number("metallicFactor", 1.0)? == 0.0
        && !others.iter().any(|&other| extensions.members.contains_key(other)))
}

/// Schlick's reflectance with F90 = 1; `None` if the Fresnel term is another or F0 varies.
fn fresnel(material: &Object<'_>, extensions: &Object<'_>) -> Result<Option<Reflectance>> {
    let has_texture = |object: &Object<'_>, names: [&str; 2]| {
        names.iter().any(|&name| object.members.contains_key(name))
    };
    // With a factor of 0, the default, there is no film, whatever its texture.
    let film = extensions.object_or_empty("KHR_materials_iridescence")?;
    if film.unit("iridescenceFactor", 0.0)? > 0.0 {
        return Ok(None);
    }
    if let Some(pbr) = extensions.object(GLOSSINESS)? {
        let f0 = pbr.colour("specularFactor", pbr.numbers("specularFactor", [1.0; 3])?)?;
        let varies = pbr.members.contains_key("specularGlossinessTexture");
        return Ok((!varies).then_some(Reflectance::Schlick(f0)));
    }
    let pbr = material.object_or_empty(METALLIC)?;
    let metallic = pbr.unit("metallicFactor", 1.0)?;
    let base = match pbr.numbers("baseColorFactor", [1.0; 4])? {
        // A dielectric's F0 does not depend on the base colour.
        _ if metallic == 0.0 => [0.0; 3],
        [r, g, b, _] => pbr.colour("baseColorFactor", [r, g, b])?,
    };
    if metallic > 0.0 && has_texture(&pbr, ["baseColorTexture", "metallicRoughnessTexture"]) {
        return Ok(None);
    }
    if metallic == 1.0 {
        return Ok(Some(Reflectance::Schlick(base)));
    }
    let ior = extensions.object_or_empty("KHR_materials_ior")?;
    let index = ior.number("ior", 1.5)?;
    if !(index >= 1.0 || index == 0.0) {
        return Err(ior.invalid(format!("ior is {index}; it must be 0, or at least 1")));
    }
    // An index of 0 asks for total reflection (KHR_materials_ior); the formula gives 1 there.
    let amplitude = (index - 1.0) / (index + 1.0);
    let specular = extensions.object_or_empty(SPECULAR)?;
    // `specularFactor` is F90.
    if specular.unit("specularFactor", 1.0)? != 1.0
        || has_texture(&specular, ["specularTexture", "specularColorTexture"])
    {
        return Ok(None);
    }
    let tint = specular.numbers("specularColorFactor", [1.0; 3])?;
    if let Some(negative) = tint.iter().find(|&&tint| tint < 0.0) {
        let why = format!("specularColorFactor has {negative}; it must be 0 or more");
        return Err(specular.invalid(why));
    }
    let dielectric = tint.map(|tint| (amplitude * amplitude * tint).min(1.0));
    let f0 = from_fn(|i| dielectric[i] * (1.0 - metallic) + base[i] * metallic);
    Ok(Some(Reflectance::Schlick(f0)))
}
