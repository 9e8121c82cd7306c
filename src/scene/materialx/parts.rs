//! What a surface is made of: the nodes that combine BSDFs, followed to those.

use std::collections::HashSet;

use super::Reader;
use super::bsdfs::DIFFUSE;
use super::connect::is_end;
use super::index::At;
use crate::scene::xml::Element;
use crate::scene::{SceneError, limits};

/// What a surface is made of, without what has a weight of 0.
#[derive(Default)]
pub(super) struct Parts<'a> {
    /// Shading models and microfacet BSDFs, and whether a thin film lies on them.
    pub(super) microfacets: Vec<(At<'a>, bool)>,
    pub(super) unknown: Vec<&'a Element>,
    pub(super) fabric: bool,
    /// Why there is nothing to bake, if there is no other part.
    pub(super) reason: Option<&'static str>,
}

impl<'a> Reader<'a> {
    /// Follows the nodes that combine BSDFs and surfaces. Each is visited once, without recursion,
    /// so that graphs may be deep and share their parts.
    pub(super) fn parts(
        &mut self,
        start: At<'a>,
        output: Option<&'a str>,
    ) -> Result<Parts<'a>, SceneError> {
        let mut parts = Parts::default();
        let mut left = vec![(start, output, false)];
        let mut seen = HashSet::new();
        while let Some((at, output, film)) = left.pop() {
            if !seen.insert((at, output)) {
                continue;
            }
            let node = at.node();
            if self.circle.contains(&at) {
                return Err(node.place.invalid("is connected to itself through other nodes"));
            }
            if !self.bsdfs.take(1) {
                return Err(node.place.too_large(format!(
                    "the materials have more than {} BSDF nodes in all; split the document",
                    limits::BSDFS
                )));
            }
            let mut follow = |reader: &Self, name: &'static str, film: bool| {
                if let Some(input) = reader.index.given(node, name) {
                    left.extend(
                        reader.source(At::new(input, at.scope))?.map(|(at, o)| (at, o, film)),
                    );
                }
                Ok(())
            };
            match &node.tag[..] {
                "output" | "input" => {
                    left.extend(self.source(at)?.map(|(at, output)| (at, output, film)));
                }
                "surface" => follow(self, "bsdf", film)?,
                "dot" => follow(self, "in", film)?,
                "add" => {
                    follow(self, "in2", film)?;
                    follow(self, "in1", film)?;
                }
                "multiply" => {
                    if self.greatest(at, "in2", 1.0)? > 0.0 {
                        follow(self, "in1", film)?;
                    }
                }
                "mix" => {
                    let mix = self.input(at, "mix", 0.0)?;
                    if mix.min < 1.0 {
                        follow(self, "bg", film)?;
                    }
                    if mix.max > 0.0 {
                        follow(self, "fg", film)?;
                    }
                }
                "layer" => {
                    let top = self.index.given(node, "top");
                    let top = top.map(|top| self.resolve(top, at.scope)).transpose()?.flatten();
                    let is_film = top.is_some_and(|(top, _)| top.node().tag == "thin_film_bsdf");
                    follow(self, "base", film || is_film)?;
                    follow(self, "top", film)?;
                }
                "conductor_bsdf" | "dielectric_bsdf" | "generalized_schlick_bsdf" => {
                    parts.microfacets.push((at, film));
                }
                "standard_surface" | "open_pbr_surface" | "gltf_pbr" | "disney_principled"
                | "UsdPreviewSurface" => {
                    // All have a diffuse part.
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
                // It lies on another BSDF, which it is the Fresnel term of.
                "thin_film_bsdf" | "absorption_vdf" | "anisotropic_vdf" => {}
                _ => match self.implemented(at, output)? {
                    Some(output) => left.push((output, None, film)),
                    None => parts.unknown.push(node),
                },
            }
        }
        Ok(parts)
    }

    /// What an input or output is connected to, with the output that is meant.
    fn source(&self, end: At<'a>) -> Result<Option<(At<'a>, Option<&'a str>)>, SceneError> {
        let next = self.target(end.node(), end.scope)?;
        Ok(next.map(|next| {
            let is_end = is_end(end.node(), next.node());
            (next, end.node().attribute("output").filter(|_| !is_end))
        }))
    }
}
