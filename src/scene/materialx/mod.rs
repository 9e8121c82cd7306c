//! MaterialX documents (1.38 and later): `standard_surface` and `open_pbr_surface`.
//!
//! Conventions, from the graphs that define the two shading models (`libraries/bxdf` of MaterialX,
//! the [OpenPBR specification][openpbr]) and the node `roughness_anisotropy` (`libraries/pbrlib`):
//!
//! - All lobes are GGX (γ = 2) with α from the roughness r and the anisotropy a, limited to [1e-6,
//!   1]:
//!   - `standard_surface`: αx = r²/A, αy = r² A, with A = √(1 − min(a, 0.98));
//!   - `open_pbr_surface`: αx = r² √(2 / (1 + (1 − a)²)), αy = (1 − a) αx.
//! - The coat, if its weight is not 0, is a lobe of its own. It roughens the base: in
//!   `standard_surface` to r + (1 − r) `coat` · `coat_affect_roughness` · `coat_roughness`, in
//!   `open_pbr_surface` to (min(1, r⁴ + 2 `coat_roughness`⁴))^¼, mixed in by the coat's weight.
//! - `transmission_extra_roughness` gives transmission a lobe of its own.
//! - Sheen and fuzz have distributions of their own. The form of G2 is left open.
//! - Defaults are those of the node definitions, version 1.0.1 and 1.1.
//! - A material is used if a `materialassign` names it, or if the document has none.
//! - An image is read in its first channel if it is a float, else in the channel that is taken from
//!   it; it is decoded from sRGB if it is a colour in the colour space `srgb_texture`.
//!
//! [openpbr]: https://academysoftwarefoundation.github.io/OpenPBR/

mod bsdfs;
mod connect;
mod graph;
mod image;
mod index;
mod shaders;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::builder::Builder;
use super::limits::Budget;
use super::memo::Memo;
use super::texture::Channel;
use super::xml::{self, Element};
use super::{Format, Scene, SceneError, limits};
use connect::{Instance, named};
use index::{At, Headers, Index, Scope};

/// Reads a MaterialX document.
pub(super) fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut xml = xml::Reader::new();
    let mut root = xml.open(path)?;
    if root.tag != "materialx" {
        return Err(root.place.syntax(format!(
            "<{}> is not the root of a MaterialX document; expected <materialx>",
            root.tag
        )));
    }
    let mut builder = Builder::new(Format::MaterialX);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut headers = Headers::new();
    expand(&mut root, folder, &mut xml, &mut headers, &mut builder)?;
    let included = xml.includes.found();
    let mut reader = Reader {
        root: &root,
        builder,
        index: Index::new(&root, &headers),
        ranges: Memo::default(),
        instances: Vec::new(),
        entered: HashMap::new(),
        bsdfs: Budget::new(limits::BSDFS),
    };
    reader.check_circles();
    reader.materials()?;
    Ok(reader.builder.finish(included))
}

/// Replaces each `<xi:include>` by the content of its document, and keeps the attributes of every
/// document's root, which hold for what it brings.
fn expand(
    root: &mut Element,
    folder: &Path,
    xml: &mut xml::Reader,
    headers: &mut Headers,
    builder: &mut Builder,
) -> Result<(), SceneError> {
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
        if !xml.includes.enter(&path, &child.place)? {
            builder.warn(&child.place, format!("{name} is missing; its materials are not seen"));
            continue;
        }
        let mut included = xml.read(&path, &child.place)?;
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
    bsdfs: Budget,
}

/// A shader, as an output of a node.
type Shader<'a> = (At<'a>, Option<&'a str>);

/// Shaders in the order of the document, with the materials that use each.
#[derive(Default)]
struct Shaders<'a> {
    list: Vec<(Shader<'a>, Vec<&'a str>)>,
    places: HashMap<Shader<'a>, usize>,
}

impl<'a> Shaders<'a> {
    /// The materials that use a shader.
    fn of(&mut self, (at, output): Shader<'a>) -> &mut Vec<&'a str> {
        // A node of several outputs is several shaders.
        let is_one = at.node().attribute("type") == Some("surfaceshader");
        let shader = (at, output.filter(|_| !is_one));
        let place = *self.places.entry(shader).or_insert_with(|| {
            self.list.push((shader, Vec::new()));
            self.list.len() - 1
        });
        &mut self.list[place].1
    }
}

impl<'a> Reader<'a> {
    fn materials(&mut self) -> Result<(), SceneError> {
        let root = self.root;
        let mut assigned = HashSet::new();
        root.walk(&mut |element| {
            if element.tag == "materialassign" {
                assigned.extend(element.attribute("material"));
            }
        });
        // A graph with a definition implements a shading model and does not use it.
        let is_graph = |e: &&Element| e.tag == "nodegraph" && e.attribute("nodedef").is_none();
        let graphs = root.children.iter().filter(is_graph);
        let nodes: Vec<At<'a>> = [root]
            .into_iter()
            .chain(graphs)
            .flat_map(|graph| graph.children.iter().map(|e| At::new(e, Scope::of(graph))))
            .collect();
        let mut shaders = Shaders::default();
        for &at in nodes.iter().filter(|at| is_shader(at.node())) {
            shaders.of((at, None));
        }
        let parts = self.parts_of_shaders(&nodes);
        for &at in &nodes {
            self.material(at, &mut shaders)?;
        }
        for ((at, output), materials) in shaders.list {
            let own = named(at.node());
            let is_part = parts.contains(&at);
            let own = [own].into_iter().filter(|_| materials.is_empty() && !is_part);
            for name in own.chain(materials.iter().copied()) {
                let used = assigned.is_empty() || assigned.contains(name);
                let read = self.surface(name, used, at, output);
                self.builder.degrade(name, &at.node().tag, &at.node().place, read)?;
            }
        }
        Ok(())
    }

    /// Notes the shaders of a material, if the node is one.
    fn material(&mut self, at: At<'a>, shaders: &mut Shaders<'a>) -> Result<(), SceneError> {
        let node = at.node();
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
                    // Both sides may have the same.
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
        let shaders = nodes.iter().filter(|at| is_shader(at.node()));
        let inputs = shaders.flat_map(|at| at.node().children.iter().map(|e| (e, at.scope)));
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
