//! The BSDFs of a surface, found by following the nodes that combine them.

use std::collections::HashSet;

use microfacet_baker::scene::SceneError;

use super::Reader;
use super::bsdfs::DIFFUSE;
use super::connect::is_end;
use super::index::At;
use crate::Result;
use crate::xml::Element;

/// A node to follow, with the output that is meant, and whether a thin film lies on it.
type Step<'a> = (At<'a>, Option<&'a str>, bool);

/// The BSDFs of a surface, without those of weight 0.
#[derive(Default)]
pub(super) struct Parts<'a> {
    /// Shading models and microfacet BSDFs, and whether a thin film lies on them.
    pub(super) microfacets: Vec<(At<'a>, bool)>,
    pub(super) unknown: Vec<&'a Element>,
    /// Nodes with a connection or a weight that is impossible, and why.
    pub(super) broken: Vec<(&'a Element, SceneError)>,
    pub(super) fabric: bool,
    /// Why there is nothing to bake, if there is no other part.
    pub(super) reason: Option<&'static str>,
    left: Vec<Step<'a>>,
}

impl<'a> Reader<'a> {
    /// Follows the nodes that combine BSDFs and surfaces. Each is visited once, without recursion,
    /// so that graphs may be deep and share their parts.
    pub(super) fn parts(&mut self, start: At<'a>, output: Option<&'a str>) -> Result<Parts<'a>> {
        let mut parts = Parts { left: vec![(start, output, false)], ..Parts::default() };
        let mut seen = HashSet::new();
        while let Some((at, output, film)) = parts.left.pop() {
            if !seen.insert((at, output)) {
                continue;
            }
            let node = at.node;
            self.count(node)?;
            if let Err(error) = self.part((at, output, film), &mut parts) {
                parts.broken.push((node, error));
            }
        }
        Ok(parts)
    }

    /// Adds a node to `parts`, and the nodes to follow from it.
    fn part(&mut self, (at, output, film): Step<'a>, parts: &mut Parts<'a>) -> Result<()> {
        let node = at.node;
        if self.circle.contains(&at) {
            return Err(node.place.invalid("is connected to itself through other nodes"));
        }
        match &node.tag[..] {
            "output" | "input" => {
                parts.left.extend(self.source(at)?.map(|(at, output)| (at, output, film)));
            }
            "surface" => self.follow(at, "bsdf", film, parts),
            "dot" => self.follow(at, "in", film, parts),
            "add" => {
                self.follow(at, "in2", film, parts);
                self.follow(at, "in1", film, parts);
            }
            "multiply" => {
                if self.greatest(at, "in2", 1.0)? > 0.0 {
                    self.follow(at, "in1", film, parts);
                }
            }
            "mix" => {
                let mix = self.input(at, "mix", 0.0)?;
                if mix.min < 1.0 {
                    self.follow(at, "bg", film, parts);
                }
                if mix.max > 0.0 {
                    self.follow(at, "fg", film, parts);
                }
            }
            "layer" => {
                let top = self.index.given(node, "top");
                // An error in `top` is reported where it is followed.
                let top = top.and_then(|top| self.resolve(top, at.scope).ok().flatten());
                let is_film = top.is_some_and(|(top, _)| top.node.tag == "thin_film_bsdf");
                self.follow(at, "base", film || is_film, parts);
                self.follow(at, "top", film, parts);
            }
            "conductor_bsdf" | "dielectric_bsdf" | "generalized_schlick_bsdf" => {
                parts.microfacets.push((at, film));
            }
            "standard_surface" | "open_pbr_surface" | "gltf_pbr" | "disney_principled"
            | "UsdPreviewSurface" => {
                // All have a diffuse component.
                parts.reason = Some(DIFFUSE);
                parts.microfacets.push((at, film));
            }
            "oren_nayar_diffuse_bsdf"
            | "burley_diffuse_bsdf"
            | "translucent_bsdf"
            | "subsurface_bsdf" => parts.reason = Some(DIFFUSE),
            "sheen_bsdf" => parts.fabric |= self.greatest(at, "weight", 1.0)? > 0.0,
            "chiang_hair_bsdf" => parts.reason = Some("a fibre model, not a microfacet one"),
            "surface_unlit" => parts.reason = Some("emits light, without microfacets"),
            // A film changes the Fresnel term of the BSDF under it; a medium has no lobe.
            "thin_film_bsdf" | "absorption_vdf" | "anisotropic_vdf" => {}
            _ => match self.implemented(at, output)? {
                Some(output) => parts.left.push((output, None, film)),
                None => parts.unknown.push(node),
            },
        }
        Ok(())
    }

    /// Adds what an input is connected to; if that is undefined, other inputs are still followed.
    fn follow(&self, at: At<'a>, name: &'static str, film: bool, parts: &mut Parts<'a>) {
        let Some(input) = self.index.given(at.node, name) else { return };
        match self.source(At::new(input, at.scope)) {
            Ok(next) => parts.left.extend(next.map(|(at, output)| (at, output, film))),
            Err(error) => parts.broken.push((at.node, error)),
        }
    }

    /// What an input or output is connected to, with the output that is meant.
    fn source(&self, end: At<'a>) -> Result<Option<(At<'a>, Option<&'a str>)>> {
        let next = self.target(end.node, end.scope)?;
        Ok(next.map(|next| {
            let is_end = is_end(end.node, next.node);
            (next, end.node.attribute("output").filter(|_| !is_end))
        }))
    }
}
