//! Ranges of σ and γ, as of textures: a set has what lobes and albedos at any point of them read,
//! and no more.

use std::fs;

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Settings, bake_with};
use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Interpolation, Kind, Table};

use serde_json::{Value, json};
use tempfile::tempdir;

use super::plan::DRAFT;
use crate::common::json;

const MIRROR: &str = "fresnel = \"mirror\"";

/// The plan of one material: σ, γ and more lines of a recipe.
fn plan(sigma: &str, gamma: &str, more: &str) -> Plan {
    let recipe = format!("[[material]]\nname = \"m\"\nsigma = {sigma}\ngamma = {gamma}\n{more}\n");
    Plan::new(&Scene::from_recipe_str(&recipe).unwrap(), Options::default()).unwrap()
}

/// The set of one material.
fn set(sigma: &str, gamma: &str, more: &str) -> Tables {
    let settings = Settings { cache: Cache::none(), ..Settings::default() };
    bake_with(&plan(sigma, gamma, more), DRAFT, settings).unwrap().set
}

fn kinds(set: &Tables) -> Vec<Kind> {
    set.tables().iter().map(|table| table.kind).collect()
}

/// Numbers from one to another, both included: even in s = 1/(γ−1).
fn shapes([min, max]: [f64; 2]) -> Vec<f64> {
    let [from, to] = [max, min].map(s_of_gamma);
    let inner = (1..12).map(|i| 1.0 + 1.0 / (from + (to - from) * f64::from(i) / 12.0));
    [min, max].into_iter().chain(inner).collect()
}

#[test]
fn any_lobe_of_a_range_of_shapes_is_served_by_tables_of_that_range_alone() {
    use Kind::{Shadowing, VisibleSlope, VisibleSlopeConditional, VisibleSlopePeeled};
    let inf = f64::INFINITY;
    for ([min, max], slopes) in [
        ([2.5, 4.0], &[VisibleSlope][..]),
        ([20.0, inf], &[VisibleSlope]),
        // At the seam the whole distribution's tables end.
        ([1.8, 3.0], &[VisibleSlope]),
        ([1.6, 1.8], &[VisibleSlopePeeled]),
        ([1.6, 1.75], &[VisibleSlopePeeled]),
        ([1.501, 1.6], &[VisibleSlopePeeled]),
        ([1.79, 3.0], &[VisibleSlope, VisibleSlopePeeled]),
        ([1.6, 1.81], &[VisibleSlope, VisibleSlopePeeled]),
        ([1.501, inf], &[VisibleSlope, VisibleSlopePeeled]),
    ] {
        let range = format!("{{ min = {min}, max = {max} }}");
        let set = set("0.3", &range, "");
        // Masking has a table on each side of the seam too.
        let masking = vec![Shadowing; slopes.len()];
        let expected = [&masking[..], slopes, &[VisibleSlopeConditional]].concat();
        assert_eq!(kinds(&set), expected, "{range}");
        assert_eq!(set.shapes(), [[max, min].map(s_of_gamma)], "{range}");
        for gamma in shapes([min, max]) {
            for sigma in [[1e-8; 2], [0.1, 0.4], [0.3; 2], [1e6; 2]] {
                assert!(set.student_t(sigma, gamma).is_ok(), "{range} {gamma}");
            }
        }
        for beyond in [min - 0.1 * (min - 1.5), max * 1.01] {
            assert!(beyond == inf || set.student_t(0.3, beyond).is_err(), "{range} {beyond}");
        }
        for table in set.tables() {
            let axis = &table.axes[0];
            assert_eq!(axis.interpolation, Interpolation::Lagrange4, "{range} {}", table.name);
        }
        // Slopes are divided by σ: it asks for nothing, whatever its range.
        for sigma in ["{ min = 0.1, max = 0.4 }", "[{ min = 0.1, max = 0.4 }, 0.3]"] {
            assert_eq!(plan(sigma, &range, "").shapes, plan("0.3", &range, "").shapes);
        }
    }
}

#[test]
fn a_narrower_range_of_shapes_has_fewer_nodes() {
    let nodes = |gamma: &str| -> usize {
        set("0.3", gamma, "").tables().iter().map(|table| table.axes[0].nodes.len()).sum()
    };
    let [all, half, small] = [
        "{ min = 1.501, max = \"inf\" }",
        "{ min = 2.0, max = \"inf\" }",
        "{ min = 2.5, max = 2.6 }",
    ]
    .map(nodes);
    assert!(small < half && half < all, "{small} {half} {all}");
}

/// The ranges of σ and γ that an albedo table covers.
fn covered(table: &Table) -> [[f64; 2]; 2] {
    [table.subject.lobe.roughness.x(), table.subject.lobe.gamma].map(Into::into)
}

#[test]
fn albedos_of_ranges_are_served_at_any_point_by_two_tables() {
    for (sigma, round) in [
        ("{ min = 0.1, max = 0.4 }", [0.1, 0.4]),
        // √(0.1 · 0.4) and √(0.4 · 0.9), of the round lobes that stand in.
        ("[{ min = 0.1, max = 0.4 }, { min = 0.4, max = 0.9 }]", [0.2, 0.6]),
        ("[{ min = 0.1, max = 0.9 }, 0.4]", [0.2, 0.6]),
        ("[{ min = 0, max = 0.9 }, 0.4]", [0.0, 0.6]),
        // Single numbers along both axes, whose γ varies.
        ("[0.1, 0.4]", [0.2, 0.2]),
        ("0.3", [0.3, 0.3]),
    ] {
        for gamma in [[2.0, 2.0], [1.6, 3.0], [2.5, 4.0]] {
            let [min, max] = gamma;
            if sigma == "[0.1, 0.4]" && min == max {
                continue;
            }
            let range = format!("{{ min = {min}, max = {max} }}");
            assert_eq!(plan(sigma, &range, "").albedos, [], "{sigma} {range}");
            let set = set(sigma, &range, MIRROR);
            let albedos: Vec<&Table> =
                set.tables().iter().filter(|table| table.kind.is_albedo()).collect();
            let all: Vec<Kind> = albedos.iter().map(|table| table.kind).collect();
            let single = round[0] == round[1] && min == max;
            // The average of a single lobe follows from its albedo.
            let expected =
                if single { &[Kind::Albedo][..] } else { &[Kind::Albedo, Kind::AlbedoAverage] };
            assert_eq!(all, expected, "{sigma} {range}");
            for table in albedos {
                let [sigmas, gammas] = covered(table);
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-12;
                assert!(close(sigmas[0], round[0]) && close(sigmas[1], round[1]), "{sigmas:?}");
                assert_eq!(gammas, gamma, "{sigma} {range}");
            }
            let masking = Masking::HeightCorrelated;
            for gamma in shapes(gamma) {
                for t in [0.0, 0.25, 0.5, 1.0] {
                    let sigma = round[0] + (round[1] - round[0]) * t;
                    let average =
                        |set: &Tables| set.albedo(sigma, gamma, masking).unwrap().albedo_average();
                    let off = average(&set) - average(&Tables::embedded());
                    assert!(off.abs() < 3e-3, "{sigma} {gamma}: {off}");
                }
            }
            assert!(set.albedo(round[1] * 1.1, max, masking).is_err(), "{sigma} {range}");
            assert!(set.albedo(round[1], max * 1.1, masking).is_err(), "{sigma} {range}");
            assert!(set.albedo(round[1], max, Masking::Uncorrelated).is_err());
        }
    }
}

#[test]
fn textures_of_ggx_need_albedos_alone_and_those_only_if_asked() {
    let sigma = "[{ min = 0.1, max = 0.4 }, { min = 0.4, max = 0.9 }]";
    assert_eq!(kinds(&set(sigma, "2", "")), []);
    assert_eq!(kinds(&set(sigma, "2", MIRROR)), [Kind::Albedo, Kind::AlbedoAverage]);
}

#[test]
fn a_plan_states_the_stand_in_and_how_far_it_is_off() {
    let folder = tempdir().unwrap();
    let material = |name: &str, sigma: &str| {
        format!("[[material]]\nname = \"{name}\"\nsigma = {sigma}\ngamma = 3\n{MIRROR}\n")
    };
    let recipe = material("worn", "[{ min = 0.1, max = 0.5 }, { min = 0.4, max = 0.5 }]")
        + &material("brushed", "[0.1, 0.4]")
        + &material("round", "{ min = 0.1, max = 0.4 }");
    fs::write(folder.path().join("r.toml"), recipe).unwrap();
    let stand_ins = |more: &[&str]| {
        let said = json(folder.path(), &[&["plan", "r.toml"], more].concat());
        [0, 1, 2].map(|i| said["materials"][i]["stand_in"].clone())
    };
    let worn = json!({ "sigma": [0.2, 0.5], "error": 0.39 });
    assert_eq!(stand_ins(&[]), [worn, Value::Null, Value::Null]);
    assert_eq!(stand_ins(&["--no-albedo"]), [Value::Null, Value::Null, Value::Null]);
}
