//! Replacements of every kind, and refusals.

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::progress::Stage;

use super::*;

fn named(text: &str) -> Named {
    text.parse().unwrap()
}

fn nearest(text: &str, to: DistributionKind, form: Form) -> Replacement {
    let built = named(text).build().unwrap();
    Target::new(&*built).by_rmse(to, form, &Stage::unwatched()).unwrap()
}

#[test]
fn every_family_finds_itself() {
    for text in [
        "beckmann:0.2",
        "gauss:0.15",
        "trowbridge-reitz:0.3",
        "blinn-phong:40",
        "schlick:0.1",
        "sawicki:12",
    ] {
        let from = named(text);
        let built = from.build().unwrap();
        let by_half_angle = Target::new(&*built).by_half_angle(from.kind, None).unwrap();
        for found in [nearest(text, from.kind, Form::Relative), by_half_angle] {
            let (a, b) = (found.to.values[0], from.values[0]);
            let near = (a / b - 1.0).abs() < 1e-6 && found.rmse[0] < 1e-7;
            assert!(near, "{text} became {}", found.to);
        }
    }
    for text in ["student-t:0.3,2.5", "gtr:0.2,1.3", "hyper-cauchy:0.4,3"] {
        let from = named(text);
        let found = nearest(text, from.kind, Form::Density);
        for (a, b) in found.to.values.iter().zip(&from.values) {
            assert!((a / b - 1.0).abs() < 1e-3, "{text} became {}", found.to);
        }
        assert!(found.rmse[1] < 1e-3 * from.build().unwrap().peak());
    }
}

#[test]
fn student_t_recognises_its_members() {
    let student_t = |text| nearest(text, DistributionKind::StudentT, Form::Relative).to;
    for (text, gamma) in [("trowbridge-reitz:0.2", 2.0), ("blinn-phong:20", 12.0)] {
        let found = student_t(text);
        assert!((found.values[1] / gamma - 1.0).abs() < 1e-2, "{text} became {found}");
    }
    let found = student_t("beckmann:0.2");
    assert!(found.values[1] > 1e3 && (found.values[0] - 0.2).abs() < 1e-3, "{found}");
}

#[test]
fn the_optimum_beats_the_half_angle_and_the_formula() {
    let (from, to) = (named("blinn-phong:50"), DistributionKind::Beckmann);
    let built = from.build().unwrap();
    let best = nearest("blinn-phong:50", to, Form::Relative);
    let half = Target::new(&*built).by_half_angle(to, None).unwrap();
    let formula = by_formula(&from, to).unwrap()[0].1.clone().unwrap();
    assert!(best.rmse[0] <= half.rmse[0] && best.rmse[0] <= formula.rmse[0]);
    assert!((best.to.values[0] / formula.to.values[0] - 1.0).abs() < 0.02);
}

#[test]
fn refusals() {
    let built = named("blinn-phong:50").build().unwrap();
    let target = Target::new(&*built);
    let refused = target.by_half_angle(DistributionKind::Gtr, None);
    assert_eq!(refused, Err(ConvertError::ShapeNeeded(DistributionKind::Gtr)));
    target.by_half_angle(DistributionKind::Gtr, Some(2.0)).unwrap();
    let refused = by_formula(&named("gauss:0.1"), DistributionKind::Gtr);
    assert!(matches!(refused, Err(ConvertError::NoFormula(..))));
    let flat = named("blinn-phong:0").build().unwrap();
    let refused = Target::new(&*flat).by_half_angle(DistributionKind::Gauss, None);
    assert_eq!(refused, Err(ConvertError::NoHalfAngle));
}

/// The least total variation, and what has it.
fn by_variation(from: &str, to: DistributionKind) -> Replacement {
    let built = named(from).build().unwrap();
    Target::new(&*built).by_variation(to, &Stage::unwatched()).unwrap()
}

#[test]
fn two_ggx_follow_a_long_tail_and_not_a_short_one() {
    // At most what a scan by hand of core, haze and weight had found, and not much less.
    for (gamma, most) in
        [("1.6", 0.023), ("1.8", 0.009), ("3", 0.081), ("6", 0.138), ("inf", 0.180)]
    {
        let found = by_variation(&format!("student-t:0.2,{gamma}"), DistributionKind::Haze);
        let near = 0.6 * most..most + 5e-4;
        assert!(near.contains(&found.variation), "gamma {gamma}: {found:?}");
    }
    // Of γ = 2 it is the GGX itself.
    let found = by_variation("student-t:0.2,2", DistributionKind::Haze);
    assert!(found.variation < 1e-4, "{found:?}");
}

#[test]
fn one_student_t_follows_a_haze_that_is_not_far_from_its_core() {
    // Roughness r, spread and weight of OpenPBR 1.2: α is r² of the core and (r + (1−r) spread)² of
    // the haze.
    let haze = |r: f64, spread: f64, weight: f64| {
        let wide = r + (1.0 - r) * spread;
        format!("haze:{},{},{weight}", r * r, wide * wide)
    };
    for weight in [0.1, 0.3, 0.5] {
        let found = by_variation(&haze(0.3, 0.1, weight), DistributionKind::StudentT);
        assert!((0.002..0.0115).contains(&found.variation), "{weight}: {found:?}");
    }
    let found = by_variation(&haze(0.1, 0.5, 0.5), DistributionKind::StudentT);
    assert!((0.35..0.37).contains(&found.variation), "{found:?}");
}

#[test]
fn a_haze_and_an_abc_are_found_again() {
    for text in ["haze:0.1,0.4,0.3", "abc:300,1.4"] {
        let from = named(text);
        for found in [nearest(text, from.kind, Form::Relative), by_variation(text, from.kind)] {
            for (a, b) in found.to.values.iter().zip(&from.values) {
                assert!((a / b - 1.0).abs() < 2e-2, "{text} became {}", found.to);
            }
            assert!(found.variation < 1e-3, "{text}: {found:?}");
        }
    }
    let built = named("ggx:0.1").build().unwrap();
    let refused = Target::new(&*built).by_half_angle(DistributionKind::Haze, None);
    assert_eq!(refused, Err(ConvertError::OfThree(DistributionKind::Haze)));
}
