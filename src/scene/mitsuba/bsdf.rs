//! The lobes of Mitsuba's BSDF plugins.

use super::{Reader, find};
use crate::scene::builder::{BECKMANN, GGX, Lobe, conductor, dielectric, metal};
use crate::scene::error::did_you_mean;
use crate::scene::texture::{Channel, Encoding};
use crate::scene::xml::Element;
use crate::scene::{Fresnel, Interval, Masking, Roughness, SceneError};

/// Lower limit of α, from `MicrofacetDistribution::configure`.
const LEAST_ALPHA: f64 = 1e-4;
/// Lower limit of α for the principled BSDFs, from `calc_dist_params`.
const LEAST_PRINCIPLED_ALPHA: f64 = 1e-3;

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

impl<'a> Reader<'a> {
    /// Adds the lobes of one BSDF, without those of the BSDFs inside it.
    pub(super) fn bsdf(
        &mut self,
        bsdf: &'a Element,
        name: Option<&str>,
        used: bool,
    ) -> Result<(), SceneError> {
        let class = bsdf.required("type")?;
        let unnamed = || format!("{class} at line {}", bsdf.place.line.unwrap_or_default());
        let name = name.map_or_else(unnamed, str::to_owned);
        let lobe = |reader: &mut Self, suffix, roughness, gamma, fresnel| {
            let lobe = Lobe {
                name: suffix,
                roughness,
                gamma,
                fresnel,
                masking: Some(Masking::Uncorrelated),
            };
            reader.builder.add(&name, &bsdf.place, used, lobe)
        };
        let reason = match class {
            "roughconductor" | "roughdielectric" | "roughplastic" | "pplastic" => {
                let gamma = distribution(bsdf)?;
                let roughness = self.alpha(bsdf)?;
                let fresnel = fresnel(bsdf, class)?;
                return lobe(self, None, roughness, gamma, fresnel);
            }
            "conductor" | "dielectric" | "thindielectric" | "plastic" => {
                let fresnel = fresnel(bsdf, class)?;
                return lobe(self, None, Roughness::Smooth, GGX, fresnel);
            }
            "principled" => {
                let roughness = self.principled(bsdf, Interval::point(1.0))?;
                let fresnel = self.principled_fresnel(bsdf)?;
                lobe(self, None, roughness, GGX, fresnel)?;
                if self.weight(bsdf, "clearcoat")?.max > 0.0 {
                    let name = format!("{name}.clearcoat");
                    let reason = "GTR1, whose tails are heavier than any Student-t distribution's";
                    self.builder.ignore(&name, "principled clearcoat", &bsdf.place, reason)?;
                }
                return Ok(());
            }
            "principledthin" if self.weight(bsdf, "spec_trans")?.max > 0.0 => {
                let eta = self.property(bsdf, "eta", 1.5)?;
                let reflection = self.principled(bsdf, Interval::point(1.0))?;
                let scale = eta.map_rising(|eta| (0.65 * eta - 0.35).max(0.0));
                let transmission = self.principled(bsdf, scale)?;
                let fresnel = constant_dielectric(eta, bsdf)?;
                lobe(self, None, reflection, GGX, fresnel)?;
                return lobe(self, Some("transmission"), transmission, GGX, fresnel);
            }
            // The BSDFs inside are listed by themselves.
            "twosided" | "mask" | "bumpmap" | "normalmap" | "blendbsdf" => return Ok(()),
            "principledthin" | "diffuse" => "diffuse, without microfacets",
            "hair" => "a fibre model, not a microfacet one",
            "measured" | "measured_polarized" => "measured data with a distribution of its own",
            "null" | "circular" | "polarizer" | "retarder" => "lets light pass without microfacets",
            _ => "not a BSDF that is known here",
        };
        self.builder.ignore(&name, class, &bsdf.place, reason)
    }

    fn alpha(&mut self, bsdf: &'a Element) -> Result<Roughness, SceneError> {
        let [both, u, v] = ["alpha", "alpha_u", "alpha_v"].map(|name| bsdf.child_named(name));
        let roughness = match (both, u, v) {
            (_, None, None) => Roughness::isotropic(self.one_alpha(bsdf, "alpha")?),
            (None, Some(_), Some(_)) => {
                let (x, y) = (self.one_alpha(bsdf, "alpha_u")?, self.one_alpha(bsdf, "alpha_v")?);
                Roughness::anisotropic(x, y)
            }
            _ => {
                return Err(bsdf.place.invalid(
                    "the roughness is either alpha, or both alpha_u and alpha_v; give one or the other",
                ));
            }
        };
        Ok(roughness)
    }

    fn one_alpha(&mut self, bsdf: &'a Element, name: &str) -> Result<Interval, SceneError> {
        let alpha = self.property(bsdf, name, 0.1)?;
        if alpha.min < 0.0 {
            return Err(bsdf
                .place
                .invalid(format!("{name} is {}; it must be more than 0", alpha.min)));
        }
        if alpha == Interval::point(0.0) {
            let message = format!(
                "{name} is 0, which Mitsuba raises to {LEAST_ALPHA:e}; a smooth BSDF is meant"
            );
            self.builder.warn(&bsdf.place, message);
        }
        Ok(alpha.map_rising(|alpha| alpha.max(LEAST_ALPHA)))
    }

    /// The roughness of the principled BSDFs; `scale` is that of the thin BSDF's transmission.
    fn principled(&mut self, bsdf: &'a Element, scale: Interval) -> Result<Roughness, SceneError> {
        let unit = |value: Interval, name: &str| {
            if value.min >= 0.0 && value.max <= 1.0 {
                return Ok(value);
            }
            let worst = if value.min < 0.0 { value.min } else { value.max };
            Err(bsdf.place.invalid(format!("{name} is {worst}; it must be from 0 to 1")))
        };
        let roughness = unit(self.property(bsdf, "roughness", 0.5)?, "roughness")?
            .map_bilinear(scale, |r, s| r * s);
        let anisotropic = unit(self.weight(bsdf, "anisotropic")?, "anisotropic")?;
        let alpha = |r: f64, aspect: f64| (r * r * aspect).max(LEAST_PRINCIPLED_ALPHA);
        if anisotropic.max == 0.0 {
            return Ok(Roughness::Isotropic(roughness.map_rising(|r| alpha(r, 1.0))));
        }
        let aspect = anisotropic.map_falling(|a| (1.0 - 0.9 * a).sqrt());
        Ok(Roughness::anisotropic(
            Interval {
                min: alpha(roughness.min, 1.0 / aspect.max),
                max: alpha(roughness.max, 1.0 / aspect.min),
            },
            Interval {
                min: alpha(roughness.min, aspect.min),
                max: alpha(roughness.max, aspect.max),
            },
        ))
    }

    /// The dielectric of a principled BSDF, unless metal or tint is mixed in.
    fn principled_fresnel(&mut self, bsdf: &'a Element) -> Result<Option<Fresnel>, SceneError> {
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

    /// A weight that is 0 by default.
    fn weight(&mut self, bsdf: &'a Element, name: &str) -> Result<Interval, SceneError> {
        self.property(bsdf, name, 0.0)
    }

    fn property(
        &mut self,
        element: &'a Element,
        name: &str,
        default: f64,
    ) -> Result<Interval, SceneError> {
        match element.child_named(name) {
            Some(property) => self.value(property),
            None => Ok(Interval::point(default)),
        }
    }

    /// A number, or the range of a texture.
    fn value(&mut self, property: &'a Element) -> Result<Interval, SceneError> {
        match &property.tag[..] {
            "float" | "integer" | "spectrum" => number(property).map(Interval::point),
            "rgb" => match rgb(property) {
                Some(rgb) => Ok(Interval::point(luminance(rgb))),
                None => Err(property.place.invalid("an rgb value is three numbers")),
            },
            "ref" => match self.referred(property)? {
                // A reference has no id of its own, so the element found is no reference.
                Some(texture) => self.value(texture),
                None => {
                    let id = property.attribute("id").unwrap_or_default();
                    Ok(self.builder.unread(
                        id,
                        "is not in the files that were found",
                        &property.place,
                    ))
                }
            },
            "texture" => {
                let key = property.key();
                if let Some(known) = self.ranges.begin(key, &property.place)? {
                    return Ok(known);
                }
                let range = self.texture(property)?;
                self.ranges.end(key, range, &property.place)
            }
            tag => Err(property
                .place
                .invalid(format!("<{tag}> gives no number where one is expected"))),
        }
    }

    fn texture(&mut self, texture: &'a Element) -> Result<Interval, SceneError> {
        let place = &texture.place;
        match texture.required("type")? {
            "bitmap" => {
                let value = |name| texture.child_named(name).and_then(|p| p.attribute("value"));
                let Some(file) = value("filename") else {
                    return Ok(self.builder.unread("bitmap", "names no file", place));
                };
                let encoding =
                    if value("raw") == Some("true") { Encoding::Linear } else { Encoding::Srgb };
                let file = find(&self.folders, file);
                Ok(self.builder.image(&file, Channel::Luminance, encoding, place))
            }
            "checkerboard" => {
                let first = self.property(texture, "color0", 0.4)?;
                Ok(first.union(self.property(texture, "color1", 0.2)?))
            }
            "uniform" => self.property(texture, "value", 1.0),
            class => {
                let reason = "has a range that is not known";
                Ok(self.builder.unread(class, reason, place))
            }
        }
    }
}

/// The Fresnel term of the BSDFs of a single interface.
fn fresnel(bsdf: &Element, class: &str) -> Result<Option<Fresnel>, SceneError> {
    if class.ends_with("conductor") {
        let material = bsdf.child_named("material").and_then(|m| m.attribute("value"));
        if material == Some("none") {
            return Ok(Some(Fresnel::Mirror));
        }
        let rgb = |name| bsdf.child_named(name).filter(|p| p.tag == "rgb").and_then(rgb);
        return match (rgb("eta"), rgb("k")) {
            (Some(eta), Some(k)) => conductor(eta, k, &bsdf.place).map(Some),
            _ => Ok(material.and_then(metal)),
        };
    }
    let inside = if class.ends_with("plastic") { "polypropylene" } else { "bk7" };
    let eta = index(bsdf, "int_ior", inside)? / index(bsdf, "ext_ior", "air")?;
    dielectric(eta, &bsdf.place).map(Some)
}

/// The Fresnel term of an index of refraction, or `None` if a texture varies it.
fn constant_dielectric(eta: Interval, bsdf: &Element) -> Result<Option<Fresnel>, SceneError> {
    eta.is_point().then(|| dielectric(eta.min, &bsdf.place)).transpose()
}

fn distribution(bsdf: &Element) -> Result<Interval, SceneError> {
    let Some(property) = bsdf.child_named("distribution") else {
        return Ok(BECKMANN);
    };
    match &property.required("value")?.to_lowercase()[..] {
        "beckmann" => Ok(BECKMANN),
        "ggx" => Ok(GGX),
        name => Err(property.place.invalid(format!(
            "the distribution \"{name}\" is not one of beckmann and ggx{}",
            did_you_mean(name, &["beckmann", "ggx"])
        ))),
    }
}

/// The number in the attribute "value".
fn number(property: &Element) -> Result<f64, SceneError> {
    let text = property.required("value")?;
    match text.trim().parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => {
            let remedy = match text.strip_prefix('$') {
                Some(name) => {
                    format!("; give it a value with <default name=\"{name}\" value=\"..\"/>")
                }
                None => String::new(),
            };
            let name = property.attribute("name").unwrap_or("value");
            Err(property.place.invalid(format!("{name} must be a number, not \"{text}\"{remedy}")))
        }
    }
}

fn rgb(property: &Element) -> Option<[f64; 3]> {
    let text = property.attribute("value")?;
    let numbers: Option<Vec<f64>> = text
        .split([',', ' '])
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().ok())
        .collect();
    match numbers?[..] {
        [grey] => Some([grey; 3]),
        [r, g, b] => Some([r, g, b]),
        _ => None,
    }
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// An index of refraction, given as a number or by name.
fn index(bsdf: &Element, name: &str, default: &str) -> Result<f64, SceneError> {
    let (text, place) = match bsdf.child_named(name) {
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
