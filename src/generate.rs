//! The whole bake: specifications in, a certified set out.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use microfacet_sampler::{LoadError, MaterialEntry, Provenance, Tables};

use crate::bake::{self, NUMERICS};
use crate::spec::TableSpec;
use crate::validate::certificate::certify;

/// Points measured at each γ for a certificate.
const CERTIFICATE_POINTS: usize = 4000;

/// What happened to one table.
#[derive(Clone, Debug)]
pub struct Step {
    /// Name of the table.
    pub name: String,
    /// Time it took to bake.
    pub elapsed: Duration,
}

/// Bakes the tables in order, calling `progress` after each, and certifies the set.
///
/// # Errors
/// [`LoadError::Invalid`] if the specifications do not make a complete set; a fault of the plan.
pub fn generate(
    specs: &[TableSpec],
    recipe: String,
    materials: Vec<MaterialEntry>,
    mut progress: impl FnMut(Step),
) -> Result<Tables, LoadError> {
    let mut tables = Vec::new();
    for spec in specs {
        let start = Instant::now();
        tables.push(bake::bake(spec));
        progress(Step { name: spec.name.clone(), elapsed: start.elapsed() });
    }
    let mut set = Tables::from_tables(provenance(recipe, materials), tables)?;
    let start = Instant::now();
    certify(&mut set, CERTIFICATE_POINTS).map_err(|why| LoadError::Invalid(why.to_string()))?;
    progress(Step { name: "certificate".into(), elapsed: start.elapsed() });
    Ok(set)
}

/// Origin, licence and conventions of a set baked by this version.
pub fn provenance(recipe: String, materials: Vec<MaterialEntry>) -> Provenance {
    let conventions = [
        ("placement", "values sit at the nodes of the axes, not at cell centres"),
        (
            "gamma",
            "Student-t shape gamma > 3/2; the axis coordinate is s = 1/(gamma-1), 0 is Beckmann, 1 is GGX",
        ),
        (
            "sigma",
            "GGX and Beckmann roughness alpha; slopes are divided by sigma, nothing else, before a lookup",
        ),
        ("frame", "tangent space, n = +z; angles in radians; slopes positive towards the viewer"),
        (
            "masking",
            "shadowing tables hold Smith's G1 of one direction; how two are combined is the reader's choice",
        ),
        ("slope_channel", "derivative of `value` with respect to the node index of the last axis"),
        ("shadowing", "value = G1/q, q = z/(z+kappa), z = cot(theta)/sigma"),
        (
            "visible_slope",
            "value = distance of h = x/(1+sqrt(1+x^2)) from the nearer end: 1+h for u <= 1/2, 1-h above",
        ),
        (
            "visible_slope_peeled",
            "as visible_slope, for the density without its term x sin(theta) p(x), x > 0",
        ),
        ("visible_slope_conditional", "value = 1-h of t = y/sqrt(1+s x^2) for u > 1/2; odd about u = 1/2"),
    ];
    Provenance {
        generator: concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")).into(),
        numerics: NUMERICS,
        license: "CC0-1.0".into(),
        conventions: conventions
            .map(|(key, value)| (key.into(), value.into()))
            .into_iter()
            .collect::<BTreeMap<_, _>>(),
        recipe,
        materials,
    }
}
