//! Whole pages: the escaping of names, and their size.

use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{MaterialEntry, Table};
use microfacet_validate::record::{Record, Returned, identity};

use super::{Source, overview, page};

/// The draft tables of a recipe.
pub(crate) fn baked(recipe: &str) -> Tables {
    let plan = Plan::new(&Scene::from_recipe_str(recipe).unwrap(), Options::default()).unwrap();
    bake(&plan, Target::Quality(Quality::Draft, Default::default())).unwrap().set
}

/// Tables of a shape, and GGX in closed form.
fn set() -> Tables {
    baked(
        "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\n\
         [[material]]\nname = \"b\"\nsigma = [0.1, 0.4]\ngamma = 2\nfresnel = \"mirror\"\n",
    )
}

/// A page of which every text that a file can state begins with `mark`.
fn marked(mark: &str) -> String {
    let set = set();
    let (mut origin, mut tables) = (set.provenance().clone(), set.tables().to_vec());
    for text in [&mut origin.generator, &mut origin.license] {
        text.insert_str(0, mark);
    }
    origin.conventions = origin
        .conventions
        .into_iter()
        .map(|(name, text)| (format!("{mark}{name}"), format!("{mark}{text}")))
        .collect();
    origin.materials.iter_mut().for_each(|entry| entry.name.insert_str(0, mark));
    tables.iter_mut().for_each(|table| table.name.insert_str(0, mark));
    let set = Tables::from_tables(origin, tables).unwrap();
    let record = Record {
        set: identity(&set).unwrap(),
        passed: true,
        samples: 1000,
        gamma_factor: 1.0,
        level: 0.01,
        level_of_one_test: 1e-4,
        rejected: 0,
        pdf_tolerance: 1e-6,
        worst_pdf_integral: None,
        configurations: Vec::new(),
        furnace_tolerance: 1e-3,
        furnaces: vec![Returned { masking: mark.into(), points: 1, lowest: 1.0, highest: 1.0 }],
        not_tested: vec![mark.into()],
    };
    let source = Source { name: mark, set: &set, validation: Some(&record) };
    page(&source, &Meter::default()).unwrap()
}

#[test]
fn what_a_file_says_is_text() {
    const HOSTILE: &str = "\" onload=\"x</script><!--<img src=x onerror='x'>\u{202e}&amp;";
    let (plain, hostile) = (marked("plain"), marked(HOSTILE));
    assert!(hostile.len() > plain.len() + 20 * HOSTILE.len(), "it is on the page");
    // Hostile names add no element, in the data of the script either.
    let elements = |page: &str| page.matches('<').count();
    assert_eq!(elements(&hostile), elements(&plain));
    let (before, rest) = hostile.split_once("<script id=\"sphere-data\"").unwrap();
    let (data, after) = rest.split_once("</script>").unwrap();
    for html in [before, after] {
        assert!(!html.contains("\" onload="), "an attribute more");
    }
    let (_, json) = data.split_once('>').unwrap();
    let data: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(data["materials"][0]["name"], format!("{HOSTILE}a"));
}

/// A page of many materials and tables shows the first ones.
#[test]
fn a_library_does_not_swell_the_page() {
    let few = set();
    let number = 2000;
    let table = |i: usize| -> Table {
        let mut table = few.tables()[i % few.tables().len()].clone();
        table.name += &format!("_{i}");
        table
    };
    let entry = |i: usize| -> MaterialEntry {
        let [entry, _] = &few.provenance().materials[..] else { panic!("two materials") };
        MaterialEntry { name: format!("material {i}"), ..entry.clone() }
    };
    let mut origin = few.provenance().clone();
    origin.materials = (0..number).map(entry).collect();
    let set = Tables::from_tables(origin, (0..number).map(table).collect()).unwrap();
    let of = |set: &Tables| {
        let source = Source { name: "a set", set, validation: None };
        overview::section(&source).into_string()
    };
    let page = of(&set);
    for said in ["1800 more materials", "1800 more tables", "inspect --details"] {
        assert!(page.contains(said), "{said}");
    }
    assert!(page.len() < 250_000, "{} bytes", page.len());
    assert!(of(&few).len() < 20_000, "{} bytes", of(&few).len());
}

#[test]
fn the_page_of_the_default_set_is_smaller_than_a_megabyte() {
    let source = Source { name: "The default set", set: &Tables::embedded(), validation: None };
    let bytes = page(&source, &Meter::default()).unwrap().len();
    println!("{bytes} bytes");
    assert!(bytes <= 1_000_000, "{bytes} bytes");
}
