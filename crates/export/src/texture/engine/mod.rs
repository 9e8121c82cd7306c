//! The textures and tables of GGX that engines read today, with values of the model: one entry for
//! each layout, with the axes and channels of its tables and the format of its files. Tables that
//! an engine makes when it starts are no layouts, since it reads no file.

mod binary;
mod image;
mod text;

use microfacet_core::Masking;

use super::{
    Along, Channel, MOST_FITTED, SIZES, Shapes, TexelAxis, Texture, TextureSpec, check, check_size,
};
use crate::ExportFile;

/// The smallest cosine that a fit to an engine's filter counts.
const LEAST_COS: f64 = 1e-3;

/// What an engine reads.
pub struct Layout {
    /// Its name on the command line.
    pub name: &'static str,
    /// The engine.
    pub engine: &'static str,
    /// The size of its tables as shipped, slowest axis first; where there are three, the first is
    /// of the indices on either side.
    pub size: &'static [usize],
    /// What to do with the files.
    pub advice: &'static str,
    /// The shapes γ of the lobes that the engine has.
    pub lobes: &'static [f64],
    masking: Masking,
    tables: &'static [Table],
    encode: fn(&[Texture]) -> Result<Vec<ExportFile>, String>,
}

/// A table of a layout.
struct Table {
    name: &'static str,
    axes: fn(&[usize]) -> Vec<TexelAxis>,
    channels: &'static [Channel],
    /// The name and the channels of its averages, if the engine reads them.
    average: Option<(&'static str, &'static [Channel])>,
}

/// √σ.
const ROOT: Along = Along::Roughness { largest: 1.0 };

/// μ down to the horizon.
const COSINE: Along = Along::Cosine { least: 0.0 };

fn middles(along: [Along; 2], size: &[usize]) -> Vec<TexelAxis> {
    along.into_iter().zip(size).map(|(along, &n)| TexelAxis::to_middles(along, n)).collect()
}

fn ends<const N: usize>(along: [Along; N], size: &[usize]) -> Vec<TexelAxis> {
    along.into_iter().zip(size).map(|(along, &n)| TexelAxis::to_ends(along, n)).collect()
}

/// n between two values, of a dielectric seen from inside or from outside.
const fn index([first, last]: [f64; 2], inside: bool) -> Along {
    Along::LinearIndex { first, last, inside }
}

/// Baked down to 1e-4, and up to a contrast of 0.99, which stands for 1.
fn cycles_glass(inside: bool, size: &[usize]) -> Vec<TexelAxis> {
    let contrast = Along::Contrast { most: 0.99, inside };
    ends([contrast, Along::Cosine { least: 1e-4 }, ROOT], size)
}

/// The column of the horizon holds the values at this cosine.
const OPENPBR_COSINE: Along = Along::Cosine { least: 9.5e-4 };

const ANGLE: Along = Along::Angle;
/// The indices that MDL has tables of.
const MDL: [f64; 2] = [1.125, 3.0];

const GGX: &[f64] = &[2.0];
const LOST: &[Channel] = &[Channel::Lost, Channel::NotReflected];
const CORRELATED: Masking = Masking::HeightCorrelated;
const SCALE_BIAS: &[Channel] = &[Channel::Scale, Channel::Bias];
const SCALE_BIAS_SHEEN: &[Channel] = &[Channel::Scale, Channel::Bias, Channel::Empty];
const BIAS_E_CLOTH: &[Channel] = &[Channel::Bias, Channel::E, Channel::Empty];

/// All layouts.
pub const LAYOUTS: [Layout; 12] = [
    Layout {
        name: "cycles",
        engine: "Cycles",
        size: &[32, 32],
        advice: "put both arrays in place of those in src/scene/shader.tables",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "ggx_E",
            // Baked down to 1e-4.
            axes: |size| ends([Along::Cosine { least: 1e-4 }, ROOT], size),
            channels: &[Channel::E],
            average: Some(("ggx_Eavg", &[Channel::E])),
        }],
        encode: text::cycles,
    },
    Layout {
        name: "cycles-glass",
        engine: "Cycles",
        size: &[16, 16, 16],
        advice: "put the four arrays in place of those in src/scene/shader.tables",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[
            Table {
                name: "ggx_glass_E",
                axes: |size| cycles_glass(false, size),
                channels: &[Channel::E],
                average: Some(("ggx_glass_Eavg", &[Channel::E])),
            },
            Table {
                name: "ggx_glass_inv_E",
                axes: |size| cycles_glass(true, size),
                channels: &[Channel::E],
                average: Some(("ggx_glass_inv_Eavg", &[Channel::E])),
            },
        ],
        encode: text::cycles_glass,
    },
    Layout {
        name: "openpbr",
        engine: "openpbr-bsdf",
        size: &[32, 32],
        advice: "put both files in place of those in impl/data; they are the metal's",
        lobes: GGX,
        masking: Masking::Uncorrelated,
        tables: &[Table {
            name: "ideal_metal",
            axes: |size| ends([ROOT, OPENPBR_COSINE], size),
            channels: &[Channel::Lost],
            average: Some(("ideal_metal_avg", &[Channel::Lost])),
        }],
        encode: text::openpbr,
    },
    Layout {
        name: "openpbr-dielectric",
        engine: "openpbr-bsdf",
        size: &[16, 32, 32],
        advice: "put the four files in place of those in impl/data; keep the reflection ratio",
        lobes: GGX,
        masking: Masking::Uncorrelated,
        // Seen from inside, then from outside: 32 indices in all.
        tables: &[
            Table {
                name: "dielectric_inside",
                axes: |size| ends([index([2.5, 1.0], true), ROOT, OPENPBR_COSINE], size),
                channels: LOST,
                average: Some(("dielectric_inside_avg", LOST)),
            },
            Table {
                name: "dielectric_outside",
                axes: |size| ends([index([1.0, 2.5], false), ROOT, OPENPBR_COSINE], size),
                channels: LOST,
                average: Some(("dielectric_outside_avg", LOST)),
            },
        ],
        encode: text::openpbr_dielectric,
    },
    Layout {
        name: "mdl",
        engine: "MDL SDK",
        size: &[16, 64, 64],
        advice: "build with it in place of the file of its name in \
                 src/mdl/jit/libbsdf/multiscatter_tables",
        lobes: &[2.0, f64::INFINITY],
        masking: Masking::Uncorrelated,
        // A conductor, and a dielectric seen from outside and from inside.
        tables: &[
            Table {
                name: "conductor",
                axes: |size| ends([Along::LinearRoughness, ANGLE], &size[1..]),
                channels: &[Channel::E],
                average: Some(("conductor_average", &[Channel::Lost])),
            },
            Table {
                name: "outside",
                axes: |size| ends([index(MDL, false), Along::LinearRoughness, ANGLE], size),
                channels: &[Channel::E],
                average: Some(("outside_average", &[Channel::Lost])),
            },
            Table {
                name: "inside",
                axes: |size| ends([index(MDL, true), Along::LinearRoughness, ANGLE], size),
                channels: &[Channel::E],
                average: Some(("inside_average", &[Channel::Lost])),
            },
        ],
        encode: binary::mdl,
    },
    Layout {
        name: "eevee",
        engine: "EEVEE",
        size: &[64, 64],
        advice: "put the array in place of that in source/blender/draw/engines/eevee/eevee_lut.cc",
        lobes: GGX,
        masking: Masking::Uncorrelated,
        tables: &[Table {
            name: "brdf_ggx",
            // Baked down to 1e-4.
            axes: |size| ends([Along::RootVersine { least: 1e-4 }, ROOT], size),
            channels: &[Channel::Scale, Channel::Bias, Channel::Tint],
            average: None,
        }],
        encode: text::eevee,
    },
    Layout {
        name: "osl",
        engine: "OSL libbsdl",
        size: &[16, 16],
        advice: "put the file in place of SPI/microfacet_tools_luts.h among the generated headers",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "MiniMicrofacetGGX",
            axes: |size| {
                let node = |i: usize| (i as f64 / (size[1] - 1) as f64).powi(2);
                let along = Along::Cosine { least: 1e-6 };
                let cosines = TexelAxis { along, texels: (0..size[1]).map(node).collect() };
                vec![TexelAxis::to_ends(ROOT, size[0]), cosines]
            },
            channels: &[Channel::Lost],
            average: None,
        }],
        encode: text::osl,
    },
    Layout {
        name: "filament",
        engine: "Filament",
        size: &[128, 128],
        advice: "build with it in place of the generated dfg.inc; the third channel, cloth, is 0: \
                 keep that of your own file if you use cloth",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "dfg",
            axes: |size| middles([ROOT, COSINE], size),
            channels: BIAS_E_CLOTH,
            average: None,
        }],
        encode: text::filament,
    },
    Layout {
        name: "three",
        engine: "three.js",
        size: &[16, 16],
        advice: "put the array in place of that in src/renderers/shaders/DFGLUTData.js and in \
                 src/nodes/functions/BSDF/DFGLUT.js",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "DFGLUTData",
            axes: |size| middles([COSINE, ROOT], size),
            channels: SCALE_BIAS,
            average: None,
        }],
        encode: text::three,
    },
    Layout {
        name: "bevy",
        engine: "Bevy",
        size: &[64, 64],
        advice: "put it in place of crates/bevy_pbr/src/environment_map/dfg.ktx2, or load it as \
                 the image of the resource DfgLut",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "dfg",
            axes: |size| middles([ROOT, COSINE], size),
            channels: SCALE_BIAS,
            average: None,
        }],
        encode: image::bevy,
    },
    Layout {
        name: "babylon",
        engine: "Babylon.js",
        size: &[256, 256],
        advice: "load it by new Texture(url, scene, true, false), the flags noMipmap and invertY, \
                 with isRGBD = true, which decodes it, and CLAMP_ADDRESSMODE as wrapU and wrapV, and \
                 set it as the scene's environmentBRDFTexture before the first material of PBR is \
                 made; the third channel, cloth, is 0",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "environmentBRDF",
            axes: |size| middles([ROOT, COSINE], size),
            channels: BIAS_E_CLOTH,
            average: None,
        }],
        encode: image::babylon,
    },
    Layout {
        name: "gltf",
        engine: "glTF viewers",
        size: &[256, 256],
        advice: "load it in place of lut_ggx.png, without decoding sRGB; the third channel, \
                 sheen, is 0",
        lobes: GGX,
        masking: CORRELATED,
        tables: &[Table {
            name: "lut_ggx",
            axes: |size| middles([ROOT, COSINE], size),
            channels: SCALE_BIAS_SHEEN,
            average: None,
        }],
        encode: image::gltf,
    },
];

impl Layout {
    /// The layout by its name.
    pub fn find(name: &str) -> Option<&'static Self> {
        LAYOUTS.iter().find(|layout| layout.name == name)
    }

    /// Checks the shape and the size of its tables.
    ///
    /// # Errors
    /// A message with the value, what is allowed, and what to do.
    pub fn check(&self, gamma: f64, size: &[usize]) -> Result<(), String> {
        check(Shapes::One(gamma), 1.0, &[SIZES[0]; 2])?;
        let axes = self.size.len();
        let form = if axes == 2 { "as 32x32" } else { "indices first, as 16x32x32" };
        check_size("this layout", size, axes, form)
    }

    /// The textures of the layout for γ, of its own size or another: each table, followed by its
    /// averages if there are any. Values are those at the texels, or fitted to the engine's filter.
    pub fn specs(&self, gamma: f64, size: &[usize], fitted: bool) -> Vec<TextureSpec> {
        let of = |table: &Table| {
            let directional = TextureSpec {
                name: table.name.into(),
                gamma,
                eta: None,
                axes: (table.axes)(size),
                masking: self.masking,
                channels: table.channels.to_vec(),
                least_cos: LEAST_COS,
                fitted: fitted && size.iter().product::<usize>() <= MOST_FITTED,
            };
            let average = table.average.map(|(name, channels)| TextureSpec {
                channels: channels.to_vec(),
                ..directional.average(name)
            });
            std::iter::once(directional).chain(average)
        };
        self.tables.iter().flat_map(of).collect()
    }

    /// The files that the engine reads.
    ///
    /// # Errors
    /// A message if a library refuses a texture.
    pub fn files(&self, textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
        (self.encode)(textures)
    }
}
