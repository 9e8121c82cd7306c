//! Albedos as textures.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};

use microfacet_baker::progress::Stage;
use microfacet_baker::store::OutputFolder;
use microfacet_export::texture;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{
    BeforeRounding, Channels, Deviation, Format, Indices, Made, Shapes, Texture, TextureSpec,
    shader_lines,
};
use microfacet_sampler::Masking;
use microfacet_tables::SIGMA_MAX;

use crate::cli::values::{self, Named, named};
use crate::cli::words::distinct;
use crate::cli::{Failure, Result, bail, ensure, note, summarize, watched};

/// Directional albedo and its average as textures that a shader reads in one line.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake export lut --gamma 2 --sigma-max 1 --size 32x32 --format npy,ktx2 --out lut
GGX up to sigma 1 in 32 texels along the roughness and 32 along the view.
  microfacet-bake export lut --gamma-min 1.6 --size 32x64x64 --format dds --out lut
All shapes from 1.6 to infinity, as a volume.
  microfacet-bake export lut --gamma 2 --eta 1.05..2.5 --sigma-max 1 --format dds --out lut
Reflected and transmitted light at interfaces of these indices, from outside and from inside.
  microfacet-bake export lut --layout cycles --out lut
What Cycles reads, with exact values; with --fit, with values fitted to its filter.")]
pub(super) struct Args {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. A layout is of 2 by default.
    #[arg(long, value_name = "G", value_parser = values::gamma)]
    gamma: Option<f64>,
    /// Smallest shape of a range, which ends at infinity; the texture is a volume.
    #[arg(long, value_name = "G", value_parser = values::gamma, conflicts_with_all = ["gamma", "layout"])]
    gamma_min: Option<f64>,
    /// Index of refraction of an interface in [1.05, 3], or a range of them as 1.05..2.5: textures
    /// of the shares of light that are reflected and transmitted, from outside and from inside, of
    /// one shape. The index is that of the denser medium over that of the other.
    #[arg(long, value_name = "N", value_parser = indices, conflicts_with_all = ["gamma_min", "layout", "channels"])]
    eta: Option<Indices>,
    /// Largest roughness, in (0, 3]; 3 by default.
    #[arg(long, value_name = "X", value_parser = values::finite, conflicts_with = "layout")]
    sigma_max: Option<f64>,
    /// Texels along roughness and view, rows and columns of the texture, or along shape, roughness
    /// and view, or along index, roughness and view; each in [4, 4096]. By default 64x64,
    /// 32x64x64 or 32x32x32, or what an engine has.
    #[arg(long, value_name = "SIZE", value_parser = size)]
    size: Option<Size>,
    /// Form of masking: G1(v) G1(l) or 1/(1 + lambda(v) + lambda(l)).
    #[arg(long, value_parser = values::masking(), default_value = Masking::HeightCorrelated.name(), conflicts_with = "layout")]
    masking: Masking,
    /// What a texel holds; those of interfaces hold both shares.
    #[arg(long, value_parser = named(&CHANNELS), ignore_case = true, default_value = "e", conflicts_with = "layout")]
    channels: Channels,
    /// Formats of files, separated by commas; needed without --layout. A description in JSON is
    /// always written.
    #[arg(long, value_parser = named(&FORMATS), ignore_case = true, value_delimiter = ',', conflicts_with = "layout")]
    format: Vec<Format>,
    /// Round values to 16 bits; c and json hold the rounded numbers.
    #[arg(long, conflicts_with = "layout")]
    half: bool,
    /// Write what an engine reads, in its own form.
    #[arg(long, value_name = "NAME", ignore_case = true, value_parser = layout())]
    layout: Option<&'static Layout>,
    /// Fit the values of a layout to its filter; by default they are exact at its texels.
    #[arg(long)]
    fit: bool,
    /// Name of the files, and of what C declares; sides of an interface add _outside and _inside,
    /// and averages _average.
    #[arg(long, default_value = "lut", value_parser = name, conflicts_with = "layout")]
    name: String,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

const CHANNELS: [Named<Channels>; 3] = [
    ("e", "E", Channels::E),
    (
        "one-minus-e",
        "1 - E, which keeps its digits in 16 bits where little is lost",
        Channels::OneMinusE,
    ),
    (
        "scale-bias",
        "E and bias - E (1-mu)^5, from which bias and scale = E - bias follow",
        Channels::ScaleBias,
    ),
];

const FORMATS: [Named<Format>; 7] = [
    ("exr", "OpenEXR; the slices of a volume are below each other", Format::Exr),
    ("dds", "DirectDraw Surface with a DX10 header", Format::Dds),
    ("ktx2", "KTX 2", Format::Ktx2),
    ("npy", "An array of NumPy", Format::Npy),
    ("c", "A header for C and C++, with a function that reads it", Format::C),
    ("h", "", Format::C),
    ("json", "The description, with the values", Format::Json),
];

/// Texels along each axis.
#[derive(Clone)]
struct Size(Vec<usize>);

fn size(text: &str) -> Result<Size> {
    let parts: Result<Vec<usize>, _> =
        text.split(['x', 'X']).map(|part| part.trim().parse()).collect();
    match parts {
        Ok(parts) if (2..=3).contains(&parts.len()) => Ok(Size(parts)),
        _ => bail!("\"{text}\" must be whole numbers with x between them, as 32x32 or 32x64x64"),
    }
}

/// Parses an index, or two with .. between them.
fn indices(text: &str) -> Result<Indices> {
    let number = |part: &str| part.trim().parse::<f64>().ok();
    let indices = match text.split_once("..") {
        Some((low, high)) => match (number(low), number(high)) {
            (Some(low), Some(high)) => Some(Indices::Between([low, high])),
            _ => None,
        },
        None => number(text).map(Indices::One),
    };
    indices.map_or_else(
        || bail!("\"{text}\" must be an index, as 1.5, or two with .. between them, as 1.05..2.5"),
        Ok,
    )
}

fn name(text: &str) -> Result<String> {
    let good = |c: char| c == '_' || c.is_ascii_lowercase() || c.is_ascii_digit();
    ensure!(
        text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(good),
        "\"{text}\" must be a name of a-z, 0-9 and _ that begins with a letter, as ggx_albedo"
    );
    ensure!(
        !(text.contains("__") || text.ends_with('_') || text.starts_with("gl_")),
        "\"{text}\" must be a name without __, _ at its end and gl_ at its start, which C++ and \
         GLSL reserve, as ggx_albedo"
    );
    Ok(text.into())
}

/// Parses the name of a layout.
fn layout() -> impl TypedValueParser<Value = &'static Layout> {
    PossibleValuesParser::new(LAYOUTS.iter().map(|layout| layout.name))
        .map(|name| Layout::find(&name.to_lowercase()).expect("one of those listed"))
}

/// The headers of C: an exported file of the same name, such as `math.h`, would hide one.
const HEADERS: &str = "assert complex ctype errno fenv float inttypes iso646 limits locale math \
                       setjmp signal stdalign stdarg stdatomic stdbit stdbool stdckdint stddef \
                       stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype";

pub(super) fn run(args: &Args) -> Result<()> {
    args.layout.map_or_else(|| of_family(args), |layout| of_engine(layout, args))
}

/// Textures in our own coordinates.
fn of_family(args: &Args) -> Result<()> {
    ensure!(
        !args.fit,
        "--fit is of a layout: name one with --layout, or leave it out; other textures are always \
         fitted"
    );
    let sigma_max = args.sigma_max.unwrap_or(SIGMA_MAX);
    let name = &args.name;
    let size =
        |default: &[usize]| args.size.as_ref().map_or(default.to_vec(), |size| size.0.clone());
    let shapes = match (args.gamma, args.gamma_min) {
        (Some(gamma), _) => Shapes::One(gamma),
        (None, Some(smallest)) => Shapes::DownTo(smallest),
        (None, None) => bail!(
            "name a shape with --gamma, a range of them with --gamma-min, or an engine with \
             --layout"
        ),
    };
    let specs: Vec<TextureSpec> = match (args.eta, shapes) {
        (Some(indices), Shapes::One(gamma) | Shapes::DownTo(gamma)) => {
            let size = size(match indices {
                Indices::One(_) => &[64, 64],
                Indices::Between(_) => &[32, 32, 32],
            });
            texture::check_interface(gamma, indices, sigma_max, &size).map_err(Failure::msg)?;
            TextureSpec::of_interface(name, gamma, indices, sigma_max, &size, args.masking).into()
        }
        (None, shapes) => {
            let size = size(match shapes {
                Shapes::One(_) => &[64, 64],
                Shapes::DownTo(_) => &[32, 64, 64],
            });
            texture::check(shapes, sigma_max, &size).map_err(Failure::msg)?;
            let (masking, channels) = (args.masking, args.channels);
            TextureSpec::of_shapes(name, shapes, sigma_max, &size, masking, channels).into()
        }
    };
    let formats = distinct(args.format.iter().copied());
    ensure!(
        !formats.is_empty(),
        "name formats with --format, as --format ktx2,npy, or an engine with --layout"
    );
    ensure!(
        !formats.contains(&Format::C) || HEADERS.split(' ').all(|header| header != name),
        "--name {name}: {name}.h is a header of C, which this one would hide; take another name, \
         as {name}_albedo"
    );
    let out = OutputFolder::open(&args.out)?;
    note_unfitted(&specs[0]);
    let made = make(&specs, true, |spec, stages| {
        let (texture, checks) = spec.make_checked(stages)?;
        let of = |texture: &Texture| checks.of(texture, |_| true);
        let (texture, before_rounding) = if args.half {
            let (rounded, rounding) = texture.rounded();
            (rounded, Some(BeforeRounding { errors: of(&texture), rounding }))
        } else {
            (texture, None)
        };
        let (errors, edges) = (of(&texture), checks.along_edges(&texture));
        Ok(Made { texture, errors, edges, before_rounding })
    })?;
    super::write(&out, &texture::files(&formats, &made).map_err(Failure::msg)?)?;
    for Made { texture, errors, edges, before_rounding } in &made {
        let name = &texture.spec.name;
        for error in errors {
            let (quantity, largest, rms) = (error.quantity, error.largest, error.rms);
            summarize(&format!("{name}: error of {quantity} {largest:.1e}, RMS {rms:.1e}\n"))?;
        }
        for (edge, errors) in edges {
            let one = |error: &Deviation| format!("{} {:.1e}", error.quantity, error.largest);
            let all: Vec<String> = errors.iter().map(one).collect();
            summarize(&format!("{name}, {}: {}\n", edge.name(), all.join(", ")))?;
        }
        if let Some(BeforeRounding { errors, .. }) = before_rounding {
            let one = |error: &Deviation| format!("{} {:.1e}", error.quantity, error.largest);
            let before: Vec<String> = errors.iter().map(one).collect();
            summarize(&format!("{name}: before rounding to 16 bits {}\n", before.join(", ")))?;
        }
    }
    for spec in &specs {
        let lines = shader_lines(spec);
        for (language, line) in [("GLSL", lines.glsl), ("HLSL", lines.hlsl), ("WGSL", lines.wgsl)] {
            summarize(&format!("{language}: {line}\n"))?;
        }
    }
    Ok(())
}

/// Textures in the layout of an engine.
fn of_engine(layout: &Layout, args: &Args) -> Result<()> {
    let gamma = args.gamma.unwrap_or(2.0);
    let size = args.size.as_ref().map_or(layout.size, |size| &size.0);
    layout.check(gamma, size).map_err(Failure::msg)?;
    let out = OutputFolder::open(&args.out)?;
    let engine = layout.engine;
    if size != layout.size {
        let shipped: Vec<String> = layout.size.iter().map(usize::to_string).collect();
        note(format!(
            "the table of {engine} has {} texels: change its constants of the size as well",
            shipped.join("x")
        ));
    }
    let specs = layout.specs(gamma, size, args.fit);
    if args.fit {
        note_unfitted(&specs[0]);
    }
    let textures = make(&specs, false, |spec, [values, _]| Ok(spec.make(values)?))?;
    super::write(&out, &layout.files(&textures).map_err(Failure::msg)?)?;
    note(format!("{engine}: {}", layout.advice));
    if !layout.lobes.contains(&gamma) {
        note(format!(
            "{engine} has GGX as its lobe, and filters environments by it: give both gamma = \
             {gamma} as well (docs/ibl.md), else the energy of this table is not theirs"
        ));
    }
    Ok(())
}

/// Says that a texture is too large to fit.
fn note_unfitted(spec: &TextureSpec) {
    if !spec.fitted {
        let most = texture::MOST_FITTED;
        note(format!("more than {most} texels: they hold the values there, without a fit"));
    }
}

/// Makes each texture, with a stage for its values and one for its checks, if it has any.
fn make<T>(
    specs: &[TextureSpec],
    checked: bool,
    of: impl Fn(&TextureSpec, [&Stage; 2]) -> Result<T>,
) -> Result<Vec<T>> {
    let checks = if checked { 0.5 } else { 0.0 };
    let parts = |spec: &TextureSpec| [1.0, checks].map(|share| share * spec.seconds());
    watched("baking textures", specs.iter().flat_map(parts).sum(), |meter| {
        let one = |spec: &TextureSpec| {
            let [values, checks] = parts(spec).map(|seconds| meter.stage(seconds));
            of(spec, [&values, &checks])
        };
        specs.iter().map(one).collect()
    })
}
