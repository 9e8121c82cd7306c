//! Tests of tables: what the sampler draws and returns, against the model. They report errors and
//! never repair.

pub mod albedo;
pub mod bsdf;
pub mod certificate;
pub mod configuration;
pub mod error_map;
pub mod furnace;
pub mod pdf_integral;
pub mod points;
pub mod radial;
pub mod record;
mod run;
pub mod stress;

pub use run::{LEVEL, Options, Outcome, PDF_TOLERANCE, Report, USUAL, run, seconds};
