//! Tests of tables from outside: what the sampler draws and returns, against the model. They report
//! errors, and do not depend on how a table was baked.
//!
//! | | |
//! | --- | --- |
//! | [`run`] | chi-square and Kolmogorov–Smirnov tests of drawn normals, at [`configuration`]s spread over what a set covers |
//! | [`per_hit`] | the same of a family whose σ and γ differ from hit to hit, and its values |
//! | [`pdf_integral`] | the tabulated density integrates to one |
//! | [`furnace`] | the white furnace: the share of light that a lobe returns, table against model |
//! | [`bsdf`] | complete materials: chi-square, reciprocity, energy, and what `eval_pdf` promises |
//! | [`stress`] | corners and edges of every axis, and rules that no input may break |
//! | [`record`] | a run as a file, which names the set that it tested |

pub mod bsdf;
pub mod configuration;
pub mod furnace;
pub mod pdf_integral;
pub mod per_hit;
pub mod record;
mod run;
pub mod stress;

pub use run::{Judged, LEVEL, Options, Outcome, PDF_TOLERANCE, Report, USUAL, run, seconds};
