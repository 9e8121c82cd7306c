//! The inputs of nodes, from the definitions of the MaterialX libraries or of the document.

use super::Reader;
use super::index::Index;
use crate::builder::{Row, names_of};
use crate::xml::Element;

/// Inputs of the nodes that are read, in the libraries of MaterialX 1.38 to 1.39 (`bxdf`, `pbrlib`
/// and `stdlib`), of OpenPBR 1.2, and of `standard_surface` before 1.0.1.
const INPUTS: [Row; 45] = [
    (
        "standard_surface",
        "base base_color diffuse_roughness metalness specular specular_color specular_roughness \
         specular_IOR specular_anisotropy specular_rotation transmission transmission_color \
         transmission_depth transmission_scatter transmission_scatter_anisotropy \
         transmission_dispersion transmission_extra_roughness subsurface subsurface_color \
         subsurface_radius subsurface_scale subsurface_anisotropy sheen sheen_color \
         sheen_roughness coat coat_color coat_roughness coat_anisotropy coat_rotation coat_IOR \
         coat_normal coat_affect_color coat_affect_roughness thin_film_thickness thin_film_IOR \
         emission emission_color opacity thin_walled normal tangent caustics internal_reflections \
         exit_to_background indirect_diffuse indirect_specular",
    ),
    (
        "open_pbr_surface",
        "base_weight base_color base_diffuse_roughness base_metalness specular_weight \
         specular_color specular_roughness specular_ior specular_roughness_anisotropy \
         specular_haze specular_haze_spread specular_retroreflectivity transmission_weight \
         transmission_color transmission_depth transmission_scatter \
         transmission_scatter_anisotropy transmission_dispersion_scale \
         transmission_dispersion_abbe_number subsurface_weight subsurface_color subsurface_radius \
         subsurface_radius_scale subsurface_scatter_anisotropy fuzz_weight fuzz_color \
         fuzz_roughness coat_weight coat_color coat_roughness coat_roughness_anisotropy coat_ior \
         coat_darkening thin_film_weight thin_film_thickness thin_film_ior emission_weight \
         emission_luminance emission_color geometry_opacity geometry_thin_walled geometry_normal \
         geometry_coat_normal geometry_tangent geometry_coat_tangent",
    ),
    (
        "gltf_pbr",
        "base_color metallic roughness normal tangent occlusion transmission specular \
         specular_color ior alpha alpha_mode alpha_cutoff iridescence iridescence_ior \
         iridescence_thickness sheen_color sheen_roughness clearcoat clearcoat_roughness \
         clearcoat_normal emissive emissive_strength thickness attenuation_distance \
         attenuation_color anisotropy_strength anisotropy_rotation dispersion",
    ),
    (
        "UsdPreviewSurface",
        "diffuseColor emissiveColor useSpecularWorkflow specularColor metallic roughness clearcoat \
         clearcoatRoughness opacity opacityMode opacityThreshold ior normal displacement occlusion",
    ),
    (
        "disney_principled",
        "baseColor metallic roughness anisotropic specular specularTint sheen sheenTint clearcoat \
         clearcoatGloss specTrans ior subsurface subsurfaceDistance",
    ),
    (
        "conductor_bsdf dielectric_bsdf generalized_schlick_bsdf",
        "weight roughness distribution normal tangent thinfilm_thickness thinfilm_ior \
         retroreflective",
    ),
    ("conductor_bsdf", "ior extinction"),
    ("dielectric_bsdf", "ior tint"),
    ("generalized_schlick_bsdf", "color0 color82 color90 exponent"),
    ("dielectric_bsdf generalized_schlick_bsdf", "scatter_mode"),
    ("thin_film_bsdf", "thickness ior"),
    ("surface", "bsdf edf opacity thin_walled"),
    ("surfacematerial", "surfaceshader backsurfaceshader displacementshader"),
    ("layer", "top base"),
    ("mix", "fg bg mix"),
    ("add subtract multiply divide power safepower min max", "in1 in2"),
    ("combine2 combine3 combine4", "in1 in2"),
    ("combine3 combine4", "in3"),
    ("combine4", "in4"),
    ("dot convert sqrt absval invert luminance extract swizzle", "in"),
    ("separate2 separate3 separate4 clamp smoothstep remap range", "in"),
    ("dot", "note"),
    ("invert", "amount"),
    ("luminance", "lumacoeffs"),
    ("extract", "index"),
    ("swizzle", "channels"),
    ("clamp smoothstep", "low high"),
    ("remap range", "inlow inhigh outlow outhigh"),
    ("range", "gamma doclamp"),
    ("constant", "value"),
    ("ifgreater ifgreatereq ifequal", "value1 value2 in1 in2"),
    ("ramplr splitlr", "valuel valuer texcoord"),
    ("ramptb splittb", "valuet valueb texcoord"),
    ("splitlr splittb", "center"),
    ("ramp4", "valuetl valuetr valuebl valuebr texcoord"),
    ("roughness_anisotropy", "roughness anisotropy"),
    ("roughness_dual", "roughness"),
    ("glossiness_anisotropy", "glossiness anisotropy"),
    ("artistic_ior", "reflectivity edge_color"),
    (
        "image tiledimage",
        "file default texcoord filtertype framerange frameoffset frameendaction layer \
         uaddressmode vaddressmode uvtiling uvoffset realworldimagesize realworldtilesize",
    ),
    (
        "hextiledimage",
        "file default texcoord tiling rotation rotationrange scale scalerange offset offsetrange \
         falloff falloffcontrast lumacoeffs",
    ),
    (
        "gltf_image gltf_colorimage",
        "file default texcoord uvindex pivot scale rotate offset operationorder uaddressmode \
         vaddressmode filtertype",
    ),
    ("gltf_image", "factor"),
    ("gltf_colorimage", "color geomcolor"),
    ("UsdUVTexture", "file st wrapS wrapT fallback scale bias"),
];

/// Longer chains of definitions that inherit from each other count as a circle.
const MAX_HEIRS: usize = 16;
/// Names of a definition's inputs that are suggested.
const MAX_SUGGESTED: usize = 256;

impl<'a> Reader<'a> {
    /// Warns of inputs that their nodes do not have, where the definition is known.
    pub(super) fn check_inputs(&mut self) {
        let root = self.root;
        let graphs = root.children.iter().filter(|child| child.tag == "nodegraph");
        for node in [root].into_iter().chain(graphs).flat_map(|graph| &graph.children) {
            let Some(definitions) = self.index.definitions(node) else { continue };
            let own = definitions.iter().flat_map(|definition| &definition.children);
            let own = own.filter(|child| child.tag == "input").take(MAX_SUGGESTED);
            let own = own.filter_map(|input| input.attribute("name"));
            let known: Vec<&str> = names_of(&INPUTS, &node.tag).into_iter().chain(own).collect();
            if known.is_empty() {
                continue;
            }
            for input in node.children.iter().filter(|child| child.tag == "input") {
                let name = input.attribute("name").unwrap_or_default();
                if definitions.iter().all(|&of| self.index.child(of, name).is_none()) {
                    self.builder.check_name(&node.tag, name, &known, &input.place);
                }
            }
        }
    }
}

impl<'a> Index<'a> {
    /// The document's definition of a node, with those that it inherits from; `None` if one of
    /// those is not there.
    fn definitions(&self, node: &'a Element) -> Option<Vec<&'a Element>> {
        let mut chain: Vec<&Element> = self.definition(node).into_iter().collect();
        while let Some(heir) = chain.last().and_then(|last| last.attribute("inherit"))
            && chain.len() < MAX_HEIRS
        {
            chain.push(self.nodedef(heir)?);
        }
        Some(chain)
    }
}
