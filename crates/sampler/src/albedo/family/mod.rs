//! The directional albedo at any shape and roughness, for textures of σ and γ: a volume over
//! (γ, σ, view), made once from a table of moments, in which a lookup costs little more than one in
//! a texture.
//!
//! `axes` has the coordinates, of which `octaves` is the logarithm, `spline` the polynomials
//! between nodes, and `build` fills the volume; `tables` is for exports.

mod axes;
mod build;
mod octaves;
mod spline;
pub(crate) mod tables;

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_lanes::{Ints, Lanes, Work, f32x4, widest};

use self::axes::{Axes, Place, SHAPE, SIGMA, View};
use self::spline::{FOUR, THREE};
use super::batch::of_each;
use super::moments::Moments;
use crate::elementary::exp2;
use crate::error::{BatchError, same_lengths};
use crate::vector::vec3;

/// Coefficients along the view, and along the shape.
const VIEWS: usize = View::CELLS + 3;
const SHAPES: usize = Axes::SHAPES + 3;
/// Coefficients along the view at one shape and roughness, and one that is read with weight 0.
type Row = [f32; VIEWS + 1];
/// What a lookup reads of one channel: from the first of four coefficients of the first of three
/// shapes of the first of three roughnesses to the last of the last.
const PART: usize = 2 * SHAPES * VIEWS + 2 * VIEWS + FOUR;

/// The directional albedo of the family under one form of masking, to be read at any σ and γ: for
/// renderers that take them from textures.
///
/// Made by [`Tables::family_albedo`](crate::Tables::family_albedo), once for all materials: it
/// takes half a MiB. A lookup is [`at`](Self::at) a place on the surface, and then a method of
/// [`AlbedoAt`] for each view and light.
///
/// In the default set E differs from [`Tables::albedo`](crate::Tables::albedo) by at most 5e-4 for
/// γ ≥ 1.6, 7e-4 for γ = 1.55 and 2.5e-3 down to 1.501 (where cos θ > 0.99), for σ ≥ 0.01 and
/// cos θ ≥ 0.02. Elsewhere, for σ ≥ 1e-8 and cos θ ≥ 1e-4, by 1.5e-3 for γ ≥ 1.55, and 5e-3 for
/// γ = 1.501. Bias and F82 differ by 3e-4 and 7e-4, elsewhere by 2e-3. Views of cos θ < 1e-4 are
/// those of a continuation, which for γ < 1.6 misses the limit at the horizon.
/// `cargo test --release -p microfacet-sampler --test family_albedo -- --nocapture` measures them.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{Masking, Tables};
///
/// let family = Tables::embedded().family_albedo(Masking::HeightCorrelated)?; // once
/// let albedo = family.at(0.8, 3.0); // at every hit
/// let v = [0.6, 0.0, 0.8];
/// let gold = albedo.moments(v).schlick(0.77, 1.0); // green: F0, F90
/// let factor = albedo.turquin(v, 0.77);
/// assert!(albedo.albedo(v) < 1.0 && gold < albedo.albedo(v) && factor > 1.0);
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FamilyAlbedo {
    masking: Masking,
    axes: Axes,
    /// Whether σ = 0, a mirror, is covered.
    mirror: bool,
    /// Coefficients of √(1 − E), of which small losses keep their order of magnitude, of the excess
    /// of bias, and of that of F82: by σ, by γ, by view.
    values: [Vec<f32>; 3],
    /// Coefficients of log₂(1 − E_avg) and of the averages of the other two: by σ, by γ. They have
    /// nodes of σ of their own, since the smallest averages too are kept with their digits.
    averages: Vec<[f32; 4]>,
}

impl FamilyAlbedo {
    /// The albedo at a roughness σ and a shape γ, of those that the set covers.
    ///
    /// Both are clamped to the ranges that the set's table covers, in the default set σ to
    /// [1e-8, 3] and γ to [1.501, ∞], which is Beckmann; NaN counts as the smallest. σ ≤ 0 is a
    /// mirror, with E = 1, where the set covers σ = 0.
    #[inline]
    #[must_use]
    pub fn at(&self, sigma: f32, gamma: f32) -> AlbedoAt<'_> {
        let mirror = self.mirror & (sigma <= 0.0);
        let (sigma, d) = self.axes.clamped(sigma, gamma);
        AlbedoAt { mirror, ..self.place(sigma, d) }
    }

    /// At a clamped σ and d = 2γ−3.
    #[inline(always)]
    fn place(&self, sigma: f32, d: f32) -> AlbedoAt<'_> {
        let place = self.axes.place(sigma, d);
        AlbedoAt { family: self, place, sigma, view: View::new(sigma, d), mirror: false }
    }

    /// E with F = 1 of each hit, of σ, γ and a view, into `e`: that of [`at`](Self::at), one by one,
    /// since each combines coefficients of its own.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `e` is then untouched.
    pub fn albedo_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        sigma: &[f32],
        gamma: &[f32],
        v: &[V],
        e: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[
            ("sigma", sigma.len()),
            ("gamma", gamma.len()),
            ("v", v.len()),
            ("e", e.len()),
        ])?;
        for (((sigma, gamma), v), e) in sigma.iter().zip(gamma).zip(v).zip(e) {
            *e = self.at(*sigma, *gamma).albedo(*v);
        }
        Ok(())
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// The memory that it takes, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let values = self.values.iter().map(|channel| size_of_val(&channel[..]));
        size_of::<Self>() + values.sum::<usize>() + size_of_val(&self.averages[..])
    }
}

/// The directional albedo at one σ and γ, read from a [`FamilyAlbedo`]; as small as some numbers.
///
/// Its methods are those of [`Albedo`](crate::albedo::Albedo), for which it stands in. `v` is a
/// unit vector in the tangent frame, n = +z; a view at or below the horizon, or with NaN in `v.z`,
/// is the grazing view.
#[derive(Clone, Copy, Debug)]
pub struct AlbedoAt<'a> {
    family: &'a FamilyAlbedo,
    /// Where σ and γ are among the nodes.
    place: Place,
    sigma: f32,
    view: View,
    mirror: bool,
}

impl AlbedoAt<'_> {
    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.family.masking
    }

    /// The directional albedo E(v) with F = 1, in [0, 1].
    #[inline]
    #[must_use]
    pub fn albedo(&self, v: impl Into<[f32; 3]>) -> f32 {
        1.0 - self.lost(v)
    }

    /// [`albedo`](Self::albedo) for each view, into `e`: the same numbers.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `e` is then untouched.
    pub fn albedo_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        e: &mut [f32],
    ) -> Result<(), BatchError> {
        // To combine the coefficients of all views takes as long as four single calls.
        if v.len() < f32x4::WIDTH {
            return of_each(v, e, |v| self.albedo(v));
        }
        same_lengths(&[("v", v.len()), ("e", e.len())])?;
        let row = self.row();
        let done = widest(Batch { albedo: *self, row: &row, v, e });
        let (v, e) = (&v[done..], &mut e[done..]);
        // What does not fill more lanes may fill four.
        let done = self.albedo_groups::<f32x4, V>(&row, v, e);
        of_each(&v[done..], &mut e[done..], |v| self.albedo(v))
    }

    /// E of all views but those too few to fill lanes; how many they are.
    #[inline(always)]
    fn albedo_groups<L: Lanes, V: Copy + Into<[f32; 3]>>(
        &self,
        row: &Row,
        v: &[V],
        e: &mut [f32],
    ) -> usize {
        let one = L::splat(1.0);
        for (v, e) in v.chunks_exact(L::WIDTH).zip(e.chunks_exact_mut(L::WIDTH)) {
            let cos = L::from_fn(|i| unit(vec3(v[i]).z));
            let (cells, [a, b, c, d]) = self.view.weights_in_lanes(cos);
            let cells = cells.to_array();
            let four = |i: usize| -> f32x4 {
                let four = row[cells[i] as usize..].first_chunk::<FOUR>();
                f32x4::from(*four.expect("in the row"))
            };
            let [w, x, y, z] = L::columns(four);
            let root = (w * a + y * c) + (x * b + z * d);
            let lost = root * root;
            let lost = lost.simd_lt(one).select(lost, one);
            e.copy_from_slice((one - lost).to_array().as_ref());
        }
        v.len() - v.len() % L::WIDTH
    }

    /// The coefficients of √(1 − E) along the view, as [`channel`](Self::channel) combines them.
    fn row(&self) -> Row {
        let mut row = [0.0; VIEWS + 1];
        if self.mirror {
            return row;
        }
        let [shape, sigma] = self.place.first;
        let from = &self.family.values[0][(sigma * SHAPES + shape) * VIEWS..];
        let [a, b, c] = self.weights_along(SHAPE);
        let [d, e, f] = self.weights_along(SIGMA);
        for (view, row) in row.iter_mut().enumerate() {
            let at = |i: usize, j: usize| from[(i * SHAPES + j) * VIEWS + view];
            let of = |i: usize| at(i, 0) * a + at(i, 1) * b + at(i, 2) * c;
            *row = of(0) * d + of(1) * e + of(2) * f;
        }
        row
    }

    /// The share of light lost, 1 − E(v).
    #[inline]
    #[must_use]
    pub fn lost(&self, v: impl Into<[f32; 3]>) -> f32 {
        self.lost_at(self.along(unit(vec3(v).z)))
    }

    /// Moments of the Fresnel weights at a view, each in [0, 1], with a total of at most 1.
    #[inline]
    #[must_use]
    pub fn moments(&self, v: impl Into<[f32; 3]>) -> Moments {
        let cos = unit(vec3(v).z);
        Moments::mirror(cos).plus(self.rest(cos))
    }

    /// The average albedo E_avg = 1/π ∫∫ E μ dμ dφ with F = 1.
    #[must_use]
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// The average share of light lost, 1 − E_avg, with all its digits.
    ///
    /// It is that of these lookups, so that a white furnace closes: E(v), and (1 − E(v)) times the
    /// integral of (1 − E)/(1 − E_avg), are 1 to 3e-3 for σ ≥ 1e-5, and to 1e-2 for σ ≥ 1e-8.
    #[must_use]
    pub fn lost_average(&self) -> f32 {
        0.0 - self.average()[0]
    }

    /// Cosine-weighted averages of the moments over the hemisphere of views: 1/π ∫∫ · μ dμ dφ.
    #[must_use]
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average())
    }

    /// Within about how much of the horizon light is lost, as a cosine.
    pub(crate) fn reach(&self) -> f32 {
        self.view.reach()
    }

    /// E − 1 in [−1, 0], and the excess of the other moments over E times a mirror's.
    #[inline(always)]
    fn rest(&self, cos: f32) -> [f32; 3] {
        if self.mirror {
            return [0.0; 3];
        }
        let along = self.along(cos);
        [0.0 - self.lost_at(along), self.channel(1, along), self.channel(2, along)]
    }

    /// The cell of a view, and the weights of its four coefficients.
    #[inline(always)]
    fn along(&self, cos: f32) -> (usize, f32x4) {
        self.view.weights(cos)
    }

    #[inline(always)]
    fn lost_at(&self, along: (usize, f32x4)) -> f32 {
        if self.mirror {
            return 0.0;
        }
        let root = self.channel(0, along);
        let lost = root * root;
        if lost < 1.0 { lost } else { 1.0 }
    }

    /// The square root of 1 − E, or the excess of another moment.
    #[inline(always)]
    fn channel(&self, channel: usize, (cell, along): (usize, f32x4)) -> f32 {
        let [shape, sigma] = self.place.first;
        let at = (sigma * SHAPES + shape) * VIEWS + cell;
        let from = &self.family.values[channel][at..];
        let part: &[f32; PART] = from.first_chunk().expect("in the volume");
        let four = |i: usize, j: usize| -> f32x4 {
            let four = part[(i * SHAPES + j) * VIEWS..].first_chunk::<FOUR>();
            f32x4::from(*four.expect("in the part"))
        };
        let [a, b, c] = self.weights_along(SHAPE);
        let of = |i: usize| four(i, 0) * a + four(i, 1) * b + four(i, 2) * c;
        let [d, e, f] = self.weights_along(SIGMA);
        let [a, b, c, d] = ((of(0) * d + of(1) * e + of(2) * f) * along).to_array();
        (a + c) + (b + d)
    }

    /// The weights of three coefficients along an axis.
    #[inline(always)]
    fn weights_along(&self, lane: usize) -> [f32; THREE] {
        self.place.weights.map(|weight| weight.to_array()[lane])
    }

    /// The averages, as the channels of tables.
    fn average(&self) -> [f32; 3] {
        if self.mirror {
            return [0.0; 3];
        }
        let shapes = self.weights_along(SHAPE);
        let (first, sigmas) = self.family.axes.average(self.sigma);
        let mut sum = f32x4::ZERO;
        for (i, a) in sigmas.into_iter().enumerate() {
            let first = (first + i) * SHAPES + self.place.first[SHAPE];
            for (node, b) in self.family.averages[first..first + THREE].iter().zip(shapes) {
                sum += f32x4::from(*node) * (a * b);
            }
        }
        let [log, bias, f82, _] = sum.to_array();
        [0.0 - unit(exp2(sum).to_array()[0]), bias, f82].map(|x| if log < LEAST { 0.0 } else { x })
    }
}

/// [`AlbedoAt::albedo_groups`].
struct Batch<'a, V> {
    albedo: AlbedoAt<'a>,
    row: &'a Row,
    v: &'a [V],
    e: &'a mut [f32],
}

impl<V: Copy + Into<[f32; 3]>> Work for Batch<'_, V> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        self.albedo.albedo_groups::<L, V>(self.row, self.v, self.e)
    }
}

/// The logarithm of a loss that counts as none.
const LEAST: f32 = -120.0;
