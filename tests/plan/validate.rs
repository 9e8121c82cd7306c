//! `validate` judges every set that can be baked, and says what it cannot judge.

use std::fs;

use tempfile::TempDir;

use microfacet_sampler::Tables;
use microfacet_tables::{Kind, Precision, encode};

use crate::common::{json, names, ok, refused, run};

/// A folder with a draft of a recipe's set in `set`.
fn baked(recipe: &str) -> TempDir {
    baked_as("draft", recipe)
}

fn baked_as(quality: &str, recipe: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("r.toml"), recipe).unwrap();
    let options = ["--quality", quality];
    ok(folder.path(), &[&["bake", "r.toml", "--out", "set"], &options[..]].concat());
    folder
}

fn material(lines: &str) -> String {
    format!("[[material]]\nname = \"m\"\nsigma = 0.3\n{lines}\n")
}

/// Ranges of γ whose kinds of tables have axes of different ends.
#[test]
fn every_range_of_shapes_can_be_judged() {
    for range in
        ["1.6, max = 4", "2, max = 10", "3, max = 4", "2, max = \"inf\"", "1.55, max = 1.7"]
    {
        let folder = baked(&material(&format!("gamma = {{ min = {range} }}")));
        let few = ["validate", "set", "--samples", "20000", "--configurations", "40"];
        assert!(ok(folder.path(), &few).ends_with("PASSED\n"), "{range}");
    }
}

/// Ranges narrower than rounding, and ranges that begin or end beside the seam at γ = 1.8.
#[test]
fn the_narrowest_ranges_are_baked_and_judged() {
    for range in [
        "1.7999999999, max = 2",
        "1.7999999999, max = 1.8",
        "1.7999999995, max = 1.8",
        "1.799999999, max = 1.8",
        "1.8, max = 1.8000000000000003",
        "2.5, max = 2.5000000000000004",
        "1.501, max = 1.5010000000000003",
    ] {
        let folder = baked_as("default", &material(&format!("gamma = {{ min = {range} }}")));
        let few = ["validate", "set", "--samples", "20000", "--configurations", "8"];
        assert!(ok(folder.path(), &few).ends_with("PASSED\n"), "{range}");
    }
}

/// Sets of single shapes, of GGX in closed form, and of both.
#[test]
fn sets_of_single_shapes_pass_the_stress_test() {
    let folder = baked(&material("gamma = 3.0"));
    let stressed = json(folder.path(), &["validate", "set", "--stress", "--points", "1"]);
    assert!(stressed["passed"] == true && stressed["points"].as_u64() > Some(50_000), "{stressed}");
    let two = "[[material]]\nname = \"ggx\"\nsigma = 0.2\ngamma = 2.0\n";
    let folder = baked(&(material("gamma = 1.6") + two));
    let stressed = json(folder.path(), &["validate", "set", "--stress", "--points", "1"]);
    assert!(stressed["passed"] == true, "{stressed}");
    let regions = stressed["regions"].as_array().unwrap();
    assert!(regions.iter().any(|region| region["shape"] == "gamma < 4"), "GGX was not visited");
}

#[test]
fn what_has_no_lobe_is_refused_or_named() {
    let folder = baked(&material(
        "gamma = 3.0\nfresnel = { conductor = { eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.2] } }",
    ));
    // One table of a set: GGX in closed form is not its business.
    let split = ["--quality", "draft", "--format", "exr", "--split", "--out", "images"];
    let split = [&["bake", "r.toml"], &split[..]].concat();
    ok(folder.path(), &split);
    let mut refusals = 0;
    for name in names(&folder.path().join("images")) {
        let path = format!("images/{name}");
        let output = run(folder.path(), &["validate", &path, "--samples", "1000"]);
        let text = String::from_utf8(output.stdout).unwrap();
        let moments = name.starts_with("albedo") && !name.contains("conductor");
        if moments && !name.contains("average") {
            // The white furnace tests it.
            assert!(text.contains("not tested: visible normals"), "{name}: {text}");
        } else {
            assert_eq!(output.status.code(), Some(2), "{name}: {text}");
        }
        let message = refused(folder.path(), &["validate", &path, "--stress"]);
        assert!(message.contains("nothing to judge") && message.contains("folder"), "{message}");
        refusals += 1;
    }
    assert!(refusals >= 4);
    // GGX in closed form, which the materials of the set use, does not stand for the image either.
    let ggx = "[[material]]\nname = \"ggx\"\nsigma = 0.2\ngamma = 2.0\n";
    let with_ggx = baked(&(material("gamma = 3.0") + ggx));
    ok(with_ggx.path(), &split);
    let message = refused(with_ggx.path(), &["validate", "images/shadowing_gamma_3.exr"]);
    assert!(message.contains("nothing to judge"), "{message}");
    let text = ok(with_ggx.path(), &["validate", "set", "--samples", "20000"]);
    assert!(text.contains("--gamma 2 "), "GGX was not tested: {text}");
    let few = ["validate", "set", "--samples", "20000", "--configurations", "10"];
    let text = ok(folder.path(), &few);
    assert!(text.contains("not tested: albedo_"), "{text}");
}

/// A right set is rejected rarely, also by a single configuration; a wrong one surely.
#[test]
fn a_single_configuration_is_not_rejected_by_chance() {
    let folder = tempfile::tempdir().unwrap();
    let one = ["validate", "--sigma", "0.3", "--gamma", "3", "--theta", "0"];
    for seed in ["1", "2", "3"] {
        assert!(ok(folder.path(), &[&one[..], &["--seed", seed]].concat()).contains("PASSED"));
    }
    let wrong = [&one[..], &["--perturb-gamma", "1.05"]].concat();
    let output = run(folder.path(), &wrong);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.code() == Some(1) && text.contains("other seeds (--seed)"), "{text}");
}

#[test]
fn half_of_pi_may_be_typed() {
    let folder = tempfile::tempdir().unwrap();
    let one = ["validate", "--sigma", "0.3", "--gamma", "3", "--samples", "20000", "--theta"];
    for theta in ["1.5708", "1.570796", "1.5707963267948966", "0"] {
        ok(folder.path(), &[&one[..], &[theta]].concat());
    }
    for theta in ["1.58", "-0.1", "nan"] {
        refused(folder.path(), &[&one[..], &[theta]].concat());
    }
}

/// What a set states is what it is judged by: coarse nodes and 16 bits are no faults, wrong values
/// are.
#[test]
fn honest_sets_pass_at_every_precision_and_wrong_ones_do_not() {
    let folder = tempfile::tempdir().unwrap();
    const FEW: [&str; 4] = ["--samples", "20000", "--configurations", "40"];
    let validated = |set: &str, more: &[&str]| {
        let output = run(folder.path(), &[&["validate", set], &FEW[..], more].concat());
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let sets: [(&str, &[&str]); 3] = [
        ("f16", &["--precision", "f16", "--no-albedo"]),
        ("u16", &["--precision", "u16", "--no-albedo"]),
        ("draft", &["--quality", "draft"]),
    ];
    for (set, how) in sets {
        ok(folder.path(), &[&["bake", "--no-cache", "--out", set], how].concat());
        let (code, text) = validated(set, &[]);
        assert!(code == Some(0) && text.ends_with("PASSED\n"), "{set}: {text}");
        assert_eq!(validated(set, &["--perturb-gamma", "1.05"]).0, Some(1), "{set}");
    }
    let set = Tables::from_bytes(&fs::read(folder.path().join("u16/tables.safetensors")).unwrap());
    let set = set.unwrap();
    let mut tables = set.tables().to_vec();
    for table in tables.iter_mut().filter(|table| table.kind == Kind::VisibleSlope) {
        table.values.iter_mut().step_by(2).for_each(|x| *x *= 1.1);
        table.precision = Precision::F32;
    }
    let wrong = encode(set.provenance(), &tables).unwrap();
    fs::write(folder.path().join("wrong.safetensors"), wrong).unwrap();
    assert_eq!(validated("wrong.safetensors", &[]).0, Some(1));
}
