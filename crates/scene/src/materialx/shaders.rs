//! The lobes of the shading models of the MaterialX libraries.

use microfacet_baker::scene::{Reflectance, Roughness, SceneError};
use microfacet_tables::Interval;

use super::Reader;
use super::index::At;
use super::inputs::Metal;
use crate::Result;
use crate::builder::Lobe;

/// The lower limit of α: `M_FLOAT_EPS` of the shaders (`stdlib/genglsl/lib/mx_math.glsl`).
pub(super) const LEAST_ALPHA: f64 = 1e-8;
/// The lower limit of α in `gltf_pbr`.
const LEAST_GLTF_ALPHA: f64 = 1e-5;

#[derive(Default)]
pub(super) struct Model {
    pub(super) lobes: Vec<Lobe>,
    /// The names of lobes with an impossible value, and the errors.
    pub(super) failed: Vec<(Option<&'static str>, SceneError)>,
    /// The input that adds a fabric's lobe, if its weight is above 0.
    pub(super) fabric: Option<&'static str>,
}

impl Model {
    /// Adds a lobe; an impossible roughness leaves out this lobe alone.
    pub(super) fn push(
        &mut self,
        name: Option<&'static str>,
        roughness: Result<Roughness>,
        fresnel: Option<Reflectance>,
    ) {
        self.push_lobe(name, roughness.map(|roughness| Lobe::ggx(name, roughness, fresnel)));
    }

    /// Adds a lobe that was read; what is impossible in it leaves out this lobe alone.
    pub(super) fn push_lobe(&mut self, name: Option<&'static str>, lobe: Result<Lobe>) {
        match lobe {
            Ok(lobe) => self.lobes.push(lobe),
            Err(error) => self.failed.push((name, error)),
        }
    }

    /// Whether the lobe's weight is above 0; an impossible weight leaves out this lobe alone.
    fn has(&mut self, name: &'static str, weight: Result<Interval>) -> bool {
        match weight {
            Ok(weight) => weight.max > 0.0,
            Err(error) => {
                self.failed.push((Some(name), error));
                false
            }
        }
    }
}

impl<'a> Reader<'a> {
    /// The lobes of a shading model of the libraries; `None` for other nodes.
    pub(super) fn model(&mut self, at: At<'a>) -> Result<Option<Model>> {
        let (mut model, fabric) = match &at.node.tag[..] {
            "standard_surface" => (self.standard_surface(at)?, "sheen"),
            "open_pbr_surface" => (self.open_pbr_surface(at)?, "fuzz_weight"),
            "gltf_pbr" => (self.gltf_pbr(at)?, "sheen_color"),
            "disney_principled" => (self.disney_principled(at)?, "sheen"),
            "UsdPreviewSurface" => return self.usd_preview_surface(at).map(Some),
            _ => return Ok(None),
        };
        match self.greatest(at, fabric, 0.0) {
            Ok(weight) => model.fabric = (weight > 0.0).then_some(fabric),
            Err(error) => model.failed.push((Some(fabric), error)),
        }
        Ok(Some(model))
    }

    /// The roughness and the anisotropy of a lobe.
    pub(super) fn pair(
        &mut self,
        at: At<'a>,
        (roughness, default): (&'static str, f64),
        anisotropy: &'static str,
    ) -> Result<(Interval, Interval)> {
        Ok((self.unit(at, roughness, default)?, self.unit(at, anisotropy, 0.0)?))
    }

    fn standard_surface(&mut self, at: At<'a>) -> Result<Model> {
        let base = self.pair(at, ("specular_roughness", 0.2), "specular_anisotropy");
        let (metalness, metal) = self.metal(at, "metalness", 0.0)?;
        let transmission = self.unit(at, "transmission", 0.0)?;
        let extra = self.input(at, "transmission_extra_roughness", 0.0)?;
        let coat = self.unit(at, "coat", 0.0)?;
        let affect = self.unit(at, "coat_affect_roughness", 0.0)?;
        let mut roughening = coat.map_bilinear(affect, |a, b| a * b);
        if roughening.max > 0.0 {
            let coat_roughness = self.unit(at, "coat_roughness", 0.1)?;
            roughening = roughening.map_bilinear(coat_roughness, |a, b| a * b);
        }
        let under_coat = |r: Interval| r.map_bilinear(roughening, |r, t| r + (1.0 - r) * t);
        let film = self.film(at, "thin_film_thickness")?;

        let mut model = Model::default();
        if metalness.max + transmission.max + self.unit(at, "specular", 1.0)?.max > 0.0 {
            let fresnel = match metal {
                _ if film => None,
                Metal::None => self.dielectric(at, "specular_IOR", 1.5)?,
                Metal::All => {
                    let reflectivity = self.product(at, "base_color", 0.8, "base", 1.0)?;
                    let edge = self.product(at, "specular_color", 1.0, "specular", 1.0)?;
                    self.artistic(at, reflectivity, edge)?
                }
                Metal::Some => None,
            };
            let has_extra = transmission.max > 0.0 && extra != Interval::point(0.0);
            let transmitted = base.as_ref().ok().filter(|_| has_extra).map(|&(r, anisotropy)| {
                let r = Interval { min: r.min + extra.min, max: r.max + extra.max };
                stretched(under_coat(r.clamp(0.0, 1.0)), anisotropy)
            });
            model.push(None, base.map(|(r, a)| stretched(under_coat(r), a)), fresnel);
            if let Some(roughness) = transmitted {
                model.push(Some("transmission"), Ok(roughness), fresnel);
            }
        }
        if coat.max > 0.0 {
            let fresnel = self.dielectric(at, "coat_IOR", 1.5)?;
            let coat = self.pair(at, ("coat_roughness", 0.1), "coat_anisotropy");
            model.push(Some("coat"), coat.map(|(r, a)| stretched(r, a)), fresnel);
        }
        Ok(model)
    }

    fn gltf_pbr(&mut self, at: At<'a>) -> Result<Model> {
        let base = self.pair(at, ("roughness", 1.0), "anisotropy_strength");
        let (metallic, metal) = self.metal(at, "metallic", 1.0)?;
        let transmission = self.unit(at, "transmission", 0.0)?;
        let specular = self.unit(at, "specular", 1.0)?;
        let film = self.film(at, "iridescence")?;

        let mut model = Model::default();
        if metallic.max + transmission.max + specular.max > 0.0 {
            let roughness = base.map(|(roughness, strength)| {
                let alpha = roughness.map_rising(|r| r * r);
                if strength.max == 0.0 {
                    return Roughness::isotropic(alpha);
                }
                let along = |alpha: f64, strength: f64| alpha + (1.0 - alpha) * strength * strength;
                let along = Interval {
                    min: along(alpha.min, strength.min),
                    max: along(alpha.max, strength.max),
                };
                let limited = |alpha: Interval| alpha.clamp(LEAST_GLTF_ALPHA, 1.0);
                Roughness::anisotropic(limited(along), limited(alpha))
            });
            let fresnel = match metal {
                _ if film => None,
                Metal::All => self.colour(at, "base_color", [1.0; 3])?.and_then(schlick),
                Metal::None if specular == Interval::point(1.0) => {
                    let tint = self.colour(at, "specular_color", [1.0; 3])?;
                    let f0 = self.normal_reflectance(at)?;
                    let f0 = tint.zip(f0).map(|(tint, f0)| tint.map(|tint| (tint * f0).min(1.0)));
                    f0.and_then(schlick)
                }
                Metal::None | Metal::Some => None,
            };
            model.push(None, roughness, fresnel);
        }
        if model.has("clearcoat", self.unit(at, "clearcoat", 0.0)) {
            let roughness = self.unit(at, "clearcoat_roughness", 0.0).map(squared);
            model.push(Some("clearcoat"), roughness, Some(Reflectance::dielectric(1.5)));
        }
        Ok(model)
    }

    fn usd_preview_surface(&mut self, at: At<'a>) -> Result<Model> {
        let roughness = self.unit(at, "roughness", 0.5).map(squared);
        let (_, metal) = self.metal(at, "metallic", 0.0)?;
        let fresnel = if self.greatest(at, "useSpecularWorkflow", 0.0)? > 0.0 {
            self.colour(at, "specularColor", [0.0; 3])?.and_then(schlick)
        } else {
            match metal {
                Metal::None => self.normal_reflectance(at)?.and_then(|f0| schlick([f0; 3])),
                Metal::All => {
                    let colour = self.colour(at, "diffuseColor", [0.18; 3])?;
                    self.artistic(at, colour, colour)?
                }
                Metal::Some => None,
            }
        };
        let mut model = Model::default();
        model.push(None, roughness, fresnel);
        if model.has("clearcoat", self.unit(at, "clearcoat", 0.0)) {
            let roughness = self.unit(at, "clearcoatRoughness", 0.01).map(squared);
            let fresnel = self.normal_reflectance(at)?.and_then(|f0| schlick([f0; 3]));
            model.push(Some("clearcoat"), roughness, fresnel);
        }
        Ok(model)
    }

    fn disney_principled(&mut self, at: At<'a>) -> Result<Model> {
        let base = self.pair(at, ("roughness", 0.5), "anisotropic");
        let (metallic, metal) = self.metal(at, "metallic", 0.0)?;
        let specular = self.unit(at, "specular", 0.5)?;

        let mut model = Model::default();
        if metallic.max + specular.max > 0.0 {
            let fresnel = match metal {
                Metal::All => self.colour(at, "baseColor", [0.16; 3])?.and_then(schlick),
                // The dielectric's reflectance is constant, times 0.08 `specular`: no Fresnel term.
                Metal::None | Metal::Some => None,
            };
            model.push(None, base.map(|(r, anisotropy)| stretched(r, anisotropy)), fresnel);
        }
        if model.has("clearcoat", self.unit(at, "clearcoat", 0.0)) {
            let gloss = self.unit(at, "clearcoatGloss", 1.0);
            let roughness = gloss.map(|gloss| squared(gloss.map_falling(|gloss| 1.0 - gloss)));
            model.push(Some("clearcoat"), roughness, None);
        }
        Ok(model)
    }
}

/// Schlick's approximation; `None` unless every reflectance is in [0, 1].
pub(super) fn schlick(f0: [f64; 3]) -> Option<Reflectance> {
    f0.iter().all(|f0| (0.0..=1.0).contains(f0)).then_some(Reflectance::Schlick(f0))
}

/// α of `roughness_anisotropy`: r² / A and r² A, with A = √(1 − min(a, 0.98)).
pub(super) fn stretched(roughness: Interval, anisotropy: Interval) -> Roughness {
    let aspect = anisotropy.map_falling(|a| (1.0 - a.min(0.98)).sqrt());
    axes(roughness, anisotropy, [1.0 / aspect.max, 1.0 / aspect.min], [aspect.min, aspect.max])
}

/// α = r² along both axes.
fn squared(roughness: Interval) -> Roughness {
    stretched(roughness, Interval::point(0.0))
}

/// The roughness along both axes: r² times a factor from `x` and from `y`, least and greatest.
pub(super) fn axes(r: Interval, anisotropy: Interval, x: [f64; 2], y: [f64; 2]) -> Roughness {
    if anisotropy.max == 0.0 {
        return Roughness::isotropic(r.map_rising(|r| r * r));
    }
    if r.max == 0.0 {
        return Roughness::Smooth;
    }
    let alpha = |factor: [f64; 2]| {
        Interval { min: r.min * r.min * factor[0], max: r.max * r.max * factor[1] }
            .clamp(LEAST_ALPHA, 1.0)
    };
    Roughness::anisotropic(alpha(x), alpha(y))
}
