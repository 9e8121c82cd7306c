//! Vectors at the border of the crate: three numbers outside, glam inside.

use glam::Vec3;

/// The vector of three numbers, as any type of vector gives them.
#[inline(always)]
pub(crate) fn vec3(v: impl Into<[f32; 3]>) -> Vec3 {
    Vec3::from_array(v.into())
}
