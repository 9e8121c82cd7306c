//! The albedos of one material as functions of the view: a table with the axes of the material
//! collapsed.

use alloc::vec::Vec;

use glam::Vec3;
use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_tables::axis::PreparedAzimuth;
use microfacet_tables::axis::lagrange::{SIX, combine};
use microfacet_tables::{Axis, Interval, Kind, Mapping, Reflectance, Table, Weights};

use super::average::{At, add, over_views};
use super::elevation::{Elevation, View};
use crate::error::MaterialError;
use crate::vector::vec3;

/// The largest number of channels of an albedo table.
const CHANNELS: usize = 4;

/// The material at which the axes before that of the view are collapsed; a table may lack some of
/// them.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialPoint {
    pub(super) sigma: f64,
    pub(super) gamma: f64,
    /// Index of refraction ≥ 1 of the dense side over the thin one.
    pub(super) eta: f64,
}

pub(super) struct MaterialWeights {
    pub(super) weights: Vec<Weights>,
    /// The roughness at which the weights are taken, no less than the first node's.
    sigma: f64,
    pub(super) is_mirror: bool,
}

impl MaterialWeights {
    /// `None` where the table was not baked for the material.
    pub(super) fn new(table: &Table, point: &MaterialPoint) -> Option<Self> {
        let mut collapsed = Self { weights: Vec::new(), sigma: point.sigma, is_mirror: false };
        for axis in &table.axes {
            let quantity = match axis.mapping {
                Mapping::LogShape(_) => point.gamma,
                Mapping::LogRoughness(_) => {
                    let Interval { min, max } = table.subject.lobe.roughness.x();
                    let sigma = end(point.sigma, [min, max]);
                    let covered = min <= sigma && sigma <= max;
                    if !(covered && table.subject.lobe.contains_shape(point.gamma)) {
                        return None;
                    }
                    let first = axis.quantity(axis.nodes[0])?;
                    // In single precision, in which lobes take σ.
                    let below = (sigma as f32) < first as f32;
                    // Nothing is tabulated between a mirror and the first node.
                    if below && sigma > 0.0 {
                        return None;
                    }
                    collapsed.is_mirror = below;
                    collapsed.sigma = sigma.max(first);
                    collapsed.sigma
                }
                Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => index(axis, point)?,
                _ => break,
            };
            collapsed.weights.push(axis.weights(axis.coordinate(quantity)?)?);
        }
        Some(collapsed)
    }

    /// At a node of γ and σ, which may be beyond what the table covers, by their indices; `None`
    /// where the table was not baked for the index of refraction.
    fn node(table: &Table, [shape, sigma]: [usize; 2], point: &MaterialPoint) -> Option<Self> {
        let mut weights = Vec::new();
        for axis in &table.axes {
            weights.push(match axis.mapping {
                Mapping::LogShape(_) => alloc::vec![(shape, 1.0)],
                Mapping::LogRoughness(_) => alloc::vec![(sigma, 1.0)],
                Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => {
                    axis.weights(axis.coordinate(index(axis, point)?)?)?
                }
                _ => break,
            });
        }
        Some(Self { weights, sigma: point.sigma, is_mirror: false })
    }
}

/// The index of refraction on its axis.
fn index(axis: &Axis, point: &MaterialPoint) -> Option<f64> {
    let [first, last] = axis.ends().map(|t| axis.quantity(t));
    Some(end(point.eta, [first?, last?]))
}

/// `x`, or an end of a range that equals it in single precision, in which lobes take σ.
fn end(x: f64, ends: [f64; 2]) -> f64 {
    // Every number is within the rounding of an infinite end.
    let same = |end: &f64| *end < f64::INFINITY && (x - end).abs() <= f64::from(f32::EPSILON) * end;
    ends.into_iter().find(same).unwrap_or(x)
}

/// N albedos of one material as functions of the view.
#[derive(Clone, Debug)]
pub struct ViewCurve<const N: usize>(Curve);

impl<const N: usize> ViewCurve<N> {
    /// Prepares a table of conductors or dielectrics, not one of moments, for one material.
    ///
    /// `eta` ≥ 1 is the index of a dielectric's dense side; tables of one material ignore σ and γ.
    /// Where the table has fewer than N channels, the last albedos are 0.
    ///
    /// # Errors
    /// [`MaterialError::OtherTable`] if the table has more channels, holds moments, or does not
    /// cover the material.
    pub fn from_table(
        table: &Table,
        sigma: f64,
        gamma: f64,
        eta: f64,
    ) -> Result<Self, MaterialError> {
        let shares =
            table.subject.reflectance.filter(|reflectance| *reflectance != Reflectance::Mirror);
        let point = MaterialPoint { sigma, gamma, eta };
        let curve = shares.filter(|reflectance| reflectance.channels().len() <= N);
        let curve = curve.and_then(|_| Curve::new(table, &point));
        curve.map(Self).ok_or_else(|| missing(&point))
    }

    pub(super) fn new(table: &Table, point: &MaterialPoint) -> Option<Self> {
        Curve::new(table, point).map(Self)
    }

    /// At a node of γ and σ by their indices, which is at `point`.
    pub(super) fn of_node(table: &Table, node: [usize; 2], point: &MaterialPoint) -> Option<Self> {
        Some(Self(Curve::collapsed(table, &MaterialWeights::node(table, node, point)?, point)))
    }

    /// The albedos at a view, each in [0, 1].
    ///
    /// `v` is a unit vector in the tangent frame, n = +z. A view at or below the horizon, or NaN,
    /// is replaced by the grazing view of its azimuth; only lobes that are not round depend on the
    /// azimuth. Closer to grazing than the table's first view, μ₀ of
    /// [`ViewBlend`](microfacet_tables::axis::ViewBlend), albedos are held constant.
    #[must_use]
    pub fn eval(&self, v: impl Into<[f32; 3]>) -> [f32; N] {
        self.of_view(vec3(v))
    }

    /// The albedos at the nodes of the view.
    pub(super) fn nodes(&self) -> impl Iterator<Item = [f32; N]> {
        self.0.nodes.iter().map(|node| core::array::from_fn(|i| node[i]))
    }

    fn of_view(&self, v: Vec3) -> [f32; N] {
        let cos = unit(v.z);
        self.0.with_view(v, |rows, view| self.at(rows, view, cos))
    }

    fn at(&self, rows: &Rows, view: &Elevation, cos: f32) -> [f32; N] {
        let all = self.0.interpolate(rows, view.six(cos, self.0.views));
        // Interpolation may leave [0, 1] by the table's error.
        core::array::from_fn(|i| all[i].clamp(0.0, 1.0))
    }

    /// Cosine-weighted averages over the hemisphere of views: 1/π ∫∫ E μ dμ dφ.
    #[must_use]
    pub fn average(&self) -> [f32; N] {
        self.average_of(|albedos| albedos.map(f64::from)).map(|x| x as f32)
    }

    /// Cosine-weighted averages of functions of the albedos.
    pub(crate) fn average_of<const M: usize>(&self, of: impl Fn([f32; N]) -> [f64; M]) -> [f64; M] {
        self.0.average(|rows, view, cos| {
            let albedos = self.at(rows, view, cos);
            let quantities = of(albedos);
            let all = albedos.map(f64::from).into_iter().chain(quantities);
            (quantities, all.fold(0, |bits, x| 2 * bits + u32::from(x == 0.0 || x == 1.0)))
        })
    }
}

/// Directional albedo of one bounce off a rough dielectric under its exact reflectance: the shares
/// of light reflected and transmitted.
///
/// The rest is shadowed, and left to further bounces.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DielectricAlbedo {
    /// The form of masking.
    pub masking: Masking,
    /// Seen from outside: [reflection, transmission] by the view outside.
    pub outside: ViewCurve<2>,
    /// Seen from inside: [reflection, transmission] by the view inside; z points to the side of the
    /// view.
    pub inside: ViewCurve<2>,
}

/// Directional albedo of one bounce under an exact reflectance, other than F = 1.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[expect(
    clippy::large_enum_variant,
    reason = "one is made for a material, and taken apart at once"
)]
pub enum FresnelAlbedo {
    /// Of a conductor: red, green and blue.
    Conductor(ViewCurve<3>),
    /// Of a dielectric, reflected and transmitted.
    Dielectric(DielectricAlbedo),
}

/// The error for a table that does not hold what was asked for.
pub(super) fn missing(point: &MaterialPoint) -> MaterialError {
    let &MaterialPoint { sigma, gamma, .. } = point;
    MaterialError::OtherTable { sigma, gamma }
}

/// All channels of a table, at one material.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// The values at the nodes, azimuths slowest; channels that the table lacks are 0.
    nodes: Vec<[f32; CHANNELS]>,
    views: usize,
    view: Views,
    /// The channel by which the others are clamped.
    clamp: Option<usize>,
    /// Whether the first channel is E − 1, not a share of light.
    moments: bool,
}

#[derive(Clone, Copy, Debug)]
enum Views {
    /// A round lobe: the same at every azimuth.
    Round(Elevation),
    /// By the roughness seen from the azimuth.
    Turning(PreparedAzimuth, View),
}

/// The coordinate of views for a roughness, of one shape: its parameters do not depend on γ.
fn shaped(view: &View, sigma: f64) -> Elevation {
    view.prepare(sigma, f64::INFINITY)
}

/// Azimuths, by index, with their weights.
pub(super) type Rows = [(usize, f32)];
/// The single azimuth of a round lobe.
const ROUND: &Rows = &[(0, 1.0)];

impl Curve {
    /// `None` where the table does not cover the material.
    pub(super) fn new(table: &Table, point: &MaterialPoint) -> Option<Self> {
        Some(Self::collapsed(table, &MaterialWeights::new(table, point)?, point))
    }

    fn collapsed(table: &Table, at: &MaterialWeights, point: &MaterialPoint) -> Self {
        let moments = table.subject.reflectance == Some(Reflectance::Mirror);
        let channels = table.channels.len();
        let mut nodes: Vec<[f32; CHANNELS]> = Vec::new();
        for node in table.collapsed::<f64>(&at.weights).chunks_exact(channels) {
            nodes.push(core::array::from_fn(|i| node.get(i).map_or(0.0, |&x| x as f32)));
        }
        if at.is_mirror && moments {
            nodes.fill([0.0; CHANNELS]);
        }
        let rest = &table.axes[at.weights.len()..];
        let view = View::of(rest[rest.len() - 1].mapping, point.eta).expect("validated on load");
        let view = match rest[0].mapping {
            Mapping::Azimuth(azimuth) => Views::Turning(azimuth.prepare(rest[0].len()), view),
            _ => Views::Round(view.prepare(at.sigma, point.gamma)),
        };
        let clamp = table.channels.iter().position(|channel| channel == Kind::CLAMP);
        Self { nodes, views: rest[rest.len() - 1].len(), view, clamp, moments }
    }

    /// Calls `then` with the azimuths and the elevation of a view.
    pub(super) fn with_view<R>(&self, v: Vec3, then: impl FnOnce(&Rows, &Elevation) -> R) -> R {
        match &self.view {
            Views::Round(view) => then(ROUND, view),
            Views::Turning(azimuth, view) => {
                let (x, y) = (f64::from(v.x), f64::from(v.y));
                let r = libm::hypot(x, y);
                // Along the normal the azimuth is arbitrary; NaN fails the comparison, too.
                let (c, s) = if r > 0.0 && r < f64::INFINITY { (x / r, y / r) } else { (1.0, 0.0) };
                then(&azimuth.six(c, s), &shaped(view, azimuth.sigma(c, s)))
            }
        }
    }

    /// The channels at some azimuths and views, clamped as G1(v) is.
    pub(super) fn interpolate(
        &self,
        rows: &Rows,
        (start, weights): (usize, [f32; SIX]),
    ) -> [f32; CHANNELS] {
        let mut sum = [0.0; CHANNELS];
        // A table without an azimuth axis has one row.
        for &(row, a) in rows.iter().filter(|row| row.1 != 0.0) {
            let node = combine(&self.nodes, row * self.views + start, &weights);
            for (sum, x) in sum.iter_mut().zip(node) {
                *sum += a * x;
            }
        }
        if self.moments {
            // E in [0, 1], so that 1 − E and its average agree.
            sum[0] = sum[0].clamp(-1.0, 0.0);
        }
        match self.clamp.map(|i| sum[i]) {
            // The channel is c = μ/(μ + A): above ½ the microsurface shows less area A than the
            // macrosurface.
            Some(clamp) if clamp > 0.5 => {
                let share = ((1.0 - clamp) / clamp).max(0.0);
                let one = if self.moments { 1.0 } else { 0.0 };
                let [first, rest @ ..] = sum.map(|x| share * x);
                let [a, b, c] = rest;
                [first + one * (share - 1.0), a, b, c]
            }
            _ => sum,
        }
    }

    pub(super) fn at(&self, rows: &Rows, view: &Elevation, cos: f32) -> [f32; CHANNELS] {
        self.interpolate(rows, view.six(cos, self.views))
    }

    /// Cosine-weighted averages over views of functions of azimuths, elevation and cos θ.
    pub(super) fn average<const N: usize>(
        &self,
        quantities: impl Fn(&Rows, &Elevation, f32) -> At<N>,
    ) -> [f64; N] {
        let over = |rows: &Rows, view: &Elevation| {
            over_views(view, self.views, &|cos| quantities(rows, view, cos))
        };
        match &self.view {
            Views::Round(view) => over(ROUND, view),
            Views::Turning(azimuth, view) => {
                let mut sum = [0.0; N];
                for ([c, s], share) in azimuth.circle() {
                    let part = over(&azimuth.six(c, s), &shaped(view, azimuth.sigma(c, s)));
                    add(&mut sum, share, &part);
                }
                sum
            }
        }
    }
}
