//! Albedos of whole slices of views.

use crate::error::{BatchError, same_lengths};

/// E of each view, into `e`.
pub(super) fn of_each<V: Copy>(
    v: &[V],
    e: &mut [f32],
    albedo: impl Fn(V) -> f32,
) -> Result<(), BatchError> {
    same_lengths(&[("v", v.len()), ("e", e.len())])?;
    v.iter().zip(e).for_each(|(v, e)| *e = albedo(*v));
    Ok(())
}
