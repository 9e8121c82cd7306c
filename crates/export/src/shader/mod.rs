//! Shader modules: functions written once, in WGSL, and translated into files, which are here too.
//! Functions of lobes are the same for single shapes and for a family; what reads the tables is
//! that of one or of the other.

mod argument;
mod data;
mod host;
mod language;
mod slang;

use std::fmt::Write;

use microfacet_tables::crc32;

use super::members::{Member, Value};
use super::{ExportFile, Family, Realtime, Shape};
pub use data::texture_rows;
pub use data::{WIDTH, append_some};
pub use host::{Group, Host};
use language::head;
pub use language::{Kind, Language, Storage};

/// Functions of lobes, after what reads the tables.
const FUNCTIONS: &str = concat!(
    include_str!("numbers.wgsl"),
    "\n",
    include_str!("masking.wgsl"),
    "\n",
    include_str!("normals.wgsl"),
    "\n",
    include_str!("prefilter.wgsl"),
    "\n",
    include_str!("albedo.wgsl"),
);

/// What reads the tables of shapes, after their members, and the functions by shape.
const OF_SHAPES: &str = concat!(
    include_str!("shape.wgsl"),
    "\n",
    include_str!("shape_albedo.wgsl"),
    "\n",
    include_str!("calls.wgsl"),
);

/// What reads the tables of a family.
const OF_FAMILY: &str =
    concat!(include_str!("family.wgsl"), "\n", include_str!("family_albedo.wgsl"));

/// The module, a program that uses it, and the data.
pub(super) fn files(
    language: Language,
    storage: Storage,
    host: &Host,
    shapes: &[Shape],
) -> Vec<ExportFile> {
    let storage = language.storage(storage);
    let module = module(&shapes.first().expect("shapes").lists(), storage);
    let mut files = text_files(Kind::Shapes, language, storage, host, &module);
    data::append_files(shapes, &mut files);
    files
}

/// The same of a family.
pub(super) fn family_files(
    language: Language,
    storage: Storage,
    host: &Host,
    family: &Family,
) -> Vec<ExportFile> {
    let storage = language.storage(storage);
    let mut files = text_files(Kind::Family, language, storage, host, &family_module(storage));
    data::append_family(family, &mut files);
    files
}

/// The functions for real time, a program that uses them, and the textures.
pub(super) fn realtime_files(
    language: Language,
    host: &Host,
    realtime: &Realtime,
) -> Vec<ExportFile> {
    let mut files = realtime_text(language, host);
    realtime.append_files(&mut files);
    files
}

/// The functions for real time, and a program that uses them.
#[doc(hidden)]
pub fn realtime_text(language: Language, host: &Host) -> Vec<ExportFile> {
    let module = include_str!("realtime.wgsl");
    text_files(Kind::Realtime, language, Storage::Texture, host, module)
}

/// The module, and a program that uses it.
fn text_files(
    kind: Kind,
    language: Language,
    storage: Storage,
    host: &Host,
    module: &str,
) -> Vec<ExportFile> {
    let sample = language.sample(storage, kind);
    let [of_module, of_sample] = language.extensions(kind);
    let name = format!("{}.{of_module}", kind.name());
    let slang = (language == Language::Slang).then(|| slang::module(storage, kind));
    let text = slang.as_deref().unwrap_or(module);
    let translation = language.translation(storage, kind).unwrap_or(text.as_bytes());
    let (contents, sample) = match language {
        Language::SpirV => (host.place_words(translation), sample),
        _ => {
            let text = str::from_utf8(translation).expect("text but of SPIR-V");
            let [text, sample] = match host.as_argument {
                true => argument::as_argument(text, &sample),
                false => [text.to_owned(), sample],
            };
            let head = head(&name, language, storage, kind, host.as_argument);
            (host.place(&format!("{head}\n{text}"), language).into(), sample)
        }
    };
    let sample = host.place_bindings(&sample, language);
    let sample = ExportFile::new(format!("{}_sample.{of_sample}", kind.name()), sample);
    let mut files = vec![ExportFile::new(name, contents), sample];
    if language == Language::Wgsl && kind != Kind::Realtime {
        files.push(ExportFile::new("student_t_closed.wgsl", include_str!("closed.wgsl")));
    }
    files
}

/// The functions for WebGL 2, without the comment at the head of the file.
pub fn for_webgl() -> &'static str {
    include_str!("translated/texture_es.glsl")
}

/// The CRC-32 of the WGSL that is translated, without its comments, which `translated/wgsl.crc32`
/// states: so a test finds old translations without a translator.
#[doc(hidden)]
pub fn wgsl_crc32(shape: &Shape) -> String {
    let texts = [Storage::Buffer, Storage::Texture].map(|storage| {
        let sample = |kind| Language::SpirV.sample(storage, kind);
        let [shapes, family] = [Kind::Shapes, Kind::Family].map(sample);
        [module(&shape.lists(), storage), shapes, family_module(storage), family].join("\n")
    });
    let realtime = include_str!("realtime.wgsl");
    let lines = texts.iter().flat_map(|text| text.lines()).chain(realtime.lines());
    let code: Vec<&str> = lines.filter(|line| !line.trim_start().starts_with("//")).collect();
    crc32(code.join("\n").as_bytes())
}

/// All text in WGSL of shapes, the same for all: it can be translated before they are known.
fn module([lobe, uncorrelated, correlated]: &[Vec<Member>; 3], storage: Storage) -> String {
    let tables = match storage {
        Storage::Buffer => include_str!("buffer.wgsl"),
        Storage::Texture => include_str!("texture.wgsl"),
    };
    let first = lobe.len().div_ceil(2);
    let second = first + uncorrelated.len().div_ceil(2);
    let which = format!("select({second}u, {first}u, masking == STUDENT_T_UNCORRELATED)");
    let lobe =
        loader("StudentTLobe", &LOBE, lobe, "student_t_lobe_of(shape: u32, sigma: vec2f)", "shape");
    let albedo = loader(
        "StudentTAlbedoTable",
        &[],
        correlated,
        "student_t_impl_albedo_table(shape: u32, masking: u32)",
        &format!("shape + {which}"),
    );
    format!("{tables}\n{LOBE_COMMENT}{lobe}\n{albedo}\n{FUNCTIONS}\n{OF_SHAPES}")
}

/// All text in WGSL of a family.
fn family_module(storage: Storage) -> String {
    let tables = match storage {
        Storage::Buffer => include_str!("family_buffer.wgsl"),
        Storage::Texture => include_str!("family_texture.wgsl"),
    };
    format!("{tables}\n{OF_FAMILY}\n{FUNCTIONS}")
}

/// What is said of a lobe.
const LOBE_COMMENT: &str = "\
// The lobe of one shape and roughness: what a shader makes at a hit, and hands to the functions. Of
// its members sigma, in [1e-8, 1e6], and is_mirror, whether one was not above 0, are for users.
";

/// The first members of a lobe of a shape, and their values.
const LOBE: [[&str; 2]; 3] = [
    ["sigma: vec2f", "vec2f(student_t_impl_sigma(sigma.x), student_t_impl_sigma(sigma.y))"],
    ["is_mirror: bool", "!(sigma.x > 0.0 && sigma.y > 0.0)"],
    ["shape: u32", "shape"],
];

/// A struct of members, after those that are given with their values, and a function that reads
/// it; a table is the index of its first pair.
fn loader(
    name: &str,
    given: &[[&str; 2]],
    members: &[Member],
    signature: &str,
    at: &str,
) -> String {
    let mut fields = String::new();
    let mut pairs = String::new();
    let mut values = String::new();
    for [field, value] in given {
        writeln!(fields, "    {field},").expect("memory");
        writeln!(values, "        {value},").expect("memory");
    }
    for (i, pair) in members.chunks(2).enumerate() {
        let first = pair[0].name;
        writeln!(pairs, "    let {first} = student_t_impl_pair(at + {i}u);").expect("memory");
        for (member, channel) in pair.iter().zip(["x", "y"]) {
            let (kind, value) = match member.value {
                Value::Table(_) => ("u32", format!("shape + u32({first}.{channel})")),
                _ => ("f32", format!("{first}.{channel}")),
            };
            writeln!(fields, "    {}: {kind},", member.name).expect("memory");
            writeln!(values, "        {value},").expect("memory");
        }
    }
    format!(
        "struct {name} {{\n{fields}}}\n\nfn {signature} -> {name} {{\n    let at = {at};\n{pairs}    \
         return {name}(\n{values}    );\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use microfacet_core::schlick::{F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE};
    use microfacet_sampler::{StudentT, Tables};
    use microfacet_tables::axis::LogShape;

    use super::super::family::Block;
    use super::super::numbers::single;
    use super::super::realtime;
    use super::super::texture::Along;
    use super::*;

    #[test]
    fn constants_are_those_of_the_crate() {
        let [low, high] = StudentT::SIGMAS.map(|sigma| single(sigma as f32));
        let constants = [
            format!("student_t_impl_max(sigma, {low}), {high})"),
            format!("fourth * k, {} * mu", single(F82_SCALE as f32)),
            format!(
                "1.0 / {}, {})",
                single((1.0 / SCHLICK_AVERAGE) as f32),
                single(F82_AVERAGE as f32)
            ),
        ];
        for constant in constants {
            assert!([FUNCTIONS, OF_SHAPES].concat().contains(&constant), "{constant}");
        }
        let constants = [
            ("PARTS", 5),
            ("VOLUMES", Block::HEAD / 4 - 2 * 28),
            ("PART", (Block::HEAD / 4 - 2 * 28 - 5) / 2),
            ("VOLUME", 28),
            ("BETWEEN", Block::WINDOW / 4),
            ("ROWS", Block::ROWS),
        ];
        for (name, value) in constants {
            let line = format!("const STUDENT_T_IMPL_{name} = {value}u;\n");
            assert!(OF_FAMILY.contains(&line), "{line}");
        }
        let [gammas, sigmas, views] = realtime::ALBEDO;
        let sizes = [
            ("GAMMAS", gammas),
            ("SIGMAS", sigmas),
            ("VIEWS", views),
            ("VIEWS_OF_MASKING", realtime::VIEWS_OF_MASKING),
        ];
        let real_time = include_str!("realtime.wgsl");
        for (name, texels) in sizes {
            let line = format!("const STUDENT_T_{name} = {texels}.0;\n");
            assert!(real_time.contains(&line), "{line}");
        }
        let Along::View(view) = realtime::spec().axes[2].along else { panic!("views come last") };
        // Both κ have the same part of heavy tails.
        assert_eq!(view.heavy, realtime::kappa(2.0) - realtime::kappa(f64::INFINITY));
        let axis = 1.0 / LogShape::BAKED.coordinate(realtime::GAMMA_MIN) * std::f64::consts::LN_2;
        let constants = [
            format!("let shape = {} * log2(1.0 + 17.0 * heavy);", single(axis as f32)),
            format!("let kappa = {0:?} + {0:?} * heavy;", realtime::kappa(f64::INFINITY)),
            format!("clamp(gamma, {:?}, 1e6)", realtime::GAMMA_MIN),
            format!("(kappa + {:?}) * stand_in", view.scale - realtime::kappa(f64::INFINITY)),
            format!("* {});\n", single((6.0 / 7.0_f64).powi(5) as f32)),
            format!("fourth * k, {} * c * fourth", single(F82_SCALE as f32)),
            format!("- {} * student_t_impl_untinted", single(F82_AVERAGE as f32)),
        ];
        for constant in constants {
            assert!(real_time.contains(&constant), "{constant}");
        }
        let width = data::WIDTH;
        let (mask, shift) = (width - 1, width.ilog2());
        let texel = format!("at & {mask}u), i32(at >> {shift}u)");
        for text in [include_str!("texture.wgsl"), include_str!("family_texture.wgsl")] {
            assert!(width.is_power_of_two() && text.contains(&texel));
        }
    }

    #[test]
    fn the_kit_for_real_time_has_names_of_its_own() {
        let names = |text: &str| -> Vec<String> {
            let declared = text.lines().filter(|line| {
                ["fn ", "struct ", "const "].iter().any(|word| line.starts_with(word))
            });
            let name = |line: &str| line.split([' ', '(', ':']).nth(1).unwrap().into();
            declared.map(name).collect()
        };
        let others =
            names(&[FUNCTIONS, OF_SHAPES, OF_FAMILY, include_str!("closed.wgsl")].concat());
        assert!(others.len() > 80 && others.contains(&"student_t_closed_d".into()));
        let kit = names(include_str!("realtime.wgsl"));
        assert!(kit.contains(&"STUDENT_T_VIEWS".into()) && kit.len() > 20, "{kit:?}");
        for name in kit {
            assert!(!others.contains(&name), "{name}");
        }
    }

    #[test]
    fn translations_are_those_of_the_wgsl() {
        let shape = Shape::bind(&Tables::embedded(), 2.0).unwrap();
        let stated = include_str!("translated/wgsl.crc32").trim();
        assert_eq!(stated, wgsl_crc32(&shape), "translated/README.md says how to translate anew");
    }

    #[test]
    fn members_are_read_by_pairs_in_their_order() {
        let shape = Shape::bind(&Tables::embedded(), 1.7).unwrap();
        let [_, _, albedo] = shape.lists();
        let text = loader("T", &[], &albedo, "t(shape: u32)", "shape");
        let fields = text.lines().take_while(|line| *line != "}").skip(1);
        let declared: Vec<&str> =
            fields.map(|line| line.trim().split_once(": ").unwrap().0).collect();
        assert!(declared.iter().copied().eq(albedo.iter().map(|member| member.name)));
        // The second pair begins with the third member.
        assert!(text.contains("let sigmas = student_t_impl_pair(at + 1u);"), "{text}");
        let values = ["shape + u32(values.x),", "shape + u32(values.y),", "sigmas.x,", "sigmas.y,"];
        assert!(text.contains(&values.join("\n        ")), "{text}");
    }

    #[test]
    fn text_is_narrow_and_that_of_all_shapes() {
        let tables = Tables::embedded();
        let [lists, heavy, closed] =
            [3.0, 1.7, 2.0].map(|gamma| Shape::bind(&tables, gamma).unwrap().lists());
        for storage in [Storage::Buffer, Storage::Texture] {
            let text = module(&lists, storage);
            assert!(text == module(&heavy, storage) && text == module(&closed, storage));
            for language in [Language::Wgsl, Language::GlslEs, Language::Msl, Language::Slang] {
                for (kind, text) in [(Kind::Shapes, &text), (Kind::Family, &family_module(storage))]
                {
                    let head = head("student_t_family.metal", language, storage, kind, false);
                    for line in head.lines().chain(text.lines()) {
                        assert!(line.len() <= 100, "{line}");
                    }
                }
            }
        }
    }
}
