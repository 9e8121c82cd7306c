//! XML as a tree of owned elements with their places, shared by the readers of Mitsuba and
//! MaterialX.

mod mended;

use std::hash::{Hash, Hasher};
use std::io;
use std::path::Path;

use mended::Mended;
use roxmltree::{Document, Node, ParsingOptions};

use microfacet_baker::input;
use microfacet_baker::scene::{Lines, Place, SceneError, SceneErrorKind};

use super::builder::Builder;
use super::include::{Includes, absent};
use crate::limits;
use crate::limits::Budget;

/// Deeper nesting than this is refused as a mistake, which bounds the stack for the recursion.
pub(super) const MAX_DEPTH: usize = 256;

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
        self.attribute(name).ok_or_else(|| {
            self.place.invalid(format!("<{}> has no attribute \"{name}\"", self.tag))
        })
    }

    /// The child element whose attribute "name" is `name`.
    pub(super) fn child_named(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.attribute("name") == Some(name))
    }

    /// The element as a key, distinguished by its address.
    pub(super) fn key(&self) -> Key<'_> {
        Key(self)
    }

    /// Calls `visit` for this element and all its descendants, in document order.
    pub(super) fn walk<'a>(&'a self, visit: &mut impl FnMut(&'a Element)) {
        visit(self);
        for child in &self.children {
            child.walk(visit);
        }
    }
}

/// An element that equals itself alone.
#[derive(Clone, Copy)]
pub(super) struct Key<'a>(pub(super) &'a Element);

impl PartialEq for Key<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Key<'_> {}

impl Hash for Key<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::from_ref(self.0).hash(state);
    }
}

/// Reads XML files of one scene, which share the limits of size.
pub(super) struct Reader {
    pub(super) includes: Includes,
    nodes: Budget,
    values: Budget,
}

impl Reader {
    pub(super) fn new() -> Self {
        Self {
            includes: Includes::new(limits::XML),
            nodes: Budget::new(limits::XML_NODES),
            values: Budget::new(limits::XML_VALUES),
        }
    }

    /// Reads the root element of the scene's own file.
    pub(super) fn open(&mut self, file: &Path) -> Result<Element, SceneError> {
        let place = Place::file(file);
        // A folder, which is no error of an include here.
        input::open(file, u64::MAX).map_err(|error| place.io(error))?;
        self.includes.enter(file, &place)?;
        self.read(file, &place)
    }

    /// Reads the root element of a file that `place` includes under a name, to be followed by
    /// [`Includes::leave`].
    ///
    /// `None` if there is no such file or it is not well formed: then a warning says so, and what
    /// follows from it, and the rest of the scene is still read.
    pub(super) fn include(
        &mut self,
        (name, file): (&str, &Path),
        place: &Place,
        builder: &mut Builder,
        said: &str,
    ) -> Result<Option<Element>, SceneError> {
        let why = if self.includes.enter(file, place)? {
            match self.read(file, place) {
                Err(error) if is_malformed(&error) => {
                    self.includes.leave();
                    format!("{name} is not well formed: {error}")
                }
                read => return read.map(Some),
            }
        } else {
            absent(name, file)
        };
        builder.warn(place, format!("{why}; {said}"));
        Ok(None)
    }

    /// Reads the root element of a file that `place` asks for.
    fn read(&mut self, file: &Path, place: &Place) -> Result<Element, SceneError> {
        let source = self.includes.text(file, place)?;
        let lines = Lines::new(file, source.as_bytes());
        let mut text = Mended::new(&source);
        loop {
            let attributes = check_attributes(&text, &lines)?;
            let nodes_limit = u32::try_from(self.nodes.left()).unwrap_or(u32::MAX);
            let options = ParsingOptions { nodes_limit, ..ParsingOptions::default() };
            let error = match Document::parse_with_options(text.text(), options) {
                Ok(document) => {
                    if !self.values.take(attributes) {
                        return Err(Place::file(file).too_large(format!(
                            "the scene has more than {} attributes; load a file that has the \
                             materials alone",
                            limits::XML_VALUES
                        )));
                    }
                    self.nodes.take(document.descendants().count() as u64);
                    return element(document.root_element(), &text, &lines, 0);
                }
                Err(error) => error,
            };
            if matches!(error, roxmltree::Error::NodesLimitReached) {
                return Err(Place::file(file).too_large(format!(
                    "the scene has more than {} elements, comments and texts; load a file that has \
                     the materials alone",
                    limits::XML_NODES
                )));
            }
            if !text.mend(&error) {
                // The message has the place before it already.
                let at = format!(" at {}", error.pos());
                return Err(lines
                    .place(text.offset(error.pos()))
                    .syntax(error.to_string().trim_end_matches(&at)));
            }
            // Parsing once more counts as much as reading once more.
            self.includes.charge(source.len(), place)?;
        }
    }
}

/// Whether the error is one of the text in a file: of its grammar, or that it is none.
fn is_malformed(error: &SceneError) -> bool {
    match &error.kind {
        SceneErrorKind::Syntax(_) => true,
        SceneErrorKind::Io(why) => why.kind() == io::ErrorKind::InvalidData,
        _ => false,
    }
}

/// Checks what the parser takes quadratic time for, and counts the attributes, at least.
fn check_attributes(text: &Mended<'_>, lines: &Lines<'_>) -> Result<u64, SceneError> {
    // No attribute holds this character, so that a piece has one element at most; each of its
    // attributes has two quotes.
    let (mut start, mut all) = (0, 0);
    for piece in text.text().split('<') {
        let quotes = piece.bytes().filter(|byte| matches!(byte, b'"' | b'\'')).count();
        if quotes > 2 * limits::XML_ATTRIBUTES {
            return Err(lines.place(text.original(start)).too_large(format!(
                "there are {quotes} quotes before the next \"<\"; an element may have {} attributes",
                limits::XML_ATTRIBUTES
            )));
        }
        start += piece.len() + 1;
        all += quotes as u64;
    }
    match text.text().match_indices("xmlns").nth(limits::XML_NAMESPACES) {
        Some((at, _)) => Err(lines.place(text.original(at)).too_large(format!(
            "the file declares more than {} namespaces; declare each once",
            limits::XML_NAMESPACES
        ))),
        None => Ok(all / 2),
    }
}

fn element(
    node: Node<'_, '_>,
    text: &Mended<'_>,
    lines: &Lines<'_>,
    depth: usize,
) -> Result<Element, SceneError> {
    let place = lines.place(text.original(node.range().start));
    if depth == MAX_DEPTH {
        return Err(too_deep(&place));
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
            .map(|child| element(child, text, lines, depth + 1))
            .collect::<Result<_, _>>()?,
        place,
    })
}

/// The error for elements that are nested more than [`MAX_DEPTH`] deep.
pub(super) fn too_deep(place: &Place) -> SceneError {
    place.syntax(format!("elements are nested more than {MAX_DEPTH} deep"))
}
