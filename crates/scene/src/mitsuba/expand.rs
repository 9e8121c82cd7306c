//! Included files, and the values of parameters (`$name`).

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::find;
use crate::Result;
use crate::builder::Builder;
use crate::xml::Element;
use crate::{limits, xml};

/// Bytes of the longest name of a parameter.
const LONGEST: usize = 64;

/// Replaces each `<include>` by its content, and `$name` by its value.
pub(super) struct Expansion<'a> {
    builder: &'a mut Builder,
    pub(super) xml: xml::Reader,
    defaults: HashMap<String, String>,
    /// Folders in which files are looked up: the scene's own, then those of `<path>`.
    pub(super) folders: Vec<PathBuf>,
    /// Whether an included file could not be read.
    pub(super) incomplete: bool,
}

impl<'a> Expansion<'a> {
    pub(super) fn new(folder: &Path, builder: &'a mut Builder) -> Self {
        Self {
            builder,
            xml: xml::Reader::new(),
            defaults: HashMap::new(),
            folders: vec![folder.to_owned()],
            incomplete: false,
        }
    }

    pub(super) fn element(&mut self, element: &mut Element, depth: usize) -> Result<()> {
        if depth == limits::XML_DEPTH {
            return Err(xml::too_deep(&element.place));
        }
        self.substitute(element)?;
        let read = match &element.tag[..] {
            "default" => self.default(element),
            "path" => self.path(element),
            _ => Ok(()),
        };
        self.builder.or_warn(read, ((), "it is left out"))?;
        let children = std::mem::take(&mut element.children);
        element.children.reserve_exact(children.len());
        for mut child in children {
            if child.tag == "include" {
                element.children.extend(self.include(&mut child, depth + 1)?);
            } else {
                self.element(&mut child, depth + 1)?;
                element.children.push(child);
            }
        }
        Ok(())
    }

    fn default(&mut self, element: &Element) -> Result<()> {
        let (name, value) = (element.required("name")?, element.required("value")?);
        if name.len() > LONGEST {
            let why = format!("a parameter's name has more than {LONGEST} bytes; shorten it");
            return Err(element.place.invalid(why));
        }
        self.defaults.entry(name.to_owned()).or_insert_with(|| value.to_owned());
        Ok(())
    }

    fn path(&mut self, element: &Element) -> Result<()> {
        let value = element.required("value")?;
        if self.folders.len() > limits::PARAMETERS {
            return Err(element.place.invalid(format!(
                "the scene has more than {} <path> folders; keep its files in fewer",
                limits::PARAMETERS
            )));
        }
        self.folders.push(self.folders[0].join(value));
        Ok(())
    }

    fn include(&mut self, element: &mut Element, depth: usize) -> Result<Vec<Element>> {
        self.substitute(element)?;
        let name = element.required("filename").map(Some);
        let name = self.builder.or_warn(name, (None, "it is left out"))?;
        let root = match name {
            Some(name) => {
                let path = find(&self.folders, name);
                let said = "its materials are not seen, and all others count as used";
                self.xml.include((name, &path), &element.place, self.builder, said)?
            }
            None => None,
        };
        let Some(mut root) = root else {
            self.incomplete = true;
            return Ok(Vec::new());
        };
        self.element(&mut root, depth)?;
        self.xml.includes.leave();
        Ok(if root.tag == "scene" { root.children } else { vec![root] })
    }

    /// Replaces each `$name` in the attributes by its value; the longest known name counts.
    fn substitute(&self, element: &mut Element) -> Result<()> {
        for (_, value) in element.attributes.iter_mut().filter(|(_, value)| value.contains('$')) {
            let mut parts = value.split('$');
            let mut replaced = parts.next().unwrap_or_default().to_owned();
            for part in parts {
                let names = (1..=part.len().min(LONGEST)).rev().filter_map(|end| part.get(..end));
                let known = names.filter_map(|name| self.defaults.get_key_value(name)).next();
                if let Some((name, value)) = known {
                    self.xml.includes.charge(value.len(), &element.place)?;
                    replaced.push_str(value);
                    replaced.push_str(&part[name.len()..]);
                } else {
                    replaced.push('$');
                    replaced.push_str(part);
                }
            }
            *value = replaced;
        }
        Ok(())
    }
}
