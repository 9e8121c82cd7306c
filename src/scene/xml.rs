//! XML as a tree of owned elements with their places, shared by the readers of Mitsuba and
//! MaterialX.

use std::fs;
use std::path::Path;

use roxmltree::{Document, Node};

use super::error::Lines;
use super::{Place, SceneError};

/// Deeper nesting than this is refused as a mistake, which bounds the stack for the recursion.
const MAX_DEPTH: usize = 256;

/// An element, without text, comments and namespaces.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) tag: String,
    pub(super) attributes: Vec<(String, String)>,
    pub(super) children: Vec<Element>,
    pub(super) place: Place,
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find_map(|(key, value)| (key == name).then_some(&value[..]))
    }

    /// The attribute `name`, whose absence is an error.
    pub(super) fn required(&self, name: &str) -> Result<&str, SceneError> {
        self.attribute(name)
            .ok_or_else(|| self.place.syntax(format!("<{}> has no attribute \"{name}\"", self.tag)))
    }

    /// The child element whose attribute "name" is `name`.
    pub(super) fn child_named(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.attribute("name") == Some(name))
    }

    /// Calls `visit` for this element and all its descendants, in document order.
    pub(super) fn walk<'a>(&'a self, visit: &mut impl FnMut(&'a Element)) {
        visit(self);
        for child in &self.children {
            child.walk(visit);
        }
    }
}

/// Reads the root element of an XML file.
pub(super) fn read(file: &Path) -> Result<Element, SceneError> {
    let place = Place::file(file);
    let text = fs::read_to_string(file).map_err(|error| place.io(error))?;
    let document = Document::parse(&text).map_err(|error| {
        let at = error.pos();
        Place { line: Some(at.row), column: Some(at.col), ..place }
            // The message has the place before it already.
            .syntax(error.to_string().trim_end_matches(&format!(" at {at}")))
    })?;
    element(document.root_element(), &Lines::new(file, &text), 0)
}

fn element(node: Node<'_, '_>, lines: &Lines, depth: usize) -> Result<Element, SceneError> {
    let place = lines.place(node.range().start);
    if depth == MAX_DEPTH {
        return Err(place.syntax(format!("elements are nested more than {MAX_DEPTH} deep")));
    }
    Ok(Element {
        tag: node.tag_name().name().to_owned(),
        attributes: node
            .attributes()
            .map(|attribute| (attribute.name().to_owned(), attribute.value().to_owned()))
            .collect(),
        children: node
            .children()
            .filter(Node::is_element)
            .map(|child| element(child, lines, depth + 1))
            .collect::<Result<_, _>>()?,
        place,
    })
}
