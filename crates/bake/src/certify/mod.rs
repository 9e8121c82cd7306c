//! Certificates: the errors of a table, measured through the run-time lookup against the model when
//! the table is baked.

pub mod albedo;
pub mod certificate;
mod climb;
pub mod points;
pub mod radial;
