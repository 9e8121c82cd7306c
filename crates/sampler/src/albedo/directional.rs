//! The directional albedo of one material with F = 1, and its moments.

use glam::Vec3;
use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_tables::{Reflectance, Table};

use super::batch::of_each;
use super::curve::{Curve, MaterialPoint, Rows, missing};
use super::elevation::Elevation;
use super::moments::{Moments, averaged, down_to_grazing, less_mirror};
use crate::error::{BatchError, MaterialError};
use crate::vector::vec3;

/// The directional albedo of one material as a function of the view, with F = 1 and as moments of
/// Fresnel weights.
///
/// Made by [`Tables::albedo`](crate::Tables::albedo) and
/// [`Tables::material_albedo`](crate::Tables::material_albedo). `v` is a unit vector in the tangent
/// frame, n = +z; its azimuth matters only to lobes that are not round. A view at or below the
/// horizon, or with NaN in `v.z`, is replaced by the grazing view of its azimuth; NaN in the other
/// two counts as the azimuth of the x axis. Errors are those of the table's certificate: in E and
/// each moment at most 3e-4 at default quality for cos θ ≥ 0.02 and σ ≥ 0.01. Closer to grazing
/// than the table's first view, μ₀ of [`ViewBlend`](microfacet_tables::axis::ViewBlend), albedos
/// approach their limits with the power of cos θ that they have there.
///
/// [`Bsdf`](crate::Bsdf)s compensate multiple scattering themselves; this is for a BSDF of your
/// own. Two compensations of the light that one bounce loses are made from it: a factor on the lobe
/// ([`turquin`](Self::turquin)) and a lobe of its own ([`compensation`](Self::compensation)).
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{Masking, Tables};
///
/// let albedo = Tables::embedded().albedo(0.8, 3.0, Masking::HeightCorrelated)?;
/// let v = [0.6, 0.0, 0.8];
/// let gold = albedo.moments(v).schlick(0.77, 1.0); // green: F0, F90
/// let factor = albedo.turquin(v, 0.77);
/// assert!(albedo.albedo(v) < 1.0 && gold < albedo.albedo(v) && factor > 1.0);
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Albedo {
    masking: Masking,
    curve: Curve,
    /// The averages, as the channels of tables.
    average: [f32; 3],
}

impl Albedo {
    /// Reads a table of moments, such as one that a bake has just filled; a table of one material
    /// ignores σ and γ.
    ///
    /// # Errors
    /// [`MaterialError::OtherTable`] for a table that holds no moments or does not cover the
    /// material.
    pub fn from_table(table: &Table, sigma: f64, gamma: f64) -> Result<Self, MaterialError> {
        Self::of_moments(table, sigma, gamma, Self::new)
    }

    /// [`moments`](Self::moments) of a table as [`from_table`](Self::from_table) reads it, for a
    /// single view: without the averages, which take longer than all else.
    ///
    /// # Errors
    /// As [`from_table`](Self::from_table).
    pub fn moments_of_table(
        table: &Table,
        sigma: f64,
        gamma: f64,
        v: impl Into<[f32; 3]>,
    ) -> Result<Moments, MaterialError> {
        Ok(Self::of_moments(table, sigma, gamma, Self::without_averages)?.moments(v))
    }

    fn of_moments(
        table: &Table,
        sigma: f64,
        gamma: f64,
        read: impl FnOnce(&Table, &MaterialPoint) -> Option<Self>,
    ) -> Result<Self, MaterialError> {
        let point = MaterialPoint { sigma, gamma, eta: f64::NAN };
        let moments = table.subject.reflectance == Some(Reflectance::Mirror);
        moments.then(|| read(table, &point)).flatten().ok_or_else(|| missing(&point))
    }

    /// `None` where the table does not cover the material.
    pub(super) fn new(table: &Table, point: &MaterialPoint) -> Option<Self> {
        let mut albedo = Self::without_averages(table, point)?;
        let curve = &albedo.curve;
        albedo.average =
            less_mirror(curve.average(|rows, view, cos| averaged(cos, albedo.at(rows, view, cos))));
        Some(albedo)
    }

    /// [`new`](Self::new) with averages still to be made.
    fn without_averages(table: &Table, point: &MaterialPoint) -> Option<Self> {
        let curve = Curve::new(table, point)?;
        Some(Self { masking: table.subject.masking?, curve, average: [f32::NAN; 3] })
    }

    /// The form of masking.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// Moments of the Fresnel weights at a view, each in [0, 1], with a total of at most 1.
    #[must_use]
    pub fn moments(&self, v: impl Into<[f32; 3]>) -> Moments {
        let v = vec3(v);
        Moments::mirror(unit(v.z)).plus(self.rest(v))
    }

    /// The directional albedo E(v) with F = 1, in [0, 1].
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
        of_each(v, e, |v| self.albedo(v))
    }

    /// The share of light lost, 1 − E(v), with all its digits where E is close to 1.
    #[must_use]
    pub fn lost(&self, v: impl Into<[f32; 3]>) -> f32 {
        // 0 − x, not −x, which would give −0.
        0.0 - self.rest(vec3(v))[0]
    }

    /// Cosine-weighted averages of the moments over the hemisphere of views: 1/π ∫∫ · μ dμ dφ.
    #[must_use]
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average)
    }

    /// The average albedo E_avg = 1/π ∫∫ E μ dμ dφ with F = 1.
    #[must_use]
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// The average share of light lost, 1 − E_avg, with all its digits.
    #[must_use]
    pub fn lost_average(&self) -> f32 {
        0.0 - self.average[0]
    }

    /// The averages as the channels of tables, in which a bake writes them: E_avg − 1, and the
    /// excess of the other moments over E_avg times a mirror's.
    #[must_use]
    pub fn average_channels(&self) -> [f32; 3] {
        self.average
    }

    /// E − 1 in [−1, 0], and the excess of the other moments over E times a mirror's.
    fn rest(&self, v: Vec3) -> [f32; 3] {
        self.curve.with_view(v, |rows, view| self.at(rows, view, unit(v.z)))
    }

    fn at(&self, rows: &Rows, view: &Elevation, cos: f32) -> [f32; 3] {
        let channels = |cos| {
            let [e, bias, f82, _] = self.curve.at(rows, view, cos);
            [e, bias, f82]
        };
        down_to_grazing(self.masking, view.floor() as f32, cos, channels)
    }
}
