//! Whole pages: what they say and in which words, the escaping of names, scripts, and their size.

use std::borrow::Cow;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use microfacet_baker::escape;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{MaterialEntry, Table};
use microfacet_validate::record::{Record, Returned, identity};
use sha2::{Digest, Sha256};

use super::subjects::Subjects;
use super::{Source, curves, energy, overview, page};

/// The draft tables of a recipe.
pub(crate) fn baked(recipe: &str) -> Tables {
    let plan = Plan::new(&Scene::from_recipe_str(recipe).unwrap(), Options::default()).unwrap();
    bake(&plan, Target::Quality(Quality::Draft, Default::default())).unwrap().set
}

/// Tables of a shape, and GGX in closed form.
fn set() -> Tables {
    baked(
        "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\nfresnel = { schlick = 0.5 }\n\
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
    const HOSTILE: &str = "\" onload=\"</script><!--<img onerror='x'>\u{202e}&amp;";
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
    let reflectances = data["reflectances"].as_array().unwrap();
    let name = format!("{HOSTILE}a");
    assert!(reflectances.iter().any(|of| of["name"] == name[..]), "{reflectances:?}");
}

/// What reverses the order of letters, or is not seen, is written out wherever it stands, and in
/// recipes so that they can be copied.
#[test]
fn every_character_is_seen() {
    let odd: String = ('\u{202a}'..='\u{202e}')
        .chain('\u{2066}'..='\u{2069}')
        .chain(['\u{200e}', '\u{200f}', '\u{200b}', '\u{1b}'])
        .collect();
    let page = marked(&odd);
    let seen = escape::lines(&page);
    assert!(matches!(seen, Cow::Borrowed(_)), "the page has what is not seen");
    let shown = escape::line(&odd).into_owned();
    let names = page.matches(&format!("<bdi>{shown}")).count();
    assert!(names > 20, "{names} names");
    assert!(page.contains(&format!("<h1><bdi>{shown}</bdi></h1>")));
    let (_, recipe) = page.split_once("<summary>Recipe</summary>").unwrap();
    let (_, recipe) = recipe.split_once("<code>").unwrap();
    let recipe = recipe.split("</code>").next().unwrap().replace("&quot;", "\"");
    let scene = Scene::from_recipe_str(&recipe).unwrap();
    assert_eq!(scene.materials[0].name, format!("{odd}a"));
}

#[test]
fn long_names_are_cut() {
    let [short, long] = [1, 100_000].map(|n| marked(&"x".repeat(n)));
    assert!(long.len() < short.len() + 100_000, "{} and {} bytes", short.len(), long.len());
    let cut = format!("{}…", "x".repeat(63));
    for part in [format!("<title>{cut} · "), format!(">{cut}</bdi></h1>")] {
        assert!(long.contains(&part), "{part}");
    }
    assert!(long.contains(&format!("<bdi title=\"{}…\">{cut}</bdi>", "x".repeat(999))));
}

/// A browser runs the scripts whose hashes the page states, and no others.
#[test]
fn the_policy_lists_the_scripts_by_hash() {
    let source = Source { name: "a set", set: &set(), validation: None };
    let page = page(&source, &Meter::default()).unwrap();
    let (_, policy) = page.split_once("Content-Security-Policy\" content=\"").unwrap();
    let (policy, _) = policy.split_once('"').unwrap();
    let (_, sources) = policy.split_once("script-src").unwrap();
    let sources: Vec<&str> = sources.split(';').next().unwrap().split_whitespace().collect();
    let scripts = page.split("<script type=\"module\">").skip(1);
    let hashes: Vec<String> = scripts
        .map(|rest| rest.split("</script>").next().unwrap())
        .map(|script| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script))))
        .collect();
    assert_eq!(hashes, sources);
    assert_eq!(hashes.len(), 2);
    for closed in ["default-src 'none'", "base-uri 'none'", "form-action 'none'"] {
        assert!(policy.contains(closed), "{policy}");
    }
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

/// The sections of figures, in which `of` is a set.
fn figures(of: &Tables) -> [String; 2] {
    let source = Source { name: "a set", set: of, validation: None };
    let subjects = Subjects::of(of);
    let energy = energy::section(&source, &subjects, &Meter::default()).unwrap();
    [curves::section(&source, &subjects), energy].map(|section| section.into_string())
}

#[test]
fn an_anisotropic_lobe_shows_the_albedo_of_its_own_table() {
    let recipe = "[[material]]\nname = \"brushed\"\nsigma = [0.1, 0.8]\ngamma = 3\n";
    let set = baked(&format!("{recipe}fresnel = \"mirror\"\n"));
    let own = set.material_albedo("brushed").unwrap();
    let round = Tables::embedded().albedo(0.08_f64.sqrt(), 3.0, own.masking()).unwrap();
    let (sin, cos) = 80_f32.to_radians().sin_cos();
    let at = |e: f32, what: &str| format!("{e:.3} ({what})");
    let [along_x, along_y] = [[sin, 0.0, cos], [0.0, sin, cos]];
    let [curves, energy] = figures(&set);
    for part in [
        at(own.albedo(along_x), "along x"),
        at(own.albedo(along_y), "along y"),
        at(round.albedo(along_x), "the round lobe"),
    ] {
        assert!(curves.contains(&part), "{part} in {curves}");
    }
    assert!((own.albedo(along_x) - own.albedo(along_y)).abs() > 0.05);
    for title in [">White furnace, view along x<", ">White furnace, view along y<"] {
        assert!(energy.contains(title), "{title}");
    }
    assert!(energy.contains("its own albedo") && !energy.contains("stands in"), "{energy}");
    // Without a table of its own, the round lobe stands in, and both sections say so.
    let [curves, energy] = figures(&baked(recipe));
    assert!(curves.contains("stands in") && energy.contains("stands in"));
    assert!(!curves.contains("along y") && !energy.contains("along y"));
}

/// Furnaces of a good and of a bad lobe can be compared: their axes have the same numbers.
#[test]
fn furnaces_share_a_logarithmic_axis() {
    let [_, energy] = figures(&baked(
        "[[material]]\nname = \"a\"\nsigma = 0.02\ngamma = 3\n\
         [[material]]\nname = \"b\"\nsigma = 1.0\ngamma = 3\n",
    ));
    let numbers = |figure: &str| -> Vec<String> {
        let texts = figure.split("</text>").filter_map(|rest| rest.rsplit('>').next());
        texts.filter(|text| text.starts_with("10")).map(str::to_owned).collect()
    };
    let all: Vec<Vec<String>> = energy.split("<figure").skip(1).map(numbers).collect();
    assert_eq!(all.len(), 2);
    assert_eq!(all[0], all[1]);
    assert_eq!([&all[0][0], &all[0][all[0].len() - 1]], ["10⁻⁷", "10⁰"]);
}

/// One word for one thing: `G1` is masking, whatever a file calls its tables.
#[test]
fn masking_has_one_name() {
    let set = set();
    let tables = set.tables().iter().cloned().enumerate();
    let renamed = tables.map(|(i, mut table)| {
        table.name = format!("table {i}");
        table
    });
    let mut origin = set.provenance().clone();
    origin.conventions.clear();
    let set = Tables::from_tables(origin, renamed.collect()).unwrap();
    let source = Source { name: "a set", set: &set, validation: None };
    let page = page(&source, &Meter::default()).unwrap();
    let text = page.split("<script").next().unwrap();
    assert!(text.contains("masking G1 of a view") && text.contains("Masking G1"));
    for other in ["hadowing", "Smith"] {
        assert!(!text.contains(other), "{other}");
    }
}
