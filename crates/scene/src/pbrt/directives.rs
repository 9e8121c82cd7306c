//! The directives of pbrt's file format.

use microfacet_baker::scene::did_you_mean;

/// All directives except those that [`Reader::statement`](super::Reader) handles.
const PASSED_OVER: [&str; 29] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMedium",
    "MediumInterface",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "TransformBegin",
    "TransformEnd",
    "Transform",
    "TransformTimes",
    "Translate",
    "WorldBegin",
    "WorldEnd",
];

/// Those that it handles.
const FOLLOWED: [&str; 12] = [
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Import",
    "Include",
    "MakeNamedMaterial",
    "Material",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "Shape",
    "Texture",
];

/// Directives of older versions that pbrt-v4 does not have, with the last version that has them.
const OLDER: [(&str, &str); 5] = [
    ("Renderer", "pbrt-v2"),
    ("SearchPath", "pbrt-v1"),
    ("SurfaceIntegrator", "pbrt-v2"),
    ("Volume", "pbrt-v2"),
    ("VolumeIntegrator", "pbrt-v2"),
];

/// What converts scenes of older versions.
pub(super) const UPGRADE: &str =
    "`pbrt --upgrade old.pbrt > new.pbrt` of pbrt-v4 converts scenes of pbrt-v3";

/// Whether a directive says nothing of materials.
pub(super) fn is_passed_over(directive: &str) -> bool {
    PASSED_OVER.contains(&directive)
}

/// The warning for a directive of an older version, if it is one.
pub(super) fn older(directive: &str) -> Option<String> {
    let &(_, version) = OLDER.iter().find(|(older, _)| *older == directive)?;
    Some(format!(
        "{directive} is a directive of {version}; such ones are passed over, and materials are read \
         as those of pbrt-v4; {UPGRADE}"
    ))
}

/// What is said of a word that is no directive.
pub(super) fn unknown(word: &str) -> String {
    let known = [&PASSED_OVER[..], &FOLLOWED[..]].concat();
    format!("unknown directive {word}{}", did_you_mean(word, &known))
}
