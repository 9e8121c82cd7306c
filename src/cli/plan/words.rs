//! What a plan does for each material, in words: one home for what `plan` and `bake` say.

use std::borrow::Cow;
use std::collections::BTreeMap;

use microfacet_baker::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec};
use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{
    AlbedoVerdict, AlbedoWish, Cost, Plan, Verdict, albedo_costs, bare_cost, entry,
};
use microfacet_baker::scene::{Ignored, Scene};
use microfacet_baker::table_spec::{Quality, TableSpec, general_set};
use microfacet_report::words::material::{material as words_of, reflectance};
use microfacet_report::words::verdict::{albedo_reason, reason};
use microfacet_tables::{Interval, Precision};
use rayon::current_num_threads;
use serde_json::json;

use crate::cli::{escape, words};

/// Lines of materials, and of tables that are printed; `--json` has them all.
const SHOWN: usize = 20;

/// Tables of a distribution outside the family.
pub(super) const OWN_TABLES: usize = 4;

/// Columns for what is baked or skipped; a longer name moves its own line only.
const WHAT: usize = 18;

fn shapes(Interval { min, max }: Interval) -> String {
    format!("gamma {}", words::range([min, max]))
}

/// A lobe in words: "gamma 3, sigma 0.1 to 0.4".
fn lobe(lobe: &AlbedoLobe) -> String {
    if let Some(distribution) = &lobe.distribution {
        return escape::line(&distribution.label()).into();
    }
    let [x, y] = lobe.sigmas().map(words::range);
    let sigma = if lobe.is_family() { x } else { format!("{x} and {y}") };
    let theta = lobe.theta.map(|theta| format!(", theta {}", theta.map(words::number).join(", ")));
    format!("{}, sigma {sigma}{}", shapes(lobe.gamma), theta.unwrap_or_default())
}

/// A plan and its scene, with the specifications of all tables.
pub(in crate::cli) struct Outline<'a> {
    pub(in crate::cli) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    /// Tables of each entry of the required shapes.
    pub(super) tables: Vec<Vec<TableSpec>>,
    /// Specification of each required albedo.
    pub(super) albedos: Vec<AlbedoSpec>,
    /// The albedos that `--albedo` would add.
    pub(super) offered: Option<Offer>,
    /// The materials that each of these is for.
    pub(super) users: Users<'a>,
}

/// Tables that are not baked unless they are asked for.
pub(super) struct Offer {
    pub(super) tables: usize,
    pub(super) cost: Cost,
}

impl Offer {
    /// What the plan offers, if anything.
    fn of(plan: &Plan, quality: Quality, precision: Precision) -> Option<Self> {
        // What no table can hold is refused where it is asked for.
        let specs: Result<Vec<AlbedoSpec>, _> =
            plan.offered.iter().map(|need| need.spec(quality, precision)).collect();
        let specs = specs.ok().filter(|specs| !specs.is_empty())?;
        let tables = specs.iter().map(AlbedoSpec::tables).sum();
        let mut cost: Cost = albedo_costs(&specs).into_iter().sum();
        // The set describes albedos once it has any.
        let with = Plan { albedos: plan.offered.clone(), ..plan.clone() };
        let described = |plan: &Plan| bare_cost(&plan.provenance()).bytes;
        cost.bytes += described(&with).saturating_sub(described(plan));
        Some(Self { tables, cost })
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let Self { tables, cost: Cost { bytes, seconds } } = self;
        json!({ "tables": tables, "cost": { "bytes": bytes, "seconds": seconds } })
    }
}

/// Names of the materials that tables are for, in the order of the scene.
pub(super) struct Users<'a> {
    /// Of each entry of the required shapes.
    pub(super) shapes: Vec<Vec<&'a str>>,
    /// Of each distribution outside the family.
    pub(super) distributions: Vec<Vec<&'a str>>,
    /// Of each required albedo.
    pub(super) albedos: Vec<Vec<&'a str>>,
}

impl<'a> Users<'a> {
    fn new(scene: &'a Scene, plan: &Plan) -> Self {
        let none = |parts: usize| vec![Vec::new(); parts];
        let mut users = Self {
            shapes: none(plan.shapes.len()),
            distributions: none(plan.distributions.len()),
            albedos: none(plan.albedos.len()),
        };
        let verdicts = plan.verdicts.iter().zip(&plan.albedo_verdicts);
        for (material, (verdict, albedo)) in scene.materials.iter().zip(verdicts) {
            let name = material.name.as_str();
            if let Some(need) = verdict.need() {
                users.shapes[need].push(name);
            }
            if *verdict == Verdict::Own {
                // A scene has a thousand distributions at most.
                let own = |known: &Distribution| material.lobe.distribution.as_ref() == Some(known);
                if let Some(i) = plan.distributions.iter().position(own) {
                    users.distributions[i].push(name);
                }
            }
            if let AlbedoVerdict::Bake(all) = albedo {
                all.iter().for_each(|&i| users.albedos[i].push(name));
            }
        }
        users
    }
}

/// Tables that are baked together, and the materials that they are for.
struct Part<'a> {
    what: String,
    /// More on what they hold.
    of: String,
    names: &'a [&'a str],
}

/// Materials for which something is not baked, for the same reason.
struct Skipped<'a> {
    what: Cow<'a, str>,
    why: Cow<'a, str>,
    names: Vec<&'a str>,
}

impl<'a> Outline<'a> {
    /// # Errors
    /// [`AlbedoError`] for an albedo that no table can hold.
    pub(in crate::cli) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        quality: Quality,
        precision: Precision,
    ) -> Result<Self, AlbedoError> {
        let general = general_set(quality, precision);
        let tables = plan.shapes.iter().map(|need| need.specs(&general)).collect();
        let albedos = plan.albedos.iter().map(|need| need.spec(quality, precision));
        let albedos = albedos.collect::<Result<_, _>>()?;
        let offered = Offer::of(plan, quality, precision);
        Ok(Self { scene, plan, tables, albedos, offered, users: Users::new(scene, plan) })
    }

    /// Specifications of the albedos that are baked.
    pub(in crate::cli) fn albedos(&self) -> &[AlbedoSpec] {
        &self.albedos
    }

    /// Whether some material has this verdict.
    pub(in crate::cli) fn has(&self, verdict: &Verdict) -> bool {
        self.plan.verdicts.contains(verdict)
    }

    /// Whether rough materials may be missing: something was not read, or is not covered.
    pub(in crate::cli) fn is_doubtful(&self) -> bool {
        self.scene.doubts().next().is_some() || self.plan.not_covered().next().is_some()
    }

    /// Numbers of tables of all parts that are baked: required shapes, distributions, albedos.
    fn counts(&self) -> Vec<usize> {
        let normals = self.tables.iter().map(Vec::len);
        let own = self.plan.distributions.iter().map(|_| OWN_TABLES);
        normals.chain(own).chain(self.albedos.iter().map(AlbedoSpec::tables)).collect()
    }

    /// The same parts, each put into words when it is asked for: there may be very many.
    fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let users = &self.users;
        let normals = self.plan.shapes.iter().zip(&users.shapes);
        let normals = normals.map(|(need, names)| Part {
            what: shapes(need.gamma()),
            of: String::new(),
            names,
        });
        let own = self.plan.distributions.iter().zip(&users.distributions);
        let own = own.map(|(own, names)| Part {
            what: escape::line(&own.label()).into(),
            of: String::new(),
            names,
        });
        let albedos = self.albedos.iter().zip(&users.albedos).map(|(spec, names)| {
            let forms: Vec<&str> = spec.maskings.iter().map(|masking| masking.name()).collect();
            let (lobe, forms) = (lobe(&spec.lobe), forms.join(" and "));
            let of = format!("{lobe}, {forms} masking, {}: ", reflectance(&spec.reflectance));
            Part { what: "albedo".into(), of, names }
        });
        normals.chain(own).chain(albedos)
    }

    /// All that is not baked, and why.
    fn skipped(&self) -> Vec<Skipped<'a>> {
        let Self { scene, plan, .. } = self;
        // In this order, and then by the alphabet.
        let mut all: BTreeMap<(usize, [Cow<'a, str>; 2]), Vec<&'a str>> = BTreeMap::new();
        let mut add = |rank, why, name| all.entry((rank, why)).or_default().push(name);
        for (material, verdict) in scene.materials.iter().zip(&plan.verdicts) {
            if verdict.need().is_none() && *verdict != Verdict::Own {
                add(0, reason(verdict), &material.name[..]);
            }
        }
        for (material, verdict) in scene.materials.iter().zip(&plan.albedo_verdicts) {
            let [what, mut why] = albedo_reason(verdict);
            match verdict {
                AlbedoVerdict::Bake(_) | AlbedoVerdict::NotNeeded => continue,
                AlbedoVerdict::Imported => why = self.offer().map_or(why, Cow::from),
                _ => {}
            }
            add(1, [format!("albedo, {what}").into(), why], &material.name);
        }
        for Ignored { name, reason, understood, .. } in &scene.ignored {
            let what = if *understood { "no lobe" } else { "not understood" };
            add(2, [what.into(), reason.as_ref().into()], name);
        }
        all.into_iter().map(|((_, [what, why]), names)| Skipped { what, why, names }).collect()
    }

    /// What `--albedo` would add, if it is known and more than is baked.
    fn offer(&self) -> Option<String> {
        let Offer { tables, cost } = self.offered.as_ref()?;
        Some(format!(
            "for energy compensation --albedo bakes {}, {} and about {} more; without it only what \
             takes one thread less than {}, and this takes {}",
            words::count(*tables, "table"),
            words::bytes(cost.bytes),
            words::seconds(cost.seconds),
            words::seconds(AlbedoWish::QUICK),
            words::seconds(cost.seconds * current_num_threads() as f64)
        ))
    }

    /// A line for each part that is baked, with `detail` of it, and for each reason to bake
    /// nothing; in the words for "baked" and "skipped" of the command.
    pub(in crate::cli) fn lines(
        &self,
        [baked, skipped]: [&str; 2],
        detail: impl Fn(usize) -> String,
    ) -> String {
        let verb = baked.len().max(skipped.len());
        let indent = verb + 2 + WHAT + 2;
        let line = |did: &str, what: &str, text: &str| {
            words::wrapped(&format!("{did:verb$}  {what:WHAT$}  "), text, indent)
        };
        let counts = self.counts();
        let mut text = String::new();
        let materials = &self.scene.materials;
        for material in materials.iter().take(SHOWN) {
            text += &line(
                "has",
                &escape::line(&material.name),
                &escape::line(&words_of(&entry(material))),
            );
        }
        if let Some(more @ [_, ..]) = materials.get(SHOWN..) {
            let more = format!("and {} more", more.len());
            text += &line("has", &more, "--json lists all");
        }
        for (i, (part, tables)) in self.parts().zip(&counts).take(SHOWN).enumerate() {
            let tables = format!("{}{}{}", part.of, words::count(*tables, "table"), detail(i));
            let names = match part.names {
                [] => String::new(),
                names => format!(", for {}", words::list(names.iter().copied())),
            };
            text += &line(baked, &part.what, &(tables + &names));
        }
        if let Some(more @ [_, ..]) = counts.get(SHOWN..) {
            let tables = more.iter().sum();
            let tables = format!("{}; --json lists all", words::count(tables, "table"));
            text += &line(baked, &format!("and {} more", more.len()), &tables);
        }
        let all = self.skipped();
        for Skipped { what, why, names } in all.iter().take(SHOWN) {
            let (why, names) = (escape::line(why), words::list(names.iter().copied()));
            text += &line(skipped, what, &format!("{why}: {names}"));
        }
        if let Some(more @ [_, ..]) = all.get(SHOWN..) {
            let names: usize = more.iter().map(|skipped| skipped.names.len()).sum();
            let why = format!("{}; --json lists all", words::count(names, "material"));
            text += &line(skipped, &format!("and {} more", more.len()), &why);
        }
        text
    }
}
