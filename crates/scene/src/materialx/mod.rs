//! MaterialX documents (1.38 and later): the shading models of its libraries, and graphs of the
//! BSDF nodes of `pbrlib`.
//!
//! Conventions, from the graphs that define the nodes (`libraries/bxdf` and `libraries/pbrlib` of
//! [MaterialX 1.39][materialx], the [OpenPBR specification][openpbr]). All lobes are GGX (γ = 2);
//! r is the roughness and a the anisotropy, from 0 to 1, and A = √(1 − min(a, 0.98)).
//!
//! | node | αx | αy | Fresnel term |
//! | --- | --- | --- | --- |
//! | `standard_surface` | r² / A | r² A | `specular_IOR`; metal: `artistic_ior` of the colours |
//! | `open_pbr_surface` | r² √(2 / (1 + (1 − a)²)) | (1 − a) αx | `specular_ior`; metal: F0 `base_color` |
//! | `gltf_pbr` | r² + (1 − r²) a² | r² | F0 of `ior`; metal: F0 `base_color` |
//! | `UsdPreviewSurface` | r² | r² | F0 of `ior`, or `specularColor`; metal: `artistic_ior` |
//! | `disney_principled` | r² / A | r² A | none; metal: F0 `baseColor` |
//! | `conductor_bsdf` | as written | as written | `ior` and `extinction` |
//! | `dielectric_bsdf` | as written | as written | `ior` |
//! | `generalized_schlick_bsdf` | as written | as written | F0 `color0`, for plain Schlick |
//!
//! - α is limited to [1e-8, 1], in `gltf_pbr` to [1e-5, 1]. For BSDF nodes it comes as written or
//!   from `roughness_anisotropy` (as `standard_surface`), `glossiness_anisotropy` (the same of
//!   1 − glossiness) or `roughness_dual` (r² for each axis).
//! - A Fresnel term is stated if the inputs are constant and nothing is mixed: metal is all or
//!   nothing, there is no thin film, and in OpenPBR no coat, which the index is relative to. F0 is
//!   Schlick's; `artistic_ior` is Gulbrandsen's (JCGT 3(4), 2014).
//! - In `open_pbr_surface` a `specular_weight` w other than 1 gives the dielectric the index whose
//!   F0 is w times as large; the metal's lobe has the weight w, and is left out at w = 0.
//! - The coat, if its weight is not 0, is a lobe of its own. It roughens the base: in
//!   `standard_surface` to r + (1 − r) `coat` · `coat_affect_roughness` · `coat_roughness`, in
//!   `open_pbr_surface` to (min(1, r⁴ + 2 `coat_roughness`⁴))^¼, mixed in by the coat's weight.
//! - The clearcoats of `gltf_pbr`, `UsdPreviewSurface` and `disney_principled` are GGX too, with
//!   α = r², of the last with r = 1 − `clearcoatGloss`. Burley's own clearcoat (2012) is GTR1; the
//!   node of MaterialX is not.
//! - `transmission_extra_roughness` gives transmission a lobe of its own. What `UsdPreviewSurface`
//!   and `disney_principled` transmit is smooth, and has none.
//! - Sheen and fuzz have distributions of their own. G2 is left open.
//! - Defaults are those of the node definitions: `standard_surface` 1.0.1, `open_pbr_surface` 1.1
//!   with the additions of 1.2, `gltf_pbr` 2.0.1, `UsdPreviewSurface` 2.6.
//! - BSDFs are followed through `surface`, `layer`, `mix`, `add` and `multiply`, and through the
//!   graphs of nodes that the document defines itself (`nodedef`); not through weights of 0.
//! - A shader appears once for each `surfacematerial` that uses it, under that name, or else under
//!   its own. A material is used if a `materialassign` names it, or if the document has none.
//! - An input with an `output` alone is connected to that output of the document. Inputs that the
//!   definition of their node does not have are warned of.
//! - The base of `open_pbr_surface` may have a second lobe of weight `specular_haze`, of the same
//!   anisotropy and the roughness r + (1 − r) ξ with ξ = `specular_haze_spread` (sections "Specular
//!   haze" and "Metallic Base" of the [draft of OpenPBR 1.2][draft]). A coat roughens that in turn,
//!   as it does r (`effective_haze_roughness` in `reference/open_pbr_surface.mtlx` there).
//! - `specular_retroreflectivity` (section "Retroreflectivity") is the share of what the base
//!   reflects, in core and haze, that goes back; `retroreflective` of a BSDF node makes it all.
//!   What is transmitted does not: in `scatter_mode` T it says nothing (MaterialX PBR
//!   specification, "Reflectance Models").
//! - An image is read in its first channel if it is a float, else in the channel that is taken from
//!   it; it is decoded from sRGB if it is a colour in the colour space `srgb_texture`. A file with
//!   `<UDIM>` or `<UVTILE>` in its name is all the tiles that exist.
//! - `fileprefix` and `colorspace` of a document's root hold for the content of that document, and
//!   files are relative to its folder.
//!
//! [materialx]: https://github.com/AcademySoftwareFoundation/MaterialX/tree/main/libraries
//! [openpbr]: https://academysoftwarefoundation.github.io/OpenPBR/
//! [draft]: https://github.com/AcademySoftwareFoundation/OpenPBR/tree/dev_1.2

mod bsdfs;
mod connect;
mod constant;
mod definitions;
mod graph;
mod image;
mod index;
mod inputs;
mod open_pbr;
mod parts;
mod shaders;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use microfacet_baker::scene::{Format, Scene};

use crate::Result;
use crate::builder::Builder;
use crate::limits::{self, Budget};
use crate::references::Memo;
use crate::texture::Channel;
use crate::xml::{self, Element};
use connect::{Instance, Source, named};
use index::{At, Headers, Index, Scope};

pub(super) fn load(path: &Path) -> Result<Scene> {
    let mut xml = xml::Reader::new();
    let mut root = xml.open(path, &["materialx"], "a MaterialX document")?;
    let mut builder = Builder::new(Format::MaterialX);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut headers = Headers::new();
    expand(&mut root, folder, &mut xml, &mut headers, &mut builder)?;
    let mut reader = Reader {
        root: &root,
        builder,
        index: Index::new(&root, &headers),
        ranges: Memo::default(),
        instances: Vec::new(),
        entered: HashMap::new(),
        circle: HashSet::new(),
        left: Budget::new(limits::NODES),
    };
    reader.check_inputs();
    reader.check_circles();
    reader.materials()?;
    Ok(reader.builder.finish(xml.includes.found()))
}

/// Replaces each `<xi:include>` by the content of its document, and keeps the attributes of every
/// document's root, which hold for its content.
fn expand(
    root: &mut Element,
    folder: &Path,
    xml: &mut xml::Reader,
    headers: &mut Headers,
    builder: &mut Builder,
) -> Result<()> {
    headers.insert(root.place.file.clone(), root.attributes.clone());
    for child in std::mem::take(&mut root.children) {
        if child.tag != "include" {
            root.children.push(child);
            continue;
        }
        let Some(name) = child.attribute("href") else {
            builder.warn(&child.place, "an include names no file with \"href\"; it is left out");
            continue;
        };
        let path = folder.join(name);
        let said = "its materials are not seen";
        let included = xml.include((name, &path), &child.place, builder, said)?;
        let Some(mut included) = included else { continue };
        expand(&mut included, path.parent().unwrap_or(folder), xml, headers, builder)?;
        xml.includes.leave();
        root.children.append(&mut included.children);
    }
    Ok(())
}

struct Reader<'a> {
    root: &'a Element,
    builder: Builder,
    index: Index<'a>,
    /// Ranges of the inputs and outputs that were evaluated.
    ranges: Memo<(At<'a>, Channel)>,
    /// Nodes that the document defines by graphs, and the scopes of those.
    instances: Vec<Instance<'a>>,
    entered: HashMap<At<'a>, Scope<'a>>,
    /// Nodes that are connected in a circle.
    circle: HashSet<At<'a>>,
    /// Nodes that may still be followed.
    left: Budget,
}

/// Shaders in the order of the document, with the materials that use each.
#[derive(Default)]
struct Shaders<'a> {
    list: Vec<(Source<'a>, Vec<&'a str>)>,
    places: HashMap<Source<'a>, usize>,
}

impl<'a> Shaders<'a> {
    /// The materials that use a shader.
    fn of(&mut self, (at, output): Source<'a>) -> &mut Vec<&'a str> {
        // A node of several outputs is several shaders.
        let is_one = at.node.attribute("type") == Some("surfaceshader");
        let shader = (at, output.filter(|_| !is_one));
        let place = *self.places.entry(shader).or_insert_with(|| {
            self.list.push((shader, Vec::new()));
            self.list.len() - 1
        });
        &mut self.list[place].1
    }
}

impl<'a> Reader<'a> {
    fn materials(&mut self) -> Result<()> {
        let root = self.root;
        let assigned = root.all("materialassign").into_iter();
        let assigned: HashSet<&str> = assigned.filter_map(|e| e.attribute("material")).collect();
        // A graph with a definition implements a shading model and does not use it.
        let implementing = self.index.implementing();
        let is_graph = |e: &&Element| {
            let defines = e.attribute("nodedef").is_some() || implementing.contains(e);
            e.tag == "nodegraph" && !defines
        };
        let graphs = root.children.iter().filter(is_graph);
        let nodes: Vec<At<'a>> = [root]
            .into_iter()
            .chain(graphs)
            .flat_map(|graph| graph.children.iter().map(|e| At::new(e, Scope::of(graph))))
            .collect();
        let mut shaders = Shaders::default();
        for &at in nodes.iter().filter(|at| is_shader(at.node)) {
            shaders.of((at, None));
        }
        let parts = self.parts_of_shaders(&nodes);
        for &at in &nodes {
            self.material(at, &mut shaders)?;
        }
        for ((at, output), materials) in shaders.list {
            let own = named(at.node);
            let is_part = parts.contains(&at);
            let own = [own].into_iter().filter(|_| materials.is_empty() && !is_part);
            for name in own.chain(materials.iter().copied()) {
                let used = assigned.is_empty() || assigned.contains(name);
                let read = self.surface(name, used, at, output);
                self.builder.degrade(name, &at.node.tag, &at.node.place, read)?;
            }
        }
        Ok(())
    }

    /// Notes the shaders of a material, if the node is one.
    fn material(&mut self, at: At<'a>, shaders: &mut Shaders<'a>) -> Result<()> {
        let node = at.node;
        let name = named(node);
        let refers = |tag: &str| tag == "shaderref" || tag == "shader_ref";
        if refers(&node.tag) || node.children.iter().any(|child| refers(&child.tag)) {
            let reason = "written for MaterialX before 1.38; upgrade the document";
            return self.builder.not_understood(name, &node.tag, &node.place, reason);
        }
        if node.tag != "surfacematerial" {
            return Ok(());
        }
        let mut has_shader = false;
        for side in ["surfaceshader", "backsurfaceshader"] {
            let Some(input) = self.index.given(node, side) else { continue };
            match self.resolve(input, at.scope) {
                Ok(Some(shader)) => {
                    has_shader = true;
                    let materials = shaders.of(shader);
                    // Both sides may have the same shader.
                    if materials.last() != Some(&name) {
                        materials.push(name);
                    }
                }
                // An empty value stands for no shader.
                Ok(None) => {}
                Err(error) => {
                    has_shader = true;
                    self.builder.degrade(name, &node.tag, &node.place, Err(error))?;
                }
            }
        }
        if !has_shader {
            self.builder.ignore(name, &node.tag, &node.place, "has no surface shader")?;
        }
        Ok(())
    }

    /// The shaders that other shaders are made of, which are no materials by themselves.
    fn parts_of_shaders(&self, nodes: &[At<'a>]) -> HashSet<At<'a>> {
        let shaders = nodes.iter().filter(|at| is_shader(at.node));
        let inputs = shaders.flat_map(|at| at.node.children.iter().map(|e| (e, at.scope)));
        let of_shaders =
            inputs.filter(|(input, _)| input.attribute("type") == Some("surfaceshader"));
        // What is not defined is an error where it is used.
        of_shaders.filter_map(|(input, scope)| Some(self.resolve(input, scope).ok()??.0)).collect()
    }
}

/// Whether a child of the document or of a graph is a node that gives a shader.
fn is_shader(node: &Element) -> bool {
    let others = ["output", "input", "nodegraph", "nodedef", "implementation", "shaderref"];
    node.attribute("type") == Some("surfaceshader") && !others.contains(&&node.tag[..])
}
