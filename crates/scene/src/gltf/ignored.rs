//! Members that are known and not read.

use crate::builder::Row;

/// Members that leave every lobe as it is, of a material (under no name) and of objects in it.
pub(super) const OTHERS: [Row; 6] = [
    (
        "",
        "name normalTexture occlusionTexture emissiveTexture emissiveFactor alphaMode alphaCutoff \
         doubleSided",
    ),
    ("KHR_materials_anisotropy", "anisotropyRotation"),
    ("KHR_materials_clearcoat", "clearcoatTexture clearcoatNormalTexture"),
    (
        "KHR_materials_iridescence",
        "iridescenceTexture iridescenceIor iridescenceThicknessMinimum \
         iridescenceThicknessMaximum iridescenceThicknessTexture",
    ),
    ("KHR_materials_pbrSpecularGlossiness", "diffuseFactor diffuseTexture"),
    (
        "extensions",
        "ADOBE_materials_clearcoat_tint KHR_materials_diffuse_roughness \
         KHR_materials_diffuse_transmission KHR_materials_dispersion \
         KHR_materials_emissive_strength KHR_materials_volume KHR_materials_volume_scatter \
         KHR_xmp_json_ld MSFT_lod",
    ),
];
