//! The traits of lobes for types that hold a lobe in another form.

/// Implements traits for a type by those of the lobe that it holds.
///
/// `$to!(self, lobe => call)` is a macro of the type, which binds `lobe` to what is held and makes
/// the call.
macro_rules! forward {
    (#[$inline:meta] $type:ty, $to:ident: $($trait:ident),+) => {$(
        forward!(@$trait #[$inline] $type, $to);
    )+};
    (@MicrofacetDistribution #[$inline:meta] $type:ty, $to:ident) => {
        impl MicrofacetDistribution for $type {
            #[$inline]
            fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
                $to!(self, lobe => lobe.d(m))
            }

            #[$inline]
            fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
                $to!(self, lobe => lobe.g1(v))
            }

            #[$inline]
            fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
                $to!(self, lobe => lobe.sample_visible_normal(v, u))
            }

            #[$inline]
            fn visible_normal_pdf(
                &self,
                v: impl Into<[f32; 3]>,
                m: impl Into<[f32; 3]>,
            ) -> f32 {
                $to!(self, lobe => lobe.visible_normal_pdf(v, m))
            }

            #[$inline]
            fn reflection_weight(
                &self,
                v: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> f32 {
                $to!(self, lobe => lobe.reflection_weight(v, l, masking))
            }

            #[$inline]
            fn facet(
                &self,
                v: impl Into<[f32; 3]>,
                m: impl Into<[f32; 3]>,
                l: impl Into<[f32; 3]>,
                masking: Masking,
            ) -> Facet {
                $to!(self, lobe => lobe.facet(v, m, l, masking))
            }

            #[$inline]
            fn is_effectively_smooth(&self) -> bool {
                $to!(self, lobe => lobe.is_effectively_smooth())
            }

            #[$inline]
            fn is_symmetric(&self) -> bool {
                $to!(self, lobe => lobe.is_symmetric())
            }
        }
    };
    (@Reflecting #[$inline:meta] $type:ty, $to:ident) => {
        impl Reflecting for $type {
            #[$inline]
            fn sample_reflecting_normal(
                &self,
                v: impl Into<[f32; 3]>,
                u: [f32; 2],
            ) -> ([f32; 3], f32) {
                $to!(self, lobe => lobe.sample_reflecting_normal(v, u))
            }

            #[$inline]
            fn reflecting_share(&self, v: impl Into<[f32; 3]>) -> f32 {
                $to!(self, lobe => lobe.reflecting_share(v))
            }
        }
    };
    (@PseudoVisible #[$inline:meta] $type:ty, $to:ident) => {
        impl PseudoVisible for $type {
            #[$inline]
            fn sample_pseudo_visible_normal(
                &self,
                v: impl Into<[f32; 3]>,
                u: [f32; 2],
            ) -> [f32; 3] {
                $to!(self, lobe => lobe.sample_pseudo_visible_normal(v, u))
            }
        }
    };
    (@Tabulated #[$inline:meta] $type:ty, $to:ident) => {
        impl Tabulated for $type {
            fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
                $to!(self, lobe => lobe.table_pdf(v, m))
            }

            fn sample_with_table_pdf(
                &self,
                v: impl Into<[f32; 3]>,
                u: [f32; 2],
            ) -> ([f32; 3], f32) {
                $to!(self, lobe => lobe.sample_with_table_pdf(v, u))
            }

            fn key(&self) -> LobeKey {
                $to!(self, lobe => lobe.key())
            }

            #[$inline]
            fn has_pole(&self) -> bool {
                $to!(self, lobe => lobe.has_pole())
            }

            fn bytes(&self) -> usize {
                $to!(self, lobe => lobe.bytes())
            }
        }
    };
    (@Batch #[$inline:meta] $type:ty, $to:ident) => {
        impl Batch for $type {
            fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
                &self,
                v: &[V],
                u: &[[f32; 2]],
                m: &mut [M],
            ) -> Result<(), BatchError> {
                $to!(self, lobe => lobe.sample_batch(v, u, m))
            }

            fn g1_batch<V: Copy + Into<[f32; 3]>>(
                &self,
                v: &[V],
                g1: &mut [f32],
            ) -> Result<(), BatchError> {
                $to!(self, lobe => lobe.g1_batch(v, g1))
            }
        }
    };
}

/// To the lobe that borrows what a lobe owns.
macro_rules! by_ref {
    ($lobe:ident, $one:ident => $call:expr) => {{
        let $one = $lobe.by_ref();
        $call
    }};
}

/// To a shape at a roughness.
macro_rules! surface {
    ($lobe:ident, $one:ident => $call:expr) => {{
        let $one = $lobe.surface();
        $call
    }};
}

/// To the lobe whose normals a bounded one leaves out.
macro_rules! unbounded {
    ($bounded:ident, $one:ident => $call:expr) => {{
        let $one = $bounded.lobe;
        $call
    }};
}

pub(super) use {by_ref, forward, surface, unbounded};
