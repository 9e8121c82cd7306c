//! How large a scene may be.
//!
//! Nearly all scenes that exist are below every limit, and reading the worst file ends within
//! seconds and about 1 GB of memory. Larger scenes, such as Disney's Moana island, whose text for
//! pbrt is geometry, have their materials in separate files, which can be loaded alone.

pub(crate) use microfacet_baker::scene::Budget;

/// Bytes of XML or of JSON, with all that is included and substituted. Most of the JSON of a glTF
/// scene may be images and geometry in base64.
pub(crate) const TEXT: u64 = 128 << 20;
/// Elements of a list of a glTF scene, and members of an object; 100 bytes each.
pub(crate) const ENTRIES: usize = 1 << 20;
/// Bytes of a pbrt scene, unpacked and with all that is included, most of which is geometry.
pub(crate) const PBRT: u64 = 1 << 30;
/// Bytes of the materials and textures of a pbrt scene. Short ones take 30 times as much memory.
pub(crate) const PBRT_HELD: u64 = 16 << 20;
/// Parameters of one pbrt directive, and of all attributes in force; folders that a Mitsuba scene
/// adds with `<path>`, in each of which every file is looked for.
pub(crate) const PARAMETERS: usize = 64;
/// Elements and attributes of XML, with all that is included; up to 250 bytes each.
pub(crate) const XML_PARTS: u64 = 3 << 20;
/// Depth of nested XML elements, which are followed by recursion.
pub(crate) const XML_DEPTH: usize = 256;
/// Depth of nested included files, textures or nodes, which are followed by recursion.
pub(crate) const DEPTH: usize = 128;
/// Included files, each counted as often as it is included.
pub(crate) const INCLUDES: usize = 10_000;
/// Materials of a scene, including those for which there is nothing to bake; textures of a pbrt
/// scene; the depth of its nested blocks.
pub(crate) const MATERIALS: usize = 100_000;
/// Nodes that are followed for all materials of a MaterialX document together: materials may share
/// them, and definitions use each other.
pub(crate) const NODES: u64 = 1 << 20;
/// Bytes of a name, a warning, or a reason to leave a material out: each material may repeat it.
pub(crate) const MESSAGE: usize = 1024;
/// Warnings of a scene; one more says that there are further ones.
pub(crate) const WARNINGS: usize = 10_000;
/// Unknown members of one glTF material that are warned of.
pub(crate) const UNKNOWN: u64 = 100;
/// Names that are compared for suggestions of similar ones: 10 000 long ones take up to a second.
pub(crate) const HINTS: u64 = 200_000;
/// Bytes of one image file, and of memory to decode it: a PNG of 8192 x 8192 pixels, 16-bit RGBA.
pub(crate) const IMAGE: u64 = 512 << 20;
/// Bytes of all images of a scene, read and decoded; a gigabyte takes two seconds.
pub(crate) const IMAGES: u64 = 8 << 30;
