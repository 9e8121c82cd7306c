//! The Ellipsoid distribution at run time: a Student-t lobe transformed by a matrix.

use core::f32::consts::FRAC_1_PI;

use glam::Vec3;
use microfacet_core::math::sqrt;
use microfacet_core::{Masking, Skew, saturated};
use microfacet_tables::axis::half_tangent::Slope;
use wide::f32x4;

use super::batch::Batch;
use super::below_horizon::{ExcessShare, Numbers, SlopeBelowHorizon};
use super::delegate::{by_ref, forward};
use super::distribution::{Facet, MicrofacetDistribution, SMOOTH, is_hidden, visible_density};
use super::horizon::{HORIZON, above_horizon};
use super::key::{LobeKey, has_pole};
use super::lanes::one::{Reads, draw_located};
use super::lanes::views::{View, Views};
use super::lanes::{first_three, sum};
use super::matrix::{ENTRIES, Matrix};
use super::reflecting::Reflecting;
use super::slices::Slices;
use super::student_t::StudentT;
use super::surface::{Shape, Stretched, Surface};
use super::tabulated::{Tabulated, with_table_pdf};
use crate::error::{BatchError, MaterialError};
use crate::vector::vec3;

/// An Ellipsoid lobe: that of Walter et al. 2015 (supplemental material of
/// <https://doi.org/10.1145/2815618>) at γ = 2, a skewed Student-t for other γ, a skewed Beckmann
/// at γ = ∞.
///
/// It reads the same tables as [`StudentT`]: a direction is transformed by the matrix and looked
/// up, and the normal is transformed back. Directions are unit vectors in the tangent frame,
/// n = +z. A view above the surface but below the lobe's own horizon (the lobe leans away, and the
/// view grazes) uses no table: its normals are drawn by rejection, with random numbers derived from
/// the two given.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{MicrofacetDistribution, Skew, Tables};
///
/// let skew = Skew::new([0.3, 0.1], [0.2, -0.1, 0.5])?; // sigma; turns about x, y, z
/// let brushed = Tables::embedded().ellipsoid(skew, 2.7)?;
/// assert!(brushed.g1([0.6, 0.0, 0.8]) <= 1.0);
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    slices: Slices,
    matrix: Matrix,
    /// For views below the lobe's horizon.
    below: ExcessShare,
}

/// An [`Ellipsoid`] of another matrix, which borrows all else: the lobe of one hit.
///
/// It is `Copy`, and no memory is allocated for it. Made by [`Ellipsoid::with_skew`].
#[derive(Clone, Copy, Debug)]
pub struct EllipsoidRef<'a> {
    slices: &'a Slices,
    matrix: Matrix,
    below: &'a ExcessShare,
}

impl Ellipsoid {
    /// The smallest and the largest diagonal entry of a matrix, as a σ would be: [1e-18, 1e18].
    pub const SIGMAS: [f64; 2] = ENTRIES;

    pub(crate) fn new(lobe: StudentT, skew: Skew) -> Result<Self, MaterialError> {
        let below = ExcessShare::new(f64::from(lobe.slices.s));
        Ok(Self { slices: lobe.slices, matrix: skew.try_into()?, below })
    }

    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.slices.gamma
    }

    /// The same shape with another matrix: the lobe of a hit where textures give its roughness,
    /// turn or tilt.
    ///
    /// # Errors
    /// [`MaterialError::Sigma`] for a roughness that leaves single precision.
    #[inline]
    pub fn with_skew(&self, skew: Skew) -> Result<EllipsoidRef<'_>, MaterialError> {
        Ok(EllipsoidRef { matrix: skew.try_into()?, ..self.by_ref() })
    }

    /// This lobe, borrowed.
    #[inline(always)]
    #[must_use]
    pub fn by_ref(&self) -> EllipsoidRef<'_> {
        EllipsoidRef { slices: &self.slices, matrix: self.matrix, below: &self.below }
    }
}

/// A direction of unit space, located.
#[inline(always)]
fn stretched(w: Vec3) -> Stretched {
    Stretched::new(w.to_array())
}

impl EllipsoidRef<'_> {
    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.slices.gamma
    }

    /// The lobe with σ = 1.
    #[inline(always)]
    fn unit(&self) -> Surface<&Slices> {
        Surface::new(self.slices, [1.0; 2])
    }

    /// D of a normal of unit space, from the square of the length that it had in the tangent frame.
    #[inline(always)]
    fn d_of_unit(&self, m: Vec3, length2: f32, scale: f32) -> f32 {
        self.slices.d(m.x * m.x + m.y * m.y, m.z * m.z, length2, scale)
    }

    /// Uv, the direction in unit space.
    #[inline(always)]
    fn to_unit(self, v: Vec3) -> Vec3 {
        let Matrix { p, q, r, x, y } = self.matrix;
        Vec3::new(p * v.x, q * v.x + r * v.y, x * v.x + y * v.y + v.z)
    }

    /// U⁻ᵀm, the normal in unit space, not normalised, and 1/|U|.
    #[inline(always)]
    fn normal_to_unit(&self, m: Vec3) -> (Vec3, f32) {
        let Matrix { p, q, r, x, y } = self.matrix;
        // Reciprocals do not wait for the normal, as four successive divisions would: this saves 10
        // of 80 ns for a normal and its density.
        let (along, aside) = (1.0 / p, 1.0 / r);
        let uy = (m.y - y * m.z) * aside;
        let ux = (m.x - x * m.z - q * uy) * along;
        (Vec3::new(ux, uy, m.z), along * aside)
    }

    /// 1/(area of the microsurface seen along v), for views above and below the lobe's horizon.
    #[inline(always)]
    fn inverse_area(&self, w: Vec3, at: &Stretched) -> f32 {
        let Self { slices, below, .. } = *self;
        if w.z >= 0.0 { slices.inverse_area(at) } else { inverse_area_below(slices, below, w, at) }
    }

    /// G2(v, l)·area/(v·n) from (v·n)/area, which is above 1 where G1(v) is clamped.
    #[inline(always)]
    fn weight(&self, unclamped: f32, l: Vec3, masking: Masking) -> f32 {
        // The closed form of G2/min(1, unclamped): both may be too small for their quotient.
        masking.g2_over_g1(unclamped.min(1.0), self.g1(l)) / unclamped.max(1.0)
    }

    /// The lobe's [common case](draw_located) between U and Uᵀ, and where its view and numbers are
    /// in the tables; `None` elsewhere, and for views below the lobe's horizon.
    ///
    /// A normal takes 1.2 times as long as one of the untilted anisotropic lobe, 1.1 to 1.2 times
    /// with its density; by the general path it took twice as long
    /// (`cargo run --profile dist -p microfacet-study -- ellipsoid_cost`).
    #[inline(always)]
    fn sample_fast<const HEAVY: bool>(&self, v: Vec3, u: [f32; 2]) -> Option<(Vec3, View, Reads)> {
        let Matrix { p, q, r, x, y } = self.matrix;
        let w = self.to_unit(v);
        if !(w.z >= 0.0) {
            return None;
        }
        let to_tangent = |m: f32x4| {
            let [mx, my, mz, _] = m.to_array();
            let lanes = |a| f32x4::splat(a);
            lanes(mx) * f32x4::new([p, 0.0, 0.0, 0.0])
                + lanes(my) * f32x4::new([q, r, 0.0, 0.0])
                + lanes(mz) * f32x4::new([x, y, 1.0, 0.0])
        };
        let xy = f32x4::new([w.x, w.y, 0.0, 0.0]);
        let view = View::new::<_, HEAVY>(self.slices, xy, w.z);
        let reads = Reads::new::<_, HEAVY>(self.slices, &view, u)?;
        let m = draw_located::<_, HEAVY>(self.slices, &view, &reads, [1.0; 2], to_tangent)?;
        // Refused where an almost singular matrix has taken squares out of range, so that the
        // length is not 1 (also where z was as long as the rest before it shrank), and for a normal
        // below the smallest cosine.
        let [[off, ..], [_, _, z, _]] = [(sum(m * m) - 1.0).abs(), m].map(f32x4::to_array);
        (off < 5e-7 && z >= HORIZON).then(|| (first_three(m), view, reads))
    }

    /// A visible normal of a lobe with a heavy part, out of line so that calls of other lobes stay
    /// short.
    #[inline(never)]
    fn sample_heavy(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> Vec3 {
        let m = self.sample_fast::<true>(Vec3::new(x, y, z), u);
        m.map_or_else(|| self.sample_general(x, y, z, u), |(m, ..)| m)
    }

    /// A visible normal, and its density where that is a by-product; `None` where the draw is not
    /// the common one.
    #[inline(always)]
    fn draw_with_density<const HEAVY: bool>(
        &self,
        v: Vec3,
        u: [f32; 2],
    ) -> Option<(Vec3, Option<f32>)> {
        let (m, view, reads) = self.sample_fast::<HEAVY>(v, u)?;
        // The length of U⁻ᵀm is in the ratio of solid angles and in the cosine of unit space, and
        // cancels; U⁻ᵀ leaves z as it is.
        let area = self.matrix.p * self.matrix.r;
        Some((m, self.slices.density_of_reads(&reads, view.at, area, m.z)))
    }

    /// A visible normal for every matrix and view.
    #[inline(never)]
    fn sample_general(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> Vec3 {
        let w = self.to_unit(Vec3::new(x, y, z));
        let [mx, my, mz] = if w.z >= 0.0 {
            let [x, y, z] = w.to_array().map(f32x4::splat);
            let m = self.unit().unnormalised(Views::new(x, y, z), u);
            m.map(|m| m.to_array()[0])
        } else {
            let view = stretched(w);
            let along = self.sample_below(w, &view, u);
            self.unit().unit_normal(&view, along, self.unit().sample_across(u[1])).to_array()
        };
        let Matrix { p, q, r, x, y } = self.matrix;
        let m = Vec3::new(p * mx + q * my + x * mz, r * my + y * mz, mz);
        // With an almost singular matrix the squares of components may be subnormal.
        above_horizon(m / m.abs().max_element())
    }

    #[cold]
    fn sample_below(&self, w: Vec3, view: &Stretched, u: [f32; 2]) -> Slope {
        SlopeBelowHorizon::new(self.slices, view.rho, -w.z).sample(u[0], &mut Numbers::new(u))
    }
}

#[cold]
fn inverse_area_below(slices: &Slices, below: &ExcessShare, w: Vec3, at: &Stretched) -> f32 {
    let area = at.rho * SlopeBelowHorizon::new(slices, at.rho, -w.z).excess(below);
    // Finite, since a density of 0 times ∞ would be NaN.
    if area > 0.0 { saturated(1.0 / area) } else { f32::MAX }
}

impl MicrofacetDistribution for EllipsoidRef<'_> {
    #[inline]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        let m = vec3(m);
        if !(m.z > 0.0) {
            return 0.0;
        }
        let (unit, scale) = self.normal_to_unit(m);
        self.d_of_unit(unit, 1.0, FRAC_1_PI * scale)
    }

    /// Smith masking G1(v) = min(1, (v·n)/area); 0 at and below the horizon.
    ///
    /// Without the clamp a lobe that leans away would return more light than it receives.
    #[inline]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        let v = vec3(v);
        if !(v.z > 0.0) {
            return 0.0;
        }
        let w = self.to_unit(v);
        (v.z * self.inverse_area(w, &stretched(w))).min(1.0)
    }

    #[inline(always)]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        let v = vec3(v);
        if self.slices.peeled {
            return self.sample_heavy(v.x, v.y, v.z, u).to_array();
        }
        let m = self.sample_fast::<false>(v, u);
        m.map_or_else(|| self.sample_general(v.x, v.y, v.z, u), |(m, ..)| m).to_array()
    }

    #[inline]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        let w = self.to_unit(v);
        visible_density(v.dot(m), self.d(m), self.inverse_area(w, &stretched(w)))
    }

    /// G2(v, l)·area/(v·n) ≤ 1.
    #[inline]
    fn reflection_weight(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> f32 {
        let (v, l) = (vec3(v), vec3(l));
        if !(v.z > 0.0) {
            return 0.0;
        }
        let w = self.to_unit(v);
        self.weight(v.z * self.inverse_area(w, &stretched(w)), l, masking)
    }

    /// From `visible_normal_pdf` and `reflection_weight`, with the area of the view computed once.
    #[inline]
    fn facet(
        &self,
        v: impl Into<[f32; 3]>,
        m: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> Facet {
        let (v, m, l) = (vec3(v), vec3(m), vec3(l));
        if !(v.z > 0.0 && m.z > 0.0) {
            return Facet::default();
        }
        let w = self.to_unit(v);
        let inverse_area = self.inverse_area(w, &stretched(w));
        let (unit, scale) = self.normal_to_unit(m);
        let d = self.d_of_unit(unit, m.dot(m), FRAC_1_PI * scale);
        let weight = self.weight(v.z * inverse_area, l, masking);
        Facet { density: saturated(d * inverse_area), weight }
    }

    fn is_effectively_smooth(&self) -> bool {
        let Matrix { p, q, r, x, y } = self.matrix;
        self.slices.is_smooth(p.max(q.abs()).max(r)) && x.abs().max(y.abs()) < SMOOTH
    }

    /// Whether the lobe is only turned: a tilt moves the mean slope away from 0.
    fn is_symmetric(&self) -> bool {
        self.matrix.x == 0.0 && self.matrix.y == 0.0
    }
}

impl Reflecting for EllipsoidRef<'_> {}

impl Tabulated for EllipsoidRef<'_> {
    /// That of the untransformed lobe times the ratio of solid angles. For views below the lobe's
    /// horizon samples have the analytic density.
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        let w = self.to_unit(v);
        if !(m.z > 0.0 && w.z >= 0.0) {
            return self.visible_normal_pdf(v, m);
        }
        if is_hidden(v, m) {
            return 0.0;
        }
        let (unit, scale) = self.normal_to_unit(m);
        let length = sqrt(unit.dot(unit));
        // The ratio of solid angles, scale over the length cubed.
        let stretch = scale / length / (length * length);
        let density = self.slices.density_of_samples([1.0; 2], w, unit / length) * stretch;
        // For a normal far from unit length powers of the length are out of range, and 0·∞ is NaN.
        if density > 0.0 { density.min(f32::MAX) } else { 0.0 }
    }

    fn sample_with_table_pdf(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        let v = vec3(v);
        let drawn = if self.slices.peeled {
            self.draw_with_density::<true>(v, u)
        } else {
            self.draw_with_density::<false>(v, u)
        };
        with_table_pdf(self, drawn, v, u)
    }

    fn key(&self) -> LobeKey {
        LobeKey::Tilted { matrix: self.matrix.entries(), gamma: self.gamma() }
    }

    #[inline]
    fn has_pole(&self) -> bool {
        has_pole(self.gamma())
    }

    fn bytes(&self) -> usize {
        self.slices.bytes()
    }
}

impl Batch for EllipsoidRef<'_> {}

forward!(#[inline(always)] Ellipsoid, by_ref: MicrofacetDistribution, Reflecting, Tabulated, Batch);
