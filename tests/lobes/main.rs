//! Lobes and BSDFs of baked sets, against the model and reference values.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/sets.rs"]
mod sets;

mod brushed_glass;
mod bsdf;
mod classic;
mod closure;
mod ellipsoid;
mod glass;
mod lobes;
mod merl;
mod reference;
mod stress;
