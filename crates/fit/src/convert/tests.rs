//! Replacements of every kind, and refusals.

use microfacet_baker::distribution::DistributionKind;
use microfacet_baker::progress::Stage;

use super::*;

fn named(text: &str) -> Named {
    text.parse().unwrap()
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
        let target = Target::new(&*built);
        for found in [
            target.by_rmse(from.kind, Form::Relative, &Stage::unwatched()).unwrap(),
            target.by_half_angle(from.kind, None).unwrap(),
        ] {
            let (a, b) = (found.to.values[0], from.values[0]);
            assert!(
                (a / b - 1.0).abs() < 1e-6 && found.rmse[0] < 1e-7,
                "{text} became {}",
                found.to
            );
        }
    }
    for text in ["student-t:0.3,2.5", "gtr:0.2,1.3", "hyper-cauchy:0.4,3"] {
        let from = named(text);
        let built = from.build().unwrap();
        let found =
            Target::new(&*built).by_rmse(from.kind, Form::Density, &Stage::unwatched()).unwrap();
        for (a, b) in found.to.values.iter().zip(&from.values) {
            assert!((a / b - 1.0).abs() < 1e-3, "{text} became {}", found.to);
        }
        assert!(found.rmse[1] < 1e-3 * built.peak());
    }
}

#[test]
fn student_t_recognises_its_members() {
    for (text, gamma) in [("trowbridge-reitz:0.2", 2.0), ("blinn-phong:20", 12.0)] {
        let built = named(text).build().unwrap();
        let found = Target::new(&*built)
            .by_rmse(DistributionKind::StudentT, Form::Relative, &Stage::unwatched())
            .unwrap();
        assert!((found.to.values[1] / gamma - 1.0).abs() < 1e-2, "{text} became {}", found.to);
    }
    let built = named("beckmann:0.2").build().unwrap();
    let found = Target::new(&*built)
        .by_rmse(DistributionKind::StudentT, Form::Relative, &Stage::unwatched())
        .unwrap();
    assert!(found.to.values[1] > 1e3 && (found.to.values[0] - 0.2).abs() < 1e-3, "{}", found.to);
}

#[test]
fn the_optimum_beats_the_half_angle_and_the_formula() {
    let from = named("blinn-phong:50");
    let built = from.build().unwrap();
    let target = Target::new(&*built);
    let best =
        target.by_rmse(DistributionKind::Beckmann, Form::Relative, &Stage::unwatched()).unwrap();
    let half = target.by_half_angle(DistributionKind::Beckmann, None).unwrap();
    let formula = by_formula(&from, DistributionKind::Beckmann).unwrap()[0].1.clone().unwrap();
    assert!(best.rmse[0] <= half.rmse[0] && best.rmse[0] <= formula.rmse[0]);
    assert!((best.to.values[0] / formula.to.values[0] - 1.0).abs() < 0.02);
}

#[test]
fn refusals() {
    let built = named("blinn-phong:50").build().unwrap();
    let target = Target::new(&*built);
    assert_eq!(
        target.by_half_angle(DistributionKind::Gtr, None).unwrap_err(),
        ConvertError::ShapeNeeded(DistributionKind::Gtr)
    );
    target.by_half_angle(DistributionKind::Gtr, Some(2.0)).unwrap();
    assert!(matches!(
        by_formula(&named("gauss:0.1"), DistributionKind::Gtr),
        Err(ConvertError::NoFormula(..))
    ));
    let flat = named("blinn-phong:0").build().unwrap();
    assert!(matches!(
        Target::new(&*flat).by_half_angle(DistributionKind::Gauss, None),
        Err(ConvertError::NoHalfAngle)
    ));
}
