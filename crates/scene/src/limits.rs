//! How large a scene may be.
//!
//! Every limit is low enough that the worst file of that size ends within seconds and 1 GB of
//! memory, and above nearly all scenes that exist. Larger ones, such as Disney's Moana island,
//! whose text for pbrt is geometry, have their materials in files of their own, which can be loaded
//! alone.

pub(crate) use microfacet_baker::scene::Budget;

/// Bytes of XML, with all that is included and substituted.
pub(crate) const XML: u64 = 64 << 20;
/// Elements, comments and texts of XML, with all that is included; 250 bytes each.
pub(crate) const XML_NODES: u64 = 2 << 20;
/// Attributes of all these elements; 250 bytes each.
pub(crate) const XML_VALUES: u64 = 3 << 19;
/// Attributes of an XML element: the parser compares each with each.
pub(crate) const XML_ATTRIBUTES: usize = 256;
/// Declarations of namespaces in an XML file: the parser copies them from element to element.
pub(crate) const XML_NAMESPACES: usize = 64;
/// Tokens and raw ampersands of an XML file that are escaped; 50 bytes each.
pub(crate) const XML_MENDED: usize = 1 << 18;
/// Bytes of the JSON of a glTF scene, most of which may be images and geometry in base64.
pub(crate) const JSON: u64 = 128 << 20;
/// Entries of one list in a glTF scene.
pub(crate) const JSON_LIST: usize = 1 << 20;
/// Bytes of a pbrt scene, unpacked and with all that is included. They are read as a stream, so
/// that only time limits them: 3 s for numbers in lists, 13 s for words.
pub(crate) const PBRT: u64 = 1 << 30;
/// Bytes of the materials and textures of a pbrt scene, which are held. Short parameters take 30
/// times as much.
pub(crate) const PBRT_HELD: u64 = 16 << 20;
/// Parameters of one pbrt directive, and of all attributes in force.
pub(crate) const PBRT_PARAMETERS: usize = 64;
/// Blocks inside each other in a pbrt scene.
pub(crate) const PBRT_BLOCKS: usize = 10_000;
/// Materials of a scene, with those for which there is nothing to bake; textures likewise.
pub(crate) const MATERIALS: usize = 100_000;
/// Bytes of a material's name: each of its lobes repeats it.
pub(crate) const NAME: usize = 1024;
/// Bytes of a warning, or of a reason why a material was left out; it may quote the scene.
pub(crate) const MESSAGE: usize = 1024;
/// Warnings of a scene; one more says that there are further ones.
pub(crate) const WARNINGS: usize = 10_000;
/// Names that are compared for suggestions of similar ones in a scene: 10 000 long ones take up to
/// a second.
pub(crate) const HINTS: u64 = 200_000;
/// Included files, each as often as it is included.
pub(crate) const INCLUDES: usize = 10_000;
/// Folders that a Mitsuba scene adds with `<path>`: every file is looked for in each.
pub(crate) const FOLDERS: usize = 64;
/// Parameters that a Mitsuba scene declares with `<default>`.
pub(crate) const DEFAULTS: usize = 1000;
/// Uses of the nodes that a MaterialX document defines, each with the values of its own inputs.
pub(crate) const INSTANCES: usize = 10_000;
/// BSDF nodes of all materials of a MaterialX document together: materials may share them.
pub(crate) const BSDFS: u64 = 1 << 20;
/// Tiles of one tiled image, and entries of the folder in which they are looked for.
pub(crate) const TILES: usize = 1000;
pub(crate) const TILE_FOLDER: usize = 100_000;
/// Bytes of one image file.
pub(crate) const IMAGE_FILE: u64 = 256 << 20;
/// Bytes of memory for decoding one image: a PNG of 8192 x 8192 pixels of 16-bit RGBA.
pub(crate) const IMAGE: u64 = 512 << 20;
/// Bytes of all images of a scene, decoded; a gigabyte takes two seconds.
pub(crate) const IMAGES: u64 = 8 << 30;
