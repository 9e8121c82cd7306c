//! The albedo of a rough interface of one bounce, by quadrature over the facets that its lobe
//! draws: what a coat needs where no table is read.
//!
//! Shares of light err by at most 1e-3, and by 6e-3 for η < 1, whose coats reflect all light beyond
//! a critical angle (test `shares_are_those_of_the_model`).

use alloc::vec::Vec;

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::{Masking, gauss_legendre};
use microfacet_tables::axis::hermite::{Cell, Node, cubic_cells, horner, locate};

use super::interface::Interface;
use crate::elementary::turn;
use crate::material::MicrofacetDistribution;
use crate::vector::vec3;

/// Cells of a [`Piece`].
const CELLS: usize = 24;

/// Facets of each view, and views with a facet each of an average.
const FACETS: usize = 2048;
const VIEWS: usize = 16384;

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
                shares(from + (to - from) * ((t * t) * (t * t)))
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

/// The shares of light that one bounce off a rough interface reflects and transmits.
#[derive(Clone, Debug)]
pub(super) struct CoatAlbedo {
    /// Seen from outside, averaged over azimuths, by the view's cosine: from the horizon, from both
    /// sides of the critical angle if there is one, and from normal incidence.
    pieces: Vec<Piece>,
    /// The cosine-weighted average that is reflected inwards, seen from inside.
    pub(super) back: f32,
}

impl CoatAlbedo {
    /// Of a lobe and an index of refraction, inside over outside.
    pub(super) fn new(lobe: &impl MicrofacetDistribution, masking: Masking, eta: f32) -> Self {
        let outside = Bounce { lobe, masking, face: Interface::new(eta, true) };
        let shares = |cos: f32| {
            mean(FACETS, |[azimuth, u, w, _]| outside.shares(view(cos, azimuth), [u, w]))
        };
        let inside = Bounce { face: Interface::new(eta, false), ..outside };
        let [back, _] = mean(VIEWS, |[azimuth, u, w, square]| {
            inside.shares(view(sqrt(square), azimuth), [u, w])
        });
        let critical = sqrt(((1.0 - eta) * (1.0 + eta)).max(0.0));
        let halves = |[low, high]: [f32; 2]| {
            let middle = 0.5 * (low + high);
            [Piece::new(low, middle, shares), Piece::new(high, middle, shares)]
        };
        let pieces = match critical > 0.0 {
            true => [[0.0, critical], [critical, 1.0]].into_iter().flat_map(halves).collect(),
            false => halves([0.0, 1.0]).into(),
        };
        Self { pieces, back: back as f32 }
    }

    /// The shares reflected and transmitted of a view from outside.
    #[inline]
    pub(super) fn shares(&self, v: Vec3) -> [f32; 2] {
        let mut pieces = self.pieces.iter();
        let found = pieces.find(|piece| v.z <= piece.from.max(piece.to));
        found.or(self.pieces.last()).map_or([0.0; 2], |piece| piece.at(v.z))
    }

    /// The cosine-weighted average that is transmitted from outside.
    pub(super) fn transmitted(&self) -> f32 {
        const RULE: [(f64, f64); 4] = gauss_legendre();
        let mut sum = 0.0;
        for piece in &self.pieces {
            let [from, to] = [piece.from, piece.to].map(f64::from);
            for cell in 0..CELLS {
                for (node, weight) in RULE {
                    let t = (cell as f64 + node) / CELLS as f64;
                    let cos = from + (to - from) * (t * t) * (t * t);
                    let [_, transmission] = piece.at(cos as f32);
                    // 2μ dμ/dt.
                    let rate = 8.0 * cos * (to - from).abs() * (t * t * t);
                    sum += weight / CELLS as f64 * rate * f64::from(transmission);
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
    /// The shares reflected and transmitted by a facet drawn for the view.
    fn shares(&self, v: Vec3, u: [f32; 2]) -> [f32; 2] {
        let m = vec3(self.lobe.sample_visible_normal(v, u));
        let facing = v.dot(m);
        if !(facing > 0.0) {
            return [0.0; 2];
        }
        let weight = |l: Vec3| self.lobe.reflection_weight(v, l, self.masking);
        let l = 2.0 * facing * m - v;
        let reflected = self.face.reflectance(facing) * weight(l);
        // The opposite of the light is above the surface.
        let transmitted = self.face.refract(v, m, facing);
        let transmitted = transmitted.map_or(0.0, |(l, facet)| facet.transmittance * weight(-l));
        [reflected, transmitted]
    }
}

fn view(cos: f32, azimuth: f32) -> Vec3 {
    let (sin, [y, x]) = (sqrt((1.0 - cos) * (1.0 + cos)), turn(azimuth));
    Vec3::new(sin * x, sin * y, cos)
}

/// The mean over points of an additive recurrence of the unit cube of four dimensions (Roberts
/// 2018, <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>).
fn mean(n: usize, of: impl Fn([f32; 4]) -> [f32; 2]) -> [f64; 2] {
    const STEPS: [f64; 4] = [
        0.856_674_883_854_502_9,
        0.733_891_856_627_126,
        0.628_706_721_027_823,
        0.538_597_256_993_757,
    ];
    let mut sum = [0.0; 2];
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
    use crate::Tables;

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
}
