//! The rules of batches, bounded normals, ellipsoids and albedo.

use glam::Vec3;

use microfacet_sampler::albedo::{Albedo, AlbedoAt};
use microfacet_sampler::lobe::{Batch, BoundedRef, Reflecting, Tabulated};
use microfacet_sampler::{Ellipsoid, Masking, MicrofacetDistribution, Skew};

use super::checks::{Checker, ULP4};
use super::{Point, direction};

/// Angles of the ellipsoids that are tried with the roughness of each material.
const TURNS: [[f64; 3]; 2] = [[0.3, 0.0, 0.0], [0.7, -0.4, 2.0]];

impl<L: Reflecting + Tabulated + Batch> Checker<'_, L> {
    /// Tests that a batch gives the same normals at one view.
    pub(super) fn batch(&mut self, points: &[Point]) {
        let v = points[0].view();
        let numbers: Vec<_> = points.iter().map(|at| at.u).collect();
        let mut normals = vec![Vec3::ZERO; points.len()];
        let done = self.lobe.sample_batch(&vec![v; points.len()], &numbers, &mut normals).is_ok();
        let mut g1 = [0.0; 5];
        let g1_done = self.lobe.g1_batch(&[v; 5], &mut g1).is_ok();
        let apart = g1.iter().map(|g1| (g1 - self.lobe.g1(v)).abs()).fold(0.0, f32::max);
        let same = |apart: f32| f64::from(apart) <= 0.5 * ULP4;
        self.require(g1_done && same(apart), "g1_batch differs", apart, &points[0]);

        for (at, m) in points.iter().zip(normals) {
            let one = Vec3::from(self.lobe.sample_visible_normal(v, at.u));
            let apart = (m - one).abs().max_element();
            self.require(done && same(apart), "sample_batch differs", apart, at);
        }
    }

    /// Tests normals bounded for reflection at one view.
    pub(super) fn bounded(&mut self, bounded: BoundedRef<'_>, points: &[Point]) {
        let bounded = bounded.at(points[0].view());
        let share = bounded.share();
        let sound = share > 0.0 && share <= 1.0;
        self.require(sound, "bounded share outside (0, 1]", share, &points[0]);
        for at in points {
            let (m, table) = bounded.sample_with_table_pdf(at.u);
            self.unit_and_above(m.into(), at);
            for pdf in [bounded.visible_normal_pdf(m), table] {
                self.density(pdf, "bounded pdf negative, NaN or inf", at);
            }
        }
    }

    /// Tests a view and normals of the ellipsoids with the material's roughness; none where a
    /// matrix would be singular in single precision.
    pub(super) fn ellipsoids(&mut self, lobe: &Ellipsoid, points: &[Point]) {
        let [x, y] = self.sigma();
        let turned = |turn: [f64; 3]| lobe.with_skew(Skew::new([x, y], turn).ok()?).ok();
        for lobe in TURNS.into_iter().filter_map(turned) {
            let v = points[0].view();
            self.share(lobe.g1(v), "ellipsoid g1 outside [0, 1]", &points[0]);
            for at in points {
                let m = Vec3::from(lobe.sample_visible_normal(v, at.u));
                self.unit(m.as_dvec3(), ULP4, "ellipsoid normal not of unit length", at);
                let l = 2.0 * v.dot(m) * m - v;
                let weight = f64::from(lobe.reflection_weight(v, l, Masking::Uncorrelated));
                let sound = (0.0..=1.0 + ULP4).contains(&weight);
                self.require(sound, "ellipsoid weight outside [0, 1]", weight, at);
                for pdf in [lobe.d(m), lobe.visible_normal_pdf(v, m)] {
                    self.density(pdf, "ellipsoid density negative, NaN or inf", at);
                }
            }
        }
    }
}

/// The rules of an albedo, alike for each of its forms.
macro_rules! albedos {
    ($($name:ident: $albedo:ty),*) => {
        impl<L: Reflecting + Tabulated + Batch> Checker<'_, L> {$(
            /// Tests albedo and compensation at a view; the random number `u[1]` determines the
            /// light.
            pub(super) fn $name(&mut self, albedo: &$albedo, at: &Point) {
                let v = at.view();
                self.share(albedo.albedo(v), "albedo outside [0, 1]", at);
                self.share(albedo.albedo_average(), "albedo_average outside [0, 1]", at);
                let l = direction(1.6 * f64::from(at.u[1]), at.phi + 1.0);
                let lobe = albedo.compensation(v, l);
                self.density(lobe, "compensation negative, NaN or inf", at);
                let swapped = albedo.compensation(l, v);
                self.require(lobe == swapped, "compensation not symmetric", lobe - swapped, at);
                let factor = f64::from(albedo.turquin(v, at.u[0]));
                let sound = (1.0..=1.1e6).contains(&factor);
                self.require(sound, "turquin factor outside [1, 1e6]", factor, at);
                self.share(albedo.multiple_bounces(at.u[0]), "multiple_bounces outside [0, 1]", at);
                let l = Vec3::from(albedo.sample_compensation(at.u));
                self.unit(l.as_dvec3(), ULP4, "compensation light not of unit length", at);
                self.require(l.z >= 0.0, "compensation light below the horizon", l.z, at);
            }
        )*}
    };
}

albedos!(albedo: Albedo, albedo_at_hit: AlbedoAt<'_>);
