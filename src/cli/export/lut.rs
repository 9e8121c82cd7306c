//! Albedos as textures.

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::PossibleValuesParser;

use microfacet_baker::progress::{Meter, Stage};
use microfacet_baker::store::OutputFolder;
use microfacet_export::texture;
use microfacet_export::texture::engine::{LAYOUTS, Layout};
use microfacet_export::texture::{
    BeforeRounding, Channels, Checks, Format, Made, Shapes, TextureSpec, shader_lines,
};
use microfacet_sampler::Masking;

use crate::cli::furnace::parse_masking;
use crate::cli::{Failure, Outcome, progress, report, summarize, values};

/// Directional albedo and its average as textures that a shader reads in one line.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake export lut --gamma 2 --sigma-max 1 --size 32x32 --format npy,ktx2 --out lut
GGX up to sigma 1 in 32 texels along the roughness and 32 along the view.
  microfacet-bake export lut --gamma-min 1.6 --size 32x64x64 --format dds --out lut
All shapes from 1.6 to infinity, as a volume.
  microfacet-bake export lut --layout cycles --out lut
What Cycles reads, with exact values; with --fit, with values fitted to its filter.")]
pub(super) struct Args {
    /// Shape in [1.501, inf]; 2 is GGX, inf is Beckmann. A layout is of 2 by default.
    #[arg(long, value_name = "G", value_parser = values::gamma)]
    gamma: Option<f64>,
    /// Smallest shape of a range, which ends at infinity; the texture is a volume.
    #[arg(long, value_name = "G", value_parser = values::gamma, conflicts_with_all = ["gamma", "layout"])]
    gamma_min: Option<f64>,
    #[arg(long, hide = true, value_name = "G", value_parser = values::gamma)]
    gamma_max: Option<f64>,
    /// Largest roughness, in (0, 3]; 3 by default.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = values::finite, conflicts_with = "layout")]
    sigma_max: Option<f64>,
    /// Texels along roughness and view, rows and columns of the texture, or along shape, roughness
    /// and view; each in [4, 4096]. By default 64x64, or 32x64x64, or what an engine has.
    #[arg(long, value_name = "SIZE", value_parser = size)]
    size: Option<Size>,
    /// Form of masking: G1(v) G1(l) or 1/(1 + lambda(v) + lambda(l)).
    #[arg(long, value_parser = parse_masking(), default_value = Masking::HeightCorrelated.name(), conflicts_with = "layout")]
    masking: Masking,
    /// What a texel holds.
    #[arg(long, value_enum, ignore_case = true, default_value_t, conflicts_with = "layout")]
    channels: ChannelsArg,
    /// Formats of files, separated by commas; needed without --layout. A description in JSON is
    /// always written.
    #[arg(long, value_enum, ignore_case = true, value_delimiter = ',', conflicts_with = "layout")]
    format: Vec<FormatArg>,
    /// Round values to 16 bits; c and json hold the rounded numbers.
    #[arg(long, conflicts_with = "layout")]
    half: bool,
    /// Write what an engine reads, in its own form.
    #[arg(long, value_name = "NAME", ignore_case = true, value_parser = PossibleValuesParser::new(LAYOUTS.iter().map(|layout| layout.name)))]
    layout: Option<String>,
    /// Fit the values of a layout to its filter; by default they are exact at its texels.
    #[arg(long)]
    fit: bool,
    /// Name of the files, and of what C declares; the averages add _average.
    #[arg(long, default_value = "lut", value_parser = name, conflicts_with = "layout")]
    name: String,
    /// Folder to write into.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum ChannelsArg {
    /// E.
    #[default]
    E,
    /// 1 - E, which keeps its digits in 16 bits where little is lost.
    OneMinusE,
    /// E and bias - E (1-mu)^5, from which bias and scale = E - bias follow.
    ScaleBias,
}

#[derive(Clone, Copy, ValueEnum)]
enum FormatArg {
    /// OpenEXR; the slices of a volume are below each other.
    Exr,
    /// DirectDraw Surface with a DX10 header.
    Dds,
    /// KTX 2.
    Ktx2,
    /// An array of NumPy.
    Npy,
    /// A header for C and C++, with a function that reads it.
    #[value(aliases = ["h"])]
    C,
    /// The description, with the values.
    Json,
}

/// Texels along each axis.
#[derive(Clone)]
struct Size(Vec<usize>);

fn size(text: &str) -> Result<Size, String> {
    let parts: Option<Vec<usize>> =
        text.split(['x', 'X']).map(|part| part.trim().parse().ok()).collect();
    match parts {
        Some(parts) if (2..=3).contains(&parts.len()) => Ok(Size(parts)),
        _ => Err(format!(
            "\"{text}\" must be whole numbers with x between them, as 32x32 or 32x64x64"
        )),
    }
}

fn name(text: &str) -> Result<String, String> {
    let good = |c: char| c == '_' || c.is_ascii_lowercase() || c.is_ascii_digit();
    if !text.starts_with(|c: char| c.is_ascii_lowercase()) || !text.chars().all(good) {
        return Err(format!(
            "\"{text}\" must be a name of a-z, 0-9 and _ that begins with a letter, as ggx_albedo"
        ));
    }
    if text.contains("__") || text.ends_with('_') || text.starts_with("gl_") {
        return Err(format!(
            "\"{text}\" must be a name without __, _ at its end and gl_ at its start, which C++ and \
             GLSL reserve, as ggx_albedo"
        ));
    }
    Ok(text.into())
}

/// The headers of C: a file of such a name would hide one, as `math.h` from itself.
const HEADERS: &str = "assert complex ctype errno fenv float inttypes iso646 limits locale math \
                       setjmp signal stdalign stdarg stdatomic stdbit stdbool stdckdint stddef \
                       stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype";

impl ChannelsArg {
    fn channels(self) -> Channels {
        match self {
            Self::E => Channels::E,
            Self::OneMinusE => Channels::OneMinusE,
            Self::ScaleBias => Channels::ScaleBias,
        }
    }
}

impl FormatArg {
    fn format(self) -> Format {
        match self {
            Self::Exr => Format::Exr,
            Self::Dds => Format::Dds,
            Self::Ktx2 => Format::Ktx2,
            Self::Npy => Format::Npy,
            Self::C => Format::C,
            Self::Json => Format::Json,
        }
    }
}

pub(super) fn run(args: Args) -> Outcome {
    match &args.layout {
        Some(name) => {
            of_engine(Layout::find(&name.to_lowercase()).expect("one of those listed"), &args)
        }
        None => of_family(&args),
    }
}

/// Textures in our own coordinates.
fn of_family(args: &Args) -> Outcome {
    if args.fit {
        return Err(Failure(
            "--fit is of a layout: name one with --layout, or leave it out; other textures are \
             always fitted"
                .into(),
        ));
    }
    if args.gamma_max.is_some() && args.gamma_min.is_none() {
        return Err(Failure(
            "--gamma-max is of no use: a range of shapes goes from --gamma-min to infinity".into(),
        ));
    }
    let shapes = match (args.gamma, args.gamma_min) {
        (Some(gamma), _) => Shapes::One(gamma),
        (None, Some(smallest)) => {
            if let Some(largest) = args.gamma_max.filter(|&largest| largest != f64::INFINITY) {
                return Err(Failure(if largest <= smallest {
                    format!(
                        "--gamma-max {largest} does not lie above --gamma-min {smallest}; a range \
                             goes from infinity down: leave out --gamma-max"
                    )
                } else {
                    "a range of shapes goes from infinity down: leave out --gamma-max".into()
                }));
            }
            Shapes::DownTo(smallest)
        }
        (None, None) => {
            return Err(Failure(
                "name a shape with --gamma, a range of them with --gamma-min, or an engine with \
                 --layout"
                    .into(),
            ));
        }
    };
    let default = match shapes {
        Shapes::One(_) => vec![64, 64],
        Shapes::DownTo(_) => vec![32, 64, 64],
    };
    let size = args.size.as_ref().map_or(default, |size| size.0.clone());
    let sigma_max = args.sigma_max.unwrap_or(microfacet_tables::SIGMA_MAX);
    texture::check(shapes, sigma_max, &size)?;
    let channels = args.channels.channels();
    let specs =
        TextureSpec::of_shapes(&args.name, shapes, sigma_max, &size, args.masking, channels);
    let mut formats: Vec<Format> = Vec::new();
    for format in args.format.iter().map(|format| format.format()) {
        if !formats.contains(&format) {
            formats.push(format);
        }
    }
    if formats.is_empty() {
        return Err(Failure(
            "name formats with --format, as --format ktx2,npy, or an engine with --layout".into(),
        ));
    }
    if formats.contains(&Format::C) && HEADERS.split(' ').any(|header| header == args.name) {
        let name = &args.name;
        return Err(Failure(format!(
            "--name {name}: {name}.h is a header of C, which this one would hide; take another name, \
             as {name}_albedo"
        )));
    }
    let out = OutputFolder::open(&args.out)?;
    note_unfitted(&specs[0]);
    let made = make(&specs, true, |spec, [values, checks]| {
        let texture = spec.make(values)?;
        let checks = Checks::new(spec, checks)?;
        let errors = checks.of(&texture, |_| true);
        if !args.half {
            return Ok(Made { texture, errors, before_rounding: None });
        }
        let (texture, rounding) = texture.rounded();
        let rounded = checks.of(&texture, |_| true);
        let before_rounding = Some(BeforeRounding { errors, rounding });
        Ok(Made { texture, errors: rounded, before_rounding })
    })?;
    let files = texture::files(&formats, &made)?;
    let done = super::write(&out, &files)?;
    for made in &made {
        for error in &made.errors {
            let (name, quantity) = (&made.texture.spec.name, error.quantity);
            let (largest, rms) = (error.largest, error.rms);
            summarize(&format!("{name}: error of {quantity} {largest:.1e}, RMS {rms:.1e}\n"))?;
        }
        if let Some(before) = &made.before_rounding {
            let name = &made.texture.spec.name;
            let before: Vec<String> = before
                .errors
                .iter()
                .map(|error| format!("{} {:.1e}", error.quantity, error.largest))
                .collect();
            summarize(&format!("{name}: before rounding to 16 bits {}\n", before.join(", ")))?;
        }
    }
    for spec in &specs {
        let lines = shader_lines(spec);
        for (language, line) in [("GLSL", lines.glsl), ("HLSL", lines.hlsl), ("WGSL", lines.wgsl)] {
            summarize(&format!("{language}: {line}\n"))?;
        }
    }
    Ok(done)
}

/// What an engine reads.
fn of_engine(layout: &Layout, args: &Args) -> Outcome {
    let gamma = args.gamma.unwrap_or(2.0);
    let size = args.size.as_ref().map_or(layout.size.to_vec(), |size| size.0.clone());
    texture::check(Shapes::One(gamma), 1.0, &size)?;
    let out = OutputFolder::open(&args.out)?;
    let size = [size[0], size[1]];
    if size != layout.size {
        let [rows, columns] = layout.size;
        report(
            "note",
            format!(
                "the table of {} has {rows}x{columns} texels: change its constants of the size as well",
                layout.engine
            ),
        );
    }
    let specs = layout.specs(gamma, size, args.fit);
    if args.fit {
        note_unfitted(&specs[0]);
    }
    let textures = make(&specs, false, |spec, [values, _]| Ok(spec.make(values)?))?;
    let done = super::write(&out, &layout.files(&textures)?)?;
    report("note", format!("{}: {}", layout.engine, layout.advice));
    Ok(done)
}

/// Says that a texture is too large to fit.
fn note_unfitted(spec: &TextureSpec) {
    if !spec.fitted {
        let most = texture::MOST_FITTED;
        report(
            "note",
            format!("more than {most} texels: they hold the values there, without a fit"),
        );
    }
}

/// Makes each texture, with a stage for its values and one for its checks, if it has any.
fn make<T>(
    specs: &[TextureSpec],
    checked: bool,
    of: impl Fn(&TextureSpec, [&Stage; 2]) -> Result<T, Failure>,
) -> Result<Vec<T>, Failure> {
    let meter = Meter::default();
    let checks = if checked { 0.5 } else { 0.0 };
    let parts = |spec: &TextureSpec| [1.0, checks].map(|share| share * spec.seconds());
    specs.iter().flat_map(parts).for_each(|seconds| meter.expect(seconds));
    let _bar = progress::show(&meter, "baking textures");
    let one = |spec: &TextureSpec| {
        let [values, checks] = parts(spec).map(|seconds| meter.stage(seconds));
        of(spec, [&values, &checks])
    };
    specs.iter().map(one).collect()
}
