//! The names and types of the parameters of pbrt's materials and float textures.

use std::rc::Rc;

use super::Reader;
use super::definition::Parameter;
use crate::builder::has_word;

/// Classes (`*` for all), the types that a parameter of them may have, and the parameters' names.
type Row = (&'static str, &'static str, &'static str);

const FLOAT: &str = "float texture";
const SPECTRUM: &str = "rgb spectrum blackbody texture";
const INDEX: &str = "float rgb spectrum blackbody";

/// Parameters of the materials with lobes and of mixtures (`materials.cpp`; `type` and `normalmap`
/// are in `scene.cpp`).
pub(super) const MATERIALS: [Row; 19] = [
    ("*", "string", "type normalmap"),
    (
        "conductor dielectric thindielectric coateddiffuse coatedconductor subsurface",
        FLOAT,
        "displacement",
    ),
    ("conductor dielectric coateddiffuse subsurface", FLOAT, "roughness uroughness vroughness"),
    ("conductor dielectric coateddiffuse coatedconductor subsurface", "bool", "remaproughness"),
    ("conductor", SPECTRUM, "eta k"),
    ("conductor coateddiffuse coatedconductor subsurface", SPECTRUM, "reflectance"),
    ("dielectric thindielectric coateddiffuse", INDEX, "eta"),
    ("coateddiffuse coatedconductor", FLOAT, "thickness g"),
    ("coateddiffuse coatedconductor", SPECTRUM, "albedo"),
    ("coateddiffuse coatedconductor", "integer", "maxdepth nsamples"),
    ("coatedconductor", FLOAT, "interface.roughness interface.uroughness interface.vroughness"),
    ("coatedconductor", FLOAT, "conductor.roughness conductor.uroughness conductor.vroughness"),
    ("coatedconductor", INDEX, "interface.eta"),
    ("coatedconductor", SPECTRUM, "conductor.eta conductor.k"),
    ("subsurface", "float", "eta scale g"),
    ("subsurface", SPECTRUM, "sigma_a sigma_s mfp"),
    ("subsurface", "string", "name"),
    // The last two names are of pbrt-v3, in which the amount may be a colour.
    ("mix", "string", "materials namedmaterial1 namedmaterial2"),
    ("mix", "float rgb spectrum texture", "amount"),
];

/// Names that only materials without lobes have; an attribute may be meant for those.
const WITHOUT_LOBES: &str =
    "alpha beta_m beta_n color eumelanin filename pheomelanin sigma transmittance";

const PLANE: &str = "checkerboard dots bilerp imagemap";

/// Parameters of the float textures whose range is known (`textures.cpp`).
pub(super) const TEXTURES: [Row; 14] = [
    (PLANE, "string", "mapping"),
    (PLANE, "float", "uscale vscale udelta vdelta"),
    (PLANE, "vector3", "v1 v2"),
    ("constant", "float", "value"),
    ("scale", FLOAT, "tex scale"),
    ("mix directionmix checkerboard", FLOAT, "tex1 tex2"),
    ("mix", FLOAT, "amount"),
    ("directionmix", "vector3", "dir"),
    ("checkerboard", "integer", "dimension"),
    ("dots", FLOAT, "inside outside"),
    ("bilerp", "float", "v00 v01 v10 v11"),
    ("imagemap", "string", "filename filter wrap encoding"),
    ("imagemap", "float", "scale maxanisotropy"),
    ("imagemap", "bool", "invert"),
];

fn is_of((classes, ..): &Row, class: &str) -> bool {
    *classes == "*" || has_word(classes, class)
}

impl Reader {
    /// Warns of parameters that a class lacks or has with another type, if the class is in a row.
    pub(super) fn check_parameters(
        &mut self,
        rows: &[Row],
        class: &str,
        parameters: &[Rc<Parameter>],
    ) {
        if !rows.iter().any(|(classes, ..)| has_word(classes, class)) {
            return;
        }
        let rows = rows.iter().filter(|row| is_of(row, class));
        let named = rows.flat_map(|(_, types, names)| names.split(' ').map(move |n| (n, types)));
        let named: Vec<(&str, &str)> = named.map(|(name, types)| (name, *types)).collect();
        let known: Vec<&str> = named.iter().map(|&(name, _)| name).collect();
        for Parameter { kind, name, place, .. } in parameters.iter().map(Rc::as_ref) {
            self.builder.check_name(class, name, &known, place);
            if let Some((_, types)) = named.iter().find(|(known, _)| known == name)
                && !has_word(types, kind)
            {
                let types = types.replace(' ', ", ");
                let warning = format!("{name} of {class} has the type {kind}; it may be {types}");
                self.builder.warn(place, warning);
            }
        }
    }

    /// Warns of attributes that no material has.
    pub(super) fn check_attributes(&mut self, parameters: &[Rc<Parameter>]) {
        let known = MATERIALS.iter().flat_map(|(_, _, names)| names.split(' '));
        let mut known: Vec<&str> = known.chain(WITHOUT_LOBES.split(' ')).collect();
        known.sort_unstable();
        known.dedup();
        for Parameter { name, place, .. } in parameters.iter().map(Rc::as_ref) {
            self.builder.check_name("a material", name, &known, place);
        }
    }
}
