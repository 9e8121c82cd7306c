//! What a plan does for each material, in words: one home for what `plan` and `bake` say.

use std::collections::BTreeMap;

use microfacet_bake::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec, Domain};
use microfacet_bake::distribution::Distribution;
use microfacet_bake::plan::{AlbedoVerdict, Plan, Verdict};
use microfacet_bake::scene::{Interval, Scene};
use microfacet_bake::table_spec::{Quality, TableSpec, general_set};
use microfacet_sampler::{Precision, Reflectance};

use crate::cli::{escape, words};

/// Said of a scene, or a recipe, for which nothing is baked and no set is written.
pub(in crate::cli) fn nothing(scene: &Scene) -> &'static str {
    if scene.warnings.is_empty() {
        "Nothing to bake: no material in use is rough.\n"
    } else {
        "Nothing to bake: no material in use is rough, in what could be read; the warnings say what \
         is missing.\n"
    }
}

/// Lines of tables that are printed; `--json` has them all.
const SHOWN: usize = 20;

/// Tables of a distribution outside the family.
pub(super) const OWN_TABLES: usize = 4;

/// Columns for what is baked or skipped; a longer name moves its own line only.
const WHAT: usize = 18;

/// Why a material gets no tables of its own, in short and in full.
pub(super) fn reason(verdict: &Verdict) -> [&'static str; 2] {
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

/// Why a material gets no albedo tables, in short and in full.
pub(super) fn albedo_reason(verdict: &AlbedoVerdict) -> [&'static str; 2] {
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

/// The reflectance of an albedo in words.
pub(in crate::cli) fn reflectance(reflectance: &Reflectance) -> String {
    match reflectance {
        Reflectance::Moments => "for F = 1 and every Schlick term".into(),
        Reflectance::Conductor { eta, k } => {
            let [eta, k] = [eta, k].map(|rgb| rgb.map(words::number).join(", "));
            format!("for a conductor with eta {eta} and k {k}")
        }
        Reflectance::Dielectric { side, min, max } => {
            let index = words::range([*min, max.unwrap_or(f64::INFINITY)]);
            format!("for a dielectric of index {index} from its {} side", side.name())
        }
    }
}

fn shapes(Interval { min, max }: Interval) -> String {
    format!("gamma {}", words::range([min, max]))
}

/// A lobe in words: "gamma 3, sigma 0.1 to 0.4".
fn lobe(lobe: &AlbedoLobe) -> String {
    match lobe {
        AlbedoLobe::Family(Domain { gamma, sigma }) => {
            format!("{}, sigma {}", shapes(*gamma), words::range([sigma.min, sigma.max]))
        }
        other => escape::line(&other.label().replace('_', " ")).into(),
    }
}

/// A plan and its scene, with the specifications of all tables.
pub(in crate::cli) struct Outline<'a> {
    pub(in crate::cli) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    /// Tables of each entry of the required shapes.
    pub(super) tables: Vec<Vec<TableSpec>>,
    /// Specification of each required albedo.
    pub(super) albedos: Vec<AlbedoSpec>,
    /// The materials that each of these is for.
    pub(super) users: Users<'a>,
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
                let own = |known: &Distribution| material.distribution.as_ref() == Some(known);
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
    what: String,
    why: &'a str,
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
        Ok(Self { scene, plan, tables, albedos, users: Users::new(scene, plan) })
    }

    /// Specifications of the albedos that are baked.
    pub(in crate::cli) fn albedos(&self) -> &[AlbedoSpec] {
        &self.albedos
    }

    /// Whether the default set serves some material.
    pub(in crate::cli) fn is_embedded(&self) -> bool {
        self.plan.verdicts.contains(&Verdict::Embedded)
    }

    /// Names of the materials, by index, that satisfy a condition.
    fn names(&self, of: impl Fn(usize) -> bool) -> Vec<&'a str> {
        let all = self.scene.materials.iter().enumerate();
        all.filter(|(i, _)| of(*i)).map(|(_, material)| material.name.as_str()).collect()
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
        let mut all = Vec::new();
        for verdict in [Verdict::ClosedForm, Verdict::Embedded, Verdict::NotRough, Verdict::NotUsed]
        {
            let [what, why] = reason(&verdict);
            let names = self.names(|i| self.plan.verdicts[i] == verdict);
            all.push(Skipped { what: what.into(), why, names });
        }
        for verdict in [
            AlbedoVerdict::NotAsked,
            AlbedoVerdict::Imported,
            AlbedoVerdict::Declined,
            AlbedoVerdict::Embedded,
        ] {
            let [what, why] = albedo_reason(&verdict);
            let names = self.names(|i| self.plan.albedo_verdicts[i] == verdict);
            all.push(Skipped { what: format!("albedo, {what}"), why, names });
        }
        let mut ignored: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for material in &self.scene.ignored {
            ignored.entry(&material.reason).or_default().push(&material.name);
        }
        let no_lobe = |(why, names)| Skipped { what: "no lobe".into(), why, names };
        all.extend(ignored.into_iter().map(no_lobe));
        all.retain(|skipped| !skipped.names.is_empty());
        all
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
        for Skipped { what, why, names } in self.skipped() {
            let names = words::list(names.into_iter());
            text += &line(skipped, &what, &format!("{why}: {names}"));
        }
        text
    }
}
