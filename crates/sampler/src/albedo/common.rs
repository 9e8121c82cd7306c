//! What all forms of the directional albedo have in common.

use microfacet_core::Masking;

use super::directional::Albedo;
use super::family::AlbedoAt;
use super::moments::Moments;
use super::shape::ShapeAlbedoAt;

/// The directional albedo of one material with F = 1, however it is looked up: [`Albedo`] is bound
/// to a material, [`AlbedoAt`] is read at a hit, [`ShapeAlbedoAt`] at a roughness of one shape.
///
/// `v` is a unit vector in the tangent frame, n = +z.
pub trait DirectionalAlbedo {
    /// The form of masking.
    fn masking(&self) -> Masking;

    /// Moments of the Fresnel weights at a view, each in [0, 1], with a total of at most 1.
    fn moments(&self, v: [f32; 3]) -> Moments;

    /// The share of light lost, 1 − E(v) ∈ [0, 1].
    fn lost(&self, v: [f32; 3]) -> f32;

    /// The average share of light lost, 1/π ∫∫ (1 − E) μ dμ dφ.
    fn lost_average(&self) -> f32;
}

macro_rules! directional {
    ($($albedo:ty),*) => {$(
        impl DirectionalAlbedo for $albedo {
            fn masking(&self) -> Masking {
                self.masking()
            }

            fn moments(&self, v: [f32; 3]) -> Moments {
                self.moments(v)
            }

            #[inline]
            fn lost(&self, v: [f32; 3]) -> f32 {
                self.lost(v)
            }

            fn lost_average(&self) -> f32 {
                self.lost_average()
            }
        }
    )*};
}

directional!(Albedo, AlbedoAt<'_>, ShapeAlbedoAt<'_>);
