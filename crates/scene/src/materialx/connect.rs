//! Connections of inputs and outputs, through graphs, their interfaces, and definitions.

use microfacet_baker::scene::SceneError;

use super::Reader;
use super::index::{At, Scope};
use crate::Result;
use crate::limits;
use crate::references::circle;
use crate::texture::Channel;
use crate::xml::Element;

/// Longer chains of outputs and interfaces than this are refused.
const MAX_STEPS: usize = 128;
/// Definitions that are used in each other's graphs more than this deep are refused.
const MAX_INSTANCES_DEEP: usize = 32;

/// A node that its definition's graph implements.
pub(super) struct Instance<'a> {
    at: At<'a>,
    definition: &'a Element,
    graph: &'a Element,
    depth: usize,
}

/// A node that an input is connected to, with the name of the node's output if that is said.
pub(super) type Source<'a> = (At<'a>, Option<&'a str>);

impl<'a> Reader<'a> {
    /// The input, output or node that an input or output in `scope` is connected to, with the scope
    /// of that; `None` if it has a value of its own.
    pub(super) fn target(&self, input: &'a Element, scope: Scope<'a>) -> Result<Option<At<'a>>> {
        if let Some(name) = input.attribute("interfacename") {
            let found = self.interface(scope, name);
            return found.map(Some).ok_or_else(|| undefined(input, "interface", name));
        }
        if let Some(name) = input.attribute("nodegraph") {
            let graph = self.index.child(self.root, name);
            let graph = graph.ok_or_else(|| undefined(input, "nodegraph", name))?;
            return self.output(input, graph).map(Some);
        }
        if let Some(name) = input.attribute("nodename") {
            let node = self.index.child(scope.graph, name);
            let node = node.ok_or_else(|| undefined(input, "node", name))?;
            return match &node.tag[..] {
                "nodegraph" => self.output(input, node).map(Some),
                _ => Ok(Some(At::new(node, scope))),
            };
        }
        // An output without a node or a graph is one of the document
        // (`PortElement::getConnectedOutput`).
        match input.attribute("output") {
            Some(name) if !name.is_empty() => self.output(input, self.root).map(Some),
            _ => Ok(None),
        }
    }

    /// The input that gives a graph in `scope` the value of its interface.
    fn interface(&self, scope: Scope<'a>, name: &'a str) -> Option<At<'a>> {
        let (graph, document) = (scope.graph, Scope::of(self.root));
        let instance = scope.instance.checked_sub(1).map(|number| &self.instances[number]);
        if let Some(instance) = instance.filter(|instance| instance.graph == graph) {
            if let Some(input) = self.index.given(instance.at.node, name) {
                return Some(At::new(input, instance.at.scope));
            }
            let default = self.index.child(instance.definition, name);
            return default
                .or_else(|| self.index.child(graph, name))
                .map(|input| At::new(input, document));
        }
        // An input in the document's own scope would refer to itself.
        if graph == self.root {
            return None;
        }
        let definition = || self.index.child(self.root, graph.attribute("nodedef")?);
        let input = self.index.child(graph, name);
        let input = input.or_else(|| self.index.child(definition()?, name))?;
        Some(At::new(input, document))
    }

    /// The output of `graph` that `input` is connected to, with its scope.
    fn output(&self, input: &'a Element, graph: &'a Element) -> Result<At<'a>> {
        let name = input.attribute("output").unwrap_or_default();
        let output = self.index.output(graph, name);
        output
            .map(|output| At::new(output, Scope::of(graph)))
            .ok_or_else(|| undefined(input, "output", name))
    }

    /// What a uniform input says, through interfaces; `None` if a node computes it.
    pub(super) fn said(&self, input: &'a Element, scope: Scope<'a>) -> Result<Option<&'a str>> {
        let mut end = At::new(input, scope);
        for _ in 0..MAX_STEPS {
            match self.target(end.node, end.scope)? {
                None => return Ok(end.node.attribute("value")),
                Some(next) if is_end(end.node, next.node) => end = next,
                Some(_) => return Ok(None),
            }
        }
        Err(too_long(input))
    }

    /// The node that an input or output is connected to; `None` if it has a value of its own.
    pub(super) fn resolve(
        &self,
        input: &'a Element,
        scope: Scope<'a>,
    ) -> Result<Option<Source<'a>>> {
        let mut end = At::new(input, scope);
        for _ in 0..MAX_STEPS {
            let Some(next) = self.target(end.node, end.scope)? else { return Ok(None) };
            if !is_end(end.node, next.node) {
                return Ok(Some((next, end.node.attribute("output"))));
            }
            end = next;
        }
        Err(too_long(input))
    }

    /// The scope of the graph that implements a node, if the document defines the node; the same
    /// scope for the same node.
    pub(super) fn enter(&mut self, at: At<'a>) -> Result<Option<Scope<'a>>> {
        let node = at.node;
        let Some(definition) = self.index.definition(node) else { return Ok(None) };
        let Some(graph) = self.index.implementation(definition) else { return Ok(None) };
        if let Some(&known) = self.entered.get(&at) {
            return Ok(Some(known));
        }
        self.count(node)?;
        let outer = at.scope.instance.checked_sub(1).map(|number| self.instances[number].depth);
        let depth = outer.unwrap_or(0) + 1;
        if depth > MAX_INSTANCES_DEEP {
            return Err(node.place.invalid(format!(
                "nodes are used in the graphs that define others more than {MAX_INSTANCES_DEEP} \
                 deep; is one a part of itself?"
            )));
        }
        self.instances.push(Instance { at, definition, graph, depth });
        let scope = Scope { graph, instance: self.instances.len() };
        self.entered.insert(at, scope);
        Ok(Some(scope))
    }

    pub(super) fn count(&self, node: &Element) -> Result<()> {
        if self.left.take(1) {
            return Ok(());
        }
        Err(node.place.invalid(format!(
            "the materials have more than {} nodes in all; split the document",
            limits::NODES
        )))
    }

    /// The output of a node that the document defines, in the graph that implements it.
    pub(super) fn implemented(
        &mut self,
        at: At<'a>,
        output: Option<&'a str>,
    ) -> Result<Option<At<'a>>> {
        let Some(scope) = self.enter(at)? else { return Ok(None) };
        let name = output.unwrap_or_default();
        let found = self.index.output(scope.graph, name);
        // A graph with one output may give it another name than its definition does.
        let found = found.or_else(|| self.index.output(scope.graph, ""));
        Ok(found.map(|output| At::new(output, scope)))
    }

    /// Warns of nodes that are connected in a circle; what depends on them is not understood.
    pub(super) fn check_circles(&mut self) {
        let root = self.root;
        let graphs = root.children.iter().filter(|child| child.tag == "nodegraph");
        let all = [root]
            .into_iter()
            .chain(graphs)
            .flat_map(|graph| graph.children.iter().map(|e| At::new(e, Scope::of(graph))));
        let connected = |At { node, scope }: At<'a>| {
            let inputs = node.children.iter().filter(|_| node.tag != "nodegraph");
            // What is not defined is an error where it is used.
            let target = |end| self.target(end, scope).ok().flatten();
            inputs.chain([node]).filter_map(target).collect()
        };
        let Some(circle) = circle(all, connected) else { return };
        let nodes: Vec<&Element> = circle.iter().map(|at| at.node).collect();
        let names: Vec<&str> = nodes.iter().chain(&nodes[..1]).map(|node| named(node)).collect();
        let message = format!(
            "nodes are connected in a circle: {}; remove one of the connections",
            names.join(" -> ")
        );
        self.builder.warn(&nodes[0].place, message);
        self.circle = circle.into_iter().collect();
    }
}

/// Whether the target of `from` is an input or output, which is connected further, and no node.
pub(super) fn is_end(from: &Element, to: &Element) -> bool {
    to.tag == "output" || from.attribute("interfacename").is_some()
}

/// The name of an element, or else its tag.
pub(super) fn named(element: &Element) -> &str {
    element.attribute("name").filter(|name| !name.is_empty()).unwrap_or(&element.tag)
}

/// The channel that a connection selects: by "channels" before MaterialX 1.39, later by the output
/// of a node that separates channels.
pub(super) fn selected(input: &Element, channel: Channel) -> Channel {
    let of_node = input.attribute("output").filter(|_| input.attribute("nodename").is_some());
    let taken = input.attribute("channels").or(of_node);
    taken.and_then(|names| channel_named(names, channel)).unwrap_or(channel)
}

/// The channel at the index of `channel` in names such as "r", "xyz" or "outx".
pub(super) fn channel_named(names: &str, channel: Channel) -> Option<Channel> {
    let letters = names.strip_prefix("out").unwrap_or(names);
    // A longer word is the name of an output with several channels, or is unknown.
    if letters.len() > 4 {
        return None;
    }
    let all: Option<Vec<Channel>> = letters
        .chars()
        .map(|letter| match letter {
            'r' | 'x' => Some(Channel::Red),
            'g' | 'y' => Some(Channel::Green),
            'b' | 'z' => Some(Channel::Blue),
            'a' | 'w' => Some(Channel::Alpha),
            _ => None,
        })
        .collect();
    let all = all?;
    all.get(place(channel)).or(all.last()).copied()
}

/// The index of a channel in a colour or a vector; 0 for a channel computed from several.
pub(super) fn place(channel: Channel) -> usize {
    match channel {
        Channel::Red | Channel::Luminance | Channel::AlphaOrMean => 0,
        Channel::Green => 1,
        Channel::Blue => 2,
        Channel::Alpha => 3,
    }
}

fn too_long(input: &Element) -> SceneError {
    input.place.invalid(format!(
        "the connection passes more than {MAX_STEPS} outputs and interfaces; is it a circle?"
    ))
}

fn undefined(input: &Element, what: &str, name: &str) -> SceneError {
    input.place.invalid(format!(
        "input \"{}\": there is no {what} \"{name}\"",
        input.attribute("name").unwrap_or_default()
    ))
}
