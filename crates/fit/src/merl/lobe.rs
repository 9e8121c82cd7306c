//! The lobes that are fitted, by what a sample needs of them: D and Λ.

use glam::DVec3;
use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_model::classic::{Abc, Isotropic, Marginal};
use microfacet_model::{MicrofacetDistribution, StudentT};
use microfacet_tables::axis::hermite::cubic_through_thirds;

/// Nodes of a table of masking from one value by quadrature to the next.
const COARSE: usize = 8;

/// A lobe that is fitted.
pub(super) enum Lobe {
    /// A member of the family.
    StudentT(StudentT),
    /// The normals of two GGX with one masking; of both Λ is the mix of two.
    Haze([StudentT; 2], f64),
    /// The distribution of Löw et al. 2012, of which Λ takes a quadrature.
    Abc(Abc),
}

pub(super) fn direction(theta: f64) -> DVec3 {
    let (sin, cos) = theta.sin_cos();
    DVec3::new(sin, 0.0, cos)
}

impl Lobe {
    pub(super) fn haze(core: f64, haze: f64, weight: f64) -> Self {
        let ggx = |sigma| StudentT::new(sigma, 2.0).expect("the search has no others");
        Self::Haze([core, haze].map(ggx), weight)
    }

    pub(super) fn abc(b: f64, c: f64) -> Self {
        Self::Abc(Abc::new(b, c).expect("the search has no others"))
    }

    /// Of a kind other than those of the family, by its parameters.
    pub(super) fn of(Named { kind, values }: &Named) -> Self {
        match (kind, &values[..]) {
            (DistributionKind::Haze, &[core, haze, weight]) => Self::haze(core, haze, weight),
            (DistributionKind::Abc, &[b, c]) => Self::abc(b, c),
            _ => unreachable!("the kinds that are fitted"),
        }
    }

    /// D at an angle from the normal, 1/sr.
    pub(super) fn d(&self, theta: f64) -> f64 {
        let m = direction(theta);
        match self {
            Self::StudentT(lobe) => lobe.d(m),
            Self::Haze([core, haze], w) => (1.0 - w) * core.d(m) + w * haze.d(m),
            Self::Abc(abc) => abc.d(theta),
        }
    }

    /// Λ at `steps` + 1 angles, which rise from 0.
    pub(super) fn lambdas(&self, angle: impl Fn(usize) -> f64, steps: usize) -> Vec<f64> {
        let of = |lobe: &StudentT| -> Vec<f64> {
            (0..=steps).map(|i| lobe.lambda(direction(angle(i)))).collect()
        };
        match self {
            Self::StudentT(lobe) => of(lobe),
            Self::Haze(lobes, w) => {
                let [core, haze] = lobes.each_ref().map(of);
                core.iter().zip(haze).map(|(core, haze)| (1.0 - w) * core + w * haze).collect()
            }
            Self::Abc(abc) => {
                let marginal = Marginal::new(abc);
                // Over this coordinate Λ is smooth, and a cubic through four nodes is enough.
                let coarse: Vec<f64> = (0..=steps / COARSE)
                    .map(|i| {
                        // The slope of the direction in units of σ. At the normal nothing is
                        // masked.
                        let x = 1.0 / (angle(COARSE * i).tan() * marginal.sigma());
                        if x.is_finite() { marginal.beyond(x).excess / x } else { 0.0 }
                    })
                    .collect();
                (0..=steps).map(|i| cubic(&coarse, i as f64 / COARSE as f64)).collect()
            }
        }
    }
}

/// The cubic through the four values about a place, a place being the number of a value.
fn cubic(values: &[f64], place: f64) -> f64 {
    let first = (place as usize).saturating_sub(1).min(values.len() - 4);
    let [a, b, c, d] = cubic_through_thirds(core::array::from_fn(|i| values[first + i]));
    let w = (place - first as f64) / 3.0;
    a + w * (b + w * (c + w * d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_met_at_and_between_its_values() {
        let of = |x: f64| 1.0 - 2.0 * x + 0.5 * x * x - 0.25 * x * x * x;
        let values: Vec<f64> = (0..6).map(|i| of(f64::from(i))).collect();
        for place in [0.0, 0.3, 1.0, 2.5, 4.9, 5.0] {
            assert!((cubic(&values, place) - of(place)).abs() < 1e-13, "{place}");
        }
    }
}
