//! The general tables read at any σ and γ, nothing bound: the lobe of a hit where textures give
//! both.
//!
//! A bound lobe collapses the γ axis of three tables, once for all its lookups. Here every lookup
//! does it for the nodes that it reads: the same nodes with the same weights, so what the tables'
//! certificates state holds. What binding does to whole rows of nodes afterwards (they ascend, and
//! so do the cubics between them) is done to the rows of each node of γ beforehand, and to the two
//! nodes of a lookup.

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_core::Roughness;
use microfacet_lanes::{Lanes, MOST, Work, f32x4, widest};
use microfacet_tables::Table;

use super::batch::Batch;
use super::coverage;
use super::delegate::{forward, surface, unbounded};
use super::distribution::{Facet, MicrofacetDistribution};
use super::family_part::{AtShape, Part, PerLane};
use super::key::{LobeKey, has_pole};
use super::lanes::many::sample_lanes;
use super::pseudo::PseudoVisible;
use super::reflecting::Reflecting;
use super::roughness::clamped;
use super::surface::Surface;
use super::tabulated::Tabulated;
use crate::error::{BatchError, MaterialError, same_lengths};
use crate::vector::vec3;

/// Lobes of every σ and γ that a set covers, read from its tables without binding: for materials
/// whose roughness and tail are textures.
///
/// Made once by [`Tables::family`](crate::Tables::family), in some milliseconds and a megabyte;
/// [`at`](Self::at) is then the lobe of a hit.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{MicrofacetDistribution, Tables};
///
/// let family = Tables::embedded().family()?; // once
/// for (sigma, gamma) in [(0.1, 1.7), (0.2, 2.5), (0.3, f32::INFINITY)] {
///     let lobe = family.at(sigma, gamma); // at each hit
///     let v = [0.6, 0.0, 0.8];
///     let m = lobe.sample_visible_normal(v, [0.3, 0.7]);
/// #   assert!(m[2] > 0.0 && lobe.g1(v) <= 1.0);
/// }
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Family {
    /// By falling γ: that of whole distributions, then that of peeled ones; one may be missing.
    pub(super) parts: Vec<Part>,
    /// Smaller γ are those of the last part.
    seam: f32,
}

/// The lobe of a [`Family`] at one σ and γ: that of a hit.
///
/// It is small and `Copy`, and no memory is allocated for it. Normals differ from those of the
/// [`StudentT`](crate::StudentT) of the same σ and γ by 1e-5 of the CDF, and G1 by 2e-6, at most;
/// D is the same closed form. There is no density of the tables themselves:
/// [`table_pdf`](Tabulated::table_pdf) is the analytic one.
#[derive(Clone, Copy, Debug)]
pub struct FamilyLobe<'a> {
    surface: Surface<AtShape<'a>>,
}

impl Family {
    /// From the tables of each kind with the widest range of shapes.
    pub(crate) fn from_tables(tables: &[Table]) -> Result<Self, MaterialError> {
        let parts: Vec<Part> =
            coverage::LOBE[1].iter().filter_map(|&kind| Part::new(tables, kind)).collect();
        let Some(last) = parts.last() else {
            return Err(MaterialError::NoRange);
        };
        let seam = if parts.len() > 1 { parts[0].gammas[0] } else { last.gammas[1] } as f32;
        Ok(Self { seam, parts })
    }

    /// The lobe of roughness σ, one number or a pair for x and y, and shape γ.
    ///
    /// σ is clamped to [1e-8, 1e6] and γ to [what the tables hold](Self::gammas), in a gap between
    /// two ranges to the lower one; NaN is taken to the lower end. What is very smooth is
    /// [a mirror](MicrofacetDistribution::is_effectively_smooth).
    #[inline(always)]
    #[must_use]
    pub fn at(&self, sigma: impl Into<Roughness>, gamma: f32) -> FamilyLobe<'_> {
        let part = self.part(gamma);
        let gamma = part.clamped(gamma);
        let surface = Surface::new(AtShape::new(part, gamma), clamped(sigma.into()));
        FamilyLobe { surface }
    }

    /// The part of a γ; NaN, too, is of the last.
    #[inline(always)]
    fn part(&self, gamma: f32) -> &Part {
        let small = usize::from(!(gamma >= self.seam) && self.parts.len() > 1);
        &self.parts[small]
    }

    /// The shapes γ that are read from tables, as ranges [smallest, largest], of falling γ: in the
    /// default set [1.8, ∞] and [1.501, 1.8].
    pub fn gammas(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.parts.iter().map(|part| part.gammas)
    }

    /// A visible normal for each hit: of σx and σy, γ, a view and a pair of numbers, into `m`:
    /// those of [`at`](Self::at), to 2 ulp, in lanes.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `m` is then untouched.
    pub fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        sigma: &[[f32; 2]],
        gamma: &[f32],
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        same_lengths(&[
            ("sigma", sigma.len()),
            ("gamma", gamma.len()),
            ("v", v.len()),
            ("u", u.len()),
            ("m", m.len()),
        ])?;
        let done = widest(Normals { hits: self.hits(sigma, gamma, v, 0), u, m });
        let (rest, u, m) = (self.hits(sigma, gamma, v, done), &u[done..], &mut m[done..]);
        // What does not fill more lanes may fill four.
        let done = rest.sample_groups::<f32x4, M>(u, m);
        for (i, (u, m)) in u.iter().zip(m).enumerate().skip(done) {
            *m = self.at(rest.sigma[i], rest.gamma[i]).sample_visible_normal(rest.v[i], *u).into();
        }
        Ok(())
    }

    /// G1 for each hit: of σx and σy, γ and a view, into `g1`: that of [`at`](Self::at), one by one,
    /// since each has tables of its own to combine, which lanes do no faster.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `g1` is then untouched.
    pub fn g1_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        sigma: &[[f32; 2]],
        gamma: &[f32],
        v: &[V],
        g1: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[
            ("sigma", sigma.len()),
            ("gamma", gamma.len()),
            ("v", v.len()),
            ("g1", g1.len()),
        ])?;
        for (((sigma, gamma), v), g1) in sigma.iter().zip(gamma).zip(v).zip(g1) {
            *g1 = self.at(*sigma, *gamma).g1(*v);
        }
        Ok(())
    }

    /// Those from one on.
    fn hits<'a, V>(
        &'a self,
        sigma: &'a [[f32; 2]],
        gamma: &'a [f32],
        v: &'a [V],
        from: usize,
    ) -> Hits<'a, V> {
        Hits { family: self, sigma: &sigma[from..], gamma: &gamma[from..], v: &v[from..] }
    }

    /// Bytes of table.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.parts.iter().map(Part::bytes).sum()
    }
}

/// Views, each with the σ and γ of its hit; all slices are of one length.
#[derive(Clone, Copy)]
struct Hits<'a, V> {
    family: &'a Family,
    sigma: &'a [[f32; 2]],
    gamma: &'a [f32],
    v: &'a [V],
}

impl<'a, V: Copy + Into<[f32; 3]>> Hits<'a, V> {
    /// Normals of all hits but those too few to fill lanes; how many they are.
    #[inline(always)]
    fn sample_groups<L: Lanes, M: From<[f32; 3]>>(&self, u: &[[f32; 2]], m: &mut [M]) -> usize {
        let whole = self.v.len() - self.v.len() % L::WIDTH;
        for from in (0..whole).step_by(L::WIDTH) {
            let group = from..from + L::WIDTH;
            let (v, u, m) = (&self.v[group.clone()], &u[group.clone()], &mut m[group.clone()]);
            let sigma = self.sigma::<L>(from);
            for part in &self.family.parts {
                let Some(shapes) = self.shapes::<L>(part, from) else { continue };
                let [x, y, z] = sample_lanes(PerLane(&shapes[..L::WIDTH]), sigma, v, u);
                let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
                for (i, m) in m.iter_mut().enumerate() {
                    if core::ptr::eq(self.family.part(self.gamma[from + i]), part) {
                        *m = M::from([x[i], y[i], z[i]]);
                    }
                }
            }
        }
        whole
    }

    /// σx and σy of a group.
    #[inline(always)]
    fn sigma<L: Lanes>(&self, from: usize) -> [L; 2] {
        let sigma = |i: usize| clamped(self.sigma[from + i].into());
        [L::from_fn(|i| sigma(i)[0]), L::from_fn(|i| sigma(i)[1])]
    }

    /// The shapes of a group in a part, each clamped to it; `None` where all are of another part.
    #[inline(always)]
    fn shapes<L: Lanes>(&self, part: &'a Part, from: usize) -> Option<[AtShape<'a>; MOST]> {
        let gamma = &self.gamma[from..from + L::WIDTH];
        if !gamma.iter().any(|&gamma| core::ptr::eq(self.family.part(gamma), part)) {
            return None;
        }
        let of = |i: usize| AtShape::new(part, part.clamped(gamma[i]));
        let mut shapes = [of(0); MOST];
        for (i, shape) in shapes[..L::WIDTH].iter_mut().enumerate().skip(1) {
            *shape = of(i);
        }
        Some(shapes)
    }
}

/// [`Hits::sample_groups`].
struct Normals<'a, V, M> {
    hits: Hits<'a, V>,
    u: &'a [[f32; 2]],
    m: &'a mut [M],
}

impl<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>> Work for Normals<'_, V, M> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        self.hits.sample_groups::<L, M>(self.u, self.m)
    }
}

impl<'a> FamilyLobe<'a> {
    /// σx and σy.
    #[must_use]
    pub fn sigma(&self) -> [f32; 2] {
        self.surface.scales.sigma
    }

    /// The shape γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.surface.shape.gamma()
    }

    /// This lobe for reflection, without most of the normals that are too steep to reflect the view
    /// above the horizon. It is the lobe to make a conductor or a plastic of, where γ may be below
    /// 1.8 (in the default set): there it lowers the variance of reflection, to 0.7 of its value
    /// next to 1.8, a third at 1.6 and a tenth at 1.51, and nothing is prepared. For larger γ it
    /// draws all visible normals.
    #[inline(always)]
    #[must_use]
    pub fn bounded(self) -> BoundedFamilyLobe<'a> {
        BoundedFamilyLobe { lobe: self }
    }

    #[inline(always)]
    fn surface(&self) -> Surface<AtShape<'a>> {
        self.surface
    }
}

forward!(#[inline(always)] FamilyLobe<'_>, surface: MicrofacetDistribution, Reflecting, PseudoVisible, Batch);

impl Tabulated for FamilyLobe<'_> {
    fn key(&self) -> LobeKey {
        LobeKey::of_family(self.sigma(), self.gamma())
    }

    #[inline]
    fn has_pole(&self) -> bool {
        has_pole(self.gamma())
    }

    fn bytes(&self) -> usize {
        self.surface.shape.bytes()
    }
}

/// The lobe of a hit for reflection, which leaves out steep normals of a heavy tail: most of those
/// that lose light below the horizon.
///
/// Evaluation and visible normals are those of the lobe; what it draws for reflection is divided by
/// a share ([`Reflecting`]), and densities are exact. Only the closed-form part of γ < 1.8 is
/// restricted, at its end towards the viewer, since that takes no table of limits; for one γ
/// [`StudentT::bounded`](crate::StudentT::bounded) restricts more. Made by [`FamilyLobe::bounded`].
#[derive(Clone, Copy, Debug)]
pub struct BoundedFamilyLobe<'a> {
    lobe: FamilyLobe<'a>,
}

impl<'a> BoundedFamilyLobe<'a> {
    /// The lobe, for evaluation.
    #[must_use]
    pub fn lobe(&self) -> FamilyLobe<'a> {
        self.lobe
    }
}

// As the lobe, except for the normals that are drawn for reflection.
forward!(#[inline(always)] BoundedFamilyLobe<'_>, unbounded: MicrofacetDistribution, Tabulated, Batch);

impl Reflecting for BoundedFamilyLobe<'_> {
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        let (m, share) = self.lobe.surface.sample_upward(vec3(v), u);
        (m.to_array(), share)
    }

    #[inline(always)]
    fn reflecting_share(&self, v: impl Into<[f32; 3]>) -> f32 {
        self.lobe.surface.upward_share(vec3(v))
    }
}

#[cfg(test)]
mod tests {
    use crate::Tables;
    use crate::material::surface::Shape as _;

    /// Near γ = 3/2 the share of the heavy part is no polynomial of γ between the nodes.
    #[test]
    fn shares_of_the_heavy_part_are_those_of_bound_lobes() {
        let tables = Tables::embedded();
        let family = tables.family().unwrap();
        let mut worst = (0.0, 0.0);
        for i in 0..300 {
            // Evenly in the logarithm of 2γ − 3.
            let gamma = 1.5 + 0.001 * 299_f32.powf(i as f32 / 299.0);
            let lobe = family.at(1.0, gamma);
            let bound = tables.student_t(1.0, lobe.gamma()).unwrap();
            for j in 0..=2000 {
                let at = bound.slices.rows as f32 * (j as f32 / 2000.0);
                let off = lobe.surface.shape.share(at) - bound.slices.heavy.share(at);
                worst = if off.abs() > worst.0 { (off.abs(), gamma) } else { worst };
            }
        }
        assert!(worst.0 < 1e-5, "{worst:?}");
    }
}
