//! Judges of tables: what the sampler draws and returns against what the model says. They report and never repair.

pub mod certificate;
