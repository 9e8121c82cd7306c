//! Elements of a document by their names, and the scopes in which names are looked up.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use crate::xml::Element;

/// The attributes of each document's root, which hold for its whole content, by file.
pub(super) type Headers = HashMap<Arc<Path>, Vec<(String, String)>>;

/// A node with the scope in which the names of its connections are looked up.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct At<'a> {
    pub(super) node: &'a Element,
    pub(super) scope: Scope<'a>,
}

impl<'a> At<'a> {
    pub(super) fn new(node: &'a Element, scope: Scope<'a>) -> Self {
        Self { node, scope }
    }
}

/// A graph or the document, and which of the graph's instances is meant.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Scope<'a> {
    pub(super) graph: &'a Element,
    /// Number of the instance that the graph implements, from 1; 0 if it implements none.
    pub(super) instance: usize,
}

impl<'a> Scope<'a> {
    /// A graph that is used as it is, or the document.
    pub(super) fn of(graph: &'a Element) -> Self {
        Self { graph, instance: 0 }
    }
}

/// Elements of a document by their names; the first of a name counts.
pub(super) struct Index<'a> {
    root: &'a Element,
    headers: &'a Headers,
    children: HashMap<(&'a Element, &'a str), &'a Element>,
    /// As `children`, but outputs only; the first output is also under the empty name.
    outputs: HashMap<(&'a Element, &'a str), &'a Element>,
    /// The first `nodedef` by node and by type of output; "" stands for any type.
    definitions: HashMap<(&'a str, &'a str), &'a Element>,
    /// The graphs that implement definitions, by the name of the `nodedef`.
    implementations: HashMap<&'a str, &'a Element>,
}

impl<'a> Index<'a> {
    pub(super) fn new(root: &'a Element, headers: &'a Headers) -> Self {
        let mut index = Self {
            root,
            headers,
            children: HashMap::new(),
            outputs: HashMap::new(),
            definitions: HashMap::new(),
            implementations: HashMap::new(),
        };
        root.walk(&mut |element| {
            for child in &element.children {
                if let Some(name) = child.attribute("name") {
                    let key = (element, name);
                    index.children.entry(key).or_insert(child);
                    if child.tag == "output" {
                        index.outputs.entry(key).or_insert(child);
                    }
                }
                if child.tag == "output" {
                    index.outputs.entry((element, "")).or_insert(child);
                }
            }
        });
        index.define();
        index
    }

    fn define(&mut self) {
        for child in &self.root.children {
            match (&child.tag[..], child.attribute("nodedef")) {
                ("nodedef", _) => {
                    let Some(node) = child.attribute("node") else { continue };
                    let outputs = child.children.iter().filter(|part| part.tag == "output");
                    let types = outputs.chain([child]).filter_map(|part| part.attribute("type"));
                    for of_type in types.chain([""]) {
                        self.definitions.entry((node, of_type)).or_insert(child);
                    }
                }
                ("nodegraph", Some(definition)) => {
                    self.implementations.entry(definition).or_insert(child);
                }
                ("implementation", Some(definition)) => {
                    let graph = child.attribute("nodegraph");
                    if let Some(graph) = graph.and_then(|name| self.child(self.root, name)) {
                        self.implementations.entry(definition).or_insert(graph);
                    }
                }
                _ => {}
            }
        }
    }

    pub(super) fn child(&self, element: &'a Element, name: &'a str) -> Option<&'a Element> {
        self.children.get(&(element, name)).copied()
    }

    /// The child `name`, if it has a value or a connection; else the default of its node holds.
    pub(super) fn given(&self, element: &'a Element, name: &'a str) -> Option<&'a Element> {
        let says = ["value", "nodename", "nodegraph", "interfacename", "output"];
        let says = |input: &&Element| says.iter().any(|name| input.attribute(name).is_some());
        self.child(element, name).filter(says)
    }

    /// The output of a graph; the first if the name is empty.
    pub(super) fn output(&self, graph: &'a Element, name: &'a str) -> Option<&'a Element> {
        self.outputs.get(&(graph, name)).copied()
    }

    /// The `nodedef` of that name, if the document has it.
    pub(super) fn nodedef(&self, name: &'a str) -> Option<&'a Element> {
        self.child(self.root, name).filter(|found| found.tag == "nodedef")
    }

    /// The `nodedef` of a node, if the document has it.
    pub(super) fn definition(&self, node: &'a Element) -> Option<&'a Element> {
        if let Some(name) = node.attribute("nodedef") {
            return self.nodedef(name);
        }
        let of = |of_type| self.definitions.get(&(&node.tag[..], of_type)).copied();
        of(node.attribute("type").unwrap_or_default()).or_else(|| of(""))
    }

    /// The graphs that implement some `nodedef`.
    pub(super) fn implementing(&self) -> HashSet<&'a Element> {
        self.implementations.values().copied().collect()
    }

    /// The graph that implements a `nodedef`.
    pub(super) fn implementation(&self, definition: &'a Element) -> Option<&'a Element> {
        self.implementations.get(definition.attribute("name")?).copied()
    }

    /// An attribute that holds for an element and all inside it: that of the innermost of
    /// `elements` that has it, or else that of the root of its document.
    pub(super) fn inherited(&self, elements: &[&'a Element], name: &str) -> Option<&'a str> {
        // The root is that of the including document; the others' attributes are in `headers`.
        let mut inside = elements.iter().filter(|&&element| element != self.root);
        let own = inside.find_map(|element| element.attribute(name));
        own.or_else(|| {
            let header = self.headers.get(&elements.first()?.place.file)?;
            header.iter().find_map(|(key, value)| (key == name).then_some(&value[..]))
        })
    }
}
