//! XML as a tree of owned elements with their places, shared by the readers of Mitsuba and
//! MaterialX.
//!
//! The parsers of renderers check no namespaces, take a raw "<" or "&" in an attribute as a
//! character, and a declaration wherever it stands. Documents of MaterialX have all of these:
//! prefixes that nothing declares, tokens such as `<UDIM>` in file names, "this & that" in a
//! description, and a space before `<?xml`. So they are read here, too.

use std::hash::{Hash, Hasher};
use std::io;
use std::path::Path;

use quick_xml::Error;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};

use microfacet_baker::scene::{Lines, Place, SceneError, SceneErrorKind};

use crate::Result;
use crate::builder::Builder;
use crate::include::Includes;
use crate::limits::{self, Budget};

/// An element, without text, comments and namespaces. It equals itself alone.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) tag: String,
    pub(super) attributes: Vec<(String, String)>,
    pub(super) children: Vec<Element>,
    pub(super) place: Place,
}

impl PartialEq for Element {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Element {}

impl Hash for Element {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::from_ref(self).hash(state);
    }
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find_map(|(key, value)| (key == name).then_some(&value[..]))
    }

    /// The attribute `name`, whose absence is an error.
    pub(super) fn required(&self, name: &str) -> Result<&str> {
        self.attribute(name).ok_or_else(|| {
            self.place.invalid(format!("<{}> has no attribute \"{name}\"", self.tag))
        })
    }

    /// The child element whose attribute "name" is `name`.
    pub(super) fn child_named(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.attribute("name") == Some(name))
    }

    /// This element and all its descendants of a tag, in document order.
    pub(super) fn all(&self, tag: &str) -> Vec<&Element> {
        let mut found = Vec::new();
        self.walk(&mut |element| found.extend(Some(element).filter(|it| it.tag == tag)));
        found
    }

    /// Calls `visit` for this element and all its descendants, in document order.
    pub(super) fn walk<'a>(&'a self, visit: &mut impl FnMut(&'a Element)) {
        visit(self);
        for child in &self.children {
            child.walk(visit);
        }
    }
}

/// Reads XML files of one scene, which share the limits of size.
pub(super) struct Reader {
    pub(super) includes: Includes,
    /// Elements and attributes.
    parts: Budget,
}

impl Reader {
    pub(super) fn new() -> Self {
        Self { includes: Includes::new(limits::TEXT), parts: Budget::new(limits::XML_PARTS) }
    }

    /// Reads the root element of the scene's own file, which has one of these tags.
    pub(super) fn open(&mut self, file: &Path, tags: &[&str], of: &str) -> Result<Element> {
        let text = self.includes.open(file)?;
        let root = self.root(file, text)?;
        if tags.contains(&&root.tag[..]) {
            return Ok(root);
        }
        let tag = &root.tag;
        Err(root.place.foreign(format!("<{tag}> is not the root of {of}; expected <{}>", tags[0])))
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
    ) -> Result<Option<Element>> {
        let text = self.includes.include((name, file), place, builder, said)?;
        let Some(text) = text else { return Ok(None) };
        match self.root(file, text) {
            Err(error) if is_malformed(&error) => {
                self.includes.leave();
                builder.warn(place, format!("{name} is not well formed: {error}; {said}"));
                Ok(None)
            }
            read => read.map(Some),
        }
    }

    /// The root element of a text.
    fn root(&self, file: &Path, text: Vec<u8>) -> Result<Element> {
        let text = String::from_utf8(text).map_err(|_| {
            let why = "is no text in UTF-8";
            Place::file(file).io(io::Error::new(io::ErrorKind::InvalidData, why))
        })?;
        let lines = Lines::new(file, text.as_bytes());
        let mut xml = quick_xml::Reader::from_str(&text);
        xml.config_mut().expand_empty_elements = true;
        xml.config_mut().allow_dangling_amp = true;
        // From the root to the innermost element.
        let mut open: Vec<Element> = Vec::new();
        let mut root = None;
        loop {
            let start = xml.buffer_position() as usize;
            let event = xml.read_event().map_err(|error| {
                let why = match error {
                    Error::Syntax(why) => why.to_string(),
                    Error::IllFormed(why) => why.to_string(),
                    other => other.to_string(),
                };
                lines.place(xml.error_position() as usize).syntax(why)
            })?;
            match event {
                Event::Start(tag) => {
                    let place = lines.place(start);
                    if open.is_empty() && root.is_some() {
                        return Err(place.syntax("a second element follows the root"));
                    }
                    if open.len() == limits::DEPTH {
                        return Err(too_deep(&place));
                    }
                    open.push(self.element(&tag, place)?);
                }
                Event::End(_) => {
                    let ended = open.pop();
                    match open.last_mut() {
                        Some(outer) => outer.children.extend(ended),
                        None => root = ended,
                    }
                }
                Event::Eof => {
                    if let Some(Element { tag, place, .. }) = open.last() {
                        return Err(place.syntax(format!("<{tag}> has no end")));
                    }
                    return root.ok_or_else(|| lines.place(0).syntax("there is no element"));
                }
                _ => {}
            }
        }
    }

    /// An element that begins here, without its children.
    fn element(&self, tag: &BytesStart<'_>, place: Place) -> Result<Element> {
        let mut attributes = Vec::new();
        self.take(&place)?;
        // The checks compare each with each.
        for attribute in tag.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| place.syntax(error.to_string()))?;
            self.take(&place)?;
            if attribute.key.as_namespace_binding().is_none() {
                let name = attribute.key.local_name().into_inner().to_owned();
                attributes.push((name, unescaped(&attribute.value)));
            }
        }
        let tag = tag.local_name().into_inner().to_owned();
        Ok(Element { tag, attributes, children: Vec::new(), place })
    }

    /// Counts an element or an attribute.
    fn take(&self, place: &Place) -> Result<()> {
        if self.parts.take(1) {
            return Ok(());
        }
        Err(place.too_large(format!(
            "the scene has more than {} elements and attributes; load a file that has the \
             materials alone",
            limits::XML_PARTS
        )))
    }
}

/// The value of an attribute, in which an ampersand that begins no reference stands for itself.
fn unescaped(value: &str) -> String {
    let value = value.replace("\r\n", " ").replace(['\t', '\n', '\r'], " ");
    let mut parts = value.split('&');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let reference = part.split_once(';').and_then(|(name, rest)| {
            let character = unescape(&format!("&{name};")).ok()?.into_owned();
            Some(character + rest)
        });
        match reference {
            Some(replaced) => text += &replaced,
            None => {
                text.push('&');
                text += part;
            }
        }
    }
    text
}

/// Whether the error is one of the text in a file: of its grammar, or that it is none.
fn is_malformed(error: &SceneError) -> bool {
    match &error.kind {
        SceneErrorKind::Syntax(_) => true,
        SceneErrorKind::Io(why) => why.kind() == io::ErrorKind::InvalidData,
        _ => false,
    }
}

/// The error for elements that are nested too deep.
pub(super) fn too_deep(place: &Place) -> SceneError {
    place.syntax(format!("elements are nested more than {} deep", limits::DEPTH))
}

#[cfg(test)]
mod tests {
    use super::unescaped;

    #[test]
    fn an_ampersand_may_begin_a_reference() {
        assert_eq!(unescaped("&amp;&lt;&gt;&quot;&apos;&#38;&#x26;&#xaF;é"), "&<>\"'&&¯é");
        let raw = "& &&nbsp;&amp &#;&#x;&#38&#3a;&#xg;&ampere;&";
        assert_eq!(unescaped(raw), raw);
        assert_eq!(unescaped("a\r\nb\tc\n&amp;"), "a b c &");
    }
}
