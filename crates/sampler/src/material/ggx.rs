//! GGX without tables: at γ = 2 masking and visible normals have closed forms.

use core::f32::consts::FRAC_1_PI;

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::{Masking, Roughness, saturated};
use microfacet_lanes::{Lanes, Work, f32x4, widest};
use microfacet_tables::axis::above_zero;

use super::batch::Batch;
use super::distribution::{Facet, MicrofacetDistribution, SMOOTH, visible_density};
use super::heavy::units;
use super::horizon::{above_horizon, face};
use super::key::LobeKey;
use super::lanes::many::{above_horizon as raised_to_horizon, components, facing};
use super::pseudo::{LAST, PseudoVisible, normal};
use super::reflecting::Reflecting;
use super::roughness::checked;
use super::surface::{LONG, LONGEST, SHORT};
use super::tabulated::Tabulated;
use crate::elementary::{turn, turns};
use crate::error::{BatchError, MaterialError, same_lengths};
use crate::vector::vec3;

/// GGX (Trowbridge–Reitz), the member γ = 2 of the family, from closed forms alone, without tables.
///
/// G1 is Walter et al. 2007, eq. 34 (<https://doi.org/10.2312/EGWR/EGSR07/195-206>). Visible
/// normals are drawn by spherical caps (Dupuy & Benyoub 2023, *Sampling Visible GGX Normals with
/// Spherical Caps*, listing 1, <https://doi.org/10.1111/cgf.14867>): `u[0]` chooses the height of a
/// point on a cap and `u[1]` its azimuth about n, so the map from `u` to normals differs from that
/// of tables; the density is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha_x: f32,
    alpha_y: f32,
    /// 1/αx and 1/αy.
    inverse_alpha: [f32; 2],
    /// 1/(παxαy).
    scale: f32,
}

impl Ggx {
    /// From the roughness α, a number or a pair for x and y; it is the σ of the family.
    ///
    /// # Errors
    /// [`MaterialError::Sigma`] unless every α lies in [1e-8, 1e6].
    pub fn new(alpha: impl Into<Roughness>) -> Result<Self, MaterialError> {
        let [alpha_x, alpha_y] = checked(alpha.into())?;
        let inverse_alpha = [1.0 / alpha_x, 1.0 / alpha_y];
        Ok(Self { alpha_x, alpha_y, inverse_alpha, scale: FRAC_1_PI / (alpha_x * alpha_y) })
    }

    /// αx and αy.
    #[must_use]
    pub fn alpha(&self) -> [f32; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// A direction with its horizontal component times α; one below the horizon is moved to it.
    #[inline(always)]
    fn stretch(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.alpha_x * v.x, self.alpha_y * v.y, v.z.max(0.0))
    }

    /// D of a normal above the horizon whose squared length is given: 1/(παxαy b²) with
    /// b = (z² + (x/αx)² + (y/αy)²)/|m|².
    #[inline(always)]
    fn d_of(&self, m: Vec3, length2: f32) -> f32 {
        let (x, y) = (m.x * self.inverse_alpha[0], m.y * self.inverse_alpha[1]);
        let root = length2 / (m.z * m.z + (x * x + y * y)).max(f32::MIN_POSITIVE);
        self.scale * root * root
    }

    /// G1/z = 2/(z + √(ρ² + z²)), finite at grazing.
    #[inline(always)]
    fn inverse_area(&self, v: Vec3) -> f32 {
        let w = self.stretch(v);
        let length = sqrt(w.dot(w));
        // The null vector, and views straight from below, have area 0: any positive number serves.
        2.0 / (w.z + length).max(f32::MIN_POSITIVE)
    }

    /// A visible normal, of any length, which rounding may have put behind the silhouette: the half
    /// vector of the stretched view w and a point of the cap z > −w.z of the sphere of radius |w|,
    /// stretched back.
    #[inline(always)]
    fn along(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let w = self.stretch(v);
        let length = sqrt(w.dot(w));
        let common = (SHORT..=LONG).contains(&length);
        let (w, length) = if common { (w, length) } else { (lifted(w, length), 1.0) };
        // Height of the half vector first, so that it keeps its digits where the cap ends at −w.z.
        let height = (1.0 - unit(u[0])).max(LAST) * (length + w.z);
        let z = height - w.z;
        let radius = sqrt(((length - z) * (length + z)).max(0.0));
        let [sin, cos] = turn(unit(u[1]));
        let (x, y) = (w.x + radius * cos, w.y + radius * sin);
        Vec3::new(self.alpha_x * x, self.alpha_y * y, height)
    }
}

impl MicrofacetDistribution for Ggx {
    #[inline]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        let m = vec3(m);
        if !(m.z > 0.0) {
            return 0.0;
        }
        saturated(self.d_of(m, 1.0))
    }

    #[inline]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        let v = vec3(v);
        (v.z.max(0.0) * self.inverse_area(v)).min(1.0)
    }

    // Without inlining the view would go from the caller's registers through memory.
    #[inline(always)]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        let v = vec3(v);
        face(above_horizon(self.along(v, u)), Vec3::new(v.x, v.y, v.z.max(0.0))).to_array()
    }

    #[inline]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        visible_density(v.dot(m), self.d(m), self.inverse_area(v))
    }

    #[inline(always)]
    fn facet(
        &self,
        v: impl Into<[f32; 3]>,
        m: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> Facet {
        let (v, m, l) = (vec3(v), vec3(m), vec3(l));
        if !(m.z > 0.0) {
            return Facet::default();
        }
        Facet::of_g1(self.d_of(m, m.dot(m)), v, [self.g1(v), self.g1(l)], masking)
    }

    fn is_effectively_smooth(&self) -> bool {
        self.alpha_x.max(self.alpha_y) < SMOOTH
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Reflecting for Ggx {
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        (self.along(vec3(v), u).to_array(), 1.0)
    }
}

impl PseudoVisible for Ggx {
    #[inline]
    fn sample_pseudo_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        let first = unit(u[0]);
        let r = sqrt(first / (1.0 - first).max(LAST));
        normal(self.alpha(), vec3(v), r, u[1]).to_array()
    }
}

impl Tabulated for Ggx {
    fn key(&self) -> LobeKey {
        LobeKey::of_family(self.alpha(), 2.0)
    }
}

impl Batch for Ggx {
    fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
        let done = widest(Normals { lobe: *self, v, u, m });
        let (v, u, m) = (&v[done..], &u[done..], &mut m[done..]);
        // What does not fill more lanes may fill four.
        let done = self.sample_groups::<f32x4, V, M>(v, u, m);
        for ((v, u), m) in v[done..].iter().zip(&u[done..]).zip(&mut m[done..]) {
            *m = self.sample_visible_normal(*v, *u).into();
        }
        Ok(())
    }
}

impl Ggx {
    /// Normals of all views but those too few to fill lanes; how many they are.
    #[inline(always)]
    fn sample_groups<L: Lanes, V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> usize {
        let groups = v.chunks_exact(L::WIDTH).zip(u.chunks_exact(L::WIDTH));
        for ((v, u), m) in groups.zip(m.chunks_exact_mut(L::WIDTH)) {
            let u = [L::from_fn(|i| u[i][0]), L::from_fn(|i| u[i][1])];
            let views = components(v);
            let normals = raised_to_horizon(self.along_lanes(views, u), L::splat(1.0));
            let [x, y, z] = facing(normals, views, L::splat(0.0));
            let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
            m.iter_mut().enumerate().for_each(|(i, m)| *m = M::from([x[i], y[i], z[i]]));
        }
        v.len() - v.len() % L::WIDTH
    }

    /// [`along`](Self::along) in lanes.
    #[inline(always)]
    fn along_lanes<L: Lanes>(self, [x, y, z]: [L; 3], u: [L; 2]) -> [L; 3] {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let (mut x, mut y, mut z) = (x * self.alpha_x, y * self.alpha_y, above_zero(z));
        let mut length = (x * x + y * y + z * z).sqrt();
        let common = length.simd_ge(L::splat(SHORT)) & length.simd_le(L::splat(LONG));
        if !common.all() {
            // As `lifted`.
            let tilted = length.simd_gt(zero) & length.simd_le(L::splat(LONGEST));
            x = common.select(x, tilted & (x / length));
            y = common.select(y, tilted & (y / length));
            z = common.select(z, tilted.select(z / length, one));
            length = common.select(length, one);
        }
        let height = (one - units(u[0])).fast_max(L::splat(LAST)) * (length + z);
        let cap = height - z;
        let radius = ((length - cap) * (length + cap)).fast_max(zero).sqrt();
        let [sin, cos] = turns(units(u[1]));
        let (x, y) = (x + radius * cos, y + radius * sin);
        [x * self.alpha_x, y * self.alpha_y, height]
    }
}

/// [`Ggx::sample_groups`].
struct Normals<'a, V, M> {
    lobe: Ggx,
    v: &'a [V],
    u: &'a [[f32; 2]],
    m: &'a mut [M],
}

impl<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>> Work for Normals<'_, V, M> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        self.lobe.sample_groups::<L, V, M>(self.v, self.u, self.m)
    }
}

/// A stretched view of unit length, since the squares of a short or long one would leave the range
/// of f32; the null vector, and one whose own square does, count as normal incidence.
#[cold]
#[inline(never)]
fn lifted(w: Vec3, length: f32) -> Vec3 {
    if length > 0.0 && length <= LONGEST { w / length } else { Vec3::Z }
}
