//! A budget of bytes for tables of all kinds is filled, never exceeded, and refused with the
//! smallest one that is possible.

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{BakeError, Baked, Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, Table, encode};

use crate::common::{ok, refused};

const GOLD: &str =
    "[[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 2.0\nfresnel = \"mirror\"\n";
const CLOTH: &str = "[[material]]\nname = \"cloth\"\ndistribution = \"gauss\"\nm = 0.25\n";
const GLASS: &str = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";

fn within(recipe: &str, max_bytes: usize, cache: &Cache) -> Result<Baked, BakeError> {
    let scene = Scene::from_recipe_str(recipe).unwrap();
    let plan = Plan::new(&scene, Options::default()).unwrap();
    bake_with(
        &plan,
        Target::MaxBytes(max_bytes),
        Settings { cache: cache.clone(), ..Settings::default() },
    )
}

fn bytes(set: &Tables) -> Vec<u8> {
    encode(set.provenance(), set.tables()).unwrap()
}

fn worst<'a>(tables: impl Iterator<Item = &'a Table>) -> f64 {
    tables.map(|table| table.certificate.worst()).fold(0.0, f64::max)
}

#[test]
fn all_kinds_of_tables_share_a_budget() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().into());
    let recipe = [GOLD, CLOTH, GLASS].concat();
    let refused = within(&recipe, 1000, &cache).unwrap_err();
    let BakeError::TooSmall { max_bytes: 1000, smallest: planned, planned: true } = refused else {
        panic!("{refused}")
    };
    assert!(refused.to_string().contains(&format!("about {planned}")), "{refused}");
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none(), "tables were baked");
    // Close to what is planned the smallest set is baked, and its file decides.
    let refused = within(&recipe, planned * 961 / 1000, &cache).unwrap_err();
    let BakeError::TooSmall { smallest, planned: false, .. } = refused else { panic!("{refused}") };
    assert!(smallest.abs_diff(planned) < planned / 25, "{smallest} where {planned} were planned");
    assert!(matches!(within(&recipe, smallest - 1, &cache), Err(BakeError::TooSmall { .. })));

    let mut before = f64::INFINITY;
    for max_bytes in [smallest, smallest + 3000, 110_000] {
        let set = within(&recipe, max_bytes, &cache).unwrap().set;
        let file = bytes(&set);
        assert!(file.len() <= max_bytes, "{} bytes of {max_bytes}", file.len());
        // Visible normals take the bytes that are left.
        let (graded, normals): (Vec<_>, Vec<_>) = set
            .tables()
            .iter()
            .partition(|table| table.kind.is_albedo() || table.name.contains("radial"));
        assert_eq!((graded.len(), normals.len()), (5, 3));
        let error = worst(graded.iter().chain(&normals).copied());
        assert!(
            error <= before && worst(normals.into_iter()) <= error,
            "{max_bytes}: {error} after {before}"
        );
        before = error;
        // The cache gives the same set.
        let again = within(&recipe, max_bytes, &cache).unwrap();
        assert!(again.baked == 0 && bytes(&again.set) == file);
        assert_eq!(Tables::from_bytes(&file).unwrap(), set);
    }
    // The larger budget pays: it buys a better quality of the distribution, which takes most of it.
    assert!(before < 1e-4, "{before}");
}

#[test]
fn without_visible_normals_the_tables_in_grades_are_all_there_is() {
    let at = |max_bytes| within(CLOTH, max_bytes, &Cache::none()).unwrap().set;
    let small = at(35_000);
    assert!(bytes(&small).len() <= 35_000);
    assert!(small.tables().iter().all(|table| table.precision == Precision::U16));
    let large = at(100_000);
    assert!(bytes(&large).len() <= 100_000);
    assert!(3.0 * worst(large.tables().iter()) < worst(small.tables().iter()));
}

/// What tables of one layout share is planned once, or sets of many would be refused that fit.
#[test]
fn many_small_tables_fit_into_the_bytes_that_they_take() {
    let metal = |i| {
        format!(
            "[[material]]\nname = \"{i}\"\nsigma = {}\ngamma = 2.0\nfresnel = {{ metal = \"gold\" }}\n",
            0.1 + 0.01 * f64::from(i)
        )
    };
    let recipe: String = (0..24).map(metal).collect();
    let plan = Plan::new(&Scene::from_recipe_str(&recipe).unwrap(), Options::default()).unwrap();
    let coarsest = Target::Quality(Quality::Draft, Precision::U16);
    let smallest = bytes(&bake_with(&plan, coarsest, Settings::default()).unwrap().set).len();
    assert!(bytes(&within(&recipe, smallest, &Cache::none()).unwrap().set).len() <= smallest);
}

#[test]
fn too_few_bytes_are_refused_before_any_work_with_the_options_that_fit() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let recipe = |name: &str, one: fn(usize) -> String| {
        let all: String =
            (0..8).map(|i| format!("[[material]]\nname = \"{i}\"\n{}\n", one(i))).collect();
        std::fs::write(at.join(name), all).unwrap();
    };
    recipe("brushed.toml", |i| format!("sigma = [0.1{i}, 0.3]\ngamma = 3.0\nfresnel = \"mirror\""));
    recipe("shapes.toml", |i| format!("sigma = 0.3\ngamma = {}", 3 + i));
    for (scene, fits, not) in [
        ("brushed.toml", "--no-albedo", "--embedded"),
        ("shapes.toml", "--embedded", "--no-albedo"),
    ] {
        let bake = ["bake", scene, "--max-bytes", "7000", "--cache", "cache", "--out", "out"];
        let said = refused(at, &bake);
        assert!(said.contains(&format!("what fits: {fits} (about ")), "{said}");
        assert!(said.contains("fits into 7000 bytes") && !said.contains(not), "{said}");
        assert!(!at.join("cache").exists() && !at.join("out").exists());
        ok(at, &[&bake[..], &[fits]].concat());
        assert!(std::fs::metadata(at.join("out/tables.safetensors")).unwrap().len() <= 7000);
        std::fs::remove_dir_all(at.join("out")).unwrap();
        let _ = std::fs::remove_dir_all(at.join("cache"));
    }
    // Nothing fits into a hundred bytes.
    let none = refused(at, &["bake", "shapes.toml", "--max-bytes", "100", "--out", "out"]);
    assert!(none.contains("100 bytes") && !none.contains("what fits"), "{none}");
}
