//! The lobes of a surface: of one shading model, or of the BSDF nodes of a graph (`pbrlib`).

use microfacet_baker::scene::{Reflectance, Roughness, SceneError};
use microfacet_tables::{Interval, MaterialEntry};

use super::Reader;
use super::connect::named;
use super::graph::{negated, sum};
use super::index::{At, Scope};
use super::shaders::{LEAST_ALPHA, Model, schlick, stretched};
use crate::Result;
use crate::builder::Lobe;
use crate::fresnel::conductor;
use crate::texture::Channel;
use crate::xml::Element;

pub(super) const DIFFUSE: &str = "diffuse, without microfacets";
const FABRIC: &str = "a fabric's distribution, not a Student-t one";

/// An equal lobe is looked for among this many lobes before it, so that time stays linear.
const MAX_COMPARED: usize = 64;

impl<'a> Reader<'a> {
    /// Adds the lobes of a node of the type `surfaceshader` as the material `name`.
    pub(super) fn surface(
        &mut self,
        name: &str,
        used: bool,
        at: At<'a>,
        output: Option<&'a str>,
    ) -> Result<()> {
        let (class, place) = (&at.node.tag, &at.node.place);
        let parts = self.parts(at, output)?;
        let is_alone = parts.microfacets.len() + parts.unknown.len() + parts.broken.len() == 1;
        let part = |node: &Element| match is_alone {
            true => name.to_owned(),
            false => format!("{name}.{}", named(node)),
        };
        let mut lobes: Vec<Part> = Vec::new();
        let mut fabric = parts.fabric.then_some("sheen");
        let mut failed = !parts.broken.is_empty();
        for (at, film) in parts.microfacets {
            let node = at.node;
            let model = self.microfacets(at, film);
            match model.and_then(|model| Ok((model, self.reflects(at)?))) {
                Ok((model, reflects)) => {
                    // An interface that reflects and transmits is one lobe, and may be two nodes.
                    for lobe in model.lobes {
                        let lobe = Part { lobe, reflects };
                        let mut near = lobes.iter_mut().rev().take(MAX_COMPARED);
                        if !near.any(|other| other.absorbs(&lobe)) {
                            lobes.push(lobe);
                        }
                    }
                    for (lobe, error) in model.failed {
                        failed = true;
                        let lobe = lobe.map_or(part(node), |lobe| format!("{}.{lobe}", part(node)));
                        self.builder.degrade(&lobe, &node.tag, &node.place, Err(error))?;
                    }
                    fabric = fabric.or(model.fabric);
                }
                Err(error) => {
                    failed = true;
                    self.builder.degrade(&part(node), &node.tag, &node.place, Err(error))?;
                }
            }
        }
        for (node, error) in parts.broken {
            self.builder.degrade(&part(node), &node.tag, &node.place, Err(error))?;
        }
        for node in &parts.unknown {
            let reason = "neither a node that is known here nor one that the document defines";
            self.builder.not_understood(&part(node), &node.tag, &node.place, reason)?;
        }
        let has_lobes = !lobes.is_empty();
        if let [Part { lobe, .. }] = &mut lobes[..] {
            lobe.name = lobe.name.filter(|name| !BSDF_LOBES.contains(name));
        }
        for Part { lobe, .. } in lobes {
            self.builder.add(name, place, used, lobe)?;
        }
        if !has_lobes && !failed && parts.unknown.is_empty() {
            let none = if fabric.is_some() { FABRIC } else { "has no BSDF of a weight above 0" };
            self.builder.ignore(name, class, place, parts.reason.unwrap_or(none))?;
            fabric = fabric.filter(|_| parts.reason.is_some());
        }
        match fabric {
            Some(fabric) => self.builder.ignore(&format!("{name}.{fabric}"), class, place, FABRIC),
            None => Ok(()),
        }
    }

    fn microfacets(&mut self, at: At<'a>, film: bool) -> Result<Model> {
        if let Some(mut model) = self.model(at)? {
            for lobe in &mut model.lobes {
                lobe.fresnel = lobe.fresnel.filter(|_| !film);
            }
            return Ok(model);
        }
        if self.greatest(at, "weight", 1.0)? <= 0.0 {
            return Ok(Model::default());
        }
        let distribution = self.index.given(at.node, "distribution");
        if let Some(name) = distribution.and_then(|input| input.attribute("value"))
            && name != "ggx"
        {
            return Err(at
                .node
                .place
                .invalid(format!("the distribution \"{name}\" is not known; MaterialX has ggx")));
        }
        let roughness = self.alpha(at)?;
        let film = self.film(at, "thinfilm_thickness")? || film;
        let (name, fresnel) = match &at.node.tag[..] {
            "conductor_bsdf" => {
                // The defaults of the node's definition.
                let n = self.colour(at, "ior", [0.183, 0.421, 1.373])?;
                let k = self.colour(at, "extinction", [3.424, 2.346, 1.770])?;
                let fresnel = n.zip(k).map(|(n, k)| conductor(n, k, &at.node.place)).transpose();
                (BSDF_LOBES[0], self.builder.without_fresnel(fresnel, None)?)
            }
            "dielectric_bsdf" => (BSDF_LOBES[1], self.dielectric(at, "ior", 1.5)?),
            _ => {
                let white = Some([1.0; 3]);
                let f0 = self.colour(at, "color0", [1.0; 3])?;
                let is_schlick = self.colour(at, "color82", [1.0; 3])? == white
                    && self.colour(at, "color90", [1.0; 3])? == white
                    && self.colour(at, "exponent", [5.0; 3])? == Some([5.0; 3]);
                (BSDF_LOBES[2], f0.filter(|_| is_schlick).and_then(schlick))
            }
        };
        let fresnel: Option<Reflectance> = fresnel.filter(|_| !film);
        let retroreflection = self.retroreflective(at)?;
        let lobe = Lobe { retroreflection, ..Lobe::ggx(Some(name), roughness, fresnel) };
        Ok(Model { lobes: vec![lobe], ..Model::default() })
    }

    /// Whether a node reflects, which a BSDF in the scatter mode T does not.
    fn reflects(&self, at: At<'a>) -> Result<bool> {
        let mode = self.index.given(at.node, "scatter_mode");
        Ok(mode.map_or(Ok(None), |mode| self.said(mode, at.scope))? != Some("T"))
    }

    /// The share of what a BSDF reflects that goes back: all or nothing, by "retroreflective".
    fn retroreflective(&mut self, at: At<'a>) -> Result<Interval> {
        const NONE: Interval = MaterialEntry::SPECULAR;
        let Some(input) = self.index.given(at.node, "retroreflective") else { return Ok(NONE) };
        if !self.reflects(at)? {
            return Ok(NONE);
        }
        let read = self.said(input, at.scope).and_then(|said| match said {
            Some("true") => Ok(Interval::point(1.0)),
            Some("false") => Ok(NONE),
            said => {
                let said = said.map_or("computed by a node".into(), |said| format!("\"{said}\""));
                let why = format!("retroreflective must be true or false, not {said}");
                Err(input.place.invalid(why))
            }
        });
        self.builder.or_warn(read, (NONE, "the lobe is read without it"))
    }

    /// The input "roughness" of a BSDF, which is α along both axes.
    fn alpha(&mut self, at: At<'a>) -> Result<Roughness> {
        let Some(input) = self.index.given(at.node, "roughness") else {
            return Ok(Roughness::isotropic(Interval::point(0.05)));
        };
        if let Some((source, _)) = self.resolve(input, at.scope)? {
            let roughness = match &source.node.tag[..] {
                "roughness_anisotropy" => Some(self.input(source, "roughness", 0.0)?),
                "glossiness_anisotropy" => {
                    let gloss = self.input(source, "glossiness", 1.0)?;
                    Some(sum(Interval::point(1.0), negated(gloss)))
                }
                _ => None,
            };
            if let Some(roughness) = roughness {
                let roughness = self.moved(source, "roughness", roughness);
                let anisotropy = self.input(source, "anisotropy", 0.0)?.clamp(0.0, 1.0);
                return Ok(stretched(roughness, anisotropy));
            }
        }
        let mut axis = |channel| {
            let alpha = self.value(input, at.scope, channel)?;
            Ok::<_, SceneError>(self.moved(at, "roughness", alpha))
        };
        let (x, y) = (axis(Channel::Red)?, axis(Channel::Green)?);
        if x == y && (x.is_point() || self.is_grey(input, at.scope)?) {
            return Ok(Roughness::isotropic(x));
        }
        Ok(Roughness::anisotropic(x.clamp(LEAST_ALPHA, 1.0), y.clamp(LEAST_ALPHA, 1.0)))
    }

    /// Whether both components of a pair are equal at every point, since they come from one number.
    fn is_grey(&self, input: &'a Element, scope: Scope<'a>) -> Result<bool> {
        let mut end = At::new(input, scope);
        for _ in 0..16 {
            let Some((source, _)) = self.resolve(end.node, end.scope)? else {
                return Ok(false);
            };
            let node = source.node;
            let next = match &node.tag[..] {
                _ if node.attribute("type") == Some("float") => return Ok(true),
                "dot" | "convert" => "in",
                "roughness_dual" => "roughness",
                "combine2" => {
                    let source_of = |name| {
                        let input = self.index.given(node, name);
                        input.map(|input| self.resolve(input, source.scope)).transpose()
                    };
                    let first = source_of("in1")?.flatten();
                    return Ok(first.is_some() && first == source_of("in2")?.flatten());
                }
                _ => return Ok(false),
            };
            let Some(input) = self.index.given(node, next) else { return Ok(false) };
            end = At::new(input, source.scope);
        }
        Ok(false)
    }
}

/// Names of the lobes of microfacet BSDFs, where a material has several.
const BSDF_LOBES: [&str; 3] = ["conductor", "dielectric", "schlick"];

/// A lobe of a surface, and whether it reflects or only transmits.
struct Part {
    lobe: Lobe,
    reflects: bool,
}

impl Part {
    /// Whether `other` is a part of the same interface; if so, this one stands for both. What is
    /// transmitted has no retroreflection, so that this is that of a part that reflects.
    fn absorbs(&mut self, other: &Self) -> bool {
        let (a, b) = (&self.lobe, &other.lobe);
        let is_same = a.name == b.name
            && a.roughness == b.roughness
            && a.haze == b.haze
            && a.fresnel == b.fresnel
            && (a.retroreflection == b.retroreflection || !self.reflects || !other.reflects);
        if is_same && !self.reflects {
            self.lobe.retroreflection = other.lobe.retroreflection;
            self.reflects = other.reflects;
        }
        is_same
    }
}
