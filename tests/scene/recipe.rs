//! The native recipe.

use std::path::Path;

use microfacet_baker::scene::{
    Format, Haze, LobeSpec, Masking, Material, Origin, Place, Reflectance, Roughness, Scene,
};
use microfacet_sampler::Metal;
use microfacet_tables::{Interval, MaterialEntry};
use proptest::prelude::*;

use crate::{Folder, anisotropic, isotropic, load, named};

fn entry(rest: &str) -> String {
    format!("[[material]]\nname = \"a\"\n{rest}\n")
}

/// The only material of a recipe.
fn material_of(rest: &str) -> Material {
    load("r.toml", &entry(rest)).materials.remove(0)
}

/// Checks that a material is refused with a message that holds `words`.
#[track_caller]
fn refuse(rest: &str, words: &str) {
    let message = Scene::from_recipe_str(&entry(rest)).unwrap_err().to_string();
    assert!(message.contains(words), "no {words:?} in {message}");
}

/// Checks that what is written of a scene reads back to its material.
#[track_caller]
fn reads_back(scene: &Scene) {
    let written = scene.to_recipe();
    let again = Scene::from_recipe_str(&written).unwrap();
    assert!(again.materials[0].asks_the_same(&scene.materials[0]), "{written}");
}

#[test]
fn every_form_of_value_is_read() {
    let (eta, k) = ([0.2, 0.9, 1.1], [0.0, 2.4, 2.2]);
    let (range, infinity) = (|min, max| Interval { min, max }, Interval::point(f64::INFINITY));
    let mixed = Roughness::Anisotropic { x: range(0.1, 0.2), y: Interval::point(0.3) };
    for (text, roughness, gamma, fresnel, masking) in [
        ("sigma = 0.3\ngamma = 3", isotropic(0.3), Interval::point(3.0), None, None),
        (
            "sigma = [0.3, 0.1]\ngamma = \"inf\"\nfresnel = \"mirror\"\nmasking = \"uncorrelated\"",
            anisotropic(0.3, 0.1),
            infinity,
            Some(Reflectance::Mirror),
            Some(Masking::Uncorrelated),
        ),
        (
            "sigma = { min = 0, max = 0.5 }\ngamma = { min = 1.6, max = \"inf\" }\n\
             fresnel = { schlick = 0.04 }\nmasking = \"height-correlated\"",
            Roughness::Isotropic(range(0.0, 0.5)),
            range(1.6, f64::INFINITY),
            Some(Reflectance::Schlick([0.04; 3])),
            Some(Masking::HeightCorrelated),
        ),
        (
            "sigma = [{ min = 0.1, max = 0.2 }, 0.3]\ngamma = inf\n\
             fresnel = { conductor = { eta = [0.2, 0.9, 1.1], k = [0, 2.4, 2.2] } }",
            mixed,
            infinity,
            Some(Reflectance::Conductor { eta, k }),
            None,
        ),
        (
            "sigma = 0\ngamma = 2.0\nfresnel = { dielectric = 1.5 }",
            Roughness::Smooth,
            Interval::point(2.0),
            Some(Reflectance::dielectric(1.5)),
            None,
        ),
    ] {
        let scene = load("r.toml", &format!("\n{}", entry(text)));
        let material = named(&scene, "a");
        assert_eq!(material.lobe, LobeSpec::family(roughness, gamma), "{text}");
        assert_eq!((material.fresnel, material.masking), (fresnel, masking), "{text}");
        let Origin { format, place, .. } = &material.origin;
        assert_eq!((*format, place.line, material.used), (Format::Recipe, Some(2), true));
    }
}

#[test]
fn a_metal_by_name_is_the_conductor_of_its_index() {
    let fresnel = |metal: &str| {
        material_of(&format!("sigma = 0.3\ngamma = 2.0\nfresnel = {{ metal = {metal} }}")).fresnel
    };
    for metal in Metal::ALL {
        let (eta, k) = (metal.eta(), metal.k());
        assert_eq!(fresnel(&format!("\"{metal}\"")), Some(Reflectance::Conductor { eta, k }));
    }
    assert_eq!(fresnel("\"aluminum\""), Some(Metal::Aluminium.into()));
}

#[test]
fn schlick_has_one_number_or_three() {
    let fresnel = |value: &str| {
        let recipe = entry(&format!("sigma = 0.3\ngamma = 2.0\nfresnel = {{ schlick = {value} }}"));
        let scene = load("r.toml", &recipe);
        (scene.materials[0].fresnel, scene.to_recipe())
    };
    let (copper, text) = fresnel("[0.95, 0.64, 0.54]");
    assert_eq!(copper, Some(Reflectance::Schlick([0.95, 0.64, 0.54])));
    assert!(text.contains("fresnel = { schlick = [0.95, 0.64, 0.54] }"), "{text}");
    let (grey, text) = fresnel("[0.5, 0.5, 0.5]");
    assert_eq!(grey, fresnel("0.5").0);
    assert!(text.contains("fresnel = { schlick = 0.5 }"), "{text}");
}

#[test]
fn equal_axes_are_isotropic_and_equal_ranges_are_not() {
    let sigma = |text: &str| material_of(&format!("sigma = {text}\ngamma = 2.0")).lobe.roughness;
    assert_eq!(sigma("[0.2, 0.2]"), isotropic(0.2));
    assert_eq!(sigma("[0, 0]"), Roughness::Smooth);
    // Both axes cover the same range, but independently.
    let range = "{ min = 0.1, max = 0.2 }";
    assert!(!sigma(&format!("[{range}, {range}]")).is_isotropic());
}

#[test]
fn the_shipped_recipes_say_what_was_published() {
    let load = |name: &str| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tables/recipes");
        microfacet_scene::load(&folder.join(name)).unwrap()
    };
    let glass = [("frosted-glass.toml", 0.454), ("etched-glass.toml", 0.524)];
    for (file, sigma) in glass {
        let scene = load(file);
        assert_eq!(scene.materials.len(), 1);
        assert_eq!(scene.materials[0].lobe.roughness, isotropic(sigma));
        assert_eq!(scene.materials[0].lobe.gamma, Interval::point(3.0));
    }
    let gold = load("gold-series.toml");
    assert!(gold.materials.iter().all(|m| m.lobe.roughness == isotropic(0.3)));
    let gammas: Vec<f64> = gold.materials.iter().map(|m| m.lobe.gamma.min).collect();
    assert_eq!(gammas, [1.51, 1.65, 2.0, 4.0, 10.0, 50.0]);
    let aluminium = load("anisotropic-aluminium.toml");
    assert_eq!(aluminium.materials[0].lobe.roughness, anisotropic(0.7, 0.3));
}

#[test]
fn ellipsoids_have_a_turn_and_single_numbers() {
    let tilted = "sigma = [0.3, 0.1]\ngamma = 2.7\ntheta = [0.1, -0.2, 0.5]";
    let scene = load("r.toml", &entry(tilted));
    assert_eq!(scene.materials[0].lobe.theta, Some([0.1, -0.2, 0.5]));
    reads_back(&scene);
}

#[test]
fn angles_may_be_in_degrees_and_are_written_in_radians() {
    let degrees = "sigma = [0.3, 0.1]\ngamma = 2.7\ntheta = [10, -20.0, 450]\ndegrees = true";
    let scene = load("r.toml", &entry(degrees));
    let theta = [10.0_f64, -20.0, 450.0].map(f64::to_radians);
    assert_eq!(scene.materials[0].lobe.theta, Some(theta));
    assert_eq!(scene.warnings, [""; 0]);
    let written = scene.to_recipe();
    assert!(written.contains(&format!("theta = {theta:?}")) && !written.contains("degrees"));
    reads_back(&scene);

    let radians =
        degrees.replace("true", "false").replace("450", "0.5").replace("10, -20.0", "1, -1");
    assert_eq!(material_of(&radians).lobe.theta, Some([1.0, -1.0, 0.5]));
    refuse(&degrees.replace("true", "\"yes\""), "degrees must be true");
    refuse("sigma = 0.3\ngamma = 2.0\ndegrees = true", "no `theta`");
}

#[test]
fn angles_that_look_like_degrees_are_doubted() {
    let load = |sigma: &str, theta: &str| {
        Scene::from_recipe_str(&entry(&format!("sigma = {sigma}\ngamma = 2.0\ntheta = {theta}")))
    };
    for theta in ["[20, 0, 0]", "[0, -5, 0]", "[0, 0.1, 45]", "[1.6, 0, 0]"] {
        let warnings = load("0.3", theta).unwrap().warnings;
        let [warning] = &warnings[..] else { panic!("{theta}: {warnings:?}") };
        let start = format!("recipe:5:9: theta = {theta} radians");
        assert!(warning.starts_with(&start) && warning.ends_with("degrees = true"), "{warning}");
    }
    for theta in ["[1.5708, -1.5708, 6.2832]", "[0, 0, -6.28]"] {
        assert_eq!(load("0.3", theta).unwrap().warnings, [""; 0], "{theta}");
    }
    // 11 is close to 7/2 half turns: the macro normal is almost in the silhouette.
    let message = load("1e-9", "[0, 10.995574287564276, 0]").unwrap_err().to_string();
    assert!(message.contains("degrees = true"), "{message}");
    let message = load("1e-9", "[0, 1.5707963267948966, 0]").unwrap_err().to_string();
    assert!(!message.contains("degrees = true"), "{message}");
}

#[test]
fn a_measured_file_has_a_unit_of_its_own() {
    let measured = |rest: &str| entry(&format!("distribution = {{ measured = \"d.csv\"{rest} }}"));
    let degrees = "theta,D\n0,4\n10,3\n20,2\n30,1\n";
    let radians: String = [(0.0_f64, 4), (10.0, 3), (20.0, 2), (30.0, 1)]
        .map(|(angle, d)| format!("{:?},{d}\n", angle.to_radians()))
        .concat();
    let load =
        |recipe: &str, csv: &str| Folder::new(&[("r.toml", recipe), ("d.csv", csv)]).load("r.toml");
    let scene = load(&measured(", degrees = true"), degrees).unwrap();
    let other = load(&measured(""), &radians).unwrap();
    assert_eq!(scene.materials[0].lobe.roughness, other.materials[0].lobe.roughness);
    // The file keeps its unit, so that what is written reads back.
    let again = load(&scene.to_recipe(), degrees).unwrap();
    assert!(again.materials[0].asks_the_same(&scene.materials[0]), "{}", scene.to_recipe());
    assert!(!other.to_recipe().contains("degrees"));

    // Errors have the place in the recipe, the file, and the line in it.
    for (csv, parts) in [
        (degrees, ["d.csv: line 3: the angle 10", "degrees = true"]),
        ("0,1\n\n\n0.1,-1\n0.2,1", ["d.csv: line 4: D = -1", ""]),
        ("D,theta\n1,0", ["d.csv: line 1: ", "angle first"]),
    ] {
        let message = load(&measured(""), csv).unwrap_err().to_string();
        assert!(message.contains("r.toml:3:16: "), "{message}");
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

#[test]
fn a_haze_is_a_lobe_with_a_weight() {
    let range = |min, max| Interval { min, max };
    let core = "sigma = 0.1\ngamma = { min = 2, max = 3 }";
    let of = |haze: &str| {
        let scene = load("r.toml", &entry(&format!("{core}\nhaze = {haze}")));
        reads_back(&scene);
        let haze = scene.materials[0].haze.clone().unwrap();
        assert_eq!(scene.materials[0].lobe.gamma, range(2.0, 3.0));
        (haze.weight, haze.lobe)
    };
    let family = |roughness, gamma| LobeSpec::family(roughness, gamma);
    // The shape is that of the core unless the haze has its own.
    let shaped = family(isotropic(0.5), range(2.0, 3.0));
    assert_eq!(of("{ weight = 0.3, sigma = 0.5 }"), (Interval::point(0.3), shaped));
    let beckmann = family(anisotropic(0.5, 0.25), Interval::point(f64::INFINITY));
    let stated = "{ weight = { min = 0, max = 1 }, sigma = [0.5, 0.25], gamma = \"inf\" }";
    assert_eq!(of(stated), (range(0.0, 1.0), beckmann));
    let (_, tilted) =
        of("{ weight = 1, sigma = 0.5, gamma = 2, theta = [0, 10, 0], degrees = true }");
    assert_eq!(tilted.theta, Some([0.0, 10.0_f64.to_radians(), 0.0]));
    let (_, gauss) = of("{ weight = 0, distribution = \"gauss\", m = 0.2 }");
    assert_eq!(gauss.distribution.unwrap().label(), "gauss:0.2");
    let (_, member) = of("{ weight = 0, distribution = \"beckmann\", m = 0.2 }");
    assert_eq!(member, family(isotropic(0.2), Interval::point(f64::INFINITY)));
    // A core of another distribution has no shape to share, and takes a haze all the same.
    let gauss = "distribution = \"gauss\"\nm = 0.1\nhaze = { weight = 0.3, sigma = 0.5";
    refuse(&format!("{gauss} }}"), "the haze has no `gamma`; add for example gamma = 2.0");
    reads_back(&load("r.toml", &entry(&format!("{gauss}, gamma = 3 }}"))));
    // As a table of its own.
    let table = entry(&format!("{core}\n[material.haze]\nweight = 0.3\nsigma = 0.5"));
    let inline = entry(&format!("{core}\nhaze = {{ weight = 0.3, sigma = 0.5 }}"));
    let [table, inline] = [table, inline].map(|text| load("r.toml", &text).materials);
    assert!(table[0].asks_the_same(&inline[0]));
    for other in [core.to_owned(), format!("{core}\nhaze = {{ weight = 0.4, sigma = 0.5 }}")] {
        assert!(!material_of(&other).asks_the_same(&inline[0]), "{other}");
    }
}

#[test]
fn a_share_of_retroreflection_is_a_number_or_a_range() {
    let of = |share: &str| {
        let scene = load("r.toml", &entry(&format!("sigma = 0.1\ngamma = 3\n{share}")));
        reads_back(&scene);
        scene.materials[0].retroreflection
    };
    assert_eq!(of(""), MaterialEntry::SPECULAR);
    assert_eq!(of("retroreflection = 0"), MaterialEntry::SPECULAR);
    assert_eq!(of("retroreflection = 0.25"), Interval::point(0.25));
    let range = Interval { min: 0.0, max: 1.0 };
    assert_eq!(of("retroreflection = { min = 0, max = 1 }"), range);
    // A dielectric may state it: what it reflects goes back, what it refracts does not.
    let pane = "retroreflection = 1\nfresnel = { dielectric = 1.5 }";
    assert_eq!(of(pane), Interval::point(1.0));
    let tilted = "sigma = 0.1\ngamma = 3\ntheta = [0.1, 0, 0]";
    assert_eq!(material_of(tilted).retroreflection, MaterialEntry::SPECULAR);
    let none = material_of(&format!("{tilted}\nretroreflection = 0"));
    assert_eq!(none.retroreflection, MaterialEntry::SPECULAR);
}

#[test]
fn unused_materials_are_no_part_of_the_recipe() {
    let mut scene = load("r.toml", &entry("sigma = 0.3\ngamma = 2.0"));
    assert!(!scene.to_recipe().is_empty());
    scene.materials[0].used = false;
    assert_eq!(scene.to_recipe(), "");
}

fn interval(ends: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = Interval> {
    let range =
        (ends.clone(), ends.clone()).prop_map(|(a, b)| Interval { min: a.min(b), max: a.max(b) });
    prop_oneof![ends.prop_map(Interval::point), range]
}

fn roughness() -> impl Strategy<Value = Roughness> {
    let sigma = || interval(1e-300..1e3);
    prop_oneof![
        Just(Roughness::Smooth),
        sigma().prop_map(Roughness::Isotropic),
        (sigma(), sigma()).prop_map(|(x, y)| Roughness::Anisotropic { x, y }),
    ]
}

fn material() -> impl Strategy<Value = Material> {
    let gamma = || interval(prop_oneof![1.500_001..1e6, Just(f64::INFINITY)]);
    let lobe = || (roughness(), gamma()).prop_map(|(sigma, gamma)| LobeSpec::family(sigma, gamma));
    let fresnel = prop_oneof![
        Just(Reflectance::Mirror),
        (0.0..=1.0).prop_map(|f0| Reflectance::Schlick([f0; 3])),
        prop::array::uniform3(0.0..=1.0).prop_map(Reflectance::Schlick),
        (1e-3..10.0).prop_map(Reflectance::dielectric),
        (prop::array::uniform3(1e-3..10.0), prop::array::uniform3(0.0..10.0))
            .prop_map(|(eta, k)| Reflectance::Conductor { eta, k }),
    ];
    let masking = prop::sample::select(&Masking::ALL[..]);
    let name = ".+";
    let haze = (interval(0.0..=1.0), lobe());
    let haze = haze.prop_map(|(weight, lobe)| Haze { weight, lobe });
    let (fresnel, masking) = (prop::option::of(fresnel), prop::option::of(masking));
    let parts = (name, lobe(), prop::option::of(haze), interval(0.0..=1.0), fresnel, masking);
    parts.prop_map(|(name, lobe, haze, retroreflection, fresnel, masking)| Material {
        name,
        lobe,
        haze,
        retroreflection,
        fresnel,
        masking,
        origin: Origin {
            format: Format::Pbrt,
            place: Place { file: Path::new("scene.pbrt").into(), line: None, column: None },
            lobe: None,
        },
        used: true,
    })
}

proptest! {
    #[test]
    fn a_written_recipe_reads_back_bit_for_bit(mut materials in prop::collection::vec(material(), 1..8)) {
        for (i, material) in materials.iter_mut().enumerate() {
            material.name.push_str(&i.to_string());
        }
        let mut scene = Scene::default();
        scene.materials = materials;
        let recipe = scene.to_recipe();
        let again = Scene::from_recipe_str(&recipe).unwrap();
        prop_assert_eq!(again.materials.len(), scene.materials.len());
        for (a, b) in again.materials.iter().zip(&scene.materials) {
            prop_assert!(a.asks_the_same(b), "{:?} is not {:?}", a, b);
        }
        prop_assert_eq!(again.to_recipe(), recipe);
    }
}
