//! The slopes of normals that reflect a view above the horizon, in the plane of incidence.
//!
//! In slopes about the macro normal, the light l = reflect(v, m) is above the horizon just where
//! the slope lies in the disc of radius 1/cos θ about tan θ towards the viewer. Its in-plane slopes
//! are an interval, and so are the random numbers u₁ of these slopes, since inverse CDFs ascend.
//!
//! Where γ is near 3/2 most visible normals are too steep: they are those of the
//! [heavy](super::heavy) part, whose number at the end of the disc has a closed form. So of any
//! shape, also of one that is known only at a hit, most of them can be left out without a table of
//! limits.

use glam::Vec3;
use microfacet_core::math::unit;
use microfacet_lanes::{Lanes, f32x4};

use super::heavy::number_above;
use super::lanes::views::View;
use super::surface::{Shape, Surface};

/// How far an end of numbers is moved outwards, so that rounding loses no direction.
pub(super) const SLACK: f32 = 1e-6;

/// The unit slopes x : z, along the stretched azimuth, at both ends of the disc: tan θ ∓ 1/cos θ,
/// the nearer end without cancellation. Of views with stretched horizontal length ρ, where that of
/// the view itself is `sin`.
#[inline(always)]
pub(super) fn ends<L: Lanes>(rho: L, cos: L, sin: L, sigma: f32) -> [[L; 2]; 2] {
    // Slopes along the view's azimuth are sin/ρ unit slopes along the stretched azimuth. Where ρ
    // vanishes, so does sin, and the azimuth is that of x.
    const LITTLE: f32 = 1e-25;
    let (across, rho) = (sin + LITTLE, rho + LITTLE * sigma);
    let (back, ahead) = (L::splat(0.0) - cos, sin + 1.0);
    [[back * across, ahead * rho], [ahead * across, cos * rho]]
}

/// The random numbers that the heavy part, which is the last, loses of all: those of slopes steeper
/// than x : z, of which none reflects upwards. `share` is that of the heavy part.
#[inline(always)]
pub(super) fn lost_above<S: Shape, L: Lanes>(shape: S, share: L, steepest: [L; 2]) -> L {
    (share * number_above(steepest, shape.tails()) - SLACK).fast_max(L::splat(0.0))
}

impl<S: Shape> Surface<S> {
    /// A visible normal for reflection, of any length, and the [share](Self::upward_share) of all
    /// normals that it is drawn from.
    #[inline(always)]
    pub(crate) fn sample_upward(self, v: Vec3, u: [f32; 2]) -> (Vec3, f32) {
        if !self.shape.peeled() {
            return (self.sample_along(v, u), 1.0);
        }
        let view = self.view::<true>(v);
        let share = self.kept(v, &view);
        (self.sample_heavy(v, &view, [unit(u[0]) * share, u[1]]), share)
    }

    /// The probability in (0, 1] that a visible normal is not one of the heavy part that is too
    /// steep to reflect the view upwards.
    #[inline(always)]
    pub(crate) fn upward_share(self, v: Vec3) -> f32 {
        if self.shape.peeled() { self.kept(v, &self.view::<true>(v)) } else { 1.0 }
    }

    #[inline(always)]
    fn kept(self, v: Vec3, &View { rho, z, at, .. }: &View) -> f32 {
        let sin = f32x4::splat(v.x * v.x + v.y * v.y).sqrt();
        let [_, steepest] = ends(rho, z, sin, self.scales.sigma[0]);
        let share = f32x4::splat(self.shape.share(at.to_array()[0]));
        1.0 - lost_above(self.shape, share, steepest).to_array()[0]
    }
}
