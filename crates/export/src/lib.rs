//! Writes single shapes γ of the family, for any roughness, for renderers in other languages:
//! tables and lookups, without an axis of γ, an archive to read, or a library to link. In C a shape
//! is source text; for shaders the functions are text, and the tables of all shapes are data for
//! one buffer or texture. [`texture`] writes albedos alone, for the filter of a texture.
//!
//! [`Shape::bind`] collapses the tables of a set at one γ. Every target is written from it, so all
//! of them hold the same numbers; [`files`] makes the files of one.
//!
//! ```
//! use microfacet_export::{Shape, Target, files};
//! use microfacet_sampler::Tables;
//!
//! let shape = Shape::bind(&Tables::embedded(), 3.0)?;
//! let names = files(&Target::C, &[shape]).into_iter().map(|file| file.name);
//! let functions =
//!     ["student_t.h", "student_t_materials.h", "student_t.hpp", "student_t_closed.h"];
//! assert_eq!(names.collect::<Vec<_>>(), [&functions[..], &["student_t_gamma_3.h"]].concat());
//! # Ok::<(), microfacet_sampler::MaterialError>(())
//! ```

use microfacet_baker::store;

mod albedo;
mod c;
mod family;
mod members;
pub mod numbers;
mod realtime;
mod shader;
mod shape;
pub mod texture;
mod turning;

pub use albedo::AlbedoTable;
pub use family::Family;
pub use members::Part;
pub use realtime::Realtime;
pub use shader::{Group, Host, Kind, Language, Storage, texture_rows};
pub use shader::{WIDTH, append_some, for_webgl, realtime_text, wgsl_crc32};
pub use shape::Shape;
pub use turning::TurningAlbedo;

/// The language of an export.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Headers for C99, C++11, CUDA and HIP.
    C,
    /// A shader module, with its tables as data. The language must have what the host asks for
    /// ([`Host::check`]).
    Shader(Language, Storage, Host),
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportFile {
    /// File name. All files of a target go into one folder.
    pub name: String,
    /// Its bytes; text is UTF-8.
    pub contents: Vec<u8>,
}

impl ExportFile {
    fn new(name: impl Into<String>, contents: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), contents: contents.into() }
    }
}

/// Numbers as an OpenEXR image: one plane as the luminance Y, two or three as R, G and B. A third
/// that is missing is 0: readers of colours, such as three.js, refuse an image without it.
fn open_exr(
    name: &str,
    size: [usize; 2],
    mut planes: Vec<Vec<f32>>,
    half: bool,
    description: Option<&str>,
) -> Result<Vec<u8>, String> {
    let names = if planes.len() == 1 { &["Y"][..] } else { &["R", "G", "B"] };
    planes.resize(names.len(), vec![0.0; size[0] * size[1]]);
    store::encode_channels(name, size, names.iter().copied().zip(planes), half, description)
}

/// The files of a target. Those with functions, which do not depend on the shapes, come first. Then
/// comes one file for each shape, or for shaders the files with the data of all shapes.
///
/// # Panics
/// If there are no shapes for shaders.
pub fn files(target: &Target, shapes: &[Shape]) -> Vec<ExportFile> {
    match target {
        Target::C => c::files(shapes),
        Target::Shader(language, storage, host) => shader::files(*language, *storage, host, shapes),
    }
}

/// The file of every shape at once for C: a header or, if `binary`, its tables as bytes. Its
/// functions are among the [`files`] of C, of shapes or of none.
#[must_use]
pub fn family_file(family: &Family, binary: bool) -> ExportFile {
    c::family(family, binary)
}

/// The files of every shape at once for a shading language, which must have what the host asks for
/// ([`Host::check`]): the module, a program that uses it, the tables, and their description.
#[must_use]
pub fn family_shader_files(
    language: Language,
    storage: Storage,
    host: &Host,
    family: &Family,
) -> Vec<ExportFile> {
    shader::family_files(language, storage, host, family)
}

/// The files of the kit for real time in a shading language: functions, which read no texture
/// themselves, a program that does, two textures for linear filters, and their description.
///
/// # Panics
/// For SPIR-V, which has no functions without a program.
#[must_use]
pub fn realtime_files(language: Language, host: &Host, realtime: &Realtime) -> Vec<ExportFile> {
    shader::realtime_files(language, host, realtime)
}

/// The header of dielectrics of one index for C; the functions and lobes are among the [`files`] of
/// C. `generator` is the program that baked the tables.
///
/// ```no_run
/// use microfacet_export::interface_file;
/// use microfacet_sampler::port::interface_tables;
/// use microfacet_sampler::{Masking, Tables};
///
/// let tables = Tables::from_bytes(&std::fs::read("glass/tables.safetensors")?)?;
/// let glass = tables.family_dielectric(1.5, Masking::HeightCorrelated)?;
/// let file = interface_file(&interface_tables(&glass), &tables.provenance().generator);
/// assert_eq!(file.name, "student_t_eta_1p5.h");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn interface_file(
    tables: &microfacet_sampler::port::InterfaceTables,
    generator: &str,
) -> ExportFile {
    c::interface(tables, generator)
}
