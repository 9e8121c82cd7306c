//! `open_pbr_surface`: the base, with its haze and its retroreflection, and the coat.

use microfacet_baker::scene::Roughness;
use microfacet_tables::{Interval, MaterialEntry};

use super::Reader;
use super::index::At;
use super::inputs::Metal;
use super::shaders::{Model, axes, schlick};
use crate::Result;
use crate::builder::Lobe;

impl<'a> Reader<'a> {
    pub(super) fn open_pbr_surface(&mut self, at: At<'a>) -> Result<Model> {
        let base = self.pair(at, ("specular_roughness", 0.3), "specular_roughness_anisotropy");
        let (metalness, metal) = self.metal(at, "base_metalness", 0.0)?;
        let transmission = self.unit(at, "transmission_weight", 0.0)?;
        let specular = self.input(at, "specular_weight", 1.0)?;
        let coat = self.unit(at, "coat_weight", 0.0)?;
        let coat_roughness = self.unit(at, "coat_roughness", 0.0)?;
        let film = self.film(at, "thin_film_weight")?;

        let mut model = Model::default();
        // `specular_weight` weights the metal's lobe; of the dielectric it only changes the index.
        if specular.max > 0.0 || transmission.max > 0.0 && metalness.min < 1.0 {
            let fresnel = match metal {
                _ if film => None,
                // Under a coat the index is relative to the coat's.
                Metal::None if coat.max > 0.0 => None,
                Metal::None => self.weighted_dielectric(at, "specular_ior", 1.5, specular)?,
                Metal::All => {
                    let f0 = self.product(at, "base_color", 0.8, "base_weight", 1.0)?;
                    let edge = self.colour(at, "specular_color", [1.0; 3])?;
                    f0.filter(|_| edge == Some([1.0; 3])).and_then(schlick)
                }
                Metal::Some => None,
            };
            let haze = self.haze(at)?;
            let retroreflection = self.retroreflectivity(at)?;
            let lobe = base.map(|(r, anisotropy)| {
                let alpha = |r| alpha(under_coat(r, coat_roughness, coat), anisotropy);
                let haze = haze.filter(|_| r.min < 1.0);
                // The coat roughens what the spread has roughened (`effective_haze_roughness`).
                let haze = haze.map(|(weight, spread)| (weight, alpha(spread_by(r, spread))));
                Lobe { haze, retroreflection, ..Lobe::ggx(None, alpha(r), fresnel) }
            });
            model.push_lobe(None, lobe);
        }
        if coat.max > 0.0 {
            let fresnel = self.dielectric(at, "coat_ior", 1.6)?;
            let anisotropy = self.unit(at, "coat_roughness_anisotropy", 0.0);
            model.push(Some("coat"), anisotropy.map(|a| alpha(coat_roughness, a)), fresnel);
        }
        Ok(model)
    }

    /// The weight and the spread of the haze; `None` if either is 0, since a haze without a spread
    /// is as rough as its core. What is impossible in them costs the haze alone.
    fn haze(&mut self, at: At<'a>) -> Result<Option<(Interval, Interval)>> {
        const NONE: (Interval, &str) = (Interval::point(0.0), "the lobe is read without a haze");
        let weight = self.unit(at, "specular_haze", 0.0);
        let weight = self.builder.or_warn(weight, NONE)?;
        if weight.max == 0.0 {
            return Ok(None);
        }
        let spread = self.unit(at, "specular_haze_spread", 0.3);
        let spread = self.builder.or_warn(spread, NONE)?;
        Ok((spread.max > 0.0).then_some((weight, spread)))
    }

    /// The share of what the base reflects that goes back; 0 with a warning if it is impossible.
    fn retroreflectivity(&mut self, at: At<'a>) -> Result<Interval> {
        let share = self.unit(at, "specular_retroreflectivity", 0.0);
        self.builder.or_warn(share, (MaterialEntry::SPECULAR, "the lobe is read without it"))
    }
}

/// The roughness of the haze over a core of roughness `r`: to 1 by the `spread`.
fn spread_by(r: Interval, spread: Interval) -> Interval {
    r.map_bilinear(spread, |r, spread| r + (1.0 - r) * spread)
}

/// The roughness `r` of what lies under a coat; it rises with each argument.
fn under_coat(r: Interval, coat_roughness: Interval, coat: Interval) -> Interval {
    let fourth = |x: f64| x * x * x * x;
    let roughened = |r: f64, coat_roughness: f64, coat: f64| {
        let sum = fourth(r) + 2.0 * fourth(coat_roughness);
        r + (sum.min(1.0).sqrt().sqrt() - r) * coat
    };
    Interval {
        min: roughened(r.min, coat_roughness.min, coat.min),
        max: roughened(r.max, coat_roughness.max, coat.max),
    }
}

/// α along both axes: r² √(2 / (1 + (1 − a)²)), and 1 − a times that.
fn alpha(roughness: Interval, anisotropy: Interval) -> Roughness {
    let stretch = |a: f64| (2.0 / (1.0 + (1.0 - a) * (1.0 - a))).sqrt();
    let along = anisotropy.map_rising(stretch);
    let across = anisotropy.map_falling(|a| (1.0 - a) * stretch(a));
    axes(roughness, anisotropy, [along.min, along.max], [across.min, across.max])
}
