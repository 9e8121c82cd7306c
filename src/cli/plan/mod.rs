//! `plan`: shows what a bake of a scene would do, and why.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use serde_json::json;

use microfacet_bake::bake::albedo::{AlbedoLobe, AlbedoSpec, Domain};
use microfacet_bake::distribution::Distribution;
use microfacet_bake::plan::{
    AlbedoVerdict, Cost, Plan, RequiredShapes, Verdict, albedo_cost, bare_cost, cost,
    distribution_cost, set_cost,
};
use microfacet_bake::scene::{self, Interval, Material, Scene};
use microfacet_bake::table_spec::{TableSpec, general_set};

use microfacet_sampler::Kind;

use super::request::Request;
use super::{Done, Outcome, escape, print, print_json, report};

/// Show what must be baked for a scene and what not, with bytes and seconds.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake plan tables/recipes/gold-series.toml")]
pub(super) struct Args {
    /// A recipe (.toml) or scene (.pbrt, .xml, .gltf, .glb, .mtlx).
    scene: PathBuf,
    #[command(flatten)]
    request: Request,
    /// Print the plan as JSON.
    #[arg(long)]
    json: bool,
}

/// A plan with the figures that are reported on it.
struct Report<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    /// Tables of each entry of the required shapes, and their cost.
    tables: Vec<(Vec<TableSpec>, Cost)>,
    /// Specification and cost of each required albedo.
    albedos: Vec<(AlbedoSpec, Cost)>,
    /// Cost of each distribution outside the family.
    distributions: Vec<Cost>,
    total: Cost,
    general: Cost,
    /// Milliseconds.
    reading: f64,
    planning: f64,
}

pub(super) fn run(args: Args) -> Outcome {
    let start = Instant::now();
    let scene = scene::load(&args.scene)?;
    let reading = start.elapsed();
    scene.warnings.iter().for_each(|warning| report("warning", warning));
    let start = Instant::now();
    let plan = args.request.plan(&scene, None)?;
    let general = general_set(args.request.quality(), args.request.precision());
    let (quality, precision) = (args.request.quality(), args.request.precision());
    let of_need = |spec: AlbedoSpec| {
        let cost = albedo_cost(&spec);
        (spec, cost)
    };
    let albedos = plan.albedos.iter().map(|need| need.spec(quality, precision).map(of_need));
    let albedos = albedos.collect::<Result<Vec<(AlbedoSpec, Cost)>, _>>()?;
    let tables: Vec<(Vec<TableSpec>, Cost)> = plan
        .shapes
        .iter()
        .map(|need| need.specs(&general))
        .map(|specs| {
            let cost = cost(&specs);
            (specs, cost)
        })
        .collect();
    let distributions: Vec<Cost> =
        plan.distributions.iter().map(|own| distribution_cost(own, quality, precision)).collect();
    let total = set_cost(&plan, quality, precision)?;
    let everything = args.request.general_plan();
    let has_albedos = !everything.albedos.is_empty();
    let mut everything = vec![cost(&general), bare_cost(&everything.provenance())];
    if has_albedos {
        everything.push(albedo_cost(&AlbedoSpec::general(quality, precision)));
    }
    let general = everything.into_iter().sum();
    let milliseconds = |time: std::time::Duration| 1e3 * time.as_secs_f64();
    let (reading, planning) = (milliseconds(reading), milliseconds(start.elapsed()));
    let report = Report {
        scene: &scene,
        plan: &plan,
        tables,
        albedos,
        distributions,
        total,
        general,
        reading,
        planning,
    };
    if args.json {
        print_json(&report.json())?
    } else {
        print(&report.text())?
    }
    Ok(Done::Ok)
}

/// Why a material gets no tables of its own, in short and in full.
fn reason(verdict: &Verdict) -> [&'static str; 2] {
    match verdict {
        Verdict::Bake(_) => ["baked", "tables are baked for it"],
        Verdict::Same { .. } => ["same", "another material needs the same tables"],
        Verdict::Within { .. } => {
            ["within", "its gamma lies in a range that is baked for another material"]
        }
        Verdict::ClosedForm => {
            ["closed form", "GGX: D, G1 and visible normals have closed forms; no tables"]
        }
        Verdict::Own => ["own tables", "not a Student-t lobe: tables of its own"],
        Verdict::Embedded => ["embedded", "covered by the default set compiled into the sampler"],
        Verdict::NotRough => ["not rough", "no microfacets"],
        Verdict::NotUsed => ["not used", "no geometry uses it"],
    }
}

fn shapes(gamma: Interval) -> String {
    if gamma.is_point() {
        format!("gamma {}", gamma.min)
    } else {
        format!("gamma {} to {}", gamma.min, gamma.max)
    }
}

/// Why a material gets no albedo tables, in short and in full.
fn albedo_reason(verdict: &AlbedoVerdict) -> [&'static str; 2] {
    match verdict {
        AlbedoVerdict::Bake(_) => ["baked", "albedo tables cover it"],
        AlbedoVerdict::NotAsked => {
            ["no fresnel", "the recipe states no `fresnel`; --albedo bakes albedos for all"]
        }
        AlbedoVerdict::Imported => {
            ["not asked", "only --albedo bakes albedos for scenes other than recipes"]
        }
        AlbedoVerdict::Declined => ["declined", "--no-albedo"],
        AlbedoVerdict::Embedded => {
            ["embedded", "the default set compiled into the sampler has its albedo"]
        }
        AlbedoVerdict::NotNeeded => ["not needed", "it gets no tables at all"],
    }
}

/// A domain in words: "gamma 3, sigma 0.1 to 0.4".
fn domain(Domain { gamma, sigma }: Domain) -> String {
    // Means of anisotropic roughnesses have many digits.
    let number = |x: f64| format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
    let end = if sigma.is_point() { String::new() } else { format!(" to {}", number(sigma.max)) };
    format!("{}, sigma {}{end}", shapes(gamma), number(sigma.min))
}

/// A lobe in words.
fn lobe(lobe: &AlbedoLobe) -> String {
    match lobe {
        AlbedoLobe::Family(covered) => domain(*covered),
        other => escape::line(&other.label().replace('_', " ")).into(),
    }
}

/// The first few of a list of names.
fn list<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 4;
    let more = names.len().saturating_sub(SHOWN);
    let mut shown: Vec<String> =
        names.take(SHOWN).map(|name| format!("\"{}\"", escape::line(name))).collect();
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    shown.join(", ")
}

impl Report<'_> {
    /// Names of the materials whose verdict satisfies a condition.
    fn names(&self, of: impl Fn(&Verdict) -> bool) -> Vec<&str> {
        let pairs = self.scene.materials.iter().zip(&self.plan.verdicts);
        pairs
            .filter(|(_, verdict)| of(verdict))
            .map(|(material, _)| material.name.as_str())
            .collect()
    }

    /// Names of the materials in use that have a distribution outside the family.
    fn wearers(&self, distribution: &Distribution) -> Vec<&str> {
        let pairs = self.scene.materials.iter().zip(&self.plan.verdicts);
        let wears = |material: &Material| material.distribution.as_ref() == Some(distribution);
        let theirs =
            pairs.filter(|(material, verdict)| **verdict == Verdict::Own && wears(material));
        theirs.map(|(material, _)| material.name.as_str()).collect()
    }

    /// Names of the materials whose albedo has such a verdict.
    fn albedo_names(&self, of: impl Fn(&AlbedoVerdict) -> bool) -> Vec<&str> {
        let pairs = self.scene.materials.iter().zip(&self.plan.albedo_verdicts);
        pairs
            .filter(|(_, verdict)| of(verdict))
            .map(|(material, _)| material.name.as_str())
            .collect()
    }

    /// Names of the materials that albedo tables serve.
    fn served(&self, need: usize) -> Vec<&str> {
        self.albedo_names(
            |verdict| matches!(verdict, AlbedoVerdict::Bake(needs) if needs.contains(&need)),
        )
    }

    fn albedo_text(&self) -> String {
        let mut text = String::new();
        for (i, (spec, cost)) in self.albedos.iter().enumerate() {
            let forms: Vec<&str> = spec.maskings.iter().map(|masking| masking.name()).collect();
            let reflectance = spec.reflectance.label().replace('_', " ");
            let tables = spec.tables();
            text += &format!(
                "bake  albedo, {reflectance}, {}, {}: {tables} table{}, {} bytes{}, about {:.3} s, for {}\n",
                lobe(&spec.lobe),
                forms.join(" and "),
                if tables == 1 { "" } else { "s" },
                cost.bytes,
                if spec.doublings() > 0 { " at least" } else { "" },
                cost.seconds,
                list(self.served(i).into_iter()),
            );
        }
        for verdict in [
            AlbedoVerdict::NotAsked,
            AlbedoVerdict::Imported,
            AlbedoVerdict::Declined,
            AlbedoVerdict::Embedded,
        ] {
            let names = self.albedo_names(|other| *other == verdict);
            if !names.is_empty() {
                let [short, long] = albedo_reason(&verdict);
                text += &format!(
                    "skip  {:22} {long}: {}\n",
                    format!("albedo, {short}"),
                    list(names.into_iter())
                );
            }
        }
        text
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (i, (need, (specs, cost))) in self.plan.shapes.iter().zip(&self.tables).enumerate() {
            let names = self.names(|verdict| verdict.need() == Some(i));
            text += &format!(
                "bake  {:22} {} tables, {} bytes, about {:.3} s, for {}\n",
                shapes(need.gamma()),
                specs.len(),
                cost.bytes,
                cost.seconds,
                list(names.into_iter())
            );
        }
        for (distribution, cost) in self.plan.distributions.iter().zip(&self.distributions) {
            text += &format!(
                "bake  {:22} 4 tables, {} bytes, about {:.3} s, for {}\n",
                escape::line(&distribution.label()),
                cost.bytes,
                cost.seconds,
                list(self.wearers(distribution).into_iter())
            );
        }
        for verdict in [Verdict::ClosedForm, Verdict::Embedded, Verdict::NotRough, Verdict::NotUsed]
        {
            let names = self.names(|other| *other == verdict);
            if !names.is_empty() {
                let [short, long] = reason(&verdict);
                text += &format!("skip  {short:22} {long}: {}\n", list(names.into_iter()));
            }
        }
        text += &self.albedo_text();
        let mut ignored: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for material in &self.scene.ignored {
            ignored.entry(material.reason).or_default().push(&material.name);
        }
        for (reason, names) in ignored {
            text += &format!("skip  {:22} {reason}: {}\n", "no lobe", list(names.into_iter()));
        }
        let (total, general) = (self.total, self.general);
        text += &if self.plan.is_empty() {
            "Nothing to bake: no material in use is rough.\n".into()
        } else {
            let share = if total.seconds > 0.0 {
                format!("{:.1} times faster", general.seconds / total.seconds)
            } else {
                "and nothing to bake".into()
            };
            let share = format!(
                "; {:.1} times smaller, {share}",
                general.bytes as f64 / total.bytes as f64
            );
            format!(
                "total {} bytes, about {:.3} s; the general set {} bytes, about {:.3} s{share}\n",
                total.bytes, total.seconds, general.bytes, general.seconds
            )
        };
        text + &format!(
            "materials: {}, read in {:.1} ms, planned in {:.1} ms\n",
            self.scene.materials.len() + self.scene.ignored.len(),
            self.reading,
            self.planning
        )
    }

    fn json(&self) -> serde_json::Value {
        let cost = |cost: &Cost| json!({ "bytes": cost.bytes, "seconds": cost.seconds });
        // JSON has no infinity.
        let ends = |need: &RequiredShapes| json!({ "gamma": [need.gamma().min.to_string(), need.gamma().max.to_string()], "s": need.s() });
        let needs: Vec<_> = self.plan.shapes.iter().zip(&self.tables).enumerate().map(|(i, (need, (specs, sum)))| {
            let tables: Vec<_> = specs
                .iter()
                .map(|spec| json!({ "name": spec.name, "kind": spec.kind.name(), "shapes": spec.shapes.nodes.len(), "views": spec.views, "numbers": spec.numbers }))
                .collect();
            json!({ "shapes": ends(need), "tables": tables, "cost": cost(sum), "materials": self.names(|verdict| verdict.need() == Some(i)) })
        }).collect();
        let albedos: Vec<_> = self.albedos.iter().enumerate().map(|(i, (spec, sum))| {
            let names: Vec<_> = spec.maskings.iter().map(|&masking| spec.name(Kind::Albedo, masking)).collect();
            let nodes: Vec<_> = spec.axes.iter().map(|axis| json!({ "name": axis.name, "length": axis.len() })).collect();
            let covers = if let AlbedoLobe::Family(domain) = &spec.lobe { Some(domain.covered()) } else { None };
            json!({
                "names": names, "lobe": spec.lobe.entry(), "covers": covers, "masking": spec.maskings, "reflectance": spec.reflectance,
                "axes": nodes, "cost": cost(sum), "materials": self.served(i),
            })
        }).collect();
        let distributions: Vec<_> = self
            .plan
            .distributions
            .iter()
            .zip(&self.distributions)
            .map(|(distribution, sum)| {
                json!({ "distribution": distribution.label(), "tables": 4, "cost": cost(sum), "materials": self.wearers(distribution) })
            })
            .collect();
        let verdicts = self.plan.verdicts.iter().zip(&self.plan.albedo_verdicts);
        let materials: Vec<_> = self
            .scene
            .materials
            .iter()
            .zip(verdicts)
            .map(|(material, (verdict, albedo))| {
                let [short, long] = reason(verdict);
                let other = match *verdict {
                    Verdict::Same { as_material: i, .. } | Verdict::Within { of_material: i, .. } => {
                        Some(&self.scene.materials[i].name)
                    }
                    _ => None,
                };
                json!({ "name": material.name, "verdict": short, "why": long, "need": verdict.need(), "shares_with": other,
                        "albedo": albedo_reason(albedo) })
            })
            .collect();
        let ignored: Vec<_> = self
            .scene
            .ignored
            .iter()
            .map(|material| json!({ "name": material.name, "kind": material.kind, "why": material.reason }))
            .collect();
        json!({
            "needs": needs, "distributions": distributions, "albedo": albedos, "materials": materials, "ignored": ignored, "nothing_needed": self.plan.is_empty(),
            "total": cost(&self.total), "general_set": cost(&self.general),
            "milliseconds": { "reading": self.reading, "planning": self.planning },
        })
    }
}
