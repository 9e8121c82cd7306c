//! Everything that is timed, each in single precision and in its best published form.

pub(super) mod beckmann;
pub(super) mod bilinear;
pub(super) mod ggx;
pub(super) mod lobe;
pub(super) mod rational;
pub(super) mod stream;
pub(super) mod tail;
