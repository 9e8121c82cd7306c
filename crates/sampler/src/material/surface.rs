//! A shape at a roughness: what upright lobes of the family compute, whatever holds the shape.
//!
//! A [`Shape`] is all that lookups read of one γ: the slices that a lobe has bound, or the general
//! set at the γ of one hit. A roughness adds a few numbers to it, [`Scales`], so that it may change
//! at every hit. The lookups are written once for both, in SIMD [`lanes`](super::lanes), and in
//! readable scalar code here and in [`student_t`](super::student_t).

use core::f32::consts::PI;

use glam::Vec3;
use microfacet_core::Masking;
use microfacet_core::math::sqrt;
use microfacet_lanes::{Lanes, f32x4};
use microfacet_tables::axis::Rational;
use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::axis::hermite::split;

use super::batch::Batch;
use super::distribution::{
    Facet, GRAZING, MicrofacetDistribution, SMOOTH, SMOOTH_MASKED, visible_density,
};
use super::heavy::Part;
use super::reflecting::Reflecting;
use crate::error::{BatchError, same_lengths};
use crate::vector::vec3;

/// What lookups in lanes read of the shapes of their lanes. Indices are of nodes and cells; one
/// that is out of range, as NaN gives, is answered by NaN or 0.
pub(crate) trait Shapes: Copy {
    /// s = 1/(γ−1).
    fn s_lanes<L: Lanes>(self) -> L;
    /// Whether a part of the visible normals, the [heavy](super::heavy) one, is not in the tables.
    fn peeled(self) -> bool;

    /// The view coordinate of slopes, in rows.
    fn lines(self) -> Lines;
    /// Nodes in half a row of slopes.
    fn half(self) -> u32;
    /// Factors from min(u, 1−u)^¼ to cells, along the plane of incidence and across it.
    fn scales(self) -> [f32; 2];
    /// (value, slope) of a node and the next, linear in w between their row and the row after it.
    fn between_lanes<L: Lanes>(self, low: L::Ints, w: L) -> [L; 4];
    /// The distance of the slope across from its end, in a cell.
    fn across_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L;

    /// The number along the plane of incidence within the part that it selects, at a view
    /// coordinate in rows, and all ones where that is the heavy part.
    fn parts<L: Lanes>(self, u: L, at: L) -> [L; 2];
    /// The constants of [`half_slopes`](super::heavy::half_slopes).
    fn tails<L: Lanes>(self) -> [L; 2];

    /// The view coordinate of G1, and its number of cells.
    fn masking_view(self) -> (Rational, f32);
    /// G1/q over the number of cells.
    fn masking_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L;

    /// The coordinate of views in rows, and 1 − τ. The same bits whatever `HEAVY` is, which must be
    /// true of a peeled table.
    #[inline(always)]
    fn place<const HEAVY: bool, L: Lanes>(self, rho: L, z: L, length: L) -> [L; 2] {
        if HEAVY && self.peeled() {
            self.lines().of_views::<true, _>(rho, z, length)
        } else {
            self.lines().of_views::<false, _>(rho, z, length)
        }
    }
}

/// What lookups of one direction read of one shape.
pub(crate) trait Shape: Shapes {
    /// What a shape is found by again: for calls out of line, whose arguments are in registers.
    type Seed: Copy;

    fn seed(self) -> Self::Seed;
    fn of_seed(seed: Self::Seed) -> Self;

    /// s = 1/(γ−1).
    fn s(self) -> f32;

    /// Whether [`between`](Self::between) and [`across`](Self::across) hold a node and a cell: one
    /// test for all reads.
    fn reads(self, high: usize, across: usize) -> bool;
    /// As [`between_lanes`](Shapes::between_lanes).
    fn between(self, low: usize, high: usize, w: f32) -> f32x4;
    /// As [`across_lanes`](Shapes::across_lanes).
    fn across(self, cell: usize, w: f32) -> f32;

    /// The share of the heavy part at a view coordinate in rows.
    fn share(self, at: f32) -> f32;
    /// The number along the plane of incidence within the part that it selects.
    #[inline(always)]
    fn part(self, u: f32, at: f32) -> Part {
        Part::of(u, self.share(at))
    }

    /// κ of the view coordinate of G1.
    fn kappa(self) -> f32;
    /// G1/q over the number of cells: a cell of it, and its value there.
    type MaskingCell;
    fn masking_cell(self, cell: usize) -> Option<Self::MaskingCell>;
    fn masking(cell: Self::MaskingCell, w: f32) -> f32;
    /// The same of a view and a light, in the first two lanes.
    fn masking_of_two(self, cells: [usize; 2], w: f32x4) -> Option<f32x4>;
    /// M₀ = ∫₀^∞ x p(x) dx, the projected area per ρ at grazing: κ over the first value of G1/q.
    fn first_moment(self) -> f32;

    /// D of a normal above the horizon, from the squares of its horizontal component over σ, of its
    /// vertical component and of its length, which need not be 1, and from 1/(πσxσy).
    fn d(self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32;

    /// The coordinate of one view in rows, equal to the sampler's to rounding.
    #[inline(always)]
    fn row(self, &Stretched { rho, z, .. }: &Stretched) -> f32 {
        let [rho, z, length] = [rho, z, sqrt(rho * rho + z * z)].map(f32x4::splat);
        self.place::<true, _>(rho, z, length)[0].to_array()[0]
    }

    /// 1/(area of the microsurface seen along the stretched direction) = G1/z, finite at grazing.
    #[inline(always)]
    fn inverse_area(self, w: &Stretched) -> f32 {
        /// Less than any area; its reciprocal times the number of cells stays finite.
        const LEAST_AREA: f32 = 1e-30;
        let (view, cells) = self.masking_view();
        let kappa = self.kappa();
        // cells/(z + κρ): times z, it is the view coordinate q in cells. z + κρ vanishes only for
        // the null vector and straight below the surface, where z·r is then 0 and not 0·∞.
        let r = cells / (w.z + kappa * w.rho).max(LEAST_AREA);
        let (cell, w) = split(f32x4::splat(view.of_view(w.rho, w.z, kappa, r, cells)));
        // G1/q over the number of cells. The index is out of the table only for NaN.
        let cell = self.masking_cell(cell.to_array()[0] as u32 as usize);
        cell.map_or(0.0, |cell| Self::masking(cell, w.to_array()[0])) * r
    }

    /// Whether a lobe of this shape with roughness σ is smooth, see
    /// [`is_effectively_smooth`](crate::MicrofacetDistribution::is_effectively_smooth).
    #[inline(always)]
    fn is_smooth(self, sigma: f32) -> bool {
        /// Twice the least M₀ of the family, that of Beckmann, 1/(2√π), rounded down.
        const LEAST_SLOPE: f32 = 0.56;
        // The common case reads no table.
        LEAST_SLOPE * sigma < SMOOTH && is_almost_smooth::<Self>(self.seed(), sigma)
    }
}

#[cold]
#[inline(never)]
fn is_almost_smooth<S: Shape>(seed: S::Seed, sigma: f32) -> bool {
    let shape = S::of_seed(seed);
    let rho = sigma * sqrt(1.0 - GRAZING * GRAZING);
    let grazing = Stretched { x: 1.0, y: 0.0, frame: 1.0, rho, z: GRAZING };
    let masked = 1.0 - GRAZING * shape.inverse_area(&grazing);
    // The mean of |x| over unit slopes x: 1 for GGX, and without limit towards γ = 3/2.
    let mean_slope = 2.0 * shape.first_moment();
    sigma * mean_slope < SMOOTH && masked <= SMOOTH_MASKED
}

/// [`Shape::first_moment`] from G1.
#[inline(always)]
pub(crate) fn moment_of<S: Shape>(shape: S) -> f32 {
    let first = shape.masking_cell(0).map_or(f32::NAN, |cell| S::masking(cell, 0.0));
    shape.kappa() / (first * shape.masking_view().1)
}

/// What a roughness adds to a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// σx and σy.
    pub(crate) sigma: [f32; 2],
    /// 1/σx and 1/σy.
    inverse: [f32; 2],
    /// 1/(πσxσy).
    density: f32,
    /// κσx and κσy, of G1's coordinate.
    pub(crate) kappa: [f32; 2],
}

impl Scales {
    #[inline(always)]
    pub(crate) fn new(sigma: [f32; 2], kappa: f32) -> Self {
        let [x, y] = sigma;
        Self {
            sigma,
            inverse: [1.0 / x, 1.0 / y],
            density: 1.0 / (PI * x * y),
            kappa: [kappa * x, kappa * y],
        }
    }
}

/// A shape at a roughness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<S> {
    pub(crate) shape: S,
    pub(crate) scales: Scales,
}

/// A direction stretched by (σx, σy, 1), with its azimuth in unit space.
#[derive(Clone, Copy)]
pub(crate) struct Stretched {
    /// Direction of the horizontal component, of length `frame`; (1, 0) at normal incidence.
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// Length of (x, y): that of the horizontal component, or 1 where that is short.
    pub(crate) frame: f32,
    /// Horizontal length, 0 at normal incidence.
    pub(crate) rho: f32,
    /// Vertical component, ≥ 0.
    pub(crate) z: f32,
}

/// Shorter horizontal components count as normal incidence: their squares, and the azimuth with
/// them, leave the range of f32.
pub(crate) const NORMAL_INCIDENCE: f32 = 1e-18;

/// For shorter horizontal components the azimuth is scaled to unit length: otherwise the square of
/// a normal carrying it would leave the range of f32.
pub(crate) const SHORT: f32 = 1e-6;

/// For longer horizontal components the azimuth is scaled, or squares would leave the range of f32.
/// A direction of unit length has one only with the matrix of a tilted lobe, whose entries are at
/// most 10¹⁸; otherwise σ ≤ 10⁶.
pub(crate) const LONG: f32 = 1e9;

/// The squares of longer components leave the range of f32.
pub(crate) const LONGEST: f32 = 1e19;

impl Stretched {
    /// A direction that is stretched already.
    #[inline(always)]
    pub(crate) fn new([x, y, z]: [f32; 3]) -> Self {
        let rho = sqrt(x * x + y * y);
        let z = if z > 0.0 { z.min(LONGEST) } else { 0.0 };
        if (SHORT..=LONG).contains(&rho) {
            Self { x, y, frame: rho, rho, z }
        } else if (NORMAL_INCIDENCE..=LONGEST).contains(&rho) {
            Self { x: x / rho, y: y / rho, frame: 1.0, rho, z }
        } else {
            // Normal incidence, straight down, NaN or too long: without z > 0 the view is moved to
            // the horizon, as every view below it, with an arbitrary azimuth.
            let (rho, z) = if z > 0.0 { (0.0, z.max(NORMAL_INCIDENCE)) } else { (1.0, 0.0) };
            Self { x: 1.0, y: 0.0, frame: 1.0, rho, z }
        }
    }
}

impl<S: Shape> Surface<S> {
    #[inline(always)]
    pub(crate) fn new(shape: S, sigma: [f32; 2]) -> Self {
        Self { shape, scales: Scales::new(sigma, shape.kappa()) }
    }

    #[inline(always)]
    pub(crate) fn stretch(self, w: Vec3) -> Stretched {
        let [sx, sy] = self.scales.sigma;
        Stretched::new([sx * w.x, sy * w.y, w.z])
    }

    /// D of a normal above the horizon, by its direction and the square of its length.
    #[inline(always)]
    fn d_of(self, m: Vec3, length2: f32) -> f32 {
        let [x, y] = self.scales.inverse;
        let (x, y) = (m.x * x, m.y * y);
        self.shape.d(x * x + y * y, m.z * m.z, length2, self.scales.density)
    }
}

impl<S: Shape> MicrofacetDistribution for Surface<S> {
    #[inline(always)]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        let m = vec3(m);
        if m.z > 0.0 { self.d_of(m, 1.0) } else { 0.0 }
    }

    #[inline(always)]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        self.g1_of_one(vec3(v))
    }

    #[inline(always)]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        self.sample(vec3(v), u).to_array()
    }

    #[inline(always)]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        let (v, m) = (vec3(v), vec3(m));
        visible_density(v.dot(m), self.d(m), self.shape.inverse_area(&self.stretch(v)))
    }

    #[inline(always)]
    fn reflection_weight(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> f32 {
        let v = vec3(v);
        let [g1_v, g1_l] = self.g1_of_both(v, vec3(l));
        if v.z > 0.0 { masking.g2_over_g1(g1_v, g1_l) } else { 0.0 }
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
        Facet::of_g1(self.d_of(m, m.dot(m)), v, self.g1_of_both(v, l), masking)
    }

    #[inline(always)]
    fn is_effectively_smooth(&self) -> bool {
        let [x, y] = self.scales.sigma;
        self.shape.is_smooth(x.max(y))
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl<S: Shape> Reflecting for Surface<S> {
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        (self.sample_along(vec3(v), u).to_array(), 1.0)
    }
}

impl<S: Shape> Batch for Surface<S> {
    #[inline]
    fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
        self.sample_all(v, u, m);
        Ok(())
    }

    #[inline]
    fn g1_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        g1: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("g1", g1.len())])?;
        self.g1_all(v, g1);
        Ok(())
    }
}
