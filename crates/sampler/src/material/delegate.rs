//! The traits of lobes for types that hold the lobe in another form.

/// Implements [`MicrofacetDistribution`](super::MicrofacetDistribution),
/// [`Reflecting`](super::Reflecting) and [`Batch`](super::Batch) for a type whose function
/// `surface` gives a shape at a roughness.
macro_rules! lobe_of_surface {
    ($lobe:ty) => {
        impl MicrofacetDistribution for $lobe {
            /// D(m), with a relative error of up to 3e-7 (2 + γ) for γ ≤ 16. For larger γ, where
            /// the cosine times σ is below 1e-19, and for lobes of a family, it is a few ulp times
            /// one plus its exponent (about 2e-6 times 1 + |ln D σxσy|).
            ///
            /// For γ < 2 D grows without limit towards the horizon and overflows to `f32::MAX`, not
            /// to ∞.
            #[inline]
            fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
                self.surface().d(vec3(m))
            }

            #[inline(always)]
            fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
                self.surface().g1_of_one(vec3(v))
            }

            /// A normal visible from `v`, by the inverse CDFs of two slopes at `u[0]` and `u[1]`.
            ///
            /// Where the whole distribution is tabulated (γ ≥ 1.8 in the default set), the tilt
            /// towards the viewer rises with `u[0]` and the tilt across with `u[1]`. For smaller γ,
            /// `u[0]` first chooses between the tabulated part and the closed-form heavy part, and
            /// the tilt rises within each.
            #[inline(always)]
            fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
                self.surface().sample(vec3(v), u).to_array()
            }

            #[inline]
            fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
                self.surface().visible_normal_pdf(vec3(v), vec3(m))
            }

            #[inline]
            fn reflection_weight(
                &self,
                v: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> f32 {
                self.surface().reflection_weight(vec3(v), vec3(l), masking)
            }

            #[inline(always)]
            fn facet(
                &self,
                v: impl Into<[f32; 3]>,
                m: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> Facet {
                self.surface().facet(vec3(v), vec3(m), vec3(l), masking)
            }

            #[inline(always)]
            fn is_effectively_smooth(&self) -> bool {
                self.surface().is_smooth()
            }
        }

        impl Reflecting for $lobe {
            #[inline(always)]
            fn sample_reflecting_normal(
                &self,
                v: impl Into<[f32; 3]>,
                u: [f32; 2],
            ) -> ([f32; 3], f32) {
                (self.surface().sample_along(vec3(v), u).to_array(), 1.0)
            }
        }

        impl Batch for $lobe {
            fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
                &self,
                v: &[V],
                u: &[[f32; 2]],
                m: &mut [M],
            ) -> Result<(), BatchError> {
                same_lengths(&[("v", v.len()), ("u", u.len()), ("m", m.len())])?;
                self.surface().sample_all(v, u, m);
                Ok(())
            }

            fn g1_batch<V: Copy + Into<[f32; 3]>>(
                &self,
                v: &[V],
                g1: &mut [f32],
            ) -> Result<(), BatchError> {
                same_lengths(&[("v", v.len()), ("g1", g1.len())])?;
                self.surface().g1_all(v, g1);
                Ok(())
            }
        }
    };
}

/// Implements the traits of lobes for a type that owns what another, of its function `by_ref`,
/// borrows.
macro_rules! lobe_by_reference {
    ($lobe:ty) => {
        impl MicrofacetDistribution for $lobe {
            #[inline(always)]
            fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
                self.by_ref().d(m)
            }

            #[inline(always)]
            fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
                self.by_ref().g1(v)
            }

            #[inline(always)]
            fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
                self.by_ref().sample_visible_normal(v, u)
            }

            #[inline(always)]
            fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
                self.by_ref().visible_normal_pdf(v, m)
            }

            #[inline(always)]
            fn reflection_weight(
                &self,
                v: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> f32 {
                self.by_ref().reflection_weight(v, l, masking)
            }

            #[inline(always)]
            fn facet(
                &self,
                v: impl Into<[f32; 3]>,
                m: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> Facet {
                self.by_ref().facet(v, m, l, masking)
            }

            fn is_effectively_smooth(&self) -> bool {
                self.by_ref().is_effectively_smooth()
            }
        }

        impl Reflecting for $lobe {
            #[inline(always)]
            fn sample_reflecting_normal(
                &self,
                v: impl Into<[f32; 3]>,
                u: [f32; 2],
            ) -> ([f32; 3], f32) {
                self.by_ref().sample_reflecting_normal(v, u)
            }

            #[inline(always)]
            fn reflecting_share(&self, v: impl Into<[f32; 3]>) -> f32 {
                self.by_ref().reflecting_share(v)
            }
        }

        impl Tabulated for $lobe {
            fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
                self.by_ref().table_pdf(v, m)
            }

            fn key(&self) -> LobeKey {
                self.by_ref().key()
            }

            #[inline]
            fn has_pole(&self) -> bool {
                self.by_ref().has_pole()
            }

            fn bytes(&self) -> usize {
                self.by_ref().bytes()
            }
        }

        impl Batch for $lobe {
            fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
                &self,
                v: &[V],
                u: &[[f32; 2]],
                m: &mut [M],
            ) -> Result<(), BatchError> {
                self.by_ref().sample_batch(v, u, m)
            }

            fn g1_batch<V: Copy + Into<[f32; 3]>>(
                &self,
                v: &[V],
                g1: &mut [f32],
            ) -> Result<(), BatchError> {
                self.by_ref().g1_batch(v, g1)
            }
        }
    };
}

pub(super) use {lobe_by_reference, lobe_of_surface};
