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

mod graph;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::builder::{Builder, GGX, Lobe, dielectric};
use super::memo::Memo;
use super::texture::Channel;
use super::xml::{self, Element, Key};
use super::{Format, Fresnel, Interval, Roughness, Scene, SceneError};

/// `M_FLOAT_EPS` of the shaders: the lower limit of α.
const LEAST_ALPHA: f64 = 1e-6;

/// Reads a MaterialX document.
pub(super) fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut xml = xml::Reader::new();
    let mut root = xml.open(path)?;
    if root.tag != "materialx" {
        return Err(root.place.invalid(format!(
            "<{}> is not the root of a MaterialX document; expected <materialx>",
            root.tag
        )));
    }
    let mut builder = Builder::new(Format::MaterialX);
    let folder = path.parent().unwrap_or(Path::new(""));
    expand(&mut root, folder, &mut xml, &mut builder)?;
    let included = xml.includes.found();
    let mut reader = Reader {
        root: &root,
        folder: folder.to_owned(),
        builder,
        index: Index::new(&root),
        ranges: Memo::default(),
    };
    reader.check_circles()?;
    reader.shaders()?;
    Ok(reader.builder.finish(included))
}

/// Replaces each `<xi:include>` by the content of its document.
fn expand(
    root: &mut Element,
    folder: &Path,
    xml: &mut xml::Reader,
    builder: &mut Builder,
) -> Result<(), SceneError> {
    for child in std::mem::take(&mut root.children) {
        if child.tag != "include" {
            root.children.push(child);
            continue;
        }
        let name = child.required("href")?;
        let path = folder.join(name);
        if !xml.includes.enter(&path, &child.place)? {
            builder.warn(&child.place, format!("{name} is missing; its materials are not seen"));
            continue;
        }
        let mut included = xml.read(&path, &child.place)?;
        expand(&mut included, path.parent().unwrap_or(folder), xml, builder)?;
        xml.includes.leave();
        root.children.append(&mut included.children);
    }
    Ok(())
}

/// Children by their element and their attribute "name"; the first of a name.
struct Index<'a> {
    children: HashMap<(Key<'a>, &'a str), &'a Element>,
    /// As `children`, of the outputs alone; the first of all is also under the empty name.
    outputs: HashMap<(Key<'a>, &'a str), &'a Element>,
}

impl<'a> Index<'a> {
    fn new(root: &'a Element) -> Self {
        let mut index = Self { children: HashMap::new(), outputs: HashMap::new() };
        root.walk(&mut |element| {
            for child in &element.children {
                if let Some(name) = child.attribute("name") {
                    let key = (element.key(), name);
                    index.children.entry(key).or_insert(child);
                    if child.tag == "output" {
                        index.outputs.entry(key).or_insert(child);
                    }
                }
                if child.tag == "output" {
                    index.outputs.entry((element.key(), "")).or_insert(child);
                }
            }
        });
        index
    }

    fn child(&self, element: &'a Element, name: &'a str) -> Option<&'a Element> {
        self.children.get(&(element.key(), name)).copied()
    }
}

/// The materials that use a shader.
#[derive(Clone, Default)]
struct Wearers<'a> {
    /// One of them.
    name: &'a str,
    count: usize,
    /// Whether one of them is assigned to geometry.
    assigned: bool,
}

impl<'a> Wearers<'a> {
    fn add(&mut self, other: &Self) {
        self.name = other.name;
        self.count += other.count;
        self.assigned |= other.assigned;
    }
}

struct Reader<'a> {
    root: &'a Element,
    folder: PathBuf,
    builder: Builder,
    index: Index<'a>,
    /// Ranges of the inputs and outputs that were evaluated.
    ranges: Memo<(Key<'a>, Channel)>,
}

/// The values of a shader's inputs.
struct Shader<'a> {
    node: &'a Element,
    /// The graph it is in, or the document.
    scope: &'a Element,
}

impl<'a> Reader<'a> {
    fn shaders(&mut self) -> Result<(), SceneError> {
        let root = self.root;
        let mut assigned = HashSet::new();
        root.walk(&mut |element| {
            if element.tag == "materialassign" {
                assigned.extend(element.attribute("material"));
            }
        });
        let wearers = self.wearers(&assigned);
        // A graph with a definition implements a shading model and does not use it.
        let graphs = root
            .children
            .iter()
            .filter(|child| child.tag == "nodegraph" && child.attribute("nodedef").is_none());
        for scope in [root].into_iter().chain(graphs) {
            for node in &scope.children {
                let shader = Shader { node, scope };
                match (&node.tag[..], node.attribute("type")) {
                    ("shaderref", _) => {
                        let (name, reason) = ("shaderref", "older than MaterialX 1.38");
                        self.builder.ignore(name, "shaderref", &node.place, reason)?;
                    }
                    ("material", _) if node.children.iter().any(|c| c.tag == "shaderref") => {
                        let name = node.attribute("name").unwrap_or_default();
                        let reason = "written for MaterialX before 1.38; upgrade the document";
                        self.builder.ignore(name, "material", &node.place, reason)?;
                    }
                    ("output" | "input" | "nodegraph" | "nodedef", _) => {}
                    (class, Some("surfaceshader")) => {
                        let own = node.attribute("name").unwrap_or(class);
                        let wearers = wearers.get(own).cloned().unwrap_or_default();
                        let used = assigned.is_empty() || wearers.assigned;
                        // A shader of one material takes its name; a shared one keeps its own.
                        let name = if wearers.count == 1 { wearers.name } else { own };
                        self.shader(name, class, &shader, used)?;
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// The materials that use each shader, by its name.
    fn wearers(&self, assigned: &HashSet<&'a str>) -> HashMap<&'a str, Wearers<'a>> {
        let mut shaders: HashMap<&str, Wearers<'a>> = HashMap::new();
        let mut graphs: HashMap<&str, Wearers<'a>> = HashMap::new();
        for material in self.root.children.iter().filter(|e| e.tag == "surfacematerial") {
            let (Some(name), Some(input)) =
                (material.attribute("name"), self.index.child(material, "surfaceshader"))
            else {
                continue;
            };
            let one = Wearers { name, count: 1, assigned: assigned.contains(name) };
            if let Some(shader) = input.attribute("nodename") {
                shaders.entry(shader).or_default().add(&one);
            }
            if let Some(graph) = input.attribute("nodegraph") {
                graphs.entry(graph).or_default().add(&one);
            }
        }
        for (graph, wearers) in graphs {
            let graph = self.index.child(self.root, graph);
            for name in graph.iter().flat_map(|g| &g.children).filter_map(|c| c.attribute("name")) {
                shaders.entry(name).or_default().add(&wearers);
            }
        }
        shaders
    }

    fn shader(
        &mut self,
        name: &str,
        class: &str,
        shader: &Shader<'a>,
        used: bool,
    ) -> Result<(), SceneError> {
        let lobes = match class {
            "standard_surface" => self.standard_surface(shader)?,
            "open_pbr_surface" => self.open_pbr_surface(shader)?,
            _ => {
                let reason = "not a shading model that is known here";
                return self.builder.ignore(name, class, &shader.node.place, reason);
            }
        };
        if lobes.is_empty() {
            let reason = "diffuse, without microfacets";
            self.builder.ignore(name, class, &shader.node.place, reason)?;
        }
        for lobe in lobes {
            self.builder.add(name, &shader.node.place, used, lobe)?;
        }
        let fabric = if class == "standard_surface" { "sheen" } else { "fuzz_weight" };
        if self.input(shader, fabric, 0.0)?.max > 0.0 {
            let name = format!("{name}.{fabric}");
            let reason = "a fabric's distribution, not a Student-t one";
            self.builder.ignore(&name, class, &shader.node.place, reason)?;
        }
        Ok(())
    }

    fn standard_surface(&mut self, shader: &Shader<'a>) -> Result<Vec<Lobe>, SceneError> {
        let alpha = |roughness: Interval, anisotropy: Interval| {
            let aspect = anisotropy.map_falling(|a| (1.0 - a.min(0.98)).sqrt());
            axes(
                roughness,
                anisotropy,
                [1.0 / aspect.max, 1.0 / aspect.min],
                [aspect.min, aspect.max],
            )
        };
        let roughness = self.unit(shader, "specular_roughness", 0.2)?;
        let anisotropy = self.unit(shader, "specular_anisotropy", 0.0)?;
        let metalness = self.unit(shader, "metalness", 0.0)?;
        let transmission = self.unit(shader, "transmission", 0.0)?;
        let extra = self.input(shader, "transmission_extra_roughness", 0.0)?;
        let coat = self.unit(shader, "coat", 0.0)?;
        let coat_roughness = self.unit(shader, "coat_roughness", 0.1)?;
        let coat_anisotropy = self.unit(shader, "coat_anisotropy", 0.0)?;
        let affect = self.unit(shader, "coat_affect_roughness", 0.0)?;
        let roughening =
            coat.map_bilinear(affect, |a, b| a * b).map_bilinear(coat_roughness, |a, b| a * b);
        let under_coat = |r: Interval| r.map_bilinear(roughening, |r, t| r + (1.0 - r) * t);

        let mut lobes = Vec::new();
        if metalness.max + transmission.max + self.unit(shader, "specular", 1.0)?.max > 0.0 {
            let fresnel = match metalness.max > 0.0 {
                true => None,
                false => self.index(shader, "specular_IOR", 1.5)?,
            };
            lobes.push(lobe(None, alpha(under_coat(roughness), anisotropy), fresnel));
            if transmission.max > 0.0 && extra != Interval::point(0.0) {
                let roughness =
                    Interval { min: roughness.min + extra.min, max: roughness.max + extra.max };
                let roughness = under_coat(roughness.clamp(0.0, 1.0));
                lobes.push(lobe(Some("transmission"), alpha(roughness, anisotropy), fresnel));
            }
        }
        if coat.max > 0.0 {
            let fresnel = self.index(shader, "coat_IOR", 1.5)?;
            lobes.push(lobe(Some("coat"), alpha(coat_roughness, coat_anisotropy), fresnel));
        }
        Ok(lobes)
    }

    fn open_pbr_surface(&mut self, shader: &Shader<'a>) -> Result<Vec<Lobe>, SceneError> {
        let alpha = |roughness: Interval, anisotropy: Interval| {
            let stretch = |a: f64| (2.0 / (1.0 + (1.0 - a) * (1.0 - a))).sqrt();
            let along = anisotropy.map_rising(stretch);
            let across = anisotropy.map_falling(|a| (1.0 - a) * stretch(a));
            axes(roughness, anisotropy, [along.min, along.max], [across.min, across.max])
        };
        let roughness = self.unit(shader, "specular_roughness", 0.3)?;
        let anisotropy = self.unit(shader, "specular_roughness_anisotropy", 0.0)?;
        let metalness = self.unit(shader, "base_metalness", 0.0)?;
        let transmission = self.unit(shader, "transmission_weight", 0.0)?;
        let specular = self.input(shader, "specular_weight", 1.0)?;
        let coat = self.unit(shader, "coat_weight", 0.0)?;
        let coat_roughness = self.unit(shader, "coat_roughness", 0.0)?;
        let coat_anisotropy = self.unit(shader, "coat_roughness_anisotropy", 0.0)?;
        let under_coat = |r: f64, coat_roughness: f64, coat: f64| {
            let fourth = |x: f64| x * x * x * x;
            let sum = fourth(r) + 2.0 * fourth(coat_roughness);
            r + (sum.min(1.0).sqrt().sqrt() - r) * coat
        };

        let mut lobes = Vec::new();
        if metalness.max + transmission.max + specular.max > 0.0 {
            // Under a coat the index is relative to the coat's; metal is not a dielectric.
            let fresnel = match metalness.max > 0.0 || coat.max > 0.0 {
                true => None,
                false => self.index(shader, "specular_ior", 1.5)?,
            };
            let roughness = Interval {
                min: under_coat(roughness.min, coat_roughness.min, coat.min),
                max: under_coat(roughness.max, coat_roughness.max, coat.max),
            };
            lobes.push(lobe(None, alpha(roughness, anisotropy), fresnel));
        }
        if coat.max > 0.0 {
            let fresnel = self.index(shader, "coat_ior", 1.6)?;
            lobes.push(lobe(Some("coat"), alpha(coat_roughness, coat_anisotropy), fresnel));
        }
        Ok(lobes)
    }

    /// An input from 0 to 1; values outside are clamped, as the shaders do.
    fn unit(
        &mut self,
        shader: &Shader<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Interval, SceneError> {
        let value = self.input(shader, name, default)?;
        if value.min < 0.0 || value.max > 1.0 {
            let worst = if value.min < 0.0 { value.min } else { value.max };
            self.builder.warn(
                &shader.node.place,
                format!("{name} is {worst}, outside [0, 1]; it is moved to the nearer end"),
            );
        }
        Ok(value.clamp(0.0, 1.0))
    }

    fn index(
        &mut self,
        shader: &Shader<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Option<Fresnel>, SceneError> {
        let eta = self.input(shader, name, default)?;
        eta.is_point().then(|| dielectric(eta.min, &shader.node.place)).transpose()
    }

    fn input(
        &mut self,
        shader: &Shader<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Interval, SceneError> {
        match self.index.child(shader.node, name) {
            Some(input) => self.value(input, shader.scope),
            None => Ok(Interval::point(default)),
        }
    }
}

fn lobe(name: Option<&'static str>, roughness: Roughness, fresnel: Option<Fresnel>) -> Lobe {
    Lobe { name, roughness, gamma: GGX, fresnel, masking: None }
}

/// The roughness along both axes: r² times a factor from `x` and from `y`, least and greatest.
fn axes(r: Interval, anisotropy: Interval, x: [f64; 2], y: [f64; 2]) -> Roughness {
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
