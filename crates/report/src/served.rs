//! Which tables or closed forms serve each material of a set, and why the set has no table.

use std::collections::BTreeMap;

use microfacet_baker::plan::{AlbedoVerdict, Options, Plan};
use microfacet_baker::scene::{Scene, recipe_of};
use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::Tables;
use microfacet_tables::{MaterialEntry, Reflectance, Table};

use crate::words::material::fresnel;
use crate::words::verdict::albedo_reason;
use crate::words::{number, range};

pub(super) struct Served<'a> {
    pub(super) name: &'a str,
    /// σ, γ or the distribution, masking and the Fresnel term.
    pub(super) words: [String; 4],
    /// Masking and visible normals.
    pub(super) lobe: Part,
    pub(super) albedo: Part,
    pub(super) bytes: usize,
}

/// What serves masking and normals, or the albedo, of a material.
pub(super) struct Part {
    /// In a few words.
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

/// The materials of a set whose materials have one lobe each, as [`by_lobe`](super::by_lobe) makes
/// it.
pub(super) fn served(set: &Tables) -> Vec<Served<'_>> {
    let wishes = wishes(&recipe_of(&set.provenance().materials));
    let default = Tables::embedded();
    let one = |entry| of(set, &default, entry, &wishes);
    set.provenance().materials.iter().map(one).collect()
}

/// The verdicts on albedos in a plan of the set's recipe, by material; empty without a plan.
fn wishes(recipe: &str) -> BTreeMap<String, AlbedoVerdict> {
    let Ok(scene) = Scene::from_recipe_str(recipe) else { return BTreeMap::new() };
    let Ok(plan) = Plan::new(&scene, Options::default()) else { return BTreeMap::new() };
    let names = scene.materials.into_iter().map(|material| material.name);
    names.zip(plan.albedo_verdicts).collect()
}

fn of<'a>(
    set: &Tables,
    default: &Tables,
    entry: &'a MaterialEntry,
    wishes: &BTreeMap<String, AlbedoVerdict>,
) -> Served<'a> {
    let [x, y] = entry.lobe.sigmas().map(range);
    let own = entry.lobe.distribution.clone();
    let mut shape = own.unwrap_or_else(|| format!("gamma {}", range(entry.lobe.gamma)));
    if let Some(theta) = entry.lobe.theta {
        shape += &format!(", tilted by theta {}", theta.map(number).join(", "));
    }
    let mut masking = entry.masking().to_string();
    if entry.lobe.is_smooth() {
        [shape, masking] = ["-", "-"].map(String::from);
    }
    let mut reflectance = fresnel(entry.fresnel.as_ref());
    if entry.is_retroreflecting() {
        reflectance += &format!(", retroreflection {}", range(entry.retroreflection));
    }
    let sigma = if x == y { x } else { format!("{x} and {y}") };
    Served {
        name: &entry.name,
        words: [sigma, shape, masking, reflectance],
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
        entry.lobe.tabulated().is_family() && set.albedo(sigma, gamma, entry.masking()).is_ok()
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
fn is_exact(fresnel: &Reflectance) -> bool {
    fresnel.tabulated().iter().any(|of| *of != Reflectance::Mirror)
}

/// The tables of a set that a material reads.
fn tables_of<'a>(
    set: &'a Tables,
    entry: &'a MaterialEntry,
) -> impl Iterator<Item = &'a Table> + 'a {
    let own = entry.lobe.tabulated();
    // Visible normals are tabulated for the round lobe, and refraction for either.
    let round = entry.lobe.round();
    let reflectances: Vec<Reflectance> =
        entry.fresnel.as_ref().map_or(vec![Reflectance::Mirror], Reflectance::tabulated);
    let reads = move |Table { kind, subject, .. }: &&Table| {
        let same = !kind.is_albedo()
            || (subject.masking == Some(entry.masking())
                && subject.reflectance.as_ref().is_some_and(|of| reads_of(of, &reflectances)));
        let refracts = subject.reflectance.is_some_and(|of| of.side().is_some());
        let is_own = subject.lobe.contains(&own);
        let of_round = (!kind.is_albedo() || refracts) && own.distribution.is_none();
        let is_read =
            if of_round { subject.lobe.contains(&round) || (refracts && is_own) } else { is_own };
        same && !entry.lobe.is_smooth() && is_read
    };
    set.tables().iter().filter(reads)
}

/// Whether a table of reflectance `of` serves one of the wanted; that of F = 1, the moments, does.
fn reads_of(of: &Reflectance, wanted: &[Reflectance]) -> bool {
    *of == Reflectance::Mirror || wanted.iter().any(|wanted| of.contains(wanted))
}
