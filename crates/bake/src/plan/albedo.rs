//! The albedo tables that a scene requires, for lobes, reflectances and forms of masking of
//! materials that ask for albedos.

use std::collections::HashMap;

use microfacet_sampler::Masking;
use microfacet_tables::{
    Interval, LobeForm, LobeSpec, Precision, Reflectance, Roughness, SIGMA_MAX, Side,
};

use super::cost::AlbedoWork;
use super::key::{self, Numbers, distinct};
use super::part::Part;
use super::{GGX, NotCovered, Options, refusal};
use crate::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec, CoarseNodes};
use crate::scene::{Format, Material};
use crate::table_spec::{Level, Quality};

/// Which materials get albedo tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AlbedoWish {
    /// Those of a native recipe that state `fresnel`; those of a scene of another format if all of
    /// them together are estimated to take less than [`QUICK`](Self::QUICK). Such scenes state a
    /// Fresnel term for nearly every material, whether or not their renderer uses albedos.
    #[default]
    Auto,
    /// Every rough material in use.
    All,
    /// None.
    None,
}

impl AlbedoWish {
    /// Seconds of one thread below which [`Auto`](Self::Auto) bakes the albedos of a scene of
    /// another format.
    pub const QUICK: f64 = 2.0;
}

/// Albedos of one table group, of one lobe or a range of the family.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RequiredAlbedo {
    /// The lobes.
    pub lobe: AlbedoLobe,
    /// The reflectance; the moments serve F = 1 and every Schlick approximation.
    pub reflectance: Reflectance,
    /// The forms of masking.
    pub maskings: Vec<Masking>,
    /// Whether the tables are [coarse](CoarseNodes), of one side of a dielectric.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub coarse: bool,
}

impl RequiredAlbedo {
    /// The moments of the whole domain of the tables.
    pub fn general() -> Self {
        let (lobe, reflectance) = (LobeSpec::GENERAL, Reflectance::Mirror);
        Self { lobe, reflectance, maskings: Masking::ALL.into(), coarse: false }
    }

    /// Glass and plastic of common indices under height-correlated masking, seen from either side:
    /// what the default set holds of dielectrics.
    pub fn common_glass() -> [Self; 2] {
        let sigma = Roughness::isotropic(Interval { min: 0.0, max: 1.0 });
        let lobe = AlbedoLobe::family(sigma, Interval { min: GGX, max: f64::INFINITY });
        let index = Interval { min: 1.3, max: 1.7 };
        [Side::Thin, Side::Dense].map(|side| Self {
            lobe: lobe.clone(),
            reflectance: Reflectance::Interface { side, index },
            maskings: vec![Masking::HeightCorrelated],
            coarse: true,
        })
    }

    /// The precision in which the tables are stored where one is asked for: coarse ones have no use
    /// for more than 16 bits.
    pub(crate) fn stored(&self, asked: Precision) -> Precision {
        if self.coarse && asked == Precision::F32 { Precision::U16 } else { asked }
    }

    /// Whether averages are baked as well, which only moments of a range of the family have.
    pub fn has_averages(&self) -> bool {
        self.spec(Quality::Draft, Precision::F32).is_ok_and(|spec| spec.has_averages())
    }

    /// The specification of the tables.
    ///
    /// # Errors
    /// [`AlbedoError`] for parameters that describe no ellipsoid.
    pub fn spec(
        &self,
        level: impl Into<Level>,
        precision: Precision,
    ) -> Result<AlbedoSpec, AlbedoError> {
        let Self { lobe, reflectance, maskings, coarse } = self.clone();
        if let Reflectance::Interface { side, index } = reflectance
            && coarse
        {
            let (nodes, precision) = (CoarseNodes::at(level.into()), self.stored(precision));
            return Ok(AlbedoSpec::coarse(lobe, (side, index), maskings, &nodes, precision));
        }
        AlbedoSpec::new(lobe, reflectance, maskings, level, precision)
    }
}

/// What the plan decides on a material's albedo.
#[derive(Clone, Debug, PartialEq)]
pub enum AlbedoVerdict {
    /// Tables are baked for it: indices into [`Plan::albedos`](super::Plan::albedos).
    Bake(Vec<usize>),
    /// Its recipe states no `fresnel`.
    NotAsked,
    /// It comes from a scene of another format, whose albedos together would take long and must be
    /// asked for.
    Imported,
    /// No albedo table covers its σ.
    NotCovered(NotCovered),
    /// The user declined albedo tables.
    Declined,
    /// The default set that is compiled into the sampler crate covers it.
    Embedded,
    /// It has no microfacets, or no geometry uses it.
    NotNeeded,
}

/// One table that one material asks for.
#[derive(Clone)]
struct Want {
    lobe: AlbedoLobe,
    reflectance: Reflectance,
    masking: Masking,
}

/// Most table groups of albedos in a plan: each takes seconds to bake.
const MAX_ALBEDOS: usize = 100_000;

#[derive(Default)]
struct Needs {
    all: Vec<RequiredAlbedo>,
    /// The group of a lobe and the index of a reflectance.
    of: HashMap<((Numbers, Option<String>), usize), usize>,
    /// The groups of the family under each reflectance: few, since `least` joins ranges.
    families: Vec<Vec<usize>>,
}

impl Needs {
    fn add(
        &mut self,
        lobe: AlbedoLobe,
        (i, reflectance): (usize, Reflectance),
        masking: Masking,
    ) -> Result<(), NotCovered> {
        let key = (key::of_lobe(&lobe), i);
        if let Some(&found) = self.of.get(&key) {
            // Both forms of masking in one table group cost little more than one.
            let maskings = &mut self.all[found].maskings;
            if !maskings.contains(&masking) {
                maskings.push(masking);
            }
            return Ok(());
        }
        if self.all.len() == MAX_ALBEDOS {
            return Err(NotCovered::Albedos { most: MAX_ALBEDOS });
        }
        if lobe.is_family() {
            self.families[i].push(self.all.len());
        }
        self.of.insert(key, self.all.len());
        let maskings = vec![masking];
        self.all.push(RequiredAlbedo { lobe, reflectance, maskings, coarse: false });
        Ok(())
    }

    /// The first group that covers what a material asks for.
    fn serving(&self, Want { lobe, masking, .. }: Want, i: usize) -> Option<usize> {
        if !lobe.is_family() {
            return self.of.get(&(key::of_lobe(&lobe), i)).copied();
        }
        let covers =
            |need: &RequiredAlbedo| need.lobe.contains(&lobe) && need.maskings.contains(&masking);
        self.families[i].iter().copied().find(|&need| covers(&self.all[need]))
    }
}

/// Albedos, and one verdict for each lobe of their scene.
type Wanted = (Vec<RequiredAlbedo>, Vec<AlbedoVerdict>);

/// The required albedos of the lobes of a scene, and those that would take too long.
pub(super) fn required(
    lobes: &[Part<'_>],
    options: Options,
) -> Result<(Wanted, Vec<RequiredAlbedo>), NotCovered> {
    let is_imported = |part: &Part<'_>| part.of.origin.format != Format::Recipe;
    let (mut offered, mut if_asked) = (Vec::new(), Vec::new());
    if options.albedo == AlbedoWish::Auto && lobes.iter().any(is_imported) {
        match wanted(lobes, Options { albedo: AlbedoWish::All, ..options }) {
            Ok(wanted) if is_quick(&wanted.0, options.quality) => return Ok((wanted, offered)),
            Ok(wanted) => (offered, if_asked) = wanted,
            // What is refused where it is asked for is not offered.
            Err(_) => {}
        }
    }
    let (albedos, mut verdicts) = wanted(lobes, options)?;
    for (verdict, if_asked) in verdicts.iter_mut().zip(if_asked) {
        // `Imported` means that tables are baked on request.
        if *verdict == AlbedoVerdict::Imported && !matches!(if_asked, AlbedoVerdict::Bake(_)) {
            *verdict = if_asked;
        }
    }
    Ok(((albedos, verdicts), offered))
}

/// Whether all these albedos are estimated to take less than [`AlbedoWish::QUICK`] on one thread.
fn is_quick(all: &[RequiredAlbedo], quality: Quality) -> bool {
    let mut left = AlbedoWish::QUICK;
    // An albedo that no table can hold is refused where it is asked for.
    all.iter().filter_map(|need| need.spec(quality, Precision::F32).ok()).all(|spec| {
        left -= AlbedoWork::new(&spec).expected(&spec);
        left > 0.0
    })
}

/// The albedos of lobes under the wish in `options`.
fn wanted(lobes: &[Part<'_>], options: Options) -> Result<Wanted, NotCovered> {
    let wants: Vec<Result<Vec<Want>, AlbedoVerdict>> =
        lobes.iter().map(|part| wants(part, options)).collect::<Result<_, _>>()?;
    let all = || wants.iter().flatten().flatten();
    let mut reflectances = distinct(all().map(|want| want.reflectance), key::of_reflectance);
    // The moments first, since they serve most materials.
    reflectances.sort_by_key(|reflectance| *reflectance != Reflectance::Mirror);
    let indices: HashMap<Numbers, usize> =
        reflectances.iter().enumerate().map(|(i, of)| (key::of_reflectance(of), i)).collect();
    let index = |want: &Want| indices[&key::of_reflectance(&want.reflectance)];
    // The lobes that are asked for under each reflectance and form of masking.
    let mut asked: Vec<[Vec<&AlbedoLobe>; Masking::ALL.len()]> =
        vec![Default::default(); reflectances.len()];
    for want in all() {
        for (lobes, masking) in asked[index(want)].iter_mut().zip(Masking::ALL) {
            if want.masking == masking {
                lobes.push(&want.lobe);
            }
        }
    }
    let families = vec![Vec::new(); reflectances.len()];
    let mut needs = Needs { families, ..Needs::default() };
    for (reflectance, asked) in reflectances.into_iter().enumerate().zip(asked) {
        for (lobes, masking) in asked.into_iter().zip(Masking::ALL) {
            let (round, own): (Vec<_>, Vec<_>) =
                lobes.into_iter().partition(|lobe| lobe.is_family());
            for lobe in joined(round.into_iter()).into_iter().chain(own.into_iter().cloned()) {
                needs.add(lobe, reflectance, masking)?;
            }
        }
    }
    let serving = |want: Want| {
        let i = index(&want);
        needs.serving(want, i).expect("needs cover all")
    };
    let verdicts = wants.into_iter().map(|wants| match wants {
        Ok(wants) => AlbedoVerdict::Bake(wants.into_iter().map(serving).collect()),
        Err(verdict) => verdict,
    });
    let verdicts = verdicts.collect();
    Ok((needs.all, verdicts))
}

/// The tables that a lobe asks for, or the verdict if it gets none.
fn wants(
    part: &Part<'_>,
    options: Options,
) -> Result<Result<Vec<Want>, AlbedoVerdict>, NotCovered> {
    if let Some(verdict) = unasked(part, options) {
        return Ok(Err(verdict));
    }
    let material = &*part.of;
    let lobe = material.lobe.tabulated();
    let of = |reflectance: Reflectance| Want {
        lobe: tabulated(&material.lobe, &reflectance),
        reflectance,
        masking: material.masking.unwrap_or_default(),
    };
    let embedded = options.embedded_albedo && lobe.is_family();
    let is_embedded = |reflectance: &Reflectance| embedded && *reflectance == Reflectance::Mirror;
    let wants: Vec<Want> =
        reflectances(material).filter(|reflectance| !is_embedded(reflectance)).map(of).collect();
    // The lobe itself too: the albedos of the default set end at the same σ.
    for lobe in std::iter::once(&lobe).chain(wants.iter().map(|want| &want.lobe)) {
        let sigma = lobe.roughness.x().max;
        if lobe.is_family() && sigma > SIGMA_MAX {
            let is_mean = !material.lobe.is_family();
            let why = NotCovered::Sigma { material: material.name.clone(), sigma, is_mean };
            return refusal(material, options, why).map(|why| Err(AlbedoVerdict::NotCovered(why)));
        }
    }
    Ok(if wants.is_empty() { Err(AlbedoVerdict::Embedded) } else { Ok(wants) })
}

/// The reflectances whose tables a material gets if its albedo is baked: the moments, and its exact
/// one.
pub(super) fn reflectances(material: &Material) -> impl Iterator<Item = Reflectance> {
    // The model has refraction for upright lobes of the family only.
    let refracts = matches!(material.lobe.form(), LobeForm::Family | LobeForm::StudentT);
    let exact = material.fresnel.iter().flat_map(Reflectance::tabulated);
    let exact =
        exact.filter(move |of| *of != Reflectance::Mirror && (refracts || of.indices().is_none()));
    std::iter::once(Reflectance::Mirror).chain(exact)
}

/// The lobe that a table of a material's albedo is of: over a range of indices it is a round one.
pub(super) fn tabulated(lobe: &AlbedoLobe, reflectance: &Reflectance) -> AlbedoLobe {
    let is_range = reflectance.indices().is_some_and(|range| !range.is_point());
    if is_range { lobe.round() } else { lobe.tabulated() }
}

/// The verdict if no albedo is asked for.
fn unasked(part: &Part<'_>, options: Options) -> Option<AlbedoVerdict> {
    let material = &*part.of;
    let native = material.origin.format == Format::Recipe;
    match options.albedo {
        _ if !part.is_tabulated() => Some(AlbedoVerdict::NotNeeded),
        AlbedoWish::None => Some(AlbedoVerdict::Declined),
        AlbedoWish::Auto if !native => Some(AlbedoVerdict::Imported),
        AlbedoWish::Auto if material.fresnel.is_none() => Some(AlbedoVerdict::NotAsked),
        _ => None,
    }
}

/// A small number of ranges of round lobes that cover all of `wants` with no more nodes in all.
fn joined<'a>(wants: impl Iterator<Item = &'a AlbedoLobe>) -> Vec<AlbedoLobe> {
    let mut groups: Vec<Vec<AlbedoLobe>> = Vec::new();
    let mut of_shapes: HashMap<Numbers, usize> = HashMap::new();
    for want in distinct(wants, |lobe| key::of_lobe(lobe)) {
        let shapes = key::of(&<[f64; 2]>::from(want.gamma));
        let group = *of_shapes.entry(shapes).or_insert(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(want.clone());
    }
    least(groups)
}

/// A small number of ranges that cover all of `groups`, each of one range of shapes.
fn least(groups: Vec<Vec<AlbedoLobe>>) -> Vec<AlbedoLobe> {
    let cost = |lobe: &AlbedoLobe| {
        let need = RequiredAlbedo { lobe: lobe.clone(), ..RequiredAlbedo::general() };
        need.spec(Quality::Default, Precision::F32).map_or(usize::MAX, |spec| spec.nodes())
    };
    let hull = |a: AlbedoLobe, b: &AlbedoLobe| {
        let sigma = Roughness::isotropic(a.roughness.x().union(b.roughness.x()));
        AlbedoLobe::family(sigma, a.gamma.union(b.gamma))
    };
    // One range instead of several, if it has no more nodes.
    let hull_if_cheaper = |lobes: Vec<AlbedoLobe>| -> Vec<AlbedoLobe> {
        let Some(first) = lobes.first() else { return lobes };
        let all = lobes.iter().fold(first.clone(), hull);
        if cost(&all) <= lobes.iter().map(cost).sum() { vec![all] } else { lobes }
    };
    // Joins all roughnesses of one range of shapes, then all shapes.
    let all = groups.into_iter().flat_map(hull_if_cheaper).collect();
    let all = hull_if_cheaper(all);
    // Ranges inside another are left out. Comparing each with each is fast for any number of
    // materials, since their hull has fewer nodes than a thousand ranges.
    let inside = |i: usize| {
        let holds = |(j, other): (usize, &AlbedoLobe)| {
            i != j && other.contains(&all[i]) && (j < i || !all[i].contains(other))
        };
        all.iter().enumerate().any(holds)
    };
    let kept = (0..all.len()).filter(|&i| !inside(i)).map(|i| all[i].clone());
    let mut kept: Vec<AlbedoLobe> = kept.collect();
    kept.sort_by(|a, b| {
        let least_sigma = |lobe: &AlbedoLobe| lobe.roughness.x().min;
        b.gamma.max.total_cmp(&a.gamma.max).then(least_sigma(a).total_cmp(&least_sigma(b)))
    });
    kept
}

#[cfg(test)]
mod tests;
