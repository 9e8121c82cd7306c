//! The smooth surface, σ = 0: its only normal is n.

use super::batch::Batch;
use super::distribution::MicrofacetDistribution;
use super::key::LobeKey;
use super::reflecting::Reflecting;
use super::tabulated::Tabulated;

/// A smooth surface, the limit σ → 0 of every lobe: all microfacets face along n, and a BSDF of it
/// has only delta events.
///
/// Nothing is masked: G1 is 1 above the horizon. Densities are 0 everywhere, since that of a single
/// normal is not finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Smooth;

impl MicrofacetDistribution for Smooth {
    fn d(&self, _m: impl Into<[f32; 3]>) -> f32 {
        0.0
    }

    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        if v.into()[2] > 0.0 { 1.0 } else { 0.0 }
    }

    /// n, whatever the view.
    fn sample_visible_normal(&self, _v: impl Into<[f32; 3]>, _u: [f32; 2]) -> [f32; 3] {
        [0.0, 0.0, 1.0]
    }

    fn visible_normal_pdf(&self, _v: impl Into<[f32; 3]>, _m: impl Into<[f32; 3]>) -> f32 {
        0.0
    }

    fn is_effectively_smooth(&self) -> bool {
        true
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Reflecting for Smooth {}

impl Tabulated for Smooth {
    fn key(&self) -> LobeKey {
        LobeKey::of_family([0.0; 2], 2.0)
    }
}

impl Batch for Smooth {}
