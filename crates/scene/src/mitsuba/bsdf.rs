//! The lobes of Mitsuba's BSDF plugins.

use microfacet_baker::scene::{Roughness, did_you_mean};
use microfacet_tables::Interval;

use super::Reader;
use super::fresnel::constant_dielectric;
use super::value::named;
use crate::Result;
use crate::builder::{BECKMANN, GGX, Lobe, Row};
use crate::xml::Element;

/// Lower limit of α, from `MicrofacetDistribution::configure`.
const LEAST_ALPHA: f64 = 1e-4;
/// Lower limit of α for the principled BSDFs, from `calc_dist_params`.
const LEAST_PRINCIPLED_ALPHA: f64 = 1e-3;

/// Properties of the BSDFs with lobes; the last two rows are those of Mitsuba 0.6.
const PROPERTIES: [Row; 12] = [
    (
        "roughconductor roughdielectric roughplastic pplastic roughcoating",
        "alpha alpha_u alpha_v distribution sample_visible",
    ),
    ("conductor roughconductor", "material eta k specular_reflectance"),
    ("dielectric thindielectric roughdielectric", "specular_transmittance"),
    (
        "dielectric thindielectric roughdielectric plastic roughplastic pplastic coating roughcoating",
        "int_ior ext_ior specular_reflectance",
    ),
    ("plastic roughplastic pplastic", "diffuse_reflectance"),
    ("plastic roughplastic", "nonlinear"),
    ("pplastic", "eta"),
    (
        "principled principledthin",
        "base_color roughness anisotropic spec_trans spec_tint sheen sheen_tint flatness eta \
         diffuse_reflectance_sampling_rate",
    ),
    (
        "principled",
        "metallic specular clearcoat clearcoat_gloss main_specular_sampling_rate \
         clearcoat_sampling_rate",
    ),
    (
        "principledthin",
        "diff_trans specular_reflectance_sampling_rate specular_transmittance_sampling_rate \
         diffuse_transmittance_sampling_rate",
    ),
    ("coating roughcoating", "thickness sigma_a"),
    (
        "conductor roughconductor dielectric thindielectric roughdielectric plastic roughplastic \
         coating roughcoating",
        "ensure_energy_conservation",
    ),
];

/// Kind of the clearcoat of a principled BSDF.
const CLEARCOAT: &str = "principled clearcoat";

impl<'a> Reader<'a> {
    /// Adds the lobes of one BSDF, without those of the BSDFs inside it.
    pub(super) fn bsdf(&mut self, bsdf: &'a Element, name: Option<&str>, used: bool) -> Result<()> {
        let class = bsdf.attribute("type").unwrap_or("no type");
        let unnamed = || format!("{class} at line {}", bsdf.place.line.unwrap_or_default());
        let name = name.map_or_else(unnamed, str::to_owned);
        self.check_properties(&PROPERTIES, bsdf);
        let read = self.lobes(bsdf, &name, used);
        self.ranges.abandon();
        let shown = coating(class).map(|lobe| format!("{name}.{lobe}"));
        self.builder.degrade(shown.as_ref().unwrap_or(&name), class, &bsdf.place, read)
    }

    fn lobes(&mut self, bsdf: &'a Element, name: &str, used: bool) -> Result<()> {
        let class = bsdf.required("type")?;
        let lobe = |reader: &mut Self, suffix, roughness, gamma, fresnel| {
            let lobe = Lobe::new(suffix, roughness, gamma, fresnel);
            reader.builder.add(name, &bsdf.place, used, lobe)
        };
        let reason = match class {
            "roughconductor" | "roughdielectric" | "roughplastic" | "pplastic" | "roughcoating" => {
                let gamma = distribution(bsdf)?;
                let roughness = self.alpha(bsdf)?;
                let fresnel = self.fresnel(bsdf, class);
                let fresnel = self.fresnel_or_warn(fresnel)?;
                return lobe(self, coating(class), roughness, gamma, fresnel);
            }
            "conductor" | "dielectric" | "thindielectric" | "plastic" | "coating" => {
                let fresnel = self.fresnel(bsdf, class);
                let fresnel = self.fresnel_or_warn(fresnel)?;
                return lobe(self, coating(class), Roughness::Smooth, GGX, fresnel);
            }
            "principled" => {
                let roughness = self.principled(bsdf, Interval::point(1.0))?;
                let fresnel = self.principled_fresnel(bsdf);
                let fresnel = self.fresnel_or_warn(fresnel)?;
                lobe(self, None, roughness, GGX, fresnel)?;
                let name = format!("{name}.clearcoat");
                let read = self.clearcoat(bsdf, &name);
                return self.builder.degrade(&name, CLEARCOAT, &bsdf.place, read);
            }
            "principledthin" if self.weight(bsdf, "spec_trans")?.max > 0.0 => {
                let eta = self.property(bsdf, "eta", 1.5)?;
                let reflection = self.principled(bsdf, Interval::point(1.0))?;
                let scale = eta.map_rising(|eta| (0.65 * eta - 0.35).max(0.0));
                let transmission = self.principled(bsdf, scale)?;
                let fresnel = self.fresnel_or_warn(constant_dielectric(eta, bsdf))?;
                // A tint mixes Schlick's reflectance into the reflection alone.
                let tint = self.weight(bsdf, "spec_tint");
                let untinted = tint.map(|tint| fresnel.filter(|_| tint.max == 0.0));
                let untinted = self.fresnel_or_warn(untinted)?;
                lobe(self, None, reflection, GGX, untinted)?;
                return lobe(self, Some("transmission"), transmission, GGX, fresnel);
            }
            // The BSDFs inside are listed by themselves.
            "twosided" | "mask" | "bumpmap" | "normalmap" | "blendbsdf" | "mixturebsdf" => {
                return Ok(());
            }
            "principledthin" | "diffuse" | "roughdiffuse" | "difftrans" => {
                "diffuse, without microfacets"
            }
            "hk" => "scatters in a layer, without microfacets",
            "hair" => "a fibre model, not a microfacet one",
            "irawan" => "a model of woven cloth, not a microfacet one",
            "measured" | "measured_polarized" => "measured data with a distribution of its own",
            "null" | "circular" | "polarizer" | "retarder" => "lets light pass without microfacets",
            class => {
                let why = match class {
                    "phong" | "ward" => "of Mitsuba 0.6; a lobe that is no Student-t, not read",
                    "sssbrdf" => "of Mitsuba 0.6; a coat that may be rough, not read",
                    _ => "not a BSDF that is known here",
                };
                return self.builder.not_understood(name, class, &bsdf.place, why);
            }
        };
        self.builder.ignore(name, class, &bsdf.place, reason)
    }

    /// Lists the clearcoat of a principled BSDF as ignored, unless its weight is 0.
    fn clearcoat(&mut self, bsdf: &'a Element, name: &str) -> Result<()> {
        if self.weight(bsdf, "clearcoat")?.max == 0.0 {
            return Ok(());
        }
        let reason = "GTR1, whose tails are heavier than any Student-t distribution's";
        self.builder.ignore(name, CLEARCOAT, &bsdf.place, reason)
    }

    fn alpha(&mut self, bsdf: &'a Element) -> Result<Roughness> {
        match ["alpha", "alpha_u", "alpha_v"].map(|name| named(bsdf, name)) {
            [_, None, None] => Ok(Roughness::isotropic(self.one_alpha(bsdf, "alpha")?)),
            // One texture for both gives equal values at each point.
            [None, Some(u), Some(v)] if self.is_same(u, v) => {
                Ok(Roughness::isotropic(self.one_alpha(bsdf, "alpha_u")?))
            }
            [None, Some(_), Some(_)] => Ok(Roughness::anisotropic(
                self.one_alpha(bsdf, "alpha_u")?,
                self.one_alpha(bsdf, "alpha_v")?,
            )),
            _ => Err(bsdf.place.invalid(
                "the roughness is either alpha, or both alpha_u and alpha_v; give one or the other",
            )),
        }
    }

    fn one_alpha(&mut self, bsdf: &'a Element, name: &str) -> Result<Interval> {
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

    /// The roughness of the principled BSDFs; `scale` multiplies `roughness`, and is 1 except for
    /// the thin BSDF's transmission.
    fn principled(&mut self, bsdf: &'a Element, scale: Interval) -> Result<Roughness> {
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

    /// A weight that is 0 by default.
    pub(super) fn weight(&mut self, bsdf: &'a Element, name: &str) -> Result<Interval> {
        self.property(bsdf, name, 0.0)
    }
}

/// The name of a coat's lobe, since the BSDF inside may have the same name as the coat.
fn coating(class: &str) -> Option<&'static str> {
    matches!(class, "coating" | "roughcoating").then_some("coating")
}

fn distribution(bsdf: &Element) -> Result<Interval> {
    let Some(property) = bsdf.child_named("distribution") else {
        return Ok(BECKMANN);
    };
    match &property.required("value")?.to_lowercase()[..] {
        "beckmann" => Ok(BECKMANN),
        "ggx" => Ok(GGX),
        "phong" | "as" => Err(property.place.invalid(format!(
            "the distribution \"{}\" is of Mitsuba 0.6; Mitsuba 3 has beckmann and ggx",
            property.required("value")?
        ))),
        name => Err(property.place.invalid(format!(
            "the distribution \"{name}\" is not one of beckmann and ggx{}",
            did_you_mean(name, &["beckmann", "ggx"])
        ))),
    }
}
