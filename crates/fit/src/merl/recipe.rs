//! Fitted materials as a recipe.

use std::fmt::Write as _;
use std::path::Path;

use microfacet_baker::scene::{
    Format, LobeSpec, Masking, Material, Names, Origin, Place, Reflectance, Roughness, Scene,
};
use microfacet_tables::{Interval, MaterialEntry, SIGMA_MAX};

use super::Fitted;

/// The names of fitted materials: those of their files without the last extension and without
/// characters that a comment cannot hold, made unique.
pub fn names<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Vec<String> {
    let mut names = Names::default();
    paths.into_iter().map(|path| names.unique(stem(path))).collect()
}

/// A recipe of fitted materials with their [`names`], in the order given.
///
/// A recipe has no key for a Lambert term: a comment at its head has those of all materials.
pub fn recipe<'a>(fits: impl IntoIterator<Item = (&'a str, &'a Fitted)>) -> String {
    let mut head = format!(
        "# Fitted to measured reflectance by microfacet-bake {}. A recipe has no key for the\n\
         # Lambert term that each of these has beside its lobe; its albedo is, in red, green\n\
         # and blue:\n",
        env!("CARGO_PKG_VERSION")
    );
    let mut scene = Scene::default();
    for (name, fitted) in fits {
        let [sigma, gamma] = fitted.sigma_gamma();
        // A reflectance in a recipe requires tables of albedos, which end at `SIGMA_MAX`.
        let tabulated = sigma <= SIGMA_MAX;
        let [r, g, b] = fitted.lambert;
        // Writing to a string cannot fail.
        let _ = writeln!(head, "#   {name}: {r:.6}, {g:.6}, {b:.6}");
        if !tabulated {
            let [r, g, b] = fitted.f0;
            let _ = writeln!(
                head,
                "#     its F0, {r:.6}, {g:.6}, {b:.6}, is left out: no albedos are tabulated above\n\
                 #     sigma = {SIGMA_MAX}"
            );
        }
        scene.materials.push(Material {
            name: name.into(),
            lobe: LobeSpec::family(
                Roughness::Isotropic(Interval::point(sigma)),
                Interval::point(gamma),
            ),
            haze: None,
            retroreflection: MaterialEntry::SPECULAR,
            fresnel: tabulated.then_some(Reflectance::Schlick(fitted.f0)),
            masking: Some(Masking::Uncorrelated),
            origin: Origin {
                format: Format::Recipe,
                place: Place { file: Path::new(name).into(), line: None, column: None },
                lobe: None,
            },
            used: true,
        });
    }
    format!("{head}\n{}", scene.to_recipe())
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name: String = stem.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    if name.is_empty() { "material".into() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use microfacet_baker::distribution::{DistributionKind, Named};
    use microfacet_baker::plan::{Options, Plan};

    #[test]
    fn a_recipe_reads_back_and_names_are_unique() {
        let fitted = |gamma| Fitted {
            lobe: Named { kind: DistributionKind::StudentT, values: vec![0.1 + 0.2, gamma] },
            f0: [1.0, 0.0, 1.0 / 3.0],
            lambert: [0.1, 0.0, 0.25],
            error: 0.1,
            ends_at: vec![],
        };
        let paths =
            ["a/gold.binary", "b/gold.binary", "gold (2).binary", "x\n[\u{1b}].binary", ".."];
        let gammas = [2.0, 1.5025, f64::INFINITY, 3.0, 1e9];
        let fits: Vec<Fitted> = gammas.map(fitted).into();
        let names = names(paths.map(Path::new));
        let text = recipe(names.iter().map(String::as_str).zip(&fits));
        let scene = Scene::from_recipe_str(&text).unwrap();
        let names: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["gold", "gold (2)", "gold (2) (2)", "x_[_]", "material"]);
        for (material, gamma) in scene.materials.iter().zip(gammas) {
            assert_eq!(material.lobe.roughness.x(), Interval::point(0.1 + 0.2));
            assert_eq!(material.lobe.gamma, Interval::point(gamma));
            assert_eq!(material.fresnel, Some(Reflectance::Schlick([1.0, 0.0, 1.0 / 3.0])));
            assert_eq!(material.masking, Some(Masking::Uncorrelated));
        }
        assert!(text.contains("#   gold (2) (2): 0.100000, 0.000000, 0.250000\n"), "{text}");
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        // A material that no albedo table covers is planned without its reflectance.
        let rough = Fitted {
            lobe: Named { kind: DistributionKind::StudentT, values: vec![9.0, 2.5] },
            ..fitted(2.0)
        };
        let text = recipe([("lambert", &rough)]);
        let scene = Scene::from_recipe_str(&text).unwrap();
        assert!(text.contains("its F0, 1.000000") && scene.materials[0].fresnel.is_none());
        assert!(Plan::new(&scene, Options::default()).is_ok());
    }
}
