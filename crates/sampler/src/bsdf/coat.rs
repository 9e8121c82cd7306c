//! The albedo of a rough interface of one bounce, by quadrature over the facets that its lobe draws:
//! what a coat needs where no table is read.
//!
//! Against albedos of tables, reflection and transmission differ by at most 2e-3.

use alloc::vec::Vec;

use glam::Vec3;
use microfacet_core::math::{sqrt, unit};
use microfacet_core::{Masking, gauss_legendre};
use microfacet_tables::axis::hermite::{Cell, Node, cubic_cells, horner, locate};

use super::interface::Interface;
use crate::elementary::turn;
use crate::material::MicrofacetDistribution;
use crate::vector::vec3;

/// Cells between views, whose cosines are (i/32)⁴: a smooth surface masks within its roughness of
/// the horizon.
const CELLS: usize = 32;

/// Facets of each view, and views with a facet each of an average.
const FACETS: usize = 1024;
const VIEWS: usize = 8192;

/// The shares of light that one bounce off a rough interface reflects and transmits.
#[derive(Clone, Debug)]
pub(super) struct CoatAlbedo {
    /// Seen from outside, averaged over azimuths, by the fourth root of the view's cosine.
    shares: [Vec<Cell>; 2],
    /// The cosine-weighted average that is reflected inwards, seen from inside.
    pub(super) back: f32,
}

impl CoatAlbedo {
    /// Of a lobe and an index of refraction, inside over outside. Takes some 50,000 samples of the
    /// lobe.
    pub(super) fn new(lobe: &impl MicrofacetDistribution, masking: Masking, eta: f32) -> Self {
        let outside = Bounce { lobe, masking, face: Interface::new(eta, true) };
        let at = |i: usize| {
            let t = i as f32 / CELLS as f32;
            let cos = (t * t) * (t * t);
            mean(FACETS, |[azimuth, u, w, _]| outside.shares(view(cos, azimuth), [u, w]))
        };
        let values: Vec<[f64; 2]> = (0..=CELLS).map(at).collect();
        let inside = Bounce { face: Interface::new(eta, false), ..outside };
        let [back, _] = mean(VIEWS, |[azimuth, u, w, square]| {
            inside.shares(view(sqrt(square), azimuth), [u, w])
        });
        let shares = [0, 1].map(|event| {
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
        Self { shares, back: back as f32 }
    }

    /// The shares reflected and transmitted of a view from outside.
    #[inline]
    pub(super) fn shares(&self, v: Vec3) -> [f32; 2] {
        let (cell, w) = locate(sqrt(sqrt(unit(v.z))) * CELLS as f32, CELLS);
        [0, 1].map(|event| horner(&self.shares[event][cell], w).clamp(0.0, 1.0))
    }

    /// The cosine-weighted average that is transmitted from outside.
    pub(super) fn transmitted(&self) -> f32 {
        const RULE: [(f64, f64); 4] = gauss_legendre();
        let mut sum = 0.0;
        for cell in 0..CELLS {
            for (node, weight) in RULE {
                let t = (cell as f64 + node) / CELLS as f64;
                let cos = (t * t) * (t * t);
                let [_, transmission] = self.shares(Vec3::new(0.0, 0.0, cos as f32));
                // 2μ dμ/dt.
                sum += weight / CELLS as f64 * 8.0 * cos * (t * t * t) * f64::from(transmission);
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
