//! `docs/reference.csv` is what the study `reference` makes, byte for byte.

use microfacet_study::reference;

const COMMITTED: &str = include_str!("../../docs/reference.csv");

#[test]
fn the_test_vectors_are_those_of_this_code() {
    let made = reference::text();
    let lines = || COMMITTED.lines().zip(made.lines()).enumerate();
    if let Some((i, (committed, made))) = lines().find(|(_, (committed, made))| committed != made) {
        panic!(
            "docs/reference.csv, line {}:\n{committed}\nis now\n{made}\nIf the change is meant, run \
             `cargo run --release -p microfacet-study -- reference docs/reference.csv`",
            i + 1
        );
    }
    assert!(made == COMMITTED, "docs/reference.csv has lines too many or too few");
    // A header and the rows.
    assert_eq!(made.lines().count(), 1 + 200);
}
