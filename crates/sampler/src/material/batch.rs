//! Functions over slices.

use super::distribution::MicrofacetDistribution;
use crate::error::{BatchError, same_lengths};

/// Functions over whole slices of views, whose vectors are of any type that converts to and from
/// three `f32`. Provided one by one; Student-t lobes compute eight at once where the processor has
/// AVX2, and elsewhere four, with the same bits: normals in less than half of the time
/// (`cargo run --profile dist -p microfacet-bench`).
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::Tables;
/// use microfacet_sampler::lobe::Batch;
///
/// let lobe = Tables::embedded().student_t(0.3, 4.0)?;
/// let (v, u) = ([[0.6, 0.0, 0.8]; 64], [[0.3, 0.7]; 64]);
/// let mut m = [[0.0; 3]; 64];
/// lobe.sample_batch(&v, &u, &mut m)?;
/// assert_eq!(m[63], m[0]);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub trait Batch: MicrofacetDistribution {
    /// [`sample_visible_normal`](MicrofacetDistribution::sample_visible_normal) for each view and
    /// pair of numbers, into `m`: the same normals, to 2 ulp, or to more where
    /// roughnesses differ by many orders of magnitude and rounding has hidden the normal.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `m` is then untouched.
    fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
        for ((v, u), m) in v.iter().zip(u).zip(m) {
            *m = self.sample_visible_normal(*v, *u).into();
        }
        Ok(())
    }

    /// [`g1`](MicrofacetDistribution::g1) for each view, into `g1`: the same numbers.
    ///
    /// # Errors
    /// [`BatchError`] if the slices are not of one length; `g1` is then untouched.
    fn g1_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        g1: &mut [f32],
    ) -> Result<(), BatchError> {
        same_lengths(&[("v", v.len()), ("g1", g1.len())])?;
        for (v, g1) in v.iter().zip(g1) {
            *g1 = self.g1(*v);
        }
        Ok(())
    }
}
