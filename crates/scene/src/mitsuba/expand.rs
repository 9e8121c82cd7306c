//! Included files, and values in place of parameters.

use std::collections::BTreeMap;
use std::ops::Bound;
use std::path::{Path, PathBuf};

use microfacet_baker::scene::SceneError;

use super::find;
use crate::builder::Builder;
use crate::xml::Element;
use crate::{limits, xml};

/// Replaces each `<include>` by its content, and `$name` by its value.
pub(super) struct Expansion<'a> {
    builder: &'a mut Builder,
    pub(super) xml: xml::Reader,
    defaults: BTreeMap<String, String>,
    /// Folders in which files are looked up: the scene's own, then those of `<path>`.
    pub(super) folders: Vec<PathBuf>,
    /// Whether something that is included is not seen.
    pub(super) incomplete: bool,
}

impl<'a> Expansion<'a> {
    /// Of a scene in `folder`.
    pub(super) fn new(folder: &Path, builder: &'a mut Builder) -> Self {
        Self {
            builder,
            xml: xml::Reader::new(),
            defaults: BTreeMap::new(),
            folders: vec![folder.to_owned()],
            incomplete: false,
        }
    }

    pub(super) fn element(
        &mut self,
        element: &mut Element,
        depth: usize,
    ) -> Result<(), SceneError> {
        if depth == xml::MAX_DEPTH {
            return Err(xml::too_deep(&element.place));
        }
        self.substitute(element)?;
        match &element.tag[..] {
            "default" => {
                let both =
                    element.required("name").and_then(|n| Ok((n, element.required("value")?)));
                let Some((name, value)) = self.or_left_out(both)? else { return Ok(()) };
                if self.defaults.len() == limits::DEFAULTS && !self.defaults.contains_key(name) {
                    return Err(element.place.too_large(format!(
                        "the scene has more than {} <default> parameters; write values in place of \
                         some",
                        limits::DEFAULTS
                    )));
                }
                self.defaults.entry(name.to_owned()).or_insert_with(|| value.to_owned());
            }
            "path" => {
                if self.folders.len() > limits::FOLDERS {
                    return Err(element.place.too_large(format!(
                        "the scene has more than {} <path> folders; keep its files in fewer",
                        limits::FOLDERS
                    )));
                }
                let Some(value) = self.or_left_out(element.required("value"))? else {
                    return Ok(());
                };
                self.folders.push(self.folders[0].join(value));
            }
            _ => {}
        }
        for mut child in std::mem::take(&mut element.children) {
            if child.tag == "include" {
                element.children.extend(self.include(&mut child, depth + 1)?);
            } else {
                self.element(&mut child, depth + 1)?;
                element.children.push(child);
            }
        }
        Ok(())
    }

    fn include(&mut self, element: &mut Element, depth: usize) -> Result<Vec<Element>, SceneError> {
        self.substitute(element)?;
        let Some(name) = self.or_left_out(element.required("filename"))? else {
            self.incomplete = true;
            return Ok(Vec::new());
        };
        let path = find(&self.folders, name);
        let said = "its materials are not seen, and all others count as used";
        let root = self.xml.include((name, &path), &element.place, self.builder, said)?;
        let Some(mut root) = root else {
            self.incomplete = true;
            return Ok(Vec::new());
        };
        self.element(&mut root, depth)?;
        self.xml.includes.leave();
        Ok(if root.tag == "scene" { root.children } else { vec![root] })
    }

    /// What was read of an element; `None`, with a warning, if it says too little to be of use.
    fn or_left_out<T>(&mut self, read: Result<T, SceneError>) -> Result<Option<T>, SceneError> {
        self.builder.or_warn(read.map(Some), (None, "it is left out"))
    }

    /// Replaces each `$name` in the attributes by its value, the longest name that is known.
    fn substitute(&self, element: &mut Element) -> Result<(), SceneError> {
        for (_, value) in &mut element.attributes {
            if value.contains('$') {
                let mut parts = value.split('$');
                let mut replaced = parts.next().unwrap_or_default().to_owned();
                for part in parts {
                    match self.default(part) {
                        Some((name, value)) => {
                            self.xml.includes.charge(value.len(), &element.place)?;
                            replaced.push_str(value);
                            replaced.push_str(&part[name.len()..]);
                        }
                        None => {
                            replaced.push('$');
                            replaced.push_str(part);
                        }
                    }
                }
                *value = replaced;
            }
        }
        Ok(())
    }

    /// The longest name that `text` begins with, and its value.
    fn default(&self, mut text: &str) -> Option<(&str, &str)> {
        loop {
            // What `text` begins with does not sort after it, and shorter ones before longer ones.
            let range = (Bound::Unbounded, Bound::Included(text));
            let (name, value) = self.defaults.range::<str, _>(range).next_back()?;
            if text.starts_with(&name[..]) {
                return Some((name, value));
            }
            // Nor is anything longer than what both begin with a beginning of it.
            let same = text.chars().zip(name.chars()).take_while(|(a, b)| a == b);
            text = &text[..same.map(|(a, _)| a.len_utf8()).sum()];
        }
    }
}
