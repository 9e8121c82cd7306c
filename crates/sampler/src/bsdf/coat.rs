//! The albedo of a rough interface of one bounce, by quadrature over the facets that its lobe
//! draws: what a coat needs where no table is read.
//!
//! Shares of light err by at most 1e-3, and by 6e-3 for η < 1, whose coats reflect all light beyond
//! a critical angle (test `shares_are_those_of_the_model`). Of lobes that are not round they are
//! interpolated over azimuths, and err by up to 0.04, and 0.2 for η < 1, where one roughness is a
//! tenth of the other (test `shares_follow_the_azimuth`).

use alloc::vec::Vec;
use core::f32::consts::{PI, TAU};

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::{Masking, gauss_legendre};
use microfacet_tables::axis::hermite::{Cell, Node, cubic_cells, horner, locate};

use super::interface::Interface;
use crate::elementary::turn;
use crate::material::{LobeKey, MicrofacetDistribution, Tabulated};
use crate::vector::vec3;

/// Cells of a [`Piece`].
const CELLS: usize = 24;

/// Facets of each view, and of one whose azimuth matters; views with a facet each of an average.
const FACETS: usize = 2048;
const FACETS_TURNED: usize = 512;
const VIEWS: usize = 16384;

/// Azimuths between two principal axes of an upright lobe, both included, and in a full turn.
const QUARTER: usize = 9;
const FULL: usize = 32;

/// A cosine next to the horizon, in place of 0, at which G1 is 0 by definition and not by its
/// limit.
const HORIZON: f32 = 1e-7;

/// Cosines of views from one end, where albedos change within the roughness, to another: in steps
/// of the fourth root of their distance from the first.
#[derive(Clone, Debug)]
struct Piece {
    from: f32,
    to: f32,
    /// The shares reflected and transmitted.
    cells: [Vec<Cell>; 2],
}

impl Piece {
    fn new(from: f32, to: f32, shares: impl Fn(f32) -> [f64; 2]) -> Self {
        let values: Vec<[f64; 2]> = (0..=CELLS)
            .map(|i| {
                let t = i as f32 / CELLS as f32;
                shares((from + (to - from) * ((t * t) * (t * t))).max(HORIZON))
            })
            .collect();
        let cells = [0, 1].map(|event| {
            let value = |i: usize| values[i][event];
            let node = |i: usize| -> Node {
                // Differences of second order, one-sided at the ends.
                let slope = match i {
                    0 => 2.0 * value(1) - 1.5 * value(0) - 0.5 * value(2),
                    CELLS => 1.5 * value(i) - 2.0 * value(i - 1) + 0.5 * value(i - 2),
                    _ => 0.5 * (value(i + 1) - value(i - 1)),
                };
                [value(i) as f32, slope as f32]
            };
            cubic_cells(&(0..=CELLS).map(node).collect::<Vec<_>>(), 1.0)
        });
        Self { from, to, cells }
    }

    #[inline]
    fn at(&self, cos: f32) -> [f32; 2] {
        let t = sqrt(sqrt(unit((cos - self.from) / (self.to - self.from))));
        let (cell, w) = locate(t * CELLS as f32, CELLS);
        [0, 1].map(|event| horner(&self.cells[event][cell], w).clamp(0.0, 1.0))
    }
}

/// How the shares depend on the view's azimuth.
#[derive(Clone, Copy, Debug)]
enum Azimuth {
    /// Not at all.
    Round,
    /// As those of an upright lobe: by the azimuth in unit space, into which σx and σy stretch.
    Upright([f32; 2]),
    /// In any way.
    Any,
}

impl Azimuth {
    fn of(lobe: &impl Tabulated) -> Self {
        match lobe.key() {
            LobeKey::Upright(lobe) => match lobe.sigma().map(|sigma| sigma as f32) {
                [x, y] if x == y || lobe.distribution.is_some() => Self::Round,
                sigma => Self::Upright(sigma),
            },
            _ => Self::Any,
        }
    }

    fn count(self) -> usize {
        match self {
            Self::Round => 1,
            Self::Upright(_) => QUARTER,
            Self::Any => FULL,
        }
    }

    /// The azimuth of a node, in radians.
    fn node(self, i: usize) -> f32 {
        match self {
            Self::Round => 0.0,
            Self::Upright([x, y]) => {
                let [sin, cos] = turn(i as f32 * (0.25 / (QUARTER - 1) as f32));
                libm::atan2f(sin * x, cos * y)
            }
            Self::Any => i as f32 * (TAU / FULL as f32),
        }
    }

    /// The nodes on both sides of a view, and the weight of the second.
    #[inline]
    fn between(self, v: Vec3) -> ([usize; 2], f32) {
        match self {
            Self::Round => ([0, 0], 0.0),
            Self::Upright([x, y]) => {
                let quarter = libm::atan2f(y * v.y.abs(), x * v.x.abs()) * (2.0 / PI);
                let at = quarter * (QUARTER - 1) as f32;
                let node = at as usize;
                ([node, node + 1].map(|node| node.min(QUARTER - 1)), at - node as f32)
            }
            Self::Any => {
                let turns = libm::atan2f(v.y, v.x) * (1.0 / TAU);
                let at = (if turns < 0.0 { turns + 1.0 } else { turns }) * FULL as f32;
                // The sum rounds to a full turn next to the first node.
                let node = at as usize;
                ([node, node + 1].map(|node| node % FULL), at - node as f32)
            }
        }
    }
}

/// The shares of light that one bounce off a rough interface reflects and transmits.
#[derive(Clone, Debug)]
pub(super) struct CoatAlbedo {
    azimuth: Azimuth,
    /// Seen from outside, for each azimuth, by the view's cosine: from the horizon, from both sides
    /// of the critical angle if there is one, and from normal incidence.
    turned: Vec<Vec<Piece>>,
    /// The cosine-weighted average that is lost, seen from inside.
    pub(super) lost_inside: f32,
}

impl CoatAlbedo {
    /// Of a lobe and an index of refraction, inside over outside. Takes 120,000 samples of a round
    /// lobe, 220,000 for η < 1, and a few times as many of others.
    pub(super) fn new(lobe: &impl Tabulated, masking: Masking, eta: f32) -> Self {
        let outside = Bounce { lobe, masking, face: Interface::new(eta, true) };
        let inside = Bounce { face: Interface::new(eta, false), ..outside };
        let [_, _, lost_inside] = mean(VIEWS, |[azimuth, u, w, square]| {
            inside.shares(view(sqrt(square), azimuth * TAU), [u, w])
        });
        let critical = sqrt(((1.0 - eta) * (1.0 + eta)).max(0.0));
        let parts: &[[f32; 2]] = match critical > 0.0 {
            true => &[[0.0, critical], [critical, 1.0]],
            false => &[[0.0, 1.0]],
        };
        let azimuth = Azimuth::of(lobe);
        let facets = if azimuth.count() == 1 { FACETS } else { FACETS_TURNED };
        let of_node = |i: usize| {
            let shares = |cos: f32| {
                let v = view(cos, azimuth.node(i));
                let [reflected, transmitted, _] =
                    mean(facets, |[_, u, w, _]| outside.shares(v, [u, w]));
                [reflected, transmitted]
            };
            let halves = |&[low, high]: &[f32; 2]| {
                let middle = 0.5 * (low + high);
                [Piece::new(low, middle, shares), Piece::new(high, middle, shares)]
            };
            parts.iter().flat_map(halves).collect()
        };
        let turned = (0..azimuth.count()).map(of_node).collect();
        Self { azimuth, turned, lost_inside: lost_inside as f32 }
    }

    /// The shares reflected and transmitted of a view from outside.
    #[inline]
    pub(super) fn shares(&self, v: Vec3) -> [f32; 2] {
        let ([low, high], w) = self.azimuth.between(v);
        let of = |node: usize| {
            let pieces = &self.turned[node];
            let found = pieces.iter().find(|piece| v.z <= piece.from.max(piece.to));
            found.or(pieces.last()).map_or([0.0; 2], |piece| piece.at(v.z))
        };
        let shares = of(low);
        if low == high {
            return shares;
        }
        let other = of(high);
        [0, 1].map(|event| shares[event] + w * (other[event] - shares[event]))
    }

    /// The cosine-weighted average that is transmitted from outside.
    pub(super) fn transmitted(&self) -> f32 {
        const RULE: [(f64, f64); 4] = gauss_legendre();
        let azimuths = if self.azimuth.count() == 1 { 1 } else { 2 * FULL };
        let mut sum = 0.0;
        for piece in &self.turned[0] {
            let [from, to] = [piece.from, piece.to].map(f64::from);
            for cell in 0..CELLS {
                for (node, weight) in RULE {
                    let t = (cell as f64 + node) / CELLS as f64;
                    let cos = from + (to - from) * (t * t) * (t * t);
                    // 2μ dμ/dt.
                    let rate = 8.0 * cos * (to - from).abs() * (t * t * t);
                    for azimuth in 0..azimuths {
                        let azimuth = (azimuth as f32 + 0.5) * (TAU / azimuths as f32);
                        let [_, transmission] = self.shares(view(cos as f32, azimuth));
                        sum += weight / (CELLS * azimuths) as f64 * rate * f64::from(transmission);
                    }
                }
            }
        }
        sum as f32
    }
}

/// One bounce off an interface.
struct Bounce<'a, L> {
    lobe: &'a L,
    masking: Masking,
    face: Interface,
}

impl<L: MicrofacetDistribution> Bounce<'_, L> {
    /// The shares reflected, transmitted and lost by a facet drawn for the view.
    fn shares(&self, v: Vec3, u: [f32; 2]) -> [f32; 3] {
        let m = vec3(self.lobe.sample_visible_normal(v, u));
        let facing = v.dot(m);
        if !(facing > 0.0) {
            return [0.0, 0.0, 1.0];
        }
        let weight = |l: Vec3| self.lobe.reflection_weight(v, l, self.masking);
        let [reflectance, reflected] =
            [self.face.reflectance(facing), weight(2.0 * facing * m - v)];
        // The opposite of the light is above the surface.
        let refracted = self.face.refract(v, m, facing);
        let [transmittance, transmitted] =
            refracted.map_or([0.0; 2], |(l, facet)| [facet.transmittance, weight(-l)]);
        // Not 1 less the others, which for a dense coat cancel.
        let lost = reflectance * (1.0 - reflected) + transmittance * (1.0 - transmitted);
        [reflectance * reflected, transmittance * transmitted, lost]
    }
}

/// The direction of an azimuth in radians.
fn view(cos: f32, azimuth: f32) -> Vec3 {
    let sin = sqrt((1.0 - cos) * (1.0 + cos));
    Vec3::new(sin * libm::cosf(azimuth), sin * libm::sinf(azimuth), cos)
}

/// The mean over points of an additive recurrence of the unit cube of four dimensions (Roberts
/// 2018, <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>).
fn mean(n: usize, of: impl Fn([f32; 4]) -> [f32; 3]) -> [f64; 3] {
    const STEPS: [f64; 4] = [
        0.856_674_883_854_502_9,
        0.733_891_856_627_126,
        0.628_706_721_027_823,
        0.538_597_256_993_757,
    ];
    let mut sum = [0.0; 3];
    for i in 0..n {
        let point = STEPS.map(|step| {
            let at = 0.5 + step * i as f64;
            (at - libm::floor(at)) as f32
        });
        for (sum, x) in sum.iter_mut().zip(of(point)) {
            *sum += f64::from(x) / n as f64;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use microfacet_model::fresnel::Dielectric;
    use microfacet_model::{AlbedoIntegrator, Shape};

    use super::*;
    use crate::{Lobe, Skew, Tables};

    #[test]
    fn shares_are_those_of_the_model() {
        let mut worst = [0.0_f64; 2];
        for gamma in [1.6, 2.5, f64::INFINITY] {
            let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
            for sigma in [0.02, 0.3, 1.0] {
                let lobe = Tables::embedded().student_t(sigma, gamma).unwrap();
                for eta in [1.0 / 1.5, 1.5, 2.4] {
                    let coat = CoatAlbedo::new(&lobe, Masking::HeightCorrelated, eta as f32);
                    let fresnel = Dielectric::new(eta).unwrap();
                    let model = |fresnel: Dielectric, cos: f64| {
                        let reflectance = |cos| [fresnel.reflectance(cos)];
                        let kink = (1.0 - eta * eta).max(0.0).sqrt();
                        let reflected =
                            integrator.reflection_with_kink(sigma, cos, kink, reflectance).unwrap();
                        let transmitted = integrator.transmission(sigma, cos, fresnel).unwrap();
                        [reflected, transmitted].map(|albedo| albedo.of(Masking::HeightCorrelated))
                    };
                    for cos in [1e-4, 0.003, 0.05, 0.3, 0.6, 0.73, 0.76, 0.97, 1.0] {
                        let got = coat.shares(view(cos as f32, 0.3));
                        for (got, [want]) in got.into_iter().zip(model(fresnel, cos)) {
                            let error = (f64::from(got) - want).abs();
                            let worst = &mut worst[usize::from(eta > 1.0)];
                            *worst = worst.max(error);
                        }
                    }
                }
            }
        }
        // Below 1 and above.
        assert!(worst[0] < 6e-3 && worst[1] < 1e-3, "{worst:?}");
    }

    #[test]
    fn shares_follow_the_azimuth() {
        let tables = Tables::embedded();
        let skew = Skew::new([0.3, 0.15], [0.2, -0.1, 0.5]).unwrap();
        for gamma in [1.7, f64::INFINITY] {
            let lobes: [Lobe; 3] = [
                tables.student_t([0.3, 0.1], gamma).unwrap().into(),
                tables.student_t([0.05, 0.5], gamma).unwrap().into(),
                tables.ellipsoid(skew, gamma).unwrap().into(),
            ];
            for lobe in &lobes {
                for (eta, limit) in [(1.0 / 1.5, 0.21), (1.5, 0.04)] {
                    let masking = Masking::HeightCorrelated;
                    let coat = CoatAlbedo::new(lobe, masking, eta);
                    let bounce = Bounce { lobe, masking, face: Interface::new(eta, true) };
                    let mut worst = 0.0_f64;
                    for cos in [0.003, 0.05, 0.3, 0.72] {
                        for i in 0..20 {
                            let v = view(cos, i as f32 * 0.33);
                            let [r, t, _] = mean(1 << 13, |[_, u, w, _]| bounce.shares(v, [u, w]));
                            for (got, want) in coat.shares(v).into_iter().zip([r, t]) {
                                worst = worst.max((f64::from(got) - want).abs());
                            }
                        }
                    }
                    assert!(worst < limit, "{lobe:?} {eta}: {worst}");
                    // An azimuth that rounds to a full turn, and the other end of a quarter.
                    let along = |x, y| coat.shares(Vec3::new(x, y, 0.6));
                    for (a, b) in
                        [(along(0.8, -1e-9), along(0.8, 0.0)), (along(1e-9, 0.8), along(0.0, 0.8))]
                    {
                        assert!((a[1] - b[1]).abs() < 1e-5, "{lobe:?} {eta}: {a:?} {b:?}");
                    }
                }
            }
        }
    }
}
