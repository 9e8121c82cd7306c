//! The committed default set is what this code bakes, byte for byte.

use microfacet_baker::plan::Plan;
use microfacet_baker::table_set::{Target, bake};
use microfacet_sampler::DEFAULT_SET as COMMITTED;
use microfacet_tables::{Certificate, Kind, Quantity, Table, encode};

#[test]
fn the_default_set_is_reproducible() {
    let plan = Plan::default_set();
    let set = bake(&plan, Target::default()).unwrap().set;
    let bytes = encode(set.provenance(), set.tables()).unwrap();
    assert!(
        bytes == COMMITTED,
        "the baked set differs from crates/sampler/data/default.safetensors; if the change is meant, raise bake::NUMERICS, run \
         `cargo run --release -- bake --glass --out out`, copy out/tables.safetensors there, and note it as value-breaking"
    );
    assert!(COMMITTED.len() < 2 << 20);

    // Common glass, as `docs/albedo.md` says.
    let of_glass =
        |table: &&Table| table.subject.reflectance.is_some_and(|of| of.indices().is_some());
    let (glass, others): (Vec<&Table>, Vec<&Table>) = set.tables().iter().partition(of_glass);
    assert_eq!(glass.len(), 2);
    for table in glass {
        let errors = &table.certificate.errors;
        assert!(errors.values().all(|of| of.largest < 1.8e-3), "{errors:?}");
    }

    // The errors that the README states for the default quality.
    let largest = |kind: Kind, figure: &dyn Fn(&Certificate) -> Option<f64>| {
        let of_kind = others.iter().filter(|table| table.kind == kind);
        of_kind.map(|table| figure(&table.certificate).unwrap()).fold(0.0, f64::max)
    };
    let worst = |kind, quantity| largest(kind, &|certificate| certificate.error(quantity));
    assert!(worst(Kind::Shadowing, Quantity::G1) < 1e-5);
    assert!(worst(Kind::VisibleSlope, Quantity::Cdf) < 1e-4);
    assert!(worst(Kind::VisibleSlopePeeled, Quantity::Cdf) < 5e-4);
    assert!(worst(Kind::VisibleSlopeConditional, Quantity::Cdf) < 1e-4);
    for quantity in [Quantity::E, Quantity::Scale, Quantity::Bias, Quantity::F82] {
        assert!(worst(Kind::Albedo, quantity) < 3e-4, "{quantity:?}");
        let outside = largest(Kind::Albedo, &|certificate| certificate.errors[&quantity].outside);
        assert!(outside < 2.2e-3, "{quantity:?}");
    }
    assert!(largest(Kind::Albedo, &|certificate| certificate.quadrature) < 1e-5);
    assert_eq!(others.iter().filter(|table| table.kind.is_albedo()).count(), 4);
}
