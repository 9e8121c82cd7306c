//! The committed default set is what this code bakes, byte for byte.

use microfacet_baker::plan::Plan;
use microfacet_baker::table_set::{Target, bake};
use microfacet_sampler::DEFAULT_SET as COMMITTED;
use microfacet_tables::{Kind, encode};

#[test]
fn the_default_set_is_reproducible() {
    let plan = Plan::general();
    let set = bake(&plan, Target::default()).unwrap().set;
    let bytes = encode(set.provenance(), set.tables()).unwrap();
    assert!(
        bytes == COMMITTED,
        "the baked set differs from crates/sampler/data/default.safetensors; if the change is meant, raise bake::NUMERICS, run \
         `cargo run --release -- bake --out out`, copy out/tables.safetensors there, and note it as value-breaking"
    );
    assert!(COMMITTED.len() < 2 << 20);

    // What the README promises of the default quality.
    let worst = |kind: Kind, key: &str| {
        let of_kind = set.tables().iter().filter(|table| table.kind == kind);
        of_kind.map(|table| table.certificate[key]).fold(0.0, f64::max)
    };
    assert!(worst(Kind::Shadowing, "g1_max_error") < 1e-5);
    assert!(worst(Kind::VisibleSlope, "cdf_max_error") < 1e-4);
    assert!(worst(Kind::VisibleSlopePeeled, "cdf_max_error") < 5e-4);
    assert!(worst(Kind::VisibleSlopeConditional, "cdf_max_error") < 1e-4);
    for quantity in ["e", "scale", "bias", "f82"] {
        assert!(worst(Kind::Albedo, &format!("{quantity}_max_error")) < 3e-4, "{quantity}");
        assert!(
            worst(Kind::Albedo, &format!("{quantity}_max_error_outside")) < 2.2e-3,
            "{quantity}"
        );
    }
    assert!(worst(Kind::Albedo, "quadrature_error") < 1e-6);
    assert_eq!(
        set.tables().iter().filter(|table| table.kind.is_albedo()).count(),
        4 * plan.albedos.len()
    );
}
