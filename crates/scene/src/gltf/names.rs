//! The names of members that are known.

use super::Importer;
use super::object::Object;
use crate::builder::{Row, names_of};
use crate::limits::Budget;

/// Members of a material (under no name) and of objects in it: those that are read, and then those
/// that leave every lobe as it is.
const NAMES: [Row; 10] = [
    (
        "",
        "pbrMetallicRoughness extensions name normalTexture occlusionTexture emissiveTexture \
         emissiveFactor alphaMode alphaCutoff doubleSided",
    ),
    (
        "pbrMetallicRoughness",
        "baseColorFactor baseColorTexture metallicFactor roughnessFactor metallicRoughnessTexture",
    ),
    (
        "extensions",
        "KHR_materials_anisotropy KHR_materials_clearcoat KHR_materials_ior \
         KHR_materials_iridescence KHR_materials_pbrSpecularGlossiness \
         KHR_materials_retroreflection KHR_materials_sheen KHR_materials_specular \
         KHR_materials_transmission KHR_materials_unlit \
         ADOBE_materials_clearcoat_tint KHR_materials_diffuse_roughness \
         KHR_materials_diffuse_transmission KHR_materials_dispersion \
         KHR_materials_emissive_strength KHR_materials_volume KHR_materials_volume_scatter \
         KHR_xmp_json_ld MSFT_lod",
    ),
    ("KHR_materials_anisotropy", "anisotropyStrength anisotropyTexture anisotropyRotation"),
    (
        "KHR_materials_clearcoat",
        "clearcoatFactor clearcoatRoughnessFactor clearcoatRoughnessTexture clearcoatTexture \
         clearcoatNormalTexture",
    ),
    ("KHR_materials_ior", "ior"),
    (
        "KHR_materials_iridescence",
        "iridescenceFactor iridescenceTexture iridescenceIor iridescenceThicknessMinimum \
         iridescenceThicknessMaximum iridescenceThicknessTexture",
    ),
    (
        "KHR_materials_pbrSpecularGlossiness",
        "specularFactor glossinessFactor specularGlossinessTexture diffuseFactor diffuseTexture",
    ),
    ("KHR_materials_retroreflection", "retroreflectionFactor retroreflectionTexture"),
    (
        "KHR_materials_specular",
        "specularFactor specularTexture specularColorFactor specularColorTexture",
    ),
];

/// What the names of Khronos' extensions of materials begin with.
const KHRONOS: &str = "KHR_materials_";

pub(super) fn extensions() -> Vec<&'static str> {
    names_of(&NAMES, "extensions")
}

impl Importer<'_> {
    /// Warns of unknown members in an object of a material, of at most as many as are `left`.
    pub(super) fn check_names(
        &mut self,
        material: &str,
        owner: &str,
        object: &Object<'_>,
        left: &Budget,
    ) {
        let known = names_of(&NAMES, owner);
        // Any object may have extensions and extras.
        let is_free = |name: &str| name == "extras" || name == "extensions" && !owner.is_empty();
        for name in object.members.keys().filter(|name| !is_free(name) && !known.is_empty()) {
            if known.contains(&&name[..]) {
                // A member that is no object is reported where it is read.
                if let Ok(Some(inner)) = object.object(name) {
                    self.check_names(material, name, &inner, left);
                }
            } else if !left.take(1) {
                return;
            } else if owner == "extensions" {
                // The common prefix would make all names similar.
                let stem = |name| str::strip_prefix(name, KHRONOS).unwrap_or(name);
                let hint = self.builder.did_you_mean(stem(name), known.iter().map(|one| stem(one)));
                let extension = format!("the extension {name} of material \"{material}\"");
                let warning = format!("{extension} is not read{hint}; its lobes are without it");
                self.builder.warn(self.place, warning);
            } else {
                let of = if owner.is_empty() { "" } else { " of " };
                let owner = format!("{owner}{of}material \"{material}\"");
                self.builder.check_name(&owner, name, &known, self.place);
            }
        }
    }
}
