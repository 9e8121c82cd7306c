//! Visible normals that can reflect a view upwards, so that fewer samples are lost below the
//! horizon.
//!
//! The in-plane slopes of normals that reflect a view upwards are an interval ([`upward`]), and so
//! are their random numbers u₁; sampling that interval changes the density by a factor only. Eto &
//! Tokuyoshi 2023 do so for GGX by shrinking its cap; the interval serves every γ. Where the heavy
//! part is apart from the table, so are its numbers, and there are two intervals. The variance of
//! a white furnace, a mean over views, falls to between 0.04 and 0.65 of its value (`cargo run
//! --release -p microfacet-sampler --example bounded`).
//!
//! The ends need not be exact: any interval that contains the shortest one, with its own length as
//! the share, gives an unbiased estimator and a density known to the bit. So they are interpolated
//! in a small table of limits, by view and slope, without a search. The number of a slope of the
//! heavy part has a closed form.
//!
//! [`upward`]: super::upward

mod limits;
mod narrowed;

use alloc::vec::Vec;

use glam::Vec3;
use microfacet_core::math::unit;
use microfacet_core::{Masking, Roughness};
use microfacet_lanes::{Lanes, f32x4, widest};

use super::batch::Batch;
use super::delegate::{by_ref, forward, unbounded};
use super::distribution::{Facet, MicrofacetDistribution};
use super::key::LobeKey;
use super::lanes::first_three;
use super::lanes::many::sample_general;
use super::lanes::one::draw;
use super::lanes::views::{View, Views};
use super::reflecting::Reflecting;
use super::slices::Slices;
use super::student_t::{StudentT, StudentTRef};
use super::surface::{Scales, Shapes, Surface};
use super::tabulated::Tabulated;
use super::upward::{ends, lost_above};
use crate::error::{BatchError, same_lengths};
use crate::vector::vec3;
use limits::{Limits, Nodes, SHARED, limits_of};
use narrowed::Narrowed;

/// A lobe whose visible normals are drawn without most of those that reflect the view below the
/// horizon.
///
/// Prepared once for a material ([`StudentT::bounded`], a millisecond), it draws a normal in about
/// twice the time of [`MicrofacetDistribution::sample_visible_normal`], in batches as well
/// (`cargo run --profile dist -p microfacet-bench`). Every normal that reflects upwards is kept;
/// some of the others remain. Estimators of reflection that weight with G2/G1 times
/// [`share`](BoundedView::share), or divide by a density of [`BoundedView`], are unbiased, and of
/// lower variance than those of [`MicrofacetDistribution::sample_visible_normal`]. After Eto &
/// Tokuyoshi 2023, *Bounded VNDF Sampling for Smith-GGX Reflections*,
/// <https://doi.org/10.1145/3610543.3626163>.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// # use microfacet_sampler::lobe::Reflecting;
/// # use microfacet_sampler::{Masking, Tables};
/// let bounded = Tables::embedded().student_t(0.8, 3.0)?.bounded();
/// let (v, masking) = ([0.6, 0.0, 0.8], Masking::HeightCorrelated);
/// let (l, weight) = bounded.sample_reflected(v, [0.3, 0.7], masking).expect("above the horizon");
/// assert!(l[2] > 0.0 && weight > 0.0 && weight < bounded.at(v).share());
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bounded {
    lobe: StudentT,
    /// By node of the view and of the slope: the least and the largest random number.
    limits: Vec<[f32; 2]>,
}

/// A [`Bounded`] lobe of another roughness, which borrows all else: the lobe of one hit.
///
/// It is `Copy`, and no memory is allocated for it: the limits depend on the shape alone. Made by
/// [`Bounded::with_roughness`].
#[derive(Clone, Copy, Debug)]
pub struct BoundedRef<'a> {
    lobe: StudentTRef<'a>,
    limits: Limits<'a>,
}

/// The visible normals of one view without most of those that reflect it below the horizon.
#[derive(Clone, Copy, Debug)]
pub struct BoundedView<'a> {
    lobe: StudentTRef<'a>,
    v: Vec3,
    view: View,
    kept: Kept<f32>,
}

impl StudentT {
    /// Prepares the visible normals of every view for reflection.
    #[must_use]
    pub fn bounded(self) -> Bounded {
        Bounded { limits: limits_of(&self.slices), lobe: self }
    }
}

impl Bounded {
    /// The lobe, for evaluation.
    #[must_use]
    pub fn lobe(&self) -> &StudentT {
        &self.lobe
    }

    /// The same shape with another roughness: the lobe of a hit where a texture gives σ.
    ///
    /// σ is clamped as by [`StudentT::with_roughness`].
    #[inline(always)]
    #[must_use]
    pub fn with_roughness(&self, roughness: impl Into<Roughness>) -> BoundedRef<'_> {
        BoundedRef { lobe: self.lobe.with_roughness(roughness), limits: Limits(&self.limits) }
    }

    /// This lobe, borrowed.
    #[inline(always)]
    #[must_use]
    pub fn by_ref(&self) -> BoundedRef<'_> {
        BoundedRef { lobe: self.lobe.by_ref(), limits: Limits(&self.limits) }
    }

    /// The normals of a view.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, v: impl Into<[f32; 3]>) -> BoundedView<'_> {
        self.by_ref().at(v)
    }

    /// [`BoundedRef::sample_reflecting_batch`] of this lobe.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; nothing is then written.
    pub fn sample_reflecting_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
        share: &mut [f32],
    ) -> Result<(), BatchError> {
        self.by_ref().sample_reflecting_batch(v, u, m, share)
    }
}

impl<'a> BoundedRef<'a> {
    /// The lobe, for evaluation.
    #[must_use]
    pub fn lobe(&self) -> StudentTRef<'a> {
        self.lobe
    }

    /// The normals of a view.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, v: impl Into<[f32; 3]>) -> BoundedView<'a> {
        let v = vec3(v);
        let surface = self.lobe.surface();
        let view =
            if surface.shape.peeled { surface.view::<true>(v) } else { surface.view::<false>(v) };
        let View { rho, z, at, .. } = view;
        let sin = f32x4::splat(v.x * v.x + v.y * v.y).sqrt();
        let kept = self.kept(rho, z, sin, at, |group, cells| {
            let limit =
                |i: usize| f32x4::splat(self.limits.limit(group.first(), cells[i].first(), i));
            [limit(0), limit(1)]
        });
        BoundedView { lobe: self.lobe, v, view, kept: kept.first() }
    }

    /// [`BoundedView::sample`] for each view and pair of numbers, into `m`, and
    /// [`BoundedView::share`] into `share`: the same normals, to 2 ulp.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; nothing is then written.
    pub fn sample_reflecting_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
        share: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len()), ("share", share.len())])?;
        /// Enough to fill the lanes, and few enough to stay in the first cache.
        const BLOCK: usize = 64;
        let blocks = v.chunks(BLOCK).zip(u.chunks(BLOCK));
        for (((v, u), m), share) in blocks.zip(m.chunks_mut(BLOCK)).zip(share.chunks_mut(BLOCK)) {
            let mut numbers = [[0.0; 2]; BLOCK];
            let numbers = &mut numbers[..v.len()];
            let narrowed = Narrowed { lobe: *self, v, u, numbers, share };
            let Narrowed { v: v_rest, u: u_rest, numbers: n_rest, share: s_rest, .. } =
                widest(narrowed).groups::<f32x4>();
            for (((v, u), n), share) in v_rest.iter().zip(u_rest).zip(n_rest).zip(s_rest) {
                let kept = self.at(*v).kept;
                *share = kept.share;
                *n = [kept.number(u[0]), u[1]];
            }
            self.lobe.surface().sample_all(v, numbers, m);
        }
        Ok(())
    }

    #[inline(always)]
    fn kept_of<L: Lanes>(&self, [vx, vy, vz]: [L; 3]) -> Kept<L> {
        let Surface { shape: slices, scales } = self.lobe.surface();
        let [sx, sy] = scales.sigma;
        let Views { rho, z, length, .. } = Views::new(vx * sx, vy * sy, vz);
        let [at, _] = slices.place::<true, L>(rho, z, length);
        let sin = (vx * vx + vy * vy).sqrt();
        self.kept(rho, z, sin, at, |row, cells| self.limits.both(row, cells))
    }

    /// The numbers u₁ that hold all at which lights can be above the horizon, for views with
    /// stretched horizontal length ρ and coordinate `at`; `limits` reads the limits at rows and at
    /// the slopes of both ends.
    #[inline(always)]
    fn kept<L: Lanes>(
        &self,
        rho: L,
        cos: L,
        sin: L,
        at: L,
        limits: impl FnOnce(Nodes<L>, [Nodes<L>; 2]) -> [L; 2],
    ) -> Kept<L> {
        let Surface { shape: slices, scales } = self.lobe.surface();
        let group = Nodes::new(at * (1.0 / SHARED as f32));
        let [least, steepest] = ends(rho, cos, sin, scales.sigma[0]);
        let [low, high] = limits(group, [Nodes::of_slope(least), Nodes::of_slope(steepest)]);
        if slices.peeled {
            // The tabulated part comes first; the heavy one has no slopes away from the viewer.
            let (zero, share) = (L::splat(0.0), slices.heavy.shares(at));
            let rest = (L::splat(1.0) - share).fast_max(zero);
            let (from, end) = (low * rest, high * rest);
            let heavy = (share - lost_above(slices, share, steepest)).fast_max(zero);
            return Kept { from, share: (end - from) + heavy, end, gap: rest - end };
        }
        Kept { from: low, share: high - low, end: L::splat(f32::INFINITY), gap: L::splat(0.0) }
    }
}

forward!(#[inline(always)] Bounded, by_ref: MicrofacetDistribution, Reflecting, Tabulated, Batch);
// As the lobe, except for the normals that are drawn for reflection.
forward!(#[inline(always)] BoundedRef<'_>, unbounded: MicrofacetDistribution, Batch);

impl Reflecting for BoundedRef<'_> {
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        let at = self.at(v);
        (at.sample(u), at.share())
    }

    #[inline(always)]
    fn reflecting_share(&self, v: impl Into<[f32; 3]>) -> f32 {
        self.at(v).share()
    }
}

impl Tabulated for BoundedRef<'_> {
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        self.lobe.table_pdf(v, m)
    }

    fn sample_with_table_pdf(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        self.lobe.sample_with_table_pdf(v, u)
    }

    fn key(&self) -> LobeKey {
        self.lobe.key()
    }

    #[inline]
    fn has_pole(&self) -> bool {
        self.lobe.has_pole()
    }

    fn bytes(&self) -> usize {
        self.lobe.bytes() + size_of_val(self.limits.0)
    }
}

/// The numbers u₁ that are kept: those between `from` and `end` and, beyond a gap, as many more as
/// make up their `share` of all.
#[derive(Clone, Copy, Debug)]
struct Kept<T> {
    from: T,
    share: T,
    end: T,
    gap: T,
}

impl Kept<f32x4> {
    #[inline(always)]
    fn first(self) -> Kept<f32> {
        let Self { from, share, end, gap } = self;
        let [from, share, end, gap] = [from, share, end, gap].map(|x| x.to_array()[0]);
        Kept { from, share, end, gap }
    }
}

impl Kept<f32> {
    /// The number of all that is one in [0, 1] of those kept.
    #[inline(always)]
    fn number(&self, u: f32) -> f32 {
        let number = self.from + unit(u) * self.share;
        (number + if number > self.end { self.gap } else { 0.0 }).min(1.0)
    }
}

impl BoundedView<'_> {
    /// A normal from two random numbers, which are clamped to [0, 1].
    #[inline]
    #[must_use]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 3] {
        let (lobe, v) = (self.lobe, self.v);
        let u = [self.kept.number(u[0]), u[1]];
        let Surface { shape, scales: Scales { sigma, .. } } = lobe.surface();
        let m = if shape.peeled {
            draw::<_, true>(shape, &self.view, u, sigma, |m| m)
        } else {
            draw::<_, false>(shape, &self.view, u, sigma, |m| m)
        };
        let general = || sample_general::<&Slices>(shape, sigma, v.x, v.y, v.z, u);
        m.map_or_else(general, first_three).to_array()
    }

    /// Probability that an unbounded sample lies in the interval, in (0, 1]: the factor on a
    /// sample's weight.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.kept.share
    }

    /// Density per steradian with which [`sample`](Self::sample) draws `m`, for an `m` that
    /// reflects the view above the horizon. Analytic, with G1 from the table.
    ///
    /// The density of reflected directions is this density over 4 v·m.
    #[inline]
    #[must_use]
    pub fn visible_normal_pdf(&self, m: impl Into<[f32; 3]>) -> f32 {
        self.lobe.visible_normal_pdf(self.v, m) / self.kept.share
    }

    /// The density of the table's samples for an `m` that reflects the view above the horizon, see
    /// [`Tabulated::table_pdf`].
    #[must_use]
    pub fn table_pdf(&self, m: impl Into<[f32; 3]>) -> f32 {
        self.lobe.table_pdf(self.v, m) / self.kept.share
    }

    /// [`sample`](Self::sample) and its [`table_pdf`](Self::table_pdf), in less time than one after
    /// the other.
    #[must_use]
    pub fn sample_with_table_pdf(&self, u: [f32; 2]) -> ([f32; 3], f32) {
        let u = [self.kept.number(u[0]), u[1]];
        let (m, density) = self.lobe.sample_with_table_pdf(self.v, u);
        (m, density / self.kept.share)
    }
}
