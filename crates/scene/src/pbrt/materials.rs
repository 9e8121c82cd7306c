//! The lobes of pbrt's materials.

use microfacet_baker::scene::Roughness;
use microfacet_tables::Interval;

use super::definition::{Definition, OLDER, Parameter};
use super::fresnel::fresnel;
use super::{Reader, UPGRADE};
use crate::Result;
use crate::builder::{Lobe, has_word};

/// If no α reaches this, pbrt treats the surface as smooth
/// (`TrowbridgeReitzDistribution::EffectivelySmooth`).
const SMOOTH: f64 = 1e-3;
/// Lower limit of α along one axis of a surface that is rough along the other (constructor of
/// `TrowbridgeReitzDistribution`).
const LEAST: f64 = 1e-4;

impl Reader {
    pub(super) fn lobes(&mut self, material: &Definition, used: bool) -> Result<()> {
        let (name, place) = (&material.name, &material.place);
        let class = &material.class;
        let mut ignore = |reason| self.builder.ignore(name, class, place, reason);
        let interfaces: &[(Option<&'static str>, &str)] = match &class[..] {
            "conductor" | "dielectric" | "coateddiffuse" | "subsurface" | "thindielectric" => {
                &[(None, "")]
            }
            "coatedconductor" => {
                &[(Some("interface"), "interface."), (Some("conductor"), "conductor.")]
            }
            "mix" => return ignore("a mixture; its parts are listed by themselves"),
            "diffuse" | "diffusetransmission" => return ignore("diffuse, without microfacets"),
            "hair" => return ignore("a fibre model, not a microfacet one"),
            "measured" => return ignore("measured data with a distribution of its own"),
            "" if material.parameter("type").is_none() => {
                let why = "it has no type; add for example \"string type\" \"conductor\"";
                return self.builder.not_understood(name, "no type", place, why);
            }
            "" | "interface" | "none" => {
                return ignore("the boundary of a medium, without a surface");
            }
            class if has_word(OLDER, class) => {
                let why = format!("a material of pbrt-v3; {UPGRADE}");
                return self.builder.not_understood(name, class, place, &why);
            }
            class => {
                let why = "not a material of pbrt-v4";
                return self.builder.not_understood(name, class, place, why);
            }
        };
        for &(lobe, prefix) in interfaces {
            let read = self.lobe(material, used, lobe, prefix);
            self.ranges.abandon();
            let name = lobe.map_or_else(|| name.clone(), |lobe| format!("{name}.{lobe}"));
            self.builder.degrade(&name, class, place, read)?;
        }
        Ok(())
    }

    /// Adds the lobe of one interface, whose parameters' names begin with `prefix`.
    fn lobe(
        &mut self,
        material: &Definition,
        used: bool,
        name: Option<&'static str>,
        prefix: &str,
    ) -> Result<()> {
        let roughness = self.roughness(material, prefix)?;
        let fresnel = self.builder.without_fresnel(fresnel(material, prefix), None)?;
        let lobe = Lobe::ggx(name, roughness, fresnel);
        self.builder.add(&material.name, &material.place, used, lobe)
    }

    fn roughness(&mut self, material: &Definition, prefix: &str) -> Result<Roughness> {
        if material.class == "thindielectric" {
            return Ok(Roughness::Smooth);
        }
        let remap = material.truth("remaproughness", true)?;
        let both = format!("{prefix}roughness");
        let axis = |axis| {
            let own = material.parameter(&format!("{prefix}{axis}roughness"));
            own.or_else(|| material.parameter(&both))
        };
        let (u, v) = (axis("u"), axis("v"));
        let alpha = |reader: &mut Self, parameter| reader.alpha(material, parameter, remap);

        let x = alpha(self, u)?;
        // Equal parameters give equal values at each point, even from a texture.
        let same = |u: &Parameter, v: &Parameter| u.kind == v.kind && u.values == v.values;
        if u.zip(v).map_or(u.is_none() == v.is_none(), |(u, v)| same(u, v)) {
            return Ok(if x.max < SMOOTH { Roughness::Smooth } else { Roughness::Isotropic(x) });
        }
        let y = alpha(self, v)?;
        if x.max.max(y.max) < SMOOTH {
            return Ok(Roughness::Smooth);
        }
        let at_least = |alpha: Interval| alpha.map_rising(|alpha| alpha.max(LEAST));
        Ok(Roughness::anisotropic(at_least(x), at_least(y)))
    }

    fn alpha(
        &mut self,
        material: &Definition,
        parameter: Option<&Parameter>,
        remap: bool,
    ) -> Result<Interval> {
        let Some(parameter) = parameter else {
            return Ok(Interval::point(0.0));
        };
        let roughness = self.value(parameter)?;
        if roughness.min < 0.0 {
            return Err(parameter.place.invalid(format!(
                "the {} of material \"{}\" is {}; it must be 0 or more, commonly up to 1",
                parameter.name, material.name, roughness.min
            )));
        }
        if roughness.max > 1.0 {
            self.builder.warn(
                &parameter.place,
                format!(
                    "the {} of material \"{}\" is {}, above the usual range [0, 1]; it is used as written",
                    parameter.name, material.name, roughness.max
                ),
            );
        }
        if remap && roughness.max > 0.0 && material.class == "subsurface" && self.of_v3 {
            let warning = format!(
                "the roughness of \"subsurface\" is mapped as by pbrt-v4, but the scene has materials \
                 of pbrt-v3, which maps it otherwise; {UPGRADE}"
            );
            self.builder.warn(&material.place, warning);
        }
        Ok(if remap { roughness.map_rising(f64::sqrt) } else { roughness })
    }
}
