//! What serves each material of a set, and why something does not.

use std::collections::BTreeMap;

use microfacet_baker::plan::{AlbedoVerdict, Options, Plan};
use microfacet_baker::scene::{Scene, recipe_of};
use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::Tables;
use microfacet_tables::{Covered, FresnelEntry, LobeEntry, MaterialEntry, Reflectance, Table};

use crate::words::material::fresnel;
use crate::words::verdict::albedo_reason;
use crate::words::{number, range};

/// A material and what serves it.
#[derive(Clone, Debug)]
pub(super) struct Served {
    pub(super) name: String,
    pub(super) sigma: String,
    /// γ, or the distribution.
    pub(super) shape: String,
    pub(super) masking: String,
    pub(super) fresnel: String,
    /// Masking and visible normals.
    pub(super) lobe: Part,
    pub(super) albedo: Part,
    /// Of the tables that it reads.
    pub(super) bytes: usize,
}

/// What serves a part of a material.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// In few words.
    pub(super) what: &'static str,
    /// Why the set has no table for it.
    pub(super) skipped: Option<String>,
}

impl Part {
    const OWN: Self = Self { what: "its tables", skipped: None };

    fn skipped(what: &'static str, why: impl Into<String>) -> Self {
        Self { what, skipped: Some(why.into()) }
    }
}

/// The materials of a set, in order.
pub(super) fn served(set: &Tables) -> Vec<Served> {
    let wishes = wishes(&recipe_of(&set.provenance().materials));
    let default = Tables::embedded();
    let one = |entry| of(set, &default, entry, &wishes);
    set.provenance().materials.iter().map(one).collect()
}

/// What a plan of the recipe, which the set keeps, decides on albedos: by name; of none if there is
/// no recipe, or none that can be planned.
fn wishes(recipe: &str) -> BTreeMap<String, AlbedoVerdict> {
    let Ok(scene) = Scene::from_recipe_str(recipe) else { return BTreeMap::new() };
    let Ok(plan) = Plan::new(&scene, Options::default()) else { return BTreeMap::new() };
    let names = scene.materials.into_iter().map(|material| material.name);
    names.zip(plan.albedo_verdicts).collect()
}

fn of(
    set: &Tables,
    default: &Tables,
    entry: &MaterialEntry,
    wishes: &BTreeMap<String, AlbedoVerdict>,
) -> Served {
    let [x, y] = entry.lobe.sigmas().map(range);
    let own = entry.lobe.distribution.clone();
    let mut shape = own.unwrap_or_else(|| format!("gamma {}", range(entry.lobe.gamma)));
    if let Some(theta) = entry.lobe.theta {
        shape += &format!(", tilted by theta {}", theta.map(number).join(", "));
    }
    let smooth = entry.lobe.is_smooth();
    Served {
        name: entry.name.clone(),
        sigma: if x == y { x } else { format!("{x} and {y}") },
        shape: if smooth { "-".into() } else { shape },
        masking: if smooth { "-".into() } else { entry.masking().to_string() },
        fresnel: fresnel(entry.fresnel.as_ref()),
        lobe: lobe(set, default, entry),
        albedo: albedo(set, default, entry, wishes.get(&entry.name)),
        bytes: tables_of(set, entry).map(Table::stored_bytes).sum(),
    }
}

/// What serves masking and visible normals.
fn lobe(set: &Tables, default: &Tables, entry: &MaterialEntry) -> Part {
    let covers = |set: &Tables| entry.lobe.s().into_iter().all(|s| set.tabulates(gamma_of_s(s)));
    if entry.lobe.is_smooth() {
        Part::skipped("none: smooth", "no microfacets, σ = 0")
    } else if entry.lobe.distribution.is_some() {
        match set.material(&entry.name) {
            Ok(_) => Part::OWN,
            Err(why) => Part::skipped("none", why.to_string()),
        }
    } else if covers(set) {
        Part::OWN
    } else if entry.lobe.is_ggx() {
        Part::skipped("closed forms of GGX", "GGX has closed forms of D, G1 and visible normals")
    } else if covers(default) {
        let why = "the default set, which is compiled into the sampler, covers it";
        Part::skipped("default set", why)
    } else {
        Part::skipped("none", "neither the set nor the default set covers it")
    }
}

/// What serves its albedo.
fn albedo(
    set: &Tables,
    default: &Tables,
    entry: &MaterialEntry,
    wish: Option<&AlbedoVerdict>,
) -> Part {
    let exact = entry.fresnel.as_ref().is_some_and(is_exact);
    let has = |set: &Tables| match exact {
        true => set.material_fresnel_albedo(&entry.name).is_ok(),
        false => set.material_albedo(&entry.name).is_ok(),
    };
    if entry.lobe.is_smooth() {
        return Part::skipped("none: smooth", "no microfacets, σ = 0");
    }
    if has(set) {
        return Part::OWN;
    }
    let moments = |set: &Tables| {
        let [sigma, gamma] = [entry.lobe.round_sigma(), entry.lobe.gamma()];
        entry.lobe.tabulated() == LobeEntry::Family
            && set.albedo(sigma, gamma, entry.masking()).is_ok()
    };
    let behind = !exact && moments(default);
    let what = if behind { "default set" } else { "none" };
    let why = match wish {
        Some(verdict @ (AlbedoVerdict::NotAsked | AlbedoVerdict::NotCovered(_))) => {
            albedo_reason(verdict)[1].clone().into_owned()
        }
        Some(_) if behind => "left out by the command that baked it; the default set has it".into(),
        Some(_) => "left out by the command that baked it".into(),
        None if behind => "not in the set; the default set has it".into(),
        None => "not in the set".into(),
    };
    Part::skipped(what, why)
}

/// Whether its albedo has a table of its own reflectance.
fn is_exact(fresnel: &FresnelEntry) -> bool {
    fresnel.tabulated().iter().any(|of| *of != Reflectance::Moments)
}

/// The tables of a set that a material reads.
fn tables_of<'a>(
    set: &'a Tables,
    entry: &'a MaterialEntry,
) -> impl Iterator<Item = &'a Table> + 'a {
    let own = entry.lobe.tabulated();
    let is_family = entry.lobe.distribution.is_none() && !entry.lobe.is_smooth();
    let reflectances: Vec<Reflectance> =
        entry.fresnel.as_ref().map_or(vec![Reflectance::Moments], FresnelEntry::tabulated);
    let within = |[low, high]: [f64; 2], x: [f64; 2]| {
        // Ends pass through 1/(γ−1) and through text.
        let slack = 1e-9 * high.abs().max(1e-9);
        low - slack <= x[0] && x[1] <= high + slack
    };
    let middle = [entry.lobe.round_sigma(); 2];
    let reads = move |table: &&Table| {
        let subject = &table.subject;
        let same = !table.kind.is_albedo()
            || (subject.masking == Some(entry.masking())
                && subject.reflectance.as_ref().is_some_and(|of| reads_of(of, &reflectances)));
        let covered = match (&subject.lobe, &subject.covers) {
            (LobeEntry::Family, Some(Covered { s, sigma })) => {
                let lobe = !table.kind.is_albedo() || own == LobeEntry::Family;
                is_family
                    && lobe
                    && within(*s, entry.lobe.s())
                    && sigma.is_none_or(|all| within(all, middle))
            }
            (LobeEntry::Family, None) => false,
            (lobe, _) => *lobe == own && !entry.lobe.is_smooth(),
        };
        same && covered
    };
    set.tables().iter().filter(reads)
}

/// Whether a table of a reflectance serves one of a material's: moments are read for F = 1 as well.
fn reads_of(of: &Reflectance, wanted: &[Reflectance]) -> bool {
    let holds = |wanted: &Reflectance| match (of, wanted) {
        (
            Reflectance::Dielectric { side, min, max },
            Reflectance::Dielectric { side: wanted, min: least, max: most },
        ) => {
            let end = |max: &Option<f64>| max.unwrap_or(f64::INFINITY);
            side == wanted && min <= least && end(most) <= end(max)
        }
        _ => of == wanted,
    };
    *of == Reflectance::Moments || wanted.iter().any(holds)
}
