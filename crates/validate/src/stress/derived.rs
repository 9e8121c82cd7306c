//! The rules of batches, bounded normals, ellipsoids and albedo.

use glam::Vec3;

use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::lobe::Bounded;
use microfacet_sampler::{Ellipsoid, Masking, MicrofacetDistribution, Skew};

use super::checks::{Checker, ULP4};
use super::{Point, direction};

/// Angles of the ellipsoids that are tried with the roughness of each material.
const TURNS: [[f64; 3]; 2] = [[0.3, 0.0, 0.0], [0.7, -0.4, 2.0]];

impl Checker<'_> {
    /// Tests that a batch gives the same normals at one view.
    pub(super) fn batch(&mut self, points: &[Point]) {
        let v = points[0].view();
        let numbers: Vec<_> = points.iter().map(|at| at.u).collect();
        let mut normals = vec![Vec3::ZERO; points.len()];
        let done = self.lobe.sample_batch(&vec![v; points.len()], &numbers, &mut normals).is_ok();
        let mut g1 = [0.0; 5];
        let g1_done = self.lobe.g1_batch(&[v; 5], &mut g1).is_ok();
        let apart = g1.iter().map(|g1| (g1 - self.lobe.g1(v)).abs()).fold(0.0, f32::max);
        self.require(
            g1_done && f64::from(apart) <= 0.5 * ULP4,
            "g1_batch differs",
            apart.into(),
            &points[0],
        );

        for (at, m) in points.iter().zip(normals) {
            let apart = (m - self.lobe.sample_visible_normal(v, at.u)).abs().max_element();
            self.require(
                done && f64::from(apart) <= 0.5 * ULP4,
                "sample_batch differs",
                apart.into(),
                at,
            );
        }
    }

    /// Tests normals bounded for reflection at one view.
    pub(super) fn bounded(&mut self, bounded: &Bounded, points: &[Point]) {
        let v = points[0].view();
        let numbers: Vec<_> = points.iter().map(|at| at.u).collect();
        let bounded = bounded.at(v);
        let share = f64::from(bounded.share());
        let drawn: Vec<_> = numbers
            .iter()
            .map(|&u| bounded.sample(u))
            .map(|m| (m, [bounded.visible_normal_pdf(m), bounded.table_pdf(m)]))
            .collect();
        self.require(
            share > 0.0 && share <= 1.0,
            "bounded share outside (0, 1]",
            share,
            &points[0],
        );
        for (at, (m, densities)) in points.iter().zip(drawn) {
            self.unit_and_above(m, at);
            for pdf in densities {
                let sound = pdf >= 0.0 && pdf.is_finite();
                self.require(sound, "bounded pdf negative, NaN or inf", pdf.into(), at);
            }
        }
    }

    /// Tests a view and normals of the ellipsoids with the material's roughness; none where a
    /// matrix would be singular in single precision.
    pub(super) fn ellipsoids(&mut self, lobe: &Ellipsoid, points: &[Point]) {
        let [x, y] = self.sigma();
        for lobe in
            TURNS.iter().filter_map(|turn| lobe.with_skew(Skew::new([x, y], *turn).ok()?).ok())
        {
            let v = points[0].view();
            let g1 = f64::from(lobe.g1(v));
            self.require((0.0..=1.0).contains(&g1), "ellipsoid g1 outside [0, 1]", g1, &points[0]);
            for at in points {
                let m = lobe.sample_visible_normal(v, at.u);
                let length = m.as_dvec3().length();
                self.require(
                    (length - 1.0).abs() <= ULP4,
                    "ellipsoid normal not of unit length",
                    length,
                    at,
                );
                let l = 2.0 * v.dot(m) * m - v;
                let weight = f64::from(lobe.reflection_weight(v, l, Masking::Uncorrelated));
                let sound = (0.0..=1.0 + ULP4).contains(&weight);
                self.require(sound, "ellipsoid weight outside [0, 1]", weight, at);
                for pdf in [lobe.d(m), lobe.visible_normal_pdf(v, m)] {
                    let sound = pdf >= 0.0 && pdf.is_finite();
                    self.require(sound, "ellipsoid density negative, NaN or inf", pdf.into(), at);
                }
            }
        }
    }

    /// Tests albedo and compensation at a view; the random number `u[1]` places the light.
    pub(super) fn albedo(&mut self, albedo: &Albedo, at: &Point) {
        let v = at.view();
        let whole = f64::from(albedo.albedo(v));
        self.require((0.0..=1.0).contains(&whole), "albedo outside [0, 1]", whole, at);
        let average = f64::from(albedo.albedo_average());
        self.require((0.0..=1.0).contains(&average), "albedo_average outside [0, 1]", average, at);
        let l = direction(1.6 * f64::from(at.u[1]), at.phi + 1.0);
        let lobe = albedo.compensation(v, l);
        self.require(
            lobe >= 0.0 && lobe.is_finite(),
            "compensation negative, NaN or inf",
            lobe.into(),
            at,
        );
        let swapped = albedo.compensation(l, v);
        self.require(lobe == swapped, "compensation not symmetric", (lobe - swapped).into(), at);
        let factor = f64::from(albedo.turquin(v, at.u[0]));
        self.require(
            (1.0..=1.1e6).contains(&factor),
            "turquin factor outside [1, 1e6]",
            factor,
            at,
        );
        let kept = f64::from(albedo.multiple_bounces(at.u[0]));
        self.require((0.0..=1.0).contains(&kept), "multiple_bounces outside [0, 1]", kept, at);
        self.unit_and_above_or_level(albedo.sample_compensation(at.u), at);
    }

    fn unit_and_above_or_level(&mut self, l: Vec3, at: &Point) {
        let length = l.as_dvec3().length();
        self.require(
            (length - 1.0).abs() <= ULP4,
            "compensation light not of unit length",
            length,
            at,
        );
        self.require(l.z >= 0.0, "compensation light below the horizon", l.z.into(), at);
    }
}
