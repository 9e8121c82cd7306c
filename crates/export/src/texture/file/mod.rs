//! Textures as files that other programs open.

mod dds;
mod describe;
mod header;
pub(in crate::texture) mod ktx2;
mod npy;

use half::f16;

use super::{Deviation, Edge, Texture};
use crate::{ExportFile, open_exr};

/// A format of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// OpenEXR; a volume has its slices below each other.
    Exr,
    /// DirectDraw Surface with a DX10 header: two dimensions or a volume.
    Dds,
    /// KTX 2: two dimensions or a volume.
    Ktx2,
    /// An array of NumPy.
    Npy,
    /// A header for C and C++, with functions that read it.
    C,
    /// The description, with the values.
    Json,
}

impl Format {
    fn extension(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Dds => "dds",
            Self::Ktx2 => "ktx2",
            Self::Npy => "npy",
            Self::C => "h",
            Self::Json => "json",
        }
    }
}

/// A texture with its measured errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// The texture.
    pub texture: Texture,
    /// Its errors.
    pub errors: Vec<Deviation>,
    /// Its errors along the edges of its domain that have names.
    pub edges: Vec<(Edge, Vec<Deviation>)>,
    /// What it was before its values were rounded to 16 bits, if they were.
    pub before_rounding: Option<BeforeRounding>,
}

/// A texture before its values were rounded to 16 bits.
#[derive(Clone, Debug, PartialEq)]
pub struct BeforeRounding {
    /// Its errors.
    pub errors: Vec<Deviation>,
    /// The largest change of a value since.
    pub rounding: f64,
}

/// The files of a texture and of its averages in some formats, and descriptions of both.
///
/// # Errors
/// A message if a library refuses a texture.
pub fn files(formats: &[Format], made: &[Made]) -> Result<Vec<ExportFile>, String> {
    let mut files = Vec::new();
    for made in made {
        let name = &made.texture.spec.name;
        let mut description = describe::description(made);
        let all = formats.iter().map(|format| format!("{name}.{}", format.extension()));
        description.insert("files".into(), all.collect());
        for format in formats {
            let compact = || describe::compact(&description);
            let contents = match format {
                Format::Exr => exr(&made.texture, &compact())?,
                Format::Dds => dds::encode(&made.texture),
                Format::Ktx2 => ktx2::encode(&made.texture, Some(&compact())),
                Format::Npy => npy::encode(&made.texture),
                Format::C => header::encode(made).into_bytes(),
                // Written after the other formats, with the values.
                Format::Json => continue,
            };
            files.push(ExportFile::new(format!("{name}.{}", format.extension()), contents));
        }
        let values = formats.contains(&Format::Json).then_some(&made.texture);
        let text = describe::text(description, values);
        files.push(ExportFile::new(format!("{name}.json"), text));
    }
    Ok(files)
}

/// Width, height and depth of a texture.
fn extent(texture: &Texture) -> [usize; 3] {
    let size = texture.size();
    let mut fastest_first = size.iter().rev().copied();
    [(); 3].map(|()| fastest_first.next().unwrap_or(1))
}

fn is_volume(texture: &Texture) -> bool {
    texture.spec.axes.len() == 3
}

fn bytes(texture: &Texture) -> Vec<u8> {
    let values = texture.values.iter();
    match texture.half {
        false => values.flat_map(|x| x.to_le_bytes()).collect(),
        true => values.flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect(),
    }
}

fn exr(texture: &Texture, description: &str) -> Result<Vec<u8>, String> {
    let [width, height, depth] = extent(texture);
    let planes = (0..texture.spec.channels.len()).map(|i| texture.plane(i).collect()).collect();
    open_exr(&texture.spec.name, [width, height * depth], planes, texture.half, Some(description))
}
