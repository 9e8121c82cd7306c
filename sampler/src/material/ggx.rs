//! GGX without tables: at γ = 2 masking and visible normals have closed forms.

use alloc::vec::Vec;
use core::f32::consts::TAU;
use core::f64::consts::FRAC_PI_2;

use glam::Vec3;

use super::sample::{above_horizon, face};
use super::slices::Slices;
use super::student_t::{Roughness, Stretched, StudentT};
use crate::error::BindError;
use crate::math::{sqrt, sqrt64};

/// Where [`StudentT::table_joints`] splits closed forms, which have no joints of their own.
const PIECES: usize = 32;

/// The smallest 1 − u₁: keeps a normal off the horizon, where its length may vanish.
const LAST: f32 = 1.0 / 16_777_216.0;

impl StudentT {
    /// GGX, γ = 2, from closed forms alone: no table is needed, none is read, and nothing is interpolated.
    ///
    /// G1 is Walter et al. 2007, eq. 34. Visible normals are drawn by spherical caps (Dupuy and Benyoub 2023, "Sampling Visible GGX
    /// Normals with Spherical Caps", listing 1): `u[0]` chooses the height of a point on a cap and `u[1]` its azimuth about n, so
    /// the map from `u` to normals is another one than that of tables, of the same density.
    ///
    /// # Errors
    /// [`BindError::Sigma`] unless both roughnesses lie in [1e-8, 1e6].
    pub fn ggx(sigma: impl Into<Roughness>) -> Result<Self, BindError> {
        let [sigma_x, sigma_y] = sigma.into().checked()?;
        let slices = Slices::none();
        Ok(Self { sigma_x, sigma_y, gamma: 2.0, s: 1.0, two_k: 1.0, slices, closed_form: true })
    }

    /// G1/z = 2/(z + √(ρ² + z²)), finite at grazing.
    #[inline(always)]
    pub(crate) fn ggx_inverse_area(view: &Stretched) -> f32 {
        2.0 / (view.z + sqrt(view.rho * view.rho + view.z * view.z))
    }

    /// The half vector of the stretched view and a point of the cap z > −w.z of the unit sphere, stretched back.
    pub(crate) fn sample_ggx(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let w = Vec3::new(self.sigma_x * v.x, self.sigma_y * v.y, v.z.max(0.0));
        let length = sqrt(w.dot(w));
        // The null vector gives no direction: taken as normal incidence.
        let w = if length > 0.0 { w / length } else { Vec3::Z };
        // Height of the half vector first, so that it keeps its digits where the cap ends at −w.z.
        let height = (1.0 - u[0].clamp(0.0, 1.0)).max(LAST) * (1.0 + w.z);
        let z = height - w.z;
        let radius = sqrt(((1.0 - z) * (1.0 + z)).max(0.0));
        // `max` takes what is no number to 0, which `clamp` alone would keep.
        let (sin, cos) = libm::sincosf(TAU * u[1].max(0.0).clamp(0.0, 1.0));
        let m = Vec3::new(
            self.sigma_x * (w.x + radius * cos),
            self.sigma_y * (w.y + radius * sin),
            height,
        );
        face(above_horizon(m), Vec3::new(v.x, v.y, v.z.max(0.0)))
    }

    /// Quantiles of the in-plane slope and, for t ≥ 0, slopes across: what a quadrature of the density may be split at.
    pub(crate) fn ggx_joints(view: &Stretched) -> [Vec<f64>; 2] {
        let (rho, z) = (f64::from(view.rho), f64::from(view.z));
        let length = sqrt64(rho * rho + z * z);
        let (sin_theta, cos_theta) = (rho / length, z / length);
        let theta = libm::atan2(sin_theta, cos_theta);
        let share = |i: usize| i as f64 / PIECES as f64;
        // sin(α − θ) of the tilt α is uniform between the silhouette, α = θ − π/2, and the horizon, α = π/2.
        let tilt = |i| theta + libm::asin((share(i) * (1.0 + cos_theta) - 1.0).clamp(-1.0, 1.0));
        let along = (0..PIECES).map(|i| libm::tan(tilt(i))).chain([f64::INFINITY]);
        let across = (0..PIECES).map(|i| libm::tan(share(i) * FRAC_PI_2)).chain([f64::INFINITY]);
        [along.collect(), across.collect()]
    }
}
