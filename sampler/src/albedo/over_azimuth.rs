//! Directional albedo of one material over the whole hemisphere of views: of lobes that are not round or not of the family.

use alloc::format;
use alloc::vec::Vec;

use glam::Vec3;
use microfacet_common::Masking;

use super::collapse::view_blend;
use super::curve::within;
use super::moments::{Moments, fade, less_mirror, over_views};
use crate::axis::lagrange::{SIX, combine, six};
use crate::axis::{BoundAzimuth, BoundView, Mapping, ViewBlend};
use crate::error::{BindError, LoadError};
use crate::format::{Kind, Table};
use crate::tables::Tables;

/// The directional albedo of one material as a function of the view, with F = 1 and as moments of Fresnel weights.
///
/// Made by [`Tables::material_view_albedo`]. `v` is a unit vector in the tangent frame, n = +z; a view at or below the horizon is taken as
/// the grazing one of its azimuth, NaN in `v.z` likewise, and NaN in the other two as the x axis. Errors are those of the table's
/// certificate: for tables of default quality at most 3e-4 for cos θ ≥ 0.02. Beyond the table's last view, μ₀ of
/// [`ViewBlend`] with σ_φ, the uncorrelated albedo is held constant and 1 − E of the correlated one falls on with the power of
/// cos θ that it has there.
#[derive(Clone, Debug)]
pub struct ViewAlbedo {
    masking: Masking,
    azimuth: BoundAzimuth,
    view: ViewBlend,
    /// How many views there are at each azimuth.
    views: usize,
    /// What the nodes hold, azimuths slowest; see [`Kind::CLAMPED_MOMENTS`], the last being 0 where nothing is clamped.
    nodes: Vec<[f32; 4]>,
    /// The averages, in the same form.
    average: [f32; 3],
}

impl Tables {
    /// The directional albedo, over cos θ and the azimuth φ of the view, of a named material that has a table of its own: an anisotropic
    /// Student-t whose σx, σy and γ are single numbers, an ellipsoid, or a distribution outside the family (of cos θ alone).
    ///
    /// For the form of masking that the recipe names, uncorrelated if it names none. The averages are integrated from the interpolated albedo
    /// over all views, so that a furnace closes; that takes about a millisecond, so keep the result.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], or [`BindError::NoViewAlbedo`] for a material whose albedo depends on cos θ alone or that was baked
    /// without albedos.
    pub fn material_view_albedo(&self, name: &str) -> Result<ViewAlbedo, BindError> {
        let entry = self.entry(name)?;
        let fail = |remedy| Err(BindError::NoViewAlbedo { name: name.into(), remedy });
        let Some(label) = entry.view_label() else {
            let [x, y] = entry.sigma;
            return fail(if x == y && x[0] == x[1] {
                "it is isotropic, and `material_albedo` has its albedo"
            } else {
                "its sigma or gamma is a range; state single numbers in its recipe, or take the isotropic stand-in of `material_albedo`"
            });
        };
        let named = Kind::ViewAlbedo.table_name(Some(entry.masking()), &label);
        let found = self.tables().iter().find(|table| table.kind == Kind::ViewAlbedo && table.name == named);
        match found {
            Some(table) => Ok(ViewAlbedo::bind(table)),
            None => fail("state `fresnel` in its recipe, or bake it with --albedo"),
        }
    }
}

impl ViewAlbedo {
    /// Binds a table at hand, such as one that a bake has just filled.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] for a table that is not sound or of another kind.
    pub fn new(table: &Table) -> Result<Self, LoadError> {
        table.validate()?;
        if table.kind == Kind::ViewAlbedo {
            return Ok(Self::bind(table));
        }
        let why = format!("table `{}`: {} where a view_albedo is expected", table.name, table.kind.name());
        Err(LoadError::Invalid(why))
    }

    fn bind(table: &Table) -> Self {
        let [azimuths, views] = &table.axes[..] else { unreachable!("validated on load") };
        let (Mapping::Azimuth(azimuth), Some(masking)) = (azimuths.mapping, table.masking) else {
            unreachable!("validated on load")
        };
        let clamp = |node: &[f32]| node.get(3).copied().unwrap_or(0.0);
        let nodes = table.values.chunks_exact(table.channels.len());
        let nodes = nodes.map(|node| [node[0], node[1], node[2], clamp(node)]).collect();
        let mut albedo = Self {
            masking,
            azimuth: azimuth.bind(azimuths.len()),
            view: view_blend(views),
            views: views.len(),
            nodes,
            average: [0.0; 3],
        };
        albedo.average = albedo.integrate();
        albedo
    }

    /// The form of masking it is for.
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// Moments of the Fresnel weights at a view; each in [0, 1], their total at most 1.
    pub fn moments(&self, v: Vec3) -> Moments {
        Moments::mirror(within(v.z)).plus(self.rest(v))
    }

    /// E(v) with F = 1, in [0, 1].
    pub fn albedo(&self, v: Vec3) -> f32 {
        1.0 - self.lost(v)
    }

    /// 1 − E(v), with all its digits where E is close to 1.
    pub fn lost(&self, v: Vec3) -> f32 {
        -self.rest(v)[0]
    }

    /// Averages of the moments over the hemisphere of views, weighted by the cosine: 1/π ∫∫ · μ dμ dφ.
    pub fn average_moments(&self) -> Moments {
        Moments::mirror_average().plus(self.average)
    }

    /// E_avg = 1/π ∫∫ E μ dμ dφ with F = 1.
    pub fn albedo_average(&self) -> f32 {
        1.0 - self.lost_average()
    }

    /// 1 − E_avg, with all its digits.
    pub fn lost_average(&self) -> f32 {
        -self.average[0]
    }

    fn integrate(&self) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for ([c, s], share) in self.azimuth.circle() {
            let rows = self.azimuth.six(c, s);
            let view = self.view_at(c, s);
            let part = over_views(view.floor(), |cos| self.interpolate(&rows, view.clamped(cos)));
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += share * part;
            }
        }
        less_mirror(sum)
    }

    /// The coordinate of views of an azimuth. What depends on γ is in the table's parameters.
    fn view_at(&self, c: f64, s: f64) -> BoundView {
        self.view.bind_shaped(self.azimuth.sigma(c, s))
    }

    /// E − 1 in [−1, 0], and what the other moments have over E times a mirror's.
    fn rest(&self, v: Vec3) -> [f32; 3] {
        let (x, y) = (f64::from(v.x), f64::from(v.y));
        let r = libm::hypot(x, y);
        // Seen along the normal every azimuth is as good; NaN fails the comparison, too.
        let (c, s) = if r > 0.0 && r < f64::INFINITY { (x / r, y / r) } else { (1.0, 0.0) };
        let (rows, view, cos) = (self.azimuth.six(c, s), self.view_at(c, s), within(v.z));
        let [e, bias, f82] = self.interpolate(&rows, view.clamped(cos));
        let floor = view.floor() as f32;
        if cos >= floor || self.masking == Masking::Uncorrelated || e == 0.0 {
            return [e, bias, f82];
        }
        // Correlated masking lets through ever more of what is seen: of a plain lobe all of it in the end.
        let [above, ..] = self.interpolate(&rows, view.clamped(4.0 * floor));
        // NaN has no power, either.
        let power = if above / e > 1.0 { (libm::log2f(above / e) / 2.0).min(1.0) } else { 0.0 };
        fade([e, bias, f82], libm::powf(cos / floor, power))
    }

    fn interpolate(&self, rows: &[(usize, f32); SIX], t: f32) -> [f32; 3] {
        let (start, weights) = six(t, self.views);
        let mut sum = [0.0; 4];
        for &(row, a) in rows {
            // A table without azimuths has one row.
            if a == 0.0 {
                continue;
            }
            let node = combine(&self.nodes, row * self.views + start, &weights);
            for (sum, x) in sum.iter_mut().zip(node) {
                *sum += a * x;
            }
        }
        let [e, bias, f82, clamp] = sum;
        let e = e.clamp(-1.0, 0.0);
        if clamp <= 0.5 {
            return [e, bias, f82];
        }
        // A/μ below one: more is seen of the surface than of its microsurface.
        let share = ((1.0 - clamp) / clamp).max(0.0);
        [share * (1.0 + e) - 1.0, share * bias, share * f82]
    }
}
