//! `validate` judges every set that can be baked, and says what it cannot judge.

use microfacet_sampler::Tables;
use microfacet_tables::{Kind, Precision, encode};

use crate::common::{Desk, has, names};

const GGX: &str = "[[material]]\nname = \"ggx\"\nsigma = 0.2\ngamma = 2.0\n";

/// A folder with a recipe, and its set in `set`.
fn baked(quality: &str, recipe: &str) -> Desk {
    let desk = Desk::new(&[("r.toml", recipe)]);
    desk.ok(&format!("bake r.toml --out set --quality {quality}"));
    desk
}

fn material(lines: &str) -> String {
    crate::common::material("m", &format!("sigma = 0.3\n{lines}"))
}

#[track_caller]
fn passes(desk: &Desk, line: &str) {
    let text = desk.ok(&format!("validate {line} --samples 20000"));
    assert!(text.ends_with("PASSED\n"), "{line}: {text}");
}

/// Ranges of γ whose kinds of tables have axes of different ends.
#[test]
fn every_range_of_shapes_can_be_judged() {
    for range in
        ["1.6, max = 4", "2, max = 10", "3, max = 4", "2, max = \"inf\"", "1.55, max = 1.7"]
    {
        let desk = baked("draft", &material(&format!("gamma = {{ min = {range} }}")));
        passes(&desk, "set --configurations 40");
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
        let desk = baked("default", &material(&format!("gamma = {{ min = {range} }}")));
        passes(&desk, "set --configurations 8");
    }
}

/// Sets of single shapes, of GGX in closed form, and of both.
#[test]
fn sets_of_single_shapes_pass_the_stress_test() {
    for recipe in [material("gamma = 3.0"), material("gamma = 1.6") + GGX] {
        let stressed = baked("draft", &recipe).json("validate set --stress --points 1");
        let points = stressed["points"].as_u64().unwrap();
        assert!(stressed["passed"] == true && points > 50_000, "{stressed}");
        let regions = stressed["regions"].as_array().unwrap();
        let ggx = regions.iter().any(|region| region["shape"] == "gamma < 4");
        assert!(ggx, "{recipe} was not visited");
    }
}

#[test]
fn what_has_no_lobe_is_refused_or_named() {
    let desk = baked(
        "draft",
        &material(
            "gamma = 3.0\nfresnel = { conductor = { eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.2] } }",
        ),
    );
    // One table of a set: GGX in closed form does not stand for it.
    let split = "bake r.toml --quality draft --format exr --split --out images";
    desk.ok(split);
    let images = names(&desk.join("images"));
    assert!(images.len() >= 4, "{images:?}");
    for name in images {
        let said = desk.run(&format!("validate images/{name} --samples 1000"));
        let moments = name.starts_with("albedo") && !name.contains("conductor");
        if moments && !name.contains("average") {
            // The white furnace tests it.
            has(&said.out, &["not tested: visible normals"]);
        } else {
            said.ends(2);
        }
        let parts = ["nothing to judge", "folder"];
        desk.refuses(&format!("validate images/{name} --stress"), &parts);
    }
    has(&desk.ok("validate set --samples 20000 --configurations 10"), &["not tested: albedo_"]);
    // GGX in closed form, which the materials of the set use, does not stand for the image either.
    let with_ggx = baked("draft", &(material("gamma = 3.0") + GGX));
    with_ggx.ok(split);
    with_ggx.refuses("validate images/shadowing_gamma_3.exr", &["nothing to judge"]);
    has(&with_ggx.ok("validate set --samples 20000"), &["--gamma 2 "]);
}

/// σ and γ at a hit: of every set that has a range of γ, and refused in words where there is none.
#[test]
fn lobes_per_hit_are_judged_where_a_set_has_a_range() {
    let line = "validate set --per-hit --samples 20000";
    for range in ["1.6, max = 4", "3, max = 4", "2, max = \"inf\"", "1.55, max = 1.7"] {
        let desk = baked("draft", &material(&format!("gamma = {{ min = {range} }}")));
        let judged = desk.json(line);
        let count = judged["mixtures"].as_array().unwrap().len();
        assert!(judged["passed"] == true && [7, 14].contains(&count), "{range}: {judged}");
        let wrong = desk.run(&format!("{line} --perturb-gamma 1.01")).ends(1);
        has(&wrong.out, &["REJECTED", "largest errors", "microfacet-bake query normal"]);
    }
    let single = baked("draft", &material("gamma = 3.0"));
    single.refuses(
        line,
        &["no tables over a range of gamma", "gamma = { min = 1.6, max = \"inf\" }"],
    );
    single.refuses("validate --per-hit --perturb-gamma 0.9", &["out of (1.5, inf]", "above 0.99"]);
}

/// A right set is rejected rarely, also by a single configuration; a wrong one surely.
#[test]
fn a_single_configuration_is_not_rejected_by_chance() {
    let desk = Desk::new(&[]);
    let one = "validate --sigma 0.3 --gamma 3 --theta 0";
    for seed in 1..=3 {
        has(&desk.ok(&format!("{one} --seed {seed}")), &["PASSED"]);
    }
    let wrong = desk.run(&format!("{one} --perturb-gamma 1.05")).ends(1);
    has(&wrong.out, &["other seeds (--seed)"]);
}

/// What a set states is what it is judged by: coarse nodes and 16 bits are no faults, wrong values
/// are.
#[test]
fn honest_sets_pass_at_every_precision_and_wrong_ones_do_not() {
    let desk = Desk::new(&[]);
    for (set, how) in [
        ("f16", "--precision f16 --no-albedo"),
        ("u16", "--precision u16 --no-albedo"),
        ("draft", "--quality draft"),
    ] {
        desk.ok(&format!("bake --no-cache --out {set} {how}"));
        passes(&desk, &format!("{set} --configurations 40"));
        let few = "--samples 20000 --configurations 40 --perturb-gamma 1.05";
        desk.run(&format!("validate {set} {few}")).ends(1);
    }
    let set = Tables::from_bytes(&desk.read("u16/tables.safetensors")).unwrap();
    let mut tables = set.tables().to_vec();
    for table in tables.iter_mut().filter(|table| table.kind == Kind::VisibleSlope) {
        table.values.iter_mut().step_by(2).for_each(|x| *x *= 1.1);
        table.precision = Precision::F32;
    }
    desk.write("wrong.safetensors", encode(set.provenance(), &tables).unwrap());
    desk.run("validate wrong.safetensors --samples 20000 --configurations 40").ends(1);
}
