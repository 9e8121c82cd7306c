//! XML as a tree of elements with their places, for the readers of Mitsuba and MaterialX.
//!
//! The parsers of renderers check no namespaces, take a raw "<" or "&" in an attribute as a
//! character, and accept a declaration anywhere. Documents of MaterialX have all of these: prefixes
//! that nothing declares, tokens such as `<UDIM>` in file names, "this & that" in a description,
//! and a space before `<?xml`. So these documents are read, and so is what the parser does not
//! check: characters and names that XML does not have, attributes without a space between them, and
//! a document type. One that declares entities is refused, since their values would be left out.

use std::collections::HashSet;
use std::hash::{Hash, Hasher};
use std::io;
use std::path::Path;

use quick_xml::Error;
use quick_xml::escape::unescape;
use quick_xml::events::attributes::AttrError;
use quick_xml::events::{BytesStart, Event};

use microfacet_baker::scene::{Lines, Place, SceneError, SceneErrorKind};

use crate::Result;
use crate::builder::{Builder, shortened};
use crate::include::Includes;
use crate::limits::{self, Budget};

/// An element, without text, comments and namespaces. An element equals only itself.
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
    /// `None`, with a warning that ends with `said`, if the file is missing or not well formed.
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
                    if open.len() == limits::XML_DEPTH {
                        return Err(too_deep(&place));
                    }
                    open.push(self.element(&tag, start, &lines)?);
                }
                Event::End(_) => {
                    let Some(mut ended) = open.pop() else { continue };
                    // Most have few children; capacity for four takes more than the element.
                    ended.children.shrink_to_fit();
                    match open.last_mut() {
                        Some(outer) => outer.children.push(ended),
                        None => root = Some(ended),
                    }
                }
                Event::Eof => {
                    if let Some(Element { tag, place, .. }) = open.last() {
                        return Err(place.syntax(format!("<{tag}> has no end")));
                    }
                    return root.ok_or_else(|| lines.place(0).syntax("there is no element"));
                }
                Event::DocType(text) if declares_entities(&text) => {
                    let why = "the document type declares entities, which are not read; write what \
                               they stand for in their places";
                    return Err(lines.place(start).syntax(why));
                }
                Event::Text(_) | Event::CData(_) | Event::GeneralRef(_) if open.is_empty() => {
                    let text = &text[start..xml.buffer_position() as usize];
                    let blank = text.len() - text.trim_ascii_start().len();
                    if blank < text.len() {
                        let place = lines.place(start + blank);
                        return Err(place.syntax("text stands outside the root element"));
                    }
                }
                _ => {}
            }
        }
    }

    /// An element that begins at `start`, without its children.
    fn element(&self, tag: &BytesStart<'_>, start: usize, lines: &Lines<'_>) -> Result<Element> {
        let place = lines.place(start);
        // Offsets in the tag count from after its bracket.
        let inside = |offset: usize| lines.place(start + 1 + offset);
        let place_of = |part: &str| inside(part.as_ptr().addr() - tag.as_ptr().addr());
        let name = tag.local_name().into_inner().to_owned();
        if name.is_empty() {
            return Err(inside(0).syntax("an element has no name"));
        }
        let mut attributes = Vec::new();
        let mut names = HashSet::new();
        self.take(&place)?;
        // The parser's own check for duplicates compares each attribute with each.
        for attribute in tag.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| {
                let why = error.to_string();
                let why = why.split_once(": ").map_or(&why[..], |(_, why)| why);
                inside(offset(&error)).syntax(why)
            })?;
            self.take(&place)?;
            let key = attribute.key.into_inner();
            if !names.insert(key) {
                let (name, second) = (shortened(&name), shortened(key));
                let why =
                    format!("<{name}> has a second attribute \"{second}\"; remove one of them");
                return Err(place_of(key).syntax(why));
            }
            if attribute.key.as_namespace_binding().is_none() {
                let name = attribute.key.local_name().into_inner().to_owned();
                if name.is_empty() {
                    return Err(place_of(key).syntax("an attribute has no name"));
                }
                attributes.push((name, unescaped(&attribute.value)));
            }
        }
        attributes.shrink_to_fit();
        Ok(Element { tag: name, attributes, children: Vec::new(), place })
    }

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

fn offset(error: &AttrError) -> usize {
    match *error {
        AttrError::ExpectedEq(offset)
        | AttrError::ExpectedValue(offset)
        | AttrError::UnquotedValue(offset)
        | AttrError::ExpectedQuote(offset, _)
        | AttrError::Duplicated(offset, _) => offset,
    }
}

/// Whether a document type has entities, of its own or of another file.
fn declares_entities(text: &str) -> bool {
    ["<!ENTITY", "SYSTEM", "PUBLIC"].iter().any(|word| text.contains(word))
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

/// Whether the error is in the text of a file: in its grammar, or because it is no UTF-8.
fn is_malformed(error: &SceneError) -> bool {
    match &error.kind {
        SceneErrorKind::Syntax(_) => true,
        SceneErrorKind::Io(why) => why.kind() == io::ErrorKind::InvalidData,
        _ => false,
    }
}

pub(super) fn too_deep(place: &Place) -> SceneError {
    place.syntax(format!("elements are nested more than {} deep", limits::XML_DEPTH))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Reader, unescaped};

    #[test]
    fn an_element_has_no_spare_room() {
        let root = Reader::new().root(Path::new("a.xml"), b"<a><b c='1'/></a>".to_vec()).unwrap();
        assert_eq!(root.children.capacity(), 1);
        assert_eq!(root.children[0].attributes.capacity(), 1);
    }

    #[test]
    fn an_ampersand_may_begin_a_reference() {
        assert_eq!(unescaped("&amp;&lt;&gt;&quot;&apos;&#38;&#x26;&#xaF;é"), "&<>\"'&&¯é");
        let raw = "& &&nbsp;&amp &#;&#x;&#38&#3a;&#xg;&ampere;&";
        assert_eq!(unescaped(raw), raw);
        assert_eq!(unescaped("a\r\nb\tc\n&amp;"), "a b c &");
    }
}
