//! What a plan does for each material, in the words of both `plan` and `bake`.

use std::borrow::Cow;
use std::collections::BTreeMap;

use microfacet_baker::bake::albedo::{AlbedoLobe, AlbedoSpec};
use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{
    AlbedoVerdict, AlbedoWish, Cost, Judged, Plan, RequiredShapes, StandIn, Verdict, entry,
};
use microfacet_baker::scene::{Ignored, Scene};
use microfacet_baker::table_set::{BakeError, costs};
use microfacet_baker::table_spec::{Quality, TableSpec, general_set};
use microfacet_report::words::material::{material as words_of, reflectance};
use microfacet_report::words::verdict::{albedo_reason, reason};
use microfacet_tables::{Interval, Precision};
use rayon::current_num_threads;
use serde_json::{Value, json};

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

/// A plan and its scene, with the specifications and costs of all tables.
pub(in crate::cli) struct Outline<'a> {
    pub(in crate::cli) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    /// The parts that are baked, as in [`costs`].
    pub(super) parts: Vec<Part<'a>>,
    /// Of the whole set.
    pub(super) total: Cost,
    /// The tables that `--albedo` would add, and their cost.
    offered: Option<(usize, Cost)>,
}

/// Tables that are baked together, and the materials that they are for.
pub(in crate::cli) struct Part<'a> {
    pub(super) tables: Tables<'a>,
    pub(super) cost: Cost,
    pub(super) names: Vec<&'a str>,
    /// Those of the materials whose own lobes have no such table.
    stand_ins: Vec<(&'a str, StandIn)>,
}

/// The tables of a part.
pub(super) enum Tables<'a> {
    Shapes(&'a RequiredShapes, Vec<TableSpec>),
    Own(&'a Distribution),
    Albedo(Box<AlbedoSpec>),
}

impl Part<'_> {
    fn count(&self) -> usize {
        match &self.tables {
            Tables::Shapes(_, specs) => specs.len(),
            Tables::Own(_) => OWN_TABLES,
            Tables::Albedo(spec) => spec.tables(),
        }
    }

    /// What a part is of, and more on what its tables hold.
    fn what(&self) -> [String; 2] {
        match &self.tables {
            Tables::Shapes(need, _) => [shapes(need.gamma()), String::new()],
            Tables::Own(own) => [escape::line(&own.label()).into(), String::new()],
            Tables::Albedo(spec) => {
                let forms: Vec<&str> = spec.maskings.iter().map(|masking| masking.name()).collect();
                let (lobe, forms) = (lobe(&spec.lobe), forms.join(" and "));
                let of = format!("{lobe}, {forms} masking, {}: ", reflectance(&spec.reflectance));
                ["albedo".into(), of]
            }
        }
    }

    /// The materials that the tables are for, and how far off they are where they stand in.
    fn purpose(&self) -> String {
        if self.names.is_empty() {
            return String::new();
        }
        let all = format!(", for {}", words::list(self.names.iter().copied()));
        let largest = self.stand_ins.iter().map(|(_, of)| of.error).reduce(f64::max);
        largest.map_or(all.clone(), |off| {
            let names = words::list(self.stand_ins.iter().map(|(name, _)| *name));
            format!(
                "{all}; round lobes of sqrt(sigma_x sigma_y) stand in for those of {names}, whose E \
                 may be {off} off"
            )
        })
    }

    /// Bytes and seconds in words; the bytes of tables that may be refined are estimates.
    pub(super) fn cost(&self) -> String {
        let Cost { bytes, seconds } = self.cost;
        let size = match &self.tables {
            Tables::Albedo(spec) if spec.doublings() > 0 => {
                format!("about {}", words::bytes(bytes))
            }
            _ => words::exact_bytes(bytes),
        };
        format!(", {size}, about {}", words::seconds(seconds))
    }
}

/// What the albedos that a plan offers would add to its cost without them.
fn offer(
    plan: &Plan,
    quality: Quality,
    precision: Precision,
    without: Cost,
) -> Option<(usize, Cost)> {
    if plan.offered.is_empty() {
        return None;
    }
    // Albedos that no table can hold are refused when they are requested.
    let specs = plan.offered.iter().map(|need| need.spec(quality, precision));
    let tables = specs.map(|spec| spec.map(|spec| spec.tables())).sum::<Result<_, _>>().ok()?;
    let mut with = plan.clone();
    with.albedos.clone_from(&plan.offered);
    let Cost { bytes, seconds } = costs(&with, quality, precision).ok()?.into_iter().sum();
    let bytes = bytes.saturating_sub(without.bytes);
    let seconds = (seconds - without.seconds).max(0.0);
    Some((tables, Cost { bytes, seconds }))
}

/// Materials for which something is not baked, for the same reason.
struct Skipped<'a> {
    what: Cow<'a, str>,
    why: Cow<'a, str>,
    names: Vec<&'a str>,
}

impl<'a> Outline<'a> {
    /// # Errors
    /// [`BakeError::Albedo`] for an albedo that no table can hold.
    pub(in crate::cli) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        quality: Quality,
        precision: Precision,
    ) -> Result<Self, BakeError> {
        let general = general_set(quality, precision);
        let costs = costs(plan, quality, precision)?;
        let shapes = plan.shapes.iter().map(|need| Ok(Tables::Shapes(need, need.specs(&general))));
        let own = plan.distributions.iter().map(|own| Ok(Tables::Own(own)));
        let albedos = plan.albedos.iter();
        let albedos =
            albedos.map(|need| Ok(Tables::Albedo(Box::new(need.spec(quality, precision)?))));
        let part = |(tables, &cost): (Result<_, BakeError>, &Cost)| {
            Ok(Part { tables: tables?, cost, names: Vec::new(), stand_ins: Vec::new() })
        };
        let parts = shapes.chain(own).chain(albedos).zip(&costs).map(part);
        let mut parts = parts.collect::<Result<Vec<Part<'a>>, BakeError>>()?;
        let first = [plan.shapes.len(), plan.shapes.len() + plan.distributions.len()];
        for Judged { material, part, verdict, albedo, .. } in plan.judged(scene) {
            let own = |known: &Distribution| part.lobe.distribution.as_ref() == Some(known);
            let own = match verdict {
                // A linear search: a scene has a thousand distributions at most.
                Verdict::Own => plan.distributions.iter().position(own).map(|i| first[0] + i),
                _ => None,
            };
            let albedos = match albedo {
                AlbedoVerdict::Bake(all) => &all[..],
                _ => &[],
            };
            let albedos = albedos.iter().map(|i| first[1] + i);
            let name = &material.name[..];
            let stand_in = StandIn::of(&part).map(|it| (name, it));
            for i in verdict.need().into_iter().chain(own).chain(albedos) {
                let Part { tables, names, stand_ins, .. } = &mut parts[i];
                // Both lobes of a material may read them.
                if names.last() != Some(&name) {
                    names.push(name);
                }
                if matches!(tables, Tables::Albedo(spec) if spec.lobe.is_family()) {
                    stand_ins.extend(stand_in);
                }
            }
        }
        let total = costs.into_iter().sum();
        let offered = offer(plan, quality, precision, total);
        Ok(Self { scene, plan, parts, total, offered })
    }

    /// What `--albedo` would add.
    pub(in crate::cli) fn offered(&self) -> Option<Value> {
        self.offered.map(|(tables, cost)| json!({ "tables": tables, "cost": cost }))
    }

    /// Whether albedos are baked.
    pub(in crate::cli) fn has_albedos(&self) -> bool {
        !self.plan.albedos.is_empty()
    }

    /// Whether some material has this verdict.
    pub(in crate::cli) fn has(&self, verdict: &Verdict) -> bool {
        self.plan.verdicts.contains(verdict)
    }

    /// Whether rough materials may be missing: something was not read, or is not covered.
    pub(in crate::cli) fn is_doubtful(&self) -> bool {
        self.scene.doubts().next().is_some() || self.plan.not_covered().next().is_some()
    }

    /// All that is not baked, and why.
    fn skipped(&self) -> Vec<Skipped<'a>> {
        let Self { scene, plan, .. } = self;
        // Sorted by rank, then by the alphabet.
        let mut all: BTreeMap<(usize, [Cow<'a, str>; 2]), Vec<&'a str>> = BTreeMap::new();
        let mut add = |rank, why, name| {
            let names = all.entry((rank, why)).or_default();
            if names.last() != Some(&name) {
                names.push(name);
            }
        };
        for Judged { material, verdict, .. } in plan.judged(scene) {
            if verdict.need().is_none() && *verdict != Verdict::Own {
                add(0, reason(verdict), &material.name[..]);
            }
        }
        for Judged { material, albedo, .. } in plan.judged(scene) {
            let [what, mut why] = albedo_reason(albedo);
            match albedo {
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
        let (tables, Cost { bytes, seconds }) = self.offered?;
        Some(format!(
            "for energy compensation --albedo bakes {}, {} and about {} more; without it only what \
             takes one thread less than {}, and this takes {}",
            words::count(tables, "table"),
            words::bytes(bytes),
            words::seconds(seconds),
            words::seconds(AlbedoWish::QUICK),
            words::seconds(seconds * current_num_threads() as f64)
        ))
    }

    /// A line for each part that is baked, with `detail` of it, and for each reason to bake
    /// nothing; in the words for "baked" and "skipped" of the command.
    pub(in crate::cli) fn lines(
        &self,
        [baked, skipped]: [&str; 2],
        detail: impl Fn(&Part<'_>) -> String,
    ) -> String {
        let verb = baked.len().max(skipped.len());
        let indent = verb + 2 + WHAT + 2;
        let line = |did: &str, what: &str, text: &str| {
            words::wrapped(&format!("{did:verb$}  {what:WHAT$}  "), text, indent)
        };
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
        for part in self.parts.iter().take(SHOWN) {
            let [what, of] = part.what();
            let tables = format!("{of}{}{}", words::count(part.count(), "table"), detail(part));
            text += &line(baked, &what, &(tables + &part.purpose()));
        }
        if let Some(more @ [_, ..]) = self.parts.get(SHOWN..) {
            let tables = words::count(more.iter().map(Part::count).sum(), "table");
            let what = format!("and {} more", more.len());
            text += &line(baked, &what, &format!("{tables}; --json lists all"));
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
