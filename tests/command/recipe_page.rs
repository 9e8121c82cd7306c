//! The page of recipes, and the recipe that the command prints: what they show can be baked.

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{Lobe, Metal};
use microfacet_tables::Precision;

use crate::common::{Desk, has};

const PAGE: &str = include_str!("../../docs/recipe.md");

/// The blocks of a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let begin = format!("\n```{language}\n");
    let blocks: Vec<_> =
        PAGE.split(&begin[..]).skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(!blocks.is_empty(), "no block of {language}");
    blocks
}

/// Every block is a recipe whose materials are baked, albedos included.
#[test]
fn every_example_of_the_page_bakes() {
    let [csv] = blocks("csv")[..] else { panic!("the page has one CSV") };
    let desk = Desk::new(&[("steel.csv", csv)]);
    for recipe in blocks("toml") {
        desk.write("recipe.toml", recipe);
        let scene = microfacet_scene::load(&desk.join("recipe.toml"));
        let scene = scene.unwrap_or_else(|why| panic!("{why} in\n{recipe}"));
        assert_eq!(scene.warnings, [""; 0], "{recipe}");
        assert_eq!(scene.materials.len(), recipe.matches("[[material]]").count(), "{recipe}");
        let plan = Plan::new(&scene, Options::default()).unwrap();
        let target = Target::Quality(Quality::Draft, Precision::F32);
        let set = bake(&plan, target).unwrap_or_else(|why| panic!("{why} in\n{recipe}")).set;
        for material in &scene.materials {
            let lobe = set.material(&material.name);
            let lobe = lobe.unwrap_or_else(|why| panic!("{}: {why}", material.name));
            assert_eq!(matches!(lobe, Lobe::Smooth(_)), material.name == "smooth");
        }
        assert_eq!(recipe.contains("fresnel"), set.tables().iter().any(|t| t.kind.is_albedo()));
    }
}

#[test]
fn every_distribution_and_its_parameters_are_on_the_page() {
    let rows: Vec<&str> = PAGE.lines().filter(|line| line.starts_with("| `")).collect();
    for kind in DistributionKind::ALL {
        let name = format!("| `{}`", kind.name());
        let row = rows.iter().find(|row| row.starts_with(&name));
        let row = row.unwrap_or_else(|| panic!("docs/recipe.md: no row of `{}`", kind.name()));
        for key in kind.parameters() {
            assert!(row.contains(&format!("`{key}`")), "docs/recipe.md: no `{key}` in {row}");
        }
        let example = format!("distribution = \"{}\"", kind.name());
        assert!(PAGE.contains(&example), "docs/recipe.md: no example {example}");
    }
}

/// The table of metals states the numbers that `{ metal = .. }` stands for.
#[test]
fn every_metal_and_its_index_are_on_the_page() {
    let (_, section) = PAGE.split_once("\n### Metals\n").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let rows: Vec<&str> = section.lines().filter(|line| line.starts_with("| `")).collect();
    assert_eq!(rows.len(), Metal::ALL.len(), "one row for each metal");
    for (row, metal) in rows.iter().zip(Metal::ALL) {
        let triple = |x: [f64; 3]| x.map(|x| format!("{x:.3}")).join(", ");
        let numbers = format!("| `{metal}` | {} | {} | ", triple(metal.eta()), triple(metal.k()));
        assert!(row.starts_with(&numbers), "docs/recipe.md: {row}\nis not {numbers}");
        assert!(row.ends_with(&format!("]({}) |", metal.source())), "docs/recipe.md: {row}");
    }
}

#[test]
fn the_recipe_to_start_from_bakes_as_it_is_and_overwrites_nothing() {
    let desk = Desk::new(&[]);
    let printed = desk.ok("recipe");
    assert_eq!(desk.ok("recipe --out mine.toml"), "mine.toml\n");
    assert_eq!(desk.read("mine.toml"), printed.as_bytes());
    let summary = desk.ok("bake mine.toml --out out --quality draft --no-cache");
    has(&summary, &["albedo_", "visible_slope"]);

    desk.write("mine.toml", "mine");
    desk.refuses("recipe -o mine.toml", &["mine.toml: ", "exists"]);
    assert_eq!(desk.read("mine.toml"), b"mine");
}

/// The recipe of a scene has its materials, bit for bit.
#[test]
fn the_recipe_of_a_scene_reads_back_to_its_materials() {
    let files = [
        (
            "s.pbrt",
            "WorldBegin\nMakeNamedMaterial \"steel\" \"string type\" \"conductor\" \"float roughness\" 0.1\n\
             MakeNamedMaterial \"glass\\n#\" \"string type\" \"dielectric\" \"float uroughness\" 0.04 \
             \"float vroughness\" 0.3\n",
        ),
        (
            "s.xml",
            "<scene version=\"3.0.0\"><bsdf type=\"roughconductor\" id=\"gold\">\
             <float name=\"alpha\" value=\"0.3\"/><string name=\"material\" value=\"Au\"/></bsdf>\
             <bsdf type=\"roughplastic\" id=\"plastic\"><string name=\"distribution\" value=\"ggx\"/></bsdf>\
             </scene>",
        ),
        (
            "s.gltf",
            r#"{"asset":{"version":"2.0"},"materials":[{"name":"a","pbrMetallicRoughness":
            {"roughnessFactor":0.7}},{"name":"a","pbrMetallicRoughness":{"roughnessFactor":0.2}}]}"#,
        ),
        (
            "s.toml",
            "[[material]]\nname = \"a\"\nsigma = [0.1, { min = 0.2, max = 0.3 }]\ngamma = \"inf\"\n\
             haze = { weight = 0.3, distribution = \"gauss\", m = 0.2 }\nretroreflection = 0.5\n",
        ),
    ];
    let desk = Desk::new(&files);
    for (name, _) in files {
        let scene = microfacet_scene::load(&desk.join(name)).unwrap();
        desk.ok(&format!("recipe {name} --out of-{name}.toml"));
        let again = microfacet_scene::load(&desk.join(&format!("of-{name}.toml"))).unwrap();
        let used: Vec<_> = scene.materials.iter().filter(|material| material.used).collect();
        assert!(!used.is_empty() && used.len() == again.materials.len(), "{name}");
        for (a, b) in used.iter().zip(&again.materials) {
            assert!(a.asks_the_same(b), "{name}: {a:?} is not {b:?}");
        }
    }
}
