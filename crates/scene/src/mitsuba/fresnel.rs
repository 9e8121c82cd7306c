//! Fresnel terms and indices of refraction.

use microfacet_baker::scene::{Place, Reflectance, did_you_mean};
use microfacet_tables::Interval;

use super::Reader;
use super::value::{named, number, rgb};
use crate::Result;
use crate::builder::has_word;
use crate::fresnel::{conductor, dielectric, metal};
use crate::xml::Element;

/// Indices of refraction by name (`render/ior.h`; Hecht, Optics, 4th edition, at 589 nm).
const INDICES: [(&str, f64); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// Presets of Mitsuba for which no index is known here (`bsdfs/conductor.cpp`), without the ending
/// `_palik`.
const UNKNOWN: &str = "AlAs AlSb Be CsI Cu2O CuO Hg HgTe Ir K Li MgO Mo Na Nb Rh Se Se-e SiC SnTe \
                       Ta Te Te-e ThF4 TiC TiN TiO2 TiO2-e V VC VN a-C d-C";

impl<'a> Reader<'a> {
    /// The Fresnel term that was read; none, with a warning, if something impossible was found.
    pub(super) fn fresnel_or_warn(
        &mut self,
        read: Result<Option<Reflectance>>,
    ) -> Result<Option<Reflectance>> {
        self.ranges.abandon();
        self.builder.without_fresnel(read, None)
    }

    /// The dielectric of a principled BSDF, unless metal or tint is mixed in.
    pub(super) fn principled_fresnel(&mut self, bsdf: &'a Element) -> Result<Option<Reflectance>> {
        if self.weight(bsdf, "metallic")?.max > 0.0 || self.weight(bsdf, "spec_tint")?.max > 0.0 {
            return Ok(None);
        }
        if bsdf.child_named("eta").is_some() {
            let eta = self.property(bsdf, "eta", 1.5)?;
            return constant_dielectric(eta, bsdf);
        }
        let specular = self.property(bsdf, "specular", 0.5)?;
        let eta = specular.map_rising(|specular| 2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0);
        constant_dielectric(eta, bsdf)
    }

    /// The Fresnel term of the BSDFs of a single interface.
    pub(super) fn fresnel(
        &mut self,
        bsdf: &'a Element,
        class: &str,
    ) -> Result<Option<Reflectance>> {
        if class.ends_with("conductor") {
            return self.conductor(bsdf);
        }
        if class == "pplastic" && bsdf.child_named("eta").is_some() {
            let eta = self.property(bsdf, "eta", 1.0)?;
            return constant_dielectric(eta, bsdf);
        }
        let default = if class.ends_with("plastic") { "polypropylene" } else { "bk7" };
        let (inside, outside) = (index(bsdf, "int_ior", default)?, index(bsdf, "ext_ior", "air")?);
        // Each is checked, since two impossible indices may have a possible ratio.
        for index in [inside, outside] {
            dielectric(index, &bsdf.place)?;
        }
        dielectric(inside / outside, &bsdf.place).map(Some)
    }

    fn conductor(&self, bsdf: &Element) -> Result<Option<Reflectance>> {
        let material = bsdf.child_named("material");
        let name = match material {
            Some(material) => material.required("value")?,
            None if self.is_older => "Cu",
            None => "none",
        };
        let read = |property: &Element| match &property.tag[..] {
            "rgb" => rgb(property).map(Some),
            "float" => number(property).map(|all| Some([all; 3])),
            // One number holds for all wavelengths; more of them are not red, green and blue.
            "spectrum" => Ok(number(property).ok().map(|all| [all; 3])),
            _ => Ok(None),
        };
        match (bsdf.child_named("eta"), bsdf.child_named("k")) {
            (None, None) if name != "none" => preset(name, &material.unwrap_or(bsdf).place),
            // Only one of a preset's eta and k is replaced: the Fresnel term is left open.
            (None, _) | (_, None) if name != "none" => Ok(None),
            (eta, k) => {
                let eta = eta.map_or(Ok(Some([0.0; 3])), read)?;
                let k = k.map_or(Ok(Some([1.0; 3])), read)?;
                let of = |(eta, k): ([f64; 3], [f64; 3])| match eta {
                    // An index of 0 reflects everything, whatever the extinction is.
                    [0.0, 0.0, 0.0] => Ok(Reflectance::Mirror),
                    eta => conductor(eta, k, &bsdf.place),
                };
                eta.zip(k).map(of).transpose()
            }
        }
    }
}

/// The Fresnel term of a preset; none if its index is not known here.
fn preset(name: &str, place: &Place) -> Result<Option<Reflectance>> {
    let stem = name.strip_suffix("_palik").unwrap_or(name);
    let known = metal(stem).map(Reflectance::from);
    if known.is_none() && !has_word(UNKNOWN, stem) {
        return Err(place.invalid(format!(
            "the material \"{name}\" is no preset of Mitsuba; name another, or give eta and k"
        )));
    }
    Ok(known)
}

/// The Fresnel term of an index of refraction, or `None` if a texture varies it.
pub(super) fn constant_dielectric(eta: Interval, bsdf: &Element) -> Result<Option<Reflectance>> {
    eta.is_point().then(|| dielectric(eta.min, &bsdf.place)).transpose()
}

/// An index of refraction, given as a number or by name.
fn index(bsdf: &Element, name: &str, default: &str) -> Result<f64> {
    let (text, place) = match named(bsdf, name) {
        Some(property) if property.tag != "string" => return number(property),
        Some(property) => (property.required("value")?, &property.place),
        None => (default, &bsdf.place),
    };
    let known = INDICES.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
    known.map(|&(_, eta)| eta).ok_or_else(|| {
        let names = INDICES.map(|(name, _)| name);
        place.invalid(format!(
            "no index of refraction is known for \"{text}\"{}; the names are {}",
            did_you_mean(text, &names),
            names.join(", ")
        ))
    })
}
