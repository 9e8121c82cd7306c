//! All rivals that are timed, each in single precision and in its best published form.

pub(crate) mod beckmann;
pub(crate) mod bilinear;
pub(crate) mod conductor;
pub(crate) mod elementary;
pub(crate) mod form;
pub(crate) mod ggx;
pub(crate) mod lanes;
pub(crate) mod lobe;
pub(crate) mod logarithm;
pub(crate) mod lookup;
pub(crate) mod rational;
pub(crate) mod stream;
pub(crate) mod tail;
