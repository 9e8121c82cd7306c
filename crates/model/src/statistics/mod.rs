//! Statistical tests of samplers against the model, wherever the drawn normals come from.

mod chi_square;
mod normals;

pub use chi_square::{ChiSquare, chi_square, sidak};
pub use normals::{NormalsTest, test_visible_normals};
