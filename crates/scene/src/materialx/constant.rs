//! Values that are the same everywhere.

use std::collections::HashSet;

use super::Reader;
use super::connect::is_end;
use super::graph::RGB;
use super::index::{At, Scope};
use crate::Result;
use crate::builder::has_word;
use crate::xml::Element;

/// Constants are followed through this many nodes at most.
const MAX_CONSTANT: usize = 64;

impl<'a> Reader<'a> {
    /// A colour or a vector that is the same everywhere; `None` if it may vary, which is found
    /// without reading images.
    pub(super) fn constant(
        &mut self,
        at: At<'a>,
        name: &'static str,
        default: [f64; 3],
    ) -> Result<Option<[f64; 3]>> {
        let Some(input) = self.index.given(at.node, name) else { return Ok(Some(default)) };
        if !self.is_constant(input, at.scope)? {
            return Ok(None);
        }
        let mut values = [0.0; 3];
        for (value, channel) in values.iter_mut().zip(RGB) {
            let range = self.value(input, at.scope, channel)?;
            if !range.is_point() {
                return Ok(None);
            }
            *value = range.min;
        }
        Ok(Some(values))
    }

    /// Whether a value comes from numbers through arithmetic alone.
    fn is_constant(&mut self, input: &'a Element, scope: Scope<'a>) -> Result<bool> {
        let mut left = vec![At::new(input, scope)];
        let mut seen = HashSet::new();
        while let Some(at) = left.pop() {
            if !seen.insert(at) {
                continue;
            }
            if seen.len() > MAX_CONSTANT {
                return Ok(false);
            }
            let end = at.node;
            let Some(next) = self.target(end, at.scope)? else { continue };
            if is_end(end, next.node) {
                left.push(next);
                continue;
            }
            let node = next.node;
            if has_word(ARITHMETIC, &node.tag) && node.children.len() <= MAX_CONSTANT {
                left.extend(node.children.iter().map(|input| At::new(input, next.scope)));
            } else {
                match self.implemented(next, end.attribute("output"))? {
                    Some(output) => left.push(output),
                    None => return Ok(false),
                }
            }
        }
        Ok(true)
    }
}

/// Nodes whose output is a number if their inputs are.
const ARITHMETIC: &str = "absval add artistic_ior clamp combine2 combine3 combine4 constant convert \
                          divide dot extract glossiness_anisotropy invert luminance max min mix \
                          multiply power range remap roughness_anisotropy roughness_dual \
                          safepower separate2 separate3 separate4 sqrt subtract";
