//! Ranges of the values that MaterialX node graphs compute.

use super::Reader;
use crate::scene::texture::{Channel, Encoding};
use crate::scene::xml::{Element, Key};
use crate::scene::{Interval, SceneError, cycle};

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
        let key = (input.key(), channel);
        if let Some(known) = self.ranges.begin(key, &input.place)? {
            return Ok(known);
        }
        let range = self.source(input, scope, channel)?;
        self.ranges.end(key, range, &input.place)
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
        match self.target(input, scope)? {
            Some((end, scope))
                if end.tag == "output" || input.attribute("interfacename").is_some() =>
            {
                self.connected(end, scope, channel)
            }
            Some((node, scope)) => self.node(node, scope, channel),
            None => number(input, channel).map(Interval::point),
        }
    }

    /// The input, output or node that an input or output in `scope` is connected to, with the scope
    /// of that; `None` if it has a value of its own.
    fn target(
        &self,
        input: &'a Element,
        scope: &'a Element,
    ) -> Result<Option<(&'a Element, &'a Element)>, SceneError> {
        let root = self.root;
        if let Some(name) = input.attribute("interfacename") {
            return match self.index.child(scope, name) {
                // An input in the document's own scope would refer to itself.
                Some(outer) if !std::ptr::eq(scope, root) => Ok(Some((outer, root))),
                _ => Err(undefined(input, "interface", name)),
            };
        }
        if let Some(name) = input.attribute("nodegraph") {
            let graph =
                self.index.child(root, name).ok_or_else(|| undefined(input, "nodegraph", name))?;
            return self.output(input, graph).map(Some);
        }
        if let Some(name) = input.attribute("nodename") {
            let node =
                self.index.child(scope, name).ok_or_else(|| undefined(input, "node", name))?;
            return match &node.tag[..] {
                "nodegraph" => self.output(input, node).map(Some),
                _ => Ok(Some((node, scope))),
            };
        }
        Ok(None)
    }

    /// The output of `graph` that `input` is connected to, with its scope.
    fn output(
        &self,
        input: &'a Element,
        graph: &'a Element,
    ) -> Result<(&'a Element, &'a Element), SceneError> {
        let name = input.attribute("output").unwrap_or_default();
        let output = self.index.outputs.get(&(graph.key(), name));
        output.map(|&output| (output, graph)).ok_or_else(|| undefined(input, "output", name))
    }

    /// Refuses nodes that are connected in a circle, of values and of shaders.
    pub(super) fn check_circles(&self) -> Result<(), SceneError> {
        let root = self.root;
        let graphs = root.children.iter().filter(|child| child.tag == "nodegraph");
        let all = [root]
            .into_iter()
            .chain(graphs)
            .flat_map(|scope| scope.children.iter().map(move |e| (e.key(), scope.key())));
        let connected = |(element, scope): (Key<'a>, Key<'a>)| {
            let (element, scope) = (element.0, scope.0);
            let inputs = element.children.iter().filter(|_| element.tag != "nodegraph");
            let ends = inputs.chain([element]);
            // What is not defined is an error where it is used.
            let targets = ends.filter_map(|end| self.target(end, scope).ok().flatten());
            targets.map(|(element, scope)| (element.key(), scope.key())).collect()
        };
        let Some(circle) = cycle::find(all, connected) else {
            return Ok(());
        };
        let nodes: Vec<&Element> = circle.iter().map(|(element, _)| element.0).collect();
        let named = |e: &Element| e.attribute("name").unwrap_or(&e.tag).to_owned();
        let names: Vec<String> = nodes.iter().chain(&nodes[..1]).map(|e| named(e)).collect();
        Err(nodes[0].place.invalid(format!(
            "nodes are connected in a circle: {}; remove one of the connections",
            names.join(" -> ")
        )))
    }

    fn node(
        &mut self,
        node: &'a Element,
        scope: &'a Element,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        let mut input = |name: &'static str, default: f64| match self.index.child(node, name) {
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
                        let index =
                            self.index.child(node, "index").and_then(|i| i.attribute("value"));
                        channel_at(index.unwrap_or("0"))
                    }
                    "swizzle" => {
                        let names =
                            self.index.child(node, "channels").and_then(|c| c.attribute("value"));
                        names.and_then(channel_named)
                    }
                    // The output is already selected in `channel`.
                    _ => Some(channel),
                };
                match (channel, self.index.child(node, "in")) {
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
            self.index.child(node, "file").and_then(|file| match file.attribute("interfacename") {
                Some(name) => self.index.child(scope, name),
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
