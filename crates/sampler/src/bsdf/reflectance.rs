//! The reflectance of a conductor's facets.

use microfacet_core::fresnel::conductor;
use microfacet_core::math::unit;
use microfacet_core::schlick::{f82_dip, f82_weight, schlick};

use super::metal::Metal;
use crate::albedo::{f82_tint_average, fresnel_average, schlick_average};
use crate::bind_error::BindError;

/// The reflectance of a conductor's facets, in N channels.
///
/// Make it once for a material: the averages over the hemisphere, which a compensation needs at
/// every hit, are computed here. They take a quadrature of some microseconds for Fresnel's
/// equations, and for a tint that darkens more than F0; else they have a closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorFresnel<const N: usize = 3> {
    form: Form<N>,
    average: [f32; N],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Form<const N: usize> {
    Mirror,
    Schlick {
        f0: [f32; N],
    },
    /// F0, and the depth of the tint's dip.
    Tinted {
        f0: [f32; N],
        dip: [f32; N],
    },
    Exact {
        eta: [f32; N],
        k: [f32; N],
    },
}

/// Ranges of η and k: outside, squares would leave single precision.
const ETA: [f64; 2] = [1e-6, 1e6];
const K: [f64; 2] = [0.0, 1e6];

impl<const N: usize> ConductorFresnel<N> {
    /// F = 1, as of a perfect mirror.
    #[must_use]
    pub const fn mirror() -> Self {
        Self { form: Form::Mirror, average: [1.0; N] }
    }

    /// Schlick's approximation F0 + (1 − F0)(1 − μ)⁵ (1994,
    /// <https://doi.org/10.1111/1467-8659.1330233>).
    ///
    /// # Errors
    /// [`BindError::Reflectance`] unless every F0, at normal incidence, lies in [0, 1].
    pub fn schlick(f0: [f32; N]) -> Result<Self, BindError> {
        reflectances("f0", &f0)?;
        Ok(Self { form: Form::Schlick { f0 }, average: f0.map(|f0| schlick_average(f0, 1.0)) })
    }

    /// OpenPBR's metal: Schlick's with a tint of the reflectance at μ = 1/7, about 82° (Kutz, Hašan
    /// & Edmondson 2021, *Novel aspects of the Adobe Standard Material*, eq. 2–5); 0 where that
    /// formula is negative, as for a small F0 and tint.
    ///
    /// # Errors
    /// [`BindError::Reflectance`] unless every F0 and tint lies in [0, 1].
    pub fn f82_tint(f0: [f32; N], tint: [f32; N]) -> Result<Self, BindError> {
        reflectances("f0", &f0)?;
        reflectances("tint", &tint)?;
        let dip = core::array::from_fn(|i| f82_dip(f0[i], tint[i]));
        let mut made = Self { form: Form::Tinted { f0, dip }, average: [0.0; N] };
        made.average = core::array::from_fn(|i| {
            // The dip is largest at its peak; where F0 exceeds that, the reflectance is not cut
            // off at 0.
            let closed = f0[i] >= dip[i];
            if closed { f82_tint_average(f0[i], tint[i]) } else { made.integrated(i) }
        });
        Ok(made)
    }

    /// Fresnel's equations for a complex index η + ik relative to the medium outside.
    ///
    /// # Errors
    /// [`BindError::Index`] unless every η lies in [1e-6, 1e6] and every k in [0, 1e6].
    pub fn exact(eta: [f64; N], k: [f64; N]) -> Result<Self, BindError> {
        indices("eta", &eta, ETA)?;
        indices("k", &k, K)?;
        let form = Form::Exact { eta: eta.map(|x| x as f32), k: k.map(|x| x as f32) };
        let mut made = Self { form, average: [0.0; N] };
        made.average = core::array::from_fn(|i| made.integrated(i));
        Ok(made)
    }

    /// The reflectance of light at a cosine v·m, clamped to [0, 1]; each in [0, 1].
    #[inline(always)]
    #[must_use]
    pub fn at(&self, cos_theta: f32) -> [f32; N] {
        let cos = unit(cos_theta);
        match &self.form {
            Form::Mirror => [1.0; N],
            Form::Schlick { f0 } => f0.map(|f0| schlick(f0, 1.0, cos)),
            Form::Tinted { f0, dip } => {
                let weight = f82_weight(cos);
                // Near its peak the dip of a small F0 and tint exceeds Schlick's reflectance.
                let at = |i: usize| (schlick::<f32>(f0[i], 1.0, cos) - dip[i] * weight).max(0.0);
                core::array::from_fn(at)
            }
            Form::Exact { eta, k } => exact(eta, k, cos),
        }
    }

    /// Cosine-weighted averages over the hemisphere, 2∫₀¹ F(μ) μ dμ.
    #[must_use]
    pub fn average(&self) -> [f32; N] {
        self.average
    }

    /// The average of a channel by quadrature.
    fn integrated(&self, channel: usize) -> f32 {
        fresnel_average(|cos| self.at(cos)[channel])
    }
}

/// Out of line, so that the short forms are inlined.
#[inline(never)]
fn exact<const N: usize>(eta: &[f32; N], k: &[f32; N], cos: f32) -> [f32; N] {
    core::array::from_fn(|i| conductor(eta[i], k[i], cos))
}

/// A metal in vacuum or air.
impl From<Metal> for ConductorFresnel {
    fn from(metal: Metal) -> Self {
        Self::exact(metal.eta(), metal.k()).expect("metals are tested")
    }
}

pub(super) fn reflectances(name: &'static str, all: &[f32]) -> Result<(), BindError> {
    match all.iter().find(|x| !(0.0..=1.0).contains(*x)) {
        Some(&value) => Err(BindError::Reflectance { name, value }),
        None => Ok(()),
    }
}

pub(super) fn indices(name: &'static str, all: &[f64], range: [f64; 2]) -> Result<(), BindError> {
    let [low, high] = range;
    match all.iter().find(|x| !(low..=high).contains(*x)) {
        Some(&value) => Err(BindError::Index { name, value, range }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn reflectances_have_their_values_at_normal_incidence_and_at_grazing() {
        let f0 = [0.0, 0.3, 1.0];
        let all = [
            ConductorFresnel::schlick(f0).unwrap(),
            ConductorFresnel::f82_tint(f0, [0.0, 0.4, 1.0]).unwrap(),
        ];
        for fresnel in all {
            assert_eq!((fresnel.at(1.0), fresnel.at(0.0)), (f0, [1.0; 3]));
            // A cosine above 1 by rounding, and NaN.
            assert_eq!((fresnel.at(1.000_000_1), fresnel.at(f32::NAN)), (f0, [1.0; 3]));
        }
        let [_, metal] = all;
        assert!(metal.at(1.0 / 7.0)[0].abs() < 1e-6);
        let exact = ConductorFresnel::exact([1.5], [0.0]).unwrap();
        assert!((exact.at(1.0)[0] - 0.04).abs() < 1e-7);
        assert_eq!(ConductorFresnel::<2>::mirror().at(0.3), [1.0; 2]);
    }

    #[test]
    fn averages_are_those_of_the_reflectance() {
        let all: [ConductorFresnel; 5] = [
            ConductorFresnel::mirror(),
            ConductorFresnel::schlick([0.0, 0.5, 1.0]).unwrap(),
            ConductorFresnel::f82_tint([0.2, 0.5, 1.0], [0.0, 0.5, 0.9]).unwrap(),
            // The first is cut off at 0, the second is about to be.
            ConductorFresnel::f82_tint([0.0, 0.3, 0.31], [0.0, 0.5, 0.51]).unwrap(),
            Metal::Gold.into(),
        ];
        for fresnel in all {
            let n = 20_000;
            for channel in 0..3 {
                let at = |i: usize| (i as f64 + 0.5) / f64::from(n);
                let sum: f64 = (0..n as usize)
                    .map(|i| 2.0 * at(i) * f64::from(fresnel.at(at(i) as f32)[channel]))
                    .sum();
                let (got, want) = (f64::from(fresnel.average()[channel]), sum / f64::from(n));
                assert!((got - want).abs() < 2e-5, "{fresnel:?}: {got} for {want}");
            }
        }
    }

    #[test]
    fn what_is_no_reflectance_is_refused_by_name() {
        for f0 in [-0.1, 1.001, f32::NAN] {
            let why = ConductorFresnel::schlick([0.5, f0, 0.5]).unwrap_err().to_string();
            assert!(why.contains("f0 = ") && why.contains("[0, 1]"), "{why}");
            assert!(ConductorFresnel::f82_tint([0.5], [f0]).is_err());
        }
        for eta in [0.0, -1.0, 1e7, f64::NAN] {
            let why = ConductorFresnel::exact([eta], [1.0]).unwrap_err().to_string();
            assert!(why.contains("eta = ") && why.contains("[1e-6, 1e6]"), "{why}");
        }
        for k in [-0.5, f64::INFINITY, f64::NAN] {
            let why = ConductorFresnel::exact([1.0], [k]).unwrap_err().to_string();
            assert!(why.contains("k = ") && why.contains("[0, 1e6]"), "{why}");
        }
    }
}
