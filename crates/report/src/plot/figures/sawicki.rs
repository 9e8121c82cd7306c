//! Distributions with parameters that bring each of them near one Beckmann distribution, as printed
//! by Sawicki 2021 (*Microfacet Distribution Function: To Change or Not to Change, That Is the
//! Question*, <https://doi.org/10.5220/0010252702090220>).

use std::f64::consts::FRAC_PI_2;

use microfacet_baker::distribution::{DistributionKind, Named};
use microfacet_model::classic::Isotropic;

use crate::plot::figures::curve;
use crate::plot::{Axis, Curve, Dash, Figure, Key, Panel};

/// The distributions, with their names and the letters of their parameters; curves that coincide
/// differ in dashes.
const DRAWN: [(DistributionKind, &str, Dash); 6] = [
    (DistributionKind::Beckmann, "Beckmann, m", Dash::Dotted),
    (DistributionKind::BlinnPhong, "Blinn–Phong, N", Dash::LongDashed),
    (DistributionKind::Gauss, "Gauss, m", Dash::DashDotted),
    (DistributionKind::TrowbridgeReitz, "GGX, C", Dash::Dashed),
    (DistributionKind::Schlick, "Schlick, m", Dash::DashDotDotted),
    (DistributionKind::Sawicki, "Sawicki, N", Dash::Solid),
];
/// The parameters of [`DRAWN`] in figures 1 and 2 of Sawicki 2021; that of Schlick is Beckmann's.
const SETS: [Set; 2] = [
    Set([0.4, 10.0, 0.4364, 0.4456, 0.4, 12.04]),
    Set([0.04464, 1000.0, 0.04471, 0.05354, 0.04464, 1174.3]),
];

struct Set([f64; DRAWN.len()]);

struct Drawn {
    kind: DistributionKind,
    name: String,
    dash: Dash,
    d: Box<dyn Isotropic>,
}

impl Drawn {
    fn curve(&self, x: &Axis, f: impl Fn(f64) -> f64) -> Curve {
        curve(Key::Kind(self.kind), &self.name, x, f).dashed(self.dash)
    }
}

impl Set {
    fn beckmann(&self) -> f64 {
        self.0[0]
    }

    fn all(&self) -> Vec<Drawn> {
        let of = |((kind, name, dash), value): ((DistributionKind, &str, Dash), f64)| {
            let d = Named { kind, values: vec![value] }.build().expect("printed parameters");
            Drawn { kind, name: format!("{name} = {value}"), dash, d }
        };
        DRAWN.into_iter().zip(self.0).map(of).collect()
    }

    /// Curves over β in degrees, as far as the lobes reach, of a function of D/D(0) of a lobe and
    /// of Beckmann. Beckmann itself is left out where the others are compared with it.
    fn over_angles(
        &self,
        title: &str,
        y: Axis,
        is_compared: bool,
        f: fn(f64, f64) -> f64,
    ) -> Panel {
        let reach = (5.0 * self.beckmann()).min(FRAC_PI_2).to_degrees();
        let (x, all) = (Axis::degrees("angle β from the normal", 0.0, reach), self.all());
        let curve = |of: &Drawn| {
            of.curve(&x, |at| {
                let [own, beckmann] = [&of.d, &all[0].d].map(|d| d.relative_d(at.to_radians()));
                f(own, beckmann)
            })
        };
        let curves: Vec<Curve> = all[usize::from(is_compared)..].iter().map(curve).collect();
        Panel::new(format!("{title}, m = {}", self.beckmann()), x, y, curves)
    }

    fn unit_forms(&self) -> Panel {
        let y = Axis::linear("D(β)/D(0)", 0.0, 1.05);
        self.over_angles("D/D(0)", y, false, |d, _| d)
    }

    fn differences(&self) -> Panel {
        let y = Axis::linear("from Beckmann (% of D(0))", -17.0, 17.0);
        self.over_angles("Difference", y, true, |d, beckmann| 100.0 * (d - beckmann))
    }

    fn tails(&self) -> Panel {
        let y = Axis::log("D/D(0) over Beckmann's", 0.1, 1e5);
        self.over_angles("Tails beside Beckmann's", y, true, |d, beckmann| d / beckmann)
    }

    /// Brightness along the line through the highlight of a sphere, relative to that where the half
    /// vector is the normal. View and light are far away, at this angle to each other.
    ///
    /// The BRDF is that of Ashikhmin and Shirley 2000 (*An Anisotropic Phong BRDF Model*,
    /// <https://doi.org/10.1080/10867651.2000.10487522>), D F/(4 (v·m) max(n·v, n·l)), times n·l.
    /// All points have one half vector m, so that F and v·m cancel.
    fn highlight(&self, degrees: f64) -> Panel {
        let light = degrees.to_radians();
        let half = 0.5 * light;
        // Normals near the highlight that face both view and light.
        let reach = 5.0 * self.beckmann();
        let low = (half - reach).max(light - FRAC_PI_2).max(-FRAC_PI_2);
        let high = (half + reach).min(FRAC_PI_2);
        let x = Axis::linear("distance from the centre (radii)", low.sin(), high.sin());
        let curve = |of: &Drawn| {
            let brightness = |normal: f64| {
                let (cos_v, cos_l) = (normal.cos().max(0.0), (normal - light).cos().max(0.0));
                of.d.relative_d((normal - half).abs()) * cos_l / cos_v.max(cos_l)
            };
            let peak = brightness(half);
            of.curve(&x, |at| brightness(at.clamp(-1.0, 1.0).asin()) / peak)
        };
        let curves: Vec<Curve> = self.all().iter().map(curve).collect();
        let title = format!("Light at {degrees}°, m = {}", self.beckmann());
        Panel::new(title, x, Axis::linear("relative brightness", 0.0, 1.05), curves)
    }
}

/// D/D(0), and its differences from Beckmann's, as in figures 1 and 2 of Sawicki 2021.
pub(super) fn distributions() -> Figure {
    Figure::new(SETS.iter().flat_map(|set| [set.unit_forms(), set.differences()]))
}

/// Ratios of D/D(0) to Beckmann's, which show the tails.
pub(super) fn tails() -> Figure {
    Figure::stacked(SETS.iter().map(Set::tails))
}

/// Highlights of a rough sphere and of a smooth one, after figures 3–5 of Sawicki 2021.
pub(super) fn highlights() -> Figure {
    let row = |set: &Set| [45.0, 120.0].map(|degrees| set.highlight(degrees));
    Figure::new(SETS.iter().flat_map(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn largest(curve: &Curve) -> f64 {
        curve.points.iter().map(|p| p.1.abs()).fold(0.0, f64::max)
    }

    #[test]
    fn differences_are_those_of_the_text() {
        let [rough, smooth] = SETS.map(|set| set.differences().curves);
        let of = |curves: &[Curve], kind| {
            largest(curves.iter().find(|curve| curve.key == Key::Kind(kind)).unwrap())
        };
        // The paper states 3.5 % for Blinn–Phong at N = 10, and 3–7 % for Sawicki.
        assert!((of(&rough, DistributionKind::BlinnPhong) - 3.5).abs() < 0.05);
        let [most, least] =
            [&rough, &smooth].map(|curves| of(curves, DistributionKind::Sawicki).round());
        assert_eq!([least, most], [3.0, 7.0]);
        // The paper states 13–15 % for Schlick; computed, it is 12.4 to 15.3.
        let [least, most] = [&rough, &smooth].map(|curves| of(curves, DistributionKind::Schlick));
        assert!((least - 12.4).abs() < 0.05 && (most - 15.3).abs() < 0.05, "{least} {most}");
        // All agree at β = 0.
        assert!(rough.iter().chain(&smooth).all(|curve| curve.points[0] == (0.0, 0.0)));
    }

    #[test]
    fn highlights_are_brightest_where_the_half_vector_is_the_normal() {
        for (panel, degrees) in highlights().panels.iter().zip([45.0, 120.0, 45.0, 120.0]) {
            let half = f64::to_radians(0.5 * degrees).sin();
            for curve in &panel.curves {
                let brightest = curve
                    .points
                    .iter()
                    .copied()
                    .fold((0.0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
                let (at, name) = (brightest.0, &curve.name);
                // Between two of the points of the curve.
                let step = curve.points[1].0 - curve.points[0].0;
                assert!((at - half).abs() < 2.0 * step, "{}, {name}: {at}", panel.title);
                assert!((0.99..1.0 + 1e-3).contains(&brightest.1), "{name}: {}", brightest.1);
                assert!(curve.points.iter().all(|p| p.1 >= 0.0 && p.1.is_finite()), "{name}");
            }
        }
    }
}
