//! Statistical tests of any sampler against the model.

mod chi_square;
mod normals;

pub use chi_square::{ChiSquare, chi_square, sidak};
pub use normals::{NormalsTest, test_normals, test_visible_normals};
