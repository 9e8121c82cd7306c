//! Keeps normals above the horizon and facing their views, where rounding does not.

use glam::Vec3;

use microfacet_core::math::sqrt;

/// Smallest cosine of a sampled normal: keeps D finite, which for γ < 2 it is not on the horizon.
pub(crate) const HORIZON: f32 = 1e-18;

/// Turns a normal that rounding has put behind the silhouette back onto it.
///
/// The silhouette's slope has the rounding of the view coordinate, which is coarse where σ is far
/// below the view's tilt, and strong anisotropy lets the tilt across spoil the tilt along.
#[inline(always)]
pub(crate) fn face(m: Vec3, v: Vec3) -> Vec3 {
    let facing = v.dot(m);
    if facing < 0.0 && facing.is_finite() {
        let (a, b) = turned_back(m, v, facing);
        raised(a * m + b * v)
    } else {
        m
    }
}

/// Parts of a normal and of a view whose sum is the normal on the silhouette.
///
/// Out of line: in a caller's loop the compiler would else work it out for every normal. Two
/// numbers, since a vector of three is returned in integer registers, and both ways would meet
/// there.
#[cold]
#[inline(never)]
fn turned_back(m: Vec3, v: Vec3, facing: f32) -> (f32, f32) {
    // A view taken at the horizon is shorter than 1, and may be almost nothing; of one whose length
    // is out of range nothing is taken.
    let length2 = v.dot(v).max(f32::MIN_POSITIVE);
    let part = if length2 <= f32::MAX { facing / length2 } else { return (1.0, 0.0) };
    let turned = m - part * v;
    let inverse = 1.0 / sqrt(turned.dot(turned));
    (inverse, -part * inverse)
}

/// Normalises a normal and raises it to the smallest cosine where it is lower.
#[inline(always)]
pub(crate) fn above_horizon(m: Vec3) -> Vec3 {
    raised(m * (1.0 / sqrt(m.dot(m))))
}

/// With the smallest cosine where it is lower.
#[inline(always)]
fn raised(m: Vec3) -> Vec3 {
    Vec3::new(m.x, m.y, m.z.max(HORIZON))
}
