//! Corrects normals that rounding has moved below the horizon or behind the silhouette.

use glam::Vec3;

use microfacet_core::math::sqrt;

/// Smallest cosine of a sampled normal: keeps D finite, which for γ < 2 has a pole on the horizon.
pub(crate) const HORIZON: f32 = 1e-18;

/// Turns a normal that rounding has put behind the silhouette back onto it.
///
/// The silhouette's slope has the rounding of the view coordinate, which is coarse where σ is far
/// below the view's tilt; with strong anisotropy the rounding of the tilt across also moves the
/// tilt along.
#[inline(always)]
pub(crate) fn face(m: Vec3, v: Vec3) -> Vec3 {
    let facing = v.dot(m);
    // Finite and below 0. `is_finite` would be joined with the sign to a test of twenty integer
    // instructions.
    if (f32::MIN..0.0).contains(&facing) {
        let (a, b) = turned_back(m, v, facing);
        raised(a * m + b * v)
    } else {
        m
    }
}

/// Factors of a normal and of a view whose sum is the normal on the silhouette.
///
/// Out of line: inlined in a caller's loop, it would be computed for every normal. Two numbers,
/// since a vector of three would be returned in integer registers.
#[cold]
#[inline(never)]
fn turned_back(m: Vec3, v: Vec3, facing: f32) -> (f32, f32) {
    // A view moved to the horizon is shorter than 1, and may be almost 0; a view whose length is
    // out of range leaves the normal unchanged.
    let length2 = v.dot(v).max(f32::MIN_POSITIVE);
    let part = if length2 <= f32::MAX { facing / length2 } else { return (1.0, 0.0) };
    let turned = m - part * v;
    let inverse = 1.0 / sqrt(turned.dot(turned));
    (inverse, -part * inverse)
}

/// Normalises a normal and raises its cosine to [`HORIZON`] where it is lower.
#[inline(always)]
pub(crate) fn above_horizon(m: Vec3) -> Vec3 {
    raised(m * (1.0 / sqrt(m.dot(m))))
}

#[inline(always)]
fn raised(m: Vec3) -> Vec3 {
    Vec3::new(m.x, m.y, m.z.max(HORIZON))
}
