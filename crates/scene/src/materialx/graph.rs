//! Ranges of the values that MaterialX node graphs compute.

use microfacet_tables::Interval;

use super::Reader;
use super::connect::{channel_named, is_end, named, place, selected};
use super::index::{At, Scope};
use super::inputs::artistic;
use crate::Result;
use crate::texture::Channel;
use crate::xml::Element;

pub(super) const RGB: [Channel; 3] = [Channel::Red, Channel::Green, Channel::Blue];

impl<'a> Reader<'a> {
    /// The range of one channel of an `<input>` of a node in `scope`.
    pub(super) fn value(
        &mut self,
        input: &'a Element,
        scope: Scope<'a>,
        channel: Channel,
    ) -> Result<Interval> {
        let range = self.connected(input, scope, channel);
        if range.is_err() {
            self.ranges.abandon();
        }
        range
    }

    /// As [`Self::value`], for its recursion. Every circle of connections passes an input.
    fn connected(
        &mut self,
        input: &'a Element,
        scope: Scope<'a>,
        channel: Channel,
    ) -> Result<Interval> {
        let key = (At::new(input, scope), channel);
        if let Some(known) = self.ranges.begin(key, &input.place)? {
            return Ok(known);
        }
        let channel = selected(input, channel);
        let range = match self.target(input, scope)? {
            Some(end) if is_end(input, end.node) => self.connected(end.node, end.scope, channel)?,
            Some(at) => self.node(at, input.attribute("output"), channel)?,
            None => Interval::point(number(input, channel)?),
        };
        self.ranges.end(key, range, &input.place)
    }

    fn node(&mut self, at: At<'a>, output: Option<&'a str>, channel: Channel) -> Result<Interval> {
        let (node, scope) = (at.node, at.scope);
        let mut of = |name: &'static str, default: f64, channel| match self.index.given(node, name)
        {
            Some(input) => self.connected(input, scope, channel),
            None => Ok(Interval::point(default)),
        };
        let mut input = |name, default| of(name, default, channel);
        Ok(match &node.tag[..] {
            "constant" => input("value", 0.0)?,
            "dot" | "convert" => input("in", 0.0)?,
            "add" => sum(input("in1", 0.0)?, input("in2", 0.0)?),
            "subtract" => sum(input("in1", 0.0)?, negated(input("in2", 0.0)?)),
            "multiply" => input("in1", 0.0)?.map_bilinear(input("in2", 1.0)?, |a, b| a * b),
            "divide" => {
                let (a, b) = (input("in1", 0.0)?, input("in2", 1.0)?);
                if b.contains(0.0) {
                    return Ok(self.unknown(node, "divides by 0"));
                }
                a.map_bilinear(b.map_falling(|b| 1.0 / b), |a, b| a * b)
            }
            "power" | "safepower" => {
                let (base, exponent) = (input("in1", 0.0)?, input("in2", 1.0)?);
                if base.min < 0.0 || base.min == 0.0 && exponent.min <= 0.0 {
                    return Ok(self.unknown(node, "takes a power of a value that is not positive"));
                }
                // The power is monotonic in each argument, so that the extremes are at the ends.
                base.map_bilinear(exponent, libm::pow)
            }
            "sqrt" => input("in", 0.0)?.map_rising(|x| x.max(0.0).sqrt()),
            "absval" => {
                let x = input("in", 0.0)?;
                let min = if x.contains(0.0) { 0.0 } else { x.min.abs().min(x.max.abs()) };
                Interval { min, max: x.min.abs().max(x.max.abs()) }
            }
            "invert" => sum(input("amount", 1.0)?, negated(input("in", 0.0)?)),
            "mix" => input("bg", 0.0)?.mix(input("fg", 0.0)?, input("mix", 0.0)?),
            "min" | "max" => {
                let (a, b) = (input("in1", 0.0)?, input("in2", 0.0)?);
                let of = if node.tag == "min" { f64::min } else { f64::max };
                Interval { min: of(a.min, b.min), max: of(a.max, b.max) }
            }
            "clamp" => clamped(input("in", 0.0)?, input("low", 0.0)?, input("high", 1.0)?),
            "remap" | "range" => {
                let (low, high) = (input("inlow", 0.0)?, input("inhigh", 1.0)?);
                if !(low.is_point() && high.is_point() && low != high) {
                    return Ok(self.unknown(node, "has a range that varies, or is empty"));
                }
                let part = input("in", 0.0)?
                    .map_bilinear(low, |x, _| (x - low.min) / (high.min - low.min));
                let (low, high) = (input("outlow", 0.0)?, input("outhigh", 1.0)?);
                if node.tag == "remap" {
                    return Ok(low.mix(high, part));
                }
                let gamma = input("gamma", 1.0)?;
                if !(gamma.is_point() && gamma.min > 0.0) {
                    return Ok(self.unknown(node, "has a gamma that varies, or is not positive"));
                }
                let power = |x: f64| libm::pow(x.abs(), 1.0 / gamma.min).copysign(x);
                let part = part.map_rising(power);
                if !(part.min.is_finite() && part.max.is_finite()) {
                    return Ok(self.unknown(node, "has values that are not finite"));
                }
                let value = low.mix(high, part);
                match self.index.given(node, "doclamp").map(|input| input.attribute("value")) {
                    None | Some(Some("false")) => value,
                    Some(Some("true")) => clamped(value, low, high),
                    // A connected value may be true or false.
                    Some(_) => value.union(clamped(value, low, high)),
                }
            }
            "smoothstep" => Interval::UNIT,
            "ifgreater" | "ifgreatereq" | "ifequal" => input("in1", 0.0)?.union(input("in2", 0.0)?),
            "ramplr" | "splitlr" => input("valuel", 0.0)?.union(input("valuer", 0.0)?),
            "ramptb" | "splittb" => input("valuet", 0.0)?.union(input("valueb", 0.0)?),
            "ramp4" => {
                let top = input("valuetl", 0.0)?.union(input("valuetr", 0.0)?);
                top.union(input("valuebl", 0.0)?).union(input("valuebr", 0.0)?)
            }
            // A weighted average; any weights are allowed for.
            "luminance" => {
                let [r, g, b] = RGB.map(|channel| of("in", 0.0, channel));
                r?.union(g?).union(b?)
            }
            "combine2" | "combine3" | "combine4" => {
                let name = ["in1", "in2", "in3", "in4"][place(channel)];
                of(name, 0.0, Channel::Red)?
            }
            "extract" | "separate2" | "separate3" | "separate4" | "swizzle" => {
                let said = |name| self.index.child(node, name)?.attribute("value");
                let channel = match &node.tag[..] {
                    "extract" => channel_at(said("index").unwrap_or("0")),
                    "swizzle" => said("channels").and_then(|names| channel_named(names, channel)),
                    // The output is already selected in `channel`.
                    _ => Some(channel),
                };
                match (channel, self.index.given(node, "in")) {
                    (Some(channel), Some(inner)) => self.connected(inner, scope, channel)?,
                    _ => self.unknown(node, "takes a channel that is not known"),
                }
            }
            "roughness_anisotropy" | "glossiness_anisotropy" => {
                let r = match &node.tag[..] {
                    "roughness_anisotropy" => input("roughness", 0.0)?,
                    _ => sum(Interval::point(1.0), negated(input("glossiness", 1.0)?)),
                };
                let anisotropy = input("anisotropy", 0.0)?;
                let alpha =
                    super::shaders::stretched(r.clamp(0.0, 1.0), anisotropy.clamp(0.0, 1.0));
                if channel == Channel::Green { alpha.y() } else { alpha.x() }
            }
            "roughness_dual" => {
                let r = input("roughness", 0.0)?;
                // A negative second roughness stands for the first.
                let r = if r.max < 0.0 { of("roughness", 0.0, Channel::Red)? } else { r };
                r.clamp(0.0, 1.0).map_rising(|r| r * r)
            }
            "artistic_ior" => {
                let (r, edge) = (input("reflectivity", 0.944)?, input("edge_color", 0.998)?);
                let of = if output == Some("extinction") { 1 } else { 0 };
                // Only the ends of a range: an index of refraction is read if it is constant.
                let [a, b] = [(r.min, edge.min), (r.max, edge.max)];
                Interval::point(artistic(a.0, a.1)[of])
                    .union(Interval::point(artistic(b.0, b.1)[of]))
            }
            "image" | "tiledimage" | "hextiledimage" | "gltf_image" => {
                let factor = input("factor", 1.0)?;
                self.image(at, channel).map_bilinear(factor, |x, factor| x * factor)
            }
            "gltf_colorimage" => {
                let factor = input("color", 1.0)?;
                self.image(at, channel).map_bilinear(factor, |x, factor| x * factor)
            }
            "UsdUVTexture" => {
                let (scale, bias) = (input("scale", 1.0)?, input("bias", 0.0)?);
                sum(self.image(at, channel).map_bilinear(scale, |x, scale| x * scale), bias)
            }
            tag => match self.implemented(at, output)? {
                Some(end) => self.connected(end.node, end.scope, channel)?,
                None => {
                    let reason = format!("is a node {tag}, whose range is not known");
                    self.unknown(node, &reason)
                }
            },
        })
    }

    fn unknown(&mut self, node: &Element, reason: &str) -> Interval {
        self.builder.unread(named(node), reason, &node.place)
    }
}

/// Clamps to the lower limit first, and then to the upper one, as shaders do.
fn clamped(value: Interval, low: Interval, high: Interval) -> Interval {
    Interval {
        min: value.min.max(low.min).min(high.min),
        max: value.max.max(low.max).min(high.max),
    }
}

pub(super) fn sum(a: Interval, b: Interval) -> Interval {
    Interval { min: a.min + b.min, max: a.max + b.max }
}

pub(super) fn negated(a: Interval) -> Interval {
    a.map_falling(|x| -x)
}

/// The number in the attribute "value"; for a colour or a vector, that of the channel.
fn number(input: &Element, channel: Channel) -> Result<f64> {
    let name = input.attribute("name").unwrap_or("value");
    let Some(text) = input.attribute("value") else {
        return Err(input.place.invalid(format!("{name} has neither a value nor a connection")));
    };
    let is_between = |c: char| c == ',' || c.is_whitespace();
    let mut parts = text.split(is_between).filter(|part| !part.is_empty());
    let first = parts.next();
    let part = match place(channel) {
        0 => first,
        index => parts.take(index).last().or(first),
    };
    match part.and_then(|part| part.parse::<f64>().ok()) {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(input.place.invalid(format!("{name} must be a number, not \"{text}\""))),
    }
}

fn channel_at(index: &str) -> Option<Channel> {
    let channels = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha];
    channels.get(index.parse::<usize>().ok()?).copied()
}
