//! What a renderer builds from lobes and albedos.

mod compensation;

pub use compensation::{f82_tint_average, fresnel_average, schlick_average};
