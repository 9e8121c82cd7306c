//! Which albedo tables a scene needs: for the forms of masking, the shapes and the roughnesses of the materials that ask, and no others.

use microfacet_sampler::{FresnelEntry, Masking, Precision};

use super::{NotCovered, Options, entry, is_rough};
use crate::bake::albedo::{AlbedoSpec, Domain, SIGMA_MAX};
use crate::bake::view_albedo::{Lobe, ViewSpec};
use crate::scene::{Format, Interval, Material, Scene};
use crate::spec::Quality;

/// Which materials get albedo tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AlbedoWish {
    /// Those of a native recipe that state `fresnel`. Scenes of other formats state a Fresnel term of nearly every material, whether or
    /// not their renderer wants albedos.
    #[default]
    Recipes,
    /// Every rough material in use.
    All,
    /// None.
    None,
}

/// Materials that albedo tables are to cover: the unit in which they are baked, measured and kept.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoNeed {
    /// Shapes and roughnesses.
    pub domain: Domain,
    /// Forms of masking.
    pub maskings: Vec<Masking>,
    /// A conductor's or dielectric's exact reflectance; `None` are the moments that serve F = 1 and Schlick's approximation.
    pub fresnel: Option<FresnelEntry>,
}

impl AlbedoNeed {
    /// Everything that tables can cover.
    pub fn general() -> Self {
        Self { domain: Domain::GENERAL, maskings: Masking::ALL.into(), fresnel: None }
    }

    /// The specification that covers it, cut out of a general one.
    pub fn spec(&self, general: &AlbedoSpec) -> AlbedoSpec {
        AlbedoSpec { fresnel: self.fresnel, ..general.part(self.domain, &self.maskings) }
    }
}

/// A material whose albedo depends on the azimuth of the view, or on a distribution of its own, and gets a table of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewNeed {
    /// Its normals.
    pub lobe: Lobe,
    /// What the name of its table ends in; materials of one label and masking share the table.
    pub label: String,
    /// The form of masking.
    pub masking: Masking,
}

impl ViewNeed {
    /// The smallest table that is tried for it.
    pub fn spec(&self, quality: Quality, precision: Precision) -> ViewSpec {
        ViewSpec::new(self.lobe.clone(), self.label.clone(), self.masking, quality, precision)
    }
}

/// The materials that get an albedo table over all views, each table once, and for each material of the scene the index of its own.
pub(super) fn view_needs(scene: &Scene, options: Options) -> (Vec<ViewNeed>, Vec<Option<usize>>) {
    let mut needs: Vec<ViewNeed> = Vec::new();
    let mut index = |material: &Material| {
        if unasked(material, options).is_some() {
            return None;
        }
        let need = view_need(material)?;
        let same = |other: &ViewNeed| (&other.label, other.masking) == (&need.label, need.masking);
        Some(needs.iter().position(same).unwrap_or_else(|| {
            needs.push(need);
            needs.len() - 1
        }))
    };
    let indices = scene.materials.iter().map(&mut index).collect();
    (needs, indices)
}

fn view_need(material: &Material) -> Option<ViewNeed> {
    let label = entry(material).view_label()?;
    let sigma = [material.roughness.x().min, material.roughness.y().min];
    let gamma = material.gamma.min;
    let lobe = match (&material.distribution, material.theta) {
        (Some(distribution), _) => Lobe::Radial { distribution: distribution.clone(), sigma: sigma[0] },
        (_, Some(theta)) => Lobe::Ellipsoid { sigma, theta, gamma },
        _ => Lobe::StudentT { sigma, gamma },
    };
    Some(ViewNeed { lobe, label, masking: material.masking.unwrap_or_default() })
}

/// What becomes of a material's albedo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlbedoVerdict {
    /// Tables are baked that cover it: an index into [`Plan::albedos`](super::Plan::albedos).
    Bake(usize),
    /// Its recipe states no `fresnel`.
    NotAsked,
    /// It comes from a scene of another format, and those have to ask.
    Imported,
    /// Albedo tables were declined.
    Declined,
    /// It is no plain Student-t, and has a table of its own alone: see [`Plan::view_indices`](super::Plan::view_indices).
    Own,
    /// The default set that is compiled into the sampler crate covers it.
    Embedded,
    /// It has no microfacets, or no geometry wears it.
    NotNeeded,
}

/// The needs of a scene, and one verdict for each of its materials.
pub(super) fn needs(
    scene: &Scene,
    options: Options,
) -> Result<(Vec<AlbedoNeed>, Vec<AlbedoVerdict>), NotCovered> {
    let wants: Vec<Result<(Domain, Masking), AlbedoVerdict>> =
        scene.materials.iter().map(|material| want(material, options)).collect::<Result<_, _>>()?;
    let mut needs: Vec<AlbedoNeed> = Vec::new();
    for masking in Masking::ALL {
        let of_form = wants.iter().flatten().filter(|want| want.1 == masking).map(|want| want.0);
        for domain in joined(of_form.collect()) {
            // Two forms at once cost little more than one.
            match needs.iter_mut().find(|need| need.domain == domain) {
                Some(need) => need.maskings.push(masking),
                None => needs.push(AlbedoNeed { domain, maskings: vec![masking], fresnel: None }),
            }
        }
    }
    // Besides these, the exact reflectances that are no combination of the moments.
    let mut exact: Vec<(FresnelEntry, Masking)> = Vec::new();
    let pairs = || {
        scene
            .materials
            .iter()
            .zip(&wants)
            .filter_map(|(material, want)| Some((material, want.as_ref().ok()?)))
    };
    for (material, &(_, masking)) in pairs() {
        if let Some(fresnel) = exact_fresnel(material)
            && !exact.contains(&(fresnel, masking))
        {
            exact.push((fresnel, masking));
        }
    }
    for (fresnel, masking) in exact {
        let same = |(material, want): &(&Material, &(Domain, Masking))| {
            want.1 == masking && exact_fresnel(material).as_ref() == Some(&fresnel)
        };
        let domains = joined(pairs().filter(same).map(|(_, want)| want.0).collect());
        let need = |domain| AlbedoNeed { domain, maskings: vec![masking], fresnel: Some(fresnel) };
        needs.extend(domains.into_iter().map(need));
    }
    let verdict = |want: &Result<(Domain, Masking), AlbedoVerdict>| match want {
        Ok((domain, masking)) => {
            let covers = |need: &AlbedoNeed| {
                need.fresnel.is_none() && need.maskings.contains(masking) && need.domain.contains(domain)
            };
            AlbedoVerdict::Bake(needs.iter().position(covers).expect("the needs cover every want"))
        }
        Err(verdict) => *verdict,
    };
    let verdicts = wants.iter().map(verdict).collect();
    Ok((needs, verdicts))
}

/// What a material needs, or why it needs nothing.
fn want(
    material: &Material,
    options: Options,
) -> Result<Result<(Domain, Masking), AlbedoVerdict>, NotCovered> {
    if let Some(verdict) = unasked(material, options) {
        return Ok(Err(verdict));
    }
    if material.distribution.is_some() || material.theta.is_some() {
        return Ok(Err(AlbedoVerdict::Own));
    }
    let (gamma, [x, y]) = (material.gamma, [material.roughness.x(), material.roughness.y()]);
    // The usual stand-in for an anisotropic surface.
    let mean = |x: f64, y: f64| if x == y { x } else { (x * y).sqrt() };
    let sigma = Interval { min: mean(x.min, y.min), max: mean(x.max, y.max) };
    if sigma.max > SIGMA_MAX {
        return Err(NotCovered::Sigma { material: material.name.clone(), sigma: sigma.max });
    }
    if options.embedded_albedo {
        return Ok(Err(AlbedoVerdict::Embedded));
    }
    Ok(Ok((Domain { gamma, sigma }, material.masking.unwrap_or_default())))
}

/// Why no albedo is wanted of a material, if none is.
fn unasked(material: &Material, options: Options) -> Option<AlbedoVerdict> {
    let native = material.origin.format == Format::Recipe;
    match options.albedo {
        _ if !material.used || !is_rough(material) => Some(AlbedoVerdict::NotNeeded),
        AlbedoWish::None => Some(AlbedoVerdict::Declined),
        AlbedoWish::Recipes if !native => Some(AlbedoVerdict::Imported),
        AlbedoWish::Recipes if material.fresnel.is_none() => Some(AlbedoVerdict::NotAsked),
        _ => None,
    }
}

/// A reflectance that needs a table of its own.
fn exact_fresnel(material: &Material) -> Option<FresnelEntry> {
    let fresnel = material.fresnel.filter(|entry| !entry.label().is_empty())?;
    // Tables hold both sides of an interface.
    Some(match fresnel {
        FresnelEntry::Dielectric(eta) if eta < 1.0 => FresnelEntry::Dielectric(1.0 / eta),
        other => other,
    })
}

/// Few domains that cover all of `wants` with no more nodes in all.
fn joined(wants: Vec<Domain>) -> Vec<Domain> {
    let general = AlbedoSpec::general(Quality::Default, Precision::F32);
    let cost = |domain: Domain| general.part(domain, &[Masking::Uncorrelated]).nodes();
    // One domain in the place of several, if that is not more.
    let hull_if_cheaper = |domains: Vec<Domain>| -> Vec<Domain> {
        let hull = domains.iter().copied().reduce(|a, b| a.union(&b));
        match hull {
            Some(hull) if cost(hull) <= domains.iter().map(|domain| cost(*domain)).sum() => vec![hull],
            _ => domains,
        }
    };
    // All roughnesses of one shape, then all shapes.
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
    // What lies inside another is there.
    let inside = |i: usize| {
        let holds =
            |(j, other): (usize, &Domain)| i != j && other.contains(&all[i]) && (*other != all[i] || j < i);
        all.iter().enumerate().any(holds)
    };
    let mut kept: Vec<Domain> = (0..all.len()).filter(|&i| !inside(i)).map(|i| all[i]).collect();
    kept.sort_by(|a, b| b.gamma.max.total_cmp(&a.gamma.max).then(a.sigma.min.total_cmp(&b.sigma.min)));
    kept
}
