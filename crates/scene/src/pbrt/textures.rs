//! The ranges of pbrt's float textures.

use microfacet_tables::Interval;

use super::Reader;
use super::definition::{Definition, Parameter};
use crate::Result;
use crate::texture::{Channel, Encoding};

impl Reader {
    /// The range of a parameter that is a number or a texture.
    pub(super) fn value(&mut self, parameter: &Parameter) -> Result<Interval> {
        if parameter.kind != "texture" {
            return parameter.number().map(Interval::point);
        }
        let place = &parameter.place;
        let name = parameter.first();
        if let Some(texture) = self.textures.get(name).cloned() {
            if let Some(known) = self.ranges.begin(texture.name.clone(), place)? {
                return Ok(known);
            }
            let range = self.texture(&texture)?;
            return self.ranges.end(texture.name.clone(), range, place);
        }
        if self.incomplete {
            let (name, reason) =
                (format!("\"{name}\""), "is not defined in the files that were found");
            return Ok(self.builder.unread(&name, reason, place));
        }
        let names = self.textures.keys().map(|name| &name[..]);
        let hint = self.builder.did_you_mean(name, names);
        Err(place.invalid(format!("float texture \"{name}\" is not defined{hint}")))
    }

    fn texture(&mut self, texture: &Definition) -> Result<Interval> {
        let mut input = |name: &str, default: f64| match texture.parameter(name) {
            Some(parameter) => self.value(parameter),
            None => Ok(Interval::point(default)),
        };
        Ok(match &texture.class[..] {
            "constant" => input("value", 1.0)?,
            "scale" => input("tex", 1.0)?.map_bilinear(input("scale", 1.0)?, |a, b| a * b),
            "mix" => input("tex1", 0.0)?.mix(input("tex2", 1.0)?, input("amount", 0.5)?),
            "directionmix" => input("tex1", 0.0)?.union(input("tex2", 1.0)?),
            "checkerboard" => input("tex1", 1.0)?.union(input("tex2", 0.0)?),
            "dots" => input("inside", 1.0)?.union(input("outside", 0.0)?),
            "bilerp" => input("v00", 0.0)?
                .union(input("v01", 1.0)?)
                .union(input("v10", 0.0)?)
                .union(input("v11", 1.0)?),
            "imagemap" => {
                let scale = input("scale", 1.0)?;
                let invert = texture.truth("invert", false)?;
                let scaled = self.image(texture).map_bilinear(scale, |a, b| a * b);
                if invert { scaled.map_falling(|x| (1.0 - x).max(0.0)) } else { scaled }
            }
            class => {
                let reason = format!("is of class {class}, whose range is not known");
                let name = format!("\"{}\"", texture.name);
                self.builder.unread(&name, &reason, &texture.place)
            }
        })
    }

    /// The range of an image; pbrt's filters read different channels.
    fn image(&mut self, texture: &Definition) -> Interval {
        let text = |name| texture.parameter(name).map(Parameter::first);
        let Some(file) = text("filename") else {
            let name = format!("\"{}\"", texture.name);
            return self.builder.unread(&name, "names no file", &texture.place);
        };
        let is_png = file.to_ascii_lowercase().ends_with(".png");
        let encoding = match text("encoding") {
            // pbrt decodes integers of other formats as sRGB, whatever `encoding` is.
            _ if !is_png => Encoding::Srgb,
            Some("linear") => Encoding::Linear,
            None | Some("sRGB") => Encoding::Srgb,
            Some(_) => {
                let reason = "has an encoding other than \"sRGB\" and \"linear\"";
                return self.builder.unread(file, reason, &texture.place);
            }
        };
        let file = self.folder.join(file);
        let mut of = |channel| self.builder.image(&file, channel, encoding, &texture.place);
        match text("filter").unwrap_or("bilinear") {
            "point" => of(Channel::Red),
            "bilinear" | "trilinear" => of(Channel::AlphaOrMean),
            // EWA, which pbrt also uses for an unknown filter, reads single pixels, or interpolates
            // where its ellipse has no width.
            _ => of(Channel::Red).union(of(Channel::AlphaOrMean)),
        }
    }
}
