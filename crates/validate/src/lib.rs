//! Tests of tables from outside: what the sampler draws and returns, against the model. They report
//! errors, and do not depend on how a table was baked.
//!
//! | | |
//! | --- | --- |
//! | [`run`] | chi-square and Kolmogorov–Smirnov tests of drawn normals, at [`configuration`]s spread over what a set covers |
//! | [`pdf_integral`] | the tabulated density integrates to one |
//! | [`furnace`] | the white furnace: the share of light that a lobe returns, table against model |
//! | [`bsdf`] | complete materials: chi-square, reciprocity, energy, and what `eval_pdf` promises |
//! | [`stress`] | corners and edges of every axis, and rules that no input may break |
//! | [`record`] | a run as a file, which names the set that it tested |

pub mod bsdf;
pub mod configuration;
pub mod furnace;
pub mod pdf_integral;
pub mod record;
mod run;
pub mod stress;

pub use run::{Judged, LEVEL, Options, Outcome, PDF_TOLERANCE, Report, USUAL, run, seconds};
