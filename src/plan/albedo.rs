//! Which albedo tables a scene requires: only for lobes, reflectances and forms of masking of
//! materials that ask for albedos.

use microfacet_sampler::{LobeEntry, Masking, Precision, Reflectance};

use super::{NotCovered, Options, entry, is_tabulated};
use crate::bake::albedo::{AlbedoError, AlbedoLobe, AlbedoSpec, Domain, SIGMA_MAX};
use crate::scene::{Format, Interval, Material, Scene};
use crate::table_spec::{Level, Quality};

/// Which materials get albedo tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AlbedoWish {
    /// Those of a native recipe that state `fresnel`. Scenes of other formats state a Fresnel term
    /// for nearly every material, whether or not their renderer uses albedos.
    #[default]
    Recipes,
    /// Every rough material in use.
    All,
    /// None.
    None,
}

/// Albedos that one table group covers, of one lobe or a range of the family; they are baked,
/// measured and kept together.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RequiredAlbedo {
    /// The lobes.
    pub lobe: AlbedoLobe,
    /// The reflectance; the moments serve F = 1 and every Schlick approximation.
    pub reflectance: Reflectance,
    /// The forms of masking.
    pub maskings: Vec<Masking>,
}

impl RequiredAlbedo {
    /// The moments of the whole domain of the tables.
    pub fn general() -> Self {
        let lobe = AlbedoLobe::Family(Domain::GENERAL);
        Self { lobe, reflectance: Reflectance::Moments, maskings: Masking::ALL.into() }
    }

    /// The specification of the tables that cover it.
    ///
    /// # Errors
    /// [`AlbedoError`] for parameters that describe no ellipsoid.
    pub fn spec(
        &self,
        level: impl Into<Level>,
        precision: Precision,
    ) -> Result<AlbedoSpec, AlbedoError> {
        let Self { lobe, reflectance, maskings } = self.clone();
        AlbedoSpec::new(lobe, reflectance, maskings, level, precision)
    }

    fn covers(&self, want: &Want) -> bool {
        let lobe = match (&self.lobe, &want.lobe) {
            (AlbedoLobe::Family(domain), AlbedoLobe::Family(other)) => domain.contains(other),
            (one, other) => one == other,
        };
        lobe && self.reflectance == want.reflectance && self.maskings.contains(&want.masking)
    }
}

/// What the plan decides on a material's albedo.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AlbedoVerdict {
    /// Tables are baked for it: indices into [`Plan::albedos`](super::Plan::albedos).
    Bake(Vec<usize>),
    /// Its recipe states no `fresnel`.
    NotAsked,
    /// It comes from a scene of another format, and for those albedos must be asked for.
    Imported,
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

/// More tables of albedos, of different lobes or reflectances, are not planned: each takes seconds
/// to bake, and the time of planning grows with the square of their number.
const MAX_ALBEDOS: usize = 1000;

/// The required albedos of a scene, and one verdict for each of its materials.
pub(super) fn required(
    scene: &Scene,
    options: Options,
) -> Result<(Vec<RequiredAlbedo>, Vec<AlbedoVerdict>), NotCovered> {
    let wants: Vec<Result<Vec<Want>, AlbedoVerdict>> = scene
        .materials
        .iter()
        .map(|material| wants(material, options))
        .collect::<Result<_, _>>()?;
    let mut needs: Vec<RequiredAlbedo> = Vec::new();
    let mut add = |lobe: AlbedoLobe, reflectance, masking| {
        // Both forms in one table group cost little more than one.
        let same = |need: &RequiredAlbedo| need.lobe == lobe && need.reflectance == reflectance;
        match needs.iter().position(same) {
            Some(i) if needs[i].maskings.contains(&masking) => {}
            Some(i) => needs[i].maskings.push(masking),
            None if needs.len() == MAX_ALBEDOS => {
                return Err(NotCovered::Albedos { most: MAX_ALBEDOS });
            }
            None => needs.push(RequiredAlbedo { lobe, reflectance, maskings: vec![masking] }),
        }
        Ok(())
    };
    let all: Vec<&Want> = wants.iter().flatten().flatten().collect();
    let mut reflectances: Vec<Reflectance> = Vec::new();
    for want in &all {
        if !reflectances.contains(&want.reflectance) {
            reflectances.push(want.reflectance);
        }
        if reflectances.len() > MAX_ALBEDOS {
            return Err(NotCovered::Albedos { most: MAX_ALBEDOS });
        }
    }
    // The moments first, since they serve most materials.
    reflectances.sort_by_key(|reflectance| *reflectance != Reflectance::Moments);
    for reflectance in reflectances {
        for masking in Masking::ALL {
            let same = all
                .iter()
                .filter(|want| want.reflectance == reflectance && want.masking == masking);
            let (family, own): (Vec<&AlbedoLobe>, Vec<&AlbedoLobe>) =
                same.map(|want| &want.lobe).partition(|lobe| matches!(lobe, AlbedoLobe::Family(_)));
            let domains = family.into_iter().filter_map(|lobe| {
                if let AlbedoLobe::Family(domain) = lobe { Some(*domain) } else { None }
            });
            let domains = joined(domains.collect()).into_iter().map(AlbedoLobe::Family);
            for lobe in domains.chain(own.into_iter().cloned()) {
                add(lobe, reflectance, masking)?;
            }
        }
    }
    let serving =
        |want: &Want| needs.iter().position(|need| need.covers(want)).expect("needs cover all");
    let verdicts = wants.into_iter().map(|wants| match wants {
        Ok(wants) => AlbedoVerdict::Bake(wants.iter().map(serving).collect()),
        Err(verdict) => verdict,
    });
    let verdicts = verdicts.collect();
    Ok((needs, verdicts))
}

/// The tables that a material asks for, or the reason why it gets none.
fn wants(
    material: &Material,
    options: Options,
) -> Result<Result<Vec<Want>, AlbedoVerdict>, NotCovered> {
    if let Some(verdict) = unasked(material, options) {
        return Ok(Err(verdict));
    }
    let (gamma, [x, y]) = (material.gamma, [material.roughness.x(), material.roughness.y()]);
    // The usual stand-in for an anisotropic surface.
    let mean = |x: f64, y: f64| if x == y { x } else { (x * y).sqrt() };
    let round = AlbedoLobe::Family(Domain {
        gamma,
        sigma: Interval { min: mean(x.min, y.min), max: mean(x.max, y.max) },
    });
    let entry = entry(material);
    let lobe = match (entry.lobe(), &material.distribution) {
        (LobeEntry::Family, _) => round.clone(),
        (LobeEntry::StudentT { sigma, .. }, _) => AlbedoLobe::StudentT { sigma, gamma: gamma.min },
        (LobeEntry::Ellipsoid { sigma, theta, .. }, _) => {
            AlbedoLobe::Ellipsoid { sigma, theta, gamma: gamma.min }
        }
        (LobeEntry::Distribution(_), Some(distribution)) => {
            AlbedoLobe::Radial { distribution: distribution.clone(), sigma: x.min }
        }
        (LobeEntry::Distribution(_), None) => unreachable!("entries take it from the material"),
    };
    let refracts = matches!(entry.lobe(), LobeEntry::Family | LobeEntry::StudentT { .. });
    let exact = material.fresnel.iter().flat_map(|fresnel| fresnel.tabulated());
    let exact = exact.filter(|reflectance| *reflectance != Reflectance::Moments);
    let of = |reflectance: Reflectance| {
        // The model has refraction for isotropic lobes of the family only.
        let lobe = if reflectance.indices().is_some() { &round } else { &lobe };
        Want { lobe: lobe.clone(), reflectance, masking: entry.masking() }
    };
    let embedded = options.embedded_albedo && matches!(lobe, AlbedoLobe::Family(_));
    let moments = (!embedded).then_some(Reflectance::Moments);
    let exact = exact.filter(|reflectance| refracts || reflectance.indices().is_none());
    let wants: Vec<Want> = moments.into_iter().chain(exact).map(of).collect();
    for want in &wants {
        if let AlbedoLobe::Family(Domain { sigma, .. }) = want.lobe
            && sigma.max > SIGMA_MAX
        {
            return Err(NotCovered::Sigma { material: material.name.clone(), sigma: sigma.max });
        }
    }
    Ok(if wants.is_empty() { Err(AlbedoVerdict::Embedded) } else { Ok(wants) })
}

/// The reason why no albedo is asked for, or `None` if one is.
fn unasked(material: &Material, options: Options) -> Option<AlbedoVerdict> {
    let native = material.origin.format == Format::Recipe;
    match options.albedo {
        _ if !is_tabulated(material) => Some(AlbedoVerdict::NotNeeded),
        AlbedoWish::None => Some(AlbedoVerdict::Declined),
        AlbedoWish::Recipes if !native => Some(AlbedoVerdict::Imported),
        AlbedoWish::Recipes if material.fresnel.is_none() => Some(AlbedoVerdict::NotAsked),
        _ => None,
    }
}

/// A small number of domains that cover all of `wants` with no more nodes in all.
fn joined(wants: Vec<Domain>) -> Vec<Domain> {
    let need =
        |domain| RequiredAlbedo { lobe: AlbedoLobe::Family(domain), ..RequiredAlbedo::general() };
    let cost = |domain| {
        need(domain).spec(Quality::Default, Precision::F32).map_or(usize::MAX, |spec| spec.nodes())
    };
    // One domain in the place of several, if it has no more nodes.
    let hull_if_cheaper = |domains: Vec<Domain>| -> Vec<Domain> {
        let hull = domains.iter().copied().reduce(|a, b| a.union(&b));
        match hull {
            Some(hull)
                if cost(hull) <= domains.iter().map(|domain| cost(*domain)).sum::<usize>() =>
            {
                vec![hull]
            }
            _ => domains,
        }
    };
    // Joins all roughnesses of one shape, then all shapes.
    let mut groups: Vec<Vec<Domain>> = Vec::new();
    for want in wants {
        match groups.iter_mut().find(|group| group[0].gamma == want.gamma) {
            Some(group) if group.contains(&want) => {}
            Some(group) => group.push(want),
            None => groups.push(vec![want]),
        }
    }
    let all = groups.into_iter().flat_map(hull_if_cheaper).collect();
    let all = hull_if_cheaper(all);
    // A domain inside another is covered by it.
    let inside = |i: usize| {
        let holds = |(j, other): (usize, &Domain)| {
            i != j && other.contains(&all[i]) && (*other != all[i] || j < i)
        };
        all.iter().enumerate().any(holds)
    };
    let mut kept: Vec<Domain> = (0..all.len()).filter(|&i| !inside(i)).map(|i| all[i]).collect();
    kept.sort_by(|a, b| {
        b.gamma.max.total_cmp(&a.gamma.max).then(a.sigma.min.total_cmp(&b.sigma.min))
    });
    kept
}
