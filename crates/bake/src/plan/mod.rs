//! Plans the tables to bake for a scene, as few as possible.
//!
//! Tables of visible normals have no σ axis (slopes are divided by σ before a lookup), so a
//! material requires only its shape γ: one γ is a slice, 1D for masking and the slope across, 2D
//! for the in-plane slope; a range of γ is a sub-range of the general set. Albedos do depend on σ,
//! and are baked for materials that ask for them.

mod albedo;
mod cost;
mod judged;
mod key;
mod part;
mod provenance;
mod required_shapes;
mod stand_in;

pub use albedo::{AlbedoVerdict, AlbedoWish, RequiredAlbedo};
pub(crate) use cost::{AlbedoWork, Known, bare_bytes, growth, normals_work, radial_work};
pub use cost::{Cost, on_threads, place_seconds, point_seconds};
pub use judged::Judged;
pub use required_shapes::RequiredShapes;
pub use stand_in::StandIn;

use self::part::Part;

use microfacet_sampler::{Ellipsoid, StudentT};
use microfacet_tables::{Interval, LobeSpec, MaterialEntry, Roughness};

use crate::distribution::Distribution;
use crate::scene::{Format, Material, Scene};
use crate::table_spec::{GAMMA_MIN, Quality};
use microfacet_tables::SIGMA_MAX;

const GGX: f64 = 2.0;

/// Options of a plan: what the renderer has at run time already, and which albedos to bake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Tabulate GGX as well, for a renderer without its closed forms.
    pub tabulate_ggx: bool,
    /// The default set is compiled in and accurate enough.
    pub embedded: bool,
    /// The default set also holds albedo tables that are accurate enough.
    pub embedded_albedo: bool,
    /// Which materials get albedo tables.
    pub albedo: AlbedoWish,
    /// The quality at which [`AlbedoWish::Auto`] estimates how long albedos take.
    pub quality: Quality,
    /// Refuse a scene of another format if no table covers one of its materials, as a recipe is
    /// refused; otherwise only that material is left out.
    pub strict: bool,
}

/// The decision of the plan on a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Tables are baked for it: an index into [`Plan::shapes`].
    Bake(usize),
    /// Tables that are baked for another material serve it too.
    Same {
        /// Index into [`Plan::shapes`].
        need: usize,
        /// Index of the other material.
        as_material: usize,
    },
    /// Its γ lies in a range that is baked for another material.
    Within {
        /// Index into [`Plan::shapes`].
        need: usize,
        /// Index of the other material.
        of_material: usize,
    },
    /// GGX, of which D, G1 and visible normals have closed forms, which the sampler crate uses
    /// where there is no table.
    ClosedForm,
    /// It is not a Student-t lobe: tables of its own are baked for it.
    Own,
    /// The default set that is compiled into the sampler crate covers it.
    Embedded,
    /// It has no microfacets.
    NotRough,
    /// No geometry uses it.
    NotUsed,
    /// No table and no closed form covers it.
    NotCovered(NotCovered),
}

impl Verdict {
    /// The index of the required shapes that cover the material, if any do.
    pub fn need(&self) -> Option<usize> {
        match *self {
            Self::Bake(need) | Self::Same { need, .. } | Self::Within { need, .. } => Some(need),
            _ => None,
        }
    }
}

/// The tables to bake for a scene, with a verdict for each material.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// Disjoint required shapes, from Beckmann to heavy tails: the ranges first, then the single
    /// shapes.
    pub shapes: Vec<RequiredShapes>,
    /// Distributions outside the family that materials have, each once.
    pub distributions: Vec<Distribution>,
    /// One verdict for each lobe of the scene's materials, in order: of a material with a haze one
    /// for its core, then one for the haze. [`judged`](Self::judged) pairs them.
    pub verdicts: Vec<Verdict>,
    /// The albedos that tables are to cover.
    pub albedos: Vec<RequiredAlbedo>,
    /// One verdict on the albedo of each lobe, in the same order.
    pub albedo_verdicts: Vec<AlbedoVerdict>,
    /// The albedos that [`AlbedoWish::Auto`] leaves out because they would take long.
    pub offered: Vec<RequiredAlbedo>,
    /// The scene's materials as the set lists them; empty for the general set.
    pub materials: Vec<MaterialEntry>,
}

impl Plan {
    /// The plan of the general set: all γ that tables cover, and all σ that albedo tables cover.
    pub fn general() -> Self {
        Self {
            shapes: vec![RequiredShapes::general()],
            albedos: vec![RequiredAlbedo::general()],
            ..Self::default()
        }
    }

    /// The plan of the default set, which is compiled into the sampler: the general set, and
    /// albedos of common glass.
    pub fn default_set() -> Self {
        let mut plan = Self::general();
        plan.albedos.extend(RequiredAlbedo::common_glass());
        plan
    }

    /// The plan of a scene.
    ///
    /// # Errors
    /// [`NotCovered`] for more albedos than are planned; also, if the material is of a recipe or
    /// with [`Options::strict`], for a γ that no table covers, a σ that no lobe can have, or a σ
    /// that no albedo table covers if an albedo is asked for.
    pub fn new(scene: &Scene, options: Options) -> Result<Self, NotCovered> {
        let lobes = part::parts(scene);
        let wants: Vec<Result<Interval, Verdict>> =
            lobes.iter().map(|part| want(part, options)).collect::<Result<_, _>>()?;
        let mut needs = required_shapes::disjoint(wants.iter().flatten().copied());
        if let Some(range) = required_shapes::cheaper_range(&needs) {
            needs = required_shapes::disjoint(wants.iter().flatten().copied().chain([range]));
        }
        let find = |want: &Interval| {
            required_shapes::find(&needs, *want).expect("the needs cover every want")
        };
        // A range is baked for the first material that asks for exactly that range, else for the
        // first inside.
        let mut owner: Vec<Option<usize>> = vec![None; needs.len()];
        for exact in [true, false] {
            for (i, want) in wants.iter().enumerate() {
                let Ok(want) = want else { continue };
                let need = find(want);
                if owner[need].is_none() && (!exact || needs[need].gamma() == *want) {
                    owner[need] = Some(i);
                }
            }
        }
        let within = |need: usize, i: usize, want: &Interval| match owner[need] {
            Some(other) if other == i => Verdict::Bake(need),
            Some(other) if wants[other] == Ok(*want) => {
                Verdict::Same { need, as_material: lobes[other].material }
            }
            other => Verdict::Within { need, of_material: lobes[other.unwrap_or(i)].material },
        };
        let verdict = |(i, want): (usize, &Result<Interval, Verdict>)| match want {
            Ok(want) => within(find(want), i, want),
            // Where a table covers γ = 2 anyway, the sampler reads it.
            Err(Verdict::ClosedForm) => match required_shapes::find(&needs, Interval::point(GGX)) {
                Some(need) => within(need, i, &Interval::point(GGX)),
                None => Verdict::ClosedForm,
            },
            Err(verdict) => verdict.clone(),
        };
        let verdicts = wants.iter().enumerate().map(verdict).collect();
        let ((albedos, albedo_verdicts), offered) = albedo::required(&lobes, options)?;
        let distributions = distributions(&lobes);
        // A material with a haze is listed whole or not at all.
        let listed = lobes.iter().filter(|part| !part.is_haze && part.is_listed());
        let materials = listed.map(|part| entry(&scene.materials[part.material])).collect();
        Ok(Self {
            shapes: needs,
            distributions,
            verdicts,
            albedos,
            albedo_verdicts,
            offered,
            materials,
        })
    }

    /// Why materials, and the albedos of materials, are not covered.
    pub fn not_covered(&self) -> impl Iterator<Item = &NotCovered> {
        let mut last = None;
        let lobes = self.verdicts.iter().filter_map(|verdict| match verdict {
            Verdict::NotCovered(why) => Some(why),
            _ => None,
        });
        // Both lobes of a material have the reason of one of them.
        let lobes = lobes.filter(move |why| last.replace(*why) != Some(*why));
        let albedos = self.albedo_verdicts.iter().filter_map(|verdict| match verdict {
            AlbedoVerdict::NotCovered(why) => Some(why),
            _ => None,
        });
        lobes.chain(albedos)
    }

    /// Whether it needs no tables.
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty() && self.distributions.is_empty() && self.albedos.is_empty()
    }

    /// Whether closed forms serve some material.
    pub fn has_closed_forms(&self) -> bool {
        self.verdicts.contains(&Verdict::ClosedForm)
    }
}

/// The range of γ that a lobe requires tables for, or the reason why it requires none.
fn want(part: &Part<'_>, options: Options) -> Result<Result<Interval, Verdict>, NotCovered> {
    let Material { lobe, used, .. } = &*part.of;
    if !used {
        return Ok(Err(Verdict::NotUsed));
    }
    if !is_rough(lobe) {
        return Ok(Err(Verdict::NotRough));
    }
    if let Some(why) = part.uncovered.clone() {
        return refusal(&part.of, options, why).map(|why| Err(Verdict::NotCovered(why)));
    }
    if lobe.distribution.is_some() {
        return Ok(Err(Verdict::Own));
    }
    // Ellipsoids have no closed form at γ = 2 in the sampler crate, which reads tables for them.
    if lobe.gamma == Interval::point(GGX) && !options.tabulate_ggx && lobe.theta.is_none() {
        return Ok(Err(Verdict::ClosedForm));
    }
    Ok(if options.embedded { Err(Verdict::Embedded) } else { Ok(lobe.gamma) })
}

/// Why neither tables nor closed forms cover a rough lobe of a material, if they do not.
fn not_covered(lobe: &LobeSpec<Distribution>, material: &str) -> Option<NotCovered> {
    let (range, name) = (lobe_sigmas(lobe), || material.to_owned());
    for sigma in lobe.sigmas().map(|sigma| sigma.max) {
        if !(range[0]..=range[1]).contains(&sigma) {
            return Some(NotCovered::Lobe { material: name(), sigma, range });
        }
    }
    let gamma = lobe.gamma.min;
    let outside = lobe.distribution.is_none() && gamma < GAMMA_MIN;
    outside.then(|| NotCovered::Gamma { material: name(), gamma })
}

/// The reason as a value if the rest of the scene is planned without the material, as an error if
/// it is not: a recipe asks for each of its materials, a scene of another format does not.
fn refusal(
    material: &Material,
    options: Options,
    why: NotCovered,
) -> Result<NotCovered, NotCovered> {
    let refuses = options.strict || material.origin.format == Format::Recipe;
    if refuses { Err(why) } else { Ok(why) }
}

fn distributions(lobes: &[Part<'_>]) -> Vec<Distribution> {
    let tabulated = lobes.iter().filter(|part| part.is_tabulated());
    let all = tabulated.filter_map(|part| part.of.lobe.distribution.as_ref());
    key::distinct(all, |all| all.label()).into_iter().cloned().collect()
}

/// Whether there are microfacets at any point of the surface.
fn is_rough(lobe: &LobeSpec<Distribution>) -> bool {
    let [least, _] = lobe_sigmas(lobe);
    let [x, y] = lobe.sigmas().map(|sigma| sigma.max);
    x > 0.0 && y > 0.0 && x.max(y) >= least
}

/// The smallest and the largest σ that a lobe can have.
fn lobe_sigmas(lobe: &LobeSpec<Distribution>) -> [f64; 2] {
    if lobe.theta.is_some() { Ellipsoid::SIGMAS } else { StudentT::SIGMAS }
}

/// A material as a set lists it: σ is 0 of a lobe without microfacets.
pub fn entry(material: &Material) -> MaterialEntry {
    let smooth = |lobe: &LobeSpec<Distribution>| {
        (!is_rough(lobe)).then(|| LobeSpec::family(Roughness::Smooth, lobe.gamma))
    };
    let mut entry = material.entry();
    if let Some(lobe) = smooth(&material.lobe) {
        entry.lobe = lobe;
    }
    if let (Some(haze), Some(of)) = (&mut entry.haze, &material.haze)
        && let Some(lobe) = smooth(&of.lobe)
    {
        haze.lobe = lobe;
    }
    entry
}

/// A material that tables cannot cover.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}", self.named(), self.reason())]
pub enum NotCovered {
    /// γ below [`GAMMA_MIN`].
    Gamma {
        /// Name of the material.
        material: String,
        /// Its γ.
        gamma: f64,
    },
    /// A σ, along one axis or both, that a lobe in single precision cannot have.
    Lobe {
        /// Name of the material.
        material: String,
        /// Its largest σ along that axis.
        sigma: f64,
        /// The σ that a lobe can have.
        range: [f64; 2],
    },
    /// An albedo for σ above [`SIGMA_MAX`].
    Sigma {
        /// Name of the material.
        material: String,
        /// Its σ.
        sigma: f64,
        /// Whether that is √(σx σy), of the round lobe that stands in for its own.
        is_mean: bool,
    },
    /// More tables of albedos than are planned.
    Albedos {
        /// The largest number that is planned.
        most: usize,
    },
}

impl NotCovered {
    /// The material that is not covered; `None` if the whole scene is not.
    pub fn material(&self) -> Option<&str> {
        match self {
            Self::Gamma { material, .. }
            | Self::Lobe { material, .. }
            | Self::Sigma { material, .. } => Some(material),
            Self::Albedos { .. } => None,
        }
    }

    /// Why it is not covered, and the remedy, without the name of the material.
    pub fn reason(&self) -> String {
        match self {
            Self::Gamma { gamma, .. } => format!(
                "gamma = {gamma} is below {GAMMA_MIN}, the smallest shape that tables cover; raise it, or sample it with the \
                 model's exact sampler"
            ),
            Self::Lobe { sigma, range: [low, high], .. } => format!(
                "sigma = {sigma:?} along one axis is outside [{low:e}, {high:e}], the roughness that a lobe can have; clamp it, \
                 or write sigma = 0 along both for a mirror"
            ),
            Self::Sigma { sigma, is_mean, .. } => format!(
                "{} = {sigma} is above {SIGMA_MAX}, the largest roughness that albedo tables cover; lower it, remove its \
                 `fresnel`, or use --no-albedo",
                if *is_mean { "sqrt(sigma_x sigma_y)" } else { "sigma" }
            ),
            Self::Albedos { most } => format!(
                "the materials ask for albedo tables of more than {most} lobes and reflectances; split the scene, or use \
                 --no-albedo"
            ),
        }
    }

    fn named(&self) -> String {
        self.material().map_or(String::new(), |material| format!("material \"{material}\": "))
    }
}
