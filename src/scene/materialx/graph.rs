//! Ranges of the values that MaterialX node graphs compute.

use super::Reader;
use crate::scene::texture::{Channel, Encoding};
use crate::scene::xml::Element;
use crate::scene::{Interval, SceneError};

impl<'a> Reader<'a> {
    /// The range of an `<input>` of a node in `scope`.
    pub(super) fn value(
        &mut self,
        input: &'a Element,
        scope: &'a Element,
    ) -> Result<Interval, SceneError> {
        self.connected(input, scope, Channel::Red)
    }

    /// As [`Self::value`], for one channel. Every cycle of connections passes through an input.
    fn connected(
        &mut self,
        input: &'a Element,
        scope: &'a Element,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        let key = (std::ptr::from_ref(input), channel);
        if let Some(known) = self.ranges.begin(key, &input.place)? {
            return Ok(known);
        }
        let range = self.source(input, scope, channel)?;
        Ok(self.ranges.end(key, range))
    }

    fn source(
        &mut self,
        input: &'a Element,
        scope: &'a Element,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        // Documents before 1.39 select channels at the connection; separate nodes have an output
        // each.
        let of_node = input.attribute("output").filter(|_| input.attribute("nodename").is_some());
        let taken = input.attribute("channels").or(of_node);
        let channel = taken.and_then(channel_named).unwrap_or(channel);
        let root = self.root;
        if let Some(name) = input.attribute("interfacename") {
            return match scope.child_named(name) {
                // An input in the document's own scope would refer to itself.
                Some(outer) if !std::ptr::eq(scope, root) => self.connected(outer, root, channel),
                _ => Err(undefined(input, "interface", name)),
            };
        }
        if let Some(name) = input.attribute("nodegraph") {
            let graph =
                root.child_named(name).ok_or_else(|| undefined(input, "nodegraph", name))?;
            return self.output(input, graph, channel);
        }
        if let Some(name) = input.attribute("nodename") {
            let node = scope.child_named(name).ok_or_else(|| undefined(input, "node", name))?;
            return match &node.tag[..] {
                "nodegraph" => self.output(input, node, channel),
                "output" => self.connected(node, scope, channel),
                _ => self.node(node, scope, channel),
            };
        }
        number(input, channel).map(Interval::point)
    }

    /// The output of `graph` that `input` is connected to.
    fn output(
        &mut self,
        input: &'a Element,
        graph: &'a Element,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        let mut outputs = graph.children.iter().filter(|child| child.tag == "output");
        let output = match input.attribute("output") {
            Some(name) => outputs.find(|output| output.attribute("name") == Some(name)),
            None => outputs.next(),
        };
        match output {
            Some(output) => self.connected(output, graph, channel),
            None => {
                let name = input.attribute("output").unwrap_or_default();
                Err(undefined(input, "output", name))
            }
        }
    }

    fn node(
        &mut self,
        node: &'a Element,
        scope: &'a Element,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        let mut input = |name: &str, default: f64| match node.child_named(name) {
            Some(input) => self.connected(input, scope, channel),
            None => Ok(Interval::point(default)),
        };
        Ok(match &node.tag[..] {
            "constant" => input("value", 0.0)?,
            "dot" | "convert" => input("in", 0.0)?,
            "add" => sum(input("in1", 0.0)?, input("in2", 0.0)?),
            "subtract" => sum(input("in1", 0.0)?, negated(input("in2", 0.0)?)),
            "multiply" => input("in1", 0.0)?.map_bilinear(input("in2", 1.0)?, |a, b| a * b),
            "invert" => sum(input("amount", 1.0)?, negated(input("in", 0.0)?)),
            "mix" => input("bg", 0.0)?.mix(input("fg", 0.0)?, input("mix", 0.0)?),
            "min" | "max" => {
                let (a, b) = (input("in1", 0.0)?, input("in2", 0.0)?);
                let of = if node.tag == "min" { f64::min } else { f64::max };
                Interval { min: of(a.min, b.min), max: of(a.max, b.max) }
            }
            "clamp" => {
                let (value, low, high) =
                    (input("in", 0.0)?, input("low", 0.0)?, input("high", 1.0)?);
                let clamp = |x: f64, low: f64, high: f64| x.max(low).min(high);
                Interval {
                    min: clamp(value.min, low.min, high.min),
                    max: clamp(value.max, low.max, high.max),
                }
            }
            "extract" | "separate2" | "separate3" | "separate4" | "swizzle" => {
                let channel = match &node.tag[..] {
                    "extract" => {
                        let index = node.child_named("index").and_then(|i| i.attribute("value"));
                        channel_at(index.unwrap_or("0"))
                    }
                    "swizzle" => {
                        let names = node.child_named("channels").and_then(|c| c.attribute("value"));
                        names.and_then(channel_named)
                    }
                    // The output is already selected in `channel`.
                    _ => Some(channel),
                };
                match (channel, node.child_named("in")) {
                    (Some(channel), Some(inner)) => self.connected(inner, scope, channel)?,
                    _ => self.unknown(node),
                }
            }
            "image" | "tiledimage" | "hextiledimage" | "gltf_image" => {
                self.image(node, scope, channel)
            }
            _ => self.unknown(node),
        })
    }

    fn unknown(&mut self, node: &Element) -> Interval {
        let name = node.attribute("name").unwrap_or(&node.tag);
        let reason = format!("is a node {}, whose range is not known", node.tag);
        self.builder.unread(name, &reason, &node.place)
    }

    fn image(&mut self, node: &'a Element, scope: &'a Element, channel: Channel) -> Interval {
        let place = &node.place;
        let input =
            node.child_named("file").and_then(|file| match file.attribute("interfacename") {
                Some(name) => scope.child_named(name),
                None => Some(file),
            });
        let Some((input, file)) = input.and_then(|input| Some((input, input.attribute("value")?)))
        else {
            let name = node.attribute("name").unwrap_or(&node.tag);
            return self.builder.unread(name, "names no file", place);
        };
        let is_colour = node.attribute("type").is_some_and(|t| t.starts_with("color"));
        let encoding = match input.attribute("colorspace") {
            Some("srgb_texture") if is_colour => Encoding::Srgb,
            _ => Encoding::Linear,
        };
        let channel = if node.attribute("type") == Some("float") { Channel::Red } else { channel };
        let prefix = [node, scope, self.root]
            .into_iter()
            .find_map(|element| element.attribute("fileprefix"))
            .unwrap_or_default();
        let file = self.folder.join(format!("{prefix}{file}"));
        self.builder.image(&file, channel, encoding, place)
    }
}

fn sum(a: Interval, b: Interval) -> Interval {
    Interval { min: a.min + b.min, max: a.max + b.max }
}

fn negated(a: Interval) -> Interval {
    a.map_falling(|x| -x)
}

fn undefined(input: &Element, what: &str, name: &str) -> SceneError {
    input.place.invalid(format!(
        "input \"{}\": there is no {what} \"{name}\"",
        input.attribute("name").unwrap_or_default()
    ))
}

/// The number in the attribute "value"; for a colour or a vector, that of the channel.
fn number(input: &Element, channel: Channel) -> Result<f64, SceneError> {
    let text = input.required("value")?;
    let mut parts = text.split(',').map(|part| part.trim().parse::<f64>().ok());
    let index = match channel {
        Channel::Green => 1,
        Channel::Blue => 2,
        Channel::Alpha => 3,
        _ => 0,
    };
    let index = index.min(text.matches(',').count());
    match parts.nth(index).flatten() {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(input.place.invalid(format!(
            "{} must be a number, not \"{text}\"",
            input.attribute("name").unwrap_or("value")
        ))),
    }
}

fn channel_at(index: &str) -> Option<Channel> {
    let channels = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha];
    channels.get(index.parse::<usize>().ok()?).copied()
}

/// The channel named "r", "x", "outr", "outx" and the like.
fn channel_named(name: &str) -> Option<Channel> {
    match name.strip_prefix("out").unwrap_or(name) {
        "r" | "x" => Some(Channel::Red),
        "g" | "y" => Some(Channel::Green),
        "b" | "z" => Some(Channel::Blue),
        "a" | "w" => Some(Channel::Alpha),
        _ => None,
    }
}
