//! The axes of a texture: quantities, their coordinates, and the texels.

use std::f64::consts::FRAC_PI_2;

use microfacet_tables::axis::{LogShape, ViewBlend};

use super::interface::{critical_coordinate, index_coordinate};

/// The most axes of a texture.
pub(super) const AXES: usize = 3;

/// The smallest σ of a texel. Below it the albedo depends on cot θ/σ alone; at 0 it is constant.
pub(super) const MIRROR: f64 = 1e-8;

/// Coordinates in the first cell of roughnesses. With 2, the error of E for γ = 1.501 in 32 × 32
/// texels is 1.1e-2 instead of 7.6e-3.
const FIRST_CELL: usize = 16;

/// The same of indices, of which the smallest change shares fastest. In other cells a fit is at the
/// texels alone, for time: of 32 along indices from 1.05 to 2.5 other axes err more, of 12 as much
/// (`docs/textures.md`).
const FIRST_OF_INDICES: usize = 4;

/// A material and a view of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Shape γ.
    pub gamma: f64,
    /// Roughness σ.
    pub sigma: f64,
    /// The index of refraction beyond the interface over that on the side of the view, less than 1
    /// seen from inside; none where all light is reflected, F = 1.
    pub eta: Option<f64>,
    /// cos θ of the view; none for an average over all views.
    pub cos: Option<f64>,
}

impl Place {
    /// A place of which nothing but γ is known, and that all light is reflected.
    pub fn of_shape(gamma: f64) -> Self {
        Self { gamma, sigma: f64::NAN, eta: None, cos: None }
    }
}

/// The quantity along an axis, as a coordinate in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// ln(1 + 17/(2γ−3)), as a share of its value at the smallest γ. 0 is γ = ∞.
    Shape {
        /// γ at 1.
        smallest: f64,
    },
    /// √((η−1)/(η+1)), between its values at both ends; η is the index of the denser medium over
    /// that of the other.
    Index {
        /// η at 0 and 1.
        ends: [f64; 2],
        /// Whether views are from inside the denser medium.
        inside: bool,
    },
    /// √(σ/σ_max).
    Roughness {
        /// σ_max.
        largest: f64,
    },
    /// σ itself, up to 1.
    LinearRoughness,
    /// n, linear between two values. η is n, or 1/n seen from inside.
    LinearIndex {
        /// n at 0.
        first: f64,
        /// n at 1.
        last: f64,
        /// Whether the surface is seen from inside.
        inside: bool,
    },
    /// √((n−1)/(n+1)), the fourth root of the reflectance of the normal view.
    Contrast {
        /// The largest value of a texel, which stands for larger ones.
        most: f64,
        /// Whether the surface is seen from inside.
        inside: bool,
    },
    /// x^¼, x = μ/(μ + κσ√(1−μ²)); made by [`Along::view`].
    View(ViewBlend),
    /// The view from inside a medium, which crowds at the critical angle as well.
    Critical {
        /// The share of x^0.3, which crowds at the horizon.
        near: f64,
    },
    /// μ.
    Cosine {
        /// The smallest μ of a texel.
        least: f64,
    },
    /// The angle θ over that of the horizon.
    Angle,
    /// √(1−μ).
    RootVersine {
        /// The smallest μ of a texel.
        least: f64,
    },
}

impl Along {
    /// The view in the coordinate that follows the roughness, with κ = scale + heavy/(2γ−3).
    pub fn view(scale: f64, heavy: f64) -> Self {
        let plain =
            ViewBlend { weight: 0.0, normal: 0.0, share: 1.0, floor: 0.0, ..ViewBlend::BAKED };
        Self::View(ViewBlend { scale, heavy, ..plain })
    }

    /// Whether it is a view, which depends on the material in some coordinates.
    pub fn is_view(self) -> bool {
        matches!(
            self,
            Self::View(_)
                | Self::Critical { .. }
                | Self::Cosine { .. }
                | Self::Angle
                | Self::RootVersine { .. }
        )
    }

    /// Of an index, whether the dielectric is seen from inside.
    pub fn inside(self) -> Option<bool> {
        match self {
            Self::Index { inside, .. }
            | Self::LinearIndex { inside, .. }
            | Self::Contrast { inside, .. } => Some(inside),
            _ => None,
        }
    }

    /// The name of its quantity in shaders and C.
    pub(super) fn argument(self) -> &'static str {
        match self {
            Self::Shape { .. } => "gamma",
            Self::Roughness { .. } | Self::LinearRoughness => "sigma",
            _ if self.is_view() => "mu",
            _ => "eta",
        }
    }

    /// Sets the quantity at the coordinate c; the material must be set before the view.
    fn set(self, c: f64, place: &mut Place) {
        match self {
            Self::Shape { smallest } => {
                let last = LogShape::BAKED.coordinate(smallest);
                // Exactly the γ that was asked for, without rounding.
                place.gamma = if c == 1.0 { smallest } else { LogShape::BAKED.quantity(c * last) };
            }
            Self::Index { ends, inside } => {
                let [first, last] = ends.map(index_coordinate);
                let square = (first + c * (last - first)).powi(2);
                // Exactly the ends that were asked for, without rounding.
                let eta = match c {
                    0.0 => ends[0],
                    1.0 => ends[1],
                    _ => (1.0 + square) / (1.0 - square),
                };
                place.eta = Some(if inside { 1.0 / eta } else { eta });
            }
            Self::Roughness { largest } => place.sigma = (largest * c * c).max(MIRROR),
            Self::LinearRoughness => place.sigma = c.max(MIRROR),
            Self::View(view) => {
                place.cos = Some(view.prepare(place.sigma, place.gamma).quantity(c));
            }
            Self::Critical { near } => {
                let (material, eta) = (*place, place.eta.expect("an interface"));
                let below = |cos: f64| critical_coordinate(near, &material, eta, cos) < c;
                place.cos = Some(if c == 1.0 { 1.0 } else { first_not(below) });
            }
            Self::Cosine { least } => place.cos = Some(c.max(least)),
            Self::Angle => place.cos = Some(if c == 1.0 { 0.0 } else { (FRAC_PI_2 * c).cos() }),
            Self::RootVersine { least } => place.cos = Some((1.0 - c * c).max(least)),
            Self::LinearIndex { first, last, inside } => {
                place.eta = Some(eta(first + (last - first) * c, inside));
            }
            Self::Contrast { most, inside } => {
                let square = c.min(most).powi(2);
                place.eta = Some(eta((1.0 + square) / (1.0 - square), inside));
            }
        }
    }

    /// The coordinate of a place.
    fn of(self, place: &Place) -> f64 {
        let cos = || place.cos.expect("a place with a view");
        let index = |inside| eta(place.eta.expect("a place with an index"), inside);
        match self {
            Self::Shape { smallest } => {
                let coordinate = |gamma| LogShape::BAKED.coordinate(gamma);
                coordinate(place.gamma) / coordinate(smallest)
            }
            Self::Index { ends, .. } => {
                let [first, last] = ends.map(index_coordinate);
                (index_coordinate(place.eta.expect("an interface")) - first) / (last - first)
            }
            Self::Roughness { largest } => (place.sigma / largest).sqrt(),
            Self::LinearRoughness => place.sigma,
            Self::View(view) => view.prepare(place.sigma, place.gamma).coordinate(cos()),
            Self::Critical { near } => {
                critical_coordinate(near, place, place.eta.expect("an interface"), cos())
            }
            Self::Cosine { .. } => cos(),
            Self::Angle => cos().acos() / FRAC_PI_2,
            Self::RootVersine { .. } => (1.0 - cos()).sqrt(),
            Self::LinearIndex { first, last, inside } => (index(inside) - first) / (last - first),
            Self::Contrast { inside, .. } => {
                let n = index(inside);
                ((n - 1.0) / (n + 1.0)).max(0.0).sqrt()
            }
        }
    }
}

/// η of n, and n of η: the reciprocal seen from inside.
fn eta(n: f64, inside: bool) -> f64 {
    if inside { n.recip() } else { n }
}

/// The smallest number in [0, 1] that is not below what is sought.
fn first_not(below: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            return high;
        }
        if below(middle) { low = middle } else { high = middle }
    }
}

/// An axis of a texture. A filter clamps to the first and the last texel, and is linear between.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelAxis {
    /// The quantity along it.
    pub along: Along,
    /// The coordinate of each texel, ascending.
    pub texels: Vec<f64>,
}

impl TexelAxis {
    /// n texels from 0 to 1: a shader that reads c reads the texture at (½ + (n−1)c)/n.
    pub fn to_ends(along: Along, n: usize) -> Self {
        let texel = |i| i as f64 / (n - 1) as f64;
        Self { along, texels: (0..n).map(texel).collect() }
    }

    /// n texels, each at the middle of its share of [0, 1]: a shader reads the texture at c.
    pub fn to_middles(along: Along, n: usize) -> Self {
        Self { along, texels: (0..n).map(|i| (i as f64 + 0.5) / n as f64).collect() }
    }

    /// Whether shapes run along it.
    pub fn is_of_shapes(&self) -> bool {
        matches!(self.along, Along::Shape { .. })
    }

    /// Whether it is the slow axis of a volume, of shapes or indices, of which certificates take
    /// slices.
    pub fn is_sliced(&self) -> bool {
        self.is_of_shapes() || self.along.inside().is_some()
    }

    /// How many texels it has.
    #[allow(clippy::len_without_is_empty, reason = "no axis is empty")]
    pub fn len(&self) -> usize {
        self.texels.len()
    }

    /// The texel before a coordinate, and the share of the next one in what a filter reads.
    pub fn locate(&self, c: f64) -> (usize, f64) {
        let before = self.texels.partition_point(|&texel| texel <= c).clamp(1, self.len() - 1) - 1;
        let [a, b] = [self.texels[before], self.texels[before + 1]];
        (before, ((c - a) / (b - a)).clamp(0.0, 1.0))
    }

    /// `per_cell` coordinates in each cell of [0, 1], with the texels and both ends among them. The
    /// first cell of roughnesses has more: E of heavy tails changes fastest there.
    pub fn dense(&self, per_cell: usize) -> Vec<f64> {
        let mut all = vec![0.0];
        let mut cell = |from: f64, to: f64| {
            let parts = match self.along {
                Along::Roughness { .. } if all.len() == 1 => FIRST_CELL,
                Along::Index { .. } if all.len() == 1 => FIRST_OF_INDICES,
                Along::Index { .. } => 1,
                _ => per_cell,
            };
            let part = |i: usize| from + (to - from) * i as f64 / parts as f64;
            all.extend((1..=parts).map(part));
        };
        let (first, last) = (self.texels[0], self.texels[self.len() - 1]);
        if first > 0.0 {
            cell(0.0, first);
        }
        self.texels.windows(2).for_each(|pair| cell(pair[0], pair[1]));
        if last < 1.0 {
            cell(last, 1.0);
        }
        all
    }
}

/// The place at one coordinate along each axis; what no axis sets is as in `fixed`.
pub fn place(axes: &[TexelAxis], fixed: Place, at: &[f64]) -> Place {
    let mut place = fixed;
    // Views last, since their coordinate depends on the material; axes may come in any order.
    for views in [false, true] {
        for (axis, &c) in axes.iter().zip(at) {
            if axis.along.is_view() == views {
                axis.along.set(c, &mut place);
            }
        }
    }
    place
}

/// The coordinate of a place along each axis.
pub(super) fn coordinates(axes: &[TexelAxis], place: &Place) -> [f64; AXES] {
    array(axes.iter().map(|axis| axis.along.of(place)))
}

pub(super) fn array(coordinates: impl Iterator<Item = f64>) -> [f64; AXES] {
    let mut at = [0.0; AXES];
    at.iter_mut().zip(coordinates).for_each(|(to, c)| *to = c);
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_places_and_back() {
        let along = [
            Along::Shape { smallest: 1.6 },
            Along::Roughness { largest: 3.0 },
            Along::view(3.0, 0.5),
        ];
        let axes = along.map(|along| TexelAxis::to_ends(along, 8));
        let nothing = Place::of_shape(f64::NAN);
        let of = |at: [f64; 3]| place(&axes, nothing, &at);
        let beckmann = Place { gamma: f64::INFINITY, sigma: 3.0, cos: Some(1.0), ..nothing };
        assert_eq!(of([0.0, 1.0, 1.0]), beckmann);
        let mirror = Place { gamma: 1.6, sigma: MIRROR, cos: Some(0.0), ..nothing };
        assert_eq!(of([1.0, 0.0, 0.0]), mirror);
        for at in [[0.3, 0.5, 0.7], [1.0, 1e-6, 0.01], [0.0, 1.0, 0.999]] {
            let found = of(at);
            let cos = found.cos.unwrap();
            let x = cos
                / (cos
                    + (3.0 + 0.5 / (2.0 * found.gamma - 3.0))
                        * found.sigma
                        * (1.0 - cos * cos).sqrt());
            assert!((x.powf(0.25) - at[2]).abs() < 1e-9, "{at:?}: {x}");
            let back = coordinates(&axes, &found);
            assert!(back.iter().zip(at).all(|(a, b)| (a - b).abs() < 1e-3), "{back:?}");
        }
    }

    #[test]
    fn filters_read_as_textures_do() {
        let ends = TexelAxis::to_ends(Along::Cosine { least: 0.0 }, 5);
        assert_eq!(
            [0.0, 0.125, 0.25, 1.0].map(|c| ends.locate(c)),
            [(0, 0.0), (0, 0.5), (1, 0.0), (3, 1.0)]
        );
        let middles = TexelAxis::to_middles(Along::Cosine { least: 0.0 }, 4);
        assert_eq!(
            [0.0, 0.125, 0.25, 1.0].map(|c| middles.locate(c)),
            [(0, 0.0), (0, 0.0), (0, 0.5), (2, 1.0)]
        );
        assert_eq!(middles.dense(2).len(), 2 * 5 + 1);
        assert_eq!(ends.dense(3).len(), 3 * 4 + 1);
        assert!(middles.dense(3).contains(&0.625) && middles.dense(3).ends_with(&[1.0]));
    }
}
