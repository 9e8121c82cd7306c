//! Tests of tables: what the sampler draws and returns, against the model. They report errors and
//! never repair.

pub mod bsdf;
pub mod configuration;
pub mod furnace;
pub mod pdf_integral;
pub mod record;
mod run;
pub mod stress;

pub use run::{LEVEL, Options, Outcome, PDF_TOLERANCE, Report, USUAL, run, seconds};
