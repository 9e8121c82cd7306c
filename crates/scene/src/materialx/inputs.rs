//! Values of the inputs of shading models and BSDFs, and the Fresnel terms that they state.

use microfacet_baker::scene::Reflectance;
use microfacet_tables::Interval;

use super::Reader;
use super::index::At;
use crate::Result;
use crate::fresnel::{conductor, dielectric};
use crate::texture::Channel;

/// The share of metal in a material.
pub(super) enum Metal {
    None,
    All,
    Some,
}

impl<'a> Reader<'a> {
    /// An input from 0 to 1; values outside are clamped, as the shaders do.
    pub(super) fn unit(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Interval> {
        let value = self.input(at, name, default)?;
        Ok(self.moved(at, name, value))
    }

    /// Clamps a value to [0, 1], with a warning if that changes it.
    pub(super) fn moved(&mut self, at: At<'a>, name: &str, value: Interval) -> Interval {
        if value.min < 0.0 || value.max > 1.0 {
            let worst = if value.min < 0.0 { value.min } else { value.max };
            self.builder.warn(
                &at.node.place,
                format!("{name} is {worst}, outside [0, 1]; it is moved to the nearer end"),
            );
        }
        value.clamp(0.0, 1.0)
    }

    pub(super) fn metal(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<(Interval, Metal)> {
        let metal = self.unit(at, name, default)?;
        let kind = match metal {
            Interval { max: 0.0, .. } => Metal::None,
            Interval { min: 1.0, .. } => Metal::All,
            _ => Metal::Some,
        };
        Ok((metal, kind))
    }

    /// The Fresnel term of a dielectric, if its index is constant; impossible ones are warned of.
    pub(super) fn dielectric(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Option<Reflectance>> {
        let fresnel = match self.constant(at, name, [default; 3]) {
            Ok(eta) => eta.map(|eta| dielectric(eta[0], &at.node.place)).transpose(),
            Err(error) => Err(error),
        };
        self.builder.without_fresnel(fresnel, None)
    }

    /// The Fresnel term of a dielectric whose reflectance at normal incidence is multiplied by a
    /// weight, which changes the index (`modulated_eta_s` in `open_pbr_surface.mtlx`).
    pub(super) fn weighted_dielectric(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: f64,
        weight: Interval,
    ) -> Result<Option<Reflectance>> {
        let fresnel = self.dielectric(at, name, default)?;
        let Some(Reflectance::Dielectric(Interval { min: eta, .. })) =
            fresnel.filter(|_| weight.is_point())
        else {
            return Ok(None);
        };
        // The index as written, without rounding.
        if weight.min == 1.0 {
            return Ok(fresnel);
        }
        let amplitude = (eta - 1.0) / (eta + 1.0);
        let f0 = (weight.min * amplitude * amplitude).clamp(0.0, 0.99999);
        let amplitude = f0.sqrt().copysign(amplitude);
        Ok(Some(Reflectance::dielectric((1.0 + amplitude) / (1.0 - amplitude))))
    }

    /// A constant colour of a Fresnel term; impossible ones are warned of.
    pub(super) fn colour(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: [f64; 3],
    ) -> Result<Option<[f64; 3]>> {
        let colour = self.constant(at, name, default);
        self.builder.without_fresnel(colour, None)
    }

    /// A constant colour times a constant number.
    pub(super) fn product(
        &mut self,
        at: At<'a>,
        colour: &'static str,
        grey: f64,
        factor: &'static str,
        default: f64,
    ) -> Result<Option<[f64; 3]>> {
        let colour = self.colour(at, colour, [grey; 3])?;
        let factor = self.colour(at, factor, [default; 3])?;
        Ok(colour.zip(factor).map(|(colour, factor)| colour.map(|x| x * factor[0])))
    }

    /// The reflectance at normal incidence, ((1 − n) / (1 + n))², of a constant index `ior`.
    pub(super) fn normal_reflectance(&mut self, at: At<'a>) -> Result<Option<f64>> {
        let Some(Reflectance::Dielectric(Interval { min: eta, .. })) =
            self.dielectric(at, "ior", 1.5)?
        else {
            return Ok(None);
        };
        let amplitude = (1.0 - eta) / (1.0 + eta);
        Ok(Some(amplitude * amplitude))
    }

    /// The conductor of a reflectance at normal incidence and an edge colour.
    pub(super) fn artistic(
        &mut self,
        at: At<'a>,
        reflectivity: Option<[f64; 3]>,
        edge: Option<[f64; 3]>,
    ) -> Result<Option<Reflectance>> {
        let Some((r, edge)) = reflectivity.zip(edge) else { return Ok(None) };
        let [red, green, blue] = [0, 1, 2].map(|i| artistic(r[i], edge[i]));
        let fresnel =
            conductor([red[0], green[0], blue[0]], [red[1], green[1], blue[1]], &at.node.place);
        self.builder.without_fresnel(fresnel.map(Some), None)
    }

    /// Whether a thin film lies, or may lie, on the lobe: its Fresnel term is then left open.
    pub(super) fn film(&mut self, at: At<'a>, amount: &'static str) -> Result<bool> {
        let film = self.greatest(at, amount, 0.0).map(|amount| amount > 0.0);
        self.builder.without_fresnel(film, true)
    }

    /// The greatest value of an input, of any channel.
    pub(super) fn greatest(&mut self, at: At<'a>, name: &'static str, default: f64) -> Result<f64> {
        let Some(input) = self.index.given(at.node, name) else { return Ok(default) };
        let mut greatest = f64::NEG_INFINITY;
        for channel in [Channel::Red, Channel::Green, Channel::Blue] {
            greatest = greatest.max(self.value(input, at.scope, channel)?.max);
        }
        Ok(greatest)
    }

    pub(super) fn input(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: f64,
    ) -> Result<Interval> {
        match self.index.given(at.node, name) {
            Some(input) => self.value(input, at.scope, Channel::Red),
            None => Ok(Interval::point(default)),
        }
    }
}

/// The index of refraction and the extinction of a metal of a reflectance at normal incidence and
/// an edge colour (Gulbrandsen, JCGT 3(4), 2014), limited as in `mx_artistic_ior`.
pub(super) fn artistic(reflectivity: f64, edge: f64) -> [f64; 2] {
    let r = reflectivity.clamp(0.0, 0.99);
    let least = (1.0 - r) / (1.0 + r);
    let greatest = (1.0 + r.sqrt()) / (1.0 - r.sqrt());
    let n = greatest + (least - greatest) * edge;
    let squared = ((n + 1.0) * (n + 1.0) * r - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    [n, squared.max(0.0).sqrt()]
}
