//! How large a scene may be.
//!
//! Every limit is low enough that the worst file of that size ends within seconds and 1 GB of
//! memory, and above nearly all scenes that exist. Larger ones, such as Disney's Moana island,
//! whose text for pbrt is geometry, have their materials in files of their own, which can be loaded
//! alone.

use std::cell::Cell;
use std::rc::Rc;

/// What may still be read or held for a scene, shared by its readers.
#[derive(Clone)]
pub(super) struct Budget {
    limit: u64,
    left: Rc<Cell<u64>>,
}

impl Budget {
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, left: Rc::new(Cell::new(limit)) }
    }

    pub(super) fn limit(&self) -> u64 {
        self.limit
    }

    pub(super) fn left(&self) -> u64 {
        self.left.get()
    }

    /// Takes a part of it; `false` if less is left.
    pub(super) fn take(&self, part: u64) -> bool {
        let left = self.left.get().checked_sub(part);
        self.left.set(left.unwrap_or(0));
        left.is_some()
    }
}

/// Bytes of a recipe, which is parsed in parts.
pub(super) const RECIPE: u64 = 64 << 20;
/// Bytes of a part of a recipe: from one `[[material]]` to the next, and all before the second. The
/// parser takes 80 times as much memory for a list of ones.
pub(super) const RECIPE_PART: u64 = 8 << 20;
/// Materials of a recipe, which is read for them alone.
pub(super) const RECIPE_MATERIALS: usize = 1_000_000;
/// Bytes of the measured distributions of a recipe, all together; each is integrated numerically.
pub(super) const MEASURED: u64 = 16 << 20;
/// Distributions outside the family in a recipe: each takes a millisecond or more to integrate.
pub(super) const DISTRIBUTIONS: u64 = 1000;
/// Bytes of XML, with all that is included and substituted.
pub(super) const XML: u64 = 64 << 20;
/// Elements, comments and texts of XML, with all that is included; 250 bytes each.
pub(super) const XML_NODES: u64 = 2 << 20;
/// Attributes of all these elements; 250 bytes each.
pub(super) const XML_VALUES: u64 = 3 << 19;
/// Attributes of an XML element: the parser compares each with each.
pub(super) const XML_ATTRIBUTES: usize = 256;
/// Declarations of namespaces in an XML file: the parser copies them from element to element.
pub(super) const XML_NAMESPACES: usize = 64;
/// Tokens and raw ampersands of an XML file that are escaped; 50 bytes each.
pub(super) const XML_MENDED: usize = 1 << 18;
/// Bytes of the JSON of a glTF scene, most of which may be images and geometry in base64.
pub(super) const JSON: u64 = 128 << 20;
/// Entries of one list in a glTF scene.
pub(super) const JSON_LIST: usize = 1 << 20;
/// Bytes of a pbrt scene, unpacked and with all that is included. They are read as a stream, so
/// that only time limits them: 3 s for numbers in lists, 13 s for words.
pub(super) const PBRT: u64 = 1 << 30;
/// Bytes of the materials and textures of a pbrt scene, which are held. Short parameters take 30
/// times as much.
pub(super) const PBRT_HELD: u64 = 16 << 20;
/// Parameters of one pbrt directive, and of all attributes in force.
pub(super) const PBRT_PARAMETERS: usize = 64;
/// Blocks inside each other in a pbrt scene.
pub(super) const PBRT_BLOCKS: usize = 10_000;
/// Materials of a scene, with those for which there is nothing to bake; textures likewise.
pub(super) const MATERIALS: usize = 100_000;
/// Bytes of a material's name: each of its lobes repeats it.
pub(super) const NAME: usize = 1024;
/// Bytes of a warning, or of a reason why a material was left out; it may quote the scene.
pub(super) const MESSAGE: usize = 1024;
/// Warnings of a scene; one more says that there are further ones.
pub(super) const WARNINGS: usize = 10_000;
/// Names that are compared for suggestions of similar ones in a scene: 10 000 long ones take up to
/// a second.
pub(super) const HINTS: u64 = 200_000;
/// Included files, each as often as it is included.
pub(super) const INCLUDES: usize = 10_000;
/// Folders that a Mitsuba scene adds with `<path>`: every file is looked for in each.
pub(super) const FOLDERS: usize = 64;
/// Parameters that a Mitsuba scene declares with `<default>`.
pub(super) const DEFAULTS: usize = 1000;
/// Uses of the nodes that a MaterialX document defines, each with the values of its own inputs.
pub(super) const INSTANCES: usize = 10_000;
/// BSDF nodes of all materials of a MaterialX document together: materials may share them.
pub(super) const BSDFS: u64 = 1 << 20;
/// Tiles of one tiled image, and entries of the folder in which they are looked for.
pub(super) const TILES: usize = 1000;
pub(super) const TILE_FOLDER: usize = 100_000;
/// Bytes of one image file.
pub(super) const IMAGE_FILE: u64 = 256 << 20;
/// Bytes of memory for decoding one image: a PNG of 8192 x 8192 pixels of 16-bit RGBA.
pub(super) const IMAGE: u64 = 512 << 20;
/// Bytes of all images of a scene, decoded; a gigabyte takes two seconds.
pub(super) const IMAGES: u64 = 8 << 30;
