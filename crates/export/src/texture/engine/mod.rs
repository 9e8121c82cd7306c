//! The textures and tables of GGX that engines read today, with values of the model: one entry for
//! each layout, with the axes and channels of its texels and the format of its file.

mod image;
mod text;

use microfacet_core::Masking;

use super::{Along, Channel, MOST_FITTED, TexelAxis, Texture, TextureSpec};
use crate::ExportFile;

/// The smallest cosine that a fit to an engine's filter counts.
const LEAST_COS: f64 = 1e-3;

/// What an engine reads.
pub struct Layout {
    /// Its name on the command line.
    pub name: &'static str,
    /// The engine.
    pub engine: &'static str,
    /// The size of its table as shipped, slowest axis first.
    pub size: [usize; 2],
    /// What to do with the files.
    pub advice: &'static str,
    axes: fn([usize; 2]) -> [TexelAxis; 2],
    masking: Masking,
    channels: &'static [Channel],
    name_of: &'static str,
    average: Option<&'static str>,
    encode: fn(&[Texture]) -> Result<Vec<ExportFile>, String>,
}

/// √σ.
const ROOT: Along = Along::Roughness { largest: 1.0 };

/// μ down to the horizon.
const COSINE: Along = Along::Cosine { least: 0.0 };

fn middles(slow: Along, fast: Along, size: [usize; 2]) -> [TexelAxis; 2] {
    [TexelAxis::to_middles(slow, size[0]), TexelAxis::to_middles(fast, size[1])]
}

fn ends(slow: Along, fast: Along, size: [usize; 2]) -> [TexelAxis; 2] {
    [TexelAxis::to_ends(slow, size[0]), TexelAxis::to_ends(fast, size[1])]
}

const CORRELATED: Masking = Masking::HeightCorrelated;
const SCALE_BIAS: &[Channel] = &[Channel::Scale, Channel::Bias];
const SCALE_BIAS_SHEEN: &[Channel] = &[Channel::Scale, Channel::Bias, Channel::Empty];
const BIAS_E_CLOTH: &[Channel] = &[Channel::Bias, Channel::E, Channel::Empty];

/// All layouts.
pub const LAYOUTS: [Layout; 10] = [
    Layout {
        name: "cycles",
        engine: "Cycles",
        size: [32, 32],
        advice: "put both arrays in place of those in src/scene/shader.tables",
        // Baked down to 1e-4.
        axes: |size| ends(Along::Cosine { least: 1e-4 }, ROOT, size),
        masking: CORRELATED,
        channels: &[Channel::E],
        name_of: "ggx_E",
        average: Some("ggx_Eavg"),
        encode: text::cycles,
    },
    Layout {
        name: "openpbr",
        engine: "openpbr-bsdf",
        size: [32, 32],
        advice: "put both files in place of those in impl/data; they are the metal's",
        // The column of the horizon holds the values at this cosine.
        axes: |size| ends(ROOT, Along::Cosine { least: 9.5e-4 }, size),
        masking: Masking::Uncorrelated,
        channels: &[Channel::Lost],
        name_of: "ideal_metal",
        average: Some("ideal_metal_avg"),
        encode: text::openpbr,
    },
    Layout {
        name: "osl",
        engine: "OSL libbsdl",
        size: [16, 16],
        advice: "put the file in place of SPI/microfacet_tools_luts.h among the generated headers",
        axes: |[rows, columns]| {
            let node = |i: usize| (i as f64 / (columns - 1) as f64).powi(2);
            let along = Along::Cosine { least: 1e-6 };
            let cosines = TexelAxis { along, texels: (0..columns).map(node).collect() };
            [TexelAxis::to_ends(ROOT, rows), cosines]
        },
        masking: CORRELATED,
        channels: &[Channel::Lost],
        name_of: "MiniMicrofacetGGX",
        average: None,
        encode: text::osl,
    },
    Layout {
        name: "filament",
        engine: "Filament",
        size: [128, 128],
        advice: "build with it in place of the generated dfg.inc; the third channel, cloth, is 0: \
                 keep that of your own file if you use cloth",
        axes: |size| middles(ROOT, COSINE, size),
        masking: CORRELATED,
        channels: BIAS_E_CLOTH,
        name_of: "dfg",
        average: None,
        encode: text::filament,
    },
    Layout {
        name: "three",
        engine: "three.js",
        size: [16, 16],
        advice: "put the array in place of that in src/renderers/shaders/DFGLUTData.js and in \
                 src/nodes/functions/BSDF/DFGLUT.js",
        axes: |size| middles(COSINE, ROOT, size),
        masking: CORRELATED,
        channels: SCALE_BIAS,
        name_of: "DFGLUTData",
        average: None,
        encode: text::three,
    },
    Layout {
        name: "bevy",
        engine: "Bevy",
        size: [64, 64],
        advice: "put it in place of crates/bevy_pbr/src/environment_map/dfg.ktx2, or load it as \
                 the image of the resource DfgLut",
        axes: |size| middles(ROOT, COSINE, size),
        masking: CORRELATED,
        channels: SCALE_BIAS,
        name_of: "dfg",
        average: None,
        encode: image::bevy,
    },
    Layout {
        name: "materialx",
        engine: "MaterialX",
        size: [128, 128],
        advice: "set it with LightHandler::setAlbedoTable; the third channel, sheen, is 0",
        axes: |size| middles(Along::LinearRoughness, COSINE, size),
        masking: CORRELATED,
        channels: SCALE_BIAS_SHEEN,
        name_of: "AlbedoTable",
        average: None,
        encode: image::open_exr,
    },
    Layout {
        name: "unity",
        engine: "Unity HDRP",
        size: [64, 64],
        advice: "bind it as _PreIntegratedFGD_GGXDisneyDiffuse; the third channel, diffuse, is 0",
        axes: |size| ends(ROOT, Along::RootCosine, size),
        masking: CORRELATED,
        channels: BIAS_E_CLOTH,
        name_of: "PreIntegratedFGD",
        average: None,
        encode: image::open_exr,
    },
    Layout {
        name: "babylon",
        engine: "Babylon.js",
        size: [256, 256],
        advice: "load it by new Texture(url, scene, true, false), the flags noMipmap and invertY, \
                 with isRGBD = true, which decodes it, and CLAMP_ADDRESSMODE as wrapU and wrapV, and \
                 set it as the scene's environmentBRDFTexture before the first material of PBR is \
                 made; the third channel, cloth, is 0",
        axes: |size| middles(ROOT, COSINE, size),
        masking: CORRELATED,
        channels: BIAS_E_CLOTH,
        name_of: "environmentBRDF",
        average: None,
        encode: image::babylon,
    },
    Layout {
        name: "gltf",
        engine: "glTF viewers",
        size: [256, 256],
        advice: "load it in place of lut_ggx.png, without decoding sRGB; the third channel, \
                 sheen, is 0",
        axes: |size| middles(ROOT, COSINE, size),
        masking: CORRELATED,
        channels: SCALE_BIAS_SHEEN,
        name_of: "lut_ggx",
        average: None,
        encode: image::gltf,
    },
];

impl Layout {
    /// The layout by its name.
    pub fn find(name: &str) -> Option<&'static Self> {
        LAYOUTS.iter().find(|layout| layout.name == name)
    }

    /// The textures of the layout for γ, of its own size or another; values at the texels, or
    /// fitted to the engine's filter.
    pub fn specs(&self, gamma: f64, size: [usize; 2], fitted: bool) -> Vec<TextureSpec> {
        let directional = TextureSpec {
            name: self.name_of.into(),
            gamma,
            eta: None,
            axes: (self.axes)(size).into(),
            masking: self.masking,
            channels: self.channels.to_vec(),
            least_cos: LEAST_COS,
            fitted: fitted && size[0] * size[1] <= MOST_FITTED,
        };
        let average = self.average.map(|name| directional.average(name));
        std::iter::once(directional).chain(average).collect()
    }

    /// The files that the engine reads.
    ///
    /// # Errors
    /// A message if a library refuses a texture.
    pub fn files(&self, textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
        (self.encode)(textures)
    }
}
