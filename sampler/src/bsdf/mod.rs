//! What a renderer builds from lobes and albedos: energy compensation.

mod compensation;

pub use compensation::{f82_tint_average, fresnel_average, schlick_average};
