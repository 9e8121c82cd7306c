//! Materials of two lobes: what a plan says of both, and what a set has of both.

use std::fs;

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Settings, bake_with};
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{VERSION, encode};
use serde_json::{Value, json};
use tempfile::tempdir;

use super::plan::DRAFT;
use crate::common::json;

const RECIPE: &str = "[[material]]\nname = \"hazy\"\nsigma = 0.1\ngamma = 2.5\n\
    haze = { weight = { min = 0.2, max = 0.4 }, sigma = [0.5, 0.25], gamma = \"inf\" }\n\
    retroreflection = 0.5\nfresnel = \"mirror\"\n\n\
    [[material]]\nname = \"plain\"\nsigma = 0.5\ngamma = 2.5\n";

#[test]
fn a_plan_has_the_haze_with_its_verdicts_inside_the_material() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("r.toml"), RECIPE).unwrap();
    let said = json(folder.path(), &["plan", "r.toml"]);
    let [hazy, plain] = [0, 1].map(|i| &said["materials"][i]);
    assert_eq!((&plain["haze"], &plain["retroreflection"]), (&Value::Null, &json!([0.0, 0.0])));
    assert_eq!(hazy["retroreflection"], json!([0.5, 0.5]));
    let haze = &hazy["haze"];
    assert_eq!(haze["weight"], json!([0.2, 0.4]));
    assert_eq!(haze["sigma"], json!([[0.5, 0.5], [0.25, 0.25]]));
    assert_eq!(haze["gamma"], json!(["inf", "inf"]));
    for key in ["distribution", "theta", "shares_with", "stand_in"] {
        assert_eq!(haze.get(key), Some(&Value::Null), "{key}");
    }
    let verdicts = |of: &Value| [&of["verdict"], &of["albedo"][0]].map(|it| it.clone());
    assert_eq!(
        [hazy, haze].map(verdicts),
        [["baked", "baked"].map(Value::from), ["baked"; 2].map(Value::from)]
    );
    assert_eq!(verdicts(plain), ["same", "no fresnel"].map(Value::from));
    assert_eq!(plain["shares_with"], "hazy");
    assert_eq!((&hazy["shapes"], &haze["shapes"]), (&json!(1), &json!(0)));
    let sigmas = |i: usize| said["albedo"][i]["sigma"].clone();
    assert_eq!([sigmas(0), sigmas(1)], [json!([[0.1, 0.1], [0.1, 0.1]]), haze["sigma"].clone()]);
    assert_eq!(said["shapes"][0]["materials"], json!(["hazy"]));
}

#[test]
fn a_set_has_certified_tables_of_both_lobes_and_reads_back() {
    let plan = Plan::new(&Scene::from_recipe_str(RECIPE).unwrap(), Options::default()).unwrap();
    let settings = Settings { cache: Cache::none(), ..Settings::default() };
    let set = bake_with(&plan, DRAFT, settings).unwrap().set;
    let entry = set.provenance().materials[0].clone();
    assert_eq!(entry, plan.materials[0]);
    for lobe in entry.lobes() {
        assert!(set.student_t(lobe.sigma(), lobe.gamma()).is_ok(), "{lobe:?}");
        let own = |table: &&microfacet_tables::Table| {
            table.kind.is_albedo() && table.subject.lobe.contains(&lobe.tabulated())
        };
        let table = set.tables().iter().find(own).unwrap();
        assert_eq!(table.subject.masking, Some(Masking::HeightCorrelated));
        assert!((1e-7..1e-2).contains(&table.certificate.worst()), "{:?}", table.certificate);
    }
    let bytes = encode(set.provenance(), set.tables()).unwrap();
    let stated = format!(r#"\"version\":{VERSION}"#);
    assert!(bytes.windows(stated.len()).any(|at| at == stated.as_bytes()));
    let again = Tables::from_bytes(&bytes).unwrap();
    assert_eq!(again, set);
    // What is cut out of the set keeps the tables of both lobes.
    assert_eq!(again.only(&["hazy"]).unwrap().tables(), set.tables());
}
