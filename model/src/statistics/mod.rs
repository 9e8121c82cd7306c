//! Statistical tests of samplers against the model. They judge what is drawn, wherever it comes from.

mod chi_square;
mod normals;

pub use chi_square::{ChiSquare, chi_square, sidak};
pub use normals::{NormalsTest, test_visible_normals};
