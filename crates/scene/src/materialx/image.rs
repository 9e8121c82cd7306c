//! Ranges of image files, whole or in tiles.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use microfacet_tables::Interval;

use super::Reader;
use super::connect::named;
use super::index::At;
use crate::texture::{Channel, Encoding};
use crate::xml::Element;

impl<'a> Reader<'a> {
    /// The range of a channel of the image of an image node.
    pub(super) fn image(&mut self, at: At<'a>, channel: Channel) -> Interval {
        let node = at.node;
        let file = self.index.given(node, "file").and_then(|file| self.text(file, at));
        let Some((input, file)) = file.filter(|(_, file)| !file.is_empty()) else {
            return self.builder.unread(named(node), "names no file", &node.place);
        };
        let of_type = node.attribute("type").unwrap_or_default();
        let is_colour = of_type.starts_with("color") || of_type == "multioutput";
        let holders = [input, node, at.scope.graph];
        let encoding = match self.index.inherited(&holders, "colorspace") {
            Some("srgb_texture") if is_colour => Encoding::Srgb,
            _ => Encoding::Linear,
        };
        let channel = if of_type == "float" { Channel::Red } else { channel };
        let prefix = self.index.inherited(&holders, "fileprefix").unwrap_or_default();
        let folder = input.place.file.parent().unwrap_or(Path::new(""));
        let path = folder.join(format!("{prefix}{file}"));
        let files = match tiles(&path) {
            None => vec![path],
            Some(Ok(tiles)) => tiles,
            Some(Err(why)) => {
                return self.builder.unread(&path.display().to_string(), why, &node.place);
            }
        };
        let mut read = |file: &PathBuf| self.builder.image(file, channel, encoding, &node.place);
        let ranges: Vec<Interval> = files.iter().map(&mut read).collect();
        ranges.into_iter().reduce(Interval::union).unwrap_or(Interval::UNIT)
    }

    /// The text that an input holds or is given, with the element that has it.
    fn text(&self, input: &'a Element, at: At<'a>) -> Option<(&'a Element, &'a str)> {
        let mut end = At::new(input, at.scope);
        // A file name may pass through the interfaces of nested graphs.
        for _ in 0..8 {
            match self.target(end.node, end.scope).ok()? {
                None => return Some((end.node, end.node.attribute("value")?)),
                Some(next) => end = next,
            }
        }
        None
    }
}

/// The files of a tiled image that exist, in the order of their names; `None` for a single image.
///
/// Tiles are numbered by `<UDIM>`, 1001 + u + 10 v, or by `<UVTILE>`, u1_v1 and so on.
fn tiles(path: &Path) -> Option<Result<Vec<PathBuf>, &'static str>> {
    let name = path.file_name()?.to_str()?;
    let (before, after, is_tile): (_, _, fn(&str) -> bool) = if let Some((before, after)) =
        name.split_once("<UDIM>")
    {
        (before, after, |tile| tile.len() == 4 && tile.parse::<u16>().is_ok_and(|tile| tile > 1000))
    } else {
        let (before, after) = name.split_once("<UVTILE>")?;
        let is_tile = |tile: &str| {
            let numbers = tile.strip_prefix('u').and_then(|rest| rest.split_once("_v"));
            numbers.is_some_and(|(u, v)| u.parse::<u16>().is_ok() && v.parse::<u16>().is_ok())
        };
        (before, after, is_tile)
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let Ok(entries) = std::fs::read_dir(folder.unwrap_or(Path::new("."))) else {
        return Some(Err("is in a folder that cannot be read"));
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let tiles = names.filter(|name| {
        let tile = name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after));
        tile.is_some_and(is_tile)
    });
    let found: BTreeSet<PathBuf> = tiles.map(|name| path.with_file_name(name)).collect();
    Some(if found.is_empty() { Err("has no tile") } else { Ok(found.into_iter().collect()) })
}
