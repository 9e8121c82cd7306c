//! Sets whose materials have one lobe each, as figures and rows show them.

use std::borrow::Cow;
use std::collections::HashSet;

use microfacet_sampler::Tables;
use microfacet_tables::{Haze, MaterialEntry};

use crate::words::range;

/// The set with each haze as a material of its own after that of its core, under another name; the
/// set itself if no material has a haze.
pub(super) fn by_lobe(set: &Tables) -> Cow<'_, Tables> {
    let origin = set.provenance();
    if origin.materials.iter().all(|entry| entry.haze.is_none()) {
        return Cow::Borrowed(set);
    }
    let mut names: HashSet<String> =
        origin.materials.iter().map(|entry| entry.name.clone()).collect();
    let mut origin = origin.clone();
    origin.materials = origin.materials.iter().flat_map(|entry| lobes(entry, &mut names)).collect();
    let parted = Tables::from_tables(origin, set.tables().to_vec());
    parted.map_or(Cow::Borrowed(set), Cow::Owned)
}

/// The core and the haze of a material, with the retroreflection that is of both.
fn lobes(entry: &MaterialEntry, names: &mut HashSet<String>) -> Vec<MaterialEntry> {
    let retroreflection = entry.retroreflection;
    let mut parts: Vec<MaterialEntry> =
        entry.parts().map(|part| MaterialEntry { retroreflection, ..part }).collect();
    if let (Some(Haze { weight, .. }), [_, haze]) = (&entry.haze, &mut parts[..]) {
        haze.name = format!("{}, haze of weight {}", entry.name, range(*weight));
        while !names.insert(haze.name.clone()) {
            haze.name.push('\'');
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use microfacet_baker::scene::Scene;
    use microfacet_tables::Provenance;

    use super::*;

    #[test]
    fn a_haze_is_a_material_of_its_own() {
        let of = |recipe: &str| {
            let scene = Scene::from_recipe_str(recipe).unwrap();
            let materials = scene.materials.iter().map(|material| material.entry()).collect();
            let origin = Provenance { materials, ..Provenance::default() };
            Tables::from_tables(origin, Vec::new()).unwrap()
        };
        let plain = "[[material]]\nname = \"a\"\nsigma = 0.1\ngamma = 2\n";
        let set = of(plain);
        assert!(matches!(by_lobe(&set), Cow::Borrowed(_)));
        let hazy = format!(
            "{plain}haze = {{ weight = 0.3, sigma = 0.5 }}\nretroreflection = 0.25\n\
             [[material]]\nname = \"a, haze of weight 0.3\"\nsigma = 0.2\ngamma = 2\n"
        );
        let set = of(&hazy);
        let parted = by_lobe(&set);
        let all = &parted.provenance().materials;
        let names: Vec<&str> = all.iter().map(|entry| &entry.name[..]).collect();
        assert_eq!(names, ["a", "a, haze of weight 0.3'", "a, haze of weight 0.3"]);
        let sigmas: Vec<f64> = all.iter().map(|entry| entry.lobe.round_sigma()).collect();
        assert_eq!(sigmas, [0.1, 0.5, 0.2]);
        assert!(all[..2].iter().all(|entry| entry.haze.is_none() && entry.is_retroreflecting()));
    }
}
