//! Errors and bytes that a bake is asked to keep to.

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::Plan;
use microfacet_baker::table_set::{BakeError, Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, Quantity};

use super::plan::{bake, bytes, normals_of, plan, scene, worst};
use crate::common::refused;

#[test]
fn an_error_budget_is_met_by_less() {
    let plan = plan(&scene(&[["glass", "0.454", "3.0"]]));
    let at = |target| bake(&plan, target, &Cache::none()).unwrap().set;
    let default = at(Target::Quality(Quality::Default, Precision::F32));
    let mut before = bytes(&default).len();
    for max_error in [1e-4, 1e-3, 1e-2] {
        let set = at(Target::MaxError(max_error));
        assert!(worst(&set) <= max_error, "{max_error}: {}", worst(&set));
        let size = bytes(&set).len();
        assert!(size < before, "{size} bytes for an error of {max_error}, {before} for less");
        // The certificates hold for the set that a reader gets.
        assert_eq!(Tables::from_bytes(&bytes(&set)).unwrap(), set);
        before = size;
    }
    let error = bake(&plan, Target::MaxError(1e-12), &Cache::none()).unwrap_err().to_string();
    assert!(error.contains("1e-12") && error.contains("reaches"), "{error}");
    for nonsense in [0.0, -1e-4, f64::NAN] {
        let error =
            bake(&plan, Target::MaxError(nonsense), &Cache::none()).unwrap_err().to_string();
        assert!(error.contains("above 0"), "{error}");
    }
}

#[test]
fn budgets_of_the_general_set_end() {
    let plan = normals_of(&Plan::general());
    let met = bake(&plan, Target::MaxError(2e-3), &Cache::none()).unwrap().set;
    assert!(met.tables().len() == 5 && worst(&met) <= 2e-3, "{}", worst(&met));
    let filled = bake(&plan, Target::MaxBytes(100_000), &Cache::none()).unwrap().set;
    assert!(bytes(&filled).len() <= 100_000);
    // With more bytes than that error takes, the error is less.
    assert!(bytes(&met).len() < 100_000 && worst(&filled) < worst(&met), "{}", worst(&filled));
    // Masking that peeling uses is as fine as what it is peeled from requires.
    let peeled = |name: &str| filled.tables().iter().find(|table| table.name == name).unwrap();
    assert!(
        peeled("shadowing_peeled").certificate.error(Quantity::G1).unwrap() < 0.1 * worst(&filled)
    );
}

#[test]
fn what_would_take_long_says_so_before_anything_is_baked() {
    for target in [Target::MaxError(1e-5), Target::MaxBytes(20_000_000)] {
        let settings = Settings::default();
        let progress = settings.progress.clone();
        let refused = bake_with(&Plan::general(), target, settings).unwrap_err();
        assert_eq!(progress.share(), 0.0, "it was begun");
        let BakeError::TooSlow { search, default_seconds } = refused else { panic!("{refused}") };
        assert!(search > 3.0 * default_seconds && default_seconds > 1.0, "{refused}");
    }
    let folder = tempfile::tempdir().unwrap();
    let message = refused(folder.path(), &["bake", "--max-error", "1e-5", "--out", "out"]);
    assert!(message.contains("--patient") && message.contains(" s"), "{message}");
    assert!(!folder.path().join("out/tables.safetensors").exists());
}

#[test]
fn a_byte_budget_is_filled_and_not_exceeded() {
    let plan = plan(&scene(&[["glass", "0.454", "3.0"]]));
    let at = |max_bytes| bake(&plan, Target::MaxBytes(max_bytes), &Cache::none());
    let [small, large] = [5_000, 8_000].map(|limit| {
        let set = at(limit).unwrap().set;
        assert!(bytes(&set).len() <= limit);
        set
    });
    assert!(worst(&large) < worst(&small));
    let error = at(2_000).unwrap_err().to_string();
    assert!(error.contains("2000 bytes"), "{error}");
}
